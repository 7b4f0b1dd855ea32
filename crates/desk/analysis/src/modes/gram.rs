//! Products of all rows with all rows, summed over points.

use realfft::num_complex::Complex64;

/// Points that are looked at together (–): two rows of them stay in the nearest cache.
const TOGETHER: usize = 1024;
/// Sums that go side by side (–).
const LANES: usize = 8;

/// Adds to `products`, n × n, that of each two of the n rows of `n_points` in `rows`; to both triangles.
pub(super) fn add_products(rows: &[f64], n_points: usize, products: &mut [f64]) {
    let n = rows.len() / n_points.max(1);
    for start in (0..n_points).step_by(TOGETHER) {
        let end = (start + TOGETHER).min(n_points);
        let part = |i: usize| &rows[i * n_points + start..i * n_points + end];
        for i in 0..n {
            for j in 0..=i {
                let product = dot(part(i), part(j));
                products[i * n + j] += product;
                if j < i {
                    products[j * n + i] += product;
                }
            }
        }
    }
}

/// Adds to `products`, n × n, the conjugate of each of the n rows of `n_points` in `rows` times each; to
/// the lower triangle.
pub(super) fn add_hermitian_products(
    rows: &[Complex64],
    n_points: usize,
    products: &mut [Complex64],
) {
    let n = rows.len() / n_points.max(1);
    for start in (0..n_points).step_by(TOGETHER) {
        let end = (start + TOGETHER).min(n_points);
        let part = |i: usize| &rows[i * n_points + start..i * n_points + end];
        for i in 0..n {
            for j in 0..=i {
                let pairs = part(i).iter().zip(part(j));
                products[i * n + j] += pairs.map(|(a, b)| a.conj() * b).sum::<Complex64>();
            }
        }
    }
}

/// Sum of the products of `one` and `other`.
fn dot(one: &[f64], other: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (ones, others) = (one.chunks_exact(LANES), other.chunks_exact(LANES));
    let rest: f64 = ones.remainder().iter().zip(others.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in ones.zip(others) {
        for lane in 0..LANES {
            sums[lane] += a[lane] * b[lane];
        }
    }
    sums.iter().sum::<f64>() + rest
}
