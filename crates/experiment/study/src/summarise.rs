//! From the series of a run to its summary.

use crate::StudyError;
use crate::columns::{Analysed, Columns, add_to, names_of};
use crate::loads;
use crate::meandering;
use crate::prepared::Prepared;
use crate::tips::Outrun;
use analysis::AnalysisError;
use analysis::pitch::{Motion, delivered};
use analysis::statistics::{BLOCK_LENGTH, statistic};
use basis::records::{
    Conditions, Cost, DeliveredPitch, MeanderingSummary, SCHEMA_VERSION, Statistic, Summary,
    TurbineSummary,
};
use control::Pitching;
use control::meandering::{MEANDERING, MeanderingSettings};
use control::phase_sync::{PHASE_SYNC, PhaseSyncSettings};
use farm::assemble::controller;
use farm::case::{Control, Run, Shear};
use std::collections::BTreeMap;

/// Channel of the wind that arrives.
const WIND: &str = "wind.u_m_s";
/// Share of clipped control instants beyond which a reader must know (–).
const CLIPPED_SHARE: f64 = 0.01;
/// Share of the time without a trusted phase beyond which a reader must know (–).
const FADED_SHARE: f64 = 0.02;
/// Share of the asked amplitude that must arrive at the blades (–).
const DELIVERED_SHARE: f64 = 0.95;

/// The run `run` in numbers, its gains left out, from its `columns`.
///
/// `clipped_shares` (–) holds, for each turbine that is there, the share of control instants at which a pitch limit
/// held a command back.
pub(crate) fn summarise(
    setup: &Prepared,
    run: &Run,
    columns: &mut Columns,
    clipped_shares: &[f64],
    cost: Cost,
) -> Result<Summary, StudyError> {
    let expected = parts(setup, run, columns.names());
    columns.expect(expected);
    let mut warnings = setup.warnings.clone();
    let mut turbines = Vec::new();
    let mut array = Vec::new();
    for (machine, index) in run.present().enumerate() {
        let placement = &setup.case.turbines[index];
        let name = &placement.name;
        let control = &run.control[index];
        let runs = controller(control, &setup.models[index], &setup.case, &setup.plan)?;
        let n_blades = setup.models[index].definition.n_blades;
        let share = clipped_shares[machine];

        let analysed = columns.of(&operation(name))?;
        let power_channel = format!("{name}.power_w");
        let power = analysed.statistic(&power_channel)?;
        let thrust = analysed.statistic(&format!("{name}.thrust_n"))?;
        let rotor_speed = analysed.statistic(&format!("{name}.rotor_speed_rad_s"))?;
        let outrun = outrun(&analysed, index, setup)?;
        add_to(&mut array, analysed.column(&power_channel)?);

        let analysed = columns.of(&pitching(name, n_blades))?;
        let pitch = collective_pitch(&analysed, name, n_blades)?;
        let delivered_pitch = delivered_pitch(&analysed, name, n_blades, control, setup, share)?;
        // A phase that follows the wind spreads the line: what is missing of it was not held back.
        let steady = control.kind().pitching(control).is_none_or(|own| own.is_steady);
        warn_of_clipping(name, &run.name, delivered_pitch, share, steady, &mut warnings);

        let analysed = columns.of(&beliefs(name, n_blades, control))?;
        warn_of_fading(&analysed, name, control, &run.name, &mut warnings)?;
        let meandering = meandering::followed(&analysed, name, n_blades, control)?;
        warn_of_no_lock(name, control, meandering, &run.name, &mut warnings);
        warnings.extend(outrun.map(|outrun| outrun.warning(&run.name, name)));

        let (mut load_deviations, mut damage_equivalent_loads) = (BTreeMap::new(), BTreeMap::new());
        for moment in loads::moments(columns.names(), name) {
            let analysed = columns.of(&moment.part())?;
            load_deviations.extend([loads::deviation(&moment, &analysed)?]);
            damage_equivalent_loads.extend(loads::damage_equivalent(&moment, &analysed)?);
        }
        let pitch_duty = loads::pitch_duty(name, &columns.of(&loads::duty_channels(name))?)?;
        turbines.push(TurbineSummary {
            name: name.clone(),
            model: placement.model.clone(),
            control: runs.describe(),
            power,
            thrust,
            rotor_speed,
            pitch,
            delivered_pitch,
            power_gain: None,
            pitch_response: control.kind().pitch_response(control),
            individual_pitch_offset: setup.models[index].individual_pitch_offset(),
            meandering,
            load_deviations,
            damage_equivalent_loads,
            load_changes: BTreeMap::new(),
            pitch_duty,
        });
    }
    let analysed = columns.of(&[WIND.to_owned()])?;
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

/// Channels that [`summarise`] asks for together, in its order; the columns of the run are called `names`.
fn parts(setup: &Prepared, run: &Run, names: &[String]) -> Vec<Vec<String>> {
    let mut parts = Vec::new();
    for index in run.present() {
        let name = &setup.case.turbines[index].name;
        let n_blades = setup.models[index].definition.n_blades;
        parts.push(operation(name));
        parts.push(pitching(name, n_blades));
        parts.push(beliefs(name, n_blades, &run.control[index]));
        parts.extend(loads::moments(names, name).iter().map(loads::Moment::part));
        parts.push(loads::duty_channels(name).to_vec());
    }
    parts.push(vec![WIND.to_owned()]);
    parts
}

/// What tells how `turbine` ran.
fn operation(turbine: &str) -> Vec<String> {
    let mut channels = names_of(turbine, &["power_w", "thrust_n", "rotor_speed_rad_s"]);
    channels.push("time_s".to_owned());
    channels
}

/// What tells how the `n_blades` blades of `turbine` pitched.
fn pitching(turbine: &str, n_blades: usize) -> Vec<String> {
    let mut channels = names_of(turbine, &["azimuth_rad"]);
    channels.extend((1..=n_blades).map(|blade| format!("{turbine}.pitch_{blade}_rad")));
    channels
}

/// What tells what `turbine`, of `n_blades` blades, believed under `control`; nothing where it seeks nothing.
fn beliefs(turbine: &str, n_blades: usize, control: &Control) -> Vec<String> {
    if control.is(&PHASE_SYNC) {
        names_of(turbine, &["sync_share"])
    } else if control.is(&MEANDERING) {
        meandering::channels(turbine, n_blades)
    } else {
        Vec::new()
    }
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
    setup: &Prepared,
    clipped_share: f64,
) -> Result<Option<DeliveredPitch>, StudyError> {
    let Some(own) = control.kind().pitching(control) else { return Ok(None) };
    let Pitching { amplitude, strouhal, start, stop, .. } = own;
    let motion = match own.motion {
        control::Motion::Cyclic => Motion::Cyclic,
        control::Motion::Collective => Motion::Collective,
    };
    if amplitude == 0.0 {
        return Ok(None);
    }
    // The excitation fades in over one period, and out from its stop on; only what lies between is measured.
    let period = setup.plan.diameter / (strouhal * setup.case.wind.speed);
    let row = |time: f64| (time / analysed.interval).ceil() as usize;
    let skip = row(start + period).saturating_sub(analysed.first);
    let end = stop.map_or(usize::MAX, |stop| row(stop).saturating_sub(analysed.first));
    let cut = |channel: &str| -> Result<_, StudyError> {
        let column = analysed.column(&format!("{name}.{channel}"))?;
        Ok(column.get(skip..end.min(column.len())).unwrap_or_default())
    };
    let azimuth = cut("azimuth_rad")?;
    let mut pitch = Vec::with_capacity(n_blades);
    for blade in 1..=n_blades {
        pitch.push(cut(&format!("pitch_{blade}_rad"))?);
    }
    match delivered(motion, azimuth, &pitch, analysed.interval, amplitude, clipped_share) {
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
    let Some(sync) = PhaseSyncSettings::of(control) else { return Ok(()) };
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
    if MeanderingSettings::of(control).is_some_and(|own| own.amplitude != 0.0 && own.fallback) {
        warnings.push(format!(
            "{run}: {name} was locked to the wake's motion {:.0} % of the time, and pitched nothing of its own meanwhile",
            100.0 * found.locked_share
        ));
    }
}

/// How the tip of the turbine at `index` outran the sound on the lattice in the analysed time; none where it did not, and
/// where there is no lattice.
fn outrun(
    analysed: &Analysed,
    index: usize,
    setup: &Prepared,
) -> Result<Option<Outrun>, StudyError> {
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

fn conditions(analysed: &Analysed, setup: &Prepared) -> Result<Conditions, StudyError> {
    let arrived = analysed.statistic(WIND)?;
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

#[cfg(test)]
mod tests;
