//! Damage-equivalent loads and standard deviations of the moments of a run, their change, and what its
//! pitching cost.

use crate::StudyError;
use crate::columns::Analysed;
use analysis::AnalysisError;
use analysis::fatigue::{
    BEARING_SLOPE, N_BEARING_POSITIONS, PitchBearing, PitchTravel, REFERENCE_FREQUENCY,
    damage_equivalent_load,
};
use analysis::statistics::{change, standard_deviation};
use basis::channels::{BLD_PITCH, ROOT_MXB, ROOT_MYB, Unit};
use basis::records::{BearingLoad, Load, LoadKind, PitchDuty};

/// Wöhler's exponent of composite blades (–).
const BLADE_SLOPE: f64 = 10.0;
/// Wöhler's exponent of steel: shaft, tower (–).
const STEEL_SLOPE: f64 = 4.0;

/// Moments that a summary tells of.
const MOMENTS: [&str; 14] = [
    "RootMxc1",
    "RootMyc1",
    "RootMzc1",
    "RootMxb1",
    "RootMyb1",
    "RotTorq",
    "LSSTipMys",
    "LSSTipMzs",
    "YawBrMxp",
    "YawBrMyp",
    "YawBrMzp",
    "TwrBsMxt",
    "TwrBsMyt",
    "TwrBsMzt",
];
/// The unit in which it tells of them, in words of its own.
const UNIT: (Unit, &str) = (Unit::KilonewtonMetre, "kN m");

/// A moment of which a summary tells.
pub(crate) struct Moment {
    /// Its name in the series.
    name: String,
    /// The same without turbine.
    channel: &'static str,
}

impl Moment {
    /// What its figures are made of.
    pub(crate) fn part(&self) -> Vec<String> {
        vec![self.name.clone()]
    }
}

/// Moments of `turbine` among the channels called `names`.
pub(crate) fn moments(names: &[String], turbine: &str) -> Vec<Moment> {
    let moment = |name: &String| {
        let rest = name.strip_prefix(turbine)?.strip_prefix('.')?;
        let channel = MOMENTS.into_iter().find(|channel| *channel == rest)?;
        Some(Moment { name: name.clone(), channel })
    };
    names.iter().filter_map(moment).collect()
}

/// Damage-equivalent load and standard deviation of `moment` (kN m), compared with nothing; the former of two
/// samples or more.
///
/// Slopes as van der Hoek et al., section 2.4: 10 for the blade's composite, 4 for steel.
pub(crate) fn loads(moment: &Moment, analysed: &Analysed<'_>) -> Result<Vec<Load>, StudyError> {
    let load = |kind, value| Load {
        channel: moment.channel.to_owned(),
        unit: UNIT.1.to_owned(),
        kind,
        value: UNIT.0.of_si(value),
        change: None,
    };
    let mut loads = Vec::new();
    let samples = analysed.column(&moment.name)?;
    if samples.len() >= 2 {
        let kind = damage_equivalent(moment.channel);
        loads.push(load(kind, figure(kind, samples, analysed.interval)?));
    }
    let deviation = analysed.statistic(&moment.name)?.standard_deviation;
    loads.push(load(LoadKind::Deviation, deviation));
    Ok(loads)
}

/// On return the `loads` of `moment` hold their change from `compared` to `analysed`; none where the compared
/// run does not keep that moment.
pub(crate) fn compare(
    loads: &mut [Load],
    moment: &Moment,
    analysed: &Analysed<'_>,
    compared: &Analysed<'_>,
) -> Result<(), StudyError> {
    let Moment { name, channel } = moment;
    if !compared.has(name) {
        return Ok(());
    }
    let (now, before) = (analysed.column(name)?, compared.column(name)?);
    if now.len() < 2 {
        return Ok(());
    }
    let interval = analysed.interval;
    for load in loads.iter_mut().filter(|load| load.channel == *channel) {
        let of = |samples: &[f64]| figure(load.kind, samples, interval);
        load.change = match change(now, before, interval, analysed.block, of) {
            Ok(change) => Some(change),
            // A moment that rested has no ratio to it.
            Err(AnalysisError::NoReference) => None,
            Err(error) => return Err(error.into()),
        };
    }
    Ok(())
}

/// The damage-equivalent load that is reported of `channel`.
fn damage_equivalent(channel: &str) -> LoadKind {
    let slope = if channel.starts_with("Root") { BLADE_SLOPE } else { STEEL_SLOPE };
    LoadKind::DamageEquivalent { slope, reference_frequency_hz: REFERENCE_FREQUENCY }
}

/// The figure `kind` of `samples` (N m) that lie `interval` (s) apart.
fn figure(kind: LoadKind, samples: &[f64], interval: f64) -> Result<f64, AnalysisError> {
    match kind {
        LoadKind::Deviation => Ok(standard_deviation(samples)),
        LoadKind::DamageEquivalent { slope, reference_frequency_hz } => {
            damage_equivalent_load(samples, interval, slope, reference_frequency_hz)
        }
    }
}

/// What [`pitch_duty`] of `turbine` is made of: pitch of blade 1, flapwise and edgewise moment at its root.
pub(crate) fn duty_channels(turbine: &str) -> [String; 3] {
    [BLD_PITCH, ROOT_MYB, ROOT_MXB].map(|channel| channel.of_blade(1).at(turbine))
}

/// What pitching did to blade 1 of `turbine`, in the blade's own frame; None where the series does not tell.
pub(crate) fn pitch_duty(
    turbine: &str,
    analysed: &Analysed<'_>,
) -> Result<Option<PitchDuty>, StudyError> {
    let names = duty_channels(turbine);
    if names.iter().any(|name| !analysed.has(name)) {
        return Ok(None);
    }
    let [pitch, flapwise, edgewise] = &names;
    let pitch = analysed.column(pitch)?;
    let (flapwise, edgewise) = (analysed.column(flapwise)?, analysed.column(edgewise)?);
    if pitch.len() < 2 {
        return Ok(None);
    }
    let mut travel = PitchTravel::new();
    let mut bearing = PitchBearing::new(BEARING_SLOPE, N_BEARING_POSITIONS)?;
    for ((&pitch, &flapwise), &edgewise) in pitch.iter().zip(flapwise).zip(edgewise) {
        travel.push(pitch)?;
        bearing.push(pitch, flapwise, edgewise)?;
    }
    let interval = analysed.interval;
    let travel = travel.travel(interval)?;
    let duration = (pitch.len() - 1) as f64 * interval;
    let loads = bearing.loads(duration)?;
    Ok(Some(PitchDuty {
        travel_deg: travel.travel.to_degrees(),
        travel_in_ten_minutes_deg: 600.0 * travel.mean_rate.to_degrees(),
        maximum_rate_deg_s: travel.maximum_rate.to_degrees(),
        moving_share: travel.moving_share,
        n_reversals: travel.n_reversals,
        bearing_slope: BEARING_SLOPE,
        bearing_loads: loads
            .iter()
            .map(|at| BearingLoad {
                position_deg: at.position.to_degrees(),
                load_kn_m: UNIT.0.of_si(at.load),
            })
            .collect(),
        sample_interval: interval,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::Series;
    use std::f64::consts::TAU;

    fn series(interval: f64, n: usize) -> Series {
        let pitch = |time: f64| 2f64.to_radians() * (TAU * 0.125 * time).sin();
        let times: Vec<f64> = (0..n).map(|k| interval * k as f64).collect();
        let column = |of: &dyn Fn(f64) -> f64| times.iter().map(|time| of(*time)).collect();
        let names = ["Time", "T1.BldPitch1", "T1.RootMyb1", "T1.RootMxb1"];
        Series {
            names: names.map(str::to_owned).to_vec(),
            columns: vec![times.clone(), column(&pitch), column(&|_| 3e7), column(&|_| 4e7)],
        }
    }

    /// A sine of 2° and 8 s travels the reference, so that the bearing carries its steady moment where it
    /// presses.
    #[test]
    fn a_steady_moment_on_a_bearing_that_travels_the_reference_is_its_load() {
        let series = series(0.01, 6001);
        let analysed = Analysed::whole(&series, 0.01);
        let duty = pitch_duty("T1", &analysed).expect("numbers").expect("all channels");
        assert!((duty.travel_deg - 60.0).abs() < 0.01, "{}", duty.travel_deg);
        assert!((duty.travel_in_ten_minutes_deg - 600.0).abs() < 0.1);
        assert_eq!(duty.bearing_loads.len(), 36);
        for (index, BearingLoad { position_deg, load_kn_m: load }) in
            duty.bearing_loads.iter().enumerate()
        {
            let angle = TAU * index as f64 / 36.0;
            assert!((position_deg.to_radians() - angle).abs() < 1e-12);
            let expected = (3e4 * angle.cos() + 4e4 * angle.sin()).max(0.0);
            assert!((load - expected).abs() < 10.0, "{angle}: {load} {expected}");
        }
        // atan(4/3) is 53°.
        let worst = duty.worst_bearing_load().expect("positions");
        assert!((worst.position_deg - 50.0).abs() < 1e-9);
        assert!((worst.load_kn_m / 5e4 - 1.0).abs() < 0.01);
        assert_eq!((duty.bearing_slope, duty.sample_interval), (3.0, 0.01));
    }

    /// Swings that grow by 20 % and 30 % in two blocks, about another mean; a moment at rest beside them has
    /// no change.
    #[test]
    fn moments_that_swing_further_say_so_with_an_interval() {
        let names = ["Time", "T1.RootMyb1", "T1.TwrBsMyt"];
        let swing = |sizes: [f64; 2], mean: f64| Series {
            names: names.map(str::to_owned).to_vec(),
            columns: vec![
                (0..1200).map(f64::from).collect(),
                sizes.map(|size| [mean + size, mean - size].repeat(300)).concat(),
                vec![mean; 1200],
            ],
        };
        let (series, other) = (swing([1.2, 1.3], 7.0), swing([1.0, 1.0], 3.0));
        fn whole(series: &Series) -> Analysed<'_> {
            Analysed::whole(series, 1.0)
        }
        let moments = moments(&series.names, "T1");
        let compared = |other: &Series| {
            let mut found = Vec::new();
            for moment in &moments {
                let mut own = loads(moment, &whole(&series)).expect("numbers");
                compare(&mut own, moment, &whole(&series), &whole(other)).expect("numbers");
                found.extend(own);
            }
            found
        };
        let found = compared(&other);
        let reported = |load: &Load| (load.channel.clone(), load.kind, load.change.is_some());
        let equivalent = |slope| LoadKind::DamageEquivalent { slope, reference_frequency_hz: 1.0 };
        assert_eq!(
            found.iter().map(reported).collect::<Vec<_>>(),
            [
                ("RootMyb1".to_owned(), equivalent(10.0), true),
                ("RootMyb1".to_owned(), LoadKind::Deviation, true),
                ("TwrBsMyt".to_owned(), equivalent(4.0), false),
                ("TwrBsMyt".to_owned(), LoadKind::Deviation, false),
            ]
        );
        for (change, expected) in found.iter().filter_map(|load| load.change).zip([
            // Half of the cycles of one size, half of the other, on a slope of ten.
            (0.5 * (1.2f64.powi(10) + 1.3f64.powi(10))).powf(0.1) - 1.0,
            (0.5 * (1.2f64.powi(2) + 1.3f64.powi(2))).sqrt() - 1.0,
        ]) {
            assert!((change.mean - expected).abs() < 1e-3, "{change:?} {expected}");
            // t(0.975, 1) · 0.1/2, whatever the slope.
            let half_width = change.half_width_95.expect("two blocks");
            assert!((half_width - 12.706_205 * 0.05).abs() < 1e-6, "{change:?}");
        }
        // A run that keeps no moments is nothing to compare with.
        let none = Series { names: vec!["Time".into()], columns: other.columns[..1].to_vec() };
        assert!(compared(&none).iter().all(|load| load.change.is_none()));
    }

    #[test]
    fn records_without_the_channels_tell_nothing() {
        let mut series = series(0.1, 100);
        assert_eq!(pitch_duty("T2", &Analysed::whole(&series, 0.1)).ok(), Some(None));
        series.columns.iter_mut().for_each(|column| column.truncate(1));
        assert_eq!(pitch_duty("T1", &Analysed::whole(&series, 0.1)).ok(), Some(None));
    }
}
