//! Speed of rainflow counting on one core: `cargo bench -p wakemix-benches --bench fatigue`.
//!
//! Three loads: a smooth one as turbines give (two sines and a slow drift), the same with noise, and noise
//! alone, whose samples turn round most of the time. Each is counted alone, for one slope and for three.
//! Repeats are short, so that on a loaded machine some go undisturbed; the best counts.
//! Options after `--`: `quick` for short loads, a number for the repeats.

use analysis::fatigue::{LoadCounter, Rainflow};
use std::hint::black_box;
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let quick = arguments.iter().any(|argument| argument == "quick");
    let n_repeats = arguments.iter().find_map(|argument| argument.parse().ok()).unwrap_or(300);
    let n_samples = if quick { 1 << 16 } else { 1 << 18 };
    println!("{n_samples} samples; million samples a second on one core, best of {n_repeats}");
    println!("{:<26} {:>8} {:>8} {:>8}", "load", "count", "m = 10", "m = 3, 4, 10");
    for (name, load) in loads(n_samples) {
        let rates = [&[][..], &[10.0], &[3.0, 4.0, 10.0]]
            .map(|slopes| (0..n_repeats).map(|_| rate(&load, slopes)).fold(0.0, f64::max));
        println!("{name:<26} {:>8.0} {:>8.0} {:>8.0}", rates[0], rates[1], rates[2]);
    }
}

fn loads(n_samples: usize) -> [(&'static str, Vec<f64>); 3] {
    let mut state = 1_u64;
    let mut noise = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    // Sampled at 50 Hz: tower and rotor frequency of a large turbine, and wind that changes over minutes.
    let smooth = |index: usize| {
        let time = 0.02 * index as f64;
        5e7 + 2e7 * (0.68 * time).sin() + 4e6 * (1.6 * time).sin() + 1e7 * (0.011 * time).sin()
    };
    [
        ("smooth", (0..n_samples).map(smooth).collect()),
        ("smooth with 2 % of noise", (0..n_samples).map(|i| smooth(i) + 1e6 * noise()).collect()),
        ("noise", (0..n_samples).map(|_| 1e7 * noise()).collect()),
    ]
}

/// Million samples a second, counted for `slopes`, or cycles alone when there are none.
fn rate(load: &[f64], slopes: &[f64]) -> f64 {
    let start = Instant::now();
    if slopes.is_empty() {
        let mut rainflow = Rainflow::new();
        let mut ranges = 0.0;
        let done = rainflow.extend(black_box(load), |cycle| ranges += cycle.count * cycle.range);
        assert!(done.is_ok(), "the bench's own load");
        rainflow.finish(|cycle| ranges += cycle.count * cycle.range);
        black_box(ranges);
    } else {
        let counted = LoadCounter::new(slopes).and_then(|mut counter| {
            counter.extend(black_box(load))?;
            counter.finish(0.02 * load.len() as f64)
        });
        match counted {
            Ok(fatigue) => _ = black_box(fatigue),
            Err(error) => panic!("the bench's own load: {error}"),
        }
    }
    load.len() as f64 / start.elapsed().as_secs_f64() / 1e6
}
