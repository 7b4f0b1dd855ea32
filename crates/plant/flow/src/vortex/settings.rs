//! What a free wake is set up with.

use super::body::BodyWakes;
use super::field::Accuracy;
use super::segment::Cores;
use super::sheet::{Resolution, Sheet};
use crate::inflow::profile::veered;
use crate::inflow::{MeanColumn, MeanProfile};
use basis::Vector3;
use std::sync::Arc;
use thiserror::Error;

/// Settings of a free wake.
#[derive(Clone, Debug, PartialEq)]
pub struct WakeSettings {
    /// Step (s), the only one that it is advanced by.
    pub interval: f64,
    /// How wakes are resolved, and where they end.
    pub resolution: Resolution,
    /// How cores begin and grow.
    pub cores: Cores,
    /// How far the wakes of bodies such as nacelles are followed.
    pub bodies: BodyWakes,
    /// Density of the air (kg/m³).
    pub air_density: f64,
    /// How exact induced velocities are.
    pub accuracy: Accuracy,
    /// What the mean shear of the wind does to wakes.
    pub shear: MeanShear,
    /// Whether there is a ground at z = 0, which the air does not pass: every vortex has an image below it.
    pub ground: bool,
    /// Points of planes and volumes.
    pub shown: Points,
    /// Blades in all (–), for whose wakes memory is made.
    pub n_blades: usize,
    /// Rows further down of the wakes of all blades together (–), likewise: as many as the
    /// [resolution](Resolution::far_rows) has for each, or fewer where wakes [end](Resolution::end) early.
    pub far_rows_in_all: usize,
    /// Elements of a blade (–).
    pub n_elements: usize,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
}

/// What the shear and veer of the mean wind do to wakes.
///
/// Vortex rings that are carried faster above than below lean downwind, and what leans moves itself upwards.
/// In air the vorticity of the shear itself holds against that, for the rotor bends and stretches it; here
/// the wind's own vorticity is not bent, so that wakes in sheared wind rise. See the theory page, "Free
/// vortices".
#[derive(Clone, Debug, PartialEq)]
pub enum MeanShear {
    /// They carry wakes as all of the wind does.
    Carries,
    /// They do not: a wake is carried by the wind less what the mean wind at the wake's height has over that
    /// at the height of its own hub.
    LeftOut {
        /// Mean speed over height.
        profile: MeanProfile,
        /// Height (m) at which the mean wind blows along x.
        hub_height: f64,
        /// Veer (rad/m), see [`DeterministicWind`](crate::inflow::DeterministicWind).
        veer: f64,
    },
    /// They do not, likewise, with the mean wind of a record of its own.
    LeftOutOf(Arc<MeanColumn>),
}

impl MeanShear {
    /// The mean wind at `height` (m), of which wakes are carried by its value at their own hubs (m/s, farm
    /// frame); none where it carries them as it is.
    pub(super) fn left_out(&self, height: f64) -> Vector3 {
        let [x, y] = match self {
            Self::Carries => [0.0; 2],
            Self::LeftOut { profile, hub_height, veer } => {
                veered(profile.speed(height), *veer, height - hub_height)
            }
            Self::LeftOutOf(column) => column.at(height).wind,
        };
        Vector3::new(x, y, 0.0)
    }
}

/// Points of a box at which planes and volumes show the wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Points {
    /// The first one, farm frame (m).
    pub first: Vector3,
    /// Distance of neighbours (m).
    pub spacing: f64,
    /// Points along x, y, z (–).
    pub n: [usize; 3],
}

impl Points {
    /// None at all.
    pub const NONE: Self = Self { first: Vector3::ZERO, spacing: 1.0, n: [0; 3] };
}

/// Why a wake cannot be set up.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum WakeError {
    /// A number that cannot be.
    #[error("a free wake cannot have {name} = {value}; expected {expected}")]
    Setting {
        /// What it is.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What would do.
        expected: &'static str,
    },
}

impl WakeSettings {
    /// Most segments that the wakes can have (–).
    pub fn most_segments(&self) -> usize {
        let Self { n_blades, n_elements, resolution, far_rows_in_all, .. } = self;
        Sheet::most_segments(*n_blades, *n_elements, resolution, *far_rows_in_all)
            + self.bodies.most_segments()
    }

    /// # Errors
    /// [`WakeError`] names what cannot be.
    pub fn check(&self) -> Result<(), WakeError> {
        let Self { interval, resolution, cores, bodies, air_density, accuracy, .. } = self;
        let positive = [
            ("step (s)", *interval),
            ("length (m)", resolution.length),
            ("rows near the blade", resolution.near_rows as f64),
            ("steps from row to row", resolution.far_stride as f64),
            ("core at birth over widths", cores.initial_widths),
            ("density of the air (kg/m³)", *air_density),
        ];
        let not_negative = [
            ("viscosity (m²/s)", cores.kinematic_viscosity),
            ("eddy constant of cores", cores.eddy_constant),
            ("length of wakes of bodies (m)", bodies.length),
            ("opening of the tree", accuracy.opening),
        ];
        let refuse = |name, value, expected| Err(WakeError::Setting { name, value, expected });
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return refuse(name, value, "a positive number");
            }
        }
        for (name, value) in not_negative {
            if !(value.is_finite() && value >= 0.0) {
                return refuse(name, value, "zero or a positive number");
            }
        }
        if resolution.end.is_nan() {
            return refuse(
                "end along x (m)",
                resolution.end,
                "a number, infinity where there is none",
            );
        }
        if accuracy.opening >= 1.0 {
            return refuse("opening of the tree", accuracy.opening, "less than 1");
        }
        if bodies.length > 0.0 && bodies.most_rings == 0 {
            return refuse("rings of a body's wake", 0.0, "one at least");
        }
        if resolution.far_filaments < 2 {
            let value = resolution.far_filaments as f64;
            return refuse("trailing vortices of a blade", value, "two at least");
        }
        Ok(())
    }
}
