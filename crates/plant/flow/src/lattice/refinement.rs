//! Boxes of finer cells in a lattice, and boxes within them.
//!
//! Cells of a box have half the size and make two steps of half the length for one of the grid around it, so
//! that the speed of sound is the same (cells a step) and the viscosity twice as many cells² a step. Each box
//! is a lattice of its own, with the filter width of its own cells.
//!
//! Populations cross from grid to grid as parts of volumes (Chen, Filippova, Hoch, Molvig, Shock, Teixeira,
//! Zhang 2006, Physica A 362, 158; Rohde, Kandhai, Derksen, van den Akker 2006, Int. J. Numer. Meth. Fluids
//! 51, 439): what leaves a cell around the box towards it is divided among the cell's eight children, which
//! move on by two short steps; what arrives around the box is the mean of what has reached the eight
//! children. So mass and momentum are kept to rounding, whatever crosses, edges and corners included: the
//! [ways](paths) are followed once, cell by cell, when the box is laid out.
//!
//! Nothing is rescaled. A population that has collided at x and goes along e stands, to second order, for
//! the gas half a step later and half-way to its next cell, where both grids agree on it: half-way of the
//! long way lies on the boundary of the box, and there the two short ways cross it, a quarter of the long
//! step before and after. Beside the boundary their crossings lie up to half a cell apart, for which the
//! eighths follow the slope of the population along it, so that a linear field crosses unchanged. What is
//! left is that the two short steps get the same, though a quarter of a step lies between each and the mean
//! of both: an error of first order in time, of alternating sign, which the box's own short steps damp. The
//! tests beside this file measure it: a Taylor-Green vortex across a box keeps second order, and less than
//! 1 % of a pulse of sound comes back. A box has no sponge of its own: one that reaches into the cells
//! before an outlet takes theirs away.
//!
//! A box touches no loop over cells. Between two steps each population lies in one place, whose address
//! [`Layout`](super::layout) knows for either kind of step: before an even one in the slot of its direction
//! in the cell where it arrives, before an odd one in the opposite slot of the cell that it left. The box's
//! own sides are ordinary periodic or slip ones; after each of its steps what came in through them is
//! overwritten with what came from around, and likewise around the box after each step there. Cells under a
//! box are swept with the others, a sixteenth of the box's work, but nobody sees them: wind in a box is that
//! of its own cells.

mod boxes;
mod coupling;
mod fields;
mod halo;
mod heat;
mod paths;
mod start;
mod steps;
#[cfg(test)]
mod tests;

use super::cell_box::CellBox;
use super::heat_links::HeatExchange;
use super::joint::Joint;
use super::links::Exchange;
use super::settings::LatticeSettings;
use super::solver::{Lattice, steps_in};
use crate::{FlowError, FlowSolver, Inflow};
use basis::{PointForce, Vector3};
use boxes::Beyond;
pub use boxes::{MARGIN, Refinement, RefinementError, WARM_MARGIN, check};
use coupling::Coupling;
use halo::Place;
use heat::HeatCoupling;
use paths::Paths;
use std::io::{Error, ErrorKind, Read, Result as IoResult, Write};
use std::sync::Arc;

/// A box of air under lattice-Boltzmann large-eddy simulation, finer in parts of it.
///
/// A body's force acts in the finest box that holds its position, all of it: where it reaches beyond that box
/// it is gathered within. What reaches into a box from outside is lost, as cells under a box mean nothing. So
/// let boxes end a few smearing lengths from what pushes the air. The same settings, inflow and forces give
/// the same bits on any number of threads.
///
/// It moves on by steps of its finest cells, and may be looked at and pushed between any two of them: forces
/// act on a grid from the next step that it begins. Grids of longer steps are ahead then, by less than one of
/// their own.
pub struct Refined {
    grid: Grid,
    /// Steps of the finest cells that were made (–).
    n_steps: u64,
    /// How many of them make a step of the grid that holds all others (–).
    span: u64,
}

/// A lattice and the boxes in it.
struct Grid {
    lattice: Lattice,
    boxes: Vec<Inner>,
    /// Forces of the bodies that are in none of them.
    forces: Vec<PointForce>,
}

/// A box in a grid.
struct Inner {
    /// Cells of the grid around that it covers.
    covered: CellBox,
    beyond: Beyond,
    coupling: Coupling,
    /// That of temperature, where the air has one.
    heat: Option<HeatCoupling>,
    grid: Grid,
    /// Forces of the bodies in it.
    forces: Vec<PointForce>,
}

impl Refined {
    /// Air that moves as `inflow` does at time zero, in the grid of `settings` and in `boxes` of it.
    ///
    /// # Errors
    /// [`RefinementError`] when a grid's settings break an assumption of the method or ask for more memory
    /// than there is, or a box does not suit its place.
    pub fn new(
        settings: LatticeSettings,
        boxes: &[Refinement],
        inflow: Arc<dyn Inflow>,
    ) -> Result<Self, RefinementError> {
        boxes::check_air(&settings, boxes)?;
        let beyond = boxes::beyond(&settings);
        let height = settings.spacing * settings.n_cells[2] as f64;
        let joint = Joint::none(height);
        let lattice = Lattice::joined(settings, &joint, Arc::clone(&inflow))?;
        let grid = Grid::new(lattice, &joint, boxes, &beyond, &inflow)?;
        Ok(Self { span: 1 << grid.depth(), grid, n_steps: 0 })
    }

    /// The grid that holds all others; its cells under boxes mean nothing.
    pub fn base(&self) -> &Lattice {
        &self.grid.lattice
    }

    /// All grids, each before those in it. The wind of its cells under boxes means nothing, nor does what its
    /// [statistics](Lattice::level_statistics) make of it; their temperature is the mean over those in them
    /// after each of its steps.
    pub fn lattices(&self) -> Vec<&Lattice> {
        let mut all = Vec::new();
        self.grid.list(&mut all);
        all
    }

    /// Duration of a step of the finest cells (s).
    pub fn interval(&self) -> f64 {
        self.base().scaling().interval() / self.span as f64
    }

    /// Time since the start (s).
    pub fn time(&self) -> f64 {
        self.n_steps as f64 * self.interval()
    }

    /// Memory of the field (bytes).
    pub fn memory(&self) -> u64 {
        self.grid.memory()
    }

    /// Mass of the air (kg), between two steps of the [base](Self::base).
    pub fn mass(&self) -> f64 {
        self.grid.totals().0
    }

    /// Momentum of the air likewise, forces of the last step not counted (kg m/s).
    pub fn momentum(&self) -> Vector3 {
        self.grid.totals().1
    }

    /// Looks at every cell.
    ///
    /// # Errors
    /// [`FlowError::Diverged`] with the first cell that the lattice cannot carry on from.
    pub fn check(&mut self) -> Result<(), FlowError> {
        self.grid.each(&mut Lattice::check)
    }

    /// Writes the state, grid by grid as [`Lattice::write_state`] does, and what is on its way between them.
    ///
    /// # Errors
    /// Those of `writer`, and [`ErrorKind::InvalidData`] when the field has diverged.
    pub fn write_state(&mut self, writer: &mut dyn Write) -> IoResult<()> {
        writer.write_all(&self.n_steps.to_le_bytes())?;
        self.grid.write_state(writer)
    }

    /// Reads a state that [`write_state`](Self::write_state) wrote from the same settings and boxes.
    ///
    /// # Errors
    /// Those of `reader`, and [`ErrorKind::InvalidData`] when it is no state or one of other grids. The field
    /// is undefined after an error and must be read or built again.
    pub fn read_state(&mut self, reader: &mut dyn Read) -> IoResult<()> {
        let mut bytes = [0; 8];
        reader.read_exact(&mut bytes)?;
        self.n_steps = u64::from_le_bytes(bytes);
        self.grid.read_state(reader)?;
        match self.grid.in_step(self.n_steps, self.span) {
            true => Ok(()),
            false => Err(Error::new(ErrorKind::InvalidData, "the state's grids are out of step")),
        }
    }
}

impl FlowSolver for Refined {
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError> {
        let n_steps = steps_in(duration, self.interval())?;
        self.grid.take(forces);
        for _ in 0..n_steps {
            self.grid.advance(self.n_steps, self.span);
            self.grid.watch(self.n_steps, self.span)?;
            self.n_steps += 1;
        }
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        true
    }
}

impl Grid {
    /// That of `lattice`, which is at its start and lies as `joint` says, with `boxes` in it.
    fn new(
        mut lattice: Lattice,
        joint: &Joint,
        boxes: &[Refinement],
        beyond: &Beyond,
        inflow: &Arc<dyn Inflow>,
    ) -> Result<Self, RefinementError> {
        let margin = boxes::margin(lattice.settings().atmosphere.is_some());
        boxes::check_apart(boxes, lattice.n_cells(), margin)?;
        let boxes = boxes
            .iter()
            .map(|one| Inner::new(one, &mut lattice, joint, beyond, inflow))
            .collect::<Result<_, _>>()?;
        Ok(Self { lattice, boxes, forces: Vec::new() })
    }

    /// Calls `act` on each lattice, until one fails.
    fn each<E>(&mut self, act: &mut dyn FnMut(&mut Lattice) -> Result<(), E>) -> Result<(), E> {
        act(&mut self.lattice)?;
        self.boxes.iter_mut().try_for_each(|one| one.grid.each(act))
    }

    fn list<'a>(&'a self, all: &mut Vec<&'a Lattice>) {
        all.push(&self.lattice);
        self.boxes.iter().for_each(|one| one.grid.list(all));
    }

    fn memory(&self) -> u64 {
        let boxes = self.boxes.iter().map(|one| {
            let heat = one.heat.as_ref().map_or(0, HeatCoupling::memory);
            one.coupling.memory() + heat + one.grid.memory()
        });
        self.lattice.memory() + boxes.sum::<u64>()
    }

    /// Mass (kg) and momentum (kg m/s) of the air.
    fn totals(&self) -> (f64, Vector3) {
        let covered: Vec<CellBox> = self.boxes.iter().map(|one| one.covered).collect();
        let own = self.lattice.totals(&covered);
        self.boxes
            .iter()
            .map(|one| one.grid.totals())
            .fold(own, |(mass, momentum), other| (mass + other.0, momentum + other.1))
    }
}

impl Inner {
    /// The box `one` in the grid `around`, which is at its start, lies as `joint` says, and `beyond` which
    /// lies what is given.
    fn new(
        one: &Refinement,
        around: &mut Lattice,
        joint: &Joint,
        beyond: &Beyond,
        inflow: &Arc<dyn Inflow>,
    ) -> Result<Self, RefinementError> {
        let n_cells = around.n_cells();
        let is_warm = around.settings().atmosphere.is_some();
        one.check(n_cells, beyond, is_warm)?;
        let own = one.beyond(n_cells, beyond);
        let settings = one.settings(around.settings(), &own);
        let faces = own.map(|ends| ends.map(|beyond| beyond.is_none()));
        let place = Place { covered: one.covered(), n_cells, beyond: *beyond, faces };
        let joint = Joint {
            faces,
            floor: joint.floor + one.first_cell[2] as f64 * around.settings().spacing,
            targets: is_warm.then(|| place.targets(heat(around))),
            ..*joint
        };
        let is_told = inflow.sample_temperature(0.0, &[settings.origin], &mut [0.0]);
        let mut lattice = Lattice::joined(settings, &joint, Arc::clone(inflow))?;
        if is_warm && is_told {
            start::join(&place, around, &mut lattice);
        }
        let mut grid = Grid::new(lattice, &joint, &one.within, &own, inflow)?;
        let heat = is_warm.then(|| HeatCoupling::new(&place, around, &mut grid.lattice));
        let around = exchange(around);
        let paths = Paths::new(one.covered(), n_cells, beyond, around.directions());
        let coupling = Coupling::new(paths, around, exchange(&mut grid.lattice));
        Ok(Self { covered: one.covered(), beyond: own, coupling, heat, grid, forces: Vec::new() })
    }
}

/// The temperature of `lattice`, whose air has one.
fn heat(lattice: &mut Lattice) -> &mut dyn HeatExchange {
    lattice.engine.heat().expect("the engine on the processor exchanges temperature")
}

/// The populations of `lattice`.
fn exchange(lattice: &mut Lattice) -> &mut dyn Exchange {
    lattice.engine.exchange().expect("the engine on the processor exchanges populations")
}
