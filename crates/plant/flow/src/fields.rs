//! The wind on planes and in volumes, at an instant or averaged, of any flow that knows it everywhere.

use basis::Vector3;
use basis::records::{Plane, PlaneAxes};

/// A flow that knows its wind on planes and in volumes.
pub trait FieldSource {
    /// The wind now on the plane that `axes` span at `position` (m, farm frame) along the third axis.
    fn plane(&self, name: &str, axes: PlaneAxes, position: f64) -> Plane;

    /// On return `plane`, which [`plane`](Self::plane) gave, holds the wind and the time of now; allocates
    /// nothing.
    fn refresh(&self, plane: &mut Plane);

    /// The wind now at every `stride`-th point along each axis.
    fn volume(&self, stride: usize) -> Volume;
}

/// Wind at points of a box, at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Position of its first point, farm frame (m).
    pub origin: Vector3,
    /// Distance of neighbouring points (m).
    pub spacing: f64,
    /// Points along x, y, z (–).
    pub n_points: [usize; 3],
    /// Instant (s).
    pub time: f64,
    /// Velocity components u, v, w (m/s), x fastest.
    pub velocity: [Vec<f32>; 3],
    /// Pressure above that of undisturbed air, over density (m²/s²); none where the flow does not know it.
    pub pressure: Option<Vec<f32>>,
}

/// A plane's mean over instants, without allocation once it is made.
#[derive(Clone, Debug)]
pub struct PlaneAverage {
    latest: Plane,
    sums: [Vec<f64>; 3],
    n_instants: u64,
    start: f64,
}

impl PlaneAverage {
    /// The mean of the planes of `source` as [`FieldSource::plane`] gives them; none taken in yet.
    pub fn new(source: &dyn FieldSource, name: &str, axes: PlaneAxes, position: f64) -> Self {
        let latest = source.plane(name, axes, position);
        let sums = std::array::from_fn(|_| vec![0.0; latest.velocity[0].len()]);
        Self { sums, n_instants: 0, start: latest.time, latest }
    }

    /// Takes the present instant in.
    pub fn add(&mut self, source: &dyn FieldSource) {
        source.refresh(&mut self.latest);
        for (sums, values) in self.sums.iter_mut().zip(&self.latest.velocity) {
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += f64::from(*value);
            }
        }
        if self.n_instants == 0 {
            self.start = self.latest.time;
        }
        self.n_instants += 1;
    }

    /// Instants taken in so far (–).
    pub fn n_instants(&self) -> u64 {
        self.n_instants
    }

    /// The mean so far; air at rest before the first instant.
    pub fn mean(&self) -> Plane {
        let share = 1.0 / self.n_instants.max(1) as f64;
        Plane {
            averaged: self.latest.time - self.start,
            velocity: std::array::from_fn(|component| {
                self.sums[component].iter().map(|sum| (sum * share) as f32).collect()
            }),
            ..self.latest.clone()
        }
    }

    /// Sums and times, to be carried over a restart.
    pub fn state(&self) -> PlaneAverageState {
        PlaneAverageState {
            sums: self.sums.clone(),
            n_instants: self.n_instants,
            start: self.start,
            time: self.latest.time,
        }
    }

    /// Goes on from `state`, which an average of the same plane gave.
    ///
    /// # Errors
    /// [`PlaneSizeError`] when it was a plane of another size; nothing is changed then.
    pub fn restore(&mut self, state: PlaneAverageState) -> Result<(), PlaneSizeError> {
        let (expected, found) = (self.sums[0].len(), state.sums[0].len());
        if state.sums.iter().any(|sums| sums.len() != expected) {
            return Err(PlaneSizeError { expected, found });
        }
        (self.sums, self.n_instants, self.start) = (state.sums, state.n_instants, state.start);
        self.latest.time = state.time;
        Ok(())
    }
}

/// What a [`PlaneAverage`] has gathered.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PlaneAverageState {
    sums: [Vec<f64>; 3],
    n_instants: u64,
    start: f64,
    time: f64,
}

/// An average was restored from a plane of another size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the stored average has {found} points, the plane {expected}")]
pub struct PlaneSizeError {
    /// Points of the plane (–).
    pub expected: usize,
    /// Points of the stored sums (–).
    pub found: usize,
}
