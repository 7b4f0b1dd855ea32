//! Temperature on its way from grid to grid, for whoever exchanges it between two steps.

use super::links::Fill;
use std::ops::Range;

/// A quantity of every cell, in lattice units but for kelvin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heat {
    /// Departure of the temperature from the reference before the last step (K).
    Before,
    /// The same now (K).
    Now,
    /// Wind along an axis in the last step (cells a step), half-way through its forces.
    Wind(usize),
}

/// Which of the two cells at a face lies in the air around, where values are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// Neither.
    Neither,
    /// The one before the face.
    Before,
    /// The one behind it.
    Behind,
}

/// A face between two cells.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Place of the third cell before it.
    pub first: usize,
    /// Axis that leads through it: 0, 1, 2.
    pub axis: u8,
    /// Which of its cells lies in the air around.
    pub given: Given,
    /// Number among those asked with of the temperature that the flux counts from.
    pub base: u32,
}

/// An engine whose temperature can be exchanged between two steps.
///
/// Three cells beyond each end that is joined to a grid around are places, too: there temperature, and in
/// the first of them the wind through the end, are what others write before each step.
pub trait HeatExchange {
    /// Where a quantity of `cell` lies; numbers below zero and beyond the last lie in the air around.
    fn place(&self, cell: [isize; 3]) -> usize;

    /// On return `values` holds `what` at `places`, one each.
    ///
    /// # Panics
    /// When a place is none of this engine's.
    fn read(&mut self, what: Heat, places: &[usize], values: &mut [f32]);

    /// On return `what` at `places` is what `fill` gives, as for [`Exchange`](super::Exchange::write).
    ///
    /// # Panics
    /// When a place is none of this engine's.
    fn write(&mut self, what: Heat, places: &[usize], fill: &Fill<'_>);

    /// On return `fluxes` holds the flux through each of `faces` along its axis in the last step, above the
    /// temperatures that they name in `bases` (cells a step times K), as the step has found it.
    fn fluxes(&mut self, faces: &[Face], bases: &[f32], fluxes: &mut [f32]);

    /// On return the temperature of the cells from `low` to before `high` is what `fill` gives.
    fn cover(&mut self, low: [usize; 3], high: [usize; 3], fill: &RowFill<'_>);

    /// Takes note that temperatures on `levels` were changed since the last step.
    fn settle(&mut self, levels: Range<usize>);

    /// On return `means` holds the temperature of each level that buoyancy starts from, and `bases` that
    /// which fluxes count from (K above the reference).
    fn levels(&self, means: &mut [f32], bases: &mut [f32]);

    /// The same of what damping goes to.
    fn targets(&self) -> Vec<f32>;

    /// From now on buoyancy on each level starts from that of `means`, and fluxes count from that of `bases`
    /// (K above the reference).
    fn refer(&mut self, means: &[f32], bases: &[f32]);
}

/// Gives part of a row, named by y and z, from its first cell in question on, whichever thread asks.
pub type RowFill<'a> = dyn Fn([usize; 2], &mut [f32]) + Sync + 'a;
