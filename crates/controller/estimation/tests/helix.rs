//! The helix estimator on blade moments that its own model makes, with noise and turbulence.

mod machine;

use basis::Sense;
use basis::angle::wrap_to_half_turn;
use estimation::helix::*;
use estimation::{Estimator, HelixEstimate, HelixEstimator};
use machine::*;
use std::f64::consts::TAU;

const SENSES: [Sense; 2] = [Sense::CounterClockwise, Sense::Clockwise];
/// Three helix periods.
const CONVERGED: f64 = 3.0 * PERIOD;

/// Runs `duration` (s) in a world that `change` may change at each step; gives each instant's world and
/// estimate.
fn run(
    options: HelixOptions,
    world: World,
    duration: f64,
    mut change: impl FnMut(f64, &mut World, &mut Dice),
) -> Vec<(f64, World, HelixEstimate)> {
    let definition = definition();
    let mut model = model(&definition, world.sense, &options);
    let mut estimator = HelixEstimator::new(&definition, &setting(world.sense), options).unwrap();
    let (mut world, mut noise) = (world, Dice(7));
    (0..(duration / INTERVAL) as usize)
        .map(|step| {
            let time = step as f64 * INTERVAL;
            change(time, &mut world, &mut noise);
            let measurements = world.read(step, &mut model, &mut noise);
            (time, world, estimator.update(&measurements))
        })
        .collect()
}

/// Errors of tilt's and yaw's phase (deg) from `from` (s) on.
fn errors(record: &[(f64, World, HelixEstimate)], from: f64) -> [Vec<f64>; 2] {
    [0, 1].map(|axis| {
        let error = |(_, world, estimate): &(f64, World, HelixEstimate)| {
            let phase = [estimate.tilt, estimate.yaw][axis].phase;
            wrap_to_half_turn(phase - world.phases[axis]).to_degrees()
        };
        record.iter().filter(|(time, ..)| *time >= from).map(error).collect()
    })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

fn still(_: f64, _: &mut World, _: &mut Dice) {}

#[test]
fn finds_any_phase_within_two_degrees_after_three_periods_while_its_own_rotor_pitches() {
    for sense in SENSES {
        let mut biases = Vec::new();
        for k in 0..12 {
            let phase = TAU * f64::from(k) / 12.0;
            let mut world = World::new(sense, phase);
            world.own = (0.07, phase + 2.5 * f64::from(k));
            let errors = errors(&run(HelixOptions::default(), world, 550.0, still), CONVERGED);
            for errors in &errors {
                assert!(rms(errors) < 2.0, "{sense} {k}: {}", rms(errors));
                biases.push(mean(errors));
            }
        }
        assert!(mean(&biases).abs() < 0.5, "{sense}: {}", mean(&biases));
    }
}

#[test]
fn the_published_form_and_separate_amplitudes_find_the_phase_too() {
    let separate = HelixOptions {
        form: Form::SeparateAmplitudes,
        noise: HelixOptions::published().noise,
        ..HelixOptions::published()
    };
    for options in [HelixOptions::published(), separate] {
        for sense in SENSES {
            let mut world = World::new(sense, 1.0);
            world.own = (0.07, 3.0);
            for errors in errors(&run(options, world, 550.0, still), CONVERGED) {
                assert!(rms(&errors) < 4.0, "{sense} {:?}: {}", options.form, rms(&errors));
            }
        }
    }
}

/// In a world like the filter's model its variances are those of its errors, and innovations are white.
#[test]
fn innovations_and_errors_keep_within_their_chi_square_bounds() {
    let density = 2e-4;
    let eddies = Eddies { deviation: 0.3, time_constant: 0.5 };
    let base = HelixOptions::default();
    let options = HelixOptions {
        noise: Noise {
            measurement: noise_of_readings(),
            amplitude: density,
            mean_wind: 1e-3,
            ..base.noise
        },
        eddies: Some(eddies),
        adaptation: None,
        response: None,
        roundness: 0.0,
        ..base
    };
    let n_runs = 24;
    let (mut errors, mut innovations) = (0.0, Vec::new());
    let definition = definition();
    for seed in 0..n_runs {
        let mut model = model(&definition, Sense::CounterClockwise, &options);
        let set = setting(Sense::CounterClockwise);
        let mut estimator = HelixEstimator::new(&definition, &set, options).unwrap();
        let mut noise = Dice(1 + seed);
        let mut world = World::new(Sense::CounterClockwise, 0.0);
        // Sine and cosine components as random walks; eddies as Gauss-Markov noise.
        let mut parts = [0.9, 0.4, 0.9, 0.4];
        let bias = [0.3 * noise.normal(), 0.3 * noise.normal()];
        let mut passing = [0.0; 2];
        for step in 0..(5.0 * PERIOD / INTERVAL) as usize {
            let kept = (-INTERVAL * 9.0 / (0.5 * 240.0)).exp();
            parts.iter_mut().for_each(|part| *part += (density * INTERVAL).sqrt() * noise.normal());
            world.mean_wind += (1e-3 * INTERVAL).sqrt() * noise.normal();
            for (passing, (other, bias)) in passing.iter_mut().zip(world.other.iter_mut().zip(bias))
            {
                *passing = kept * *passing + 0.3 * (1.0 - kept * kept).sqrt() * noise.normal();
                *other = bias + *passing;
            }
            world.amplitudes = [parts[0].hypot(parts[1]), parts[2].hypot(parts[3])];
            world.phases = [parts[1].atan2(parts[0]), parts[3].atan2(parts[2])];
            let estimate = estimator.update(&world.read(step, &mut model, &mut noise));
            if (step + 1) % (PERIOD / INTERVAL) as usize == 0
                && step as f64 * INTERVAL > 2.0 * PERIOD
            {
                innovations.push(estimate.innovation);
            }
            if step + 1 == (5.0 * PERIOD / INTERVAL) as usize {
                for (axis, truth) in [estimate.tilt, estimate.yaw].iter().zip(world.phases) {
                    errors += wrap_to_half_turn(axis.phase - truth).powi(2) / axis.phase_variance;
                }
            }
        }
    }
    // Wilson and Hilferty's cube: 99.9 % bounds of a chi-square of n degrees of freedom over n.
    let bounds = |n: f64| {
        let cube = |z: f64| (1.0 - 2.0 / (9.0 * n) + z * (2.0 / (9.0 * n)).sqrt()).powi(3);
        cube(-3.29)..cube(3.29)
    };
    let n = 2.0 * n_runs as f64;
    assert!(bounds(n).contains(&(errors / n)), "{} not in {:?}", errors / n, bounds(n));
    // An exponential mean over a period of n readings weighs as many as two periods in a plain mean.
    let n = 2.0 * 3.0 * PERIOD / INTERVAL * innovations.len() as f64;
    let innovation = mean(&innovations);
    assert!(bounds(n).contains(&innovation), "{innovation} not in {:?}", bounds(n));
}

#[test]
fn eddies_leave_the_phase_within_ten_degrees_and_are_known_to() {
    let mut passing = [0.0; 2];
    let record = run(
        HelixOptions::default(),
        World::new(Sense::CounterClockwise, 2.0),
        2000.0,
        |_, world, noise| {
            let kept = (-INTERVAL / 15.0_f64).exp();
            for passing in &mut passing {
                *passing = kept * *passing + 0.4 * (1.0 - kept * kept).sqrt() * noise.normal();
            }
            world.other = [1.0 + passing[0], passing[1]];
        },
    );
    let errors = errors(&record, CONVERGED);
    let estimate = |index: usize| {
        let late = record.iter().filter(|(time, ..)| *time >= CONVERGED);
        let deviation: Vec<f64> =
            late.map(|(.., e)| [e.tilt, e.yaw][index].phase_variance.sqrt().to_degrees()).collect();
        mean(&deviation)
    };
    for (index, errors) in errors.iter().enumerate() {
        assert!(rms(errors) < 10.0, "{}", rms(errors));
        // The filter's own deviation tells the error within a factor of two.
        assert!((0.5..2.0).contains(&(rms(errors) / estimate(index))), "{}", estimate(index));
    }
    // Shear is found as what lasts.
    let tilts: Vec<f64> =
        record.iter().filter(|(t, ..)| *t > CONVERGED).map(|r| r.2.other.tilt).collect();
    assert!((mean(&tilts) - 1.0).abs() < 0.2, "{}", mean(&tilts));
}

#[test]
fn goes_on_through_dropouts_and_says_so() {
    let definition = definition();
    let options = HelixOptions::default();
    let mut model = model(&definition, Sense::Clockwise, &options);
    let mut estimator =
        HelixEstimator::new(&definition, &setting(Sense::Clockwise), options).unwrap();
    let (world, mut noise) = (World::new(Sense::Clockwise, 4.0), Dice(3));
    let mut shown = [0.0; 3];
    let (mut errors, mut partial) = (Vec::new(), 0);
    let mut variance = 0.0;
    for step in 0..(600.0 / INTERVAL) as usize {
        let mut measurements = world.read(step, &mut model, &mut noise);
        let time = measurements.time;
        for (moment, shown) in measurements.flap_moments.iter_mut().zip(&mut shown) {
            if noise.uniform() < 0.1 {
                *moment = if noise.uniform() < 0.5 { f64::NAN } else { *shown };
            }
            *shown = *moment;
        }
        let silent = (450.0..500.0).contains(&time);
        if silent {
            measurements.flap_moments.iter_mut().for_each(|moment| *moment = f64::NAN);
        }
        let estimate = estimator.update(&measurements);
        if silent {
            assert_eq!(estimate.status, Status::Holding);
            assert!(estimate.tilt.phase_variance >= variance);
            variance = estimate.tilt.phase_variance;
        }
        if time > CONVERGED {
            partial += usize::from(estimate.status == Status::Partial);
            errors.push(wrap_to_half_turn(estimate.yaw.phase - 4.0).to_degrees());
        }
    }
    assert!(partial > 200, "{partial}");
    assert!(rms(&errors) < 2.5, "{}", rms(&errors));
}

#[test]
fn a_step_of_the_wind_does_not_turn_the_phase() {
    let record = run(
        HelixOptions::default(),
        World::new(Sense::CounterClockwise, 1.0),
        600.0,
        |time, world, _| {
            world.mean_wind = if time > 350.0 { 11.0 } else { 9.0 };
        },
    );
    for errors in errors(&record, CONVERGED) {
        assert!(errors.iter().all(|error| error.abs() < 12.0));
    }
    let last = record.last().unwrap().2;
    assert!((last.mean_wind - 11.0).abs() < 0.6, "{}", last.mean_wind);
}

#[test]
fn trust_goes_with_the_helix_and_comes_back() {
    let mut passing = [0.0; 2];
    let record = run(
        HelixOptions::default(),
        World::new(Sense::CounterClockwise, 1.0),
        2000.0,
        |time, world, noise| {
            let kept = (-INTERVAL / 15.0_f64).exp();
            for passing in &mut passing {
                *passing = kept * *passing + 0.3 * (1.0 - kept * kept).sqrt() * noise.normal();
            }
            world.other = passing;
            world.amplitudes = if (600.0..1300.0).contains(&time) { [0.0; 2] } else { [1.0; 2] };
        },
    );
    let trust = |at: f64| record[(at / INTERVAL) as usize].2.trust.overall();
    assert!(trust(590.0) > 0.6, "{}", trust(590.0));
    assert!(trust(1290.0) < 0.3, "{}", trust(1290.0));
    assert!(trust(1990.0) > 0.5, "{}", trust(1990.0));
    for errors in errors(&record, 1300.0 + CONVERGED) {
        assert!(rms(&errors) < 12.0, "{}", rms(&errors));
    }
}

#[test]
fn chain_rule_and_differences_give_the_same_filter() {
    let world = World::new(Sense::CounterClockwise, 5.0);
    let by =
        |jacobian| run(HelixOptions { jacobian, ..HelixOptions::default() }, world, 60.0, still);
    let (exact, tried) = (by(Jacobian::Analytic), by(Jacobian::CentralDifferences { step: 1e-5 }));
    for ((.., exact), (.., tried)) in exact.iter().zip(&tried) {
        assert!((exact.mean_wind - tried.mean_wind).abs() < 1e-3);
        assert!((exact.helix.tilt - tried.helix.tilt).abs() < 1e-3);
        assert!((exact.helix.yaw - tried.helix.yaw).abs() < 1e-3);
        let ratio = exact.tilt.phase_variance / tried.tilt.phase_variance;
        assert!((ratio - 1.0).abs() < 1e-2, "{ratio}");
    }
}

#[test]
fn a_rate_that_is_not_the_nominal_one_is_found() {
    let mut world = World::new(Sense::CounterClockwise, 1.0);
    world.rate *= 1.02;
    let options = HelixOptions { rate: Some(1e-10), ..HelixOptions::default() };
    let record = run(options, world, 1500.0, still);
    let last = record.last().unwrap().2;
    assert!((last.rate / world.rate - 1.0).abs() < 2e-3, "{}", last.rate / world.rate);
    // Phases refer to the nominal excitation, on which the helix gains.
    let truth = 1.0 + 0.02 * TAU / PERIOD * 1499.8;
    assert!(wrap_to_half_turn(last.tilt.phase - truth).abs() < 0.05);
}

/// Where the rotor does not pitch and the wake answers at once the earlier method serves; with a rotor that
/// pitches in a wake that takes its time it is out several times as far as the extended filter.
#[test]
fn the_linear_filter_serves_at_its_point_alone() {
    let (definition, sense) = (definition(), Sense::CounterClockwise);
    let still = HelixOptions {
        rotor: Rotor { wake: Wake::Static, flexible: false, ..HelixOptions::default().rotor },
        ..HelixOptions::default()
    };
    let errors = |truth: HelixOptions, own: f64| {
        let mut model = model(&definition, sense, &truth);
        let point = OperatingPoint { wind: 9.0, rotor_speed: ROTOR_SPEED, pitch: 0.0 };
        let mut linear = LinearEstimator::new(&definition, &setting(sense), point, truth).unwrap();
        let mut extended = HelixEstimator::new(&definition, &setting(sense), truth).unwrap();
        let mut world = World::new(sense, 1.0);
        world.own = (own, 3.0);
        let (mut dice, mut errors) = (Dice(4), [Vec::new(), Vec::new()]);
        for step in 0..(600.0 / INTERVAL) as usize {
            let read = world.read(step, &mut model, &mut dice);
            for (errors, estimate) in
                errors.iter_mut().zip([linear.update(&read), extended.update(&read)])
            {
                if read.time > CONVERGED {
                    errors.push(wrap_to_half_turn(estimate.tilt.phase - 1.0).to_degrees());
                }
            }
        }
        errors.map(|errors| rms(&errors))
    };
    let [linear, _] = errors(still, 0.0);
    assert!(linear < 5.0, "{linear}");
    let [linear, extended] = errors(HelixOptions::default(), 0.07);
    assert!(extended < 2.0 && linear > 4.0 * extended, "{linear} {extended}");
}
