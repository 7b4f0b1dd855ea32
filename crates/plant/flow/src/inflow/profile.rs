//! Mean wind over height.

use super::{InflowError, not_negative, positive};
use crate::Inflow;
use basis::Vector3;
use serde::{Deserialize, Serialize};

/// Share of the hub height below which a power law is held constant (–): no blade and no cell centre of
/// interest is there, and the law itself ends at the ground with an infinite gradient.
pub const POWER_LAW_FLOOR: f64 = 0.01;

/// Greatest roughness length of a logarithmic law (hub heights): beyond it the law says nothing of a rotor.
pub const GREATEST_ROUGHNESS: f64 = 0.1;

/// Mean wind along x over height z above the ground. Alone it is steady inflow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MeanProfile {
    /// The same speed everywhere.
    Uniform {
        /// Speed (m/s).
        speed: f64,
    },
    /// speed (z / `hub_height`)^`exponent`, constant below [`POWER_LAW_FLOOR`] hub heights.
    PowerLaw {
        /// Height of `speed` (m).
        hub_height: f64,
        /// Speed there (m/s).
        speed: f64,
        /// Exponent (–).
        exponent: f64,
    },
    /// speed ln(z/z₀) / ln(`hub_height`/z₀); calm at and below z₀.
    LogLaw {
        /// Height of `speed` (m).
        hub_height: f64,
        /// Speed there (m/s).
        speed: f64,
        /// Roughness length z₀ (m), at most [`GREATEST_ROUGHNESS`] hub heights.
        roughness_length: f64,
    },
}

impl MeanProfile {
    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used.
    pub fn check(&self) -> Result<(), InflowError> {
        match *self {
            Self::Uniform { speed } => not_negative("speed (m/s)", speed),
            Self::PowerLaw { hub_height, speed, exponent } => {
                positive("hub height (m)", hub_height)?;
                not_negative("speed (m/s)", speed)?;
                if exponent.is_finite() {
                    return Ok(());
                }
                let (name, expected) = ("shear exponent (–)", "a finite number");
                Err(InflowError::Setting { name, value: exponent, expected })
            }
            Self::LogLaw { hub_height, speed, roughness_length } => {
                positive("hub height (m)", hub_height)?;
                not_negative("speed (m/s)", speed)?;
                positive("roughness length (m)", roughness_length)?;
                if roughness_length <= GREATEST_ROUGHNESS * hub_height {
                    return Ok(());
                }
                let (name, expected) =
                    ("roughness length (m)", "at most a tenth of the hub height");
                Err(InflowError::Setting { name, value: roughness_length, expected })
            }
        }
    }

    /// Mean speed (m/s) at `height` (m) above the ground; finite for every height, below the ground too.
    pub fn speed(&self, height: f64) -> f64 {
        match *self {
            Self::Uniform { speed } => speed,
            Self::PowerLaw { hub_height, speed, exponent } => {
                speed * (height / hub_height).max(POWER_LAW_FLOOR).powf(exponent)
            }
            Self::LogLaw { hub_height, speed, roughness_length } => {
                let heights = (height / roughness_length).max(1.0);
                speed * heights.ln() / (hub_height / roughness_length).ln()
            }
        }
    }

    /// Speed at the reference height (m/s): that with which turbulence is carried along.
    pub fn hub_speed(&self) -> f64 {
        match *self {
            Self::Uniform { speed } | Self::PowerLaw { speed, .. } | Self::LogLaw { speed, .. } => {
                speed
            }
        }
    }
}

/// Mean wind u, v (m/s) of `speed` (m/s), `above_hub` (m) above the height at which it blows along x, where
/// it veers by `veer` (rad/m): clockwise seen from above, upwards.
pub(crate) fn veered(speed: f64, veer: f64, above_hub: f64) -> [f64; 2] {
    let (sine, cosine) = (-veer * above_hub).sin_cos();
    [speed * cosine, speed * sine]
}

impl Inflow for MeanProfile {
    fn sample(&self, _time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let (mut height, mut speed) = (f64::NAN, 0.0);
        for (position, velocity) in positions.iter().zip(velocities) {
            // Neighbours mostly share their height, and a power costs more than all the rest.
            if position.z != height {
                height = position.z;
                speed = self.speed(height);
            }
            *velocity = Vector3::new(speed, 0.0, 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn meets_the_speed_at_the_reference_height() {
        for profile in [
            MeanProfile::Uniform { speed: 9.0 },
            MeanProfile::PowerLaw { hub_height: 150.0, speed: 9.0, exponent: 0.14 },
            MeanProfile::LogLaw { hub_height: 150.0, speed: 9.0, roughness_length: 1e-3 },
        ] {
            assert!((profile.speed(150.0) - 9.0).abs() < 1e-12);
            assert_eq!(profile.hub_speed(), 9.0);
        }
    }

    /// TurbSim's summary file for 9 m/s at 150 m and exponent 0.14 lists these speeds.
    #[test]
    fn agrees_with_turbsim() {
        let profile = MeanProfile::PowerLaw { hub_height: 150.0, speed: 9.0, exponent: 0.14 };
        for (height, speed) in [(295.0, 9.89), (246.7, 9.65), (63.0, 7.97), (5.0, 5.59)] {
            assert!((profile.speed(height) - speed).abs() < 0.0051, "{height} m");
        }
    }

    #[test]
    fn a_roughness_that_leaves_no_profile_is_refused() {
        let of = |roughness_length| MeanProfile::LogLaw {
            hub_height: 90.0,
            speed: 9.0,
            roughness_length,
        };
        assert!(of(9.0).check().is_ok());
        for refused in [9.001, 0.0, f64::NAN] {
            assert!(of(refused).check().is_err(), "{refused} m");
        }
    }

    #[test]
    fn log_law_is_calm_at_the_roughness_length() {
        let profile = MeanProfile::LogLaw { hub_height: 100.0, speed: 10.0, roughness_length: 0.1 };
        assert_eq!(profile.speed(0.1), 0.0);
        assert_eq!(profile.speed(-3.0), 0.0);
        assert!((profile.speed(1.0) - 10.0 / 3.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn is_finite_and_not_negative_everywhere(
            height in -100.0..2000.0_f64, exponent in -0.2..0.6_f64, roughness_length in 1e-5..2.0_f64,
        ) {
            for profile in [
                MeanProfile::PowerLaw { hub_height: 90.0, speed: 12.0, exponent },
                MeanProfile::LogLaw { hub_height: 90.0, speed: 12.0, roughness_length },
            ] {
                let speed = profile.speed(height);
                prop_assert!(speed.is_finite() && speed >= 0.0);
            }
        }

        #[test]
        fn sampling_is_the_profile(heights in prop::collection::vec(-5.0..400.0_f64, 1..20)) {
            let profile = MeanProfile::PowerLaw { hub_height: 90.0, speed: 12.0, exponent: 0.2 };
            let positions: Vec<_> = heights.iter().map(|&z| Vector3::new(3.0, z, z)).collect();
            let mut velocities = vec![Vector3::ZERO; positions.len()];
            profile.sample(7.0, &positions, &mut velocities);
            for (height, velocity) in heights.iter().zip(velocities) {
                prop_assert_eq!(velocity, Vector3::new(profile.speed(*height), 0.0, 0.0));
            }
        }
    }
}
