//! From a table to a surrogate, and from its file to predictions, validation and figures.

use design::SurrogateModel;
use design::regression::{
    KernelText, PredictQuestion, Scatter, TrainQuestion, ValidateQuestion, cuts, draw_surrogate,
    fit_in_words, predict, train, validate,
};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use surrogate::Trend;

/// A load over wind and turbulence, each different input twice, with a little scatter.
fn table(path: &Path, n: usize) {
    let mut text = "wind [m/s],turbulence,still,load [MN-m]\n".to_owned();
    for row in 0..n {
        let place = (row / 2) as f64;
        let (wind, turbulence) =
            (6.0 + (0.618 * place).fract() * 6.0, (0.755 * place).fract() * 0.1);
        let scatter = 0.02 * (12.9 * row as f64).sin();
        let load = 3.0 + 0.3 * wind + 15.0 * turbulence * (0.5 * wind).sin() + scatter;
        writeln!(text, "{wind},{turbulence},1,{load}").expect("a string takes it");
    }
    fs::write(path, text).expect("written");
}

fn question(file: PathBuf) -> TrainQuestion {
    TrainQuestion {
        file,
        inputs: vec!["wind".to_owned(), "turbulence".to_owned()],
        output: "load".to_owned(),
        kernel: KernelText::new("se").expect("a kernel"),
        trend: Trend::Constant,
        deviation: None,
        group: None,
        estimates_noise: true,
        split: 0.7,
        seed: 1,
        n_starts: 2,
        n_inducing: None,
    }
}

#[test]
fn a_table_becomes_a_surrogate_that_its_file_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    table(&at("loads.csv"), 120);
    let found = train(&question(at("loads.csv"))).expect("a surrogate");
    assert_eq!(found.n, [120, 42, 18]);
    assert!(found.warnings.iter().any(|text| text.contains("84 rows have 42 different inputs")));
    let on_test = found.on_test.expect("rows kept aside");
    // The scatter has a deviation of 0.014, the load one of 0.6.
    assert!(on_test.root_mean_square < 0.05 && on_test.n == 18, "{on_test:?}");
    found.model.write(&at("model.json")).expect("written");
    assert_eq!(SurrogateModel::read(&at("model.json")).expect("read"), found.model);

    let asked = |means_only| PredictQuestion {
        model: at("model.json"),
        file: at("loads.csv"),
        means_only,
        group: 0,
    };
    let [bands, means] = [false, true].map(|means| predict(&asked(means)).expect("predictions"));
    assert!(bands.warnings.is_empty() || bands.warnings[0].contains("outside"));
    let scale = bands.means[0].abs();
    for (a, b) in bands.means.iter().zip(&means.means) {
        assert!((a - b).abs() < 1e-9 * scale, "{a} {b}");
    }
    bands.write(&at("out.csv")).expect("written");
    let text = fs::read_to_string(at("out.csv")).expect("read");
    let head =
        "wind [m/s],turbulence,load [MN-m],load_deviation [MN-m],load_observation_deviation [MN-m]";
    assert_eq!(text.lines().next(), Some(head));

    let asked = ValidateQuestion {
        model: at("model.json"),
        file: at("loads.csv"),
        deviation: None,
        group: None,
    };
    let held = validate(&asked).expect("validated");
    assert!(held.on_table.is_some_and(|found| found.covered_95.is_some()));
    assert_eq!((held.n_rows, held.pairs.len()), (120, 60));
    assert_eq!(found.test_pairs.len(), 18);
    let fit = fit_in_words(&[("trained on", found.on_training), ("kept aside", found.on_test)]);
    assert!(fit.starts_with("RMSPE ") && fit.ends_with("of 18 inputs kept aside"), "{fit}");
    let scatter = Some(Scatter { pairs: &held.pairs, fit });
    let two = Some([0, 1]);
    let names = draw_surrogate(&held.model, &at("model.json"), scatter, two, folder.path());
    assert_eq!(names.expect("drawn"), ["surrogate-scatter", "surrogate-cuts", "surrogate-map"]);
    assert!(at("figures/surrogate-map.svg").exists());
    assert_eq!(cuts(&held.model, &at("model.json")).expect("cuts").len(), 2);
}

/// Rows of two noise groups, each with a known deviation of its own; the second row of an input is of another
/// group than the first.
fn noisy_table(path: &Path, n: usize) {
    let mut text = "wind,turbulence,load,known,source\n".to_owned();
    for row in 0..n {
        let place = (row / 2) as f64;
        let (wind, turbulence) =
            (6.0 + (0.618 * place).fract() * 6.0, (0.755 * place).fract() * 0.1);
        let known = 0.01 + 0.001 * (row % 13) as f64;
        let scatter = (0.05 + 0.2 * (row % 2) as f64) * (12.9 * row as f64).sin();
        let load = 3.0 + 0.3 * wind + 15.0 * turbulence * (0.5 * wind).sin() + scatter;
        writeln!(text, "{wind},{turbulence},{load},{known},{}", row % 2)
            .expect("a string takes it");
    }
    fs::write(path, text).expect("written");
}

/// The variance of a pair is that of the curve and Σ (σ² of its group + its known variance) / n²; rounding
/// alone lies between.
#[test]
fn pairs_have_the_noise_of_their_rows() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    noisy_table(&at("loads.csv"), 80);
    let mut asked = question(at("loads.csv"));
    (asked.deviation, asked.group) = (Some("known".to_owned()), Some("source".to_owned()));
    let found = train(&asked).expect("a surrogate");
    assert_eq!(found.n, [80, 28, 12]);
    assert!(found.warnings.iter().any(|text| text.contains("56 rows have 28 different inputs")));
    assert_eq!(found.left_out.map(|left| left.n), Some(28));
    found.model.write(&at("model.json")).expect("written");
    let mut asked = ValidateQuestion {
        model: at("model.json"),
        file: at("loads.csv"),
        deviation: Some("known".to_owned()),
        group: Some("source".to_owned()),
    };
    let held = validate(&asked).expect("validated");
    assert!(held.on_table.is_some_and(|found| found.covered_95.is_some()), "{:?}", held.warnings);
    let curve = PredictQuestion {
        model: at("model.json"),
        file: at("loads.csv"),
        means_only: false,
        group: 1,
    };
    let curve = predict(&curve).expect("predictions");
    let noise = &found.model.noise_variances;
    assert!(noise.len() == 2 && noise[1] > noise[0], "{noise:?}");
    for (place, pair) in held.pairs.iter().enumerate() {
        let known = [2 * place, 2 * place + 1].map(|row| 0.01 + 0.001 * (row % 13) as f64);
        let rows = noise[0] + noise[1] + known[0].powi(2) + known[1].powi(2);
        let variance = curve.deviations[2 * place][0].powi(2) + rows / 4.0;
        assert!(
            (pair.standard_deviation.powi(2) / variance - 1.0).abs() < 1e-9,
            "{place} {pair:?}"
        );
    }
    curve.write(&at("out.csv")).expect("written");
    let text = fs::read_to_string(at("out.csv")).expect("read");
    let name = "load_observation_deviation_of_group_1_without_known_noise";
    assert!(text.lines().next().is_some_and(|head| head.ends_with(name)), "{text}");

    for (forgets_group, word) in [(true, "--group"), (false, "--deviation")] {
        let mut less = asked.clone();
        if forgets_group {
            less.group = None
        } else {
            less.deviation = None
        }
        let held = validate(&less).expect("validated");
        assert!(held.on_table.is_some_and(|found| found.covered_95.is_none()));
        assert!(held.warnings.iter().any(|text| text.contains(word)), "{:?}", held.warnings);
    }
    let text = fs::read_to_string(at("loads.csv")).expect("read");
    fs::write(at("loads.csv"), text + "7,0.05,5,0.01,2\n").expect("written");
    let held = validate(&asked).expect("validated");
    assert!(held.warnings.iter().any(|text| text.contains("line 82 is of noise group 2")));
    asked.group = Some("load".to_owned());
    assert!(validate(&asked).is_err());
}

/// A smooth function without any noise at few inputs: the likelihood grows as its estimate falls.
#[test]
fn bands_that_are_too_narrow_are_warned_of() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("few.csv");
    let mut text = "wind,turbulence,load\n".to_owned();
    for row in 0..15 {
        let (wind, turbulence) =
            ((0.618 * f64::from(row)).fract() * 6.0, (0.755 * f64::from(row)).fract());
        writeln!(text, "{wind},{turbulence},{}", wind.sin() + turbulence).expect("it takes it");
    }
    fs::write(&file, text).expect("written");
    let asked = TrainQuestion { split: 1.0, ..question(file) };
    let warnings = train(&asked).expect("a surrogate").warnings;
    for words in ["15 different inputs for 4 hyperparameters", "group 0 was found at its lower"] {
        assert!(warnings.iter().any(|text| text.contains(words)), "{warnings:?}");
    }
}

/// `report` as it is drawn, without the breaks of its lines.
fn drawn(report: miette::Report) -> String {
    let text = format!("{report:?}").replace('│', " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_is_wrong_is_named_with_file_column_and_fix() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    table(&at("loads.csv"), 60);
    let told = |question: &TrainQuestion| {
        drawn(miette::Report::new(train(question).expect_err("refused")))
    };
    let mut still = question(at("loads.csv"));
    still.inputs.push("still".to_owned());
    let text = told(&still);
    assert!(text.contains("still is 1 in every row") && text.contains("--inputs"), "{text}");
    let mut missing = question(at("loads.csv"));
    missing.inputs.push("yaw".to_owned());
    assert!(told(&missing).contains("yaw"));
    let found = train(&question(at("loads.csv"))).expect("a surrogate");
    found.model.write(&at("model.json")).expect("written");
    fs::write(at("far.csv"), "turbulence,wind\n0.05,8\n0.05,30\n").expect("written");
    let asked = PredictQuestion {
        model: at("model.json"),
        file: at("far.csv"),
        means_only: true,
        group: 0,
    };
    let warnings = predict(&asked).expect("predictions").warnings;
    assert!(warnings.iter().any(|text| text.contains("of wind") && text.contains("30 in line 3")));
    fs::write(at("model.json"), "{}").expect("written");
    let text = drawn(miette::Report::new(predict(&asked).expect_err("no model")));
    assert!(text.contains("wakemix surrogate train"), "{text}");
}
