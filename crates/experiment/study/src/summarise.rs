//! From the series of a run to its summary.

mod sectors;
mod warnings;

use crate::StudyError;
use crate::columns::{Analysed, Columns, add_to};
use crate::loads;
use crate::prepared::Prepared;
use crate::tips::Outrun;
use crate::warnings::SetupWarning;
use analysis::AnalysisError;
use analysis::pitch::{Motion, delivered};
use analysis::statistics::{mean, statistic};
use basis::Channel;
use basis::channels::{AZIMUTH, BLD_PITCH, GEN_PWR, NAC_YAW, ROT_SPEED, RT_AERO_FXH, TIME, WIND_U};
use basis::records::{
    Conditions, ControlSetting, ControlSummary, Cost, DeliveredPitch, Finding, FlowSummary,
    GridSummary, Load, PitchExcitation, Rotor, SCHEMA_VERSION, Statistic, Summary, TurbineSummary,
    Warning, WarningKind,
};
use control::{MissingChannel, Pitching, TurbineRecord};
use farm::assemble::controller;
use farm::case::{Control, Run, Shear, TurbulenceModel};
use farm::plan::GridOfPlan;
use farm::solvers::WindSource;

/// What a turbine leaves beside its series.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Left {
    /// Share of control instants at which a pitch limit held a command back (–).
    pub(crate) clipped_share: f64,
    /// What its controller has to tell, each as what follows "run R: T".
    pub(crate) remarks: Vec<String>,
}

/// The run `run` in numbers, its gains left out, from its `columns`.
///
/// `left` holds what each turbine that is there leaves beside its series.
pub(crate) fn summarise(
    setup: &Prepared,
    run: &Run,
    columns: &mut Columns,
    left: &[Left],
    cost: Cost,
) -> Result<Summary, StudyError> {
    let expected = parts(setup, run, columns.names());
    columns.expect(expected);
    let before = |warning: &SetupWarning| Warning {
        kind: WarningKind::Setup,
        turbine: warning.turbine.clone(),
        message: warning.message.clone(),
    };
    let known = setup.warnings.iter().filter(|warning| warning.concerns(&run.name));
    let mut warnings: Vec<Warning> = known.map(before).collect();
    let mut turbines = Vec::new();
    let mut array = Vec::new();
    for (index, left) in run.present().zip(left) {
        let turbine = Turbine::new(setup, run, index, left);
        turbines.push(turbine.summarise(columns, &mut array, &mut warnings)?);
    }
    let analysed = columns.of(&wind())?;
    Ok(Summary {
        schema_version: SCHEMA_VERSION,
        case: setup.case.name.clone(),
        run: run.name.clone(),
        compare_with: None,
        conditions: conditions(&analysed, setup)?,
        flow: Some(flow(setup)),
        array_power: statistic(&array, analysed.interval, analysed.block)?,
        array_power_gain: None,
        turbines,
        cost,
        warnings,
    })
}

/// A turbine in a run.
struct Turbine<'a> {
    setup: &'a Prepared,
    run: &'a Run,
    /// Its place in the case.
    index: usize,
    name: &'a str,
    n_blades: usize,
    control: &'a Control,
    left: &'a Left,
}

impl<'a> Turbine<'a> {
    fn new(setup: &'a Prepared, run: &'a Run, index: usize, left: &'a Left) -> Self {
        Self {
            setup,
            run,
            index,
            name: &setup.case.turbines[index].name,
            n_blades: setup.models[index].definition.n_blades,
            control: &run.control[index],
            left,
        }
    }

    /// Its numbers; on return `array` holds its power too (W), and `warnings` what a reader of its numbers
    /// must know.
    fn summarise(
        &self,
        columns: &mut Columns,
        array: &mut Vec<f64>,
        warnings: &mut Vec<Warning>,
    ) -> Result<TurbineSummary, StudyError> {
        let Self { setup, index, name, n_blades, control, .. } = *self;

        let analysed = columns.of(&operation(name))?;
        let power_channel = GEN_PWR.at(name);
        let power = analysed.statistic(&power_channel)?;
        let thrust = analysed.statistic(&RT_AERO_FXH.at(name))?;
        let rotor_speed = analysed.statistic(&ROT_SPEED.at(name))?;
        let yaw = mean(analysed.column(&NAC_YAW.at(name))?);
        let outrun = outrun(&analysed, index, setup)?;
        warnings.extend(self.warning_of_overspeed(&analysed)?);
        add_to(array, analysed.column(&power_channel)?);

        let analysed = columns.of(&pitching(name, n_blades))?;
        let pitch = collective_pitch(&analysed, name, n_blades)?;
        let delivered_pitch = self.delivered_pitch(&analysed)?;
        warnings.extend(self.warning_of_clipping(delivered_pitch));

        let analysed = columns.of(&outcome_channels(name, n_blades, control))?;
        let record = OfTurbine { analysed: &analysed, name, n_blades };
        let outcome = control.kind().outcome(control, &record);
        let outcome =
            outcome.map_err(|MissingChannel(channel)| StudyError::MissingChannel { channel })?;
        let message = |words: &String| format!("{}: {name}{words}", self.run.name);
        let of_controller = |words| self.warning(WarningKind::Controller, message(words));
        warnings.extend(outcome.warnings.iter().chain(&self.left.remarks).map(of_controller));
        let outran = |outrun: Outrun| outrun.warning(&self.run.name, name);
        warnings.extend(outrun.map(|found| self.warning(WarningKind::TipSpeed, outran(found))));

        let wind = sectors::of(setup, index)?;
        Ok(TurbineSummary {
            name: name.to_owned(),
            model: setup.case.turbines[index].model.clone(),
            rotor: Some(self.rotor(yaw)),
            control: self.control_summary(outcome.findings)?,
            power,
            thrust,
            rotor_speed,
            pitch,
            yaw_misalignment_deg: wind.as_ref().map(|wind| wind.misalignment_deg(yaw)),
            sectors: wind.map(|wind| wind.sectors).unwrap_or_default(),
            delivered_pitch,
            power_gain: None,
            pitch_response: control.kind().pitch_response(control),
            individual_pitch_offset: setup.models[index].individual_pitch_offset(),
            meandering: outcome.meandering,
            loads: moments(name, columns)?,
            pitch_duty: loads::pitch_duty(name, &columns.of(&loads::duty_channels(name))?)?,
        })
    }

    /// Its rotor in its place, turned by `yaw` (rad) on average.
    fn rotor(&self, yaw: f64) -> Rotor {
        let foot = self.setup.plan.positions[self.index];
        let definition = &self.setup.models[self.index].definition;
        let hub = [foot.x, foot.y, foot.z + definition.rotor.hub_height];
        Rotor { diameter: definition.rotor_diameter(), hub, yaw_deg: yaw.to_degrees() }
    }

    /// What ran on it.
    fn control_summary(&self, findings: Vec<Finding>) -> Result<ControlSummary, StudyError> {
        let Self { setup, index, .. } = *self;
        let runs = controller(self.control, &setup.models[index], &setup.case, &setup.plan)?;
        let excitation = excited(self.control).map(|set| PitchExcitation {
            sense: set.sense,
            amplitude_deg: set.amplitude.to_degrees(),
            strouhal: set.strouhal,
            phase_offset_deg: set.phase_offset.map(f64::to_degrees),
            start: set.start,
            stop: set.stop,
        });
        let plain = ControlSummary::plain(self.control.kind().name(), &runs.describe());
        let settings = Some(ControlSetting::all(self.control.values()));
        Ok(ControlSummary { settings, excitation, findings, ..plain })
    }

    /// Its excitation as its blades delivered it; none without one, or in too short a record.
    fn delivered_pitch(&self, analysed: &Analysed) -> Result<Option<DeliveredPitch>, StudyError> {
        let Some(set) = excited(self.control) else { return Ok(None) };
        // The excitation fades in over one period, and out from its stop on; only what lies between is
        // measured.
        let period = self.setup.plan.diameter / (set.strouhal * self.setup.case.wind.speed);
        let row = |time: f64| (time / analysed.interval).ceil() as usize;
        let skip = row(set.start + period).saturating_sub(analysed.first);
        let end = set.stop.map_or(usize::MAX, |stop| row(stop).saturating_sub(analysed.first));
        let cut = |channel: &Channel| -> Result<_, StudyError> {
            let column = analysed.column(&channel.at(self.name))?;
            Ok(column.get(skip..end.min(column.len())).unwrap_or_default())
        };
        let azimuth = cut(&AZIMUTH)?;
        let mut pitch = Vec::with_capacity(self.n_blades);
        for blade in 1..=self.n_blades {
            pitch.push(cut(&BLD_PITCH.of_blade(blade))?);
        }
        let motion = match set.motion {
            control::Motion::Cyclic => Motion::Cyclic,
            control::Motion::Collective => Motion::Collective,
        };
        let (interval, amplitude) = (analysed.interval, set.amplitude);
        match delivered(motion, azimuth, &pitch, interval, amplitude, self.left.clipped_share) {
            Ok(delivered) => Ok(Some(delivered)),
            Err(AnalysisError::TooShort { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        }
    }
}

/// Periodic pitch of constant amplitude that `control` adds; none of amplitude zero.
fn excited(control: &Control) -> Option<Pitching> {
    control.kind().pitching(control).filter(|set| set.amplitude != 0.0)
}

/// Columns of one turbine, for its controller.
struct OfTurbine<'a> {
    analysed: &'a Analysed<'a>,
    name: &'a str,
    n_blades: usize,
}

impl OfTurbine<'_> {
    fn full_name(&self, channel: &Channel) -> String {
        full_name(self.name, channel)
    }
}

impl TurbineRecord for OfTurbine<'_> {
    fn column(&self, channel: &Channel) -> Result<&[f64], MissingChannel> {
        let name = self.full_name(channel);
        self.analysed.column(&name).map_err(|_| MissingChannel(name))
    }

    fn interval(&self) -> f64 {
        self.analysed.interval
    }

    fn n_blades(&self) -> usize {
        self.n_blades
    }
}

/// Name in the series of the `channel` of `turbine`; time is everybody's.
fn full_name(turbine: &str, channel: &Channel) -> String {
    if *channel == TIME { TIME.name.into_owned() } else { channel.at(turbine) }
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
fn parts(setup: &Prepared, run: &Run, names: &[String]) -> Vec<Vec<String>> {
    let mut parts = Vec::new();
    for index in run.present() {
        let name = &setup.case.turbines[index].name;
        let n_blades = setup.models[index].definition.n_blades;
        parts.push(operation(name));
        parts.push(pitching(name, n_blades));
        parts.push(outcome_channels(name, n_blades, &run.control[index]));
        parts.extend(loads::moments(names, name).iter().map(loads::Moment::part));
        parts.push(loads::duty_channels(name).to_vec());
    }
    parts.push(wind());
    parts
}

/// The wind that meets the first turbine.
fn wind() -> Vec<String> {
    vec![WIND_U.name.into_owned()]
}

/// What tells how `turbine` ran.
fn operation(turbine: &str) -> Vec<String> {
    let channels = [GEN_PWR, RT_AERO_FXH, ROT_SPEED, NAC_YAW].map(|channel| channel.at(turbine));
    channels.into_iter().chain([TIME.name.into_owned()]).collect()
}

/// What tells how the `n_blades` blades of `turbine` pitched.
fn pitching(turbine: &str, n_blades: usize) -> Vec<String> {
    let pitch = BLD_PITCH.at(turbine, n_blades);
    std::iter::once(AZIMUTH.at(turbine)).chain(pitch).collect()
}

/// What the controller of `turbine`, of `n_blades` blades, reads to say what became of it.
fn outcome_channels(turbine: &str, n_blades: usize, control: &Control) -> Vec<String> {
    let channels = control.kind().outcome_channels(control, n_blades);
    channels.iter().map(|channel| full_name(turbine, channel)).collect()
}

fn collective_pitch(
    analysed: &Analysed,
    name: &str,
    n_blades: usize,
) -> Result<Statistic, StudyError> {
    let mut mean = Vec::new();
    for blade in 1..=n_blades {
        let column = analysed.column(&BLD_PITCH.of_blade(blade).at(name))?;
        mean.resize(column.len(), 0.0);
        for (mean, pitch) in mean.iter_mut().zip(column) {
            *mean += pitch / n_blades as f64;
        }
    }
    Ok(statistic(&mean, analysed.interval, analysed.block)?)
}

/// How the tip of the turbine at `index` exceeded the speed of sound of the solver's air in the analysed
/// time; none where it did not, and where that air has no sound.
fn outrun(
    analysed: &Analysed,
    index: usize,
    setup: &Prepared,
) -> Result<Option<Outrun>, StudyError> {
    let plan = &setup.plan;
    let Some(sound_speed) = (setup.case.flow.solver.sound_speed)(plan) else { return Ok(None) };
    let name = &setup.case.turbines[index].name;
    let times = analysed.column(&TIME.name)?;
    let rotor_speeds = analysed.column(&ROT_SPEED.at(name))?;
    let radius = setup.models[index].definition.rotor_radius();
    Ok(Outrun::of(times, rotor_speeds, radius, sound_speed, plan.interval))
}

/// What moves the air of `setup`.
fn flow(setup: &Prepared) -> FlowSummary {
    let solver = setup.case.flow.solver;
    let grids = setup.plan.grids();
    let several = if setup.plan.boxes.is_empty() { &[] } else { grids.as_slice() };
    FlowSummary {
        solver: solver.name.to_owned(),
        has_wakes: solver.has_wakes,
        limits: solver.limits.to_owned(),
        grids: several.iter().map(grid_summary).collect(),
    }
}

fn grid_summary(grid: &GridOfPlan) -> GridSummary {
    let size = grid.n_cells.map(|n| n as f64 * grid.spacing);
    GridSummary { origin: grid.origin, size, spacing: grid.spacing, n_cells: grid.cells() as u64 }
}

fn conditions(analysed: &Analysed, setup: &Prepared) -> Result<Conditions, StudyError> {
    let realised = analysed.statistic(&WIND_U.name)?;
    let case = &setup.case;
    let (shear_exponent, roughness_length) = match case.wind.shear {
        Shear::PowerLaw { exponent } => (Some(exponent), None),
        Shear::LogLaw { roughness_length } => (None, Some(roughness_length)),
    };
    Ok(Conditions {
        target_wind_speed: case.wind.speed,
        direction_deg: case.wind.direction_deg(),
        target_turbulence_intensity: case.wind.turbulence_intensity,
        turbulence_length_scale: turbulence_length_scale(setup),
        realised_wind_speed: realised.mean,
        realised_turbulence_intensity: realised.standard_deviation / realised.mean,
        shear_exponent,
        roughness_length,
        seed: case.wind.seed,
        rotor_diameter: setup.plan.diameter,
        cells_per_diameter: cells_per_diameter(setup),
        interval: setup.plan.interval,
        spin_up: case.time.spin_up,
        duration: case.time.duration,
    })
}

/// Length scale of Mann's tensor (m); none where the turbulence is not Mann's.
fn turbulence_length_scale(setup: &Prepared) -> Option<f64> {
    let (wind, made) = (&setup.case.wind, setup.case.wind_source());
    let is_made = wind.turbulence_intensity > 0.0
        && wind.turbulence_model == TurbulenceModel::Mann
        && !wind.is_brought()
        && matches!(made, WindSource::AtInlet | WindSource::AroundRotors);
    is_made.then(|| farm::wind::length_scale(wind, setup.plan.hub_height))
}

/// Cells per diameter of the first turbine, of those that it stands in (–), as the case says or else as they
/// were laid out; none where there are no cells.
fn cells_per_diameter(setup: &Prepared) -> Option<f64> {
    let plan = &setup.plan;
    let given = setup.case.flow.values.optional_number("cells_per_diameter");
    let halvings = plan.levels.first().map_or(1.0, |level| f64::from(1_u32 << level));
    let around = || given.unwrap_or(plan.diameter / plan.spacing);
    (plan.cells() > 0).then(|| halvings * around())
}

#[cfg(test)]
mod tests;
