//! Cost of the velocity that the segments of a wake induce at their own nodes: `cargo bench -p
//! wakemix-benches --bench vortex`.
//!
//! Wakes of three blades of 60 m, eleven trailing vortices each; boxes made anew in every call. Beside it the
//! sum over all segments in single precision, and the error of either against the sum in double precision. A
//! number after `--` is that of the threads.

use basis::Vector3;
use flow::vortex::examples::wake;
use flow::vortex::{Accuracy, direct, induced};
use std::time::Instant;

/// Trailing vortices of each blade (–).
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
        let segments = wake(PER_BLADE, n / (3 * PER_BLADE) + 1);
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
