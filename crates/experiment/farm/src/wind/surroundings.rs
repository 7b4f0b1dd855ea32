//! The atmosphere that a study stands in: as its precursor left it, and not neutral air at rest on the earth.

use crate::case::{Blockage, Case, Ground};
use crate::plan::{MAXIMUM_LATTICE_SPEED, Plan};
use flow::inflow::{MeanColumn, MeanProfile};
use flow::lattice::atmosphere::{Atmosphere, Damping};
use thiserror::Error;

/// Share of a domain's height above which waves are damped, where the precursor's damping begins above the
/// domain (–).
const DAMPED_ABOVE: f64 = 0.75;
/// Least depth of the layer in which waves are damped, in cells (–).
const LEAST_DAMPED: f64 = 4.0;
/// Mean speed at hub height over `wind.speed`, less one, beyond which a reader must know (–), and room above
/// the fastest free stream of a plan that it may take (–).
const SPEED_TO_WARN: f64 = 0.05;
const SLACK: f64 = 0.02;

/// An atmosphere with its mean over height, in the frame of the planes that were taken out of it: x along the
/// mean wind at hub height, y to the left.
#[derive(Clone, Debug, PartialEq)]
pub struct Surroundings {
    pub(crate) column: MeanColumn,
    /// What of the air does not hang on the domain; the profile of temperature is that of the column.
    pub(crate) atmosphere: Atmosphere,
    pub(crate) roughness_length: f64,
    /// Length and width of the precursor's box (m).
    pub(crate) extent: [f64; 2],
    /// Height of the precursor's box (m), top of its inversion at the start (m), and where it damps waves (m)
    /// at which rate (1/s).
    pub(crate) height: f64,
    pub(crate) inversion_top: f64,
    pub(crate) damping: Damping,
}

/// Why a study cannot stand in the atmosphere of a precursor.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SurroundingsError {
    /// The ground is another.
    #[error(
        "the precursor's air blew over a ground of z₀ = {roughness_length} m: write flow.ground = {{ roughness_length = {roughness_length} }}"
    )]
    Ground {
        /// Roughness length of the precursor's (m).
        roughness_length: f64,
    },
    /// It blows faster than the lattice carries.
    #[error(
        "the precursor's air blows with {found:.2} m/s at hub height, {lattice:.3} cells per step, and {MAXIMUM_LATTICE_SPEED} are the most: write wind.speed = {found:.2}, which the step is made for, or lower flow.step"
    )]
    Fast {
        /// Mean speed at hub height (m/s).
        found: f64,
        /// The same in cells per step (–).
        lattice: f64,
    },
    /// A correction that is not made of what goes on beside the study.
    #[error(
        "= \"corrected\" scales the wind that blows in, and the air of a precursor beside the study comes in as it is: leave it out, or take wind.precursor_wind = \"planes\""
    )]
    Blockage,
    /// The domain is higher than what is known of the air.
    #[error(
        "the domain is {domain:.0} m high and the precursor's box {box_height:.0} m: lower flow.height_diameters to {fitting:.2}, or make a higher precursor"
    )]
    High {
        /// Height of the domain (m).
        domain: f64,
        /// Height of the precursor's box (m).
        box_height: f64,
        /// What fits (diameters of the first turbine).
        fitting: f64,
    },
}

impl SurroundingsError {
    /// The key that it is about.
    pub fn key(&self) -> [&'static str; 2] {
        match self {
            Self::Ground { .. } => ["flow", "ground"],
            Self::Fast { .. } => ["wind", "speed"],
            Self::Blockage => ["flow", "blockage"],
            Self::High { .. } => ["flow", "height_diameters"],
        }
    }
}

impl Surroundings {
    /// Mean wind and temperature over height.
    pub fn column(&self) -> &MeanColumn {
        &self.column
    }

    /// The wind of `case` below the lowest row of planes: the logarithmic law of the precursor's ground.
    pub(super) fn profile_at_ground(&self, case: &Case, plan: &Plan) -> MeanProfile {
        let (hub_height, speed) = (plan.hub_height, case.wind.speed);
        MeanProfile::LogLaw { hub_height, speed, roughness_length: self.roughness_length }
    }

    /// The atmosphere of the domain of `plan`.
    pub(crate) fn atmosphere(&self, plan: &Plan) -> Atmosphere {
        Atmosphere {
            damping: self.damping(height_of(plan), plan.spacing),
            ..self.atmosphere.clone()
        }
    }

    /// Where waves are damped in a domain of `height` (m) and cells of `spacing` (m): as in the precursor, or
    /// in its highest quarter, but not below the inversion; none where that leaves no room.
    pub(crate) fn damping(&self, height: f64, spacing: f64) -> Option<Damping> {
        let from = self.damping.from.min((DAMPED_ABOVE * height).max(self.inversion_top));
        let has_room = height - from >= LEAST_DAMPED * spacing;
        has_room.then_some(Damping { from, ..self.damping })
    }

    /// Mean speed at `height` (m/s).
    pub fn speed_at(&self, height: f64) -> f64 {
        let [along, across] = self.column.at(height).wind;
        along.hypot(across)
    }

    /// Whether the domain of `case`, laid out as `plan`, can stand in it.
    ///
    /// # Errors
    /// [`SurroundingsError`] says what does not fit.
    pub fn check(&self, case: &Case, plan: &Plan) -> Result<(), SurroundingsError> {
        let roughness_length = self.roughness_length;
        if case.flow.domain().ground != (Ground::Rough { roughness_length }) {
            return Err(SurroundingsError::Ground { roughness_length });
        }
        if case.wind.precursor_beside && case.flow.domain().blockage == Blockage::Corrected {
            return Err(SurroundingsError::Blockage);
        }
        let found = self.speed_at(plan.hub_height);
        let lattice = found * plan.base_interval() / plan.spacing;
        if lattice > MAXIMUM_LATTICE_SPEED * (1.0 + SLACK) {
            return Err(SurroundingsError::Fast { found, lattice });
        }
        let domain = height_of(plan);
        if domain > self.height + plan.spacing {
            let fitting = (100.0 * self.height / plan.diameter).floor() / 100.0;
            return Err(SurroundingsError::High { domain, box_height: self.height, fitting });
        }
        Ok(())
    }

    /// What a reader of the numbers must know of it in the domain of `plan`.
    pub fn warnings(&self, case: &Case, plan: &Plan) -> Vec<String> {
        let height = height_of(plan);
        let [length, width] = [0, 1].map(|axis| plan.n_cells[axis] as f64 * plan.spacing);
        let least = self.extent[0].min(self.extent[1]);
        let small = (case.wind.precursor_beside && length.max(width) > least).then(|| {
            format!(
                "the domain is {length:.0} m by {width:.0} m, and the precursor's box {:.0} m by {:.0} m: what comes in at places as far apart as the box meets the same eddies",
                self.extent[0], self.extent[1]
            )
        });
        let open = self.damping(height, plan.spacing).is_none().then(|| {
            format!(
                "the domain ends {height:.0} m above the ground, and the inversion reaches up to {:.0} m: waves on it come back from the top undamped; raise flow.height_diameters",
                self.inversion_top
            )
        });
        let (found, speed) = (self.speed_at(plan.hub_height), case.wind.speed);
        // Of planes their own mean is told.
        let is_other = case.wind.precursor_beside && (found / speed - 1.0).abs() > SPEED_TO_WARN;
        let other = is_other.then(|| {
            format!(
                "wind.precursor blows with {found:.2} m/s at hub height, and wind.speed = {speed} m/s: Strouhal numbers, the step and the rotors' first speeds are those of wind.speed"
            )
        });
        open.into_iter().chain(small).chain(other).collect()
    }
}

/// Height of the domain of `plan` (m).
fn height_of(plan: &Plan) -> f64 {
    plan.n_cells[2] as f64 * plan.spacing
}
