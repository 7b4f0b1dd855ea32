//! Normally distributed numbers from a seed.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// A stream of independent numbers of mean zero and variance one (–).
pub(crate) struct Normals {
    seeded: ChaCha8Rng,
}

impl Normals {
    /// The stream of `seed`.
    pub(crate) fn new(seed: u64) -> Self {
        Self { seeded: ChaCha8Rng::seed_from_u64(seed) }
    }

    /// The next number. Box and Muller, Ann. Math. Statist. 29, 1958; the second of each pair is not used.
    pub(crate) fn next(&mut self) -> f64 {
        // In (0, 1], whose logarithm is finite.
        let mut uniform = || ((self.seeded.next_u64() >> 11) as f64 + 1.0) / (1_u64 << 53) as f64;
        let (radius, turn) = ((-2.0 * uniform().ln()).sqrt(), uniform());
        radius * (TAU * turn).cos()
    }
}
