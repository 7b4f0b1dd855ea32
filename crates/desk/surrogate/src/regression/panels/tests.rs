//! Tests of the factor against plain products of matrices.

use super::*;
use faer::linalg::solvers::Solve;

/// Symmetric, diagonally dominant, of any size.
fn entry(row: usize, column: usize) -> f64 {
    let away = row.abs_diff(column) as f64;
    let level = (row + column) as f64;
    if row == column {
        3.0 + (0.01 * level).sin()
    } else {
        (0.1 * level).cos() / (1.0 + away * away)
    }
}

fn factor(n: usize, n_threads: usize) -> Panels {
    Panels::factor(n, n_threads, |rows, column, target| {
        rows.zip(target).for_each(|(row, value)| *value = entry(row, column));
    })
    .expect("positive definite")
}

/// The sizes leave one block, some, and some with a rest.
#[test]
fn a_factor_solves_inverts_and_has_the_determinant() {
    for n in [1, 7, 256, 300, 700] {
        let (panels, matrix) = (factor(n, 2), Mat::from_fn(n, n, entry));
        let right = Mat::from_fn(n, 2, |row, column| (row as f64 + 0.3 * column as f64).sin());
        let back = &matrix * panels.solve(&right) - &right;
        assert!(back.norm_max() < 1e-13, "{n}: {}", back.norm_max());
        let own = matrix.llt(Side::Lower).expect("positive definite");
        let log: f64 = (0..n).map(|i| 2.0 * own.L()[(i, i)].ln()).sum();
        assert!((panels.log_determinant() - log).abs() < 1e-11);
        let inverse = panels.inverse_factor();
        let mut worst = 0.0_f64;
        let unit = own.solve(Mat::<f64>::identity(n, n));
        let tiles =
            inverse.visit_inverse(|| (), |(), row, column, tile| (row, column, tile.to_owned()));
        for (row, column, tile) in tiles {
            for j in 0..tile.ncols() {
                for i in 0..tile.nrows() {
                    worst = worst.max((tile[(i, j)] - unit[(row + i, column + j)]).abs());
                }
            }
        }
        for i in 0..n {
            for j in [i, n - 1 - i] {
                worst = worst.max((inverse.inverse_entry(i, j) - unit[(i, j)]).abs());
            }
        }
        assert!(worst < 1e-13, "{n}: {worst}");
    }
}

#[test]
fn threads_change_no_bit() {
    let right = Mat::from_fn(900, 1, |row, _| row as f64);
    let [one, three] = [1, 3].map(|n_threads| factor(900, n_threads));
    assert_eq!(one.solve(&right), three.solve(&right));
    let [one, three] = [one, three].map(|panels| panels.inverse_factor());
    for place in 0..900 {
        assert_eq!(one.inverse_entry(place, 450), three.inverse_entry(place, 450));
    }
}

#[test]
fn what_is_not_positive_definite_has_no_factor() {
    let of = |value: f64| {
        Panels::factor(3, 1, |rows, column, target| {
            rows.zip(target).for_each(|(row, entry)| {
                *entry = if row == column { 1.0 } else { value };
            });
        })
    };
    assert!(of(1.5).is_none());
    assert!(of(f64::NAN).is_none());
    assert!(of(0.1).is_some());
}
