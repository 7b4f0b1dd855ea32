//! Air without temperature whose cells tell their wind, and find their eddies' viscosity.

use crate::lattice::collision::relaxation_rate_of;
use crate::lattice::fields::{Field, Fields, beyond};
use crate::lattice::stencil::Moments;
use crate::lattice::still::{Air, RowAir};
use crate::simd::Simd;

/// Air that is alike everywhere but for its eddies.
pub(crate) struct Noted<'a> {
    pub(crate) fields: &'a Fields,
    /// Whether what leaves a row downstream enters it upstream.
    pub(crate) periodic: bool,
}

/// A row of it.
pub(crate) struct NotedRow {
    wind: [*mut f32; 3],
    viscosity: *const f32,
    n_cells: usize,
    periodic: bool,
}

impl Air for Noted<'_> {
    type Row<S: Simd> = NotedRow;

    #[inline(always)]
    fn row<S: Simd>(&self, [y, z]: [usize; 2], _: f32) -> NotedRow {
        let row = |field| self.fields.row(field, y, z);
        NotedRow {
            wind: [row(Field::Wind(0)), row(Field::Wind(1)), row(Field::Wind(2))],
            viscosity: row(Field::Viscosity).cast_const(),
            n_cells: self.fields.n_cells[0],
            periodic: self.periodic,
        }
    }
}

impl<S: Simd> RowAir<S> for NotedRow {
    const PUSHES: bool = false;

    #[inline(always)]
    unsafe fn judge(&self, state: &Moments<S>, time: S, x: usize, _: &[*mut f32; 3]) -> S {
        // SAFETY: rows of the fields are padded to whole vectors; this row is this thread's.
        unsafe {
            for (component, row) in state.velocity.iter().zip(self.wind) {
                component.store(row.add(x));
            }
            relaxation_rate_of(S::load(self.viscosity.add(x)), time)
        }
    }

    #[inline(always)]
    unsafe fn close(&self) {
        for row in self.wind {
            // SAFETY: the row's own padding.
            unsafe { beyond(row, self.n_cells, 1, self.periodic) };
        }
    }
}
