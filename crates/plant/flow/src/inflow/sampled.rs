//! A wind that is known everywhere, laid on the points of a box: what a file of planes needs.

use super::{InflowError, PlaneGrid, TurbulenceBox};
use crate::Inflow;
use basis::Vector3;

/// `inflow` at x = 0 on the planes of `grid`, the first at time zero: a box that is carried along with the
/// grid's speed and brings this wind, and the mean of u at each of its heights (m/s), lowest first, which the
/// box does not hold.
///
/// The box repeats; a wind that ends otherwise than it began jumps there.
///
/// # Errors
/// [`InflowError::Setting`] for a grid that makes no sense, [`InflowError::Memory`] for one that the machine
/// cannot hold.
pub fn sampled(
    inflow: &dyn Inflow,
    grid: &PlaneGrid,
) -> Result<(TurbulenceBox, Vec<f64>), InflowError> {
    grid.check()?;
    let n_points = [grid.n_steps, grid.n_y, grid.n_z];
    let size = grid.n_y.saturating_mul(grid.n_z);
    let n_values = grid.n_steps.saturating_mul(size);
    let mut velocity: [Vec<f32>; 3] = Default::default();
    for values in &mut velocity {
        let memory = 12_u64.saturating_mul(n_values as u64);
        let refused = |_| InflowError::Memory { n_points, memory };
        values.try_reserve_exact(n_values).map_err(refused)?;
        values.resize(n_values, 0.0);
    }
    let place = |point: usize| {
        let (y, z) = (point % grid.n_y, point / grid.n_y);
        let [y, z] = [(y, 0), (z, 1)]
            .map(|(index, axis)| grid.first[axis] + index as f64 * grid.spacing[axis]);
        Vector3::new(0.0, y, z)
    };
    let positions: Vec<Vector3> = (0..size).map(place).collect();
    let mut winds = vec![Vector3::ZERO; size];
    let mut mean_speeds = vec![0.0; grid.n_z];
    let per_value = 1.0 / (grid.n_steps * grid.n_y) as f64;
    // Twice, so that what is rounded is the difference from the mean, and nothing is held in double
    // precision.
    for step in 0..grid.n_steps {
        inflow.sample(step as f64 * grid.interval, &positions, &mut winds);
        for (point, wind) in winds.iter().enumerate() {
            mean_speeds[point / grid.n_y] += per_value * wind.x;
        }
    }
    for step in 0..grid.n_steps {
        inflow.sample(step as f64 * grid.interval, &positions, &mut winds);
        // Time runs against x.
        let start = (grid.n_steps - step) % grid.n_steps * size;
        for (point, wind) in winds.iter().enumerate() {
            let mean = Vector3::new(mean_speeds[point / grid.n_y], 0.0, 0.0);
            for (values, value) in velocity.iter_mut().zip((*wind - mean).to_array()) {
                values[start + point] = value as f32;
            }
        }
    }
    let spacing = [grid.speed * grid.interval, grid.spacing[0], grid.spacing[1]];
    Ok((TurbulenceBox::new(n_points, spacing, velocity)?, mean_speeds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inflow::deterministic::{Change, Event};
    use crate::inflow::planes::BoxPlanes;
    use crate::inflow::{DeterministicWind, MeanProfile, Planes};
    use std::sync::Arc;

    #[test]
    fn planes_bring_the_wind_that_was_sampled() {
        let profile = MeanProfile::PowerLaw { hub_height: 90.0, speed: 10.0, exponent: 0.2 };
        let event = Event::Everywhere(Change::Ramp { start: 3.0, duration: 5.0, speed: 13.0 });
        let wind = DeterministicWind { profile, hub_height: 90.0, veer: 2e-3, event };
        let grid = PlaneGrid {
            n_y: 3,
            n_z: 4,
            spacing: [20.0, 25.0],
            first: [-20.0, 40.0],
            interval: 0.5,
            speed: 10.0,
            n_steps: 24,
            repeats: true,
        };
        let (turbulence, mean_speeds) = sampled(&wind, &grid).unwrap();
        // Without a mean of its own the box still adds up: the planes' mean is put on top by hand.
        let still = MeanProfile::Uniform { speed: 10.0 };
        let mut planes = BoxPlanes::new(Arc::new(turbulence), &still, grid.first[1]).unwrap();
        assert!((planes.grid().interval - grid.interval).abs() < 1e-12);
        let mut values = vec![[0.0; 3]; 12];
        for step in 0..grid.n_steps {
            planes.read(step, &mut values).unwrap();
            for (point, [u, v, w]) in values.iter().enumerate() {
                let (y, z) = (point % 3, point / 3);
                let place = Vector3::new(0.0, -20.0 + 20.0 * y as f64, 40.0 + 25.0 * z as f64);
                let expected = wind.wind(0.5 * step as f64, place);
                let u = f64::from(*u) - 10.0 + mean_speeds[z];
                assert!((u - expected.x).abs() < 1e-5, "{step}: {u} {expected}");
                assert!((f64::from(*v) - expected.y).abs() < 1e-5 && *w == 0.0);
            }
        }
        let none = PlaneGrid { n_steps: 0, ..grid };
        assert!(matches!(sampled(&wind, &none), Err(InflowError::Setting { .. })));
    }
}
