//! The budget of mean kinetic energy in a control volume.

use crate::grids::slopes;
use basis::records::{Grid, stress_of};

/// Mean flow on a grid that spans a volume.
#[derive(Clone, Copy, Debug)]
pub struct MeanFlow<'a> {
    /// The points.
    pub grid: &'a Grid,
    /// Mean velocity (m/s).
    pub mean: &'a [Vec<f64>; 3],
    /// Stresses (m²/s²), in the order of [`basis::records::STRESSES`].
    pub stress: &'a [Vec<f64>; 6],
    /// Mean pressure over density (m²/s²), but for a constant; none where it was not recorded.
    pub pressure: Option<&'a [f64]>,
}

/// A box of grid points: steps of the first and the last along x, y, z, both on its faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// First and last step along each axis.
    pub steps: [[usize; 2]; 3],
}

/// What changes the mean kinetic energy in a control volume, over density (m⁵/s³). What comes in is positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// Carried in by the mean flow, through all faces: −∮ ½ūᵢūᵢ ūⱼnⱼ dA (m⁵/s³).
    pub advection: f64,
    /// Work of the mean pressure: −∮ p̄ ūⱼnⱼ dA (m⁵/s³); zero where there is none on record.
    pub pressure: f64,
    /// Carried in by stresses: −∮ ūᵢ⟨uᵢ'uⱼ'⟩nⱼ dA (m⁵/s³).
    pub turbulent_flux: f64,
    /// Handed over to fluctuations, a loss where it is negative: ∫ ⟨uᵢ'uⱼ'⟩ ∂ūᵢ/∂xⱼ dV (m⁵/s³).
    pub production: f64,
    /// The flux by stresses through the faces along the wind, that is without those across it (m⁵/s³).
    pub through_sides: f64,
    /// Sizes of all parts of the flux, added: what a residual is measured by (m⁵/s³).
    pub scale: f64,
    /// Volume (m³).
    pub volume: f64,
}

impl Budget {
    /// What is left of the sum of all: zero in a closed budget of steady mean flow without a rotor in it. It
    /// holds what was not recorded: work of viscous and subgrid stresses, and of pressure where there is
    /// none.
    pub fn residual(&self) -> f64 {
        self.advection + self.pressure + self.turbulent_flux + self.production
    }
}

/// The budget of `flow` in `region`; none where a value in it is no number, or it has no extent along an
/// axis.
///
/// Trapezia over faces and volume, slopes by central differences: of second order in the spacing.
/// Source: the transport equation of mean kinetic energy, Cal et al. (2010), J. Renew. Sustain. Energy 2,
/// 013106, integrated over the volume.
pub fn budget(flow: &MeanFlow, region: &Region) -> Option<Budget> {
    let grid = flow.grid;
    let is_sound = |axis: usize| {
        let [first, last] = region.steps[axis];
        first < last && last < grid.n_points[axis]
    };
    if !(0..3).all(is_sound) {
        return None;
    }
    let mut found = Budget::default();
    for axis in 0..3 {
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let [advection, pressure, turbulent] = through_face(flow, region, axis, side);
            found.advection += sign * advection;
            found.pressure += sign * pressure;
            found.turbulent_flux += sign * turbulent;
            found.scale += advection.abs() + pressure.abs() + turbulent.abs();
            if axis > 0 {
                found.through_sides += sign * turbulent;
            }
        }
    }
    found.production = production(flow, region);
    let lengths = (0..3)
        .map(|axis| (region.steps[axis][1] - region.steps[axis][0]) as f64 * grid.spacing[axis]);
    found.volume = lengths.product();
    found.residual().is_finite().then_some(found)
}

/// Weight of `step` of the trapezia between `ends` (–).
fn weight(step: usize, ends: [usize; 2]) -> f64 {
    if ends.contains(&step) { 0.5 } else { 1.0 }
}

/// What flow, pressure and stresses carry along `axis` through the face at its first (0) or last (1) step.
fn through_face(flow: &MeanFlow, region: &Region, axis: usize, side: usize) -> [f64; 3] {
    let grid = flow.grid;
    let [a, b] = match axis {
        0 => [1, 2],
        1 => [0, 2],
        _ => [0, 1],
    };
    let area = grid.spacing[a] * grid.spacing[b];
    let mut sums = [0.0; 3];
    for second in region.steps[b][0]..=region.steps[b][1] {
        for first in region.steps[a][0]..=region.steps[a][1] {
            let mut place = [0; 3];
            (place[axis], place[a], place[b]) = (region.steps[axis][side], first, second);
            let index = grid.index(place);
            let share = area * weight(first, region.steps[a]) * weight(second, region.steps[b]);
            let mean = flow.mean.each_ref().map(|values| values[index]);
            let energy = 0.5 * mean.iter().map(|u| u * u).sum::<f64>();
            let stress: f64 =
                (0..3).map(|i| mean[i] * flow.stress[stress_of(i, axis)][index]).sum();
            sums[0] += share * energy * mean[axis];
            sums[1] += share * flow.pressure.map_or(0.0, |pressure| pressure[index]) * mean[axis];
            sums[2] += share * stress;
        }
    }
    sums
}

/// ∫ ⟨uᵢ'uⱼ'⟩ ∂ūᵢ/∂xⱼ dV.
fn production(flow: &MeanFlow, region: &Region) -> f64 {
    let grid = flow.grid;
    let mut sum = 0.0;
    for component in 0..3 {
        for axis in 0..3 {
            let slopes = slopes(grid, &flow.mean[component], axis);
            let stress = &flow.stress[stress_of(component, axis)];
            sum += over_volume(grid, region, |index| slopes[index] * stress[index]);
        }
    }
    sum
}

/// The integral of `values` over `region` by trapezia.
fn over_volume(grid: &Grid, region: &Region, values: impl Fn(usize) -> f64) -> f64 {
    let [x, y, z] = region.steps;
    let mut sum = 0.0;
    for k in z[0]..=z[1] {
        for j in y[0]..=y[1] {
            for i in x[0]..=x[1] {
                let share = weight(i, x) * weight(j, y) * weight(k, z);
                sum += share * values(grid.index([i, j, k]));
            }
        }
    }
    sum * grid.spacing.iter().product::<f64>()
}
