//! A rotor that joins the helix in its wind, in a closed loop with its estimator's own model.

#[path = "../../../controller/estimation/tests/machine/mod.rs"]
mod machine;

use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use basis::mbc::to_fixed_frame;
use basis::{FixedFrame, Measurements, PerBlade, Sense};
use control::phase_sync::{SyncSettings, TRUST};
use control::{Excitation, PhaseSync};
use estimation::HelixEstimator;
use estimation::helix::HelixOptions;
use machine::{Dice, INTERVAL, PERIOD, ROTOR_SPEED, definition, model, setting};
use std::f64::consts::{PI, TAU};

const AMPLITUDE: f64 = 0.07;
const START: f64 = 3.0 * PERIOD;

/// Wind of a helix of `amplitude` (m/s) and `phase` (rad) at `time` (s).
fn wind(sense: Sense, amplitude: f64, phase: f64, time: f64) -> FixedFrame {
    let angle = TAU / PERIOD * time + phase;
    FixedFrame {
        average: 9.0,
        tilt: amplitude * angle.sin(),
        yaw: amplitude * (angle + sense.yaw_lead()).sin(),
    }
}

fn sync(sense: Sense, offset: f64) -> PhaseSync {
    let settings = SyncSettings {
        sense,
        amplitude: AMPLITUDE,
        rate: TAU / PERIOD,
        offset,
        azimuth_offset: 0.0,
        start: START,
        trust: Some(TRUST),
    };
    let estimator = HelixEstimator::new(&definition(), &setting(sense), HelixOptions::default())
        .expect("a rotor");
    PhaseSync::new(settings, estimator)
}

/// The rotor with its controller in a wind; what was pitched in the fixed frame at each step comes out.
struct Loop {
    sync: PhaseSync,
    sense: Sense,
    model: estimation::helix::MeasurementModel,
    dice: Dice,
    pitch: PerBlade<f64>,
    step: usize,
}

impl Loop {
    fn new(sense: Sense, offset: f64) -> Self {
        Self {
            sync: sync(sense, offset),
            sense,
            model: model(&definition(), sense, &HelixOptions::default()),
            dice: Dice(7),
            pitch: PerBlade::splat(3, 0.0),
            step: 0,
        }
    }

    fn measure(&mut self, wind: FixedFrame) -> Measurements<'static> {
        let time = self.step as f64 * INTERVAL;
        let azimuth = ROTOR_SPEED * time;
        let moments = self.model.moments(INTERVAL, wind, azimuth, ROTOR_SPEED, &self.pitch);
        let scale = 0.05 * moments.mean();
        Measurements {
            time,
            interval: INTERVAL,
            azimuth: wrap_to_turn(azimuth),
            rotor_speed: ROTOR_SPEED,
            generator_speed: ROTOR_SPEED,
            pitch: self.pitch,
            flap_moments: moments.map(|moment| moment + scale * self.dice.normal()),
            ..Measurements::at_rest(3)
        }
    }

    /// Runs for `duration` (s) in a helix of `amplitude` (m/s) and `phase` (rad); gives the steps' tilt and
    /// yaw pitch (rad).
    fn run(&mut self, duration: f64, amplitude: f64, phase: f64) -> Vec<FixedFrame> {
        let n_steps = (duration / INTERVAL) as usize;
        let mut pitches = Vec::with_capacity(n_steps);
        for _ in 0..n_steps {
            let time = self.step as f64 * INTERVAL;
            let measurements = self.measure(wind(self.sense, amplitude, phase, time));
            self.pitch = self.sync.pitch(&measurements);
            pitches.push(to_fixed_frame(measurements.azimuth, &self.pitch));
            self.step += 1;
        }
        pitches
    }
}

#[test]
fn pitch_leads_the_wind_by_the_offset_in_both_senses() {
    for sense in [Sense::CounterClockwise, Sense::Clockwise] {
        for (phase, offset) in [(0.7, 0.0), (2.0, PI), (4.5, 1.5 * PI)] {
            let mut rotor = Loop::new(sense, offset);
            let before = rotor.run(START, 1.0, phase);
            assert!(before.iter().all(|pitch| pitch.tilt == 0.0), "nothing before the start");
            rotor.run(3.0 * PERIOD, 1.0, phase);
            let first = rotor.step;
            let pitches = rotor.run(2.0 * PERIOD, 1.0, phase);
            // Both axes' components at the excitation's rate, against a wave of the wind's phase.
            let (mut tilt, mut yaw) = ([0.0; 2], [0.0; 2]);
            for (index, pitch) in pitches.iter().enumerate() {
                let angle = TAU / PERIOD * (first + index) as f64 * INTERVAL + phase;
                let share = 2.0 / pitches.len() as f64;
                let lead = angle + sense.yaw_lead();
                tilt[0] += share * pitch.tilt * angle.sin();
                tilt[1] += share * pitch.tilt * angle.cos();
                yaw[0] += share * pitch.yaw * lead.sin();
                yaw[1] += share * pitch.yaw * lead.cos();
            }
            for [sine, cosine] in [tilt, yaw] {
                let error = wrap_to_half_turn(cosine.atan2(sine) - offset).to_degrees();
                assert!(error.abs() < 4.0, "{sense}, offset {offset}: {error}° beside it");
                assert!((sine.hypot(cosine) / AMPLITUDE - 1.0).abs() < 0.05);
            }
        }
    }
}

#[test]
fn without_a_helix_it_fades_to_the_baseline_and_comes_back_with_it() {
    let mut rotor = Loop::new(Sense::CounterClockwise, PI);
    rotor.run(START + 3.0 * PERIOD, 1.0, 1.0);
    assert_eq!(rotor.sync.share(), 1.0);
    rotor.run(12.0 * PERIOD, 0.0, 1.0);
    assert_eq!(rotor.sync.share(), 0.0);
    let reading = rotor_reading(&mut rotor);
    assert_eq!(rotor.sync.pitch(&reading)[0], 0.0);
    rotor.run(8.0 * PERIOD, 1.0, 1.0);
    assert!(rotor.sync.share() > 0.9);
}

fn rotor_reading(rotor: &mut Loop) -> Measurements<'static> {
    let reading = rotor.measure(wind(Sense::CounterClockwise, 0.0, 0.0, 0.0));
    rotor.step += 1;
    reading
}

#[test]
fn a_restored_controller_goes_on_with_the_same_bits() {
    let mut one = Loop::new(Sense::CounterClockwise, 0.5);
    one.run(START + PERIOD, 1.0, 1.0);
    let mut other = Loop::new(Sense::CounterClockwise, 0.5);
    other.run(START + PERIOD, 1.0, 1.0);
    let stored = one.sync.save();
    let mut fresh = sync(Sense::CounterClockwise, 0.5);
    fresh.restore(&stored).expect("its own state");
    one.sync = fresh;
    for (a, b) in one.run(PERIOD, 1.0, 1.0).iter().zip(other.run(PERIOD, 1.0, 1.0)) {
        assert_eq!(a.tilt.to_bits(), b.tilt.to_bits());
        assert_eq!(a.yaw.to_bits(), b.yaw.to_bits());
    }
}

#[test]
fn moments_that_are_no_numbers_leave_pitch_that_is_one() {
    let mut rotor = Loop::new(Sense::CounterClockwise, 0.0);
    rotor.run(START + 2.0 * PERIOD, 1.0, 1.0);
    let mut reading = rotor_reading(&mut rotor);
    reading.flap_moments = PerBlade::splat(3, f64::NAN);
    for _ in 0..100 {
        reading.time += INTERVAL;
        assert!(rotor.sync.pitch(&reading).iter().all(|pitch| pitch.is_finite()));
    }
}
