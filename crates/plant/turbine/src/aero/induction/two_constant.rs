//! Dynamic inflow with two time constants: induced velocity follows its steady value through a lead and two
//! lags.
//!
//! Source: Øye's model as described by Snel and Schepers, "Joint investigation of dynamic inflow effects and
//! implementation of an engineering method", ECN-C--94-107, 1995, and by Hansen, "Aerodynamics of wind
//! turbines", 2nd ed., 2008, eq. 9.21 to 9.25. AeroDyn's dynamic blade-element momentum is the same model
//! (its DBEMT).

use lti::lag::kept;
use serde::{Deserialize, Serialize};

/// Induction up to which the slow constant grows (–).
const LARGEST_INDUCTION: f64 = 0.5;
/// Least wind through the rotor used for the slow constant (m/s).
const LEAST_WIND: f64 = 0.1;

/// The model: W + (τ₁ + τ₂) Ẇ + τ₁ τ₂ Ẅ = W_qs + k τ₁ Ẇ_qs, W the induced velocity and W_qs that of momentum
/// theory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoConstant {
    /// The slow time constant τ₁.
    pub slow: SlowConstant,
    /// Share k of a change that reaches the second lag at once (–).
    pub coupling: f64,
}

impl TwoConstant {
    /// Share k that the sources give (–).
    pub const COUPLING: f64 = 0.6;

    /// With a slow constant of `slow` (s) whatever the wind.
    pub fn fixed(slow: f64) -> Self {
        Self { slow: SlowConstant::Fixed(slow), coupling: Self::COUPLING }
    }

    /// With a slow constant that follows wind and induction.
    pub fn varying() -> Self {
        Self { slow: SlowConstant::Varying, coupling: Self::COUPLING }
    }
}

/// Where the slow time constant comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlowConstant {
    /// Always the same (s).
    Fixed(f64),
    /// 1.1 / (1 − 1.3 a) · R/U with the rotor's mean induction a, at most 0.5, and mean wind U.
    Varying,
}

impl SlowConstant {
    /// The constant τ₁ (s) of a rotor of `rotor_radius` (m) in `mean_wind` (m/s) at `mean_induction` (–).
    pub fn value(self, rotor_radius: f64, mean_wind: f64, mean_induction: f64) -> f64 {
        match self {
            Self::Fixed(constant) => constant,
            Self::Varying => {
                let induction = mean_induction.clamp(0.0, LARGEST_INDUCTION);
                1.1 / (1.0 - 1.3 * induction) * rotor_radius / mean_wind.abs().max(LEAST_WIND)
            }
        }
    }
}

/// The fast time constant τ₂ (s) at `share` (–) of the rotor radius, where the slow one is `slow` (s).
pub fn fast_constant(slow: f64, share: f64) -> f64 {
    (0.39 - 0.26 * share * share) * slow
}

/// Decay of the two lags over one interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Decay {
    slow: f64,
    fast: f64,
    /// Share of the first lag's error that reaches the second.
    passed: f64,
}

impl Decay {
    /// Over `interval` (s), at `share` (–) of the rotor radius, with a slow time constant of `slow` (s).
    pub fn new(interval: f64, slow: f64, share: f64) -> Self {
        let fast = fast_constant(slow, share);
        let (slow_kept, fast_kept) = (kept(interval, slow), kept(interval, fast));
        let passed = slow / (slow - fast) * (slow_kept - fast_kept);
        Self { slow: slow_kept, fast: fast_kept, passed }
    }
}

/// One component of induced velocity, lagged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lagged {
    /// Induced velocity (m/s).
    pub velocity: f64,
    /// First lag: of 1 − k of the steady value (m/s).
    first: f64,
    /// Steady value at the last instant (m/s).
    steady: f64,
}

impl Lagged {
    /// At rest at `steady` (m/s), with a share of `coupling` (–).
    pub fn settled(steady: f64, coupling: f64) -> Self {
        Self { velocity: steady, first: (1.0 - coupling) * steady, steady }
    }

    /// Advances to the instant at which the steady value is `steady` (m/s).
    ///
    /// Exact for a steady value held at the mean of its last two; any interval is stable.
    pub fn advance(&mut self, decay: &Decay, coupling: f64, steady: f64) {
        let held = 0.5 * (self.steady + steady);
        let away = self.first - (1.0 - coupling) * held;
        self.velocity = held + (self.velocity - held) * decay.fast + away * decay.passed;
        self.first += away * (decay.slow - 1.0);
        self.steady = steady;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_answered_in_closed_form() {
        let (slow, share, k) = (20.0, 0.7, TwoConstant::COUPLING);
        let fast = fast_constant(slow, share);
        let mut lagged = Lagged::settled(2.0, k);
        // The step lies between instants: halfway, where the mean of the two puts it.
        let interval = 0.02;
        let decay = Decay::new(interval, slow, share);
        for step in 1..=5000 {
            lagged.advance(&decay, k, 3.0);
            let time = (f64::from(step) - 0.5) * interval;
            // Step response of (1 + k τ₁ s) / ((1 + τ₁ s)(1 + τ₂ s)).
            let c1 = slow * (1.0 - k) / (slow - fast);
            let response = 1.0 - c1 * (-time / slow).exp() - (1.0 - c1) * (-time / fast).exp();
            assert!(
                (lagged.velocity - 2.0 - response).abs() < 1e-5,
                "{time}: {lagged:?} {response}"
            );
        }
    }

    #[test]
    fn any_interval_settles_and_none_overshoots_far() {
        for interval in [1e-3, 0.1, 10.0, 1e4] {
            let decay = Decay::new(interval, 10.0, 0.95);
            let mut lagged = Lagged::settled(0.0, 0.6);
            for _ in 0..20_000 {
                lagged.advance(&decay, 0.6, 1.0);
                assert!(lagged.velocity > -1e-12 && lagged.velocity < 1.0 + 1e-9, "{lagged:?}");
            }
            let fast = fast_constant(10.0, 0.95);
            let slow_part = 4.0 / (10.0 - fast) * (-2000.0 * interval).exp();
            assert!((1.0 - lagged.velocity - slow_part).abs() < 1e-3 * slow_part + 1e-9);
        }
    }

    #[test]
    fn the_slow_constant_is_the_published_one() {
        // IEA 15 MW at 9 m/s and a third of induction: the order of the 29 s that it is run with.
        let slow = SlowConstant::Varying.value(120.0, 9.0, 1.0 / 3.0);
        assert!((slow - 1.1 / (1.0 - 1.3 / 3.0) * 120.0 / 9.0).abs() < 1e-12);
        assert!(SlowConstant::Varying.value(120.0, 0.0, 0.9).is_finite());
        assert_eq!(SlowConstant::Fixed(7.0).value(120.0, 0.0, 0.9), 7.0);
        assert!((fast_constant(10.0, 0.0) - 3.9).abs() < 1e-12);
        assert!((fast_constant(10.0, 1.0) - 1.3).abs() < 1e-12);
    }
}
