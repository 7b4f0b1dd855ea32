//! A turbine for tests and examples: cylinders at the root, aerofoils that stall further out.
//!
//! No published turbine. What a test changes it overrides:
//! `Definition { rated_power: 3e6, ..sample::definition() }`.

use crate::actuators::PitchActuator;
use crate::aero::Polar;
use crate::definition::*;
use basis::Vector3;
use std::f64::consts::PI;

/// Angle of attack without lift of [`aerofoil`] (rad).
pub const ZERO_LIFT: f64 = -0.05;

/// Polar of `lift` and `drag` (–) against the angle of attack (rad), in steps of half a degree; no moment.
///
/// # Panics
/// When a value is no number, or drag is negative.
pub fn polar(lift: impl Fn(f64) -> f64, drag: impl Fn(f64) -> f64) -> Polar {
    let angles: Vec<f64> = (-360..=360).map(|k| f64::from(k) * PI / 360.0).collect();
    let lift: Vec<f64> = angles.iter().map(|angle| lift(*angle)).collect();
    let drag: Vec<f64> = angles.iter().map(|angle| drag(*angle)).collect();
    Polar::new("sample", &angles, &lift, &drag, &vec![0.0; angles.len()])
        .expect("angles rise over the whole circle")
}

/// An aerofoil that stalls at about 15°.
pub fn aerofoil() -> Polar {
    let attached = |angle: f64| 1.0 / (1.0 + ((angle.abs() - 0.28) / 0.03).exp());
    let plate = |angle: f64| 1.1 * (2.0 * angle).sin();
    polar(
        |angle| {
            let share = attached(angle);
            share * 2.0 * PI * (angle - ZERO_LIFT).sin() + (1.0 - share) * plate(angle)
        },
        |angle| 0.008 + 1.3 * angle.sin().powi(2) * (1.0 - attached(angle)),
    )
}

/// Structure of a blade of `length` (m) that has `mass` (kg/m) and stiffness the same all along.
pub fn even_sections(length: f64, mass: f64) -> Vec<BladeSection> {
    let section = |span: f64| BladeSection {
        span,
        twist: 0.0,
        mass,
        flap_stiffness: 1e9,
        edge_stiffness: 1e9,
    };
    vec![section(0.0), section(length)]
}

/// Station `k` of 30 along the blade: twist and chord of an optimum rotor, the root drawn in.
fn station(k: usize) -> BladeStation {
    let radius = 2.0 + 58.0 * k as f64 / 29.0;
    let inflow = 2.0 / 3.0 * (60.0 / (7.5 * radius)).atan();
    let chord = (16.0 * PI * radius / (3.0 * 4.0) * (1.0 - inflow.cos())).clamp(0.8, 4.0);
    BladeStation {
        span: radius - 2.0,
        chord,
        twist: (inflow - 0.09).min(0.25),
        prebend: 0.0,
        sweep: 0.0,
        polar: usize::from(k > 4),
    }
}

/// A rotor of 60 m radius and 2 MW that stands flat in the wind: no tilt, precone, prebend or tower shadow.
pub fn definition() -> Definition {
    let mode = Mode { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], damping_ratio: 0.01 };
    Definition {
        name: "sample".into(),
        n_blades: 3,
        rotor: RotorGeometry {
            hub_radius: 2.0,
            tip_radius: 60.0,
            precone: 0.0,
            shaft_tilt: 0.0,
            overhang: 5.0,
            hub_height: 90.0,
        },
        blade: (0..30).map(station).collect(),
        polars: vec![polar(|_| 0.0, |_| 0.5), aerofoil()],
        blade_structure: BladeStructure {
            sections: even_sections(58.0, 100.0),
            flap_modes: [mode, mode],
            edge_mode: mode,
        },
        tower: Tower {
            base_height: 0.0,
            top_height: 88.0,
            top_to_shaft: 2.0,
            profile: vec![],
            sections: vec![],
            fore_aft_modes: [mode, mode],
            side_to_side_modes: [mode, mode],
        },
        hub: Hub { mass: 1e4, inertia: 1e5 },
        nacelle: Nacelle {
            mass: 1e5,
            yaw_inertia: 1e6,
            center_of_mass: Vector3::ZERO,
            yaw_bearing_mass: 0.0,
        },
        drive_train: DriveTrain {
            gear_ratio: 10.0,
            generator_inertia: 100.0,
            gearbox_efficiency: 1.0,
            generator_efficiency: 0.9,
            stiffness: 1e8,
            damping: 1e6,
        },
        pitch_actuator: PitchActuator {
            natural_frequency: 3.0,
            damping_ratio: 0.7,
            maximum_rate: 0.1,
            minimum_pitch: -0.1,
            maximum_pitch: 1.5,
        },
        swashplate: None,
        operation: None,
        rated_power: 2e6,
        rated_rotor_speed: 1.5,
    }
}
