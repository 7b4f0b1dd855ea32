//! Temperature in boxes: what stays, what is kept, what is given, and the same bits.

mod carried;
mod cooled;
mod layers;
mod orders;
mod records;
mod starts;
mod swings;

use super::*;
use crate::lattice::atmosphere::{Atmosphere, Damping, Driving, Heating, Perturbation, Reference};
use std::f64::consts::TAU;

/// A cell: temperature above the reference (K), centre (m), volume (m³) and density (that of undisturbed
/// air).
struct Cell {
    temperature: f64,
    centre: Vector3,
    volume: f64,
    density: f64,
}

/// Every cell that is not covered.
fn warm_cells(air: &Refined) -> Vec<Cell> {
    fn add(grid: &Grid, all: &mut Vec<Cell>) {
        let lattice = &grid.lattice;
        let [_, n_y, _] = lattice.n_cells();
        let whole = CellBox { low: [0; 3], high: lattice.n_cells() };
        let is_covered =
            |cell: &[usize; 3]| grid.boxes.iter().any(|one| one.covered.contains(*cell));
        for cell in whole.cells().filter(|cell| !is_covered(cell)) {
            let row = lattice.engine.temperature(cell[2] * n_y + cell[1]).expect("it has one");
            let place = Vector3::from_array(cell.map(|n| n as f64));
            let [excess, ..] = lattice.cell_states(&[cell; 8]);
            all.push(Cell {
                temperature: f64::from(row[cell[0]]),
                centre: lattice.scaling().to_si_position(place),
                volume: lattice.scaling().spacing().powi(3),
                density: 1.0 + f64::from(excess[0]),
            });
        }
        grid.boxes.iter().for_each(|one| add(&one.grid, all));
    }
    let mut all = Vec::new();
    add(&air.grid, &mut all);
    all
}

/// Mean temperature over all air, by mass (K above the reference).
fn mean(air: &Refined) -> f64 {
    let (mut sum, mut mass) = (0.0, 0.0);
    for cell in warm_cells(air) {
        sum += cell.temperature * cell.density * cell.volume;
        mass += cell.density * cell.volume;
    }
    sum / mass
}
