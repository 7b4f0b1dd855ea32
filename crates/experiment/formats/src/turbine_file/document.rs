//! The file as it is written: one struct per group, units in the keys where they are not SI.

use super::operation::Operation;
use super::swashplate::Swashplate;
use serde::{Deserialize, Serialize};

/// A turbine file. Groups may be missing while a turbine is being put together; [`super::parse`] asks for
/// all.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Document {
    /// Short name, as in `iea-15mw`.
    pub name: String,
    /// Name in words.
    pub title: String,
    /// Blades (–).
    pub n_blades: usize,
    /// Where the rotor stands.
    pub rotor: Option<Rotor>,
    /// Outer shape of the blades.
    pub blade: Option<Blade>,
    /// Mass, stiffness and modes of the blades.
    pub blade_structure: Option<BladeStructure>,
    /// The tower.
    pub tower: Option<Tower>,
    /// The hub.
    pub hub: Option<Hub>,
    /// The nacelle.
    pub nacelle: Option<Nacelle>,
    /// Gearbox, shaft, generator.
    pub drive_train: Option<DriveTrain>,
    /// Pitch actuators.
    pub pitch_actuator: Option<PitchActuator>,
    /// Between which mean wind speeds it works; not every source tells.
    pub operation: Option<Operation>,
    /// Constants of torque and pitch control.
    pub controller: Option<Controller>,
    /// Polars.
    pub airfoils: Option<Airfoils>,
}

/// Where the rotor stands; positive precone, tilt and overhang carry the tips away from the tower.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotor {
    /// Where the figures come from.
    pub source: String,
    /// Rotor apex to blade root (m).
    pub hub_radius: f64,
    /// Rotor apex to blade tip along the pitch axis (m).
    pub tip_radius: f64,
    /// Cone of the pitch axes (deg).
    pub precone_deg: f64,
    /// Tilt of the shaft (deg).
    pub shaft_tilt_deg: f64,
    /// Yaw axis to rotor apex along the shaft (m).
    pub overhang: f64,
    /// Rotor apex above ground or mean sea level (m).
    pub hub_height: f64,
}

/// Outer shape of a blade.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blade {
    /// Where the figures come from.
    pub source: String,
    /// Stations, root to tip.
    pub stations: Vec<Station>,
}

/// Span from the root (m), chord (m), twist (deg), prebend upwind (m), sweep aft (m), name of the polar.
pub type Station = (f64, f64, f64, f64, f64, String);

/// Mass, stiffness and modes of a blade.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BladeStructure {
    /// Where the figures come from.
    pub source: String,
    /// Span from the root (m), twist (deg), mass (kg/m), flap and edge stiffness (N m²), root to tip.
    pub sections: Vec<[f64; 5]>,
    /// First flapwise mode.
    pub flap_mode_1: Mode,
    /// Second flapwise mode.
    pub flap_mode_2: Mode,
    /// First edgewise mode.
    pub edge_mode_1: Mode,
}

/// Shape of a bending mode.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Coefficients of x² to x⁶ (–), sum one.
    pub coefficients: [f64; 5],
    /// Share of critical damping (–).
    pub damping_ratio: f64,
}

/// The tower.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tower {
    /// Where the figures come from.
    pub source: String,
    /// Clamped foot above ground or mean sea level (m).
    pub base_height: f64,
    /// Yaw bearing above ground or mean sea level (m).
    pub top_height: f64,
    /// Yaw bearing to shaft on the yaw axis (m).
    pub top_to_shaft: f64,
    /// Height (m), diameter (m), drag coefficient (–), bottom to top.
    pub profile: Vec<[f64; 3]>,
    /// Height (m), mass (kg/m), fore-aft and side-to-side stiffness (N m²), bottom to top.
    pub sections: Vec<[f64; 4]>,
    /// First fore-aft mode.
    pub fore_aft_mode_1: Mode,
    /// Second fore-aft mode.
    pub fore_aft_mode_2: Mode,
    /// First side-to-side mode.
    pub side_to_side_mode_1: Mode,
    /// Second side-to-side mode.
    pub side_to_side_mode_2: Mode,
}

/// The hub.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hub {
    /// Where the figures come from.
    pub source: String,
    /// Mass (kg).
    pub mass: f64,
    /// Inertia about the shaft (kg m²).
    pub inertia: f64,
}

/// The nacelle.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nacelle {
    /// Where the figures come from.
    pub source: String,
    /// Mass (kg).
    pub mass: f64,
    /// Inertia about the yaw axis (kg m²).
    pub yaw_inertia: f64,
    /// From the tower top downwind, left looking downwind, up (m).
    pub center_of_mass: [f64; 3],
    /// Mass of the yaw bearing (kg).
    pub yaw_bearing_mass: f64,
}

/// Gearbox, shaft, generator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriveTrain {
    /// Where the figures come from.
    pub source: String,
    /// Generator speed over rotor speed (–).
    pub gear_ratio: f64,
    /// Generator inertia about its own shaft (kg m²).
    pub generator_inertia: f64,
    /// Efficiency of the gearbox (–).
    pub gearbox_efficiency: f64,
    /// Efficiency of the generator (–).
    pub generator_efficiency: f64,
    /// Torsional stiffness, low-speed side (N m/rad).
    pub stiffness: f64,
    /// Torsional damping, low-speed side (N m s/rad).
    pub damping: f64,
}

/// Pitch actuators.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PitchActuator {
    /// Where the figures come from.
    pub source: String,
    /// Natural frequency (rad/s).
    pub natural_frequency: f64,
    /// Damping ratio (–).
    pub damping_ratio: f64,
    /// Fastest the actuator turns a blade (deg/s).
    pub maximum_rate_deg_s: f64,
    /// Least pitch of the bearing (deg).
    pub minimum_pitch_deg: f64,
    /// Greatest pitch of the bearing (deg).
    pub maximum_pitch_deg: f64,
    /// A swashplate that pitches all blades; each has an actuator of its own without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub swashplate: Option<Swashplate>,
}

/// Constants of torque and pitch control, low-speed side; gains act on measured minus reference rotor speed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// Where the figures come from.
    pub source: String,
    /// Electrical power at rated (kW).
    pub rated_power_kw: f64,
    /// Rotor speed at rated (rpm).
    pub rated_rotor_speed_rpm: f64,
    /// Least rotor speed under torque control (rpm).
    pub minimum_rotor_speed_rpm: f64,
    /// Tip-speed ratio of greatest power (–).
    pub optimal_tip_speed_ratio: f64,
    /// Torque over rotor speed squared below rated (N m s²).
    pub torque_gain: f64,
    /// Generator torque at rated (N m).
    pub rated_torque: f64,
    /// Least generator torque (N m).
    pub minimum_torque: f64,
    /// Greatest generator torque (N m).
    pub maximum_torque: f64,
    /// Fastest change of generator torque (N m/s).
    pub maximum_torque_rate: f64,
    /// Constant power above rated, otherwise constant torque.
    pub constant_power: bool,
    /// Torque over speed error (N m s).
    pub torque_proportional: f64,
    /// Torque rate over speed error (N m).
    pub torque_integral: f64,
    /// Collective pitch below rated (deg).
    pub fine_pitch_deg: f64,
    /// Greatest collective pitch (deg).
    pub maximum_pitch_deg: f64,
    /// Fastest change of collective pitch (deg/s).
    pub maximum_pitch_rate_deg_s: f64,
    /// Wind speed (m/s), least collective pitch (deg); may be empty.
    pub minimum_pitch: Vec<[f64; 2]>,
    /// Pitch (deg), pitch over speed error (s), pitch rate over speed error (–).
    pub pitch_gains: Vec<[f64; 3]>,
    /// How torque and pitch control give way to each other.
    pub set_point_smoothing: SetPointSmoothing,
    /// Corner of the filter on rotor speed (rad/s).
    pub speed_filter_corner: f64,
    /// Damping ratio of that filter (–), then of second order; of first order without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_filter_damping: Option<f64>,
    /// Notch filters on rotor speed: frequency (rad/s), damping ratios of numerator and denominator (–).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub speed_notches: Vec<[f64; 3]>,
    /// How torque finds the greatest power; what suits the flow solver without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_control: Option<TorqueControl>,
    /// Corner of the filter on the estimated wind speed (rad/s); a period of half a minute without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind_speed_filter_corner: Option<f64>,
    /// Pitch against the motion of the tower.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tower_damping: Option<TowerDamping>,
    /// Pitch of each blade against tilt and yaw moment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub individual_pitch: Option<IndividualPitch>,
}

/// How torque finds the greatest power below rated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TorqueControl {
    /// `torque_gain` times rotor speed squared.
    KOmegaSquared,
    /// The speed that the estimated wind asks for.
    TipSpeedRatio,
}

impl TorqueControl {
    /// As the file says it.
    pub fn name(self) -> &'static str {
        match self {
            Self::KOmegaSquared => "k-omega-squared",
            Self::TipSpeedRatio => "tip-speed-ratio",
        }
    }
}

/// Collective pitch against the fore-aft motion of the tower top.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TowerDamping {
    /// Pitch over velocity (rad s/m).
    pub gain: f64,
    /// What is slower is left alone (rad/s).
    pub high_pass_corner: f64,
    /// Most that it adds or takes (deg).
    pub limit_deg: f64,
}

/// Individual pitch control at rotor frequency.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct IndividualPitch {
    /// Pitch over moment (rad/(N m)).
    pub proportional: f64,
    /// Pitch rate over moment (rad/(N m s)).
    pub integral: f64,
    /// Added to the azimuth on the way back to the blades (deg); found before the runs without.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub azimuth_offset_deg: Option<f64>,
    /// Greatest amplitude (deg).
    pub limit_deg: f64,
    /// Wind speeds (m/s) between which it is let in.
    pub ramp: [f64; 2],
    /// What the blades stay above.
    pub floor: PitchFloor,
}

/// What the blades stay above under individual pitch control.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PitchFloor {
    /// The actuators' limits alone.
    None,
    /// `fine_pitch_deg`.
    #[default]
    FinePitch,
    /// `minimum_pitch` at the estimated wind.
    MinimumPitch,
}

impl PitchFloor {
    /// As the file says it.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::FinePitch => "fine-pitch",
            Self::MinimumPitch => "minimum-pitch",
        }
    }
}

/// How torque and pitch control give way to each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SetPointSmoothing {
    /// Relative fall of the torque reference per pitch (1/rad).
    pub torque_shift: f64,
    /// Relative rise of the pitch reference per missing power (–).
    pub pitch_shift: f64,
    /// Corner of the filter on the shift (rad/s).
    pub filter_corner: f64,
}

/// Polars of the blade's sections.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Airfoils {
    /// Where the figures come from.
    pub source: String,
    /// The polars.
    pub polar: Vec<PolarTable>,
}

/// One polar.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PolarTable {
    /// Name, unique in the file.
    pub name: String,
    /// Reynolds number (–).
    pub reynolds_number: Option<f64>,
    /// Constants of unsteady flow.
    pub unsteady: Option<Unsteady>,
    /// Angle of attack (deg), lift, drag and moment coefficient (–).
    pub table: Vec<[f64; 4]>,
}

/// Constants of unsteady flow.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unsteady {
    /// Angle of attack without lift (deg).
    pub zero_lift_angle_deg: f64,
    /// Separation over 30 % of the chord, above (deg).
    pub upper_separation_angle_deg: f64,
    /// Separation over 30 % of the chord, below (deg).
    pub lower_separation_angle_deg: f64,
    /// Slope of the normal force (1/rad).
    pub normal_force_slope: f64,
    /// Normal force at leading-edge separation, above (–).
    pub upper_critical_normal_force: f64,
    /// Normal force at leading-edge separation, below (–).
    pub lower_critical_normal_force: f64,
    /// Drag without lift (–).
    pub zero_lift_drag: f64,
    /// Moment without lift (–).
    pub zero_lift_moment: f64,
    /// T_f0, T_V0, T_p, T_VL in half chords (–).
    pub time_constants: Option<[f64; 4]>,
    /// A₁, A₂, A₅ (–).
    pub indicial_amplitudes: Option<[f64; 3]>,
    /// b₁, b₂, b₅ (–).
    pub indicial_exponents: Option<[f64; 3]>,
}
