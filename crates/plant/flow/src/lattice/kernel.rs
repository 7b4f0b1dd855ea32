//! The compiled loops: one entry per velocity set and instruction set, picked once when a lattice is built.

use super::atmosphere::law::Stratified;
use super::atmosphere::stratification::HeatShare;
use super::atmosphere::transport::{self, Transport};
use super::eddies::{self, Mixing, Noted};
use super::forces::ForceBlock;
use super::probe::{self, RowState, View};
use super::settings::Stencil as Set;
use super::stencil::{D3Q19, Stencil};
use super::stencil27::D3Q27;
use super::still::Still;
use super::sweep::{self, Share, Step};
use crate::simd::{Backend, Portable};
use std::ops::Range;

/// Loops for one velocity set, compiled for one instruction set.
#[derive(Clone, Copy)]
pub(crate) struct Kernel {
    /// Directions of the populations.
    pub(crate) directions: &'static [[i8; 3]],
    sweep: unsafe fn(&Step<'_>, &[ForceBlock], &mut Share),
    sweep_noted: SweepNoted,
    sweep_stratified: SweepStratified,
    mix: unsafe fn(&Mixing<'_>, Range<usize>),
    carry: unsafe fn(&Transport<'_>, Range<usize>, &mut HeatShare),
    read_row: unsafe fn(&View<'_>, usize, &mut RowState),
    read_cells: ReadCells,
    write_row: unsafe fn(&View<'_>, usize, &RowState),
}

type SweepNoted = unsafe fn(&Step<'_>, &Noted<'_>, &[ForceBlock], &mut Share);

type SweepStratified = unsafe fn(&Step<'_>, &Stratified<'_>, &[ForceBlock], &mut Share);

type ReadCells = unsafe fn(&View<'_>, &[[usize; 3]; 8]) -> [[f32; 8]; 4];

macro_rules! kernel {
    ($vector:ty, $stencil:ty, $n:literal $(, $features:literal)?) => {{
        $(#[target_feature(enable = $features)])?
        unsafe fn sweep(step: &Step<'_>, blocks: &[ForceBlock], share: &mut Share) {
            // SAFETY: handed through.
            unsafe { sweep::rows::<$vector, $stencil, $n, Still>(step, &Still, blocks, share) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn sweep_noted(
            step: &Step<'_>,
            air: &Noted<'_>,
            blocks: &[ForceBlock],
            share: &mut Share,
        ) {
            // SAFETY: handed through.
            unsafe { sweep::rows::<$vector, $stencil, $n, Noted<'_>>(step, air, blocks, share) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn mix(pass: &Mixing<'_>, rows: Range<usize>) {
            // SAFETY: handed through.
            unsafe { eddies::rows::<$vector>(pass, rows) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn sweep_stratified(
            step: &Step<'_>,
            air: &Stratified<'_>,
            blocks: &[ForceBlock],
            share: &mut Share,
        ) {
            // SAFETY: handed through.
            unsafe { sweep::rows::<$vector, $stencil, $n, Stratified<'_>>(step, air, blocks, share) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn carry(step: &Transport<'_>, rows: Range<usize>, heat: &mut HeatShare) {
            // SAFETY: handed through.
            unsafe { transport::rows::<$vector>(step, rows, heat) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn read_row(view: &View<'_>, row: usize, state: &mut RowState) {
            // SAFETY: handed through.
            unsafe { probe::read_row::<$vector, $stencil, $n>(view, row, state) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn read_cells(view: &View<'_>, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 4] {
            // SAFETY: handed through.
            unsafe { probe::read_cells::<$vector, $stencil, $n>(view, cells) }
        }
        $(#[target_feature(enable = $features)])?
        unsafe fn write_row(view: &View<'_>, row: usize, state: &RowState) {
            // SAFETY: handed through.
            unsafe { probe::write_row::<$vector, $stencil, $n>(view, row, state) }
        }
        let directions = &<$stencil as Stencil<$n>>::DIRECTIONS;
        Kernel {
            directions,
            sweep,
            sweep_noted,
            sweep_stratified,
            mix,
            carry,
            read_row,
            read_cells,
            write_row,
        }
    }};
}

impl Kernel {
    /// The loops for `set` on `backend`, whose instructions the caller has found on this machine.
    pub(crate) fn new(set: Set, backend: Backend) -> Self {
        match (set, backend) {
            #[cfg(target_arch = "x86_64")]
            (Set::D3Q19, Backend::Avx512) => kernel!(crate::simd::Avx512, D3Q19, 19, "avx512f,fma"),
            #[cfg(target_arch = "x86_64")]
            (Set::D3Q19, Backend::Avx2) => kernel!(crate::simd::Avx2, D3Q19, 19, "avx2,fma"),
            #[cfg(target_arch = "x86_64")]
            (Set::D3Q27, Backend::Avx512) => {
                kernel!(crate::simd::Avx512, D3Q27, 27, "avx512f,fma")
            }
            #[cfg(target_arch = "x86_64")]
            (Set::D3Q27, Backend::Avx2) => kernel!(crate::simd::Avx2, D3Q27, 27, "avx2,fma"),
            (Set::D3Q19, _) => kernel!(Portable, D3Q19, 19),
            (Set::D3Q27, _) => kernel!(Portable, D3Q27, 27),
        }
    }

    /// Moves the rows of `share` on by a step, under the force densities of `blocks`.
    pub(crate) fn sweep(&self, step: &Step<'_>, blocks: &[ForceBlock], share: &mut Share) {
        // SAFETY: shares of one step have disjoint rows, and the back-end was checked.
        unsafe { (self.sweep)(step, blocks, share) }
    }

    /// The same in air whose cells tell their wind.
    pub(crate) fn sweep_noted(
        &self,
        step: &Step<'_>,
        air: &Noted<'_>,
        blocks: &[ForceBlock],
        share: &mut Share,
    ) {
        // SAFETY: as above.
        unsafe { (self.sweep_noted)(step, air, blocks, share) }
    }

    /// Finds the viscosity of eddies on `rows` after a sweep that is done on all rows.
    pub(crate) fn mix(&self, pass: &Mixing<'_>, rows: Range<usize>) {
        // SAFETY: rows of one step are disjoint, and the back-end was checked.
        unsafe { (self.mix)(pass, rows) }
    }

    /// The same in an atmosphere, which notes the wind of the step.
    pub(crate) fn sweep_stratified(
        &self,
        step: &Step<'_>,
        air: &Stratified<'_>,
        blocks: &[ForceBlock],
        share: &mut Share,
    ) {
        // SAFETY: as above.
        unsafe { (self.sweep_stratified)(step, air, blocks, share) }
    }

    /// Carries the temperatures of `rows` over a step whose sweep is done on all rows.
    pub(crate) fn carry(&self, step: &Transport<'_>, rows: Range<usize>, heat: &mut HeatShare) {
        // SAFETY: rows of one step are disjoint, and the back-end was checked.
        unsafe { (self.carry)(step, rows, heat) }
    }

    /// Density and velocity of row number `row`.
    pub(crate) fn read_row(&self, view: &View<'_>, row: usize, state: &mut RowState) {
        // SAFETY: a view exists between steps only, and the back-end was checked.
        unsafe { (self.read_row)(view, row, state) }
    }

    /// Density less one and velocity components of eight cells of the grid.
    pub(crate) fn read_cells(&self, view: &View<'_>, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 4] {
        // SAFETY: as above; callers clamp the cells to the grid.
        unsafe { (self.read_cells)(view, cells) }
    }

    /// Gives row number `row` the populations of `state` in equilibrium.
    pub(crate) fn write_row(&self, view: &View<'_>, row: usize, state: &RowState) {
        // SAFETY: as above; a row is written by one thread.
        unsafe { (self.write_row)(view, row, state) }
    }
}
