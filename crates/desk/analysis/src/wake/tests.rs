//! Wakes with known answers: a Gaussian deficit in a sheared wind.

use super::*;
use basis::records::PlaneAxes;

const HUB: f64 = 150.0;

fn sheared(height: f64) -> f64 {
    10.0 * (height / HUB).powf(0.1)
}

/// A plane that holds `velocity` (x, y, z) → u; v = 2 u, w = 0.
fn plane(
    axes: PlaneAxes,
    origin: [f64; 3],
    n_points: [usize; 2],
    velocity: impl Fn([f64; 3]) -> f64,
) -> Plane {
    let spacing = [10.0, 8.0];
    let mut u = Vec::new();
    for second in 0..n_points[1] {
        for first in 0..n_points[0] {
            let (a, b) = (first as f64 * spacing[0], second as f64 * spacing[1]);
            let [x, y, z] = origin;
            u.push(velocity(match axes {
                PlaneAxes::Horizontal => [x + a, y + b, z],
                PlaneAxes::Streamwise => [x + a, y, z + b],
                PlaneAxes::Crosswind => [x, y + a, z + b],
            }) as f32);
        }
    }
    let v = u.iter().map(|u| 2.0 * u).collect();
    let w = vec![0.0; u.len()];
    let name = "test".to_owned();
    Plane { name, axes, origin, spacing, n_points, time: 0.0, averaged: 0.0, velocity: [u, v, w] }
}

/// A Gaussian of 4 m/s and deviation 60 m, its centre moving with x.
fn deficit([x, y, z]: [f64; 3]) -> f64 {
    let centre = [13.0 + 0.05 * x, 137.0];
    let distance = (y - centre[0]).powi(2) + (z - centre[1]).powi(2);
    4.0 * (-0.5 * distance / 3600.0).exp()
}

fn wake(point: [f64; 3]) -> f64 {
    sheared(point[2]) - deficit(point)
}

fn crosswind() -> Plane {
    plane(PlaneAxes::Crosswind, [0.0, -400.0, 4.0], [81, 50], wake)
}

#[test]
fn centre_of_a_gaussian_wake_is_found_between_the_points() {
    let [y, z] = centre(&crosswind(), sheared, 60.0).expect("a crosswind plane");
    assert!((y - 13.0).abs() < 0.05 && (z - 137.0).abs() < 0.4, "{y} {z}");
}

#[test]
fn centre_line_follows_the_wake() {
    let plane = plane(PlaneAxes::Horizontal, [100.0, -400.0, HUB], [60, 101], wake);
    for [x, y] in centre_line(&plane, sheared, 60.0).expect("a horizontal plane") {
        assert!((y - 13.0 - 0.05 * x).abs() < 0.1, "{x} {y}");
    }
}

/// A free stream has no centre, but no failure either.
#[test]
fn uniform_air_does_not_fail() {
    let plane = plane(PlaneAxes::Crosswind, [0.0, -40.0, 4.0], [9, 9], |_| 8.0);
    let [y, z] = centre(&plane, |_| 8.0, 60.0).expect("a crosswind plane");
    assert!(y.is_finite() && z.is_finite());
}

#[test]
fn momentum_deficit_of_a_gaussian_wake() {
    // ∫ u (U − u) dA with u = U − a g: a U · 2πσ² − a² · πσ² in a uniform wind.
    let uniform = |point: [f64; 3]| 10.0 - deficit(point);
    let plane = plane(PlaneAxes::Crosswind, [0.0, -400.0, -263.0], [81, 101], uniform);
    let expected = std::f64::consts::PI * 3600.0 * (2.0 * 4.0 * 10.0 - 16.0);
    let deficit = momentum_deficit(&plane, |_| 10.0).expect("a crosswind plane");
    assert!((deficit / expected - 1.0).abs() < 1e-5, "{deficit} {expected}");
}

#[test]
fn disc_average_of_linear_shear_is_the_speed_at_its_centre() {
    let linear = |[_, _, z]: [f64; 3]| 10.0 + 0.02 * (z - HUB);
    let plane = plane(PlaneAxes::Crosswind, [0.0, -200.0, 4.0], [41, 50], linear);
    let disc = disc_average(&plane, [7.0, HUB], 120.0).expect("the disc lies in the plane");
    assert!((disc.mean - 10.0).abs() < 1e-6);
    // ∫ u³ dA / A = U³ + 3 U s² R² / 4 for u = U + s (z − z₀).
    let cube: f64 = 1000.0 + 30.0 * (0.02_f64 * 120.0).powi(2) / 4.0;
    assert!((disc.rotor_equivalent - cube.cbrt()).abs() < 1e-4);
}

#[test]
fn disc_average_of_a_gaussian_wake() {
    let uniform = |point: [f64; 3]| 10.0 - deficit(point);
    let plane = plane(PlaneAxes::Crosswind, [0.0, -400.0, 4.0], [81, 50], uniform);
    let disc = disc_average(&plane, [13.0, 137.0], 120.0).expect("the disc lies in the plane");
    // Mean of the Gaussian over the disc: 2σ²/R² (1 − exp(−R²/2σ²)).
    let expected = 10.0 - 4.0 * 0.5 * (1.0 - (-2.0_f64).exp());
    assert!((disc.mean - expected).abs() < 0.01, "{}", disc.mean);
    assert!(disc.rotor_equivalent > disc.mean);
}

#[test]
fn the_middle_of_a_deficit_is_its_first_moment() {
    // A paraboloid, 4 m/s in the middle and nought at R, times one and a slope s upwards: its first moment is
    // s R²/6 above its axis.
    let (centre, slope, radius) = ([13.0, 120.0], 0.005, 80.0_f64);
    let uneven = |[_, y, z]: [f64; 3]| {
        let share = 1.0 - (f64::hypot(y - centre[0], z - centre[1]) / radius).powi(2);
        sheared(z) - 4.0 * share.max(0.0) * (1.0 + slope * (z - centre[1]))
    };
    let plane = plane(PlaneAxes::Crosswind, [0.0, -400.0, 4.0], [81, 50], uneven);
    let [y, z] = middle_of_deficit(&plane, sheared, [0.0, 110.0], 105.0).expect("a wake");
    let expected = centre[1] + slope * radius.powi(2) / 6.0;
    assert!((y - centre[0]).abs() < 0.1 && (z - expected).abs() < 0.1, "{y} {z} {expected}");
    // Wind that is everywhere faster than the free stream lacks nothing.
    assert!(middle_of_deficit(&plane, |_| 0.0, [0.0, 110.0], 105.0).is_err());
}

#[test]
fn profiles_hold_the_planes_own_values() {
    let plane = crosswind();
    let along = along_first(&plane, 4.0 + 8.0 * 7.0).expect("inside");
    assert_eq!(along.positions.len(), 81);
    assert_eq!(along.velocities[80], f64::from(plane.velocity[0][7 * 81 + 80]));
    let up = along_second(&plane, -400.0 + 10.0 * 80.0).expect("inside");
    assert_eq!(up.positions[49], 4.0 + 8.0 * 49.0);
    assert_eq!(up.velocities[7], along.velocities[80]);
    let [u, v, w] = velocity_at(&plane, -3.3, 77.7).expect("inside");
    assert!((v - 2.0 * u).abs() < 1e-5 && w == 0.0);
}

#[test]
fn wrong_planes_and_places_are_refused() {
    let crosswind = crosswind();
    let horizontal = plane(PlaneAxes::Horizontal, [0.0, -40.0, HUB], [9, 9], wake);
    assert!(matches!(
        velocity_at(&crosswind, 401.0, 50.0),
        Err(AnalysisError::OutsidePlane { .. })
    ));
    assert!(matches!(
        velocity_at(&crosswind, 0.0, f64::NAN),
        Err(AnalysisError::OutsidePlane { .. })
    ));
    assert!(disc_average(&crosswind, [0.0, 100.0], 120.0).is_err());
    assert!(disc_average(&horizontal, [0.0, 0.0], 1.0).is_err());
    assert!(momentum_deficit(&horizontal, sheared).is_err());
    assert!(centre(&horizontal, sheared, 60.0).is_err());
    assert!(centre_line(&crosswind, sheared, 60.0).is_err());
}

#[test]
fn fluctuation_is_the_deviation_over_time() {
    let at = |time: f64, u: f64| Plane {
        time,
        ..plane(PlaneAxes::Crosswind, [0.0; 3], [3, 2], move |_| u)
    };
    let planes = [at(10.0, 7.0), at(20.0, 9.0), at(30.0, 7.0), at(40.0, 9.0)];
    let fluctuation = fluctuation(&planes).expect("four instants");
    assert_eq!((fluctuation.time, fluctuation.averaged), (40.0, 30.0));
    assert!(fluctuation.velocity[0].iter().all(|u| *u == 1.0));
    assert!(fluctuation.velocity[1].iter().all(|v| *v == 2.0));
    assert!(super::fluctuation(&planes[..1]).is_err());
}
