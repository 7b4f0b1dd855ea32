//! The measurement function by itself, to compute blade moments for a known wind.

use super::options::HelixOptions;
use super::rotor::{Memory, Rotor, RotorKinematics, RotorModelState};
use super::settings::{HelixSettings, check};
use crate::EstimationError;
use basis::{FixedFrame, PerBlade};
use std::sync::Arc;
use turbine::Definition;

/// The rotor model of a [`HelixEstimator`](super::HelixEstimator) with the same settings and options.
///
/// For trials with known winds: its moments are those that the filter expects.
#[derive(Clone, Debug)]
pub struct MeasurementModel {
    rotor: Rotor,
    state: RotorModelState,
    memory: Memory,
    settled: bool,
}

impl MeasurementModel {
    /// # Errors
    /// Those of [`HelixEstimator::new`](super::HelixEstimator::new).
    pub fn new(
        definition: &Arc<Definition>,
        settings: &HelixSettings,
        options: &HelixOptions,
    ) -> Result<Self, EstimationError> {
        check(definition, settings, options)?;
        let rotor = Rotor::new(definition, settings, options);
        let (state, memory) = (rotor.start(), rotor.memory());
        Ok(Self { rotor, state, memory, settled: false })
    }

    /// Moments at the blade roots (N m) an `interval` (s) after the last ones, blade 1 at `azimuth` (rad),
    /// the rotor turning with `rotor_speed` (rad/s), blades pitched by `pitch` (rad), in the fixed frame's
    /// `wind` (m/s). The first call starts from the steady wake in its mean wind.
    pub fn moments(
        &mut self,
        interval: f64,
        wind: FixedFrame,
        azimuth: f64,
        rotor_speed: f64,
        pitch: &PerBlade<f64>,
    ) -> PerBlade<f64> {
        let kinematics = RotorKinematics { azimuth, rotor_speed, pitch: *pitch };
        let Self { rotor, state, memory, settled } = self;
        if !*settled {
            rotor.rest(
                FixedFrame { average: wind.average, ..FixedFrame::default() },
                &kinematics,
                state,
                memory,
            );
            *settled = true;
        }
        rotor.advance(interval, wind, &kinematics, state, memory).moments
    }
}
