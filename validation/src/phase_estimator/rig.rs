//! An aeroelastic turbine in a known wind, and estimators that run on it.

use super::wind::{HelixWind, degrees, pitch};
use crate::folds::larger;
use basis::{Measurements, PerBlade, Vector3};
use control::{Baseline, Controller};
use estimation::Estimator;
use estimation::helix::HelixEstimate;
use flow::Inflow;
use std::sync::Arc;
use turbine::aero::blade_element::Theory;
use turbine::aero::induction::TwoConstant;
use turbine::{Definition, Induction, Turbine, aero};

/// Control interval (s).
pub(super) const INTERVAL: f64 = 0.1;
/// Density of the air (kg/m³).
pub(super) const AIR_DENSITY: f64 = 1.225;
/// Time at which estimators begin (s): blades and tower have come to rest from their start.
const FIRST_READING: f64 = 20.0;
/// Time at which the rotor's own pitch begins (s).
const OWN_START: f64 = 200.0;
/// Time before errors count (s): three helix periods.
pub(super) const SETTLED: f64 = 280.0;

/// Random numbers that are the same everywhere.
pub(super) struct Noise(pub(super) u64);

impl Noise {
    /// Uniform between 0 and 1.
    pub(super) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    /// Normal with variance one, after Box and Muller.
    pub(super) fn normal(&mut self) -> f64 {
        let (radius, angle) = ((-2.0 * self.uniform().ln()).sqrt(), self.uniform());
        radius * (std::f64::consts::TAU * angle).cos()
    }
}

/// What is done to the readings.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Instruments {
    /// Standard deviation of moments over their mean (–).
    pub(super) noise: f64,
    /// Chance that a blade's moment is not read at an instant (–), half of which show the last value and half
    /// no number.
    pub(super) dropouts: f64,
}

/// Conditions of a trial.
pub(super) struct Trial {
    pub(super) wind: HelixWind,
    pub(super) flexible: bool,
    /// Amplitude (rad) of its own pitch, and how far ahead of the wave it is (rad).
    pub(super) own: (f64, f64),
    pub(super) instruments: Instruments,
    /// Seconds.
    pub(super) duration: f64,
    /// First rotor speed (rad/s).
    pub(super) rotor_speed: f64,
}

/// Errors of one estimator against the truth, after [`SETTLED`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Errors {
    /// Root mean square and mean of tilt's and yaw's phase error (deg).
    pub(super) rms: [f64; 2],
    pub(super) mean: [f64; 2],
    /// Mean of the phase errors squared over the filter's own variance (–).
    pub(super) consistency: f64,
    /// Mean normalised innovation squared (–).
    pub(super) innovation: f64,
    /// Mean trust (–).
    pub(super) trust: f64,
    n: f64,
}

impl Errors {
    pub(super) fn add(&mut self, estimate: &HelixEstimate, truth: [f64; 2]) {
        for (axis, (got, truth)) in [estimate.tilt, estimate.yaw].iter().zip(truth).enumerate() {
            let error = degrees(got.phase - truth);
            self.rms[axis] += error * error;
            self.mean[axis] += error;
            self.consistency += 0.5 * error.to_radians().powi(2) / got.phase_variance;
        }
        self.innovation += estimate.innovation;
        self.trust += estimate.trust.overall();
        self.n += 1.0;
    }

    pub(super) fn finish(mut self) -> Self {
        for axis in 0..2 {
            self.rms[axis] = (self.rms[axis] / self.n).sqrt();
            self.mean[axis] /= self.n;
        }
        self.consistency /= self.n;
        self.innovation /= self.n;
        self.trust /= self.n;
        self
    }

    /// The worse axis' root mean square (deg).
    pub(super) fn worst(&self) -> f64 {
        larger(self.rms[0], self.rms[1])
    }
}

/// Runs the turbine and runs `estimators`; gives the errors of each.
pub(super) fn run<E: Estimator<Estimate = HelixEstimate>>(
    definition: &Arc<Definition>,
    constants: &control::baseline::Constants,
    trial: &Trial,
    estimators: &mut [E],
) -> Vec<Errors> {
    let truth = trial.wind.truth();
    let mut errors = vec![Errors::default(); estimators.len()];
    follow(definition, constants, trial, estimators, |time, index, estimate| {
        if time > SETTLED {
            errors[index].add(estimate, truth);
        }
    });
    errors.into_iter().map(Errors::finish).collect()
}

/// Runs the turbine and runs `estimators`; `seen` receives time (s), place in `estimators` and
/// estimate.
pub(super) fn follow<E: Estimator<Estimate = HelixEstimate>>(
    definition: &Arc<Definition>,
    constants: &control::baseline::Constants,
    trial: &Trial,
    estimators: &mut [E],
    mut seen: impl FnMut(f64, usize, &HelixEstimate),
) {
    drive(definition, constants, trial, |measurements| {
        for (index, estimator) in estimators.iter_mut().enumerate() {
            seen(measurements.time, index, &estimator.update(measurements));
        }
    });
}

/// Runs the turbine with the own pitch that is commanded; `take` receives its measurements once it has come
/// to rest from its start.
pub(super) fn drive(
    definition: &Arc<Definition>,
    constants: &control::baseline::Constants,
    trial: &Trial,
    mut take: impl FnMut(&Measurements<'static>),
) {
    let (amplitude, ahead) = trial.own;
    fly(definition, constants, trial, |reading| {
        take(reading);
        let begun = if reading.time < OWN_START { 0.0 } else { amplitude };
        let n_blades = reading.pitch.len();
        pitch(&trial.wind, reading.time, reading.azimuth, begun, ahead, n_blades)
    });
}

/// Runs the turbine; `excite` receives its measurements once it has come to rest from its start, and gives
/// what is added to each blade's pitch (rad).
pub(super) fn fly(
    definition: &Arc<Definition>,
    constants: &control::baseline::Constants,
    trial: &Trial,
    mut excite: impl FnMut(&Measurements<'static>) -> PerBlade<f64>,
) {
    let settings = turbine::TurbineSettings {
        induction: Induction::ByMomentum(aero::rotor::BemSettings {
            induction: aero::Induction::TwoConstant(TwoConstant::varying()),
            theory: Theory::default(),
            skewed_wake: true,
            dynamic_stall: true,
            tower: None,
        }),
        flexible: trial.flexible,
        air_density: AIR_DENSITY,
        yaw: 0.0,
        rotor_speed: trial.rotor_speed,
        azimuth: 0.0,
        pitch: constants.fine_pitch,
    };
    let mut turbine = Turbine::new(Arc::clone(definition), Vector3::ZERO, settings)
        .expect("the library's own turbines have a structure");
    let mut controller = Baseline::new(constants.clone());
    let mut winds = vec![Vector3::ZERO; turbine.stations().len()];
    let mut noise = Noise(1);
    let mut shown = PerBlade::splat(definition.n_blades, 0.0);
    for step in 0..(trial.duration / INTERVAL) as usize {
        let time = step as f64 * INTERVAL;
        let measurements = turbine.truth(time, INTERVAL).measured();
        let mut commands = controller.update(&measurements);
        if time > FIRST_READING {
            let own = excite(&read(&measurements, trial.instruments, &mut shown, &mut noise));
            commands.pitch.iter_mut().zip(own.iter()).for_each(|(pitch, own)| *pitch += own);
        }
        trial.wind.sample(time, turbine.stations(), &mut winds);
        turbine.advance(INTERVAL, &winds, &commands);
    }
}

/// `measurements` as the instruments show them.
pub(super) fn read(
    measurements: &Measurements<'static>,
    instruments: Instruments,
    shown: &mut PerBlade<f64>,
    noise: &mut Noise,
) -> Measurements<'static> {
    let scale = instruments.noise * measurements.flap_moments.mean().abs();
    let mut read = *measurements;
    for (reading, shown) in read.flap_moments.iter_mut().zip(shown.iter_mut()) {
        if noise.uniform() < instruments.dropouts {
            *reading = if noise.uniform() < 0.5 { f64::NAN } else { *shown };
        } else {
            *reading += scale * noise.normal();
            *shown = *reading;
        }
    }
    read
}
