//! The H2 norm and the H-infinity norm.

use super::dense::{
    blocks, complex, eigenvalues, identity, inverse, largest_singular_value, transposed,
};
use super::{MatrixError, StateSpace, inverse_bilinear};
use num_complex::Complex64;

/// Share (–) by which a level is above the largest gain found when it is tested for being an upper bound.
const STEP: f64 = 1e-7;
/// Real part of an eigenvalue, as a share of its modulus, up to which it may be on the imaginary axis.
const NEAR_AXIS: f64 = 1e-4;
/// Levels that are tested at most.
const MOST_LEVELS: usize = 60;

/// The largest gain over all frequencies, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeakGain {
    /// Largest singular value over all frequencies: outputs' unit per inputs' unit.
    pub gain: f64,
    /// Frequency (rad/s); infinite where the gain is largest beyond all frequencies.
    pub frequency: f64,
}

impl StateSpace {
    /// H2 norm of a stable system; in continuous time without gain at infinite frequency.
    ///
    /// Source: Zhou, Doyle and Glover, "Robust and Optimal Control", 1996, Lemma 4.6 and §21.3.
    pub fn h2_norm(&self) -> Result<f64, MatrixError> {
        if self.interval.is_none() && self.d.norm_max() > 0.0 {
            self.stable_or_error()?;
            return Err(MatrixError::InfiniteNorm);
        }
        let gramian = self.controllability_gramian()?;
        let seen = &self.c * &gramian * self.c.transpose();
        let direct = &self.d * self.d.transpose();
        let trace: f64 = (0..self.outputs()).map(|i| seen[(i, i)] + direct[(i, i)]).sum();
        Ok(trace.max(0.0).sqrt())
    }

    /// H-infinity norm of a stable system, within about 1e-7 of itself, by the Hamiltonian's eigenvalues on
    /// the imaginary axis; a system in discrete time goes through the bilinear transformation.
    ///
    /// Source: Bruinsma and Steinbuch, "A fast algorithm to compute the H-infinity norm of a transfer
    /// function matrix", Systems & Control Letters 14, 1990.
    pub fn h_infinity_norm(&self) -> Result<PeakGain, MatrixError> {
        self.stable_or_error()?;
        let Some(interval) = self.interval else {
            return continuous_norm(self);
        };
        let peak = continuous_norm(&inverse_bilinear(self)?)?;
        let frequency = 2.0 / interval * (0.5 * peak.frequency * interval).atan();
        Ok(PeakGain { frequency, ..peak })
    }

    /// Frequencies (rad/s) at which a singular value of the response may be `level`: those of the
    /// Hamiltonian's eigenvalues on or near the imaginary axis, smallest first. Continuous time.
    ///
    /// Source: Boyd, Balakrishnan and Kabamba, Math. Control Signals Systems 2, 1989, Theorem 2.
    pub fn frequencies_with_gain(&self, level: f64) -> Result<Vec<f64>, MatrixError> {
        if self.interval.is_some() {
            return Err(MatrixError::Time { needed: "continuous" });
        }
        if self.order() == 0 {
            return Ok(Vec::new());
        }
        // Inputs and outputs share the level, so that the blocks are of one size.
        let share = 1.0 / level.sqrt();
        let (b, c, d) = (share * &self.b, share * &self.c, (1.0 / level) * &self.d);
        let singular = || MatrixError::Singular("the gain at infinite frequency less the level");
        let inner =
            inverse(&(identity(self.inputs()) - d.transpose() * &d)).ok_or_else(singular)?;
        let outer =
            inverse(&(identity(self.outputs()) - &d * d.transpose())).ok_or_else(singular)?;
        let a = &self.a + &b * &inner * d.transpose() * &c;
        let top = &b * &inner * b.transpose();
        let bottom = -(c.transpose() * &outer * &c);
        let hamiltonian = blocks(&[&[&a, &top], &[&bottom, &(-transposed(&a))]]);
        Ok(on_axis(&eigenvalues(&hamiltonian)?))
    }
}

/// Moduli of the imaginary parts of values that are near the imaginary axis, smallest first.
pub(super) fn on_axis(values: &[Complex64]) -> Vec<f64> {
    let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    let near = |value: &&Complex64| {
        value.re.abs() <= NEAR_AXIS * value.norm() + f64::EPSILON.sqrt() * 1e-3 * largest
    };
    let mut frequencies: Vec<f64> =
        values.iter().filter(near).map(|value| value.im.abs()).collect();
    frequencies.sort_by(f64::total_cmp);
    frequencies.dedup_by(|a, b| (*a - *b).abs() <= 1e-14 * b.abs());
    frequencies
}

/// The norm of a stable system in continuous time.
fn continuous_norm(system: &StateSpace) -> Result<PeakGain, MatrixError> {
    let at_infinity = largest_singular_value(&complex(&system.d))?;
    let mut best = PeakGain { gain: at_infinity, frequency: f64::INFINITY };
    let mut first = vec![0.0];
    first.extend(system.poles()?.iter().flat_map(|pole| [pole.norm(), pole.im.abs()]));
    raise(system, &first, &mut best)?;
    for _ in 0..MOST_LEVELS {
        if best.gain == 0.0 {
            // All gains that were looked at are zero; a few more tell whether the system is.
            raise(system, &[1e-3, 0.1, 1.0, 10.0, 1e3], &mut best)?;
            if best.gain == 0.0 {
                return Ok(best);
            }
        }
        let found = best.gain;
        let crossings = system.frequencies_with_gain(found * (1.0 + 2.0 * STEP))?;
        let mut tried = crossings.clone();
        tried.extend(crossings.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])));
        tried.extend(crossings.windows(2).map(|pair| (pair[0] * pair[1]).sqrt()));
        raise(system, &tried, &mut best)?;
        if best.gain <= found * (1.0 + 2.0 * STEP) {
            polish(system, &mut best)?;
            return Ok(best);
        }
    }
    Err(MatrixError::NotConverged("the H-infinity norm"))
}

/// Raises the largest gain found to that at the top of its peak, by golden section.
fn polish(system: &StateSpace, best: &mut PeakGain) -> Result<(), MatrixError> {
    if !(best.frequency > 0.0 && best.frequency.is_finite()) {
        return Ok(());
    }
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let (centre, mut low, mut high) = (best.frequency, -1e-3_f64, 1e-3_f64);
    for _ in 0..24 {
        let width = golden * (high - low);
        let (right, left) = (low + width, high - width);
        let frequencies = [centre * left.exp(), centre * right.exp()];
        let mut gains = [0.0; 2];
        for (gain, frequency) in gains.iter_mut().zip(frequencies) {
            *gain = largest_singular_value(&system.response(frequency)?)?;
            if *gain > best.gain {
                *best = PeakGain { gain: *gain, frequency };
            }
        }
        if gains[0] > gains[1] {
            high = right;
        } else {
            low = left;
        }
    }
    Ok(())
}

/// Raises the largest gain found to that at `frequencies` (rad/s).
fn raise(system: &StateSpace, frequencies: &[f64], best: &mut PeakGain) -> Result<(), MatrixError> {
    for &frequency in frequencies {
        let gain = largest_singular_value(&system.response(frequency)?)?;
        if gain > best.gain {
            *best = PeakGain { gain, frequency };
        }
    }
    Ok(())
}
