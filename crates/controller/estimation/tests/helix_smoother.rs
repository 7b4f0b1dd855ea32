//! The smoother on blade moments: it knows the future, and errs less for it.

mod machine;

use basis::angle::wrap_to_half_turn;
use basis::{Measurements, Sense};
use estimation::helix::{HelixOptions, Noise, smooth, tuning};
use estimation::{HelixEstimate, HelixEstimator};
use machine::*;

/// Three helix periods.
const CONVERGED: f64 = 3.0 * PERIOD;
/// Intensity of the phases' random walk (rad²/s).
const WANDERING: f64 = 2e-4;

/// A record of a world in which both phases wander, and the phases.
fn wandering(options: &HelixOptions, duration: f64) -> (Vec<Measurements<'static>>, Vec<[f64; 2]>) {
    let definition = definition();
    let sense = Sense::CounterClockwise;
    let mut model = model(&definition, sense, options);
    let (mut world, mut dice) = (World::new(sense, 1.0), Dice(3));
    let step = |step: usize| {
        for phase in &mut world.phases {
            *phase += (WANDERING * INTERVAL).sqrt() * dice.normal();
        }
        (world.read(step, &mut model, &mut dice), world.phases)
    };
    (0..(duration / INTERVAL) as usize).map(step).unzip()
}

/// Root mean square (rad) of the phase errors of `found` once the filter has converged, and mean of their
/// squares over the variances that go with them (–).
fn errors(found: &[HelixEstimate], record: &[Measurements], truth: &[[f64; 2]]) -> [f64; 2] {
    let (mut square, mut normalised, mut n) = (0.0, 0.0, 0.0);
    for ((estimate, read), phases) in found.iter().zip(record).zip(truth) {
        if read.time < CONVERGED {
            continue;
        }
        for (axis, phase) in [estimate.tilt, estimate.yaw].iter().zip(phases) {
            let error = wrap_to_half_turn(axis.phase - phase);
            square += error * error;
            normalised += error * error / axis.phase_variance;
            n += 1.0;
        }
    }
    [f64::sqrt(square / n), normalised / n]
}

#[test]
fn phases_that_wander_are_found_better_with_the_future_than_without() {
    // Noise as the world has it: at an amplitude of 1 m/s components wander as phases do.
    let matched = |options: HelixOptions| HelixOptions {
        noise: Noise {
            measurement: noise_of_readings(),
            amplitude: WANDERING,
            phase: WANDERING,
            mean_wind: 1e-3,
            ..options.noise
        },
        adaptation: None,
        roundness: 0.0,
        ..options
    };
    for options in [HelixOptions::default(), HelixOptions::published()].map(matched) {
        let (record, truth) = wandering(&options, 16.0 * PERIOD);
        let definition = definition();
        let new = || HelixEstimator::new(&definition, &setting(Sense::CounterClockwise), options);
        let (mut forward, mut both) = (new().expect("sound"), new().expect("sound"));
        let filtered = tuning::replay(&mut forward, &record, INTERVAL).expect("a sound record");
        let smoothed = smooth(&mut both, &record, INTERVAL).expect("a sound record");
        assert_eq!(smoothed.len(), record.len());
        // At the end there is no future.
        let last = record.len() - 1;
        assert_eq!(smoothed[last].tilt.phase, filtered[last].tilt.phase, "{:?}", options.form);
        let [of_filter, _] = errors(&filtered, &record, &truth);
        let [of_smoother, consistency] = errors(&smoothed, &record, &truth);
        // A random walk in white noise has half the variance, 0.71 of the error, from both sides.
        assert!(of_smoother < 0.85 * of_filter, "{:?}: {of_smoother} {of_filter}", options.form);
        // Errors last for some memories of the filter, of which the record has some dozens.
        assert!((0.4..2.5).contains(&consistency), "{:?}: {consistency}", options.form);
    }
}

#[test]
fn gaps_and_a_late_beginning_do_not_break_the_way_back() {
    let options = HelixOptions::published();
    let (mut record, _) = wandering(&options, 6.0 * PERIOD);
    for read in &mut record[..5] {
        read.flap_moments[1] = f64::NAN;
    }
    for read in &mut record[900..1100] {
        read.flap_moments = read.flap_moments.map(|_| f64::NAN);
    }
    let definition = definition();
    let estimator = HelixEstimator::new(&definition, &setting(Sense::CounterClockwise), options);
    let mut estimator = estimator.expect("sound");
    let smoothed = smooth(&mut estimator, &record, INTERVAL).expect("a sound record");
    let sure = |index: usize| smoothed[index].tilt.phase_variance;
    assert!(smoothed.iter().all(|estimate| estimate.tilt.phase.is_finite()));
    // In the middle of a gap both sides are far.
    assert!(sure(1000) > sure(905) && sure(1000) > sure(1095), "{} {}", sure(905), sure(1095));
}
