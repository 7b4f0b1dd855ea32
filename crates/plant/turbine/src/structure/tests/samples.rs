//! Turbines to test with: the published ones, read from their files, and a plain one for closed forms.

use crate::Polar;
use crate::actuators::PitchActuator;
use crate::definition::*;
use crate::structure::{Structure, StructureSettings};
use basis::Vector3;
use std::f64::consts::PI;
use toml::{Table, Value};

pub(super) const IEA_15: &str = include_str!("../../../../../../turbines/iea-15mw.toml");
pub(super) const IEA_22: &str = include_str!("../../../../../../turbines/iea-22mw.toml");
pub(super) const NREL_5: &str = include_str!("../../../../../../turbines/nrel-5mw.toml");

/// The structural part of a turbine file; its aerofoils are one thin plate.
pub(super) fn published(text: &str) -> Definition {
    let file: Table = text.parse().unwrap();
    let group = |name: &str| file[name].as_table().unwrap();
    let number = |table: &Table, key: &str| float(&table[key]);
    let degrees = |table: &Table, key: &str| number(table, key).to_radians();
    let (rotor, tower) = (group("rotor"), group("tower"));
    let (blade, drive) = (group("blade_structure"), group("drive_train"));
    let (hub, nacelle) = (group("hub"), group("nacelle"));
    let centre: Vec<f64> =
        nacelle["center_of_mass"].as_array().unwrap().iter().map(float).collect();
    Definition {
        name: file["name"].as_str().unwrap().into(),
        n_blades: file["n_blades"].as_integer().unwrap() as usize,
        rotor: RotorGeometry {
            hub_radius: number(rotor, "hub_radius"),
            tip_radius: number(rotor, "tip_radius"),
            precone: degrees(rotor, "precone_deg"),
            shaft_tilt: degrees(rotor, "shaft_tilt_deg"),
            overhang: number(rotor, "overhang"),
            hub_height: number(rotor, "hub_height"),
        },
        blade: rows(&group("blade")["stations"])
            .iter()
            .map(|row| BladeStation {
                span: row[0],
                chord: row[1],
                twist: row[2].to_radians(),
                prebend: row[3],
                sweep: row[4],
                polar: 0,
            })
            .collect(),
        polars: vec![plate()],
        blade_structure: BladeStructure {
            sections: rows(&blade["sections"])
                .iter()
                .map(|row| BladeSection {
                    span: row[0],
                    twist: row[1].to_radians(),
                    mass: row[2],
                    flap_stiffness: row[3],
                    edge_stiffness: row[4],
                })
                .collect(),
            flap_modes: [mode(&blade["flap_mode_1"]), mode(&blade["flap_mode_2"])],
            edge_mode: mode(&blade["edge_mode_1"]),
        },
        tower: Tower {
            base_height: number(tower, "base_height"),
            top_height: number(tower, "top_height"),
            top_to_shaft: number(tower, "top_to_shaft"),
            profile: vec![],
            sections: rows(&tower["sections"])
                .iter()
                .map(|row| TowerSection {
                    height: row[0],
                    mass: row[1],
                    fore_aft_stiffness: row[2],
                    side_to_side_stiffness: row[3],
                })
                .collect(),
            fore_aft_modes: [mode(&tower["fore_aft_mode_1"]), mode(&tower["fore_aft_mode_2"])],
            side_to_side_modes: [
                mode(&tower["side_to_side_mode_1"]),
                mode(&tower["side_to_side_mode_2"]),
            ],
        },
        hub: Hub { mass: number(hub, "mass"), inertia: number(hub, "inertia") },
        nacelle: Nacelle {
            mass: number(nacelle, "mass"),
            yaw_inertia: number(nacelle, "yaw_inertia"),
            center_of_mass: Vector3::new(centre[0], centre[1], centre[2]),
            yaw_bearing_mass: number(nacelle, "yaw_bearing_mass"),
        },
        drive_train: DriveTrain {
            gear_ratio: number(drive, "gear_ratio"),
            generator_inertia: number(drive, "generator_inertia"),
            gearbox_efficiency: 1.0,
            generator_efficiency: 1.0,
            stiffness: number(drive, "stiffness"),
            damping: number(drive, "damping"),
        },
        ..plain()
    }
}

/// Three even, untwisted blades of 40 m on an even tower of 78 m: tilted, coned, prebent. Its shapes are
/// parabolas and steeper.
pub(super) fn plain() -> Definition {
    let mode = |coefficients| Mode { coefficients, damping_ratio: 0.01 };
    let first = mode([1.5, -0.5, 0.0, 0.0, 0.0]);
    let second = mode([-4.0, 5.0, 0.0, 0.0, 0.0]);
    let section = |span: f64| BladeSection {
        span,
        twist: 0.0,
        mass: 300.0,
        flap_stiffness: 6e8,
        edge_stiffness: 1.5e9,
    };
    let tower_section = |height: f64| TowerSection {
        height,
        mass: 4000.0,
        fore_aft_stiffness: 3e11,
        side_to_side_stiffness: 3e11,
    };
    let station = |span: f64| BladeStation {
        span,
        chord: 3.0,
        twist: 0.0,
        prebend: 0.03 * span,
        sweep: 0.0,
        polar: 0,
    };
    Definition {
        name: "plain".into(),
        n_blades: 3,
        rotor: RotorGeometry {
            hub_radius: 2.0,
            tip_radius: 42.0,
            precone: 0.05,
            shaft_tilt: 0.09,
            overhang: 5.0,
            hub_height: 82.0,
        },
        blade: vec![station(0.0), station(40.0)],
        polars: vec![plate()],
        blade_structure: BladeStructure {
            sections: vec![section(0.0), section(40.0)],
            flap_modes: [first, second],
            edge_mode: first,
        },
        tower: Tower {
            base_height: 2.0,
            top_height: 80.0,
            top_to_shaft: 2.0,
            profile: vec![],
            sections: vec![tower_section(2.0), tower_section(80.0)],
            fore_aft_modes: [first, second],
            side_to_side_modes: [first, second],
        },
        hub: Hub { mass: 2e4, inertia: 5e4 },
        nacelle: Nacelle {
            mass: 1e5,
            yaw_inertia: 1.5e6,
            center_of_mass: Vector3::new(1.0, 0.0, 1.5),
            yaw_bearing_mass: 3e3,
        },
        drive_train: DriveTrain {
            gear_ratio: 1.0,
            generator_inertia: 3e6,
            gearbox_efficiency: 1.0,
            generator_efficiency: 1.0,
            stiffness: 5e8,
            damping: 2e6,
        },
        pitch_actuator: PitchActuator {
            natural_frequency: 3.0,
            damping_ratio: 0.7,
            maximum_rate: 0.1,
            minimum_pitch: -0.05,
            maximum_pitch: 1.5,
        },
        swashplate: None,
        operation: None,
        rated_power: 2e6,
        rated_rotor_speed: 1.7,
    }
}

/// `definition` without any damping.
pub(super) fn undamped(mut definition: Definition) -> Definition {
    definition.drive_train.damping = 0.0;
    let blade = &mut definition.blade_structure;
    let tower = &mut definition.tower;
    blade.edge_mode.damping_ratio = 0.0;
    for modes in [&mut blade.flap_modes, &mut tower.fore_aft_modes, &mut tower.side_to_side_modes] {
        modes.iter_mut().for_each(|mode| mode.damping_ratio = 0.0);
    }
    definition
}

pub(super) fn structure(definition: &Definition, settings: &StructureSettings<'_>) -> Structure {
    Structure::new(definition, settings).unwrap()
}

fn plate() -> Polar {
    let angles: Vec<f64> = (-36..=36).map(|k| f64::from(k) * PI / 36.0).collect();
    let zeros = vec![0.0; angles.len()];
    Polar::new("plate", &angles, &zeros, &zeros, &zeros).unwrap()
}

fn mode(value: &Value) -> Mode {
    let coefficients: Vec<f64> =
        value["coefficients"].as_array().unwrap().iter().map(float).collect();
    Mode {
        coefficients: coefficients.try_into().unwrap(),
        damping_ratio: float(&value["damping_ratio"]),
    }
}

/// Rows of a table, what is not a number left out.
fn rows(value: &Value) -> Vec<Vec<f64>> {
    let row =
        |row: &Value| row.as_array().unwrap().iter().filter(|v| !v.is_str()).map(float).collect();
    value.as_array().unwrap().iter().map(row).collect()
}

fn float(value: &Value) -> f64 {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64)).unwrap()
}
