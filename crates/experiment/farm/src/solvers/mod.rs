//! What may move the air of a farm: a descriptor for each kind of flow solver, and the one list of them.
//!
//! A new kind is a file beside this one with its [`SolverKind`], and a line in [`SOLVERS`]. Everyone else
//! asks the descriptor.

mod lattice;
mod prescribed;
mod vortex;

pub use lattice::LATTICE;
pub use prescribed::{PLANES, PRESCRIBED, TURBULENCE, UNIFORM};
pub use vortex::VORTEX;

use crate::air::Air;
use crate::case::{Case, Flow, Wind};
use crate::plan::{Layout, Plan, PlanError};
use crate::self_check::Tunnel;
use crate::wind::Site;
use basis::keys::{self, Key, Values};
use basis::registry::{Named, Registry};
use flow::Inflow;
use flow::inflow::{InflowError, Planes};
use flow::lattice::LatticeError;
use flow::lattice::refinement::RefinementError;
use flow::vortex::WakeError;
use std::fmt;
use std::ops::{ControlFlow, Deref};
use std::sync::Arc;

/// The kinds of flow solvers. A new kind is a file beside this one and a line here; a program built on
/// wakemix [adds](Registry::add) its own.
pub static SOLVERS: Registry<SolverKind> =
    Registry::new(&[&LATTICE, &UNIFORM, &TURBULENCE, &PLANES, &VORTEX]);

/// Everything that belongs to one kind of flow solver.
///
/// Kinds in which the wind is prescribed start from [`PRESCRIBED`] and say what differs.
pub struct SolverKind {
    /// Its name, the word of `flow.solver`.
    pub name: &'static str,
    /// What it does, in a sentence without a full stop.
    pub about: &'static str,
    /// What its wind cannot show, in sentences for a reader of results; empty where there is nothing to say.
    pub limits: &'static str,
    /// Keys of `[flow]` that it uses, beside those of all kinds; what they hold is [`Flow::values`]. Other
    /// kinds may have keys of the same names.
    pub keys: &'static [Key],
    /// What about the values of these keys cannot be, beyond what the keys say one by one.
    pub check: fn(&Values) -> Vec<keys::Objection>,
    /// Which wind it takes in.
    pub wind: WindSource,
    /// Whether its air can be the [atmosphere](Site::surroundings) of a precursor.
    pub stands_in_atmosphere: bool,
    /// Whether the wind that it gives contains the rotors' induction; otherwise turbines make their own by
    /// momentum theory.
    pub resolves_induction: bool,
    /// Whether the wind that it gives holds the rotors' wakes, so that turbines feel one another.
    pub has_wakes: bool,
    /// How it wants forces spread, and interpolates the wind, where it resolves induction: of the turbine of
    /// this number.
    pub smearing: fn(&Plan, usize) -> Smearing,
    /// Whether it asks for the bound vortices of blades, not for their forces alone.
    pub uses_bound_vortices: bool,
    /// Most pieces of vortices that its wakes have (–); none where they are nothing of the kind.
    pub most_filaments: Option<fn(&Case, &Plan) -> u64>,
    /// Whether rotors are checked in it, each alone, before a study.
    pub needs_self_check: bool,
    /// The tunnel in which they are, in a flow like the case's as it is laid out.
    pub tunnel: fn(&Plan, &Flow) -> Tunnel,
    /// Speed of unbounded air over that in such a tunnel (–) in which a rotor of a diameter (m) and a thrust
    /// coefficient (–) in the tunnel is in the same state, as far as the case's own flow has none of the
    /// tunnel's bounds: what the case lacks itself is for the check to find.
    pub equivalent_speed: fn(&Tunnel, &Flow, f64, f64) -> f64,
    /// What of the case's wind and domain it cannot take.
    pub objections: fn(&Wind, &Flow) -> Vec<Objection>,
    /// What a reader of the numbers must know of a case in it, as it is laid out.
    pub warnings: fn(&Case, &Plan) -> Vec<String>,
    /// Speed of sound (m/s) of its air, which no tip may exceed; none where the air has no sound.
    pub sound_speed: fn(&Plan) -> Option<f64>,
    /// Domain and step for a layout.
    pub plan: fn(&Case, &Layout) -> Result<Plan, PlanError>,
    /// How far downstream of the last rotor it asks for its wind (m), where that is made or read around the
    /// rotors.
    pub reach: fn(&Case, &Plan) -> f64,
    /// Memory that its field takes (bytes).
    pub memory: fn(&Case, &Plan) -> u64,
    /// Keys that need less memory where they are lower, in words that follow “lower”.
    pub less_memory: &'static str,
    /// What may carry a run whose air broke down, in words.
    pub steadier: &'static str,
    /// The air at time zero.
    pub begin: fn(Start) -> Result<Air, SolverError>,
    /// The air about one rotor alone, in a steady wind, at time zero.
    pub begin_alone: fn(&Alone) -> Result<Air, SolverError>,
    /// What a step of that air costs (cell updates; 1 where there are no cells) about a rotor of a diameter
    /// (m).
    pub updates_alone: fn(&Tunnel, f64) -> f64,
}

impl Named for SolverKind {
    fn name(&self) -> &'static str {
        self.name
    }
}

/// Which wind a kind of solver takes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WindSource {
    /// The mean profile with veer and event, without turbulence.
    Deterministic,
    /// The mean profile, and turbulence in a box that is carried into its domain; or planes from a file.
    AtInlet,
    /// The mean profile, and turbulence on a grid around the rotors.
    AroundRotors,
    /// Planes from a file.
    Planes,
    /// Any of these but the inlet: what the case's wind says.
    Any,
}

impl WindSource {
    /// What it is for `wind`, [`Any`](Self::Any) decided.
    pub fn of(self, wind: &Wind) -> Self {
        match self {
            Self::Any if wind.planes.is_some() => Self::Planes,
            Self::Any if wind.turbulence_intensity > 0.0 && wind.table.is_none() => {
                Self::AroundRotors
            }
            Self::Any => Self::Deterministic,
            other => other,
        }
    }
}

/// Lengths over which a flow that resolves induction smears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smearing {
    /// Gaussian width ε of the forces (m).
    pub length: f64,
    /// Distance of the points between which the wind is interpolated (m); 0 where it is not.
    pub sample_spacing: f64,
}

/// What a solver begins a run from.
pub struct Start<'a> {
    /// Case, plan and turbines.
    pub site: Site<'a>,
    /// The wind that enters: profile, veer and event, with turbulence for [`WindSource::AtInlet`].
    pub inflow: Arc<dyn Inflow>,
    /// The file of planes, opened, for [`WindSource::Planes`].
    pub planes: Option<Box<dyn Planes>>,
    /// Receives the share (–) of what is made at the start that is done; a break ends it.
    pub progress: &'a dyn Fn(f64) -> ControlFlow<()>,
}

/// One rotor alone, at the origin, in a steady wind.
pub struct Alone<'a> {
    /// Room around it, and step.
    pub tunnel: Tunnel,
    /// Speed and air.
    pub wind: &'a Wind,
    /// Its diameter (m).
    pub diameter: f64,
    /// What moves the air, and how.
    pub flow: &'a Flow,
}

/// A key of `[wind]` that a solver cannot take as it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objection {
    /// The key, or the one beside which a missing key should stand.
    pub key: &'static str,
    /// What is wrong.
    pub fault: Fault,
    /// How to fix it.
    pub fix: &'static str,
}

/// What is wrong with a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// It is given and has no effect, with the reason.
    NoUse(&'static str),
    /// Its value is not for this solver, with the reason.
    Refused(&'static str),
    /// This key is missing (dotted).
    Missing(&'static str),
}

/// Why no flow could be set up.
#[derive(Debug, thiserror::Error)]
pub enum SolverError {
    /// A lattice cannot be set up.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// Nor boxes of finer cells in it.
    #[error(transparent)]
    Refinement(#[from] RefinementError),
    /// A free wake cannot be set up.
    #[error(transparent)]
    Wake(#[from] WakeError),
    /// Its wind cannot be read.
    #[error(transparent)]
    Inflow(#[from] InflowError),
    /// [`WindSource::Planes`] without planes in [`Start::planes`].
    #[error("flow.solver = \"{solver}\" takes planes of wind, and none were handed to it")]
    NoPlanes {
        /// The flow solver.
        solver: &'static str,
    },
    /// Another reason, of a kind of its own.
    #[error(transparent)]
    Other(Box<dyn std::error::Error + Send + Sync>),
}

/// A kind of flow solver as a case names it; alike where the names are.
#[derive(Clone, Copy)]
pub struct Solver(pub &'static SolverKind);

impl Solver {
    /// [`LATTICE`], which holds without a choice.
    pub const LATTICE: Self = Self(&LATTICE);
    /// [`UNIFORM`].
    pub const UNIFORM: Self = Self(&UNIFORM);
    /// [`TURBULENCE`].
    pub const TURBULENCE: Self = Self(&TURBULENCE);
    /// [`PLANES`].
    pub const PLANES: Self = Self(&PLANES);

    /// The kind called `name` in [`SOLVERS`].
    pub fn named(name: &str) -> Option<Self> {
        SOLVERS.find(name).map(Self)
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self::LATTICE
    }
}

impl Deref for Solver {
    type Target = SolverKind;

    fn deref(&self) -> &SolverKind {
        self.0
    }
}

impl PartialEq for Solver {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Solver {}

impl fmt::Debug for Solver {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Solver({})", self.name)
    }
}

/// Names of the kinds that leave induction to the turbines, for a sentence: `flow.solver = "a", "b" or "c"`.
pub fn without_induction() -> String {
    let names: Vec<String> = SOLVERS
        .all()
        .iter()
        .filter(|kind| !kind.resolves_induction)
        .map(|kind| format!("\"{}\"", kind.name))
        .collect();
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => names.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn kinds_and_their_keys_have_names_of_their_own() {
        let names: BTreeSet<&str> = SOLVERS.all().iter().map(|kind| kind.name).collect();
        assert_eq!(names.len(), SOLVERS.all().len());
        for kind in SOLVERS.all() {
            assert_eq!(Solver::named(kind.name), Some(Solver(kind)));
            let keys: BTreeSet<&str> = kind.keys.iter().map(|key| key.name).collect();
            assert_eq!(keys.len(), kind.keys.len());
            assert!(!kind.about.is_empty() && !kind.about.ends_with('.'), "{}", kind.name);
        }
        assert_eq!(Solver::named("vortices"), None);
    }

    #[test]
    fn a_sentence_names_those_that_leave_induction_to_the_turbines() {
        assert_eq!(without_induction(), "\"uniform\", \"turbulence\" or \"planes\"");
    }
}
