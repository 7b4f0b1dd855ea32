//! The wind beyond open sides: what the inflow has there, and what the air that leaves has left behind.
//!
//! Whether air enters a row through its side is decided for the row as a whole, by the mean along it of the
//! inflow's wind: a gust that turns the wind of a place for a moment turns nothing else. Where that mean
//! grazes the side, the row is let in and out in part, so that nothing jumps when it turns.

use super::layout::Layout;
use super::scaling::Scaling;
use super::times::{Times, weight};
use super::values::{read_values, write_values};
use crate::Inflow;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;
use std::io::{Read, Result, Write};
use std::ops::Range;

/// Mean wind through a side, over that past it, from which on it enters wholly (–): 0.6°.
const WHOLLY: f32 = 0.01;

/// The rows beyond open sides that border on one thread's rows, in lattice units.
///
/// Columns hold each row's cells, padded to whole vectors, then those beyond its corners: upstream and
/// downstream.
pub(crate) struct OpenSides {
    n_cells: usize,
    /// Values from a row to the next.
    stride: usize,
    /// Number of the first row among all at sides.
    first: usize,
    rows: Vec<SideRow>,
    /// Wind of the inflow at the two times around the present step.
    around: [[Vec<f32>; 3]; 2],
    /// Mean of it along each row: along x, and through the side into the box.
    means: [Vec<[f32; 2]>; 2],
    /// Temperature likewise, in an atmosphere.
    heat: Option<SideHeat>,
    /// Density less one.
    excess: Vec<f32>,
    /// How far the inflow entered in the last step, cell by cell, and the wind along y there.
    entered: Vec<f32>,
    across: Vec<f32>,
    times: Times,
    /// Weight of the later of the two times in the present step (–).
    weight: f32,
    /// Room for a row.
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    temperatures: Vec<f64>,
}

/// A row beyond a side.
#[derive(Clone, Copy)]
struct SideRow {
    /// y and z of the row of the box beside it.
    place: [usize; 2],
    /// Sense of y out of the box: 1 or −1.
    outward: i8,
}

/// Temperature beyond the sides.
struct SideHeat {
    /// Temperature that departures count from (K).
    reference: f64,
    /// Departures at the two times around the present step (K), cell by cell.
    around: [Vec<f32>; 2],
    /// Whether the inflow tells its temperature.
    told: bool,
}

/// A row beyond a side, as the step finds it.
pub(crate) struct Beside {
    /// Wind of the inflow at the two times around the step.
    pub(crate) around: [[*const f32; 3]; 2],
    /// Weight of the later one (–).
    pub(crate) weight: f32,
    /// Density less one.
    pub(crate) excess: *mut f32,
    /// How far the inflow entered last, and the wind along y there.
    pub(crate) entered: *mut f32,
    pub(crate) across: *mut f32,
    /// How far the inflow enters there: 1 where it does, 0 where air leaves.
    pub(crate) share: f32,
    /// Sense of y out of the box: 1 or −1.
    pub(crate) outward: i8,
    /// Where what lies beyond its corners is found.
    pub(crate) corners: usize,
}

impl OpenSides {
    /// What lies beyond the sides at `rows`; in an atmosphere temperature counts from `reference` (K).
    pub(crate) fn new(layout: &Layout, rows: &Range<usize>, reference: Option<f64>) -> Self {
        let [n_cells, n_y, _] = layout.n_cells;
        let stride = n_cells.next_multiple_of(MAXIMUM_LANES) + MAXIMUM_LANES;
        let at_side = |row: usize| {
            let place = layout.place(row);
            match place[0] {
                0 => Some(SideRow { place, outward: -1 }),
                y if y + 1 == n_y => Some(SideRow { place, outward: 1 }),
                _ => None,
            }
        };
        let [y, z] = layout.place(rows.start);
        let rows: Vec<SideRow> = rows.clone().filter_map(at_side).collect();
        let column = || vec![0.0; stride * rows.len()];
        let plane = || [column(), column(), column()];
        let heat = reference.map(|reference| SideHeat {
            reference,
            around: [column(), column()],
            told: false,
        });
        Self {
            n_cells,
            stride,
            first: 2 * z + usize::from(y > 0),
            around: [plane(), plane()],
            means: [vec![[0.0; 2]; rows.len()], vec![[0.0; 2]; rows.len()]],
            heat,
            excess: column(),
            entered: column(),
            across: column(),
            times: Times::before_all(),
            weight: 0.0,
            positions: vec![Vector3::ZERO; n_cells + 2],
            velocities: vec![Vector3::ZERO; n_cells + 2],
            temperatures: vec![0.0; n_cells + 2],
            rows,
        }
    }

    /// On return the air beyond the sides is undisturbed, with the wind of `inflow` at time zero.
    pub(crate) fn start(&mut self, inflow: &dyn Inflow, scaling: &Scaling) {
        self.times = Times::before_all();
        self.ask(0, inflow, scaling, 1);
        self.excess.fill(0.0);
        self.across.copy_from_slice(&self.around[1][1]);
        for number in 0..self.rows.len() {
            let share = self.share(number);
            self.entered[number * self.stride..][..self.n_cells].fill(share);
        }
    }

    /// On return they hold the wind of `inflow` at step number `step`.
    pub(crate) fn update(&mut self, step: u64, inflow: &dyn Inflow, scaling: &Scaling) {
        if let Some(later) = self.times.turn(step) {
            self.around.swap(0, 1);
            self.means.swap(0, 1);
            if let Some(heat) = &mut self.heat {
                heat.around.swap(0, 1);
            }
            self.ask(later, inflow, scaling, 1);
        }
        self.weight = weight(step);
    }

    fn ask(&mut self, step: u64, inflow: &dyn Inflow, scaling: &Scaling, which: usize) {
        let time = step as f64 * scaling.interval();
        let n = self.n_cells;
        let corners = self.corners();
        for number in 0..self.rows.len() {
            let SideRow { place: [y, z], outward } = self.rows[number];
            let y = y as f64 + f64::from(outward);
            let along = (0..n).map(|x| x as f64).chain([-1.0, n as f64]);
            for (position, x) in self.positions.iter_mut().zip(along) {
                *position = scaling.to_si_position(Vector3::new(x, y, z as f64));
            }
            inflow.sample(time, &self.positions, &mut self.velocities);
            let start = number * self.stride;
            let mut sums = [0.0; 2];
            for (index, velocity) in self.velocities.iter().enumerate() {
                let velocity = scaling.to_lattice_velocity(*velocity).as_vec3().to_array();
                let place = start + if index < n { index } else { corners + index - n };
                for (column, value) in self.around[which].iter_mut().zip(velocity) {
                    column[place] = value;
                }
                if index < n {
                    sums[0] += velocity[0];
                    sums[1] -= f32::from(outward) * velocity[1];
                }
            }
            self.means[which][number] = sums.map(|sum| sum / n as f32);
            let Some(heat) = &mut self.heat else { continue };
            heat.told = inflow.sample_temperature(time, &self.positions, &mut self.temperatures);
            if !heat.told {
                self.temperatures.fill(f64::NAN);
            }
            let departures = heat.around[which][start..start + n].iter_mut();
            for (departure, temperature) in departures.zip(&self.temperatures) {
                *departure = (temperature - heat.reference) as f32;
            }
        }
    }

    /// Where in a row what lies beyond its corners is found.
    fn corners(&self) -> usize {
        self.stride - MAXIMUM_LANES
    }

    /// How far the inflow enters through row number `number` of these.
    fn share(&self, number: usize) -> f32 {
        let [before, after] = [0, 1].map(|which| self.means[which][number]);
        let [along, inward] =
            [0, 1].map(|axis| before[axis] + self.weight * (after[axis] - before[axis]));
        match inward > 0.0 {
            true => (inward / (WHOLLY * along.hypot(inward))).min(1.0),
            false => 0.0,
        }
    }

    /// What lies beyond the side at row (`y`, `z`), which is a row of this thread; none inside the box.
    pub(crate) fn beside(&mut self, [y, z]: [usize; 2]) -> Option<Beside> {
        let number = (2 * z + usize::from(y > 0)).checked_sub(self.first)?;
        let row = self.rows.get(number).filter(|row| row.place == [y, z])?;
        let start = number * self.stride;
        Some(Beside {
            around: self
                .around
                .each_ref()
                .map(|wind| wind.each_ref().map(|column| column[start..].as_ptr())),
            weight: self.weight,
            share: self.share(number),
            outward: row.outward,
            corners: self.corners(),
            excess: self.excess[start..].as_mut_ptr(),
            entered: self.entered[start..].as_mut_ptr(),
            across: self.across[start..].as_mut_ptr(),
        })
    }

    /// Rows of the box that these border on (y and z); how far the inflow entered there in the last step,
    /// cell by cell, and the wind along y; and the inflow's temperatures in the present step as departures
    /// (K), where it tells them.
    pub(crate) fn temperatures(
        &self,
    ) -> impl Iterator<Item = ([usize; 2], [&[f32]; 2], Option<impl Iterator<Item = f32>>)> {
        let weight = self.weight;
        self.rows.iter().enumerate().map(move |(number, row)| {
            let cells = number * self.stride..number * self.stride + self.n_cells;
            let told = self.heat.as_ref().filter(|heat| heat.told).map(|heat| {
                let [before, after] =
                    heat.around.each_ref().map(|column| column[cells.clone()].iter());
                before.zip(after).map(move |(before, after)| before + weight * (after - before))
            });
            let last = [&self.entered, &self.across].map(|column| &column[cells.clone()]);
            (row.place, last, told)
        })
    }

    /// Writes what time has changed, row by row.
    pub(crate) fn write(&self, writer: &mut dyn Write, bytes: &mut Vec<u8>) -> Result<()> {
        let warm = self.heat.iter().flat_map(|heat| &heat.around);
        let wind = || self.around.iter().flatten().chain(warm.clone());
        let columns = || [&self.excess, &self.entered, &self.across].into_iter().chain(wind());
        (0..self.rows.len()).try_for_each(|number| {
            for column in columns() {
                for range in self.kept(number) {
                    write_values(writer, bytes, &column[range])?;
                }
            }
            self.means.iter().try_for_each(|means| write_values(writer, bytes, &means[number]))
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
        for number in 0..self.rows.len() {
            let kept = self.kept(number);
            let warm = self.heat.iter_mut().flat_map(|heat| &mut heat.around);
            let wind = self.around.iter_mut().flatten().chain(warm);
            let last = [&mut self.excess, &mut self.entered, &mut self.across];
            for column in last.into_iter().chain(wind) {
                for range in kept.clone() {
                    read_values(reader, bytes, &mut column[range])?;
                }
            }
            for means in &mut self.means {
                read_values(reader, bytes, &mut means[number])?;
            }
        }
        let stride = self.stride;
        if let (Some(heat), false) = (&mut self.heat, self.rows.is_empty()) {
            heat.told = !heat.around[1][..stride][0].is_nan();
        }
        Ok(())
    }

    /// Values of row number `number` that outlast a step: its cells, and those beyond its corners.
    fn kept(&self, number: usize) -> [Range<usize>; 2] {
        let start = number * self.stride;
        let corners = start + self.corners();
        [start..start + self.n_cells, corners..corners + 2]
    }

    /// Memory that they hold (bytes).
    pub(crate) fn bytes(&self) -> usize {
        let n_columns = 7 + if self.heat.is_some() { 2 } else { 0 };
        let room = 2 * size_of::<Vector3>() + size_of::<f64>();
        n_columns * self.rows.len() * self.stride * size_of::<f32>()
            + self.rows.len() * (size_of::<SideRow>() + 2 * size_of::<[f32; 2]>())
            + (self.n_cells + 2) * room
    }
}
