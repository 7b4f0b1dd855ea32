//! What a run leaves behind, as plain data that every desk can read.

mod control;
pub mod examples;
mod fields;
mod filaments;
mod flow;
mod load;
mod sweep;
mod warning;

pub use control::{ControlSetting, ControlSummary, Finding, PitchExcitation, SettingValue};
pub use fields::{
    Field, FieldSetting, Grid, Moments, PhaseAverages, PhaseBin, STRESSES, stress_of,
};
pub use filaments::{Filaments, Piece, PieceKind};
pub use flow::{FlowSummary, GridSummary, Sector};
pub use load::{Load, LoadKind};
use serde::{Deserialize, Serialize};
pub use sweep::{
    SWEEP_SCHEMA_VERSION, Setting, Sweep, SweepLoad, SweepPart, SweepRow, SweepTable, SweptKey,
    SweptRun, SweptStudy, SweptValue, WindGain,
};
pub use warning::{Warning, WarningKind};

/// Version of the layout of [`Summary`]; raised when a field changes its name, its place or its meaning.
///
/// 2: loads, control and warnings are typed, where they were sentences; the wind is given as target and
/// realised. 3: a pitch response has its kind in it, where that was a key; bearing loads have their
/// positions.
pub const SCHEMA_VERSION: u32 = 3;

/// Mean of a quantity over the analysed time, with what is known of its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Mean, in the quantity's unit.
    pub mean: f64,
    /// Standard deviation of the samples, in the quantity's unit.
    pub standard_deviation: f64,
    /// Half width of the 95 % interval of the mean from block means, in the quantity's unit; absent with
    /// fewer than two blocks.
    pub half_width_95: Option<f64>,
    /// Number of blocks behind the interval.
    pub n_blocks: usize,
}

/// Blade pitch as the actuator delivered it, beside what was commanded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeliveredPitch {
    /// Amplitude of the commanded excitation line (deg).
    pub commanded_amplitude_deg: f64,
    /// Amplitude of the strongest line of blade 1's pitch (deg).
    pub delivered_amplitude_deg: f64,
    /// Its frequency (Hz).
    pub frequency_hz: f64,
    /// Excitation frequency in the fixed frame recovered from the delivered pitch (Hz).
    pub excitation_frequency_hz: f64,
    /// Share of control instants at which a pitch limit held a command back (–).
    pub clipped_share: f64,
}

/// What pitching did to blade 1: how far its actuator went, and the load on its bearing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PitchDuty {
    /// Sum of all motion, whichever way (deg).
    pub travel_deg: f64,
    /// The same in ten minutes (deg).
    pub travel_in_ten_minutes_deg: f64,
    /// Fastest motion between two rows of the series (deg/s).
    pub maximum_rate_deg_s: f64,
    /// Share of the time in which pitch moved at all (–).
    pub moving_share: f64,
    /// Changes of direction (–).
    pub n_reversals: usize,
    /// Slope of the bearing loads (–).
    pub bearing_slope: f64,
    /// Equivalent moment of the pitch bearing at equally spaced positions all round its ring.
    pub bearing_loads: Vec<BearingLoad>,
    /// Time between the samples of pitch and moments that these figures are made of (s).
    pub sample_interval: f64,
}

/// Load of a pitch bearing at one position of its ring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BearingLoad {
    /// Angle from the direction of the flapwise moment towards that of the edgewise one (deg).
    pub position_deg: f64,
    /// Equivalent moment (kN m).
    pub load_kn_m: f64,
}

impl PitchDuty {
    /// The greatest of the bearing loads.
    pub fn worst_bearing_load(&self) -> Option<BearingLoad> {
        // The first of equal ones.
        let loads = self.bearing_loads.iter().copied().rev();
        loads.max_by(|a, b| a.load_kn_m.total_cmp(&b.load_kn_m))
    }
}

/// How a turbine's own pitch acts, as its controller is given it before the run: identified, or set in the
/// case file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum PitchResponse {
    /// In the estimator's model of the turbine's own pitch.
    Estimator {
        /// Factor on tilt and yaw of the pitch (–).
        gain: f64,
        /// Angle by which a blade runs ahead of its pitch (rad).
        azimuth_offset: f64,
        /// Amplitude of the helix that was found where there was none, before (m/s).
        before: f64,
        /// The same after (m/s).
        after: f64,
        /// Azimuth offset of the inverse multi-blade transformation with which it pitches (rad); absent in
        /// records that do not tell.
        #[serde(default)]
        transformation_offset: Option<f64>,
    },
    /// Where what finds the helix is not calibrated, in the inverse multi-blade transformation alone.
    Transformation {
        /// Its azimuth offset (rad).
        azimuth_offset: f64,
    },
    /// Under individual pitch control, in its inverse multi-blade transformation.
    IndividualPitch {
        /// Its azimuth offset (rad).
        azimuth_offset: f64,
    },
    /// On the tilt and yaw moments of the blades.
    Loads {
        /// Azimuth offset of the inverse multi-blade transformation (rad).
        azimuth_offset: f64,
        /// Time by which commands run ahead (s).
        delay: f64,
        /// Moment lost per pitch (N m/rad).
        gain: f64,
    },
}

/// The slow oscillation of one of a rotor's moments, correlated with the phase that a turbine estimated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeanderingAxis {
    /// Amplitude of the moment's part in phase with the estimated phase, the effect of pitch included (N m).
    pub amplitude: f64,
    /// Mean amplitude that the turbine took for the baseline's (N m); absent while it knew none.
    pub reference: Option<f64>,
    /// The first over the second: the factor reached (–).
    pub factor: Option<f64>,
}

/// What a turbine that follows meandering found in its loads, and what became of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeanderingSummary {
    /// Share of the time in which its phase-locked loop was locked (–).
    pub locked_share: f64,
    /// Mean estimated frequency while locked (Hz); absent where it never was.
    pub frequency_hz: Option<f64>,
    /// Tilt moment while locked, from the start of control on; absent where that makes less than two periods.
    pub tilt: Option<MeanderingAxis>,
    /// Yaw moment, likewise.
    pub yaw: Option<MeanderingAxis>,
}

/// A rotor in its place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotor {
    /// Its diameter (m).
    pub diameter: f64,
    /// Where its hub is: hub height above the foot of the tower (m, farm frame).
    pub hub: [f64; 3],
    /// Mean turn of its nacelle from facing along x, counter-clockwise seen from above (deg); zero in
    /// records that do not tell.
    #[serde(default)]
    pub yaw_deg: f64,
}

/// One turbine over one run's analysed time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TurbineSummary {
    /// Name in the case file.
    pub name: String,
    /// Turbine model.
    pub model: String,
    /// Its rotor in its place; absent in records that do not tell.
    #[serde(default)]
    pub rotor: Option<Rotor>,
    /// What controlled it.
    pub control: ControlSummary,
    /// Electrical power (W).
    pub power: Statistic,
    /// Thrust (N).
    pub thrust: Statistic,
    /// Rotor speed (rad/s).
    pub rotor_speed: Statistic,
    /// Collective pitch (rad).
    pub pitch: Statistic,
    /// The wind that comes to each quarter of its rotor; none unless it comes from a part of a record.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sectors: Vec<Sector>,
    /// Mean turn of its nacelle from facing that wind, of its mean over the whole rotor, counter-clockwise
    /// seen from above (deg); absent likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub yaw_misalignment_deg: Option<f64>,
    /// Delivered excitation; absent on a turbine without one.
    pub delivered_pitch: Option<DeliveredPitch>,
    /// Power relative to the same turbine in the compared run, minus one (–).
    pub power_gain: Option<Statistic>,
    /// How its own pitch acts; absent where its controller need not know.
    pub pitch_response: Option<PitchResponse>,
    /// Azimuth offset with which its individual pitch control works (rad); absent where there is no such
    /// control.
    pub individual_pitch_offset: Option<f64>,
    /// What it found of meandering and made of it; absent on a turbine that does not follow any.
    pub meandering: Option<MeanderingSummary>,
    /// Standard deviations and damage-equivalent loads of its moments, by channel.
    pub loads: Vec<Load>,
    /// Travel and bearing load of blade 1's pitch; absent where the series does not hold its root moments.
    pub pitch_duty: Option<PitchDuty>,
}

impl TurbineSummary {
    /// The standard deviation of `channel`.
    pub fn deviation(&self, channel: &str) -> Option<&Load> {
        self.loads.iter().find(|load| load.channel == channel && load.kind == LoadKind::Deviation)
    }

    /// The damage-equivalent load of `channel`.
    pub fn damage_equivalent(&self, channel: &str) -> Option<&Load> {
        self.loads.iter().find(|load| load.channel == channel && load.kind.is_damage_equivalent())
    }
}

/// What a run cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Wall time of the run (s).
    pub wall_time: f64,
    /// Cells of the flow, of all grids (–).
    pub n_cells: u64,
    /// Flow steps, of the finest cells (–).
    pub n_steps: u64,
    /// Cell updates per second, everything included (1/s).
    pub updates_per_second: f64,
    /// Threads (–).
    pub n_threads: usize,
    /// Memory of the flow field (bytes).
    pub memory: u64,
    /// Most that the program's process held at once until the run's numbers were made, runs before it in the
    /// same process included (bytes); of a run that was resumed the most of any of its processes. Absent
    /// where the system does not report it.
    pub peak_memory: Option<u64>,
}

/// The wind, as the case sets it and as the flow realised it, and how it was simulated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// Free-stream speed at hub height of the first turbine that the case sets (m/s).
    pub target_wind_speed: f64,
    /// Where the mean wind comes from, clockwise from north (deg); from the west in records that do not tell.
    #[serde(default = "from_west")]
    pub direction_deg: f64,
    /// Turbulence intensity that the case sets (–).
    pub target_turbulence_intensity: f64,
    /// Length scale of the turbulence's tensor (m); absent where the turbulence has none.
    #[serde(default)]
    pub turbulence_length_scale: Option<f64>,
    /// Mean speed at hub height upstream of the first turbine (m/s).
    pub realised_wind_speed: f64,
    /// Turbulence intensity there (–).
    pub realised_turbulence_intensity: f64,
    /// Power-law exponent of the mean profile (–); absent where that is logarithmic.
    pub shear_exponent: Option<f64>,
    /// Roughness length of the logarithmic mean profile (m); absent where that is a power law.
    pub roughness_length: Option<f64>,
    /// Seed of the turbulence.
    pub seed: u64,
    /// Rotor diameter of the first turbine (m).
    pub rotor_diameter: f64,
    /// Cells per diameter of the first turbine, of those that it stands in (–); absent where the wind is
    /// prescribed.
    pub cells_per_diameter: Option<f64>,
    /// Flow step, of the finest cells (s).
    pub interval: f64,
    /// Time before the analysis starts (s).
    pub spin_up: f64,
    /// Total simulated time (s).
    pub duration: f64,
}

/// Direction of the wind in records that do not tell (deg).
fn from_west() -> f64 {
    270.0
}

/// One run in numbers; `summary.json` is this, written out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// [`SCHEMA_VERSION`] of the writer.
    pub schema_version: u32,
    /// Name of the case.
    pub case: String,
    /// Name of the run.
    pub run: String,
    /// Run that the gains compare with.
    pub compare_with: Option<String>,
    /// The wind.
    pub conditions: Conditions,
    /// What moved the air; absent in records that do not tell.
    #[serde(default)]
    pub flow: Option<FlowSummary>,
    /// The turbines, in the case file's order.
    pub turbines: Vec<TurbineSummary>,
    /// Electrical power of all turbines together (W).
    pub array_power: Statistic,
    /// Its gain over the compared run (–).
    pub array_power_gain: Option<Statistic>,
    /// What it cost.
    pub cost: Cost,
    /// Warnings that a reader of the numbers must see.
    pub warnings: Vec<Warning>,
}

impl Summary {
    /// Whether turbines felt one another's wakes; where the record does not tell, whether the air had cells.
    pub fn has_wakes(&self) -> bool {
        let has_cells = self.conditions.cells_per_diameter.is_some();
        self.flow.as_ref().map_or(has_cells, |flow| flow.has_wakes)
    }
}

/// Equally spaced samples of many channels, those of `series.csv`, in SI units whatever that file's are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Names of the [channels](crate::channels), without units: `Time`, `T1.GenPwr`, `T1.BldPitch1`, ….
    pub names: Vec<String>,
    /// One column per name, all of one length.
    pub columns: Vec<Vec<f64>>,
}

impl Series {
    /// The samples of the channel called `name`, in SI units.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.names.iter().position(|n| n == name).map(|index| self.columns[index].as_slice())
    }
}

/// Which two farm axes a plane spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PlaneAxes {
    /// Horizontal: first axis x, second y.
    Horizontal,
    /// Vertical along the wind: first axis x, second z.
    Streamwise,
    /// Across the wind: first axis y, second z.
    Crosswind,
}

/// Velocity on a regular plane, at one instant or averaged.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// Name, such as `hub-height` or `T2-crosswind` or `2D`.
    pub name: String,
    /// Axes that it spans.
    pub axes: PlaneAxes,
    /// Position of its first point, farm frame (m).
    pub origin: [f64; 3],
    /// Distance of neighbouring points along the two axes (m).
    pub spacing: [f64; 2],
    /// Points along the two axes (–).
    pub n_points: [usize; 2],
    /// Instant (s), or the end of the averaging.
    pub time: f64,
    /// Averaged time before `time` (s); 0 for an instant.
    pub averaged: f64,
    /// Velocity components u, v, w (m/s), each `n_points[1] × n_points[0]`, first axis fastest.
    pub velocity: [Vec<f32>; 3],
}
