//! Moments at the blade roots of a turbine that pitches a helix, beside those of the estimator's models:
//! figure 4 of van Vondelen et al. (2025).

use crate::PostprocessingError;
use crate::error::{InRecords, case_of};
use crate::phase::query::{folder_of, rotor};
use crate::phase::{column, tells};
use analysis::phase::uniform_interval;
use basis::channels::{AZIMUTH, BLD_PITCH, BladeChannel, ROOT_MYC, ROT_SPEED, TIME};
use basis::mbc::{to_blades, to_fixed_frame};
use basis::records::Series;
use basis::{FixedFrame, PerBlade};
use control::phase_sync::{PhaseEstimator, azimuth_offset_of};
use control::{ControlError, excitation_rate};
use estimation::helix::{HelixOptions, HelixSettings, MeasurementModel, Wake};
use farm::assemble::AssemblyError;
use farm::case::Case;
use formats::records::{self, RunFolder};
use report::{Along, TrackFigure, TrackLine, TrackRow};
use std::f64::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;
use turbine::Definition;

/// Turns of the rotor that the figure shows, at the end of the record (–).
const SHOWN_TURNS: f64 = 8.0;
/// Steps of the search for the wind (–), and its ends (m/s).
const N_STEPS: usize = 16;
const WINDS: [f64; 2] = [3.0, 25.0];
/// Meganewton metres of a newton metre.
const MEGA: f64 = 1e-6;

/// A question to the records of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MomentsQuestion {
    /// Folder of the run.
    pub run: PathBuf,
    /// Turbine that pitches a helix; the first that does when absent.
    pub turbine: Option<String>,
    /// Azimuth offset of the pitch in the models (rad); one that was identified before a run of the same
    /// study when absent.
    pub azimuth_offset: Option<f64>,
    /// First time that counts (s); the end of the spin-up when absent.
    pub from: Option<f64>,
}

/// Fixed-frame moments of one model, or the measured ones, at the helix's frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentsLine {
    /// Name of the model.
    pub name: &'static str,
    /// Uniform wind (m/s) in which its mean moment is the measured one; absent for the measured moments.
    pub wind: Option<f64>,
    /// Amplitude of tilt and yaw moment at the helix's frequency (N m).
    pub amplitudes: [f64; 2],
    /// Their phases ahead of the measured ones (rad).
    pub leads: [f64; 2],
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentsAnswer {
    /// Run.
    pub run: String,
    /// Turbine.
    pub turbine: String,
    /// Azimuth offset of the pitch in the models that have one (rad); none where none is known.
    pub azimuth_offset: Option<f64>,
    /// The measured moments, then those of the models.
    pub lines: Vec<MomentsLine>,
    /// Moments over the last turns of the rotor.
    pub figure: TrackFigure,
}

/// What a turbine measured, from the first time that counts on.
struct Record<'a> {
    times: &'a [f64],
    interval: f64,
    azimuth: &'a [f64],
    rotor_speed: &'a [f64],
    pitch: Vec<&'a [f64]>,
    moments: Vec<&'a [f64]>,
}

impl<'a> Record<'a> {
    fn of(
        series: &'a Series,
        name: &str,
        n_blades: usize,
        from: f64,
    ) -> Result<Self, PostprocessingError> {
        let times = column(series, &TIME.name)?;
        let first = times.partition_point(|time| *time < from);
        let channel = |name: &String| Ok(&column(series, name)?[first..]);
        let per_blade = |what: BladeChannel| {
            let names = what.at(name, n_blades);
            names.iter().map(channel).collect::<Result<Vec<_>, PostprocessingError>>()
        };
        Ok(Self {
            interval: uniform_interval(&times[first..])?,
            times: &times[first..],
            azimuth: channel(&AZIMUTH.at(name))?,
            rotor_speed: channel(&ROT_SPEED.at(name))?,
            pitch: per_blade(BLD_PITCH)?,
            moments: per_blade(ROOT_MYC)?,
        })
    }

    fn blades(&self, of: &[&[f64]], row: usize) -> PerBlade<f64> {
        PerBlade::from_fn(of.len(), |blade| of[blade][row])
    }

    fn measured(&self) -> Vec<PerBlade<f64>> {
        (0..self.times.len()).map(|row| self.blades(&self.moments, row)).collect()
    }

    /// Moments of a model with `options` in a uniform `wind` (m/s).
    fn modelled(
        &self,
        rotor: &Rotor,
        options: &HelixOptions,
        wind: f64,
    ) -> Result<Vec<PerBlade<f64>>, PostprocessingError> {
        let model = MeasurementModel::new(&rotor.definition, &rotor.settings, options);
        let mut model = model.map_err(ControlError::from).map_err(AssemblyError::from)?;
        let wind = FixedFrame { average: wind, ..FixedFrame::default() };
        let offset = options.rotor.pitch_azimuth_offset;
        let at = |row: usize| {
            let (azimuth, pitch) = (self.azimuth[row], self.blades(&self.pitch, row));
            let pitch = to_blades(azimuth - offset, to_fixed_frame(azimuth, &pitch), pitch.len());
            model.moments(self.interval, wind, azimuth, self.rotor_speed[row], &pitch)
        };
        Ok((0..self.times.len()).map(at).collect())
    }

    /// The uniform wind (m/s) in which the mean moment of the model with `options` is the measured one.
    fn wind(&self, rotor: &Rotor, options: &HelixOptions) -> Result<f64, PostprocessingError> {
        let mean = |moments: &[PerBlade<f64>]| {
            moments.iter().map(PerBlade::mean).sum::<f64>() / moments.len() as f64
        };
        let target = mean(&self.measured());
        let [mut low, mut high] = WINDS;
        for _ in 0..N_STEPS {
            let middle = 0.5 * (low + high);
            if mean(&self.modelled(rotor, options, middle)?) < target {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(0.5 * (low + high))
    }

    /// Amplitude (N m) and angle (rad) of tilt and yaw of `moments` at `rate` (rad/s), over whole periods.
    fn at_rate(&self, moments: &[PerBlade<f64>], rate: f64) -> [[f64; 2]; 2] {
        let period = TAU / rate / self.interval;
        let n = ((moments.len() as f64 / period).floor() * period).round() as usize;
        let mut sums = [[0.0; 2]; 2];
        let rows = moments.iter().zip(self.azimuth).zip(self.times);
        for ((moments, azimuth), time) in rows.skip(moments.len() - n) {
            let FixedFrame { tilt, yaw, .. } = to_fixed_frame(*azimuth, moments);
            let (sine, cosine) = (rate * time).sin_cos();
            for (sums, moment) in sums.iter_mut().zip([tilt, yaw]) {
                sums[0] += 2.0 * moment * sine / n as f64;
                sums[1] += 2.0 * moment * cosine / n as f64;
            }
        }
        sums.map(|[sine, cosine]| [sine.hypot(cosine), cosine.atan2(sine)])
    }
}

/// The rotor that models stand for.
struct Rotor {
    definition: Arc<Definition>,
    settings: HelixSettings,
}

/// The moments of the turbine that `question` names beside those of the models.
///
/// The wind of a model is uniform and steady, so the comparison is good where the turbine stands in a wind
/// without waves, as the first of a row does. What is compared is what the pitch does.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, lack a channel, have gaps or hold no helix.
pub fn moments(question: &MomentsQuestion) -> Result<MomentsAnswer, PostprocessingError> {
    let folder = folder_of(&question.run);
    let manifest = records::read_manifest(&folder)?;
    let case = case_of(&folder, &manifest)?;
    let control = &case.runs[manifest.run_index].control;
    let pitches = |&index: &usize| {
        let named = question.turbine.as_ref();
        let own = control[index].kind().pitching(&control[index]);
        named.is_none_or(|name| *name == case.turbines[index].name)
            && own.is_some_and(|own| own.sense.is_some() && own.amplitude != 0.0)
    };
    let found = (0..case.turbines.len()).find(pitches);
    let found = found.and_then(|index| Some((index, control[index].helix()?)));
    let (index, (sense, strouhal)) = found.ok_or_else(|| PostprocessingError::NoSignals {
        directory: folder.path().to_owned(),
        lacking: "has that turbine, or any, pitching a helix",
        fix: "name a run in which a turbine pitches a helix, and that turbine with --turbine",
    })?;
    let turbine = &case.turbines[index];
    let summary = records::read_summary(&folder)?;
    let rate = excitation_rate(strouhal, case.wind.speed, summary.conditions.rotor_diameter);
    let series =
        records::read_series(&folder.series_path(), |channel| tells(&turbine.name, channel))?;
    let definition = Arc::new(rotor(&turbine.model, &manifest, &folder)?);
    let from = question.from.unwrap_or(case.time.spin_up);
    let record = Record::of(&series, &turbine.name, definition.n_blades, from)
        .in_records(&folder.series_path())?;
    let offset = question.azimuth_offset.or(identified(&case, &folder, &turbine.model)?);
    let settings = HelixSettings {
        sense,
        rate,
        interval: record.interval,
        air_density: case.wind.air_density,
        n_elements: HelixSettings::N_ELEMENTS,
    };
    let rotor = Rotor { definition, settings };
    let (lines, tracks) = compared(&record, &rotor, offset, &case)?;
    Ok(MomentsAnswer {
        figure: figure(&record, &manifest.run, &turbine.name, &tracks),
        run: manifest.run,
        turbine: turbine.name.clone(),
        azimuth_offset: offset,
        lines,
    })
}

/// The azimuth offset (rad) that was identified for a turbine of `model` before a run of the study of
/// `folder`; none where no record tells.
fn identified(
    case: &Case,
    folder: &RunFolder,
    model: &str,
) -> Result<Option<f64>, PostprocessingError> {
    let Some(study) = folder.path().parent() else { return Ok(None) };
    for run in case.runs.iter().map(|run| RunFolder::new(study, &run.name)) {
        if !run.is_complete() {
            continue;
        }
        for recorded in records::read_summary(&run)?.turbines {
            let same = |turbine: &&farm::case::Placement| turbine.name == recorded.name;
            let is_alike = case.turbines.iter().find(same).is_some_and(|one| one.model == model);
            let offset = recorded.pitch_response.as_ref().and_then(azimuth_offset_of);
            if let (true, Some(offset)) = (is_alike, offset.filter(|offset| *offset != 0.0)) {
                return Ok(Some(offset));
            }
        }
    }
    Ok(None)
}

/// Name and moments over time of each line.
type Tracks = Vec<(&'static str, Vec<PerBlade<f64>>)>;

/// The measured moments of `record`, and those of each model with the azimuth `offset` (rad) where it is
/// known.
fn compared(
    record: &Record,
    rotor: &Rotor,
    offset: Option<f64>,
    case: &Case,
) -> Result<(Vec<MomentsLine>, Tracks), PostprocessingError> {
    let published = HelixOptions::published();
    let mut quasi_steady = published;
    quasi_steady.rotor.wake = Wake::Static;
    let robust = PhaseEstimator::Robust.options(case.flow.solver.resolves_induction);
    let mut models = Vec::new();
    if let Some(offset) = offset {
        models.push(("quasi-steady, azimuth offset", quasi_steady.with_azimuth_offset(offset)));
    }
    models.push(("dynamic, no offset", published));
    if let Some(offset) = offset {
        models.push(("dynamic, azimuth offset", published.with_azimuth_offset(offset)));
    }
    models.push(("robust, blades bend", robust));
    let rate = rotor.settings.rate;
    let measured = record.measured();
    let reference = record.at_rate(&measured, rate);
    let line = |name, wind, moments: &[PerBlade<f64>]| {
        let found = record.at_rate(moments, rate);
        let lead =
            |axis: usize| basis::angle::wrap_to_half_turn(found[axis][1] - reference[axis][1]);
        let amplitudes = found.map(|[amplitude, _]| amplitude);
        MomentsLine { name, wind, amplitudes, leads: [lead(0), lead(1)] }
    };
    let mut lines = vec![line("measured", None, &measured)];
    let mut tracks = vec![("measured", measured)];
    for (name, options) in models {
        let wind = record.wind(rotor, &options)?;
        let moments = record.modelled(rotor, &options, wind)?;
        lines.push(line(name, Some(wind), &moments));
        tracks.push((name, moments));
    }
    Ok((lines, tracks))
}

/// The moments of `tracks` over the last turns of the rotor, a row for each blade.
fn figure(record: &Record, run: &str, turbine: &str, tracks: &Tracks) -> TrackFigure {
    let n = record.rotor_speed.len();
    let mean_speed = record.rotor_speed.iter().sum::<f64>() / n as f64;
    let shown = (SHOWN_TURNS * TAU / mean_speed / record.interval).ceil() as usize;
    let rows = n.saturating_sub(shown)..n;
    let line =
        |colour: usize, (name, moments): &(&str, Vec<PerBlade<f64>>), blade: usize| TrackLine {
            name: (*name).to_owned(),
            colour,
            times: record.times[rows.clone()].to_vec(),
            values: moments[rows.clone()].iter().map(|moments| MEGA * moments[blade]).collect(),
            band: Vec::new(),
        };
    let row = |blade: usize| TrackRow {
        label: format!("blade {} (MN m)", blade + 1),
        is_angle: false,
        lines: tracks.iter().enumerate().map(|(index, track)| line(index, track, blade)).collect(),
    };
    TrackFigure {
        along: Along::TIME,
        name: format!("blade-moments-{run}-{turbine}"),
        title: format!("Moments at the blade roots of {turbine}, measured and modelled: {run}"),
        caption: "Models are those of the phase estimator, in a steady uniform wind in which their mean moment is the measured one; they \
                  are given the measured pitch and rotor speed."
            .to_owned(),
        rows: (0..record.moments.len()).map(row).collect(),
        mark: None,
    }
}
