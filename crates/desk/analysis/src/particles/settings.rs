//! How particles are binned.

use super::basis_functions::n_terms;
use super::{Order, ParticlesError};
use basis::records::Grid;

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Standard deviation of the Gaussian weight over the size of a bin (–): a bin ends two of them from its
/// middle.
const GAUSSIAN: f64 = 0.25;
/// Stages of which the means are kept, for convergence (–).
pub(super) const N_STAGES: usize = 4;
/// Samples for each term of a polynomial, for it to be fitted (–).
const SAMPLES_A_TERM: u32 = 2;

/// How particles are binned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BinSettings {
    /// The middles of the bins.
    pub grid: Grid,
    /// Size of a bin along x, y, z (m).
    pub size: [f64; 3],
    /// Highest order that is fitted.
    pub order: Order,
    /// Axes along which velocity may vary within a bin: those along which particles are spread.
    pub axes: [bool; 3],
    /// Samples that a bin has at least (–); one with fewer is empty.
    pub fewest: u32,
}

impl BinSettings {
    /// Bins `spacing` (m) apart that overlap by the share `overlap`, over the `region` (lower and upper end
    /// along x, y, z, m), centred in it; along an axis in which the region is no longer than a bin there is
    /// one.
    ///
    /// # Errors
    /// [`ParticlesError`] for numbers that make no bins, or more than `memory` (bytes) holds.
    pub fn over(
        region: [[f64; 2]; 3],
        spacing: [f64; 3],
        overlap: f64,
        order: Order,
        memory: u64,
    ) -> Result<Self, ParticlesError> {
        if !(0.0..1.0).contains(&overlap) {
            return Err(ParticlesError::Overlap { overlap });
        }
        let mut grid = Grid { origin: [0.0; 3], spacing, n_points: [1; 3] };
        let mut n_bins = 1.0;
        for axis in 0..3 {
            let (spacing, [from, to]) = (spacing[axis], region[axis]);
            if !(spacing.is_finite() && spacing > 0.0) {
                return Err(ParticlesError::Spacing { axis: AXES[axis], spacing });
            }
            if !(from.is_finite() && to.is_finite() && from <= to) {
                return Err(ParticlesError::Region { axis: AXES[axis], from, to });
            }
            // Rounding does not cost a bin.
            let steps = ((to - from) / spacing + 1e-9).floor();
            let is_spanned = to - from > spacing / (1.0 - overlap);
            let steps = if is_spanned { steps } else { 0.0 };
            n_bins *= steps + 1.0;
            grid.origin[axis] = 0.5 * (from + to - steps * spacing);
            grid.n_points[axis] = (steps as usize).saturating_add(1);
        }
        let axes = region.map(|[from, to]| to > from);
        let size = spacing.map(|spacing| spacing / (1.0 - overlap));
        let settings = Self { grid, size, order, axes, fewest: SAMPLES_A_TERM };
        let needed = n_bins * settings.bin_bytes() as f64;
        if needed > memory as f64 {
            return Err(ParticlesError::Memory { n_bins, needed, allowed: memory });
        }
        Ok(settings)
    }

    /// Memory of a bin: its sums, and its means at stages of convergence (bytes).
    pub fn bin_bytes(&self) -> u64 {
        let sums = self.stride() * size_of::<f64>() + size_of::<u32>();
        (sums + N_STAGES * 3 * size_of::<f32>()) as u64
    }

    /// Memory of all bins (bytes).
    pub fn memory(&self) -> u64 {
        self.grid.len() as u64 * self.bin_bytes()
    }

    /// Terms of the highest order (–).
    pub(super) fn n_terms(&self) -> usize {
        n_terms(self.order, self.axes)
    }

    /// Sums of a bin (–): products of terms by the squares of the weights and by the weights, terms times
    /// velocity, products of velocity.
    pub(super) fn stride(&self) -> usize {
        let n = self.n_terms();
        n * (n + 1) + 3 * n + 6
    }

    /// Samples that `order` needs (–).
    pub(super) fn needed(&self, order: Order) -> u32 {
        let n = n_terms(order, self.axes) as u32;
        if order == Order::Constant { self.fewest } else { self.fewest.max(SAMPLES_A_TERM * n) }
    }

    /// Standard deviations of the weight along x, y, z (m).
    pub(super) fn deviations(&self) -> [f64; 3] {
        self.size.map(|size| GAUSSIAN * size)
    }
}
