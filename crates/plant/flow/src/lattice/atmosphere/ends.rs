//! Temperature at the ends of rows: what leaves downstream enters upstream, or what enters has a temperature
//! and what leaves takes its own along.

use super::heat::{self, DIRECTIONS, N_HEAT};
use super::sweep::StepHeat;
use crate::lattice::layout::{Parity, write_direction};
use crate::lattice::simd::Portable;
use crate::lattice::simd::Simd;

/// Wind and temperature that enter a row.
#[derive(Clone, Copy)]
pub(crate) struct Entering {
    /// Departure from the reference temperature (K).
    pub(crate) temperature: f32,
    /// Cells a step.
    pub(crate) velocity: [f32; 3],
}

/// Gives the halo cells of a row that was just swept the populations that stream into it next.
///
/// # Safety
/// As for the sweep; the row's cells have been collided in this step.
#[inline(always)]
pub(crate) unsafe fn close(
    air: &StepHeat<'_>,
    parity: Parity,
    addresses: &[usize; N_HEAT],
    entering: Option<Entering>,
) {
    let last = air.layout.n_cells[0] - 1;
    for (slot, address) in addresses.iter().enumerate() {
        let q = write_direction(parity, slot);
        let [along, ..] = DIRECTIONS[q];
        // SAFETY: cells of a row of this thread, and its halo.
        unsafe {
            let place = air.heat.add(*address);
            match (along, entering) {
                (1, None) => *place.wrapping_sub(1) = *place.add(last),
                (1, Some(wind)) => *place.wrapping_sub(1) = population(&wind, q),
                (-1, None) => *place.add(last + 1) = *place,
                (-1, Some(_)) => *place.add(last + 1) = *place.add(last),
                _ => {}
            }
        }
    }
}

/// Population `q` of air in equilibrium.
#[inline(always)]
fn population(wind: &Entering, q: usize) -> f32 {
    let velocity = wind.velocity.map(Portable::splat);
    let temperature = Portable::splat(wind.temperature);
    let mut lanes = [0.0; Portable::LANES];
    // SAFETY: as many values as lanes; any machine has these instructions.
    unsafe {
        heat::equilibrium(temperature, velocity)[q].store(lanes.as_mut_ptr());
    }
    lanes[0]
}
