//! Temperature in boxes: what is kept, what crosses, and the same bits.

use super::*;
use crate::lattice::atmosphere::{Atmosphere, Damping, Driving, Heating, Perturbation, Reference};
use std::f64::consts::TAU;

/// A cell: temperature above the reference (K), centre (m), volume (m³) and density (that of undisturbed air).
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
        for cell in
            whole.cells().filter(|cell| grid.boxes.iter().all(|one| !one.covered.contains(*cell)))
        {
            let row = lattice.engine.temperature(cell[2] * n_y + cell[1]).expect("it has one");
            let centre =
                lattice.scaling().to_si_position(Vector3::from_array(cell.map(|n| n as f64)));
            let [excess, ..] = lattice.cell_states(&[cell; 8]);
            all.push(Cell {
                temperature: f64::from(row[cell[0]]),
                centre,
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

/// Two boxes in one another on slippery ground, in air of layers.
fn layered(wind: Vector3, reference: Reference) -> Refined {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [18, 14, 16], 0.1, 8.0);
    (settings.ends, settings.sides) = (Ends::Periodic, Sides::Periodic);
    settings.threads = Some(2);
    settings.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 290.0], [55.0, 290.5], [88.0, 294.0], [160.0, 295.0]],
        damping: Some(Damping { from: 110.0, rate: 0.01 }),
        driving: Driving::Geostrophic([wind.x, wind.y]),
        reference,
        ..Atmosphere::new(290.0)
    });
    let mut place = cells([4, 3, 0], [10, 8, 11]);
    place.within.push(cells([4, 4, 4], [10, 8, 9]));
    refined(settings, &[place], move |_, _| wind)
}

#[test]
fn layers_at_rest_stay_at_rest() {
    for reference in [Reference::Mean, Reference::Start] {
        for wind in [Vector3::ZERO, Vector3::new(6.0, 3.0, 0.0)] {
            let mut air = layered(wind, reference);
            let before = warm_cells(&air);
            air.advance(60.0, &[]).expect("no divergence");
            let pairs = warm_cells(&air).into_iter().zip(&before);
            let warmed = pairs.map(|(a, b)| (a.temperature - b.temperature).abs());
            let warmed = warmed.fold(0.0, f64::max);
            let off = all_cells(&air).into_iter().map(|(_, v, _)| (v - wind).length());
            let off = off.fold(0.0, f64::max);
            println!("{reference:?}, {wind}: {warmed:e} K, {off:e} m/s");
        }
    }
}

/// Air in disorder between slippery ground and top, warm and cold, boxes in it and on the ground.
fn stirred(stencil: Stencil, boxed: bool) -> Refined {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [24, 20, 16], 0.2, 5.0);
    (settings.ends, settings.sides) = (Ends::Periodic, Sides::Periodic);
    settings.stencil = stencil;
    settings.threads = Some(2);
    settings.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 290.0], [60.0, 290.0], [100.0, 293.0], [160.0, 294.0]],
        perturbation: Some(Perturbation { below: 160.0, amplitude: 1.0, seed: 5 }),
        ..Atmosphere::new(290.0)
    });
    let mut place = cells([4, 4, 0], [10, 12, 8]);
    place.within.push(cells([4, 5, 3], [9, 8, 8]));
    let other = cells([17, 4, 4], [4, 5, 7]);
    let boxes = [place, other];
    refined(settings, if boxed { &boxes } else { &[] }, |_, x| {
        let swirl = |a: f64, b: f64| (0.05 * a + 0.09 * b).sin() * (0.13 * b - 0.04 * a).cos();
        Vector3::new(3.0, 1.0, 0.0)
            + 2.0 * Vector3::new(swirl(x.y, x.z), swirl(x.z, x.x), swirl(x.x, x.y))
    })
}

#[test]
fn debug_layers() {
    let wind = Vector3::new(6.0, 3.0, 0.0);
    let mut air = layered(wind, Reference::Mean);
    let before = warm_cells(&air);
    for step in [0.025, 0.025, 0.025, 0.025, 0.1, 0.8, 9.0] {
        air.advance(step, &[]).expect("no divergence");
        let now = warm_cells(&air);
        let mut worst: Vec<_> = now
            .iter()
            .zip(&before)
            .map(|(a, b)| {
                ((a.temperature - b.temperature).abs(), a.centre, a.volume, b.temperature)
            })
            .collect();
        worst.sort_by(|a, b| b.0.total_cmp(&a.0));
        println!("{}: {:?}", air.time(), &worst[..6]);
    }
}

#[test]
fn heat_is_kept() {
    for (stencil, boxed) in [(Stencil::D3Q19, false), (Stencil::D3Q19, true)] {
        let mut air = stirred(stencil, boxed);
        let before = mean(&air);
        for _ in 0..5 {
            air.advance(20.0, &[]).expect("no divergence");
            println!("{stencil:?} {boxed}: {:e} K", mean(&air) - before);
        }
    }
}
