//! Temperature carried by the wind and conducted, after each sweep of the air.
//!
//! Finite volumes on the cells of the lattice. The temperature of a face is upwind of fifth order (Wicker,
//! Skamarock 2002, Mon. Weather Rev. 130, 2088), the wind through it the mean of its cells'; what a step
//! changes is extrapolated from the last two (Adams, Bashforth). The sweep has left the wind and the
//! diffusivity of every cell.
//!
//! # Safety
//! All threads read the temperature and the wind of all rows, and each writes the temperature to come and the
//! change of its own rows only.

use super::beside::Beside;
use super::coefficients::Level;
use super::stratification::HeatShare;
use crate::lattice::fields::{Field, Fields, REACH, beyond};
use crate::lattice::heat_links::{Face, Given};
use crate::lattice::layout::Edge;
use crate::simd::{MAXIMUM_LANES, Portable, Simd};
use std::ops::Range;

/// What all rows of a step share.
pub(crate) struct Transport<'a> {
    pub(super) fields: &'a Fields,
    /// Steps made before this one (–).
    pub(super) n_steps: u64,
    /// Temperatures beyond open sides.
    pub(super) beside: Option<&'a Beside>,
    /// Levels, from the ground up.
    pub(super) levels: &'a [Level],
    /// Departure of the temperatures of the plates below and above from the reference (K), if there are such.
    pub(super) plates: Option<[f32; 2]>,
    /// Whether what leaves a row downstream enters it upstream.
    pub(super) periodic: bool,
    /// Values from a row at the ground to the next in what threads know of them.
    pub(super) ground_stride: usize,
}

/// Carries the temperatures of the rows of `range` over a step, and sums them up row by row in `heat`.
///
/// # Safety
/// As the module says; `S`'s instructions are there.
#[inline(always)]
pub(crate) unsafe fn rows<S: Simd>(
    step: &Transport<'_>,
    range: Range<usize>,
    heat: &mut HeatShare,
) {
    let [n, n_y, _] = step.fields.n_cells;
    for (number, row) in range.enumerate() {
        let [y, z] = [row % n_y, row / n_y];
        let HeatShare { surface, beyond: ghosts, none, sums, .. } = heat;
        ghosts.fill(step, y, z);
        let source = match z {
            0 => surface.source[number * step.ground_stride..].as_ptr(),
            _ => none.as_ptr(),
        };
        // SAFETY: handed through.
        unsafe {
            let row = Row::new(step, ghosts, [y, z], source);
            sums[number] = row.carry::<S>(n);
            if step.fields.joined[0] == [false; 2] {
                close_row(row.next, n, step.periodic, row.entering);
            }
        }
    }
}

/// Temperatures that one thread finds beyond the ground, and beyond the top.
pub(crate) struct Ghosts([[Vec<f32>; REACH]; 2]);

impl Ghosts {
    /// Room for rows of `n_cells`.
    pub(super) fn new(n_cells: usize) -> Self {
        let row = |_| vec![0.0; n_cells.next_multiple_of(MAXIMUM_LANES)];
        Self([std::array::from_fn(row), std::array::from_fn(row)])
    }

    /// On return they hold what lies beyond the ground and the top of row (`y`, `z`) where these are near and
    /// it is not given: a slope that goes on, or that to the plate.
    fn fill(&mut self, step: &Transport<'_>, y: usize, z: usize) {
        let fields = step.fields;
        let n_z = fields.n_cells[2];
        let temperature = Fields::temperature(step.n_steps);
        let near = [z < REACH, z + REACH >= n_z];
        for (end, ghosts) in self.0.iter_mut().enumerate() {
            let is_known = fields.levels[end] == Edge::Periodic || fields.joined[2][end];
            if !near[end] || is_known {
                continue;
            }
            let inside = |depth: usize| {
                let depth = depth.min(n_z - 1);
                fields.cells(temperature, y, if end == 0 { depth } else { n_z - 1 - depth })
            };
            for (depth, ghost) in ghosts.iter_mut().enumerate() {
                match step.plates {
                    Some(plates) => {
                        for (ghost, image) in ghost.iter_mut().zip(inside(depth)) {
                            *ghost = 2.0 * plates[end] - image;
                        }
                    }
                    None => {
                        let far = (depth + 1) as f32;
                        let cells = inside(0).iter().zip(inside(1));
                        for (ghost, (first, second)) in ghost.iter_mut().zip(cells) {
                            *ghost = first + far * (first - second);
                        }
                    }
                }
            }
        }
    }
}

/// Cells across an axis: from the third before to the third behind.
type Line = [*const f32; 2 * REACH + 1];

/// One row, and what lies around it.
struct Row {
    /// Its temperature and its neighbours' along x, y, z.
    temperature: [Line; 3],
    /// Wind along each axis, and diffusivity along it: before, here, behind.
    wind: [[*const f32; 3]; 3],
    diffusivity: [[*const f32; 3]; 3],
    /// Whether air passes the faces before and behind along each axis, and whether heat does (1 or 0).
    open: [[f32; 2]; 3],
    conducts: [[f32; 2]; 3],
    change: *mut f32,
    next: *mut f32,
    source: *const f32,
    /// Temperature that fluxes count from.
    base: f32,
    /// Rate of damping and temperature that it goes to.
    damping: [f32; 2],
    /// What of this step's change, and of the last one's, is made.
    weights: [f32; 2],
    /// Temperature that enters at the row's beginning where the inflow does not tell its own (K above the
    /// reference).
    entering: f32,
}

impl Row {
    fn new(step: &Transport<'_>, ghosts: &Ghosts, [y, z]: [usize; 2], source: *const f32) -> Self {
        let fields = step.fields;
        let n_z = fields.n_cells[2];
        let around = |field, axis| neighbours(step, field, axis, [y, z]);
        // In the air around it is that of the last cell.
        let diffusivity = |axis| {
            let here = fields.row(Field::Diffusivity, y, z).cast_const();
            let n = fields.n_cells[axis];
            let [before, _, behind] = around(Field::Diffusivity, axis);
            let place = [0, y, z][axis];
            let given = [place == 0, place + 1 == n];
            let [first, last] =
                [0, 1].map(|end| axis > 0 && given[end] && fields.joined[axis][end]);
            [if first { here } else { before }, here, if last { here } else { behind }]
        };
        let edges = |axis: usize, closed: bool, first, last| {
            [(first, 0), (last, 1)].map(|(at_edge, end)| {
                if closed && at_edge && !fields.joined[axis][end] { 0.0 } else { 1.0 }
            })
        };
        let slips = !matches!(fields.sides, Edge::Periodic | Edge::Open);
        let bounded = fields.levels[0] != Edge::Periodic;
        let open = [
            [1.0; 2],
            edges(1, slips, y == 0, y + 1 == fields.n_cells[1]),
            edges(2, bounded, z == 0, z + 1 == n_z),
        ];
        let mut conducts = open;
        if step.plates.is_some() {
            conducts[2] = [1.0; 2];
        }
        let Level { base, damping, target, .. } = step.levels[z];
        Self {
            temperature: temperatures(step, ghosts, [y, z]),
            wind: [0, 1, 2].map(|axis| around(Field::Wind(axis), axis)),
            diffusivity: [0, 1, 2].map(diffusivity),
            open,
            conducts,
            change: fields.row(Field::Change, y, z),
            next: fields.row(Fields::temperature(step.n_steps + 1), y, z),
            source,
            base,
            damping: [damping, target],
            weights: if step.n_steps == 0 { [1.0, 0.0] } else { [1.5, -0.5] },
            entering: target,
        }
    }

    /// Carries the temperatures of its `n` cells over a step; gives their sum.
    ///
    /// # Safety
    /// As the module says.
    #[inline(always)]
    unsafe fn carry<S: Simd>(&self, n: usize) -> f32 {
        let mut sum = S::splat(0.0);
        let mut x = 0;
        let mut last = S::splat(0.0);
        // SAFETY: rows are padded to whole vectors; what is written behind the last cell is padding.
        unsafe {
            while x < n {
                last = self.vector::<S>(x);
                if x + S::LANES <= n {
                    sum = sum + last;
                }
                x += S::LANES;
            }
        }
        let whole: f32 = lanes(sum)[..S::LANES].iter().sum();
        let rest = if x == n { 0 } else { n + S::LANES - x };
        whole + lanes(last)[..rest].iter().sum::<f32>()
    }

    /// The cells from `x`.
    #[inline(always)]
    unsafe fn vector<S: Simd>(&self, x: usize) -> S {
        // SAFETY: handed through.
        unsafe {
            let here = S::load(self.temperature[0][REACH].add(x));
            let mut change = S::splat(0.0);
            for axis in 0..3 {
                change = change + self.along::<S>(axis, x, here);
            }
            let [this, before] = self.weights;
            let place = self.change.add(x);
            let made = S::splat(this).mul_add(change, S::splat(before) * S::load(place));
            change.store(place);
            let [damping, target] = self.damping;
            let damped = S::splat(damping).mul_add(S::splat(target) - here, made);
            let next = here + (damped + S::load(self.source.add(x)));
            next.store(self.next.add(x));
            next
        }
    }

    /// What flows into the cells from `x`, of temperature `here`, along `axis`.
    #[inline(always)]
    unsafe fn along<S: Simd>(&self, axis: usize, x: usize, here: S) -> S {
        let half = S::splat(0.5);
        let [before, behind] = self.open[axis];
        let [heat_before, heat_behind] = self.conducts[axis];
        // SAFETY: handed through.
        unsafe {
            let mut t = [here; 2 * REACH + 1];
            for (t, place) in t.iter_mut().zip(&self.temperature[axis]) {
                *t = S::load(place.add(x));
            }
            let [a, b, c, d, e, f, g] = t;
            let [wa, wb, wc] = self.wind[axis];
            let wind = S::load(wb.add(x));
            let enters = S::splat(0.5 * before) * (S::load(wa.add(x)) + wind);
            let leaves = S::splat(0.5 * behind) * (wind + S::load(wc.add(x)));
            // Against the level's mean: air that is equally warm everywhere stays so, however it moves, and
            // heat is kept as well as mass through each level.
            let base = S::splat(self.base);
            let carried = through([a, b, c, d, e, f], enters, base)
                - through([b, c, d, e, f, g], leaves, base);
            let [ka, kb, kc] = self.diffusivity[axis];
            let k = S::load(kb.add(x));
            let from_before = S::splat(heat_before) * (S::load(ka.add(x)) + k) * (c - here);
            let from_behind = S::splat(heat_behind) * (k + S::load(kc.add(x))) * (e - here);
            half.mul_add(from_before + from_behind, carried)
        }
    }
}

/// Rows of temperature along each axis through row (`y`, `z`), up to [`REACH`] cells to either side.
fn temperatures(
    step: &Transport<'_>,
    ghosts: &Ghosts,
    [y, z]: [usize; 2],
) -> [[*const f32; 2 * REACH + 1]; 3] {
    let fields = step.fields;
    let at = |y, z| fields.row(Fields::temperature(step.n_steps), y, z).cast_const();
    let mut temperature = [[at(y, z); 2 * REACH + 1]; 3];
    for (index, offset) in (-(REACH as isize)..=REACH as isize).enumerate() {
        temperature[0][index] = at(y, z).wrapping_offset(offset);
        temperature[1][index] = match (step.beside, fields.side(y, offset)) {
            (Some(beside), Some(side)) => beside.row(side, z).cast_const(),
            _ => at(fields.beside(y, offset), z),
        };
        temperature[2][index] = match fields.above(z, offset) {
            Some(z) => at(y, z),
            None if offset < 0 => ghosts.0[0][(-offset) as usize - 1 - z].as_ptr(),
            None => ghosts.0[1][offset as usize + z - fields.n_cells[2]].as_ptr(),
        };
    }
    temperature
}

/// Rows of `field` at row (`y`, `z`) and a cell to either side along `axis`.
fn neighbours(
    step: &Transport<'_>,
    field: Field,
    axis: usize,
    [y, z]: [usize; 2],
) -> [*const f32; 3] {
    let fields = step.fields;
    let at = |y, z| fields.row(field, y, z).cast_const();
    [-1, 0, 1].map(|offset| match axis {
        0 => at(y, z).wrapping_offset(offset),
        1 => match (step.beside, fields.side(y, offset)) {
            // Heat goes through a side with the wind that mass goes with.
            (Some(beside), Some(side)) if field == Field::Wind(1) => {
                beside.wind(side, z).cast_const()
            }
            _ => at(fields.beside(y, offset), z),
        },
        _ => at(y, fields.above(z, offset).unwrap_or(z)),
    })
}

/// Gives what lies beyond the ends of a `row` of `n` temperatures its values: those of its other end, or what
/// is `entering` (K above the reference) and the last one.
///
/// # Safety
/// A row of the fields, written by this thread alone.
#[inline(always)]
pub(super) unsafe fn close_row(row: *mut f32, n: usize, periodic: bool, entering: f32) {
    // SAFETY: the row's own padding.
    unsafe {
        beyond(row, n, REACH, periodic);
        if !periodic {
            upstream(row, entering);
        }
    }
}

/// Gives what lies upstream of a `row` the temperature that is `entering` (K above the reference).
///
/// # Safety
/// A row of the fields whose padding nobody else uses meanwhile.
#[inline(always)]
pub(super) unsafe fn upstream(row: *mut f32, entering: f32) {
    for offset in 1..=REACH {
        // SAFETY: the row's own padding.
        unsafe { *row.wrapping_sub(offset) = entering };
    }
}

/// Flux through a face with `wind`, of temperatures above `base`, between the third and the fourth of `t`.
#[inline(always)]
fn through<S: Simd>(t: [S; 6], wind: S, base: S) -> S {
    let [a, b, c, d, e, f] = t;
    let share = S::splat(1.0 / 60.0);
    let speed = wind.maximum(S::splat(0.0) - wind);
    let even = S::splat(37.0).mul_add(c + d, S::splat(8.0).sub_from(b + e, a + f));
    let odd = S::splat(10.0).mul_add(d - c, S::splat(5.0).sub_from(e - b, f - a));
    let centre = share.mul_add(even, S::splat(0.0) - base);
    speed.sub_from(share * odd, wind * centre)
}

/// On return `fluxes` holds the flux through each of `faces` in a step that finds `temperature`, above those
/// of `bases` that they name, as the rows beside them count it.
pub(in crate::lattice) fn face_fluxes(
    fields: &Fields,
    temperature: Field,
    faces: &[Face],
    bases: &[f32],
    fluxes: &mut [f32],
) {
    type S = Portable;
    let all = fields.values();
    let at = |field, place| all[fields.start(field) + place];
    for (fluxes, faces) in fluxes.chunks_mut(S::LANES).zip(faces.chunks(S::LANES)) {
        let mut known = [[0.0; MAXIMUM_LANES]; 9];
        for (lane, face) in faces.iter().enumerate() {
            let axis = usize::from(face.axis);
            let stride = fields.strides()[axis];
            let cell = |number| face.first + number * stride;
            for (number, known) in known[..6].iter_mut().enumerate() {
                known[lane] = at(temperature, cell(number));
            }
            let [before, behind] = [2, 3].map(cell);
            let wind = Field::Wind(axis);
            known[6][lane] = 0.5 * (at(wind, before) + at(wind, behind));
            let [one, other] = match face.given {
                Given::Neither => [before, behind],
                Given::Before => [behind; 2],
                Given::Behind => [before; 2],
            };
            known[7][lane] = 0.5 * (at(Field::Diffusivity, one) + at(Field::Diffusivity, other));
            known[8][lane] = bases[face.base as usize];
        }
        // SAFETY: buffers of the widest vector.
        let [a, b, c, d, e, f, wind, diffusivity, base] =
            known.map(|values| unsafe { S::load(values.as_ptr()) });
        let flux = diffusivity.mul_add(c - d, through([a, b, c, d, e, f], wind, base));
        fluxes.copy_from_slice(&lanes(flux)[..fluxes.len()]);
    }
}

/// The lanes of `value`.
#[inline(always)]
fn lanes<S: Simd>(value: S) -> [f32; MAXIMUM_LANES] {
    let mut lanes = [0.0; MAXIMUM_LANES];
    // SAFETY: a buffer of the widest vector.
    unsafe { value.store(lanes.as_mut_ptr()) };
    lanes
}
