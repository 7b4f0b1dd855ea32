//! Poles, stability, and modes that no input moves or no output shows.

use super::dense::{complex, complex_singular_values, eigenvalues};
use super::{MatrixError, StateSpace};
use faer::Mat;
use num_complex::Complex64;

/// Smallest singular value of (λ I − A, B), as a share of the matrices' norm, below which no input moves
/// the mode λ.
const UNMOVED: f64 = 1e-9;

impl StateSpace {
    /// Poles (rad/s in continuous time, – in discrete time), in no particular order.
    pub fn poles(&self) -> Result<Vec<Complex64>, MatrixError> {
        eigenvalues(&self.a)
    }

    /// How far `pole` is beyond the border of stability: its real part (rad/s), or its modulus less one
    /// (–).
    pub fn growth(&self, pole: Complex64) -> f64 {
        if self.interval.is_some() { pole.norm() - 1.0 } else { pole.re }
    }

    /// The pole that is nearest to instability or furthest beyond it; none without a state.
    pub fn least_stable_pole(&self) -> Result<Option<Complex64>, MatrixError> {
        let poles = self.poles()?;
        Ok(poles.into_iter().max_by(|a, b| self.growth(*a).total_cmp(&self.growth(*b))))
    }

    /// Whether all poles are strictly inside the stable region.
    pub fn is_stable(&self) -> Result<bool, MatrixError> {
        Ok(self.least_stable_pole()?.is_none_or(|pole| self.growth(pole) < 0.0))
    }

    /// An error that names a pole where the system is not stable.
    pub fn stable_or_error(&self) -> Result<(), MatrixError> {
        match self.least_stable_pole()? {
            Some(pole) if self.growth(pole) >= 0.0 => Err(MatrixError::Unstable { pole }),
            _ => Ok(()),
        }
    }

    /// A pole that is not stable and that no input moves (test of Popov, Belevitch and Hautus).
    pub fn unstabilisable_mode(&self) -> Result<Option<Complex64>, MatrixError> {
        let border = UNMOVED * self.a.norm_l2();
        for pole in self.poles()? {
            if self.growth(pole) < -border {
                continue;
            }
            let n = self.order();
            let moved = Mat::from_fn(n, n + self.inputs(), |i, j| {
                if j >= n {
                    return Complex64::new(self.b[(i, j - n)], 0.0);
                }
                (if i == j { pole } else { Complex64::default() }) - self.a[(i, j)]
            });
            let smallest = complex_singular_values(&moved)?.last().copied().unwrap_or(0.0);
            if smallest <= UNMOVED * complex(&self.a).norm_l2().max(self.b.norm_l2()) {
                return Ok(Some(pole));
            }
        }
        Ok(None)
    }

    /// A pole that is not stable and that no output shows (test of Popov, Belevitch and Hautus).
    pub fn undetectable_mode(&self) -> Result<Option<Complex64>, MatrixError> {
        self.dual().unstabilisable_mode()
    }
}
