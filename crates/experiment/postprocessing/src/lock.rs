//! What a meandering loop finds in the records of a run, replayed: how well it would lock, on any turbine.

use crate::PostprocessingError;
use crate::error::{InRecords, case_of};
use crate::phase::query::folder_of;
use crate::phase::{column, moments, tells};
use analysis::AnalysisError;
use analysis::phase::uniform_interval;
use basis::channels::TIME;
use basis::records::Series;
use basis::{FixedFrame, Sense};
use control::ControlError;
use control::excitation_rate;
use control::meandering::{Leader, MeanderingError, MeanderingSettings};
use estimation::phase_locked::{PhaseLockedSettings, TwoAxisLoop, TwoAxisSettings};
use farm::assemble::AssemblyError;
use farm::case::{Case, Control};
use formats::records;
use std::path::PathBuf;

/// Strouhal numbers (–) and sense of a loop without other settings: the defaults of `kind = "meandering"`.
const STROUHAL: [f64; 2] = [0.15, 0.3];
const SENSE: Sense = Sense::Clockwise;

/// A question to the records of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LockQuestion {
    /// Folder of the run.
    pub run: PathBuf,
    /// Turbine whose blades are listened to; each that is there when absent.
    pub turbine: Option<String>,
    /// Lowest and highest Strouhal number that is followed (–); the turbine's own, or the case file's
    /// default, when absent.
    pub strouhal: [Option<f64>; 2],
    /// Way the loads circle; the turbine's own, or the case file's default, when absent.
    pub sense: Option<Sense>,
    /// First time that counts (s); the end of the spin-up when absent.
    pub from: Option<f64>,
}

/// What a loop found on one turbine.
#[derive(Clone, Debug, PartialEq)]
pub struct LockAnswer {
    /// Turbine.
    pub turbine: String,
    /// Way the loads were taken to circle.
    pub sense: Sense,
    /// Lowest and highest Strouhal number that was followed (–).
    pub strouhal_range: [f64; 2],
    /// First and last time that count (s).
    pub times: [f64; 2],
    /// Root mean square of the phase error over the last period (rad): its median over the time that counts.
    pub phase_error: f64,
    /// Share of the time locked (–).
    pub locked_share: f64,
    /// Mean estimated Strouhal number (–).
    pub strouhal: f64,
}

/// Runs a loop over the blade moments of each turbine that `question` asks for, as they were recorded: what a
/// turbine's own pitch did to them is among them.
///
/// # Errors
/// [`PostprocessingError`] for records that cannot be read, lack a channel or have gaps, and for Strouhal
/// numbers that no loop follows.
pub fn lock(question: &LockQuestion) -> Result<Vec<LockAnswer>, PostprocessingError> {
    let folder = folder_of(&question.run);
    let manifest = records::read_manifest(&folder)?;
    let case = case_of(&folder, &manifest)?;
    let control = &case.runs[manifest.run_index].control;
    let is_asked = |&index: &usize| {
        let name = &case.turbines[index].name;
        let is_named = question.turbine.as_ref().is_none_or(|requested| requested == name);
        is_named && control[index].is_there()
    };
    let turbines: Vec<usize> = (0..case.turbines.len()).filter(is_asked).collect();
    if turbines.is_empty() {
        return Err(PostprocessingError::NobodySeeks {
            run: manifest.run.clone(),
            requested: question.turbine.clone(),
            turbines: case.turbines.iter().map(|turbine| turbine.name.clone()).collect(),
            folder: folder.path().to_owned(),
        });
    }
    let summary = records::read_summary(&folder)?;
    let wanted =
        |channel: &str| turbines.iter().any(|&index| tells(&case.turbines[index].name, channel));
    let series = records::read_series(&folder.series_path(), wanted)?;
    let diameter = summary.conditions.rotor_diameter;
    answers(question, &case, control, &turbines, &series, diameter)
        .in_records(&folder.series_path())
}

/// What the loops of `question` find in `series` on the `turbines` of `case`, which are under `control`; the
/// first rotor has this `diameter` (m).
fn answers(
    question: &LockQuestion,
    case: &Case,
    control: &[Control],
    turbines: &[usize],
    series: &Series,
    diameter: f64,
) -> Result<Vec<LockAnswer>, PostprocessingError> {
    let times = column(series, &TIME.name)?;
    let rate_of_one = excitation_rate(1.0, case.wind.speed, diameter);
    let from = question.from.unwrap_or(case.time.spin_up);
    let mut answers = Vec::with_capacity(turbines.len());
    for &index in turbines {
        let own = MeanderingSettings::of(&control[index]);
        let [low, high] = own.map_or(STROUHAL, |own| own.strouhal);
        let [asked_low, asked_high] = question.strouhal;
        let range = [asked_low.unwrap_or(low), asked_high.unwrap_or(high)];
        let sense = question.sense.unwrap_or(own.map_or(SENSE, |own| own.sense));
        let settings = TwoAxisSettings {
            signal: PhaseLockedSettings::between(range.map(|strouhal| strouhal * rate_of_one)),
            sense,
            leader: own.map_or(Leader::Both, |own| own.leader),
        };
        let turbine = case.turbines[index].name.clone();
        let tracked = track(times, &moments(series, &turbine)?, &settings, from)?;
        answers.push(LockAnswer {
            turbine,
            sense,
            strouhal_range: range,
            times: tracked.times,
            phase_error: tracked.phase_error,
            locked_share: tracked.locked_share,
            strouhal: tracked.rate / rate_of_one,
        });
    }
    Ok(answers)
}

/// What a loop found in a record.
struct Tracked {
    /// First and last time that count (s).
    times: [f64; 2],
    /// Median root mean square of the phase error (rad).
    phase_error: f64,
    /// Share of the time locked (–).
    locked_share: f64,
    /// Mean estimated rate (rad/s).
    rate: f64,
}

/// Runs a loop of `settings` over `moments` (N m, fixed frame) at `times` (s); what it finds counts from the
/// time `from` (s) on.
fn track(
    times: &[f64],
    moments: &[FixedFrame],
    settings: &TwoAxisSettings,
    from: f64,
) -> Result<Tracked, PostprocessingError> {
    let interval = uniform_interval(times)?;
    let mut follower = TwoAxisLoop::new(settings, interval)
        .map_err(MeanderingError::from)
        .map_err(ControlError::from)
        .map_err(AssemblyError::from)?;
    let (mut errors, mut rates, mut n_locked) = (Vec::new(), 0.0, 0_usize);
    for (time, moments) in times.iter().zip(moments) {
        let estimate = follower.follow(interval, *moments);
        if *time >= from {
            errors.push(follower.phase_error());
            rates += estimate.rate;
            n_locked += usize::from(estimate.locked);
        }
    }
    if errors.is_empty() {
        return Err(AnalysisError::TooShort { n_samples: 0, needed: 1 }.into());
    }
    let n = errors.len();
    errors.sort_by(f64::total_cmp);
    Ok(Tracked {
        times: [times[times.len() - n], times[times.len() - 1]],
        phase_error: 0.5 * (errors[(n - 1) / 2] + errors[n / 2]),
        locked_share: n_locked as f64 / n as f64,
        rate: rates / n as f64,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Time between rows (s), and rate of the band's middle (rad/s).
    const INTERVAL: f64 = 0.5;
    const RATE: f64 = 0.05;

    /// What a loop for 0.6 to 1.4 of [`RATE`] finds in moments that circle with it, and with `disturbance`
    /// (–) as much besides at four fifths of it.
    fn tracked(disturbance: f64) -> Tracked {
        let settings = TwoAxisSettings {
            signal: PhaseLockedSettings::between([0.6 * RATE, 1.4 * RATE]),
            sense: SENSE,
            leader: Leader::Both,
        };
        let times: Vec<f64> = (0..8000).map(|row| INTERVAL * f64::from(row)).collect();
        let moments: Vec<FixedFrame> = times
            .iter()
            .map(|time| {
                let angles = [RATE * time, 0.8 * RATE * time];
                let sum = |lead: f64| {
                    let [wave, other] = angles.map(|angle| (angle + lead).sin());
                    4e6 * (wave + disturbance * other)
                };
                FixedFrame { average: 3e7, tilt: sum(0.0), yaw: sum(SENSE.yaw_lead()) }
            })
            .collect();
        track(&times, &moments, &settings, 2000.0).expect("a sound record")
    }

    #[test]
    fn a_pure_circle_is_locked_to_and_a_second_wave_makes_the_phase_err() {
        let pure = tracked(0.0);
        assert_eq!(pure.times, [2000.0, 3999.5]);
        assert_eq!(pure.locked_share, 1.0);
        assert!((pure.rate / RATE - 1.0).abs() < 1e-4, "{} rad/s", pure.rate);
        assert!(pure.phase_error < 1e-3, "{} rad", pure.phase_error);
        // The phase of the sum swings by 0.3 rad about that of the wave; a loop follows part of it and keeps
        // its lock.
        let disturbed = tracked(0.3);
        assert!((0.01..0.7).contains(&disturbed.phase_error), "{} rad", disturbed.phase_error);
    }

    #[test]
    fn a_time_after_the_record_is_too_late() {
        let settings = TwoAxisSettings {
            signal: PhaseLockedSettings::between([0.6 * RATE, 1.4 * RATE]),
            sense: SENSE,
            leader: Leader::Both,
        };
        let found = track(&[0.0, 0.5], &[FixedFrame::default(); 2], &settings, 1.0);
        assert!(matches!(
            found,
            Err(PostprocessingError::Analysis { source: AnalysisError::TooShort { .. }, .. })
        ));
    }
}
