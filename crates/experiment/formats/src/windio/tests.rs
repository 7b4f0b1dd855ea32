//! Files as users have them, written here: read right, or refused with file, line, key and what was expected.

use super::*;
use crate::turbine_file;
use std::fs;

/// A made-up turbine with anchors, flow and block style, and a polar that ends a hair before a full turn.
pub(crate) const FILE: &str = include_str!("small.yaml");

fn import_text(text: &str) -> Result<Document, TurbineFileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("small.yaml");
    fs::write(&path, text).unwrap();
    import(&path, &ImportOptions::default())
}

#[test]
fn what_the_file_holds_is_read() {
    let document = import_text(FILE).unwrap();
    assert_eq!(
        (document.name.as_str(), document.title.as_str()),
        ("small", "A small made-up machine")
    );
    let rotor = document.rotor.as_ref().unwrap();
    assert_eq!((rotor.hub_radius, rotor.tip_radius, rotor.hub_height), (1.0, 40.0, 72.0));
    assert!((rotor.overhang - 4.0 / 0.1f64.cos()).abs() < 1e-12);
    let tower = document.tower.as_ref().unwrap();
    // Tower, shaft and overhang lead back to the hub.
    let hub = tower.top_height
        + tower.top_to_shaft
        + rotor.overhang * rotor.shaft_tilt_deg.to_radians().sin();
    assert!((hub - rotor.hub_height).abs() < 1e-9);
    let wall = std::f64::consts::PI / 4.0 * (36.0 - 5.94f64.powi(2)) * 7800.0 * 1.1;
    assert!((tower.sections[0][1] / wall - 1.0).abs() < 1e-12);
    let stations = &document.blade.as_ref().unwrap().stations;
    assert_eq!(stations.len(), 3);
    // Aerodynamic centre a quarter chord ahead of the pitch axis at the tip, at no twist.
    assert!((stations[2].3 - 1.0).abs() < 1e-12 && (stations[2].4 + 0.25).abs() < 1e-12);
    let airfoils = document.airfoils.as_ref().unwrap();
    // Halfway between tube and wing.
    let row = airfoils.polar[1].table.iter().find(|row| row[0] == 0.0).unwrap();
    assert!((row[1] - 0.2).abs() < 1e-12 && (row[2] - 0.205).abs() < 1e-12, "{row:?}");
    assert_eq!(airfoils.polar[0].table.first().unwrap()[0], -180.0);
    let controller = document.controller.as_ref().unwrap();
    assert!((controller.rated_rotor_speed_rpm - 2.0 * 30.0 / PI).abs() < 1e-9);
    assert_eq!(document.drive_train.as_ref().unwrap().generator_efficiency, 0.95);
}

#[test]
fn what_it_does_not_hold_is_listed() {
    let written = turbine_file::write(&import_text(FILE).unwrap());
    for key in [
        "blade_structure",
        "nacelle",
        "tower.fore_aft_mode_1",
        "drive_train.generator_inertia",
        "controller.pitch_gains",
    ] {
        assert!(
            written.missing.iter().any(|missing| missing == key),
            "{key}: {:?}",
            written.missing
        );
    }
    assert!(
        !written
            .missing
            .iter()
            .any(|missing| missing.starts_with("rotor") || missing.starts_with("airfoils"))
    );
}

#[test]
fn errors_name_file_line_and_key() {
    let cases = [
        (
            "    diameter: 2.0",
            "    diamter: 2.0",
            "components.hub.diameter: expected the key diameter",
        ),
        (
            "uptilt: 0.1",
            "uptilt: steep",
            "line 14, components.nacelle.drivetrain.uptilt: expected a number, found \"steep\"",
        ),
        (
            "labels: [tube, wing, wing]",
            "labels: [tube, wong, wing]",
            "line 26, components.blade.outer_shape_bem.airfoil_position.labels.2",
        ),
        (
            "values: [2.0, 2.0, 1.0]",
            "values: [2.0, 1.0]",
            "line 29, components.blade.outer_shape_bem.chord.values: expected 3 numbers",
        ),
        (
            "grid: &angles [-3.14, 3.14]",
            "grid: &angles [-3.0, 3.14]",
            "expected angles from -3.1416 to 3.1416",
        ),
        ("material: steel", "material: wood", "expected the name of a material, found \"wood\""),
    ];
    for (from, to, expected) in cases {
        assert!(FILE.contains(from), "{from}");
        let message = import_text(&FILE.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(message.contains("small.yaml, line ") && message.contains(expected), "{message}");
    }
    let message = import_text("name: [").unwrap_err().to_string();
    assert!(message.contains("small.yaml, line"), "{message}");
}
