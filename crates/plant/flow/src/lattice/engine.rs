//! What holds the populations and moves them: the seam under [`Lattice`](super::Lattice).
//!
//! A lattice knows units, wind and what others ask of the air; an engine knows memory and the machine that it
//! runs on. Today's is [`Cpu`](super::cpu::Cpu). One with memory of its own, on another device, implements
//! the same few methods.

use super::atmosphere::AirRow;
use super::forces::ForceBlock;
use super::heat_links::HeatExchange;
use super::links::Exchange;
use super::probe::RowState;
use crate::Inflow;
use basis::PointForce;
use std::io::{Read, Result, Write};

/// Moves the air of a lattice, in lattice units; rows run along x and are numbered with y fastest.
pub trait Engine: Send + Sync {
    /// On return the air moves as `inflow` does at time zero, and no step is made.
    fn start(&mut self, inflow: &dyn Inflow);

    /// Holds `forces` from now on, until others are set.
    fn set_forces(&mut self, forces: &[PointForce]);

    /// The geostrophic wind that drives an atmosphere is `wind` (cells a step, x and y) from now on; false
    /// where there is none to be driven.
    fn drive(&mut self, wind: [f32; 2]) -> bool {
        let _ = wind;
        false
    }

    /// Makes a step, with the wind of `inflow` at the inlet and beyond open sides.
    fn step(&mut self, inflow: &dyn Inflow);

    /// Steps made (–).
    fn n_steps(&self) -> u64;

    /// On return `state` holds density and velocity of row number `row`, forces of this step aside.
    fn read_row(&self, row: usize, state: &mut RowState);

    /// On return `state` holds wind, temperature and subgrid fluxes of row number `row`; false where the air
    /// has no temperature.
    fn read_air(&self, row: usize, state: &mut AirRow) -> bool {
        let _ = (row, state);
        false
    }

    /// Temperatures of row number `row` (K above the atmosphere's reference); none where the air has none.
    fn temperature(&self, row: usize) -> Option<&[f32]> {
        let _ = row;
        None
    }

    /// The viscosity of eddies on row number `row` in the step to come (cells² a step), where a pass of its
    /// own finds it.
    fn eddy_viscosity(&self, row: usize) -> Option<&[f32]> {
        let _ = row;
        None
    }

    /// Density less one, and the velocity components forces aside, of eight cells (x, y, z).
    fn read_cells(&self, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 4];

    /// Hands `see` the force density on row number `row`, and perhaps on others, without what acts on every
    /// cell alike.
    fn see_forces(&self, row: usize, see: &mut dyn FnMut(&[ForceBlock]));

    /// Looks at every `stride`-th row from `first` for a cell that the lattice cannot carry on from; gives
    /// the cell and its speed.
    fn look(&mut self, first: usize, stride: usize) -> Option<([usize; 3], f32)>;

    /// Its populations for whoever exchanges them with another grid; none where they cannot be reached.
    fn exchange(&mut self) -> Option<&mut dyn Exchange> {
        None
    }

    /// Its temperature likewise; none where the air has none, or it cannot be reached.
    fn heat(&mut self) -> Option<&mut dyn HeatExchange> {
        None
    }

    /// Writes all that time has changed but the steps made and the forces.
    ///
    /// # Errors
    /// Those of `writer`.
    fn write_state(&self, writer: &mut dyn Write) -> Result<()>;

    /// Goes on after `n_steps` steps from what [`write_state`](Self::write_state) wrote.
    ///
    /// # Errors
    /// Those of `reader`; the field is undefined then.
    fn read_state(&mut self, n_steps: u64, reader: &mut dyn Read) -> Result<()>;

    /// What of the machine decides its bits, such as the instructions that it computes with: a word or two.
    fn backend(&self) -> &'static str;

    /// Threads that it runs on (–).
    fn n_threads(&self) -> usize;

    /// Memory that it holds (bytes).
    fn memory(&self) -> u64;
}

/// A field whose rows can be read between two steps.
pub(crate) trait Rows {
    /// On return `state` holds density and velocity of row number `row`, forces of this step aside.
    fn read_row(&self, row: usize, state: &mut RowState);
}
