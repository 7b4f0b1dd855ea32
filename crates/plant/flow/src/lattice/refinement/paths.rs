//! The ways of populations between a box and the cells around it, followed once.
//!
//! A cell of the grid around that touches the box has eight children of half the size. Each population of it
//! whose way crosses the box is divided among them, and each eighth followed over two steps: it enters the
//! box in the first or second, or passes a corner of the box by. So is each population that leaves the box.
//! All that ends in the eight children of one cell arrives there.

use super::boxes::Beyond;
use crate::lattice::cell_box::CellBox;
use crate::lattice::layout::Edge;
use crate::lattice::links::Link;
use std::collections::BTreeMap;

/// A population of the grid around that is divided, and its neighbours along each axis: indices of
/// [`Paths::asked`].
pub(super) struct Source {
    pub(super) here: u32,
    pub(super) around: [[u32; 2]; 3],
    /// One over their distances (cells).
    pub(super) per_distance: [f32; 3],
}

/// An eighth of a source.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) source: u32,
    /// Where it crosses from one grid to the other, from where the mean of all eight does (cells around).
    pub(super) offset: [f32; 3],
}

/// Something that has reached a cell around the box: an index among the populations that leave the box in the
/// first step, in the second, or among the parts that pass it by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arrival {
    First(u32),
    Second(u32),
    Passing(u32),
}

/// All ways between a box and the grid around it.
#[derive(Default)]
pub(super) struct Paths {
    /// Populations that leave cells around the box, as far as they must be known.
    pub(super) asked: Vec<Link>,
    pub(super) sources: Vec<Source>,
    /// What arrives in the box in the first and in the second step.
    pub(super) entering: [(Vec<Link>, Vec<Part>); 2],
    /// What passes the box by.
    pub(super) passing: Vec<Part>,
    /// What leaves the box, in either step.
    pub(super) leaving: Vec<Link>,
    /// What left the box at an edge in the first step, by its number, and enters it again in the second.
    pub(super) returning: (Vec<Link>, Vec<u32>),
    /// What arrives in cells around the box, and the eight parts of each.
    pub(super) arriving: (Vec<Link>, Vec<[Arrival; 8]>),
}

/// The cells around, divided: coordinates count their children.
struct Grid<'a> {
    n_cells: [usize; 3],
    beyond: &'a Beyond,
    directions: &'static [[i8; 3]],
    /// The box.
    inside: CellBox,
}

impl Grid<'_> {
    /// Where population `direction` of `cell` is a step later, and which it is then. No box stands on other
    /// walls than those that air slips along.
    fn follow(&self, cell: [usize; 3], direction: usize) -> ([usize; 3], usize) {
        let mut there = cell;
        let mut turned = self.directions[direction];
        for axis in 0..3 {
            let step = turned[axis];
            let n = self.n_cells[axis];
            let out = (step < 0 && cell[axis] == 0) || (step > 0 && cell[axis] + 1 == n);
            match self.beyond[axis][usize::from(step > 0)] {
                Some(Edge::Periodic) if out => there[axis] = if step > 0 { 0 } else { n - 1 },
                _ if out => turned[axis] = -step,
                _ => there[axis] = cell[axis].wrapping_add_signed(isize::from(step)),
            }
        }
        (there, self.number(turned))
    }

    fn number(&self, direction: [i8; 3]) -> usize {
        // A velocity set holds the mirror images of its directions.
        self.directions.iter().position(|other| *other == direction).unwrap_or_default()
    }

    /// `cell` as the box counts.
    fn within(&self, cell: [usize; 3]) -> [usize; 3] {
        std::array::from_fn(|axis| cell[axis] - self.inside.low[axis])
    }

    /// The cell around before or after `cell` along `axis`, if it moves and there is one.
    fn neighbour(&self, cell: [usize; 3], axis: usize, after: bool) -> Option<[usize; 3]> {
        let n = self.n_cells[axis] / 2;
        let mut there = cell;
        there[axis] = match (after, self.beyond[axis][usize::from(after)]) {
            (false, _) if cell[axis] > 0 => cell[axis] - 1,
            (true, _) if cell[axis] + 1 < n => cell[axis] + 1,
            (false, Some(Edge::Periodic)) => n - 1,
            (true, Some(Edge::Periodic)) => 0,
            _ => return None,
        };
        (!self.inside.contains(there.map(|place| 2 * place))).then_some(there)
    }
}

/// How an eighth of a population goes on.
enum Fate {
    Enters(usize, Link),
    Passes(Link),
}

/// Paths under construction.
struct Builder<'a> {
    grid: Grid<'a>,
    paths: Paths,
    /// Index among those asked for.
    known: BTreeMap<Link, u32>,
    /// What has arrived where.
    arrived: BTreeMap<(usize, [usize; 3]), Vec<Arrival>>,
}

impl Paths {
    /// The ways between the cells `covered` and those around them, in a grid of `n_cells` cells `beyond`
    /// which lies what is given.
    pub(super) fn new(
        covered: CellBox,
        n_cells: [usize; 3],
        beyond: &Beyond,
        directions: &'static [[i8; 3]],
    ) -> Self {
        let inside = CellBox { low: covered.low.map(|n| 2 * n), high: covered.high.map(|n| 2 * n) };
        // Cells that are no neighbours of a cell outside.
        let core = CellBox { low: inside.low.map(|n| n + 1), high: inside.high.map(|n| n - 1) };
        let grid = Grid { n_cells: n_cells.map(|n| 2 * n), beyond, directions, inside };
        let mut builder = Builder {
            grid,
            paths: Self::default(),
            known: BTreeMap::new(),
            arrived: BTreeMap::new(),
        };
        for direction in 1..directions.len() {
            let ring = covered.grown(1, n_cells).cells().filter(|cell| !covered.contains(*cell));
            ring.for_each(|cell| builder.divide(cell, direction));
            let skin = inside.cells().filter(|cell| !core.contains(*cell));
            skin.for_each(|cell| builder.let_out(cell, direction));
        }
        builder.finish()
    }
}

impl Builder<'_> {
    /// Divides population `direction` of `cell` around the box, if its way crosses the box.
    fn divide(&mut self, cell: [usize; 3], direction: usize) {
        let fates: [Fate; 8] =
            std::array::from_fn(|child| self.fate(child_of(cell, child), direction));
        if !fates.iter().any(|fate| matches!(fate, Fate::Enters(..))) {
            return;
        }
        let mut offsets: [[f32; 3]; 8] = std::array::from_fn(|child| {
            // From the middle of its own way to the middle of the whole one.
            let shift = match fates[child] {
                Fate::Enters(0, _) => -0.25,
                Fate::Enters(..) => 0.25,
                Fate::Passes(_) => 0.0,
            };
            let bits = child_of([0; 3], child);
            std::array::from_fn(|axis| {
                let step = f32::from(self.grid.directions[direction][axis]);
                bits[axis] as f32 * 0.5 - 0.25 + shift * step
            })
        });
        // The eighths are to sum up to what is divided.
        let mean: [f32; 3] = std::array::from_fn(|axis| {
            offsets.iter().map(|offset| offset[axis]).sum::<f32>() / 8.0
        });
        for (offset, mean) in offsets.iter_mut().flat_map(|offset| offset.iter_mut().zip(mean)) {
            *offset -= mean;
        }
        let source = self.paths.sources.len() as u32;
        let new = self.source(cell, direction);
        self.paths.sources.push(new);
        for (fate, offset) in fates.into_iter().zip(offsets) {
            let part = Part { source, offset };
            match fate {
                Fate::Enters(step, link) => {
                    let (links, parts) = &mut self.paths.entering[step];
                    links.push(link);
                    parts.push(part);
                }
                Fate::Passes(link) => {
                    self.arrive(link, Arrival::Passing(self.paths.passing.len() as u32));
                    self.paths.passing.push(part);
                }
            }
        }
    }

    /// How population `direction` of `cell`, outside the box, goes on for two steps.
    fn fate(&self, cell: [usize; 3], direction: usize) -> Fate {
        let grid = &self.grid;
        let (mut cell, mut direction) = (cell, direction);
        for step in 0..2 {
            (cell, direction) = grid.follow(cell, direction);
            if grid.inside.contains(cell) {
                return Fate::Enters(step, Link { cell: grid.within(cell), direction });
            }
        }
        Fate::Passes(Link { cell, direction })
    }

    /// Population `direction` of `cell` around the box and its neighbours.
    fn source(&mut self, cell: [usize; 3], direction: usize) -> Source {
        let here = self.ask(cell, direction);
        let mut source = Source { here, around: [[here; 2]; 3], per_distance: [0.5; 3] };
        for axis in 0..3 {
            for after in [false, true] {
                match self.grid.neighbour(cell, axis, after) {
                    Some(there) => {
                        source.around[axis][usize::from(after)] = self.ask(there, direction);
                    }
                    None => source.per_distance[axis] = 1.0,
                }
            }
        }
        source
    }

    /// Index of a population that leaves `cell` around the box.
    fn ask(&mut self, cell: [usize; 3], direction: usize) -> u32 {
        let asked = &mut self.paths.asked;
        let link = Link { cell, direction };
        *self.known.entry(link).or_insert_with(|| {
            asked.push(link);
            asked.len() as u32 - 1
        })
    }

    /// Follows population `direction` of `cell`, inside the box, if it leaves the box.
    fn let_out(&mut self, cell: [usize; 3], direction: usize) {
        let (there, turned) = self.grid.follow(cell, direction);
        if self.grid.inside.contains(there) {
            return;
        }
        let number = self.paths.leaving.len() as u32;
        self.paths.leaving.push(Link { cell: self.grid.within(cell), direction });
        self.arrive(Link { cell: there, direction: turned }, Arrival::Second(number));
        let (beyond, direction) = self.grid.follow(there, turned);
        if self.grid.inside.contains(beyond) {
            let (links, numbers) = &mut self.paths.returning;
            links.push(Link { cell: self.grid.within(beyond), direction });
            numbers.push(number);
        } else {
            self.arrive(Link { cell: beyond, direction }, Arrival::First(number));
        }
    }

    /// Notes that `arrival` has reached the child that `link` names.
    fn arrive(&mut self, link: Link, arrival: Arrival) {
        let parent = link.cell.map(|place| place / 2);
        self.arrived.entry((link.direction, parent)).or_default().push(arrival);
    }

    fn finish(mut self) -> Paths {
        for ((direction, cell), arrivals) in self.arrived {
            let parts = <[Arrival; 8]>::try_from(arrivals)
                .expect("a cell has eight children, and one way leads to each");
            self.paths.arriving.0.push(Link { cell, direction });
            self.paths.arriving.1.push(parts);
        }
        self.paths
    }
}

/// Child number `child` of `cell`.
fn child_of(cell: [usize; 3], child: usize) -> [usize; 3] {
    std::array::from_fn(|axis| 2 * cell[axis] + (child >> axis & 1))
}
