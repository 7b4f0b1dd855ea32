//! Temperature of a box at the start, where the inflow tells it.
//!
//! At the middles of the box's cells it is another one in the mean than at the middles of the cells around:
//! by 0.1 K at the foot of an inversion of 0.75 K a cell, with which a box would rise as a whole until the
//! inflow has passed. So a cell keeps how much it departs from the others of its level among the children of
//! a cell around, as the inflow tells at its own place, and the two levels get what that cell and its slope
//! upwards say: as buoyancy's means are divided, and as what blows in later is. So the mean over the eight is
//! the temperature of the cell around, and layered air is at rest.

use super::halo::Place;
use super::heat;
use crate::lattice::cell_box::CellBox;
use crate::lattice::solver::Lattice;

/// On return the cells of the box `inside` at `place`, which hold what the inflow tells at their places, have
/// the means of those of the grid `around`, which is at its start as well.
pub(super) fn join(place: &Place, around: &Lattice, inside: &mut Lattice) {
    let CellBox { low, high } = place.covered;
    let [n_x, n_y, n_z]: [usize; 3] = std::array::from_fn(|axis| high[axis] - low[axis]);
    // Of each two times two children of a level.
    let mut lacking = vec![0.0; n_x * n_y * 2 * n_z];
    let mut column = vec![0.0; place.n_cells[2]];
    let mut levels = vec![0.0; 2 * n_z];
    for y in 0..n_y {
        for x in 0..n_x {
            for (z, value) in column.iter_mut().enumerate() {
                *value = around.warmth([low[0] + x, low[1] + y, z]);
            }
            place.divide_levels(&column, &mut levels);
            for (level, wanted) in levels.iter().enumerate() {
                let child = |aside: usize| [2 * x + (aside & 1), 2 * y + (aside >> 1), level];
                let [a, b, c, d] = [0, 1, 2, 3].map(|aside| inside.warmth(child(aside)));
                lacking[(level * n_y + y) * n_x + x] = wanted - 0.25 * ((a + b) + (c + d));
            }
        }
    }
    let n_cells = inside.n_cells();
    let inside = heat(inside);
    inside.cover([0; 3], n_cells, &|[y, z], values| {
        let lacking = &lacking[(z * n_y + y / 2) * n_x..][..n_x];
        for (pair, lacking) in values.chunks_exact_mut(2).zip(lacking) {
            pair.iter_mut().for_each(|value| *value += lacking);
        }
    });
    inside.settle(0..n_cells[2]);
}
