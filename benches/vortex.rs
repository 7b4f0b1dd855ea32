//! Cost of the velocity that the segments of a wake induce in their own middles: `cargo bench -p
//! wakemix-benches --bench vortex`.
//!
//! Wakes of three blades of 60 m, eleven trailing vortices each; boxes made anew in every call. Beside it the
//! sum over all segments in single precision, and the error of either against the sum in double precision. A
//! number after `--` is that of the threads.
//!
//! Last the share that the sum over all segments, one by one, reaches of what arithmetic alone would take on
//! the machine: [`OPERATIONS`] vector instructions for as many segments as a vector has values, at the rate
//! that a loop of nothing but such instructions has on as many threads at once.

use basis::Vector3;
use benches::arithmetic;
use flow::vortex::examples::wake;
use flow::vortex::{Accuracy, direct, induced};
use std::time::Instant;

/// Trailing vortices of each blade (–).
const PER_BLADE: usize = 11;
/// Nodes at which errors are taken (–).
const N_COMPARED: usize = 300;
/// Most segments that are summed one by one (–).
const MOST_SUMMED: usize = 40_000;

/// Segments of the sum that is held against the machine's limit (–).
const N_LIMIT: usize = 10_000;
/// Vector instructions that a segment takes for a vector of places in `flow::vortex::field::near`, counted
/// in its source as it stands for AVX-512: 11 sums, differences and comparisons, 17 products, 25 sums of
/// products, 3 guesses and choices. Loads come with them.
const OPERATIONS: f64 = 56.0;

fn main() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let n_threads = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(cores);
    println!(
        "seconds on {n_threads} threads, best of five; relative error, root of the mean square"
    );
    println!("{:>9} {:>7} {:>8} {:>10} {:>10}", "segments", "degree", "opening", "time", "error");
    for n in [1_000, 3_300, 10_000, 34_000, 100_000, 300_000] {
        let segments = wake(PER_BLADE, n / (3 * PER_BLADE) + 1);
        let positions: Vec<Vector3> =
            segments.iter().map(|segment| 0.5 * (segment.from + segment.to)).collect();
        let step = (positions.len() / N_COMPARED).max(1);
        let compared: Vec<Vector3> = positions.iter().step_by(step).copied().collect();
        let mut exact = vec![Vector3::ZERO; compared.len()];
        direct(&segments, &compared, &mut exact);
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        for (degree, opening) in [(3, 0.5), (4, 0.5), (4, 0.6), (4, 0.0)] {
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
    share_of_limit(n_threads);
}

/// Prints the share of the machine's arithmetic that the sum over segments one by one reaches.
fn share_of_limit(n_threads: usize) {
    let limits = || {
        let threads: Vec<_> =
            (0..n_threads).map(|_| std::thread::spawn(arithmetic::limit)).collect();
        let found = threads.into_iter().map(|thread| thread.join().ok().flatten());
        found.collect::<Option<Vec<_>>>()
    };
    let Some(before) = limits() else {
        println!("no limit is known of a machine without AVX2");
        return;
    };
    let segments = wake(PER_BLADE, N_LIMIT / (3 * PER_BLADE) + 1);
    let positions: Vec<Vector3> =
        segments.iter().map(|segment| 0.5 * (segment.from + segment.to)).collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    let accuracy = Accuracy { degree: 4, opening: 0.0 };
    let once = || {
        let started = Instant::now();
        induced(&segments, accuracy, n_threads, &positions, &mut velocities);
        started.elapsed().as_secs_f64()
    };
    let best = std::iter::repeat_with(once).take(15).fold(f64::INFINITY, f64::min);
    let after = limits().unwrap_or_default();
    let rate = |all: &[arithmetic::Limit]| all.iter().map(|limit| limit.rate).sum::<f64>();
    let limit = rate(&before).max(rate(&after));
    let lanes = before[0].lanes as f64;
    let pairs = (segments.len() * positions.len()) as f64;
    let share = pairs / lanes * OPERATIONS / best / limit;
    println!(
        "near field: {:.2} G pairs/s on {n_threads} threads, {:.1} % of {:.2} G vector instructions/s at {OPERATIONS} for {lanes} segments",
        1e-9 * pairs / best,
        100.0 * share,
        1e-9 * limit
    );
}
