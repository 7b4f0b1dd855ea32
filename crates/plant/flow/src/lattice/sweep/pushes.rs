//! What pushes the cells of a row: the force densities of bodies, of the wall, and on all cells alike.

use super::{Share, Step};
use crate::lattice::forces::ForceBlock;
use crate::simd::MAXIMUM_LANES;
use std::ops::Range;

/// On return `share` holds the force density on the cells of a row in the range that is given back, and
/// perhaps around it.
///
/// It is the row at (`y`, `z`), number `number` of the thread's rows; where something `pushes` every cell the
/// range is the whole row.
#[inline(always)]
pub(super) fn gather_forces(
    step: &Step<'_>,
    blocks: &[ForceBlock],
    share: &mut Share,
    number: usize,
    [y, z]: [usize; 2],
    pushes: bool,
) -> Range<usize> {
    let Share { wall, force, .. } = share;
    let n = step.layout.n_cells[0];
    let at_wall = z == 0 && !wall[0].is_empty();
    let everywhere = pushes || at_wall || step.acceleration != [0.0; 3];
    let mut range = if everywhere { 0..n } else { n..0 };
    for block in blocks {
        if block.row(y, z).is_some() {
            range.start = range.start.min(block.origin[0]);
            range.end = range.end.max(block.origin[0] + block.size[0]);
        }
    }
    if range.is_empty() {
        return 0..0;
    }
    // Whole vectors, whichever back-end runs.
    range.start -= range.start % MAXIMUM_LANES;
    range.end = range.end.next_multiple_of(MAXIMUM_LANES);
    for (component, value) in force.iter_mut().zip(step.acceleration) {
        component[range.clone()].fill(value);
    }
    if at_wall {
        let start = number * step.layout.row_stride;
        for (component, wall) in force.iter_mut().zip(&*wall) {
            for (value, wall) in component[..n].iter_mut().zip(&wall[start..start + n]) {
                *value += wall;
            }
        }
    }
    for block in blocks {
        if let Some(cells) = block.row(y, z) {
            for (component, source) in force.iter_mut().zip(&block.force) {
                for (value, source) in
                    component[block.origin[0]..].iter_mut().zip(&source[cells.clone()])
                {
                    *value += source;
                }
            }
        }
    }
    range.start..range.end.min(n)
}
