//! Kane's equations M(q) q̈ = f: every body's inertia and load, put on the coordinates through its partial
//! velocities.
#![expect(
    clippy::needless_range_loop,
    reason = "rows and columns by index, as the equations have them"
)]

use super::arrowhead::ArrowheadMatrix;
use super::beam::{BaseMotion, Inertia};
use super::coordinates::{Coordinates, GENERATOR, N_MODES, N_SHARED, N_TOWER, TORSION};
use super::frame::MovingFrame;
use super::machine::{Machine, Motion, Pitch};
use super::stations::LoadResultants;
use basis::Vector3;
use basis::blades::MAXIMUM_BLADES;

/// Both sides of the equations of motion at one instant, with the parts that load recovery needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct EquationsOfMotion {
    /// Mass matrix M (kg, kg m, kg m²).
    pub(super) mass: ArrowheadMatrix,
    /// Generalised forces f (N, N m): loads, gravity, stiffness and damping, less the velocity-dependent
    /// inertial forces.
    pub(super) force: Coordinates,
    pub(super) motion: Motion,
    pub(super) tower: Inertia<N_TOWER>,
    pub(super) blades: [Inertia<N_MODES>; MAXIMUM_BLADES],
}

/// Axial rotary inertia: a body with inertia about one axis only.
pub(super) struct AxialInertia {
    pub(super) axis: Vector3,
    pub(super) inertia: f64,
    pub(super) spin: Vector3,
}

impl AxialInertia {
    /// Moment (N m) that the body needs at the angular acceleration `acceleration` (rad/s²): d/dt of I (ω·a)
    /// a.
    pub(super) fn required_moment(&self, acceleration: Vector3) -> Vector3 {
        let momentum = self.inertia * self.spin.dot(self.axis);
        // The part of the spin across the axis turns the axis itself.
        self.axis * (self.inertia * acceleration.dot(self.axis))
            + self.spin.cross(self.axis) * momentum
    }
}

impl Machine {
    /// Axial rotary inertia of the nacelle about its own vertical.
    pub(super) fn nacelle_axial_inertia(&self, motion: &Motion) -> AxialInertia {
        let nacelle = &motion.nacelle;
        AxialInertia {
            axis: nacelle.axes.z_axis,
            inertia: self.nacelle_inertia,
            spin: nacelle.spin,
        }
    }

    /// Axial rotary inertia of the hub about the shaft.
    pub(super) fn hub_axial_inertia(&self, motion: &Motion) -> AxialInertia {
        AxialInertia {
            axis: motion.hub.axes.x_axis,
            inertia: self.hub_inertia,
            spin: motion.hub.spin,
        }
    }

    /// The generator's frame, turning `gear_ratio` times as fast as its azimuth.
    pub(super) fn generator(&self, motion: &Motion, v: &Coordinates) -> MovingFrame {
        let shaft = &motion.shaft;
        let mut frame =
            shaft.turning(shaft.axes.x_axis, self.gear_ratio * v.shared[GENERATOR], 0.0, &[]);
        frame.angular[GENERATOR] += shaft.axes.x_axis * self.gear_ratio;
        frame
    }

    /// Axial rotary inertia of the generator about the shaft, in its own `frame`.
    pub(super) fn generator_axial_inertia(&self, frame: &MovingFrame) -> AxialInertia {
        AxialInertia { axis: frame.axes.x_axis, inertia: self.generator_inertia, spin: frame.spin }
    }

    /// Both sides of the equations of motion at `q` and `v` under the loads `applied`.
    pub(super) fn equations_of_motion(
        &self,
        q: &Coordinates,
        v: &Coordinates,
        pitch: &[Pitch],
        applied: &LoadResultants,
    ) -> EquationsOfMotion {
        let motion = self.motion(q, v, pitch);
        let ground = BaseMotion { acceleration: -self.gravity, ..BaseMotion::default() };
        let (tower_q, tower_v) = (q.tower(), v.tower());
        let mut equations = EquationsOfMotion {
            mass: ArrowheadMatrix::default(),
            force: Coordinates::default(),
            motion,
            tower: self.tower.inertia(&tower_q, &tower_v, &ground),
            blades: [Inertia::ZERO; MAXIMUM_BLADES],
        };
        let restoring = self.tower.restoring(&tower_q, &tower_v);
        for i in 0..N_TOWER {
            equations.mass.shared[i][..N_TOWER].copy_from_slice(&equations.tower.modal[i]);
            equations.force.shared[i] =
                applied.tower_modes[i] + restoring[i] - equations.tower.modal_bias[i];
        }
        let motion = &equations.motion;
        let (mass, force) = (&mut equations.mass.shared, &mut equations.force.shared);
        add_point_mass(mass, force, &motion.top, self.yaw_bearing_mass, self.gravity);
        add_point_mass(mass, force, &motion.nacelle, self.nacelle_mass, self.gravity);
        add_point_mass(mass, force, &motion.hub, self.hub_mass, self.gravity);
        add_axial_inertia(mass, force, &motion.nacelle, &self.nacelle_axial_inertia(motion));
        add_axial_inertia(mass, force, &motion.hub, &self.hub_axial_inertia(motion));
        let generator = self.generator(motion, v);
        add_axial_inertia(mass, force, &generator, &self.generator_axial_inertia(&generator));
        for i in 0..N_TOWER {
            force[i] += motion.shaft.linear[i].dot(applied.nacelle);
        }
        force[GENERATOR] -= applied.generator_torque;
        force[TORSION] -=
            self.shaft_stiffness * q.shared[TORSION] + self.shaft_damping * v.shared[TORSION];
        for blade in 0..self.n_blades {
            self.add_blade(blade, q, v, applied, &mut equations);
        }
        equations
    }

    /// Adds a blade: the six rigid-body motions of its frame, which the shared coordinates give, and its own
    /// modes.
    fn add_blade(
        &self,
        blade: usize,
        q: &Coordinates,
        v: &Coordinates,
        applied: &LoadResultants,
        equations: &mut EquationsOfMotion,
    ) {
        let frame = &equations.motion.blades[blade];
        let (q, v) = (&q.blades[blade], &v.blades[blade]);
        let own_from_farm = frame.axes.transpose();
        let base_motion = BaseMotion {
            acceleration: own_from_farm * (frame.acceleration_rest - self.gravity),
            spin: own_from_farm * frame.spin,
            angular_acceleration: own_from_farm * frame.angular_rest,
        };
        let inertia = self.blade.inertia(q, v, &base_motion);
        let mut net = applied.blade(blade);
        net.force -= inertia.bias.force;
        net.moment -= inertia.bias.moment;
        let restoring = self.blade.restoring(q, v);
        for mode in 0..N_MODES {
            equations.mass.blades[blade][mode] = inertia.modal[mode];
            equations.force.blades[blade][mode] =
                applied.modes[blade][mode] + restoring[mode] - inertia.modal_bias[mode];
        }
        // Torsion turns the rotor exactly as the generator does: its column repeats, so the loop ends before
        // it.
        let mut linear = [Vector3::ZERO; TORSION];
        let mut angular = [Vector3::ZERO; TORSION];
        for c in 0..TORSION {
            linear[c] = own_from_farm * frame.linear[c];
            angular[c] = own_from_farm * frame.angular[c];
        }
        let mut block = [[0.0; N_SHARED]; N_SHARED];
        for d in 0..TORSION {
            // Momentum and angular momentum of the blade at unit speed of coordinate d.
            let momentum = linear[d] * inertia.mass + angular[d].cross(inertia.first);
            let angular_momentum = inertia.first.cross(linear[d]) + inertia.second * angular[d];
            for c in 0..=d {
                block[c][d] = linear[c].dot(momentum) + angular[c].dot(angular_momentum);
                block[d][c] = block[c][d];
            }
        }
        for c in 0..N_SHARED {
            let (column, own) = if c == TORSION { (GENERATOR, GENERATOR) } else { (c, c) };
            equations.force.shared[c] +=
                linear[column].dot(net.force) + angular[column].dot(net.moment);
            for mode in 0..N_MODES {
                equations.mass.coupling[blade][mode][c] = linear[column].dot(inertia.linear[mode])
                    + angular[column].dot(inertia.angular[mode]);
            }
            for d in 0..N_SHARED {
                equations.mass.shared[c][d] += block[own][d.min(GENERATOR)];
            }
        }
        equations.blades[blade] = inertia;
    }
}

/// Adds a point mass at the origin of `frame`.
fn add_point_mass(
    mass: &mut [[f64; N_SHARED]; N_SHARED],
    force: &mut [f64; N_SHARED],
    frame: &MovingFrame,
    amount: f64,
    gravity: Vector3,
) {
    let net = (gravity - frame.acceleration_rest) * amount;
    for c in 0..N_TOWER {
        for d in 0..N_TOWER {
            mass[c][d] += amount * frame.linear[c].dot(frame.linear[d]);
        }
        force[c] += frame.linear[c].dot(net);
    }
}

/// Adds the axial rotary inertia of a `body` that moves with `frame`.
fn add_axial_inertia(
    mass: &mut [[f64; N_SHARED]; N_SHARED],
    force: &mut [f64; N_SHARED],
    frame: &MovingFrame,
    body: &AxialInertia,
) {
    let required = body.required_moment(frame.angular_rest);
    let along: [f64; N_SHARED] = std::array::from_fn(|c| frame.angular[c].dot(body.axis));
    for c in 0..N_SHARED {
        for d in 0..N_SHARED {
            mass[c][d] += body.inertia * along[c] * along[d];
        }
        force[c] -= frame.angular[c].dot(required);
    }
}
