//! The estimator's states as a normal distribution: mean and covariance, prediction and correction.

use serde::{Deserialize, Serialize};

/// Largest number of states (–); states that a form does not use have no variance and do not change.
pub(super) const N_STATES: usize = 12;
/// Mean wind over the rotor (m/s).
pub(super) const MEAN_WIND: usize = 0;
/// First of the four parameters of the wave.
pub(super) const WAVE: usize = 1;
/// Constant tilt and yaw of the wind, as of shear (m/s).
pub(super) const BIAS: usize = 5;
/// Tilt and yaw of the wind in passing eddies (m/s).
pub(super) const PASSING: usize = 7;
/// Difference of the excitation rate from the nominal one (rad/s).
pub(super) const RATE: usize = 9;
/// Error of the model's response to the rotor's own pitch: in phase and a quarter turn ahead (–).
pub(super) const RESPONSE: usize = 10;

/// One value for each state.
pub(super) type Vector = [f64; N_STATES];

/// Mean and covariance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct StateEstimate {
    pub(super) mean: Vector,
    pub(super) covariance: [Vector; N_STATES],
}

impl StateEstimate {
    /// Zero mean and covariance.
    pub(super) fn zero() -> Self {
        Self { mean: [0.0; N_STATES], covariance: [[0.0; N_STATES]; N_STATES] }
    }

    /// Variance of the sum of states weighted by `slopes`.
    pub(super) fn variance_along(&self, slopes: &Vector) -> f64 {
        dot(&self.along(slopes), slopes)
    }

    /// Adds process noise to the covariance: `noise` on the diagonal, `pairs` on pairs of states.
    pub(super) fn spread(&mut self, noise: &Vector, pairs: &[(usize, usize, f64)]) {
        for (state, variance) in noise.iter().enumerate() {
            self.covariance[state][state] += variance;
        }
        for &(a, b, covariance) in pairs {
            self.covariance[a][b] += covariance;
            self.covariance[b][a] += covariance;
        }
    }

    /// P → F P Fᵀ with F = `transition`.
    pub(super) fn carry(&mut self, transition: &[Vector; N_STATES]) {
        let mut half = [[0.0; N_STATES]; N_STATES];
        for (row, carried) in transition.iter().zip(&mut half) {
            for (weight, covariance) in row.iter().zip(&self.covariance) {
                if *weight != 0.0 {
                    for (sum, value) in carried.iter_mut().zip(covariance) {
                        *sum += weight * value;
                    }
                }
            }
        }
        for (covariance, half) in self.covariance.iter_mut().zip(&half) {
            for (value, row) in covariance.iter_mut().zip(transition) {
                *value = dot(half, row);
            }
        }
    }

    /// Corrects by one measurement: its `innovation`, its derivatives by the states `slopes`, and its noise
    /// `variance`. Joseph's form: the covariance stays symmetric and positive whatever the rounding.
    pub(super) fn correct(&mut self, slopes: &Vector, innovation: f64, variance: f64) {
        // Symbols: P covariance, h slopes, r variance, k gain; P' = (I − k hᵀ) P (I − k hᵀ)ᵀ + r k kᵀ.
        let along = self.along(slopes);
        let total = dot(&along, slopes) + variance;
        let gain = along.map(|value| value / total);
        for (mean, gain) in self.mean.iter_mut().zip(&gain) {
            *mean += gain * innovation;
        }
        for (row, gain) in self.covariance.iter_mut().zip(&gain) {
            for (value, along) in row.iter_mut().zip(&along) {
                *value -= gain * along;
            }
        }
        let left = self.along(slopes);
        for (row, (left, own)) in self.covariance.iter_mut().zip(left.iter().zip(&gain)) {
            for (value, gain) in row.iter_mut().zip(&gain) {
                *value += (variance * own - left) * gain;
            }
        }
        for row in 1..N_STATES {
            for column in 0..row {
                let middle = 0.5 * (self.covariance[row][column] + self.covariance[column][row]);
                self.covariance[row][column] = middle;
                self.covariance[column][row] = middle;
            }
        }
    }

    /// The state in `index` with its sign turned.
    pub(super) fn turn_sign(&mut self, index: usize) {
        self.mean[index] = -self.mean[index];
        for other in (0..N_STATES).filter(|other| *other != index) {
            self.covariance[index][other] = -self.covariance[index][other];
            self.covariance[other][index] = -self.covariance[other][index];
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.mean.iter().chain(self.covariance.iter().flatten()).all(|value| value.is_finite())
    }

    /// P h.
    fn along(&self, slopes: &Vector) -> Vector {
        let mut along = [0.0; N_STATES];
        for (sum, row) in along.iter_mut().zip(&self.covariance) {
            *sum = dot(row, slopes);
        }
        along
    }
}

pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A covariance from any square root.
    fn estimate(root: &[f64]) -> StateEstimate {
        let mut estimate = StateEstimate::zero();
        for a in 0..N_STATES {
            for b in 0..N_STATES {
                estimate.covariance[a][b] =
                    (0..N_STATES).map(|k| root[a * N_STATES + k] * root[b * N_STATES + k]).sum();
            }
        }
        estimate
    }

    proptest! {
        /// Joseph's form is the textbook's, P − P h hᵀ P / s, and stays symmetric and positive along any
        /// direction.
        #[test]
        fn josephs_form_is_the_short_one(
            root in prop::collection::vec(-1.0..1.0_f64, N_STATES * N_STATES),
            slopes in prop::array::uniform12(-2.0..2.0_f64),
            direction in prop::array::uniform12(-1.0..1.0_f64),
            innovation in -3.0..3.0_f64, variance in 1e-3..10.0_f64,
        ) {
            let before = estimate(&root);
            let mut after = before.clone();
            after.correct(&slopes, innovation, variance);
            let along = before.along(&slopes);
            let total = dot(&along, &slopes) + variance;
            for a in 0..N_STATES {
                prop_assert!((after.mean[a] - along[a] * innovation / total).abs() < 1e-9);
                for b in 0..N_STATES {
                    let expected = before.covariance[a][b] - along[a] * along[b] / total;
                    prop_assert!((after.covariance[a][b] - expected).abs() < 1e-9);
                    prop_assert_eq!(after.covariance[a][b], after.covariance[b][a]);
                }
            }
            prop_assert!(after.variance_along(&direction) > -1e-12);
            prop_assert!(after.variance_along(&slopes) <= before.variance_along(&slopes));
        }
    }

    #[test]
    fn carrying_by_the_identity_changes_nothing_and_by_a_factor_its_square() {
        let root: Vec<f64> = (0..144).map(|k| (f64::from(k) * 1.7).sin()).collect();
        let before = estimate(&root);
        let mut after = before.clone();
        let mut transition = [[0.0; N_STATES]; N_STATES];
        (0..N_STATES).for_each(|k| transition[k][k] = 1.0);
        after.carry(&transition);
        assert_eq!(before, after);
        transition[3][3] = 0.5;
        after.carry(&transition);
        assert_eq!(after.covariance[3][3], 0.25 * before.covariance[3][3]);
        assert_eq!(after.covariance[3][1], 0.5 * before.covariance[3][1]);
    }
}
