//! Pitch actuators: second-order lag with limits of rate and position.

mod swashplate;

pub use swashplate::{Drive, N_RODS, Swashplate, SwashplateState, lead_of};

use crate::breakdown::within;
use lti::lag::free_response;
use serde::{Deserialize, Serialize};

/// Longest sub-step as a share of 1/ω (–), so that a rate limit acts soon after it is reached.
const LONGEST_SUBSTEP: f64 = 0.1;

/// Parameters of a blade's pitch actuator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PitchActuator {
    /// Natural frequency ω (rad/s).
    pub natural_frequency: f64,
    /// Damping ratio ζ (–).
    pub damping_ratio: f64,
    /// Greatest pitch rate either way (rad/s).
    pub maximum_rate: f64,
    /// Least pitch (rad).
    pub minimum_pitch: f64,
    /// Greatest pitch (rad).
    pub maximum_pitch: f64,
}

/// State of one blade's pitch actuator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PitchState {
    /// Pitch, positive to feather (rad).
    pub pitch: f64,
    /// Its rate (rad/s).
    pub rate: f64,
}

impl PitchActuator {
    /// Advances `state` by `interval` (s) towards the constant `command` (rad); true if a limit acted.
    ///
    /// Between limits θ″ = ω² (command − θ) − 2 ζ ω θ′ is followed exactly for any interval. The rate is
    /// limited sub-step by sub-step; at a position limit the blade stands still. A command out of range
    /// counts as limited.
    pub fn advance(&self, state: &mut PitchState, interval: f64, command: f64) -> bool {
        let target = command.clamp(self.minimum_pitch, self.maximum_pitch);
        let mut limited = target != command;
        let n_substeps = (interval * self.natural_frequency / LONGEST_SUBSTEP).ceil().max(1.0);
        let step = interval / n_substeps;
        let response = free_response(self.natural_frequency, self.damping_ratio, step);
        for _ in 0..n_substeps as usize {
            let error = state.pitch - target;
            let pitch = target + response[0][0] * error + response[0][1] * state.rate;
            let rate = response[1][0] * error + response[1][1] * state.rate;
            let reach = self.maximum_rate * step;
            let reached = within(pitch, [state.pitch - reach, state.pitch + reach]);
            let held = reached.clamp(self.minimum_pitch, self.maximum_pitch);
            limited |= reached != pitch || rate.abs() > self.maximum_rate;
            state.rate = if held == reached {
                rate.clamp(-self.maximum_rate, self.maximum_rate)
            } else {
                0.0
            };
            state.pitch = held;
        }
        limited
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ACTUATOR: PitchActuator = PitchActuator {
        natural_frequency: 3.0,
        damping_ratio: 0.707,
        maximum_rate: 0.035,
        minimum_pitch: -0.05,
        maximum_pitch: 1.57,
    };
    const UNLIMITED: PitchActuator =
        PitchActuator { maximum_rate: 1e6, minimum_pitch: -1e6, maximum_pitch: 1e6, ..ACTUATOR };

    #[test]
    fn between_limits_the_step_response_is_exact_for_any_interval() {
        let (w, z) = (UNLIMITED.natural_frequency, UNLIMITED.damping_ratio);
        let damped = w * (1.0 - z * z).sqrt();
        for interval in [0.05, 0.13, 0.3] {
            let mut state = PitchState::default();
            for step in 1..=20 {
                assert!(!UNLIMITED.advance(&mut state, interval, 0.1));
                let t = interval * f64::from(step);
                let exact = 0.1
                    * (1.0
                        - (-z * w * t).exp()
                            * ((damped * t).cos() + z * w / damped * (damped * t).sin()));
                assert!((state.pitch - exact).abs() < 1e-12, "{} at {t}", state.pitch);
            }
        }
    }

    #[test]
    fn critical_and_over_damping_are_exact_too() {
        for z in [1.0, 1.8] {
            let actuator = PitchActuator { damping_ratio: z, ..UNLIMITED };
            let (mut coarse, mut fine) = (PitchState::default(), PitchState::default());
            actuator.advance(&mut coarse, 0.3, 0.1);
            for _ in 0..3 {
                actuator.advance(&mut fine, 0.1, 0.1);
            }
            assert!((coarse.pitch - fine.pitch).abs() < 1e-12);
            for _ in 0..100 {
                actuator.advance(&mut fine, 0.3, 0.1);
            }
            assert!((fine.pitch - 0.1).abs() < 1e-9);
        }
    }

    #[test]
    fn rate_and_position_limits_hold_and_are_reported() {
        let mut state = PitchState::default();
        let mut before = state.pitch;
        for _ in 0..50 {
            assert!(ACTUATOR.advance(&mut state, 0.1, 0.5));
            assert!(state.pitch - before <= 0.035 * 0.1 + 1e-12 && state.rate <= 0.035);
            before = state.pitch;
        }
        for _ in 0..200 {
            assert!(
                ACTUATOR.advance(&mut state, 0.1, -0.2),
                "a command below the least pitch is held back"
            );
            assert!(state.pitch >= -0.05);
        }
        assert!((state.pitch + 0.05).abs() < 1e-6);
    }

    #[test]
    fn a_slow_sine_is_followed_with_the_lag_of_the_transfer_function() {
        // H(iω_e) = ω²/(ω² − ω_e² + 2 i ζ ω ω_e), a helix at 1P of a large rotor.
        let (rate, amplitude, interval) = (0.8, 0.02, 0.02);
        let mut state = PitchState::default();
        let (mut real, mut imaginary, mut n) = (0.0, 0.0, 0);
        let period = std::f64::consts::TAU / rate;
        let n_steps = (40.0 * period / interval).round() as usize;
        let interval = 40.0 * period / n_steps as f64;
        for step in 0..n_steps {
            // Held commands lag by half an interval; command at the middle of each.
            let t = (step as f64 + 0.5) * interval;
            assert!(!ACTUATOR.advance(&mut state, interval, amplitude * (rate * t).cos()));
            if step >= n_steps / 2 {
                let t = (step + 1) as f64 * interval;
                real += 2.0 * state.pitch * (rate * t).cos();
                imaginary -= 2.0 * state.pitch * (rate * t).sin();
                n += 1;
            }
        }
        let (w, z) = (ACTUATOR.natural_frequency, ACTUATOR.damping_ratio);
        let denominator = (w * w - rate * rate).powi(2) + (2.0 * z * w * rate).powi(2);
        let exact = (
            w * w * (w * w - rate * rate) / denominator,
            -w * w * 2.0 * z * w * rate / denominator,
        );
        assert!((real / f64::from(n) / amplitude - exact.0).abs() < 2e-3);
        assert!((imaginary / f64::from(n) / amplitude - exact.1).abs() < 2e-3);
    }
}
