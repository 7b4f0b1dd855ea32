//! Mass along a beam lumped at few points: Gaussian quadrature with the mass as its weight.

/// Abscissae and weights of the three-point Gauss-Legendre rule on (−1, 1), exact up to the fifth degree.
pub(super) const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Places (m) and masses (kg) of two points for each part of a beam between neighbouring `borders` (m).
///
/// `density` holds places (m, rising) and mass per length (kg/m), linear in between. The points have the
/// part's mass, first, second and third moment, so that ∫ density × f is exact for every cubic f in each
/// part, whatever the density. Source: Gauss quadrature from moments; the points are roots of the quadratic
/// orthogonal to all lines.
pub(super) fn mass_points(density: &[(f64, f64)], borders: &[f64]) -> Vec<(f64, f64)> {
    borders.windows(2).flat_map(|part| two_points(density, part[0], part[1])).collect()
}

fn two_points(density: &[(f64, f64)], start: f64, end: f64) -> [(f64, f64); 2] {
    let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
    let mut moments = [0.0; 4];
    for pair in density.windows(2) {
        let (from, to) = (pair[0].0.max(start), pair[1].0.min(end));
        if to <= from {
            continue;
        }
        let slope = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
        for (abscissa, weight) in GAUSS {
            let place = 0.5 * (from + to) + 0.5 * (to - from) * abscissa;
            let mass = 0.5 * (to - from) * weight * (pair[0].1 + slope * (place - pair[0].0));
            let mut term = mass;
            for moment in &mut moments {
                *moment += term;
                term *= (place - middle) / half;
            }
        }
    }
    // Symbols: m0 to m3 moments of mass over t in (−1, 1); t² + b t + c the orthogonal quadratic.
    let [m0, m1, m2, m3] = moments;
    let spread = m0 * m2 - m1 * m1;
    let b = (m1 * m2 - m0 * m3) / spread;
    let c = (m1 * m3 - m2 * m2) / spread;
    let root = (0.25 * b * b - c).sqrt();
    let (low, high) = (-0.5 * b - root, -0.5 * b + root);
    let upper = (m1 - low * m0) / (high - low);
    [(middle + half * low, m0 - upper), (middle + half * high, upper)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_mass_gives_legendres_points() {
        let points = mass_points(&[(0.0, 3.0), (2.0, 3.0)], &[0.0, 2.0]);
        for (point, sign) in points.iter().zip([-1.0, 1.0]) {
            assert!((point.0 - (1.0 + sign / 3.0_f64.sqrt())).abs() < 1e-12);
            assert!((point.1 - 3.0).abs() < 1e-12);
        }
    }

    #[test]
    fn cubics_are_exact_for_a_kinked_density() {
        // Density 4 − x up to 1, then 3: ∫ x³ over (0, 2) = 1 − 1/5 + 3 (16 − 1) / 4.
        let points = mass_points(&[(0.0, 4.0), (1.0, 3.0), (2.0, 3.0)], &[0.0, 2.0]);
        let sum: f64 = points.iter().map(|(place, mass)| mass * place.powi(3)).sum();
        assert!((sum - (0.8 + 11.25)).abs() < 1e-12);
        assert!(points.iter().all(|(place, mass)| *mass > 0.0 && (0.0..2.0).contains(place)));
    }
}
