//! The model in plain Python, examples/surrogate/predict.py, beside the program's own predictions.

use design::regression::{KernelText, PredictQuestion, TrainQuestion, predict, train};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;
use surrogate::Trend;

const INPUTS: [&str; 3] = ["wind", "turbulence", "direction"];

/// A load over wind, turbulence and direction, every fourth row a replicate, with a little scatter.
fn table(path: &Path, n: usize, first: usize) {
    let mut text = INPUTS.join(",") + ",load\n";
    for row in first..first + n {
        let share = |of: f64| (of * (row - usize::from(row % 4 == 3)) as f64).fract();
        let (wind, turbulence) = (6.0 + 6.0 * share(0.618), 0.02 + 0.1 * share(0.755));
        let direction = 360.0 * share(0.569);
        let scatter = 0.1 * (12.9 * row as f64).sin();
        let load = 5.0 + 0.4 * wind + 20.0 * turbulence + direction.to_radians().sin() + scatter;
        writeln!(text, "{wind},{turbulence},{direction},{load}").expect("a string takes it");
    }
    fs::write(path, text).expect("written");
}

/// Python's standard library and the example alone: means at the inputs of a table, one a line, with every
/// digit.
const ASK: &str = "
import csv, json, sys
sys.path.insert(0, sys.argv[1])
import predict
model = json.load(open(sys.argv[2]))
for row in list(csv.reader(open(sys.argv[3])))[1:]:
    print(repr(predict.mean(model, [float(word) for word in row[:3]])))
";

fn in_python(folder: &Path) -> Vec<f64> {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../examples/surrogate");
    // No bytecode is left beside the example.
    let output = Command::new("python3")
        .args(["-B", "-c", ASK])
        .arg(example)
        .args(["model.json", "asked.csv"].map(|name| folder.join(name)))
        .output()
        .expect("python3 is needed, as CONTRIBUTING.md says");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.lines().map(|line| line.parse().expect("a number")).collect()
}

/// Within 1e-10 of each prediction, for every shape of kernel, every trend, and inducing points. Some
/// terms of a mean are a hundred thousand times the mean, and cancel: their rounding is all that differs.
#[test]
fn the_example_says_what_the_program_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    table(&at("train.csv"), 120, 0);
    table(&at("asked.csv"), 40, 1000);
    let sum = "se(wind,turbulence)*periodic(direction:360)+matern32";
    for (kernel, trend, n_inducing) in [
        ("se", Trend::Zero, None),
        ("matern32", Trend::Constant, None),
        ("matern52", Trend::Linear, None),
        ("rq", Trend::Constant, None),
        (sum, Trend::Linear, None),
        ("se", Trend::Constant, Some(30)),
    ] {
        let question = TrainQuestion {
            file: at("train.csv"),
            inputs: INPUTS.map(str::to_owned).to_vec(),
            output: "load".to_owned(),
            kernel: KernelText::new(kernel).expect("a kernel"),
            trend,
            deviation: None,
            group: None,
            estimates_noise: true,
            split: 1.0,
            seed: 1,
            n_starts: 2,
            n_inducing,
        };
        train(&question).expect("a surrogate").model.write(&at("model.json")).expect("written");
        let others = in_python(folder.path());
        assert_eq!(others.len(), 40);
        for means_only in [false, true] {
            let (model, file) = (at("model.json"), at("asked.csv"));
            let asked = PredictQuestion { model, file, means_only, group: 0 };
            for (own, other) in predict(&asked).expect("predictions").means.iter().zip(&others) {
                let difference = (own / other - 1.0).abs();
                assert!(difference < 1e-10, "{kernel}, {means_only}: {own} {other} {difference:e}");
            }
        }
    }
}
