//! Random numbers that belong to a seed, a channel and a reading.

use basis::mixed;
use std::f64::consts::TAU;

/// The random numbers of one reading.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Draw {
    pub(crate) seed: u64,
    pub(crate) channel: usize,
    pub(crate) reading: u64,
}

impl Draw {
    /// Uniform between 0 and 1, neither of them.
    pub(crate) fn uniform(self) -> f64 {
        self.number(0)
    }

    /// Normal, mean 0, variance 1; independent of [`Draw::uniform`]. Box and Muller's.
    pub(crate) fn normal(self) -> f64 {
        (-2.0 * self.number(1).ln()).sqrt() * (TAU * self.number(2)).cos()
    }

    fn number(self, which: u64) -> f64 {
        let place = self.reading.wrapping_mul(4).wrapping_add(which);
        let key = mixed(self.seed ^ mixed(self.channel as u64));
        let bits = mixed(key.wrapping_add(place.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        ((bits >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }
}
