//! Speed of Gaussian-process regression: `cargo bench -p wakemix-benches --bench gaussian_process`.
//!
//! A load surrogate's size: 7287 observations of ten inputs. The Cholesky factor alone is held against the
//! double-precision operations that the same threads work out in registers (`benches::arithmetic`), measured
//! before and after each repeat, since neighbours of a machine change both; and once more by processor
//! time, of which neighbours take none, but which does not tell of threads that wait. Then the whole fit,
//! means and deviations. Options after `--`: `quick` for a sixth of the observations, a number for the
//! threads.

use benches::arithmetic::{double_limit, processor_seconds};
use std::time::Instant;
use surrogate::{Kernel, Observations, Panels, Regression, RegressionSettings, Shape};

const N_INPUTS: usize = 10;
const N_REPEATS: usize = 5;
const N_QUERIES: usize = 100_000;

/// A number in [0, 1) for each index, the same on every machine (Weyl's sequence, folded).
fn uniform(index: usize) -> f64 {
    let turned = (index as f64 + 1.0) * 0.618_033_988_749_894_9;
    let folded = (turned * 1e4).fract() * 7.31 + turned.fract() * 3.17;
    folded.fract()
}

fn inputs(n: usize, offset: usize) -> Vec<f64> {
    (0..n * N_INPUTS).map(|index| uniform(index + offset)).collect()
}

/// A smooth function of the inputs with noise.
fn observations(n: usize) -> Observations {
    let inputs = inputs(n, 0);
    let value = |(index, x): (usize, &[f64])| {
        let level =
            (3.0 * x[0] + x[1]).sin() + x[2] * x[3] + (2.0 * x[4]).cos() * x[5] + 0.5 * x[6];
        // A sum of twelve uniform numbers is nearly normal.
        let sum: f64 = (0..12).map(|k| uniform(7 * index + 91 * k + 13)).sum();
        level + 0.1 * (sum - 6.0)
    };
    let values = inputs.chunks(N_INPUTS).enumerate().map(value).collect();
    Observations { inputs, n_dimensions: N_INPUTS, values, variances: Vec::new() }
}

/// What `work` gives, and how long it took on the wall (s).
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let started = Instant::now();
    let done = work();
    (done, started.elapsed().as_secs_f64())
}

/// The factor of a matrix that costs nothing to fill in.
fn cholesky(n: usize, n_threads: usize) {
    let operations = (n as f64).powi(3) / 3.0;
    for _ in 0..N_REPEATS {
        let before = double_limit(n_threads);
        let factor = || {
            Panels::factor(n, n_threads, |rows, column, target| {
                target.fill(0.5);
                if rows.contains(&column) {
                    target[column - rows.start] = 2.0;
                }
            })
        };
        let processor = processor_seconds();
        let (found, seconds) = timed(factor);
        let rate = operations / seconds;
        let rate_of_processor = operations / (processor_seconds() - processor);
        let log = found.expect("positive definite").log_determinant();
        print!("cholesky n {n}, {n_threads} threads: {seconds:.2} s, {:.1} GFLOP/s", rate * 1e-9);
        if let (Some(before), Some(after)) = (before, double_limit(n_threads)) {
            let limit = 0.5 * (before.rate + after.rate);
            let of_processor = 0.5 * (before.rate_of_processor + after.rate_of_processor);
            print!(
                ", {:.0} % of {:.1} GFLOP/s; of processor time {:.0} % of {:.1} GFLOP/s",
                100.0 * rate / limit,
                limit * 1e-9,
                100.0 * rate_of_processor / of_processor,
                of_processor * 1e-9
            );
        }
        println!(" (ln |K| {log:.3})");
    }
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let n = if words.iter().any(|word| word == "quick") { 1215 } else { 7287 };
    let asked = words.iter().find_map(|word| word.parse().ok());
    let n_threads =
        asked.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, |n| n.get()));
    cholesky(n, n_threads);
    let data = observations(n);
    for shape in [Shape::SquaredExponential, Shape::Matern52] {
        let mut settings = RegressionSettings::default();
        settings.search.n_threads = n_threads;
        let kernel = Kernel::of(shape, N_INPUTS);
        let processor = processor_seconds();
        let (fit, seconds) = timed(|| Regression::fit(&kernel, &data, &settings).expect("a fit"));
        println!(
            "{shape:?}: fit of {n} observations with hyperparameters {seconds:.1} s, {:.1} s of processors, ln p {:.3}, noise {:.4}",
            processor_seconds() - processor,
            fit.log_marginal_likelihood(),
            fit.parameters().noise[0].sqrt()
        );
        let slopes = fit.likelihood_slopes().expect("exact");
        println!("  slopes there {:.1?}", slopes);
        let queries = inputs(N_QUERIES, 12_345);
        let processor = processor_seconds();
        let (means, seconds) = timed(|| fit.means(&queries).expect("means"));
        let processor = processor_seconds() - processor;
        println!("  {} means {seconds:.2} s, {processor:.2} s of processors", means.len());
        let some = &queries[..N_QUERIES / 50 * N_INPUTS];
        let (bands, seconds) = timed(|| fit.predict(some, 0).expect("bands"));
        println!("  {} means with deviations {seconds:.2} s", bands.len());
    }
}
