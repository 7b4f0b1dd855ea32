//! Speed of the lattice against the limit that memory sets: `cargo bench -p wakemix-benches --bench lattice`.
//!
//! A cell update reads and writes each population once. The limit is the rate at which the same threads read
//! and write back an array in place, by the fastest of many loops (`benches::bandwidth`). Neighbours of a
//! machine change both within seconds, by as much as half; so the limit is measured before and after every
//! figure, and the share is the median of such pairs, with the least and the greatest. Options after `--`:
//! `quick` for a small box, `best` for the fastest instructions alone, a number for the repeats.
//! `benches/count.py` counts the instructions of its loops and times each loop alone.

use basis::{PointForce, Vector3};
use benches::bandwidth::Limit;
use flow::lattice::atmosphere::{Atmosphere, Driving, Heating};
use flow::lattice::{Backend, Ends, Ground, Lattice, LatticeSettings, Stencil};
use flow::{FlowSolver, Inflow};
use std::sync::Arc;
use std::time::Instant;

/// What a cell update does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Work {
    /// The bulk alone.
    Bare,
    /// Inlet, outlet, wall and two rotors' forces.
    Everything,
    /// The bulk on a turning earth, with temperature, over a cooled ground.
    Temperature,
    /// The bulk alone with twenty-seven directions.
    Bare27,
    /// With temperature and twenty-seven directions.
    Temperature27,
}

impl Work {
    const ALL: [Self; 5] =
        [Self::Bare, Self::Everything, Self::Temperature, Self::Bare27, Self::Temperature27];

    fn has_temperature(self) -> bool {
        matches!(self, Self::Temperature | Self::Temperature27)
    }

    fn stencil(self) -> Stencil {
        match self {
            Self::Bare | Self::Everything | Self::Temperature => Stencil::D3Q19,
            Self::Bare27 | Self::Temperature27 => Stencil::D3Q27,
        }
    }

    /// Bytes that a cell update moves: populations in and out; with temperature the sweep reads one field and
    /// writes four, and the transport reads six and writes two.
    fn bytes(self) -> f64 {
        let fields = if self.has_temperature() { 13.0 } else { 0.0 };
        4.0 * (2.0 * self.stencil().n_directions() as f64 + fields)
    }
}

const STEPS: f64 = 20.0;
/// Memory that the limit is measured on, as much as the box takes (MiB).
const MEBIBYTES: usize = 192;

struct Shear;

impl Inflow for Shear {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            let gust = (0.05 * (position.x - 10.0 * time)).sin();
            *velocity = Vector3::new(9.0 + 0.005 * position.z + 0.3 * gust, 0.3 * gust, 0.0);
        }
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let quick = arguments.iter().any(|argument| argument == "quick");
    let best = arguments.iter().any(|argument| argument == "best");
    let n_repeats = arguments.iter().find_map(|argument| argument.parse().ok()).unwrap_or(7).max(1);
    let n_cells = if quick { [192, 64, 64] } else { [288, 96, 96] };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut counts = vec![1, cores];
    counts.dedup();
    println!(
        "cells {n_cells:?}, {} M; median of {n_repeats}, least and greatest",
        n_cells.iter().product::<usize>() as f64 / 1e6
    );
    for n_threads in counts {
        let limits = Limit::find(n_threads, MEBIBYTES, 3);
        println!("{n_threads} threads; the fastest loops that read and write in place:");
        for (one, rate) in &limits.loops {
            println!("  {:.1} GB/s: {one:?}", rate / 1e9);
        }
        for (name, backend, work) in cases(best) {
            let limit = || limits.now(3);
            let mut before = limit();
            let (mut speeds, mut limits, mut shares) = (Vec::new(), Vec::new(), Vec::new());
            for _ in 0..n_repeats {
                let speed = updates_per_second(n_cells, n_threads, backend, work);
                let after = limit();
                let around = 0.5 * (before + after);
                shares.push(100.0 * speed * work.bytes() / around);
                speeds.push(speed / 1e6);
                limits.push(around / 1e9);
                before = after;
            }
            let [speed, limit, share] = [speeds, limits, shares].map(Spread::of);
            println!(
                "  {name:<20} {:>4.0} ({:.0} to {:.0}) M updates/s, limit {:.1} ({:.1} to {:.1}) GB/s: {:.1} ({:.1} to {:.1}) % of it",
                speed.median,
                speed.least,
                speed.greatest,
                limit.median,
                limit.least,
                limit.greatest,
                share.median,
                share.least,
                share.greatest,
            );
        }
    }
    // A box that stays in each core's own cache tells what the arithmetic alone allows.
    for n_threads in [1, cores] {
        let cached = [256, 8, 6 * n_threads];
        let speed = (0..n_repeats)
            .map(|_| updates_per_second(cached, n_threads, Backend::detect(), Work::Bare))
            .fold(0.0, f64::max);
        println!(
            "{n_threads} threads on {cached:?} cells, in the cache: {:.0} M updates/s",
            speed / 1e6
        );
    }
    let cells = n_cells.iter().product::<usize>() as f64;
    for work in [Work::Everything, Work::Temperature, Work::Bare27, Work::Temperature27] {
        let air = lattice(n_cells, 1, Backend::detect(), work);
        println!("{work:?}: memory {:.1} bytes a cell", air.memory() as f64 / cells);
    }
}

/// Median of some figures, the least and the greatest of them.
struct Spread {
    median: f64,
    least: f64,
    greatest: f64,
}

impl Spread {
    fn of(mut figures: Vec<f64>) -> Self {
        figures.sort_by(f64::total_cmp);
        let n = figures.len();
        Self {
            median: 0.5 * (figures[(n - 1) / 2] + figures[n / 2]),
            least: figures[0],
            greatest: figures[n - 1],
        }
    }
}

/// Name, back-end and work.
fn cases(best: bool) -> Vec<(String, Backend, Work)> {
    Backend::ALL
        .into_iter()
        .filter(|backend| backend.is_available() && (!best || *backend == Backend::detect()))
        .flat_map(|backend| Work::ALL.map(|work| (format!("{backend:?} {work:?}"), backend, work)))
        .collect()
}

fn lattice(n_cells: [usize; 3], n_threads: usize, backend: Backend, work: Work) -> Lattice {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, n_cells, 0.08, 10.0);
    settings.threads = Some(n_threads);
    settings.backend = Some(backend);
    if work != Work::Everything {
        settings.ends = Ends::Periodic;
    }
    settings.stencil = work.stencil();
    if work == Work::Everything || work.has_temperature() {
        settings.ground = Ground::WallStress { roughness_length: 0.05 };
    }
    if work.has_temperature() {
        settings.atmosphere = Some(Atmosphere {
            coriolis: 1e-4,
            driving: Driving::Geostrophic([9.0, 0.0]),
            heating: Heating::Ground { temperature: 289.0, rate: -1e-4 },
            temperature: vec![[0.0, 290.0], [900.0, 293.0]],
            ..Atmosphere::new(290.0)
        });
    }
    match Lattice::new(settings, Arc::new(Shear)) {
        Ok(air) => air,
        Err(error) => panic!("the bench's own settings: {error}"),
    }
}

/// Best of three runs.
fn updates_per_second(n_cells: [usize; 3], n_threads: usize, backend: Backend, work: Work) -> f64 {
    let mut air = lattice(n_cells, n_threads, backend, work);
    let forces = if work == Work::Everything { rotors(&air) } else { Vec::new() };
    let interval = air.settings().interval;
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        for _ in 0..STEPS as usize {
            if let Err(error) = air.advance(interval, &forces) {
                panic!("{error}");
            }
        }
        best = best.min(start.elapsed().as_secs_f64());
    }
    n_cells.iter().product::<usize>() as f64 * STEPS / best
}

/// Two rotors, a quarter of the box wide, of three blades of forty stations.
fn rotors(air: &Lattice) -> Vec<PointForce> {
    let spacing = air.settings().spacing;
    let [n_x, n_y, n_z] = air.n_cells().map(|n| n as f64 * spacing);
    let mut forces = Vec::new();
    for rotor in [0.2, 0.6] {
        for blade in 0..3 {
            let (sine, cosine) = (f64::from(blade) * std::f64::consts::TAU / 3.0).sin_cos();
            for station in 0..40 {
                let radius = 0.125 * n_z * (f64::from(station) + 0.5) / 40.0;
                let hub = Vector3::new(rotor * n_x, 0.5 * n_y, 0.5 * n_z);
                let position = hub + Vector3::new(0.0, -sine, cosine) * radius;
                let force = Vector3::new(-1.0e4, 0.0, 0.0);
                forces.push(PointForce::of_body(position, force, 2.0 * spacing));
            }
        }
    }
    forces
}
