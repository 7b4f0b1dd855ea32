//! Closed forms of one and two observations, slopes by differences, leave-one-out by refitting, scikit-learn.

use super::*;
use crate::Noise;
use proptest::prelude::*;
use std::f64::consts::TAU;

const SHAPES: [Shape; 4] =
    [Shape::Periodic { period: TAU }, Shape::SquaredExponential, Shape::Matern32, Shape::Matern52];

fn parameters(signal_variance: f64, lengths: &[f64], noise_variance: f64) -> Hyperparameters {
    Hyperparameters { signal_variance, lengths: lengths.to_vec(), noise_variance }
}

/// A wavy surface over two inputs with known variances, the same every time.
fn surface(n: usize) -> Observations {
    let mut normals = Normals::new(3);
    let inputs: Vec<f64> = (0..2 * n).map(|_| normals.next()).collect();
    let values = inputs.chunks(2).map(|p| 4.0 + p[0].sin() + 0.3 * p[1]).collect();
    let variances = (0..n).map(|_| 0.01 * normals.next().powi(2)).collect();
    Observations { inputs, n_dimensions: 2, values, variances }
}

/// One observation y of variance s² + v about zero: mean k/(s² + v) y, variance s² − k²/(s² + v).
#[test]
fn one_observation_is_a_line_through_the_origin() {
    let observations = Observations::of_curve(vec![0.0], vec![3.0]).with_deviations(&[0.5]);
    let shape = Shape::SquaredExponential;
    let process =
        GaussianProcess::new(shape, parameters(2.0, &[1.5], 0.25), observations, Mean::Zero)
            .expect("one observation");
    let total = 2.0 + 0.25 + 0.25;
    for input in [0.0, 0.7, -3.0] {
        let covariance = 2.0 * (-0.5 * (input / 1.5_f64).powi(2)).exp();
        let found = process.predict(&[input]).expect("one input");
        let variance = 2.0 - covariance * covariance / total;
        assert!((found.mean - 3.0 * covariance / total).abs() < 1e-14);
        assert!((found.standard_deviation.powi(2) - variance).abs() < 1e-13);
        assert!((found.observation_deviation.powi(2) - variance - 0.25).abs() < 1e-13);
    }
    let log = -0.5 * (9.0 / total + total.ln() + TAU.ln());
    assert!((process.log_marginal_likelihood() - log).abs() < 1e-14);
    let left_out = process.leave_one_out()[0];
    assert!(left_out.mean.abs() < 1e-14);
    assert!((left_out.standard_deviation - total.sqrt()).abs() < 1e-14);
}

/// Two observations, the inverse of their covariance written out; an estimated mean is theirs.
#[test]
fn two_observations_share_their_weight() {
    let (signal, noise, length) = (1.7, 0.3, 0.9);
    let shape = Shape::Matern32;
    let matern = |distance: f64| {
        let r = 3.0_f64.sqrt() * distance / length;
        signal * (1.0 + r) * (-r).exp()
    };
    let observations = || Observations::of_curve(vec![0.0, 1.0], vec![1.0, 2.5]);
    let (diagonal, side) = (signal + noise, matern(1.0));
    let determinant = diagonal * diagonal - side * side;
    let (a, b) = (matern(0.4), matern(0.6));
    let make = |mean| {
        GaussianProcess::new(shape, parameters(signal, &[length], noise), observations(), mean)
            .expect("two observations")
    };
    let found = make(Mean::Zero).predict(&[0.4]).expect("one input");
    let weights = [diagonal * a - side * b, diagonal * b - side * a].map(|w| w / determinant);
    assert!((found.mean - weights[0] - 2.5 * weights[1]).abs() < 1e-13);
    let variance = signal - weights[0] * a - weights[1] * b;
    assert!((found.standard_deviation.powi(2) - variance).abs() < 1e-13);
    let process = make(Mean::Constant);
    assert!((process.mean() - 1.75).abs() < 1e-14);
    let found = process.predict(&[0.4]).expect("one input");
    assert!((found.mean - 1.75 - 0.75 * (weights[1] - weights[0])).abs() < 1e-13);
    let of_mean = (1.0 - weights[0] - weights[1]).powi(2) * (diagonal + side) / 2.0;
    assert!((found.standard_deviation.powi(2) - variance - of_mean).abs() < 1e-13);
}

#[test]
fn slopes_of_the_likelihood_are_its_differences() {
    for shape in SHAPES {
        for mean in [Mean::Zero, Mean::Constant] {
            let log_at = |logs: &[f64]| {
                let parameters =
                    parameters(logs[0].exp(), &[logs[1].exp(), logs[2].exp()], logs[3].exp());
                let process = GaussianProcess::new(shape, parameters, surface(12), mean);
                process.expect("a good process")
            };
            let logs = [0.4, -0.2, 0.3, -2.0];
            let slopes = log_at(&logs).likelihood_slopes();
            for (index, slope) in slopes.iter().enumerate() {
                let moved = |step: f64| {
                    let mut moved = logs;
                    moved[index] += step;
                    log_at(&moved).log_marginal_likelihood()
                };
                // Central differences: an error of step² times the third derivative, and rounding.
                let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
                assert!(
                    (slope - difference).abs() < 1e-6 * (1.0 + slope.abs()),
                    "{shape:?} {index}"
                );
            }
        }
    }
}

#[test]
fn a_leave_one_out_prediction_is_a_process_of_the_others() {
    let all = surface(9);
    for mean in [Mean::Zero, Mean::Constant] {
        let make = |observations: Observations| {
            let parameters = parameters(1.5, &[0.8, 1.1], 0.02);
            GaussianProcess::new(Shape::Matern52, parameters, observations, mean).expect("good")
        };
        let left_out = make(all.clone()).leave_one_out();
        for (index, found) in left_out.iter().enumerate() {
            let mut others = all.clone();
            let input: Vec<f64> = others.inputs.drain(2 * index..2 * index + 2).collect();
            let value = others.values.remove(index);
            let variance = others.variances.remove(index);
            let expected = make(others).predict(&input).expect("two inputs");
            assert_eq!(found.value, value);
            assert!((found.mean - expected.mean).abs() < 1e-10);
            let total = (expected.observation_deviation.powi(2) + variance).sqrt();
            assert!((found.standard_deviation - total).abs() < 1e-10);
            assert!((found.standardised() - (value - expected.mean) / total).abs() < 1e-8);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// With an estimated mean, a constant added to all values is added to the curve, and the band does not
    /// change.
    #[test]
    fn an_estimated_mean_follows_the_values(added in -50.0..50.0_f64, at in -2.0..2.0_f64) {
        let of = |added: f64| {
            let mut observations = surface(8);
            observations.values.iter_mut().for_each(|value| *value += added);
            let parameters = parameters(1.0, &[1.0, 1.0], 0.1);
            GaussianProcess::new(Shape::SquaredExponential, parameters, observations, Mean::Constant)
                .expect("good")
                .predict(&[at, 0.3])
                .expect("two inputs")
        };
        let (still, moved) = (of(0.0), of(added));
        prop_assert!((moved.mean - still.mean - added).abs() < 1e-10);
        prop_assert!((moved.standard_deviation - still.standard_deviation).abs() < 1e-12);
    }

    /// A full turn gives the same prediction, with a deviation below that of the prior.
    #[test]
    fn a_periodic_curve_closes(offset in -7.0..7.0_f64, turns in -3..4_i32) {
        let offsets: Vec<f64> = (0..6).map(f64::from).collect();
        let values = offsets.iter().map(|o| (o - 1.0).cos()).collect();
        let process = GaussianProcess::new(
            Shape::Periodic { period: TAU },
            parameters(1.0, &[0.9], 0.01),
            Observations::of_curve(offsets, values),
            Mean::Zero,
        ).expect("good");
        let here = process.predict(&[offset]).expect("one input");
        let there = process.predict(&[offset + TAU * f64::from(turns)]).expect("one input");
        prop_assert!((here.mean - there.mean).abs() < 1e-10);
        prop_assert!(here.standard_deviation > 0.0 && here.standard_deviation < 1.0);
    }
}

#[test]
fn samples_spread_as_the_band_says() {
    let offsets: Vec<f64> = (0..8).map(|i| 0.8 * f64::from(i)).collect();
    let values = offsets.iter().map(|o| o.sin()).collect();
    let process = GaussianProcess::fit(
        Shape::Periodic { period: TAU },
        Observations::of_curve(offsets, values).with_deviations(&[0.3; 8]),
        &FitSettings { noise: Noise::Known, ..FitSettings::default() },
    )
    .expect("good");
    let inputs: Vec<Vec<f64>> = (0..24).map(|i| vec![TAU * f64::from(i) / 24.0]).collect();
    let n = 4000;
    let samples = process.samples(&inputs, n, 5).expect("drawn");
    assert_eq!(samples, process.samples(&inputs, n, 5).expect("drawn"));
    for (index, input) in inputs.iter().enumerate() {
        let found = process.predict(input).expect("one input");
        let mean = samples.iter().map(|s| s[index]).sum::<f64>() / n as f64;
        let variance = samples.iter().map(|s| (s[index] - mean).powi(2)).sum::<f64>() / n as f64;
        // Four standard errors of 4000 draws.
        assert!((mean - found.mean).abs() < 0.064 * found.standard_deviation);
        assert!((variance.sqrt() / found.standard_deviation - 1.0).abs() < 0.045);
    }
}

/// One data set of the stored results: keys with their numbers.
struct Golden<'a> {
    name: &'a str,
    shape: Shape,
    lines: Vec<(&'a str, Vec<f64>)>,
}

impl Golden<'_> {
    fn numbers(&self, key: &str) -> &[f64] {
        &self.lines.iter().find(|line| line.0 == key).expect("a key of the file").1
    }

    fn hyperparameters(&self, key: &str) -> Hyperparameters {
        let [signal, lengths @ .., noise] = self.numbers(key) else { panic!("three numbers") };
        parameters(*signal, lengths, *noise)
    }
}

fn golden() -> Vec<Golden<'static>> {
    let text = include_str!("../../../../../validation/data/surrogate/scikit-learn.txt");
    let mut cases: Vec<Golden> = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let ["case", name, shape] = words[..] {
            let shape = match shape {
                "periodic" => SHAPES[0],
                "squared-exponential" => SHAPES[1],
                "matern-32" => SHAPES[2],
                _ => SHAPES[3],
            };
            cases.push(Golden { name, shape, lines: Vec::new() });
            continue;
        }
        let numbers = words[1..].iter().map(|word| word.parse().expect("a number")).collect();
        cases.last_mut().expect("a case").lines.push((words[0], numbers));
    }
    cases
}

/// Likelihood, slopes and curve at given hyperparameters to rounding; the best ones as far as two searches
/// agree.
#[test]
fn scikit_learn_finds_the_same() {
    for case in golden() {
        let values = case.numbers("values").to_vec();
        let n_dimensions = case.numbers("inputs").len() / values.len();
        let observations = Observations {
            inputs: case.numbers("inputs").to_vec(),
            n_dimensions,
            values,
            variances: case.numbers("variances").to_vec(),
        };
        let make = |key| {
            let parameters = case.hyperparameters(key);
            GaussianProcess::new(case.shape, parameters, observations.clone(), Mean::Zero)
                .expect("good")
        };
        let guess = make("guess");
        let log = case.numbers("guess-log")[0];
        assert!((guess.log_marginal_likelihood() - log).abs() < 1e-9, "{}", case.name);
        for (slope, expected) in guess.likelihood_slopes().iter().zip(case.numbers("guess-slopes"))
        {
            assert!((slope - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{}", case.name);
        }
        let best = make("best");
        let points = || case.numbers("points").chunks(n_dimensions);
        let expected = case.numbers("means").iter().zip(case.numbers("deviations"));
        for (point, (mean, deviation)) in points().zip(expected) {
            let found = best.predict(point).expect("a point");
            assert!((found.mean - mean).abs() < 1e-8, "{}: {found:?} {mean}", case.name);
            assert!((found.observation_deviation / deviation - 1.0).abs() < 1e-5, "{}", case.name);
        }
        let settings = FitSettings { mean: Mean::Zero, ..FitSettings::default() };
        let fitted =
            GaussianProcess::fit(case.shape, observations.clone(), &settings).expect("good");
        let best_log = case.numbers("best-log")[0];
        let log = fitted.log_marginal_likelihood();
        assert!(log > best_log - 1e-4, "{}: {log} {best_log}", case.name);
        for point in points() {
            let (own, theirs) =
                (fitted.predict(point).expect("a point"), best.predict(point).expect("a point"));
            let apart = (own.mean - theirs.mean).abs() / theirs.observation_deviation;
            assert!(apart < 0.02, "{}: {own:?} {theirs:?}", case.name);
        }
    }
}

#[test]
fn bad_data_is_refused_by_name() {
    let fit = |observations| {
        GaussianProcess::fit(Shape::Matern52, observations, &FitSettings::default())
            .expect_err("bad data")
    };
    let good = || Observations::of_curve(vec![0.0, 1.0, 2.0], vec![1.0, 2.0, 1.5]);
    assert!(matches!(fit(Observations::of_curve(vec![], vec![])), SurrogateError::TooFew { .. }));
    let two = Observations::of_curve(vec![0.0, 1.0], vec![1.0, 2.0]);
    assert!(matches!(fit(two), SurrogateError::TooFew { n: 2, needed: 3 }));
    let uneven = Observations::of_curve(vec![0.0, 1.0], vec![1.0, 2.0, 3.0]);
    assert!(matches!(fit(uneven), SurrogateError::Lengths { .. }));
    assert!(matches!(fit(good().with_deviations(&[0.1])), SurrogateError::Lengths { .. }));
    let gap = Observations::of_curve(vec![0.0, 1.0, 2.0], vec![1.0, f64::NAN, 1.5]);
    assert_eq!(fit(gap), SurrogateError::NotFinite { what: "the values", index: 1 });
    let negative = Observations { variances: vec![0.1, -0.1, 0.1], ..good() };
    assert!(matches!(fit(negative), SurrogateError::NotPositive { .. }));
    let still =
        GaussianProcess::fit(Shape::Periodic { period: 0.0 }, good(), &FitSettings::default());
    assert!(matches!(still, Err(SurrogateError::NotPositive { what: "the period", .. })));
    let repeated = GaussianProcess::new(
        Shape::SquaredExponential,
        parameters(1.0, &[1.0], 0.0),
        Observations::of_curve(vec![1.0, 1.0], vec![1.0, 2.0]),
        Mean::Zero,
    );
    assert!(matches!(repeated, Err(SurrogateError::NotPositiveDefinite { n: 2 })));
    let process = GaussianProcess::fit(Shape::Matern52, good(), &FitSettings::default());
    assert!(process.expect("three observations").predict(&[0.0, 1.0]).is_err());
    // Values without any spread make a flat curve, not an error.
    let flat = Observations::of_curve(vec![0.0, 1.0, 2.0], vec![5.0; 3]);
    let flat = GaussianProcess::fit(Shape::Matern52, flat, &FitSettings::default()).expect("flat");
    assert!((flat.predict(&[0.5]).expect("one input").mean - 5.0).abs() < 1e-5);
}
