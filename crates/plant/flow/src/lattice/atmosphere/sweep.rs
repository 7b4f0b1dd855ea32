//! One pass over a row of an atmosphere: both sets of populations read, collided and written back in place.
//!
//! As [`sweep`](crate::lattice::sweep), whose safety argument holds for the second array as for the first:
//! it has the same rows, and its own addresses belong to one cell each.

use super::coefficients::{Coefficients, Level};
use super::ends::{self, Entering};
use super::heat::{self, Heat, N_HEAT};
use super::law::Law;
use super::stratification::HeatShare;
use crate::lattice::collision::collide;
use crate::lattice::ends::{RowEnds, close};
use crate::lattice::forces::ForceBlock;
use crate::lattice::layout::{LINE, Layout, Parity, read_direction, write_direction};
use crate::lattice::simd::{MAXIMUM_LANES, Simd};
use crate::lattice::stencil::{Moments, Stencil};
use crate::lattice::sweep::{AHEAD, Share, Step, gather_forces};
use std::ops::Range;

/// What all rows of a step share of the atmosphere.
pub(crate) struct StepHeat<'a> {
    /// The populations that carry temperature.
    pub(crate) heat: *mut f32,
    pub(crate) layout: &'a Layout,
    pub(crate) coefficients: &'a Coefficients,
    /// Levels, from the ground up.
    pub(crate) levels: &'a [Level],
}

// SAFETY: see the module; everything but `heat` is read only.
unsafe impl Sync for StepHeat<'_> {}

/// One row of a step.
struct RowHeat<'a> {
    /// Its addresses among the populations that carry temperature.
    addresses: [usize; N_HEAT],
    level: Level,
    /// Smagorinsky's factor.
    subgrid: f32,
    /// What the ground adds to the temperature of each cell (K), padded to whole vectors; zeros above it.
    source: &'a [f32],
}

/// Moves the rows of `share` on by a step, as [`sweep::rows`](crate::lattice::sweep::rows), with their
/// temperatures.
///
/// # Safety
/// As for the sweep.
#[inline(always)]
pub(crate) unsafe fn rows<S: Simd, L: Stencil<Q>, const Q: usize>(
    step: &Step<'_>,
    air: &StepHeat<'_>,
    blocks: &[ForceBlock],
    share: &mut Share,
    heat: &mut HeatShare,
) {
    let first = share.rows.start;
    let mut start = first;
    let [mut y, mut z] = step.layout.place(first);
    let stride = step.layout.row_stride;
    while start < share.rows.end {
        let n = (share.rows.end - start).min(S::LANES);
        let mut addresses = [[0; Q]; MAXIMUM_LANES];
        for (index, address) in addresses[..n].iter_mut().enumerate() {
            *address = step.layout.addresses(step.parity, y, z);
            let number = start + index - first;
            let forced = gather_forces(step, blocks, &share.wall, &mut share.force, number, [y, z]);
            let row = RowHeat {
                addresses: air.layout.addresses(step.parity, y, z),
                level: air.levels[z],
                subgrid: step.subgrid[z],
                source: match z {
                    0 => &heat.surface.source[number * stride..],
                    _ => &heat.none,
                },
            };
            // SAFETY: handed through; this row's cells are done before its ends are closed.
            unsafe {
                heat.sums[number] = match step.parity {
                    Parity::Even => {
                        cells_of::<S, L, Q, false>(step, air, address, &row, &share.force, forced)
                    }
                    Parity::Odd => {
                        cells_of::<S, L, Q, true>(step, air, address, &row, &share.force, forced)
                    }
                };
                let entering = entering(&share.ends, number, row.level.target);
                ends::close(air, step.parity, &row.addresses, entering);
            }
            y += 1;
            if y == step.layout.n_cells[1] {
                (y, z) = (0, z + 1);
            }
        }
        // SAFETY: handed through; these rows' cells are done.
        unsafe { close::<S, L, Q>(step, &addresses[..n], start - first, &mut share.ends) };
        start += n;
    }
}

/// What enters row number `number` of `ends`: air of the `temperature` of its level.
#[inline(always)]
fn entering(ends: &RowEnds, number: usize, temperature: f32) -> Option<Entering> {
    match ends {
        RowEnds::Periodic => None,
        RowEnds::Open { inlet, .. } => {
            let velocity = inlet.each_ref().map(|column| column[number]);
            Some(Entering { temperature, velocity })
        }
    }
}

/// Moves the row at `addresses` on by a step under `force`, which holds in the range `forced`; gives the sum
/// of its temperatures.
///
/// # Safety
/// As for the sweep.
#[inline(always)]
unsafe fn cells_of<S: Simd, L: Stencil<Q>, const Q: usize, const ODD: bool>(
    step: &Step<'_>,
    air: &StepHeat<'_>,
    addresses: &[usize; Q],
    row: &RowHeat<'_>,
    force: &[Vec<f32>; 3],
    forced: Range<usize>,
) -> f32 {
    let n = step.layout.n_cells[0];
    let pieces = match forced.is_empty() {
        true => [0..n, n..n, n..n],
        false => [0..forced.start, forced.clone(), forced.end..n],
    };
    let [before, forced, behind] = pieces;
    // One sum through all pieces, which begin with whole vectors: its bits do not hang on where they begin.
    let mut sum = Sum { lanes: S::splat(0.0), rest: 0.0 };
    // SAFETY: handed through.
    unsafe {
        cells::<S, L, Q, ODD, false>(step, air, addresses, row, force, before, &mut sum);
        cells::<S, L, Q, ODD, true>(step, air, addresses, row, force, forced, &mut sum);
        cells::<S, L, Q, ODD, false>(step, air, addresses, row, force, behind, &mut sum);
    }
    sum.rest + first(sum.lanes, S::LANES).iter().sum::<f32>()
}

/// Sum of the temperatures of a row so far: of whole vectors, and of the cells behind the last.
struct Sum<S> {
    lanes: S,
    rest: f32,
}

#[inline(always)]
unsafe fn cells<S: Simd, L: Stencil<Q>, const Q: usize, const ODD: bool, const FORCED: bool>(
    step: &Step<'_>,
    air: &StepHeat<'_>,
    addresses: &[usize; Q],
    row: &RowHeat<'_>,
    force: &[Vec<f32>; 3],
    range: Range<usize>,
    sum: &mut Sum<S>,
) {
    if range.is_empty() {
        return;
    }
    // SAFETY: handed through.
    let places = unsafe { Places::new(step, air, addresses, row, force) };
    let law = Law::<S>::new(air.coefficients, row.level, row.subgrid);
    let parity = parity::<ODD>();
    let mut x = range.start;
    // SAFETY: whole vectors of cells of the row; its padding makes the last one readable, and only cells of
    // the row are written.
    unsafe {
        if x + S::LANES <= range.end {
            // As in the sweep without temperature: the next vector's state is found before this one's is
            // written.
            let mut now = before::<S, L, Q, ODD, FORCED>(&places, &law, x);
            loop {
                let has_next = x + 2 * S::LANES <= range.end;
                let next = if has_next {
                    before::<S, L, Q, ODD, FORCED>(&places, &law, x + S::LANES)
                } else {
                    now
                };
                sum.lanes = sum.lanes + now.heat.temperature;
                let (f, g) = now.after::<L, Q>(&law);
                for slot in 0..Q {
                    f[write_direction(parity, slot)].store(places.air[slot].add(x));
                }
                for slot in 0..N_HEAT {
                    g[write_direction(parity, slot)].store(places.heat[slot].add(x));
                }
                x += S::LANES;
                if !has_next {
                    break;
                }
                now = next;
            }
        }
        if x < range.end {
            part::<S, L, Q, ODD, FORCED>(&places, &law, x..range.end, sum);
        }
    }
}

/// Moves the cells of `range`, less than a vector, on by a step.
#[inline(always)]
unsafe fn part<S: Simd, L: Stencil<Q>, const Q: usize, const ODD: bool, const FORCED: bool>(
    places: &Places<Q>,
    law: &Law<S>,
    range: Range<usize>,
    sum: &mut Sum<S>,
) {
    let (x, n) = (range.start, range.len());
    let parity = parity::<ODD>();
    // SAFETY: as for whole vectors; cells of the row alone are written.
    unsafe {
        let now = before::<S, L, Q, ODD, FORCED>(places, law, x);
        sum.rest = first(now.heat.temperature, n).iter().sum();
        let (f, g) = now.after::<L, Q>(law);
        for slot in 0..Q {
            write(f[write_direction(parity, slot)], n, places.air[slot].add(x));
        }
        for slot in 0..N_HEAT {
            write(g[write_direction(parity, slot)], n, places.heat[slot].add(x));
        }
    }
}

/// Where a row lies in memory.
struct Places<const Q: usize> {
    air: [*mut f32; Q],
    heat: [*mut f32; N_HEAT],
    times: *const f32,
    source: *const f32,
    force: [*const f32; 3],
}

impl<const Q: usize> Places<Q> {
    /// The row at `addresses`, under `force`.
    ///
    /// # Safety
    /// A row's addresses lie in the arrays.
    #[inline(always)]
    unsafe fn new(
        step: &Step<'_>,
        air: &StepHeat<'_>,
        addresses: &[usize; Q],
        row: &RowHeat<'_>,
        force: &[Vec<f32>; 3],
    ) -> Self {
        let mut places = Self {
            air: [step.air; Q],
            heat: [air.heat; N_HEAT],
            times: step.relaxation_times.as_ptr(),
            source: row.source.as_ptr(),
            force: [force[0].as_ptr(), force[1].as_ptr(), force[2].as_ptr()],
        };
        // SAFETY: as the caller promises.
        unsafe {
            for (place, address) in places.air.iter_mut().zip(addresses) {
                *place = step.air.add(*address);
            }
            for (place, address) in places.heat.iter_mut().zip(&row.addresses) {
                *place = air.heat.add(*address);
            }
        }
        places
    }
}

/// A vector of cells before its collision.
#[derive(Clone, Copy)]
struct Ready<S> {
    state: Moments<S>,
    g: [S; N_HEAT],
    heat: Heat<S>,
    push: [S; 3],
    /// Half-way through the force.
    velocity: [S; 3],
    /// Of stress and of temperature.
    rates: [S; 2],
    source: S,
}

/// The cells from `x` before their collision.
#[inline(always)]
unsafe fn before<S: Simd, L: Stencil<Q>, const Q: usize, const ODD: bool, const FORCED: bool>(
    places: &Places<Q>,
    law: &Law<S>,
    x: usize,
) -> Ready<S> {
    let parity = parity::<ODD>();
    // SAFETY: the caller promises whole readable vectors.
    unsafe {
        let mut f = [S::splat(0.0); Q];
        for slot in 0..Q {
            f[read_direction(parity, slot)] = fetch(places.air[slot], x);
        }
        let mut g = [S::splat(0.0); N_HEAT];
        for slot in 0..N_HEAT {
            g[read_direction(parity, slot)] = fetch(places.heat[slot], x);
        }
        let state = L::moments(&f);
        let heat = heat::moments(&g);
        let time = S::load(places.times.add(x));
        let mut push = law.force(&state, heat.temperature);
        if FORCED {
            for (push, force) in push.iter_mut().zip(places.force) {
                *push = *push + S::load(force.add(x));
            }
        }
        let half = S::splat(0.5) * state.per_density;
        let mut velocity = state.velocity;
        for (velocity, push) in velocity.iter_mut().zip(push) {
            *velocity = half.mul_add(push, *velocity);
        }
        let rates = law.rates(&state, &heat, velocity[2], time);
        Ready { state, g, heat, push, velocity, rates, source: S::load(places.source.add(x)) }
    }
}

/// The vector at `x` of a stream, and the one that is due later on its way.
#[inline(always)]
unsafe fn fetch<S: Simd>(place: *mut f32, x: usize) -> S {
    // SAFETY: the caller promises a whole readable vector.
    unsafe {
        let place = place.add(x);
        if S::LANES >= LINE || x.is_multiple_of(LINE) {
            S::prefetch(place.wrapping_add(AHEAD));
        }
        S::load(place)
    }
}

impl<S: Simd> Ready<S> {
    /// Populations after the collision: those of the air, those of temperature.
    #[inline(always)]
    fn after<L: Stencil<Q>, const Q: usize>(&self, law: &Law<S>) -> ([S; Q], [S; N_HEAT]) {
        let Self { state, g, heat, push, velocity, rates: [rate, heat_rate], source } = self;
        let f = L::populations(&collide(state, *rate, Some(*push)));
        let warming = law.warming(heat.temperature) + *source;
        let mut g = heat::collide(g, heat, *velocity, *heat_rate, warming);
        for (leaving, [factor, addend]) in [6, 5].into_iter().zip(&law.leaving) {
            g[leaving] = g[leaving].mul_add(*factor, *addend);
        }
        (f, g)
    }
}

/// The lanes of `value`, zero from the `n`-th on.
#[inline(always)]
fn first<S: Simd>(value: S, n: usize) -> [f32; MAXIMUM_LANES] {
    let mut lanes = [0.0; MAXIMUM_LANES];
    // SAFETY: a buffer of the widest vector.
    unsafe { value.store(lanes.as_mut_ptr()) };
    lanes[n..].fill(0.0);
    lanes
}

/// Writes the first `n` lanes of `value` to `place`.
#[inline(always)]
unsafe fn write<S: Simd>(value: S, n: usize, place: *mut f32) {
    for (lane, value) in first(value, n)[..n].iter().enumerate() {
        // SAFETY: the caller promises that many writable values.
        unsafe { *place.add(lane) = *value };
    }
}

#[inline(always)]
const fn parity<const ODD: bool>() -> Parity {
    if ODD { Parity::Odd } else { Parity::Even }
}
