//! Temperature between a box and the grid around it.
//!
//! Before each of its steps the box is given the temperatures of three of its cells beyond each end, half-way
//! in time between those around before and after the long step for its second one, and the wind through the
//! end. That is known at the beginning of a long step, and goes on for the second short one as it has changed
//! since the one before. Means of levels, which buoyancy starts from, are those around as well, so that none
//! jumps. After its steps the cells around that it covers have the means of theirs.
//!
//! What passes an end is what the box's cells have let through: the cell around that has counted with a flux
//! of its own has that taken back, and gets the sum of the short steps' instead (Berger, Colella 1989, J.
//! Comput. Phys. 82, 64). So heat is kept to rounding where levels are alike, as mass is. At ends along x and
//! y fluxes count from the same temperature on both sides; at the lower and the upper end from the level's
//! outside. It goes on as the wind does: held for both short steps, a mean that changes would leave a quarter
//! of what it gains in a step in the cells outside.

use super::halo::{End, Halo, Place};
use super::heat;
use crate::lattice::cell_box::CellBox;
use crate::lattice::heat_links::{Face, Given, Heat, HeatExchange};
use crate::lattice::solver::Lattice;
use crate::lattice::values::{read_values, write_values};
use std::io::{Read, Result, Write};
use std::ops::Range;

/// Temperature that a box and the grid around it hand each other.
pub(super) struct HeatCoupling {
    covered: CellBox,
    /// Levels around on which temperatures change.
    touched: Range<usize>,
    levels: Levels,
    temperature: Halo,
    /// What is asked for, and the same a long step later.
    known: [Vec<f32>; 2],
    /// Wind through the ends along each axis, and what it gains in half a long step.
    wind: [Halo; 3],
    blowing: [Vec<f32>; 3],
    gaining: [Vec<f32>; 3],
    gates: Gates,
}

/// Temperatures that buoyancy starts from, and that fluxes count from.
struct Levels {
    place: Place,
    /// What buoyancy starts from in the grid around, before its last step and now.
    means: Vec<f32>,
    now: Vec<f32>,
    /// What fluxes count from there before that step, what it gains in half of one, and as the box counts.
    starts: Vec<f32>,
    gains: Vec<f32>,
    bases: Vec<f32>,
    unused: Vec<f32>,
    /// Of the box.
    own_means: Vec<f32>,
    own_bases: Vec<f32>,
}

/// Faces between the box and the cells around it.
struct Gates {
    /// As the grid around has them.
    long: Vec<Face>,
    /// Four of the box for each.
    short: Vec<Face>,
    /// Places of the cells outside.
    outside: Vec<usize>,
    /// Fluxes along the axis of the last step: around, and in the box, as a cell around counts them.
    last: [Vec<f32>; 2],
    /// What the cells outside are to get (K).
    owed: Vec<f32>,
    fluxes: Vec<f32>,
}

impl HeatCoupling {
    /// That of the box `inside` at `place` in the grid `around`, before their first steps; on return the
    /// cells that it covers have its temperatures.
    pub(super) fn new(place: &Place, around: &mut Lattice, inside: &mut Lattice) -> Self {
        let (near, own) = (&*heat(around), &*heat(inside));
        let temperature = Halo::deep(place, near, own);
        let wind = [0, 1, 2].map(|axis| Halo::shallow(place, axis, near, own));
        let heat = Self {
            covered: place.covered,
            touched: place.covered.low[2].saturating_sub(1)
                ..place.n_cells[2].min(place.covered.high[2] + 1),
            levels: Levels::new(place),
            known: [0, 1].map(|_| vec![0.0; temperature.asked.len()]),
            blowing: wind.each_ref().map(|halo| vec![0.0; halo.places.len()]),
            gaining: wind.each_ref().map(|halo| vec![0.0; halo.places.len()]),
            temperature,
            wind,
            gates: Gates::new(place, near, own),
        };
        heat.cover(around, inside);
        heat
    }

    /// Takes note of the levels of the grid `around` before its step.
    pub(super) fn keep(&mut self, around: &mut Lattice) {
        let has_gained = around.n_steps() > 0;
        let Levels { means, starts, gains, bases, .. } = &mut self.levels;
        heat(around).levels(means, bases);
        for ((gain, start), base) in gains.iter_mut().zip(starts).zip(bases) {
            *gain = if has_gained { 0.5 * (*base - *start) } else { 0.0 };
            *start = *base;
        }
    }

    /// Takes up what the grid `around` has made of wind and temperature in its last step.
    pub(super) fn take(&mut self, around: &mut Lattice) {
        let n_steps = around.n_steps() - 1;
        let weights = weights(n_steps);
        let around = heat(around);
        let [known, _] = &mut self.known;
        for (axis, (halo, blowing)) in self.wind.iter().zip(&mut self.blowing).enumerate() {
            let known = &mut known[..halo.asked.len()];
            around.read(Heat::Wind(axis), &halo.asked, known);
            let gaining = &mut self.gaining[axis];
            gaining.copy_from_slice(blowing);
            halo.fill(known, 0, blowing);
            for (gain, wind) in gaining.iter_mut().zip(&*blowing) {
                // Before the first step there was none that it could have grown from.
                *gain = if n_steps == 0 { 0.0 } else { 0.5 * (wind - *gain) };
            }
        }
        let Gates { long, owed, fluxes, .. } = &mut self.gates;
        let fluxes = &mut fluxes[..long.len()];
        around.fluxes(long, &self.levels.bases, fluxes);
        owed.fill(0.0);
        self.gates.pass(0, -1.0, weights);
    }

    /// Gives the box `inside` what it finds around it in its first (0) or second (1) `step`.
    pub(super) fn surround(&mut self, around: &mut Lattice, inside: &mut Lattice, step: usize) {
        let (around, inside) = (heat(around), heat(inside));
        let [known, later] = &mut self.known;
        let asked = &self.temperature.asked;
        around.read(Heat::Before, asked, known);
        if step == 1 {
            around.read(Heat::Now, asked, later);
            halve(known, later);
        }
        let halo = &self.temperature;
        inside.write(Heat::Now, &halo.places, &|first, values| halo.fill(known, first, values));
        let gained = step as f32;
        for (axis, halo) in self.wind.iter().enumerate() {
            let (blowing, gaining) = (&self.blowing[axis], &self.gaining[axis]);
            inside.write(Heat::Wind(axis), &halo.places, &|first, values| {
                let winds = blowing[first..].iter().zip(&gaining[first..]);
                for (value, (wind, gain)) in values.iter_mut().zip(winds) {
                    *value = wind + gained * gain;
                }
            });
        }
        self.levels.hand_on(around, inside, step);
    }

    /// Takes up what has passed the ends of the box `inside` in its last step.
    pub(super) fn cross(&mut self, inside: &mut Lattice) {
        let weights = weights(inside.n_steps() - 1);
        let Gates { short, fluxes, .. } = &mut self.gates;
        heat(inside).fluxes(short, &self.levels.bases, fluxes);
        gather(fluxes);
        self.gates.pass(1, 1.0, weights);
    }

    /// Hands the grid `around` what has passed the ends, and the temperatures of the box `inside`.
    pub(super) fn give(&mut self, around: &mut Lattice, inside: &Lattice) {
        let Gates { outside, owed, fluxes, .. } = &mut self.gates;
        let near = heat(around);
        let temperatures = &mut fluxes[..outside.len()];
        near.read(Heat::Now, outside, temperatures);
        for (temperature, owed) in temperatures.iter_mut().zip(&*owed) {
            *temperature += owed;
        }
        near.write(Heat::Now, outside, &|first, values| {
            values.copy_from_slice(&temperatures[first..first + values.len()]);
        });
        self.cover(around, inside);
    }

    /// On return the cells of the grid `around` that the box `inside` covers have its temperatures.
    fn cover(&self, around: &mut Lattice, inside: &Lattice) {
        let CellBox { low, high } = self.covered;
        let n_y = inside.n_cells()[1];
        let around = heat(around);
        around.cover(low, high, &|[y, z], values| {
            let first = 2 * (z - low[2]) * n_y + 2 * (y - low[1]);
            let rows = [first, first + 1, first + n_y, first + n_y + 1];
            let [a, b, c, d] = rows.map(|row| inside.engine.temperature(row).unwrap_or_default());
            for (x, value) in values.iter_mut().enumerate() {
                let pair = |row: &[f32]| row[2 * x] + row[2 * x + 1];
                *value = 0.125 * ((pair(a) + pair(b)) + (pair(c) + pair(d)));
            }
        });
        around.settle(self.touched.clone());
    }

    /// Writes what is on its way between two steps of the box, and what the next ones go on from.
    pub(super) fn write_state(&self, writer: &mut dyn Write) -> Result<()> {
        let mut bytes = Vec::new();
        let Levels { means, starts, gains, bases, .. } = &self.levels;
        let [x, y, z] = &self.blowing;
        let [u, v, w] = &self.gaining;
        let Gates { last: [long, short], owed, .. } = &self.gates;
        let levels = [means, starts, gains, bases];
        let gates = [long, short, owed];
        for values in levels.into_iter().chain([x, y, z, u, v, w]).chain(gates) {
            write_values(writer, &mut bytes, values)?;
        }
        Ok(())
    }

    /// Reads what [`write_state`](Self::write_state) wrote.
    pub(super) fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut bytes = Vec::new();
        let Levels { means, starts, gains, bases, .. } = &mut self.levels;
        let [x, y, z] = &mut self.blowing;
        let [u, v, w] = &mut self.gaining;
        let Gates { last: [long, short], owed, .. } = &mut self.gates;
        let levels = [means, starts, gains, bases];
        let gates = [long, short, owed];
        for values in levels.into_iter().chain([x, y, z, u, v, w]).chain(gates) {
            read_values(reader, &mut bytes, values)?;
        }
        Ok(())
    }

    /// Memory that it holds (bytes).
    pub(super) fn memory(&self) -> u64 {
        let halos = self.wind.iter().chain([&self.temperature]).map(Halo::memory);
        let Gates { long, short, outside, fluxes, .. } = &self.gates;
        let blowing: usize = self.blowing.iter().map(Vec::len).sum();
        let n_values = 2 * (self.known[0].len() + blowing) + 3 * long.len() + fluxes.len();
        (halos.sum::<usize>()
            + size_of::<f32>() * n_values
            + size_of::<usize>() * outside.len()
            + size_of::<Face>() * (long.len() + short.len())) as u64
    }
}

impl Levels {
    fn new(place: &Place) -> Self {
        let room = || vec![0.0; place.n_cells[2]];
        let own = || vec![0.0; 2 * (place.covered.high[2] - place.covered.low[2])];
        Self {
            place: *place,
            means: room(),
            now: room(),
            starts: room(),
            gains: room(),
            bases: room(),
            unused: room(),
            own_means: own(),
            own_bases: own(),
        }
    }

    /// Gives the box `inside` those of the grid `around` for its first (0) or second (1) `step`.
    fn hand_on(&mut self, around: &dyn HeatExchange, inside: &mut dyn HeatExchange, step: usize) {
        let Self { place, means, now, gains, bases, unused, own_means, own_bases, .. } = self;
        now.copy_from_slice(means);
        if step == 1 {
            around.levels(now, unused);
            halve(now, means);
            bases.iter_mut().zip(gains).for_each(|(base, gain)| *base += *gain);
        }
        place.divide_levels(now, own_means);
        let first = place.covered.low[2];
        for (level, base) in own_bases.iter_mut().enumerate() {
            *base = bases[first + level / 2];
        }
        inside.refer(own_means, own_bases);
    }
}

impl Gates {
    fn new(place: &Place, around: &dyn HeatExchange, inside: &dyn HeatExchange) -> Self {
        let (mut long, mut short, mut outside) = (Vec::new(), Vec::new(), Vec::new());
        for end in place.ends() {
            let End { axis, is_last } = end;
            let given = if is_last { Given::Behind } else { Given::Before };
            let others = [0, 1, 2].into_iter().filter(|other| *other != axis);
            let others: Vec<usize> = others.collect();
            for cell in place.beside(end, 1) {
                let base = cell[2] as u32;
                let here = cell.map(|place| place as isize);
                outside.push(around.place(here));
                // The third cell before the face, which lies before or behind the cell outside.
                let third = |mut cell: [isize; 3], before: isize| {
                    cell[axis] -= before;
                    cell
                };
                let first = around.place(third(here, if is_last { 3 } else { 2 }));
                long.push(Face { first, axis: axis as u8, given: Given::Neither, base });
                let mut child = place.within(cell);
                child[axis] += if is_last { 0 } else { 1 };
                for number in 0..4 {
                    let mut child = third(child, if is_last { 3 } else { 2 });
                    child[others[0]] += number & 1;
                    child[others[1]] += number >> 1;
                    short.push(Face { first: inside.place(child), axis: axis as u8, given, base });
                }
            }
        }
        let n = long.len();
        Self {
            last: [vec![0.0; n], vec![0.0; n]],
            owed: vec![0.0; n],
            fluxes: vec![0.0; 4 * n],
            long,
            short,
            outside,
        }
    }

    /// Counts `sense` times what the fluxes of a step bring the cells outside, made of themselves and the
    /// last ones of that `grid` (0 around, 1 the box) with `weights`.
    fn pass(&mut self, grid: usize, sense: f32, [this, before]: [f32; 2]) {
        let Self { short, last, owed, fluxes, .. } = self;
        let faces = short.iter().step_by(4).zip(owed);
        for ((face, owed), (last, flux)) in faces.zip(last[grid].iter_mut().zip(fluxes)) {
            let sense = if face.given == Given::Before { -sense } else { sense };
            *owed += sense * (this * *flux + before * *last);
            *last = *flux;
        }
    }
}

/// What of a step's change, and of that of the one before, step number `n_steps` makes.
fn weights(n_steps: u64) -> [f32; 2] {
    if n_steps == 0 { [1.0, 0.0] } else { [1.5, -0.5] }
}

/// On return `values` begins with the flux through each four faces of the box, as it counts in a cell around:
/// its volume is that of eight.
fn gather(values: &mut [f32]) {
    for number in 0..values.len() / 4 {
        let [a, b, c, d] = std::array::from_fn(|part| values[4 * number + part]);
        values[number] = 0.125 * ((a + b) + (c + d));
    }
}

/// On return `values` holds the means of it and `others`.
fn halve(values: &mut [f32], others: &[f32]) {
    for (value, other) in values.iter_mut().zip(others) {
        *value = 0.5 * (*value + other);
    }
}
