//! One test body for every estimator: the blade moments of a known helix, whatever finds it in them.

mod machine;

use basis::angle::wrap_to_half_turn;
use basis::mbc::to_fixed_frame;
use basis::{Measurements, Sense};
use estimation::helix::{HelixEstimator, HelixOptions};
use estimation::phase_locked::{
    GeneratorKind, Leader, PhaseLockedSettings, TwoAxisLoop, TwoAxisSettings,
};
use estimation::{Estimator, Oscillation, Quantity};
use machine::*;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::f64::consts::{SQRT_2, TAU};
use std::sync::LazyLock;

const CCW: Sense = Sense::CounterClockwise;
const CW: Sense = Sense::Clockwise;
/// Length of a record, in its own periods (–).
const PERIODS: f64 = 10.0;
/// Beginning of the dropout, its length, and where its marks are judged again, in periods (–).
const DROPOUT: [f64; 3] = [4.5, 0.5, 7.5];
/// Confidence above which a phase is used, and under which none is (–): synchronisation's threshold for the
/// first.
const TRUSTED: f64 = 0.15;

/// What an estimator promises, with 5 % of noise on a helix of 1 m/s and without noise; noise counts for more
/// on a weaker one.
struct Promise {
    /// Periods after which it holds (–).
    settled: f64,
    /// Root mean square of either phase's error (deg).
    phase: [f64; 2],
    /// Root mean square of the rate's error (–).
    rate: [f64; 2],
}

impl Promise {
    /// Bounds of phase (deg) and rate (–) on `known`.
    fn on(&self, known: &Known) -> [f64; 2] {
        [self.phase, self.rate].map(|[noisy, clean]| {
            if known.noisy { noisy / known.amplitude.min(1.0) } else { clean }
        })
    }
}

/// A record with the truth about it.
struct Known {
    name: String,
    sense: Sense,
    /// Rate of the helix (rad/s) and its amplitude (m/s).
    rate: f64,
    amplitude: f64,
    noisy: bool,
    record: Vec<Measurements<'static>>,
    /// Phases of tilt and yaw at time zero (rad), of the wind and of the load.
    wind: [f64; 2],
    load: [f64; 2],
}

impl Known {
    /// Moments of a helix of `amplitude` (m/s) at `factor` (–) of the usual rate, the rotor pitching by `own`
    /// (rad).
    fn new(sense: Sense, factor: f64, amplitude: f64, noise: f64, own: f64) -> Self {
        let (definition, options) = (definition(), HelixOptions::default());
        let rate = factor * TAU / PERIOD;
        let mut world = World::new(sense, 1.0);
        (world.rate, world.amplitudes, world.own) = (rate, [amplitude; 2], (own, 2.5));
        let n = (PERIODS * TAU / rate / INTERVAL) as usize;
        let made = |noise| {
            let mut model = model(&definition, sense, &options);
            let (world, mut dice) = (World { noise, ..world }, Dice(3));
            (0..n).map(|step| world.read(step, &mut model, &mut dice)).collect::<Vec<_>>()
        };
        let clean = made(0.0);
        let load = swing(&clean, rate);
        let record = if noise == 0.0 { clean } else { made(noise) };
        let name = format!("{sense}, {factor} of the rate, {amplitude} m/s, {noise} noise");
        let wind = [world.phases[0], sense.yaw_lead() + world.phases[1]];
        Self { name, sense, rate, amplitude, noisy: noise > 0.0, record, wind, load }
    }

    /// Errors of the estimate `estimate` (rad) at `time` (s).
    fn errors(&self, estimate: &Oscillation, time: f64) -> [f64; 2] {
        let truth = match estimate.quantity {
            Quantity::Wind => self.wind,
            Quantity::Load => self.load,
        };
        [0, 1].map(|axis| wrap_to_half_turn(estimate.phases[axis] - truth[axis] - self.rate * time))
    }
}

/// Phases of tilt and yaw moment in the second half of `record`, a whole number of periods of `rate` (rad/s).
fn swing(record: &[Measurements], rate: f64) -> [f64; 2] {
    let mut parts = [[0.0; 2]; 2];
    let half = &record[record.len() / 2..];
    let loads = |read: &Measurements| to_fixed_frame(read.azimuth, &read.flap_moments);
    let n = half.len() as f64;
    let mean = half
        .iter()
        .map(loads)
        .fold([0.0; 2], |[tilt, yaw], load| [tilt + load.tilt / n, yaw + load.yaw / n]);
    for read in half {
        let (load, (sine, cosine)) = (loads(read), (rate * read.time).sin_cos());
        for (parts, load) in parts.iter_mut().zip([load.tilt - mean[0], load.yaw - mean[1]]) {
            parts[0] += load * sine;
            parts[1] += load * cosine;
        }
    }
    parts.map(|[sine, cosine]| cosine.atan2(sine))
}

/// Records that all are judged on.
static RECORDS: LazyLock<Vec<Known>> = LazyLock::new(|| {
    vec![
        Known::new(CCW, 1.0, 1.0, 0.0, 0.0),
        Known::new(CW, 0.8, 1.0, 0.0, 0.0),
        Known::new(CCW, 0.65, 1.0, 0.05, 0.0),
        Known::new(CW, 0.65, 1.0, 0.05, 0.0),
        Known::new(CCW, 1.0, 0.5, 0.05, 0.0),
        Known::new(CW, 1.0, 2.0, 0.05, 0.0),
        Known::new(CCW, 1.15, 1.0, 0.05, 0.0),
        Known::new(CW, 1.15, 1.0, 0.05, 0.0),
        Known::new(CCW, 1.0, 1.0, 0.05, 0.07),
        Known::new(CW, 0.8, 1.0, 0.05, 0.07),
    ]
});

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, with a count.
struct Counting;

// SAFETY: every call goes to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Estimate of `estimator` after `read`; all its numbers are finite, and nothing is allocated for it.
fn checked_estimate<E: Estimator>(estimator: &mut E, read: &Measurements) -> Oscillation {
    let before = COUNT.with(Cell::get);
    let oscillation: Oscillation = estimator.update(read).into();
    assert_eq!(COUNT.with(Cell::get), before, "an update allocates");
    let Oscillation { rate, phases, amplitudes, trust, .. } = oscillation;
    assert!(phases.iter().all(|phase| (0.0..TAU).contains(phase)), "{oscillation:?}");
    assert!(amplitudes.iter().all(|size| size.is_finite() && *size >= 0.0), "{oscillation:?}");
    assert!(rate.is_finite() && (0.0..=1.0).contains(&trust), "{oscillation:?}");
    oscillation
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Compares what `make` makes for a rate (rad/s) and a sense with its `promise`.
fn judge<E: Estimator>(promise: &Promise, make: impl Fn(f64, Sense) -> E) {
    for known in RECORDS.iter() {
        finds(promise, known, &mut make(known.rate, known.sense));
    }
    for known in [&RECORDS[0], &RECORDS[3], &RECORDS[5]] {
        bridges(promise, known, &mut make(known.rate, known.sense));
    }
    resumes(&RECORDS[2], &make);
    trusts_no_noise(make(TAU / PERIOD, CCW));
    survives(&make(TAU / PERIOD, CCW).state().clone(), &mut make(TAU / PERIOD, CCW));
}

/// Phases and rate from the promised time on.
fn finds<E: Estimator>(promise: &Promise, known: &Known, estimator: &mut E) {
    let from = promise.settled * TAU / known.rate;
    let (mut errors, mut rates) = ([Vec::new(), Vec::new()], Vec::new());
    for read in &known.record {
        let estimate = checked_estimate(estimator, read);
        if read.time >= from {
            let error = known.errors(&estimate, read.time);
            errors.iter_mut().zip(error).for_each(|(errors, error)| errors.push(error));
            rates.push(estimate.rate / known.rate - 1.0);
            assert!(estimate.trust > TRUSTED, "{}: {}", known.name, estimate.trust);
        }
    }
    let [phase, rate] = promise.on(known);
    let found = errors.map(|errors| rms(&errors).to_degrees());
    assert!(found.iter().all(|error| *error < phase), "{}: {found:?}°", known.name);
    assert!(rms(&rates) < rate, "{}: rate off by {}", known.name, rms(&rates));
}

/// Half a period without numbers, and single ones missing: flagged and bridged.
fn bridges<E: Estimator>(promise: &Promise, known: &Known, estimator: &mut E) {
    let period = TAU / known.rate;
    let [begin, length, again] = DROPOUT.map(|periods| periods * period);
    let mut errors = [Vec::new(), Vec::new()];
    for (step, read) in known.record.iter().enumerate() {
        let mut read = *read;
        let silent = (begin..begin + length).contains(&read.time);
        match step % 97 {
            _ if silent => read.flap_moments.iter_mut().for_each(|moment| *moment = f64::NAN),
            13 => read.flap_moments[1] = f64::NAN,
            57 => read.azimuth = f64::INFINITY,
            _ => {}
        }
        let estimate = checked_estimate(estimator, &read);
        if silent {
            assert!(estimate.held, "{}: not held at {}", known.name, read.time);
        }
        if read.time >= again {
            let error = known.errors(&estimate, read.time);
            errors.iter_mut().zip(error).for_each(|(errors, error)| errors.push(error));
        }
    }
    // What is left of a second start, beside the noise.
    let bound = 1.5 * promise.on(known)[0];
    let found = errors.map(|errors| rms(&errors).to_degrees());
    assert!(found.iter().all(|error| *error < bound), "{}: {found:?}° after", known.name);
}

/// A state that was written down goes on with the same bits, and so does the first one.
fn resumes<E: Estimator>(known: &Known, make: &impl Fn(f64, Sense) -> E) {
    let new = || make(known.rate, known.sense);
    let (mut whole, mut resumed) = (new(), new());
    let blank = whole.state().clone();
    let (early, late) = known.record.split_at(400);
    let first: Vec<Oscillation> = early.iter().map(|read| whole.update(read).into()).collect();
    let bytes = postcard::to_stdvec(whole.state()).expect("plain data");
    resumed.restore(postcard::from_bytes(&bytes).expect("what was written"));
    for read in &late[..400] {
        let one: Oscillation = whole.update(read).into();
        assert_eq!(one, resumed.update(read).into());
    }
    assert!(whole.state() == resumed.state());
    resumed.restore(blank);
    for (read, first) in early.iter().zip(first) {
        assert_eq!(resumed.update(read).into(), first);
    }
}

/// Without an oscillation there is no confidence.
fn trusts_no_noise<E: Estimator>(mut estimator: E) {
    let mut model = model(&definition(), CCW, &HelixOptions::default());
    let (mut world, mut dice, mut trust) = (World::new(CCW, 1.0), Dice(9), Vec::new());
    world.amplitudes = [0.0; 2];
    for step in 0..(6.0 * PERIOD / INTERVAL) as usize {
        let estimate = checked_estimate(&mut estimator, &world.read(step, &mut model, &mut dice));
        if step as f64 * INTERVAL > 3.0 * PERIOD {
            trust.push(estimate.trust);
        }
    }
    let mean = trust.iter().sum::<f64>() / trust.len() as f64;
    assert!(mean < TRUSTED, "{mean}");
}

/// Whatever instruments show, every number stays one, and good readings bring the rate back into its range.
fn survives<E: Estimator>(blank: &E::State, estimator: &mut E) {
    let mut runner = TestRunner::new(ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(24)
    });
    let odd = prop::collection::vec((0..8_usize, any::<f64>()), 30);
    let estimator = std::cell::RefCell::new(estimator);
    let outcome = runner.run(&odd, |odd| {
        let mut estimator = estimator.borrow_mut();
        estimator.restore(blank.clone());
        for ((what, value), read) in odd.into_iter().zip(&RECORDS[4].record) {
            let mut read = *read;
            match what {
                0..=2 => read.flap_moments[what] = value,
                3 => read.azimuth = value,
                4 => read.rotor_speed = value,
                5 => read.pitch[1] = value,
                6 => read.time = value,
                _ => read.interval = value,
            }
            checked_estimate(&mut **estimator, &read);
        }
        Ok(())
    });
    outcome.expect("numbers");
}

fn filter(options: HelixOptions, factor: f64) -> impl Fn(f64, Sense) -> HelixEstimator {
    let definition = definition();
    move |rate, sense| {
        let setting = estimation::helix::HelixSettings { rate: factor * rate, ..setting(sense) };
        HelixEstimator::new(&definition, &setting, options).expect("a sound setting")
    }
}

fn phase_locked(kind: GeneratorKind) -> impl Fn(f64, Sense) -> TwoAxisLoop {
    move |_, sense| {
        let rates = [0.6, 1.2].map(|factor| factor * TAU / PERIOD);
        let signal = PhaseLockedSettings { generator: kind, ..PhaseLockedSettings::between(rates) };
        let settings = TwoAxisSettings { signal, sense, leader: Leader::Both };
        TwoAxisLoop::new(&settings, INTERVAL).expect("a sound loop")
    }
}

#[test]
fn the_filter_in_its_robust_form() {
    let promise = Promise { settled: 3.0, phase: [2.0, 0.5], rate: [1e-12; 2] };
    judge(&promise, filter(HelixOptions::default(), 1.0));
}

#[test]
fn the_filter_in_its_published_form_on_the_same_rotor() {
    let options =
        HelixOptions { rotor: HelixOptions::default().rotor, ..HelixOptions::published() };
    let promise = Promise { settled: 3.0, phase: [4.0, 0.5], rate: [1e-12; 2] };
    judge(&promise, filter(options, 1.0));
}

#[test]
fn the_filter_that_estimates_the_rate() {
    let options = HelixOptions { rate: Some(1e-10), ..HelixOptions::default() };
    let promise = Promise { settled: 6.0, phase: [4.0, 2.0], rate: [0.01, 0.005] };
    judge(&promise, filter(options, 0.98));
}

#[test]
fn the_loops_with_the_mixed_generator() {
    let promise = Promise { settled: 6.0, phase: [4.0, 2.0], rate: [0.02, 0.005] };
    judge(&promise, phase_locked(GeneratorKind::Mixed));
}

#[test]
fn the_loops_with_the_extended_generator() {
    let kind = GeneratorKind::extended(SQRT_2, 1.0).expect("a damping with a dc gain");
    let promise = Promise { settled: 6.0, phase: [4.0, 2.0], rate: [0.02, 0.005] };
    judge(&promise, phase_locked(kind));
}
