//! From a record in a file to a controller in a file that holds the plant which made the record.

use design::{
    DesignError, IdentifyQuestion, Source, SynthesizeQuestion, Trend, identify, report_identified,
    report_synthesized, synthesize,
};
use formats::linear_model::{LinearModel, Role};
use lti::Recursion;
use std::collections::VecDeque;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const INTERVAL: f64 = 1.0;
/// Samples by which the outputs come late (–).
const DELAY: usize = 6;

/// Two lags, coupled, whose outputs come late.
struct Plant {
    lags: Recursion,
    way: VecDeque<[f64; 2]>,
}

impl Plant {
    fn new() -> Self {
        let rows = |values: [[f64; 2]; 2]| values.map(|row| row.to_vec()).to_vec();
        let lags = Recursion::new(
            &rows([[0.85, 0.05], [-0.05, 0.8]]),
            &rows([[0.4, 0.1], [-0.1, 0.5]]),
            &rows([[1.0, 0.0], [0.0, 1.0]]),
            &rows([[0.0; 2]; 2]),
        );
        Self { lags, way: VecDeque::from(vec![[0.0; 2]; DELAY]) }
    }

    fn step(&mut self, input: [f64; 2]) -> [f64; 2] {
        let mut output = [0.0; 2];
        self.lags.step(&input, &mut output);
        self.way.push_back(output);
        self.way.pop_front().expect("as long as it was")
    }
}

/// Signs that hold for some samples, the same in every run.
fn excitation(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    if *state >> 63 == 1 { 1.0 } else { -1.0 }
}

/// A record of the plant about means that are not zero, with a little noise.
fn record(folder: &Path, n_samples: usize) -> PathBuf {
    let mut text = "Time (s),tilt (deg),yaw (deg),up (m),right (m)\n".to_owned();
    let (mut plant, mut state, mut noise) = (Plant::new(), 11, 77);
    for sample in 0..n_samples {
        let input = [excitation(&mut state), excitation(&mut state)];
        let output = plant.step(input).map(|y| y + 0.02 * excitation(&mut noise));
        let time = INTERVAL * sample as f64;
        writeln!(
            text,
            "{time},{},{},{},{}",
            input[0],
            3.0 + input[1],
            1.0 + output[0],
            13.0 + output[1]
        )
        .expect("a text");
    }
    let path = folder.join("record.csv");
    fs::write(&path, text).expect("a folder of one's own");
    path
}

fn question(file: PathBuf) -> IdentifyQuestion {
    let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
    IdentifyQuestion {
        source: Source {
            file,
            inputs: names(["tilt", "yaw"]),
            outputs: names(["up", "right"]),
            span: [f64::NEG_INFINITY, f64::INFINITY],
        },
        decimate: 1,
        trend: Trend::Constant,
        windows: [15, 15],
        feedthrough: false,
        order: Some(2),
        delay: DELAY as f64 * INTERVAL,
        aside: 0.25,
        bandwidth: 0.05,
    }
}

#[test]
fn the_controller_of_an_identified_model_holds_the_plant_that_was_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    let found = identify(&question(record(folder.path(), 2400))).expect("a model");
    assert!(found.accounted_for.iter().flatten().all(|share| *share > 99.0));
    // (1 − A)⁻¹ B by hand.
    for (row, expected) in found.gain.iter().zip([[2.3077, 1.3846], [-1.0769, 2.1538]]) {
        for (gain, expected) in row.iter().zip(expected) {
            assert!((gain - expected).abs() < 0.05, "{:?}", found.gain);
        }
    }
    assert!(found.delays.iter().flatten().all(|delay| *delay == Some((DELAY + 1) as f64)));
    let page = report_identified(&found, "record.csv", folder.path()).expect("a page");
    let page = fs::read_to_string(page).expect("a page");
    assert!(page.contains("the model accounts for 99") && !page.contains("A warning"));
    assert!(page.contains("Frequency response") && page.contains("&quot;A&quot;"));
    assert!(folder.path().join("figures/singular-values.png").exists());
    let model = folder.path().join("model.json");
    found.model.write(&model).expect("written");
    let weights = folder.path().join("weights.toml");
    let text = "[performance]\nbandwidth = 0.05\npeak = 2.0\nattenuation = 0.001\n\n[control]\ncorner = 0.5\nratio = 10.0\nscale = 0.05\n";
    fs::write(&weights, text).expect("written");
    let designed = synthesize(&SynthesizeQuestion { model, weights }).expect("a controller");
    assert_eq!(designed.delay_samples, DELAY);
    assert!(designed.achieved.expect("a norm") <= 1.0001 * designed.bound.expect("a bound"));
    let page = report_synthesized(&designed, "model.json", folder.path()).expect("a page");
    let page = fs::read_to_string(page).expect("a page");
    assert!(page.contains("Holds down disturbances") && page.contains("Step responses"));
    let path = folder.path().join("controller.json");
    designed.controller.write(&path).expect("written");
    let LinearModel { a, b, c, d, k, .. } =
        LinearModel::read(&path, Role::Controller).expect("what was written");
    let mut law = Recursion::new(&a, &b, &c, &d).with_back_calculation(&k.expect("a gain"));
    let (mut plant, reference) = (Plant::new(), [1.0, -0.5]);
    let (mut measured, mut command) = ([0.0; 2], [0.0; 2]);
    for _ in 0..600 {
        let errors = [0, 1].map(|axis| reference[axis] - measured[axis]);
        law.step(&errors, &mut command);
        measured = plant.step(command);
    }
    for axis in 0..2 {
        assert!((measured[axis] - reference[axis]).abs() < 0.01, "{measured:?}");
    }
}

#[test]
fn what_cannot_be_used_is_told_with_its_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let short = identify(&question(record(folder.path(), 40))).expect_err("too short");
    assert!(matches!(short, DesignError::Identification { .. }));
    assert!(short.to_string().contains("record.csv"), "{short}");
    let weights = folder.path().join("weights.toml");
    fs::write(&weights, "[performance]\nbandwith = 0.05\n").expect("written");
    let model = folder.path().join("model.json");
    identify(&question(record(folder.path(), 900)))
        .expect("a model")
        .model
        .write(&model)
        .expect("written");
    let asked = SynthesizeQuestion { model: model.clone(), weights: weights.clone() };
    let said = synthesize(&asked).expect_err("a word spelt wrong").to_string();
    assert!(said.contains("weights.toml"), "{said}");
    // A weight that integrates has a mode that no controller moves.
    let integrating = "[performance]\nnumerator = [1.0, 1.0]\ndenominator = [1.0, 0.0]\n\n[control]\ncorner = 0.5\nratio = 10.0\nscale = 0.05\n";
    fs::write(&weights, integrating).expect("written");
    let said = synthesize(&asked).expect_err("a pole on the axis").to_string();
    assert!(said.contains("performance weight") || said.contains("stabilisable"), "{said}");
}
