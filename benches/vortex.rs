//! Cost of the velocity that the segments of a wake induce at their own nodes: `cargo bench -p
//! wakemix-benches --bench vortex`.
//!
//! Wakes of three blades of 60 m, eleven trailing vortices each; boxes made anew in every call. Beside it the
//! sum over all segments in single precision, and the error of either against the sum in double precision. A
//! number after `--` is that of the threads.

use basis::Vector3;
use flow::vortex::{Accuracy, Segment, direct, induced};
use std::f64::consts::TAU;
use std::time::Instant;

const PER_BLADE: usize = 11;
/// Nodes at which errors are taken (–).
const N_COMPARED: usize = 300;
/// Most segments that are summed one by one (–).
const MOST_SUMMED: usize = 40_000;

fn main() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let n_threads = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(cores);
    println!(
        "seconds on {n_threads} threads, best of five; relative error, root of the mean square"
    );
    println!("{:>9} {:>7} {:>8} {:>10} {:>10}", "segments", "degree", "opening", "time", "error");
    for n in [1_000, 3_300, 10_000, 34_000, 100_000, 300_000] {
        let segments = wake(n);
        let positions: Vec<Vector3> = segments.iter().map(|segment| segment.from).collect();
        let step = (positions.len() / N_COMPARED).max(1);
        let compared: Vec<Vector3> = positions.iter().step_by(step).copied().collect();
        let mut exact = vec![Vector3::ZERO; compared.len()];
        direct(&segments, &compared, &mut exact);
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        for (degree, opening) in [(2, 0.6), (3, 0.6), (3, 0.7), (4, 0.7), (3, 0.0)] {
            if opening == 0.0 && n > MOST_SUMMED {
                continue;
            }
            let accuracy = Accuracy { degree, opening };
            let once = || {
                let started = Instant::now();
                induced(&segments, accuracy, n_threads, &positions, &mut velocities);
                started.elapsed().as_secs_f64()
            };
            let best = std::iter::repeat_with(once).take(5).fold(f64::INFINITY, f64::min);
            let found = velocities.iter().step_by(step);
            let (missed, whole) = exact.iter().zip(found).fold((0.0, 0.0), |sum, (a, b)| {
                (sum.0 + (*a - *b).length_squared(), sum.1 + a.length_squared())
            });
            let error = f64::sqrt(missed / whole);
            println!("{n:>9} {degree:>7} {opening:>8} {best:>10.5} {error:>10.2e}");
        }
    }
}

/// A wake of three blades of 60 m in about `n` segments, tip and root strong.
fn wake(n: usize) -> Vec<Segment> {
    let n_nodes = n / (3 * PER_BLADE) + 1;
    let all = (0..3).flat_map(|blade| (0..PER_BLADE).map(move |k| (blade, k)));
    all.flat_map(|(blade, k)| filament(blade, k, n_nodes)).collect()
}

fn filament(blade: usize, k: usize, n_nodes: usize) -> Vec<Segment> {
    let radius = 3.0 + 57.0 * k as f64 / (PER_BLADE - 1) as f64;
    let node = |step: usize| {
        let angle = TAU * (blade as f64 / 3.0 - step as f64 / 50.0);
        let x = 0.6 * step as f64 + 4.0 * (0.05 * step as f64).sin();
        Vector3::new(x, radius * angle.sin(), 90.0 + radius * angle.cos())
    };
    let circulation = match k {
        0 => 35.0,
        k if k + 1 == PER_BLADE => -40.0,
        k => 3.0 - 0.4 * k as f64,
    };
    (0..n_nodes - 1)
        .map(|step| Segment {
            from: node(step),
            to: node(step + 1),
            circulation,
            core_squared: 0.16,
        })
        .collect()
}
