//! Files as users have them, written here: read right, or refused with file, line, key and what was expected.

use super::*;
use crate::library;

fn document(text: &str) -> Document {
    toml::from_str(text).unwrap()
}

fn nrel() -> &'static str {
    library::text("nrel-5mw").unwrap()
}

/// The error of the NREL 5 MW file with `from` replaced by `to`.
fn error_of(from: &str, to: &str) -> TurbineFileError {
    assert!(nrel().contains(from), "{from}");
    parse("mine.toml", &nrel().replacen(from, to, 1)).unwrap_err()
}

#[test]
fn written_and_read_again_a_turbine_is_the_same() {
    for name in library::names() {
        let text = library::text(name).unwrap();
        let first = document(text);
        let written = write(&first);
        assert!(written.missing.is_empty(), "{name}: {:?}", written.missing);
        assert_eq!(document(&written.text), first, "{name}");
        assert_eq!(parse("a", &written.text).unwrap(), parse("b", text).unwrap(), "{name}");
    }
}

#[test]
fn figures_are_read_in_si() {
    let TurbineFile { definition, controller, .. } = parse("mine.toml", nrel()).unwrap();
    assert!((definition.rotor.precone - 2.5f64.to_radians()).abs() < 1e-12);
    assert!((definition.rated_power - 5e6).abs() < 1e-3);
    assert!((definition.rated_rotor_speed - 1.267).abs() < 1e-3);
    assert_eq!(definition.polars.len(), 8);
    assert!((definition.blade[4].twist - 13.308f64.to_radians()).abs() < 1e-9);
    // Report: drive-train inertia about the shaft 4.38e7 kg m² (rotor 3.876e7, generator 534 × 97²).
    assert!((definition.drive_train_inertia() / 4.378e7 - 1.0).abs() < 0.01);
    assert!((controller.rotor_radius - definition.rotor_radius()).abs() < 1e-12);
    assert!(controller.pitch_gains.iter().all(|row| row.proportional > 0.0 && row.integral > 0.0));
    assert!((controller.torque_gains.integral / (104.507 * 97.0 * 97.0) - 1.0).abs() < 1e-4);
}

#[test]
fn errors_name_file_line_key_and_fix() {
    let cases = [
        (
            "hub_height = 90.0",
            "hub_height = 40.0",
            "line 17, rotor.hub_height",
            "more than tip_radius",
        ),
        (
            "hub_height = 90.0",
            "hub_height = 95.0",
            "line 17, rotor.hub_height",
            "90.00 m, from tower",
        ),
        ("precone_deg = 2.5", "precone_deg = 250.0", "line 14, rotor.precone_deg", "-30 to 30°"),
        ("4.1,  3.854", "1.1,  3.854", "line 25, blade.stations[3]", "increases, more than 1.3667"),
        ("1.3667,  3.542", "1.3667, -3.542", "line 24, blade.stations[2]", "above zero"),
        ("\"DU40_A17\"", "\"DU41\"", "line 27, blade.stations[5]", "the name of a polar"),
        (
            "coefficients = [0.0622,",
            "coefficients = [0.1622,",
            "line 47, blade_structure.flap_mode_1",
            "add up to 1",
        ),
        ("gear_ratio = 97.0", "gear_ratio = 0.5", "drive_train.gear_ratio", "1 to 1000"),
        ("n_blades = 3", "n_blades = 12", "line 8, n_blades", "1 to 6 blades"),
        (
            "rated_power_kw = 5000.0",
            "rated_power_kw = 5e6",
            "controller.rated_power_kw",
            "100000 kW",
        ),
    ];
    for (from, to, place, expected) in cases {
        let message = error_of(from, to).to_string();
        assert!(message.starts_with("mine.toml, line "), "{message}");
        assert!(message.contains(place) && message.contains(expected), "{message}");
    }
}

#[test]
fn a_polar_must_turn_fully_and_rise() {
    let short = error_of("[ -180.0000,  0.00000,  0.50000,  0.00000 ],\n", "").to_string();
    assert!(short.contains("airfoils.polar[1].table"), "{short}");
    let text = nrel();
    let row = text.lines().find(|line| line.contains("[ -175.0000")).unwrap();
    let message = error_of(row, &row.replace("-175.0", "-185.0")).to_string();
    assert!(message.contains("table[2]") && message.contains("must increase"), "{message}");
}

#[test]
fn unknown_and_missing_keys_are_named() {
    let message = error_of("hub_radius", "hub_raduis").to_string();
    assert!(
        message.contains("line 12") && message.contains("unknown field `hub_raduis`"),
        "{message}"
    );
    let message = error_of("overhang = 5.0191", "# overhang").to_string();
    assert!(message.contains("missing field `overhang`"), "{message}");
    let whole = nrel();
    let (start, end) = (whole.find("[hub]").unwrap(), whole.find("[nacelle]").unwrap());
    let error = parse("mine.toml", &format!("{}{}", &whole[..start], &whole[end..])).unwrap_err();
    assert!(error.to_string().contains("hub: expected a group [hub]"), "{error}");
    let error = error_of("precone_deg = 2.5", "precone_deg = \"2.5\"");
    let TurbineFileError::Syntax { line, .. } = error else { panic!("{error}") };
    assert_eq!(line, 14);
}

#[test]
fn what_is_not_known_stays_out_and_is_listed() {
    let mut partial = document(nrel());
    partial.hub = None;
    partial.drive_train.as_mut().unwrap().damping = f64::NAN;
    partial.controller.as_mut().unwrap().pitch_gains.clear();
    let written = write(&partial);
    assert_eq!(written.missing, ["hub", "drive_train.damping", "controller.pitch_gains"]);
    let message = parse("mine.toml", &written.text).unwrap_err().to_string();
    assert!(message.contains("missing field"), "{message}");
}

#[test]
fn what_a_controller_can_do_without_is_read_checked_and_written() {
    let keys = "\
speed_filter_damping = 0.7
torque_control = \"k-omega-squared\"
wind_speed_filter_corner = 0.3
speed_notches = [[1.5, 0.0, 0.25], [3.0, 0.1, 0.3]]
tower_damping = { gain = 0.02, high_pass_corner = 0.1, limit_deg = 2.0 }
individual_pitch = { proportional = 0.0, integral = 2e-9, azimuth_offset_deg = 20.0, limit_deg = 5.0, ramp = [8.0, 10.0], floor = \"minimum-pitch\" }
speed_filter_corner = 1.5708";
    let text = nrel().replacen("speed_filter_corner = 1.5708", keys, 1);
    let TurbineFile { controller, .. } = parse("mine.toml", &text).unwrap();
    assert_eq!(controller.torque_control, Some(control::baseline::TorqueControl::KOmegaSquared));
    assert_eq!(controller.speed_notches.len(), 2);
    assert_eq!(controller.wind_speed_filter_corner, 0.3);
    assert!((controller.tower_damping.unwrap().limit - 2f64.to_radians()).abs() < 1e-15);
    let individual = controller.individual_pitch.unwrap();
    assert_eq!(individual.floor, control::baseline::PitchFloor::Least);
    assert!((individual.azimuth_offset.unwrap() - 20f64.to_radians()).abs() < 1e-15);
    let written = write(&document(&text));
    assert!(written.missing.is_empty(), "{:?}", written.missing);
    assert_eq!(document(&written.text), document(&text));
    for (from, to, place) in [
        ("damping = 0.7", "damping = 0.0", "controller.speed_filter_damping: expected 0.05 to 5"),
        ("[1.5, 0.0", "[-1.5, 0.0", "controller.speed_notches[1]"),
        ("[[1.5,", "[[1.0, 0.0, 0.2], [1.1, 0.0, 0.2], [1.2, 0.0, 0.2], [1.5,", "4 rows at most"),
        ("ramp = [8.0, 10.0]", "ramp = [8.0, 7.0]", "controller.individual_pitch.ramp"),
        (
            "offset_deg = 20.0",
            "offset_deg = 400.0",
            "individual_pitch.azimuth_offset_deg: expected",
        ),
        ("corner = 0.1,", "corner = 0.0,", "controller.tower_damping.high_pass_corner"),
        ("\"k-omega-squared\"", "\"greedy\"", "k-omega-squared"),
    ] {
        let message = parse("mine.toml", &text.replacen(from, to, 1)).unwrap_err().to_string();
        assert!(message.contains(place), "{message}");
    }
}

#[test]
fn an_azimuth_offset_that_is_left_out_stays_out() {
    let keys = "\
individual_pitch = { proportional = 0.0, integral = 2e-9, limit_deg = 5.0, ramp = [8.0, 10.0], floor = \"fine-pitch\" }
speed_filter_corner = 1.5708";
    let text = nrel().replacen("speed_filter_corner = 1.5708", keys, 1);
    let individual = parse("mine.toml", &text).unwrap().controller.individual_pitch.unwrap();
    assert_eq!(individual.azimuth_offset, None);
    let written = write(&document(&text));
    assert!(written.missing.is_empty(), "{:?}", written.missing);
    assert!(!written.text.contains("azimuth_offset_deg"), "{}", written.text);
    assert_eq!(document(&written.text), document(&text));
    // Nothing is not the same as 0.
    let none = text.replacen("limit_deg", "azimuth_offset_deg = 0.0, limit_deg", 1);
    let individual = parse("mine.toml", &none).unwrap().controller.individual_pitch.unwrap();
    assert_eq!(individual.azimuth_offset, Some(0.0));
}
