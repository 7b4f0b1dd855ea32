//! What bins say of particles.

use super::Order;
use basis::records::{Grid, Moments};

/// Velocity on a grid, from particles; not a number where there were too few.
#[derive(Clone, Debug, PartialEq)]
pub struct Binned {
    /// The middles of the bins.
    pub grid: Grid,
    /// Size of a bin along x, y, z (m).
    pub size: [f64; 3],
    /// Order of the polynomial of each bin; none where it is empty.
    pub order: Vec<Option<Order>>,
    /// Samples of each bin, mean velocity at its middle (m/s), and stresses of what the polynomial leaves
    /// (m²/s²).
    pub moments: Moments,
    /// Standard error of the means of u, v, w (m/s): samples are taken for independent, which those of one
    /// track are not.
    pub error: [Vec<f32>; 3],
    /// Gradient of u, v, w along x, y, z (1/s): `gradient[component][axis]`; not a number where a bin has a
    /// mean alone.
    pub gradient: [[Vec<f32>; 3]; 3],
    /// How the means converged, stage by stage; all samples last.
    pub convergence: Vec<Convergence>,
    /// What was taken in, and what was not.
    pub tally: Tally,
}

impl Binned {
    /// Bins with a polynomial of `order`.
    pub fn n_of(&self, order: Order) -> usize {
        self.order.iter().filter(|of| **of == Some(order)).count()
    }

    /// Median, over the bins that are not empty, of the samples in a bin (–); zero where all are empty.
    pub fn median_samples(&self) -> u32 {
        let pairs = self.moments.n_samples.iter().zip(&self.order);
        let mut n: Vec<u32> = pairs.filter(|(_, o)| o.is_some()).map(|(n, _)| *n).collect();
        n.sort_unstable();
        n.get(n.len() / 2).copied().unwrap_or(0)
    }
}

/// Means after a part of the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// Particles so far (–).
    pub n_taken: u64,
    /// Root of the mean square of the difference of u, v, w to the last means (m/s), over bins that had a
    /// mean then.
    pub change: f64,
    /// Root of the mean square of the standard errors then (m/s).
    pub error: f64,
}

/// How many particles and bins came to what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Particles that were taken in (–).
    pub n_taken: u64,
    /// Particles without a number somewhere, left out (–).
    pub n_holes: u64,
    /// Outliers, left out (–).
    pub n_outliers: u64,
    /// Particles outside all bins (–).
    pub n_outside: u64,
    /// Bins without a sample (–).
    pub n_empty: u64,
    /// Bins with fewer samples than are needed (–).
    pub n_thin: u64,
}
