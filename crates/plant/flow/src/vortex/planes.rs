//! Slices and volumes of the wind at an instant.

use super::field::CHUNK;
use super::settings::Points;
use super::wake::FreeWake;
use crate::WindField;
use crate::fields::{FieldSource, Volume};
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};
use std::sync::PoisonError;

impl FieldSource for FreeWake {
    fn plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane {
        let Points { first, spacing, n } = self.settings.shown;
        let [normal, along, up] = axes_of(axes);
        let mut origin = first.to_array();
        origin[normal] = position;
        let n_points = [n[along], n[up]];
        let mut plane = Plane {
            name: name.to_owned(),
            axes,
            origin,
            spacing: [spacing; 2],
            n_points,
            time: 0.0,
            averaged: 0.0,
            velocity: std::array::from_fn(|_| vec![0.0; n_points[0] * n_points[1]]),
        };
        self.refresh(&mut plane);
        plane
    }

    fn refresh(&self, plane: &mut Plane) {
        plane.time = self.time();
        let [_, along, up] = axes_of(plane.axes);
        let (origin, n) = (Vector3::from_array(plane.origin), plane.n_points[0]);
        let spacing = plane.spacing;
        let place = |index: usize| {
            let mut place = origin;
            place[along] += (index % n) as f64 * spacing[0];
            place[up] += (index / n) as f64 * spacing[1];
            place
        };
        self.show(&place, &mut plane.velocity);
    }

    fn volume(&self, stride: usize) -> Volume {
        let Points { first, spacing, n } = self.settings.shown;
        let spacing = spacing * stride.max(1) as f64;
        let n_points = n.map(|n| n.div_ceil(stride.max(1)));
        let [n_x, n_y, _] = n_points;
        let place = |index: usize| {
            let steps = [index % n_x, index / n_x % n_y, index / (n_x * n_y)];
            first + spacing * Vector3::from_array(steps.map(|k| k as f64))
        };
        let mut velocity = std::array::from_fn(|_| vec![0.0; n_points.iter().product()]);
        self.show(&place, &mut velocity);
        Volume { origin: first, spacing, n_points, time: self.time(), velocity, pressure: None }
    }
}

impl FreeWake {
    /// On return `velocity` holds the components of the wind at each `place` (m).
    fn show(&self, place: &(dyn Fn(usize) -> Vector3 + Sync), velocity: &mut [Vec<f32>; 3]) {
        let mut room = self.room.lock().unwrap_or_else(PoisonError::into_inner);
        room.resize(velocity[0].len(), Vector3::ZERO);
        self.pool().for_chunks(&mut room, CHUNK, &|first, chunk| {
            let mut places = [Vector3::ZERO; CHUNK];
            for (k, position) in places[..chunk.len()].iter_mut().enumerate() {
                *position = place(first + k);
            }
            self.sample(&places[..chunk.len()], chunk);
        });
        for (axis, values) in velocity.iter_mut().enumerate() {
            for (value, wind) in values.iter_mut().zip(room.iter()) {
                *value = wind[axis] as f32;
            }
        }
    }
}

/// Axis across a plane, and those along its rows and from row to row.
fn axes_of(axes: PlaneAxes) -> [usize; 3] {
    match axes {
        PlaneAxes::Crosswind => [0, 1, 2],
        PlaneAxes::Streamwise => [1, 0, 2],
        PlaneAxes::Horizontal => [2, 0, 1],
    }
}
