//! Low-pass, high-pass and notch of second order for steps of any length.

use serde::{Deserialize, Serialize};

/// Corner times interval (rad) from which on the frequency is beyond what is sampled.
const FASTEST: f64 = 3.0;

/// What passes: the numerator over s² + 2 ζ ω s + ω².
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
enum Passes {
    /// ω².
    #[default]
    Low,
    /// s² + 2 ζₙ ω s + ω², with the numerator's damping ratio ζₙ (–).
    AllBut(f64),
    /// s².
    High,
}

/// A filter of second order, N(s) / (s² + 2 ζ ω s + ω²): low-pass, high-pass or notch.
///
/// Discretised by the bilinear rule, exact at the frequency ω: at any other rate Ω its gain and phase are
/// those of the continuous filter at ω tan(Ω T/2)/tan(ω T/2). A frequency that cannot be sampled (ω T ≥ 3)
/// lets a low-pass and a notch pass everything, a high-pass nothing.
///
/// Source: Oppenheim and Schafer, "Discrete-Time Signal Processing", 3rd ed., 2010, §7.2.2 (bilinear
/// transformation).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SecondOrder {
    frequency: f64,
    damping: f64,
    passes: Passes,
    inputs: [f64; 2],
    outputs: [f64; 2],
}

impl SecondOrder {
    /// A low-pass filter of natural `frequency` (rad/s) and `damping` ratio (–) that has settled at `value`.
    pub fn low_pass(frequency: f64, damping: f64, value: f64) -> Self {
        Self::settled(frequency, damping, Passes::Low, value)
    }

    /// A notch at `frequency` (rad/s), damping ratios of numerator and denominator (–), that has settled at
    /// `value`.
    pub fn notch(frequency: f64, numerator: f64, denominator: f64, value: f64) -> Self {
        Self::settled(frequency, denominator, Passes::AllBut(numerator), value)
    }

    /// A high-pass filter of natural `frequency` (rad/s) and `damping` ratio (–, 1/√2: Butterworth) that has
    /// settled at zero under a steady input of `value`.
    pub fn high_pass(frequency: f64, damping: f64, value: f64) -> Self {
        Self { outputs: [0.0; 2], ..Self::settled(frequency, damping, Passes::High, value) }
    }

    fn settled(frequency: f64, damping: f64, passes: Passes, value: f64) -> Self {
        Self { frequency, damping, passes, inputs: [value; 2], outputs: [value; 2] }
    }

    /// The filter's output after `interval` (s), at whose end the input is `input`; an input that is no
    /// number leaves it as it was.
    pub fn update(&mut self, interval: f64, input: f64) -> f64 {
        if !input.is_finite() {
            return self.outputs[0];
        }
        if !self.outputs[0].is_finite() {
            self.inputs = [input; 2];
            self.outputs = if self.passes == Passes::High { [0.0; 2] } else { [input; 2] };
        }
        let angle = self.frequency * interval;
        let output = if angle > 0.0 && angle < FASTEST {
            let t = (0.5 * angle).tan();
            let [b0, b1, b2] = match self.passes {
                Passes::Low => transformed(0.0, 0.0, 1.0, t),
                Passes::AllBut(damping) => transformed(1.0, damping, 1.0, t),
                Passes::High => transformed(1.0, 0.0, 0.0, t),
            };
            let [a0, a1, a2] = transformed(1.0, self.damping, 1.0, t);
            let [u1, u2] = self.inputs;
            let [y1, y2] = self.outputs;
            (b0 * input + b1 * u1 + b2 * u2 - a1 * y1 - a2 * y2) / a0
        } else if self.passes == Passes::High && angle > 0.0 {
            0.0
        } else {
            input
        };
        self.inputs = [input, self.inputs[0]];
        self.outputs = [output, self.outputs[0]];
        output
    }

    /// The filter's output.
    pub fn value(&self) -> f64 {
        self.outputs[0]
    }
}

/// Coefficients of 1, z⁻¹ and z⁻² that `square` s² + 2 `damping` ω s + `constant` ω² becomes, times t²/ω² (1
/// + z⁻¹)².
///
/// s = ω/t (z − 1)/(z + 1) with t = tan(ω T/2).
fn transformed(square: f64, damping: f64, constant: f64, t: f64) -> [f64; 3] {
    let (middle, t2) = (2.0 * damping * t, constant * (t * t));
    [square + middle + t2, 2.0 * (t2 - square), square - middle + t2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;
    use std::f64::consts::{FRAC_1_SQRT_2, TAU};

    const N_PERIOD: i32 = 60;

    /// Response of `filter` to a sine of 60 samples a period, long after it began.
    fn measured(mut filter: SecondOrder, interval: f64) -> Complex64 {
        let mut sum = Complex64::default();
        for step in 0..200 * N_PERIOD {
            let angle = TAU * f64::from(step % N_PERIOD) / f64::from(N_PERIOD);
            let output = filter.update(interval, angle.cos());
            if step >= 199 * N_PERIOD {
                sum += output * Complex64::cis(-angle) * 2.0 / f64::from(N_PERIOD);
            }
        }
        sum
    }

    #[test]
    fn gain_and_phase_are_those_of_the_transfer_function_at_the_warped_frequency() {
        for (interval, frequency) in [(0.02, 4.0), (0.1, 1.0), (0.3, 0.5)] {
            let rate = TAU / f64::from(N_PERIOD) / interval;
            let warped = (0.5_f64 * rate * interval).tan() / (0.5_f64 * frequency * interval).tan();
            let s = Complex64::new(0.0, warped);
            let of = |damping: f64| s * s + 2.0 * damping * s + 1.0;
            let cases = [
                (SecondOrder::low_pass(frequency, 0.7, 0.0), 1.0 / of(0.7)),
                (SecondOrder::notch(frequency, 0.05, 0.25, 0.0), of(0.05) / of(0.25)),
                (SecondOrder::high_pass(frequency, FRAC_1_SQRT_2, 0.0), s * s / of(FRAC_1_SQRT_2)),
            ];
            for (filter, exact) in cases {
                let found = measured(filter, interval);
                assert!((found - exact).norm() < 1e-9, "{filter:?}: {found} for {exact}");
            }
        }
    }

    #[test]
    fn at_its_own_frequency_a_filter_is_exact() {
        // Low-pass 1/(2 ζ), notch the ratio of dampings, Butterworth's high-pass 1/√2.
        let interval = 0.3;
        let frequency = TAU / f64::from(N_PERIOD) / interval;
        let cases = [
            (SecondOrder::low_pass(frequency, 0.7, 0.0), 1.0 / 1.4),
            (SecondOrder::notch(frequency, 0.05, 0.25, 0.0), 0.2),
            (SecondOrder::high_pass(frequency, FRAC_1_SQRT_2, 0.0), FRAC_1_SQRT_2),
        ];
        for (filter, gain) in cases {
            assert!((measured(filter, interval).norm() - gain).abs() < 1e-9, "{filter:?}");
        }
    }

    #[test]
    fn settled_filters_stay_and_pass_what_they_cannot_resolve() {
        let mut notch = SecondOrder::notch(1.5, 0.0, 0.25, 0.8);
        let mut high = SecondOrder::high_pass(1.5, 0.7, 0.8);
        for _ in 0..100 {
            assert!((notch.update(0.1, 0.8) - 0.8).abs() < 1e-12);
            assert!(high.update(0.1, 0.8).abs() < 1e-12);
        }
        assert!((notch.update(0.1, f64::NAN) - 0.8).abs() < 1e-12);
        assert_eq!(SecondOrder::low_pass(20.0, 0.7, 0.0).update(0.3, 5.0), 5.0);
        assert_eq!(SecondOrder::high_pass(20.0, 0.7, 0.0).update(0.3, 5.0), 0.0);
    }
}
