//! Boxes as their writers take them: planes one at a time, from memory or from a file.

use super::StoredBox;
use crate::FileError;
use flow::inflow::TurbulenceBox;
use std::path::Path;

/// What a box is, its planes aside.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Points along x, y, z (–).
    pub n_points: [usize; 3],
    /// Distance of neighbouring points along x, y, z (m).
    pub spacing: [f64; 3],
    /// Speed with which the box is carried along (m/s).
    pub hub_speed: f64,
    /// Height of that speed (m).
    pub hub_height: f64,
    /// Height of the lowest row of points (m).
    pub lowest_height: f64,
    /// Mean speed along x at each row of points, lowest first (m/s), n_z values.
    pub mean_speeds: Vec<f64>,
    /// Where it comes from, in words.
    pub description: String,
    /// Whether its first plane follows its last; a box does, a part of a record does not.
    pub repeats: bool,
}

impl Outline {
    /// Component 0 to 2 of the wind (m/s, the mean included) at point number `point` of a plane, whose
    /// fluctuation is `fluctuation` (m/s).
    pub(super) fn wind(&self, component: usize, point: usize, fluctuation: f32) -> f64 {
        let fluctuation = f64::from(fluctuation);
        if component > 0 {
            return fluctuation;
        }
        let row = point / self.n_points[1];
        fluctuation + self.mean_speeds.get(row).copied().unwrap_or(self.hub_speed)
    }
}

/// A box whose planes come one at a time, in any order and as often as they are asked for.
pub trait Source {
    /// What the box is, its planes aside.
    fn outline(&self) -> Outline;

    /// Fluctuations u, v, w (m/s) on the plane with index `x`, which counts downwind; each n_z × n_y, y
    /// fastest and from the right to the left looking downwind.
    ///
    /// # Errors
    /// [`FileError`] when it cannot be had.
    fn plane(&mut self, x: usize) -> Result<[&[f32]; 3], FileError>;
}

impl Source for &StoredBox {
    fn outline(&self) -> Outline {
        Outline {
            n_points: self.turbulence.n_points(),
            spacing: self.turbulence.spacing(),
            hub_speed: self.hub_speed,
            hub_height: self.hub_height,
            lowest_height: self.lowest_height,
            mean_speeds: self.mean_speeds.clone(),
            description: self.description.clone(),
            repeats: true,
        }
    }

    fn plane(&mut self, x: usize) -> Result<[&[f32]; 3], FileError> {
        let turbulence = &self.turbulence;
        Ok([0, 1, 2].map(|component| turbulence.plane(component, x)))
    }
}

/// Hands the planes of `source` to `take` one after the other, downwind: the order in which a box in memory
/// is summed up, so that sums are the same to the last bit.
pub(super) fn each_plane(
    source: &mut dyn Source,
    mut take: impl FnMut([&[f32]; 3]),
) -> Result<(), FileError> {
    let [n_x, ..] = source.outline().n_points;
    for x in 0..n_x {
        take(source.plane(x)?);
    }
    Ok(())
}

/// All planes of `source`, the file at `path`, in memory.
pub(super) fn whole(path: &Path, source: &mut dyn Source) -> Result<StoredBox, FileError> {
    const WHAT: &str = "a turbulence box";
    let outline = source.outline();
    let n_values: usize = outline.n_points.iter().product();
    let mut velocity: [Vec<f32>; 3] = Default::default();
    for values in &mut velocity {
        values.try_reserve_exact(n_values).map_err(|_| {
            let problem = format!("its {n_values} points do not fit into memory");
            FileError::content(WHAT, path, problem, "take a shorter record")
        })?;
    }
    each_plane(source, |plane| {
        for (values, plane) in velocity.iter_mut().zip(plane) {
            values.extend_from_slice(plane);
        }
    })?;
    let turbulence =
        TurbulenceBox::new(outline.n_points, outline.spacing, velocity).map_err(|error| {
            FileError::content(WHAT, path, error.to_string(), "make the file again")
        })?;
    Ok(StoredBox {
        turbulence,
        hub_speed: outline.hub_speed,
        hub_height: outline.hub_height,
        lowest_height: outline.lowest_height,
        mean_speeds: outline.mean_speeds,
        description: outline.description,
    })
}
