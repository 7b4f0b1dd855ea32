//! Temperature of boxes at the start, as an inflow tells it.

use super::*;
use crate::Inflow;

/// Wind that tells its temperature.
struct Told<F>(Vector3, F);

impl<F: Fn(Vector3) -> f64 + Send + Sync> Inflow for Told<F> {
    fn sample(&self, _: f64, _: &[Vector3], velocities: &mut [Vector3]) {
        velocities.fill(self.0);
    }

    fn sample_temperature(&self, _: f64, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        for (position, temperature) in positions.iter().zip(temperatures) {
            *temperature = self.1(*position);
        }
        true
    }
}

/// Air on cells of 10 m over slippery ground, in which `warmth` tells the temperature, and two boxes in one
/// another that rise through an inversion.
fn told(wind: Vector3, boxes: bool, warmth: fn(Vector3) -> f64) -> Refined {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [18, 14, 16], 0.1, 8.0);
    (settings.ends, settings.sides, settings.threads) = (Ends::Periodic, Sides::Periodic, Some(1));
    settings.atmosphere = Some(Atmosphere {
        driving: Driving::Geostrophic([wind.x, wind.y]),
        ..Atmosphere::new(290.0)
    });
    let mut place = cells([4, 3, 0], [10, 8, 11]);
    place.within.push(cells([4, 4, 4], [10, 8, 15]));
    let boxes = if boxes { vec![place] } else { Vec::new() };
    Refined::new(settings, &boxes, Arc::new(Told(wind, warmth))).expect("sound settings")
}

/// 0.75 K a cell from the middle of a cell on, over a hundred metres.
fn inversion(x: Vector3) -> f64 {
    290.0 + 0.075 * (x.z - 75.0).clamp(0.0, 40.0)
}

#[test]
fn air_is_at_rest_whose_inversion_the_inflow_tells() {
    for wind in [Vector3::ZERO, Vector3::new(6.0, 3.0, 0.0)] {
        let mut air = told(wind, true, inversion);
        air.advance(60.0, &[]).expect("no divergence");
        let off = all_cells(&air).into_iter().map(|(_, v, _)| (v - wind).length());
        let off = off.fold(0.0, f64::max);
        println!("{wind}: {off:e} m/s");
        // As where levels have the temperatures of a profile. With what is told at their own middles, 0.1 K
        // more in the mean at the inversion's foot, the boxes rose with 0.02 m/s.
        assert!(off < 3e-5, "{wind}: {off} m/s");
    }
}

#[test]
fn a_box_begins_with_the_heat_of_the_cells_that_it_covers() {
    const WAVE: f64 = TAU / 90.0;
    fn warmth(x: Vector3) -> f64 {
        inversion(x) + 0.5 * (WAVE * x.x).sin() * (WAVE * x.y).cos()
    }
    let (plain, boxed) = (told(Vector3::ZERO, false, warmth), told(Vector3::ZERO, true, warmth));
    let (left, right) = (mean(&plain), mean(&boxed));
    assert!((left - right).abs() < 1e-6, "{left} and {right} K");
    // Cell by cell, those under the boxes as well.
    let [_, n_y, n_z] = plain.base().n_cells();
    for row in 0..n_y * n_z {
        let rows = [&plain, &boxed].map(|air| air.base().engine.temperature(row).expect("warm"));
        for (a, b) in rows[0].iter().zip(rows[1]) {
            assert!((a - b).abs() < 2e-6, "{a} and {b} K in row {row}");
        }
    }
    // Along a level each cell has what is told at its own place, but for what the means over four of it lack:
    // 0.5 K times half the sum of (k h/4)² along x and y, h the cells around, in the outer box and in the
    // inner one besides. Below the inversion there are no slopes upwards.
    let most = 0.5 * (WAVE * 10.0 / 4.0).powi(2) * (1.0 + 0.25);
    let low =
        warm_cells(&boxed).into_iter().filter(|cell| cell.volume < 999.0 && cell.centre.z < 60.0);
    let off = low.map(|cell| (cell.temperature + 290.0 - warmth(cell.centre)).abs());
    let off = off.fold(0.0, f64::max);
    println!("off by {off} K at most, {most} K expected");
    assert!(off < 1.05 * most, "{off} K");
}
