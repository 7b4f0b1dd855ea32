//! Eigenvalues and vectors of Hermitian matrices of moderate size.
//!
//! Householder's reflections to a tridiagonal matrix, then the implicit symmetric QR step with Wilkinson's
//! shift. Source: Golub and Van Loan, "Matrix Computations", 4th ed., 2013, §8.3. Written here, as a
//! library of dense algebra would come into every build of the program, and modes need this alone.

use realfft::num_complex::Complex64;

const NOTHING: Complex64 = Complex64::new(0.0, 0.0);
const ONE: Complex64 = Complex64::new(1.0, 0.0);
/// Steps for each eigenvalue at most (–); two or three are usual.
const MOST_STEPS: usize = 60;

/// Eigenvalues, greatest first, with their vectors of length 1, one a row.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Eigen {
    pub(super) values: Vec<f64>,
    pub(super) vectors: Vec<Vec<Complex64>>,
}

/// Those of `matrix`, `n` × `n` in rows, of which the lower triangle is read; in single file by size of the
/// matrix cubed.
pub(super) fn eigen(matrix: &[Complex64], n: usize) -> Eigen {
    let mut rows: Vec<Vec<Complex64>> = (0..n)
        .map(|i| {
            let upper = |j: usize| matrix[j * n + i].conj();
            let entry = |j: usize| if j <= i { matrix[i * n + j] } else { upper(j) };
            (0..n).map(entry).collect()
        })
        .collect();
    let reflections = reduced(&mut rows);
    let mut diagonal: Vec<f64> = (0..n).map(|i| rows[i][i].re).collect();
    let beside: Vec<Complex64> = (1..n).map(|i| rows[i][i - 1]).collect();
    let mut sizes: Vec<f64> = beside.iter().map(|entry| entry.norm()).collect();
    let mut vectors = columns(&reflections, &beside, n);
    diagonalise(&mut diagonal, &mut sizes, &mut vectors);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| diagonal[*b].total_cmp(&diagonal[*a]));
    Eigen {
        values: order.iter().map(|i| diagonal[*i]).collect(),
        vectors: order.iter().map(|i| std::mem::take(&mut vectors[*i])).collect(),
    }
}

/// On return `rows` are tridiagonal; gives the vector of each reflection, from its second row on.
fn reduced(rows: &mut [Vec<Complex64>]) -> Vec<Vec<Complex64>> {
    let n = rows.len();
    let mut reflections = Vec::new();
    for k in 0..n.saturating_sub(2) {
        let mut v: Vec<Complex64> = (k + 1..n).map(|i| rows[i][k]).collect();
        let size = norm(&v);
        let first = v[0];
        if size > first.norm() * (1.0 + f64::EPSILON) {
            let turn = if first.norm() > 0.0 { first / first.norm() } else { ONE };
            let beside = -turn * size;
            v[0] -= beside;
            let length = norm(&v);
            v.iter_mut().for_each(|entry| *entry /= length);
            reflect(rows, k + 1, &v);
            for (below, row) in rows[k + 1..].iter_mut().enumerate() {
                row[k] = if below == 0 { beside } else { NOTHING };
            }
        } else {
            v.fill(NOTHING);
        }
        reflections.push(v);
    }
    reflections
}

/// On return `rows` from `start` on are reflected from both sides by `v`, of length 1: A − v w* − w v* with
/// w = 2 A v − 2 (v* A v) v.
fn reflect(rows: &mut [Vec<Complex64>], start: usize, v: &[Complex64]) {
    let product = |row: &Vec<Complex64>| -> Complex64 {
        row[start..].iter().zip(v).map(|(entry, v)| entry * v).sum()
    };
    let mut w: Vec<Complex64> = rows[start..].iter().map(product).collect();
    let within: f64 = v.iter().zip(&w).map(|(v, p)| (v.conj() * p).re).sum();
    for (w, v) in w.iter_mut().zip(v) {
        *w = 2.0 * (*w - within * v);
    }
    for (i, row) in rows[start..].iter_mut().enumerate() {
        let (v_i, w_i) = (v[i], w[i]);
        for ((entry, v), w) in row[start..].iter_mut().zip(v).zip(&w) {
            *entry -= v_i * w.conj() + w_i * v.conj();
        }
    }
}

/// The columns of the product of all `reflections`, turned so that the entries `beside` the diagonal are
/// their sizes.
fn columns(reflections: &[Vec<Complex64>], beside: &[Complex64], n: usize) -> Vec<Vec<Complex64>> {
    let mut columns = vec![vec![NOTHING; n]; n];
    let mut turn = ONE;
    for (i, column) in columns.iter_mut().enumerate() {
        if i > 0 && beside[i - 1].norm() > 0.0 {
            turn *= beside[i - 1] / beside[i - 1].norm();
        }
        column[i] = turn;
        for (k, v) in reflections.iter().enumerate().rev() {
            let own = &mut column[k + 1..];
            let along: Complex64 = own.iter().zip(v).map(|(x, v)| v.conj() * x).sum();
            for (x, v) in own.iter_mut().zip(v) {
                *x -= 2.0 * along * v;
            }
        }
    }
    columns
}

/// On return `diagonal` holds the eigenvalues of the tridiagonal matrix with `beside` next to it, and
/// `vectors` are turned with it.
fn diagonalise(diagonal: &mut [f64], beside: &mut [f64], vectors: &mut [Vec<Complex64>]) {
    let is_small = |diagonal: &[f64], beside: &[f64], i: usize| {
        beside[i].abs() <= f64::EPSILON * (diagonal[i].abs() + diagonal[i + 1].abs())
    };
    let mut last = diagonal.len().saturating_sub(1);
    let mut n_steps = 0;
    while last > 0 {
        if is_small(diagonal, beside, last - 1) || n_steps == MOST_STEPS {
            beside[last - 1] = 0.0;
            last -= 1;
            n_steps = 0;
            continue;
        }
        let mut first = last - 1;
        while first > 0 && !is_small(diagonal, beside, first - 1) {
            first -= 1;
        }
        step(diagonal, beside, vectors, first, last);
        n_steps += 1;
    }
}

/// One QR step on the entries from `first` to `last`.
fn step(
    diagonal: &mut [f64],
    beside: &mut [f64],
    vectors: &mut [Vec<Complex64>],
    first: usize,
    last: usize,
) {
    // Wilkinson's shift: the eigenvalue of the last two rows that is nearer to the last entry.
    let half = 0.5 * (diagonal[last - 1] - diagonal[last]);
    let edge = beside[last - 1];
    let shift = diagonal[last] - edge * edge / (half + half.hypot(edge).copysign(half));
    let (mut x, mut bulge) = (diagonal[first] - shift, beside[first]);
    for k in first..last {
        let size = x.hypot(bulge);
        let (c, s) = if size > 0.0 { (x / size, bulge / size) } else { (1.0, 0.0) };
        if k > first {
            beside[k - 1] = size;
        }
        let (a, b, e) = (diagonal[k], diagonal[k + 1], beside[k]);
        diagonal[k] = c * c * a + 2.0 * c * s * e + s * s * b;
        diagonal[k + 1] = s * s * a - 2.0 * c * s * e + c * c * b;
        beside[k] = c * s * (b - a) + (c * c - s * s) * e;
        x = beside[k];
        if k + 1 < last {
            bulge = s * beside[k + 1];
            beside[k + 1] *= c;
        }
        let (upper, lower) = vectors.split_at_mut(k + 1);
        for (one, other) in upper[k].iter_mut().zip(&mut lower[0]) {
            let before = *one;
            *one = c * before + s * *other;
            *other = c * *other - s * before;
        }
    }
}

fn norm(values: &[Complex64]) -> f64 {
    values.iter().map(|value| value.norm_sqr()).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A Hermitian matrix whose entries are `numbers`.
    fn matrix(n: usize, numbers: &[f64]) -> Vec<Complex64> {
        let mut next = numbers.iter().copied().cycle();
        let mut entries = vec![NOTHING; n * n];
        for i in 0..n {
            for j in 0..=i {
                let [re, im] = [0, 1].map(|_| next.next().unwrap_or(0.0));
                entries[i * n + j] = Complex64::new(re, if i == j { 0.0 } else { im });
                entries[j * n + i] = entries[i * n + j].conj();
            }
        }
        entries
    }

    fn holds(matrix: &[Complex64], n: usize) {
        let found = eigen(matrix, n);
        let size = matrix.iter().map(|entry| entry.norm()).fold(1e-300, f64::max);
        for (k, vector) in found.vectors.iter().enumerate() {
            for i in 0..n {
                let product: Complex64 = (0..n).map(|j| matrix[i * n + j] * vector[j]).sum();
                let away = (product - found.values[k] * vector[i]).norm();
                assert!(away < 1e-12 * size * n as f64, "{away} of {size}");
            }
            for (other, own) in found.vectors.iter().enumerate() {
                let product: Complex64 = own.iter().zip(vector).map(|(a, b)| a.conj() * b).sum();
                let expected = f64::from(u8::from(other == k));
                assert!((product - expected).norm() < 1e-12 * n as f64);
            }
        }
        assert!(found.values.windows(2).all(|pair| pair[0] >= pair[1]));
    }

    #[test]
    fn known_eigenvalues_come_out() {
        // 2, −i; i, 2: 3 and 1.
        let i = Complex64::i();
        let found = eigen(&[2.0 * ONE, -i, i, 2.0 * ONE], 2);
        assert!((found.values[0] - 3.0).abs() < 1e-14 && (found.values[1] - 1.0).abs() < 1e-14);
        // The second difference of n points: 2 − 2 cos (π k / (n + 1)).
        let n = 40;
        let entry = |index: usize| match (index / n).abs_diff(index % n) {
            0 => 2.0 * ONE,
            1 => -ONE,
            _ => NOTHING,
        };
        let difference: Vec<Complex64> = (0..n * n).map(entry).collect();
        let found = eigen(&difference, n);
        for (k, value) in found.values.iter().rev().enumerate() {
            let angle = std::f64::consts::PI * (k + 1) as f64 / (n + 1) as f64;
            assert!((value - (2.0 - 2.0 * angle.cos())).abs() < 1e-13, "{k}: {value}");
        }
    }

    #[test]
    fn nothing_one_and_the_same_are_matrices_too() {
        assert_eq!(eigen(&[], 0).values, [0.0; 0]);
        assert_eq!(eigen(&[-3.0 * ONE], 1).values, [-3.0]);
        for n in [3, 8] {
            holds(&vec![NOTHING; n * n], n);
            holds(&matrix(n, &[1.0, 0.0]), n);
            let unit: Vec<Complex64> =
                (0..n * n).map(|i| if i / n == i % n { ONE } else { NOTHING }).collect();
            holds(&unit, n);
        }
    }

    proptest! {
        #[test]
        fn vectors_stand_upright_and_are_only_stretched(
            n in 1_usize..14, numbers in prop::collection::vec(-1.0..1.0, 1..200), power in -30..30,
        ) {
            let scale = 10.0_f64.powi(power);
            let numbers: Vec<f64> = numbers.iter().map(|number| scale * number).collect();
            holds(&matrix(n, &numbers), n);
        }
    }
}
