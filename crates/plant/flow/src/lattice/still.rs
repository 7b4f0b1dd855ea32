//! What acts on a cell beside its neighbours and the forces of bodies: nothing, in air that is alike
//! everywhere.

use super::collision::{Relaxation, relaxation_rate};
use super::stencil::Moments;
use crate::simd::Simd;

/// What acts on the air during a step.
pub(crate) trait Air {
    /// The same on one row.
    type Row<S: Simd>: RowAir<S>;

    /// What acts on the row at (y, z), under Smagorinsky's factor `subgrid`.
    fn row<S: Simd>(&self, place: [usize; 2], subgrid: f32) -> Self::Row<S>;
}

/// What acts on the cells of a row.
pub(crate) trait RowAir<S: Simd> {
    /// Whether it pushes every cell.
    const PUSHES: bool;

    /// Rate at which the stress of the cells from `x` relaxes, in `state` and with `time` for the air's own
    /// viscosity; what pushes them is added to `force`.
    ///
    /// # Safety
    /// As for the sweep: whole vectors of a row from `x`, padding included.
    unsafe fn judge(&self, state: &Moments<S>, time: S, x: usize, force: &[*mut f32; 3]) -> S;

    /// Takes note that all cells of the row were judged.
    ///
    /// # Safety
    /// As above.
    unsafe fn close(&self);
}

/// Air that is alike everywhere.
pub(crate) struct Still;

/// A row of it: Smagorinsky's factor.
pub(crate) struct StillRow<S>(S);

impl Air for Still {
    type Row<S: Simd> = StillRow<S>;

    #[inline(always)]
    fn row<S: Simd>(&self, _: [usize; 2], subgrid: f32) -> StillRow<S> {
        StillRow(S::splat(subgrid))
    }
}

impl<S: Simd> RowAir<S> for StillRow<S> {
    const PUSHES: bool = false;

    #[inline(always)]
    unsafe fn judge(&self, state: &Moments<S>, time: S, _: usize, _: &[*mut f32; 3]) -> S {
        relaxation_rate(state, &Relaxation { time, subgrid: self.0 })
    }

    #[inline(always)]
    unsafe fn close(&self) {}
}
