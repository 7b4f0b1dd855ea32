//! What streams into the box through its open sides.
//!
//! Each row at a side has a halo row beyond it, which is given the populations that stream into the box, as
//! inlet and outlet give them to the cells beyond a row's ends. Where wind enters, they have the inflow's
//! velocity and the density and stress of the cell inside. Where it leaves, the wave that goes out decides
//! together with what the cell inside has of the other one: eddies pass along a side much faster than through
//! it, and a halo that kept the wave which enters as it was, as the outlet's does, would answer each of them
//! with a pressure of the sound's impedance (Yoo, Im 2007, Combust. Theory Model. 11, 259, whose terms along
//! the side this takes from the cell beside). Speed through the side goes on with the slope that the cell's
//! stress tells: were it that of the cell, air that keeps its volume could not speed up along the side, and
//! the side would hold eddies fast as a wall does. Velocity along the side is that of the cell inside.
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
/// How far the inflow's wind is held where air leaves (–): with none of it what blows out there drifts, and
/// has broken down after minutes.
const HELD: f32 = 0.05;

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
        let state =
            pass::<S>(step, &side, side.corners, S::load(shares.as_ptr()), &L::moments(&ends));
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
            let state = pass::<S>(step, &side, x, S::splat(side.share), &L::moments(&inside));
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

/// State of the halo cells from `x` a step later, given the cells `inside` beside them and how far the inflow
/// enters there.
///
/// # Safety
/// Whole vectors of a row beyond a side from `x`.
#[inline(always)]
unsafe fn pass<S: Simd>(
    step: &Step<'_>,
    side: &Beside,
    x: usize,
    share: S,
    inside: &Moments<S>,
) -> Moments<S> {
    let outward = S::splat(f32::from(side.outward));
    // SAFETY: handed through.
    unsafe {
        let [mut u, mut v, mut w] = [S::splat(0.0); 3];
        let [before, after] = &side.around;
        for ((value, before), after) in [&mut u, &mut v, &mut w].into_iter().zip(before).zip(after)
        {
            let before = S::load(before.add(x));
            *value = S::splat(side.weight).mul_add(S::load(after.add(x)) - before, before);
        }
        let [excess, speed] = side.halo.map(|column| S::load(column.add(x)));
        let [leaving_excess, leaving_speed] =
            leave([excess, speed], inside, outward, S::splat(step.side_stiffness));
        let held = S::splat(HELD).mul_add(S::splat(1.0) - share, share);
        let excess = share.mul_add(inside.density_excess - leaving_excess, leaving_excess);
        let speed = held.mul_add(outward * v - leaving_speed, leaving_speed);
        for (value, column) in [excess, speed].into_iter().zip(side.halo) {
            value.store(column.add(x));
        }
        let [along, _, upwards] = inside.velocity;
        let velocity =
            [held.mul_add(u - along, along), outward * speed, held.mul_add(w - upwards, upwards)];
        Moments::new(excess, velocity, inside.stress)
    }
}

/// Density excess and outward speed of the halo cell a step later, given the cell `inside` before it.
#[inline(always)]
fn leave<S: Simd>(
    [excess, speed]: [S; 2],
    inside: &Moments<S>,
    outward: S,
    stiffness: S,
) -> [S; 2] {
    // Symbols: c speed of sound; out and into what becomes of p + rho c u and p - rho c u in the step.
    let c = S::splat(0.577_350_3);
    let c_squared = S::splat(1.0 / 3.0);
    let rho = S::splat(1.0) + excess;
    // Air keeps its volume: where it speeds up along the side, less goes through it. The slope of the speed
    // through the side is that which the cell's stress tells, so that the halo leaves it as it is.
    let slope = S::splat(3.0) * inside.stress[1];
    let beyond = outward.mul_add(inside.velocity[1], slope);
    let carried = speed.maximum(S::splat(0.0)) + c;
    let pressure_rise = c_squared * (inside.density_excess - excess);
    let speed_rise = rho * c * (beyond - speed);
    let out = carried * (pressure_rise + speed_rise);
    let into = (stiffness * c_squared).sub_from(inside.density_excess, pressure_rise - speed_rise);
    [
        S::splat(1.5).mul_add(out + into, excess),
        (S::splat(0.5) * (out - into)).divide(rho * c) + speed,
    ]
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
