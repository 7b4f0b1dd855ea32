//! Blocks of runs beside those of their baseline.

use crate::{TuningError, TuningFile};
use analysis::AnalysisError;
use analysis::fatigue::{REFERENCE_FREQUENCY, damage_equivalent_load};
use analysis::statistics::block_means;
use basis::channels::GEN_PWR;
use basis::records::Series;
use formats::records::{RunFolder, read_series};
use search::Evaluation;
use std::path::Path;
use study::Prepared;

/// How records are cut.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Cut {
    /// Turbines whose power counts.
    pub(crate) turbines: Vec<String>,
    /// Channels with Wöhler exponents (–) whose equivalent loads are followed.
    loads: Vec<(String, f64)>,
    /// First analysed row, time between rows (s), length of a block (s).
    first: usize,
    interval: f64,
    block: f64,
}

/// The analysed part of a run's records.
struct Record<'a> {
    cut: &'a Cut,
    series: Series,
    path: &'a Path,
}

impl Cut {
    /// That of the runs of `prepared` which `file` asks for.
    ///
    /// # Errors
    /// [`TuningError::OtherTurbines`], [`TuningError::NoBlock`].
    pub(crate) fn new(file: &TuningFile, prepared: &Prepared) -> Result<Self, TuningError> {
        let present = |name: &str| -> Vec<String> {
            let run = prepared.case.runs.iter().find(|run| run.name == name);
            let places = run.map_or(Vec::new(), |run| run.present().collect());
            places.into_iter().map(|place| prepared.case.turbines[place].name.clone()).collect()
        };
        let turbines = present(&file.run);
        if turbines != present(&file.baseline) {
            let (run, baseline) = (file.run.clone(), file.baseline.clone());
            return Err(TuningError::OtherTurbines { run, baseline });
        }
        let plan = &prepared.plan;
        let analysed = (plan.n_steps - plan.n_spin_up_steps) as f64 * plan.interval;
        // A sample short of a whole block does not cost it, as everywhere.
        if analysed < 0.99 * file.block {
            let (path, block) = (file.case.clone(), file.block);
            return Err(TuningError::NoBlock { path, analysed, block });
        }
        Ok(Self {
            turbines,
            loads: file.loads.clone(),
            first: plan.n_spin_up_steps.div_ceil(plan.row_stride) as usize,
            interval: plan.row_interval(),
            block: file.block,
        })
    }

    /// Names of the outputs of an evaluation: turbines, then channels.
    pub(crate) fn outputs(&self) -> Vec<String> {
        let loads = self.loads.iter().map(|(channel, _)| channel.clone());
        self.turbines.iter().cloned().chain(loads).collect()
    }

    /// What the run in `folder` gave over the `baseline`.
    ///
    /// # Errors
    /// [`TuningError::File`], [`TuningError::NoChannel`], [`TuningError::Analysis`].
    pub(crate) fn evaluation(
        &self,
        folder: &RunFolder,
        baseline: &RunFolder,
    ) -> Result<Evaluation, TuningError> {
        let (own_path, its_path) = (folder.series_path(), baseline.series_path());
        let (own, its) = (self.read(&own_path)?, self.read(&its_path)?);
        let failed = |source| TuningError::Analysis { path: folder.path().to_owned(), source };
        let mut powers = Vec::new();
        for turbine in &self.turbines {
            let channel = GEN_PWR.at(turbine);
            let blocks = |record: &Record| {
                block_means(record.column(&channel)?, self.interval, self.block).map_err(failed)
            };
            powers.push([blocks(&own)?, blocks(&its)?]);
        }
        let mut outputs = contributions(&powers).map_err(failed)?;
        for (channel, slope) in &self.loads {
            let [own, its] = [own.column(channel)?, its.column(channel)?];
            outputs.push(self.load_changes(own, its, *slope).map_err(failed)?);
        }
        Ok(Evaluation { outputs })
    }

    fn read<'a>(&'a self, path: &'a Path) -> Result<Record<'a>, TuningError> {
        let powers = self.turbines.iter().map(|turbine| GEN_PWR.at(turbine));
        let wanted: Vec<String> =
            powers.chain(self.loads.iter().map(|(channel, _)| channel.clone())).collect();
        let series = read_series(path, |name| wanted.iter().any(|wanted| wanted == name))?;
        Ok(Record { cut: self, series, path })
    }

    /// Block by block the change (–) of the equivalent load of `own` over that of `its`.
    fn load_changes(
        &self,
        own: &[f64],
        its: &[f64],
        slope: f64,
    ) -> Result<Vec<f64>, AnalysisError> {
        let n_blocks = block_means(own, self.interval, self.block)?.len();
        let whole =
            ((self.block / self.interval).round() as usize).min(own.len() / n_blocks.max(1));
        let load = |samples: &[f64]| {
            damage_equivalent_load(samples, self.interval, slope, REFERENCE_FREQUENCY)
        };
        let pairs = own.chunks_exact(whole.max(1)).zip(its.chunks_exact(whole.max(1)));
        let change = |(own, its): (&[f64], &[f64])| {
            let reference = load(its)?;
            if reference == 0.0 {
                return Err(AnalysisError::NoReference);
            }
            Ok(load(own)? / reference - 1.0)
        };
        pairs.take(n_blocks).map(change).collect()
    }
}

impl Record<'_> {
    fn column(&self, channel: &str) -> Result<&[f64], TuningError> {
        let missing =
            || TuningError::NoChannel { path: self.path.to_owned(), channel: channel.to_owned() };
        let column = self.series.column(channel).ok_or_else(missing)?;
        Ok(column.get(self.cut.first..).unwrap_or_default())
    }
}

/// Contribution of each turbine to the gain of the array (–), block by block, of block means of its power (W)
/// in a run and in the baseline.
///
/// Both runs met the same wind. With the difference d and the baseline's array power x of a block, a
/// turbine's contribution is r = Σd/Σx, and that of a block r + (d − r x)/x̄, whose mean is r and whose
/// spread is that behind the interval of `analysis::statistics::gain` (Cochran, "Sampling Techniques",
/// 1977, §6.4): wind that makes a block stronger is no noise. Contributions of all turbines add up to the
/// gain of the array, block by block.
///
/// # Errors
/// [`AnalysisError::ZeroMean`] where the baseline makes no power.
fn contributions(powers: &[[Vec<f64>; 2]]) -> Result<Vec<Vec<f64>>, AnalysisError> {
    let n_blocks = powers.iter().flatten().map(Vec::len).min().unwrap_or(0);
    let array = |block: usize| powers.iter().map(|[_, before]| before[block]).sum::<f64>();
    let before: Vec<f64> = (0..n_blocks).map(array).collect();
    let reference = before.iter().sum::<f64>() / n_blocks as f64;
    if reference.is_nan() || reference == 0.0 {
        return Err(AnalysisError::ZeroMean);
    }
    let of_turbine = |[now, then]: &[Vec<f64>; 2]| {
        let differences: Vec<f64> = (0..n_blocks).map(|block| now[block] - then[block]).collect();
        let ratio = differences.iter().sum::<f64>() / n_blocks as f64 / reference;
        let of_block = |(d, x): (&f64, &f64)| ratio + (d - ratio * x) / reference;
        differences.iter().zip(&before).map(of_block).collect()
    };
    Ok(powers.iter().map(of_turbine).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use analysis::statistics::gain;

    /// Contributions add up to the gain of the array's power, and have its interval.
    #[test]
    fn contributions_are_the_gain_of_the_array_with_its_interval() {
        let first = [vec![0.9, 1.9, 1.4, 1.2], vec![1.0, 2.0, 1.5, 1.1]];
        let second = [vec![0.7, 1.2, 1.1, 0.8], vec![0.5, 1.0, 0.7, 0.9]];
        let found = contributions(&[first.clone(), second.clone()]).expect("power");
        let sums = |place: usize| -> Vec<f64> {
            first[place].iter().zip(&second[place]).map(|(a, b)| a + b).collect()
        };
        let expected = gain(&sums(0), &sums(1), 1.0, 1.0).expect("a gain");
        let blocks: Vec<f64> = found[0].iter().zip(&found[1]).map(|(a, b)| a + b).collect();
        let own = analysis::statistics::independent(&blocks).expect("blocks");
        assert!((own.mean - expected.mean).abs() < 1e-12);
        let halves = [own, expected].map(|one| one.half_width_95.expect("blocks"));
        assert!((halves[0] - halves[1]).abs() < 1e-12);
        assert!(matches!(contributions(&[[vec![1.0], vec![0.0]]]), Err(AnalysisError::ZeroMean)));
    }
}
