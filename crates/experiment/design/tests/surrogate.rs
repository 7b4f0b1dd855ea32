//! From a table to a surrogate, and from its file to predictions, validation and figures.

use design::SurrogateModel;
use design::regression::{
    KernelText, PredictQuestion, TrainQuestion, cuts, draw_surrogate, predict, train, validate,
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

    let held = validate(&at("model.json"), &at("loads.csv")).expect("validated");
    assert_eq!((held.n_rows, held.pairs.len()), (120, 60));
    let pairs = Some(&held.pairs[..]);
    let names = draw_surrogate(&held.model, &at("model.json"), pairs, Some([0, 1]), folder.path());
    assert_eq!(names.expect("drawn"), ["surrogate-scatter", "surrogate-cuts", "surrogate-map"]);
    assert!(at("figures/surrogate-map.svg").exists());
    assert_eq!(cuts(&held.model, &at("model.json")).expect("cuts").len(), 2);
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
