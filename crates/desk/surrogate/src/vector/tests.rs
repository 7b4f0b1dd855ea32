//! Tests of the loops.

use super::*;

#[test]
fn the_exponential_is_that_of_the_library() {
    for step in 0..70_000 {
        let x = -0.01 * f64::from(step);
        let expected = x.exp();
        // Two units of the last place.
        assert!((exp(x) - expected).abs() <= 4.5e-16 * expected, "{x}");
    }
    assert_eq!(exp(0.0), 1.0);
    assert!(exp(-1e9) < 1e-300);
}

#[test]
fn sums_and_squares_are_those_of_plain_loops() {
    let a: Vec<f64> = (0..77).map(|i| (0.3 * f64::from(i)).sin()).collect();
    let b: Vec<f64> = (0..77).map(|i| (0.7 * f64::from(i)).cos()).collect();
    let (mut product, mut weighted) = (0.0, 0.0);
    add_product(&mut product, &a, &b);
    add_weighted_squares(&mut weighted, &a, &b, 0.4);
    let plain: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
    assert!((product - plain).abs() < 1e-13);
    let plain: f64 = a.iter().zip(&b).map(|(a, b)| a * (b - 0.4) * (b - 0.4)).sum();
    assert!((weighted - plain).abs() < 1e-13);
    let mut squares = vec![0.0; 77];
    square_distances(&mut squares, &[&a, &b], &[0.1, 0.2]);
    for ((square, a), b) in squares.iter().zip(&a).zip(&b) {
        assert!((square - (a - 0.1).powi(2) - (b - 0.2).powi(2)).abs() < 1e-15);
    }
}
