//! From a record to a model: PBSID-opt, and what a control engineer asks of it first.

use crate::data::Data;
use crate::model::{linear_model, rows};
use crate::{DesignError, Source};
use faer::Mat;
use formats::linear_model::{LinearModel, Role};
use identification::decoupling::{
    azimuth_offset, nearest_azimuth_offset, relative_gains, with_azimuth_offset,
};
use identification::delay::{by_correlation, by_zeros};
use identification::fit::{predicted, simulated, variance_accounted_for};
use identification::frequency::FrequencyResponse;
use identification::pbsid::{InnovationModel, Regularisation, Settings, Subspace};
use identification::{IdentificationError, Record, Trend};
use lti::Complex64;
use lti::matrices::StateSpace;

/// Most states that are looked at for a gap (–).
const MOST_STATES: usize = 20;
/// Longest delay that is looked for (s).
const LONGEST_DELAY: f64 = 60.0;

/// What to identify, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifyQuestion {
    /// The record.
    pub source: Source,
    /// Every so many samples are kept, after a filter (–).
    pub decimate: usize,
    /// Trend that is taken off.
    pub trend: Trend,
    /// Windows of past and future (samples).
    pub windows: [usize; 2],
    /// Whether an input acts within the same sample.
    pub feedthrough: bool,
    /// Order of the model; that of the largest gap among the singular values when absent.
    pub order: Option<usize>,
    /// Delay of the outputs that is known (s): taken out of the record in whole samples, and as such written
    /// beside the model.
    pub delay: f64,
    /// Share of the record that is kept aside for validation (–).
    pub aside: f64,
    /// Frequency at which the relative gains are wanted, beside zero (rad/s).
    pub bandwidth: f64,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Identified {
    /// The model, as its file has it.
    pub model: LinearModel,
    /// Samples of the record, and how many of them were kept aside (–).
    pub n_samples: [usize; 2],
    /// Deviations of the states in the order of their weight (–), the first of them.
    pub singular_values: Vec<f64>,
    /// Variance of each output that simulation accounts for (%), on what was identified from and on what was
    /// kept aside.
    pub accounted_for: [Vec<f64>; 2],
    /// Variance of each output that prediction one sample ahead accounts for (%), on what was kept aside.
    pub predicted: Vec<f64>,
    /// Poles.
    pub poles: Roots,
    /// Transmission zeros, all that are finite, of all inputs and outputs together.
    pub zeros: Roots,
    /// Delay that those in the right half plane stand for (s).
    pub delay_of_zeros: f64,
    /// Delay of each output (row) behind each input (column) by prewhitened correlation (s); none where
    /// nothing is significant, or the record too short.
    pub delays: Vec<Vec<Option<f64>>>,
    /// Gain at rest, outputs by inputs.
    pub gain: Vec<Vec<f64>>,
    /// Relative gains at rest and real parts at the bandwidth asked for; none of a system that is not square.
    pub relative_gains: Option<[Vec<Vec<f64>>; 2]>,
    /// Azimuth offset with which tilt and yaw are decoupled at rest; none but of two inputs and two outputs.
    pub azimuth_offset: Option<Offset>,
    /// The one that comes nearest to decoupling them at the bandwidth asked for.
    pub azimuth_offset_at_bandwidth: Option<Offset>,
    /// Frequency response of record and model.
    pub response: Responses,
    /// Frequency of interest that was asked for (rad/s).
    pub bandwidth: f64,
}

/// Poles or zeros of a system in discrete time, the slowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Roots {
    /// In the plane of z (–).
    pub sampled: Vec<Complex64>,
    /// ln z/T (rad/s), in the same order.
    pub continuous: Vec<Complex64>,
}

/// An azimuth offset, and what it does.
#[derive(Clone, Debug, PartialEq)]
pub struct Offset {
    /// On top of that of the record (rad).
    pub angle: f64,
    /// Relative gains with it at rest and real parts at the bandwidth asked for.
    pub relative_gains: [Vec<Vec<f64>>; 2],
}

/// Frequency responses at the same frequencies.
#[derive(Clone, Debug)]
pub struct Responses {
    /// Frequencies (rad/s), equally spaced, the first being the spacing.
    pub frequencies: Vec<f64>,
    /// Without a model: outputs × inputs at each frequency.
    pub measured: Vec<Vec<Vec<Complex64>>>,
    /// Root mean square of its random error, likewise.
    pub deviations: Vec<Vec<Vec<f64>>>,
    /// Multiple coherence of each output (–).
    pub coherences: Vec<Vec<f64>>,
    /// Of the model.
    pub modelled: Vec<Vec<Vec<Complex64>>>,
}

/// Identifies a model.
///
/// # Errors
/// [`DesignError`] naming the record and what is wrong with it.
pub fn identify(question: &IdentifyQuestion) -> Result<Identified, DesignError> {
    let data = Data::read(&question.source)?;
    found(question, &data).map_err(|source| data.failed(source))
}

fn found(question: &IdentifyQuestion, data: &Data) -> Result<Identified, IdentificationError> {
    let means = [data.record.inputs(), data.record.outputs()]
        .map(|channels| channels.iter().map(|channel| mean(&channel.samples)).collect());
    let record = data.record.detrended(question.trend)?.decimated(question.decimate)?;
    let interval = record.interval();
    let shift = (question.delay / interval).round() as usize;
    let record = record.outputs_advanced(shift)?;
    let (identified, aside) = record.split(1.0 - question.aside)?;
    let [past, future] = question.windows;
    let settings = Settings {
        past,
        future,
        feedthrough: question.feedthrough,
        regularisation: Regularisation::CrossValidated,
    };
    let subspace = Subspace::new(&identified, settings)?;
    let order = question.order.unwrap_or_else(|| subspace.largest_gap(MOST_STATES));
    let found = subspace.model(order)?;
    let system = &found.system;
    let accounted_for = [&identified, &aside]
        .map(|record| variance_accounted_for(record, &simulated(system, record)?));
    let [on_identified, on_aside] = accounted_for;
    let ahead = predicted(system, &found.gain, &aside)?;
    let rate = question.bandwidth;
    let gain = system.gain_at_rest()?;
    Ok(Identified {
        n_samples: [record.n_samples(), aside.n_samples()],
        singular_values: subspace.singular_values().iter().take(MOST_STATES).copied().collect(),
        accounted_for: [on_identified?, on_aside?],
        predicted: variance_accounted_for(&aside, &ahead)?,
        poles: Roots::of(system.poles()?, interval),
        zeros: Roots::of(system.invariant_zeros()?, interval),
        delay_of_zeros: by_zeros(system)?.delay,
        delays: delays(&record, shift)?,
        relative_gains: relative(system, rate),
        azimuth_offset: offset(system, azimuth_offset(&gain), rate),
        azimuth_offset_at_bandwidth: offset(system, nearest_azimuth_offset(system, rate), rate),
        gain: rows(&gain),
        response: responses(&record, system)?,
        bandwidth: rate,
        model: in_a_file(data, &found, shift as f64 * interval, means),
    })
}

fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len() as f64
}

/// The model as its file has it, its outputs being `delay` (s) late.
fn in_a_file(
    data: &Data,
    found: &InnovationModel,
    delay: f64,
    [input_means, output_means]: [Vec<f64>; 2],
) -> LinearModel {
    let order = found.system.order();
    let description = format!("order {order}, PBSID-opt, from {}", data.path.display());
    let mut model = linear_model(Role::Model, description, data.ports.clone(), &found.system);
    model.k = Some(rows(&found.gain));
    model.output_delay_s = delay;
    (model.input_means, model.output_means) = (input_means, output_means);
    model
}

impl Roots {
    /// Of a system whose samples are `interval` (s) apart.
    fn of(mut sampled: Vec<Complex64>, interval: f64) -> Self {
        let rate = |root: &Complex64| root.ln() / interval;
        sampled.sort_by(|a, b| {
            let by_size = rate(a).norm().total_cmp(&rate(b).norm());
            by_size.then(b.im.total_cmp(&a.im))
        });
        let continuous = sampled.iter().map(rate).collect();
        Self { sampled, continuous }
    }

    /// Those outside the unit circle, which are those in the right half plane (rad/s).
    pub fn unstable(&self) -> impl Iterator<Item = &Complex64> {
        self.continuous.iter().filter(|root| root.re > 0.0)
    }
}

/// Delays of all outputs behind all inputs (s), of a record whose outputs were moved by `shift` samples.
fn delays(record: &Record, shift: usize) -> Result<Vec<Vec<Option<f64>>>, IdentificationError> {
    let interval = record.interval();
    let most = ((LONGEST_DELAY / interval) as usize).min(record.n_samples() / 12);
    let of_pair = |input: usize, output: usize| {
        let found = match by_correlation(record, input, output, most) {
            Ok(found) => found.samples,
            // A record that is long enough for a model may be too short for this.
            Err(IdentificationError::TooFewSamples { .. }) => None,
            Err(error) => return Err(error),
        };
        Ok(found.map(|samples| (samples + shift) as f64 * interval))
    };
    let of_output = |output| {
        (0..record.inputs().len())
            .map(|input| of_pair(input, output))
            .collect::<Result<Vec<_>, _>>()
    };
    (0..record.outputs().len()).map(of_output).collect()
}

/// Relative gains at rest and at `bandwidth` (rad/s), real parts.
fn relative(system: &StateSpace, bandwidth: f64) -> Option<[Vec<Vec<f64>>; 2]> {
    let at = |frequency| {
        let gains = relative_gains(system, frequency).ok()?;
        Some(rows(&Mat::from_fn(gains.nrows(), gains.ncols(), |i, j| gains[(i, j)].re)))
    };
    Some([at(0.0)?, at(bandwidth)?])
}

/// The offset that was `found` (rad), where there is one, with the relative gains of the `system` under it.
fn offset(
    system: &StateSpace,
    found: Result<f64, IdentificationError>,
    bandwidth: f64,
) -> Option<Offset> {
    let angle = found.ok()?;
    let turned = with_azimuth_offset(system, angle).ok()?;
    Some(Offset { angle, relative_gains: relative(&turned, bandwidth)? })
}

/// Responses of `record`, in segments of an eighth of it, and of `system`.
fn responses(record: &Record, system: &StateSpace) -> Result<Responses, IdentificationError> {
    let measured = FrequencyResponse::new(record, record.n_samples() / 8)?;
    let complex = |matrix: &Mat<faer::c64>| -> Vec<Vec<Complex64>> {
        matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
    };
    let modelled = measured.frequencies.iter().map(|frequency| system.response(*frequency));
    let modelled = modelled.collect::<Result<Vec<_>, _>>()?;
    Ok(Responses {
        measured: measured.responses.iter().map(complex).collect(),
        deviations: measured.deviations.iter().map(rows).collect(),
        coherences: measured.coherences,
        modelled: modelled.iter().map(complex).collect(),
        frequencies: measured.frequencies,
    })
}
