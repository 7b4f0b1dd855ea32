//! Mean pressure of all instants, which the budget of a wake's energy asks for.

use serde::{Deserialize, Serialize};

/// Sums of pressure over density at points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct MeanPressure {
    n_instants: u64,
    sums: Vec<f64>,
}

impl MeanPressure {
    /// At `n_points`; nothing taken in yet.
    pub(super) fn new(n_points: usize) -> Self {
        Self { n_instants: 0, sums: vec![0.0; n_points] }
    }

    /// Memory that it takes at `n_points` (bytes).
    pub(super) fn memory(n_points: u64) -> u64 {
        n_points * size_of::<f64>() as u64
    }

    /// Takes in the `pressure` of an instant.
    pub(super) fn add(&mut self, pressure: &[f32]) {
        self.n_instants += 1;
        for (sum, value) in self.sums.iter_mut().zip(pressure) {
            *sum += f64::from(*value);
        }
    }

    /// The mean so far; not a number before there is an instant.
    pub(super) fn mean(&self) -> Vec<f32> {
        let n_instants = self.n_instants as f64;
        self.sums.iter().map(|sum| (sum / n_instants) as f32).collect()
    }
}
