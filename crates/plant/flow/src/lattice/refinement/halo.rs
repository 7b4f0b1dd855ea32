//! Values beyond the ends of a box, from the cells of the grid around.
//!
//! What lies there has the value of the cell around that holds it, and goes on from that one's middle with
//! its slopes, as populations that enter the box do: a linear field crosses unchanged.

use super::boxes::Beyond;
use super::paths::Source;
use crate::lattice::cell_box::CellBox;
use crate::lattice::fields::REACH;
use crate::lattice::heat_links::HeatExchange;
use crate::lattice::joint::Faces;
use crate::lattice::layout::Edge;
use std::collections::BTreeMap;

/// From the middle of a cell to those of its children along an axis (cells).
const ASIDE: f32 = 0.25;

/// Where a box lies in the grid around.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Cells around that it covers.
    pub(super) covered: CellBox,
    /// Cells around along x, y, z.
    pub(super) n_cells: [usize; 3],
    /// What lies beyond these.
    pub(super) beyond: Beyond,
    /// Ends of the box that lie in the air around.
    pub(super) faces: Faces,
}

/// An end of the box that lies in the air around.
#[derive(Clone, Copy)]
pub(super) struct End {
    pub(super) axis: usize,
    /// Whether it is the last one along the axis.
    pub(super) is_last: bool,
}

/// Some values beyond the ends of a box, each a part of a source among the cells around.
#[derive(Default)]
pub(super) struct Halo {
    /// Places around that are asked for.
    pub(super) asked: Vec<usize>,
    /// Cells around and their neighbours: indices of what is asked for.
    sources: Vec<Source>,
    /// Places beyond the box, and for each eight times its source and its number among the children.
    pub(super) places: Vec<usize>,
    parts: Vec<u32>,
}

impl Place {
    /// Ends that lie in the air around.
    pub(super) fn ends(&self) -> impl Iterator<Item = End> + use<> {
        let faces = self.faces;
        let all = (0..3).flat_map(|axis| [false, true].map(|is_last| End { axis, is_last }));
        all.filter(move |end| faces[end.axis][usize::from(end.is_last)])
    }

    /// Cells around that lie `depth` cells (1 or more) beyond an `end`, x fastest.
    pub(super) fn beside(
        &self,
        end: End,
        depth: usize,
    ) -> impl Iterator<Item = [usize; 3]> + use<> {
        let CellBox { mut low, mut high } = self.covered;
        let End { axis, is_last } = end;
        low[axis] = if is_last { high[axis] + depth - 1 } else { low[axis] - depth };
        high[axis] = low[axis] + 1;
        CellBox { low, high }.cells()
    }

    /// First child of `cell` as the box counts its cells.
    pub(super) fn within(&self, cell: [usize; 3]) -> [isize; 3] {
        std::array::from_fn(|axis| 2 * (cell[axis] as isize - self.covered.low[axis] as isize))
    }

    /// The cell before or `after` another along `axis`, if there is one.
    fn neighbour(&self, cell: [usize; 3], axis: usize, after: bool) -> Option<[usize; 3]> {
        let n = self.n_cells[axis];
        let mut there = cell;
        there[axis] = match (after, self.beyond[axis][usize::from(after)]) {
            (false, _) if cell[axis] > 0 => cell[axis] - 1,
            (true, _) if cell[axis] + 1 < n => cell[axis] + 1,
            (false, Some(Edge::Periodic)) => n - 1,
            (true, Some(Edge::Periodic)) => 0,
            _ => return None,
        };
        Some(there)
    }

    /// On return `children` holds what the `values` of all levels around are on those of the box.
    pub(super) fn divide_levels(&self, values: &[f32], children: &mut [f32]) {
        let levels = self.covered.low[2]..self.covered.high[2];
        for (children, level) in children.chunks_exact_mut(2).zip(levels) {
            let at = |after| self.neighbour([0, 0, level], 2, after).map(|[_, _, z]| values[z]);
            let here = values[level];
            let [below, above] = [at(false), at(true)];
            let both = below.is_some() && above.is_some();
            let slope = slope_upwards([below.unwrap_or(here), here, above.unwrap_or(here)], both);
            children[0] = values[level] - ASIDE * slope;
            children[1] = values[level] + ASIDE * slope;
        }
    }

    /// Temperatures that damping goes to on the levels of the box, in the grid `around`.
    pub(super) fn targets(&self, around: &mut dyn HeatExchange) -> Vec<f32> {
        let mut targets = vec![0.0; 2 * (self.covered.high[2] - self.covered.low[2])];
        self.divide_levels(&around.targets(), &mut targets);
        targets
    }
}

/// Slope upwards of a value between that `below` and that `above` it, of which `both` are there or one is
/// the value `here` itself: what goes on with it makes no new extremes, so that no cold air lies at the foot
/// of an inversion above what is warmer (van Leer 1977, J. Comput. Phys. 23, 276).
fn slope_upwards([below, here, above]: [f32; 3], both: bool) -> f32 {
    if !both {
        return above - below;
    }
    let [rise, gain] = [here - below, above - here];
    let least = 2.0 * rise.abs().min(gain.abs());
    let central = 0.5 * (above - below);
    if rise * gain > 0.0 { central.clamp(-least, least) } else { 0.0 }
}

impl Halo {
    /// Values in as many cells of the box's size as its cells reach beyond the `ends` of the box `inside` at
    /// `place` in the grid `around`.
    pub(super) fn deep(
        place: &Place,
        around: &dyn HeatExchange,
        inside: &dyn HeatExchange,
    ) -> Self {
        let mut halo = Self::default();
        let mut known = BTreeMap::new();
        for end in place.ends() {
            for depth in 1..=REACH.div_ceil(2) {
                for cell in place.beside(end, depth) {
                    let around_it = |axis| [false, true].map(|a| place.neighbour(cell, axis, a));
                    let neighbours = [0, 1, 2].map(around_it);
                    halo.source(cell, neighbours, &mut known, around);
                    halo.give(place, cell, inside, |child| reaches(child, end, place));
                }
            }
        }
        halo
    }

    /// Values of the cells next to the ends along `axis` alone, as the cells outside tell them: those that
    /// the box covers have no wind that means anything.
    pub(super) fn shallow(
        place: &Place,
        axis: usize,
        around: &dyn HeatExchange,
        inside: &dyn HeatExchange,
    ) -> Self {
        let mut halo = Self::default();
        let mut known = BTreeMap::new();
        for end in place.ends().filter(|end| end.axis == axis) {
            for cell in place.beside(end, 1) {
                let around_it = |axis| [false, true].map(|a| place.neighbour(cell, axis, a));
                let mut neighbours = [0, 1, 2].map(around_it);
                neighbours[axis][usize::from(!end.is_last)] = None;
                halo.source(cell, neighbours, &mut known, around);
                halo.give(place, cell, inside, |child| depth(child, end, place) == 1);
            }
        }
        halo
    }

    /// Adds `cell` around and its `neighbours` to the sources.
    fn source(
        &mut self,
        cell: [usize; 3],
        neighbours: [[Option<[usize; 3]>; 2]; 3],
        known: &mut BTreeMap<[usize; 3], u32>,
        around: &dyn HeatExchange,
    ) {
        let asked = &mut self.asked;
        let mut ask = |cell: [usize; 3]| {
            *known.entry(cell).or_insert_with(|| {
                asked.push(around.place(cell.map(|place| place as isize)));
                asked.len() as u32 - 1
            })
        };
        let source = Source {
            here: ask(cell),
            around: neighbours.map(|pair| pair.map(|there| ask(there.unwrap_or(cell)))),
            per_distance: neighbours
                .map(|pair| if pair.iter().all(Option::is_some) { 0.5 } else { 1.0 }),
        };
        self.sources.push(source);
    }

    /// Adds those children of the last source, `cell`, that are `wanted`.
    fn give(
        &mut self,
        place: &Place,
        cell: [usize; 3],
        inside: &dyn HeatExchange,
        wanted: impl Fn([isize; 3]) -> bool,
    ) {
        let source = self.sources.len() as u32 - 1;
        let first = place.within(cell);
        for number in 0..8 {
            let child = std::array::from_fn(|axis| first[axis] + (number >> axis & 1) as isize);
            if wanted(child) {
                self.places.push(inside.place(child));
                self.parts.push(8 * source + number);
            }
        }
    }

    /// On return `values` holds those of the places from number `first` on, given what was asked for.
    pub(super) fn fill(&self, known: &[f32], first: usize, values: &mut [f32]) {
        let mut last = u32::MAX;
        let (mut mean, mut slopes) = (0.0, [0.0; 3]);
        for (value, part) in values.iter_mut().zip(&self.parts[first..]) {
            if part >> 3 != last {
                last = part >> 3;
                let source = &self.sources[last as usize];
                mean = known[source.here as usize];
                slopes = std::array::from_fn(|axis| {
                    let [before, after] = source.around[axis].map(|index| known[index as usize]);
                    let per_distance = source.per_distance[axis];
                    match axis {
                        2 => slope_upwards([before, mean, after], per_distance < 1.0),
                        _ => (after - before) * per_distance,
                    }
                });
            }
            let [a, b, c]: [f32; 3] =
                std::array::from_fn(|axis| if part >> axis & 1 == 0 { -ASIDE } else { ASIDE });
            *value = mean + (slopes[0] * a + slopes[1] * b + slopes[2] * c);
        }
    }

    /// Memory that it holds (bytes).
    pub(super) fn memory(&self) -> usize {
        size_of::<usize>() * (self.asked.len() + self.places.len())
            + size_of::<Source>() * self.sources.len()
            + size_of::<u32>() * self.parts.len()
    }
}

/// How many cells of the box's size `child` lies beyond an `end` of it (1 is next to it).
fn depth(child: [isize; 3], end: End, place: &Place) -> usize {
    let End { axis, is_last } = end;
    let n = 2 * (place.covered.high[axis] - place.covered.low[axis]) as isize;
    (if is_last { child[axis] - n + 1 } else { -child[axis] }) as usize
}

/// Whether cells of the box look as far as `child` beyond the `end`.
fn reaches(child: [isize; 3], end: End, place: &Place) -> bool {
    depth(child, end, place) <= REACH
}
