//! Internal loads: applied loads and gravity less inertia, of everything outboard of a cut.

use super::beam::{BaseMotion, Wrench};
use super::coordinates::{GENERATOR, N_MODES, TORSION};
use super::equations_of_motion::EquationsOfMotion;
use super::machine::{Machine, N_BLADE_PARTS};
use super::midpoint::PhasePoint;
use super::stations::LoadResultants;
use basis::{PerBlade, Vector3};
use serde::{Deserialize, Serialize};

/// Stations along a blade at which bending moments are output, at equal fractions of its length (–).
pub const N_GAUGES: usize = N_BLADE_PARTS - 1;

/// Loads and deflections of one blade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BladeLoads {
    /// At the root, in the coned frame, which does not pitch: x downwind, y towards the trailing edge, z
    /// along the pitch axis.
    pub root: Wrench,
    /// The same in the pitched frame.
    pub pitched_root: Wrench,
    /// Deflection of the tip in the coned frame (m): out of plane downwind, in plane towards the trailing
    /// edge, along the blade.
    pub tip_deflection: Vector3,
    /// Moments (N m) at 1/8 to 7/8 of the blade about the local principal axes: edgewise (x), flapwise (y).
    pub span_moments: [[f64; 2]; N_GAUGES],
}

/// Loads and motions of the whole turbine at the middle of a step.
///
/// A load is what the outboard side of a cut does to its inboard side, the convention of OpenFAST.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Loads {
    /// Azimuth of blade 1 (rad, not wrapped).
    pub azimuth: f64,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Generator speed, high-speed side (rad/s).
    pub generator_speed: f64,
    /// Loads of each blade.
    pub blades: PerBlade<BladeLoads>,
    /// Rotor on the shaft at the rotor apex, axes of the shaft, not rotating: x downwind, y left, z up.
    pub shaft: Wrench,
    /// The same in axes that rotate with the hub.
    pub rotating_shaft: Wrench,
    /// Nacelle and rotor on the yaw bearing, axes of the tower top, not yawing: x downwind, y left, z up.
    pub yaw_bearing: Wrench,
    /// The whole turbine on the foot of the tower: x downwind, y left, z up.
    pub tower_base: Wrench,
    /// Displacement of the tower top, downwind, left, up (m).
    pub tower_top: Vector3,
    /// Acceleration of the tower top without gravity, axes of the shaft (m/s²).
    pub nacelle_acceleration: Vector3,
}

impl Machine {
    /// Loads where `phase`, its accelerations included, satisfies `equations` under the loads `applied`.
    pub(super) fn loads(
        &self,
        phase: &PhasePoint,
        equations: &EquationsOfMotion,
        applied: &LoadResultants,
    ) -> Loads {
        let motion = &equations.motion;
        let azimuth = phase.q.shared[GENERATOR] + phase.q.shared[TORSION];
        let rotor_speed = phase.v.shared[GENERATOR] + phase.v.shared[TORSION];
        let hub_turning = motion.hub.angular_acceleration(&phase.a);
        let mut rotor = Wrench {
            force: (self.gravity - motion.hub.acceleration(&phase.a)) * self.hub_mass,
            moment: -self.hub_axial_inertia(motion).required_moment(hub_turning),
        };
        let blades = PerBlade::from_fn(self.n_blades, |blade| {
            let (loads, at_apex) = self.blade_loads(blade, phase, equations, applied);
            rotor.add(at_apex.turned(&motion.blades[blade].axes));
            loads
        });
        let generator = self.generator(motion, &phase.v);
        let generator_turning = generator.angular_acceleration(&phase.a);
        let nacelle_turning = motion.nacelle.angular_acceleration(&phase.a);
        let weight = (self.gravity - motion.nacelle.acceleration(&phase.a)) * self.nacelle_mass;
        let mut top = rotor;
        top.force += applied.nacelle;
        top.moment -= self.generator_axial_inertia(&generator).required_moment(generator_turning);
        top = top.about(motion.hub.origin - motion.top.origin);
        top.moment -= self.nacelle_axial_inertia(motion).required_moment(nacelle_turning);
        top.add(
            Wrench { force: weight, moment: Vector3::ZERO }
                .about(motion.nacelle.origin - motion.top.origin),
        );
        let top_acceleration = motion.top.acceleration(&phase.a);
        let mut base = top;
        base.force += (self.gravity - top_acceleration) * self.yaw_bearing_mass;
        base = base.about(motion.top.origin - self.base);
        base.add(applied.tower);
        base.force -= equations.tower.bias.force;
        base.moment -= equations.tower.bias.moment;
        for (mode, acceleration) in phase.a.tower().iter().enumerate() {
            base.force -= equations.tower.linear[mode] * *acceleration;
            base.moment -= equations.tower.angular[mode] * *acceleration;
        }
        let shaft_from_farm = motion.shaft.axes.transpose();
        Loads {
            azimuth,
            rotor_speed,
            generator_speed: self.gear_ratio * phase.v.shared[GENERATOR],
            blades,
            shaft: rotor.turned(&shaft_from_farm),
            rotating_shaft: rotor.turned(&motion.hub.axes.transpose()),
            yaw_bearing: top.turned(&motion.top.axes.transpose()),
            tower_base: base,
            tower_top: motion.top.origin - self.base - self.tower_top.rest,
            nacelle_acceleration: shaft_from_farm * top_acceleration,
        }
    }

    /// Loads of `blade`, and its load on the hub about the rotor apex in its own axes.
    fn blade_loads(
        &self,
        blade: usize,
        phase: &PhasePoint,
        equations: &EquationsOfMotion,
        applied: &LoadResultants,
    ) -> (BladeLoads, Wrench) {
        let frame = &equations.motion.blades[blade];
        let (q, v, a) = (&phase.q.blades[blade], &phase.v.blades[blade], &phase.a.blades[blade]);
        let own_from_farm = frame.axes.transpose();
        let base_motion = BaseMotion {
            acceleration: own_from_farm * (frame.acceleration(&phase.a) - self.gravity),
            spin: own_from_farm * frame.spin,
            angular_acceleration: own_from_farm * frame.angular_acceleration(&phase.a),
        };
        let mut outboard = Wrench::default();
        let mut span_moments = [[0.0; 2]; N_GAUGES];
        self.blade.inertial_forces(q, v, a, &base_motion, |index, position, force| {
            outboard.force += force;
            outboard.moment += position.cross(force);
            if index % 2 == 1 {
                return;
            }
            let part = index / 2;
            outboard.add(applied.parts[blade][part]);
            if part > 0 {
                span_moments[part - 1] = self.principal_moments(part, q, &outboard);
            }
        });
        let pitched_root = outboard.about(Vector3::Z * -self.hub_radius);
        let (tip, _) = self.blade_tip.at(q);
        let farm_from_cone = self.cone_axes(blade, &equations.motion);
        let coned_from_pitched = farm_from_cone.transpose() * frame.axes;
        let loads = BladeLoads {
            root: pitched_root.turned(&coned_from_pitched),
            pitched_root,
            tip_deflection: coned_from_pitched * (tip - self.blade_tip.rest),
            span_moments,
        };
        (loads, outboard)
    }

    /// Moments (N m) about the principal axes at the inner end of `part`, of all beyond it, `outboard` about
    /// the apex.
    fn principal_moments(&self, part: usize, q: &[f64; N_MODES], outboard: &Wrench) -> [f64; 2] {
        let place = &self.blade.borders[part];
        let (position, _) = place.at(q);
        let moment = outboard.about(-position).moment;
        let (sine, cosine) = self.gauge_twist[part - 1].sin_cos();
        let turn = place.turn(q);
        let axes = [Vector3::new(cosine, -sine, 0.0), Vector3::new(sine, cosine, 0.0)];
        axes.map(|axis| moment.dot(axis + turn.cross(axis)))
    }
}
