//! Every number of every turbine of the library, one at a time in the place of which no number can be.

use super::*;
use crate::fuzz::numbers::{Found, NEVER, numbers_of};
use crate::library;
use crate::turbine_file::{parse, write};

/// Columns (from 0) of keys that may be negative: angles, offsets to either side, heights below sea level,
/// coefficients. All else are lengths, masses, stiffnesses and the like.
const SIGNED: &[(&str, &[usize])] = &[
    ("rotor.precone_deg", &[0]),
    ("rotor.shaft_tilt_deg", &[0]),
    ("rotor.overhang", &[0]),
    ("blade.stations", &[2, 3, 4]),
    ("blade_structure.flap_mode_1.coefficients", &[0, 1, 2, 3, 4]),
    ("blade_structure.flap_mode_2.coefficients", &[0, 1, 2, 3, 4]),
    ("blade_structure.edge_mode_1.coefficients", &[0, 1, 2, 3, 4]),
    ("blade_structure.sections", &[1]),
    ("tower.base_height", &[0]),
    ("tower.profile", &[0]),
    ("tower.sections", &[0]),
    ("tower.fore_aft_mode_1.coefficients", &[0, 1, 2, 3, 4]),
    ("tower.fore_aft_mode_2.coefficients", &[0, 1, 2, 3, 4]),
    ("tower.side_to_side_mode_1.coefficients", &[0, 1, 2, 3, 4]),
    ("tower.side_to_side_mode_2.coefficients", &[0, 1, 2, 3, 4]),
    ("nacelle.center_of_mass", &[0, 1, 2]),
    ("pitch_actuator.minimum_pitch_deg", &[0]),
    ("pitch_actuator.maximum_pitch_deg", &[0]),
    ("pitch_actuator.swashplate.rod_azimuth_deg", &[0]),
    ("pitch_actuator.swashplate.bias_deg", &[0, 1]),
    ("controller.fine_pitch_deg", &[0]),
    ("controller.maximum_pitch_deg", &[0]),
    ("controller.minimum_pitch", &[1]),
    ("controller.pitch_gains", &[0, 1, 2]),
    ("airfoils.polar.table", &[0, 1, 2, 3]),
    ("airfoils.polar.unsteady.zero_lift_angle_deg", &[0]),
    ("airfoils.polar.unsteady.upper_separation_angle_deg", &[0]),
    ("airfoils.polar.unsteady.lower_separation_angle_deg", &[0]),
    ("airfoils.polar.unsteady.normal_force_slope", &[0]),
    ("airfoils.polar.unsteady.upper_critical_normal_force", &[0]),
    ("airfoils.polar.unsteady.lower_critical_normal_force", &[0]),
    ("airfoils.polar.unsteady.indicial_amplitudes", &[0, 1, 2]),
    ("airfoils.polar.unsteady.zero_lift_drag", &[0]),
    ("airfoils.polar.unsteady.zero_lift_moment", &[0]),
];

fn may_be_negative(number: &Found) -> bool {
    let signed =
        |(key, columns): &(&str, &[usize])| *key == number.key && columns.contains(&number.column);
    SIGNED.iter().any(signed)
}

#[test]
fn every_number_of_the_library_has_a_range_that_only_numbers_fit() {
    for name in library::names() {
        let text = library::text(name).unwrap();
        let numbers = numbers_of(text);
        assert!(numbers.len() > 1000, "{name}");
        for number in numbers {
            let keys: Vec<Step> = number.key.split('.').map(Key).collect();
            let limits = limits_in(row_of(&keys), number.column);
            let range = limits.unwrap_or_else(|| panic!("{}", number.key)).range;
            let value: f64 = text[number.bytes.clone()].parse().unwrap();
            assert!(range.contains(value), "{name}, {}: {value}", number.key);
            for never in NEVER {
                assert!(!range.contains(never.parse().unwrap()), "{}: {never}", number.key);
            }
            let negative = may_be_negative(&number);
            assert_eq!(range.contains(-1e-9), negative, "{}, {}", number.key, number.column);
        }
    }
}

/// The file of the turbine called `name` with a few rows of each long table, so that it can be read often.
fn thinned(name: &str) -> String {
    let mut document: Document = toml::from_str(library::text(name).unwrap()).unwrap();
    let airfoils = document.airfoils.as_mut().unwrap();
    airfoils.polar.truncate(2);
    for polar in &mut airfoils.polar {
        thin(&mut polar.table);
    }
    let polar = airfoils.polar[1].name.clone();
    let stations = &mut document.blade.as_mut().unwrap().stations;
    thin(stations);
    stations.iter_mut().for_each(|station| station.5.clone_from(&polar));
    thin(&mut document.blade_structure.as_mut().unwrap().sections);
    let tower = document.tower.as_mut().unwrap();
    thin(&mut tower.profile);
    thin(&mut tower.sections);
    let controller = document.controller.as_mut().unwrap();
    thin(&mut controller.minimum_pitch);
    thin(&mut controller.pitch_gains);
    write(&document).text
}

/// Leaves the first, the middle and the last of `rows`, and a table of few as it is.
fn thin<T: Clone>(rows: &mut Vec<T>) {
    if rows.len() < 4 {
        return;
    }
    let last = rows.len() - 1;
    *rows = [0, last / 2, last].map(|row| rows[row].clone()).to_vec();
}

#[test]
fn what_no_number_can_be_is_refused_wherever_it_stands() {
    for name in library::names() {
        let text = thinned(name);
        parse("thinned.toml", &text).unwrap();
        let numbers = numbers_of(&text);
        assert!(numbers.len() > 150, "{name}: {}", numbers.len());
        for number in numbers {
            let written = &text[number.bytes.clone()];
            let negative = format!("-{}", written.trim_start_matches('-'));
            let is_zero = written.parse() == Ok(0.0);
            let negative = if is_zero { "-1.0".to_owned() } else { negative };
            let refused = if may_be_negative(&number) { None } else { Some(negative.as_str()) };
            for bad in NEVER.into_iter().chain(refused) {
                let mut damaged = text.clone();
                damaged.replace_range(number.bytes.clone(), bad);
                let message = parse("thinned.toml", &damaged)
                    .expect_err(&format!("{name}, {} = {bad}", number.key))
                    .to_string();
                let line = 1 + text[..number.bytes.start].matches('\n').count();
                let place = format!("thinned.toml, line {line}");
                assert!(message.starts_with(&place), "{message}, expected {place}");
                let last = number.key.rsplit('.').next().unwrap();
                assert!(message.contains(last), "{message}, expected {last}");
                assert!(message.contains("expected"), "{message}");
            }
        }
    }
}

/// What the library's turbines leave out.
#[test]
fn keys_that_may_be_left_out_have_ranges_too() {
    let keys = "\
speed_filter_damping = 0.7
wind_speed_filter_corner = 0.3
speed_notches = [[1.5, 0.1, 0.25], [3.0, 0.1, 0.3]]
tower_damping = { gain = 0.02, high_pass_corner = 0.1, limit_deg = 2.0 }
individual_pitch = { proportional = 1e-9, integral = 2e-9, azimuth_offset_deg = 20.0, limit_deg = 5.0, ramp = [8.0, 10.0], floor = \"minimum-pitch\" }
";
    let text = thinned("nrel-5mw");
    let place = text.find("speed_filter_corner = ").unwrap();
    let text = format!("{}{keys}{}", &text[..place], &text[place..]);
    parse("more.toml", &text).unwrap();
    let added = place..place + keys.len();
    let numbers = numbers_of(&text).into_iter().filter(|n| added.contains(&n.bytes.start));
    let mut n_numbers = 0;
    for number in numbers {
        n_numbers += 1;
        for bad in NEVER {
            let mut damaged = text.clone();
            damaged.replace_range(number.bytes.clone(), bad);
            let message = parse("more.toml", &damaged).expect_err(&number.key).to_string();
            assert!(message.contains(&number.key), "{message}");
        }
    }
    assert_eq!(n_numbers, 17);
}

#[test]
fn a_cut_out_lies_above_the_cut_in() {
    let text = library::text("nrel-5mw").unwrap();
    let text = text.replace("cut_out_wind_speed = 25.0", "cut_out_wind_speed = 2.0");
    let message = parse("mine.toml", &text).unwrap_err().to_string();
    let expected =
        "operation.cut_out_wind_speed: expected more than cut_in_wind_speed, 3 m/s, found 2";
    assert!(message.contains(expected), "{message}");
}
