//! What the steps of a run cost beside one another.

use super::Plan;

/// What the steps of a run cost: cell updates; where the air has no cells, steps with wakes of full length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Of a step once wakes have their length (–).
    pub of_step: f64,
    /// Steps until then (–).
    pub n_growing_steps: u64,
}

/// What a step costs without any wake, over one with wakes of full length (–): turbines, boxes, outputs.
const LEAST: f64 = 0.1;

impl Effort {
    /// Of the first `n_steps` steps of a run (–). Beside [`LEAST`] a step costs in proportion to the length
    /// that wakes have.
    pub fn until(&self, n_steps: u64) -> f64 {
        let growing = n_steps.min(self.n_growing_steps) as f64;
        let share = if growing > 0.0 { growing / self.n_growing_steps as f64 } else { 0.0 };
        let of_growing = LEAST + (1.0 - LEAST) * 0.5 * share;
        self.of_step * (n_steps as f64 - growing + of_growing * growing)
    }
}

impl Plan {
    /// What the steps of its runs cost.
    pub fn effort(&self) -> Effort {
        let of_step = if self.cells() > 0 { self.updates_of_step() } else { 1.0 };
        Effort { of_step, n_growing_steps: self.n_growing_steps }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_growing_wakes_cost_less() {
        let even = Effort { of_step: 3.0, n_growing_steps: 0 };
        assert_eq!([0, 1, 40].map(|n| even.until(n)), [0.0, 3.0, 120.0]);
        // The trapezium below the line to the full cost, then all of it.
        let growing = Effort { of_step: 1.0, n_growing_steps: 100 };
        let expected = [0.0, 5.0 + 0.9 * 12.5, 10.0 + 0.9 * 50.0, 70.0 + 0.9 * 50.0];
        for (n, expected) in [0, 50, 100, 160].into_iter().zip(expected) {
            assert!((growing.until(n) - expected).abs() < 1e-12, "{n}");
        }
    }
}
