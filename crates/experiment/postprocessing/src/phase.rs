//! How well the phase of a helix is estimated on the turbine that it meets: records in, agreement with the
//! true wind out.

mod estimates;
pub(crate) mod query;
mod replay;

pub use estimates::PreviewUse;
pub(crate) use estimates::recorded;
pub use replay::{Replayed, tune};

use crate::PostprocessingError;
use crate::error::InRecords;
use analysis::phase::{
    Agreement, AxisWind, Band, Coherence, GroundTruth, Reference, agreement, coherence,
    fixed_frame_moments, ground_truth, uniform_interval,
};
use basis::Channel;
use basis::FixedFrame;
use basis::channels::{
    AZIMUTH, BLD_PITCH, LINES, PREVIEW_LAG, PREVIEW_SHARE, ROOT_MYC, ROT_SPEED, SYNC_SHARE, TIME,
    of_phase_sync,
};
use basis::records::{Series, Statistic};
use estimates::{Estimates, Wave, consistency};
use query::{Query, Records};
use std::f64::consts::TAU;
use std::path::PathBuf;

/// Excitation periods in a segment of the cross-spectrum (–).
const SEGMENT_PERIODS: f64 = 4.0;

/// A question to the records of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PhaseQuestion {
    /// Folder of the run.
    pub run: PathBuf,
    /// Turbine that a helix meets; the first that looks for one when absent.
    pub turbine: Option<String>,
    /// Folder of a run of the same study without that turbine, whose series holds the true wind at its place;
    /// a run beside this one when absent.
    pub truth: Option<PathBuf>,
    /// Estimator to run over the records; the run's own estimate when absent.
    pub estimator: Option<Replayed>,
    /// Band of the filter through which the truth goes; [`Band::around`] the excitation with [`Band::RATIO`]
    /// when absent.
    pub band: Option<Band>,
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
    /// Mean of the squared phase errors over the estimator's own variance of them (–), with its interval from
    /// blocks: one where the estimator knows its errors, more where it is too sure of itself. Absent where
    /// the series does not hold the variance.
    pub consistency: Option<Statistic>,
    /// Estimated wind of the helix at each time (m/s).
    pub wind: Vec<f64>,
    /// Standard deviation that the estimator has of it (m/s); empty where the series does not hold it.
    pub wind_deviation: Vec<f64>,
    /// True wind of the helix at each time (m/s), in the band of the truth.
    pub true_wind: Vec<f64>,
    /// Estimated phase at each time (rad).
    pub phase: Vec<f64>,
    /// Standard deviation that the estimator has of it (rad); empty where the series does not hold it.
    pub phase_deviation: Vec<f64>,
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
    /// Frequency of the helix (Hz).
    pub frequency: f64,
    /// Band of the truth.
    pub band: Band,
    /// Length of the blocks behind all intervals (s).
    pub block: f64,
    /// Times that count (s).
    pub times: Vec<f64>,
    /// Mean estimated and true wind over the radial lines (m/s), which weigh the middle of the disc more than
    /// its area does.
    pub mean_winds: [f64; 2],
    /// Estimated wind over the disc at each time (m/s).
    pub wind: Vec<f64>,
    /// Standard deviation that the estimator has of it (m/s); empty where the series does not hold it.
    pub wind_deviation: Vec<f64>,
    /// True wind over the disc at each time (m/s), not filtered.
    pub true_wind: Vec<f64>,
    /// Tilt.
    pub tilt: PhaseAxis,
    /// Yaw.
    pub yaw: PhaseAxis,
    /// Mean trust (–).
    pub trust: f64,
    /// How far the run's own estimate came through a lidar. Absent of a turbine without a preview, and of
    /// estimators that are run over the records, which see the blade loads alone.
    pub preview: Option<PreviewUse>,
    /// Tilt and yaw phase of the turbine's own blade moments through the filter of the truth, which knows the
    /// future: what its loads hold, beside what an estimator made of them in time. Absent where the turbine
    /// pitched a helix of its own.
    pub zero_phase: Option<[Agreement; 2]>,
    /// Tilt and yaw phase of the estimate against the truth in the published band, at the times at which both
    /// bands can be trusted. Absent where the records cannot hold that band.
    pub published_band: Option<[Agreement; 2]>,
}

/// The answers for all turbines of a run that look for a helix.
#[derive(Debug)]
pub struct PhaseAnswers {
    /// Turbine by turbine, in the case's order.
    pub answers: Vec<PhaseAnswer>,
    /// Why others have none: no run kept the true wind at their place.
    pub without_truth: Vec<PostprocessingError>,
}

/// The wind where the turbine would stand, in a run without it.
pub(crate) struct Truth {
    /// Name of the run.
    pub(crate) run: String,
    band: Band,
    wind: GroundTruth,
}

/// How well the phase of the helix was estimated in the run that `question` names.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, lack a channel, have gaps, or hold no helix.
pub fn phase(question: &PhaseQuestion) -> Result<PhaseAnswer, PostprocessingError> {
    let mut records = Records::read(question)?;
    let first = records.turbines[0];
    let query = records.query(first)?;
    answer(question, &query).in_records(&query.path)
}

/// What [`phase`] answers for the turbine that `question` names, for each that estimates the phase of a helix
/// where it names none.
///
/// # Errors
/// As [`phase`]; [`PostprocessingError::NoTruth`] only where no turbine has an answer.
pub fn phases(question: &PhaseQuestion) -> Result<PhaseAnswers, PostprocessingError> {
    let mut records = Records::read(question)?;
    let mut found = PhaseAnswers { answers: Vec::new(), without_truth: Vec::new() };
    for index in records.turbines.clone() {
        match records.query(index) {
            Err(error @ PostprocessingError::NoTruth { .. }) => found.without_truth.push(error),
            query => {
                let query = query?;
                found.answers.push(answer(question, &query).in_records(&query.path)?);
            }
        }
    }
    if found.answers.is_empty() && !found.without_truth.is_empty() {
        return Err(found.without_truth.remove(0));
    }
    Ok(found)
}

/// Answer of the records of `query` for one turbine.
fn answer(question: &PhaseQuestion, query: &Query<'_>) -> Result<PhaseAnswer, PostprocessingError> {
    let Query { run, case, name, reference, series, truth, published, .. } = query;
    let estimates = match question.estimator {
        Some(estimator) => replay::replay(query, estimator)?,
        None => recorded(series, name)?,
    };
    let from = question.from.unwrap_or(case.time.spin_up);
    let compared = |estimates: &Estimates, truth: &Truth| {
        compare(run, name, series, estimates, truth, reference, from)
    };
    let agreements = |found: PhaseAnswer| [found.tilt.agreement, found.yaw.agreement];
    let zero_phase = if query.pitches {
        None
    } else {
        let looked_back = zero_phase(series, name, reference, truth.band)?;
        Some(agreements(compared(&looked_back, truth)?))
    };
    let published_band = match published {
        Some(published) => {
            let alike = published.within(truth);
            Some(agreements(compared(&estimates, &alike)?))
        }
        None => None,
    };
    Ok(PhaseAnswer { zero_phase, published_band, ..compared(&estimates, truth)? })
}

impl Truth {
    /// The same, trusted only where `other` is, whose samples are the same instants.
    fn within(&self, other: &Self) -> Self {
        let [own, theirs] = [&self.wind.trusted, &other.wind.trusted];
        let trusted = own.start.max(theirs.start)..own.end.min(theirs.end);
        let wind = GroundTruth { trusted, ..self.wind.clone() };
        Self { run: self.run.clone(), band: self.band, wind }
    }
}

/// What the blade moments of turbine `name` tell of its wind to a filter that knows the future; moments (N m)
/// stand for winds.
fn zero_phase(
    series: &Series,
    name: &str,
    reference: &Reference,
    band: Band,
) -> Result<Estimates, PostprocessingError> {
    let moments = moments(series, name)?;
    let times = column(series, &TIME.name)?;
    let filtered = ground_truth(&moments, times[0], uniform_interval(times)?, reference, band)?;
    let wave = |axis: AxisWind| {
        let AxisWind { amplitude, phase, .. } = axis;
        Wave { amplitude, phase, ..Wave::default() }
    };
    Ok(Estimates {
        trust: vec![1.0; filtered.average.len()],
        preview: None,
        wind: filtered.average,
        wind_deviation: Vec::new(),
        tilt: wave(filtered.tilt),
        yaw: wave(filtered.yaw),
    })
}

/// Moments of the blades of turbine `name` in the fixed frame (N m), row by row.
pub(crate) fn moments(series: &Series, name: &str) -> Result<Vec<FixedFrame>, PostprocessingError> {
    let blade = |blade: usize| series.column(&ROOT_MYC.of_blade(blade).at(name));
    let blades: Vec<&[f64]> = (1..).map_while(blade).collect();
    Ok(fixed_frame_moments(column(series, &AZIMUTH.at(name))?, &blades)?)
}

/// Comparison of `estimates` over the rows of `series` with `truth`, from the time `from` (s) on.
///
/// # Errors
/// [`PostprocessingError::Analysis`] for records that are too short or have gaps.
pub(crate) fn compare(
    run: &str,
    turbine: &str,
    series: &Series,
    estimates: &Estimates,
    Truth { run: truth_run, band, wind: truth }: &Truth,
    reference: &Reference,
    from: f64,
) -> Result<PhaseAnswer, PostprocessingError> {
    let times = column(series, &TIME.name)?;
    let interval = uniform_interval(times)?;
    let places: Vec<(usize, usize)> = (0..times.len())
        .filter(|&row| times[row] >= from)
        .filter_map(|row| Some((row, truth.index_at(times[row])?)))
        .filter(|(_, place)| truth.trusted.contains(place))
        .collect();
    let pick = |values: &[f64]| places.iter().map(|(row, _)| values[*row]).collect::<Vec<_>>();
    // What is not known at any time is known at none.
    let pick_known = |values: &[f64]| if values.is_empty() { Vec::new() } else { pick(values) };
    let pick_true = |values: &[f64]| places.iter().map(|(_, at)| values[*at]).collect::<Vec<_>>();
    let block = TAU / reference.rate * SEGMENT_PERIODS;
    let n_segment = (block / interval).round() as usize;
    let axis = |estimate: &Wave, truth: &AxisWind, lead: f64| {
        let (phase, true_phase) = (pick(&estimate.phase), pick_true(&truth.phase));
        let wind: Vec<f64> = places
            .iter()
            .map(|(row, _)| {
                let angle = reference.rate * times[*row] + lead + estimate.phase[*row];
                estimate.amplitude[*row] * angle.sin()
            })
            .collect();
        let true_wind = pick_true(&truth.wind);
        let coherence = if wind.len() >= 2 * n_segment {
            Some(coherence(&wind, &true_wind, interval, reference.frequency(), n_segment)?)
        } else {
            None
        };
        let phase_deviation = pick_known(&estimate.deviation);
        let consistency = (!phase_deviation.is_empty())
            .then(|| consistency(&phase, &true_phase, &phase_deviation, interval, block))
            .transpose()?;
        Ok::<PhaseAxis, PostprocessingError>(PhaseAxis {
            consistency,
            amplitude: mean(&pick(&estimate.amplitude)),
            true_amplitude: mean(&pick_true(&truth.amplitude)),
            agreement: agreement(&phase, &true_phase, interval, block)?,
            coherence,
            wind,
            wind_deviation: pick_known(&estimate.wind_deviation),
            true_wind,
            phase,
            phase_deviation,
            true_phase,
        })
    };
    Ok(PhaseAnswer {
        run: run.to_owned(),
        turbine: turbine.to_owned(),
        truth: truth_run.clone(),
        frequency: reference.frequency(),
        band: *band,
        block,
        tilt: axis(&estimates.tilt, &truth.tilt, 0.0)?,
        yaw: axis(&estimates.yaw, &truth.yaw, reference.sense.yaw_lead())?,
        mean_winds: [mean(&pick(&estimates.wind)), mean(&pick_true(&truth.average))],
        wind: pick(&estimates.wind),
        wind_deviation: pick_known(&estimates.wind_deviation),
        true_wind: pick_true(&truth.average),
        trust: mean(&pick(&estimates.trust)),
        preview: estimates
            .preview
            .as_ref()
            .map(|[share, lag]| PreviewUse::of(&pick(share), &pick(lag))),
        times: pick(times),
        zero_phase: None,
        published_band: None,
    })
}

/// Whether `channel` of a series tells of the phase of a helix at turbine `name`; no other is asked for here.
pub(crate) fn tells(name: &str, channel: &str) -> bool {
    let own = channel.strip_prefix(name).and_then(|rest| rest.strip_prefix('.'));
    channel == TIME.name || own.is_some_and(|own| of_phase(own) || is_of_blades(own))
}

/// Whether the turbine's channel `own` tells of a phase: measured, estimated, and the true wind where it
/// would stand.
fn of_phase(own: &str) -> bool {
    let is = |channel: &Channel| channel.name == own;
    [AZIMUTH, ROT_SPEED].iter().any(is)
        || of_phase_sync().iter().filter(|channel| **channel != SYNC_SHARE).any(is)
        || [PREVIEW_SHARE, PREVIEW_LAG].iter().any(is)
        || LINES.iter().any(is)
}

/// Whether the turbine's channel `own` is what a blade pitches or the moment at its root.
pub(crate) fn is_of_blades(own: &str) -> bool {
    let stem = own.trim_end_matches(|c: char| c.is_ascii_digit());
    own.len() > stem.len() && [BLD_PITCH, ROOT_MYC].iter().any(|channel| channel.stem == stem)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The samples of `channel`.
pub(crate) fn column<'a>(
    series: &'a Series,
    channel: &str,
) -> Result<&'a [f64], PostprocessingError> {
    let missing =
        || PostprocessingError::MissingChannel { path: None, channel: channel.to_owned() };
    series.column(channel).ok_or_else(missing)
}

/// The true wind at the place of turbine `name` in the `series` of `run`, through a filter of `band`; nothing
/// where that was not kept.
///
/// # Errors
/// [`PostprocessingError::Analysis`] for a record that is too short or has gaps.
pub(crate) fn truth(
    run: &str,
    name: &str,
    series: &Series,
    reference: &Reference,
    band: Band,
) -> Result<Option<Truth>, PostprocessingError> {
    let [Some(average), Some(tilt), Some(yaw)] = LINES.map(|part| series.column(&part.at(name)))
    else {
        return Ok(None);
    };
    let times = column(series, &TIME.name)?;
    let interval = uniform_interval(times)?;
    let winds: Vec<FixedFrame> = (0..times.len())
        .map(|row| FixedFrame { average: average[row], tilt: tilt[row], yaw: yaw[row] })
        .collect();
    let wind = ground_truth(&winds, times[0], interval, reference, band)?;
    Ok(Some(Truth { run: run.to_owned(), band, wind }))
}
