//! A file of planes in which two waves travel.

use super::*;
use basis::records::{Plane, PlaneAxes};
use formats::records::{InstantWriter, PlacedTurbine, PlaneSetting};
use std::f64::consts::TAU;
use std::path::Path;

const INTERVAL: f64 = 2.0;

/// A plane across the wind of 21 × 9 points in which a wave of 1 m/s and 0.05 Hz goes to the left.
fn plane(time: f64) -> Plane {
    let values = |component: usize| {
        let value = |index: usize| {
            let y = (index % 21) as f64 / 20.0;
            let wave = (TAU * (y - 0.05 * time)).cos() + 0.2 * (TAU * (2.0 * y - 0.1 * time)).cos();
            if component == 0 { 8.0 + wave } else { 0.01 * (component * index % 7) as f64 }
        };
        (0..21 * 9).map(|index| value(index) as f32).collect()
    };
    Plane {
        name: "crosswind-3D".to_owned(),
        axes: PlaneAxes::Crosswind,
        origin: [300.0, -100.0, 20.0],
        spacing: [10.0, 20.0],
        n_points: [21, 9],
        time,
        averaged: 0.0,
        velocity: [values(0), values(1), values(2)],
    }
}

fn written(path: &Path, n_instants: usize) {
    let turbine = PlacedTurbine {
        name: "T1".to_owned(),
        hub: [0.0, 0.0, 90.0],
        rotor_diameter: 100.0,
        is_there: true,
    };
    let setting = PlaneSetting {
        case: "waves".to_owned(),
        run: "helix".to_owned(),
        wind_speed: 20.0,
        wind_direction_deg: 270.0,
        turbulence_intensity: 0.06,
        air_density: 1.225,
        turbines: vec![turbine],
    };
    let mut writer = InstantWriter::create(path, &setting, &plane(0.0)).unwrap();
    for index in 0..n_instants {
        writer.write(&plane(600.0 + index as f64 * INTERVAL)).unwrap();
    }
    writer.finish().unwrap();
}

#[test]
fn a_file_of_planes_has_modes_that_are_named_after_the_helix() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crosswind-3D.nc");
    written(&path, 200);
    let question = ModesQuestion { excitation: Some(0.05), ..ModesQuestion::of(&path) };
    let answer = modes(&question).unwrap();
    // A third of 200 instants are 133 s, 6 whole periods of 20 s.
    assert_eq!((answer.spod.n_block, answer.spod.n_blocks), (60, 5));
    assert_eq!(answer.name_of(6).as_deref(), Some("f_e"));
    assert_eq!(answer.name_of(12).as_deref(), Some("2 f_e"));
    // Waves of 1 and 0.2 m/s: half the square of the amplitude, each twice a POD mode.
    assert!((answer.pod.total - 0.52).abs() < 1e-4);
    assert!((answer.pod.energies[0] - 0.25).abs() < 1e-4);
    assert_eq!(answer.pod_name(0).as_deref(), Some("f_e"));
    assert_eq!(answer.pod_name(2).as_deref(), Some("2 f_e"));
    // f_e, 2 f_e, 3 f_e; the strongest one is f_e again.
    assert_eq!(answer.spod.modes.len(), 3);
    assert!(
        answer.conditions.contains("waves, helix, crosswind-3D, 20 m/s, TI 6 %, f_e 0.0500 Hz")
    );
    assert!(answer.conditions.contains("(St 0.25)"), "{}", answer.conditions);
    let figures = signals(&answer);
    assert_eq!((figures.densities.len(), figures.maps.len()), (1, 2));
    assert!(figures.maps[0].panels[0].title.starts_with("f_e: 0.0500 Hz"));
    assert!(figures.densities[0].caption.contains("200 instants from 600 to 998 s; 5 blocks"));
}

#[test]
fn what_has_no_modes_names_the_file_and_the_fix() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short.nc");
    written(&path, 6);
    let question = ModesQuestion { n_block: Some(8), ..ModesQuestion::of(&path) };
    let refused = modes(&question).unwrap_err();
    let help = miette::Diagnostic::help(&refused).map(|help| help.to_string()).unwrap_or_default();
    let message = refused.to_string();
    assert!(message.contains("short.nc") && message.contains("8 are needed"), "{message}");
    assert!(help.contains("output.plane_interval"), "{help}");
    let nowhere = modes(&ModesQuestion::of(folder.path())).unwrap_err();
    assert!(nowhere.to_string().contains("kept no plane at instants"), "{nowhere}");
}
