//! Synthetic studies of a row of three in several winds.

use super::*;
use basis::records::{Conditions, examples};
use formats::records::RunFolder;
use tempfile::TempDir;

/// The turbines stand in another order than the file names them.
const CASE: &str = r#"
name = "row"
[wind]
speed = 9.0
turbulence_intensity = 0.05
[time]
spin_up = 300.0
duration = 900.0
[[turbine]]
name = "T3"
model = "iea-15mw"
position_diameters = [10.0, 0.0]
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
[[run]]
name = "two"
control.T3 = { kind = "absent" }
"#;

/// Power at baseline (W) of T3, T1 and T2.
const BASELINE: [f64; 3] = [5e6, 12e6, 4e6];

/// A complete run number `index` of the case in `text`, with the powers (W) of its turbines.
fn leave(folder: &Path, text: &str, index: usize, powers: &[(&str, f64)]) {
    let case = case::parse("row.toml", text, &[]).expect("a sound case");
    let manifest = Manifest::start("0.1.0", &case, text, index, [("iea-15mw", "a turbine")]);
    let run = RunFolder::new(folder, &manifest.run);
    run.create().expect("a folder");
    let turbines = powers.iter().map(|(name, power)| examples::turbine(name, *power)).collect();
    let made = examples::summary(&manifest.run, turbines);
    let summary = Summary {
        compare_with: (index > 0).then(|| "baseline".to_owned()),
        conditions: Conditions { seed: case.wind.seed, ..made.conditions },
        ..made
    };
    records::write_manifest(&run, &manifest.finish("portable")).expect("a file");
    records::write_summary(&run, &summary).expect("a file");
}

/// The case in the wind of seed number `seed`.
fn seeded(seed: u64) -> String {
    CASE.replace("speed = 9.0", &format!("speed = 9.0\nseed = {seed}"))
}

/// A study in which the helix gives T3, T1 and T2 the `gains` (–), and T3 is away in the run "two", in which
/// T2 makes a quarter more.
fn study(seed: u64, gains: [f64; 3]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = seeded(seed);
    let [p3, p1, p2] = BASELINE;
    let [g3, g1, g2] = gains.map(|gain| 1.0 + gain);
    leave(folder.path(), &text, 0, &[("T3", p3), ("T1", p1), ("T2", p2)]);
    leave(folder.path(), &text, 1, &[("T3", g3 * p3), ("T1", g1 * p1), ("T2", g2 * p2)]);
    leave(folder.path(), &text, 2, &[("T1", p1), ("T2", 1.25 * p2)]);
    folder
}

fn ask(studies: &[&TempDir], runs: &[&str]) -> Result<GainsAnswer, PostprocessingError> {
    gains_over_seeds(&GainsQuestion {
        studies: studies.iter().map(|study| study.path().to_owned()).collect(),
        runs: runs.iter().map(|&run| run.to_owned()).collect(),
    })
}

#[test]
fn gains_of_three_winds_have_the_interval_of_student() {
    let of_t3 = [0.106, 0.097, 0.119];
    let studies = [1, 2, 3].map(|seed| study(seed, [of_t3[seed as usize - 1], -0.05, 0.2]));
    let answer = ask(&studies.each_ref(), &[]).expect("sound studies");
    assert_eq!(answer.case, "row");
    assert_eq!(answer.seeds, [1, 2, 3]);
    assert_eq!(answer.downstream, ["T3", "T2"]);
    let reported: Vec<[&str; 2]> =
        answer.runs.iter().map(|run| [run.run.as_str(), run.compare_with.as_str()]).collect();
    assert_eq!(reported, [["helix", "baseline"], ["two", "baseline"]]);
    let parts = &answer.runs[0].parts;
    let names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["T3", "T1", "T2", "downstream", "all"]);
    for (wind, gain) in of_t3.iter().enumerate() {
        let won = [5.0 * gain, -0.6, 0.8];
        let expected = [*gain, -0.05, 0.2, (won[0] + won[2]) / 9.0, won.iter().sum::<f64>() / 21.0];
        for (part, expected) in parts.iter().zip(expected) {
            assert!((part.gains[wind] - expected).abs() < 1e-12, "{part:?}, {expected}");
        }
    }
    // Deviations of −1/750, −31/3000 and 7/600 about the mean; t(0.975, 2) = 4.302653.
    let squares =
        (1.0_f64 / 750.0).powi(2) + (31.0_f64 / 3000.0).powi(2) + (7.0_f64 / 600.0).powi(2);
    let half_width = parts[0].together.half_width_95.expect("three winds");
    assert!((half_width - 4.302_653 * (squares / 6.0).sqrt()).abs() < 1e-8, "{half_width}");
    assert!((parts[0].together.mean - 0.322 / 3.0).abs() < 1e-12);
    // What is the same in all winds is certain.
    assert!(parts[1].together.half_width_95.is_some_and(|half_width| half_width < 1e-12));
}

#[test]
fn a_gain_over_no_power_is_left_out_and_told() {
    let studies = [1, 2].map(|seed| study(seed, [0.1, 0.0, 0.2]));
    let [p3, p1, _] = BASELINE;
    // In one wind T2 stands still at baseline.
    leave(studies[1].path(), &seeded(2), 0, &[("T3", p3), ("T1", p1), ("T2", 0.0)]);
    let answer = ask(&studies.each_ref(), &["helix"]).expect("the rest");
    let names: Vec<&str> = answer.runs[0].parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["T3", "T1", "downstream", "all"]);
    let [told] = answer.undefined.as_slice() else { panic!("{:?}", answer.undefined) };
    assert!(told.contains("T2") && told.contains("baseline"), "{told}");
    assert!(told.contains(&studies[1].path().display().to_string()), "{told}");
}

#[test]
fn turbines_that_are_away_are_not_counted_together() {
    let studies = [1, 2].map(|seed| study(seed, [0.1, 0.0, 0.0]));
    let answer = ask(&studies.each_ref(), &["two"]).expect("sound studies");
    assert_eq!(answer.runs.len(), 1);
    let parts = &answer.runs[0].parts;
    let names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["T1", "T2"]);
    assert_eq!(parts[1].gains, [0.25, 0.25]);
}

/// Why `studies` tell nothing of `runs`.
fn refused(studies: &[&TempDir], runs: &[&str]) -> SeedsError {
    match ask(studies, runs) {
        Err(PostprocessingError::Seeds(error)) => error,
        other => panic!("{other:?}"),
    }
}

#[test]
fn studies_that_do_not_belong_together_are_refused() {
    let first = study(1, [0.1, 0.0, 0.0]);
    assert_eq!(refused(&[&first], &[]), SeedsError::TooFew { n_studies: 1 });
    let again = study(1, [0.2, 0.0, 0.0]);
    assert!(matches!(refused(&[&first, &again], &[]), SeedsError::SameWind { seed: 1, .. }));

    let lacking = study(2, [0.1, 0.0, 0.0]);
    std::fs::remove_dir_all(lacking.path().join("helix")).expect("a run");
    let expected = SeedsError::Runs {
        folder: lacking.path().to_owned(),
        missing: vec!["helix".to_owned()],
        common: vec!["two".to_owned()],
    };
    assert_eq!(refused(&[&first, &lacking], &[]), expected);
    assert_eq!(refused(&[&first, &lacking], &["helix"]), expected);
    // What all have can be asked for.
    assert!(ask(&[&first, &lacking], &["two"]).is_ok());
    std::fs::remove_dir_all(lacking.path().join("baseline")).expect("a run");
    let nothing = SeedsError::NoGains { folder: lacking.path().to_owned() };
    assert_eq!(refused(&[&lacking, &lacking], &[]), nothing);

    let other = study(3, [0.1, 0.0, 0.0]);
    let text = seeded(3).replace("speed = 9.0", "speed = 8.0");
    let powers = [("T3", 5e6), ("T1", 12e6), ("T2", 4e6)];
    leave(other.path(), &text, 1, &powers);
    let error = refused(&[&first, &other], &["helix"]);
    assert!(matches!(&error, SeedsError::Cases { run, .. } if run == "helix"), "{error}");

    leave(other.path(), &seeded(3), 1, &powers[1..]);
    let error = refused(&[&first, &other], &["helix"]);
    let reported = format!("T1, T2 in {} and T3, T1, T2 in", other.path().display());
    assert!(error.to_string().contains(&reported), "{error}");
}
