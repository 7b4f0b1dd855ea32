//! Two turbines in the four winds of a published study: how power and blade loads change from run to run,
//! with as many seeds as there are.

use analysis::AnalysisError;
use analysis::fatigue::{REFERENCE_FREQUENCY, damage_equivalent_load};
use analysis::statistics::{change_together, independent, mean};
use basis::records::Series;
use formats::records::{RunRecords, read_study, read_sweep};
use std::path::Path;

/// A wind of the study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FarmWind {
    /// Its number in the names of the source's cases (–).
    pub(crate) number: usize,
    /// Shear exponent (–).
    pub(crate) shear: f64,
    /// Turbulence intensity (–).
    pub(crate) intensity: f64,
}

impl FarmWind {
    /// Whether another seed makes another wind.
    pub(crate) fn has_seeds(self) -> bool {
        self.intensity > 0.0
    }
}

const fn wind(number: usize, shear: f64, intensity: f64) -> FarmWind {
    FarmWind { number, shear, intensity }
}

/// Even, with shear, with turbulence, with both.
pub(crate) const WINDS: [FarmWind; 4] =
    [wind(1, 0.0, 0.0), wind(2, 0.2, 0.0), wind(3, 0.0, 0.06), wind(4, 0.2, 0.06)];
const N_TURBINES: usize = 2;
/// Two turns of the helix (s): the blocks of which intervals are made.
const BLOCK: f64 = 84.0;
/// Wöhler's exponent of composite blades (–), this program's choice: the source names none.
const SLOPE: f64 = 10.0;

/// What is compared: its name, the channel of a turbine, and whether its damage-equivalent load is meant.
pub(crate) const QUANTITIES: [(&str, &str, bool); 3] = [
    ("power", "GenPwr", false),
    ("flapwise equivalent load", "RootMyb1", true),
    ("edgewise equivalent load", "RootMxb1", true),
];
/// Whose: the turbines one by one, and both together.
pub(crate) const WHOSE: [&str; N_TURBINES + 1] = ["T1", "T2", "both"];

/// A change with the half width of its interval (%).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Change {
    pub(crate) mean: f64,
    pub(crate) half_width: f64,
}

/// Changes of a quantity: of each turbine, and of both together.
pub(crate) type Changes = [Change; N_TURBINES + 1];

/// The channels that are compared over the analysed time of `run` in this `wind`, one of the sweep in
/// `folder`; prints its power.
pub(crate) fn series_of(folder: &Path, wind: FarmWind, run: &str) -> Result<Series, String> {
    let runs = records(folder, wind)?;
    let found = runs.iter().find(|records| records.summary.run == run);
    let found = found.ok_or_else(|| format!("wind {}: there is no run {run}", wind.number))?;
    print_power(wind, found);
    analysed(found)
}

/// How all [`QUANTITIES`] change from `before` to `now`.
pub(crate) fn all_changes(
    now: &Series,
    before: &Series,
) -> Result<[Changes; QUANTITIES.len()], String> {
    let mut all = [Changes::default(); QUANTITIES.len()];
    for ((_, channel, is_load), found) in QUANTITIES.into_iter().zip(&mut all) {
        *found = changes(channel, is_load, now, before)?;
    }
    Ok(all)
}

/// What the changes `of_seeds` are together: their mean, with an interval from how they differ; those of one
/// seed alone are its own.
pub(crate) fn together(
    of_seeds: &[[Changes; QUANTITIES.len()]],
) -> Result<[Changes; QUANTITIES.len()], String> {
    let mut all = [Changes::default(); QUANTITIES.len()];
    for (quantity, found) in all.iter_mut().enumerate() {
        let of_quantity: Vec<Changes> = of_seeds.iter().map(|changes| changes[quantity]).collect();
        *found = of_all(&of_quantity)?;
    }
    Ok(all)
}

/// Prints `changes` of all quantities in what `words` name.
pub(crate) fn print_changes(words: &str, changes: &[Changes; QUANTITIES.len()]) {
    for ((quantity, ..), changes) in QUANTITIES.into_iter().zip(changes) {
        let [first, second, both] =
            changes.map(|Change { mean, half_width }| format!("{mean:+.2} ± {half_width:.2} %"));
        tell!("{words}, {quantity}: T1 {first}, T2 {second}, both {both}");
    }
}

/// What the changes `of_seeds` of one quantity are together.
fn of_all(of_seeds: &[Changes]) -> Result<Changes, String> {
    if let [only] = of_seeds {
        return Ok(*only);
    }
    let mut all = Changes::default();
    for (whose, all) in all.iter_mut().enumerate() {
        let means: Vec<f64> = of_seeds.iter().map(|changes| changes[whose].mean).collect();
        let found = independent(&means).map_err(|error| error.to_string())?;
        *all = Change { mean: found.mean, half_width: found.half_width_95.unwrap_or(f64::NAN) };
    }
    Ok(all)
}

/// The runs in this `wind`, of the sweep in `folder`.
fn records(folder: &Path, wind: FarmWind) -> Result<Vec<RunRecords>, String> {
    let sweep = read_sweep(folder).map_err(|error| error.to_string())?;
    let sweep = sweep.ok_or_else(|| format!("{} holds no sweep", folder.display()))?;
    for study in &sweep.studies {
        let records = read_study(&folder.join(&study.folder)).map_err(|error| error.to_string())?;
        let is_it = records.runs.first().is_some_and(|run| {
            let found = &run.summary.conditions;
            found.shear_exponent == Some(wind.shear)
                && found.target_turbulence_intensity == wind.intensity
        });
        if is_it {
            return Ok(records.runs);
        }
    }
    let FarmWind { shear, intensity, .. } = wind;
    Err(format!("no study with shear {shear} and turbulence intensity {intensity}"))
}

/// The channels that are compared, over the analysed time of `run`.
fn analysed(run: &RunRecords) -> Result<Series, String> {
    let channels: Vec<String> = QUANTITIES
        .into_iter()
        .flat_map(|(_, channel, _)| ["T1", "T2"].map(|turbine| format!("{turbine}.{channel}")))
        .collect();
    let wanted = |name: &str| name == "Time" || channels.iter().any(|channel| channel == name);
    let mut series = run.series.read(wanted).map_err(|error| error.to_string())?;
    let spin_up = run.summary.conditions.spin_up;
    let time = series.column("Time").ok_or("the series has no times")?;
    let first = time.partition_point(|time| *time <= spin_up);
    for column in &mut series.columns {
        column.drain(..first);
    }
    Ok(series)
}

/// Changes of `channel` from `before` to `now`, of each turbine and of both together.
fn changes(channel: &str, is_load: bool, now: &Series, before: &Series) -> Result<Changes, String> {
    let Some([first, .., last]) = now.column("Time") else {
        return Err("the series has no two times after the spin-up".to_owned());
    };
    let columns = |series: &Series| -> Result<Vec<Vec<f64>>, String> {
        let of = |turbine: &&str| {
            let name = format!("{turbine}.{channel}");
            let column = series.column(&name).ok_or_else(|| format!("there is no {name}"))?;
            Ok(column.to_vec())
        };
        WHOSE[..N_TURBINES].iter().map(of).collect()
    };
    let (now, before) = (columns(now)?, columns(before)?);
    let pairs: Vec<[&[f64]; 2]> =
        now.iter().zip(&before).map(|(now, before)| [&now[..], &before[..]]).collect();
    let interval = (last - first) / (now[0].len() - 1) as f64;
    let figure = |samples: &[f64]| -> Result<f64, AnalysisError> {
        if !is_load {
            return Ok(mean(samples));
        }
        damage_equivalent_load(samples, interval, SLOPE, REFERENCE_FREQUENCY)
    };
    let of = |pairs: &[[&[f64]; 2]]| {
        let found = change_together(pairs, interval, BLOCK, figure);
        found.map_err(|error| error.to_string()).map(|found| Change {
            mean: 100.0 * found.mean,
            half_width: 100.0 * found.half_width_95.unwrap_or(f64::NAN),
        })
    };
    Ok([of(&pairs[..1])?, of(&pairs[1..])?, of(&pairs)?])
}

/// Power of `run` in this `wind`.
fn print_power(wind: FarmWind, run: &RunRecords) {
    let powers = run
        .summary
        .turbines
        .iter()
        .map(|turbine| format!("{} {:.1} kW", turbine.name, 1e-3 * turbine.power.mean));
    let (seed, name) = (run.summary.conditions.seed, &run.summary.run);
    let powers = powers.collect::<Vec<_>>().join(", ");
    tell!("wind {}, seed {seed}, {name}: {powers}", wind.number);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Power and moments of both turbines that are `factor` times those of a factor of 1.
    fn series(factors: [f64; N_TURBINES]) -> Series {
        let time: Vec<f64> = (1..=6000).map(|step| 300.0 + 0.1 * f64::from(step)).collect();
        let wave = |size: f64| time.iter().map(|t| size * (2.0 + (1.3 * t).sin())).collect();
        let mut series = Series { names: vec!["Time".to_owned()], columns: vec![time.clone()] };
        for (_, channel, _) in QUANTITIES {
            for (turbine, factor) in ["T1", "T2"].iter().zip(factors) {
                series.names.push(format!("{turbine}.{channel}"));
                series.columns.push(wave(factor * if *turbine == "T2" { 0.5 } else { 1.0 }));
            }
        }
        series
    }

    #[test]
    fn changes_are_those_of_each_and_of_the_sum() {
        let (now, before) = (series([1.1, 0.8]), series([1.0, 1.0]));
        for (_, channel, is_load) in QUANTITIES {
            let [first, second, both] = changes(channel, is_load, &now, &before).unwrap();
            assert!((first.mean - 10.0).abs() < 1e-9 && (second.mean + 20.0).abs() < 1e-9);
            // The second is half as much as the first.
            assert!(both.mean.abs() < 1e-9 && both.half_width < 1e-9, "{both:?}");
        }
    }

    #[test]
    fn seeds_together_have_their_mean_and_how_they_differ() {
        let changes = |mean: f64| [Change { mean, half_width: 9.0 }; N_TURBINES + 1];
        assert_eq!(of_all(&[changes(3.0)]).unwrap()[0], Change { mean: 3.0, half_width: 9.0 });
        // Student's 97.5 % point of three degrees of freedom is 3.182; these have a deviation of √(5/3).
        let all = of_all(&[1.0, 2.0, 3.0, 4.0].map(changes)).unwrap();
        assert!((all[2].mean - 2.5).abs() < 1e-12);
        assert!((all[2].half_width - 3.182 * (5.0_f64 / 12.0).sqrt()).abs() < 1e-3, "{all:?}");
    }
}
