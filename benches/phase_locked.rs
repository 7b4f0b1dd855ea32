//! Cost of a phase-locked loop's update on one core: `cargo bench -p wakemix-benches --bench phase_locked`.
//!
//! One signal, and a turbine's two from its blades' moments, with each generator. Repeats are short, so that
//! on a loaded machine some go undisturbed; the best counts. A number after `--` is that of the repeats.

use basis::{Measurements, PerBlade, Sense};
use estimation::Estimator;
use estimation::phase_locked::{
    GeneratorKind, Leader, PhaseLockedLoop, PhaseLockedSettings, TwoAxisLoop, TwoAxisSettings,
};
use std::f64::consts::SQRT_2;
use std::hint::black_box;
use std::time::Instant;

/// Interval of the updates (s), and how many make a repeat.
const INTERVAL: f64 = 0.1;
const N_UPDATES: u32 = 10_000;

fn main() {
    let n_repeats =
        std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(300);
    println!("nanoseconds an update on one core, best of {n_repeats}");
    println!("{:<10} {:>12} {:>12}", "generator", "one signal", "two axes");
    let extended = match GeneratorKind::extended(SQRT_2, 1.0) {
        Ok(kind) => kind,
        Err(error) => panic!("the bench's own settings: {error}"),
    };
    for (name, generator) in
        [("SOGI", GeneratorKind::Second), ("ESOGI", extended), ("MSTOGI", GeneratorKind::Mixed)]
    {
        let signal =
            PhaseLockedSettings { generator, ..PhaseLockedSettings::between([0.03, 0.09]) };
        let best = |cost: fn(&PhaseLockedSettings) -> f64| {
            (0..n_repeats).map(|_| cost(&signal)).fold(f64::INFINITY, f64::min)
        };
        println!("{name:<10} {:>12.0} {:>12.0}", best(one_signal), best(two_axes));
    }
}

/// Nanoseconds an update of one signal.
fn one_signal(settings: &PhaseLockedSettings) -> f64 {
    let mut follower = match PhaseLockedLoop::new(settings, INTERVAL) {
        Ok(follower) => follower,
        Err(error) => panic!("the bench's own settings: {error}"),
    };
    let start = Instant::now();
    for step in 0..N_UPDATES {
        // A triangle in place of a sine, whose cost would count.
        let sample = f64::from((step % 1200).abs_diff(600)) - 300.0;
        black_box(follower.update(INTERVAL, black_box(sample)));
    }
    1e9 * start.elapsed().as_secs_f64() / f64::from(N_UPDATES)
}

/// Nanoseconds an update of a turbine's two signals, the multi-blade transformation among them.
fn two_axes(settings: &PhaseLockedSettings) -> f64 {
    let settings =
        TwoAxisSettings { signal: *settings, sense: Sense::Clockwise, leader: Leader::Both };
    let mut follower = match TwoAxisLoop::new(&settings, INTERVAL) {
        Ok(follower) => follower,
        Err(error) => panic!("the bench's own settings: {error}"),
    };
    let mut measurements = Measurements {
        interval: INTERVAL,
        rotor_speed: 0.7,
        generator_speed: 0.7,
        flap_moments: PerBlade::splat(3, 5e7),
        ..Measurements::at_rest(3)
    };
    let start = Instant::now();
    for step in 0..N_UPDATES {
        measurements.azimuth = 0.07 * f64::from(step % 90);
        measurements.flap_moments[0] = 1e5 * f64::from((step % 1200).abs_diff(600));
        black_box(follower.update(black_box(&measurements)));
    }
    1e9 * start.elapsed().as_secs_f64() / f64::from(N_UPDATES)
}
