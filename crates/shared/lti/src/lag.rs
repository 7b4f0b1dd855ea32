//! Lags of first and second order over one interval, exact for an input that is held over it.

/// Angle over the interval (–) beyond which hyperbolic functions would overflow and exponentials take their
/// place.
const LARGEST_ANGLE: f64 = 300.0;
/// Angle over the interval (–) below which damping counts as critical: off by a sixth of its square.
const SMALLEST_ANGLE: f64 = 1e-6;

/// Share (–) of an old value that a lag of first order with `time_constant` (s) keeps over `interval` (s),
/// e^(−T/τ).
pub fn kept(interval: f64, time_constant: f64) -> f64 {
    (-interval / time_constant).exp()
}

/// Value of τ y′ + y = u after `interval` (s) of constant `input` u: exact.
///
/// `value` y is in the unit of the input, `time_constant` τ in s.
pub fn first(value: f64, input: f64, interval: f64, time_constant: f64) -> f64 {
    input + kept(interval, time_constant) * (value - input)
}

/// Value and rate (1/s) of y″ + 2 ζ ω y′ + ω² y = ω² u after `interval` (s) of constant `input` u: exact.
///
/// `frequency` ω is in rad/s, `damping` ζ a ratio (–).
pub fn second(
    [value, rate]: [f64; 2],
    input: f64,
    interval: f64,
    frequency: f64,
    damping: f64,
) -> [f64; 2] {
    let response = free_response(frequency, damping, interval);
    let error = value - input;
    [
        input + response[0][0] * error + response[0][1] * rate,
        response[1][0] * error + response[1][1] * rate,
    ]
}

/// Exponential of the free motion y″ + 2 ζ ω y′ + ω² y = 0 over `interval` (s): value and rate after it
/// (rows), per unit of value and rate before (columns).
///
/// `frequency` ω is in rad/s, `damping` ζ a ratio (–): under-damped, critical or over-damped.
pub fn free_response(frequency: f64, damping: f64, interval: f64) -> [[f64; 2]; 2] {
    // Symbols: w natural frequency, s = sqrt(zeta² − 1) w; c and k are cosh(s t), sinh(s t)/s or their
    // trigonometric twins.
    let (w, zeta) = (frequency, damping);
    let decay = (-zeta * w * interval).exp();
    let square = (zeta * zeta - 1.0) * w * w;
    let angle = square.abs().sqrt() * interval;
    let (decay, c, k) = if angle < SMALLEST_ANGLE {
        (decay, 1.0, interval)
    } else if square > 0.0 && angle > LARGEST_ANGLE {
        let exponent = zeta * w * interval;
        let (slow, fast) = ((angle - exponent).exp(), (-angle - exponent).exp());
        (1.0, 0.5 * (slow + fast), 0.5 * (slow - fast) / angle * interval)
    } else if square > 0.0 {
        (decay, angle.cosh(), angle.sinh() / angle * interval)
    } else {
        (decay, angle.cos(), angle.sin() / angle * interval)
    };
    [[decay * (c + zeta * w * k), decay * k], [-decay * w * w * k, decay * (c - zeta * w * k)]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_step_through_first_order_is_the_exponential() {
        let value = first(0.0, 2.0, 0.3, 1.5);
        assert!((value - 2.0 * (1.0 - (-0.2_f64).exp())).abs() < 1e-15);
        assert_eq!(first(2.0, 2.0, 0.3, 1.5), 2.0);
    }

    #[test]
    fn an_undamped_quarter_period_turns_value_into_rate() {
        let [value, rate] = second([0.0, 0.0], 1.0, FRAC_PI_2 / 3.0, 3.0, 0.0);
        assert!((value - 1.0).abs() < 1e-12 && (rate - 3.0).abs() < 1e-12);
    }

    #[test]
    fn steps_with_critical_and_strong_damping_are_the_closed_forms() {
        // Critical: 1 − (1 + ω t) e^(−ω t).
        let (w, t) = (3.0_f64, 0.4_f64);
        let [value, rate] = second([0.0, 0.0], 1.0, t, w, 1.0);
        assert!((value - (1.0 - (1.0 + w * t) * (-w * t).exp())).abs() < 1e-12);
        assert!((rate - w * w * t * (-w * t).exp()).abs() < 1e-12);
        // Poles −a and −b: 1 − (b e^(−a t) − a e^(−b t))/(b − a), with a and b at 1 and 4 rad/s: ω = 2, ζ =
        // 1.25.
        let exact = |t: f64| 1.0 - (4.0 * (-t).exp() - (-4.0 * t).exp()) / 3.0;
        for t in [0.1, 1.0, 3.0] {
            let [value, _] = second([0.0, 0.0], 1.0, t, 2.0, 1.25);
            assert!((value - exact(t)).abs() < 1e-12, "{value} at {t} s");
        }
        // So strongly damped that only the slow pole at −ω/(2 ζ) is seen: cosh alone would overflow.
        let [value, _] = second([0.0, 0.0], 1.0, 1.0, 10.0, 100.0);
        assert!((value - (1.0 - (-0.05_f64).exp())).abs() < 1e-4, "{value}");
    }

    proptest! {
        /// Two half steps are one whole, whatever the damping.
        #[test]
        fn halves_make_a_whole(
            damping in prop_oneof![0.0..3.0_f64, Just(1.0), 0.999_999..1.000_001_f64],
            frequency in 0.1..30.0_f64,
            interval in 0.001..1.0_f64,
            value in -1.0..1.0_f64,
            rate in -1.0..1.0_f64,
        ) {
            let step = |state, interval| second(state, 1.0, interval, frequency, damping);
            let whole = step([value, rate], interval);
            let halves = step(step([value, rate], 0.5 * interval), 0.5 * interval);
            // Rounding grows with the rate's scale ω, and by what cosh exceeds its decay.
            let bound = 1e-10 * (1.0 + frequency);
            prop_assert!((whole[0] - halves[0]).abs() < bound, "{whole:?} {halves:?}");
            prop_assert!((whole[1] - halves[1]).abs() < bound * frequency.max(1.0));
        }
    }
}
