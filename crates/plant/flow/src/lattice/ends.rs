//! What enters upstream and leaves downstream.
//!
//! A halo cell beyond each end of a row is given the populations that stream into the row. At the inlet they
//! have the inflow's velocity and the density and stress of the first cell (non-equilibrium extrapolation:
//! Guo, Zheng, Shi 2002, Phys. Fluids 14, 2007). At the outlet, density and velocity of the halo cell follow
//! the characteristics that leave the box, and none enters but a weak pull to the undisturbed pressure
//! (Poinsot, Lele 1992, J. Comput. Phys. 101, 104; in lattices: Izquierdo, Fueyo 2008, Phys. Rev. E 78,
//! 046707).

use super::layout::write_direction;
use super::settings::Ends;
use super::stencil::{Moments, Stencil};
use super::sweep::Step;
use crate::simd::{MAXIMUM_LANES, Simd};

/// State at the ends of one thread's rows, in lattice units; each array holds a value per row, padded to
/// whole vectors.
pub(crate) enum RowEnds {
    /// The row's ends are each other's neighbours.
    Periodic,
    /// Wind enters and leaves.
    Open {
        /// Velocity that enters.
        inlet: [Vec<f32>; 3],
        /// Density less one, and velocity, of the halo cell beyond the outlet.
        outlet: [Vec<f32>; 4],
    },
}

impl RowEnds {
    /// Ends of `n_rows` rows, at rest.
    pub(crate) fn new(ends: Ends, n_rows: usize) -> Self {
        let column = || vec![0.0; n_rows.next_multiple_of(MAXIMUM_LANES) + MAXIMUM_LANES];
        match ends {
            Ends::Periodic => Self::Periodic,
            Ends::InletOutlet => Self::Open {
                inlet: [column(), column(), column()],
                outlet: [column(), column(), column(), column()],
            },
        }
    }
}

/// Gives the halo cells of rows that were just swept the populations that stream into them next.
///
/// `addresses` are those of at most a vector of rows, the first of them row number `first` of `ends`.
///
/// # Safety
/// As for the sweep; the rows' cells have been collided in this step.
#[inline(always)]
pub(crate) unsafe fn close<S: Simd, L: Stencil<Q>, const Q: usize>(
    step: &Step<'_>,
    addresses: &[[usize; Q]],
    first: usize,
    ends: &mut RowEnds,
) {
    let n = step.layout.n_cells[0];
    // SAFETY: handed through; `ends` is padded to whole vectors.
    unsafe {
        let upstream = gather::<S, Q>(step, addresses, 0);
        let downstream = gather::<S, Q>(step, addresses, n - 1);
        match ends {
            RowEnds::Periodic => {
                scatter::<S, L, Q>(step, addresses, n, -1, &upstream);
                scatter::<S, L, Q>(step, addresses, usize::MAX, 1, &downstream);
            }
            RowEnds::Open { inlet, outlet } => {
                let inside = L::moments(&upstream);
                let mut velocity = [S::splat(0.0); 3];
                for (value, column) in velocity.iter_mut().zip(inlet.iter()) {
                    *value = S::load(column.as_ptr().add(first));
                }
                let before = Moments::new(inside.density_excess, velocity, inside.stress);
                scatter::<S, L, Q>(step, addresses, usize::MAX, 1, &L::populations(&before));

                let mut halo = [S::splat(0.0); 4];
                for (value, column) in halo.iter_mut().zip(outlet.iter()) {
                    *value = S::load(column.as_ptr().add(first));
                }
                let inside = L::moments(&downstream);
                let halo = leave(halo, &inside, S::splat(step.outlet_stiffness));
                for (value, column) in halo.iter().zip(outlet.iter_mut()) {
                    value.store(column.as_mut_ptr().add(first));
                }
                let [density_excess, u, v, w] = halo;
                let beyond = Moments::new(density_excess, [u, v, w], inside.stress);
                scatter::<S, L, Q>(step, addresses, n, -1, &L::populations(&beyond));
            }
        }
    }
}

/// Density excess and velocity of the halo cell a step later, given the cell `inside` before it.
#[inline(always)]
fn leave<S: Simd>(halo: [S; 4], inside: &Moments<S>, stiffness: S) -> [S; 4] {
    // Symbols: c speed of sound; l1 amplitude of the wave that enters, l5 of the one that leaves.
    let [excess, u, v, w] = halo;
    let c = S::splat(0.577_350_3);
    let c_squared = S::splat(1.0 / 3.0);
    let half = S::splat(0.5);
    let rho = S::splat(1.0) + excess;
    let outward = u.maximum(S::splat(0.0));
    let pressure_slope = c_squared * (excess - inside.density_excess);
    let speed_slope = rho * c * (u - inside.velocity[0]);
    let l5 = (outward + c) * (pressure_slope + speed_slope);
    let l1 = stiffness * c_squared * excess;
    [
        ((l5 + l1) * S::splat(1.5)).sub_from(S::splat(1.0), excess),
        ((l5 - l1) * half).divide(rho * c).sub_from(S::splat(1.0), u),
        outward.sub_from(v - inside.velocity[1], v),
        outward.sub_from(w - inside.velocity[2], w),
    ]
}

/// Populations after the collision of the cells at `x` of some rows, one row per lane.
#[inline(always)]
unsafe fn gather<S: Simd, const Q: usize>(
    step: &Step<'_>,
    addresses: &[[usize; Q]],
    x: usize,
) -> [S; Q] {
    let mut lanes = [[0.0; MAXIMUM_LANES]; Q];
    for (lane, addresses) in addresses.iter().enumerate() {
        for slot in 0..Q {
            // SAFETY: a cell of a row of this thread.
            lanes[write_direction(step.parity, slot)][lane] =
                unsafe { *step.air.add(addresses[slot] + x) };
        }
    }
    let mut populations = [S::splat(0.0); Q];
    for q in 0..Q {
        // SAFETY: a buffer of the widest vector.
        populations[q] = unsafe { S::load(lanes[q].as_ptr()) };
    }
    populations
}

/// Writes those of `populations` that go along x as `direction` to the halo cells at `x` (−1 is
/// `usize::MAX`).
#[inline(always)]
unsafe fn scatter<S: Simd, L: Stencil<Q>, const Q: usize>(
    step: &Step<'_>,
    addresses: &[[usize; Q]],
    x: usize,
    direction: i8,
    populations: &[S; Q],
) {
    for slot in 0..Q {
        let q = write_direction(step.parity, slot);
        if L::DIRECTIONS[q][0] != direction {
            continue;
        }
        let mut lanes = [0.0; MAXIMUM_LANES];
        // SAFETY: a buffer of the widest vector; then halo cells of rows of this thread.
        unsafe {
            populations[q].store(lanes.as_mut_ptr());
            for (lane, addresses) in addresses.iter().enumerate() {
                *step.air.add(addresses[slot].wrapping_add(x)) = lanes[lane];
            }
        }
    }
}
