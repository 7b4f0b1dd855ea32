//! Natural frequencies: the equations of motion linearised about the present state.
#![expect(
    clippy::needless_range_loop,
    reason = "rows and columns by index, as the equations have them"
)]

use super::coordinates::{Coordinates, DegreeOfFreedom, Locks, N_MODES, N_SHARED};
use super::machine::{Machine, Pitch};
use super::stations::LoadResultants;
use basis::blades::MAXIMUM_BLADES;
use std::f64::consts::TAU;

/// Most coordinates that a turbine can have.
const N: usize = N_SHARED + N_MODES * MAXIMUM_BLADES;
/// Step of the finite differences, in the coordinates' own units; the forces are polynomials and sines.
const DIFFERENCE: f64 = 1e-3;
/// Sweeps of Jacobi's method; six digits take five.
const MAXIMUM_SWEEPS: usize = 30;

/// One undamped mode of the whole turbine.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalMode {
    /// Frequency (Hz); 0 for a rigid-body motion.
    pub frequency: f64,
    /// Share of each degree of freedom in the kinetic energy (–), in the order of [`DegreeOfFreedom::ALL`];
    /// they sum to one.
    pub shares: [f64; N_SHARED + N_MODES],
}

impl NaturalMode {
    /// The degree of freedom with the largest share.
    pub fn dominant(&self) -> DegreeOfFreedom {
        let largest = (0..self.shares.len())
            .max_by(|&a, &b| self.shares[a].total_cmp(&self.shares[b]))
            .unwrap_or(0);
        DegreeOfFreedom::ALL[largest]
    }
}

impl Machine {
    /// Modes about `q`, moving at `v`, lowest frequency first: M ẍ = ∂f/∂x x without damping and gyroscopic
    /// forces.
    ///
    /// The rotor speed in `v` stiffens the blades. Coupling through velocities is left out; it vanishes at
    /// standstill.
    pub(super) fn natural_modes(
        &self,
        q: &Coordinates,
        v: &Coordinates,
        pitch: &[Pitch],
        locks: &Locks,
    ) -> Vec<NaturalMode> {
        let free: Vec<usize> = (0..N_SHARED + N_MODES * self.n_blades)
            .filter(|&index| match index.checked_sub(N_SHARED) {
                None => !locks.shared[index],
                Some(rest) => !locks.modes[rest % N_MODES],
            })
            .collect();
        let n = free.len();
        let none = LoadResultants::default();
        // Only the speed of the rotor is part of the steady state; vibrations are not.
        let mut steady = Coordinates::default();
        steady.shared[super::coordinates::GENERATOR] = v.shared[super::coordinates::GENERATOR];
        let mut stiffness = vec![vec![0.0; n]; n];
        let mut mass = vec![vec![0.0; n]; n];
        let at = self.equations_of_motion(q, &steady, pitch, &none);
        for (column, &index) in free.iter().enumerate() {
            let mut unit = Coordinates::default();
            *entry(&mut unit, index) = 1.0;
            let mut product = at.mass.times(self.n_blades, &unit);
            let force = |step: f64| {
                self.equations_of_motion(&q.plus(step, &unit), &steady, pitch, &none).force
            };
            let mut change = force(-DIFFERENCE).plus(-1.0, &force(DIFFERENCE));
            for (row, &index) in free.iter().enumerate() {
                mass[row][column] = *entry(&mut product, index);
                stiffness[row][column] = *entry(&mut change, index) / (2.0 * DIFFERENCE);
            }
        }
        let (values, vectors) = generalised_eigen(&mass, &stiffness);
        let mut modes: Vec<NaturalMode> = values
            .iter()
            .zip(&vectors)
            .map(|(&value, vector)| {
                let mut shares = [0.0; N_SHARED + N_MODES];
                for (row, &index) in free.iter().enumerate() {
                    let momentum: f64 = (0..n).map(|k| mass[row][k] * vector[k]).sum();
                    let kind =
                        if index < N_SHARED { index } else { N_SHARED + (index - N_SHARED) % 3 };
                    shares[kind] += vector[row] * momentum;
                }
                NaturalMode { frequency: value.max(0.0).sqrt() / TAU, shares }
            })
            .collect();
        modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        modes
    }
}

/// The coordinate at `index`, shared ones first, then blade after blade.
fn entry(coordinates: &mut Coordinates, index: usize) -> &mut f64 {
    match index.checked_sub(N_SHARED) {
        None => &mut coordinates.shared[index],
        Some(rest) => &mut coordinates.blades[rest / N_MODES][rest % N_MODES],
    }
}

/// Eigenvalues and eigenvectors of K x = λ M x; vectors have unit modal mass.
///
/// With M = L Lᵀ, Jacobi's rotations diagonalise the symmetric part of L⁻¹ K L⁻ᵀ.
fn generalised_eigen(mass: &[Vec<f64>], stiffness: &[Vec<f64>]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = mass.len();
    let mut padded = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            padded[i][j] = if i < n && j < n { mass[i][j] } else { f64::from(u8::from(i == j)) };
        }
    }
    let factor = super::arrowhead::cholesky(&padded);
    let solve_lower = |column: &mut [f64]| {
        for i in 0..n {
            for j in 0..i {
                column[i] -= factor[i][j] * column[j];
            }
            column[i] /= factor[i][i];
        }
    };
    // Rows of K put through L⁻¹, then columns.
    let mut half: Vec<Vec<f64>> = stiffness.to_vec();
    half.iter_mut().for_each(|row| solve_lower(row));
    let mut reduced = vec![vec![0.0; n]; n];
    for j in 0..n {
        let mut column: Vec<f64> = half.iter().map(|row| row[j]).collect();
        solve_lower(&mut column);
        (0..n).for_each(|i| reduced[i][j] = column[i]);
    }
    let mut matrix = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..n {
            matrix[i][j] = 0.5 * (reduced[i][j] + reduced[j][i]);
        }
    }
    let turns = jacobi(&mut matrix);
    let values = (0..n).map(|k| matrix[k][k]).collect();
    let vectors = (0..n)
        .map(|k| {
            let mut x: Vec<f64> = (0..n).map(|i| turns[i][k]).collect();
            for i in (0..n).rev() {
                for j in i + 1..n {
                    x[i] -= factor[j][i] * x[j];
                }
                x[i] /= factor[i][i];
            }
            x
        })
        .collect();
    (values, vectors)
}

/// Diagonalises the symmetric `matrix`; gives the rotation whose columns are its eigenvectors.
fn jacobi(matrix: &mut [Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let mut turns = vec![vec![0.0; n]; n];
    (0..n).for_each(|k| turns[k][k] = 1.0);
    for _ in 0..MAXIMUM_SWEEPS {
        let square = |i: usize, j: usize| matrix[i][j] * matrix[i][j];
        let off: f64 =
            (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| square(i, j)).sum();
        let all: f64 = (0..n).map(|k| square(k, k)).sum();
        if off <= 1e-28 * all {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                if matrix[p][q] == 0.0 {
                    continue;
                }
                let ratio = 0.5 * (matrix[q][q] - matrix[p][p]) / matrix[p][q];
                let tangent = ratio.signum() / (ratio.abs() + ratio.hypot(1.0));
                let cosine = 1.0 / tangent.hypot(1.0);
                let sine = tangent * cosine;
                for k in 0..n {
                    let (a, b) = (matrix[k][p], matrix[k][q]);
                    matrix[k][p] = cosine * a - sine * b;
                    matrix[k][q] = sine * a + cosine * b;
                }
                for k in 0..n {
                    let (a, b) = (matrix[p][k], matrix[q][k]);
                    matrix[p][k] = cosine * a - sine * b;
                    matrix[q][k] = sine * a + cosine * b;
                    let (a, b) = (turns[k][p], turns[k][q]);
                    turns[k][p] = cosine * a - sine * b;
                    turns[k][q] = sine * a + cosine * b;
                }
            }
        }
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_coupled_masses_have_their_closed_form() {
        // Masses 1 and 4, springs 2 to the wall and 3 between.
        let (values, vectors) = generalised_eigen(
            &[vec![1.0, 0.0], vec![0.0, 4.0]],
            &[vec![5.0, -3.0], vec![-3.0, 3.0]],
        );
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        // 4 λ² − 23 λ + 6 = 0.
        let root = (23.0_f64 * 23.0 - 96.0).sqrt();
        assert!((sorted[0] - (23.0 - root) / 8.0).abs() < 1e-12);
        assert!((sorted[1] - (23.0 + root) / 8.0).abs() < 1e-12);
        for vector in vectors {
            assert!((vector[0] * vector[0] + 4.0 * vector[1] * vector[1] - 1.0).abs() < 1e-12);
        }
    }
}
