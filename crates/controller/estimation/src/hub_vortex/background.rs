//! A first look at the wind around the hub vortex: shear and the wake's bowl.

use super::linear::solved;
use super::point::{Point, median};

/// Coefficients: mean, slopes to the left and up, curvature.
const N: usize = 4;
/// Fits, each without what the one before found too fast (–).
const N_FITS: usize = 4;
/// Scatter from a normal deviation's median (–): 1/Φ⁻¹(3/4).
const OF_MEDIAN: f64 = 1.4826;
/// What is further above the background than this belongs to the vortex, in parts of the scatter (–).
const BISQUARE: f64 = 3.0;

/// Working memory of a fit.
#[derive(Clone, Debug)]
pub(super) struct Background {
    residuals: Vec<f64>,
    scratch: Vec<f64>,
}

impl Background {
    /// Memory for `n_points`.
    pub(super) fn with_capacity(n_points: usize) -> Self {
        Self { residuals: Vec::with_capacity(n_points), scratch: Vec::with_capacity(n_points) }
    }

    /// On return the speeds of `points` are what they exceed their background by (m/s); gives the scatter of
    /// what is left of the background (m/s). None where the points do not tell one.
    ///
    /// Least squares with weights (Tukey's bisquare), found again and again: only what is too fast loses
    /// weight, since the vortex is faster than the air around.
    pub(super) fn remove(&mut self, points: &mut [Point], radius: f64) -> Option<f64> {
        let mut scatter = f64::INFINITY;
        for _ in 0..N_FITS {
            let fit = self.fit(points, radius, scatter)?;
            self.residuals.clear();
            let residual = |point: &Point| point.speed - value(&fit, &terms(point, radius));
            self.residuals.extend(points.iter().map(residual));
            self.scratch.clear();
            self.scratch.extend(self.residuals.iter().map(|residual| residual.abs()));
            scatter = OF_MEDIAN * median(&mut self.scratch);
        }
        for (point, residual) in points.iter_mut().zip(&self.residuals) {
            point.speed = *residual;
        }
        Some(scatter)
    }

    /// Coefficients of the background of `points`, with weights by the residuals of the fit before.
    fn fit(&self, points: &[Point], radius: f64, scatter: f64) -> Option<[f64; N]> {
        let (mut matrix, mut right) = ([[0.0; N]; N], [0.0; N]);
        for (index, point) in points.iter().enumerate() {
            let residual = self.residuals.get(index).copied().unwrap_or(0.0);
            let weight = if scatter.is_finite() { bisquare(residual, scatter) } else { 1.0 };
            let terms = terms(point, radius);
            for row in 0..N {
                right[row] += weight * terms[row] * point.speed;
                for column in 0..N {
                    matrix[row][column] += weight * terms[row] * terms[column];
                }
            }
        }
        solved(matrix, right)
    }
}

/// Weight of a point that exceeds its background by `residual` (m/s).
fn bisquare(residual: f64, scatter: f64) -> f64 {
    let ratio = residual / (BISQUARE * scatter).max(1e-9);
    if ratio <= 0.0 {
        1.0
    } else if ratio < 1.0 {
        (1.0 - ratio * ratio).powi(2)
    } else {
        0.0
    }
}

fn terms(point: &Point, radius: f64) -> [f64; N] {
    let [left, up] = point.place.map(|place| place / radius);
    [1.0, left, up, left * left + up * up]
}

fn value(fit: &[f64; N], terms: &[f64; N]) -> f64 {
    fit.iter().zip(terms).map(|(coefficient, term)| coefficient * term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc() -> Vec<Point> {
        let places = (-5..5).flat_map(|y| (-5..5).map(move |z| [y, z]));
        let place = |[y, z]: [i32; 2]| [10.0 * f64::from(y) + 5.0, 10.0 * f64::from(z) + 5.0];
        places.map(|p| Point { place: place(p), speed: 0.0, time: 0.0 }).collect()
    }

    #[test]
    fn a_sheared_bowl_is_removed_to_the_last_bit_with_a_vortex_in_it() {
        let mut points = disc();
        let at = |place: [f64; 2]| (-0.5 * ((place[0] - 15.0).hypot(place[1]) / 8.0).powi(2)).exp();
        for point in &mut points {
            let [y, z] = point.place;
            point.speed = 5.0 + 0.01 * y + 0.03 * z + 2e-4 * (y * y + z * z) + 3.0 * at([y, z]);
        }
        let scatter = Background::with_capacity(100).remove(&mut points, 50.0).expect("a fit");
        assert!(scatter < 0.02, "{scatter}");
        for point in &points {
            assert!((point.speed - 3.0 * at(point.place)).abs() < 0.05, "{point:?}");
        }
    }

    #[test]
    fn points_on_a_line_tell_no_background() {
        let mut points = disc();
        points.iter_mut().for_each(|point| point.place[0] = 0.0);
        assert_eq!(Background::with_capacity(100).remove(&mut points, 50.0), None);
    }
}
