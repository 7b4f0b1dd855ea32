//! Damage-equivalent loads and standard deviations of the moments of a run, their change, and what its pitching cost.

use crate::StudyError;
use crate::channels::LOADS;
use crate::columns::Analysed;
use analysis::AnalysisError;
use analysis::fatigue::{
    BEARING_SLOPE, N_BEARING_POSITIONS, PitchBearing, PitchTravel, REFERENCE_FREQUENCY,
    damage_equivalent_load, duty_convention,
};
use analysis::statistics::{BLOCK_LENGTH, change, standard_deviation};
use basis::records::{PitchDuty, Statistic};
use std::collections::BTreeMap;

/// Wöhler's exponent of composite blades (–).
const BLADE_SLOPE: f64 = 10.0;
/// Wöhler's exponent of steel: shaft, tower (–).
const STEEL_SLOPE: f64 = 4.0;

/// A moment that is kept of any run.
pub(crate) struct Moment {
    /// Name of its column.
    name: String,
    /// The same without turbine and unit.
    channel: &'static str,
}

impl Moment {
    /// What its figures are made of.
    pub(crate) fn part(&self) -> Vec<String> {
        vec![self.name.clone()]
    }
}

/// Moments of `turbine` among the columns called `names`.
pub(crate) fn moments(names: &[String], turbine: &str) -> Vec<Moment> {
    let moment = |name: &String| {
        let rest = name.strip_prefix(turbine)?.strip_prefix('.')?;
        let rest = rest.strip_suffix("_kN-m")?;
        let channel = LOADS.into_iter().find(|channel| *channel == rest)?;
        Some(Moment { name: name.clone(), channel })
    };
    names.iter().filter_map(moment).collect()
}

/// 1-Hz damage-equivalent load (range, peak to peak) of `moment`, with its key in a summary: channel, slope and unit.
///
/// Slopes as van der Hoek et al., section 2.4: 10 for the blade's composite, 4 for steel.
pub(crate) fn damage_equivalent(
    moment: &Moment,
    analysed: &Analysed<'_>,
) -> Result<Option<(String, f64)>, StudyError> {
    let samples = analysed.column(&moment.name)?;
    if samples.len() < 2 {
        return Ok(None);
    }
    let (key, of) = equivalent_load(moment.channel, analysed.interval);
    Ok(Some((key, of(samples)?)))
}

/// Standard deviation of `moment` (kN m), with its key in a summary.
pub(crate) fn deviation(
    moment: &Moment,
    analysed: &Analysed<'_>,
) -> Result<(String, f64), StudyError> {
    let deviation = analysed.statistic(&moment.name)?.standard_deviation;
    Ok((deviation_key(moment.channel), deviation))
}

/// Changes of both from `compared` to `analysed` by the same keys; none where the compared run does not keep `moment`.
pub(crate) fn changes(
    moment: &Moment,
    analysed: &Analysed<'_>,
    compared: &Analysed<'_>,
) -> Result<BTreeMap<String, Statistic>, StudyError> {
    let mut changes = BTreeMap::new();
    let Moment { name, channel } = moment;
    if !compared.has(name) {
        return Ok(changes);
    }
    let (now, before) = (analysed.column(name)?, compared.column(name)?);
    if now.len() < 2 {
        return Ok(changes);
    }
    let interval = analysed.interval;
    let (key, load) = equivalent_load(channel, interval);
    let deviation = |samples: &[f64]| Ok(standard_deviation(samples));
    let found = [
        (key, change(now, before, interval, BLOCK_LENGTH, load)),
        (deviation_key(channel), change(now, before, interval, BLOCK_LENGTH, deviation)),
    ];
    for (key, change) in found {
        match change {
            Ok(change) => {
                changes.insert(key, change);
            }
            // A moment that rested has no ratio to it.
            Err(AnalysisError::NoReference) => {}
            Err(error) => return Err(error.into()),
        }
    }
    Ok(changes)
}

/// Key in a summary of the standard deviation of `channel`.
fn deviation_key(channel: &str) -> String {
    format!("{channel}, standard deviation (kN m)")
}

/// Key in a summary of the equivalent load of `channel`, and what makes it of samples `interval` (s) apart.
fn equivalent_load(
    channel: &str,
    interval: f64,
) -> (String, impl Fn(&[f64]) -> Result<f64, AnalysisError>) {
    let slope = if channel.starts_with("Root") { BLADE_SLOPE } else { STEEL_SLOPE };
    let key = format!("{channel}, m = {slope} (kN m)");
    (key, move |samples: &[f64]| {
        damage_equivalent_load(samples, interval, slope, REFERENCE_FREQUENCY)
    })
}

/// What [`pitch_duty`] of `turbine` is made of: pitch of blade 1, flapwise and edgewise moment at its root.
pub(crate) fn duty_channels(turbine: &str) -> [String; 3] {
    ["pitch_1_rad", "RootMyb1_kN-m", "RootMxb1_kN-m"].map(|channel| format!("{turbine}.{channel}"))
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
        bearing_loads_kn_m: loads.iter().map(|position| position.load).collect(),
        convention: duty_convention(BEARING_SLOPE, N_BEARING_POSITIONS, interval),
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
        let names = ["time_s", "T1.pitch_1_rad", "T1.RootMyb1_kN-m", "T1.RootMxb1_kN-m"];
        Series {
            names: names.map(str::to_owned).to_vec(),
            columns: vec![times.clone(), column(&pitch), column(&|_| 3e4), column(&|_| 4e4)],
        }
    }

    /// A sine of 2° and 8 s travels the reference, so that the bearing carries its steady moment where it presses.
    #[test]
    fn a_steady_moment_on_a_bearing_that_travels_the_reference_is_its_load() {
        let series = series(0.01, 6001);
        let analysed = Analysed::whole(&series, 0.01);
        let duty = pitch_duty("T1", &analysed).expect("numbers").expect("all channels");
        assert!((duty.travel_deg - 60.0).abs() < 0.01, "{}", duty.travel_deg);
        assert!((duty.travel_in_ten_minutes_deg - 600.0).abs() < 0.1);
        assert_eq!(duty.bearing_loads_kn_m.len(), 36);
        for (index, load) in duty.bearing_loads_kn_m.iter().enumerate() {
            let angle = TAU * index as f64 / 36.0;
            let expected = (3e4 * angle.cos() + 4e4 * angle.sin()).max(0.0);
            assert!((load - expected).abs() < 10.0, "{angle}: {load} {expected}");
        }
        // atan(4/3) is 53°.
        let (load, position) = duty.worst_bearing_load().expect("positions");
        assert!((position.to_degrees() - 50.0).abs() < 1e-9 && (load / 5e4 - 1.0).abs() < 0.01);
        assert!(duty.convention.contains("m = 3, at 36 positions"), "{}", duty.convention);
        assert!(duty.convention.ends_with("samples every 0.01 s"), "{}", duty.convention);
    }

    /// Swings that grow by 20 % and 30 % in two blocks, about another mean; a moment at rest beside them has no change.
    #[test]
    fn moments_that_swing_further_say_so_with_an_interval() {
        let names = ["time_s", "T1.RootMyb1_kN-m", "T1.TwrBsMyt_kN-m"];
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
        let changes = |other: &Series| {
            let mut found = BTreeMap::new();
            for moment in &moments {
                let change = changes(moment, &whole(&series), &whole(other));
                found.extend(change.expect("numbers"));
            }
            found
        };
        let found = changes(&other);
        let keys: Vec<&str> = found.keys().map(String::as_str).collect();
        assert_eq!(keys, ["RootMyb1, m = 10 (kN m)", "RootMyb1, standard deviation (kN m)"]);
        for (change, expected) in found.values().zip([
            // Half of the cycles of one size, half of the other, on a slope of ten.
            (0.5 * (1.2f64.powi(10) + 1.3f64.powi(10))).powf(0.1) - 1.0,
            (0.5 * (1.2f64.powi(2) + 1.3f64.powi(2))).sqrt() - 1.0,
        ]) {
            assert!((change.mean - expected).abs() < 1e-3, "{change:?} {expected}");
            // t(0.975, 1) · 0.1/2, whatever the slope.
            let half_width = change.half_width_95.expect("two blocks");
            assert!((half_width - 12.706_205 * 0.05).abs() < 1e-6, "{change:?}");
        }
        let own: Vec<String> = moments
            .iter()
            .filter_map(|moment| damage_equivalent(moment, &whole(&series)).expect("numbers"))
            .map(|(key, _)| key)
            .collect();
        assert!(found.keys().all(|key| own.contains(key) || key.contains("deviation")));
        // A run that keeps no moments is nothing to compare with.
        let none = Series { names: vec!["time_s".into()], columns: other.columns[..1].to_vec() };
        assert!(changes(&none).is_empty());
    }

    #[test]
    fn records_without_the_channels_tell_nothing() {
        let mut series = series(0.1, 100);
        assert_eq!(pitch_duty("T2", &Analysed::whole(&series, 0.1)).ok(), Some(None));
        series.columns.iter_mut().for_each(|column| column.truncate(1));
        assert_eq!(pitch_duty("T1", &Analysed::whole(&series, 0.1)).ok(), Some(None));
    }
}
