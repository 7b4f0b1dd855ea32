//! The probe volume: along how much of its beam a lidar measures.

use std::f64::consts::PI;

/// Weight of the air along a beam around the place that it measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Probe {
    /// That place alone.
    None,
    /// Of a focused continuous wave: z / (π (z² + s²)) at the distance s, z the Rayleigh length (m).
    Lorentzian(f64),
    /// Of a pulse: a Gaussian, by its full width at half maximum (m).
    Gaussian(f64),
}

/// Places along the beam at which a probe volume is sampled (–).
const N_NODES: usize = 11;
/// Where a Lorentzian ends (Rayleigh lengths): what lies beyond holds 6 % of its weight, and is spread over
/// more air than a lidar's detector tells from none.
const LORENTZIAN_END: f64 = 10.0;

impl Probe {
    /// Distances from the place that is measured (m, along the beam) and weights (–), whose sum is 1.
    ///
    /// A Lorentzian is integrated by Gauss and Legendre over arctan(s/z), where its weight is even; a
    /// Gaussian by sums one standard deviation apart, which are exact to 1e-8 for smooth winds.
    pub(super) fn nodes(self) -> Vec<(f64, f64)> {
        let nodes: Vec<(f64, f64)> = match self {
            Self::None => vec![(0.0, 1.0)],
            Self::Lorentzian(length) => {
                let most = LORENTZIAN_END.atan();
                let rule = gauss_legendre(N_NODES).into_iter();
                rule.map(|(x, weight)| (length * (most * x).tan(), weight)).collect()
            }
            Self::Gaussian(width) => {
                let deviation = width / (8.0 * 2.0_f64.ln()).sqrt();
                let half = N_NODES as i32 / 2;
                let steps = (-half..=half).map(f64::from);
                steps.map(|step| (deviation * step, (-0.5 * step * step).exp())).collect()
            }
        };
        let total: f64 = nodes.iter().map(|(_, weight)| weight).sum();
        nodes.into_iter().map(|(place, weight)| (place, weight / total)).collect()
    }
}

/// Abscissae and weights of the rule of Gauss and Legendre of `n` points on (−1, 1): roots of the Legendre
/// polynomial by Newton's method.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let legendre = |x: f64| {
        let (mut before, mut value) = (1.0, x);
        for degree in 2..=n {
            let k = degree as f64;
            (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
        }
        (value, n as f64 * (x * value - before) / (x * x - 1.0))
    };
    let point = |index: usize| {
        let mut x = -(PI * (index as f64 + 0.75) / (n as f64 + 0.5)).cos();
        for _ in 0..20 {
            let (value, slope) = legendre(x);
            x -= value / slope;
        }
        let slope = legendre(x).1;
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a probe shows of cos(k s).
    fn shown(probe: Probe, k: f64) -> f64 {
        probe.nodes().iter().map(|(place, weight)| weight * (k * place).cos()).sum()
    }

    #[test]
    fn means_and_slopes_go_through_every_probe() {
        for probe in [Probe::None, Probe::Lorentzian(12.0), Probe::Gaussian(30.0)] {
            let nodes = probe.nodes();
            let total: f64 = nodes.iter().map(|(_, weight)| weight).sum();
            let first: f64 = nodes.iter().map(|(place, weight)| place * weight).sum();
            assert!((total - 1.0).abs() < 1e-14 && first.abs() < 1e-12, "{probe:?}");
        }
    }

    #[test]
    fn a_gaussian_probe_dampens_a_wave_by_its_closed_form() {
        let width = 30.0;
        let deviation = width / (8.0 * 2.0_f64.ln()).sqrt();
        for wavelength in [40.0, 80.0, 200.0] {
            let k = 2.0 * PI / wavelength;
            let expected = (-0.5 * (k * deviation).powi(2)).exp();
            let found = shown(Probe::Gaussian(width), k);
            assert!((found - expected).abs() < 2e-4, "{wavelength} m: {found} {expected}");
        }
    }

    #[test]
    fn a_lorentzian_probe_dampens_a_wave_as_its_integral_does() {
        let length = 10.0;
        for wavelength in [120.0, 250.0, 600.0] {
            let k = 2.0 * PI / wavelength;
            let n = 200_000;
            let most = LORENTZIAN_END.atan();
            let angle = |index: i32| most * (2.0 * (f64::from(index) + 0.5) / f64::from(n) - 1.0);
            let sum: f64 = (0..n).map(|index| (k * length * angle(index).tan()).cos()).sum();
            let found = shown(Probe::Lorentzian(length), k);
            assert!((found - sum / f64::from(n)).abs() < 2e-3, "{wavelength} m: {found}");
            // Without an end it would be e^(−k z).
            assert!((found - (-k * length).exp()).abs() < 0.08, "{wavelength} m: {found}");
        }
    }

    #[test]
    fn the_rule_is_exact_for_powers_and_weighs_a_lorentzian_by_its_angle() {
        let rule = gauss_legendre(N_NODES);
        for power in [0, 2, 16, 20] {
            let sum: f64 = rule.iter().map(|(x, weight)| weight * x.powi(power)).sum();
            assert!((sum - 2.0 / f64::from(power + 1)).abs() < 1e-13, "{power}");
        }
        // The mean of 1/(1 + s²) over what is left of a Lorentzian: ∫ cos² over the angle.
        let most = LORENTZIAN_END.atan();
        let expected = 0.5 + 0.25 * (2.0 * most).sin() / most;
        let found: f64 =
            Probe::Lorentzian(1.0).nodes().iter().map(|(s, weight)| weight / (1.0 + s * s)).sum();
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}
