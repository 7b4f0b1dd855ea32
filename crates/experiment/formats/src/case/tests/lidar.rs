//! Controllers that see through lidars: families of laws, and previews.

use super::SMALL;
use crate::case::{Case, parse, write};

/// The small case whose first turbine has an anemometer and two lidars, under `control`.
fn with(control: &str) -> String {
    let sensors = "[[turbine]]\nsensors.anemometer = { kind = \"anemometer\" }\nsensors.lidar = { kind = \"lidar\" }\nsensors.eye = { kind = \"lidar\", looks = \"upwind\", downwind = 5.0, focal_distance_diameters = 2.0 }\nsensors.pulses = { kind = \"lidar\", ranges_diameters = [0.5, 1.0] }\n";
    let helix = "{ kind = \"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25 }";
    assert!(SMALL.contains("[[turbine]]\n") && SMALL.contains(helix));
    SMALL.replacen("[[turbine]]\n", sensors, 1).replacen(helix, control, 1)
}

fn read(control: &str) -> Result<Case, String> {
    parse("small.toml", &with(control), &[]).map_err(|error| error.to_lines())
}

fn lidar_loop(laws: &str) -> String {
    format!(
        "{{ kind = \"lidar-loop\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.3, reference_tilt = 1.0, reference_yaw = 13.0, {laws} }}"
    )
}

const FAMILY: &str = "controller = [{ wind_speed = 8.0, file = \"law-8.json\" }, { wind_speed = 10, file = \"law-10.json\" }]";

#[test]
fn a_lidar_loop_has_one_law_or_a_family_of_them() {
    for laws in ["controller = \"law.json\"", FAMILY] {
        let case = read(&lidar_loop(laws)).expect("a sound case");
        let again = parse("again", &write(&case), &[]).expect("what was written is read");
        assert_eq!(again, case);
        let control = case.runs.iter().flat_map(|run| &run.control);
        let files: Vec<Vec<String>> = control
            .filter_map(|control| control.kind().law_files(control))
            .map(|files| files.laws)
            .collect();
        let expected: &[&str] =
            if laws == FAMILY { &["law-8.json", "law-10.json"] } else { &["law.json"] };
        assert_eq!(files, [expected]);
    }
}

#[test]
fn a_family_that_cannot_be_is_told_with_its_key_and_fix() {
    let ten_first = FAMILY.replace("wind_speed = 8.0", "wind_speed = 10.5");
    let twice = FAMILY.replace("wind_speed = 8.0", "wind_speed = 10.0");
    let cases = [
        (
            twice,
            "controller` has two laws for 10 m/s, law-8.json and law-10.json; leave one of them out",
        ),
        (
            ten_first,
            "controller` is not in ascending order of wind speed: law-8.json of 10.5 m/s stands before law-10.json of 10 m/s; sort the laws",
        ),
        (
            format!("{FAMILY}, anemometer = \"mast\""),
            "controller` is a family that is blended by the measured wind, and T1 has no sensor `mast`; add sensors.mast = { kind = \"anemometer\" } to the [[turbine]] T1, or name",
        ),
        (
            format!("{FAMILY}, anemometer = \"eye\""),
            "measured wind, and `eye` of T1 is a lidar, whose first value is no wind speed; add sensors.anemometer = { kind = \"anemometer\" } to the [[turbine]] T1, and name it",
        ),
        (
            format!("{FAMILY}, anemometer = \"none\""),
            "measured wind, and `anemometer` is `none`; leave it out, or name an anemometer of T1",
        ),
        (
            "controller = \"law.json\", wind_filter_time = 30.0".to_owned(),
            "wind_filter_time` has no effect here",
        ),
        (
            "controller = [{ wind_speed = 8.0, file = \"law-8.json\" }]".to_owned(),
            "controller` is a family of one law, which is blended with none: its `wind_speed` has no effect; give controller = \"law-8.json\"",
        ),
        (
            "controller = \"law.json\", lidar = \"mast\"".to_owned(),
            "lidar` = \"mast\" names no lidar of T1; add sensors.mast = { kind = \"lidar\" }",
        ),
        (
            "controller = \"law.json\", lidar = \"anemometer\"".to_owned(),
            "lidar` = \"anemometer\" names no lidar of T1",
        ),
        (
            "controller = \"law.json\", lidar = \"eye\"".to_owned(),
            "lidar` = \"eye\" looks upwind, and the own wake is downwind; leave out `looks`",
        ),
        (
            "controller = \"law.json\", lidar = \"pulses\"".to_owned(),
            "lidar` = \"pulses\" measures at 2 ranges, and a controller follows the hub vortex in one plane; give sensors.pulses of T1 one range",
        ),
        ("controller = 8".to_owned(), "controller` must be a file in quotes, or control.T1.contr"),
        ("controller = []".to_owned(), "controller` must be one control.T1.controller"),
        (
            "controller = [{ file = \"law-8.json\" }]".to_owned(),
            "controller.0.wind_speed` is missing",
        ),
    ];
    for (laws, expected) in cases {
        let said = read(&lidar_loop(&laws)).expect_err(&laws);
        assert!(said.contains(expected), "{laws}\nexpected {expected}\nfound    {said}");
    }
}

#[test]
fn a_preview_needs_a_lidar_that_looks_upwind_far_enough() {
    let sync = |more: &str| {
        format!(
            "{{ kind = \"phase-sync\", sense = \"ccw\", strouhal = 0.25, offset_deg = 90, amplitude_deg = 4.0, {more} }}"
        )
    };
    let case = read(&sync("preview = \"eye\"")).expect("a sound case");
    assert_eq!(parse("again", &write(&case), &[]).expect("what was written is read"), case);
    let near = with(&sync("preview = \"eye\""))
        .replace("focal_distance_diameters = 2.0", "focal_distance_diameters = 0.6");
    let said = parse("small.toml", &near, &[]).expect_err("too near").to_lines();
    let expected = "preview` = \"eye\" sees the wind 0.6 D ahead: an estimate without lag needs half a period of the helix, which is 2.00 D of the free wind and 0.67 D of a slow wake, at a third of it; look 2.00 D ahead";
    assert!(said.contains(expected), "{said}");
    let cases = [
        ("preview = \"mast\"", "preview` = \"mast\" names no lidar of T1; add sensors.mast"),
        ("preview = \"anemometer\"", "preview` = \"anemometer\" names no lidar of T1"),
        ("preview = \"lidar\"", "preview` = \"lidar\" looks downwind"),
        ("preview_speed_factor = 0.9", "preview_speed_factor` has no effect here"),
    ];
    for (more, expected) in cases {
        let said = read(&sync(more)).expect_err(more);
        assert!(said.contains(expected), "{more}\nexpected {expected}\nfound    {said}");
    }
}

#[test]
fn a_probing_turbine_sees_its_wake() {
    let probing = |keys: &str| {
        format!(
            "{{ kind = \"probing\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.3{keys} }}"
        )
    };
    read(&probing("")).expect("a sound case");
    for (keys, expected) in [
        (", lidar = \"mast\"", "lidar` = \"mast\" names no lidar of T1; add sensors.mast"),
        (", noise_start = 1e6", "noise_start` = 1000000 s is not before the end of the run"),
    ] {
        let said = read(&probing(keys)).expect_err(keys);
        assert!(said.contains(expected), "expected {expected}\nfound    {said}");
    }
    let before =
        with(&probing("")).replace("kind = \"lidar\" }", "kind = \"lidar\", downwind = -3.0 }");
    let said = parse("small.toml", &before, &[]).expect_err("through the rotor").to_lines();
    assert!(
        said.contains("downwind` is before the rotor for a lidar that looks downwind"),
        "{said}"
    );
}
