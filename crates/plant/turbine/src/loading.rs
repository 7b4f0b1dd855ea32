//! Nonlinear part of the smearing correction of a heavily loaded disc, beyond the linear wake of
//! [`crate::lifting_line`].
//!
//! In linear theory the smeared wake lacks the induction of the load that smearing moves beyond the tip. A
//! loaded disc is not linear: the wake of a lighter annulus is convected faster and induces less than in
//! proportion. Annulus by annulus, momentum theory gives both the flow that the solver should find under the
//! smeared load τ_s and the one under the thin blades' load τ (N/m²), from the speed u through the disc
//! alone:
//!
//! ```text
//! U − u_s = τ_s / (2 ρ u_s),        u_t (U − u_t) = τ / (2 ρ),        correction = u_t − u_s.
//! ```
//!
//! The helices convected at u_c give the linear (τ_s − τ) / (2 ρ u_c) on average over the azimuth; [`excess`]
//! gives the difference. It vanishes for light loads and for narrow smearing.
//! Source: axial momentum theory; above an induction of 0.4 its tangent, as Glauert's empirical relation.

use std::f64::consts::PI;

/// Axial induction factor beyond which momentum theory is continued by its tangent (–).
const GREATEST_INDUCTION: f64 = 0.4;

/// Share of each ring's load that smearing moves to each other ring.
#[derive(Clone, Debug)]
pub struct Loading {
    /// Share per area (1/m²), receiving station × ring of origin.
    share: Vec<f64>,
    n: usize,
}

impl Loading {
    /// Rings of radius `centres` (m), loads smeared with a Gaussian of width `smearing_length` (m).
    pub fn new(centres: &[f64], smearing_length: f64) -> Self {
        let area = PI * smearing_length * smearing_length;
        let share = centres
            .iter()
            .flat_map(|&r| centres.iter().map(move |&q| (r, q)))
            .map(|(r, q)| {
                // Gaussian at distance r from the axis, averaged over a ring of radius q: Bessel's I₀,
                // scaled.
                let argument = 2.0 * r * q / (smearing_length * smearing_length);
                let apart = (r - q) / smearing_length;
                (-apart * apart).exp() * scaled_bessel(argument) / area
            })
            .collect();
        Self { share, n: centres.len() }
    }

    /// Load (N/m²) at `station` when the rings carry `thrusts` (N).
    pub fn smeared(&self, station: usize, thrusts: &[f64]) -> f64 {
        self.share[station * self.n..][..self.n].iter().zip(thrusts).map(|(s, t)| s * t).sum()
    }
}

/// Axial velocity (m/s) that the linear wake leaves out: `speed` (m/s) is sampled through the disc, `smeared`
/// and `thin` are the loads there over the air's density (m²/s²), `carried` the speed at which the linear
/// wake is convected (m/s).
pub fn excess(speed: f64, smeared: f64, thin: f64, carried: f64) -> f64 {
    if speed <= 0.0 || carried <= 0.0 || thin <= 0.0 {
        return 0.0;
    }
    let free = speed / through(smeared / (speed * speed));
    let felt = free * (1.0 - induction(2.0 * thin / (free * free)));
    (felt - speed) - 0.5 * (smeared - thin) / carried
}

/// Thrust coefficient where the tangent takes over from momentum theory (–), and the tangent's slope (–).
const GREATEST_COEFFICIENT: f64 = 4.0 * GREATEST_INDUCTION * (1.0 - GREATEST_INDUCTION);
const SLOPE: f64 = 4.0 * (1.0 - 2.0 * GREATEST_INDUCTION);

/// Axial induction factor (–) of a disc with this thrust `coefficient` (–).
fn induction(coefficient: f64) -> f64 {
    if coefficient < GREATEST_COEFFICIENT {
        0.5 * (1.0 - (1.0 - coefficient).sqrt())
    } else {
        GREATEST_INDUCTION + (coefficient - GREATEST_COEFFICIENT) / SLOPE
    }
}

/// Speed through a disc over the free stream's (–), given its `load` over the air's density and the square of
/// the speed through it (–): [`induction`] solved for the free stream, so that both agree however slow the
/// air is.
fn through(load: f64) -> f64 {
    // Symbols: b the unknown ratio, one less the induction; load b² = C(1 − b)/2.
    let b = 1.0 / (1.0 + 0.5 * load);
    if b > 1.0 - GREATEST_INDUCTION {
        return b;
    }
    let all = GREATEST_COEFFICIENT + SLOPE * (1.0 - GREATEST_INDUCTION);
    let half = 0.25 * SLOPE;
    all / (2.0 * (half + (half * half + 0.5 * load * all).sqrt()))
}

/// I₀(x) exp(−x), Abramowitz and Stegun 9.8.1 and 9.8.2, to 2e-7.
fn scaled_bessel(x: f64) -> f64 {
    let t = x / 3.75;
    if x < 3.75 {
        let t = t * t;
        let sum =
            [0.004_581_3, 0.036_076_8, 0.265_973_2, 1.206_749_2, 3.089_942_4, 3.515_622_9, 1.0]
                .iter()
                .fold(0.0, |sum, c| sum * t + c);
        sum * (-x).exp()
    } else {
        let t = 1.0 / t;
        let sum = [
            0.003_923_77,
            -0.016_476_33,
            0.026_355_37,
            -0.020_577_06,
            0.009_162_81,
            -0.001_575_65,
            0.002_253_19,
            0.013_285_92,
            0.398_942_28,
        ]
        .iter()
        .fold(0.0, |sum, c| sum * t + c);
        sum / x.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bessel_has_its_published_values() {
        // I₀(1) = 1.2660658778, I₀(5) = 27.239871824 (Abramowitz and Stegun, table 9.8).
        assert!((scaled_bessel(1.0) - 1.266_065_877_8 * (-1.0_f64).exp()).abs() < 3e-7);
        assert!((scaled_bessel(5.0) - 27.239_871_824 * (-5.0_f64).exp()).abs() < 3e-7);
    }

    #[test]
    fn smearing_moves_load_and_loses_none() {
        // A fine disc of rings, of which one in the middle is loaded.
        let n = 400;
        let centres: Vec<f64> = (0..n).map(|i| 0.25 + 0.5 * f64::from(i)).collect();
        let loading = Loading::new(&centres, 12.0);
        let mut thrusts = vec![0.0; n as usize];
        thrusts[160] = 1.0;
        let total: f64 = centres
            .iter()
            .enumerate()
            .map(|(station, r)| loading.smeared(station, &thrusts) * 2.0 * PI * r * 0.5)
            .sum();
        assert!((total - 1.0).abs() < 1e-4, "{total}");
        let peak = (0..n as usize)
            .max_by(|a, b| loading.smeared(*a, &thrusts).total_cmp(&loading.smeared(*b, &thrusts)));
        assert!(peak.is_some_and(|peak| peak.abs_diff(160) <= 2));
    }

    #[test]
    fn momentum_theory_holds_between_both_flows() {
        // Wind 10 m/s, thin coefficient 0.8, smeared 0.5: both speeds are known.
        let speed_at = |coefficient: f64| 5.0 * (1.0 + (1.0 - coefficient).sqrt());
        let load = |coefficient: f64| 0.5 * coefficient * 100.0;
        let (carried, sampled) = (7.0, speed_at(0.5));
        let linear = 0.5 * (load(0.5) - load(0.8)) / carried;
        let total = linear + excess(sampled, load(0.5), load(0.8), carried);
        assert!((sampled + total - speed_at(0.8)).abs() < 1e-12);
    }

    #[test]
    fn light_loads_and_narrow_smearing_leave_nothing_over() {
        assert!(excess(10.0, 0.01, 0.02, 10.0).abs() < 1e-5);
        assert!(excess(7.0, 30.0, 30.0, 7.0).abs() < 1e-9);
        assert_eq!(excess(0.0, 1.0, 2.0, 7.0), 0.0);
    }

    #[test]
    fn load_that_smearing_does_not_move_needs_no_correction_however_slow_the_air() {
        // Momentum theory has two roots; taking the wrong one drives a stalled wake's rotor into a runaway.
        for speed in [0.01, 0.3, 1.0, 2.0, 4.0, 8.0, 20.0] {
            for load in [0.5, 10.0, 30.0, 60.0] {
                let difference = excess(speed, load, load, 6.0);
                assert!(difference.abs() < 1e-12 * (1.0 + load / speed), "{difference} at {speed}");
            }
        }
    }

    #[test]
    fn beyond_momentum_theory_the_tangent_takes_over_without_a_jump() {
        let at = |thin: f64| excess(6.0, 48.0, thin, 6.0);
        let (free, greatest) = (10.0_f64, 0.96);
        let edge = 0.5 * greatest * free * free;
        assert!((at(edge + 1e-6) - at(edge - 1e-6)).abs() < 1e-5);
        assert!(at(edge + 10.0).is_finite());
    }
}
