//! Three masses on springs, the first one pushed: a turbine's answer to a slow load in its simplest form.

use lti::Complex64;

/// Masses (kg), damping constants (N s/m) and stiffnesses (N/m) from the wall outwards. van Veldhoven (2024),
/// §3-1.
const MASSES: [f64; 3] = [14.0, 16.0, 15.0];
const DAMPING: [f64; 3] = [0.6, 0.6, 0.6];
const STIFFNESS: [f64; 3] = [0.1, 0.1, 0.3];

/// Places (m) and speeds (m/s) of the masses.
///
/// The source's matrices (Eq. 3-3) couple the third mass back to the second with k₂ and c₂; here, as its
/// figure 3-1 shows, the same spring k₃ and damper c₃ pull at both.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SpringMass([f64; 6]);

impl SpringMass {
    /// Place of the first mass (m).
    pub(super) fn place(&self) -> f64 {
        self.0[0]
    }

    /// Moves on by `interval` (s) under `force` (N) on the first mass, held meanwhile; fourth-order
    /// Runge-Kutta.
    pub(super) fn advance(&mut self, interval: f64, force: f64) {
        let shifted = |slope: [f64; 6], by: f64| {
            Self(std::array::from_fn(|index| self.0[index] + by * slope[index]))
        };
        let k1 = self.slope(force);
        let k2 = shifted(k1, 0.5 * interval).slope(force);
        let k3 = shifted(k2, 0.5 * interval).slope(force);
        let k4 = shifted(k3, interval).slope(force);
        for (index, value) in self.0.iter_mut().enumerate() {
            *value += interval / 6.0 * (k1[index] + 2.0 * (k2[index] + k3[index]) + k4[index]);
        }
    }

    fn slope(&self, force: f64) -> [f64; 6] {
        let [x1, x2, x3, v1, v2, v3] = self.0;
        // Pull of each spring and damper on the mass at its outer end, towards the wall.
        let pull = |index: usize, stretch: f64, speed: f64| {
            STIFFNESS[index] * stretch + DAMPING[index] * speed
        };
        let pulls = [pull(0, x1, v1), pull(1, x2 - x1, v2 - v1), pull(2, x3 - x2, v3 - v2)];
        [
            v1,
            v2,
            v3,
            (force - pulls[0] + pulls[1]) / MASSES[0],
            (pulls[2] - pulls[1]) / MASSES[1],
            -pulls[2] / MASSES[2],
        ]
    }
}

/// Gain (m/N) and phase (rad) of the first mass' place behind a force on it at `rate` (rad/s).
pub(super) fn answer(rate: f64) -> [f64; 2] {
    // Dynamic stiffness, from the free end inwards.
    let spring = |index: usize| Complex64::new(STIFFNESS[index], rate * DAMPING[index]);
    let inertia = |index: usize| Complex64::new(-rate * rate * MASSES[index], 0.0);
    let third = inertia(2) + spring(2);
    let second = inertia(1) + spring(1) + spring(2) - spring(2) * spring(2) * third.inv();
    let first = inertia(0) + spring(0) + spring(1) - spring(1) * spring(1) * second.inv();
    let answer = first.inv();
    [answer.norm(), answer.arg()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masses_in_motion_answer_as_the_closed_form_says() {
        let (rate, interval) = (0.04, 0.1);
        let mut masses = SpringMass::default();
        let mut sums = [0.0; 2];
        // The force is held over a step and so half a step late.
        let n_period = (std::f64::consts::TAU / rate / interval).round();
        let rate = std::f64::consts::TAU / n_period / interval;
        for step in 0..(40.0 * n_period) as usize {
            let (sine, cosine) = (rate * interval * step as f64).sin_cos();
            if step as f64 >= 39.0 * n_period {
                sums[0] += masses.place() * sine * 2.0 / n_period;
                sums[1] += masses.place() * cosine * 2.0 / n_period;
            }
            masses.advance(interval, (rate * interval * (step as f64 + 0.5)).sin());
        }
        let [gain, phase] = answer(rate);
        assert!((sums[0].hypot(sums[1]) / gain - 1.0).abs() < 1e-4);
        assert!((sums[1].atan2(sums[0]) - phase).abs() < 1e-4);
    }
}
