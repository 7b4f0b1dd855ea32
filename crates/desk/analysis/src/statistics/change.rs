//! Change of a statistic other than the mean, such as a standard deviation or an equivalent load, with its
//! interval.

use super::{blocks, check_lengths, half_width_95, sample_deviation};
use crate::AnalysisError;
use basis::records::Statistic;

/// Change from `compared` to `samples` (same unit, same instants, every `interval` s) of the statistic `of`
/// of a record: ratio of the two minus one (–), with its interval from paired blocks of `block_length` (s).
///
/// The half width is t s / √n with the standard deviation s of the same change in each of the n pairs of
/// blocks; with fewer than two there is none. `standard_deviation` of the result is this s (zero with fewer
/// than two blocks). Both runs have the same wind, so its effect on a block cancels within the pair. For
/// means there is [`gain`](super::gain), whose blocks add up to the whole.
///
/// Limits: variations slower than a block are in the change, not in its interval.
///
/// # Errors
/// [`AnalysisError::UnequalLengths`], [`AnalysisError::NoReference`] where `of` gives zero for `compared` or
/// a block of it, those of `of`, and those of [`statistic`](super::statistic).
///
/// ```
/// # use analysis::statistics::{change, standard_deviation};
/// // Swings of 1 and 2 become swings of 1.1 and 2.4: by 10 % and by 20 %, t(0.975, 1) = 12.706.
/// let wave = |sizes: [f64; 2]| sizes.map(|size| [size, -size].repeat(300)).concat();
/// let deviation = |samples: &[f64]| Ok(standard_deviation(samples));
/// let change = change(&wave([1.1, 2.4]), &wave([1.0, 2.0]), 1.0, 600.0, deviation)?;
/// assert!((change.mean - ((1.21_f64 + 5.76) / 5.0).sqrt() + 1.0).abs() < 1e-12);
/// assert!((change.half_width_95.unwrap() - 12.706 * 0.05).abs() < 1e-4);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn change(
    samples: &[f64],
    compared: &[f64],
    interval: f64,
    block_length: f64,
    of: impl Fn(&[f64]) -> Result<f64, AnalysisError>,
) -> Result<Statistic, AnalysisError> {
    change_together(&[[samples, compared]], interval, block_length, of)
}

/// The same of the sum of the statistics of several records, such as the load of all turbines together:
/// `pairs` of samples and what they are compared with, each record on its own.
///
/// # Errors
/// Those of [`change`].
///
/// ```
/// # use analysis::statistics::{change_together, standard_deviation};
/// let wave = |size: f64| [size, -size].repeat(600);
/// let (first, second) = ([wave(3.0), wave(2.0)], [wave(1.0), wave(2.0)]);
/// let pairs = [[&first[0][..], &first[1]], [&second[0][..], &second[1]]];
/// let deviation = |samples: &[f64]| Ok(standard_deviation(samples));
/// // 3 + 1 over 2 + 2.
/// assert!(change_together(&pairs, 1.0, 600.0, deviation)?.mean.abs() < 1e-12);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn change_together(
    pairs: &[[&[f64]; 2]],
    interval: f64,
    block_length: f64,
    of: impl Fn(&[f64]) -> Result<f64, AnalysisError>,
) -> Result<Statistic, AnalysisError> {
    let change = |pairs: &mut dyn Iterator<Item = [&[f64]; 2]>| -> Result<f64, AnalysisError> {
        let (mut now, mut before) = (0.0, 0.0);
        for [samples, compared] in pairs {
            now += of(samples)?;
            before += of(compared)?;
        }
        if before == 0.0 {
            return Err(AnalysisError::NoReference);
        }
        Ok(now / before - 1.0)
    };
    let mut in_blocks: Vec<Vec<[&[f64]; 2]>> = Vec::new();
    for [samples, compared] in pairs {
        check_lengths(samples, compared)?;
        let pairs =
            blocks(samples, interval, block_length)?.zip(blocks(compared, interval, block_length)?);
        in_blocks.push(pairs.map(|(samples, compared)| [samples, compared]).collect());
    }
    let n_blocks = in_blocks.iter().map(Vec::len).min().unwrap_or(0);
    let changes = (0..n_blocks).map(|block| change(&mut in_blocks.iter().map(|own| own[block])));
    let changes = changes.collect::<Result<Vec<f64>, _>>()?;
    Ok(Statistic {
        mean: change(&mut pairs.iter().copied())?,
        standard_deviation: sample_deviation(&changes).unwrap_or(0.0),
        half_width_95: half_width_95(&changes),
        n_blocks: changes.len(),
    })
}
