//! What a box of finer cells costs: `cargo bench -p wakemix-benches --bench refinement`.
//!
//! A step of the grid around alone, two steps of the box's cells alone, and a step of both together, in turn,
//! so that neighbours of the machine change all three alike; medians. What the third takes beyond the others
//! is the exchange. The box is 10 × 4 × 2 rotor diameters of 120 m in cells of 5 m, the grid around has cells
//! of 10 m. All of it once with air that is alike everywhere, and once in stratified air with temperature.

use basis::Vector3;
use flow::lattice::atmosphere::Atmosphere;
use flow::lattice::refinement::{Refined, Refinement};
use flow::lattice::{Lattice, LatticeSettings};
use flow::{FlowSolver, Inflow};
use std::sync::Arc;
use std::time::Instant;

const REPEATS: usize = 15;
/// Steps of the grid around in a figure.
const STEPS: usize = 4;

struct Shear;

impl Inflow for Shear {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            let gust = (0.05 * (position.x - 10.0 * time)).sin();
            *velocity = Vector3::new(9.0 + 0.005 * position.z + 0.3 * gust, 0.3 * gust, 0.0);
        }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut counts = vec![1, cores];
    counts.dedup();
    for n_threads in counts {
        let bare = timed(n_threads, None)?;
        let stratified = Atmosphere {
            temperature: vec![[0.0, 290.0], [900.0, 293.0]],
            ..Atmosphere::new(290.0)
        };
        let warm = timed(n_threads, Some(stratified))?;
        println!(
            "{n_threads} threads: temperature takes {:.2} times as long around, {:.2} inside, {:.2} together",
            warm[0] / bare[0],
            warm[1] / bare[1],
            warm[2] / bare[2]
        );
    }
    Ok(())
}

/// Times of a step around, inside and together (ms), on `n_threads` in air with this `atmosphere`; prints
/// them.
fn timed(
    n_threads: usize,
    atmosphere: Option<Atmosphere>,
) -> Result<[f64; 3], Box<dyn std::error::Error>> {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [144, 64, 32], 0.08, 10.0);
    settings.threads = Some(n_threads);
    let words = if atmosphere.is_some() { "with temperature" } else { "bare" };
    settings.atmosphere = atmosphere;
    let place = Refinement { first_cell: [12, 8, 0], n_cells: [120, 48, 24], within: Vec::new() };
    let mut together = Refined::new(settings.clone(), &[place], Arc::new(Shear))?;
    let inside = together.lattices()[1].settings().clone();
    let mut around = Lattice::new(settings, Arc::new(Shear))?;
    let mut inside = Lattice::new(inside, Arc::new(Shear))?;
    let mut times = [Vec::new(), Vec::new(), Vec::new()];
    let interval = STEPS as f64 * around.settings().interval;
    for _ in 0..REPEATS {
        times[0].push(milliseconds(&mut around, interval)?);
        times[1].push(milliseconds(&mut inside, interval)?);
        times[2].push(milliseconds(&mut together, interval)?);
    }
    let found = times.map(median);
    let [around, inside, both] = found;
    let grids = together.lattices().iter().map(|one| one.memory()).sum::<u64>();
    let n_cells: usize = together
        .lattices()
        .iter()
        .map(|one| one.settings().n_cells.iter().product::<usize>())
        .sum();
    println!(
        "{n_threads} threads, {words}: {around:.1} ms around, {inside:.1} ms inside, {both:.1} ms together: {:.0} % for the exchange; {:.0} MB, {:.0} of them for it; {:.0} bytes a cell",
        100.0 * (both / (around + inside) - 1.0),
        together.memory() as f64 / 1e6,
        (together.memory() - grids) as f64 / 1e6,
        together.memory() as f64 / n_cells as f64,
    );
    Ok(found)
}

/// Time that a step of the grid around takes (ms).
fn milliseconds(air: &mut dyn FlowSolver, interval: f64) -> Result<f64, flow::FlowError> {
    let start = Instant::now();
    air.advance(interval, &[])?;
    Ok(1e3 * start.elapsed().as_secs_f64() / STEPS as f64)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
