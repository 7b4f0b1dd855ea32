//! Definition of a turbine: geometry, polars, masses, stiffnesses, mode shapes, drive train, actuators.
//!
//! Signs are those of the reports on upwind turbines: precone, shaft tilt, overhang and prebend are
//! positive when they carry the blade tips *away from the tower*; twist and pitch are positive to feather.

use crate::Polar;
use crate::actuators::{PitchActuator, Swashplate};
use basis::Vector3;

/// One turbine as plain data, SI and radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Definition {
    /// Name, such as `iea-15mw`.
    pub name: String,
    /// Blades (–).
    pub n_blades: usize,
    /// Position of the rotor.
    pub rotor: RotorGeometry,
    /// Aerodynamic stations of a blade, root to tip; the first at span 0.
    pub blade: Vec<BladeStation>,
    /// Polars that the stations refer to.
    pub polars: Vec<Polar>,
    /// Mass and stiffness of a blade.
    pub blade_structure: BladeStructure,
    /// The tower.
    pub tower: Tower,
    /// The hub.
    pub hub: Hub,
    /// Nacelle and yaw bearing.
    pub nacelle: Nacelle,
    /// Gearbox, shaft and generator.
    pub drive_train: DriveTrain,
    /// Pitch actuator of each blade; with a swashplate of each of its rods, in collective pitch.
    pub pitch_actuator: PitchActuator,
    /// The swashplate that pitches all blades; absent where each has an actuator of its own.
    pub swashplate: Option<Swashplate>,
    /// Between which mean wind speeds it works; absent where the source does not tell.
    pub operation: Option<Operation>,
    /// Electrical power at rated (W).
    pub rated_power: f64,
    /// Rotor speed at rated (rad/s).
    pub rated_rotor_speed: f64,
}

/// Between which mean wind speeds at hub height a turbine works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Operation {
    /// It starts in this wind (m/s).
    pub cut_in: f64,
    /// It is stopped above this wind (m/s).
    pub cut_out: f64,
}

/// Position and angles of the rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorGeometry {
    /// Rotor apex to blade root, along the blade's pitch axis (m).
    pub hub_radius: f64,
    /// Rotor apex to blade tip, along the blade's pitch axis, prebend and sweep left aside (m).
    pub tip_radius: f64,
    /// Angle of the pitch axes out of the plane across the shaft, tips upwind (rad).
    pub precone: f64,
    /// Angle of the shaft against the horizontal, upwind end up (rad).
    pub shaft_tilt: f64,
    /// Yaw axis to rotor apex along the shaft, upwind (m).
    pub overhang: f64,
    /// Rotor apex above ground or mean sea level (m).
    pub hub_height: f64,
}

/// Blade section at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BladeStation {
    /// Distance from the blade root along the pitch axis (m).
    pub span: f64,
    /// Chord (m).
    pub chord: f64,
    /// Twist, positive to feather (rad).
    pub twist: f64,
    /// Aerodynamic centre off the pitch axis, positive upwind at zero pitch (m).
    pub prebend: f64,
    /// Aerodynamic centre off the pitch axis in the plane of rotation, positive towards the trailing edge
    /// (m).
    pub sweep: f64,
    /// Index into [`Definition::polars`].
    pub polar: usize,
}

/// Mass and stiffness of one blade.
#[derive(Clone, Debug, PartialEq)]
pub struct BladeStructure {
    /// Sections, root to tip.
    pub sections: Vec<BladeSection>,
    /// First two flapwise modes.
    pub flap_modes: [Mode; 2],
    /// First edgewise mode.
    pub edge_mode: Mode,
}

/// Structural section of a blade at one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BladeSection {
    /// Distance from the blade root along the pitch axis (m).
    pub span: f64,
    /// Twist of the principal axes, positive to feather (rad).
    pub twist: f64,
    /// Mass per length (kg/m).
    pub mass: f64,
    /// Flapwise bending stiffness (N m²).
    pub flap_stiffness: f64,
    /// Edgewise bending stiffness (N m²).
    pub edge_stiffness: f64,
}

/// Shape and damping of one bending mode of a cantilever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Coefficients of x² to x⁶ (–), x the share of the length from the clamped end; they sum to one.
    pub coefficients: [f64; 5],
    /// Share of critical damping (–).
    pub damping_ratio: f64,
}

impl Mode {
    /// Deflection at `share` of the length (–), one at the free end.
    pub fn shape(&self, share: f64) -> f64 {
        let polynomial = self.coefficients.iter().rev().fold(0.0, |sum, c| sum * share + c);
        polynomial * share * share
    }
}

/// The tower, clamped at its base.
#[derive(Clone, Debug, PartialEq)]
pub struct Tower {
    /// Foot of the flexible tower above ground or mean sea level (m).
    pub base_height: f64,
    /// Top, at the yaw bearing, above ground or mean sea level (m).
    pub top_height: f64,
    /// Yaw bearing to the shaft, on the yaw axis, up (m).
    pub top_to_shaft: f64,
    /// Outer shape, bottom to top.
    pub profile: Vec<TowerProfile>,
    /// Structural sections, bottom to top.
    pub sections: Vec<TowerSection>,
    /// First two fore-aft modes, over the height from base to top.
    pub fore_aft_modes: [Mode; 2],
    /// First two side-to-side modes.
    pub side_to_side_modes: [Mode; 2],
}

/// Outer shape of the tower at one height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TowerProfile {
    /// Height above ground or mean sea level (m).
    pub height: f64,
    /// Outer diameter (m).
    pub diameter: f64,
    /// Drag coefficient on diameter × length (–).
    pub drag_coefficient: f64,
}

/// Structural section of the tower at one height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TowerSection {
    /// Height above ground or mean sea level (m).
    pub height: f64,
    /// Mass per length (kg/m).
    pub mass: f64,
    /// Fore-aft bending stiffness (N m²).
    pub fore_aft_stiffness: f64,
    /// Side-to-side bending stiffness (N m²).
    pub side_to_side_stiffness: f64,
}

/// The hub.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hub {
    /// Mass (kg).
    pub mass: f64,
    /// Inertia about the shaft (kg m²).
    pub inertia: f64,
}

/// Nacelle and yaw bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nacelle {
    /// Nacelle mass without hub and yaw bearing (kg).
    pub mass: f64,
    /// Nacelle inertia about the yaw axis (kg m²).
    pub yaw_inertia: f64,
    /// Centre of mass from the tower top, in the nacelle: downwind, left looking downwind, up (m).
    pub center_of_mass: Vector3,
    /// Yaw bearing mass (kg).
    pub yaw_bearing_mass: f64,
}

/// Gearbox, shaft and generator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveTrain {
    /// Generator speed over rotor speed (–).
    pub gear_ratio: f64,
    /// Generator inertia about its own, high-speed shaft (kg m²).
    pub generator_inertia: f64,
    /// Mechanical power behind the gearbox over power before it (–).
    pub gearbox_efficiency: f64,
    /// Electrical power over mechanical power of the generator (–).
    pub generator_efficiency: f64,
    /// Torsional stiffness of the shaft, low-speed side (N m/rad).
    pub stiffness: f64,
    /// Torsional damping of the shaft, low-speed side (N m s/rad).
    pub damping: f64,
}

impl Definition {
    /// Distance from the shaft's axis (m) of a point of the blade's reference line at `radius` (m) from the
    /// apex along the pitch axis and `prebend` (m) upwind of it, blade unpitched.
    pub fn distance_from_shaft(&self, radius: f64, prebend: f64) -> f64 {
        let (sine, cosine) = self.rotor.precone.sin_cos();
        radius * cosine - prebend * sine
    }

    /// Radius of the disc that the blade tips sweep, seen along the shaft (m): tip radius less what precone
    /// and prebend take.
    pub fn rotor_radius(&self) -> f64 {
        let prebend = self.blade.last().map_or(0.0, |tip| tip.prebend);
        self.distance_from_shaft(self.rotor.tip_radius, prebend)
    }

    /// Diameter of the swept disc (m), twice [`Definition::rotor_radius`]; a little less than the name of a
    /// turbine says.
    pub fn rotor_diameter(&self) -> f64 {
        2.0 * self.rotor_radius()
    }

    /// Area of the swept disc (m²); coefficients of power, thrust and torque refer to it.
    pub fn rotor_area(&self) -> f64 {
        std::f64::consts::PI * self.rotor_radius().powi(2)
    }

    /// Blade length along the pitch axis (m).
    pub fn blade_length(&self) -> f64 {
        self.rotor.tip_radius - self.rotor.hub_radius
    }

    /// Mass of one blade (kg).
    pub fn blade_mass(&self) -> f64 {
        self.blade_moment(|_| 1.0)
    }

    /// Inertia about the shaft of blades and hub (kg m²), mass on the coned pitch axes.
    pub fn rotor_inertia(&self) -> f64 {
        let blade = self.blade_moment(|span| {
            self.distance_from_shaft(self.rotor.hub_radius + span, 0.0).powi(2)
        });
        self.n_blades as f64 * blade + self.hub.inertia
    }

    /// Inertia of rotor and generator on the low-speed side (kg m²).
    pub fn drive_train_inertia(&self) -> f64 {
        let gear_ratio = self.drive_train.gear_ratio;
        self.rotor_inertia() + gear_ratio * gear_ratio * self.drive_train.generator_inertia
    }

    /// Electrical power over aerodynamic power in steady running (–).
    pub fn efficiency(&self) -> f64 {
        self.drive_train.gearbox_efficiency * self.drive_train.generator_efficiency
    }

    /// ∫ mass × `weight`(span) over one blade; mass and weight linear between sections, exact for their
    /// product up to cubic.
    fn blade_moment(&self, weight: impl Fn(f64) -> f64) -> f64 {
        self.blade_structure
            .sections
            .windows(2)
            .map(|pair| {
                let length = pair[1].span - pair[0].span;
                let middle = 0.5 * (pair[0].span + pair[1].span);
                let ends =
                    pair[0].mass * weight(pair[0].span) + pair[1].mass * weight(pair[1].span);
                // Simpson's rule.
                length / 6.0 * (ends + 2.0 * (pair[0].mass + pair[1].mass) * weight(middle))
            })
            .sum()
    }
}
