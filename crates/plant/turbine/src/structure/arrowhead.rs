//! Arrowhead matrices of a rotor: symmetric, and blades couple only through the shared coordinates, which
//! keeps solving cheap.
#![expect(
    clippy::needless_range_loop,
    reason = "rows and columns by index, as the equations have them"
)]

use super::coordinates::{Coordinates, Locks, N_MODES, N_SHARED};
use basis::blades::MAXIMUM_BLADES;

/// A symmetric arrowhead matrix over all coordinates: a block for each blade, coupled to the shared block
/// only.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ArrowheadMatrix {
    pub(super) shared: [[f64; N_SHARED]; N_SHARED],
    /// Rows: modes of the blade, columns: shared coordinates.
    pub(super) coupling: [[[f64; N_SHARED]; N_MODES]; MAXIMUM_BLADES],
    pub(super) blades: [[[f64; N_MODES]; N_MODES]; MAXIMUM_BLADES],
}

impl ArrowheadMatrix {
    /// The matrix times `x`, for `n_blades` blades.
    pub(super) fn times(&self, n_blades: usize, x: &Coordinates) -> Coordinates {
        let mut product = Coordinates::default();
        for (sum, row) in product.shared.iter_mut().zip(&self.shared) {
            *sum = dot(row, &x.shared);
        }
        for blade in 0..n_blades {
            for mode in 0..N_MODES {
                let coupling = &self.coupling[blade][mode];
                product.blades[blade][mode] =
                    dot(coupling, &x.shared) + dot(&self.blades[blade][mode], &x.blades[blade]);
                for (sum, term) in product.shared.iter_mut().zip(coupling) {
                    *sum += term * x.blades[blade][mode];
                }
            }
        }
        product
    }

    /// Solution x of matrix × x = `right`; the matrix is positive definite over the coordinates that `locks`
    /// leaves free. x is zero where locked.
    ///
    /// Blades are eliminated one by one by Cholesky factors; then the Schur complement of the shared block is
    /// solved.
    pub(super) fn solve(&self, n_blades: usize, locks: &Locks, right: &Coordinates) -> Coordinates {
        let mut shared = self.shared;
        let mut x = *right;
        hold(&mut shared, &mut x.shared, &locks.shared);
        let mut factors = [[[0.0; N_MODES]; N_MODES]; MAXIMUM_BLADES];
        let mut reduced = [[[0.0; N_SHARED]; N_MODES]; MAXIMUM_BLADES];
        for blade in 0..n_blades {
            let mut block = self.blades[blade];
            let mut coupling = self.coupling[blade];
            hold(&mut block, &mut x.blades[blade], &locks.modes);
            for (row, held) in coupling.iter_mut().zip(&locks.modes) {
                for (value, column_held) in row.iter_mut().zip(&locks.shared) {
                    if *held || *column_held {
                        *value = 0.0;
                    }
                }
            }
            let factor = cholesky(&block);
            // Symbols: block = L Lᵀ; Y = L⁻¹ coupling, y = L⁻¹ right; the shared block loses Yᵀ Y, its right
            // side Yᵀ y.
            for row in 0..N_MODES {
                for before in 0..row {
                    let share = factor[row][before];
                    for column in 0..N_SHARED {
                        coupling[row][column] -= share * coupling[before][column];
                    }
                    x.blades[blade][row] -= share * x.blades[blade][before];
                }
                let scale = 1.0 / factor[row][row];
                for value in &mut coupling[row] {
                    *value *= scale;
                }
                x.blades[blade][row] *= scale;
                for a in 0..N_SHARED {
                    for b in 0..=a {
                        shared[a][b] -= coupling[row][a] * coupling[row][b];
                    }
                    x.shared[a] -= coupling[row][a] * x.blades[blade][row];
                }
            }
            factors[blade] = factor;
            reduced[blade] = coupling;
        }
        let factor = cholesky(&shared);
        forward(&factor, &mut x.shared);
        backward(&factor, &mut x.shared);
        for blade in 0..n_blades {
            for (value, row) in x.blades[blade].iter_mut().zip(&reduced[blade]) {
                *value -= dot(row, &x.shared);
            }
            backward(&factors[blade], &mut x.blades[blade]);
        }
        x
    }
}

/// Takes held coordinates out of a block and its right side.
fn hold<const N: usize>(block: &mut [[f64; N]; N], right: &mut [f64; N], held: &[bool; N]) {
    for i in (0..N).filter(|&i| held[i]) {
        for j in 0..N {
            block[i][j] = 0.0;
            block[j][i] = 0.0;
        }
        block[i][i] = 1.0;
        right[i] = 0.0;
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for i in 0..N {
        sum += a[i] * b[i];
    }
    sum
}

/// Lower factor L of `matrix` = L Lᵀ; reads the lower triangle only.
pub(super) fn cholesky<const N: usize>(matrix: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut factor = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let mut rest = matrix[i][j];
            for k in 0..j {
                rest -= factor[i][k] * factor[j][k];
            }
            factor[i][j] = if i == j { rest.sqrt() } else { rest / factor[j][j] };
        }
    }
    factor
}

fn forward<const N: usize>(factor: &[[f64; N]; N], x: &mut [f64; N]) {
    for i in 0..N {
        for j in 0..i {
            x[i] -= factor[i][j] * x[j];
        }
        x[i] /= factor[i][i];
    }
}

fn backward<const N: usize>(factor: &[[f64; N]; N], x: &mut [f64; N]) {
    for i in (0..N).rev() {
        for j in i + 1..N {
            x[i] -= factor[j][i] * x[j];
        }
        x[i] /= factor[i][i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::DegreeOfFreedom;

    fn sample(n_blades: usize) -> ArrowheadMatrix {
        let mut matrix = ArrowheadMatrix::default();
        for i in 0..N_SHARED {
            for j in 0..N_SHARED {
                matrix.shared[i][j] = if i == j { 9.0 } else { 1.0 / (1.0 + i as f64 + j as f64) };
            }
        }
        for blade in 0..n_blades {
            for i in 0..N_MODES {
                for j in 0..N_SHARED {
                    matrix.coupling[blade][i][j] = 0.1 * (blade + 2 * i) as f64 - 0.05 * j as f64;
                }
                for j in 0..N_MODES {
                    matrix.blades[blade][i][j] = if i == j { 4.0 } else { 0.3 };
                }
            }
        }
        matrix
    }

    #[test]
    fn solving_undoes_multiplying() {
        for n_blades in 1..=4 {
            let matrix = sample(n_blades);
            let shared = [1.0, -2.0, 0.5, 3.0, -0.1, 0.7];
            let mut x = Coordinates { shared, ..Coordinates::default() };
            for blade in 0..n_blades {
                x.blades[blade] = [blade as f64, 1.0, -0.4];
            }
            let right = matrix.times(n_blades, &x);
            let found = matrix.solve(n_blades, &Locks::default(), &right);
            let gap = found.plus(-1.0, &x);
            let worst = gap.shared.iter().chain(gap.blades.iter().flatten());
            assert!(worst.fold(0.0_f64, |worst, value| worst.max(value.abs())) < 1e-12);
        }
    }

    #[test]
    fn locked_coordinates_stay_and_do_not_load_the_rest() {
        let matrix = sample(3);
        let right =
            Coordinates { shared: [1.0; N_SHARED], blades: [[1.0; N_MODES]; MAXIMUM_BLADES] };
        let locks = Locks::of(&[DegreeOfFreedom::Generator, DegreeOfFreedom::Edge1]);
        let x = matrix.solve(3, &locks, &right);
        assert_eq!(x.shared[4], 0.0);
        assert!(x.blades[..3].iter().all(|blade| blade[2] == 0.0));
        let product = matrix.times(3, &x);
        assert!((product.shared[0] - 1.0).abs() < 1e-12);
        assert!((product.blades[1][1] - 1.0).abs() < 1e-12);
    }
}
