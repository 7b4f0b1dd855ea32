//! Reading density and velocity out of populations, and writing them in.

use super::layout::{Layout, Parity, read_direction};
use super::stencil::{Moments, Stencil};
use crate::simd::{MAXIMUM_LANES, Simd};

/// The air between two steps.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    /// The populations.
    pub(crate) air: *mut f32,
    pub(crate) layout: &'a Layout,
    /// Of the step to come.
    pub(crate) parity: Parity,
}

// SAFETY: threads read, or write rows of their own; see the sweep.
unsafe impl Sync for View<'_> {}

/// Density less one and velocity, forces aside, of one row of cells; padded to whole vectors.
#[derive(Clone, Debug)]
pub struct RowState {
    /// Density less one, cell by cell.
    pub density_excess: Vec<f32>,
    /// Velocity, component by component (cells a step).
    pub velocity: [Vec<f32>; 3],
}

impl RowState {
    /// Room for a row of `n_cells`.
    pub fn new(n_cells: usize) -> Self {
        let column = || vec![0.0; n_cells.next_multiple_of(MAXIMUM_LANES)];
        Self { density_excess: column(), velocity: [column(), column(), column()] }
    }
}

/// On return `state` holds that of row number `row`.
///
/// # Safety
/// `S`'s instructions are there, and no sweep is running.
#[inline(always)]
pub(crate) unsafe fn read_row<S: Simd, L: Stencil<Q>, const Q: usize>(
    view: &View<'_>,
    row: usize,
    state: &mut RowState,
) {
    let [y, z] = view.layout.place(row);
    let addresses: [usize; Q] = view.layout.addresses(view.parity, y, z);
    let mut x = 0;
    while x < view.layout.n_cells[0] {
        let mut populations = [S::splat(0.0); Q];
        // SAFETY: rows and buffers are padded to whole vectors.
        unsafe {
            for slot in 0..Q {
                populations[read_direction(view.parity, slot)] =
                    S::load(view.air.add(addresses[slot] + x));
            }
            let moments = L::moments(&populations);
            moments.density_excess.store(state.density_excess.as_mut_ptr().add(x));
            for (component, column) in moments.velocity.iter().zip(&mut state.velocity) {
                component.store(column.as_mut_ptr().add(x));
            }
        }
        x += S::LANES;
    }
}

/// Density less one and velocity, forces aside, of eight cells.
///
/// # Safety
/// As for [`read_row`]; the cells lie in the grid.
#[inline(always)]
pub(crate) unsafe fn read_cells<S: Simd, L: Stencil<Q>, const Q: usize>(
    view: &View<'_>,
    cells: &[[usize; 3]; 8],
) -> [[f32; 8]; 4] {
    let mut lanes = [[0.0; MAXIMUM_LANES]; Q];
    for (lane, [x, y, z]) in cells.iter().enumerate() {
        let addresses: [usize; Q] = view.layout.addresses(view.parity, *y, *z);
        for slot in 0..Q {
            // SAFETY: a cell of the grid.
            lanes[read_direction(view.parity, slot)][lane] =
                unsafe { *view.air.add(addresses[slot] + x) };
        }
    }
    let mut state = [[0.0; MAXIMUM_LANES]; 4];
    let mut first = 0;
    while first < cells.len() {
        let mut populations = [S::splat(0.0); Q];
        // SAFETY: buffers of the widest vector, of which `first` leaves a whole one.
        unsafe {
            for q in 0..Q {
                populations[q] = S::load(lanes[q].as_ptr().add(first));
            }
            let Moments { density_excess, velocity: [u, v, w], .. } = L::moments(&populations);
            for (column, value) in state.iter_mut().zip([density_excess, u, v, w]) {
                value.store(column.as_mut_ptr().add(first));
            }
        }
        first += S::LANES;
    }
    let mut result = [[0.0; 8]; 4];
    for (result, column) in result.iter_mut().zip(&state) {
        result.copy_from_slice(&column[..8]);
    }
    result
}

/// Gives row number `row` the populations of `state` in equilibrium.
///
/// # Safety
/// As for [`read_row`]; the view is of an even step, and the row is this thread's own.
#[inline(always)]
pub(crate) unsafe fn write_row<S: Simd, L: Stencil<Q>, const Q: usize>(
    view: &View<'_>,
    row: usize,
    state: &RowState,
) {
    let [y, z] = view.layout.place(row);
    let addresses: [usize; Q] = view.layout.addresses(Parity::Even, y, z);
    let n = view.layout.n_cells[0];
    let mut x = 0;
    while x < n {
        // SAFETY: buffers are padded to whole vectors; a vector past the row's end is written cell by cell.
        unsafe {
            let mut velocity = [S::splat(0.0); 3];
            for (component, column) in velocity.iter_mut().zip(&state.velocity) {
                *component = S::load(column.as_ptr().add(x));
            }
            let density_excess = S::load(state.density_excess.as_ptr().add(x));
            let populations =
                L::populations(&Moments::new(density_excess, velocity, [S::splat(0.0); 6]));
            for q in 0..Q {
                let mut lanes = [0.0; MAXIMUM_LANES];
                populations[q].store(lanes.as_mut_ptr());
                for (lane, value) in lanes[..S::LANES.min(n - x)].iter().enumerate() {
                    *view.air.add(addresses[q] + x + lane) = *value;
                }
            }
        }
        x += S::LANES;
    }
}
