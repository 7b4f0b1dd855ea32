//! Temperature that the inflow brings in with its wind.

use super::*;
use crate::FlowSolver;
use crate::lattice::atmosphere::{Atmosphere, Heating};
use std::f64::consts::TAU;

const SPEED: f64 = 0.1;
/// Steps of a swing of the temperature that enters: sixty cells.
const PERIOD: f64 = 600.0;

/// Wind along x whose temperature swings by a kelvin about 300 K, as it would in air that was carried there.
struct Swinging;

impl Inflow for Swinging {
    fn sample(&self, _: f64, _: &[Vector3], velocities: &mut [Vector3]) {
        velocities.fill(Vector3::new(SPEED, 0.0, 0.0));
    }

    fn sample_temperature(
        &self,
        time: f64,
        positions: &[Vector3],
        temperatures: &mut [f64],
    ) -> bool {
        for (position, temperature) in positions.iter().zip(temperatures) {
            *temperature = 300.0 + swing(time, position.x);
        }
        true
    }
}

fn swing(time: f64, x: f64) -> f64 {
    (TAU / PERIOD * (time - x / SPEED)).sin()
}

fn settings(threads: usize) -> LatticeSettings {
    let mut settings = periodic_box([90, 4, 3], 1e-4);
    settings.ends = Ends::InletOutlet;
    settings.threads = Some(threads);
    settings.atmosphere =
        Some(Atmosphere { gravity: 0.0, heating: Heating::None, ..Atmosphere::new(300.0) });
    settings
}

fn begin(threads: usize) -> Lattice {
    Lattice::new(settings(threads), Arc::new(Swinging)).unwrap()
}

/// Departures from 300 K along the first row.
fn row(air: &Lattice) -> Vec<f32> {
    let mut row = crate::lattice::atmosphere::AirRow::new(90);
    assert!(air.engine.read_air(0, &mut row));
    row.temperature[..90].to_vec()
}

#[test]
fn what_enters_is_carried_along() {
    let mut air = begin(1);
    // What was there at the start has left: 900 steps to the outlet.
    air.advance(1500.0, &[]).unwrap();
    for (x, found) in row(&air).into_iter().enumerate().take(80) {
        let expected = swing(1500.0, x as f64);
        // Beyond the inlet temperature is even, which makes it a quarter of a cell late: 0.026 K.
        assert!((f64::from(found) - expected).abs() < 0.04, "cell {x}: {found}, {expected}");
    }
}

#[test]
fn temperature_is_told_between_cells() {
    let mut air = begin(1);
    air.advance(50.0, &[]).unwrap();
    let row = row(&air);
    let places = [4.0, 4.25, 89.0].map(|x| Vector3::new(x, 1.0, 1.0));
    let mut found = [0.0; 3];
    assert!(air.sample_temperature(&places, &mut found));
    let between = row[4] + 0.25 * (row[5] - row[4]);
    for (found, expected) in found.into_iter().zip([row[4], between, row[89]]) {
        assert!((found - 300.0 - f64::from(expected)).abs() < 1e-5, "{found}, {expected}");
    }
    let dry = Lattice::new(periodic_box([8, 4, 3], 1e-4), Arc::new(Swinging)).unwrap();
    assert!(!dry.sample_temperature(&places, &mut found));
}

#[test]
fn threads_and_resuming_change_no_bit_of_it() {
    let bits = |air: &Lattice| row(air).into_iter().map(f32::to_bits).collect::<Vec<u32>>();
    let [mut one, mut three] = [1, 3].map(begin);
    // Not a whole number of the times at which the inflow is asked.
    one.advance(130.0, &[]).unwrap();
    three.advance(130.0, &[]).unwrap();
    let mut kept = Vec::new();
    one.write_state(&mut kept).unwrap();
    let mut resumed = begin(2);
    resumed.read_state(&mut kept.as_slice()).unwrap();
    for air in [&mut one, &mut three, &mut resumed] {
        air.advance(57.0, &[]).unwrap();
    }
    assert!(bits(&one) == bits(&three) && bits(&one) == bits(&resumed));
}
