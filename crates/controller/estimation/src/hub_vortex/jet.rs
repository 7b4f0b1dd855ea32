//! A Gaussian jet over a wake: both fitted at once, so that neither takes what is the other's.

use super::linear::solved;
use super::point::Point;

/// Parameters of the background: mean, slopes to the left and up, second and fourth power of the radius.
const N_BACKGROUND: usize = 5;
/// And of the jet: speed, place left and up, logarithm of its width.
const N: usize = N_BACKGROUND + 4;
/// Where the place stands among them.
const PLACE: usize = N_BACKGROUND + 1;
/// Where the width stands among them.
const WIDTH: usize = N - 1;
/// Most steps of the fit (–).
const N_STEPS: usize = 20;
/// A step of the place that is the last, in parts of the region's radius (–).
const NEAR: f64 = 1e-4;
/// The jet's width, in parts of what it was taken for (–).
const WIDTHS: [f64; 2] = [0.4, 1.75];
/// Damping at the start, its change from step to step, and the most after which nothing gets better (–).
const DAMPING: [f64; 3] = [1e-3, 10.0, 1e8];

/// The jet that a fit found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Jet {
    /// Speed above the background (m/s).
    pub(super) speed: f64,
    /// Place: left and up (m).
    pub(super) place: [f64; 2],
    /// Standard error of the place, both directions together (m).
    pub(super) error: f64,
}

/// Sums of one fit.
#[derive(Clone, Copy)]
struct Sums {
    matrix: [[f64; N]; N],
    right: [f64; N],
    /// Sum of squares (m²/s²).
    cost: f64,
}

/// The Gaussian jet among `points` within `radius` (m), looked for from `place` (m) with a width of `width`
/// (m); none where the points do not tell one. Least squares by Levenberg and Marquardt.
pub(super) fn fit(points: &[Point], radius: f64, place: [f64; 2], width: f64) -> Option<Jet> {
    if points.len() <= N {
        return None;
    }
    let mut parameters = [0.0; N];
    parameters[PLACE] = place[0] / radius;
    parameters[PLACE + 1] = place[1] / radius;
    let bounds = WIDTHS.map(|share| (share * width / radius).ln());
    parameters[WIDTH] = (width / radius).ln();
    start(points, radius, &mut parameters)?;
    let mut sums = sums(points, radius, &parameters);
    let [mut damping, change, most] = DAMPING;
    for _ in 0..N_STEPS {
        let mut damped = sums.matrix;
        (0..N).for_each(|index| damped[index][index] *= 1.0 + damping);
        let step = solved(damped, sums.right)?;
        let mut tried = parameters;
        tried.iter_mut().zip(&step).for_each(|(value, step)| *value += step);
        tried[WIDTH] = tried[WIDTH].clamp(bounds[0], bounds[1]);
        let after = self::sums(points, radius, &tried);
        if after.cost <= sums.cost {
            (parameters, sums, damping) = (tried, after, damping / change);
            if step[PLACE].hypot(step[PLACE + 1]) < NEAR {
                break;
            }
        } else {
            damping *= change;
            if damping > most {
                break;
            }
        }
    }
    told(&sums, &parameters, radius, points.len())
}

/// On return background and speed of the jet are the best for its place and width.
fn start(points: &[Point], radius: f64, parameters: &mut [f64; N]) -> Option<()> {
    // With all of them zero the residuals are the speeds, and the first slopes those of a linear fit.
    let Sums { matrix, right, .. } = sums(points, radius, parameters);
    let mut linear = [[0.0; PLACE]; PLACE];
    for (row, from) in linear.iter_mut().zip(&matrix) {
        row.copy_from_slice(&from[..PLACE]);
    }
    let mut speeds = [0.0; PLACE];
    speeds.copy_from_slice(&right[..PLACE]);
    parameters[..PLACE].copy_from_slice(&solved(linear, speeds)?);
    Some(())
}

/// Sums of squares and slopes at `parameters`.
fn sums(points: &[Point], radius: f64, parameters: &[f64; N]) -> Sums {
    let mut sums = Sums { matrix: [[0.0; N]; N], right: [0.0; N], cost: 0.0 };
    let inverse = (-2.0 * parameters[WIDTH]).exp();
    let speed = parameters[N_BACKGROUND];
    for point in points {
        let [left, up] = point.place.map(|place| place / radius);
        let squared = left * left + up * up;
        let from = [left - parameters[PLACE], up - parameters[PLACE + 1]];
        let away = inverse * (from[0] * from[0] + from[1] * from[1]);
        let shape = (-0.5 * away).exp();
        let steep = speed * shape;
        let slopes = [
            1.0,
            left,
            up,
            squared,
            squared * squared,
            shape,
            steep * inverse * from[0],
            steep * inverse * from[1],
            steep * away,
        ];
        let linear = slopes.iter().zip(parameters).take(PLACE);
        let residual = point.speed - linear.map(|(slope, value)| slope * value).sum::<f64>();
        sums.cost += residual * residual;
        for row in 0..N {
            sums.right[row] += slopes[row] * residual;
            for column in 0..=row {
                sums.matrix[row][column] += slopes[row] * slopes[column];
            }
        }
    }
    for row in 0..N {
        for column in 0..row {
            sums.matrix[column][row] = sums.matrix[row][column];
        }
    }
    sums
}

/// What a fit of `n_points` tells; none where it is no jet, or not in the region.
fn told(sums: &Sums, parameters: &[f64; N], radius: f64, n_points: usize) -> Option<Jet> {
    let variance = sums.cost / (n_points - N) as f64;
    let mut error = 0.0;
    for axis in [PLACE, PLACE + 1] {
        let mut unit = [0.0; N];
        unit[axis] = 1.0;
        error += variance * solved(sums.matrix, unit)?[axis];
    }
    let place = [parameters[PLACE], parameters[PLACE + 1]];
    let is_there = parameters[N_BACKGROUND] > 0.0 && place[0].hypot(place[1]) < 1.0;
    let error = radius * error.max(0.0).sqrt();
    let jet = Jet { speed: parameters[N_BACKGROUND], place: place.map(|p| radius * p), error };
    (is_there && error.is_finite()).then_some(jet)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Speeds of a grid 12 m apart with a jet of 2 m/s and 11 m, and `extra` (m/s).
    fn points(extra: impl Fn(f64, f64) -> f64) -> Vec<Point> {
        let places = (-4..4).flat_map(|y| (-4..4).map(move |z| [y, z]));
        let places = places.map(|p| p.map(|index: i32| 12.0 * (f64::from(index) + 0.5)));
        let speed = |[y, z]: [f64; 2]| {
            let (r, from_jet) = (y.hypot(z) / 50.0, (y - 7.0).hypot(z + 4.0) / 11.0);
            5.0 + 0.3 * z / 50.0
                + r * r
                + 0.7 * r.powi(4)
                + 2.0 * (-0.5 * from_jet * from_jet).exp()
                + extra(y, z)
        };
        places.map(|place| Point { place, speed: speed(place), time: 0.0 }).collect()
    }

    #[test]
    fn a_jet_over_a_background_is_found_to_the_last_digits_from_afar() {
        for start in [[7.0, -4.0], [18.0, -4.0], [0.0, 8.0]] {
            let jet = fit(&points(|_, _| 0.0), 50.0, start, 12.0).expect("a jet");
            assert!((jet.place[0] - 7.0).hypot(jet.place[1] + 4.0) < 1e-3, "{jet:?}");
            assert!((jet.speed - 2.0).abs() < 1e-3 && jet.error < 1e-2, "{jet:?}");
        }
    }

    /// Noise of 0.1 m/s: over many noises the place scatters as its error says.
    #[test]
    fn the_error_of_the_place_is_its_scatter() {
        let (mut squares, mut told) = (0.0, 0.0);
        for seed in 0..200 {
            let noise = |y: f64, z: f64| {
                let bits = ((f64::from(seed) + 1.3) * (3.7 * y + 11.9 * z + 0.21)).sin() * 4e4;
                0.1 * 12.0_f64.sqrt() * (bits.rem_euclid(1.0) - 0.5)
            };
            let jet = fit(&points(noise), 50.0, [7.0, -4.0], 12.0).expect("a jet");
            squares += (jet.place[0] - 7.0).powi(2) + (jet.place[1] + 4.0).powi(2);
            told += jet.error * jet.error;
        }
        assert!((squares / told - 1.0).abs() < 0.35, "{}", squares / told);
    }

    #[test]
    fn a_hole_and_too_few_points_are_no_jet() {
        let hole =
            |y: f64, z: f64| -4.0 * (-0.5 * (((y - 7.0).hypot(z + 4.0)) / 11.0).powi(2)).exp();
        assert_eq!(fit(&points(hole), 50.0, [7.0, -4.0], 12.0), None);
        assert_eq!(fit(&points(|_, _| 0.0)[..9], 50.0, [7.0, -4.0], 12.0), None);
    }
}
