//! Where a population lies in memory: slots, rows, padding, and what the sides do to addresses.
//!
//! One array holds slot after slot, each slot all cells, x fastest. Streaming is in place (AA pattern:
//! Bailey, Myre, Walsh, Lilja, Saar 2009, ICPP, 550): an even step reads and writes the cell itself, an odd
//! step its neighbours, and each address belongs to exactly one cell in either. A row's addresses are `Q`
//! offsets, so that periodic and slip sides are nothing but other offsets: a mirrored direction is a mirrored
//! slot. Open sides have the offsets of slip ones: what would come back mirrored is overwritten by what comes
//! from beyond.
//!
//! | step | population f_q before the collision | population f_q after it |
//! | --- | --- | --- |
//! | even | slot q of the cell | slot q̄ of the cell |
//! | odd | slot q̄ of the neighbour against q | slot q of the neighbour along q |

use super::stencil::opposite;

/// Values per cache line (–).
pub(crate) const LINE: usize = 16;
/// Values that each slot's start is shifted by against the page grid, so that nineteen streams do not fall
/// into one cache set.
const SKEW: usize = 3 * LINE;
/// Values per page (–).
const PAGE: usize = 1024;

/// Most directions of a velocity set (–).
const MOST_SLOTS: usize = 27;

/// What a row meets beyond the first or last along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    /// The row at the other end.
    Periodic,
    /// Itself, mirrored.
    Slip,
    /// Itself, turned back.
    Hold,
    /// Air beyond the box, whose populations lie where itself, mirrored, would have its own.
    Open,
}

/// Which of the two kinds of step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parity {
    /// Populations lie in their own cells.
    Even,
    /// Populations lie in the neighbours.
    Odd,
}

impl Parity {
    /// Parity of step number `step`.
    pub(crate) fn of(step: u64) -> Self {
        if step.is_multiple_of(2) { Self::Even } else { Self::Odd }
    }
}

/// Sizes and strides, in values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Cells along x, y, z.
    pub(crate) n_cells: [usize; 3],
    /// From a row to the next in y.
    pub(crate) row_stride: usize,
    /// From a row to the next in z.
    plane_stride: usize,
    /// From a slot to the next.
    slot_stride: usize,
    n_slots: usize,
    sides: Edge,
    /// Below and above.
    levels: [Edge; 2],
    directions: [[i8; 3]; MOST_SLOTS],
    /// Slot of the direction mirrored along y, and along z.
    mirrored: [[u8; MOST_SLOTS]; 2],
    /// From a row's first cell in slot 0 to its addresses in an odd step, away from the sides.
    reach: [usize; MOST_SLOTS],
}

impl Layout {
    /// `n_cells` cells with a slot for each of `directions`; `sides` beyond y, `levels` below and above.
    pub(crate) fn new(
        n_cells: [usize; 3],
        directions: &[[i8; 3]],
        sides: Edge,
        levels: [Edge; 2],
    ) -> Self {
        // One halo cell at each end of a row; the one before x = 0 is the last value of the row before.
        let row_stride = (n_cells[0] + 2).next_multiple_of(LINE);
        let plane_stride = row_stride * n_cells[1];
        let slot_stride = (plane_stride * n_cells[2] + LINE).next_multiple_of(PAGE) + SKEW;
        let mut layout = Self {
            n_cells,
            row_stride,
            plane_stride,
            slot_stride,
            n_slots: directions.len(),
            sides,
            levels,
            directions: [[0; 3]; MOST_SLOTS],
            mirrored: [[0; MOST_SLOTS]; 2],
            reach: [0; MOST_SLOTS],
        };
        for (q, direction) in directions.iter().enumerate() {
            layout.directions[q] = *direction;
            for (axis, mirrored) in [1, 2].into_iter().zip(&mut layout.mirrored) {
                let mut image = *direction;
                image[axis] = -image[axis];
                mirrored[q] =
                    directions.iter().position(|other| *other == image).unwrap_or(q) as u8;
            }
            let [x, y, z] = direction.map(isize::from);
            layout.reach[q] = (q * slot_stride)
                .wrapping_add_signed(x + y * row_stride as isize + z * plane_stride as isize);
        }
        layout
    }

    /// Values of the whole array.
    pub(crate) fn n_values(&self) -> usize {
        // A line before the first row for its halo, two after the last for whole-vector reads.
        self.slot_stride * self.n_slots + 3 * LINE
    }

    /// Rows along x.
    pub(crate) fn n_rows(&self) -> usize {
        self.n_cells[1] * self.n_cells[2]
    }

    /// y and z of row number `row`.
    pub(crate) fn place(&self, row: usize) -> [usize; 2] {
        [row % self.n_cells[1], row / self.n_cells[1]]
    }

    /// Offset of x = 0 in slot `slot` of row (`y`, `z`).
    pub(crate) fn row(&self, slot: usize, y: usize, z: usize) -> usize {
        LINE + slot * self.slot_stride + z * self.plane_stride + y * self.row_stride
    }

    /// The `Q` offsets that the populations of the row at (`y`, `z`) are read from and written to at x = 0; x
    /// is added to all of them.
    #[inline(always)]
    pub(crate) fn addresses<const Q: usize>(
        &self,
        parity: Parity,
        y: usize,
        z: usize,
    ) -> [usize; Q] {
        let first = self.row(0, y, z);
        let mut offsets = [0; Q];
        if parity == Parity::Even {
            for (slot, offset) in offsets.iter_mut().enumerate() {
                *offset = first + slot * self.slot_stride;
            }
        } else if y > 0 && y + 1 < self.n_cells[1] && z > 0 && z + 1 < self.n_cells[2] {
            for (offset, reach) in offsets.iter_mut().zip(&self.reach) {
                *offset = first.wrapping_add(*reach);
            }
        } else {
            self.addresses_at_sides(y, z, &mut offsets);
        }
        offsets
    }

    /// As [`Self::addresses`] for an odd step, past the sides.
    #[inline(never)]
    fn addresses_at_sides(&self, y: usize, z: usize, offsets: &mut [usize]) {
        for (q, offset) in offsets.iter_mut().enumerate() {
            *offset = self.odd_address(q, y, z);
        }
    }

    /// One of the offsets of an odd step.
    fn odd_address(&self, q: usize, y: usize, z: usize) -> usize {
        let [ex, ey, ez] = self.directions[q];
        let (y_there, mirror_y) = step(y, ey, self.n_cells[1], self.sides);
        let beyond = self.levels[usize::from(ez > 0)];
        let (z_there, mirror_z) = step(z, ez, self.n_cells[2], beyond);
        if mirror_z && beyond == Edge::Hold {
            return self.row(opposite(q), y, z);
        }
        let mut slot = q;
        for (mirror, mirrored) in [mirror_y, mirror_z].into_iter().zip(&self.mirrored) {
            if mirror {
                slot = usize::from(mirrored[slot]);
            }
        }
        self.row(slot, y_there, z_there).wrapping_add_signed(isize::from(ex))
    }

    /// Where population `direction` of `cell` lies that the next step, of `parity`, reads.
    pub(crate) fn arriving(
        &self,
        parity: Parity,
        [x, y, z]: [usize; 3],
        direction: usize,
    ) -> usize {
        self.address(parity, read_direction(parity, direction), y, z) + x
    }

    /// Where population `direction` of `cell` lies that the last step, of `parity`, wrote.
    pub(crate) fn leaving(&self, parity: Parity, [x, y, z]: [usize; 3], direction: usize) -> usize {
        self.address(parity, write_direction(parity, direction), y, z) + x
    }

    /// The direction that is `direction` mirrored along y.
    pub(crate) fn mirrored(&self, direction: usize) -> usize {
        usize::from(self.mirrored[0][direction])
    }

    /// Whether what goes along `direction` from level `z` is turned back by what holds the air there.
    pub(crate) fn turns_back(&self, direction: usize, z: usize) -> bool {
        let beyond = match self.directions[direction][2] {
            -1 if z == 0 => self.levels[0],
            1 if z + 1 == self.n_cells[2] => self.levels[1],
            _ => return false,
        };
        beyond == Edge::Hold
    }

    /// Address number `slot` of the row at (`y`, `z`).
    fn address(&self, parity: Parity, slot: usize, y: usize, z: usize) -> usize {
        match parity {
            Parity::Even => self.row(slot, y, z),
            Parity::Odd => self.odd_address(slot, y, z),
        }
    }
}

/// From `place` one step along `direction` on an axis of `n` rows: where it ends, and whether it was
/// mirrored.
fn step(place: usize, direction: i8, n: usize, edge: Edge) -> (usize, bool) {
    match direction {
        1 if place + 1 == n => match edge {
            Edge::Periodic => (0, false),
            Edge::Slip | Edge::Hold | Edge::Open => (place, true),
        },
        -1 if place == 0 => match edge {
            Edge::Periodic => (n - 1, false),
            Edge::Slip | Edge::Hold | Edge::Open => (place, true),
        },
        _ => (place.wrapping_add_signed(isize::from(direction)), false),
    }
}

/// Direction of the population that address number `slot` holds before the collision.
#[inline(always)]
pub(crate) const fn read_direction(parity: Parity, slot: usize) -> usize {
    match parity {
        Parity::Even => slot,
        Parity::Odd => opposite(slot),
    }
}

/// Direction of the population that address number `slot` holds after the collision.
#[inline(always)]
pub(crate) const fn write_direction(parity: Parity, slot: usize) -> usize {
    match parity {
        Parity::Even => opposite(slot),
        Parity::Odd => slot,
    }
}

#[cfg(test)]
mod tests {
    use super::super::stencil::{D3Q19, Stencil};
    use super::super::stencil27::D3Q27;
    use super::*;
    use std::collections::BTreeSet;

    fn each_once<L: Stencil<Q>, const Q: usize>(
        n_cells: [usize; 3],
        sides: Edge,
        levels: [Edge; 2],
    ) {
        let layout = Layout::new(n_cells, &L::DIRECTIONS, sides, levels);
        for parity in [Parity::Even, Parity::Odd] {
            let mut seen = BTreeSet::new();
            for row in 0..layout.n_rows() {
                let [y, z] = layout.place(row);
                let addresses: [usize; Q] = layout.addresses(parity, y, z);
                for offset in addresses {
                    for x in 0..n_cells[0] {
                        assert!(offset + x < layout.n_values());
                        assert!(
                            seen.insert(offset + x),
                            "{parity:?} {n_cells:?} y {y} z {z} x {x}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn every_address_belongs_to_one_cell() {
        use Edge::{Hold, Open, Periodic, Slip};
        for (sides, levels) in [
            (Periodic, [Slip; 2]),
            (Slip, [Slip; 2]),
            (Slip, [Periodic; 2]),
            (Periodic, [Periodic; 2]),
            (Periodic, [Hold, Slip]),
            (Slip, [Hold; 2]),
            (Open, [Hold, Slip]),
        ] {
            for n_cells in [[5, 4, 3], [4, 1, 2], [4, 2, 1], [7, 3, 4]] {
                each_once::<D3Q19, 19>(n_cells, sides, levels);
                each_once::<D3Q27, 27>(n_cells, sides, levels);
            }
        }
    }

    #[test]
    fn rows_inside_are_reached_as_rows_at_the_sides_are() {
        let layout = Layout::new([6, 5, 4], &D3Q27::DIRECTIONS, Edge::Slip, [Edge::Periodic; 2]);
        let quick: [usize; 27] = layout.addresses(Parity::Odd, 2, 1);
        let mut slow = [0; 27];
        layout.addresses_at_sides(2, 1, &mut slow);
        assert_eq!(quick, slow);
    }
}
