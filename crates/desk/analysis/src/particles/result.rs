//! What particles in cells tell: mean, slopes, stresses, and how sure they are.

use super::Cells;
use crate::small::solved;
use basis::records::STRESSES;

/// Fewest particles whose velocities a plane is laid through (–): more than twice its four unknowns.
const FEWEST_FOR_SLOPES: u32 = 10;

/// Sums of one cell; places in half edges from its middle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CellSums {
    n: u32,
    squares: f64,
    /// Weights times products of (1, x, y, z): a symmetric matrix, its upper triangle row by row.
    places: [f64; 10],
    /// Weights times products of (1, x, y, z) and u, v, w.
    mixed: [[f64; 4]; 3],
    /// Weights times products of velocities.
    products: [f64; 6],
}

impl CellSums {
    pub(super) fn add(&mut self, weight: f64, away: [f64; 3], velocity: [f64; 3]) {
        self.n += 1;
        self.squares += weight * weight;
        let row = [1.0, away[0], away[1], away[2]];
        let mut place = 0;
        for i in 0..4 {
            for j in i..4 {
                self.places[place] += weight * row[i] * row[j];
                place += 1;
            }
        }
        for (mixed, u) in self.mixed.iter_mut().zip(velocity) {
            for (sum, part) in mixed.iter_mut().zip(row) {
                *sum += weight * part * u;
            }
        }
        for (sum, [a, b]) in self.products.iter_mut().zip(STRESSES) {
            *sum += weight * velocity[a] * velocity[b];
        }
    }

    /// Planes through the velocities: of each component the value in the middle and slopes a half edge.
    fn planes(&self) -> Option<[[f64; 4]; 3]> {
        let mut matrix = [[0.0; 4]; 4];
        let mut place = 0;
        for i in 0..4 {
            for j in i..4 {
                (matrix[i][j], matrix[j][i]) = (self.places[place], self.places[place]);
                place += 1;
            }
        }
        // Particles in a plane or on a line tell nothing of slopes across it: their spread is too small.
        let spread = (1..4).map(|i| matrix[i][i] / matrix[0][0]);
        if self.n < FEWEST_FOR_SLOPES || spread.fold(f64::INFINITY, f64::min) < 1e-3 {
            return None;
        }
        let [u, v, w] = self.mixed;
        Some([solved(matrix, u)?, solved(matrix, v)?, solved(matrix, w)?])
    }
}

/// Velocity in cells; not a number in those with too few particles.
#[derive(Clone, Debug, PartialEq)]
pub struct Binned {
    /// The cells.
    pub cells: Cells,
    /// Particles in each (–).
    pub n: Vec<u32>,
    /// As many particles of equal weight would be as sure (–): (Σw)²/Σw².
    pub effective: Vec<f64>,
    /// Velocity in the middle (m/s).
    pub mean: [Vec<f64>; 3],
    /// Stresses (m²/s²), what the mean changes across the cell left out where slopes are known.
    pub stress: [Vec<f64>; 6],
    /// Standard error of the mean's components (m/s), particles taken as independent.
    pub error: [Vec<f64>; 3],
    /// Slopes (1/s), row the component; not numbers where there are too few particles for them.
    pub slopes: Vec<[[f64; 3]; 3]>,
    /// Cells without a velocity: of too few particles (–).
    pub n_masked: usize,
}

impl Binned {
    /// Of the sums in `cells`, those with fewer than `least` particles left out.
    pub(super) fn of(cells: &Cells, sums: &[CellSums], least: u32) -> Self {
        let empty = || vec![f64::NAN; sums.len()];
        let mut found = Self {
            cells: *cells,
            n: sums.iter().map(|sums| sums.n).collect(),
            effective: vec![0.0; sums.len()],
            mean: [empty(), empty(), empty()],
            stress: std::array::from_fn(|_| empty()),
            error: [empty(), empty(), empty()],
            slopes: vec![[[f64::NAN; 3]; 3]; sums.len()],
            n_masked: 0,
        };
        for (index, own) in sums.iter().enumerate() {
            let weights = own.places[0];
            if own.n < least.max(1) || weights <= 0.0 {
                found.n_masked += 1;
                continue;
            }
            found.effective[index] = weights * weights / own.squares;
            found.set(index, own);
        }
        found
    }

    fn set(&mut self, index: usize, own: &CellSums) {
        let weights = own.places[0];
        let planes = own.planes();
        let fitted = planes.unwrap_or_else(|| own.mixed.map(|m| [m[0] / weights, 0.0, 0.0, 0.0]));
        let unknowns = if planes.is_some() { 4.0 } else { 1.0 };
        // Of so many particles as many less as there are unknowns tell of what is left.
        let effective = self.effective[index];
        let free = 1.0 - unknowns / effective;
        for component in 0..3 {
            self.mean[component][index] = fitted[component][0];
            if planes.is_some() {
                self.slopes[index][component] =
                    std::array::from_fn(|a| fitted[component][a + 1] / (0.5 * self.cells.size));
            }
        }
        for (place, [a, b]) in STRESSES.into_iter().enumerate() {
            let explained: f64 = fitted[a].iter().zip(own.mixed[b]).map(|(x, y)| x * y).sum();
            let stress = (own.products[place] - explained) / weights;
            let stress = if free > 0.0 { stress / free } else { f64::NAN };
            self.stress[place][index] = stress;
            if a == b {
                self.error[a][index] = (stress.max(0.0) / effective).sqrt();
            }
        }
    }
}

/// Whether a particle at `position` (m) with `velocity` (m/s) is further from the mean of the cell that it is
/// nearest to than `factor` standard deviations and `least` (m/s) in any component; never where that cell has
/// no velocity.
pub fn is_beyond(
    binned: &Binned,
    position: [f64; 3],
    velocity: [f64; 3],
    factor: f64,
    least: f64,
) -> bool {
    let grid = &binned.cells.grid;
    let place = std::array::from_fn(|axis| {
        let steps = ((position[axis] - grid.origin[axis]) / grid.spacing[axis]).round();
        steps.clamp(0.0, grid.n_points[axis] as f64 - 1.0) as usize
    });
    let index = grid.index(place);
    (0..3).any(|component| {
        let deviation = binned.stress[component][index].max(0.0).sqrt();
        (velocity[component] - binned.mean[component][index]).abs() > factor * deviation + least
    })
}
