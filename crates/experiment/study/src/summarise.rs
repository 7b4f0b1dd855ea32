//! From the series of a run to its summary.

use crate::StudyError;
use crate::loads;
use crate::meandering;
use crate::prepare::Setup;
use crate::probes::response_of;
use crate::tips::Outrun;
use analysis::AnalysisError;
use analysis::pitch::{Motion, delivered};
use analysis::statistics::{BLOCK_LENGTH, statistic};
use basis::records::{
    Conditions, Cost, DeliveredPitch, MeanderingSummary, SCHEMA_VERSION, Series, Statistic,
    Summary, TurbineSummary,
};
use farm::assemble::controller;
use farm::case::{Control, Run, Shear};
use std::collections::BTreeMap;

/// Share of clipped control instants beyond which a reader must know (–).
const CLIPPED_SHARE: f64 = 0.01;
/// Share of the time without a trusted phase beyond which a reader must know (–).
const FADED_SHARE: f64 = 0.02;
/// Share of the asked amplitude that must arrive at the blades (–).
const DELIVERED_SHARE: f64 = 0.95;

/// The series of one run, cut to the analysed time.
pub(crate) struct Analysed<'a> {
    /// All of it.
    pub(crate) series: &'a Series,
    first: usize,
    /// Time between rows (s).
    pub(crate) interval: f64,
}

impl<'a> Analysed<'a> {
    pub(crate) fn new(series: &'a Series, setup: &Setup) -> Self {
        let plan = &setup.plan;
        let first = plan.n_spin_up_steps.div_ceil(plan.row_stride) as usize;
        Self { series, first, interval: plan.row_interval() }
    }

    /// All of a series whose rows lie `interval` (s) apart.
    #[cfg(test)]
    pub(crate) fn whole(series: &'a Series, interval: f64) -> Self {
        Self { series, first: 0, interval }
    }

    /// The analysed part of the channel `name`.
    pub(crate) fn column(&self, name: &str) -> Result<&'a [f64], StudyError> {
        let column = self
            .series
            .column(name)
            .ok_or_else(|| StudyError::MissingChannel { channel: name.to_owned() })?;
        Ok(column.get(self.first..).unwrap_or_default())
    }

    /// Mean and deviation of the channel `name`.
    pub(crate) fn statistic(&self, name: &str) -> Result<Statistic, StudyError> {
        Ok(statistic(self.column(name)?, self.interval, BLOCK_LENGTH)?)
    }

    /// Sum of a channel over all turbines, instant by instant.
    pub(crate) fn sum(&self, names: &[&str], channel: &str) -> Result<Vec<f64>, StudyError> {
        let mut sum = Vec::new();
        for name in names {
            let column = self.column(&format!("{name}.{channel}"))?;
            sum.resize(column.len(), 0.0);
            for (sum, value) in sum.iter_mut().zip(column) {
                *sum += value;
            }
        }
        Ok(sum)
    }
}

/// The run `run` in numbers, its gains left out.
///
/// `clipped_shares` (–) holds, for each turbine that is there, the share of control instants at which a pitch limit
/// held a command back.
pub(crate) fn summarise(
    setup: &Setup,
    run: &Run,
    series: &Series,
    clipped_shares: &[f64],
    cost: Cost,
) -> Result<Summary, StudyError> {
    let analysed = Analysed::new(series, setup);
    let mut warnings = setup.warnings.clone();
    let mut turbines = Vec::new();
    for (machine, index) in run.present().enumerate() {
        let placement = &setup.case.turbines[index];
        let name = &placement.name;
        let control = &run.control[index];
        let runs = controller(control, &setup.models[index], &setup.case, &setup.plan)?;
        let n_blades = setup.models[index].definition.n_blades;
        let delivered_pitch =
            delivered_pitch(&analysed, name, n_blades, control, setup, clipped_shares[machine])?;
        // A phase that follows the wind spreads the line: what is missing of it was not held back.
        let steady = !matches!(control, Control::PhaseSync(_));
        let share = clipped_shares[machine];
        warn_of_clipping(name, &run.name, delivered_pitch, share, steady, &mut warnings);
        warn_of_fading(&analysed, name, control, &run.name, &mut warnings)?;
        let meandering = meandering::followed(&analysed, name, n_blades, control)?;
        warn_of_no_lock(name, control, meandering, &run.name, &mut warnings);
        let found = outrun(&analysed, index, setup)?;
        warnings.extend(found.map(|outrun| outrun.warning(&run.name, name)));
        turbines.push(TurbineSummary {
            name: name.clone(),
            model: placement.model.clone(),
            control: runs.describe(),
            power: analysed.statistic(&format!("{name}.power_w"))?,
            thrust: analysed.statistic(&format!("{name}.thrust_n"))?,
            rotor_speed: analysed.statistic(&format!("{name}.rotor_speed_rad_s"))?,
            pitch: collective_pitch(&analysed, name, n_blades)?,
            delivered_pitch,
            power_gain: None,
            pitch_response: response_of(control),
            meandering,
            load_deviations: loads::deviations(series, name, &analysed)?,
            damage_equivalent_loads: loads::damage_equivalent(series, name, &analysed)?,
            load_changes: BTreeMap::new(),
            pitch_duty: loads::pitch_duty(series, name, &analysed)?,
        });
    }
    let names: Vec<&str> = turbines.iter().map(|turbine| turbine.name.as_str()).collect();
    let array = analysed.sum(&names, "power_w")?;
    Ok(Summary {
        schema_version: SCHEMA_VERSION,
        case: setup.case.name.clone(),
        run: run.name.clone(),
        compare_with: None,
        conditions: conditions(&analysed, setup)?,
        array_power: statistic(&array, analysed.interval, BLOCK_LENGTH)?,
        array_power_gain: None,
        turbines,
        cost,
        warnings,
    })
}

fn collective_pitch(
    analysed: &Analysed,
    name: &str,
    n_blades: usize,
) -> Result<Statistic, StudyError> {
    let mut mean = Vec::new();
    for blade in 1..=n_blades {
        let column = analysed.column(&format!("{name}.pitch_{blade}_rad"))?;
        mean.resize(column.len(), 0.0);
        for (mean, pitch) in mean.iter_mut().zip(column) {
            *mean += pitch / n_blades as f64;
        }
    }
    Ok(statistic(&mean, analysed.interval, BLOCK_LENGTH)?)
}

fn delivered_pitch(
    analysed: &Analysed,
    name: &str,
    n_blades: usize,
    control: &Control,
    setup: &Setup,
    clipped_share: f64,
) -> Result<Option<DeliveredPitch>, StudyError> {
    let (motion, amplitude, strouhal, start, stop) = match control {
        Control::Helix(helix) => {
            (Motion::Cyclic, helix.amplitude, helix.strouhal, helix.start, helix.stop)
        }
        Control::Pulse(pulse) => {
            (Motion::Collective, pulse.amplitude, pulse.strouhal, pulse.start, pulse.stop)
        }
        Control::PhaseSync(sync) => {
            (Motion::Cyclic, sync.amplitude, sync.strouhal, sync.start, None)
        }
        // The amplitude of meandering control is no constant.
        Control::Meandering(_) | Control::Baseline | Control::Absent => return Ok(None),
    };
    if amplitude == 0.0 {
        return Ok(None);
    }
    // The excitation fades in over one period, and out from its stop on; only what lies between is measured.
    let period = setup.plan.diameter / (strouhal * setup.case.wind.speed);
    let row = |time: f64| (time / analysed.interval).ceil() as usize;
    let skip = row(start + period).saturating_sub(analysed.first);
    let end = stop.map_or(usize::MAX, |stop| row(stop).saturating_sub(analysed.first));
    let cut =
        |column: &'_ [f64]| column.get(skip..end.min(column.len())).unwrap_or_default().to_vec();
    let azimuth = cut(analysed.column(&format!("{name}.azimuth_rad"))?);
    let mut pitch = Vec::with_capacity(n_blades);
    for blade in 1..=n_blades {
        pitch.push(cut(analysed.column(&format!("{name}.pitch_{blade}_rad"))?));
    }
    let pitch: Vec<&[f64]> = pitch.iter().map(Vec::as_slice).collect();
    match delivered(motion, &azimuth, &pitch, analysed.interval, amplitude, clipped_share) {
        Ok(delivered) => Ok(Some(delivered)),
        Err(AnalysisError::TooShort { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

fn warn_of_clipping(
    name: &str,
    run: &str,
    pitch: Option<DeliveredPitch>,
    clipped_share: f64,
    steady: bool,
    warnings: &mut Vec<String>,
) {
    let held = 100.0 * clipped_share;
    let Some(pitch) = pitch else {
        if clipped_share > CLIPPED_SHARE {
            warnings.push(format!("{run}: a pitch limit held {name} back {held:.0} % of the time"));
        }
        return;
    };
    let asked = pitch.commanded_amplitude_deg;
    let arrived = pitch.delivered_amplitude_deg;
    let missing = steady && arrived < DELIVERED_SHARE * asked;
    if missing || clipped_share > CLIPPED_SHARE {
        warnings.push(format!(
            "{run}: {name} was asked for {asked:.2}° and delivered {arrived:.2}°; a pitch limit held it back {held:.0} % of the time"
        ));
    }
}

/// Notes where a turbine that shall join a helix could not trust its estimate.
fn warn_of_fading(
    analysed: &Analysed,
    name: &str,
    control: &Control,
    run: &str,
    warnings: &mut Vec<String>,
) -> Result<(), StudyError> {
    let Control::PhaseSync(sync) = control else { return Ok(()) };
    if sync.amplitude == 0.0 {
        return Ok(());
    }
    let share = analysed.column(&format!("{name}.sync_share"))?;
    let faded =
        share.iter().filter(|share| **share < 0.5).count() as f64 / share.len().max(1) as f64;
    if faded > FADED_SHARE {
        warnings.push(format!(
            "{run}: {name} could not trust the phase that it found {:.0} % of the time, and ran baseline meanwhile",
            100.0 * faded
        ));
    }
    Ok(())
}

/// Notes where a turbine that shall act on meandering `found` nothing to lock to.
fn warn_of_no_lock(
    name: &str,
    control: &Control,
    found: Option<MeanderingSummary>,
    run: &str,
    warnings: &mut Vec<String>,
) {
    let Some(found) = found.filter(|found| found.locked_share < 1.0 - FADED_SHARE) else { return };
    if matches!(control, Control::Meandering(asked) if asked.amplitude != 0.0 && asked.fallback) {
        warnings.push(format!(
            "{run}: {name} was locked to the wake's motion {:.0} % of the time, and pitched nothing of its own meanwhile",
            100.0 * found.locked_share
        ));
    }
}

/// How the tip of the turbine at `index` outran the sound on the lattice in the analysed time; none where it did not, and
/// where there is no lattice.
fn outrun(analysed: &Analysed, index: usize, setup: &Setup) -> Result<Option<Outrun>, StudyError> {
    if setup.case.flow.solver.is_prescribed() {
        return Ok(None);
    }
    let name = &setup.case.turbines[index].name;
    let times = analysed.column("time_s")?;
    let rotor_speeds = analysed.column(&format!("{name}.rotor_speed_rad_s"))?;
    let radius = setup.models[index].definition.rotor_radius();
    let plan = &setup.plan;
    Ok(Outrun::of(times, rotor_speeds, radius, plan.spacing, plan.interval))
}

fn conditions(analysed: &Analysed, setup: &Setup) -> Result<Conditions, StudyError> {
    let arrived = analysed.statistic("wind.u_m_s")?;
    let case = &setup.case;
    let (shear_exponent, roughness_length) = match case.wind.shear {
        Shear::PowerLaw { exponent } => (Some(exponent), None),
        Shear::LogLaw { roughness_length } => (None, Some(roughness_length)),
    };
    Ok(Conditions {
        wind_speed: case.wind.speed,
        turbulence_intensity: case.wind.turbulence_intensity,
        arriving_wind_speed: arrived.mean,
        arriving_turbulence_intensity: arrived.standard_deviation / arrived.mean,
        shear_exponent,
        roughness_length,
        seed: case.wind.seed,
        rotor_diameter: setup.plan.diameter,
        cells_per_diameter: (!case.flow.solver.is_prescribed())
            .then_some(case.flow.cells_per_diameter),
        interval: setup.plan.interval,
        spin_up: case.time.spin_up,
        duration: case.time.duration,
    })
}
