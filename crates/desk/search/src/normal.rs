//! The normal distribution.

use std::f64::consts::{SQRT_2, TAU};

/// 97.5 % point (–).
pub(crate) const NORMAL_97_5: f64 = 1.959_963_984_540_054;

/// Density at `z` (–).
pub(crate) fn density(z: f64) -> f64 {
    (-0.5 * z * z).exp() / TAU.sqrt()
}

/// Probability of less than `z` (–).
pub(crate) fn probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// Mean of what a normal number of `mean` and `deviation` exceeds `least` by, zero where it does not (same
/// unit). Jones et al., "Efficient global optimization of expensive black-box functions", J. Global Optim.
/// 13, 1998, Eq. 15.
pub(crate) fn excess(mean: f64, deviation: f64, least: f64) -> f64 {
    let above = mean - least;
    if deviation <= 0.0 {
        return above.max(0.0);
    }
    let z = above / deviation;
    (above * probability(z) + deviation * density(z)).max(0.0)
}

/// The value at `share` of the way through ascending `sorted` values, between neighbours along a line.
pub(crate) fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let low = place.floor() as usize;
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] + (place - low as f64) * (sorted[high] - sorted[low])
}
