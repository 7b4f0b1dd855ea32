//! How averages of fields of any length are made in little memory: strips of points, batches of instants.

use analysis::phases::{Bins, POINT_BYTES};
use basis::records::Grid;
use std::ops::Range;

/// Points that are summed at a time: few, so that their sums stay in a core's cache.
const BLOCK: usize = 128;
/// Bytes of a velocity.
const VELOCITY: u64 = 3 * size_of::<f32>() as u64;
/// Bytes of the moments of a point in a bin.
pub(super) const MOMENTS: u64 = 40;
/// Bytes of a point in what is taken apart of a strip.
const PARTS: u64 = 512;
/// Fewest instants of a batch, unless there are fewer (–).
const FEWEST: u64 = 64;
/// Share of the memory that sums of the points under way may take at most.
const SHARE: u64 = 4;

/// Which points and instants are in memory together.
///
/// Points are taken strip by strip, whole rows that lie in the file one after the other, and each strip
/// through all instants: in one batch where they fit, as then sums can stay in the cache, else in several,
/// between which the sums of the strip stay in memory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plan {
    n_points: usize,
    n_instants: usize,
    /// Points of a strip, the last of which may have fewer.
    of_strip: usize,
    /// Instants of a batch, likewise.
    of_batch: usize,
    /// Points that are summed at a time.
    pub(super) block: usize,
    pub(super) n_threads: usize,
    /// Memory of all of this (bytes).
    pub(crate) memory: u64,
}

impl Plan {
    /// That for `n_instants` on `grid` in `bins` within `memory` (bytes), on `n_threads` at most; whether the
    /// bins are kept counts.
    ///
    /// # Errors
    /// The memory that it takes at least (bytes).
    pub(crate) fn of(
        (grid, n_instants): (&Grid, usize),
        bins: &Bins,
        memory: u64,
        (n_threads, keeps_bins): (usize, bool),
    ) -> Result<Self, u64> {
        let n_points = grid.len();
        let row = grid.n_points.into_iter().find(|n| *n > 1).unwrap_or(1);
        let n_bins = bins.len() as u64 + 1;
        let sums = n_bins * POINT_BYTES + VELOCITY;
        // A batch is read while the one before is summed: two of them are in memory.
        let is_one = 2 * VELOCITY * n_instants as u64 <= 2 * sums;
        let most = if is_one { n_instants as u64 } else { (sums / (2 * VELOCITY)).max(FEWEST) };
        let n_batches = n_instants.div_ceil(most.max(1) as usize).max(1);
        let of_batch = n_instants.div_ceil(n_batches);
        let batch = VELOCITY * of_batch as u64;
        let kept = if keeps_bins { 2 * n_bins * MOMENTS } else { 0 };
        let of_point = 2 * batch + PARTS + kept + if n_batches > 1 { sums } else { 0 };
        let of_work = sums + batch;
        let share = memory / SHARE / of_work;
        let block = (share as usize).clamp(1, BLOCK);
        let n_threads = (share as usize / block).clamp(1, n_threads);
        let work = (block * n_threads) as u64 * of_work;
        let of_row = of_point * row as u64;
        let n_rows = n_points / row;
        let most = (memory.saturating_sub(work) / of_row).min(n_rows as u64) as usize;
        if most == 0 {
            return Err((of_row + of_work) * SHARE / (SHARE - 1));
        }
        let n_strips = n_rows.div_ceil(most);
        let of_strip = row * n_rows.div_ceil(n_strips);
        let memory = work + of_strip as u64 * of_point;
        Ok(Self { n_points, n_instants, of_strip, of_batch, block, n_threads, memory })
    }

    /// The strips, by the numbers of their points.
    pub(crate) fn strips(&self) -> impl ExactSizeIterator<Item = Range<usize>> + Clone + use<> {
        pieces(self.n_points, self.of_strip)
    }

    /// The batches, by the numbers of their instants.
    pub(crate) fn batches(&self) -> impl ExactSizeIterator<Item = Range<usize>> + Clone + use<> {
        pieces(self.n_instants, self.of_batch)
    }

    /// Most points of a strip.
    pub(super) fn of_strip(&self) -> usize {
        self.of_strip
    }
}

/// `n` in pieces `of` so many.
pub(super) fn pieces(
    n: usize,
    of: usize,
) -> impl ExactSizeIterator<Item = Range<usize>> + Clone + use<> {
    let of = of.max(1);
    (0..n.div_ceil(of)).map(move |number| number * of..((number + 1) * of).min(n))
}
