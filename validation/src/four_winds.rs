//! Two turbines in the four winds of a published study, in free vortices and in resolved flow: runs with
//! several seeds, and how power and blade loads change from run to run.

use crate::studies::{Carried, summaries_of};
use analysis::AnalysisError;
use analysis::fatigue::{REFERENCE_FREQUENCY, damage_equivalent_load};
use analysis::statistics::{change_together, independent, mean};
use basis::records::Series;
use formats::records::{RunRecords, read_study, read_sweep};
use std::path::{Path, PathBuf};

/// The run with a helix that nothing corrects.
pub(crate) const OPEN: &str = "open-loop";
/// The run with a loop that a lidar closes.
pub(crate) const CLOSED: &str = "closed-loop";
/// Seed with which all winds are made; with others those are that it changes.
pub(crate) const FIRST_SEED: u64 = 1;
/// Where the reference of all closed loops is: the open loop in even wind, of the first seed's folder.
const REFERENCE: &str = "shear_exponent-0-turbulence_intensity-0/open-loop";

/// The two turbines as one flow has them.
pub(crate) struct Farm {
    case: Carried,
    /// Name of its folders, before the seed.
    name: &'static str,
}

/// In free vortices, as the study has them.
pub(crate) const FREE: Farm = Farm { case: Carried::Shipped("lidar-closed-loop"), name: "lidar" };
/// In resolved flow.
pub(crate) const RESOLVED: Farm =
    Farm { case: Carried::Own(include_str!("../cases/lidar-lattice.toml")), name: "lidar-lattice" };

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
/// Changes of all [`QUANTITIES`].
pub(crate) type AllChanges = [Changes; QUANTITIES.len()];

impl Farm {
    /// What `of` finds in each wind with each of `seeds`, given the folder with these `runs`: all winds with
    /// the first seed, else those that it changes.
    pub(crate) fn of_winds(
        &self,
        seeds: &[u64],
        runs: &[&str],
        mut of: impl FnMut(&Path, FarmWind, u64) -> Result<AllChanges, String>,
    ) -> Result<[Vec<AllChanges>; WINDS.len()], String> {
        let mut of_winds: [Vec<_>; WINDS.len()] = Default::default();
        for &seed in seeds {
            let folder = self.folder(seed, runs)?;
            for (wind, of_seeds) in WINDS.into_iter().zip(&mut of_winds) {
                if wind.has_seeds() || seed == FIRST_SEED {
                    of_seeds.push(of(&folder, wind, seed)?);
                }
            }
        }
        Ok(of_winds)
    }

    /// Makes these `runs` with a `seed`, or takes up what is there of them, and gives their folder: all winds
    /// with the first seed, else those that it changes. Validations share the folders: each makes the runs
    /// that it wants.
    pub(crate) fn folder(&self, seed: u64, runs: &[&str]) -> Result<PathBuf, String> {
        let name = |seed: u64| format!("{}-{seed}", self.name);
        // From the current folder, for the case itself may stand elsewhere.
        let here = std::env::current_dir().map_err(|error| error.to_string())?;
        let first = here.join("runs").join(format!("validate-{}", name(FIRST_SEED)));
        let reference = first.join(REFERENCE);
        let mut overrides = vec![
            format!("wind.seed={seed}"),
            format!("run.{CLOSED}.control.T1.reference_run=\"{}\"", reference.display()),
        ];
        if seed != FIRST_SEED {
            overrides.push("sweep.wind.turbulence_intensity=[0.06]".to_owned());
        }
        Ok(summaries_of(self.case, &name(seed), overrides, runs)?.1)
    }

    /// Makes the open loop in one `wind` with a `seed`, its helix of another `amplitude` (°), and gives its
    /// folder.
    pub(crate) fn open_of(
        &self,
        wind: FarmWind,
        seed: u64,
        amplitude: f64,
    ) -> Result<PathBuf, String> {
        let FarmWind { number, shear, intensity } = wind;
        let overrides = vec![
            format!("wind.seed={seed}"),
            format!("run.{OPEN}.control.T1.amplitude_deg={amplitude:.3}"),
            format!("sweep.wind.shear_exponent=[{shear:?}]"),
            format!("sweep.wind.turbulence_intensity=[{intensity:?}]"),
        ];
        let name = format!("{}-as-much-{number}-{seed}", self.name);
        Ok(summaries_of(self.case, &name, overrides, &[OPEN])?.1)
    }
}

/// The channels that are compared over the analysed time of `run` in this `wind`, one of the sweep in
/// `folder`; prints its power.
pub(crate) fn series_of(folder: &Path, wind: FarmWind, run: &str) -> Result<Series, String> {
    let found = records_of(folder, wind, run)?;
    print_power(wind, &found);
    let channels: Vec<String> = QUANTITIES
        .into_iter()
        .flat_map(|(_, channel, _)| ["T1", "T2"].map(|turbine| format!("{turbine}.{channel}")))
        .collect();
    analysed(&found, &channels)
}

/// How all [`QUANTITIES`] change from `before` to `now`.
pub(crate) fn all_changes(now: &Series, before: &Series) -> Result<AllChanges, String> {
    let mut all = [Changes::default(); QUANTITIES.len()];
    for ((_, channel, is_load), found) in QUANTITIES.into_iter().zip(&mut all) {
        *found = changes(channel, is_load, now, before)?;
    }
    Ok(all)
}

/// What the changes `of_seeds` are together: their mean, with an interval from how they differ; those of one
/// seed alone are its own.
pub(crate) fn together(of_seeds: &[AllChanges]) -> Result<AllChanges, String> {
    let mut all = [Changes::default(); QUANTITIES.len()];
    for (quantity, found) in all.iter_mut().enumerate() {
        let of_quantity: Vec<Changes> = of_seeds.iter().map(|changes| changes[quantity]).collect();
        *found = of_all(&of_quantity)?;
    }
    Ok(all)
}

/// `changes` over one run that all seeds share, whose own scatter no seed tells of: intervals with that of
/// the blocks of `shared`.
pub(crate) fn over_shared(mut changes: AllChanges, shared: &Series) -> Result<AllChanges, String> {
    for ((_, channel, is_load), changes) in QUANTITIES.into_iter().zip(&mut changes) {
        let scatter = scatter_of(channel, is_load, shared)?;
        for (change, scatter) in changes.iter_mut().zip(scatter) {
            change.half_width = change.half_width.hypot(scatter);
        }
    }
    Ok(changes)
}

/// Prints `changes` of all quantities in what `words` name.
pub(crate) fn print_changes(words: &str, changes: &AllChanges) {
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

/// What `run` left in this `wind`, of the sweep in `folder`.
pub(crate) fn records_of(folder: &Path, wind: FarmWind, run: &str) -> Result<RunRecords, String> {
    let mut runs = records(folder, wind)?.into_iter();
    let found = runs.find(|records| records.summary.run == run);
    found.ok_or_else(|| format!("wind {}: there is no run {run}", wind.number))
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

/// Time and these `channels` over the analysed time of `run`.
pub(crate) fn analysed(run: &RunRecords, channels: &[String]) -> Result<Series, String> {
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

/// Changes of `channel` from `before` to `now`, of each turbine and of both together; intervals are those of
/// blocks, which hold the scatter of both runs.
fn changes(channel: &str, is_load: bool, now: &Series, before: &Series) -> Result<Changes, String> {
    let interval = interval(now)?;
    let (now, before) = (columns(channel, now)?, columns(channel, before)?);
    let pairs: Vec<[&[f64]; 2]> =
        now.iter().zip(&before).map(|(now, before)| [&now[..], &before[..]]).collect();
    let of = |pairs: &[[&[f64]; 2]]| {
        let found = change_together(pairs, interval, BLOCK, figure(is_load, interval));
        found.map_err(|error| error.to_string()).map(|found| Change {
            mean: 100.0 * found.mean,
            half_width: 100.0 * found.half_width_95.unwrap_or(f64::NAN),
        })
    };
    Ok([of(&pairs[..1])?, of(&pairs[1..])?, of(&pairs)?])
}

/// Half widths (%) of the means of `channel` over one run, of each turbine and of both together, from its
/// blocks.
fn scatter_of(
    channel: &str,
    is_load: bool,
    series: &Series,
) -> Result<[f64; N_TURBINES + 1], String> {
    let interval = interval(series)?;
    let columns = columns(channel, series)?;
    let figure = figure(is_load, interval);
    let length = (BLOCK / interval).round() as usize;
    let mut blocks = [const { Vec::new() }; N_TURBINES + 1];
    for start in (0..columns[0].len() / length).map(|block| block * length) {
        let mut sum = 0.0;
        for (column, blocks) in columns.iter().zip(&mut blocks) {
            let found = figure(&column[start..start + length]);
            let found = found.map_err(|error| error.to_string())?;
            blocks.push(found);
            sum += found;
        }
        blocks[N_TURBINES].push(sum);
    }
    let mut scatter = [f64::NAN; N_TURBINES + 1];
    for (scatter, blocks) in scatter.iter_mut().zip(&blocks) {
        let found = independent(blocks).map_err(|error| error.to_string())?;
        *scatter = 100.0 * found.half_width_95.unwrap_or(f64::NAN) / found.mean;
    }
    Ok(scatter)
}

/// Time between two samples of `series` (s).
fn interval(series: &Series) -> Result<f64, String> {
    match series.column("Time") {
        Some(times @ [first, .., last]) => Ok((last - first) / (times.len() - 1) as f64),
        _ => Err("the series has no two times after the spin-up".to_owned()),
    }
}

/// `channel` of both turbines.
fn columns(channel: &str, series: &Series) -> Result<Vec<Vec<f64>>, String> {
    let of = |turbine: &&str| {
        let name = format!("{turbine}.{channel}");
        let column = series.column(&name).ok_or_else(|| format!("there is no {name}"))?;
        Ok(column.to_vec())
    };
    WHOSE[..N_TURBINES].iter().map(of).collect()
}

/// What is compared of samples `interval` (s) apart: their mean, or their equivalent load.
fn figure(is_load: bool, interval: f64) -> impl Fn(&[f64]) -> Result<f64, AnalysisError> {
    move |samples| match is_load {
        false => Ok(mean(samples)),
        true => damage_equivalent_load(samples, interval, SLOPE, REFERENCE_FREQUENCY),
    }
}

/// Wind before the first turbine and power of `run` in this `wind`.
fn print_power(wind: FarmWind, run: &RunRecords) {
    let powers = run
        .summary
        .turbines
        .iter()
        .map(|turbine| format!("{} {:.1} kW", turbine.name, 1e-3 * turbine.power.mean));
    let (seed, name) = (run.summary.conditions.seed, &run.summary.run);
    let powers = powers.collect::<Vec<_>>().join(", ");
    let speed = run.summary.conditions.realised_wind_speed;
    tell!("wind {}, seed {seed}, {name}: {speed:.2} m/s, {powers}", wind.number);
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
    fn a_run_that_all_share_widens_intervals_by_its_blocks() {
        // Each block has its own mean: 7 of them from 0.7 to 1.3 times the whole's, deviation 0.216.
        let mut shared = series([1.0, 1.0]);
        let n = (BLOCK / 0.1) as usize;
        for column in &mut shared.columns[1..] {
            for (sample, value) in column.iter_mut().enumerate() {
                *value = 0.7 + 0.1 * (sample / n) as f64;
            }
        }
        let three = [Change { mean: 2.0, half_width: 3.0 }; N_TURBINES + 1];
        let [scatter, ..] = scatter_of("GenPwr", false, &shared).unwrap();
        // Student's 97.5 % point of six degrees of freedom is 2.447.
        assert!((scatter - 100.0 * 2.447 * 0.216_02 / 7.0_f64.sqrt()).abs() < 0.01, "{scatter}");
        let [power, ..] = over_shared([three; QUANTITIES.len()], &shared).unwrap();
        assert!(power.iter().all(|change| change.mean == 2.0), "{power:?}");
        assert!((power[0].half_width - 3.0_f64.hypot(scatter)).abs() < 1e-9, "{power:?}");
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
