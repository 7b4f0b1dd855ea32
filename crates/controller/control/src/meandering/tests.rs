//! Control of loads that answer to pitch at once or late, turned or not, against the target.

use super::*;
use basis::mbc::to_fixed_frame;
use basis::{PerBlade, Sense};
use estimation::phase_locked::{Leader, PhaseLockedSettings as Signal};
use std::collections::VecDeque;
use std::f64::consts::FRAC_PI_3;

const INTERVAL: f64 = 0.2;
const RATE: f64 = 0.08;
const ROTOR_SPEED: f64 = 0.7;
const GAIN: f64 = 2.5e8;
/// Amplitudes and offsets of the disturbance's tilt and yaw (N m).
const AMPLITUDES: [f64; 2] = [7e6, 1.5e7];
const OFFSETS: [f64; 2] = [-1e6, 2e6];

/// A rotor whose loads follow pitch late and turned by an angle.
struct Rotor {
    sense: Sense,
    azimuth_offset: f64,
    /// Tilt and yaw pitch of the steps before, oldest first.
    pitch: VecDeque<FixedFrame>,
}

impl Rotor {
    fn new(sense: Sense, n_late: usize, azimuth_offset: f64) -> Self {
        Self { sense, azimuth_offset, pitch: vec![FixedFrame::default(); n_late + 1].into() }
    }

    fn moments(&self, time: f64) -> FixedFrame {
        let phase = RATE * time;
        let (sine, cosine) = self.azimuth_offset.sin_cos();
        let pitch = self.pitch[0];
        let [tilt, yaw] =
            [pitch.tilt * cosine - pitch.yaw * sine, pitch.tilt * sine + pitch.yaw * cosine];
        FixedFrame {
            average: 5e7,
            tilt: OFFSETS[0] + AMPLITUDES[0] * phase.sin() - GAIN * tilt,
            yaw: OFFSETS[1] + AMPLITUDES[1] * (phase + self.sense.yaw_lead()).sin() - GAIN * yaw,
        }
    }

    fn measurements(&self, step: usize) -> Measurements<'static> {
        let time = INTERVAL * step as f64;
        let azimuth = wrap_to_turn(ROTOR_SPEED * time);
        Measurements {
            time,
            interval: INTERVAL,
            azimuth,
            rotor_speed: ROTOR_SPEED,
            generator_speed: ROTOR_SPEED,
            flap_moments: to_blades(azimuth, self.moments(time), 3),
            ..Measurements::at_rest(3)
        }
    }

    /// One step under `control`; gives the commands of the blades (rad).
    fn step(&mut self, step: usize, control: &mut Meandering) -> PerBlade<f64> {
        let measurements = self.measurements(step);
        let mut pitch = PerBlade::splat(3, 0.1);
        control.add_to(&mut pitch, &measurements);
        self.pitch.pop_front();
        self.pitch.push_back(to_fixed_frame(measurements.azimuth, &pitch));
        pitch
    }
}

fn settings(sense: Sense, factor: f64) -> MeanderingControlSettings {
    let signal = Signal::between([0.05, 0.13]);
    MeanderingControlSettings {
        follower: TwoAxisSettings { signal, sense, leader: Leader::Both },
        followed: Followed::Load,
        factor,
        reference: Reference::Given { tilt: AMPLITUDES[0], yaw: AMPLITUDES[1] },
        decoupling: Decoupling { azimuth_offset: 0.0, delay: 0.0, gain: GAIN },
        bandwidth: 0.01,
        proportional: 0.1,
        maximum_amplitude: 0.1,
        maximum_offset: 0.0,
        needs_lock: true,
        start: 400.0,
    }
}

/// Amplitudes over the baseline's (–) and offsets (N m) that are left after 3000 s.
fn settled(rotor: &mut Rotor, settings: MeanderingControlSettings) -> ([f64; 2], [f64; 2]) {
    let mut control = Meandering::new(settings, INTERVAL).unwrap();
    for step in 0..15_000 {
        rotor.step(step, &mut control);
    }
    let estimate = control.estimate();
    assert!(estimate.locked);
    let [tilt, yaw] = control.loads(&estimate);
    ([tilt.amplitude / AMPLITUDES[0], yaw.amplitude / AMPLITUDES[1]], [tilt.offset, yaw.offset])
}

#[test]
fn the_target_factor_is_reached_on_both_axes() {
    for sense in [Sense::Clockwise, Sense::CounterClockwise] {
        for factor in [1.25, 0.75, 0.35, 2.0] {
            let mut rotor = Rotor::new(sense, 1, 0.0);
            let (reached, offsets) = settled(&mut rotor, settings(sense, factor));
            for (reached, (offset, expected)) in
                reached.into_iter().zip(offsets.into_iter().zip(OFFSETS))
            {
                assert!((reached / factor - 1.0).abs() < 0.005, "{sense} {factor}: {reached}");
                assert!((offset - expected).abs() < 2e4, "{offset}");
            }
        }
    }
}

#[test]
fn amplitudes_that_are_learned_or_observed_do_as_well() {
    for reference in [Reference::Learned { duration: 300.0 }, Reference::Observed] {
        let sense = Sense::Clockwise;
        for factor in [1.25, 0.5] {
            let mut given = settings(sense, factor);
            given.reference = reference;
            given.start = 900.0;
            let (reached, _) = settled(&mut Rotor::new(sense, 1, 0.0), given);
            for reached in reached {
                assert!((reached / factor - 1.0).abs() < 0.02, "{reference:?} {factor}: {reached}");
            }
        }
    }
}

/// The wake's own part is followed into full attenuation, with a gain that is a quarter off.
#[test]
fn a_load_can_be_taken_away_whole_when_the_wake_is_followed() {
    for sense in [Sense::Clockwise, Sense::CounterClockwise] {
        for factor in [0.0, 0.1, 0.35, 2.0] {
            let mut given = settings(sense, factor);
            given.followed = Followed::Wake;
            given.decoupling.gain *= 0.8;
            given.reference = Reference::Given { tilt: AMPLITUDES[0], yaw: AMPLITUDES[1] };
            let (reached, _) = settled(&mut Rotor::new(sense, 1, 0.0), given);
            for reached in reached {
                assert!((reached - factor).abs() < 0.02, "{sense} {factor}: {reached}");
            }
        }
    }
}

/// A loop held to rates above the load's own never locks.
#[test]
fn without_a_lock_it_waits_or_pitches_as_set() {
    for needs_lock in [true, false] {
        let mut given = settings(Sense::Clockwise, 2.0);
        given.needs_lock = needs_lock;
        given.follower.signal = Signal::between([0.2, 0.4]);
        let mut rotor = Rotor::new(Sense::Clockwise, 1, 0.0);
        let mut control = Meandering::new(given, INTERVAL).unwrap();
        let mut pitched: f64 = 0.0;
        for step in 0..15_000 {
            rotor.step(step, &mut control);
            pitched = pitched.max(control.commands().tilt.abs());
            assert!(pitched == 0.0 || INTERVAL * step as f64 >= given.start, "before the start");
            assert!(!needs_lock || !control.estimate().locked);
        }
        assert_eq!(pitched > 0.0, !needs_lock, "{pitched}");
    }
}

#[test]
fn offsets_are_removed_where_set() {
    let sense = Sense::CounterClockwise;
    let mut given = settings(sense, 0.75);
    given.maximum_offset = 0.05;
    let (reached, offsets) = settled(&mut Rotor::new(sense, 1, 0.0), given);
    assert!(reached.iter().all(|reached| (reached / 0.75 - 1.0).abs() < 0.005));
    assert!(offsets.iter().all(|offset| offset.abs() < 1e4), "{offsets:?}");
}

/// What a helix of small amplitude does to the tilt moment of `rotor`, by correlation over whole periods.
fn answer(sense: Sense, n_late: usize, azimuth_offset: f64) -> Answer {
    let mut rotor = Rotor::new(sense, n_late, azimuth_offset);
    let rate = std::f64::consts::TAU / 400.0 / INTERVAL;
    let amplitude = 0.01;
    let (mut sine_sum, mut cosine_sum) = (0.0, 0.0);
    for step in 0..1200 {
        // Only what pitch changes: the disturbance at time zero is a constant.
        let change = rotor.moments(0.0).tilt - OFFSETS[0];
        let angle = rate * INTERVAL * f64::from(step);
        if step >= 800 {
            sine_sum -= change * angle.sin() / 200.0;
            cosine_sum -= change * angle.cos() / 200.0;
        }
        rotor.pitch.pop_front();
        rotor.pitch.push_back(FixedFrame {
            average: 0.0,
            tilt: amplitude * angle.sin(),
            yaw: amplitude * (angle + sense.yaw_lead()).sin(),
        });
    }
    Answer { gain: sine_sum.hypot(cosine_sum) / amplitude, lead: cosine_sum.atan2(sine_sum) }
}

#[test]
fn two_helices_tell_azimuth_offset_delay_and_gain() {
    let (n_late, turned) = (9, FRAC_PI_3);
    let rate = std::f64::consts::TAU / 400.0 / INTERVAL;
    let [ccw, cw] =
        [Sense::CounterClockwise, Sense::Clockwise].map(|sense| answer(sense, n_late, turned));
    let decoupling = Decoupling::from_senses(rate, ccw, cw);
    assert!((decoupling.azimuth_offset - turned).abs() < 1e-9, "{decoupling:?}");
    // The pitch is applied from the step after on.
    assert!((decoupling.delay - INTERVAL * (n_late + 1) as f64).abs() < 1e-6, "{decoupling:?}");
    assert!((decoupling.gain / GAIN - 1.0).abs() < 1e-9);
    for sense in [Sense::Clockwise, Sense::CounterClockwise] {
        let mut given = settings(sense, 0.5);
        given.decoupling = decoupling;
        let (reached, _) = settled(&mut Rotor::new(sense, n_late, turned), given);
        assert!(reached.iter().all(|reached| (reached / 0.5 - 1.0).abs() < 0.01), "{reached:?}");
    }
}

#[test]
fn control_begins_without_a_step_and_stays_within_its_bounds() {
    let sense = Sense::Clockwise;
    let mut given = settings(sense, 3.0);
    given.maximum_amplitude = 0.02;
    given.proportional = 0.5;
    let mut control = Meandering::new(given, INTERVAL).unwrap();
    let mut rotor = Rotor::new(sense, 1, 0.0);
    let mut before = FixedFrame::default();
    for step in 0..10_000 {
        let pitch = rotor.step(step, &mut control);
        let commands = control.commands();
        if INTERVAL * step as f64 <= given.start - INTERVAL {
            assert!(pitch.iter().all(|pitch| *pitch == 0.1));
        }
        // The steepest that a sine of the largest amplitude can be, and a little for growing.
        let steepest = 1.2 * 0.02 * RATE * INTERVAL;
        assert!((commands.tilt - before.tilt).abs() < steepest);
        assert!((commands.yaw - before.yaw).abs() < steepest);
        assert!(commands.tilt.abs() < 0.020_01 && commands.yaw.abs() < 0.020_01);
        before = commands;
    }
    // The bound is let go of at once when the target falls: the integral has not wound up.
    control.settings.factor = 1.0;
    for step in 10_000..10_000 + (8.0 / given.bandwidth / INTERVAL) as usize {
        rotor.step(step, &mut control);
    }
    let reached = control.estimate().tilt.amplitude / AMPLITUDES[0];
    assert!((reached - 1.0).abs() < 0.03, "{reached}");
}

#[test]
fn bad_readings_are_bridged() {
    let sense = Sense::CounterClockwise;
    let mut control = Meandering::new(settings(sense, 0.75), INTERVAL).unwrap();
    let mut rotor = Rotor::new(sense, 1, 0.0);
    let mut before = 0.1;
    for step in 0..15_000 {
        let mut measurements = rotor.measurements(step);
        match step % 500 {
            3 => measurements.azimuth = f64::NAN,
            77 => measurements.flap_moments[1] = f64::NAN,
            200 => measurements.rotor_speed = f64::INFINITY,
            _ => {}
        }
        let azimuth = rotor.measurements(step).azimuth;
        let mut pitch = PerBlade::splat(3, 0.1);
        control.add_to(&mut pitch, &measurements);
        assert_eq!(control.estimate().held, [3, 77].contains(&(step % 500)));
        assert!((pitch[0] - before).abs() < 0.01);
        before = pitch[0];
        rotor.pitch.pop_front();
        rotor.pitch.push_back(to_fixed_frame(azimuth, &pitch));
    }
    let reached = control.estimate().yaw.amplitude / AMPLITUDES[1];
    assert!((reached / 0.75 - 1.0).abs() < 0.01, "{reached}");
}

#[test]
fn control_survives_being_written_and_read() {
    let sense = Sense::Clockwise;
    let mut control = Meandering::new(settings(sense, 1.25), INTERVAL).unwrap();
    let mut rotor = Rotor::new(sense, 1, 0.0);
    for step in 0..4000 {
        rotor.step(step, &mut control);
    }
    let bytes = postcard::to_stdvec(&control).unwrap();
    let resumed: Meandering = postcard::from_bytes(&bytes).unwrap();
    assert_eq!(control, resumed);
}

#[test]
fn what_cannot_be_built_says_why() {
    let build = |change: fn(&mut MeanderingControlSettings)| {
        let mut settings = settings(Sense::Clockwise, 1.25);
        change(&mut settings);
        Meandering::new(settings, INTERVAL).unwrap_err().to_string()
    };
    assert!(build(|s| s.factor = -1.0).contains("zero or more"));
    assert!(build(|s| s.decoupling.gain = 0.0).contains("positive"));
    assert!(build(|s| s.start = f64::NAN).contains("start"));
    assert!(build(|s| s.reference = Reference::Learned { duration: 0.0 }).contains("learning"));
    assert!(build(|s| s.follower.signal.follower.rates = [0.0, 0.1]).contains("above zero"));
    let unstable = build(|s| (s.bandwidth, s.decoupling.delay) = (0.5, 4.0));
    assert!(unstable.starts_with("the amplitude loop is unstable at 0.0500 rad/s: a pole at +"));
    assert!(
        unstable.contains("with an integral gain of 0.5 1/s; it is stable up to 0.2"),
        "{unstable}"
    );
}

/// Gains that nothing is pitched by are no matter.
#[test]
fn a_loop_that_monitors_may_have_any_gain() {
    let mut given = settings(Sense::Clockwise, 1.25);
    (given.bandwidth, given.decoupling.delay, given.maximum_amplitude) = (0.5, 4.0, 0.0);
    assert!(Meandering::new(given, INTERVAL).is_ok());
}

#[test]
fn monitoring_leaves_every_bit_of_the_pitch() {
    let sense = Sense::Clockwise;
    let mut given = settings(sense, 1.5);
    given.maximum_amplitude = 0.0;
    given.start = 0.0;
    let mut control = Meandering::new(given, INTERVAL).unwrap();
    let rotor = Rotor::new(sense, 1, 0.0);
    for step in 0..5000 {
        let measurements = rotor.measurements(step);
        let mut pitch = PerBlade::splat(3, -0.0);
        control.add_to(&mut pitch, &measurements);
        assert!(pitch.iter().all(|pitch| pitch.to_bits() == (-0.0_f64).to_bits()));
    }
    assert!(control.estimate().locked);
    assert_eq!(control.authority(), 0.0);
    assert_eq!(control.describe(), "baseline, monitoring meandering");
}

#[test]
fn an_excitation_goes_on_from_its_state_with_the_same_bits() {
    let sense = Sense::CounterClockwise;
    let new = || Meandering::new(settings(sense, 0.5), INTERVAL).unwrap();
    let pitched = |excitation: &mut Meandering, step: usize| {
        let mut pitch = PerBlade::splat(3, 0.1);
        excitation.add_to(&mut pitch, &Rotor::new(sense, 1, 0.0).measurements(step));
        pitch
    };
    let mut excitation = new();
    for step in 0..3000 {
        pitched(&mut excitation, step);
    }
    let mut resumed = new();
    resumed.restore(&excitation.save()).unwrap();
    for step in 3000..3500 {
        let pitch = pitched(&mut excitation, step);
        assert_eq!(pitch, pitched(&mut resumed, step));
        assert!(step < 3010 || pitch != PerBlade::splat(3, 0.1));
    }
}
