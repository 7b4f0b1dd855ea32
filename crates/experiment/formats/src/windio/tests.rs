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

/// A made-up turbine with sections of the blade, masses of the nacelle, several polars of an airfoil, and
/// frequencies of its controllers; what it lacks is the generator's inertia.
const WHOLE: &str = include_str!("whole.yaml");
const GENERATOR: &str = "[drive_train]\ngenerator_inertia = 50000.0\n";

/// What becomes of the file of `text`, with `completion` as further figures.
fn completed(
    text: &str,
    completion: Option<&str>,
    polars: PolarChoice,
) -> Result<Imported, TurbineFileError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("whole.yaml");
    fs::write(&path, text).unwrap();
    let completion = completion.map(|text| {
        let path = folder.path().join("more.toml");
        fs::write(&path, text).unwrap();
        path
    });
    import_with(&path, &ImportOptions::default(), &WindioOptions { polars, completion })
}

#[test]
fn with_a_figure_that_a_user_adds_the_turbine_is_whole() {
    let alone = completed(WHOLE, None, PolarChoice::default()).unwrap();
    let missing = turbine_file::write(&alone.document).missing;
    assert!(missing.contains(&"drive_train.generator_inertia".to_owned()), "{missing:?}");
    assert!(
        missing.iter().all(|key| key.starts_with("drive_train") || key.starts_with("controller")),
        "{missing:?}"
    );
    let Imported { document, notes } =
        completed(WHOLE, Some(GENERATOR), PolarChoice::default()).unwrap();
    let written = turbine_file::write(&document);
    assert_eq!(written.missing, Vec::<String>::new());
    let file = turbine_file::parse("whole.toml", &written.text).unwrap();
    // A uniform blade of 39 m: 3.516 sqrt(EI / m) / L² (Blevins, 1979, table 8-1) is 0.5203 Hz flapwise,
    // twice that edgewise, where it is four times as stiff.
    assert!(
        notes
            .iter()
            .any(|note| note.contains("0.520 and 3.2") && note.contains("1.041 Hz edgewise")),
        "{notes:?}"
    );
    let flap = &document.blade_structure.as_ref().unwrap().flap_mode_1;
    let middle: f64 = (0..5).map(|k| flap.coefficients[k] * 0.5_f64.powi(k as i32 + 2)).sum();
    assert!((middle - 0.3395).abs() < 5e-4, "{middle}");
    let constants = &file.controller;
    let inertia = file.definition.drive_train_inertia();
    // A generator without a gearbox adds its own to that of hub and blades, m (R³ − r³) each.
    let blades = 3.0 * 200.0 * (40.0_f64.powi(3) - 1.0) / 3.0;
    assert!((inertia / (blades + 500.0 + 50_000.0) - 1.0).abs() < 5e-3, "{inertia}");
    assert!((constants.torque_gains.integral / (0.3_f64.powi(2) * inertia) - 1.0).abs() < 1e-6);
    let rated = 2e6 / 0.95 / 2.0;
    assert!((constants.rated_torque / rated - 1.0).abs() < 1e-6, "{}", constants.rated_torque);
    // More pitch is more effective: gains fall.
    let gains = &constants.pitch_gains;
    assert!(gains.len() >= 5, "{gains:?}");
    assert!(gains.windows(2).all(|pair| pair[1].proportional < pair[0].proportional), "{gains:?}");
    assert!((gains[0].integral / gains[0].proportional - 0.25).abs() < 1e-6);
}

#[test]
fn polars_are_chosen_by_flow_and_reynolds_number() {
    let drag = |words: Option<&str>, reynolds_number: Option<f64>| {
        let choice = PolarChoice { configuration: words.map(str::to_owned), reynolds_number };
        let imported = completed(WHOLE, None, choice)?;
        let airfoils = imported.document.airfoils.unwrap();
        let row = airfoils.polar[2].table.iter().find(|row| row[0] == 0.0).unwrap();
        Ok::<_, TurbineFileError>((row[2], imported.notes))
    };
    let (clean, notes) = drag(None, None).unwrap();
    assert_eq!(clean, 0.01);
    assert!(
        notes[0].starts_with("polars: \"Clean\" at Re 3.000e6 (of 3) of wing; --polars"),
        "{notes:?}"
    );
    assert_eq!(drag(Some("fully turbulent"), None).unwrap().0, 0.02);
    assert_eq!(drag(Some("rough"), Some(1e7)).unwrap().0, 0.015);
    assert_eq!(drag(None, Some(6e6)).unwrap().0, 0.015);
    let message = drag(Some("icy"), None).unwrap_err().to_string();
    for words in ["airfoils.2.polars", "a polar whose configuration has \"icy\"", "\"Clean\""] {
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn a_completion_that_is_none_is_refused() {
    let refused = |text: &str| completed(WHOLE, Some(text), PolarChoice::default()).unwrap_err();
    let message = refused("[drive_train]\ngenerator_inertia = \n").to_string();
    assert!(message.contains("more.toml, line 2"), "{message}");
    let message = refused("[drive_train]\ngenerator_mass = 1.0\n").to_string();
    assert!(message.contains("more.toml") && message.contains("generator_mass"), "{message}");
}

#[test]
fn the_template_names_what_is_missing_and_holds_nothing_yet() {
    let text = WHOLE.replace("system_mass: 60000.0", "system_masses: 60000.0");
    assert!(import_text(&text).is_err(), "half a group is a mistake");
    let small = turbine_file::write(&import_text(FILE).unwrap()).missing;
    let template = template(&small);
    for line in [
        "# [nacelle]",
        "# center_of_mass = ?",
        "# generator_inertia = ?",
        "# controller.pitch_gains",
    ] {
        assert!(template.contains(line), "{line} in {template}");
    }
    assert!(template.lines().all(|line| line.is_empty() || line.starts_with('#')), "{template}");
    assert!(template.parse::<toml::Table>().unwrap().is_empty());
}
