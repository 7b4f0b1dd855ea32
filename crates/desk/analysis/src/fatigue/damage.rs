//! Linear damage accumulation, from cycles to one equivalent load.

use crate::AnalysisError;

/// Damage of loads after Palmgren and Miner with a straight S-N line: Σ count · load^m.
///
/// The sum is kept relative to the largest load, so that no unit overflows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Damage {
    slope: f64,
    /// The slope where it is a whole number, which is faster to raise to.
    whole_slope: Option<i32>,
    largest: f64,
    sum: f64,
}

impl Damage {
    /// No damage yet, for the slope `slope` (–), Wöhler's exponent m.
    ///
    /// # Errors
    /// [`AnalysisError::Slope`] unless it is a number of at least 1.
    pub fn new(slope: f64) -> Result<Self, AnalysisError> {
        if !slope.is_finite() || slope < 1.0 {
            return Err(AnalysisError::Slope { slope });
        }
        let whole_slope = (slope.fract() == 0.0 && slope <= 64.0).then_some(slope as i32);
        Ok(Self { slope, whole_slope, largest: 0.0, sum: 0.0 })
    }

    /// Wöhler's exponent m (–).
    pub fn slope(&self) -> f64 {
        self.slope
    }

    /// Adds `count` (any unit) times the damage of `load` (any unit), which is finite; a load of zero or less
    /// does none.
    #[inline]
    pub fn add(&mut self, load: f64, count: f64) {
        if load > self.largest {
            self.sum *= self.power(self.largest / load);
            self.largest = load;
        }
        if load > 0.0 {
            self.sum += count * self.power(load / self.largest);
        }
    }

    /// The one load, in the unit of the loads, that does the same damage `n_equivalent` times (unit of the
    /// counts, > 0).
    pub fn equivalent_load(&self, n_equivalent: f64) -> f64 {
        self.largest * (self.sum / n_equivalent).powf(1.0 / self.slope)
    }

    #[inline]
    fn power(&self, ratio: f64) -> f64 {
        self.whole_slope.map_or_else(|| ratio.powf(self.slope), |slope| ratio.powi(slope))
    }
}
