//! Steps of grids within grids: a box makes two in one of the grid around it.
//!
//! All are counted in steps of the finest cells. `n_steps` of them were made since the start, and `span` make
//! one of a grid, which is made as a whole when its time begins.

use super::{Grid, exchange};
use crate::FlowError;
use basis::{PointForce, Vector3};
use std::io::{Read, Result as IoResult, Write};

impl Grid {
    /// Boxes within one another in it, at most (–).
    pub(super) fn depth(&self) -> u32 {
        self.boxes.iter().map(|one| 1 + one.grid.depth()).max().unwrap_or(0)
    }

    /// Takes `forces`, each for the finest grid that holds its position: they act from the next step on that
    /// this grid begins.
    pub(super) fn take(&mut self, forces: &[PointForce]) {
        self.forces.clear();
        self.boxes.iter_mut().for_each(|one| one.forces.clear());
        for force in forces {
            let cell = (self.lattice.scaling().to_lattice_position(force.position)
                + Vector3::splat(0.5))
            .to_array();
            let held = cell.iter().all(|place| *place >= 0.0);
            let cell = cell.map(|place| place as usize);
            match self.boxes.iter_mut().find(|one| held && one.covered.contains(cell)) {
                Some(one) => one.forces.push(*force),
                None => self.forces.push(*force),
            }
        }
        for one in &mut self.boxes {
            one.grid.take(&one.forces);
        }
    }

    /// Moves on by a step of the finest cells.
    pub(super) fn advance(&mut self, n_steps: u64, span: u64) {
        if n_steps.is_multiple_of(span) {
            self.begin();
        }
        for one in &mut self.boxes {
            let short = span / 2;
            let step = (n_steps % span / short) as usize;
            if n_steps.is_multiple_of(short)
                && let Some(heat) = &mut one.heat
            {
                heat.surround(&mut self.lattice, &mut one.grid.lattice, step);
            }
            one.grid.advance(n_steps, short);
            if n_steps.is_multiple_of(short)
                && let Some(heat) = &mut one.heat
            {
                // What its step has found is no part of its state, and the steps of boxes in it may follow
                // after a pause.
                heat.cross(&mut one.grid.lattice);
            }
            if (n_steps + 1).is_multiple_of(short) {
                one.coupling.cross(exchange(&mut one.grid.lattice), step);
            }
        }
        if (n_steps + 1).is_multiple_of(span) {
            self.end();
        }
    }

    /// Makes a step of its own, before those of the boxes.
    fn begin(&mut self) {
        let made = self.lattice.n_steps();
        let around = exchange(&mut self.lattice);
        self.boxes.iter_mut().for_each(|one| one.coupling.keep(around, made));
        self.boxes.iter_mut().filter_map(|one| one.heat.as_mut()).for_each(|heat| {
            heat.keep(&mut self.lattice);
        });
        self.lattice.hold(&self.forces);
        self.lattice.step();
        let around = exchange(&mut self.lattice);
        self.boxes.iter_mut().for_each(|one| one.coupling.take(around, made + 1));
        self.boxes.iter_mut().for_each(|one| one.coupling.lend(around, made + 1));
        self.boxes.iter_mut().filter_map(|one| one.heat.as_mut()).for_each(|heat| {
            heat.take(&mut self.lattice);
        });
    }

    /// Takes up what the boxes have made of its step.
    fn end(&mut self) {
        let made = self.lattice.n_steps();
        let around = exchange(&mut self.lattice);
        self.boxes.iter_mut().for_each(|one| one.coupling.give(around, made));
        for one in &mut self.boxes {
            if let Some(heat) = &mut one.heat {
                heat.give(&mut self.lattice, &one.grid.lattice);
            }
        }
    }

    /// Looks at part of each grid that has just made a step.
    pub(super) fn watch(&mut self, n_steps: u64, span: u64) -> Result<(), FlowError> {
        if n_steps.is_multiple_of(span) {
            self.lattice.watch()?;
        }
        self.boxes.iter_mut().try_for_each(|one| one.grid.watch(n_steps, span / 2))
    }

    /// Whether each grid has made the steps that it should have.
    pub(super) fn in_step(&self, n_steps: u64, span: u64) -> bool {
        self.lattice.n_steps() == n_steps.div_ceil(span)
            && self.boxes.iter().all(|one| one.grid.in_step(n_steps, span / 2))
    }

    pub(super) fn write_state(&mut self, writer: &mut dyn Write) -> IoResult<()> {
        self.lattice.write_state(writer)?;
        self.boxes.iter_mut().try_for_each(|one| {
            one.coupling.write_state(writer)?;
            one.heat.as_ref().map_or(Ok(()), |heat| heat.write_state(writer))?;
            one.grid.write_state(writer)
        })
    }

    pub(super) fn read_state(&mut self, reader: &mut dyn Read) -> IoResult<()> {
        self.lattice.read_state(reader)?;
        self.boxes.iter_mut().try_for_each(|one| {
            one.coupling.read_state(reader)?;
            one.heat.as_mut().map_or(Ok(()), |heat| heat.read_state(reader))?;
            one.grid.read_state(reader)
        })
    }
}
