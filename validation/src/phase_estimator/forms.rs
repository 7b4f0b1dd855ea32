//! Four forms on the same records: published, published with the azimuth offset that is identified for the
//! turbine, linear, robust (and robust calibrated, as a study runs it).

use super::rig::{self, Errors, Instruments, SETTLED};
use super::wind::{HelixWind, Swing, turbulent};
use super::{Machine, OWN, PERIOD, ROTOR_SPEED, SHEAR, SPEED, robust, setting, tell, trial};
use analysis::statistics::independent;
use basis::mbc::to_fixed_frame;
use basis::{FixedFrame, Measurements, Sense};
use control::meandering::{Answer, Decoupling};
use estimation::helix::{HelixEstimate, HelixOptions, LinearEstimator, OperatingPoint};
use estimation::{EstimationError, Estimator, HelixEstimator};
use std::f64::consts::TAU;

/// Seeds of the turbulence; their spread is the interval.
const SEEDS: [u64; 4] = [1, 2, 3, 4];
const INTENSITY: f64 = 0.06;
/// Amplitude of the helices that tell the azimuth offset (rad): a degree.
const SMALL: f64 = std::f64::consts::PI / 180.0;
/// Excitation periods of which the answer to them is taken (–).
const COUNTED: f64 = 3.0;
const NAMES: [&str; 5] =
    ["published", "published with its identified offset", "linear", "robust", "robust, calibrated"];

/// The estimators of one trial, in the order of [`NAMES`].
struct Forms {
    filters: [HelixEstimator; 4],
    linear: LinearEstimator,
}

impl Forms {
    fn new(machine: &Machine, sense: Sense, offset: f64) -> Result<Self, EstimationError> {
        let made = |options| machine.estimator(&machine.definition, sense, options);
        let pitch = machine.constants.fine_pitch;
        let point = OperatingPoint { wind: SPEED, rotor_speed: ROTOR_SPEED, pitch };
        Ok(Self {
            filters: [
                made(HelixOptions::published())?,
                made(HelixOptions::published().with_azimuth_offset(offset))?,
                made(robust())?,
                machine.calibrated(&machine.definition, sense)?,
            ],
            linear: LinearEstimator::new(&machine.definition, &setting(sense), point, robust())?,
        })
    }

    fn update(&mut self, read: &Measurements) -> [HelixEstimate; 5] {
        let [published, with_offset, robust, calibrated] = &mut self.filters;
        [
            published.update(read),
            with_offset.update(read),
            self.linear.update(read),
            robust.update(read),
            calibrated.update(read),
        ]
    }
}

/// One table: errors of each form in each condition, means of four winds with their 95 % intervals.
pub(super) fn forms(machine: &Machine) -> Result<(), EstimationError> {
    let offset = identified_offset(machine);
    tell(
        "azimuth offset identified for the published form, deg",
        &format!("{:.1}", offset.to_degrees()),
    );
    let (ccw, cw) = (Sense::CounterClockwise, Sense::Clockwise);
    for (sense, own) in [(ccw, 0.0), (ccw, OWN), (cw, 0.0), (cw, OWN)] {
        let mut errors = [const { Vec::new() }; 5];
        for seed in SEEDS {
            let mean = turbulent(SPEED, SHEAR, INTENSITY, machine.hub(), seed);
            let wind = machine.wind(Swing::Gradient(super::AMPLITUDE), sense, mean);
            let found = judged(machine, &mut Forms::new(machine, sense, offset)?, wind, own);
            for (errors, found) in errors.iter_mut().zip(found) {
                errors.push(found);
            }
        }
        for (name, errors) in NAMES.iter().zip(&errors) {
            let what = format!(
                "{sense}, turbulence {:.0} %, own pitch {:.0}°, four winds, {name}: tilt / yaw, rms error; bias, deg",
                100.0 * INTENSITY,
                own.to_degrees()
            );
            let axis = |of: fn(&Errors, usize) -> f64, axis: usize| {
                told(&errors.iter().map(|errors| of(errors, axis)).collect::<Vec<_>>())
            };
            let [tilt, yaw] = [0, 1].map(|place| axis(|errors, axis| errors.rms[axis], place));
            let biases = [0, 1].map(|place| axis(|errors, axis| errors.mean[axis], place));
            let figures = format!("{tilt} / {yaw}; {} / {}", biases[0], biases[1]);
            tell(&what, &figures);
        }
    }
    Ok(())
}

/// Errors of each of `forms` on a turbine that pitches by `own` (rad) in `wind`.
fn judged(machine: &Machine, forms: &mut Forms, wind: HelixWind, own: f64) -> [Errors; 5] {
    let truth = wind.truth();
    let trial = trial(wind, own, Instruments::default(), 1200.0);
    let mut errors = [Errors::default(); 5];
    rig::drive(&machine.definition, &machine.constants, &trial, |read| {
        for (errors, estimate) in errors.iter_mut().zip(forms.update(read)) {
            if read.time > SETTLED {
                errors.add(&estimate, truth);
            }
        }
    });
    errors.map(Errors::finish)
}

/// Mean of `values`, one from each wind, ± half of its 95 % interval by Student's t: what other winds of the
/// same kind would change.
fn told(values: &[f64]) -> String {
    match independent(values) {
        Ok(found) => {
            let half = found.half_width_95.map_or(String::new(), |half| format!(" ± {half:.1}"));
            format!("{:.1}{half}", found.mean)
        }
        Err(error) => error.to_string(),
    }
}

/// The azimuth offset (rad) with which tilt pitch of the turbine answers in the tilt moment alone, as it is
/// identified before a study: a small helix of either sense in a steady wind.
fn identified_offset(machine: &Machine) -> f64 {
    let rate = TAU / PERIOD;
    let [counter_clockwise, clockwise] =
        [Sense::CounterClockwise, Sense::Clockwise].map(|sense| answer(machine, sense, rate));
    Decoupling::from_senses(rate, counter_clockwise, clockwise).azimuth_offset
}

/// What a small helix of `sense` takes off the moments.
fn answer(machine: &Machine, sense: Sense, rate: f64) -> Answer {
    let calm = machine.wind(
        Swing::Gradient(0.0),
        sense,
        turbulent(SPEED, SHEAR, 0.0, machine.hub(), SEEDS[0]),
    );
    let (phase, duration) = (calm.phase, SETTLED + COUNTED * PERIOD);
    let mut trial = trial(calm, SMALL, Instruments::default(), duration);
    trial.own.1 = 0.0;
    let mut record: Vec<(f64, FixedFrame)> = Vec::new();
    rig::drive(&machine.definition, &machine.constants, &trial, |read| {
        if read.time > SETTLED {
            record.push((read.time, to_fixed_frame(read.azimuth, &read.flap_moments)));
        }
    });
    let n = record.len().max(1) as f64;
    let mean = |of: fn(&FixedFrame) -> f64| record.iter().map(|(_, m)| of(m)).sum::<f64>() / n;
    let [tilt, yaw] = [mean(|moment| moment.tilt), mean(|moment| moment.yaw)];
    let (mut with, mut earlier) = (0.0, 0.0);
    for (time, moment) in &record {
        let angle = rate * time + phase;
        let lost = [(tilt - moment.tilt, angle), (yaw - moment.yaw, angle + sense.yaw_lead())];
        for (lost, angle) in lost {
            with += lost * angle.sin() / n;
            earlier += lost * angle.cos() / n;
        }
    }
    Answer { gain: with.hypot(earlier) / SMALL, lead: earlier.atan2(with) }
}
