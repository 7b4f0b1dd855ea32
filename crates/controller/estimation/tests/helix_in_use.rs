//! The helix estimator in use: tuned, resumed, refused where it cannot work, given whatever instruments show.

mod machine;

use basis::Sense;
use estimation::helix::tuning::TrueWave;
use estimation::helix::*;
use estimation::{EstimationError, Estimator, HelixEstimator};
use machine::*;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

#[test]
fn tuning_finds_the_noise_and_a_scale_that_serves() {
    let definition = definition();
    let options = HelixOptions::published();
    let sense = Sense::CounterClockwise;
    let mut model = model(&definition, sense, &options);
    let (mut world, mut dice) = (World::new(sense, 1.0), Dice(11));
    let (mut record, mut truth) = (Vec::new(), TrueWave::default());
    for step in 0..(8.0 * PERIOD / INTERVAL) as usize {
        let angle = world.rate * step as f64 * INTERVAL;
        world.phases = [1.0 + 0.3 * (angle / 5.0).sin(); 2];
        world.mean_wind = 9.0 + 0.3 * (angle / 4.0).sin();
        truth.average.push(world.mean_wind);
        truth.amplitudes.iter_mut().for_each(|column| column.push(1.0));
        truth.phases.iter_mut().for_each(|column| column.push(world.phases[0]));
        record.push(world.read(step, &mut model, &mut dice));
    }
    let tuned = tuning::tune(&definition, &setting(sense), options, &record, &truth).unwrap();
    assert!(tuned.error.to_degrees() < 8.0, "{}", tuned.error.to_degrees());
    // Chosen on the second half, and not worse there than what was given.
    assert!(tuned.error <= tuned.untuned_error + 0.02, "{tuned:?}");
    let Measurement::Moment(density) = tuned.options.noise.measurement else { panic!() };
    let expected = 0.05 * record[50].flap_moments.mean() * INTERVAL.sqrt();
    assert!((0.8..1.3).contains(&(density / expected)), "{}", density / expected);
    // The mean wind's process noise is found too, and scaled with the rest.
    let found = tuning::process_noise(&truth, INTERVAL, TAU / PERIOD).unwrap();
    let scaled = tuned.options.noise.mean_wind / (tuned.scale * found.mean_wind);
    assert!((0.8..1.25).contains(&scaled), "{scaled}");
    let Noise { amplitude, phase, .. } = tuned.options.noise;
    assert!(phase / amplitude > 1e3, "{tuned:?}");
    // A gap, another interval, a lost azimuth and a truth of another length are reported.
    let tune = |record: &[_], truth: &TrueWave| {
        tuning::tune(&definition, &setting(sense), options, record, truth).unwrap_err()
    };
    let gap: Vec<_> = record.iter().enumerate().filter(|(k, _)| *k != 500).map(|r| *r.1).collect();
    assert!(matches!(tune(&gap, &truth), EstimationError::Sample { index: 500, .. }));
    let every_other: Vec<_> = record.iter().step_by(2).copied().collect();
    assert!(matches!(tune(&every_other, &truth), EstimationError::Sample { index: 1, .. }));
    let mut blind = record.clone();
    blind[7].azimuth = f64::NAN;
    assert!(matches!(tune(&blind, &truth), EstimationError::Sample { index: 7, .. }));
    let short = TrueWave { average: truth.average[..9].to_vec(), ..truth.clone() };
    assert!(matches!(tune(&record, &short), EstimationError::Length { .. }));
    let n = record.len() / 2;
    let part = TrueWave {
        average: truth.average[..n].to_vec(),
        amplitudes: truth.amplitudes.map(|column| column[..n].to_vec()),
        phases: truth.phases.map(|column| column[..n].to_vec()),
    };
    assert!(matches!(tune(&record[..n], &part), EstimationError::TooShort { .. }));
}

/// A filter that is tuned on the rows of a series, half a second apart, meant for control every tenth of one.
#[test]
fn noise_found_at_one_interval_means_the_same_at_another() {
    let definition = definition();
    let options = HelixOptions { jacobian: Jacobian::Analytic, ..HelixOptions::published() };
    let sense = Sense::CounterClockwise;
    let found = [0.1, 0.5].map(|interval| {
        let mut model = model(&definition, sense, &options);
        // The same noise, a reading of it for each interval; hardly a helix, which the high pass lets through
        // in part and which is no white noise.
        let noise = 0.05 * (0.1_f64 / interval).sqrt();
        let world = World { noise, amplitudes: [0.1; 2], ..World::new(sense, 1.0) };
        let mut dice = Dice(3);
        let n = (8.0 * PERIOD / interval) as usize;
        let read = |step: usize| world.read_every(interval, step, &mut model, &mut dice);
        let record: Vec<_> = (0..n).map(read).collect();
        let wander = |k: usize| (TAU * interval * k as f64 / 400.0).sin();
        let column = |mean: f64, swing: f64| -> Vec<f64> {
            (0..n).map(|k| mean + swing * wander(k)).collect()
        };
        let truth = TrueWave {
            average: column(9.0, 0.2),
            amplitudes: [column(1.0, 0.1), column(1.0, 0.1)],
            phases: [column(1.0, 0.2), column(1.0, 0.2)],
        };
        let set = HelixSettings { interval, ..setting(sense) };
        let tuned = tuning::tune(&definition, &set, options, &record, &truth).unwrap();
        let Measurement::Moment(density) = tuned.options.noise.measurement else { panic!() };
        let noise = tuned.options.noise;
        [density.powi(2), noise.mean_wind / tuned.scale, noise.phase / tuned.scale]
    });
    for (fine, coarse) in found[0].iter().zip(found[1]) {
        assert!((coarse / fine - 1.0).abs() < 0.15, "{found:?}");
    }
}

#[test]
fn the_usual_elements_are_enough() {
    let definition = definition();
    let options = HelixOptions::default();
    let reading = |n_elements: usize| {
        let setting = HelixSettings { n_elements, ..setting(Sense::CounterClockwise) };
        let mut model = MeasurementModel::new(&definition, &setting, &options).unwrap();
        let world = World { noise: 0.0, ..World::new(Sense::CounterClockwise, 0.0) };
        (0..100).map(|step| world.read(step, &mut model, &mut Dice(1)).flap_moments).last().unwrap()
    };
    let (few, many) = (reading(HelixSettings::N_ELEMENTS), reading(60));
    for (few, many) in few.iter().zip(many.iter()) {
        assert!((few / many - 1.0).abs() < 0.01, "{}", few / many);
    }
}

#[test]
fn a_resumed_estimator_goes_on_with_the_same_bits() {
    let definition = definition();
    let options = HelixOptions::default();
    let mut model = model(&definition, Sense::Clockwise, &options);
    let world = World { own: (0.05, 1.0), ..World::new(Sense::Clockwise, 2.0) };
    let mut noise = Dice(5);
    let record: Vec<_> = (0..400).map(|step| world.read(step, &mut model, &mut noise)).collect();
    let new = || HelixEstimator::new(&definition, &setting(Sense::Clockwise), options).unwrap();
    let mut whole = new();
    record[..200].iter().for_each(|measurements| _ = whole.update(measurements));
    let bytes = postcard::to_stdvec(whole.state()).unwrap();
    let mut resumed = new();
    resumed.restore(postcard::from_bytes(&bytes).unwrap());
    assert_eq!(whole.state(), resumed.state());
    for measurements in &record[200..] {
        assert_eq!(whole.update(measurements), resumed.update(measurements));
    }
    assert_eq!(whole.state(), resumed.state());
}

#[test]
fn what_cannot_work_is_said_at_once() {
    let definition = definition();
    let good = setting(Sense::Clockwise);
    let error = |setting: HelixSettings, options: HelixOptions| {
        HelixEstimator::new(&definition, &setting, options).unwrap_err()
    };
    let options = HelixOptions::default();
    let slow = error(HelixSettings { interval: 4.0, ..good }, options);
    assert!(matches!(slow, EstimationError::AboveNyquist { .. }), "{slow}");
    let fast = error(HelixSettings { rate: 20.0, ..good }, options);
    assert!(matches!(fast, EstimationError::AboveNyquist { .. }), "{fast}");
    let rare = error(good, HelixOptions { update_every: 30, ..options });
    assert!(matches!(rare, EstimationError::AboveNyquist { .. }), "{rare}");
    let noise = Noise { amplitude: -1e-4, ..options.noise };
    let negative = error(good, HelixOptions { noise, ..options });
    assert!(negative.to_string().contains("not positive definite"), "{negative}");
    let noise = Noise { measurement: Measurement::Moment(0.0), ..options.noise };
    let silent = error(good, HelixOptions { noise, ..options });
    assert!(matches!(silent, EstimationError::NotPositiveDefinite { name: "measurement", .. }));
    let round = error(good, HelixOptions { roundness: 1.0, ..options });
    assert!(matches!(round, EstimationError::NotPositiveDefinite { name: "process", .. }));
    let none = error(HelixSettings { rate: f64::NAN, ..good }, options);
    assert!(matches!(none, EstimationError::Setting { .. }), "{none}");
    let mut two = (*definition).clone();
    two.n_blades = 2;
    let two = HelixEstimator::new(&two.into(), &good, options).unwrap_err();
    assert_eq!(two, EstimationError::FewBlades { n_blades: 2 });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// Whatever instruments show, every number of the estimate is finite and phases lie on the circle.
    #[test]
    fn no_reading_brings_it_down(
        odd in prop::collection::vec((0..8_usize, any::<f64>()), 30),
    ) {
        let definition = definition();
        let options = HelixOptions::default();
        let mut model = model(&definition, Sense::Clockwise, &options);
        let mut estimator = HelixEstimator::new(&definition, &setting(Sense::Clockwise), options).unwrap();
        let (world, mut noise) = (World::new(Sense::Clockwise, 2.0), Dice(9));
        for (step, (what, value)) in odd.into_iter().enumerate() {
            let mut measurements = world.read(step, &mut model, &mut noise);
            match what {
                0..=2 => measurements.flap_moments[what] = value,
                3 => measurements.azimuth = value,
                4 => measurements.rotor_speed = value,
                5 => measurements.pitch[1] = value,
                6 => measurements.time = value,
                _ => measurements.interval = value,
            }
            let estimate = estimator.update(&measurements);
            for axis in [estimate.tilt, estimate.yaw] {
                prop_assert!((0.0..TAU).contains(&axis.phase), "{estimate:?}");
                prop_assert!(axis.amplitude.is_finite() && axis.phase_variance.is_finite());
                prop_assert!(axis.phase_variance <= PI * PI / 3.0 + 1e-12);
            }
            prop_assert!(estimate.mean_wind.is_finite());
            prop_assert!((0.0..=1.0).contains(&estimate.trust.overall()), "{estimate:?}");
        }
    }
}
