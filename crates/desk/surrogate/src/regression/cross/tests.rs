//! Tests of leaving out: blocks of replicates that differ in group and known noise.

use crate::regression::{Kernel, NoiseGroups, Parameters, Regression, RegressionSettings, Trend};
use crate::{Observations, Shape};

const NOISE: [f64; 2] = [0.04, 0.25];
const N: usize = 24;

/// Rows over two inputs, two or three of each input, every one with a known variance of its own.
fn rows() -> (Observations, Vec<usize>) {
    let (mut inputs, mut values, mut variances, mut groups) = (vec![], vec![], vec![], vec![]);
    for row in 0..N {
        // Replicates do not stand together.
        let place = (5 * row % N % 9) as f64;
        let (x, y) = ((0.618 * place).fract() * 5.0, (0.755 * place).fract());
        inputs.extend([x, y]);
        values.push(3.0 + x.sin() + 2.0 * y + 0.4 * (12.9 * row as f64).sin());
        variances.push(0.01 + 0.003 * row as f64);
        groups.push(row % 2);
    }
    (Observations { inputs, n_dimensions: 2, values, variances }, groups)
}

fn made(data: &Observations, groups: &[usize], trend: Trend) -> Regression {
    let mut kernel = Kernel::of(Shape::Matern52, 2);
    (kernel.terms[0].variance, kernel.terms[0].parts[0].lengths) = (1.5, vec![1.2, 0.6]);
    let parameters = Parameters { kernel, noise: NOISE.to_vec() };
    let noise = NoiseGroups::Each(groups.to_vec());
    let settings = RegressionSettings { trend, noise, ..RegressionSettings::default() };
    Regression::new(&parameters, data, &settings).expect("good data")
}

/// Every row of an input is left out together, really, and their plain mean is predicted. A condition number
/// below 10³ leaves rounding far below 10⁻⁹.
#[test]
fn rows_of_one_input_are_left_out_together() {
    let (data, groups) = rows();
    for trend in [Trend::Zero, Trend::Constant, Trend::Linear] {
        let all = made(&data, &groups, trend);
        let found = all.leave_one_out().expect("exact");
        let n_inputs = all.n_inputs();
        assert!(all.collapsed().values.len() == N && n_inputs < N / 2 && found.len() == n_inputs);
        let in_folds = all.folds(n_inputs, 3).expect("folds");
        let mut seen: Vec<&[f64]> = Vec::new();
        for row in 0..N {
            let input = data.input(row);
            if seen.contains(&input) {
                continue;
            }
            seen.push(input);
            let (own, others): (Vec<usize>, Vec<usize>) =
                (0..N).partition(|other| data.input(*other) == input);
            let kept = Observations {
                inputs: others.iter().flat_map(|row| data.input(*row)).copied().collect(),
                n_dimensions: 2,
                values: others.iter().map(|row| data.values[*row]).collect(),
                variances: others.iter().map(|row| data.variances[*row]).collect(),
            };
            let kept_groups: Vec<usize> = others.iter().map(|row| groups[*row]).collect();
            let told = made(&kept, &kept_groups, trend).predict(input, 0).expect("one")[0];
            let n = own.len() as f64;
            let value = own.iter().map(|row| data.values[*row]).sum::<f64>() / n;
            let noise = own.iter().map(|row| NOISE[groups[*row]] + data.variances[*row]);
            let noise = noise.sum::<f64>() / (n * n);
            let deviation = (told.standard_deviation.powi(2) + noise).sqrt();
            for left in [&found[seen.len() - 1], &in_folds[seen.len() - 1]] {
                assert!((left.value - value).abs() < 1e-9, "{trend:?} {left:?} {value}");
                assert!((left.mean - told.mean).abs() < 1e-9, "{trend:?} {left:?} {told:?}");
                assert!((left.standard_deviation / deviation - 1.0).abs() < 1e-9, "{trend:?}");
            }
        }
    }
}
