//! Mechanical energy of the whole turbine, which a free motion conserves.

use super::coordinates::{Coordinates, TORSION};
use super::machine::{Machine, Pitch};
use super::stations::LoadResultants;

/// Mechanical energy (J); each part has a zero of its own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Kinetic energy (J).
    pub kinetic: f64,
    /// Elastic energy of bending and torsion (J).
    pub elastic: f64,
    /// Potential energy of gravity, from the farm's origin (J).
    pub gravitational: f64,
}

impl Energy {
    /// Sum of all (J).
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.gravitational
    }
}

impl Machine {
    /// Energy at `q` and `v`, blades at `pitch` and their pitch rates left out.
    pub(super) fn energy(&self, q: &Coordinates, v: &Coordinates, pitch: &[Pitch]) -> Energy {
        let equations = self.equations_of_motion(q, v, pitch, &LoadResultants::default());
        let momenta = equations.mass.times(self.n_blades, v);
        let twice = |momenta: &[f64], rates: &[f64]| -> f64 {
            momenta.iter().zip(rates).map(|(momentum, rate)| momentum * rate).sum()
        };
        let mut kinetic = twice(&momenta.shared, &v.shared);
        let mut elastic = self.tower.elastic_energy(&q.tower())
            + 0.5 * self.shaft_stiffness * q.shared[TORSION].powi(2);
        let motion = &equations.motion;
        let mut moment = motion.top.origin * self.yaw_bearing_mass
            + motion.nacelle.origin * self.nacelle_mass
            + motion.hub.origin * self.hub_mass
            + self.base * equations.tower.mass
            + equations.tower.first;
        for blade in 0..self.n_blades {
            kinetic += twice(&momenta.blades[blade], &v.blades[blade]);
            elastic += self.blade.elastic_energy(&q.blades[blade]);
            let (frame, inertia) = (&motion.blades[blade], &equations.blades[blade]);
            moment += frame.origin * inertia.mass + frame.axes * inertia.first;
        }
        Energy { kinetic: 0.5 * kinetic, elastic, gravitational: -self.gravity.dot(moment) }
    }
}
