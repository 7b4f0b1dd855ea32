//! A turbine alone in a steady wind that pitches a helix: the record on which a phase estimator is calibrated.

use crate::air::Air;
use crate::assemble::{self, AssemblyError, Model};
use crate::case::{Case, Control, Helix, PhaseEstimator, PhaseSync};
use crate::farm::Recorder;
use crate::plan::Plan;
use crate::{Farm, Machine};
use basis::{Commands, Measurements, Vector3};
use control::excitation_rate;
use estimation::EstimationError;
use estimation::helix::{Calibration, calibrate};
use flow::FlowError;
use flow::inflow::{MeanProfile, PrescribedWind};
use flow::lattice::{self, Lattice};
use std::f64::consts::TAU;
use std::sync::Arc;
use thiserror::Error;
use turbine::Turbine;

/// Wind of the record over the case's (–): about what is left in a wake.
const WAKE_SPEED: f64 = 0.75;
/// Inlet to rotor, rotor to outlet, width and height of the tunnel (diameters).
const TUNNEL: [f64; 3] = [3.0, 3.0, 5.0];
/// Time for the near wake to settle (diameters over wind speed).
const SETTLING: f64 = 8.0;
/// Excitation periods for the filter to settle, and counted after them (–).
const PERIODS: [f64; 2] = [2.0, 2.0];

/// Why no calibration could be made.
#[derive(Debug, Error)]
pub enum CalibrationError {
    /// The turbine cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// The air cannot be set up.
    #[error("the air of the calibration cannot be set up")]
    Settings(#[from] lattice::SettingsError),
    /// The air did not stay finite.
    #[error("the air of the calibration diverged")]
    Flow(#[from] FlowError),
    /// The record tells nothing.
    #[error("the phase estimator cannot be calibrated")]
    Estimation(#[from] EstimationError),
}

/// Calibrates the estimator of `sync` on turbine number `index` of `case`: gain and azimuth offset of its own pitch.
///
/// The turbine stands alone in a steady wind of three quarters of the case's, on the grid of `plan` or in prescribed wind
/// as the case has it, and pitches the helix that it shall pitch; `progress` is told the share done.
///
/// # Errors
/// [`CalibrationError`].
pub fn calibration(
    case: &Case,
    plan: &Plan,
    model: &Model,
    index: usize,
    sync: &PhaseSync,
    progress: &mut dyn FnMut(f64),
) -> Result<Calibration, CalibrationError> {
    let diameter = model.definition.rotor_diameter();
    let rate = excitation_rate(sync.strouhal, case.wind.speed, plan.diameter);
    let mut alone = case.clone();
    alone.wind.speed = WAKE_SPEED * case.wind.speed;
    // The same rate in the slower wind, and its diameters are this rotor's.
    let strouhal = rate * plan.diameter / (TAU * alone.wind.speed);
    let helix = Control::Helix(Helix {
        sense: sync.sense,
        amplitude: sync.amplitude,
        strouhal,
        phase: 0.0,
        azimuth_offset: sync.azimuth_offset,
        start: 0.0,
    });
    let settings = assemble::turbine_settings(&alone, plan, model, alone.turbines[index].flexible);
    let foot = Vector3::new(0.0, 0.0, -model.definition.rotor.hub_height);
    let turbine = Turbine::new(Arc::clone(&model.definition), foot, settings)
        .map_err(AssemblyError::from)?
        .without_bodies();
    let controller = assemble::controller(&helix, model, &alone, plan, None)?;
    let air = tunnel(&alone, plan, diameter)?;
    let mut farm = Farm::new(vec![Machine::new(turbine, controller)], air, plan.interval, 1)
        .map_err(AssemblyError::from)?;
    let settling = SETTLING * diameter / alone.wind.speed;
    let period = TAU / rate;
    let n_settling = (settling / plan.interval).ceil() as u64;
    let n_counted = ((PERIODS[0] + PERIODS[1]) * period / plan.interval).ceil() as u64 + 1;
    let mut record = Record { measurements: Vec::with_capacity(n_counted as usize), on: false };
    for step in 0..n_settling + n_counted {
        record.on = step >= n_settling;
        farm.advance(&mut record)?;
        progress((step + 1) as f64 / (n_settling + n_counted) as f64);
    }
    let setting = assemble::estimator_setting(sync, case, plan);
    let options = assemble::estimator_options(PhaseEstimator::Robust, case.flow.solver);
    let settling = PERIODS[0] * period;
    Ok(calibrate(&model.definition, &setting, options, &record.measurements, settling)?)
}

/// Steady wind around the origin.
fn tunnel(case: &Case, plan: &Plan, diameter: f64) -> Result<Air, lattice::SettingsError> {
    let profile = Arc::new(MeanProfile::Uniform { speed: case.wind.speed });
    if case.flow.solver.is_prescribed() {
        return Ok(Air::Prescribed(Box::new(PrescribedWind::everywhere(profile))));
    }
    let [upstream, downstream, width] = TUNNEL;
    let cells = |diameters: f64| (diameters * diameter / plan.spacing).round() as usize;
    let n_across = cells(width);
    let n_cells = [cells(upstream + downstream), n_across, n_across];
    let half_width = 0.5 * n_across as f64 * plan.spacing;
    let origin = Vector3::new(-upstream * diameter, -half_width, -half_width);
    let mut settings =
        lattice::Settings::new(origin, plan.spacing, n_cells, plan.interval, case.wind.speed);
    settings.air_density = case.wind.air_density;
    settings.kinematic_viscosity = case.wind.kinematic_viscosity;
    settings.ground = lattice::Ground::Periodic;
    settings.threads = case.flow.threads;
    Ok(Air::Lattice(Box::new(Lattice::new(settings, profile)?)))
}

/// Keeps what was measured.
struct Record {
    measurements: Vec<Measurements>,
    on: bool,
}

impl Recorder for Record {
    fn record(&mut self, _: usize, measurements: &Measurements, _: &Commands) {
        if self.on {
            self.measurements.push(*measurements);
        }
    }
}
