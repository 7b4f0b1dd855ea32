//! The measurement model by itself, to make blade moments of a known wind.

use super::estimator::{Setting, check};
use super::options::Options;
use super::rotor::{Memory, Posture, Rotor, State};
use crate::EstimationError;
use basis::{FixedFrame, PerBlade};
use std::sync::Arc;
use turbine::Definition;

/// The rotor that a [`HelixEstimator`](super::HelixEstimator) with the same setting and options believes in.
///
/// For trials on known winds: what it makes is what the filter expects.
#[derive(Clone, Debug)]
pub struct MeasurementModel {
    rotor: Rotor,
    state: State,
    memory: Memory,
    settled: bool,
}

impl MeasurementModel {
    /// # Errors
    /// Those of [`HelixEstimator::new`](super::HelixEstimator::new).
    pub fn new(
        definition: &Arc<Definition>,
        setting: &Setting,
        options: &Options,
    ) -> Result<Self, EstimationError> {
        check(definition, setting, options)?;
        let rotor = Rotor::new(definition, setting, options);
        let (state, memory) = (rotor.start(), rotor.memory());
        Ok(Self { rotor, state, memory, settled: false })
    }

    /// Moments at the blade roots (N m) an `interval` (s) after the last ones, blade 1 at `azimuth` (rad), the rotor turning
    /// with `rotor_speed` (rad/s), blades pitched by `pitch` (rad), in the fixed frame's `wind` (m/s). The first call comes
    /// to rest in its mean wind.
    pub fn moments(
        &mut self,
        interval: f64,
        wind: FixedFrame,
        azimuth: f64,
        rotor_speed: f64,
        pitch: &PerBlade<f64>,
    ) -> PerBlade<f64> {
        let posture = Posture { azimuth, rotor_speed, pitch: *pitch };
        let Self { rotor, state, memory, settled } = self;
        if !*settled {
            rotor.rest(
                FixedFrame { average: wind.average, ..FixedFrame::default() },
                &posture,
                state,
                memory,
            );
            *settled = true;
        }
        rotor.advance(interval, wind, &posture, state, memory).moments
    }
}
