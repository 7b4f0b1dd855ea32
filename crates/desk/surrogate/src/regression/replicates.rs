//! Observations of the same input.

use super::problem::Problem;
use crate::SurrogateError;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

impl Problem {
    /// # Errors
    /// [`SurrogateError::Replicates`] where replicates without any noise differ.
    pub(crate) fn check_replicates(&self, is_noiseless: bool) -> Result<(), SurrogateError> {
        let differs =
            |index: &usize| is_noiseless && self.known[*index] == 0.0 && self.within[*index] > 0.0;
        match (0..self.len()).find(differs) {
            Some(place) => {
                Err(SurrogateError::Replicates { place, n: self.counts[place] as usize })
            }
            None => Ok(()),
        }
    }

    /// Numbers of the observations at each different input, in the order in which inputs come first.
    pub(crate) fn blocks(&self) -> Vec<Vec<usize>> {
        let mut place_of: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
        let mut blocks: Vec<Vec<usize>> = Vec::new();
        for index in 0..self.len() {
            let key = self.inputs.iter().map(|column| (column[index] + 0.0).to_bits()).collect();
            let place = *place_of.entry(key).or_insert(blocks.len());
            if place == blocks.len() {
                blocks.push(Vec::new());
            }
            blocks[place].push(index);
        }
        blocks
    }

    /// Share of each observation of `block` in the mean of all its replicates (–).
    pub(crate) fn shares(&self, block: &[usize]) -> Vec<f64> {
        let n: f64 = block.iter().map(|index| self.counts[*index]).sum();
        block.iter().map(|index| self.counts[*index] / n).collect()
    }

    /// Noise variance of the mean of all replicates of `block` where the groups have `noise`: with a variance
    /// v of each of n, Σ v / n².
    pub(crate) fn variance_of_mean(&self, block: &[usize], noise: &[f64]) -> f64 {
        let shares = self.shares(block);
        let of_one = |(index, share): (&usize, f64)| {
            share * share * self.variance(*index, noise) / self.counts[*index]
        };
        block.iter().zip(shares).map(of_one).sum()
    }

    /// What replicates about their means add to the logarithm of the likelihood; all of it counted in the
    /// values' own unit.
    ///
    /// Of r replicates with variance v: Π N(yᵢ; f, v) = N(ȳ; f, v/r) (2πv)^(−(r−1)/2) r^(−1/2) exp(−S/(2v)),
    /// S being the sum of squares about ȳ.
    pub(crate) fn log_of_replicates(&self, noise: &[f64]) -> f64 {
        let of_one = |index: usize| {
            let (count, variance) = (self.counts[index], self.variance(index, noise));
            // Replicates that agree, where nothing is noisy, say no more than one of them.
            if count == 1.0 || variance == 0.0 {
                return 0.0;
            }
            let within = self.within[index] / variance;
            (count - 1.0) * (TAU * variance).ln() + within + count.ln()
        };
        let sum: f64 = (0..self.len()).map(of_one).sum();
        -0.5 * sum - self.n_observations() * self.scaling.scale.ln()
    }

    /// Derivatives of [`log_of_replicates`](Self::log_of_replicates) by the logarithms of the noise.
    pub(crate) fn slopes_of_replicates(&self, noise: &[f64]) -> Vec<f64> {
        let mut slopes = vec![0.0; self.n_groups];
        for index in (0..self.len()).filter(|index| self.counts[*index] > 1.0) {
            let Some(slope) = slopes.get_mut(self.groups[index]) else { continue };
            if self.variance(index, noise) == 0.0 {
                continue;
            }
            let share = noise[self.groups[index]] / self.variance(index, noise);
            let within = self.within[index] / self.variance(index, noise);
            *slope -= 0.5 * share * (self.counts[index] - 1.0 - within);
        }
        slopes
    }
}
