//! Mechanical energy and momentum of the whole turbine: what a free motion keeps.

use super::coordinates::{Coordinates, TORSION};
use super::machine::{Machine, Pitch};
use super::stations::Gathered;

/// Mechanical energy (J); its parts need no common zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion (J).
    pub kinetic: f64,
    /// Of bending and torsion (J).
    pub elastic: f64,
    /// Of height, from the farm's origin (J).
    pub gravitational: f64,
}

impl Energy {
    /// Sum of all (J).
    pub fn total(&self) -> f64 {
        self.kinetic + self.elastic + self.gravitational
    }
}

impl Machine {
    /// Energy at `q` and `v`, blades pitched by `pitch` and not pitching.
    pub(super) fn energy(&self, q: &Coordinates, v: &Coordinates, pitch: &[Pitch]) -> Energy {
        let balance = self.balance(q, v, pitch, &Gathered::default());
        let momenta = balance.mass.times(self.n_blades, v);
        let twice = |momenta: &[f64], rates: &[f64]| -> f64 {
            momenta.iter().zip(rates).map(|(momentum, rate)| momentum * rate).sum()
        };
        let mut kinetic = twice(&momenta.shared, &v.shared);
        let mut elastic = self.tower.elastic_energy(&q.tower())
            + 0.5 * self.shaft_stiffness * q.shared[TORSION].powi(2);
        let motion = &balance.motion;
        let mut moment = motion.top.origin * self.yaw_bearing_mass
            + motion.nacelle.origin * self.nacelle_mass
            + motion.hub.origin * self.hub_mass
            + self.base * balance.tower.mass
            + balance.tower.first;
        for blade in 0..self.n_blades {
            kinetic += twice(&momenta.blades[blade], &v.blades[blade]);
            elastic += self.blade.elastic_energy(&q.blades[blade]);
            let (frame, inertia) = (&motion.blades[blade], &balance.blades[blade]);
            moment += frame.origin * inertia.mass + frame.axes * inertia.first;
        }
        Energy { kinetic: 0.5 * kinetic, elastic, gravitational: -self.gravity.dot(moment) }
    }
}
