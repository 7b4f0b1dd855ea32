//! What an estimator is told of the helix that it looks for, and of its turbine.

use super::options::{HelixOptions, positive};
use crate::EstimationError;
use basis::Sense;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use turbine::Definition;

/// Settings of an estimator: the helix that it looks for and its turbine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HelixSettings {
    /// Sense of the helix.
    pub sense: Sense,
    /// Excitation rate ω_e in the fixed frame (rad/s).
    pub rate: f64,
    /// Control interval (s).
    pub interval: f64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Elements of each blade in the model (–); [`HelixSettings::N_ELEMENTS`] are enough.
    pub n_elements: usize,
}

impl HelixSettings {
    /// Elements of each blade (–) that give the effect of pitch on the moments of a modern rotor to well
    /// within a percent. An error there counts several times in the phase, since pitch changes the moments
    /// more than the helix does.
    pub const N_ELEMENTS: usize = 16;
}

/// Whether an estimator with `settings` and `options` can be on a turbine of `definition`.
///
/// # Errors
/// Those of [`HelixEstimator::new`](super::HelixEstimator::new).
pub(super) fn check(
    definition: &Definition,
    settings: &HelixSettings,
    options: &HelixOptions,
) -> Result<(), EstimationError> {
    let HelixSettings { rate, interval, air_density, n_elements, .. } = *settings;
    options.check()?;
    if definition.n_blades < 3 {
        return Err(EstimationError::FewBlades { n_blades: definition.n_blades });
    }
    positive("excitation rate (rad/s)", rate)?;
    positive("control interval (s)", interval)?;
    positive("air density (kg/m³)", air_density)?;
    positive("elements of a blade (–)", n_elements as f64)?;
    let interval = interval * options.update_every as f64;
    let (nyquist, rotor_speed) = (PI / interval, definition.rated_rotor_speed);
    if rate + rotor_speed >= nyquist {
        return Err(EstimationError::AboveNyquist { rate, rotor_speed, interval, nyquist });
    }
    Ok(())
}
