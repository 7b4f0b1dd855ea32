//! Monin-Obukhov similarity: wind and temperature above a rough ground that heat passes through.

use crate::lattice::wall::VON_KARMAN;

/// Constants of the similarity functions.
///
/// In stable air φ = 1 + β ζ, in unstable air (1 − γ ζ)^(−1/4) for momentum and (1 − γ ζ)^(−1/2) for heat
/// (Dyer 1974, Bound.-Layer Meteorol. 7, 363), ζ = z/L.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// β of momentum (–).
    pub stable_momentum: f64,
    /// β of heat (–).
    pub stable_heat: f64,
    /// γ of both (–).
    pub unstable: f64,
}

impl Default for Similarity {
    /// Constants that the intercomparison of stable boundary layers prescribed (Beare et al. 2006,
    /// Bound.-Layer Meteorol. 118, 247), and Dyer's for unstable air.
    fn default() -> Self {
        Self { stable_momentum: 4.8, stable_heat: 7.8, unstable: 16.0 }
    }
}

/// Largest height over Obukhov length that is told from still more stable air (–).
const MOST_STABLE: f64 = 20.0;
/// Newton's steps in unstable air: from the estimate below three are enough for seven digits.
const NEWTON_STEPS: usize = 4;

/// A height above a rough ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// ln(z/z₀) (–).
    pub(crate) logarithm: f64,
    /// z₀/z (–).
    pub(crate) roughness: f64,
}

impl Similarity {
    /// Integral of (1 − φ)/ζ for momentum and heat from the ground up, at `zeta` (Paulson 1970, J. Appl.
    /// Meteorol. 9, 857).
    pub fn corrections(&self, zeta: f64) -> [f64; 2] {
        if zeta >= 0.0 {
            return [-self.stable_momentum * zeta, -self.stable_heat * zeta];
        }
        let x = (1.0 - self.unstable * zeta).powf(0.25);
        let half = (0.5 * (1.0 + x * x)).ln();
        let momentum =
            2.0 * (0.5 * (1.0 + x)).ln() + half - 2.0 * x.atan() + std::f64::consts::FRAC_PI_2;
        [momentum, 2.0 * half]
    }

    /// U κ/u* and (θ − θ at the ground) κ/θ* at `place`, where its height over Obukhov's length is `zeta`.
    pub(crate) fn profiles(&self, place: Place, zeta: f64) -> [f64; 2] {
        let above = self.corrections(zeta);
        let ground = self.corrections(zeta * place.roughness);
        std::array::from_fn(|which| {
            (place.logarithm - above[which] + ground[which]).max(0.1 * place.logarithm)
        })
    }

    /// Height over Obukhov's length (–) at `place` for a bulk Richardson number g z Δθ/(θ U²).
    pub(crate) fn of_richardson(&self, place: Place, richardson: f64) -> f64 {
        let logarithm = place.logarithm;
        if richardson >= 0.0 {
            // ζ (l + b ζ) = Ri (l + a ζ)²: a quadratic.
            let share = 1.0 - place.roughness;
            let (a, b) = (self.stable_momentum * share, self.stable_heat * share);
            let square = b - richardson * a * a;
            let linear = logarithm * (1.0 - 2.0 * richardson * a);
            let constant = -richardson * logarithm * logarithm;
            let root = linear * linear - 4.0 * square * constant;
            if root < 0.0 {
                return MOST_STABLE;
            }
            let below = linear + root.sqrt();
            return if below > 0.0 {
                (-2.0 * constant / below).min(MOST_STABLE)
            } else {
                MOST_STABLE
            };
        }
        let mut zeta = richardson * logarithm;
        for _ in 0..NEWTON_STEPS {
            let residual = |zeta: f64| {
                let [momentum, heat] = self.profiles(place, zeta);
                zeta - richardson * momentum * momentum / heat
            };
            let width = 1e-4 * zeta.min(-1e-6);
            let value = residual(zeta);
            let slope = (residual(zeta + width) - value) / width;
            zeta = (zeta - value / slope).min(0.0);
        }
        zeta
    }

    /// Height over Obukhov's length at `place` for a `flux` κ z g q/(θ U³) of heat upwards (–), a bulk one.
    pub(crate) fn of_flux(&self, place: Place, flux: f64, before: f64) -> f64 {
        // ζ = −κ⁻³ … (U κ/u*)³: a fixed point, from what held before.
        let [momentum, _] = self.profiles(place, before);
        let zeta = -flux * (momentum / VON_KARMAN).powi(3);
        0.5 * (zeta.clamp(-MOST_STABLE, MOST_STABLE) + before)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> Place {
        Place { logarithm: (9.375_f64 / 0.1).ln(), roughness: 0.1 / 9.375 }
    }

    #[test]
    fn a_bulk_richardson_number_is_that_of_its_profiles() {
        let similarity = Similarity::default();
        for zeta in [-5.0, -1.0, -0.1, -1e-3, 0.0, 1e-3, 0.1, 1.0, 5.0] {
            let [momentum, heat] = similarity.profiles(place(), zeta);
            let richardson = zeta * heat / (momentum * momentum);
            let found = similarity.of_richardson(place(), richardson);
            assert!((found - zeta).abs() < 1e-5 * (1.0 + zeta.abs()), "{zeta}: {found}");
        }
    }

    #[test]
    fn corrections_are_integrals_of_the_similarity_functions() {
        let similarity = Similarity::default();
        for zeta in [-2.0_f64, -0.3, 0.7] {
            let n = 200_000;
            let (mut momentum, mut heat) = (0.0, 0.0);
            for index in 0..n {
                let at = zeta * (index as f64 + 0.5) / n as f64;
                let root = (1.0 - 16.0 * at).abs();
                let [phi_m, phi_h] = match at < 0.0 {
                    true => [root.powf(-0.25), root.powf(-0.5)],
                    false => [1.0 + 4.8 * at, 1.0 + 7.8 * at],
                };
                momentum += (1.0 - phi_m) / at * zeta / n as f64;
                heat += (1.0 - phi_h) / at * zeta / n as f64;
            }
            let [m, h] = similarity.corrections(zeta);
            assert!((m - momentum).abs() < 1e-4 && (h - heat).abs() < 1e-4, "{zeta}");
        }
    }

    #[test]
    fn a_flux_of_heat_settles() {
        let similarity = Similarity::default();
        for flux in [-2e-6, 3e-5] {
            let mut zeta = 0.0;
            for _ in 0..60 {
                zeta = similarity.of_flux(place(), flux, zeta);
            }
            let [momentum, _] = similarity.profiles(place(), zeta);
            let expected = -flux * (momentum / VON_KARMAN).powi(3);
            assert!((zeta / expected - 1.0).abs() < 1e-6, "{flux}: {zeta} {expected}");
        }
    }
}
