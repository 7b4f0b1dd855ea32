//! How well the phase of a helix is estimated on the turbine that it meets: records in, agreement with the true wind out.

use crate::StudyError;
use crate::prepare::turbine;
use analysis::phase::{
    Agreement, Band, Coherence, GroundTruth, Reference, agreement, coherence, ground_truth,
    uniform_interval,
};
use basis::records::Series;
use basis::{FixedFrame, Measurements, PerBlade};
use control::excitation_rate;
use estimation::HelixEstimator;
use estimation::helix::Setting;
use estimation::helix::tuning::{self, Tuned};
use farm::assemble::{AssemblyError, estimator_options};
use farm::case::{Case, Control, PhaseEstimator};
use formats::case;
use formats::records::{self, Manifest, RunFolder};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use turbine::Definition;

/// Excitation periods in a segment of the cross-spectrum (–).
const SEGMENT_PERIODS: f64 = 4.0;

/// What is asked of the records of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PhaseQuestion {
    /// Folder of the run.
    pub run: PathBuf,
    /// Turbine that a helix meets; the first that seeks one when absent.
    pub turbine: Option<String>,
    /// Folder of a run of the same study without that turbine, whose series holds the true wind at its place; a run
    /// beside this one when absent.
    pub truth: Option<PathBuf>,
    /// Estimator to run over the records; what the run itself believed when absent.
    pub estimator: Option<PhaseEstimator>,
    /// First time that counts (s); the end of the spin-up when absent.
    pub from: Option<f64>,
}

/// One axis of the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseAxis {
    /// Mean amplitude of the estimate (m/s).
    pub amplitude: f64,
    /// Mean amplitude of the truth (m/s).
    pub true_amplitude: f64,
    /// Estimated against true phase.
    pub agreement: Agreement,
    /// Estimated against true wind at the excitation frequency; absent in records shorter than two segments.
    pub coherence: Option<Coherence>,
    /// Estimated phase at each time (rad).
    pub phase: Vec<f64>,
    /// True phase at each time (rad).
    pub true_phase: Vec<f64>,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseAnswer {
    /// Run.
    pub run: String,
    /// Turbine.
    pub turbine: String,
    /// Run with the true wind.
    pub truth: String,
    /// Times that count (s).
    pub times: Vec<f64>,
    /// Mean estimated and true wind over the disc (m/s).
    pub mean_winds: [f64; 2],
    /// Tilt.
    pub tilt: PhaseAxis,
    /// Yaw.
    pub yaw: PhaseAxis,
    /// Mean trust (–).
    pub trust: f64,
}

/// Estimates over the time of a series.
struct Estimates {
    wind: Vec<f64>,
    tilt: Wave,
    yaw: Wave,
    trust: Vec<f64>,
}

#[derive(Default)]
struct Wave {
    amplitude: Vec<f64>,
    phase: Vec<f64>,
}

/// How well the phase of the helix was estimated in the run that `question` names.
///
/// # Errors
/// [`StudyError`] for records that cannot be read, lack a channel, have gaps, or hold no helix.
pub fn phase(question: &PhaseQuestion) -> Result<PhaseAnswer, StudyError> {
    let folder = folder_of(&question.run);
    let manifest = records::read_manifest(&folder)?;
    let case = case::parse("the manifest's case", &manifest.case_text, &[])?;
    let index = turbine_of(question, &case, &manifest)?;
    let name = case.turbines[index].name.clone();
    let reference = reference(&case, &manifest, index)?;
    let series = records::read_series(&folder.series_path())?;
    let times = column(&series, "time_s")?;
    let interval = uniform_interval(times)?;
    let (truth_run, truth) = truth(question, &folder, &name, &reference)?;
    let estimates = match question.estimator {
        Some(estimator) => replay(&case, &series, index, &reference, estimator, interval)?,
        None => recorded(&series, &name)?,
    };
    let from = question.from.unwrap_or(case.time.spin_up);
    let places: Vec<(usize, usize)> = (0..times.len())
        .filter(|&row| times[row] >= from)
        .filter_map(|row| Some((row, truth.index_at(times[row])?)))
        .filter(|(_, place)| truth.trusted.contains(place))
        .collect();
    let block = TAU / reference.rate * SEGMENT_PERIODS;
    let axis = |estimate: &Wave, truth: &analysis::phase::AxisWind, lead: f64| {
        let pick = |values: &[f64]| places.iter().map(|(row, _)| values[*row]).collect::<Vec<_>>();
        let pick_true =
            |values: &[f64]| places.iter().map(|(_, at)| values[*at]).collect::<Vec<_>>();
        let (phase, true_phase) = (pick(&estimate.phase), pick_true(&truth.phase));
        let amplitude = pick(&estimate.amplitude);
        let wind: Vec<f64> = places
            .iter()
            .map(|(row, _)| {
                let angle = reference.rate * times[*row] + lead + estimate.phase[*row];
                estimate.amplitude[*row] * angle.sin()
            })
            .collect();
        let n_segment = (block / interval).round() as usize;
        let coherence = (wind.len() >= 2 * n_segment)
            .then(|| {
                coherence(
                    &wind,
                    &pick_true(&truth.wind),
                    interval,
                    reference.frequency(),
                    n_segment,
                )
            })
            .transpose()?;
        Ok::<PhaseAxis, StudyError>(PhaseAxis {
            amplitude: mean(&amplitude),
            true_amplitude: mean(&pick_true(&truth.amplitude)),
            agreement: agreement(&phase, &true_phase, interval, block)?,
            coherence,
            phase,
            true_phase,
        })
    };
    Ok(PhaseAnswer {
        run: manifest.run,
        turbine: name,
        truth: truth_run,
        tilt: axis(&estimates.tilt, &truth.tilt, 0.0)?,
        yaw: axis(&estimates.yaw, &truth.yaw, reference.sense.yaw_lead())?,
        mean_winds: [
            mean(&places.iter().map(|(row, _)| estimates.wind[*row]).collect::<Vec<_>>()),
            mean(&places.iter().map(|(_, at)| truth.average[*at]).collect::<Vec<_>>()),
        ],
        trust: mean(&places.iter().map(|(row, _)| estimates.trust[*row]).collect::<Vec<_>>()),
        times: places.iter().map(|(row, _)| times[*row]).collect(),
    })
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The run in the folder `path`.
fn folder_of(path: &Path) -> RunFolder {
    // A bare name has no parent to look for other runs in.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
    RunFolder::new(path.parent().unwrap_or(Path::new("")), &name.unwrap_or_default())
}

fn column<'a>(series: &'a Series, channel: &str) -> Result<&'a [f64], StudyError> {
    let missing = || StudyError::MissingChannel { channel: channel.to_owned() };
    series.column(channel).ok_or_else(missing)
}

/// The turbine that `question` is about.
fn turbine_of(
    question: &PhaseQuestion,
    case: &Case,
    manifest: &Manifest,
) -> Result<usize, StudyError> {
    let names: Vec<String> = case.turbines.iter().map(|turbine| turbine.name.clone()).collect();
    let control = &case.runs[manifest.run_index].control;
    let found = match &question.turbine {
        Some(name) => names.iter().position(|other| other == name),
        None => control.iter().position(|control| matches!(control, Control::PhaseSync(_))),
    };
    found.ok_or_else(|| StudyError::NobodySeeks {
        run: manifest.run.clone(),
        asked: question.turbine.clone(),
        turbines: names,
    })
}

/// The helix that meets turbine `index`: the one that it joins, or that of the nearest turbine upstream.
fn reference(case: &Case, manifest: &Manifest, index: usize) -> Result<Reference, StudyError> {
    let control = &case.runs[manifest.run_index].control;
    let x = |turbine: usize| case.turbines[turbine].position_diameters[0];
    let own = match control[index] {
        Control::PhaseSync(sync) => Some((sync.sense, sync.strouhal)),
        _ => None,
    };
    let upstream = (0..control.len())
        .filter(|&other| x(other) < x(index))
        .filter_map(|other| match control[other] {
            Control::Helix(helix) => Some((x(other), (helix.sense, helix.strouhal))),
            _ => None,
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|found| found.1);
    let (sense, strouhal) = own.or(upstream).ok_or_else(|| StudyError::NoHelix {
        run: manifest.run.clone(),
        turbine: case.turbines[index].name.clone(),
    })?;
    let (_, first) = turbine(&case.turbines[0].model, Path::new(""))?;
    let diameter = first.definition.rotor_diameter();
    let rate = excitation_rate(strouhal, case.wind.speed, diameter);
    Ok(Reference { rate, sense })
}

/// Name of the run with the true wind at the place of turbine `name`, and that wind's phases.
fn truth(
    question: &PhaseQuestion,
    folder: &RunFolder,
    name: &str,
    reference: &Reference,
) -> Result<(String, GroundTruth), StudyError> {
    let study = folder.path().parent().unwrap_or(Path::new("")).to_owned();
    let channel = format!("{name}.lines_average_m_s");
    let candidates: Vec<RunFolder> = match &question.truth {
        Some(path) => vec![folder_of(path)],
        None => {
            let mut names: Vec<PathBuf> = std::fs::read_dir(&study)
                .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
                .unwrap_or_default();
            names.sort();
            names.iter().map(|path| folder_of(path)).filter(RunFolder::is_complete).collect()
        }
    };
    for candidate in candidates {
        let series = records::read_series(&candidate.series_path())?;
        if series.column(&channel).is_none() {
            continue;
        }
        let times = column(&series, "time_s")?;
        let interval = uniform_interval(times)?;
        let part = |axis: &str| column(&series, &format!("{name}.lines_{axis}_m_s"));
        let (average, tilt, yaw) = (part("average")?, part("tilt")?, part("yaw")?);
        let winds: Vec<FixedFrame> = (0..times.len())
            .map(|row| FixedFrame { average: average[row], tilt: tilt[row], yaw: yaw[row] })
            .collect();
        let band = Band::around(reference.frequency(), Band::RATIO);
        let truth = ground_truth(&winds, times[0], interval, reference, band)?;
        return Ok((candidate.run(), truth));
    }
    Err(StudyError::NoTruth { turbine: name.to_owned(), directory: study })
}

/// What turbine `name` believed during the run.
fn recorded(series: &Series, name: &str) -> Result<Estimates, StudyError> {
    let channel = |what: &str| column(series, &format!("{name}.{what}")).map(<[f64]>::to_vec);
    let wave = |axis: &str| {
        Ok::<Wave, StudyError>(Wave {
            amplitude: channel(&format!("estimated_{axis}_amplitude_m_s"))?,
            phase: channel(&format!("estimated_{axis}_phase_rad"))?,
        })
    };
    Ok(Estimates {
        wind: channel("estimated_wind_m_s")?,
        tilt: wave("tilt")?,
        yaw: wave("yaw")?,
        trust: channel("estimate_trust")?,
    })
}

/// What `estimator` believes when it is given the records of turbine `index` row by row.
fn replay(
    case: &Case,
    series: &Series,
    index: usize,
    reference: &Reference,
    estimator: PhaseEstimator,
    interval: f64,
) -> Result<Estimates, StudyError> {
    let (definition, setting) = seeker(case, index, reference, interval)?;
    let options = estimator_options(estimator, case.flow.solver);
    let mut estimator =
        HelixEstimator::new(&definition, &setting, options).map_err(AssemblyError::from)?;
    let record = record(case, series, index, definition.n_blades, interval)?;
    let replayed =
        tuning::replay(&mut estimator, &record, interval).map_err(AssemblyError::from)?;
    let mut estimates = Estimates {
        wind: Vec::new(),
        tilt: Wave::default(),
        yaw: Wave::default(),
        trust: Vec::new(),
    };
    for estimate in replayed {
        estimates.wind.push(estimate.mean_wind);
        for (wave, axis) in
            [(&mut estimates.tilt, estimate.tilt), (&mut estimates.yaw, estimate.yaw)]
        {
            wave.amplitude.push(axis.amplitude);
            wave.phase.push(axis.phase);
        }
        estimates.trust.push(estimate.trust.overall());
    }
    Ok(estimates)
}

/// Noise for the estimator that `question` names, tuned on its record against the true wind.
///
/// Source: van Vondelen et al. (2025), Algorithm 1.
///
/// # Errors
/// As [`phase`].
pub fn tune(question: &PhaseQuestion) -> Result<Tuned, StudyError> {
    let folder = folder_of(&question.run);
    let manifest = records::read_manifest(&folder)?;
    let case = case::parse("the manifest's case", &manifest.case_text, &[])?;
    let index = turbine_of(question, &case, &manifest)?;
    let name = &case.turbines[index].name;
    let reference = reference(&case, &manifest, index)?;
    let series = records::read_series(&folder.series_path())?;
    let times = column(&series, "time_s")?;
    let interval = uniform_interval(times)?;
    let (_, truth) = truth(question, &folder, name, &reference)?;
    let from = question.from.unwrap_or(case.time.spin_up);
    let (definition, setting) = seeker(&case, index, &reference, interval)?;
    let whole = record(&case, &series, index, definition.n_blades, interval)?;
    let (mut measured, mut tilt, mut yaw) = (Vec::new(), Vec::new(), Vec::new());
    for measurements in whole {
        let at = truth.index_at(measurements.time).filter(|at| truth.trusted.contains(at));
        if let (Some(at), true) = (at, measurements.time >= from) {
            measured.push(measurements);
            tilt.push(truth.tilt.wind[at]);
            yaw.push(truth.yaw.wind[at]);
        }
    }
    let estimator = question.estimator.unwrap_or(PhaseEstimator::Robust);
    let options = estimator_options(estimator, case.flow.solver);
    let tuned = tuning::tune(&definition, &setting, options, &measured, [&tilt, &yaw]);
    Ok(tuned.map_err(AssemblyError::from)?)
}

/// The rotor of turbine `index`, and what its estimator is told.
fn seeker(
    case: &Case,
    index: usize,
    reference: &Reference,
    interval: f64,
) -> Result<(Arc<Definition>, Setting), StudyError> {
    let (_, file) = turbine(&case.turbines[index].model, Path::new(""))?;
    let setting = Setting {
        sense: reference.sense,
        rate: reference.rate,
        interval,
        air_density: case.wind.air_density,
        n_elements: Setting::N_ELEMENTS,
    };
    Ok((Arc::new(file.definition), setting))
}

/// What turbine `index` measured, row by row.
fn record(
    case: &Case,
    series: &Series,
    index: usize,
    n_blades: usize,
    interval: f64,
) -> Result<Vec<Measurements>, StudyError> {
    let name = &case.turbines[index].name;
    let channel = |what: &str| column(series, &format!("{name}.{what}"));
    let per_blade = |what: &str| {
        (1..=n_blades)
            .map(|blade| channel(&what.replace('#', &blade.to_string())))
            .collect::<Result<Vec<_>, _>>()
    };
    let times = column(series, "time_s")?;
    let azimuth = channel("azimuth_rad")?;
    let rotor_speed = channel("rotor_speed_rad_s")?;
    let (pitch, flap) = (per_blade("pitch_#_rad")?, per_blade("flap_moment_#_nm")?);
    let measurements = |row: usize| Measurements {
        time: times[row],
        interval,
        azimuth: azimuth[row],
        rotor_speed: rotor_speed[row],
        generator_speed: rotor_speed[row],
        pitch: PerBlade::from_fn(n_blades, |blade| pitch[blade][row]),
        // The estimator asks for nothing of what follows but the moments.
        generator_torque: 0.0,
        power: 0.0,
        thrust: 0.0,
        aerodynamic_torque: 0.0,
        rotor_wind_speed: 0.0,
        flap_moments: PerBlade::from_fn(n_blades, |blade| flap[blade][row]),
        edge_moments: PerBlade::splat(n_blades, 0.0),
        tower_top_acceleration: 0.0,
    };
    Ok((0..times.len()).map(measurements).collect())
}
