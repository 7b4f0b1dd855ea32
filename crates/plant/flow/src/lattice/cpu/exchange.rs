//! Populations of the engine on the processor, for whoever exchanges them, and how threads share that work.

use super::Cpu;
use crate::lattice::layout::Parity;
use crate::lattice::links::{Exchange, Fill, Link, Way};
use crate::pool::Pool;
use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

/// Values that are filled at a time.
const CHUNK: usize = 256;

impl Exchange for Cpu {
    fn directions(&self) -> &'static [[i8; 3]] {
        self.kernel.directions
    }

    fn places(&self, way: Way, links: &[Link], n_steps: u64) -> Vec<usize> {
        let place = |link: &Link| match way {
            // The last step has the other parity.
            Way::Leaving => self.layout.leaving(Parity::of(n_steps + 1), link.cell, link.direction),
            Way::Arriving => self.layout.arriving(Parity::of(n_steps), link.cell, link.direction),
        };
        links.iter().map(place).collect()
    }

    fn read(&mut self, places: &[usize], values: &mut [f32]) {
        gather(&mut self.pool, self.memory.values(), places, values);
    }

    fn write(&mut self, places: &[usize], fill: &Fill<'_>) {
        let n_values = self.memory.values().len();
        scatter(&mut self.pool, (self.memory.start(), n_values), places, fill);
    }
}

/// On return `values` begins with those of `all` at `places`.
pub(super) fn gather(pool: &mut Pool, all: &[f32], places: &[usize], values: &mut [f32]) {
    let n = places.len().min(values.len());
    fill_up(pool, &mut values[..n], &|first, values| {
        for (value, place) in values.iter_mut().zip(&places[first..]) {
            *value = all[*place];
        }
    });
}

/// On return `values` are what `fill` gives.
pub(super) fn fill_up(pool: &mut Pool, values: &mut [f32], fill: &Fill<'_>) {
    let (n, n_threads) = (values.len(), pool.n_threads());
    let values = Values(values.as_mut_ptr());
    pool.run(&|thread| {
        let range = share(n, thread, n_threads);
        // SAFETY: the ranges of the threads are parts of `values` that do not overlap.
        fill(range.start, unsafe { values.part(range) });
    });
}

/// On return those of the values from an address on, as many as are told, that lie at `places` are what
/// `fill` gives. They are nobody else's meanwhile.
pub(super) fn scatter(pool: &mut Pool, all: (*mut f32, usize), places: &[usize], fill: &Fill<'_>) {
    let n_threads = pool.n_threads();
    let (start, n_values) = all;
    let all = Values(start);
    pool.run(&|thread| {
        let mut room = [0.0; CHUNK];
        let range = share(places.len(), thread, n_threads);
        for (number, chunk) in places[range.clone()].chunks(CHUNK).enumerate() {
            let room = &mut room[..chunk.len()];
            fill(range.start + number * CHUNK, room);
            for (value, place) in room.iter().zip(chunk) {
                assert!(*place < n_values, "a place of another engine");
                // SAFETY: a value of the array, which nobody else touches now; threads that were given the
                // same place both store it as a whole.
                unsafe { all.store(*place, *value) };
            }
        }
    });
}

/// Part of `n` things that falls to `thread`.
pub(super) fn share(n: usize, thread: usize, n_threads: usize) -> Range<usize> {
    thread * n / n_threads..(thread + 1) * n / n_threads
}

/// Values that threads share.
pub(super) struct Values(pub(super) *mut f32);

// SAFETY: what threads do with it is unsafe and says why it may.
unsafe impl Sync for Values {}

impl Values {
    /// The values in `range`.
    ///
    /// # Safety
    /// They exist as long as the result, and nobody else touches them.
    #[expect(clippy::mut_from_ref, reason = "each thread takes another part")]
    pub(super) unsafe fn part(&self, range: Range<usize>) -> &mut [f32] {
        // SAFETY: the caller promises it.
        unsafe { std::slice::from_raw_parts_mut(self.0.add(range.start), range.len()) }
    }

    /// Stores `value` at `place`.
    ///
    /// # Safety
    /// It exists, and nobody touches it now but through this.
    unsafe fn store(&self, place: usize, value: f32) {
        // SAFETY: the caller promises it; words are aligned as values are.
        let word = unsafe { AtomicU32::from_ptr(self.0.add(place).cast()) };
        word.store(value.to_bits(), Ordering::Relaxed);
    }
}
