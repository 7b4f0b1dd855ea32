//! The only door between SI and lattice units.

use basis::Vector3;

/// Square of the lattice speed of sound, in cells² per step².
const SOUND_SPEED_SQUARED: f64 = 1.0 / 3.0;

/// Turns SI quantities of the farm frame into lattice units and back.
///
/// In lattice units a cell is one long, a step takes one, and undisturbed air has density one. A cell's
/// integer coordinates mean its centre, so the domain's corner `origin` lies at (−½, −½, −½).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scaling {
    origin: Vector3,
    spacing: f64,
    interval: f64,
    air_density: f64,
}

impl Scaling {
    /// Cells of edge `spacing` (m) from the corner `origin` (m), steps of `interval` (s), air of
    /// `air_density` (kg/m³).
    pub fn new(origin: Vector3, spacing: f64, interval: f64, air_density: f64) -> Self {
        Self { origin, spacing, interval, air_density }
    }

    /// Edge of a cell (m).
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Duration of a step (s).
    pub fn interval(&self) -> f64 {
        self.interval
    }

    /// Cell coordinates (–) of a farm position (m); whole numbers are cell centres.
    pub fn to_lattice_position(&self, position: Vector3) -> Vector3 {
        (position - self.origin) / self.spacing - Vector3::splat(0.5)
    }

    /// Farm position (m) of cell coordinates (–).
    pub fn to_si_position(&self, coordinates: Vector3) -> Vector3 {
        self.origin + (coordinates + Vector3::splat(0.5)) * self.spacing
    }

    /// Cells (–) in a length (m).
    pub fn to_lattice_length(&self, length: f64) -> f64 {
        length / self.spacing
    }

    /// Cells per step (–) of a velocity (m/s).
    pub fn to_lattice_velocity(&self, velocity: Vector3) -> Vector3 {
        velocity * (self.interval / self.spacing)
    }

    /// Velocity (m/s) of cells per step (–).
    pub fn to_si_velocity(&self, velocity: Vector3) -> Vector3 {
        velocity * self.si_velocity_unit()
    }

    /// One cell per step, as a speed (m/s).
    pub fn si_velocity_unit(&self) -> f64 {
        self.spacing / self.interval
    }

    /// Cells per step per step (–) of an acceleration (m/s²).
    pub fn to_lattice_acceleration(&self, acceleration: Vector3) -> Vector3 {
        acceleration * (self.interval * self.interval / self.spacing)
    }

    /// Lattice force density (–) of a force (N) that acts on one cell.
    pub fn to_lattice_force(&self, force: Vector3) -> Vector3 {
        force * (self.interval * self.interval / (self.air_density * self.spacing.powi(4)))
    }

    /// Force (N) on one cell of a lattice force density (–).
    pub fn to_si_force(&self, force: Vector3) -> Vector3 {
        force * (self.air_density * self.spacing.powi(4) / (self.interval * self.interval))
    }

    /// Cells² per step (–) of a kinematic viscosity (m²/s).
    pub fn to_lattice_viscosity(&self, kinematic_viscosity: f64) -> f64 {
        kinematic_viscosity * self.interval / (self.spacing * self.spacing)
    }

    /// Pressure above the undisturbed one (Pa) of a density excess (–).
    pub fn to_si_pressure(&self, density_excess: f64) -> f64 {
        self.air_density * SOUND_SPEED_SQUARED * density_excess * self.si_velocity_unit().powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_is_the_identity() {
        let scaling = Scaling::new(Vector3::new(-240.0, -480.0, 0.0), 15.0, 0.1, 1.225);
        let position = Vector3::new(12.0, -3.0, 150.0);
        assert!(
            (scaling.to_si_position(scaling.to_lattice_position(position)) - position).length()
                < 1e-10
        );
        let velocity = Vector3::new(9.0, 0.3, -0.1);
        assert!(
            (scaling.to_si_velocity(scaling.to_lattice_velocity(velocity)) - velocity).length()
                < 1e-12
        );
        let force = Vector3::new(1.0e5, 2.0, 3.0);
        assert!((scaling.to_si_force(scaling.to_lattice_force(force)) - force).length() < 1e-6);
    }

    #[test]
    fn newton_holds_across_the_door() {
        // A force on one cell of air changes its speed by F dt / m.
        let scaling = Scaling::new(Vector3::ZERO, 12.0, 0.07, 1.2);
        let force = Vector3::new(500.0, 0.0, 0.0);
        let change = scaling.to_si_velocity(scaling.to_lattice_force(force));
        let expected = 500.0 * 0.07 / (1.2 * 12.0_f64.powi(3));
        assert!((change.x - expected).abs() < 1e-12);
    }
}
