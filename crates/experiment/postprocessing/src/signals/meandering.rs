//! Meandering amplified or attenuated, over time and over frequency: figures 4-4 to 4-7 of van Veldhoven
//! (2024).

mod figures;

use super::{analysed, control_of};
use crate::PostprocessingError;
use crate::error::case_in;
use crate::phase::{column, is_of_blades};
use basis::Channel;
use basis::channels::{AZIMUTH, FollowedMoment, MEAND_AXES, MEAND_RATE, TIME, of_meandering};
use basis::records::Series;
use control::excitation_rate;
use control::meandering::MeanderingSettings;
use farm::case::{Case, CirclingDisk, WindEvent};
use figures::Figures;
use formats::records::{self, RunRecords, StudyRecords};
use report::{DensityFigure, Signals, TrackFigure};
use std::f64::consts::TAU;
use std::path::Path;

/// What became of one axis of a turbine's load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanderingAxisNumbers {
    /// Mean of the amplitude's error, target minus estimate (N m), from its first target on.
    pub amplitude_error: f64,
    /// Its root mean square (N m).
    pub amplitude_rms: f64,
    /// Mean target amplitude (N m).
    pub target: f64,
    /// Mean of the estimated bias, the moment's own mean (N m).
    pub bias: f64,
    /// Standard deviation of that estimate (N m).
    pub bias_deviation: f64,
}

/// What became of the meandering load of a turbine in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanderingNumbers {
    /// Run.
    pub run: String,
    /// Turbine.
    pub turbine: String,
    /// Target amplitude over that of the baseline (–); absent where it only monitors.
    pub factor: Option<f64>,
    /// Tilt and yaw.
    pub axes: [MeanderingAxisNumbers; 2],
    /// Mean estimated frequency, and standard deviation of the estimate (Hz).
    pub frequency: [f64; 2],
    /// Root mean square of the estimated frequency's error over the true one (–), where the wind is a disk
    /// that circles at a known rate.
    pub frequency_error: Option<f64>,
}

/// The runs of a study in which one turbine follows a meandering wake.
#[derive(Clone, Debug)]
pub(crate) struct Meandered {
    turbine: String,
    pub(crate) numbers: Vec<MeanderingNumbers>,
    pub(crate) tracks: Vec<TrackFigure>,
    pub(crate) densities: Vec<DensityFigure>,
}

impl Meandered {
    /// As a part of a report.
    pub(crate) fn signals(&self) -> Signals {
        Signals {
            title: format!("Meandering at {}", self.turbine),
            lead: "Tilt and yaw moment of the blades, brought to a factor of their own amplitude in phase with the wake's motion, and what \
                   the phase-locked loop makes of them."
                .to_owned(),
            tracks: self.tracks.clone(),
            densities: self.densities.clone(),
            ..Signals::default()
        }
    }
}

/// What became of meandering loads in the study in `directory`: turbine by turbine and run by run in numbers,
/// and the figures.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, and [`PostprocessingError::NoSignals`] where no
/// turbine follows a meandering wake.
pub fn meandering(
    directory: &Path,
) -> Result<(Vec<MeanderingNumbers>, Vec<Signals>), PostprocessingError> {
    let study = records::read_study(directory)?;
    let case = case_in(directory, &study.case_text)?;
    let found = of_study(&case, &study)?;
    if found.is_empty() {
        return Err(PostprocessingError::NoSignals {
            directory: directory.to_owned(),
            lacking: "has a turbine that follows a meandering wake, with rows after the spin-up",
            fix: "give a turbine kind = \"meandering\"; amplitude_deg = 0 only monitors",
        });
    }
    let signals = found.iter().map(Meandered::signals).collect();
    Ok((found.into_iter().flat_map(|turbine| turbine.numbers).collect(), signals))
}

/// The same in `records` of `case`, by turbines.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be analysed.
pub(super) fn of_study(
    case: &Case,
    records: &StudyRecords,
) -> Result<Vec<Meandered>, PostprocessingError> {
    let mut found = Vec::new();
    for (index, turbine) in case.turbines.iter().enumerate() {
        let mut figures = Figures::default();
        let mut numbers = Vec::new();
        for run in &records.runs {
            let control = control_of(case, run).get(index);
            let Some(settings) = control.and_then(MeanderingSettings::of) else { continue };
            if let Some(followed) = Followed::of(case, run, &turbine.name, settings)? {
                numbers.push(followed.numbers()?);
                figures.add(&followed)?;
            }
        }
        if !numbers.is_empty() {
            found.push(figures.of(&turbine.name, numbers));
        }
    }
    Ok(found)
}

/// One run in which a turbine follows a meandering wake.
struct Followed<'a> {
    run: &'a str,
    turbine: &'a str,
    settings: MeanderingSettings,
    series: Series,
    /// First analysed row, and time between rows (s).
    first: usize,
    interval: f64,
    /// Frequency of Strouhal number one (Hz).
    of_one: f64,
    /// The disk that circles in the wind, where there is one.
    disk: Option<CirclingDisk>,
}

impl<'a> Followed<'a> {
    /// Nothing where the analysed time has no rows.
    fn of(
        case: &Case,
        run: &'a RunRecords,
        turbine: &'a str,
        settings: MeanderingSettings,
    ) -> Result<Option<Self>, PostprocessingError> {
        let wanted = |channel: &str| {
            let own = channel.strip_prefix(turbine).and_then(|rest| rest.strip_prefix('.'));
            let is_needed = |own: &str| {
                own == AZIMUTH.name
                    || is_of_blades(own)
                    || of_meandering().iter().any(|channel| channel.name == own)
            };
            channel == TIME.name || own.is_some_and(is_needed)
        };
        let series = run.series.read(wanted)?;
        let Some((first, _, interval)) = analysed(&series, case.time.spin_up) else {
            return Ok(None);
        };
        let diameter = run.summary.conditions.rotor_diameter;
        Ok(Some(Self {
            run: &run.manifest.run,
            turbine,
            settings,
            first,
            interval,
            of_one: excitation_rate(1.0, case.wind.speed, diameter) / TAU,
            disk: match case.wind.event {
                Some(WindEvent::RotatingDisk(disk)) => Some(disk),
                _ => None,
            },
            series,
        }))
    }

    /// Highest and lowest frequency that is followed (Hz).
    fn band(&self) -> [f64; 2] {
        self.settings.strouhal.map(|strouhal| strouhal * self.of_one)
    }

    fn times(&self) -> Result<&[f64], PostprocessingError> {
        Ok(&column(&self.series, &TIME.name)?[self.first..])
    }

    /// The analysed rows of the turbine's `channel`.
    fn own(&self, channel: &Channel) -> Result<&[f64], PostprocessingError> {
        Ok(&column(&self.series, &channel.at(self.turbine))?[self.first..])
    }

    /// Whether it only monitors.
    fn monitors(&self) -> bool {
        self.settings.amplitude == 0.0
    }

    /// Target minus estimated amplitude of `axis` (N m) at each row; not a number while there is no target.
    fn amplitude_error(&self, axis: &FollowedMoment) -> Result<Vec<f64>, PostprocessingError> {
        let reference = self.own(&axis.reference)?;
        let found = self.own(&axis.amplitude)?;
        let error = |(reference, found): (&f64, &f64)| {
            if *reference > 0.0 { self.settings.factor * reference - found } else { f64::NAN }
        };
        Ok(reference.iter().zip(found).map(error).collect())
    }

    /// True frequency (Hz) at each row, where it is known.
    fn true_frequency(&self) -> Result<Option<Vec<f64>>, PostprocessingError> {
        let Some(CirclingDisk { strouhal: [first, last], sweep, .. }) = self.disk else {
            return Ok(None);
        };
        let at = |time: &f64| {
            let share = if sweep > 0.0 { (time / sweep).clamp(0.0, 1.0) } else { 1.0 };
            (first + (last - first) * share) * self.of_one
        };
        Ok(Some(self.times()?.iter().map(at).collect()))
    }

    fn numbers(&self) -> Result<MeanderingNumbers, PostprocessingError> {
        let axis = |followed: &FollowedMoment| {
            let errors = known(&self.amplitude_error(followed)?);
            let reference = self.own(&followed.reference)?;
            let reference: Vec<f64> =
                reference.iter().copied().filter(|reference| *reference > 0.0).collect();
            let [bias, bias_deviation] = moments_of(self.own(&followed.offset)?);
            let [amplitude_error, deviation] = moments_of(&errors);
            Ok::<_, PostprocessingError>(MeanderingAxisNumbers {
                amplitude_error,
                amplitude_rms: amplitude_error.hypot(deviation),
                target: self.settings.factor * moments_of(&reference)[0],
                bias,
                bias_deviation,
            })
        };
        let [tilt, yaw] = MEAND_AXES;
        let frequencies: Vec<f64> = self.own(&MEAND_RATE)?.iter().map(|rate| rate / TAU).collect();
        let error = self.true_frequency()?.map(|truth| {
            let squares = frequencies.iter().zip(&truth).map(|(a, b)| (a / b - 1.0).powi(2));
            (squares.sum::<f64>() / truth.len() as f64).sqrt()
        });
        Ok(MeanderingNumbers {
            run: self.run.to_owned(),
            turbine: self.turbine.to_owned(),
            factor: (!self.monitors()).then_some(self.settings.factor),
            axes: [axis(&tilt)?, axis(&yaw)?],
            frequency: moments_of(&frequencies),
            frequency_error: error,
        })
    }
}

fn known(values: &[f64]) -> Vec<f64> {
    values.iter().copied().filter(|value| value.is_finite()).collect()
}

/// Mean and standard deviation; not numbers where there are no values.
fn moments_of(values: &[f64]) -> [f64; 2] {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n;
    [mean, square.sqrt()]
}
