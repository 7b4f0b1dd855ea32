//! One pass over rows of cells: read, collide, write back in place.
//!
//! # Safety
//! The sweep writes through a raw pointer that all threads share. It is sound because each address belongs to
//! exactly one cell in a step of either parity (a test of [`Layout`] shows it), a halo value to exactly one
//! row's end, and each row to exactly one thread. What comes in through an open side is put where the row
//! beside it has what goes out.

mod beyond;
mod pushes;

use super::collision::collide;
use super::ends::{self, RowEnds};
use super::forces::ForceBlock;
use super::layout::{LINE, Layout, Parity, read_direction, write_direction};
use super::sides::OpenSides;
use super::stencil::{Moments, Stencil, Sums};
use super::still::{Air, RowAir};
use crate::simd::{MAXIMUM_LANES, Simd};
use pushes::gather_forces;
use std::mem::MaybeUninit;
use std::ops::Range;
use std::sync::atomic::{Ordering, compiler_fence};

/// How far ahead of a cell its populations are prefetched, in values: nineteen streams are more than a
/// processor's own prefetching follows, and a miss is longer than the cells that it can look ahead to. Rows
/// follow one another in memory, so that what is prefetched beyond a row's end is the next row's start.
pub(crate) const AHEAD: usize = 8 * LINE;

/// What all rows of a step share, in lattice units.
pub(crate) struct Step<'a> {
    /// The populations.
    pub(crate) air: *mut f32,
    pub(crate) layout: &'a Layout,
    pub(crate) parity: Parity,
    /// Relaxation time of the air's own viscosity at each x, padded to whole vectors.
    pub(crate) relaxation_times: &'a [f32],
    /// Smagorinsky's factor at each z.
    pub(crate) subgrid: &'a [f32],
    /// Force density on every cell.
    pub(crate) acceleration: [f32; 3],
    /// How the outlet pulls its pressure back to that of undisturbed air.
    pub(crate) outlet_stiffness: f32,
    /// The same of open sides.
    pub(crate) side_stiffness: f32,
}

// SAFETY: see the module; everything but `air` is read only.
unsafe impl Sync for Step<'_> {}

/// What one thread owns of a step: its rows, what enters and leaves at their ends, and room to work in.
pub(crate) struct Share {
    /// Rows, y fastest.
    pub(crate) rows: Range<usize>,
    /// State at the rows' ends.
    pub(crate) ends: RowEnds,
    /// What lies beyond the sides that the rows border on, where these are open.
    pub(crate) sides: Option<OpenSides>,
    /// Force density of the wall on the rows at the ground among `rows`: x and y components, `row_stride`
    /// values a row.
    pub(crate) wall: [Vec<f32>; 2],
    /// Force density on one row, padded to whole vectors.
    pub(crate) force: [Vec<f32>; 3],
}

/// Moves the rows of `share` on by a step, under the force densities of `blocks` and what acts on `air`.
///
/// # Safety
/// As the module says; `S`'s instructions are there; buffers are padded as their docs say.
#[inline(always)]
pub(crate) unsafe fn rows<S: Simd, L: Stencil<Q>, const Q: usize, A: Air>(
    step: &Step<'_>,
    air: &A,
    blocks: &[ForceBlock],
    share: &mut Share,
) {
    let first = share.rows.start;
    let mut start = first;
    let [mut y, mut z] = step.layout.place(first);
    while start < share.rows.end {
        let n = (share.rows.end - start).min(S::LANES);
        let mut addresses = [[0; Q]; MAXIMUM_LANES];
        for (index, address) in addresses[..n].iter_mut().enumerate() {
            *address = step.layout.addresses(step.parity, y, z);
            let number = start + index - first;
            let forced = gather_forces(step, blocks, share, number, [y, z], A::Row::<S>::PUSHES);
            let row = air.row::<S>([y, z], step.subgrid[z]);
            // SAFETY: handed through.
            unsafe {
                match step.parity {
                    Parity::Even => row_of::<S, L, Q, _, false>(step, address, &row, share, forced),
                    Parity::Odd => row_of::<S, L, Q, _, true>(step, address, &row, share, forced),
                }
                row.close();
            }
            y += 1;
            if y == step.layout.n_cells[1] {
                (y, z) = (0, z + 1);
            }
        }
        // SAFETY: handed through; these rows' cells are done.
        unsafe { ends::close::<S, L, Q>(step, &addresses[..n], start - first, &mut share.ends) };
        if let Some(sides) = &mut share.sides {
            for (row, addresses) in (start..).zip(&addresses[..n]) {
                // SAFETY: handed through; the ends of these rows are closed.
                unsafe { beyond::close::<S, L, Q>(step, addresses, step.layout.place(row), sides) };
            }
        }
        start += n;
    }
}

#[inline(always)]
unsafe fn row_of<S: Simd, L: Stencil<Q>, const Q: usize, R: RowAir<S>, const ODD: bool>(
    step: &Step<'_>,
    addresses: &[usize; Q],
    row: &R,
    share: &mut Share,
    forced: Range<usize>,
) {
    let n = step.layout.n_cells[0];
    let [fx, fy, fz] = &mut share.force;
    let force = [fx.as_mut_ptr(), fy.as_mut_ptr(), fz.as_mut_ptr()];
    // SAFETY: handed through.
    unsafe {
        if R::PUSHES {
            cells::<S, L, Q, R, ODD, true>(step, addresses, row, force, forced);
        } else if forced.is_empty() {
            cells::<S, L, Q, R, ODD, false>(step, addresses, row, force, 0..n);
        } else {
            cells::<S, L, Q, R, ODD, false>(step, addresses, row, force, 0..forced.start);
            cells::<S, L, Q, R, ODD, true>(step, addresses, row, force, forced.clone());
            cells::<S, L, Q, R, ODD, false>(step, addresses, row, force, forced.end..n);
        }
    }
}

#[inline(always)]
unsafe fn cells<
    S: Simd,
    L: Stencil<Q>,
    const Q: usize,
    R: RowAir<S>,
    const ODD: bool,
    const FORCED: bool,
>(
    step: &Step<'_>,
    addresses: &[usize; Q],
    row: &R,
    force: [*mut f32; 3],
    range: Range<usize>,
) {
    let places = places(step, addresses);
    let times = step.relaxation_times.as_ptr();
    let mut x = range.start;
    let mut desk = Desk::<S>::new();
    let [mut now, mut next, mut later] = desk.trays();
    // SAFETY: whole vectors of cells of the row; its padding makes the last one readable, and only cells of
    // the row are written.
    unsafe {
        let n_vectors = range.len() / S::LANES;
        if n_vectors > 0 {
            add_up::<S, L, Q, ODD>(&places, x, now);
            judge(now, x, times, row, &force);
            if n_vectors > 1 {
                add_up::<S, L, Q, ODD>(&places, x + S::LANES, next);
            }
            // Three vectors share no address, and what one waits for (divisions, roots) the others fill. The
            // fences keep the compiler from mixing the stages: its own order costs up to half as much again.
            for _ in 2..n_vectors {
                judge(next, x + S::LANES, times, row, &force);
                compiler_fence(Ordering::SeqCst);
                add_up::<S, L, Q, ODD>(&places, x + 2 * S::LANES, later);
                compiler_fence(Ordering::SeqCst);
                write_back::<S, L, Q, ODD, FORCED>(&places, x, now, &force);
                compiler_fence(Ordering::SeqCst);
                (now, next, later) = (next, later, now);
                x += S::LANES;
            }
            if n_vectors > 1 {
                judge(next, x + S::LANES, times, row, &force);
                write_back::<S, L, Q, ODD, FORCED>(&places, x, now, &force);
                now = next;
                x += S::LANES;
            }
            write_back::<S, L, Q, ODD, FORCED>(&places, x, now, &force);
            x += S::LANES;
        }
        if x < range.end {
            add_up::<S, L, Q, ODD>(&places, x, now);
            judge(now, x, times, row, &force);
            let after = after::<S, L, Q, FORCED>(now, x, &force);
            write_part::<S, Q, ODD>(&places, x..range.end, &after);
        }
    }
}

/// Where the populations of a row at `addresses` lie.
#[inline(always)]
fn places<const Q: usize>(step: &Step<'_>, addresses: &[usize; Q]) -> [*mut f32; Q] {
    let mut places = [step.air; Q];
    for (place, address) in places.iter_mut().zip(addresses) {
        // SAFETY: a row's addresses lie in the array.
        *place = unsafe { step.air.add(*address) };
    }
    places
}

/// A vector of cells on its way through the stages, each of which fills in more.
struct Tray<S> {
    sums: Sums<S>,
    per_density: S,
    state: Moments<S>,
    /// Rate at which the stress relaxes.
    rate: S,
}

/// Trays of three vectors.
struct Desk<S>([MaybeUninit<Tray<S>>; 3]);

impl<S> Desk<S> {
    #[inline(always)]
    fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; 3])
    }

    /// The trays, as memory that the compiler knows nothing of, so that it cannot pass the values on beside
    /// it and undo the order of the stages.
    #[inline(always)]
    fn trays(&mut self) -> [*mut Tray<S>; 3] {
        let first = std::hint::black_box(&raw mut self.0).cast::<Tray<S>>();
        std::array::from_fn(|number| first.wrapping_add(number))
    }
}

/// Whether population `slot` is asked for ahead of its cells where it is read: half of them are asked for
/// where they are written instead, which is faster than all at once. Vectors shorter than a line have it all
/// in one place, so that only one asks whether a line begins.
#[inline(always)]
const fn asked_where_read<S: Simd>(slot: usize) -> bool {
    slot.is_multiple_of(2) || S::LANES < LINE
}

/// First stage: the populations of the cells from `x` are read and added up, and divided by the density.
#[inline(always)]
unsafe fn add_up<S: Simd, L: Stencil<Q>, const Q: usize, const ODD: bool>(
    places: &[*mut f32; Q],
    x: usize,
    tray: *mut Tray<S>,
) {
    // SAFETY: the caller promises whole readable vectors.
    unsafe {
        let mut populations = [S::splat(0.0); Q];
        for slot in 0..Q {
            let place = places[slot].add(x);
            populations[read_direction(parity::<ODD>(), slot)] = S::load(place);
            if asked_where_read::<S>(slot) && (S::LANES >= LINE || x.is_multiple_of(LINE)) {
                S::prefetch(place.wrapping_add(AHEAD));
            }
        }
        let sums = L::sums(&populations);
        (*tray).per_density = sums.per_density();
        (*tray).sums = sums;
    }
}

/// Second stage: the state of the cells, and the rate at which their stress relaxes.
#[inline(always)]
unsafe fn judge<S: Simd, R: RowAir<S>>(
    tray: *mut Tray<S>,
    x: usize,
    times: *const f32,
    row: &R,
    force: &[*mut f32; 3],
) {
    // SAFETY: the caller promises whole readable vectors.
    unsafe {
        let state = (*tray).sums.moments((*tray).per_density);
        (*tray).rate = row.judge(&state, S::load(times.add(x)), x, force);
        (*tray).state = state;
    }
}

/// Last stage: the populations after the collision are written back.
#[inline(always)]
unsafe fn write_back<
    S: Simd,
    L: Stencil<Q>,
    const Q: usize,
    const ODD: bool,
    const FORCED: bool,
>(
    places: &[*mut f32; Q],
    x: usize,
    tray: *const Tray<S>,
    force: &[*mut f32; 3],
) {
    // SAFETY: handed through.
    unsafe {
        let after = after::<S, L, Q, FORCED>(tray, x, force);
        for slot in 0..Q {
            let place = places[slot].add(x);
            after[write_direction(parity::<ODD>(), slot)].store(place);
            if !asked_where_read::<S>(slot) {
                S::prefetch(place.wrapping_add(AHEAD + 2 * S::LANES));
            }
        }
    }
}

/// Writes those populations `after` the collision back that belong to the cells of `range`, less than a
/// vector.
#[inline(always)]
unsafe fn write_part<S: Simd, const Q: usize, const ODD: bool>(
    places: &[*mut f32; Q],
    range: Range<usize>,
    after: &[S; Q],
) {
    for slot in 0..Q {
        let mut lanes = [0.0; MAXIMUM_LANES];
        // SAFETY: a buffer of the widest vector; then cells of the row.
        unsafe {
            after[write_direction(parity::<ODD>(), slot)].store(lanes.as_mut_ptr());
            for (lane, value) in lanes[..range.len()].iter().enumerate() {
                *places[slot].add(range.start + lane) = *value;
            }
        }
    }
}

/// Populations after the collision of the cells from `x`.
#[inline(always)]
unsafe fn after<S: Simd, L: Stencil<Q>, const Q: usize, const FORCED: bool>(
    tray: *const Tray<S>,
    x: usize,
    force: &[*mut f32; 3],
) -> [S; Q] {
    // SAFETY: the caller promises whole readable vectors.
    unsafe {
        let force = if FORCED {
            let [fx, fy, fz] = *force;
            Some([S::load(fx.add(x)), S::load(fy.add(x)), S::load(fz.add(x))])
        } else {
            None
        };
        L::populations(&collide(&(*tray).state, (*tray).rate, force))
    }
}

#[inline(always)]
const fn parity<const ODD: bool>() -> Parity {
    if ODD { Parity::Odd } else { Parity::Even }
}
