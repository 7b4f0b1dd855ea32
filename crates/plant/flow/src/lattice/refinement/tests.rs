//! Refined air against closed forms, invariants and uniform grids.

mod exactness;
mod fields;
mod ground;
mod wake;
mod warm;
mod waves;

use super::boxes::beyond;
use super::*;
use crate::WindField;
use crate::lattice::settings::{Ends, Ground, Sides, Stencil};
use crate::lattice::stencil::{D3Q19, Stencil as _};
use crate::lattice::stencil27::D3Q27;
use crate::lattice::subgrid::{DEFAULT_SMAGORINSKY, Subgrid};
use crate::lattice::tests::{Wind, periodic_box};

fn cells(first_cell: [usize; 3], n_cells: [usize; 3]) -> Refinement {
    Refinement { first_cell, n_cells, within: Vec::new() }
}

/// A lattice of `settings` with `boxes` in it, on one thread where they name no number: several of these
/// small ones go on side by side.
fn refined(
    mut settings: LatticeSettings,
    boxes: &[Refinement],
    wind: impl Fn(f64, Vector3) -> Vector3 + Send + Sync + 'static,
) -> Refined {
    settings.threads.get_or_insert(1);
    Refined::new(settings, boxes, Arc::new(Wind(wind))).expect("sound settings")
}

/// The same box of air in cells of half the size.
fn fine(settings: &LatticeSettings) -> LatticeSettings {
    LatticeSettings {
        spacing: 0.5 * settings.spacing,
        n_cells: settings.n_cells.map(|n| 2 * n),
        interval: 0.5 * settings.interval,
        ..settings.clone()
    }
}

/// Centre (m), velocity (m/s) and volume (m³) of every cell that is not covered.
fn all_cells(air: &Refined) -> Vec<(Vector3, Vector3, f64)> {
    fn add(grid: &Grid, all: &mut Vec<(Vector3, Vector3, f64)>) {
        let lattice = &grid.lattice;
        let whole = CellBox { low: [0; 3], high: lattice.n_cells() };
        for cell in
            whole.cells().filter(|cell| grid.boxes.iter().all(|b| !b.covered.contains(*cell)))
        {
            let centre =
                lattice.scaling().to_si_position(Vector3::from_array(cell.map(|n| n as f64)));
            let mut velocity = [Vector3::ZERO];
            lattice.sample(&[centre], &mut velocity);
            all.push((centre, velocity[0], lattice.scaling().spacing().powi(3)));
        }
        grid.boxes.iter().for_each(|one| add(&one.grid, all));
    }
    let mut all = Vec::new();
    add(&air.grid, &mut all);
    all
}
