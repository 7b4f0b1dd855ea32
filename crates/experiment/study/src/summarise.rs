//! From the series of a run to its summary.

mod warnings;

use crate::StudyError;
use crate::columns::{Analysed, Columns, add_to, names_of};
use crate::loads;
use crate::meandering;
use crate::prepare::Setup;
use crate::probes::response_of;
use crate::tips::Outrun;
use analysis::AnalysisError;
use analysis::pitch::{Motion, delivered};
use analysis::statistics::{BLOCK_LENGTH, statistic};
use basis::Sense;
use basis::records::{
    Conditions, ControlSummary, Cost, DeliveredPitch, Load, PitchExcitation, SCHEMA_VERSION,
    Statistic, Summary, TurbineSummary, Warning, WarningKind,
};
use farm::assemble::controller;
use farm::case::{Control, Run, Shear};

/// Channel of the wind that meets the first turbine.
const WIND: &str = "wind.u_m_s";

/// The run `run` in numbers, its gains left out, from its `columns`.
///
/// `clipped_shares` (–) holds, for each turbine that is there, the share of control instants at which a pitch limit
/// held a command back.
pub(crate) fn summarise(
    setup: &Setup,
    run: &Run,
    columns: &mut Columns,
    clipped_shares: &[f64],
    cost: Cost,
) -> Result<Summary, StudyError> {
    let expected = parts(setup, run, columns.names());
    columns.expect(expected);
    let before = |message: &String| Warning {
        kind: WarningKind::Setup,
        turbine: None,
        message: message.clone(),
    };
    let mut warnings: Vec<Warning> = setup.warnings.iter().map(before).collect();
    let mut turbines = Vec::new();
    let mut array = Vec::new();
    for (index, &clipped_share) in run.present().zip(clipped_shares) {
        let turbine = Turbine::new(setup, run, index, clipped_share);
        turbines.push(turbine.summarise(columns, &mut array, &mut warnings)?);
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

/// A turbine in a run.
struct Turbine<'a> {
    setup: &'a Setup,
    run: &'a Run,
    /// Its place in the case.
    index: usize,
    name: &'a str,
    n_blades: usize,
    control: &'a Control,
    /// Share of control instants at which a pitch limit held a command back (–).
    clipped_share: f64,
}

impl<'a> Turbine<'a> {
    fn new(setup: &'a Setup, run: &'a Run, index: usize, clipped_share: f64) -> Self {
        Self {
            setup,
            run,
            index,
            name: &setup.case.turbines[index].name,
            n_blades: setup.models[index].definition.n_blades,
            control: &run.control[index],
            clipped_share,
        }
    }

    /// Its numbers; on return `array` holds its power too (W), and `warnings` what a reader of its numbers must know.
    fn summarise(
        &self,
        columns: &mut Columns,
        array: &mut Vec<f64>,
        warnings: &mut Vec<Warning>,
    ) -> Result<TurbineSummary, StudyError> {
        let Self { setup, index, name, n_blades, control, .. } = *self;

        let analysed = columns.of(&operation(name))?;
        let power_channel = format!("{name}.power_w");
        let power = analysed.statistic(&power_channel)?;
        let thrust = analysed.statistic(&format!("{name}.thrust_n"))?;
        let rotor_speed = analysed.statistic(&format!("{name}.rotor_speed_rad_s"))?;
        let outrun = outrun(&analysed, index, setup)?;
        add_to(array, analysed.column(&power_channel)?);

        let analysed = columns.of(&pitching(name, n_blades))?;
        let pitch = collective_pitch(&analysed, name, n_blades)?;
        let delivered_pitch = self.delivered_pitch(&analysed)?;
        warnings.extend(self.warning_of_clipping(delivered_pitch));

        let analysed = columns.of(&beliefs(name, n_blades, control))?;
        warnings.extend(self.warning_of_fading(&analysed)?);
        let meandering = meandering::followed(&analysed, name, n_blades, control)?;
        warnings.extend(self.warning_of_no_lock(meandering));
        let outran = |outrun: Outrun| outrun.warning(&self.run.name, name);
        warnings.extend(outrun.map(|found| self.warning(WarningKind::TipSpeed, outran(found))));

        Ok(TurbineSummary {
            name: name.to_owned(),
            model: setup.case.turbines[index].model.clone(),
            control: self.control_summary()?,
            power,
            thrust,
            rotor_speed,
            pitch,
            delivered_pitch,
            power_gain: None,
            pitch_response: response_of(control),
            individual_pitch_offset: setup.models[index].individual_pitch_offset(),
            meandering,
            loads: moments(name, columns)?,
            pitch_duty: loads::pitch_duty(name, &columns.of(&loads::duty_channels(name))?)?,
        })
    }

    /// What ran on it.
    fn control_summary(&self) -> Result<ControlSummary, StudyError> {
        let Self { setup, index, .. } = *self;
        let runs = controller(self.control, &setup.models[index], &setup.case, &setup.plan)?;
        let kind = match self.control {
            Control::Absent => "absent",
            Control::Baseline => "baseline",
            Control::Helix(_) => "helix",
            Control::Pulse(_) => "pulse",
            Control::PhaseSync(_) => "phase-sync",
            Control::Meandering(_) => "meandering",
        };
        let excitation = Excited::of(self.control).map(|set| PitchExcitation {
            sense: set.sense,
            amplitude_deg: set.amplitude.to_degrees(),
            strouhal: set.strouhal,
            phase_offset_deg: set.phase_offset.map(f64::to_degrees),
            start: set.start,
            stop: set.stop,
        });
        Ok(ControlSummary { excitation, ..ControlSummary::plain(kind, &runs.describe()) })
    }

    /// Its excitation as its blades delivered it; none without one, or in too short a record.
    fn delivered_pitch(&self, analysed: &Analysed) -> Result<Option<DeliveredPitch>, StudyError> {
        let Some(set) = Excited::of(self.control) else { return Ok(None) };
        // The excitation fades in over one period, and out from its stop on; only what lies between is measured.
        let period = self.setup.plan.diameter / (set.strouhal * self.setup.case.wind.speed);
        let row = |time: f64| (time / analysed.interval).ceil() as usize;
        let skip = row(set.start + period).saturating_sub(analysed.first);
        let end = set.stop.map_or(usize::MAX, |stop| row(stop).saturating_sub(analysed.first));
        let cut = |channel: &str| -> Result<_, StudyError> {
            let column = analysed.column(&format!("{}.{channel}", self.name))?;
            Ok(column.get(skip..end.min(column.len())).unwrap_or_default())
        };
        let azimuth = cut("azimuth_rad")?;
        let mut pitch = Vec::with_capacity(self.n_blades);
        for blade in 1..=self.n_blades {
            pitch.push(cut(&format!("pitch_{blade}_rad"))?);
        }
        let motion = if set.sense.is_some() { Motion::Cyclic } else { Motion::Collective };
        let (interval, amplitude) = (analysed.interval, set.amplitude);
        match delivered(motion, azimuth, &pitch, interval, amplitude, self.clipped_share) {
            Ok(delivered) => Ok(Some(delivered)),
            Err(AnalysisError::TooShort { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }
}

/// Periodic pitch of constant amplitude that a turbine was set to add.
struct Excited {
    /// Sense of a helix; none of a pulse.
    sense: Option<Sense>,
    /// Amplitude (rad).
    amplitude: f64,
    /// Strouhal number (–).
    strouhal: f64,
    /// Lead over the wind of a helix that it joins (rad).
    phase_offset: Option<f64>,
    /// When it fades in and out (s).
    start: f64,
    stop: Option<f64>,
}

impl Excited {
    /// What `control` adds; the amplitude of meandering control is no constant.
    fn of(control: &Control) -> Option<Self> {
        let excited = match control {
            Control::Helix(helix) => Self {
                sense: Some(helix.sense),
                amplitude: helix.amplitude,
                strouhal: helix.strouhal,
                phase_offset: None,
                start: helix.start,
                stop: helix.stop,
            },
            Control::Pulse(pulse) => Self {
                sense: None,
                amplitude: pulse.amplitude,
                strouhal: pulse.strouhal,
                phase_offset: None,
                start: pulse.start,
                stop: pulse.stop,
            },
            Control::PhaseSync(sync) => Self {
                sense: Some(sync.sense),
                amplitude: sync.amplitude,
                strouhal: sync.strouhal,
                phase_offset: Some(sync.offset),
                start: sync.start,
                stop: None,
            },
            Control::Meandering(_) | Control::Baseline | Control::Absent => return None,
        };
        (excited.amplitude != 0.0).then_some(excited)
    }
}

/// Loads of the moments that are kept of `turbine`, by channel.
fn moments(turbine: &str, columns: &mut Columns) -> Result<Vec<Load>, StudyError> {
    let mut found = Vec::new();
    for moment in loads::moments(columns.names(), turbine) {
        found.extend(loads::loads(&moment, &columns.of(&moment.part())?)?);
    }
    found.sort_by(|a, b| a.channel.cmp(&b.channel));
    Ok(found)
}

/// Channels that [`summarise`] asks for together, in its order; the columns of the run are called `names`.
fn parts(setup: &Setup, run: &Run, names: &[String]) -> Vec<Vec<String>> {
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
    match control {
        Control::PhaseSync(_) => names_of(turbine, &["sync_share"]),
        Control::Meandering(_) => meandering::channels(turbine, n_blades),
        Control::Absent | Control::Baseline | Control::Helix(_) | Control::Pulse(_) => Vec::new(),
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
    let realised = analysed.statistic(WIND)?;
    let case = &setup.case;
    let (shear_exponent, roughness_length) = match case.wind.shear {
        Shear::PowerLaw { exponent } => (Some(exponent), None),
        Shear::LogLaw { roughness_length } => (None, Some(roughness_length)),
    };
    Ok(Conditions {
        target_wind_speed: case.wind.speed,
        target_turbulence_intensity: case.wind.turbulence_intensity,
        realised_wind_speed: realised.mean,
        realised_turbulence_intensity: realised.standard_deviation / realised.mean,
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
