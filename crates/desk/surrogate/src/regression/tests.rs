//! Tests of the regression: plain sums over all observations, differences, and leaving out.

use super::*;
use crate::sample::Normals;
use crate::{GaussianProcess, Hyperparameters, Mean, Observations, Shape, SurrogateError};
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use std::f64::consts::TAU;

/// `n` observations of a smooth function of three inputs of different size; every third input comes twice.
fn data(n: usize) -> Observations {
    let mut normals = Normals::new(5);
    let (mut inputs, mut values) = (Vec::new(), Vec::new());
    for index in 0..n {
        let mut input =
            vec![8.0 + normals.next(), 270.0 + 40.0 * normals.next(), 0.01 * normals.next()];
        if index % 3 == 2 {
            input = inputs[inputs.len() - 3..].to_vec();
        }
        let level = input[0] + 2.0 * (input[1] / 57.3).sin() + 30.0 * input[2];
        values.push(1e3 * (level + 0.3 * normals.next()));
        inputs.extend(input);
    }
    Observations { inputs, n_dimensions: 3, values, variances: Vec::new() }
}

fn part(shape: Shape, inputs: &[usize], lengths: &[f64]) -> Part {
    Part { shape, inputs: inputs.to_vec(), lengths: lengths.to_vec() }
}

/// A sum of products of every shape.
fn everything() -> Kernel {
    let turning = Shape::Periodic { period: 360.0 };
    let first = vec![
        part(Shape::SquaredExponential, &[0, 2], &[2.0, 0.03]),
        part(turning, &[1], &[1.3]),
        part(Shape::RationalQuadratic { exponent: 1.7 }, &[2, 1], &[0.02, 70.0]),
    ];
    let second = vec![part(Shape::Matern32, &[0, 1, 2], &[3.0, 50.0, 0.04])];
    let third = vec![
        part(Shape::Matern52, &[1], &[35.0]),
        part(Shape::RationalQuadratic { exponent: 0.4 }, &[0], &[1.1]),
    ];
    let term = |variance, parts| Term { variance, parts };
    Kernel { terms: vec![term(4e6, first), term(9e5, second), term(2e6, third)] }
}

/// Covariance of two points, written out.
fn covariance(kernel: &Kernel, a: &[f64], b: &[f64]) -> f64 {
    let of_part = |part: &Part| {
        let along = part.inputs.iter().zip(&part.lengths);
        let square: f64 = match part.shape {
            Shape::Periodic { period } => along
                .map(|(i, l)| {
                    (2.0 * (std::f64::consts::PI * (a[*i] - b[*i]) / period).sin() / l).powi(2)
                })
                .sum(),
            _ => along.map(|(i, l)| ((a[*i] - b[*i]) / l).powi(2)).sum(),
        };
        let r = square.sqrt();
        match part.shape {
            Shape::Periodic { .. } | Shape::SquaredExponential => (-square / 2.0).exp(),
            Shape::Matern32 => (1.0 + 3_f64.sqrt() * r) * (-(3_f64.sqrt()) * r).exp(),
            Shape::Matern52 => {
                (1.0 + 5_f64.sqrt() * r + 5.0 * square / 3.0) * (-(5_f64.sqrt()) * r).exp()
            }
            Shape::RationalQuadratic { exponent } => {
                (1.0 + square / (2.0 * exponent)).powf(-exponent)
            }
        }
    };
    let of_term = |term: &Term| term.variance * term.parts.iter().map(of_part).product::<f64>();
    kernel.terms.iter().map(of_term).sum()
}

/// Log likelihood, mean and deviation at `query`, of all observations as they are, none collapsed.
fn plain(
    kernel: &Kernel,
    noise: &[f64],
    groups: &[usize],
    trend: Trend,
    data: &Observations,
    query: &[f64],
) -> [f64; 3] {
    let n = data.len();
    let matrix = Mat::from_fn(n, n, |i, j| {
        let own = if i == j { noise[groups[i]] + data.variance(i) } else { 0.0 };
        covariance(kernel, data.input(i), data.input(j)) + own
    });
    let factor = matrix.llt(Side::Lower).expect("positive definite");
    let functions = |x: &[f64]| -> Vec<f64> {
        std::iter::once(1.0).chain(x.iter().copied()).take(trend.n_coefficients(x.len())).collect()
    };
    let q = trend.n_coefficients(data.n_dimensions);
    let basis = Mat::from_fn(n, q, |row, column| functions(data.input(row))[column]);
    let values = Mat::from_fn(n, 1, |row, _| data.values[row]);
    let of_basis = factor.solve(&basis);
    let square = basis.transpose() * &of_basis;
    let coefficients = square.full_piv_lu().solve(of_basis.transpose() * &values);
    let rest = &values - &basis * &coefficients;
    let weights = factor.solve(&rest);
    let log_det: f64 = (0..n).map(|i| 2.0 * factor.L()[(i, i)].ln()).sum();
    let fitted = (rest.transpose() * &weights)[(0, 0)];
    let log = -0.5 * (fitted + log_det + n as f64 * TAU.ln());
    let known = Mat::from_fn(n, 1, |row, _| covariance(kernel, data.input(row), query));
    let here = Mat::from_fn(q, 1, |row, _| functions(query)[row]);
    let mean = (known.transpose() * &weights)[(0, 0)] + (here.transpose() * &coefficients)[(0, 0)];
    let missing = &here - of_basis.transpose() * &known;
    let of_trend = (missing.transpose() * square.full_piv_lu().solve(&missing))[(0, 0)];
    let explained = (known.transpose() * factor.solve(&known))[(0, 0)];
    [log, mean, (kernel.variance() - explained + of_trend).sqrt()]
}

fn settings(trend: Trend, noise: NoiseGroups) -> RegressionSettings {
    RegressionSettings { trend, noise, ..RegressionSettings::default() }
}

/// Replicates collapsed, inputs scaled, blocks and vectors: the same as sums over all observations. The
/// condition number of K is some 10⁴, so that 10⁻⁹ is far above rounding.
#[test]
fn the_regression_is_the_plain_process_of_all_observations() {
    let kernel = everything();
    let mut data = data(60);
    data.variances = (0..60).map(|i| if i / 3 % 2 == 0 { 2e4 } else { 0.0 }).collect();
    let groups: Vec<usize> = (0..60).map(|i| usize::from(i % 6 > 2)).collect();
    let noise = vec![9e4, 4e4];
    let query = [8.3, 255.0, 0.004];
    for trend in [Trend::Zero, Trend::Constant, Trend::Linear] {
        let parameters = Parameters { kernel: kernel.clone(), noise: noise.clone() };
        let settings = settings(trend, NoiseGroups::Each(groups.clone()));
        let found = Regression::new(&parameters, &data, &settings).expect("good data");
        let [log, mean, deviation] = plain(&kernel, &noise, &groups, trend, &data, &query);
        let own = found.predict(&query, 1).expect("a query")[0];
        assert!((found.log_marginal_likelihood() - log).abs() < 1e-8, "{trend:?} {log}");
        assert!((own.mean - mean).abs() < 1e-9 * mean.abs(), "{trend:?} {own:?} {mean}");
        assert!((own.standard_deviation / deviation - 1.0).abs() < 1e-8, "{trend:?}");
        let both = (deviation * deviation + noise[1]).sqrt();
        assert!((own.observation_deviation / both - 1.0).abs() < 1e-8);
        assert!(found.collapsed().values.len() < 60 && found.jitter() == 0.0);
        for (own, given) in found.parameters().noise.iter().zip(&noise) {
            assert!((own / given - 1.0).abs() < 1e-12);
        }
    }
}

/// Central differences with a step h err by some h² and rounding over h: 10⁻⁶ of the largest.
#[test]
fn slopes_of_the_likelihood_are_its_differences() {
    let data = data(60);
    let groups: Vec<usize> = (0..60).map(|i| usize::from(i % 6 > 2)).collect();
    let settings = settings(Trend::Linear, NoiseGroups::Each(groups));
    let of = |logarithms: &[f64]| {
        let (kernel, noise) = everything().with(logarithms);
        let noise = noise.iter().map(|log| log.exp()).collect();
        Regression::new(&Parameters { kernel, noise }, &data, &settings).expect("good data")
    };
    let mut at = everything().logarithms();
    at.extend([9e4_f64.ln(), 4e4_f64.ln()]);
    let slopes = of(&at).likelihood_slopes().expect("exact");
    let largest = slopes.iter().fold(1.0_f64, |most, slope| most.max(slope.abs()));
    for index in 0..at.len() {
        let moved = |step: f64| {
            let mut at = at.clone();
            at[index] += step;
            of(&at).log_marginal_likelihood()
        };
        let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
        assert!(
            (slopes[index] - difference).abs() < 1e-6 * largest,
            "{index} {difference} {slopes:?}"
        );
    }
}

#[test]
fn leave_one_out_is_leaving_out() {
    let mut data = data(30);
    data.inputs.truncate(3 * 20);
    data.values.truncate(20);
    let parameters = Parameters { kernel: everything(), noise: vec![9e4] };
    let settings = settings(Trend::Constant, NoiseGroups::One);
    let all = Regression::new(&parameters, &data, &settings).expect("good data");
    let collapsed = all.collapsed();
    let found = all.leave_one_out().expect("exact");
    let in_folds = all.folds(collapsed.values.len(), 3).expect("folds");
    for (index, left) in found.iter().enumerate() {
        let keep = |values: &[f64]| -> Vec<f64> {
            values.iter().enumerate().filter(|v| v.0 != index).map(|v| *v.1).collect()
        };
        let mut others = collapsed.clone();
        others.inputs.drain(3 * index..3 * index + 3);
        others.groups.pop();
        let parts = [&mut others.values, &mut others.counts, &mut others.within, &mut others.known];
        parts.into_iter().for_each(|part| *part = keep(part));
        let of_others = Regression::restore(&parameters, &others, &settings).expect("good data");
        let own =
            of_others.predict(&collapsed.inputs[3 * index..3 * index + 3], 0).expect("one")[0];
        let noise = 9e4 / collapsed.counts[index];
        let deviation = (own.standard_deviation.powi(2) + noise).sqrt();
        for left in [left, &in_folds[index]] {
            assert!((left.mean - own.mean).abs() < 1e-8 * own.mean.abs(), "{left:?} {own:?}");
            assert!((left.standard_deviation / deviation - 1.0).abs() < 1e-8);
            assert!((left.value - collapsed.values[index]).abs() < 1e-8);
        }
    }
}

#[test]
fn it_is_the_process_of_curves() {
    let data = data(21);
    let (lengths, signal, noise) = (vec![2.0, 60.0, 0.03], 3e6, 9e4);
    let mut kernel = Kernel::of(Shape::Matern52, 3);
    kernel.terms[0].variance = signal;
    kernel.terms[0].parts[0].lengths = lengths.clone();
    let parameters = Parameters { kernel, noise: vec![noise] };
    let settings = settings(Trend::Constant, NoiseGroups::One);
    let own = Regression::new(&parameters, &data, &settings).expect("good data");
    let parameters = Hyperparameters { signal_variance: signal, lengths, noise_variance: noise };
    let other = GaussianProcess::new(Shape::Matern52, parameters, data, Mean::Constant);
    let other = other.expect("good data");
    let (a, b) = (own.log_marginal_likelihood(), other.log_marginal_likelihood());
    assert!((a - b).abs() < 1e-9, "{a} {b}");
    let query = [7.7, 300.0, 0.0];
    let (a, b) = (own.predict(&query, 0).expect("one")[0], other.predict(&query).expect("one"));
    assert!((a.mean - b.mean).abs() < 1e-8 * b.mean.abs());
    assert!((a.standard_deviation / b.standard_deviation - 1.0).abs() < 1e-8);
    let outside = own.outside(&[7.7, 900.0, 0.0, 7.8, 270.0, 0.0]);
    assert_eq!((outside.len(), outside[0].input, outside[0].furthest), (1, 1, 900.0));
}

/// With every observation an inducing point nothing is lost but the jitter, 10⁻¹⁰ of the variance.
#[test]
fn inducing_points_at_all_observations_are_exact() {
    let data = data(90);
    let parameters = Parameters { kernel: everything(), noise: vec![9e4] };
    for trend in [Trend::Zero, Trend::Linear] {
        let exact = settings(trend, NoiseGroups::One);
        let sparse = RegressionSettings { exact_up_to: 0, n_inducing: 90, ..exact.clone() };
        let exact = Regression::new(&parameters, &data, &exact).expect("good data");
        let sparse = Regression::new(&parameters, &data, &sparse).expect("good data");
        let query = [8.3, 255.0, 0.004, 9.0, 301.0, -0.01];
        let (a, b) = (exact.predict(&query, 0), sparse.predict(&query, 0));
        for (a, b) in a.expect("two").iter().zip(&b.expect("two")) {
            assert!((a.mean - b.mean).abs() < 1e-5 * a.mean.abs(), "{a:?} {b:?}");
            assert!(
                (a.standard_deviation / b.standard_deviation - 1.0).abs() < 1e-4,
                "{a:?} {b:?}"
            );
        }
        let (a, b) = (exact.log_marginal_likelihood(), sparse.log_marginal_likelihood());
        assert!((a - b).abs() < 1e-3, "{a} {b}");
        assert_eq!(sparse.sparse().expect("sparse").n_points, exact.collapsed().values.len());
    }
}

/// Beyond `exact_up_to` no likelihood of all observations is worked out, at which the cube of their number
/// would be paid; below, that of all is.
#[test]
fn inducing_points_never_ask_for_the_likelihood_of_all() {
    let data = data(90);
    let kernel = Kernel::of(Shape::SquaredExponential, 3);
    let mut settings = settings(Trend::Constant, NoiseGroups::One);
    (settings.search.n_starts, settings.search.n_first, settings.n_inducing) = (2, 20, 15);
    let largest = |settings: &RegressionSettings| {
        let found = Regression::fit(&kernel, &data, settings).expect("a fit");
        (found.searched().expect("a search").n_largest, found.collapsed().values.len())
    };
    let (n_largest, n) = largest(&settings);
    assert_eq!(n_largest, n);
    settings.exact_up_to = 0;
    assert_eq!(largest(&settings), (20, n));
}

/// The same data in other units has the same fit, told in these units; and threads change no bit.
#[test]
fn a_fit_is_told_in_the_users_units() {
    let data = data(45);
    let kernel = Kernel::of(Shape::Matern32, 3);
    let mut settings = settings(Trend::Constant, NoiseGroups::One);
    settings.search.n_starts = 2;
    let found = Regression::fit(&kernel, &data, &settings).expect("a fit");
    settings.search.n_threads = 1;
    let alone = Regression::fit(&kernel, &data, &settings).expect("a fit");
    assert_eq!(found.parameters(), alone.parameters());
    let mut other = data.clone();
    other.inputs.iter_mut().skip(1).step_by(3).for_each(|x| *x = x.to_radians());
    other.values.iter_mut().for_each(|value| *value *= 1e-3);
    let other = Regression::fit(&kernel, &other, &settings).expect("a fit");
    let [a, b] = [&found, &other].map(|of| of.parameters().kernel.terms[0].clone());
    // Two searches end where their slopes are below 10⁻⁵; lengths along a flat ridge agree less well.
    assert!((a.parts[0].lengths[1].to_radians() / b.parts[0].lengths[1] - 1.0).abs() < 1e-2);
    assert!((a.variance * 1e-6 / b.variance - 1.0).abs() < 1e-2, "{a:?} {b:?}");
    let shift = 45.0 * 1e3_f64.ln();
    let (a, b) = (found.log_marginal_likelihood() + shift, other.log_marginal_likelihood());
    assert!((a - b).abs() < 1e-5, "{a} {b}");
    let noise = found.parameters().noise[0].sqrt();
    assert!(noise > 150.0 && noise < 600.0, "{noise}");
}

#[test]
fn bad_data_is_refused_by_name() {
    let kernel = Kernel::of(Shape::SquaredExponential, 3);
    let settings = RegressionSettings::default();
    let refused = |data: &Observations, settings: &RegressionSettings| {
        Regression::fit(&kernel, data, settings).expect_err("bad data")
    };
    let mut still = data(12);
    still.inputs.iter_mut().skip(1).step_by(3).for_each(|x| *x = 270.0);
    let constant = SurrogateError::Constant { input: 1, value: 270.0 };
    assert_eq!(refused(&still, &settings), constant);
    assert!(matches!(refused(&data(3), &settings), SurrogateError::TooFew { n: 2, needed: 3 }));
    let known = RegressionSettings { noise: NoiseGroups::Known, ..settings.clone() };
    assert!(matches!(refused(&data(12), &known), SurrogateError::Replicates { n: 2, .. }));
    let gap = NoiseGroups::Each((0..12).map(|i| 2 * (i % 2)).collect());
    let gap = RegressionSettings { noise: gap, ..settings.clone() };
    assert_eq!(refused(&data(12), &gap), SurrogateError::EmptyGroup { group: 1 });
    let mut broken = data(12);
    broken.values[4] = f64::NAN;
    let nan = SurrogateError::NotFinite { what: "the values", index: 4 };
    assert_eq!(refused(&broken, &settings), nan);
}

/// Without noise a smooth kernel of close points cannot be factorised; the jitter that helps is told.
#[test]
fn a_jitter_is_told() {
    let inputs: Vec<f64> = (0..60).map(|i| 0.01 * f64::from(i)).collect();
    let values = inputs.iter().map(|x| x.sin()).collect();
    let mut kernel = Kernel::of(Shape::SquaredExponential, 1);
    kernel.terms[0].parts[0].lengths = vec![1.0];
    let parameters = Parameters { kernel, noise: Vec::new() };
    let settings = settings(Trend::Zero, NoiseGroups::Known);
    let found = Regression::new(&parameters, &Observations::of_curve(inputs, values), &settings);
    let found = found.expect("with a jitter");
    assert!(found.jitter() > 0.0);
    assert!((found.means(&[0.305]).expect("one")[0] - 0.305_f64.sin()).abs() < 1e-5);
}
