//! The regression against direct least squares.

use super::*;
use crate::simulate::noise;

/// Regressors with columns of falling size, outputs of known coefficients and noise.
fn factor(rows: usize, columns: usize, fall: f64, strength: f64) -> Mat<f64> {
    let series: Vec<Vec<f64>> = (0..=columns).map(|i| noise(i as u64, rows)).collect();
    let whole = Mat::from_fn(rows, columns + 1, |row, column| {
        if column < columns {
            fall.powi(column as i32) * series[column][row]
        } else {
            let sum: f64 = (0..columns).map(|i| fall.powi(i as i32) * series[i][row]).sum();
            sum + strength * series[columns][row]
        }
    });
    whole.qr().thin_R().to_owned()
}

#[test]
fn without_noise_coefficients_are_exact() {
    for way in [Regularisation::Exact, Regularisation::CrossValidated] {
        let factor = factor(400, 8, 0.3, 0.0);
        let found = regression(factor.as_ref(), 8, 400, way).expect("converges");
        for column in 0..8 {
            assert!((found.coefficients[(column, 0)] - 1.0).abs() < 1e-9);
        }
        assert!(found.covariance[(0, 0)] < 1e-24);
    }
}

/// With noise, errors lie within a few of their own deviations, and the residuals have the noise's variance.
#[test]
fn deviations_are_those_of_the_errors() {
    let factor = factor(2000, 6, 0.5, 0.2);
    let found = regression(factor.as_ref(), 6, 2000, Regularisation::Exact).expect("converges");
    for column in 0..6_i32 {
        let deviation = found.deviations[(column as usize, 0)];
        let expected = 0.2 / (2000.0_f64.sqrt() * 0.5_f64.powi(column));
        assert!((deviation / expected - 1.0).abs() < 0.1, "{deviation} {expected}");
        assert!((found.coefficients[(column as usize, 0)] - 1.0).abs() < 3.5 * deviation);
    }
    assert!((found.covariance[(0, 0)] / 0.04 - 1.0).abs() < 0.1);
}

/// Where most regressors are noise, a penalty leaves smaller errors than none.
#[test]
fn cross_validation_helps_where_coefficients_are_many() {
    let error = |way: Regularisation| {
        let factor = factor(150, 100, 0.8, 3.0);
        let found = regression(factor.as_ref(), 100, 150, way).expect("converges").coefficients;
        (0..100).map(|c| (0.8_f64.powi(c as i32) * (found[(c, 0)] - 1.0)).powi(2)).sum::<f64>()
    };
    let (exact, validated) = (error(Regularisation::Exact), error(Regularisation::CrossValidated));
    assert!(validated < 0.3 * exact, "{validated} {exact}");
}
