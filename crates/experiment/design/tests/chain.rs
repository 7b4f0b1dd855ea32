//! From a record in a file to a controller in a file that holds the plant which made the record.

use design::{
    DesignError, IdentifyQuestion, Source, SynthesizeQuestion, Synthesized, Trend, identify,
    report_identified, report_synthesized, synthesize,
};
use formats::linear_model::{LinearModel, Port, Role};
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
    let mut plant = Plant::new();
    record_of(folder, n_samples, |input| plant.step(input))
}

/// A record of what `step` makes of tilt and yaw, likewise.
fn record_of(
    folder: &Path,
    n_samples: usize,
    mut step: impl FnMut([f64; 2]) -> [f64; 2],
) -> PathBuf {
    let mut text = "Time (s),tilt (deg),yaw (deg),up (m),right (m)\n".to_owned();
    let (mut state, mut noise) = (11, 77);
    for sample in 0..n_samples {
        let input = [excitation(&mut state), excitation(&mut state)];
        let output = step(input).map(|y| y + 0.02 * excitation(&mut noise));
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
    assert!(page.contains("the others closed, with the delay and its predictor"));
    let delayed = designed.with_delay.as_ref().expect("a delay");
    // Six samples of delay leave less than none.
    assert!(delayed.sensitivity.gain > designed.peaks[0], "{delayed:?}");
    let [_, longer] = delayed.mismatch;
    assert!(longer.is_some_and(|time| time > INTERVAL), "{delayed:?}");
    assert_eq!(designed.delay_left, 0.0);
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

/// A system with known matrices, every second.
fn system(matrices: [&[&[f64]]; 3]) -> Recursion {
    let [a, b, c] = matrices.map(|rows| rows.iter().map(|row| row.to_vec()).collect::<Vec<_>>());
    Recursion::new(&a, &b, &c, &[vec![0.0; 2], vec![0.0; 2]])
}

/// 0.5 (z − 1.25)/((z − 0.8)(z − 0.6)) and (z − 0.5)/((z − 0.9)(z − 0.3)), mixed at inputs and outputs: the
/// zeros of both together are 1.25 and 0.5, though none of the four paths has a zero at either.
#[test]
fn zeros_of_inputs_and_outputs_together_are_found_in_a_record() {
    let mut plant = system([
        &[
            &[1.4, -0.48, 0.0, 0.0],
            &[1.0, 0.0, 0.0, 0.0],
            &[0.0, 0.0, 1.2, -0.27],
            &[0.0, 0.0, 1.0, 0.0],
        ],
        &[&[1.0, 0.5], &[0.0, 0.0], &[-0.4, 1.0], &[0.0, 0.0]],
        &[&[0.5, -0.625, 0.6, -0.3], &[-0.2, 0.25, 1.0, -0.5]],
    ]);
    let folder = tempfile::tempdir().expect("a folder");
    let path = record_of(folder.path(), 6000, |input| {
        let mut output = [0.0; 2];
        plant.step(&input, &mut output);
        output
    });
    let asked = IdentifyQuestion { order: Some(4), delay: 0.0, ..question(path) };
    let found = identify(&asked).expect("a model");
    let near = |roots: &[lti::Complex64], expected: f64, within: f64| {
        roots.iter().any(|root| (root - expected).norm() < within)
    };
    let [zeros, poles] = [&found.zeros, &found.poles];
    assert_eq!((zeros.sampled.len(), poles.sampled.len()), (2, 4));
    assert!(near(&zeros.sampled, 1.25, 0.01) && near(&zeros.sampled, 0.5, 0.01), "{zeros:?}");
    for pole in [0.9, 0.8, 0.6, 0.3] {
        assert!(near(&poles.sampled, pole, 0.01), "{poles:?}");
    }
    // Slow ones first: ln 1.25 before ln 0.5, and ln 0.9 before all.
    assert!((zeros.continuous[0].re - 1.25_f64.ln()).abs() < 0.01);
    assert!((poles.continuous[0].re - 0.9_f64.ln()).abs() < 0.01);
    let unstable: Vec<_> = zeros.unstable().collect();
    assert!(unstable.len() == 1 && unstable[0].re > 0.0, "{unstable:?}");
    // (z + 1)/(z − 1) seconds.
    assert!((found.delay_of_zeros - 9.0).abs() < 0.5, "{}", found.delay_of_zeros);
    let page = report_identified(&found, "record.csv", folder.path()).expect("a page");
    let page = fs::read_to_string(page).expect("a page");
    assert!(page.contains("Transmission zeros") && page.contains("in z (–)"));
}

/// Lags behind commands that are turned by −20°: their relative gains are cos² 20° at every frequency, and
/// those with an offset of 20° the identity.
#[test]
fn relative_gains_are_told_with_the_azimuth_offset_and_without() {
    let mut plant = system([
        &[&[0.9, 0.0], &[0.0, 0.7]],
        &[&[0.1, 0.0], &[0.0, 0.6]],
        &[&[1.0, 0.0], &[0.0, 1.0]],
    ]);
    let (sine, cosine) = (-20.0_f64).to_radians().sin_cos();
    let folder = tempfile::tempdir().expect("a folder");
    let path = record_of(folder.path(), 6000, |[tilt, yaw]| {
        let mut output = [0.0; 2];
        plant.step(&[cosine * tilt + sine * yaw, cosine * yaw - sine * tilt], &mut output);
        output
    });
    let asked = IdentifyQuestion { delay: 0.0, bandwidth: 0.2, ..question(path) };
    let found = identify(&asked).expect("a model");
    let without = found.relative_gains.as_ref().expect("two by two");
    for gains in without {
        assert!((gains[0][0] - cosine * cosine).abs() < 0.03, "{gains:?}");
    }
    for offset in [&found.azimuth_offset, &found.azimuth_offset_at_bandwidth] {
        let offset = offset.as_ref().expect("two by two");
        assert!((offset.angle.to_degrees() - 20.0).abs() < 1.5, "{}", offset.angle.to_degrees());
        for gains in &offset.relative_gains {
            assert!((gains[0][0] - 1.0).abs() < 0.01 && gains[0][1].abs() < 0.01, "{gains:?}");
        }
    }
    let page = report_identified(&found, "record.csv", folder.path()).expect("a page");
    let page = fs::read_to_string(page).expect("a page");
    assert!(page.contains("with the azimuth offset that decouples at rest"));
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
    assert!(
        said.contains("weights.toml: [performance] has a pole on the imaginary axis"),
        "{said}"
    );
}

/// A third state that grows is told with the matrix that hides it, before any weight is blamed; so are the
/// keys of weights that leave nothing to find.
#[test]
fn what_no_controller_can_do_is_told_with_its_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let [model, weights] = ["model.json", "weights.toml"].map(|name| folder.path().join(name));
    let port = |name: &str| vec![Port { name: name.to_owned(), unit: String::new() }];
    let write = |b: f64, c: f64, grown: f64| {
        let model_of = LinearModel::new(
            Role::Model,
            "a lag".to_owned(),
            Some(1.0),
            [port("tilt"), port("up")],
            [
                vec![vec![0.9, 0.0], vec![0.0, grown]],
                vec![vec![0.1], vec![b]],
                vec![vec![1.0, c]],
                vec![vec![0.0]],
            ],
        );
        model_of.write(&model).expect("written");
    };
    let asked = SynthesizeQuestion { model: model.clone(), weights: weights.clone() };
    let said = |text: &str| {
        fs::write(&weights, text).expect("written");
        let error = synthesize(&asked).expect_err(text);
        let fix = miette::Diagnostic::help(&error).map(|help| help.to_string());
        error.to_string() + "; " + &fix.unwrap_or_default()
    };
    let performance = "[performance]\nbandwidth = 0.05\npeak = 2.0\nattenuation = 0.001\n";
    write(0.0, 1.0, 1.05);
    let both = format!("{performance}\n[control]\nD = [[0.1]]\n");
    let text = said(&both);
    assert!(text.contains("model.json: `A` has a mode at z = 1.0500"), "{text}");
    assert!(text.contains("no input moves it (`B`); identify a model of lower order"), "{text}");
    write(1.0, 0.0, 1.05);
    let text = said(&both);
    assert!(text.contains("no output shows it (`C`)"), "{text}");
    write(1.0, 1.0, 0.5);
    let text = said(performance);
    assert!(text.contains("weights.toml: [control] is missing: controls cost nothing"), "{text}");
    assert!(text.contains("add [control] with `corner`"), "{text}");
    let text = said("method = \"h2\"\n");
    assert!(text.contains("[performance] is missing: nothing is asked"), "{text}");
    let text = said(&format!("order = 0\n{performance}"));
    assert!(text.contains("weights.toml") && text.contains("line 1") && text.contains("order"));
}

/// What a controller comes to, of the model of the record and `weights`.
fn designed(folder: &Path, weights: &str) -> Synthesized {
    let (model, path) = (folder.join("model.json"), folder.join("weights.toml"));
    fs::write(&path, weights).expect("written");
    synthesize(&SynthesizeQuestion { model, weights: path }).expect("a controller")
}

#[test]
fn tilt_and_yaw_may_have_weights_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let found = identify(&question(record(folder.path(), 2400))).expect("a model");
    found.model.write(&folder.path().join("model.json")).expect("written");
    let control = "[control]\ncorner = 0.5\nratio = 10.0\nscale = 0.05\n";
    let of = |channel: &str, bandwidth: f64| {
        format!(
            "[[performance]]\nchannel = \"{channel}\"\nbandwidth = {bandwidth}\npeak = 2.0\nattenuation = 0.001\n\n"
        )
    };
    let alike = designed(
        folder.path(),
        &format!("[performance]\nbandwidth = 0.05\npeak = 2.0\nattenuation = 0.001\n\n{control}"),
    );
    assert!(alike.responses.channels.is_empty());
    // The same number for both, one by one and as matrices: (s/2 + ω)/(s + a).
    let each = designed(folder.path(), &(of("right", 0.05) + &of("up", 0.05) + control));
    let matrices = "[performance]\nA = [[-5e-5]]\nB = [[1.0]]\nC = [[0.049975]]\nD = [[0.5]]\n\n";
    let by_matrices = designed(folder.path(), &(matrices.to_owned() + control));
    let expected = alike.bound.expect("a bound");
    for other in [&each, &by_matrices] {
        assert!((other.bound.expect("a bound") / expected - 1.0).abs() < 1e-4);
    }
    // A yaw that is asked to be five times as fast is faster than tilt, and both keep their bounds.
    let apart = designed(folder.path(), &(of("right", 0.1) + &of("up", 0.02) + control));
    let channels = &apart.responses.channels;
    let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
    assert_eq!(names, ["up", "right"]);
    let achieved = apart.achieved.expect("a norm");
    for channel in channels {
        let kept = channel.gains.iter().zip(&channel.bounds);
        // The bilinear transformation moves weights near the end of the band alone.
        let slow = kept.zip(&apart.responses.frequencies).filter(|(_, rate)| **rate < 0.3);
        for ((gain, bound), rate) in slow {
            assert!(*gain <= 1.02 * achieved * bound, "{} at {rate} rad/s", channel.name);
        }
    }
    let crossing = |channel: usize| {
        let gains = &channels[channel].gains;
        let index = gains.iter().position(|gain| *gain > std::f64::consts::FRAC_1_SQRT_2);
        apart.responses.frequencies[index.expect("it crosses")]
    };
    assert!(crossing(1) > 2.0 * crossing(0), "{} {}", crossing(0), crossing(1));
    let page = report_synthesized(&apart, "model.json", folder.path()).expect("a page");
    let page = fs::read_to_string(page).expect("a page");
    assert!(page.contains("Sensitivities, channel by channel"));
}
