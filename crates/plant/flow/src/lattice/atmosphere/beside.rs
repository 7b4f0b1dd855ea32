//! Temperature beyond open sides, and the wind through them that carries it.

use crate::lattice::layout::{Edge, LINE};
use crate::lattice::memory::Memory;

/// Temperatures beyond both sides, level by level, as departures from the reference (K), the same at every
/// distance, as beyond the inlet; and the wind along y next to the box (cells per step).
///
/// Each row of it is written by the thread of the row of the box beside it, before any thread reads it in the
/// same step.
pub(crate) struct Beside {
    memory: Memory,
    stride: usize,
    n_levels: usize,
}

impl Beside {
    /// Those of a box of `n_cells` with `sides`, if these are open. None at all when the system refuses the
    /// memory.
    pub(super) fn new(n_cells: [usize; 3], sides: Edge) -> Option<Option<Self>> {
        if sides != Edge::Open {
            return Some(None);
        }
        let stride = n_cells[0].next_multiple_of(LINE);
        let memory = Memory::zeroed(4 * n_cells[2] * stride)?;
        Some(Some(Self { memory, stride, n_levels: n_cells[2] }))
    }

    /// First temperature beyond the first (0) or last `side` at level `z`; whole vectors of a row's cells
    /// follow.
    #[inline(always)]
    pub(super) fn row(&self, side: usize, z: usize) -> *mut f32 {
        // Inside the array for levels of the box.
        self.memory.start().wrapping_add((side * self.n_levels + z) * self.stride)
    }

    /// The wind there, likewise.
    #[inline(always)]
    pub(super) fn wind(&self, side: usize, z: usize) -> *mut f32 {
        self.row(2 + side, z)
    }

    /// Memory that they hold (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.memory.bytes()
    }
}
