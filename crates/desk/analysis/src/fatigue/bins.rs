//! Cycles sorted into bins of range.

use super::load::check_duration;
use super::{Cycle, Damage, REFERENCE_FREQUENCY};
use crate::AnalysisError;
use std::num::NonZeroUsize;

/// Cycles in equal bins from zero to the largest range, as published studies count them (200 in van der Hoek
/// et al.).
///
/// A cycle in a bin does the damage of the bin's middle, so that the equivalent load differs from that of the
/// cycles themselves by at most half a bin times (cycles / N_eq)^(1/m).
#[derive(Clone, Debug, PartialEq)]
pub struct RangeBins {
    width: f64,
    counts: Vec<f64>,
}

impl RangeBins {
    /// Sorts `cycles` into `n_bins` bins.
    pub fn new(cycles: &[Cycle], n_bins: NonZeroUsize) -> Self {
        let n_bins = n_bins.get();
        let largest = cycles.iter().map(|cycle| cycle.range).fold(0.0, f64::max);
        let width = largest / n_bins as f64;
        let mut counts = vec![0.0; n_bins];
        for cycle in cycles {
            // One rounding alone, so that whole numbers fall on the edges that they are on; the largest range
            // belongs to the last bin.
            let bin = ((cycle.range * n_bins as f64 / largest) as usize).min(n_bins - 1);
            counts[bin] += cycle.count;
        }
        Self { width, counts }
    }

    /// Width of a bin, in the unit of the load.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Cycles in each bin (–), smallest ranges first.
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    /// Range at the middle of bin `index`, in the unit of the load.
    pub fn middle(&self, index: usize) -> f64 {
        (index as f64 + 0.5) * self.width
    }

    /// 1-Hz damage-equivalent load for the slope `slope` (–) over `duration` (s), peak to peak in the unit of
    /// the load.
    ///
    /// Source: van der Hoek et al., Eq. 8 (see [the module](super)).
    ///
    /// # Errors
    /// [`AnalysisError::Slope`], [`AnalysisError::NotPositive`].
    pub fn equivalent_load(&self, slope: f64, duration: f64) -> Result<f64, AnalysisError> {
        check_duration(duration)?;
        let mut damage = Damage::new(slope)?;
        for (index, count) in self.counts.iter().enumerate().rev() {
            damage.add(self.middle(index), *count);
        }
        Ok(damage.equivalent_load(REFERENCE_FREQUENCY * duration))
    }
}
