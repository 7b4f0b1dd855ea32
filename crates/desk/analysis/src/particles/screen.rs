//! Outliers among particles, by the medians of those around them.

use super::median::median;
use super::{Particle, ParticlesError};
use basis::records::Grid;

/// Fewest particles of a cell by which one is judged (–).
const FEWEST_NEIGHBOURS: usize = 5;

/// How outliers are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenSettings {
    /// Greatest distance from the median, over the median distance of the others and the noise (–). Of
    /// normal scatter 5 leaves out 7 in 10⁴ of each component, 2, the source's for vectors of one instant,
    /// a sixth.
    pub limit: f64,
    /// Noise of a velocity (m/s), so that still air has no outliers.
    pub noise: f64,
    /// Samples by which a cell is judged at most (–).
    pub most: usize,
}

impl ScreenSettings {
    /// The usual limit for particles of many instants, with `noise` (m/s).
    pub fn usual(noise: f64) -> Self {
        Self { limit: 5.0, noise, most: 128 }
    }
}

/// A first look at particles: a few of each cell, drawn at random, the same ones every time.
#[derive(Clone, Debug)]
pub struct Screen {
    cells: Cells,
    settings: ScreenSettings,
    n: Vec<u64>,
    kept: Vec<Vec<[f32; 3]>>,
}

/// Medians of the cells, by which particles are judged.
#[derive(Clone, Debug, PartialEq)]
pub struct Screened {
    cells: Cells,
    limit: f64,
    noise: f64,
    /// Median and median distance from it of u, v, w in each cell (m/s); none where there are too few.
    medians: Vec<Option<[[f64; 2]; 3]>>,
}

/// Cells that do not overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cells {
    lowest: [f64; 3],
    size: [f64; 3],
    n: [usize; 3],
}

impl Cells {
    /// Cells of `size` (m) that cover bins of that size in the middles of `grid`.
    fn over(grid: &Grid, size: [f64; 3]) -> Self {
        let lowest = [0, 1, 2].map(|axis| grid.origin[axis] - 0.5 * size[axis]);
        let n = [0, 1, 2].map(|axis| {
            let length = (grid.n_points[axis].max(1) - 1) as f64 * grid.spacing[axis] + size[axis];
            ((length / size[axis] - 1e-9).ceil() as usize).max(1)
        });
        Self { lowest, size, n }
    }

    fn len(&self) -> usize {
        self.n.iter().product()
    }

    /// Number of the cell that holds `position` (m); none outside.
    fn of(&self, position: [f64; 3]) -> Option<usize> {
        let mut index = 0;
        for axis in (0..3).rev() {
            let steps = ((position[axis] - self.lowest[axis]) / self.size[axis]).floor();
            if !(0.0..self.n[axis] as f64).contains(&steps) {
                return None;
            }
            index = index * self.n[axis] + steps as usize;
        }
        Some(index)
    }
}

impl Screen {
    /// A look at cells of `size` (m), that of the bins, over the bins in the middles of `grid`.
    ///
    /// # Errors
    /// [`ParticlesError::Limit`].
    pub fn new(
        grid: &Grid,
        size: [f64; 3],
        settings: ScreenSettings,
    ) -> Result<Self, ParticlesError> {
        let limit = settings.limit;
        if limit.is_nan() || limit <= 0.0 {
            return Err(ParticlesError::Limit { limit });
        }
        let cells = Cells::over(grid, size);
        Ok(Self { cells, settings, n: vec![0; cells.len()], kept: vec![Vec::new(); cells.len()] })
    }

    /// Memory that it takes at most (bytes).
    pub fn memory(&self) -> u64 {
        (self.cells.len() * (self.settings.most * size_of::<[f32; 3]>() + 32)) as u64
    }

    /// Looks at `particle`: each of a cell's has the same chance to be kept.
    pub fn look(&mut self, particle: &Particle) {
        let Some(cell) = self.cells.of(particle.position).filter(|_| particle.is_whole()) else {
            return;
        };
        let velocity = particle.velocity.map(|value| value as f32);
        let kept = &mut self.kept[cell];
        let n = self.n[cell];
        if kept.len() < self.settings.most {
            kept.push(velocity);
        } else {
            let place = mixed(cell as u64 ^ n.rotate_left(32)) % (n + 1);
            if let Some(slot) = usize::try_from(place).ok().and_then(|place| kept.get_mut(place)) {
                *slot = velocity;
            }
        }
        self.n[cell] += 1;
    }

    /// The medians.
    pub fn screened(self) -> Screened {
        let medians = self.kept.iter().map(|kept| {
            let is_enough = kept.len() >= FEWEST_NEIGHBOURS;
            let of = |component: usize| {
                let values = kept.iter().map(|velocity| f64::from(velocity[component]));
                median_and_distance(values.collect())
            };
            is_enough.then(|| [0, 1, 2].map(of))
        });
        let ScreenSettings { limit, noise, .. } = self.settings;
        Screened { cells: self.cells, limit, noise, medians: medians.collect() }
    }
}

impl Screened {
    /// Whether `particle` lies too far from the median of its cell; never where there are too few to tell.
    pub fn is_outlier(&self, particle: &Particle) -> bool {
        let medians = self.cells.of(particle.position).and_then(|cell| self.medians[cell].as_ref());
        medians.is_some_and(|medians| {
            medians.iter().zip(particle.velocity).any(|([median, distance], value)| {
                (value - median).abs() > self.limit * (distance + self.noise)
            })
        })
    }

    /// Cells that have medians, and all (–).
    pub fn n_cells(&self) -> [usize; 2] {
        [self.medians.iter().flatten().count(), self.medians.len()]
    }
}

/// Median of `values` and the median of their distances from it; not empty.
fn median_and_distance(mut values: Vec<f64>) -> [f64; 2] {
    let middle = median(&mut values);
    for value in &mut values {
        *value = (*value - middle).abs();
    }
    [middle, median(&mut values)]
}

/// Bits of `number`, well mixed (splitmix64).
pub(super) fn mixed(number: u64) -> u64 {
    let mut bits = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    bits ^ (bits >> 31)
}
