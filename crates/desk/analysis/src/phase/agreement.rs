//! Agreement of an estimated phase with the true one, over time.

use crate::AnalysisError;
use crate::statistics::{block_means, mean, statistic};
use basis::angle::wrap_to_half_turn;

/// Agreement of two phases on the circle; all intervals from means of blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agreement {
    /// Root mean square of the difference, each on the shorter way round (rad, [0, π]).
    pub rmse: f64,
    /// 95 % interval of `rmse` (rad): of the mean square by Student's t, its root; absent with fewer than two
    /// blocks.
    pub rmse_95: Option<[f64; 2]>,
    /// Blocks behind all intervals (–); one degree of freedom less.
    pub n_blocks: usize,
    /// Circular mean of estimate minus truth (rad, [−π, π)): a constant correction would remove it.
    pub bias: f64,
    /// Half width of the 95 % interval of `bias` (rad); absent with fewer than two blocks.
    pub bias_half_width_95: Option<f64>,
    /// Root mean square of the difference without the bias (rad).
    pub spread: f64,
    /// Phase locking |mean of e^{iΔ}| (–): 1 for a constant difference, 0 for one that goes round.
    pub locking: f64,
}

/// Agreement of the phases `estimated` with `truth` (rad, any turn), one each `interval` (s), intervals from
/// blocks of `block_length` (s).
///
/// Source: van Vondelen et al. (2025), §3.3.4 (RMSE, phase error); Mardia and Jupp, "Directional Statistics",
/// 2000, §2.2-2.3 (mean direction and resultant length).
/// Limits: an interval is right as far as the means of blocks are independent.
///
/// # Errors
/// [`AnalysisError::UnequalLengths`], [`AnalysisError::TooShort`] without samples,
/// [`AnalysisError::NotFinite`], [`AnalysisError::NotPositive`] for an interval or block without length.
pub fn agreement(
    estimated: &[f64],
    truth: &[f64],
    interval: f64,
    block_length: f64,
) -> Result<Agreement, AnalysisError> {
    if estimated.len() != truth.len() {
        let (first, second) = (estimated.len(), truth.len());
        return Err(AnalysisError::UnequalLengths { first, second });
    }
    let pairs = || estimated.iter().zip(truth);
    if let Some(index) = pairs().position(|(a, b)| !(a - b).is_finite()) {
        return Err(AnalysisError::NotFinite { index });
    }
    let differences: Vec<f64> = pairs().map(|(a, b)| wrap_to_half_turn(a - b)).collect();
    let squares: Vec<f64> = differences.iter().map(|d| d * d).collect();
    let square = statistic(&squares, interval, block_length)?;
    let cosines: Vec<f64> = differences.iter().map(|d| d.cos()).collect();
    let sines: Vec<f64> = differences.iter().map(|d| d.sin()).collect();
    let (cosine, sine) = (mean(&cosines), mean(&sines));
    let bias = wrap_to_half_turn(sine.atan2(cosine));
    let of_blocks: Vec<f64> = block_means(&cosines, interval, block_length)?
        .iter()
        .zip(&block_means(&sines, interval, block_length)?)
        .map(|(cosine, sine)| wrap_to_half_turn(sine.atan2(*cosine) - bias))
        .collect();
    let rest = differences.iter().map(|d| wrap_to_half_turn(d - bias).powi(2)).sum::<f64>();
    Ok(Agreement {
        rmse: square.mean.sqrt(),
        rmse_95: square
            .half_width_95
            .map(|half| [square.mean - half, square.mean + half].map(|end| end.max(0.0).sqrt())),
        n_blocks: square.n_blocks,
        bias,
        bias_half_width_95: match of_blocks.as_slice() {
            [] => None,
            blocks => statistic(blocks, 1.0, 1.0)?.half_width_95,
        },
        spread: (rest / differences.len() as f64).sqrt(),
        locking: cosine.hypot(sine),
    })
}
