//! Sweeps as the reader takes them: names, comparisons, and what is wrong with them at its place.

use super::{CaseError, parse, parse_all};

const CASE: &str = r#"
name = "swept"
[wind]
speed = 9.0
turbulence_intensity = 0.1
[time]
spin_up = 5.0
duration = 20.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "ccw"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
[[run]]
name = "both"
compare_with = "ccw"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "pulse", amplitude_deg = 2.0, strouhal = 0.25 }
"#;

/// The case with `sweep` under `[sweep]`.
fn with(sweep: &str) -> String {
    format!("{CASE}[sweep]\n{sweep}\n")
}

/// Everything that is wrong with `sweep`, a line each.
fn wrong(sweep: &str, overrides: &[&str]) -> String {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    match parse_all("case.toml", &with(sweep), &overrides) {
        Err(error @ CaseError::Invalid { .. }) => error.to_lines(),
        other => panic!("{sweep}: {other:?}"),
    }
}

#[test]
fn each_run_takes_the_keys_that_its_controller_has_and_compares_with_its_like() {
    let sweep = "control.T1.strouhal = [0.2, 0.3]\n\"control.T2.amplitude_deg\" = [1, 2.5]";
    let case = parse("case.toml", &with(sweep), &[]).unwrap();
    let runs: Vec<(&str, Option<&str>)> =
        case.runs.iter().map(|run| (run.name.as_str(), run.compare_with.as_deref())).collect();
    assert_eq!(
        runs,
        [
            ("baseline", None),
            ("ccw-strouhal-0.2", None),
            ("ccw-strouhal-0.3", None),
            ("both-strouhal-0.2-amplitude_deg-1", Some("ccw-strouhal-0.2")),
            ("both-strouhal-0.2-amplitude_deg-2.5", Some("ccw-strouhal-0.2")),
            ("both-strouhal-0.3-amplitude_deg-1", Some("ccw-strouhal-0.3")),
            ("both-strouhal-0.3-amplitude_deg-2.5", Some("ccw-strouhal-0.3")),
        ]
    );
    // One run alone, by its name; and what is written of it reads back.
    let case = parse("case.toml", &with("\"run.ccw.control.T1.strouhal\" = [0.2, 0.3]"), &[]);
    let case = case.unwrap();
    assert_eq!(case.runs.len(), 4);
    let again = parse("written", &super::write(&case), &[]).unwrap();
    assert_eq!(again, case);
}

#[test]
fn other_keys_make_studies_named_by_their_values() {
    let sweep = "wind.speed = [8, 9.5]\n\"turbine.T2.position_diameters\" = [[5, 0], [7, 0.5]]";
    let (cases, swept) = parse_all("case.toml", &with(sweep), &[]).unwrap();
    let swept = swept.unwrap();
    let folders: Vec<&str> = swept.studies.iter().map(|study| study.folder.as_str()).collect();
    assert_eq!(
        folders,
        [
            "speed-8-position_diameters-5-0",
            "speed-8-position_diameters-7-0.5",
            "speed-9.5-position_diameters-5-0",
            "speed-9.5-position_diameters-7-0.5",
        ]
    );
    assert_eq!(cases[2].wind.speed, 9.5);
    assert_eq!(cases[1].turbines[1].position, farm::case::Position::Diameters([7.0, 0.5]));
    // Who wants one case is told that there are several.
    let error = parse("case.toml", &with(sweep), &[]).unwrap_err().to_lines();
    assert!(error.contains("wind.speed, turbine.T2.position_diameters makes several"), "{error}");
    // The command line may give other values.
    let other = ["sweep.wind.speed=[7]".to_owned()];
    let (cases, _) = parse_all("case.toml", &with(sweep), &other).unwrap();
    assert_eq!((cases.len(), cases[0].wind.speed), (2, 7.0));
}

#[test]
fn what_is_wrong_is_told_at_its_place_with_the_fix() {
    let line = |n: usize| format!("case.toml:{}: ", CASE.lines().count() + 1 + n);
    for (sweep, place, told, fix) in [
        ("\"wind.speed\" = 8", 1, "must be a list, found a whole number", "[ ... ]"),
        ("wind.speed = []", 1, "holds no value", "or leave the key out"),
        ("wind.speed = [8, 8.0]", 1, "holds 8 twice", "leave one of them out"),
        ("wind.speed = [8, 80]", 1, "`wind.speed` = 80 is out of range", "range"),
        ("wind.sped = [8]", 1, "there is no key `wind.sped`", "did you mean `speed`"),
        ("wind.speed = [8]\n\"wind.speed\" = [9]", 2, "is swept twice", "leave one"),
        ("wind.speed = [true]", 1, "holds true or false", "numbers, texts"),
        ("name = [\"a\", \"b\"]", 1, "`name` cannot be swept", "named by their values"),
        ("control.T1.strouhl = [0.2]", 1, "no run takes `control.T1.strouhl`", "give a [[run]]"),
        ("control.T3.strouhal = [0.2]", 1, "none has a control of T3", "control.T3 = {"),
        ("control.T1 = [1]", 1, "names no key of a control", "\"control.T1.strouhal\""),
        ("run.cw.control.T1.strouhal = [0.2]", 1, "there is no run `cw`", "baseline, ccw, both"),
        ("turbine.T7.model = [\"a\"]", 1, "there is no turbine", "their number, from 0"),
    ] {
        let lines = wrong(sweep, &[]);
        assert!(lines.contains(&line(place)) || place == 0, "{sweep}: {lines}");
        assert!(lines.contains(told) && lines.contains(fix), "{sweep}: {lines}");
    }
    let lines = wrong("wind.speed = [8, 9]", &["wind.speed=7"]);
    assert!(lines.contains("--set 'sweep.wind.speed=[...]'"), "{lines}");
    let lines = wrong("control.T1.strouhal = [0.2]", &["run.ccw.control.T1.strouhal=0.3"]);
    assert!(lines.contains("--set 'sweep.control.T1.strouhal=[...]'"), "{lines}");
    let many: Vec<String> = (1..=1001).map(|n| n.to_string()).collect();
    let lines = wrong(&format!("wind.seed = [{}]", many.join(", ")), &[]);
    assert!(lines.contains("more than 1000 studies") && lines.contains("fewer values"), "{lines}");
    let long = CASE.replace("\"ccw\"", &format!("\"{}\"", "c".repeat(60)));
    let text = format!("{long}[sweep]\ncontrol.T1.strouhal = [0.2]\n");
    let error = parse_all("case.toml", &text, &[]).unwrap_err().to_lines();
    assert!(error.contains("longer than 64") && error.contains("shorten"), "{error}");
}

#[test]
fn an_empty_sweep_or_none_is_no_sweep() {
    assert!(wrong("", &[]).contains("`sweep` is empty"));
    let (cases, sweep) = parse_all("case.toml", CASE, &[]).unwrap();
    assert!(cases.len() == 1 && sweep.is_none());
}
