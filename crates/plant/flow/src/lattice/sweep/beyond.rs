//! What streams into the box through its open sides.
//!
//! Each row at a side has a halo row beyond it, which is given the populations that stream into the box, as
//! inlet and outlet give them to the cells beyond a row's ends, with the stress of the cell inside. Its
//! pressure is that of the wave which leaves: it follows the cell inside at the speed of sound, with a weak
//! pull to that of undisturbed air.
//!
//! Where wind enters, it has the inflow's velocity and, through the side, that of a wave of this pressure on
//! its way out: so sound leaves there too. Where wind leaves, it has the velocity of the cell inside, and
//! through the side that goes on with its slope. Eddies pass along a side much faster than through it; where
//! the halo does not follow them, or keeps no volume, the air answers with the impedance of sound (Yoo, Im
//! 2007, Combust. Theory Model. 11, 259, see the terms along the boundary). An outlet's halo, which waits for
//! them, would spoil a quarter of the energy of a vortex that leaves at 15° to the side; this one spoils a
//! twenty-fifth. The slope needs no other cell: it is in the stress that the collision has left.
//!
//! A gust can turn the air back in places where wind leaves. Were the halo's velocity that of the cell inside
//! there, too, what enters would be decided by nothing: in an atmosphere's wind such a place blew itself up
//! after five minutes. So what comes back in has the inflow's wind along the side, the sooner the steeper it
//! comes, and through the side the velocity of the cell inside, without its slope, and with a bound, which
//! gusts hardly reach: without the bound another place blew up after three quarters of an hour. With the
//! inflow's velocity through the side, which on average blows out, gusts would go out and not come in: a wind
//! of its own.
//!
//! # Safety
//! As for the sweep: what goes out of the box through a side is written to places that belong to the row's
//! own cells alone, and those are where the populations from beyond are read.

use super::Step;
use crate::lattice::layout::write_direction;
use crate::lattice::sides::{Beside, OpenSides};
use crate::lattice::stencil::{Moments, Stencil};
use crate::simd::{MAXIMUM_LANES, Simd};

/// Most directions that lead through a side (–).
const MOST_WAYS: usize = 9;

/// Air that comes back in where wind leaves, over its speed, from which on it has the inflow's wind (–): 3°.
const BACK: f32 = 0.05;
/// Most that comes back in there, over the inflow's speed (–): 6°.
const STEEPEST: f32 = 0.1;

/// A way through the side.
#[derive(Clone, Copy, Default)]
struct Way {
    /// Number of the address that the population from beyond is put at.
    slot: usize,
    /// Its direction.
    direction: usize,
    /// Cells along x that it goes.
    along: i8,
}

/// Gives the halo cells beyond the side at the row at `place`, if there are any, the populations that stream
/// into the box next.
///
/// # Safety
/// As for the sweep; the row's cells have been collided in this step, and its ends closed.
#[inline(always)]
pub(super) unsafe fn close<S: Simd, L: Stencil<Q>, const Q: usize>(
    step: &Step<'_>,
    addresses: &[usize; Q],
    place: [usize; 2],
    sides: &mut OpenSides,
) {
    let Some(side) = sides.beside(place) else { return };
    let mut ways = [Way::default(); MOST_WAYS];
    let n_ways = ways_in::<L, Q>(step, &side, place[1], &mut ways);
    let ways = &ways[..n_ways];
    let n = step.layout.n_cells[0];
    // SAFETY: rows and columns are padded to whole vectors.
    unsafe {
        // Corners first: the places of the cells beside them are overwritten after that.
        let ends = gather::<S, Q>(step, addresses, |lane| if lane == 0 { 0 } else { n - 1 });
        let mut shares = [side.share; MAXIMUM_LANES];
        // The inlet rules upstream.
        shares[0] = 1.0;
        let mut times = [step.relaxation_times[n - 1]; MAXIMUM_LANES];
        times[0] = step.relaxation_times[0];
        let law = Law { share: S::load(shares.as_ptr()), time: S::load(times.as_ptr()) };
        let state = pass::<S>(step, &side, side.corners, &law, &L::moments(&ends));
        let populations = L::populations(&state);
        for way in ways.iter().filter(|way| way.along != 0) {
            let mut lanes = [0.0; MAXIMUM_LANES];
            populations[way.direction].store(lanes.as_mut_ptr());
            let (lane, x) = if way.along > 0 { (0, usize::MAX) } else { (1, n) };
            *step.air.add(addresses[way.slot].wrapping_add(x)) = lanes[lane];
        }
        let mut x = 0;
        while x < n {
            let n_lanes = (n - x).min(S::LANES);
            let inside = gather::<S, Q>(step, addresses, |lane| x + lane.min(n_lanes - 1));
            let time = S::load(step.relaxation_times.as_ptr().add(x));
            let law = Law { share: S::splat(side.share), time };
            let state = pass::<S>(step, &side, x, &law, &L::moments(&inside));
            let populations = L::populations(&state);
            for way in ways {
                let mut lanes = [0.0; MAXIMUM_LANES];
                populations[way.direction].store(lanes.as_mut_ptr());
                for (lane, value) in lanes[..n_lanes].iter().enumerate() {
                    *step.air.add(addresses[way.slot] + x + lane) = *value;
                }
            }
            x += S::LANES;
        }
    }
}

/// On return `ways` begins with those that lead into the box from beyond the `side` at level `z`; gives their
/// number.
#[inline(always)]
fn ways_in<L: Stencil<Q>, const Q: usize>(
    step: &Step<'_>,
    side: &Beside,
    z: usize,
    ways: &mut [Way; MOST_WAYS],
) -> usize {
    let mut n_ways = 0;
    for slot in 0..Q {
        let out = write_direction(step.parity, slot);
        let [along, across, _] = L::DIRECTIONS[out];
        if across == side.outward && !step.layout.turns_back(out, z) {
            ways[n_ways] = Way { slot, direction: step.layout.mirrored(out), along };
            n_ways += 1;
        }
    }
    n_ways
}

/// What decides on the halo cells of some places.
struct Law<S> {
    /// How far the inflow enters.
    share: S,
    /// Relaxation time of the air's own viscosity.
    time: S,
}

/// State of the halo cells from `x` after a step, given the cells `inside` beside them.
///
/// # Safety
/// Whole vectors of a row beyond a side from `x`.
#[inline(always)]
unsafe fn pass<S: Simd>(
    step: &Step<'_>,
    side: &Beside,
    x: usize,
    law: &Law<S>,
    inside: &Moments<S>,
) -> Moments<S> {
    let c = S::splat(0.577_350_3);
    let outward = S::splat(f32::from(side.outward));
    // SAFETY: handed through.
    let (wind, excess) = unsafe { (wind(side, x), S::load(side.excess.add(x))) };
    let rise = inside.density_excess - excess;
    // The halo takes a step to hear of the cell inside, as a wave that goes out does.
    let next = S::splat(step.side_stiffness).sub_from(excess, c.mul_add(rise, excess));
    // SAFETY: handed through.
    unsafe { next.store(side.excess.add(x)) };

    let rho = S::splat(1.0) + excess;
    let entering = (c * excess).divide(rho).mul_add(outward, wind[1]);
    let slope = slope(inside, law.time, c * rise);
    let back = coming_back(inside, outward);
    let [along, across, upwards] = inside.velocity;
    let across = no_steeper(across, outward, &wind);
    let leaving = outward.mul_add((S::splat(1.0) - back) * slope, across);
    let share = (S::splat(1.0) - law.share).mul_add(back, law.share);
    let between = |share: S, entering: S, leaving: S| share.mul_add(entering - leaving, leaving);
    let velocity = [
        between(share, wind[0], along),
        between(law.share, entering, leaving),
        between(share, wind[2], upwards),
    ];
    // SAFETY: handed through.
    unsafe {
        share.store(side.entered.add(x));
        velocity[1].store(side.across.add(x));
    }
    Moments::new(excess, velocity, inside.stress)
}

/// How far the air in the cells `inside` comes back in: 1 where it does so at 3° or more, 0 where it leaves.
#[inline(always)]
fn coming_back<S: Simd>(inside: &Moments<S>, outward: S) -> S {
    let [along, across, upwards] = inside.velocity;
    // Not zero in still air.
    let least = S::splat(1e-12);
    let squared = along.mul_add(along, across.mul_add(across, upwards.mul_add(upwards, least)));
    let inward = (outward * across * S::splat(-1.0 / BACK)).divide(squared.sqrt());
    let (zero, one) = (S::splat(0.0), S::splat(1.0));
    one - (one - inward.maximum(zero)).maximum(zero)
}

/// The velocity `across` of cells inside, which blows in with no more than its share of the inflow's `wind`.
#[inline(always)]
fn no_steeper<S: Simd>(across: S, outward: S, wind: &[S; 3]) -> S {
    let squared = wind[0].mul_add(wind[0], wind[1] * wind[1]);
    outward * (outward * across).maximum(S::splat(-STEEPEST) * squared.sqrt())
}

/// Wind of the inflow in the step at the halo cells from `x`.
///
/// # Safety
/// As above.
#[inline(always)]
unsafe fn wind<S: Simd>(side: &Beside, x: usize) -> [S; 3] {
    let [before, after] = &side.around;
    let mut wind = [S::splat(0.0); 3];
    for ((value, before), after) in wind.iter_mut().zip(before).zip(after) {
        // SAFETY: handed through.
        let (before, after) = unsafe { (S::load(before.add(x)), S::load(after.add(x))) };
        *value = S::splat(side.weight).mul_add(after - before, before);
    }
    wind
}

/// Slope of v along y in the cells `inside` (per step), which the collision has left in their stress; `time`
/// is the relaxation time and `gain` the gain of density in a step.
#[inline(always)]
fn slope<S: Simd>(inside: &Moments<S>, time: S, gain: S) -> S {
    // Before the collision stress less its trace is -2/3 rho time (slope - divergence/3), after it 1 - 1/time
    // of that.
    let third = S::splat(1.0 / 3.0);
    let [xx, yy, zz, ..] = inside.stress;
    let left = third.sub_from(xx + yy + zz, yy);
    let shear = (S::splat(1.5) * left * inside.per_density).divide(S::splat(1.0) - time);
    third.sub_from(gain, shear)
}

/// Populations after the collision of the cells at the places that `x` gives, lane by lane.
#[inline(always)]
unsafe fn gather<S: Simd, const Q: usize>(
    step: &Step<'_>,
    addresses: &[usize; Q],
    x: impl Fn(usize) -> usize,
) -> [S; Q] {
    let mut populations = [S::splat(0.0); Q];
    for slot in 0..Q {
        let mut lanes = [0.0; MAXIMUM_LANES];
        for (lane, value) in lanes[..S::LANES].iter_mut().enumerate() {
            // SAFETY: a cell of a row of this thread.
            *value = unsafe { *step.air.add(addresses[slot] + x(lane)) };
        }
        // SAFETY: a buffer of the widest vector.
        populations[write_direction(step.parity, slot)] = unsafe { S::load(lanes.as_ptr()) };
    }
    populations
}
