//! When an output is due.

use farm::Plan;

/// A step that no run makes.
const NEVER: u64 = u64::MAX;

/// The steps of a run at whose end an output is due; steps are counted from 1, so step n ends n intervals
/// after the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    first: u64,
    stride: u64,
}

impl Schedule {
    /// The first step, and every `stride`-th after it; 0 is taken as 1.
    pub fn steps(stride: u64) -> Self {
        Self { first: 1, stride: stride.max(1) }
    }

    /// The end of the spin-up, and every `stride`-th step of the analysed time of `plan`; 0 is taken as 1.
    pub fn analysed_steps(plan: &Plan, stride: u64) -> Self {
        let stride = stride.max(1);
        // A run without spin-up has no step that ends where the analysed time begins.
        let first = if plan.n_spin_up_steps == 0 { stride } else { plan.n_spin_up_steps };
        Self { first, stride }
    }

    /// Every `interval` (s) of the analysed time of `plan`, rounded to whole steps, one at least; the first
    /// time an interval after the spin-up.
    pub fn analysed(plan: &Plan, interval: f64) -> Self {
        let stride = (interval / plan.interval).round().max(1.0) as u64;
        Self { first: plan.n_spin_up_steps + stride, stride }
    }

    /// At no step: the output only finishes.
    pub fn at_the_end() -> Self {
        Self { first: NEVER, stride: 1 }
    }

    /// Whether the output is due at the end of `step`.
    pub fn is_due(&self, step: u64) -> bool {
        step.checked_sub(self.first).is_some_and(|since| since.is_multiple_of(self.stride))
    }

    /// Steps out of `n_steps` at whose end it is due (–).
    pub fn count(&self, n_steps: u64) -> u64 {
        n_steps.checked_sub(self.first).map_or(0, |since| since / self.stride + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::Vector3;

    const N_STEPS: u64 = 40;

    fn plan(n_spin_up_steps: u64) -> Plan {
        Plan {
            origin: Vector3::ZERO,
            spacing: 0.0,
            boxes: Vec::new(),
            levels: Vec::new(),
            n_cells: [0; 3],
            n_points: [0; 3],
            interval: 0.2,
            n_steps: N_STEPS,
            n_spin_up_steps,
            n_growing_steps: 0,
            row_stride: 1,
            diameter: 126.0,
            hub_height: 90.0,
            positions: Vec::new(),
            blockage: 0.0,
            lattice_speed: 0.0,
            turn: 0.0,
            method: Default::default(),
        }
    }

    /// The steps at which `schedule` is due; as many as it says.
    fn due(schedule: Schedule) -> Vec<u64> {
        let due: Vec<u64> = (1..=N_STEPS).filter(|&step| schedule.is_due(step)).collect();
        assert_eq!(schedule.count(N_STEPS), due.len() as u64, "{schedule:?}");
        due
    }

    #[test]
    fn rows_begin_with_the_first_step() {
        assert_eq!(due(Schedule::steps(15)), [1, 16, 31]);
        assert_eq!(due(Schedule::steps(0)).len() as u64, N_STEPS);
        assert_eq!(due(Schedule::steps(N_STEPS)), [1]);
    }

    #[test]
    fn steps_of_the_analysed_time_begin_with_the_end_of_the_spin_up() {
        assert_eq!(due(Schedule::analysed_steps(&plan(10), 12)), [10, 22, 34]);
        assert_eq!(due(Schedule::analysed_steps(&plan(0), 12)), [12, 24, 36]);
        assert_eq!(due(Schedule::analysed_steps(&plan(38), 0)), [38, 39, 40]);
    }

    #[test]
    fn seconds_of_the_analysed_time_are_whole_steps() {
        // 2 s are ten steps, 2.09 s too, 0.01 s are one.
        assert_eq!(due(Schedule::analysed(&plan(10), 2.0)), [20, 30, 40]);
        assert_eq!(due(Schedule::analysed(&plan(10), 2.09)), [20, 30, 40]);
        assert_eq!(due(Schedule::analysed(&plan(38), 0.01)), [39, 40]);
        assert_eq!(due(Schedule::analysed(&plan(10), 7.0)), [0; 0]);
    }

    #[test]
    fn what_comes_at_the_end_is_due_at_no_step() {
        assert_eq!(due(Schedule::at_the_end()), [0; 0]);
    }
}
