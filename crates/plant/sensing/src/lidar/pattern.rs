//! Scan patterns: where the beams cross the plane that they are aimed at, in the disc of the pattern.

use std::f64::consts::{PI, TAU};

/// How the points of a scan lie in the disc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pattern {
    /// A square grid with the disc's centre in the middle of four points.
    Plane,
    /// Circles around the centre, evenly spaced out to the rim, points in proportion to their length.
    Rings {
        /// Circles (–).
        n_rings: usize,
    },
    /// A curve of loops through the centre, as two prisms make that turn against each other.
    Rosette {
        /// Loops (–).
        n_petals: usize,
    },
    /// Fixed beams: up to [`MOST_ON_CONE`] on a cone, more in a spiral that fills the disc evenly.
    Beams,
}

/// Fixed beams that lie on one cone, as those of nacelle lidars do (–).
pub(super) const MOST_ON_CONE: usize = 8;

impl Pattern {
    /// `n` points, to the left looking downwind and up, in a disc of radius 1, in the order in which they are
    /// measured.
    pub(super) fn points(self, n: usize) -> Vec<[f64; 2]> {
        match self {
            Self::Plane => grid(n),
            Self::Rings { n_rings } => rings(n, n_rings),
            Self::Rosette { n_petals } => rosette(n, n_petals),
            Self::Beams if n <= MOST_ON_CONE => circle(n, 1.0, PI / n as f64).collect(),
            Self::Beams => spiral(n),
        }
    }
}

/// `n` points of a circle of `radius`, the first at `angle` (rad) from up, clockwise seen from upwind.
fn circle(n: usize, radius: f64, angle: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..n).map(move |index| {
        let (sine, cosine) = (angle + TAU * index as f64 / n as f64).sin_cos();
        [-radius * sine, radius * cosine]
    })
}

/// Points of a square grid of spacing 2, none of them at the centre: the nearest first, and with each its
/// distance squared.
fn grid_points(n: usize) -> Vec<(i64, [i64; 2])> {
    let reach = (n as f64).sqrt().ceil() as i64 + 1;
    let odd = || (-reach..reach).map(|index| 2 * index + 1);
    let mut points: Vec<(i64, [i64; 2])> =
        odd().flat_map(|left| odd().map(move |up| (left * left + up * up, [left, up]))).collect();
    points.sort_by_key(|(distance, point)| (*distance, *point));
    points
}

/// The counts of points at or next to `n` for which a grid fills its disc: `n` itself twice where it does.
pub(super) fn whole_grids(n: usize) -> [usize; 2] {
    let points = grid_points(n);
    let is_whole = |count: usize| count == 0 || points[count - 1].0 != points[count].0;
    let below = (4..=n).rev().find(|count| is_whole(*count)).unwrap_or(4);
    let above = (n.max(4)..points.len() - 1).find(|count| is_whole(*count)).unwrap_or(below);
    [below, above]
}

/// The `n` points of a grid nearest the centre, row after row from the top; each has an equal share of the
/// disc's area.
fn grid(n: usize) -> Vec<[f64; 2]> {
    let mut nearest = grid_points(n);
    nearest.truncate(n);
    let furthest = nearest.last().map_or(1.0, |(distance, _)| (*distance as f64).sqrt());
    nearest.sort_by_key(|(_, [left, up])| (-up, -left));
    let scale = (0.5 * (PI / n as f64).sqrt()).min(1.0 / furthest);
    nearest.into_iter().map(|(_, point)| point.map(|place| scale * place as f64)).collect()
}

fn rings(n: usize, n_rings: usize) -> Vec<[f64; 2]> {
    // Points up to ring number k in proportion to 1 + 2 + … + k.
    let up_to = |ring: usize| {
        (n as f64 * (ring * (ring + 1)) as f64 / (n_rings * (n_rings + 1)) as f64).round() as usize
    };
    let ring = |number: usize| {
        let n_points = up_to(number) - up_to(number - 1);
        let radius = number as f64 / n_rings as f64;
        circle(n_points, radius, PI * number as f64 / n_points.max(1) as f64)
    };
    (1..=n_rings).flat_map(ring).collect()
}

/// Half the sum of two turning arrows, the second `n_petals` − 1 times as fast as the first and the other way
/// round: it passes the rim, then the centre, `n_petals` times.
fn rosette(n: usize, n_petals: usize) -> Vec<[f64; 2]> {
    let point = |index: usize| {
        let angle = TAU * (index as f64 + 0.5) / n as f64;
        let (first, second) = (angle.sin_cos(), ((n_petals - 1) as f64 * angle).sin_cos());
        [-0.5 * (first.0 - second.0), 0.5 * (first.1 + second.1)]
    };
    (0..n).map(point).collect()
}

/// Vogel's spiral, "A better way to construct the sunflower head", Math. Biosci. 44 (1979): equal shares of
/// the disc's area.
fn spiral(n: usize) -> Vec<[f64; 2]> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let point = |index: usize| {
        let radius = ((index as f64 + 0.5) / n as f64).sqrt();
        let (sine, cosine) = (golden * index as f64).sin_cos();
        [-radius * sine, radius * cosine]
    };
    (0..n).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patterns() -> [Pattern; 5] {
        let rings = |n_rings| Pattern::Rings { n_rings };
        [Pattern::Plane, rings(1), rings(4), Pattern::Rosette { n_petals: 5 }, Pattern::Beams]
    }

    #[test]
    fn all_points_lie_in_the_disc_around_its_centre() {
        for pattern in patterns() {
            for n in [12, 24, 80] {
                let points = pattern.points(n);
                assert_eq!(points.len(), n, "{pattern:?}");
                let furthest = points.iter().map(|[y, z]| y.hypot(*z)).fold(0.0, f64::max);
                assert!(furthest <= 1.0 + 1e-12 && furthest > 0.6, "{pattern:?} {n}: {furthest}");
                let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / n as f64;
                assert!(mean(0).hypot(mean(1)) < 0.1, "{pattern:?} {n}");
            }
        }
    }

    #[test]
    fn a_grid_is_symmetric_and_even_and_whole_only_for_some_counts() {
        let points = Pattern::Plane.points(80);
        let is_there = |wanted: [f64; 2]| {
            points.iter().any(|p| (p[0] - wanted[0]).hypot(p[1] - wanted[1]) < 1e-12)
        };
        assert!(points.iter().all(|[y, z]| is_there([-y, *z]) && is_there([*z, *y])));
        // Each point stands for π/80 of the disc: the nearest is half a spacing away along both axes.
        let spacing = (PI / 80.0).sqrt();
        let nearest = points.iter().map(|[y, z]| y.hypot(*z)).fold(1.0, f64::min);
        assert!((nearest - spacing / 2.0_f64.sqrt()).abs() < 1e-12);
        assert!(points[0][1] > 0.8 && points[79][1] < -0.8, "rows from the top");
        assert_eq!(whole_grids(80), [80, 80]);
        assert_eq!(whole_grids(79), [76, 80]);
        assert_eq!(whole_grids(1), [4, 4]);
    }

    #[test]
    fn rings_have_points_in_proportion_to_their_length() {
        let points = Pattern::Rings { n_rings: 3 }.points(60);
        for (ring, expected) in [(1.0, 10), (2.0, 20), (3.0, 30)] {
            let on_it = points.iter().filter(|[y, z]| (y.hypot(*z) - ring / 3.0).abs() < 1e-12);
            assert_eq!(on_it.count(), expected);
        }
    }

    #[test]
    fn a_rosette_is_a_rose_curve() {
        // |½ (e^iα + e^−i4α)| = |cos(5α/2)|.
        let rosette = Pattern::Rosette { n_petals: 5 };
        for (index, [y, z]) in rosette.points(97).iter().enumerate() {
            let angle = TAU * (index as f64 + 0.5) / 97.0;
            assert!((y.hypot(*z) - (2.5 * angle).cos().abs()).abs() < 1e-12);
        }
    }

    #[test]
    fn four_beams_point_to_the_corners_of_a_square() {
        let corner = 0.5_f64.sqrt();
        let expected = [[-corner, corner], [-corner, -corner], [corner, -corner], [corner, corner]];
        for (point, expected) in Pattern::Beams.points(4).iter().zip(expected) {
            assert!((point[0] - expected[0]).hypot(point[1] - expected[1]) < 1e-12);
        }
    }
}
