//! The wind that enters, sampled every few steps and interpolated in between.

use super::ends::RowEnds;
use super::layout::Layout;
use super::scaling::Scaling;
use crate::Inflow;
use basis::Vector3;
use std::ops::Range;

/// Steps between two times at which the inflow is sampled: wind crosses half a cell in them, so nothing that
/// the grid resolves is lost.
const STRIDE: u64 = 4;

/// One thread's part of the inlet.
pub(crate) struct Inlet {
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    /// Lattice velocities at the two times around the present step.
    around: [[Vec<f32>; 3]; 2],
    /// Interval of `STRIDE` steps that `around` belongs to.
    interval: Option<u64>,
}

impl Inlet {
    /// The inlet of `rows`.
    pub(crate) fn new(layout: &Layout, scaling: &Scaling, rows: Range<usize>) -> Self {
        let positions: Vec<_> = rows
            .map(|row| {
                let [y, z] = layout.place(row);
                scaling.to_si_position(Vector3::new(-1.0, y as f64, z as f64))
            })
            .collect();
        let plane = || std::array::from_fn(|_| vec![0.0; positions.len()]);
        Self {
            velocities: vec![Vector3::ZERO; positions.len()],
            around: [plane(), plane()],
            interval: None,
            positions,
        }
    }

    /// Asks the inflow anew at the next step, whichever that is.
    pub(crate) fn forget(&mut self) {
        self.interval = None;
    }

    /// On return the inlet of `ends` holds the wind at step number `step`.
    pub(crate) fn update(
        &mut self,
        step: u64,
        inflow: &dyn Inflow,
        scaling: &Scaling,
        ends: &mut RowEnds,
    ) {
        let RowEnds::Open { inlet, .. } = ends else { return };
        let interval = step / STRIDE;
        if self.interval != Some(interval) {
            if interval > 0 && self.interval == Some(interval - 1) {
                self.around.swap(0, 1);
            } else {
                self.ask(interval * STRIDE, inflow, scaling, 0);
            }
            self.ask((interval + 1) * STRIDE, inflow, scaling, 1);
            self.interval = Some(interval);
        }
        let weight = (step % STRIDE) as f32 / STRIDE as f32;
        let [before, after] = &self.around;
        for ((column, before), after) in inlet.iter_mut().zip(before).zip(after) {
            for ((value, before), after) in column.iter_mut().zip(before).zip(after) {
                *value = before + weight * (after - before);
            }
        }
    }

    fn ask(&mut self, step: u64, inflow: &dyn Inflow, scaling: &Scaling, which: usize) {
        inflow.sample(step as f64 * scaling.interval(), &self.positions, &mut self.velocities);
        let [x, y, z] = &mut self.around[which];
        for (index, velocity) in self.velocities.iter().enumerate() {
            let velocity = scaling.to_lattice_velocity(*velocity);
            (x[index], y[index], z[index]) =
                (velocity.x as f32, velocity.y as f32, velocity.z as f32);
        }
    }
}
