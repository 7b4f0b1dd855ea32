//! Quarters of a disc in winds that are known everywhere.

use super::*;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

const GRID: PlaneGrid = PlaneGrid {
    n_y: 61,
    n_z: 34,
    spacing: [10.0, 10.0],
    first: [-300.0, 5.0],
    interval: 1.0,
    speed: 8.0,
    n_steps: 80,
    repeats: false,
};
const DISC: Disc = Disc { y: 0.0, z: 170.0, radius: 142.0 };
const SHEAR: f64 = 0.02;
const ASIDE: f64 = -0.004;

struct Known(fn(f64, f64, f64) -> [f64; 3]);

impl Planes for Known {
    fn grid(&self) -> PlaneGrid {
        GRID
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        for (point, value) in values.iter_mut().enumerate() {
            let y = GRID.first[0] + (point % GRID.n_y) as f64 * GRID.spacing[0];
            let z = GRID.first[1] + (point / GRID.n_y) as f64 * GRID.spacing[1];
            *value = (self.0)(step as f64, y, z).map(|value| value as f32);
        }
        Ok(())
    }
}

fn sectors(
    planes: &mut dyn Planes,
    disc: Disc,
    free_stream: f64,
) -> Result<[Sector; 4], InflowError> {
    PlaneMeans::of(planes, free_stream)?.sectors(disc)
}

/// Shear and a slope to the side; ten waves pass, of which all is turbulence.
fn waves(step: f64, y: f64, z: f64) -> [f64; 3] {
    let wave = (TAU * step / 8.0).sin();
    [8.0 + SHEAR * (z - 170.0) + ASIDE * y + 0.6 * wave, 0.3 * wave, -0.3 * wave]
}

/// The mean of a slope over a quarter: that at the distance 8 sin(π/4) R / (3π) from the middle. Rings and
/// rays find it to (1/64)²/4 + (π/128)²/24 = 9e-5 of it; single precision adds 5e-7 m/s.
#[test]
fn a_slope_is_met_where_the_middle_of_a_quarter_is() {
    let away = 8.0 * FRAC_PI_4.sin() * DISC.radius / (3.0 * PI);
    for shift in [0.0, 100.0] {
        let disc = Disc { y: shift, ..DISC };
        let found = sectors(&mut Known(waves), disc, 10.0).unwrap();
        let middle = 8.0 + ASIDE * shift;
        let expected = [SHEAR * away, -ASIDE * away, -SHEAR * away, ASIDE * away];
        // The variance of a sine is half its square.
        let intensity = ((0.36 + 0.09 + 0.09) / 2.0 / 3.0_f64).sqrt() / 10.0;
        for ((sector, expected), name) in found.iter().zip(expected).zip(SECTOR_NAMES) {
            let error = sector.wind_speed - middle - expected;
            assert!(error.abs() < 1e-4 * expected.abs() + 1e-6, "{sector:?}: {error}");
            assert!((sector.turbulence_intensity - intensity).abs() < 1e-7, "{sector:?}");
            assert_eq!(sector.name, name);
        }
    }
}

/// Turbulence to the left alone; below the lowest row that row counts.
#[test]
fn a_quarter_has_what_blows_in_it() {
    let left = |step: f64, y: f64, _: f64| {
        [8.0 + if y > 0.0 { (TAU * step / 8.0).sin() } else { 0.0 }, 0.0, 0.0]
    };
    let [up, right, down, left] =
        sectors(&mut Known(left), DISC, 8.0).unwrap().map(|sector| sector.turbulence_intensity);
    let full = (0.5 / 3.0_f64).sqrt() / 8.0;
    // The point in the middle of the disc is still: the last spacing before it is a ramp.
    assert!(right < 1e-9 && left > 0.97 * full && left < full * (1.0 + 1e-6), "{right} {left}");
    // Half of the quarter, less the ramp: 5 m of width all the way up, but for its narrow end, where z -
    // z²/20 is missing up to 10 m. Rays and rings see its edge to a part in a thousand.
    let ramp = 5.0 * (DISC.radius - 10.0) + 50.0 - 1000.0 / 60.0;
    let half = 0.5 - ramp / (0.25 * PI * DISC.radius.powi(2));
    assert!((up / full - half).abs() < 1e-3 && (up - down).abs() < 1e-9, "{up} {down} {half}");
    let low = Disc { z: 80.0, ..DISC };
    assert!(sectors(&mut Known(waves), low, 8.0).is_ok());
}

/// v over u, of means over the disc: where v grows to the left and u upward both are those of its middle.
#[test]
fn wind_that_blows_across_a_disc_has_a_direction() {
    let across = |step: f64, y: f64, z: f64| {
        let [u, v, w] = waves(step, 0.0, z);
        [u, v + 0.7 + 0.01 * y, w]
    };
    for (shift, v) in [(0.0, 0.7_f64), (-100.0, -0.3)] {
        let means = PlaneMeans::of(&mut Known(across), 8.0).unwrap();
        let found = means.direction(Disc { y: shift, ..DISC }).unwrap();
        assert!((found - v.atan2(8.0)).abs() < 1e-6, "{found}");
        assert!(means.direction(Disc { y: 160.0, ..DISC }).is_err());
    }
}

#[test]
fn a_disc_beyond_the_planes_is_refused() {
    for disc in [Disc { y: 160.0, ..DISC }, Disc { y: -160.0, ..DISC }, Disc { z: 194.0, ..DISC }] {
        let error = sectors(&mut Known(waves), disc, 8.0).unwrap_err();
        assert!(matches!(error, InflowError::Outside { .. }), "{error}");
    }
    assert!(sectors(&mut Known(waves), Disc { radius: 0.0, ..DISC }, 8.0).is_err());
    assert!(sectors(&mut Known(waves), DISC, 0.0).is_err());
}

/// Planes after the first half are a metre per second faster.
#[test]
fn some_planes_alone_are_what_passed_meanwhile() {
    let faster = |step: f64, _: f64, _: f64| [if step < 40.0 { 8.0 } else { 9.0 }, 0.0, 0.0];
    let mut planes = Known(faster);
    let n_steps = planes.grid().n_steps;
    assert!(n_steps > 42);
    let of = |planes: &mut Known, steps: std::ops::Range<usize>| {
        PlaneMeans::of_steps(planes, 8.0, steps).map(|means| means.sectors(DISC).unwrap())
    };
    for (steps, speed) in [(0..40, 8.0), (40..n_steps + 9, 9.0), (38..42, 8.5)] {
        let found = of(&mut planes, steps).unwrap();
        assert!(found.iter().all(|sector| (sector.wind_speed - speed).abs() < 1e-6), "{found:?}");
        let intensity = if speed == 8.5 { 0.5 / 3.0_f64.sqrt() / 8.0 } else { 0.0 };
        assert!((found[0].turbulence_intensity - intensity).abs() < 1e-7, "{found:?}");
    }
    assert!(of(&mut planes, n_steps..n_steps + 5).is_err());
}
