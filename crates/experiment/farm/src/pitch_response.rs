//! A turbine alone in a steady wind that pitches a helix: the record on which a phase estimator is
//! calibrated, and which tells how pitch acts on the loads.

mod joining;
mod prescribed;

pub use joining::{OwnPitch, own_pitch, own_pitch_cost};
pub use prescribed::{
    INDIVIDUAL_PITCH_STROUHAL, individual_pitch_offset, individual_pitch_offset_cost,
};

use crate::assemble::{self, AssemblyError, TurbineModel};
use crate::case::{Case, Control, Sense};
use crate::farm::Recorder;
use crate::plan::Plan;
use crate::self_check::Tunnel;
use crate::solvers::{Alone, SolverError};
use crate::{Farm, FarmError, Machine, Progress};
use basis::mbc::to_fixed_frame;
use basis::{Commands, Truth, Vector3};
use control::meandering::{Answer, Decoupling};
use control::{Excitation, Helix, excitation_rate};
use estimation::EstimationError;
use std::f64::consts::TAU;
use std::sync::Arc;
use thiserror::Error;
use turbine::{Turbine, TurbineSettings};

/// Wind of the record over the case's (–): about what is left in a wake.
const WAKE_SPEED: f64 = 0.75;
/// Excitation periods counted where no filter has to settle (–): moments answer as soon as the near wake has
/// settled, some periods after the pitch began, so that waiting longer would tell nothing more and cost a
/// third of the identification.
const COUNTED: f64 = 2.0;
/// Amplitude of the helices that tell how pitch acts on the loads (rad): a degree.
pub const IDENTIFICATION_AMPLITUDE: f64 = std::f64::consts::PI / 180.0;

/// Why no calibration could be made.
#[derive(Debug, Error)]
pub enum CalibrationError {
    /// The receiver of its progress stopped it.
    #[error("the calibration was interrupted")]
    BrokenOff,
    /// The turbine cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The flow cannot be set up.
    #[error("the flow of the calibration cannot be set up")]
    Solver(#[from] SolverError),
    /// Flow or turbine did not stay finite.
    #[error("the calibration diverged")]
    Flow(#[from] FarmError),
    /// The record tells nothing.
    #[error("the phase estimator cannot be calibrated")]
    Estimation(#[from] EstimationError),
}

/// What an identification costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IdentificationCost {
    /// Steps, those of all its trials together (–).
    pub n_steps: u64,
    /// Cell updates or what takes as long, steps where the case's wind is prescribed (–): what wall time goes
    /// with.
    pub work: f64,
}

/// Cost of [`decoupling`].
pub fn decoupling_cost(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    strouhal: [f64; 2],
) -> IdentificationCost {
    let rate = excitation_rate(middle(strouhal), case.wind.speed, plan.diameter);
    let wind_speed = WAKE_SPEED * case.wind.speed;
    Course::new(wind_speed, plan, model, rate, COUNTED).cost(case, plan, model, 2)
}

/// The middle of a range of Strouhal numbers (–).
fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Steps of one trial: until the near wake has settled and the pitch, which fades in over a period, is whole;
/// and after it.
#[derive(Clone, Copy)]
struct Course {
    n_settling: u64,
    n_counted: u64,
}

impl Course {
    /// In a wind of `wind_speed` (m/s), with `n_periods` (–) of a pitch of `rate` (rad/s) after the settling.
    fn new(wind_speed: f64, plan: &Plan, model: &TurbineModel, rate: f64, n_periods: f64) -> Self {
        let tunnel = Tunnel::for_identification(plan);
        let diameter = model.definition.rotor_diameter();
        let settling = (tunnel.settling * diameter / wind_speed).max(TAU / rate);
        Self {
            n_settling: (settling / plan.interval).ceil() as u64,
            n_counted: (n_periods * TAU / rate / plan.interval).ceil() as u64 + 1,
        }
    }

    fn n_steps(self) -> u64 {
        self.n_settling + self.n_counted
    }

    /// Of `n_trials` of them.
    fn cost(
        self,
        case: &Case,
        plan: &Plan,
        model: &TurbineModel,
        n_trials: u64,
    ) -> IdentificationCost {
        let tunnel = Tunnel::for_identification(plan);
        let diameter = model.definition.rotor_diameter();
        let updates = (case.flow.solver.updates_alone)(&tunnel, diameter);
        let n_steps = n_trials * self.n_steps();
        IdentificationCost { n_steps, work: updates * n_steps as f64 }
    }
}

/// How pitch acts on tilt and yaw moment of turbine number `index` of `case` in the middle of the range
/// `strouhal` (–).
///
/// The turbine stands alone in a steady wind of three quarters of the case's, on the grid of `plan` or in
/// prescribed wind as the case has it, with perfect instruments, and pitches a helix of
/// [`IDENTIFICATION_AMPLITUDE`], first counter-clockwise, then clockwise; what either takes off the moments
/// is given by [`Decoupling::from_senses`]; `progress` receives the share done.
///
/// # Errors
/// [`CalibrationError`].
pub fn decoupling(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    strouhal: [f64; 2],
    progress: Progress,
) -> Result<Decoupling, CalibrationError> {
    let rate = excitation_rate(middle(strouhal), case.wind.speed, plan.diameter);
    let wind_speed = WAKE_SPEED * case.wind.speed;
    let [counter_clockwise, clockwise] =
        answers(case, plan, model, index, wind_speed, rate, progress)?;
    Ok(Decoupling::from_senses(rate, counter_clockwise, clockwise))
}

/// What a counter-clockwise and a clockwise helix of [`IDENTIFICATION_AMPLITUDE`] at `rate` (rad/s) take off
/// the moments of turbine number `index` of `case`, alone in a steady wind of `wind_speed` (m/s); `progress`
/// receives the share done.
///
/// # Errors
/// [`CalibrationError`].
pub fn answers(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    wind_speed: f64,
    rate: f64,
    progress: Progress,
) -> Result<[Answer; 2], CalibrationError> {
    let mut answer = |sense, done: f64| {
        let pitch = Pitching {
            wind_speed,
            rate,
            sense,
            amplitude: IDENTIFICATION_AMPLITUDE,
            azimuth_offset: 0.0,
            periods: COUNTED,
        };
        let mut report = |share: f64| progress(done + 0.5 * share);
        let record = pitching(case, plan, model, index, &pitch, &mut report)?;
        let n_counted = (COUNTED * TAU / rate / plan.interval).round() as usize;
        let counted = &record[record.len().saturating_sub(n_counted)..];
        Ok::<_, CalibrationError>(answer_to(counted, sense, rate))
    };
    Ok([answer(Sense::CounterClockwise, 0.0)?, answer(Sense::Clockwise, 0.5)?])
}

/// What a helix of [`IDENTIFICATION_AMPLITUDE`] at `rate` (rad/s) takes off the moments in `record`, whole
/// periods of it in a steady wind: both axes correlated with their command and with the same a quarter period
/// earlier.
fn answer_to(record: &[Truth], sense: Sense, rate: f64) -> Answer {
    let moments = |of: &Truth| to_fixed_frame(of.azimuth, &of.flap_moments);
    let n = record.len().max(1) as f64;
    let mean = record
        .iter()
        .map(moments)
        .fold([0.0; 2], |[tilt, yaw], moments| [tilt + moments.tilt / n, yaw + moments.yaw / n]);
    let (mut with, mut earlier) = (0.0, 0.0);
    for measurements in record {
        let moments = moments(measurements);
        let angle = rate * measurements.time;
        let lost = [mean[0] - moments.tilt, mean[1] - moments.yaw];
        for (lost, angle) in lost.into_iter().zip([angle, angle + sense.yaw_lead()]) {
            let (sine, cosine) = angle.sin_cos();
            with += lost * sine / n;
            earlier += lost * cosine / n;
        }
    }
    Answer { gain: with.hypot(earlier) / IDENTIFICATION_AMPLITUDE, lead: earlier.atan2(with) }
}

/// What a turbine does while it is recorded.
struct Pitching {
    /// Steady wind that it stands in (m/s).
    wind_speed: f64,
    /// Rate of the helix (rad/s).
    rate: f64,
    sense: Sense,
    /// Amplitude of the helix (rad).
    amplitude: f64,
    /// Azimuth offset of its inverse multi-blade transformation (rad).
    azimuth_offset: f64,
    /// Excitation periods recorded (–).
    periods: f64,
}

/// What a turbine of `model` measures, alone in a steady wind as turbine number `index` of `case` but facing
/// it, while it pitches as `pitch` has it, after the near wake has settled.
fn pitching(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    index: usize,
    pitch: &Pitching,
    progress: Progress,
) -> Result<Vec<Truth>, CalibrationError> {
    let diameter = model.definition.rotor_diameter();
    let rate = pitch.rate;
    let mut alone = case.clone();
    alone.wind.speed = pitch.wind_speed;
    // Diameters of a case are its plan's.
    let strouhal = rate * plan.diameter / (TAU * alone.wind.speed);
    let mut helix =
        Helix::new(pitch.sense, pitch.amplitude, strouhal, alone.wind.speed, plan.diameter);
    helix.azimuth_offset = pitch.azimuth_offset;
    // The rotor alone, facing the wind: no tower stands in its wind.
    let settings = assemble::turbine_settings(&alone, plan, model, index, None);
    let settings = TurbineSettings { yaw: 0.0, ..settings };
    let foot = Vector3::new(0.0, 0.0, -model.definition.rotor.hub_height);
    let turbine = Turbine::new(Arc::clone(&model.definition), foot, settings)
        .map_err(AssemblyError::from)?
        .without_bodies();
    let turbine = assemble::in_air_of(alone.flow.solver, turbine);
    let baseline = assemble::controller(&Control::baseline(), model, &alone, plan)?;
    let controller = helix.on_top_of(baseline);
    let tunnel = Tunnel::for_identification(plan);
    let air = (alone.flow.solver.begin_alone)(&Alone {
        tunnel,
        wind: &alone.wind,
        diameter,
        flow: &alone.flow,
    })?;
    let mut farm = Farm::new(vec![Machine::new(turbine, controller)], air, plan.interval, 1)
        .map_err(AssemblyError::from)?;
    let course = Course::new(pitch.wind_speed, plan, model, rate, pitch.periods);
    let n_steps = course.n_steps();
    let room = course.n_counted as usize;
    let mut record = Record { truths: Vec::with_capacity(room), on: false };
    for step in 0..n_steps {
        record.on = step >= course.n_settling;
        farm.advance(&mut record)?;
        if progress((step + 1) as f64 / n_steps as f64).is_break() {
            return Err(CalibrationError::BrokenOff);
        }
    }
    Ok(record.truths)
}

/// Keeps what was measured.
struct Record {
    truths: Vec<Truth>,
    on: bool,
}

impl Recorder for Record {
    fn record(&mut self, _: usize, truth: &Truth, _: &Commands) {
        if self.on {
            self.truths.push(*truth);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::FixedFrame;
    use basis::mbc::to_blades;

    /// Measurements of a rotor whose moments lose `gain` (N m/rad) of a helix, `lead` (rad) ahead of it,
    /// beside constants and an oscillation at three times the rotor's frequency.
    fn record(sense: Sense, rate: f64, gain: f64, lead: f64) -> Vec<Truth> {
        let (interval, rotor_speed) = (0.2, 0.61);
        let n = (COUNTED * TAU / rate / interval).round() as usize;
        (1000..1000 + n)
            .map(|step| {
                let time = interval * step as f64;
                let azimuth = rotor_speed * time;
                let angle = rate * time + lead;
                let third = 4e5 * (3.0 * azimuth).sin();
                let moments = FixedFrame {
                    average: 3e7,
                    tilt: 2e6 + third - gain * IDENTIFICATION_AMPLITUDE * angle.sin(),
                    yaw: -1e6 + third
                        - gain * IDENTIFICATION_AMPLITUDE * (angle + sense.yaw_lead()).sin(),
                };
                Truth {
                    time,
                    interval,
                    azimuth,
                    rotor_speed,
                    generator_speed: rotor_speed,
                    flap_moments: to_blades(azimuth, moments, 3),
                    ..Truth::at_rest(3)
                }
            })
            .collect()
    }

    #[test]
    fn a_helix_of_either_sense_tells_gain_and_lead() {
        let rate = TAU / 100.0;
        for sense in [Sense::CounterClockwise, Sense::Clockwise] {
            for lead in [-2.5, -0.7, 0.0, 0.6] {
                let found = answer_to(&record(sense, rate, 1.6e8, lead), sense, rate);
                assert!((found.gain / 1.6e8 - 1.0).abs() < 5e-3, "{sense}: {found:?}");
                assert!((found.lead - lead).abs() < 5e-3, "{sense} {lead}: {found:?}");
            }
        }
    }
}
