//! The hub vortex in the scans that a run kept: where it was, in the fixed frame and in that of the helix.

mod beside;
mod figures;
mod scans;

pub(crate) use beside::{Shown, beside, is_pitch, names, pitch};
pub(crate) use figures::{of_runs, seen, signals};
pub(crate) use scans::{Sampled, scans_of};

use crate::PostprocessingError;
use basis::{HelixFrame, Sense};
use estimation::hub_vortex::{HubVortex, HubVortexFilter, HubVortexSettings};
use std::f64::consts::TAU;
use std::path::PathBuf;

/// How the hub vortex is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VortexFilter {
    /// As Chen, van Vondelen, van Wingerden (2026) do.
    Published,
    /// Weighted, its delay made good.
    Robust,
    /// In its place the centroid of the wind over the disc, its delay made good.
    Centroid,
}

impl VortexFilter {
    /// All.
    pub const ALL: [Self; 3] = [Self::Published, Self::Robust, Self::Centroid];

    /// Its name on the command line and in a case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Published => "published",
            Self::Robust => "robust",
            Self::Centroid => "centroid",
        }
    }
}

/// A question to the scans of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HubVortexQuestion {
    /// Folder of the run.
    pub run: PathBuf,
    /// Turbine whose lidar it is; the first that has one when absent.
    pub turbine: Option<String>,
    /// Name of the lidar; the turbine's first when absent.
    pub lidar: Option<String>,
    /// Filters; all when empty.
    pub filters: Vec<VortexFilter>,
    /// Frequency of the helix (Hz); that which the turbine pitched when absent.
    pub frequency: Option<f64>,
    /// Its sense; that which the turbine pitched when absent.
    pub sense: Option<Sense>,
    /// Upper end of the band, the low-pass filter's cut-off (Hz); that of the filter when absent.
    pub cut_off: Option<f64>,
    /// Time between samples (s); that of the turbine's controller, or else that of the scans, when absent.
    pub interval: Option<f64>,
    /// Which of several ranges (rotor diameters), the nearest; that nearest to 1 when absent.
    pub range: Option<f64>,
    /// First time that counts (s); the end of the spin-up when absent.
    pub from: Option<f64>,
}

/// What one filter found.
#[derive(Clone, Debug, PartialEq)]
pub struct HubVortexTrack {
    /// The filter.
    pub filter: VortexFilter,
    /// The vortex at each of the answer's times.
    pub vortices: Vec<HubVortex>,
    /// It in numbers.
    pub numbers: HubVortexNumbers,
}

/// The hub vortex in numbers, over the times that count and are settled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubVortexNumbers {
    /// Samples that they are over (–).
    pub n_samples: usize,
    /// Mean place over whole periods of the helix: to the left looking downwind and up from the rotor's
    /// centre (m).
    pub centre: [f64; 2],
    /// Mean distance from that centre, and its standard deviation (m), as the low-pass filter leaves it: it
    /// takes 1 % at samples 0.1 s apart, 11 % at 0.4 s, of a helix of 42 s. Places in the helix frame have
    /// that made good.
    pub radius: [f64; 2],
    /// Mean tilt and yaw in the helix frame (m).
    pub helix: [f64; 2],
    /// Their standard deviations (m).
    pub helix_deviation: [f64; 2],
    /// Mean confidence (–).
    pub confidence: f64,
    /// Share of scans in which it was not found (–).
    pub blind: f64,
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub struct HubVortexAnswer {
    /// Run.
    pub run: String,
    /// Turbine.
    pub turbine: String,
    /// Lidar.
    pub lidar: String,
    /// The frame of the helix.
    pub frame: HelixFrame,
    /// Rotor diameter (m).
    pub diameter: f64,
    /// Distance that it is seen at (m): the mean range.
    pub range: f64,
    /// Time between samples (s).
    pub interval: f64,
    /// What its circle is taken to be about, to the left and up (m), where the turbine's controller was told.
    pub given_centre: Option<[f64; 2]>,
    /// First time that counts (s).
    pub from: f64,
    /// Share of the points that had no speed (–).
    pub missing: f64,
    /// Times of the samples (s).
    pub times: Vec<f64>,
    /// What each filter found.
    pub tracks: Vec<HubVortexTrack>,
    /// Filters that had not settled before the scans ended, which have no track.
    pub unsettled: Vec<VortexFilter>,
}

/// Follows the hub vortex through the scans that `question` names, as a controller would.
///
/// # Errors
/// [`PostprocessingError::Scans`] for a run without such scans, or without a helix;
/// [`PostprocessingError`] for records that cannot be read.
pub fn hub_vortex(question: &HubVortexQuestion) -> Result<HubVortexAnswer, PostprocessingError> {
    follow(&scans_of(question)?, question)
}

/// The same in what was `sampled`.
pub(crate) fn follow(
    sampled: &Sampled,
    question: &HubVortexQuestion,
) -> Result<HubVortexAnswer, PostprocessingError> {
    if !sampled.is_downwind() {
        let problem = "of a lidar that looks upwind, where no hub vortex is";
        let fix = "name one that looks downwind with --turbine and --lidar";
        return Err(sampled.refused(problem, fix));
    }
    let frame = frame_of(sampled, question)?;
    let filters = match question.filters.as_slice() {
        [] => VortexFilter::ALL.as_slice(),
        filters => filters,
    };
    let from = question.from.unwrap_or(sampled.spin_up);
    let (mut tracks, mut unsettled) = (Vec::with_capacity(filters.len()), Vec::new());
    for filter in filters {
        let settings = settings(*filter, frame, sampled, question);
        let vortices = followed(settings, sampled)?;
        let numbers = numbers(&sampled.times(), &vortices, from, &frame);
        match numbers {
            Some(numbers) => tracks.push(HubVortexTrack { filter: *filter, vortices, numbers }),
            None => unsettled.push(*filter),
        }
    }
    if tracks.is_empty() {
        return Err(sampled.too_short(from));
    }
    let stored = &sampled.stored;
    Ok(HubVortexAnswer {
        run: stored.run.clone(),
        turbine: stored.turbine.clone(),
        lidar: stored.sensor.clone(),
        frame,
        diameter: stored.rotor_diameter,
        range: sampled.range(),
        interval: sampled.interval,
        given_centre: sampled.centre,
        from,
        missing: sampled.missing(),
        times: sampled.times(),
        tracks,
        unsettled,
    })
}

/// The frame of the helix: what is asked for, and else what the turbine pitched.
fn frame_of(
    sampled: &Sampled,
    question: &HubVortexQuestion,
) -> Result<HelixFrame, PostprocessingError> {
    let own = sampled.stored.helix;
    let rate = question.frequency.map(|frequency| TAU * frequency).or(own.map(|own| own.rate));
    let sense = question.sense.or(own.map(|own| own.sense));
    match (rate, sense) {
        (Some(rate), Some(sense)) => Ok(HelixFrame { sense, rate }),
        _ => Err(sampled.refused(
            "whose turbine pitched no helix: no frame is known that turns with the hub vortex",
            "say how fast it turns, and which way, with --frequency and --sense",
        )),
    }
}

fn settings(
    filter: VortexFilter,
    frame: HelixFrame,
    sampled: &Sampled,
    question: &HubVortexQuestion,
) -> HubVortexSettings {
    let radius = 0.5 * sampled.stored.rotor_diameter;
    let usual = match filter {
        VortexFilter::Published => HubVortexSettings::of_source,
        VortexFilter::Robust => HubVortexSettings::robust,
        VortexFilter::Centroid => HubVortexSettings::centroid,
    };
    let usual = usual(frame, radius, sampled.interval);
    let cut_off = question.cut_off.unwrap_or(usual.cut_off);
    HubVortexSettings { cut_off, centre: sampled.centre, ..usual }
}

/// The vortex in every sample: the filter of a control loop, sample by sample.
fn followed(
    settings: HubVortexSettings,
    sampled: &Sampled,
) -> Result<Vec<HubVortex>, PostprocessingError> {
    let refused = |error: estimation::EstimationError| {
        let fix = "ask for another --band, --interval or --frequency";
        sampled.refused(&format!("in which no hub vortex can be followed: {error}"), fix)
    };
    let mut filter = HubVortexFilter::new(settings, sampled.points.len()).map_err(refused)?;
    let mut vortices = Vec::with_capacity(sampled.samples.len());
    sampled.each(|time, scan| vortices.push(filter.update(time, &scan)));
    Ok(vortices)
}

/// `vortices` in numbers, from `from` (s) on; none where too few of them are settled.
fn numbers(
    times: &[f64],
    vortices: &[HubVortex],
    from: f64,
    frame: &HelixFrame,
) -> Option<HubVortexNumbers> {
    let counted = |(time, vortex): &(&f64, &HubVortex)| **time >= from && vortex.settled;
    let all: Vec<(f64, &HubVortex)> =
        times.iter().zip(vortices).filter(counted).map(|(time, vortex)| (*time, vortex)).collect();
    let (first, last) = (all.first()?.0, all.last()?.0);
    if all.len() < 2 {
        return None;
    }
    let period = TAU / frame.rate;
    // A sample stands for the time to the next: a whole turn and its first sample again are one too many.
    let interval = (last - first) / (all.len() - 1) as f64;
    let n_periods = ((last - first + interval) / period + 1e-6).floor();
    let n_whole = ((n_periods * period / interval).round() as usize).min(all.len());
    let whole = if n_whole == 0 { &all[..] } else { &all[all.len() - n_whole..] };
    let mean = |of: &dyn Fn(&HubVortex) -> f64| {
        whole.iter().map(|(_, vortex)| of(vortex)).sum::<f64>() / whole.len() as f64
    };
    let spread = |of: &dyn Fn(&HubVortex) -> f64, about: f64| {
        mean(&|vortex| (of(vortex) - about).powi(2)).sqrt()
    };
    let centre = [0, 1].map(|axis| mean(&|vortex| vortex.filtered[axis]));
    let distance =
        |vortex: &HubVortex| (vortex.filtered[0] - centre[0]).hypot(vortex.filtered[1] - centre[1]);
    let radius = mean(&distance);
    let helix = [0, 1].map(|axis| mean(&|vortex| vortex.helix[axis]));
    let deviation = |axis: usize| spread(&|vortex| vortex.helix[axis], helix[axis]);
    Some(HubVortexNumbers {
        n_samples: whole.len(),
        centre,
        radius: [radius, spread(&distance, radius)],
        helix,
        helix_deviation: [0, 1].map(deviation),
        confidence: mean(&|vortex| vortex.confidence),
        blind: mean(&|vortex| f64::from(u8::from(vortex.held))),
    })
}
