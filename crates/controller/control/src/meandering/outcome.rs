//! What a turbine found of meandering, and what became of it: from its records.

use super::MeanderingSettings;
use crate::kind::Control;
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::channels::{
    AZIMUTH, FollowedMoment, MEAND_AXES, MEAND_LOCK, MEAND_RATE, ROOT_MYC, TIME,
};
use basis::mbc::to_fixed_frame;
use basis::records::{MeanderingAxis, MeanderingSummary};
use basis::{Channel, FixedFrame, PerBlade};
use std::f64::consts::TAU;

/// Share of the time without a lock beyond which a reader must know (–).
const UNLOCKED_SHARE: f64 = 0.02;
/// Periods of the oscillation that tell an amplitude (–).
const FEWEST_PERIODS: f64 = 2.0;

/// Channels that [`outcome`] reads of a turbine of `n_blades` blades.
pub(super) fn channels(n_blades: usize) -> Vec<Channel> {
    let [tilt, yaw] = MEAND_AXES;
    let own = [TIME, AZIMUTH, MEAND_LOCK, MEAND_RATE];
    let axes = [tilt.phase, yaw.phase, tilt.reference, yaw.reference];
    let flap = (1..=n_blades).map(|blade| ROOT_MYC.of_blade(blade));
    own.into_iter().chain(axes).chain(flap).collect()
}

/// What the turbine of `record` found of meandering under `control`.
///
/// # Errors
/// [`MissingChannel`].
pub(super) fn outcome(
    control: &Control,
    record: &dyn TurbineRecord,
) -> Result<Outcome, MissingChannel> {
    let Some(given) = MeanderingSettings::of(control) else { return Ok(Outcome::default()) };
    let found = followed(record, given.start)?;
    let acts = given.amplitude != 0.0 && given.fallback;
    let warning = || {
        format!(
            " was locked to the wake's motion {:.0} % of the time, and added no pitch without lock",
            100.0 * found.locked_share
        )
    };
    let is_lost = found.locked_share < 1.0 - UNLOCKED_SHARE;
    let warnings = Vec::from_iter((acts && is_lost).then(warning));
    Ok(Outcome { meandering: Some(found), warnings, ..Outcome::default() })
}

/// What the turbine of `record` followed, under control from `start` (s) on.
///
/// Amplitudes are those of the moments themselves, correlated with the phase that the turbine estimated: what
/// drifts away from that phase does not count, so that they lie somewhat below the loop's own estimate where
/// it follows slowly.
///
/// # Errors
/// [`MissingChannel`].
fn followed(record: &dyn TurbineRecord, start: f64) -> Result<MeanderingSummary, MissingChannel> {
    let (lock, rate) = (record.column(&MEAND_LOCK)?, record.column(&MEAND_RATE)?);
    let times = record.column(&TIME)?;
    let locked: Vec<usize> = (0..lock.len()).filter(|&row| lock[row] > 0.5).collect();
    let counted: Vec<usize> = locked.iter().copied().filter(|&row| times[row] >= start).collect();
    let turned = record.interval() * counted.iter().map(|&row| rate[row]).sum::<f64>();
    let is_known = turned >= TAU * FEWEST_PERIODS;
    let moments = moments(record, &counted)?;
    let [tilt, yaw] = MEAND_AXES;
    let axis = |followed: &FollowedMoment, of: fn(&FixedFrame) -> f64| {
        let phase = record.column(&followed.phase)?;
        let reference = record.column(&followed.reference)?;
        let pick = |column: &[f64]| counted.iter().map(|&row| column[row]).collect::<Vec<_>>();
        let moment: Vec<f64> = moments.iter().map(of).collect();
        let found = || axis_of(&moment, &pick(phase), &pick(reference));
        Ok::<_, MissingChannel>(is_known.then(found))
    };
    let rates: Vec<f64> = locked.iter().map(|&row| rate[row] / TAU).collect();
    Ok(MeanderingSummary {
        locked_share: locked.len() as f64 / lock.len().max(1) as f64,
        frequency_hz: mean(&rates),
        tilt: axis(&tilt, |moments| moments.tilt)?,
        yaw: axis(&yaw, |moments| moments.yaw)?,
    })
}

/// Moments of the blades of `record` in the fixed frame (N m) at the `rows` of the analysed time.
fn moments(record: &dyn TurbineRecord, rows: &[usize]) -> Result<Vec<FixedFrame>, MissingChannel> {
    let azimuth = record.column(&AZIMUTH)?;
    let n_blades = record.n_blades();
    let flap = (1..=n_blades)
        .map(|blade| record.column(&ROOT_MYC.of_blade(blade)))
        .collect::<Result<Vec<&[f64]>, MissingChannel>>()?;
    let at = |&row: &usize| {
        to_fixed_frame(azimuth[row], &PerBlade::from_fn(n_blades, |blade| flap[blade][row]))
    };
    Ok(rows.iter().map(at).collect())
}

/// The part of `moment` (N m) in step with `phase` (rad), against the amplitudes `reference` (N m), zero
/// while not known.
fn axis_of(moment: &[f64], phase: &[f64], reference: &[f64]) -> MeanderingAxis {
    let steady = mean(moment).unwrap_or(0.0);
    let scale = 2.0 / moment.len() as f64;
    let (mut with, mut earlier) = (0.0, 0.0);
    for (moment, phase) in moment.iter().zip(phase) {
        let (sine, cosine) = phase.sin_cos();
        with += scale * (moment - steady) * sine;
        earlier += scale * (moment - steady) * cosine;
    }
    let amplitude = with.hypot(earlier);
    let known: Vec<f64> = reference.iter().copied().filter(|&reference| reference > 0.0).collect();
    let reference = mean(&known);
    MeanderingAxis { amplitude, reference, factor: reference.map(|known| amplitude / known) }
}

/// None of nothing.
fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::meandering::MEANDERING;
    use basis::mbc::to_blades;
    use basis::records::Series;

    /// Time between rows (s).
    const INTERVAL: f64 = 0.5;
    /// Rate of the oscillation (rad/s): ten periods in the last half of the record.
    const RATE: f64 = TAU / 100.0;

    fn control() -> Control {
        let values =
            [("factor", 1.5.into()), ("amplitude_deg", 4.0.into()), ("start", 1000.0.into())];
        Control::new(&MEANDERING, &values).expect("such control can be")
    }

    /// 2000 s, locked from `locked_from` (s) on; 3 MN m in tilt and 1 MN m in yaw once control starts, ten
    /// times as much before.
    fn series(locked_from: f64) -> Series {
        let times: Vec<f64> = (0..4000).map(|row| INTERVAL * f64::from(row)).collect();
        let azimuth = |time: f64| 0.6 * time;
        let blade = |time: f64, blade: usize| {
            let scale = if time < 1000.0 { 1e7 } else { 1e6 };
            let fixed = FixedFrame {
                average: 3e7,
                tilt: 2e6 + 3.0 * scale * (RATE * time).sin(),
                yaw: -1e6 + scale * (RATE * time + 1.0).sin(),
            };
            to_blades(azimuth(time), fixed, 3)[blade]
        };
        let is_locked = |time: f64| time >= locked_from;
        let columns: [(&str, &dyn Fn(f64) -> f64); 11] = [
            ("Time", &|time| time),
            ("Azimuth", &azimuth),
            ("RootMyc1", &|time| blade(time, 0)),
            ("RootMyc2", &|time| blade(time, 1)),
            ("RootMyc3", &|time| blade(time, 2)),
            ("MeandLock", &|time| f64::from(u8::from(is_locked(time)))),
            ("MeandRate", &|time| if is_locked(time) { RATE } else { 0.0 }),
            ("MeandTiltPhase", &|time| (RATE * time).rem_euclid(TAU)),
            ("MeandYawPhase", &|time| (RATE * time + 0.7).rem_euclid(TAU)),
            ("MeandTiltRef", &|time| if time < 1200.0 { 0.0 } else { 2e6 }),
            ("MeandYawRef", &|_| 0.0),
        ];
        Series {
            names: columns.iter().map(|(name, _)| (*name).to_owned()).collect(),
            columns: columns
                .iter()
                .map(|(_, of)| times.iter().map(|time| of(*time)).collect())
                .collect(),
        }
    }

    struct Record(Series);

    impl TurbineRecord for Record {
        fn column(&self, channel: &Channel) -> Result<&[f64], MissingChannel> {
            let column = self.0.column(&channel.name);
            column.ok_or_else(|| MissingChannel(channel.name.clone().into_owned()))
        }

        fn interval(&self) -> f64 {
            INTERVAL
        }

        fn n_blades(&self) -> usize {
            3
        }
    }

    fn found(series: Series) -> MeanderingSummary {
        let outcome = outcome(&control(), &Record(series)).expect("all channels");
        outcome.meandering.expect("meandering")
    }

    #[test]
    fn amplitudes_are_those_of_the_moments_while_it_acts() {
        let found = found(series(500.0));
        assert_eq!(found.locked_share, 0.75);
        assert!((found.frequency_hz.expect("it locked") - 0.01).abs() < 1e-12);
        let (tilt, yaw) = (found.tilt.expect("ten periods"), found.yaw.expect("ten periods"));
        assert!((tilt.amplitude - 3e6).abs() < 1.0, "{tilt:?}");
        assert!((tilt.factor.expect("a reference") - 1.5).abs() < 1e-6, "{tilt:?}");
        // An estimated phase that is off by a constant tells the same amplitude.
        assert!((yaw.amplitude - 1e6).abs() < 1.0, "{yaw:?}");
        assert_eq!((yaw.reference, yaw.factor), (None, None));
    }

    #[test]
    fn what_was_hardly_followed_has_no_amplitude() {
        let never = found(series(f64::INFINITY));
        assert_eq!((never.locked_share, never.frequency_hz), (0.0, None));
        assert_eq!((never.tilt, never.yaw), (None, None));
        // Locked for a period and a half.
        let late = found(series(1850.0));
        assert!(late.frequency_hz.is_some() && late.tilt.is_none() && late.yaw.is_none());
    }

    #[test]
    fn what_it_is_made_of_is_all_that_it_needs() {
        let mut names = series(500.0).names;
        let mut wanted: Vec<_> = channels(3).into_iter().map(|one| one.name.into_owned()).collect();
        names.sort();
        wanted.sort();
        assert_eq!(names, wanted);
    }

    #[test]
    fn a_turbine_under_other_control_tells_nothing() {
        let reported = outcome(&Control::baseline(), &Record(series(0.0)));
        assert_eq!(reported, Ok(Outcome::default()));
    }
}
