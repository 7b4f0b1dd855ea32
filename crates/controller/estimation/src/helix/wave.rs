//! The helix in the wind, as tilt and yaw of the fixed frame.

use super::state_estimate::{StateEstimate, WAVE};
use basis::Sense;
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Variance of an unknown phase, uniform on the circle (rad²).
pub(super) const UNKNOWN_PHASE: f64 = PI * PI / 3.0;

/// States of the wave.
///
/// In every form the wind of a helix is, with the excitation's angle θ = ω_e t and the sense's lead λ of yaw
/// over tilt (π/2 for ccw, −π/2 for cw),
///
/// ```text
/// tilt = A_tilt sin(θ + φ_tilt)        yaw = A_yaw sin(θ + λ + φ_yaw)
/// ```
///
/// so that ccw has the yaw A cos(θ + φ_yaw) of van Vondelen et al. (2025), Eq. 20, cw its negative, and pitch
/// commands with the same phases (Eq. 22, offset zero) rise where the wind does in both senses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Form {
    /// One amplitude for both axes, and a phase for each: the published state (Eq. 21).
    SharedAmplitude,
    /// An amplitude and a phase for each axis.
    SeparateAmplitudes,
    /// A sine and a cosine component for each axis: the wind is linear in them, and a helix that fades leaves
    /// no spurious phase.
    Quadrature,
}

/// One axis of the helix in the wind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Amplitude (m/s).
    pub amplitude: f64,
    /// Its variance (m²/s²).
    pub amplitude_variance: f64,
    /// Phase φ against the excitation's angle ω_e t (rad, [0, 2π)).
    pub phase: f64,
    /// Its variance (rad²), at most that of an unknown phase, π²/3.
    pub phase_variance: f64,
}

/// Tilt and yaw of the wind and their slopes over the wave's four states.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Swing {
    pub(super) tilt: f64,
    pub(super) yaw: f64,
    pub(super) tilt_slopes: [f64; 4],
    pub(super) yaw_slopes: [f64; 4],
}

impl Form {
    /// The helix's wind where the excitation's angle is `angle` (rad).
    pub(super) fn swing(self, sense: Sense, states: &[f64], angle: f64) -> Swing {
        let yaw_angle = angle + sense.yaw_lead();
        match self {
            Self::SharedAmplitude | Self::SeparateAmplitudes => {
                let (tilt_sine, tilt_cosine) = (angle + states[1]).sin_cos();
                let (yaw_sine, yaw_cosine) = (yaw_angle + states[2]).sin_cos();
                let tilt = states[0];
                let (yaw, own) = match self {
                    Self::SharedAmplitude => (tilt, [yaw_sine, 0.0]),
                    _ => (states[3], [0.0, yaw_sine]),
                };
                Swing {
                    tilt: tilt * tilt_sine,
                    yaw: yaw * yaw_sine,
                    tilt_slopes: [tilt_sine, tilt * tilt_cosine, 0.0, 0.0],
                    yaw_slopes: [own[0], 0.0, yaw * yaw_cosine, own[1]],
                }
            }
            Self::Quadrature => {
                let (tilt_sine, tilt_cosine) = angle.sin_cos();
                let (yaw_sine, yaw_cosine) = yaw_angle.sin_cos();
                Swing {
                    tilt: states[0] * tilt_sine + states[1] * tilt_cosine,
                    yaw: states[2] * yaw_sine + states[3] * yaw_cosine,
                    tilt_slopes: [tilt_sine, tilt_cosine, 0.0, 0.0],
                    yaw_slopes: [0.0, 0.0, yaw_sine, yaw_cosine],
                }
            }
        }
    }

    /// Pairs of wave states that are equal in a round helix.
    pub(super) fn pairs(self) -> &'static [(usize, usize)] {
        match self {
            Self::SharedAmplitude => &[(1, 2)],
            Self::SeparateAmplitudes => &[(0, 3), (1, 2)],
            Self::Quadrature => &[(0, 2), (1, 3)],
        }
    }

    /// Whether state `index` of the wave is a phase; otherwise it is a speed, or unused.
    pub(super) fn is_phase(self, index: usize) -> bool {
        self != Self::Quadrature && (index == 1 || index == 2)
    }

    /// Whether state `index` of the wave is used.
    pub(super) fn is_used(self, index: usize) -> bool {
        self != Self::SharedAmplitude || index < 3
    }

    /// On return amplitudes are positive and phases in [−π, π), and the wave is the same. Tells which of the
    /// amplitudes were turned over, with their phases.
    pub(super) fn tidy(self, estimate: &mut StateEstimate) -> [bool; 2] {
        let turned: [bool; 2] = std::array::from_fn(|which| {
            let amplitude = self.polar().get(which).map(|(amplitude, _)| WAVE + amplitude);
            amplitude.is_some_and(|amplitude| estimate.mean[amplitude] < 0.0)
        });
        self.turn_over(turned, estimate);
        for (_, phases) in self.polar() {
            for phase in *phases {
                estimate.mean[WAVE + phase] = wrap_to_half_turn(estimate.mean[WAVE + phase]);
            }
        }
        turned
    }

    /// Amplitudes, each with its phases; none where the wave has components.
    fn polar(self) -> &'static [(usize, &'static [usize])] {
        match self {
            Self::SharedAmplitude => &[(0, &[1, 2])],
            Self::SeparateAmplitudes => &[(0, &[1]), (3, &[2])],
            Self::Quadrature => &[],
        }
    }

    /// On return the amplitudes for which `turned` holds have the other sign and their phases half a turn
    /// more: the wave is the same.
    pub(super) fn turn_over(self, turned: [bool; 2], estimate: &mut StateEstimate) {
        for ((amplitude, phases), _) in
            self.polar().iter().zip(turned).filter(|(_, turned)| *turned)
        {
            estimate.turn_sign(WAVE + amplitude);
            phases.iter().for_each(|phase| estimate.mean[WAVE + phase] += PI);
        }
    }

    /// Tilt and yaw axis of `estimate`.
    pub(super) fn axes(self, estimate: &StateEstimate) -> [Axis; 2] {
        let variance = |index: usize| estimate.covariance[WAVE + index][WAVE + index];
        let state = |index: usize| estimate.mean[WAVE + index];
        let polar = |amplitude: usize, phase: usize| Axis {
            amplitude: state(amplitude),
            amplitude_variance: variance(amplitude),
            phase: wrap_to_turn(state(phase)),
            phase_variance: variance(phase).min(UNKNOWN_PHASE),
        };
        match self {
            Self::SharedAmplitude => [polar(0, 1), polar(0, 2)],
            Self::SeparateAmplitudes => [polar(0, 1), polar(3, 2)],
            Self::Quadrature => [0, 2].map(|first| {
                // sine component a = A cos φ, cosine component b = A sin φ.
                let (a, b) = (state(first), state(first + 1));
                let (aa, bb) = (variance(first), variance(first + 1));
                let ab = estimate.covariance[WAVE + first][WAVE + first + 1];
                let square = a * a + b * b;
                let along = a * a * aa + 2.0 * a * b * ab + b * b * bb;
                let across = b * b * aa - 2.0 * a * b * ab + a * a * bb;
                let known = square > 0.0;
                Axis {
                    amplitude: square.sqrt(),
                    amplitude_variance: if known { along / square } else { aa + bb },
                    phase: wrap_to_turn(b.atan2(a)),
                    phase_variance: if known {
                        (across / (square * square)).min(UNKNOWN_PHASE)
                    } else {
                        UNKNOWN_PHASE
                    },
                }
            }),
        }
    }

    /// On return the wave has been turned ahead by `angle` (rad): all phases are larger by it.
    pub(super) fn turn(self, states: &mut [f64], angle: f64) {
        if self == Self::Quadrature {
            let (sine, cosine) = angle.sin_cos();
            for first in [0, 2] {
                let (a, b) = (states[first], states[first + 1]);
                states[first] = a * cosine - b * sine;
                states[first + 1] = a * sine + b * cosine;
            }
        } else {
            states[1] += angle;
            states[2] += angle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FORMS: [Form; 3] = [Form::SharedAmplitude, Form::SeparateAmplitudes, Form::Quadrature];
    const SENSES: [Sense; 2] = [Sense::Clockwise, Sense::CounterClockwise];

    fn states(form: Form, amplitude: f64, phase: f64) -> [f64; 4] {
        match form {
            Form::SharedAmplitude => [amplitude, phase, phase, 0.0],
            Form::SeparateAmplitudes => [amplitude, phase, phase, amplitude],
            Form::Quadrature => {
                let (b, a) = phase.sin_cos();
                [amplitude * a, amplitude * b, amplitude * a, amplitude * b]
            }
        }
    }

    proptest! {
        /// All forms give the same wind, that of Eq. 20; turning ahead adds to its phase; the axes hold that
        /// phase.
        #[test]
        fn every_form_is_the_helix(
            amplitude in 0.1..3.0_f64, phase in -3.0..3.0_f64, angle in -20.0..20.0_f64,
        ) {
            for form in FORMS {
                let wave = states(form, amplitude, phase);
                let ccw = form.swing(Sense::CounterClockwise, &wave, angle);
                prop_assert!((ccw.tilt - amplitude * (angle + phase).sin()).abs() < 1e-12);
                prop_assert!((ccw.yaw - amplitude * (angle + phase).cos()).abs() < 1e-12);
                let cw = form.swing(Sense::Clockwise, &wave, angle);
                prop_assert!((cw.tilt - ccw.tilt).abs() < 1e-12 && (cw.yaw + ccw.yaw).abs() < 1e-12);
                let mut turned = wave;
                form.turn(&mut turned, 0.7);
                let later = form.swing(Sense::CounterClockwise, &wave, angle + 0.7);
                let swung = form.swing(Sense::CounterClockwise, &turned, angle).yaw;
                prop_assert!((swung - later.yaw).abs() < 1e-12);
                let mut estimate = StateEstimate::zero();
                estimate.mean[WAVE..WAVE + 4].copy_from_slice(&wave);
                for axis in form.axes(&estimate) {
                    prop_assert!((axis.amplitude - amplitude).abs() < 1e-12);
                    prop_assert!(wrap_to_half_turn(axis.phase - phase).abs() < 1e-12);
                }
            }
        }

        /// Slopes are those of central differences.
        #[test]
        fn slopes_are_differences(wave in prop::array::uniform4(0.2..2.0_f64), angle in -9.0..9.0_f64) {
            for (form, sense) in FORMS.into_iter().flat_map(|form| SENSES.map(|sense| (form, sense))) {
                let swing = form.swing(sense, &wave, angle);
                for index in 0..4 {
                    let beside = |step: f64| {
                        let mut beside = wave;
                        beside[index] += step;
                        form.swing(sense, &beside, angle)
                    };
                    let (up, down) = (beside(1e-5), beside(-1e-5));
                    prop_assert!((swing.tilt_slopes[index] - (up.tilt - down.tilt) / 2e-5).abs() < 1e-8);
                    prop_assert!((swing.yaw_slopes[index] - (up.yaw - down.yaw) / 2e-5).abs() < 1e-8);
                }
            }
        }
    }

    #[test]
    fn a_negative_amplitude_is_half_a_turn() {
        for form in [Form::SharedAmplitude, Form::SeparateAmplitudes] {
            let mut estimate = StateEstimate::zero();
            let wave = states(form, -0.8, 3.0);
            estimate.mean[WAVE..WAVE + 4].copy_from_slice(&wave);
            form.tidy(&mut estimate);
            let [tilt, yaw] = form.axes(&estimate);
            assert!((tilt.amplitude - 0.8).abs() < 1e-15 && (yaw.amplitude - 0.8).abs() < 1e-15);
            assert!(wrap_to_half_turn(tilt.phase - 3.0 - PI).abs() < 1e-12);
            let after = form.swing(Sense::Clockwise, &estimate.mean[WAVE..], 0.4);
            let before = form.swing(Sense::Clockwise, &wave, 0.4);
            assert!((after.tilt - before.tilt).abs() < 1e-12);
            assert!((after.yaw - before.yaw).abs() < 1e-12);
        }
    }
}
