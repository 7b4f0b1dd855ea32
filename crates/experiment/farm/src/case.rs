//! One study as plain data: what the case file says, in SI units.

pub use crate::domain::{Blockage, Domain, Ground, Method, Sides};
pub use crate::event::{CirclingDisk, WindEvent};
pub use crate::layout::{FROM_WEST, Position};
pub use crate::made_grid::MadeGrid;
pub use crate::outputs::Requested;
pub use crate::solvers::{Solver, WindSource};
pub use control::{Control, Sense};
pub use flow::inflow::deterministic::Change;
pub use flow::inflow::{Cut, recorded::Beyond};
pub use sensing::{Instrument, Instruments, Lag, Mounted};

use crate::layout;
use basis::keys::Values;
use serde::{Deserialize, Serialize};

/// A study: one wind, one row of turbines, several runs to compare.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Name of the study.
    pub name: String,
    /// What it is for, in one line.
    pub description: Option<String>,
    /// The incoming wind.
    pub wind: Wind,
    /// The flow solver.
    pub flow: Flow,
    /// Time.
    pub time: Time,
    /// The turbines, first upstream.
    pub turbines: Vec<Placement>,
    /// The runs, all in the same inflow.
    pub runs: Vec<Run>,
    /// What is kept.
    pub output: Output,
}

/// The incoming wind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wind {
    /// Mean speed at hub height of the first turbine (m/s).
    pub speed: f64,
    /// Where the mean wind comes from on the map (rad, clockwise from north); [`FROM_WEST`] blows to the
    /// east. The wind's frame follows it, see [`Case::places`].
    pub direction: f64,
    /// Turbulence intensity, standard deviation of the streamwise component over `speed` (–).
    pub turbulence_intensity: f64,
    /// How the mean speed grows with height.
    pub shear: Shear,
    /// Length scale of Mann's tensor (m); absent, it follows from the rest
    /// (`wind::length_scale`).
    pub length_scale: Option<f64>,
    /// Anisotropy Γ of Mann's tensor (–).
    pub anisotropy: f64,
    /// Seed of the turbulence.
    pub seed: u64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Kinematic viscosity of air (m²/s).
    pub kinematic_viscosity: f64,
    /// Which turbulence is made, where it is made and not read.
    pub turbulence_model: TurbulenceModel,
    /// The points on which turbulence is made around the rotors; absent, they follow from the rotors.
    pub grid: Option<MadeGrid>,
    /// File with the planes of wind that [`Solver::PLANES`] reads, or that enter at the inlet of a domain,
    /// relative to the case file.
    pub planes: Option<String>,
    /// Folder of a precursor whose planes enter at the inlet of a domain, with their temperature, and whose
    /// atmosphere the air of the domain is; relative to the case file.
    pub precursor: Option<String>,
    /// Whether that precursor goes on beside each run, from where it stands, and its air enters in place of
    /// its planes.
    pub precursor_beside: bool,
    /// What blows where a domain is larger than the grid of these planes, where the case says so.
    pub beyond_planes: Option<Beyond>,
    /// What is taken of the planes of a file; all of it when absent.
    pub cut: Option<Cut>,
    /// File with the wind over time for a solver of deterministic wind, relative to the case file.
    pub table: Option<String>,
    /// Veer (rad/m): the mean wind turns clockwise, seen from above, by so much per metre upwards; zero at
    /// hub height.
    pub veer: f64,
    /// What happens in time, in deterministic wind; nothing when absent.
    pub event: Option<WindEvent>,
}

impl Wind {
    /// Whether it comes from a file or a precursor, rather than being made.
    pub fn is_brought(&self) -> bool {
        self.planes.is_some() || self.precursor.is_some()
    }

    /// Whether it comes from recorded planes, of a file or of a precursor.
    pub fn brings_planes(&self) -> bool {
        self.is_brought() && !self.precursor_beside
    }

    /// Whether it changes in time: it is turbulent, something happens in it, or a file says what.
    pub fn varies(&self) -> bool {
        self.turbulence_intensity > 0.0
            || self.event.is_some()
            || self.table.is_some()
            || self.is_brought()
    }

    /// Where the mean wind comes from, for records and readers (deg, clockwise from north).
    pub fn direction_deg(&self) -> f64 {
        // Without what the change of units leaves at its end.
        (1e9 * self.direction.to_degrees()).round() / 1e9
    }
}

/// How the mean speed grows with height; it meets [`Wind::speed`] at hub height of the first turbine.
///
/// [`MeanProfile`](flow::inflow::MeanProfile) gives the equations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shear {
    /// Power law.
    PowerLaw {
        /// Exponent (–).
        exponent: f64,
    },
    /// Logarithmic law, calm at and below the roughness length.
    LogLaw {
        /// Roughness length z₀ (m).
        roughness_length: f64,
    },
}

/// How turbulence is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TurbulenceModel {
    /// Mann's spectral tensor, free of divergence.
    Mann,
    /// Kaimal's spectra with the exponential coherence of IEC 61400-1, for prescribed wind only.
    Kaimal,
}

/// The flow solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    /// What moves the air.
    pub solver: Solver,
    /// What the keys of `[flow]` hold that the solver's kind [declares](crate::solvers::SolverKind::keys);
    /// in the units of the file.
    pub values: Values,
    /// Step of air and turbines (s); when absent chosen from the tip speed and the Mach number for the
    /// lattice, and [`PRESCRIBED_STEP`](crate::plan::PRESCRIBED_STEP) for prescribed wind.
    pub step: Option<f64>,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
}

impl Flow {
    /// What they say of the box of cells, for solvers that have its [keys](crate::domain::KEYS).
    pub fn domain(&self) -> Domain {
        Domain::of(&self.values)
    }
}

/// Time of every run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Not analysed, wakes develop (s).
    pub spin_up: f64,
    /// In all, spin-up included (s).
    pub duration: f64,
    /// Length of the blocks whose means are taken as independent (s).
    pub block: f64,
}

/// One turbine in the layout.
#[derive(Clone, Debug, PartialEq)]
pub struct Placement {
    /// Name, such as `T1`.
    pub name: String,
    /// Turbine model in the library, or a path to a turbine file.
    pub model: String,
    /// Path to a ROSCO input file (DISCON.IN) with the constants of its controller; the model's own when
    /// absent.
    pub discon: Option<String>,
    /// Torque over rotor speed squared below rated (N m s²), on the rotor's side; the model's own when
    /// absent.
    pub torque_gain: Option<f64>,
    /// Foot of the tower on the map.
    pub position: Position,
    /// Turn of the nacelle from facing the mean wind when time begins, counter-clockwise seen from above
    /// (rad).
    pub yaw: f64,
    /// Error with which each blade's pitch is mounted, positive to feather (rad); empty where there is none.
    pub pitch_misalignment: Vec<f64>,
    /// Whether blades, tower and drive train bend.
    pub flexible: bool,
    /// Longest step of the structure (s); that of the turbine when absent.
    pub structure_step: Option<f64>,
    /// Whether flow about the blades' sections separates with delay; otherwise their polars hold at once.
    pub dynamic_stall: bool,
    /// How its induction follows its loads, where the wind is prescribed.
    pub dynamic_inflow: DynamicInflow,
    /// What its tower does to the wind that its blades meet, where the wind is prescribed.
    pub tower_influence: TowerInfluence,
    /// What its controller sees of it.
    pub instruments: Instruments,
    /// Further sensors, whose readings its controller sees by their names.
    pub sensors: Vec<Mounted>,
}

impl Placement {
    /// Name of what stands there: the model, and what its controller has of its own. Turbines of one name are
    /// alike, machine and controller.
    pub fn machine(&self) -> String {
        match (&self.discon, self.torque_gain) {
            (Some(discon), _) => format!("{} under {discon}", self.model),
            (None, Some(gain)) => format!("{} with a torque of {gain:?} N m s²", self.model),
            (None, None) => self.model.clone(),
        }
    }
}

/// How a rotor's induction follows its loads; [`turbine::aero::induction`] gives the equations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum DynamicInflow {
    /// At once.
    None,
    /// With two time constants, after Øye.
    TwoConstant {
        /// The slow one, τ₁ (s); it follows wind and induction when absent.
        slow_constant: Option<f64>,
    },
    /// With the inertia of the air, after Snel and Schepers.
    SnelSchepers,
}

impl Default for DynamicInflow {
    fn default() -> Self {
        Self::TwoConstant { slow_constant: None }
    }
}

/// What a tower does to the wind past it; [`turbine::aero::tower_influence`] gives the equations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum TowerInfluence {
    /// Nothing.
    #[default]
    None,
    /// The wind parts about it as about a cylinder.
    Potential,
    /// As `Potential`, and its drag slows the wind ahead, after Bak.
    PotentialWithDrag,
    /// As `Potential`, and the wind is slow behind it, after Powles.
    PotentialAndShadow,
}

/// One run: who does what.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Name of the run.
    pub name: String,
    /// Run that its gains compare with; the first run when absent (the first compares with none).
    pub compare_with: Option<String>,
    /// What runs on each turbine, in the order of [`Case::turbines`].
    pub control: Vec<Control>,
}

impl Run {
    /// Places in [`Case::turbines`] of the turbines that are there in this run, in order: the farm's
    /// machines.
    pub fn present(&self) -> impl Iterator<Item = usize> + '_ {
        let is_there = |(index, control): (usize, &Control)| control.is_there().then_some(index);
        self.control.iter().enumerate().filter_map(is_there)
    }
}

/// Feet of the towers of `turbines` in the frame of wind from `direction` (rad, clockwise from north), in the
/// layout's own unit: x downwind, y to the left.
pub fn places(turbines: &[Placement], direction: f64) -> Vec<[f64; 2]> {
    let positions: Vec<Position> = turbines.iter().map(|turbine| turbine.position).collect();
    layout::places(&positions, direction)
}

impl Case {
    /// Which wind its air takes in.
    pub fn wind_source(&self) -> WindSource {
        self.flow.solver.wind.of(&self.wind)
    }

    /// Feet of the towers in the wind's frame, in the layout's own unit: x downwind, y to the left.
    pub fn places(&self) -> Vec<[f64; 2]> {
        places(&self.turbines, self.wind.direction)
    }

    /// The same (m); `diameter` (m) is that of the first turbine.
    pub fn feet(&self, diameter: f64) -> Vec<[f64; 2]> {
        let units = self.turbines.iter().map(|turbine| turbine.position.unit(diameter));
        let places = self.places().into_iter().zip(units);
        places.map(|(place, unit)| place.map(|length| length * unit)).collect()
    }

    /// The same in diameters of the first turbine, whose is `diameter` (m).
    pub fn places_in_diameters(&self, diameter: f64) -> Vec<[f64; 2]> {
        let places = self.places().into_iter().zip(&self.turbines);
        places
            .map(|(place, turbine)| match turbine.position {
                Position::Diameters(_) => place,
                Position::Metres(_) => place.map(|length| length / diameter),
            })
            .collect()
    }

    /// Sense and Strouhal number of the helix furthest upstream in `run`.
    pub fn first_helix(&self, run: &Run) -> Option<(Sense, f64)> {
        let places = self.places();
        let x = |index: usize| places[index][0];
        let helices = run.control.iter().enumerate();
        let helices = helices.filter_map(|(index, control)| Some((x(index), control.helix()?)));
        helices.min_by(|a, b| a.0.total_cmp(&b.0)).map(|found| found.1)
    }
}

/// Sense and Strouhal number of the helix on the nearest turbine upstream of turbine `index` that has one
/// under `controls`; `places` are those of the turbines in the wind's frame.
pub fn helix_upstream(
    index: usize,
    places: &[[f64; 2]],
    controls: &[Control],
) -> Option<(Sense, f64)> {
    let x = |index: usize| places[index][0];
    (0..places.len())
        .filter(|&other| x(other) < x(index))
        .filter_map(|other| Some((x(other), controls[other].helix()?)))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|found| found.1)
}

/// What is kept of a run, beside series and summary.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Time between rows of the series (s); when absent every step of a lattice and
    /// [`PRESCRIBED_ROW`](crate::plan::PRESCRIBED_ROW) of prescribed wind.
    pub interval: Option<f64>,
    /// Time between instantaneous hub-height and crosswind planes (s); none when absent.
    pub plane_interval: Option<f64>,
    /// Crosswind planes at these distances behind the first turbine (diameters).
    pub crosswind_diameters: Vec<f64>,
    /// Phases of the first helix in the row by which the hub-height plane is averaged (–); none when absent.
    pub helix_phases: Option<usize>,
    /// Places in [`Case::turbines`] of the turbines where runs without them keep the wind along radial lines
    /// over the disc.
    pub lines_at: Vec<usize>,
    /// Places in [`Case::turbines`] of the turbines where runs without them record the wind over the rotor.
    pub inflow_at: Vec<usize>,
    /// Time between volume snapshots, VTK (s); none when absent.
    pub volume_interval: Option<f64>,
    /// Every so many cells along each axis are in a volume (–).
    pub volume_stride: usize,
    /// Time between snapshots of the vortices of wakes, VTK (s); those of the last instant alone when absent.
    pub filament_interval: Option<f64>,
    /// Whether the scans of lidars are kept.
    pub keeps_scans: bool,
    /// Checkpoint every so many seconds of wall time (s).
    pub checkpoint_interval: f64,
    /// Whether the checkpoint at the end of a run stays, from which it can go on for longer.
    pub keeps_checkpoint: bool,
    /// Further outputs, each with a name of its own.
    pub further: Vec<Requested>,
}
