//! Random numbers from a seed.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// A stream of random numbers: the same for the same seed.
pub(crate) struct Draws {
    seeded: ChaCha8Rng,
}

impl Draws {
    /// The stream number `stream` of `seed`; different streams are independent.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut seeded = ChaCha8Rng::seed_from_u64(seed);
        seeded.set_stream(stream);
        Self { seeded }
    }

    /// A number in (0, 1].
    pub(crate) fn uniform(&mut self) -> f64 {
        ((self.seeded.next_u64() >> 11) as f64 + 1.0) / (1_u64 << 53) as f64
    }

    /// A number of mean zero and variance one. Box and Muller, Ann. Math. Statist. 29, 1958.
    pub(crate) fn normal(&mut self) -> f64 {
        let (radius, turn) = ((-2.0 * self.uniform().ln()).sqrt(), self.uniform());
        radius * (TAU * turn).cos()
    }

    /// χ² of `freedom` degrees.
    pub(crate) fn chi_square(&mut self, freedom: usize) -> f64 {
        (0..freedom).map(|_| self.normal().powi(2)).sum()
    }

    /// The numbers below `n` in random order.
    pub(crate) fn order(&mut self, n: usize) -> Vec<usize> {
        let mut keyed: Vec<(f64, usize)> = (0..n).map(|index| (self.uniform(), index)).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        keyed.into_iter().map(|(_, index)| index).collect()
    }
}
