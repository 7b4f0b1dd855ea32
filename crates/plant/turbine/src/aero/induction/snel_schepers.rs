//! Dynamic inflow after Snel and Schepers: the induced velocity of each annulus follows the balance of thrust
//! and momentum.
//!
//! 4 R f_a u̇ + 4 u (V − u) = thrust of the ring / (½ρ · its area), u the induced velocity, V the wind, R the
//! rotor radius. The function f_a of radius comes from a wake of vortex rings on a cylinder; it makes tips
//! faster than roots.
//!
//! Source: Snel and Schepers, "Joint investigation of dynamic inflow effects and implementation of an
//! engineering method", ECN-C--94-107, 1995 (the differential-equation model of ECN); Schepers, "Engineering
//! models in wind energy aerodynamics", thesis, Delft, 2012. Beyond that: Prandtl's loss F divides the
//! thrust, as in the steady theory, and Buhl's parabola stands for 4 u (V − u) beyond u = 0.4 V, so that the
//! steady state is that of blade-element momentum.

use crate::actuator_line::Onset;
use crate::aero::Polar;
use crate::aero::blade_element::{Annulus, Theory, loss_factor};
use std::f64::consts::{FRAC_PI_2, PI};

/// Least flow through the disc over the relative speed (–) used for the swirl.
const LEAST_PASSAGE: f64 = 0.02;
/// Relaxation of the swirl towards its steady value in one step (–); the model gives it no lag.
const SWIRL_RELAXATION: f64 = 0.5;
/// Slope of lift in attached flow (1/rad), for the stiffness of the balance only.
const LIFT_SLOPE: f64 = 2.0 * PI;

/// The model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnelSchepers {
    /// Factor on the model's time constant (–); one is the model as published.
    pub time_factor: f64,
}

impl Default for SnelSchepers {
    fn default() -> Self {
        Self { time_factor: 1.0 }
    }
}

/// The function f_a at `share` (–) of the rotor radius, between 0 and 1: one on the axis, zero at the edge.
///
/// 2π over ∫ (1 − x cos φ) / (1 + x² − 2x cos φ)^1.5 dφ around the turn, here in its closed form with
/// complete elliptic integrals.
pub fn radial_factor(share: f64) -> f64 {
    let x = share.clamp(0.0, 1.0 - 1e-9);
    let (first, second) = complete_elliptic(4.0 * x / ((1.0 + x) * (1.0 + x)));
    PI / (first / (1.0 + x) + second / (1.0 - x))
}

/// Complete elliptic integrals of the first and second kind (–) at `parameter` m = k² (–, below 1), by the
/// arithmetic-geometric mean.
fn complete_elliptic(parameter: f64) -> (f64, f64) {
    let (mut a, mut b, mut c) = (1.0, (1.0 - parameter).sqrt(), parameter.sqrt());
    let (mut sum, mut weight) = (0.5 * c * c, 0.5);
    while c.abs() > 1e-16 {
        (a, b, c) = (0.5 * (a + b), (a * b).sqrt(), 0.5 * (a - b));
        weight *= 2.0;
        sum += weight * c * c;
    }
    let first = FRAC_PI_2 / a;
    (first, first * (1.0 - sum))
}

/// Advances the `induced` velocities, axial against the wind and tangential along the swirl (m/s), by
/// `interval` (s).
///
/// `onset` is the wind without induction at a blade of `annulus`, whose section has `polar`; `inertia` is R
/// f_a (m) times the model's time factor. Any interval is stable: the balance is linearised and its decay
/// taken to fourth order.
pub(super) fn advance(
    interval: f64,
    onset: Onset,
    annulus: &Annulus,
    polar: &Polar,
    theory: Theory,
    inertia: f64,
    induced: [&mut f64; 2],
) {
    // Symbols of the header: u and v induced velocities, wind V; sigma local solidity, loss F.
    let [u, v] = induced;
    let wind = onset.normal;
    let (through, along) = (wind - *u, onset.tangential + *v);
    let speed = (through * through + along * along).sqrt();
    if speed == 0.0 {
        return;
    }
    let (sine, cosine) = (through / speed, along / speed);
    let section = polar.at(through.atan2(along) - annulus.section_pitch);
    let drag = if theory.drag_in_induction { section.drag } else { 0.0 };
    let normal = section.lift * cosine + drag * sine;
    let tangential = section.lift * sine - drag * cosine;
    let loss = loss_factor(annulus, theory, sine.abs().max(1e-6));
    let sigma = annulus.n_blades as f64 * annulus.chord / (2.0 * PI * annulus.radius);
    let loading = sigma * speed / (4.0 * loss);
    let (momentum, stiffness) = momentum(wind, *u, loss);
    let rate = (stiffness.max(0.0) + loading * LIFT_SLOPE * cosine.abs()) / inertia;
    let z = rate * interval;
    // (1 − e^−z)/z, cautiously for large z.
    let reach = interval / (1.0 + z * (0.5 + z / 12.0));
    let thrust = loading * speed * normal * annulus.momentum_share();
    *u += reach * (thrust - momentum) / inertia;
    let passage = through.abs().max(LEAST_PASSAGE * speed).copysign(through);
    *v += SWIRL_RELAXATION * (loading * speed / passage * tangential - *v);
}

/// Momentum u (V − u) that the ring gives up (m²/s²), Buhl's parabola included, and its slope over u (m/s).
fn momentum(wind: f64, induced: f64, loss: f64) -> (f64, f64) {
    // A wind from behind is the mirror image.
    let (wind, u, sign) = if wind < 0.0 { (-wind, -induced, -1.0) } else { (wind, induced, 1.0) };
    if u <= 0.4 * wind {
        return (sign * u * (wind - u), wind - 2.0 * u);
    }
    let scale = 1.0 / (4.0 * loss);
    let (linear, square) = (4.0 * loss - 40.0 / 9.0, 50.0 / 9.0 - 4.0 * loss);
    let thrust = (8.0 / 9.0 * wind + linear * u) * wind + square * u * u;
    (sign * scale * thrust, scale * (linear * wind + 2.0 * square * u))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aero::blade_element::axial_induction;

    #[test]
    fn the_radial_factor_is_its_integral() {
        for share in [0.0f64, 0.1, 0.5, 0.8, 0.95] {
            // The integrand is periodic: the sum over equal steps converges geometrically.
            let n = 4000;
            let integral: f64 = (0..n)
                .map(|k| {
                    let cosine = (2.0 * PI * f64::from(k) / f64::from(n)).cos();
                    (1.0 - share * cosine) / (1.0 + share * share - 2.0 * share * cosine).powf(1.5)
                })
                .sum::<f64>()
                * 2.0
                * PI
                / f64::from(n);
            let expected = 2.0 * PI / integral;
            assert!((radial_factor(share) - expected).abs() < 1e-10, "{share}");
        }
        assert!((radial_factor(0.0) - 1.0).abs() < 1e-12);
        // At the edge it vanishes with π (1 − x).
        assert!((radial_factor(0.9999) / (PI * 1e-4) - 1.0).abs() < 1e-2);
    }

    #[test]
    fn momentum_is_the_steady_theorys() {
        for loss in [0.2, 0.7, 1.0] {
            for loading in [-0.2, 0.0, 0.3, 0.6, 0.7, 1.5, 8.0] {
                // Where blades load the ring with κ, momentum theory says a, and then 4 F κ (1 − a)² of
                // thrust.
                let a = axial_induction(loading, loss);
                let (got, slope) = momentum(10.0, 10.0 * a, loss);
                let expected = 100.0 * loading * (1.0 - a).powi(2);
                assert!((got - expected).abs() < 1e-9, "{loading} {loss}: {got} {expected}");
                assert_eq!(momentum(-10.0, -10.0 * a, loss), (-got, slope));
                let beside = momentum(10.0, 10.0 * a + 1e-6, loss).0;
                assert!(((beside - got) * 1e6 - slope).abs() < 1e-3);
            }
        }
    }
}
