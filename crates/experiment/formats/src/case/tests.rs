//! What the case file's users see: good files read, bad ones told where and how to mend.

use super::*;
use control::meandering::{Followed, Leader, MeanderingSettings, Reference};
use control::phase_sync::{PhaseNoise, PhaseSyncSettings};
use farm::case::{Control, Ground, Sense, Sides};
use proptest::prelude::*;
use std::fs;

const SMALL: &str = r#"
name = "small"
[wind]
speed = 9
turbulence_intensity = 0.05
[time]
spin_up = 300
duration = 900.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0, 0.0]
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
compare_with = "baseline"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

fn small(overrides: &[&str]) -> Result<Case, CaseError> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse("small.toml", SMALL, &overrides)
}

/// The lines that a user sees after `from` was replaced by `to` in the small case.
fn told(from: &str, to: &str) -> String {
    assert!(SMALL.contains(from), "the small case does not hold {from}");
    parse("small.toml", &SMALL.replacen(from, to, 1), &[]).unwrap_err().to_lines()
}

#[test]
fn a_small_case_gets_the_documented_defaults() {
    let case = small(&[]).unwrap();
    assert_eq!(case.wind.length_scale, 33.6);
    assert_eq!(case.wind.seed, 1);
    assert_eq!(case.flow.cells_per_diameter, 16.0);
    assert_eq!((case.flow.ground, case.flow.sides), (Ground::Slip, Sides::Periodic));
    assert_eq!((case.flow.step, case.flow.threads), (None, None));
    assert_eq!(case.output.checkpoint_interval, 300.0);
    assert_eq!(case.runs[0].control, [Control::baseline(), Control::baseline()]);
    let helix = &case.runs[1].control[0];
    assert_eq!(helix.helix(), Some((Sense::CounterClockwise, 0.25)));
    assert_eq!(helix.values().angle("amplitude_deg"), 4f64.to_radians());
    assert_eq!(helix.values().number("start"), 0.0);
}

#[test]
fn helix_and_pulse_may_stop() {
    for kind in ["\"helix\", sense = \"cw\"", "\"pulse\""] {
        let control = format!("kind = {kind}, amplitude_deg = 4, strouhal = 0.25, stop = 300.5");
        let case = small(&[&format!("run.helix.control.T1={{ {control} }}")]).unwrap();
        let stop = case.runs[1].control[0].values().optional_number("stop");
        assert_eq!(stop, Some(300.5), "{kind}");
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    }
    let plain = write(&small(&[]).unwrap());
    assert!(!plain.contains("stop"), "{plain}");
}

/// The meandering control of a small case that says `keys` beside factor and amplitude, after it was written and read.
fn meandering(keys: &str) -> MeanderingSettings {
    let control = format!("kind = \"meandering\", factor = 1.5, amplitude_deg = 4{keys}");
    let case = small(&[&format!("run.helix.control.T1={{ {control} }}")]);
    let case = case.unwrap_or_else(|error| panic!("{}", error.to_lines()));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case, "{keys}");
    MeanderingSettings::of(&case.runs[1].control[0]).expect("meandering")
}

#[test]
fn meandering_needs_little_to_be_said() {
    let usual = meandering("");
    assert_eq!((usual.factor, usual.amplitude, usual.offset), (1.5, 4f64.to_radians(), 0.0));
    assert_eq!(usual.strouhal, [0.15, 0.3]);
    assert_eq!((usual.sense, usual.leader), (Sense::Clockwise, Leader::Both));
    assert_eq!((usual.followed, usual.reference), (Followed::Wake, Reference::Observed));
    assert_eq!((usual.bandwidth, usual.decoupling, usual.start), (0.01, None, 0.0));

    let learned = meandering(", reference = \"learned\", followed = \"load\", leader = \"yaw\"");
    assert_eq!(learned.reference, Reference::Learned { duration: 300.0 });
    assert_eq!((learned.followed, learned.leader), (Followed::Load, Leader::Yaw));

    let given = meandering(
        ", reference = \"given\", reference_tilt_mnm = 7.77, reference_yaw_mnm = 10.87, \
         azimuth_offset_deg = 38.4, delay = 0.99, moment_per_degree_mnm = 4.2, sense = \"ccw\"",
    );
    assert_eq!(given.reference, Reference::Given { tilt: 7.77e6, yaw: 10.87e6 });
    let decoupling = given.decoupling.unwrap();
    assert_eq!((decoupling.azimuth_offset, decoupling.delay), (38.4f64.to_radians(), 0.99));
    assert!((decoupling.gain * 1f64.to_radians() - 4.2e6).abs() < 1e-3);
    assert_eq!(given.sense, Sense::CounterClockwise);
}

/// The phase synchronisation of T2 in a small case that says `keys` beside the needed ones, after it was written and read.
fn phase_sync(keys: &str) -> PhaseSyncSettings {
    let control = format!("kind = \"phase-sync\", offset_deg = 90, amplitude_deg = 4{keys}");
    let case = small(&[&format!("run.helix.control.T2={{ {control} }}")]);
    let case = case.unwrap_or_else(|error| panic!("{}", error.to_lines()));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case, "{keys}");
    PhaseSyncSettings::of(&case.runs[1].control[1]).expect("phase-sync")
}

#[test]
fn noise_of_a_phase_estimator_is_its_own_unless_given() {
    assert_eq!(phase_sync("").noise, PhaseNoise::default());
    let robust = phase_sync(", measurement_noise_mnm = 0.3141, wandering_amplitude = 2.5e-4");
    assert_eq!(robust.noise.measurement, Some(0.3141 * 1e6));
    assert_eq!(robust.noise.wandering_amplitude, Some(2.5e-4));
    assert_eq!(robust.noise.wandering_phase, None);
    let published = phase_sync(", estimator = \"published\", wandering_phase = 3e-4");
    let expected = PhaseNoise { wandering_phase: Some(3e-4), ..PhaseNoise::default() };
    assert_eq!(published.noise, expected);
}

#[test]
fn the_azimuth_offset_of_a_turbine_in_step_is_found_unless_given() {
    assert_eq!(phase_sync("").azimuth_offset, None);
    assert_eq!(phase_sync(", azimuth_offset_deg = 0").azimuth_offset, Some(0.0));
    assert_eq!(phase_sync(", azimuth_offset_deg = 17").azimuth_offset, Some(17f64.to_radians()));
    // What only watches pitches nothing; its records are those of a turbine that was given none.
    let watching = |keys: &str| {
        let control = "kind = \"phase-sync\", offset_deg = 90, amplitude_deg = 0";
        small(&[&format!("run.helix.control.T2={{ {control}{keys} }}")]).unwrap()
    };
    let case = watching("");
    let sync = PhaseSyncSettings::of(&case.runs[1].control[1]).expect("phase-sync");
    assert_eq!(sync.azimuth_offset, Some(0.0));
    assert_eq!(case, watching(", azimuth_offset_deg = 0"));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    // An open helix is turned by nothing that it does not ask for.
    let case = small(&[]).unwrap();
    assert_eq!(case.runs[1].control[0].values().number("azimuth_offset_deg"), 0.0);
}

#[test]
fn stall_is_dynamic_where_the_wind_is_prescribed_unless_the_case_says_otherwise() {
    let of = |overrides: &[&str]| {
        let case = small(overrides).unwrap();
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
        [0, 1].map(|index: usize| case.turbines[index].dynamic_stall)
    };
    assert_eq!(of(&[]), [false, false]);
    assert_eq!(of(&["flow.solver=turbulence"]), [true, true]);
    assert_eq!(of(&["turbine.T1.stall=dynamic"]), [true, false]);
    assert_eq!(of(&["flow.solver=uniform", "turbine.T2.stall=steady"]), [true, false]);
}

#[test]
fn a_turbine_may_name_the_input_of_its_controller() {
    let case = small(&["turbine.T2.discon=rosco/DISCON.IN"]).unwrap();
    let asked: Vec<Option<&str>> = case.turbines.iter().map(|t| t.discon.as_deref()).collect();
    assert_eq!(asked, [None, Some("rosco/DISCON.IN")]);
    // Of one model, and yet not alike.
    assert_eq!(case.turbines[0].machine(), "iea-15mw");
    assert_ne!(case.turbines[0].machine(), case.turbines[1].machine());
    let written = write(&case);
    assert_eq!(parse("again", &written, &[]).unwrap(), case);
    let plain = write(&small(&[]).unwrap());
    assert!(!plain.contains("discon"), "{plain}");
    assert_ne!(fingerprint(&written, "helix"), fingerprint(&plain, "helix"));
    let lines = small(&["turbine.T2.discon=3"]).unwrap_err().to_lines();
    assert!(lines.contains("`turbine.T2.discon` must be text in quotes"), "{lines}");
}

#[test]
fn every_shipped_case_reads_and_reads_back() {
    for entry in fs::read_dir(root().join("cases")).unwrap() {
        let path = entry.unwrap().path();
        let file = read(&path, &[]).unwrap_or_else(|error| panic!("{}", error.to_lines()));
        assert_eq!(parse("again", &write(&file.case), &[]).unwrap(), file.case, "{path:?}");
    }
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
            "small.toml:16: turbines T1 and T2 overlap: they stand 0.50 diameters apart, 1 is the least; move one",
        ),
        ("[5.0, 0.0]", "[1200, 0.0]", "`turbine.T2.position_diameters` = 1200 is out of range"),
        ("\"T2\"", "\"T1\"", "small.toml:14: the turbine name `T1` is taken already"),
        (
            "\"T2\"",
            "\"T 2\"",
            "`turbine.T 2.name` = \"T 2\" is not a name: 1 to 64 letters, digits, `-` and `_` make one; try \"T-2\"",
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
            "`run.helix.control.T1.kind` = \"phase-lock\" does not exist; what exists is \"baseline\", \"helix\", \"pulse\", \"phase-sync\", \"meandering\", \"absent\"",
        ),
        (
            "\"helix\", sense = \"ccw\"",
            "\"phase-sync\", offset_deg = 90",
            "T1 shall join a helix, but no turbine upstream of it has one in this run; give a turbine upstream a helix",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, wandering_phase = 1e-4, sense",
            "`run.helix.control.T1.wandering_phase` is of no use here: it goes with estimator = \"published\"",
        ),
        (
            "\"helix\", sense",
            "\"phase-sync\", offset_deg = 90, measurement_noise_mnm = 0, sense",
            "`run.helix.control.T1.measurement_noise_mnm` = 0 is out of range: 0 < measurement_noise_mnm <= 10000 MN m",
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
            "`run.helix.control.T1.learning_time` is of no use here: it goes with reference = \"learned\", not \"observed\"; leave it out",
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
            "\"helix\", sense",
            "\"pulse\", sense",
            "there is no key `run.helix.control.T1.sense`; control.T1 = { kind = \"pulse\", … } knows",
        ),
        (
            "\"ccw\"",
            "\"acw\"",
            "`run.helix.control.T1.sense` = \"acw\" does not exist; what exists is \"cw\", \"ccw\"; one of",
        ),
        ("\"helix\", sense", "\"helx\", sense", "did you mean \"helix\"?"),
        (
            "0.25 }",
            "0.25, start = 900 }",
            "`run.helix.control.T1.start` = 900 s is not before the end",
        ),
        (
            "[time]",
            "[flow]\nsolver = \"vortex\"\n[time]",
            "`flow.solver` = \"vortex\" does not exist; what exists is \"lattice\"",
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
            "the run name `helix` is taken already",
        ),
        ("speed = 9", "speed 9", "small.toml:4: this is not TOML"),
        ("speed = 9", "speed = 9\nspeed = 8", "small.toml:5: this is not TOML: duplicate key"),
    ];
    for (from, to, expected) in cases {
        let lines = told(from, to);
        assert!(lines.contains(expected), "{from} -> {to}\nexpected {expected}\ntold     {lines}");
    }
}

#[test]
fn everything_wrong_is_told_at_once_from_top_to_bottom() {
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
fn a_problem_on_an_endless_line_is_told_without_a_drawing() {
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
fn overrides_reach_every_key() {
    let case = small(&[
        "wind.speed = 8",
        "flow.sides=slip",
        "flow.ground={ roughness_length = 0.001 }",
        "turbine.0.model=iea-22mw",
        "turbine.T2.position_diameters=[7, 0]",
        "run.helix.control.T1.amplitude_deg=3",
        "run.baseline.control.T2={ kind = \"pulse\", amplitude_deg = 2, strouhal = 0.3 }",
    ])
    .unwrap();
    assert_eq!(case.wind.speed, 8.0);
    assert_eq!(case.flow.sides, Sides::Slip);
    assert_eq!(case.flow.ground, Ground::Rough { roughness_length: 0.001 });
    assert_eq!(case.turbines[0].model, "iea-22mw");
    assert_eq!(case.turbines[1].position_diameters, [7.0, 0.0]);
    let helix = &case.runs[1].control[0];
    assert_eq!(helix.values().angle("amplitude_deg"), 3f64.to_radians());
    assert!(case.runs[0].control[1].is(&control::pulse::PULSE));
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
        assert!(lines.contains(expected), "{text}\nexpected {expected}\ntold     {lines}");
    }
}

#[test]
fn a_file_that_is_not_there_or_not_text_is_told() {
    let error = read(Path::new("cases/no-such.toml"), &[]).unwrap_err();
    assert!(error.to_string().contains("cannot read the case file cases/no-such.toml"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bytes.toml");
    fs::write(&path, [b'a', 0xff, 0xfe]).unwrap();
    let error = read(&path, &[]).unwrap_err();
    assert!(error.to_string().contains("byte 1 is not UTF-8 text"), "{error}");
}

/// Compares a committed page with the one made now; WAKEMIX_UPDATE=1 writes it instead.
fn is_current(path: &str, made: &str) {
    let path = root().join(path);
    if std::env::var_os("WAKEMIX_UPDATE").is_some() {
        fs::write(&path, made).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        committed == made,
        "{path:?} is not current: run WAKEMIX_UPDATE=1 cargo test -p wakemix-formats"
    );
}

#[test]
fn the_reference_page_and_the_schema_are_current() {
    is_current("docs/case-file.md", &reference());
    is_current("docs/case.schema.json", &schema());
}

#[test]
fn the_example_of_the_reference_page_reads() {
    let page = reference();
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    parse("docs/case-file.md", example, &[]).unwrap_or_else(|error| panic!("{}", error.to_lines()));
}

#[test]
fn every_default_of_the_table_is_what_the_reader_uses() {
    // Writing out a case writes every key; taking the keys with defaults away again must change nothing.
    let case = small(&[]).unwrap();
    let written = write(&case);
    for table in [&keys::WIND, &keys::FLOW, &keys::OUTPUT] {
        for key in table.keys {
            let basis::keys::LeftOut::Value(default) = key.left_out else { continue };
            let stated =
                format!("{}.{}={default}", table.heading.trim_matches(['[', ']']), key.name);
            assert_eq!(
                parse("written", &written, std::slice::from_ref(&stated)).unwrap(),
                case,
                "{stated}"
            );
        }
    }
}

#[test]
fn a_fingerprint_is_of_what_decides_the_bits() {
    let of = |overrides: &[&str]| fingerprint(&write(&small(overrides).unwrap()), "helix");
    let plain = of(&[]);
    assert_eq!(plain, fingerprint(SMALL, "helix"));
    for harmless in [
        "flow.threads=3",
        "description=words",
        "output.checkpoint_interval=9",
        "run.baseline.control.T1={ kind = \"absent\" }",
    ] {
        assert_eq!(of(&[harmless]), plain, "{harmless}");
    }
    for decisive in [
        "wind.seed=2",
        "run.helix.control.T1.phase_deg=1",
        "time.duration=901",
        "output.plane_interval=5",
    ] {
        assert_ne!(of(&[decisive]), plain, "{decisive}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}") {
        let _ = parse("random", &text, std::slice::from_ref(&text));
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        cuts in prop::collection::vec((0usize..800, 0usize..12, "[\\[\\]{}=.,\"'#\n a-z0-9_-]{0,6}"), 1..4),
    ) {
        let mut text = SMALL.to_owned();
        for (start, length, insert) in cuts {
            let start = start.min(text.len());
            text.replace_range(start..(start + length).min(text.len()), &insert);
        }
        if let Err(error) = parse("damaged", &text, &[]) {
            prop_assert!(!error.to_lines().is_empty());
        }
    }

    #[test]
    fn any_case_in_range_reads_back_as_written(
        speed in 0.1..40.0, seed in 0..i64::MAX as u64, amplitude in 0.0..10.0, phase in -360.0..360.0,
        roughness in 1e-6..5.0, x in 1.0..500.0, threads in prop::option::of(1usize..1024),
    ) {
        let mut case = small(&[
            &format!("wind.speed={speed:?}"), &format!("wind.seed={seed}"),
            &format!("run.helix.control.T1.amplitude_deg={amplitude:?}"),
            &format!("run.helix.control.T1.phase_deg={phase:?}"),
            &format!("flow.ground={{ roughness_length = {roughness:?} }}"),
            &format!("turbine.T2.position_diameters=[-{x:?}, 0]"),
        ]).unwrap();
        case.flow.threads = threads;
        case.description = Some("a \"quoted\"\tline \\ with ü".to_owned());
        prop_assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    }
}
