//! Wind and turbulence on the quarters of a rotor's disc: what a surrogate of loads is told of the wind.

use super::{InflowError, PlaneGrid, Planes, positive};
use basis::Vector3;
use basis::records::Sector;
use std::ops::Range;

/// Names of the quarters, in the order of the azimuth: looking downwind.
pub const SECTOR_NAMES: [&str; 4] = ["up", "right", "down", "left"];

/// Rings and rays over a quarter (–): a slope across the disc is averaged to one in ten thousand.
const N_RINGS: usize = 64;
const N_RAYS: usize = 64;
/// Part of a spacing by which a disc may leave the points (–).
const SLACK: f64 = 1e-6;

/// Where a rotor stands in planes of wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Place of its middle along y of the planes (m).
    pub y: f64,
    /// Height of its middle (m).
    pub z: f64,
    /// Its radius (m).
    pub radius: f64,
}

/// Mean wind and turbulence at each point of planes.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneMeans {
    grid: PlaneGrid,
    /// Mean of u (m/s).
    speeds: Vec<f64>,
    /// Mean of v (m/s).
    crosswinds: Vec<f64>,
    /// Turbulence intensity (–).
    intensities: Vec<f64>,
}

impl PlaneMeans {
    /// Those of all of `planes`, which are read once. The intensity of a point is √((u′u′ + v′v′ +
    /// w′w′)/3) over `free_stream` (m/s), so that a wake that is mixed more shows more of it though its
    /// wind is faster. Source: van der Hoek et al., "Gaussian process surrogate modeling for efficient
    /// controller tuning and fatigue load prediction of the helix wake-mixing method", eq. 7.
    ///
    /// # Errors
    /// [`InflowError::Plane`] for planes that cannot be had, [`InflowError::Setting`] for a free stream that
    /// is not positive.
    pub fn of(planes: &mut dyn Planes, free_stream: f64) -> Result<Self, InflowError> {
        let n_steps = planes.grid().n_steps;
        Self::of_steps(planes, free_stream, 0..n_steps)
    }

    /// The same of these `steps` of `planes` alone, as many as there are.
    ///
    /// # Errors
    /// As [`of`](Self::of); [`InflowError::Setting`] where none of them is there.
    pub fn of_steps(
        planes: &mut dyn Planes,
        free_stream: f64,
        steps: Range<usize>,
    ) -> Result<Self, InflowError> {
        positive("free stream (m/s)", free_stream)?;
        let grid = planes.grid();
        let steps = steps.start..steps.end.min(grid.n_steps);
        positive("number of planes", steps.len() as f64)?;
        let [speeds, crosswinds, intensities] = fields(planes, free_stream, steps)?;
        Ok(Self { grid, speeds, crosswinds, intensities })
    }

    /// Means over each quarter of `disc`: up, right, down and left, looking downwind.
    ///
    /// Between points both are bilinear; below the lowest row those of that row count, as for a turbine that
    /// stands there. Source: the same, eq. 6, which is written without the quarter's area, by which its
    /// integral must be divided to be a speed.
    ///
    /// # Errors
    /// [`InflowError::Outside`] where the disc leaves the planes to a side or above, [`InflowError::Setting`]
    /// for a radius that is not positive.
    pub fn sectors(&self, disc: Disc) -> Result<[Sector; 4], InflowError> {
        check(&self.grid, disc)?;
        Ok(std::array::from_fn(|quarter| {
            let mean = |field: &[f64]| mean_over(&self.grid, disc, quarter, field);
            Sector {
                name: SECTOR_NAMES[quarter].to_owned(),
                wind_speed: mean(&self.speeds),
                turbulence_intensity: mean(&self.intensities),
            }
        }))
    }

    /// Where the mean wind over `disc` blows to, counter-clockwise seen from above from the axis of the
    /// planes (rad). Wakes that are steered blow across a rotor by some degrees, which is as good as yaw.
    ///
    /// # Errors
    /// As [`sectors`](Self::sectors).
    pub fn direction(&self, disc: Disc) -> Result<f64, InflowError> {
        check(&self.grid, disc)?;
        // Quarters are of one area.
        let sum = |field: &[f64]| -> f64 {
            (0..SECTOR_NAMES.len()).map(|quarter| mean_over(&self.grid, disc, quarter, field)).sum()
        };
        Ok(sum(&self.crosswinds).atan2(sum(&self.speeds)))
    }
}

/// Whether `disc` is one, and lies within the sides and the top of `grid`.
fn check(grid: &PlaneGrid, disc: Disc) -> Result<(), InflowError> {
    positive("radius of a rotor (m)", disc.radius)?;
    let ([left, right], [low, high]) = (grid.across(), grid.up());
    let places = [(-disc.radius, 0.0), (disc.radius, 0.0), (0.0, disc.radius)];
    for (aside, above) in places {
        let position = Vector3::new(0.0, disc.y + aside, disc.z + above);
        let [beside, over] = grid.spacing.map(|spacing| SLACK * spacing);
        if position.y < left - beside || position.y > right + beside || position.z > high + over {
            return Err(InflowError::Outside { position, across: [left, right], up: [low, high] });
        }
    }
    Ok(())
}

/// Means of u and v (m/s) and turbulence intensity over `free_stream` (–) at each point of these `steps`
/// of `planes`.
fn fields(
    planes: &mut dyn Planes,
    free_stream: f64,
    steps: Range<usize>,
) -> Result<[Vec<f64>; 3], InflowError> {
    let grid = planes.grid();
    let n_points = grid.n_y * grid.n_z;
    let (mut first, mut plane) = (vec![[0.0_f32; 3]; n_points], vec![[0.0_f32; 3]; n_points]);
    planes.read(steps.start, &mut first)?;
    // Of differences from the first plane: squares of the wind itself would cancel.
    let mut sums = vec![[[0.0_f64; 2]; 3]; n_points];
    let n_steps = steps.len();
    for step in steps.skip(1) {
        planes.read(step, &mut plane)?;
        for (sums, (value, first)) in sums.iter_mut().zip(plane.iter().zip(&first)) {
            for (sums, (value, first)) in sums.iter_mut().zip(value.iter().zip(first)) {
                let away = f64::from(*value) - f64::from(*first);
                *sums = [sums[0] + away, sums[1] + away * away];
            }
        }
    }
    let n = n_steps as f64;
    let means = |axis: usize| {
        let each = sums.iter().zip(&first);
        each.map(|(sums, first)| f64::from(first[axis]) + sums[axis][0] / n).collect()
    };
    let variance = |[sum, squares]: &[f64; 2]| (squares / n - (sum / n).powi(2)).max(0.0);
    let intensity =
        |sums: &[[f64; 2]; 3]| (sums.iter().map(variance).sum::<f64>() / 3.0).sqrt() / free_stream;
    Ok([means(0), means(1), sums.iter().map(intensity).collect()])
}

/// Mean of `field`, a value at each point of `grid`, over `quarter` of `disc`, the first being up.
fn mean_over(grid: &PlaneGrid, disc: Disc, quarter: usize, field: &[f64]) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    let quarter_turn = std::f64::consts::FRAC_PI_2;
    for ray in 0..N_RAYS {
        let share = (ray as f64 + 0.5) / N_RAYS as f64;
        let azimuth = (quarter as f64 - 0.5 + share) * quarter_turn;
        for ring in 0..N_RINGS {
            let radius = disc.radius * (ring as f64 + 0.5) / N_RINGS as f64;
            // y is to the left, and the azimuth grows to the right.
            let place = [disc.y - radius * azimuth.sin(), disc.z + radius * azimuth.cos()];
            sum += radius * at(grid, field, place);
            weights += radius;
        }
    }
    sum / weights
}

/// `field` at `place` along y and z (m), bilinear; beyond the points that of the nearest.
fn at(grid: &PlaneGrid, field: &[f64], [y, z]: [f64; 2]) -> f64 {
    let ((columns, aside), (rows, above)) = (grid.columns_at(y), grid.rows_at(z));
    let along = |row: usize| {
        let [a, b] = columns.map(|column| field[row * grid.n_y + column]);
        a + aside * (b - a)
    };
    let [below, over] = rows.map(along);
    below + above * (over - below)
}

#[cfg(test)]
#[path = "sectors_tests.rs"]
mod tests;
