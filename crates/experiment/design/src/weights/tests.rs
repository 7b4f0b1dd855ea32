//! Weights in all their forms, and what is said of those that cannot be.

use super::*;
use formats::linear_model::Role;

/// A model of two lags with the channels of a helix and its hub vortex.
fn model() -> LinearModel {
    let port = |name: &str| Port { name: name.to_owned(), unit: String::new() };
    let diagonal = |value: f64| vec![vec![value, 0.0], vec![0.0, value]];
    LinearModel::new(
        Role::Model,
        "two lags".to_owned(),
        Some(1.0),
        [
            ["T1.HelixTilt", "T1.HelixYaw"].map(port).to_vec(),
            ["T1.HubVortexTilt", "T1.HubVortexYaw"].map(port).to_vec(),
        ],
        [0.9, 0.1, 1.0, 0.0].map(diagonal),
    )
}

fn weights(text: &str) -> Result<Weights, DesignError> {
    let path = Path::new("weights.toml");
    WeightsFile::parse(path, text)?.on(&model(), path)
}

fn performance(text: &str) -> StateSpace {
    let [performance, ..] = weights(text).expect("a weight");
    performance.expect("one of performance").whole
}

/// One of performance with what it says, and how to mend it.
fn refused(text: &str) -> [String; 2] {
    let error = weights(text).map(|_| ()).expect_err(text);
    let fix = miette::Diagnostic::help(&error).map(|help| help.to_string());
    [error.to_string(), fix.unwrap_or_default()]
}

const FREQUENCIES: [f64; 4] = [0.0, 0.013, 0.4, 20.0];

fn same(one: &StateSpace, other: &StateSpace) {
    for frequency in FREQUENCIES {
        let [one, other] = [one, other].map(|system| system.response(frequency).expect("no pole"));
        assert!((&one - &other).norm_l2() < 1e-12, "{frequency} rad/s");
    }
}

/// (0.5 s + 0.02)/(s + 0.002), on both channels, four ways: by its numbers, its coefficients, its matrices on
/// one channel, and on both.
#[test]
fn all_forms_of_a_weight_are_one() {
    let first = performance("[performance]\nbandwidth = 0.02\npeak = 2.0\nattenuation = 0.1\n");
    assert_eq!((first.inputs(), first.outputs()), (2, 2));
    let direct = first.response(0.4).expect("no pole")[(0, 0)];
    let s = lti::Complex64::new(0.0, 0.4);
    assert!((direct - (0.5 * s + 0.02) / (s + 0.002)).norm() < 1e-14);
    for other in [
        "[performance]\nnumerator = [0, 0.5, 0.02]\ndenominator = [1, 0.002]\n",
        "[performance]\nA = [[-0.002]]\nB = [[0.1]]\nC = [[0.19]]\nD = [[0.5]]\n",
        "[performance]\nA = [[-0.002, 0], [0, -0.002]]\nB = [[0.1, 0], [0, 0.1]]\nC = [[0.19, 0], [0, 0.19]]\nD = [[0.5, 0], [0, 0.5]]\n",
    ] {
        same(&performance(other), &first);
    }
}

#[test]
fn channels_are_known_by_their_names_in_any_order() {
    let text = "[[performance]]\nchannel = \"HubVortexYaw\"\nD = [[3.0]]\n\n\
                [[performance]]\nchannel = \"T1.HubVortexTilt\"\nnumerator = [1]\ndenominator = [1, 1]\n\n\
                [control]\nD = [[0.5, 0.1], [0.1, 0.5], [0, 0.2]]\n";
    let [performance, complementary, control] = weights(text).expect("weights");
    assert!(complementary.is_none());
    let performance = performance.expect("given");
    assert_eq!(performance.by_channel.len(), 2);
    let at_rest = performance.whole.gain_at_rest().expect("no pole there");
    assert_eq!(
        [at_rest[(0, 0)], at_rest[(0, 1)], at_rest[(1, 0)], at_rest[(1, 1)]],
        [1.0, 0.0, 0.0, 3.0]
    );
    // The weaker of both bounds what is larger than either.
    assert_eq!(bound(&performance.whole, 0.0).expect("no pole there"), Some(1.0));
    let control = control.expect("given");
    assert!(control.by_channel.is_empty());
    assert_eq!((control.whole.inputs(), control.whole.outputs()), (2, 3));
    assert!(bound(&control.whole, 1.0).expect("a gain").is_some());
}

/// One output for two inputs leaves their difference free.
#[test]
fn a_weight_that_does_not_see_a_direction_bounds_nothing() {
    let sum = performance("[performance]\nD = [[1.0, 1.0]]\n");
    assert_eq!(bound(&sum, 0.1).expect("a gain"), None);
}

#[test]
fn quadratic_weights_are_one_number_or_one_for_each_channel() {
    let path = Path::new("weights.toml");
    let of =
        |text: &str| WeightsFile::parse(path, text).expect("read").quadratic_on(&model(), path);
    let found = of("[quadratic]\noutputs = [1, 4.0]\ncontrols = 2\n").expect("weights");
    let diagonal = |matrix: &faer::Mat<f64>| [matrix[(0, 0)], matrix[(1, 1)], matrix[(0, 1)]];
    assert_eq!(diagonal(&found.outputs), [1.0, 4.0, 0.0]);
    assert_eq!(diagonal(&found.controls), [2.0, 2.0, 0.0]);
    assert_eq!(diagonal(&found.integrals), [0.01, 0.01, 0.0]);
    for (text, said) in [
        ("[quadratic]\noutputs = [1]\n", "[quadratic] has 1 numbers in `outputs`"),
        ("[quadratic]\ncontrols = [1, 0]\n", "`controls` = 0"),
        ("[quadratic]\ninput_noise = inf\n", "`input_noise` that is not finite"),
    ] {
        let told = of(text).expect_err(text).to_string();
        assert!(told.contains("weights.toml") && told.contains(said), "{told}");
    }
}

#[test]
fn what_is_no_weight_is_told_with_file_table_and_key() {
    let rational =
        |numbers: &str| format!("[performance]\nnumerator = [1, 1]\ndenominator = {numbers}\n");
    let of_tilt = "[[performance]]\nchannel = \"HubVortexTilt\"\nD = [[1.0]]\n";
    for (text, said, fix) in [
        (rational("[1.0, 0.0]"), "a pole on the imaginary axis, at 0 rad/s", "to the left"),
        (rational("[1.0, 0.0, 0.25]"), "a pole on the imaginary axis, at 0.5 rad/s", "to the left"),
        (rational("[1.0, -2.0]"), "a pole at 2", "mirror"),
        (rational("[0.0, 3.0]"), "`numerator` has degree 1, where at most 0", "(s/ω + 1)"),
        (rational("[0.0, 0.0]"), "`denominator` that is zero", "coefficients"),
        (rational("[1.0, nan]"), "`denominator` that is not finite", "plain numbers"),
        ("[performance]\nnumerator = [1, 1]\n".to_owned(), "lacks `denominator`", "`denominator`"),
        ("[performance]\npeak = 2\nD = [[1]]\n".to_owned(), "`peak` and `D`", "or `A`"),
        ("[performance]\n".to_owned(), "holds no weight", "bandwidth"),
        (
            "[performance]\nbandwidth = 0.02\npeak = -2\nattenuation = 0.1\n".to_owned(),
            "`peak` = -2, where a number above zero",
            "above zero",
        ),
        (
            "[performance]\nA = [[-1.0]]\nB = [[1.0, 2.0]]\nC = [[1.0]]\nD = [[0.0]]\n".to_owned(),
            "`B` of 1 × 2, where 1 × 1 is expected",
            "equal length",
        ),
        ("[performance]\nA = [[-1.0]]\nD = [[0.0]]\n".to_owned(), "lacks `B`", "`B`"),
        ("[performance]\nD = [[1, 0, 0]]\n".to_owned(), "has 3 inputs, where 1, for", "columns"),
        ("[performance]\nD = []\n".to_owned(), "no number in `D`", "rows"),
        (of_tilt.to_owned(), "no table for T1.HubVortexYaw", "add a table"),
        (format!("{of_tilt}\n{of_tilt}"), "[[performance]] of HubVortexTilt is there twice", "one"),
        (format!("{of_tilt}\n[[performance]]\nD = [[1.0]]\n"), "no `channel`", "`channel`"),
        (of_tilt.replace("[[performance]]", "[performance]"), "has a `channel`", "double brackets"),
        (of_tilt.replace("Vortex", "Cap"), "one of T1.HubVortexTilt, T1.HubVortexYaw", "output"),
        (of_tilt.replace("[[1.0]]", "[[1.0, 0.0]]"), "has 2 inputs, where 1 is", "columns"),
        ("[performance]\nbandwith = 0.02\n".to_owned(), "`bandwith`", "docs/control-design.md"),
        ("performance = 3\n".to_owned(), "a table, or one for each channel", "docs"),
        ("[performance]\npeak = \"two\"\n".to_owned(), "line 2", "docs"),
    ] {
        let [told, help] = refused(&text);
        assert!(told.contains("weights.toml") && told.contains(said), "{text}: {told}");
        assert!(help.contains(fix), "{text}: {help}");
    }
}
