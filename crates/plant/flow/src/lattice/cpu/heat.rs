//! Temperature of the engine on the processor, for whoever exchanges it.

use super::Cpu;
use super::exchange::{Values, fill_up, gather, scatter, share};
use crate::lattice::atmosphere::stratification::Stratification;
use crate::lattice::atmosphere::transport::face_fluxes;
use crate::lattice::fields::{Field, Fields};
use crate::lattice::heat_links::{Face, Heat, HeatExchange, RowFill};
use crate::lattice::links::Fill;
use std::ops::Range;

/// The air with temperature. An engine without it calls itself no exchange of heat.
fn warm(air: &Option<Stratification>) -> &Stratification {
    air.as_ref().expect("air with temperature")
}

/// Where `what` lies after `n_steps` steps.
fn field(what: Heat, n_steps: u64) -> Field {
    match what {
        Heat::Before => Fields::temperature(n_steps + 1),
        Heat::Now => Fields::temperature(n_steps),
        Heat::Wind(axis) => Field::Wind(axis),
    }
}

impl HeatExchange for Cpu {
    fn place(&self, cell: [isize; 3]) -> usize {
        warm(&self.stratification).fields().place(cell)
    }

    fn read(&mut self, what: Heat, places: &[usize], values: &mut [f32]) {
        let fields = warm(&self.stratification).fields();
        let all = &fields.values()[fields.start(field(what, self.n_steps))..];
        gather(&mut self.pool, all, places, values);
    }

    fn write(&mut self, what: Heat, places: &[usize], fill: &Fill<'_>) {
        let Some(air) = &mut self.stratification else { return };
        let start = air.fields().start(field(what, self.n_steps));
        let (first, n_values) = air.fields_mut().all();
        let all = (first.wrapping_add(start), n_values - start);
        scatter(&mut self.pool, all, places, fill);
    }

    fn fluxes(&mut self, faces: &[Face], bases: &[f32], fluxes: &mut [f32]) {
        let fields = warm(&self.stratification).fields();
        let temperature = field(Heat::Before, self.n_steps);
        fill_up(&mut self.pool, fluxes, &|first, fluxes| {
            face_fluxes(fields, temperature, &faces[first..], bases, fluxes);
        });
    }

    fn cover(&mut self, low: [usize; 3], high: [usize; 3], fill: &RowFill<'_>) {
        let n_rows = high[1] - low[1];
        let fields = warm(&self.stratification).fields();
        let temperature = field(Heat::Now, self.n_steps);
        let n_threads = self.pool.n_threads();
        self.pool.run(&|thread| {
            for row in share(n_rows * (high[2] - low[2]), thread, n_threads) {
                let [y, z] = [low[1] + row % n_rows, low[2] + row / n_rows];
                let row = Values(fields.row(temperature, y, z));
                // SAFETY: cells of a row that only this thread touches now.
                fill([y, z], unsafe { row.part(low[0]..high[0]) });
            }
        });
    }

    fn settle(&mut self, levels: Range<usize>) {
        let Some(air) = &mut self.stratification else { return };
        let n_y = self.layout.n_cells[1];
        let rows = levels.start * n_y..levels.end * n_y;
        let mut sums = std::mem::take(&mut air.sums);
        let (settled, n_steps) = (&*air, self.n_steps);
        fill_up(&mut self.pool, &mut sums[rows.clone()], &|first, sums| {
            for (row, sum) in (rows.start + first..).zip(sums) {
                *sum = settled.settle(n_steps, row);
            }
        });
        air.sums = sums;
        air.follow(levels);
    }

    fn levels(&self, means: &mut [f32], bases: &mut [f32]) {
        let levels = means.iter_mut().zip(bases).zip(&warm(&self.stratification).levels);
        for ((mean, base), level) in levels {
            (*mean, *base) = (level.mean, level.base);
        }
    }

    fn targets(&self) -> Vec<f32> {
        warm(&self.stratification).levels.iter().map(|level| level.target).collect()
    }

    fn refer(&mut self, means: &[f32], bases: &[f32]) {
        let Some(air) = &mut self.stratification else { return };
        for (level, (mean, base)) in air.levels.iter_mut().zip(means.iter().zip(bases)) {
            (level.mean, level.base) = (*mean, *base);
        }
    }
}
