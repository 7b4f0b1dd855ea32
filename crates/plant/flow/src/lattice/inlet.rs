//! The wind that enters, and its temperature, sampled every few steps and interpolated in between.

use super::ends::RowEnds;
use super::layout::Layout;
use super::scaling::Scaling;
use super::times::{Times, weight};
use super::values::{read_values, write_values};
use crate::Inflow;
use basis::Vector3;
use std::io::{Read, Result, Write};
use std::ops::Range;

/// One thread's part of the inlet.
pub(crate) struct Inlet {
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    /// Lattice velocities at the two times around the present step.
    around: [[Vec<f32>; 3]; 2],
    /// Temperature likewise, in an atmosphere.
    heat: Option<EnteringHeat>,
    times: Times,
}

/// Temperature of the wind that enters.
struct EnteringHeat {
    /// Temperature that departures count from (K).
    reference: f64,
    temperatures: Vec<f64>,
    /// Departures at the two times around the present step (K).
    around: [Vec<f32>; 2],
    /// Whether the inflow tells its temperature.
    told: bool,
}

impl Inlet {
    /// The inlet of `rows`; in an atmosphere temperature counts from `reference` (K).
    pub(crate) fn new(
        layout: &Layout,
        scaling: &Scaling,
        rows: Range<usize>,
        reference: Option<f64>,
    ) -> Self {
        let positions: Vec<_> = rows
            .map(|row| {
                let [y, z] = layout.place(row);
                scaling.to_si_position(Vector3::new(-1.0, y as f64, z as f64))
            })
            .collect();
        let plane = || std::array::from_fn(|_| vec![0.0; positions.len()]);
        let heat = reference.map(|reference| EnteringHeat {
            reference,
            temperatures: vec![0.0; positions.len()],
            around: [vec![0.0; positions.len()], vec![0.0; positions.len()]],
            told: false,
        });
        Self {
            heat,
            velocities: vec![Vector3::ZERO; positions.len()],
            around: [plane(), plane()],
            times: Times::before_all(),
            positions,
        }
    }

    /// On return it holds the wind of `inflow` at time zero, and no step is made.
    pub(crate) fn start(&mut self, inflow: &dyn Inflow, scaling: &Scaling) {
        self.times = Times::before_all();
        self.ask(0, inflow, scaling, 1);
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
        if let Some(later) = self.times.turn(step) {
            self.around.swap(0, 1);
            if let Some(heat) = &mut self.heat {
                heat.around.swap(0, 1);
            }
            self.ask(later, inflow, scaling, 1);
        }
        let weight = weight(step);
        let [before, after] = &self.around;
        for ((column, before), after) in inlet.iter_mut().zip(before).zip(after) {
            for ((value, before), after) in column.iter_mut().zip(before).zip(after) {
                *value = before + weight * (after - before);
            }
        }
    }

    /// Temperatures that enter at step number `step` at the rows from the first on, as departures (K); none
    /// where the inflow does not tell its own. Valid once the inlet was [updated](Self::update) to that step.
    pub(crate) fn temperatures(&self, step: u64) -> Option<impl Iterator<Item = f32> + '_> {
        let heat = self.heat.as_ref().filter(|heat| heat.told)?;
        let weight = weight(step);
        let [before, after] = &heat.around;
        Some(
            before.iter().zip(after).map(move |(before, after)| before + weight * (after - before)),
        )
    }

    /// Writes what the inflow told at the two times, row by row.
    pub(crate) fn write(&self, writer: &mut dyn Write, bytes: &mut Vec<u8>) -> Result<()> {
        (0..self.positions.len()).try_for_each(|row| {
            for wind in &self.around {
                write_values(writer, bytes, &wind.each_ref().map(|column| column[row]))?;
            }
            let Some(heat) = &self.heat else { return Ok(()) };
            write_values(writer, bytes, &heat.around.each_ref().map(|column| column[row]))
        })
    }

    /// Reads what [`write`](Self::write) wrote after `n_steps` steps.
    pub(crate) fn read(
        &mut self,
        n_steps: u64,
        reader: &mut dyn Read,
        bytes: &mut Vec<u8>,
    ) -> Result<()> {
        self.times = Times::around_last(n_steps);
        for row in 0..self.positions.len() {
            for wind in &mut self.around {
                let mut values = [0.0; 3];
                read_values(reader, bytes, &mut values)?;
                for (column, value) in wind.iter_mut().zip(values) {
                    column[row] = value;
                }
            }
            if let Some(heat) = &mut self.heat {
                let mut values = [0.0; 2];
                read_values(reader, bytes, &mut values)?;
                for (column, value) in heat.around.iter_mut().zip(values) {
                    column[row] = value;
                }
                heat.told = !values[1].is_nan();
            }
        }
        Ok(())
    }

    fn ask(&mut self, step: u64, inflow: &dyn Inflow, scaling: &Scaling, which: usize) {
        let time = step as f64 * scaling.interval();
        inflow.sample(time, &self.positions, &mut self.velocities);
        if let Some(heat) = &mut self.heat {
            heat.told = inflow.sample_temperature(time, &self.positions, &mut heat.temperatures);
            if !heat.told {
                heat.temperatures.fill(f64::NAN);
            }
            for (departure, temperature) in heat.around[which].iter_mut().zip(&heat.temperatures) {
                *departure = (temperature - heat.reference) as f32;
            }
        }
        let [x, y, z] = &mut self.around[which];
        for (index, velocity) in self.velocities.iter().enumerate() {
            let velocity = scaling.to_lattice_velocity(*velocity);
            (x[index], y[index], z[index]) =
                (velocity.x as f32, velocity.y as f32, velocity.z as f32);
        }
    }
}
