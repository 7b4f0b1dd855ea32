//! Spectra of the wind where a turbine would stand, with a helix and without (figure 3 of van Vondelen et
//! al., 2025), and of the tilt moment of a turbine that looks for a helix (their figure 5).

use super::{analysed, control_of, density, helix_in, line};
use crate::PostprocessingError;
use crate::error::case_in;
use crate::phase::{column, moments, tells};
use analysis::spectra::Spectrum;
use basis::channels::LINES;
use control::excitation_rate;
use control::phase_sync::PhaseSyncSettings;
use estimation::helix::tuning::high_passed_variance;
use farm::case::Case;
use formats::records::{self, RunRecords, StudyRecords};
use report::{DensityFigure, DensityRow, Signals, SpectrumLine};
use std::f64::consts::TAU;
use std::path::Path;

/// Excitation frequencies that a figure shows (–).
const SHOWN: f64 = 6.0;
/// Where measurement noise is taken to begin, over the excitation rate (–): that of the tuning.
const NOISE_CORNER: f64 = 2.0;
/// Components of the wind, with their labels.
const COMPONENTS: [(&str, &str); 3] =
    [("average", "average ((m/s)²/Hz)"), ("tilt", "tilt ((m/s)²/Hz)"), ("yaw", "yaw ((m/s)²/Hz)")];
/// Meganewton metres of a newton metre.
const MEGA: f64 = 1e-6;

/// A spectrum in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectraLine {
    /// Run.
    pub run: String,
    /// What it is of: `average`, `tilt`, `yaw` of the wind, or `tilt moment`.
    pub of: &'static str,
    /// Whether a turbine upstream pitched a helix.
    pub has_helix: bool,
    /// Density at the excitation frequency (unit²/Hz).
    pub peak: f64,
    /// That over the geometric mean of the densities at two thirds and three halves of that frequency (–):
    /// how far the helix stands out.
    pub stands_out: f64,
    /// Standard deviation of what lies above twice the excitation frequency (MN m), for a moment: R of
    /// Algorithm 1 is its square for one blade. Absent for a wind.
    pub noise: Option<f64>,
}

/// Spectra at one turbine or its place.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectraAnswer {
    /// Turbine.
    pub turbine: String,
    /// Excitation frequency (Hz).
    pub frequency: f64,
    /// Line by line.
    pub lines: Vec<SpectraLine>,
    /// Density of the wind; absent where no run kept it.
    pub winds: Option<DensityFigure>,
    /// Density of the tilt moment; absent where the turbine looks for no helix.
    pub moments: Option<DensityFigure>,
}

impl SpectraAnswer {
    /// As a part of a report.
    pub(crate) fn signals(&self) -> Signals {
        Signals {
            title: format!("Spectra at {}", self.turbine),
            lead: "Power spectral densities, whose area is the variance, by Welch's method."
                .to_owned(),
            densities: self.winds.iter().chain(&self.moments).cloned().collect(),
            ..Signals::default()
        }
    }
}

/// Spectra in the study in `directory`: turbine by turbine, of the wind where it would stand and of its tilt
/// moment.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, and [`PostprocessingError::NoSignals`] where none
/// of its runs kept either.
pub fn spectra(directory: &Path) -> Result<Vec<SpectraAnswer>, PostprocessingError> {
    let study = records::read_study(directory)?;
    let case = case_in(directory, &study.case_text)?;
    let found = of_study(&case, &study)?;
    if found.is_empty() {
        return Err(PostprocessingError::NoSignals {
            directory: directory.to_owned(),
            lacking: "kept the wind at the place of a turbine, or has one that looks for a helix, over eight periods of a helix",
            fix: "give the case output.lines_at = [\"T2\"] and a run without T2, or a turbine kind = \"phase-sync\", and a helix upstream",
        });
    }
    Ok(found)
}

/// The same in `records` of `case`; nothing where there is none.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be analysed.
pub(super) fn of_study(
    case: &Case,
    records: &StudyRecords,
) -> Result<Vec<SpectraAnswer>, PostprocessingError> {
    let mut found = Vec::new();
    for (index, turbine) in case.turbines.iter().enumerate() {
        let Some(frequency) = excitation(case, records, index) else { continue };
        let place = Place { case, records, index, name: &turbine.name, frequency };
        let (winds, mut lines) = place.winds()?;
        let (moments, of_moments) = place.moments()?;
        lines.extend(of_moments);
        if winds.is_some() || moments.is_some() {
            let turbine = turbine.name.clone();
            found.push(SpectraAnswer { turbine, frequency, lines, winds, moments });
        }
    }
    Ok(found)
}

/// Frequency (Hz) of the first helix that meets turbine `index` in a run.
fn excitation(case: &Case, records: &StudyRecords, index: usize) -> Option<f64> {
    let upstream = |run: &RunRecords| helix_in(case, run, index);
    let (run, (_, strouhal)) = records.runs.iter().find_map(|run| Some((run, upstream(run)?)))?;
    let diameter = run.summary.conditions.rotor_diameter;
    Some(excitation_rate(strouhal, case.wind.speed, diameter) / TAU)
}

/// A turbine, or where it would stand.
struct Place<'a> {
    case: &'a Case,
    records: &'a StudyRecords,
    index: usize,
    name: &'a str,
    /// Excitation frequency (Hz).
    frequency: f64,
}

impl Place<'_> {
    /// Whether a helix comes from upstream in `run`.
    fn has_helix(&self, run: &RunRecords) -> bool {
        helix_in(self.case, run, self.index).is_some()
    }

    /// Runs for which `wanted`, with their colours: those without a helix first.
    fn runs(&self, wanted: impl Fn(&RunRecords) -> bool) -> Vec<(usize, &RunRecords)> {
        let mut runs: Vec<&RunRecords> =
            self.records.runs.iter().filter(|run| wanted(run)).collect();
        runs.sort_by_key(|run| self.has_helix(run));
        runs.into_iter().enumerate().collect()
    }

    /// The wind where the turbine would stand, in runs without it.
    fn winds(&self) -> Result<(Option<DensityFigure>, Vec<SpectraLine>), PostprocessingError> {
        let mut rows =
            COMPONENTS.map(|(_, label)| DensityRow { label: label.to_owned(), lines: Vec::new() });
        let mut numbers = Vec::new();
        let kept = |run: &RunRecords| run.series.names().contains(&LINES[0].at(self.name));
        for (colour, run) in self.runs(kept) {
            let series = run.series.read(|channel| tells(self.name, channel))?;
            let Some((first, _, interval)) = analysed(&series, self.case.time.spin_up) else {
                continue;
            };
            for (((of, _), part), row) in COMPONENTS.into_iter().zip(LINES).zip(&mut rows) {
                let samples = &column(&series, &part.at(self.name))?[first..];
                let Some(found) = density(samples, interval, self.frequency)? else { continue };
                numbers.push(self.number(run, of, &found, None));
                row.lines.push(line(&run.manifest.run, colour, found));
            }
        }
        let title = format!("Spectra of the wind at {}'s place", self.name);
        let caption = "The wind along 36 lines over the disc in runs without the turbine, not filtered. A helix from upstream stands out \
                       at its own frequency in tilt and yaw.";
        let figure = self.figure("wind-spectra", title, caption.to_owned(), &[], rows.into());
        Ok((figure, numbers))
    }

    /// The tilt moment of the turbine in runs in which it looks for a helix.
    fn moments(&self) -> Result<(Option<DensityFigure>, Vec<SpectraLine>), PostprocessingError> {
        let seeks = |run: &RunRecords| {
            let control = control_of(self.case, run).get(self.index);
            control.is_some_and(|control| PhaseSyncSettings::of(control).is_some())
        };
        let mut row = DensityRow { label: "tilt moment ((MN m)²/Hz)".into(), lines: Vec::new() };
        let mut numbers = Vec::new();
        let corner = NOISE_CORNER * self.frequency;
        for (colour, run) in self.runs(seeks) {
            let series = run.series.read(|channel| tells(self.name, channel))?;
            let Some((first, _, interval)) = analysed(&series, self.case.time.spin_up) else {
                continue;
            };
            let tilt: Vec<f64> = moments(&series, self.name)?[first..]
                .iter()
                .map(|moment| MEGA * moment.tilt)
                .collect();
            let Some(found) = density(&tilt, interval, self.frequency)? else { continue };
            let variance = high_passed_variance(&tilt, interval, TAU * corner).ok();
            numbers.push(self.number(run, "tilt moment", &found, variance.map(f64::sqrt)));
            row.lines.push(line(&run.manifest.run, colour, found));
        }
        let title = format!("Spectrum of the tilt moment of {}", self.name);
        let caption = "What lies above twice the helix's frequency is taken for measurement noise: its variance gives R of the phase \
                       estimator (`wakemix analyse tune`).";
        let mark = [(corner, "noise from here on".to_owned())];
        let figure =
            self.figure("tilt-moment-density", title, caption.to_owned(), &mark, vec![row]);
        Ok((figure, numbers))
    }

    /// `found` in numbers.
    fn number(
        &self,
        run: &RunRecords,
        of: &'static str,
        found: &Spectrum,
        noise: Option<f64>,
    ) -> SpectraLine {
        let at = |frequency: f64| {
            let place = (frequency / found.frequency_step).round() as usize;
            found.values.get(place).copied().unwrap_or(f64::NAN)
        };
        let peak = at(self.frequency);
        let beside = (at(self.frequency / 1.5) * at(1.5 * self.frequency)).sqrt();
        SpectraLine {
            run: run.manifest.run.clone(),
            of,
            has_helix: self.has_helix(run),
            peak,
            stands_out: peak / beside,
            noise,
        }
    }

    /// `rows` as a figure with the excitation and `marks` in it; nothing where they hold no line.
    fn figure(
        &self,
        name: &str,
        title: String,
        caption: String,
        marks: &[(f64, String)],
        rows: Vec<DensityRow>,
    ) -> Option<DensityFigure> {
        let lines = rows.iter().flat_map(|row| &row.lines);
        let highest = lines.map(SpectrumLine::last_frequency).fold(0.0, f64::max);
        let highest = highest.min(SHOWN * self.frequency);
        let mut all = vec![(self.frequency, "helix".to_owned())];
        all.extend_from_slice(marks);
        (highest > 0.0).then(|| DensityFigure {
            name: format!("{name}-{}", self.name),
            title,
            caption,
            lowest_frequency: None,
            highest_frequency: highest,
            marks: all,
            band: None,
            rows,
        })
    }
}
