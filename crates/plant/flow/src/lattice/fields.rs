//! Where temperature, what a step tells of the wind, and the viscosity of eddies lie in memory.
//!
//! One array holds field after field, each all cells, x fastest. The three values before a row and the three
//! behind it are those of neighbours beyond its ends. A box of finer cells has as many rows and levels beyond
//! its sides where these lie in the air around, whose values are given there.

use super::joint::Faces;
use super::layout::{Edge, LINE, Layout};
use super::memory::Memory;
use super::values::{read_values, write_values};
use std::io::{Read, Result, Write};
use std::ops::Range;

/// Values beyond either end of a row that its cells look at (–).
pub(super) const REACH: usize = 3;

/// A quantity of every cell, in lattice units but for kelvin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Field {
    /// Departure of the temperature from the reference (K), after an even number of steps.
    Even,
    /// The same after an odd number.
    Odd,
    /// Change of temperature in the last step by wind and conduction (K a step).
    Change,
    /// Diffusivity of the step under way.
    Diffusivity,
    /// Wind of the step under way along x, y, z, half-way through its forces where there is temperature.
    Wind(usize),
    /// Viscosity of eddies in the step to come, where it follows from the wind of neighbours.
    Viscosity,
}

impl Field {
    /// Its number among all (–).
    const fn number(self) -> usize {
        match self {
            Self::Even => 0,
            Self::Odd => 1,
            Self::Change => 2,
            Self::Diffusivity => 3,
            Self::Wind(axis) => 4 + axis,
            Self::Viscosity => 7,
        }
    }
}

/// Fields of air with temperature that outlast a step.
pub(super) const KEPT: [Field; N_KEPT] = [Field::Even, Field::Odd, Field::Change];
/// Their number (–).
pub(super) const N_KEPT: usize = 3;

/// The fields of a box.
pub(crate) struct Fields {
    memory: Memory,
    pub(super) n_cells: [usize; 3],
    row_stride: usize,
    level_stride: usize,
    field_stride: usize,
    /// From a field's start to its first cell.
    first: usize,
    /// Numbers of the fields that there are.
    held: Range<usize>,
    /// What lies beyond y, and below and above, where it is not the air around.
    pub(super) sides: Edge,
    pub(super) levels: [Edge; 2],
    /// Which ends of each axis lie in the air of a grid around.
    pub(super) joined: Faces,
}

impl Fields {
    /// Those of air with temperature on the cells of `layout`, with `sides` beyond y and `levels` below and
    /// above but for the ends that are `joined` to a grid around, all zero; `viscosity` says whether that of
    /// eddies is among them. None when the system refuses the memory.
    pub(super) fn warm(
        layout: &Layout,
        sides: Edge,
        levels: [Edge; 2],
        joined: Faces,
        viscosity: bool,
    ) -> Option<Self> {
        let end = if viscosity { Field::Viscosity } else { Field::Wind(2) };
        Self::of(Field::Even.number()..end.number() + 1, layout, sides, levels, joined)
    }

    /// Those of air without temperature whose eddies have a viscosity, likewise.
    pub(super) fn of_eddies(layout: &Layout, sides: Edge, levels: [Edge; 2]) -> Option<Self> {
        let held = Field::Wind(0).number()..Field::Viscosity.number() + 1;
        Self::of(held, layout, sides, levels, Faces::default())
    }

    /// No field at all.
    pub(super) fn none(layout: &Layout, sides: Edge, levels: [Edge; 2]) -> Option<Self> {
        Self::of(0..0, layout, sides, levels, Faces::default())
    }

    /// Those whose numbers are `held`.
    fn of(
        held: Range<usize>,
        layout: &Layout,
        sides: Edge,
        levels: [Edge; 2],
        joined: Faces,
    ) -> Option<Self> {
        let n_cells = layout.n_cells;
        // Whole vectors, and a line for what lies beyond the ends: `REACH` values at its beginning belong to
        // this row, as many at its end to the next.
        let row_stride = n_cells[0].next_multiple_of(LINE) + LINE;
        let beyond = |axis: usize| joined[axis].map(|joined| if joined { REACH } else { 0 });
        let [[before, behind], [below, above]] = [beyond(1), beyond(2)];
        let level_stride = row_stride * (before + n_cells[1] + behind);
        let field_stride = level_stride * (below + n_cells[2] + above) + LINE;
        let first = LINE + below * level_stride + before * row_stride;
        let memory = Memory::zeroed(field_stride * held.len() + LINE)?;
        Some(Self {
            memory,
            n_cells,
            row_stride,
            level_stride,
            field_stride,
            first,
            held,
            sides,
            levels,
            joined,
        })
    }

    /// Where temperature lies after `n_steps` steps.
    pub(super) fn temperature(n_steps: u64) -> Field {
        if n_steps.is_multiple_of(2) { Field::Even } else { Field::Odd }
    }

    /// Whether `field` is among them.
    pub(super) fn hold(&self, field: Field) -> bool {
        self.held.contains(&field.number())
    }

    /// First cell of row (`y`, `z`) of `field`, which is among them. Rows and levels before the first have
    /// the numbers before zero, which wrap around.
    #[inline(always)]
    pub(super) fn row(&self, field: Field, y: usize, z: usize) -> *mut f32 {
        let row = y.wrapping_mul(self.row_stride);
        let place = z.wrapping_mul(self.level_stride).wrapping_add(row).wrapping_add(self.first);
        // Inside the array for rows of the box.
        self.memory.start().wrapping_add(self.start(field).wrapping_add(place))
    }

    /// Where `field`, which is among them, begins.
    #[inline(always)]
    pub(super) fn start(&self, field: Field) -> usize {
        (field.number() - self.held.start) * self.field_stride
    }

    /// Place from a field's [start](Self::start) of `cell`, which may lie beyond an end where values are
    /// given.
    pub(super) fn place(&self, cell: [isize; 3]) -> usize {
        let steps = cell.iter().zip(self.strides());
        let offset = steps.map(|(place, stride)| place * stride as isize).sum();
        self.first.wrapping_add_signed(offset)
    }

    /// From a cell to the next along x, y, z.
    pub(super) fn strides(&self) -> [usize; 3] {
        [1, self.row_stride, self.level_stride]
    }

    /// All values of all fields, while nobody writes them.
    pub(super) fn values(&self) -> &[f32] {
        self.memory.values()
    }

    /// Address of the first of all values, and their number.
    pub(super) fn all(&mut self) -> (*mut f32, usize) {
        (self.memory.start(), self.memory.values().len())
    }

    /// The cells of row (`y`, `z`) of `field`, while nobody writes it.
    pub(super) fn cells(&self, field: Field, y: usize, z: usize) -> &[f32] {
        // SAFETY: a row of the array; between the passes of a step its fields are read only.
        unsafe { std::slice::from_raw_parts(self.row(field, y, z).cast_const(), self.n_cells[0]) }
    }

    /// The same, to be overwritten.
    pub(super) fn cells_mut(&mut self, field: Field, y: usize, z: usize) -> &mut [f32] {
        // SAFETY: a row of the array, borrowed exclusively.
        unsafe { std::slice::from_raw_parts_mut(self.row(field, y, z), self.n_cells[0]) }
    }

    /// On return `field` is zero everywhere.
    pub(super) fn clear(&mut self, field: Field) {
        let [_, n_y, n_z] = self.n_cells;
        for row in 0..n_y * n_z {
            self.cells_mut(field, row % n_y, row / n_y).fill(0.0);
        }
    }

    /// Writes `field` row by row.
    pub(super) fn write(
        &self,
        field: Field,
        writer: &mut dyn Write,
        bytes: &mut Vec<u8>,
    ) -> Result<()> {
        let [_, n_y, n_z] = self.n_cells;
        (0..n_y * n_z).try_for_each(|row| {
            write_values(writer, bytes, self.cells(field, row % n_y, row / n_y))
        })
    }

    /// Reads what [`write`](Self::write) wrote; what lies beyond the rows' ends is left as it is.
    pub(super) fn read(
        &mut self,
        field: Field,
        reader: &mut dyn Read,
        bytes: &mut Vec<u8>,
    ) -> Result<()> {
        let [_, n_y, n_z] = self.n_cells;
        (0..n_y * n_z).try_for_each(|row| {
            read_values(reader, bytes, self.cells_mut(field, row % n_y, row / n_y))
        })
    }

    /// Memory that they hold (bytes).
    pub(super) fn bytes(&self) -> usize {
        self.memory.bytes()
    }

    /// The row of a level that lies `offset` rows along y from `y`; one in the air around beyond the last
    /// and, wrapped around, before the first where the box is joined to it.
    #[inline(always)]
    pub(super) fn beside(&self, y: usize, offset: isize) -> usize {
        let there = y.wrapping_add_signed(offset);
        if there >= self.n_cells[1] && self.joined[1][usize::from(offset > 0)] {
            return there;
        }
        reach(y, offset, self.n_cells[1], self.sides)
    }

    /// Which of the open sides, the first (0) or the last, lies between `y` and what is `offset` rows on.
    #[inline(always)]
    pub(super) fn side(&self, y: usize, offset: isize) -> Option<usize> {
        let place = y as isize + offset;
        match self.sides {
            Edge::Open if place < 0 => Some(0),
            Edge::Open if place >= self.n_cells[1] as isize => Some(1),
            _ => None,
        }
    }

    /// The level that lies `offset` levels above `z`, where that is one of the box, comes back from its
    /// other side or lies in the air around, as [`beside`](Self::beside).
    #[inline(always)]
    pub(super) fn above(&self, z: usize, offset: isize) -> Option<usize> {
        let n = self.n_cells[2];
        let place = z as isize + offset;
        if (place < 0 || place >= n as isize) && self.joined[2][usize::from(offset > 0)] {
            return Some(place as usize);
        }
        let beyond = self.levels[usize::from(offset > 0)];
        match beyond {
            Edge::Periodic => Some(reach(z, offset, n, beyond)),
            _ if place < 0 || place >= n as isize => None,
            _ => Some(place as usize),
        }
    }
}

/// From `place` on an axis of `n` rows `offset` rows on: around, or mirrored at the ends.
fn reach(place: usize, offset: isize, n: usize, edge: Edge) -> usize {
    let (place, n) = (place as isize + offset, n as isize);
    let there = match edge {
        Edge::Periodic => place.rem_euclid(n),
        // Mirrored; where there are fewer rows than that, the last one.
        _ if place < 0 => (-1 - place).min(n - 1),
        _ if place >= n => (2 * n - 1 - place).max(0),
        _ => place,
    };
    there as usize
}

/// Gives the `reach` values before and behind a `row` of `n` cells those of the row's other end, or those of
/// its last cells.
///
/// # Safety
/// A row of the fields, written by this thread alone.
#[inline(always)]
pub(super) unsafe fn beyond(row: *mut f32, n: usize, reach: usize, periodic: bool) {
    for offset in 0..reach {
        let (first, last) = match periodic {
            true => ((n - 1 - offset % n), offset % n),
            false => (0, n - 1),
        };
        // SAFETY: handed through.
        unsafe {
            *row.wrapping_sub(1 + offset) = *row.add(first);
            *row.add(n + offset) = *row.add(last);
        }
    }
}
