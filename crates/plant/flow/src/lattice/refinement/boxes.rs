//! Which cells are refined, and the assumptions that are checked before they are.

use crate::lattice::atmosphere::Heating;
use crate::lattice::cell_box::CellBox;
use crate::lattice::fields::REACH;
use crate::lattice::layout::Edge;
use crate::lattice::settings::{Ends, Ground, LatticeError, LatticeSettings, Sides, Stencil};
use crate::lattice::subgrid::SubgridModel;
use basis::Vector3;
use thiserror::Error;

/// Cells of the grid around a box between it and a side that it does not stand on, and between two boxes: one
/// takes part in the exchange, the next one knows its slope.
pub const MARGIN: usize = 2;
/// The same in air with temperature, of which three cells before a face tell what passes it, and cells that a
/// box covers at least along an axis along which it ends in the air.
pub const WARM_MARGIN: usize = REACH;
/// Memory of the exchange for each population that leaves a box through a face of a cell (bytes), about: as
/// measured of a box of 64 × 32 × 32 cells on the ground.
const BYTES_OF_LINK: u64 = 125;
/// Memory of the exchange of temperature for each face of a cell of a box's sides (bytes), about, with what
/// is given beyond it, as measured likewise.
const BYTES_OF_WARM_FACE: u64 = 190;

/// A box of cells of half the size, moved by steps of half the length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refinement {
    /// Its first cell along x, y, z, in cells of the grid around it (–).
    pub first_cell: [usize; 3],
    /// Cells of the grid around it that it covers along x, y, z (–).
    pub n_cells: [usize; 3],
    /// Boxes within it, in cells of its own.
    pub within: Vec<Refinement>,
}

/// Why a grid cannot be refined so.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum RefinementError {
    /// A grid cannot be built.
    #[error(transparent)]
    Lattice(#[from] LatticeError),
    /// A box has no cells along an axis.
    #[error(
        "a refined box has no cells along {axis}: give it at least one cell of the grid around it, or leave it out"
    )]
    Empty {
        /// Axis.
        axis: &'static str,
    },
    /// A box comes too close to a side of the grid around it.
    #[error(
        "a refined box from cell {first} to cell {last} along {axis} comes too close to a side of the {n_cells} cells around it: let it end {margin} cells before, or stand on a wall that air slips along, or fill a periodic axis"
    )]
    TooClose {
        /// Axis.
        axis: &'static str,
        /// First cell covered.
        first: usize,
        /// Last cell covered.
        last: usize,
        /// Cells around it along the axis (–).
        n_cells: usize,
        /// Cells that are to lie between (–).
        margin: usize,
    },
    /// A box is too thin for what passes its faces.
    #[error(
        "a refined box in air with temperature covers {n_cells} cells along {axis}, and needs {WARM_MARGIN}: make it thicker, or leave out the atmosphere"
    )]
    Thin {
        /// Axis.
        axis: &'static str,
        /// Cells of the grid around that it covers (–).
        n_cells: usize,
    },
    /// Two boxes overlap or nearly touch.
    #[error(
        "refined boxes number {first} and {second} are less than {margin} cells apart: join them, or move one"
    )]
    Overlap {
        /// Number of the first box among its neighbours, from zero.
        first: usize,
        /// Number of the second.
        second: usize,
        /// Cells that are to lie between (–).
        margin: usize,
    },
    /// The wind of neighbours that a model of eddies needs is not handed from grid to grid.
    #[error(
        "the subgrid model {} needs the wind of neighbours, which boxes of finer cells do not hand each other: take smagorinsky, or leave out the boxes", .0.word()
    )]
    Subgrid(SubgridModel),
}

/// What lies beyond the first and the last cell along each axis: none where populations are given, by an
/// inlet, an outlet, an open side or the grid around.
pub(super) type Beyond = [[Option<Edge>; 2]; 3];

/// Checks that `boxes`, and those within them, suit their places in the grid of `settings`, and each grid the
/// assumptions of the method: all that [`Refined::new`](super::Refined::new) refuses but memory.
///
/// # Errors
/// [`RefinementError`] for the first that does not.
pub fn check(settings: &LatticeSettings, boxes: &[Refinement]) -> Result<(), RefinementError> {
    check_air(settings, boxes)?;
    check_in(settings, &beyond(settings), boxes)
}

/// Cells between boxes and sides, and between boxes, in air with temperature (`is_warm`) or without.
pub(super) fn margin(is_warm: bool) -> usize {
    if is_warm { WARM_MARGIN } else { MARGIN }
}

/// Checks that the air of `settings` can be in boxes at all, if there are any.
pub(super) fn check_air(
    settings: &LatticeSettings,
    boxes: &[Refinement],
) -> Result<(), RefinementError> {
    if boxes.is_empty() {
        return Ok(());
    }
    match settings.subgrid.model {
        model if model.needs_neighbours() => Err(RefinementError::Subgrid(model)),
        _ => Ok(()),
    }
}

fn check_in(
    settings: &LatticeSettings,
    beyond: &Beyond,
    boxes: &[Refinement],
) -> Result<(), RefinementError> {
    settings.check()?;
    let (n_cells, is_warm) = (settings.n_cells, settings.atmosphere.is_some());
    check_apart(boxes, n_cells, margin(is_warm))?;
    boxes.iter().try_for_each(|one| {
        one.check(n_cells, beyond, is_warm)?;
        let own = one.beyond(n_cells, beyond);
        check_in(&one.settings(settings, &own), &own, &one.within)
    })
}

/// What lies beyond the box of `settings`.
pub(super) fn beyond(settings: &LatticeSettings) -> Beyond {
    let ends = match settings.ends {
        Ends::Periodic => Some(Edge::Periodic),
        Ends::InletOutlet => None,
    };
    let sides = Some(Edge::of_sides(settings.sides)).filter(|sides| *sides != Edge::Open);
    [[ends; 2], [sides; 2], Edge::of_ground(settings.ground).map(Some)]
}

impl Refinement {
    /// The box from `low` to `high` (m, farm frame), snapped to the nearest cells of `settings`, with nothing
    /// within it.
    pub fn between(settings: &LatticeSettings, low: Vector3, high: Vector3) -> Self {
        let cell = |corner: Vector3| {
            let place = ((corner - settings.origin) / settings.spacing).to_array();
            // Saturating: what lies before the grid begins with it.
            std::array::from_fn(|axis| (place[axis].round() as usize).min(settings.n_cells[axis]))
        };
        let (first_cell, end): ([usize; 3], [usize; 3]) = (cell(low), cell(high));
        let n_cells = std::array::from_fn(|axis| end[axis].saturating_sub(first_cell[axis]));
        Self { first_cell, n_cells, within: Vec::new() }
    }

    /// Cells of half the size along x, y, z (–).
    pub fn fine_cells(&self) -> [usize; 3] {
        self.n_cells.map(|n| 2 * n)
    }

    /// Boxes within one another, this one included (–).
    pub fn depth(&self) -> u32 {
        1 + self.within.iter().map(Self::depth).max().unwrap_or(0)
    }

    /// Memory (bytes) of its exchange, and of that of the boxes within it, with the grid around it in
    /// populations of `stencil`, in air with temperature (`is_warm`) or without, about: what it is where they
    /// cross all six sides.
    pub fn exchange_memory(&self, stencil: Stencil, is_warm: bool) -> u64 {
        let [x, y, z] = self.fine_cells().map(|n| n as u64);
        // Directions that lead through a face.
        let n_links = match stencil {
            Stencil::D3Q19 => 5,
            Stencil::D3Q27 => 9,
        };
        let heat = if is_warm { BYTES_OF_WARM_FACE } else { 0 };
        let within = self.within.iter().map(|one| one.exchange_memory(stencil, is_warm));
        2 * (x * y + y * z + z * x) * (n_links * BYTES_OF_LINK + heat) + within.sum::<u64>()
    }

    /// The cells around it that it covers.
    pub(super) fn covered(&self) -> CellBox {
        CellBox {
            low: self.first_cell,
            high: std::array::from_fn(|axis| self.first_cell[axis] + self.n_cells[axis]),
        }
    }

    /// Checks its place among `n_cells` cells, `beyond` which lies what is given, in air with temperature
    /// (`is_warm`) or without.
    pub(super) fn check(
        &self,
        n_cells: [usize; 3],
        beyond: &Beyond,
        is_warm: bool,
    ) -> Result<(), RefinementError> {
        let margin = margin(is_warm);
        let CellBox { low, high } = self.covered();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            if self.n_cells[axis] == 0 {
                return Err(RefinementError::Empty { axis: name });
            }
            let n = n_cells[axis];
            let touches = [low[axis] == 0, high[axis] == n];
            let apart = [low[axis] >= margin, high[axis] + margin <= n];
            let stands: [bool; 2] = std::array::from_fn(|side| match beyond[axis][side] {
                // What a wall turns back would go other ways in long steps than in short ones.
                None | Some(Edge::Hold | Edge::Open) => false,
                Some(Edge::Periodic) => touches == [true; 2],
                Some(Edge::Slip) => touches[side],
            });
            let good: [bool; 2] = std::array::from_fn(|side| apart[side] || stands[side]);
            if good != [true; 2] {
                return Err(RefinementError::TooClose {
                    axis: name,
                    first: low[axis],
                    last: high[axis].saturating_sub(1),
                    n_cells: n,
                    margin,
                });
            }
            if is_warm && stands != [true; 2] && self.n_cells[axis] < WARM_MARGIN {
                return Err(RefinementError::Thin { axis: name, n_cells: self.n_cells[axis] });
            }
        }
        Ok(())
    }

    /// What lies beyond the box in a grid of `n_cells` cells, given what lies beyond that one.
    pub(super) fn beyond(&self, n_cells: [usize; 3], around: &Beyond) -> Beyond {
        let CellBox { low, high } = self.covered();
        std::array::from_fn(|axis| {
            [
                around[axis][0].filter(|_| low[axis] == 0),
                around[axis][1].filter(|_| high[axis] == n_cells[axis]),
            ]
        })
    }

    /// Settings of the box's own grid, `beyond` which lies what is given, in the grid of `around`.
    ///
    /// Where populations are given by the grid around, the lattice has a side that it can have: whatever
    /// comes from there is overwritten.
    pub(super) fn settings(&self, around: &LatticeSettings, beyond: &Beyond) -> LatticeSettings {
        let first = Vector3::from_array(self.first_cell.map(|first| first as f64));
        LatticeSettings {
            origin: around.origin + first * around.spacing,
            spacing: 0.5 * around.spacing,
            n_cells: self.n_cells.map(|n| 2 * n),
            interval: 0.5 * around.interval,
            ends: Ends::Periodic,
            sides: match beyond[1][0] {
                Some(Edge::Periodic) => Sides::Periodic,
                _ => Sides::Slip,
            },
            ground: match beyond[2][0] {
                Some(_) => around.ground,
                None => Ground::Slip,
            },
            atmosphere: around.atmosphere.clone().map(|mut atmosphere| {
                let of_ground =
                    matches!(atmosphere.heating, Heating::Flux(_) | Heating::Ground { .. });
                if of_ground && beyond[2][0].is_none() {
                    atmosphere.heating = Heating::None;
                }
                atmosphere
            }),
            ..around.clone()
        }
    }
}

/// Checks that `boxes` are `margin` cells apart from one another, in a grid of `n_cells` cells.
pub(super) fn check_apart(
    boxes: &[Refinement],
    n_cells: [usize; 3],
    margin: usize,
) -> Result<(), RefinementError> {
    for (second, one) in boxes.iter().enumerate() {
        let around = one.covered().grown(margin, n_cells);
        if let Some(first) =
            boxes[..second].iter().position(|other| other.covered().overlaps(&around))
        {
            return Err(RefinementError::Overlap { first, second, margin });
        }
    }
    Ok(())
}
