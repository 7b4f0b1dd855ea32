//! The loop behind a generator: phase error, loop filter, oscillator.
//!
//! Symbols of van Veldhoven (2024), §2-3: θ phase of the input, θ̂ of the oscillator, θ̃ = θ − θ̂; k_p, k_i,
//! k_a gains.
//!
//! The oscillator turns at ω̂ = k_p e + ∫(k_i e + ∫k_a e), with the phase error e = 2 tan(θ̃/2) (Eq. 2-21,
//! doubled so that small errors pass with gain one and the gains have their usual meaning). It rises without
//! bound towards half a turn, so that there is no second equilibrium, and it does not depend on the
//! amplitude.
//!
//! A loop with k_p and k_i alone (type 2) follows a frequency ramp with a constant error e = ω̇/k_i. The
//! quasi-type-2 loop adds the whole of θ̃ to its output phase, not to the phase in the comparison: then
//!
//! ```text
//! θ_out/θ = F + (1 − F) θ̂/θ ,   θ̂/θ = F L/(s + F L) ,   L = k_p + k_i/s ,   F = 1/(1 + τ s)
//! ```
//!
//! whose open loop is (s² + k_p s + k_i)/(τ s³), that of Eq. 2-30: type 3 with the gains of type 2. Half of
//! θ̃, which tan(θ̃/2) would add, leaves half of the error.

use super::PhaseLockedError;
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use lti::{Complex64, roots};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_1_SQRT_2;
use std::fmt;

/// Largest phase error in the loop filter (rad), 2 tan at 143°: in discrete time the true one has no bound.
const LARGEST_ERROR: f64 = 6.0;

/// Longest turn of the oscillator from one sample to the next (rad); beyond it the sample is not used.
pub(super) const LONGEST_TURN: f64 = 1.0;

/// Type of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Order {
    /// Proportional and integral: lags behind a frequency ramp.
    Two,
    /// The same with the phase error added to the output phase: no error on a ramp.
    #[default]
    QuasiTwo,
    /// Twice integral: no error on a ramp, slower and less stable.
    Three,
}

/// Gains of the loop filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// Rate per phase error k_p (1/s).
    pub proportional: f64,
    /// Growth of the rate per phase error k_i (1/s²).
    pub integral: f64,
    /// Growth of that per phase error k_a (1/s³); zero but in a loop of type three.
    pub double_integral: f64,
}

impl Gains {
    /// Gains of a loop of `order` with `natural_rate` ω_n (rad/s) and `damping_ratio` ξ (–).
    ///
    /// Types two: k_p = 2 ξ ω_n, k_i = ω_n² (Eq. 2-36). Type three has the same pair of poles and a real one
    /// at −ω_n.
    pub fn new(order: Order, natural_rate: f64, damping_ratio: f64) -> Self {
        let (rate, ratio) = (natural_rate, damping_ratio);
        match order {
            Order::Two | Order::QuasiTwo => {
                let (proportional, integral) = (2.0 * ratio * rate, rate * rate);
                Self { proportional, integral, double_integral: 0.0 }
            }
            Order::Three => Self {
                proportional: (1.0 + 2.0 * ratio) * rate,
                integral: (1.0 + 2.0 * ratio) * rate * rate,
                double_integral: rate.powi(3),
            },
        }
    }

    /// Rightmost pole of the loop closed over a generator with phase lag `lag` τ (s), the root of
    /// s³ (1 + τ s) + k_p s² + k_i s + k_a that decays least. Eqs. 2-26 and 2-29 for small errors.
    pub fn slowest_pole(&self, lag: f64) -> Pole {
        // In units of the lag, so that coefficients are of order one.
        let [p, i, a] = [
            self.proportional * lag,
            self.integral * lag.powi(2),
            self.double_integral * lag.powi(3),
        ];
        let rightmost = |roots: &[Complex64]| {
            roots.iter().fold(roots[0], |most, root| if root.re > most.re { *root } else { most })
        };
        // Without double integral action that integrator is left out.
        let root = if a == 0.0 {
            rightmost(&roots([i, p, 1.0]))
        } else {
            rightmost(&roots([a, i, p, 1.0]))
        };
        Pole { real: root.re / lag, imaginary: root.im / lag }
    }
}

/// A pole in the plane of s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// Growth (1/s), negative where it decays.
    pub real: f64,
    /// Frequency (rad/s).
    pub imaginary: f64,
}

impl fmt::Display for Pole {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:+.3e} ± {:.3e} j rad/s", self.real, self.imaginary.abs())
    }
}

/// Settings of the loop filter and oscillator.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LoopSettings {
    /// Type of the loop.
    pub order: Order,
    /// Natural rate ω_n (rad/s).
    pub natural_rate: f64,
    /// Damping ratio ξ (–), 1/√2 as a rule.
    pub damping_ratio: f64,
    /// Lowest and highest rate of the estimate (rad/s).
    pub rates: [f64; 2],
}

impl LoopSettings {
    /// A quasi-type-2 loop between `rates` (rad/s) that starts at their middle, with ξ = 1/√2 and ω_n 0.3
    /// times the lowest rate: two thirds of the stability limit there with any generator of k = √2.
    pub fn between(rates: [f64; 2]) -> Self {
        let natural_rate = 0.3 * rates[0];
        Self { order: Order::QuasiTwo, natural_rate, damping_ratio: FRAC_1_SQRT_2, rates }
    }

    /// Rate that the loop starts from, ω₀ of Eq. 2-31 (rad/s).
    pub fn middle(&self) -> f64 {
        0.5 * (self.rates[0] + self.rates[1])
    }

    /// Gains of the loop filter.
    pub fn gains(&self) -> Gains {
        Gains::new(self.order, self.natural_rate, self.damping_ratio)
    }

    /// Checks the settings with a generator of phase lag `lag` (rad) over its centre rate, at `interval` (s).
    ///
    /// # Errors
    /// [`PhaseLockedError::Rates`], [`PhaseLockedError::Interval`], [`PhaseLockedError::LoopSetting`], and
    /// [`PhaseLockedError::Unstable`] with the unstable pole.
    pub fn check(&self, lag: f64, interval: f64) -> Result<(), PhaseLockedError> {
        let [lowest, highest] = self.rates;
        if !(lowest > 0.0 && highest > lowest && highest.is_finite()) {
            return Err(PhaseLockedError::Rates { lowest, highest });
        }
        // A dozen samples a period.
        let longest = 0.5 / highest;
        if !(interval > 0.0 && interval <= longest) {
            return Err(PhaseLockedError::Interval { interval, longest });
        }
        for (name, value) in
            [("natural rate (rad/s)", self.natural_rate), ("damping ratio (–)", self.damping_ratio)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(PhaseLockedError::LoopSetting { name, value });
            }
        }
        // The generator is slowest at the lowest rate.
        let pole = self.gains().slowest_pole(lag / lowest);
        if pole.real >= 0.0 {
            return Err(PhaseLockedError::Unstable { pole, rate: lowest });
        }
        Ok(())
    }
}

/// Oscillator and loop filter with their state; serialises whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Oscillator {
    order: Order,
    gains: Gains,
    rates: [f64; 2],
    /// θ̂ (rad, [0, 2π)).
    phase: f64,
    /// Integral part of ω̂ (rad/s).
    integral: f64,
    /// Second integral (rad/s²).
    acceleration: f64,
    /// ω̂ (rad/s).
    rate: f64,
    /// θ̃ (rad).
    error: f64,
    /// Last valid interval (s), used in place of an invalid one.
    interval: f64,
}

impl Oscillator {
    /// An oscillator at phase zero that turns at the middle of its rates; `settings` are checked by their
    /// owner.
    pub(super) fn new(settings: &LoopSettings) -> Self {
        let rate = settings.middle();
        Self {
            order: settings.order,
            gains: settings.gains(),
            rates: settings.rates,
            phase: 0.0,
            integral: rate,
            acceleration: 0.0,
            rate,
            error: 0.0,
            interval: 0.0,
        }
    }

    /// Turns on by `interval` (s), or by the last one where this is not a number or negative; gives the angle
    /// (rad).
    pub(super) fn turn(&mut self, interval: f64) -> f64 {
        if interval.is_finite() && interval >= 0.0 {
            self.interval = interval;
        }
        let turned = self.rate * self.interval;
        self.phase = wrap_to_turn(self.phase + turned);
        turned
    }

    /// Follows the vector `in_phase` = A sin θ, `quadrature` = −A cos θ (one unit) over the interval that it
    /// turned by.
    pub(super) fn follow(&mut self, in_phase: f64, quadrature: f64) {
        let interval = self.interval;
        let (sine, cosine) = self.phase.sin_cos();
        // A sin θ̃ and A cos θ̃.
        let across = in_phase * cosine + quadrature * sine;
        let along = in_phase * sine - quadrature * cosine;
        let amplitude = across.hypot(along);
        if amplitude == 0.0 {
            return self.coast();
        }
        self.error = across.atan2(along);
        let error = (2.0 * (0.5 * self.error).tan()).clamp(-LARGEST_ERROR, LARGEST_ERROR);
        let [lowest, highest] = self.rates;
        let Gains { proportional, integral, double_integral } = self.gains;
        let target = self.integral + proportional * error;
        self.rate = target.clamp(lowest, highest);
        // Anti-windup: at a limit the integrals do not grow outwards.
        let outwards = (target - self.rate) * error > 0.0;
        if !outwards {
            self.acceleration += double_integral * error * interval;
            let growth = integral * error + self.acceleration;
            self.integral = (self.integral + growth * interval).clamp(lowest, highest);
        } else {
            self.acceleration = 0.0;
        }
    }

    /// Goes on without a sample, at the estimated rate.
    pub(super) fn coast(&mut self) {
        self.error = 0.0;
        self.rate = self.integral;
    }

    /// Estimated phase (rad, [0, 2π)) of an input A sin θ.
    pub fn phase(&self) -> f64 {
        match self.order {
            Order::QuasiTwo => wrap_to_turn(self.phase + self.error),
            Order::Two | Order::Three => self.phase,
        }
    }

    /// Phase of the vector `in_phase`, `quadrature` ahead of the estimated phase (rad, [−π, π)).
    pub(super) fn lead_of(&self, in_phase: f64, quadrature: f64) -> f64 {
        wrap_to_half_turn(in_phase.atan2(-quadrature) - self.phase())
    }

    /// Estimated rate ω̂ (rad/s).
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Phase error θ̃ of the oscillator (rad, (−π, π]).
    pub fn error(&self) -> f64 {
        self.error
    }

    /// Whether the rate stands at one of its limits.
    pub fn is_limited(&self) -> bool {
        self.rate <= self.rates[0] || self.rate >= self.rates[1]
    }
}
