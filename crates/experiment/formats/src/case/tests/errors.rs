//! Errors in a case file name the place and the fix.

use super::{SMALL, small};
use crate::case::{Problem, parse, read};
use std::fs;
use std::path::Path;

/// The lines that a user sees after `from` was replaced by `to` in the small case.
fn message(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "the small case does not hold {from}");
    parse("small.toml", &SMALL.replacen(from, to, 1), &[]).unwrap_err().to_lines()
}

#[test]
fn errors_name_file_line_key_and_fix() {
    let cases = [
        (
            "speed = 9",
            "sped = 9",
            "small.toml:4: there is no key `wind.sped`; did you mean `speed`?",
        ),
        (
            "speed = 9",
            "speed = 900",
            "small.toml:4: `wind.speed` = 900 is out of range: 0 < speed <= 40 m/s; did you mean 9 m/s? 900 cm/s would be that",
        ),
        ("speed = 9", "speed = 54", "did you mean 15 m/s? 54 km/h would be that"),
        (
            "speed = 9",
            "speed = \"9 m/s\"",
            "`wind.speed` must be a number, found text \"9 m/s\"; write 9, without quotes or unit (m/s)",
        ),
        ("speed = 9\n", "", "small.toml:3: `wind.speed` is missing; add it: Mean speed"),
        ("intensity = 0.05", "intensity = 5", "did you mean 0.05? 5 percent would be that"),
        ("speed = 9", "speed = nan", "`wind.speed` = NaN is out of range"),
        ("[wind]", "[wnid]", "there is no key `wnid`; did you mean `wind`?"),
        (
            "duration = 900.0",
            "duration = 300",
            "small.toml:8: `time.duration` = 300 s is not longer than `time.spin_up` = 300 s",
        ),
        (
            "[5.0, 0.0]",
            "[0.5, 0.0]",
            "small.toml:16: turbines T1 and T2 overlap: they stand 0.50 diameters apart, at least 1 is needed; move one",
        ),
        ("[5.0, 0.0]", "[1200, 0.0]", "`turbine.T2.position_diameters` = 1200 is out of range"),
        ("\"T2\"", "\"T1\"", "small.toml:14: the turbine name `T1` is used twice"),
        (
            "\"T2\"",
            "\"T 2\"",
            "`turbine.T 2.name` = \"T 2\" is not a valid name: use 1 to 64 letters, digits, `-` and `_`; try \"T-2\"",
        ),
        (
            "control.T1",
            "control.T3",
            "small.toml:22: `run.helix.control.T3` names the turbine `T3`, which the file does not have; it has `T1`, `T2`",
        ),
        (
            "= \"baseline\"\ncontrol",
            "= \"base-line\"\ncontrol",
            "small.toml:21: `run.helix.compare_with` names the run `base-line`, which the file does not have; it has `baseline`, `helix`; did you mean \"baseline\"?",
        ),
        ("= \"baseline\"\ncontrol", "= \"helix\"\ncontrol", "run `helix` is compared with itself"),
        (
            "[[run]]\nname = \"baseline\"",
            "[[run]]\nname = \"baseline\"\ncompare_with = \"helix\"",
            "small.toml:19: run `baseline` is compared with `helix`, which comes after it; put [[run]] `helix` before",
        ),
        (
            "4.0, strouhal",
            "14, strouhal",
            "`run.helix.control.T1.amplitude_deg` = 14 is out of range: 0 <= amplitude_deg <= 10 deg",
        ),
        ("strouhal = 0.25", "strouhal = -0.25", "0 < strouhal <= 2"),
        (
            "\"helix\", sense",
            "\"phase-lock\", sense",
            "`run.helix.control.T1.kind` = \"phase-lock\" is unknown; expected one of \"baseline\", \"held-speed\", \"helix\", \"pulse\", \"phase-sync\", \"meandering\", \"probing\", \"lidar-loop\", \"steering\", \"derate\", \"discon\", \"absent\"",
        ),
        (
            "\"helix\", sense = \"ccw\"",
            "\"phase-sync\", offset_deg = 90",
            "T1 is to join a helix, but no turbine upstream of it pitches one in this run; give a turbine upstream a helix",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, process_noise_phase = 1e-4, sense",
            "`run.helix.control.T1.process_noise_phase` has no effect here: it applies only with a published estimator",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, wandering_amplitude = 1e-4, sense",
            "there is no key `run.helix.control.T1.wandering_amplitude`; it is called `process_noise_amplitude` now",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, wandering_phase = 1e-4, sense",
            "there is no key `run.helix.control.T1.wandering_phase`; it is called `process_noise_phase` now",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, amplitudes = \"separate\", sense",
            "`run.helix.control.T1.amplitudes` has no effect here: it applies only with a published estimator",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, dynamic_inflow = \"two-constant\", wake_time_factor = 0.5, sense",
            "`run.helix.control.T1.wake_time_factor` has no effect here: it applies only with dynamic_inflow = \"snel-schepers\"",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, measurement_noise_1s_mnm = 0, sense",
            "`run.helix.control.T1.measurement_noise_1s_mnm` = 0 is out of range: 0 < measurement_noise_1s_mnm <= 10000 MN m",
        ),
        (
            "\"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25",
            "\"meandering\", factor = 1.5, amplitude_deg = 4.0, strouhal_low = 0.3",
            "`run.helix.control.T1.strouhal_low` = 0.3 is not below `strouhal_high` = 0.3; wakes meander",
        ),
        (
            "\"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25",
            "\"meandering\", factor = 1.5, amplitude_deg = 4.0, reference = \"given\", reference_tilt_mnm = 7",
            "`run.helix.control.T1.reference_yaw_mnm` is missing; reference = \"given\" needs the amplitudes",
        ),
        (
            "\"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25",
            "\"meandering\", factor = 1.5, amplitude_deg = 4.0, learning_time = 60",
            "`run.helix.control.T1.learning_time` has no effect here: it applies only with reference = \"learned\", not \"observed\"; leave it out",
        ),
        (
            "\"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25",
            "\"meandering\", factor = 1.5, amplitude_deg = 4.0, azimuth_offset_deg = 38, delay = 1",
            "`run.helix.control.T1.moment_per_degree_mnm` is missing; azimuth_offset_deg, delay and moment_per_degree_mnm go together",
        ),
        (
            "\"helix\", sense = \"ccw\", amplitude_deg = 4.0, strouhal = 0.25",
            "\"meandering\", factor = -1, amplitude_deg = 4.0",
            "`run.helix.control.T1.factor` = -1 is out of range: 0 <= factor <= 10",
        ),
        (
            "[time]",
            "[output]\nlines_at = [\"T9\"]\n[time]",
            "`output.lines_at` names the turbine `T9`, which the file does not have",
        ),
        (
            "[time]",
            "[output]\nvolume_stride = 1\n[time]",
            "small.toml:7: `output.volume_stride` has no effect here: no volumes are kept without `output.volume_interval`; add `volume_interval`, or leave `volume_stride` out",
        ),
        (
            "\"helix\", sense",
            "\"pulse\", sense",
            "there is no key `run.helix.control.T1.sense`; control.T1 = { kind = \"pulse\", … } knows",
        ),
        (
            "\"ccw\"",
            "\"acw\"",
            "`run.helix.control.T1.sense` = \"acw\" is unknown; expected one of \"cw\", \"ccw\"; one of",
        ),
        ("\"helix\", sense", "\"helx\", sense", "did you mean \"helix\"?"),
        (
            "0.25 }",
            "0.25, start = 900 }",
            "`run.helix.control.T1.start` = 900 s is not before the end",
        ),
        (
            "[time]",
            "[flow]\nsolver = \"potential\"\n[time]",
            "`flow.solver` = \"potential\" is unknown; expected one of \"lattice\"",
        ),
        ("[time]", "[flow]\ncells_per_diameter = 6\n[time]", "8 <= cells_per_diameter <= 200"),
        (
            "[time]",
            "[flow]\nground = \"rough\"\n[time]",
            "`flow.ground` must be \"slip\" or { roughness_length = 0.001 }",
        ),
        ("[time]", "[flow]\nthreads = 0\n[time]", "1 <= threads <= 1024"),
        (
            "speed = 9",
            "speed = 9\nseed = 1.5",
            "`wind.seed` must be a whole number, found a number",
        ),
        ("speed = 9", "speed = 9\nseed = -1", "`wind.seed` = -1 is out of range"),
        (
            "[[run]]\nname = \"baseline\"",
            "[[run]]\nname = \"HELIX\"",
            "the run name `helix` is used twice",
        ),
        ("speed = 9", "speed 9", "small.toml:4: this is not TOML"),
        ("speed = 9", "speed = 9\nspeed = 8", "small.toml:5: this is not TOML: duplicate key"),
    ];
    for (from, to, expected) in cases {
        let lines = message(from, to);
        assert!(lines.contains(expected), "{from} -> {to}\nexpected {expected}\nfound    {lines}");
    }
}

#[test]
fn everything_wrong_is_reported_at_once_from_top_to_bottom() {
    let text = SMALL.replace("speed = 9", "speed = 900").replace("[5.0, 0.0]", "[0.0]");
    let error = parse("small.toml", &text, &[]).unwrap_err();
    let lines: Vec<usize> = error.problems().iter().map(Problem::line).collect();
    assert_eq!(lines, [4, 16]);
    assert_eq!(error.to_string(), "small.toml cannot be run: 2 of its entries are wrong");
    let empty = parse("empty.toml", "", &[]).unwrap_err();
    let keys = ["name", "wind", "time", "turbine", "run"];
    assert_eq!(empty.problems().len(), keys.len(), "{}", empty.to_lines());
}

#[test]
fn a_drawn_error_points_at_the_value() {
    let error = parse("small.toml", &SMALL.replace("speed = 9", "speed = 900"), &[]).unwrap_err();
    let mut drawing = String::new();
    let theme = miette::GraphicalTheme::unicode_nocolor();
    miette::GraphicalReportHandler::new_themed(theme).render_report(&mut drawing, &error).unwrap();
    assert!(
        drawing.contains("[small.toml:4:9]") && drawing.contains("help: did you mean 9 m/s?"),
        "{drawing}"
    );
}

/// Found by fuzzing: what draws errors gave up on columns that 16 bits do not count.
#[test]
fn a_problem_on_an_endless_line_is_reported_without_a_drawing() {
    let endless = format!("speed = 900{}# and on\n", " ".repeat(70_000));
    for text in [SMALL.replace("speed = 9\n", &endless), SMALL.replace("speed = 9", &endless)] {
        let error = parse("small.toml", &text, &[]).unwrap_err();
        let mut drawing = String::new();
        miette::GraphicalReportHandler::new().render_report(&mut drawing, &error).unwrap();
        assert!(drawing.contains("small.toml:4") && drawing.contains("did you mean 9 m/s?"));
        assert!(error.to_lines().starts_with("small.toml:4: `wind.speed` = 900"));
    }
}

#[test]
fn errors_of_overrides_name_the_override() {
    let cases = [
        ("wind.speed=900", "--set:1: `wind.speed` = 900 is out of range"),
        ("wind.speed=fast", "--set:1: `wind.speed` must be a number, found text \"fast\""),
        ("wind.sped=9", "--set:1: there is no key `wind.sped`; did you mean `speed`?"),
        ("wind.speed", "the override `wind.speed` cannot be applied: it has no `=`"),
        ("turbine.T9.model=x", "there is no turbine numbered (from 0) or named `T9`"),
        ("turbine.2.model=x", "there is no turbine numbered (from 0) or named `2`"),
        ("name.first=x", "`name` holds no keys"),
        (".=1", "a part of its key is empty"),
    ];
    for (text, expected) in cases {
        let lines = small(&[text]).unwrap_err().to_lines();
        assert!(lines.contains(expected), "{text}\nexpected {expected}\nfound    {lines}");
    }
}

#[test]
fn a_file_that_is_not_there_or_not_text_is_reported() {
    let error = read(Path::new("cases/no-such.toml"), &[]).unwrap_err();
    assert!(error.to_string().contains("cannot read the case file cases/no-such.toml"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bytes.toml");
    fs::write(&path, [b'a', 0xff, 0xfe]).unwrap();
    let error = read(&path, &[]).unwrap_err();
    assert!(error.to_string().contains("byte 1 is not UTF-8 text"), "{error}");
}

#[test]
fn a_run_cannot_have_the_name_of_what_a_study_keeps_beside_it() {
    for name in ["figures", "Figures"] {
        let told = message("name = \"baseline\"\n", &format!("name = \"{name}\"\n"));
        let expected = format!("`run.{name}.name` cannot be that: a study's folder has its own");
        assert!(told.contains(&expected), "{told}");
    }
}

#[test]
fn after_the_first_hundred_problems_no_more_are_looked_for() {
    let keys: String = (0..100_000).map(|key| format!("spead_{key} = 9\n")).collect();
    let error =
        parse("small.toml", &SMALL.replacen("[wind]\n", &format!("[wind]\n{keys}"), 1), &[]);
    let error = error.unwrap_err();
    assert_eq!(error.problems().len(), 100);
    let said = "small.toml cannot be run: 100 of its entries are wrong, or more: the rest is not looked at";
    assert_eq!(error.to_string(), said);
}

#[test]
fn what_is_drawn_of_a_file_cannot_steer_a_terminal() {
    let text = SMALL.replacen("speed = 9", "speed = 9 # \u{1b}[2J\u{9b}31m é", 1);
    let error = parse("small.toml", &text, &[]).unwrap_err();
    let mut drawn = String::new();
    miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::none())
        .render_report(&mut drawn, &error)
        .unwrap();
    assert!(!drawn.contains(['\u{1b}', '\u{9b}']) && drawn.contains("9 # ?[2J¿31m é"), "{drawn:?}");
}
