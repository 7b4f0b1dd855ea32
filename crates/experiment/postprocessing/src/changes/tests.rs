//! Synthetic studies of two turbines, open and closed, in several winds.

use super::*;
use basis::records::examples::{damage_equivalent, load, statistic};
use basis::records::{Conditions, FlowSummary, Summary, examples};
use formats::case;
use formats::records::{Manifest, SeriesWriter};
use std::path::Path;
use tempfile::TempDir;

const CASE: &str = r#"
name = "two"
[wind]
speed = 10.0
turbulence_intensity = 0.06
shear_exponent = 0.2
[time]
spin_up = 300.0
duration = 1500.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [4.0, 0.0]
[[run]]
name = "open"
[[run]]
name = "closed"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 3.0, strouhal = 0.3 }
"#;

/// Power (W) and flapwise load (kN m) of each turbine in the open loop.
const OPEN: [[f64; 2]; 2] = [[3e6, 6000.0], [1e6, 2000.0]];

/// The case in the wind of `seed` with turbulence of `intensity` (–).
fn text(seed: u64, intensity: f64) -> String {
    CASE.replace("0.06", &format!("{intensity:?}\nseed = {seed}"))
}

/// Leaves run number `index` of the case in `text`, whose turbines have the powers and loads `values`.
fn leave(folder: &Path, text: &str, index: usize, values: [[f64; 2]; 2]) {
    let case = case::parse("two.toml", text, &[]).expect("a sound case");
    let manifest = Manifest::start("0.1.0", &case, text, index, [("nrel-5mw", "a turbine")]);
    let run = RunFolder::new(folder, &manifest.run);
    run.create().expect("a folder");
    let turbine = |(name, [power, moment]): (&str, [f64; 2])| {
        let mut turbine = examples::turbine(name, power);
        let kind = damage_equivalent(10.0);
        turbine.loads = vec![load("RootMyb1", kind, moment)];
        if index > 0 {
            let blocks = |mean: f64| basis::records::Statistic { n_blocks: 2, ..statistic(mean) };
            turbine.loads[0].change = Some(blocks(0.1));
            turbine.power_gain = Some(blocks(0.05));
        }
        turbine
    };
    let turbines = ["T1", "T2"].into_iter().zip(values).map(turbine).collect();
    let made = examples::summary(&manifest.run, turbines);
    let flow = FlowSummary {
        solver: "vortex".into(),
        has_wakes: true,
        limits: String::new(),
        grids: Vec::new(),
    };
    let summary = Summary {
        compare_with: (index > 0).then(|| "open".to_owned()),
        flow: Some(flow),
        array_power_gain: (index > 0).then(|| statistic(0.02)),
        conditions: Conditions {
            seed: case.wind.seed,
            target_wind_speed: 10.0,
            target_turbulence_intensity: case.wind.turbulence_intensity,
            shear_exponent: Some(0.2),
            ..made.conditions
        },
        ..made
    };
    records::write_manifest(&run, &manifest.finish("portable")).expect("a file");
    records::write_summary(&run, &summary).expect("a file");
}

/// A study in which power and load of T1 and T2 change by `changes` (–).
fn study(seed: u64, intensity: f64, changes: [[f64; 2]; 2]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = text(seed, intensity);
    leave(folder.path(), &text, 0, OPEN);
    let closed = [0, 1].map(|t| [0, 1].map(|q| OPEN[t][q] * (1.0 + changes[t][q])));
    leave(folder.path(), &text, 1, closed);
    folder
}

fn ask(studies: &[&TempDir]) -> Result<ChangesAnswer, PostprocessingError> {
    ask_for("RootMyb1", studies)
}

fn ask_for(channel: &str, studies: &[&TempDir]) -> Result<ChangesAnswer, PostprocessingError> {
    changes(&ChangesQuestion {
        studies: studies.iter().map(|study| study.path().to_owned()).collect(),
        runs: Vec::new(),
        channels: vec![channel.to_owned()],
    })
}

/// Leaves the series of both runs in the folder `study`, with these channels besides the time, whose values
/// are `row` of the run and the second (–).
fn leave_series(study: &Path, names: &[&'static str], row: impl Fn(&str, u32) -> Vec<f64>) {
    for run in ["open", "closed"] {
        let mut channels = vec![TIME];
        for name in names {
            channels.push(basis::Channel::new(name, basis::Unit::KilonewtonMetre));
        }
        let path = RunFolder::new(study, run).series_path();
        let mut writer = SeriesWriter::create(&path, &channels).expect("a file");
        for step in 0..1500 {
            let row = [vec![f64::from(step)], row(run, step)].concat();
            writer.write(&row).expect("a row");
        }
        writer.finish().expect("a file");
    }
}

fn row<'a>(answer: &'a ChangesAnswer, is_power: bool, part: &str) -> &'a ChangesRow {
    let is_asked =
        |row: &&ChangesRow| row.part == part && (row.quantity == Quantity::Power) == is_power;
    answer.rows.iter().find(is_asked).expect("a row")
}

#[test]
fn loads_add_up_over_turbines_and_winds_of_unlike_seeds_count_together() {
    let turbulent = [(1, 0.04), (2, 0.1), (3, 0.07)]
        .map(|(seed, change)| study(seed, 0.06, [[-0.01, change], [0.05, 2.0 * change]]));
    let even = study(1, 0.0, [[0.0, 0.2], [0.0, 0.4]]);
    // One wind alone is told by the blocks of its series.
    leave_series(even.path(), &["T1.RootMyb1", "T2.RootMyb1"], |_, step| {
        vec![f64::from(step % 2), f64::from(step % 3)]
    });
    let answer = ask(&[&turbulent[0], &even, &turbulent[1], &turbulent[2]]).expect("sound studies");
    let names: Vec<&str> = answer.winds.iter().map(|wind| wind.name.as_str()).collect();
    assert_eq!(names, ["shear 0.2, TI 6 %", "shear 0.2"]);
    assert_eq!(answer.winds[0].studies.len(), 3);
    let parts: Vec<&str> = answer.rows.iter().map(|row| row.part.as_str()).collect();
    assert_eq!(parts, ["T1", "T2", "all", "T1", "T2", "all"]);
    let power = row(&answer, true, "all").changes[0].as_ref().expect("a change");
    // 3 MW less 1 %, 1 MW more 5 %.
    assert!((power.together.mean - 0.02 / 4.0).abs() < 1e-12);
    let loads = row(&answer, false, "all").changes[0].as_ref().expect("a change");
    for (found, change) in loads.each.iter().zip([0.04, 0.1, 0.07]) {
        // Three quarters of the load are T1's.
        assert!((found - change * (0.75 + 0.5)).abs() < 1e-12, "{found}");
    }
    // Deviations of ±0.0375 and 0 about 0.0875; t(0.975, 2) = 4.302653.
    let half = loads.together.half_width_95.expect("three winds");
    assert!((half - 4.302_653 * 0.0375 / 3.0_f64.sqrt()).abs() < 1e-7, "{half}");
}

#[test]
fn one_wind_has_what_its_summary_tells_and_the_blocks_of_its_series() {
    let even = study(1, 0.0, [[0.0, 0.2], [0.0, 0.4]]);
    // T1 swings by 1 and 1, and 1.1 and 1.3; T2 by 1 throughout.
    leave_series(even.path(), &["T1.RootMyb1", "T2.RootMyb1"], |run, step| {
        let sizes = if run == "open" { [1.0, 1.0] } else { [1.1, 1.3] };
        let sign = if step % 2 == 0 { 1e3 } else { -1e3 };
        vec![sign * sizes[usize::from(step >= 900)], sign]
    });
    let answer = ask(&[&even]).expect("a sound study");
    let of = |is_power, part: &str| {
        row(&answer, is_power, part).changes[0].as_ref().expect("a change").together
    };
    assert_eq!([of(true, "T1").mean, of(true, "all").mean], [0.05, 0.02]);
    assert_eq!(of(false, "T1").mean, 0.1);
    let all = of(false, "all");
    // (1.1 + 1)/2 and (1.3 + 1)/2: 0.05 and 0.15, t(0.975, 1) = 12.706205.
    let half = all.half_width_95.expect("two blocks");
    assert!((half - 12.706_205 * 0.05).abs() < 1e-3 * half, "{half}");
    assert_eq!(all.n_blocks, 2);
}

#[test]
fn wind_without_turbulence_counts_once_whatever_its_seeds() {
    let alike = [1, 2].map(|seed| study(seed, 0.0, [[0.0, 0.2], [0.0, 0.4]]));
    // A series is not needed where blocks are not told.
    for folder in &alike {
        for (run, index) in [("open", 0), ("closed", 1)] {
            let at = RunFolder::new(folder.path(), run);
            let mut summary = records::read_summary(&at).expect("a summary");
            for turbine in &mut summary.turbines {
                turbine.loads[0].change = (index > 0).then(|| statistic(0.1));
            }
            records::write_summary(&at, &summary).expect("a file");
        }
    }
    let answer = ask(&alike.each_ref()).expect("sound studies");
    let loads = row(&answer, false, "all").changes[0].as_ref().expect("a change");
    assert_eq!((loads.each.len(), loads.together.half_width_95), (1, None));
    assert!(answer.remarks.iter().any(|remark| remark.contains("it counts once")));
    // Of turbulent wind the same seed twice is refused.
    let again = [0, 1].map(|_| study(1, 0.06, [[0.0, 0.2], [0.0, 0.4]]));
    let error = ask(&again.each_ref()).expect_err("one wind twice");
    assert!(matches!(error, PostprocessingError::Seeds(SeedsError::SameWind { .. })));
}

#[test]
fn a_sum_of_loads_is_of_all_turbines_or_of_none() {
    let even = study(1, 0.0, [[0.0, 0.2], [0.0, 0.4]]);
    leave_series(even.path(), &["T1.RootMyb1"], |_, step| vec![f64::from(step % 2)]);
    let error = ask(&[&even]).expect_err("T2 is not there");
    let PostprocessingError::MissingChannel { path, channel } = error else {
        panic!("{error}");
    };
    assert_eq!(channel, "T2.RootMyb1");
    assert!(path.is_some_and(|path| path.starts_with(even.path().join("closed"))));
}

#[test]
fn a_channel_that_nobody_tells_of_is_remarked_with_those_that_are_told() {
    let alike = [1, 2].map(|seed| study(seed, 0.06, [[0.0, 0.2], [0.0, 0.4]]));
    let answer = ask_for("RootMyb9", &alike.each_ref()).expect("sound studies");
    assert!(answer.rows.iter().all(|row| row.quantity == Quantity::Power));
    let expected =
        "no run tells the damage-equivalent load of `RootMyb9`: they tell those of RootMyb1";
    assert_eq!(answer.remarks, [expected]);
}
