//! Planes averaged by the phase of the excitation, while a run goes on.
//!
//! Source: van Vondelen et al. (2025), §4.5: 36 equidistant phases of the helix.

use crate::AnalysisError;
use basis::angle::wrap_to_turn;
use basis::records::Plane;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Sums of one plane's velocities, one for each phase of the excitation.
///
/// Phase k of n stands for the instants at which the excitation's angle ω_e t lies within half a step of
/// 2πk/n; what turns with the excitation keeps sin(π/n)/(π/n) of its amplitude, 99.9 % for 36 phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseAverage {
    /// The plane without velocities.
    like: Plane,
    rate: f64,
    n_points: usize,
    /// For each component, `n_phases × n_points` (m/s).
    sums: [Vec<f64>; 3],
    n_instants: Vec<u64>,
    first: Option<f64>,
    last: f64,
}

/// A plane at one phase of the excitation.
#[derive(Clone, Debug, PartialEq)]
pub struct PhasePlane {
    /// The excitation's angle ω_e t (rad, [0, 2π)).
    pub phase: f64,
    /// Instants behind it (–).
    pub n_instants: u64,
    /// Their mean; `averaged` is the time between the run's first and last instant.
    pub plane: Plane,
}

impl PhaseAverage {
    /// Phases in the published slices (–), one every ten degrees.
    pub const N_PHASES: usize = 36;

    /// An average of planes with the points of `like` over `n_phases` phases of an excitation of `rate`
    /// (rad/s); nothing taken in yet. At least one phase.
    pub fn new(like: &Plane, rate: f64, n_phases: usize) -> Self {
        let n_phases = n_phases.max(1);
        let n_points = like.n_points.iter().product();
        let empty = || vec![0.0; n_phases * n_points];
        Self {
            like: Plane { velocity: Default::default(), ..like.clone() },
            rate,
            n_points,
            sums: [empty(), empty(), empty()],
            n_instants: vec![0; n_phases],
            first: None,
            last: like.time,
        }
    }

    /// Memory that the average holds from the start (bytes): 24 for each point and phase.
    pub fn memory(&self) -> usize {
        self.sums.iter().map(Vec::len).sum::<usize>() * size_of::<f64>()
    }

    /// Instants taken in so far at each phase (–).
    pub fn n_instants(&self) -> &[u64] {
        &self.n_instants
    }

    /// Takes in `plane`, an instant at `plane.time`; allocates nothing.
    ///
    /// # Errors
    /// [`AnalysisError::UnequalLengths`] when it has other points; then nothing has changed.
    pub fn add(&mut self, plane: &Plane) -> Result<(), AnalysisError> {
        if let Some(odd) = plane.velocity.iter().find(|values| values.len() != self.n_points) {
            return Err(AnalysisError::UnequalLengths { first: self.n_points, second: odd.len() });
        }
        let n_phases = self.n_instants.len();
        let place = wrap_to_turn(self.rate * plane.time) / TAU * n_phases as f64;
        let phase = place.round() as usize % n_phases;
        let range = phase * self.n_points..(phase + 1) * self.n_points;
        for (sums, values) in self.sums.iter_mut().zip(&plane.velocity) {
            for (sum, value) in sums[range.clone()].iter_mut().zip(values) {
                *sum += f64::from(*value);
            }
        }
        self.n_instants[phase] += 1;
        self.first.get_or_insert(plane.time);
        self.last = plane.time;
        Ok(())
    }

    /// The mean plane of every phase that has an instant, in the order of the phases.
    pub fn planes(&self) -> Vec<PhasePlane> {
        let n_phases = self.n_instants.len();
        let mean = |phase: usize| {
            let (n_instants, start) = (self.n_instants[phase], phase * self.n_points);
            let mean_of = |sums: &Vec<f64>| -> Vec<f32> {
                let sums = &sums[start..start + self.n_points];
                sums.iter().map(|sum| (sum / n_instants as f64) as f32).collect()
            };
            let [u, v, w] = &self.sums;
            let plane = Plane {
                time: self.last,
                averaged: self.last - self.first.unwrap_or(self.last),
                velocity: [mean_of(u), mean_of(v), mean_of(w)],
                ..self.like.clone()
            };
            PhasePlane { phase: TAU * phase as f64 / n_phases as f64, n_instants, plane }
        };
        (0..n_phases).filter(|phase| self.n_instants[*phase] > 0).map(mean).collect()
    }
}
