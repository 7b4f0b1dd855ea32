//! Means, gains and the intervals that go with them.

mod change;
mod student;

use crate::AnalysisError;
use basis::records::Statistic;
pub use change::{change, change_together};
pub use student::student_97_5;

/// Length of the blocks whose means are taken as independent (s): ten minutes, the field's averaging time.
pub const BLOCK_LENGTH: f64 = 600.0;
/// Share of a block that may be missing at the end of a record (–).
const SHORT: f64 = 0.01;

/// Mean of `samples` (any unit, every `interval` s), standard deviation, and the half width of the 95 %
/// interval of the mean from blocks of `block_length` (s).
///
/// The half width is t s / √n with the standard deviation s of the n block means and Student's t for n − 1
/// degrees of freedom; with fewer than two whole blocks there is none. Samples after the last whole block
/// count for mean and standard deviation, not for the interval.
///
/// Source: Law, "Simulation Modeling and Analysis", 5th ed., 2015, §9.5.3 (batch means).
/// Limits: right as far as block means are independent; blocks must be long against the slowest motion of the
/// wake.
///
/// # Errors
/// [`AnalysisError::TooShort`] without samples; [`AnalysisError::NotPositive`] for a block that holds no
/// sample.
///
/// ```
/// // 1 in the first block, 3 in the second: t(0.975, 1) = 12.706, s / √2 = 1
/// let samples = [[1.0; 600], [3.0; 600]].concat();
/// let statistic = analysis::statistics::statistic(&samples, 1.0, 600.0)?;
/// assert_eq!(statistic.mean, 2.0);
/// assert!((statistic.half_width_95.unwrap() - 12.706).abs() < 1e-3);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn statistic(
    samples: &[f64],
    interval: f64,
    block_length: f64,
) -> Result<Statistic, AnalysisError> {
    let blocks = block_means(samples, interval, block_length)?;
    Ok(Statistic {
        mean: mean(samples),
        standard_deviation: standard_deviation(samples),
        half_width_95: half_width_95(&blocks),
        n_blocks: blocks.len(),
    })
}

/// Gain of `samples` over `compared` (same unit, same instants, every `interval` s): ratio of the two means
/// minus one (–), with its interval from paired blocks of `block_length` (s).
///
/// Both runs met the same wind, so what the wind does to a block cancels within the pair. With block means
/// yᵢ and xᵢ, ratio r and mean x̄, the half width is t s / √n with the standard deviation s of
/// (yᵢ − r xᵢ) / x̄; `standard_deviation` of the result is this s (zero with fewer than two blocks).
///
/// Source: Cochran, "Sampling Techniques", 3rd ed., 1977, §6.3-6.4 (ratio estimate and its variance).
///
/// # Errors
/// [`AnalysisError::UnequalLengths`], [`AnalysisError::ZeroMean`], and those of [`statistic`].
pub fn gain(
    samples: &[f64],
    compared: &[f64],
    interval: f64,
    block_length: f64,
) -> Result<Statistic, AnalysisError> {
    check_lengths(samples, compared)?;
    let blocks = block_means(samples, interval, block_length)?;
    let compared_blocks = block_means(compared, interval, block_length)?;
    let reference = mean(compared);
    if reference == 0.0 {
        return Err(AnalysisError::ZeroMean);
    }
    let ratio = mean(samples) / reference;
    let residuals: Vec<f64> =
        blocks.iter().zip(&compared_blocks).map(|(y, x)| (y - ratio * x) / reference).collect();
    Ok(Statistic {
        mean: ratio - 1.0,
        standard_deviation: sample_deviation(&residuals).unwrap_or(0.0),
        half_width_95: half_width_95(&residuals),
        n_blocks: residuals.len(),
    })
}

/// Mean of independent `values` (any unit), such as one of each seed of the wind, and the half width of its
/// 95 % interval, t s / √n with the standard deviation s of the n values and Student's t for n − 1 degrees of
/// freedom; with fewer than two there is none. `standard_deviation` of the result is this s (zero with fewer
/// than two).
///
/// # Errors
/// [`AnalysisError::TooShort`] without values.
///
/// ```
/// // t(0.975, 1) = 12.706, s / √2 = 1
/// let statistic = analysis::statistics::independent(&[1.0, 3.0])?;
/// assert_eq!(statistic.mean, 2.0);
/// assert!((statistic.half_width_95.unwrap() - 12.706).abs() < 1e-3);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn independent(values: &[f64]) -> Result<Statistic, AnalysisError> {
    if values.is_empty() {
        return Err(AnalysisError::TooShort { n_samples: 0, needed: 1 });
    }
    Ok(Statistic {
        mean: mean(values),
        standard_deviation: sample_deviation(values).unwrap_or(0.0),
        half_width_95: half_width_95(values),
        n_blocks: values.len(),
    })
}

/// Standard error of the mean of `statistic` (its unit), and the degrees of freedom behind it (–): the half
/// width of its interval over Student's t for its n − 1 degrees of freedom, s / √n. None without an interval.
///
/// An interval of few blocks is several times as wide as that of a normal distribution (4.30 standard errors
/// on either side for three), so that a half width over 1.96 is no standard error.
///
/// ```
/// use analysis::statistics::{independent, standard_error};
/// // s = √2, n = 2
/// let (error, freedom) = standard_error(&independent(&[1.0, 3.0])?).unwrap();
/// assert!((error - 1.0).abs() < 1e-12 && freedom == 1);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn standard_error(statistic: &Statistic) -> Option<(f64, usize)> {
    let freedom = statistic.n_blocks.checked_sub(1).filter(|freedom| *freedom > 0)?;
    Some((statistic.half_width_95? / student_97_5(freedom), freedom))
}

/// Turbulence intensity (–): standard deviation of the streamwise velocity `samples` (m/s) over their mean.
///
/// # Errors
/// [`AnalysisError::TooShort`] without samples, [`AnalysisError::ZeroMean`] in still air.
pub fn turbulence_intensity(samples: &[f64]) -> Result<f64, AnalysisError> {
    let whole = statistic(samples, 1.0, f64::MAX)?;
    if whole.mean == 0.0 {
        return Err(AnalysisError::ZeroMean);
    }
    Ok(whole.standard_deviation / whole.mean)
}

/// Mean of each whole block of `block_length` (s) in `samples`, taken every `interval` (s).
///
/// # Errors
/// [`AnalysisError::TooShort`] without samples; [`AnalysisError::NotPositive`] for a block that holds no
/// sample.
pub fn block_means(
    samples: &[f64],
    interval: f64,
    block_length: f64,
) -> Result<Vec<f64>, AnalysisError> {
    Ok(blocks(samples, interval, block_length)?.map(mean).collect())
}

/// The whole blocks of `block_length` (s) in `samples`, taken every `interval` (s).
fn blocks(
    samples: &[f64],
    interval: f64,
    block_length: f64,
) -> Result<impl Iterator<Item = &[f64]>, AnalysisError> {
    if samples.is_empty() {
        return Err(AnalysisError::TooShort { n_samples: 0, needed: 1 });
    }
    let positive = |quantity, value: f64| {
        if value > 0.0 { Ok(()) } else { Err(AnalysisError::NotPositive { quantity, value }) }
    };
    positive("the sampling interval", interval)?;
    positive("the block length", block_length)?;
    let whole = (block_length / interval).round().max(1.0) as usize;
    // Steps rarely divide a block: a sample short of the last one must not cost it.
    let n_blocks = (samples.len() as f64 / whole as f64 + SHORT).floor() as usize;
    let n_samples = whole.min(samples.len() / n_blocks.max(1)).max(1);
    Ok(samples.chunks_exact(n_samples).take(n_blocks))
}

/// Refuses two records of different length.
fn check_lengths(first: &[f64], second: &[f64]) -> Result<(), AnalysisError> {
    let (first, second) = (first.len(), second.len());
    if first == second { Ok(()) } else { Err(AnalysisError::UnequalLengths { first, second }) }
}

/// Half width of the 95 % interval of the mean of `blocks`; none with fewer than two.
fn half_width_95(blocks: &[f64]) -> Option<f64> {
    let deviation = sample_deviation(blocks)?;
    Some(student_97_5(blocks.len() - 1) * deviation / (blocks.len() as f64).sqrt())
}

/// Standard deviation with n − 1 in the denominator; none with fewer than two values.
fn sample_deviation(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let mean = mean(values);
    let sum = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    Some((sum / (values.len() - 1) as f64).sqrt())
}

/// Mean of `samples`, in their unit; no number where there are none.
pub fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len() as f64
}

/// Standard deviation of `samples` with n in the denominator, in their unit; no number where there are none.
pub fn standard_deviation(samples: &[f64]) -> f64 {
    let mean = mean(samples);
    let sum = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
    (sum / samples.len() as f64).sqrt()
}

#[cfg(test)]
mod tests;
