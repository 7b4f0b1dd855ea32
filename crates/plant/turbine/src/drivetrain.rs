//! The drive train: one inertia between the air and the generator.

use serde::{Deserialize, Serialize};

/// A rigid drive train, everything on the low-speed side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drivetrain {
    /// Inertia of rotor and generator about the shaft (kg m²).
    pub inertia: f64,
    /// Electrical power over generator torque × rotor speed (–).
    pub efficiency: f64,
}

/// Where the rotor stands and how fast it turns.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RotorState {
    /// Azimuth of blade 1, zero up, clockwise seen from upwind (rad, [0, 2π)).
    pub azimuth: f64,
    /// Rotor speed (rad/s).
    pub speed: f64,
}

impl Drivetrain {
    /// `rotor` after `interval` (s) under torques (N m) that are held meanwhile: exact, J Ω′ = Q_air − Q_generator.
    ///
    /// A rotor that would turn backwards stands still: the generator does not drive it.
    pub fn after(
        &self,
        rotor: RotorState,
        interval: f64,
        aerodynamic_torque: f64,
        generator_torque: f64,
    ) -> RotorState {
        let acceleration = (aerodynamic_torque - generator_torque) / self.inertia;
        let speed = (rotor.speed + acceleration * interval).max(0.0);
        let azimuth =
            basis::angle::wrap_to_turn(rotor.azimuth + 0.5 * (rotor.speed + speed) * interval);
        RotorState { azimuth, speed }
    }

    /// Electrical power (W) at `rotor_speed` (rad/s) and `generator_torque` (N m, low-speed side).
    pub fn power(&self, rotor_speed: f64, generator_torque: f64) -> f64 {
        self.efficiency * generator_torque * rotor_speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_torque_spins_up_in_closed_form() {
        let drivetrain = Drivetrain { inertia: 3.2e8, efficiency: 0.95 };
        let mut rotor = RotorState { azimuth: 0.0, speed: 0.2 };
        for _ in 0..1000 {
            rotor = drivetrain.after(rotor, 0.1, 9e6, 5e6);
        }
        let (acceleration, t): (f64, f64) = (4e6 / 3.2e8, 100.0);
        let turned = 0.2 * t + 0.5 * acceleration * t * t;
        assert!((rotor.speed - 0.2 - acceleration * t).abs() < 1e-12);
        assert!((rotor.azimuth - turned.rem_euclid(std::f64::consts::TAU)).abs() < 1e-9);
        assert!((drivetrain.power(rotor.speed, 5e6) - 0.95 * 5e6 * rotor.speed).abs() < 1e-6);
    }

    #[test]
    fn a_braked_rotor_stops_and_does_not_turn_back() {
        let drivetrain = Drivetrain { inertia: 1e8, efficiency: 1.0 };
        let rotor = drivetrain.after(RotorState { azimuth: 1.0, speed: 0.01 }, 1.0, 0.0, 5e6);
        assert_eq!(rotor.speed, 0.0);
        assert!(rotor.azimuth >= 1.0);
    }
}
