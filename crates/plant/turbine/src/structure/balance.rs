//! Kane's equations M(q) q̈ = f: every body's inertia and load, put on the coordinates through its partial velocities.
#![expect(
    clippy::needless_range_loop,
    reason = "rows and columns by index, as the equations have them"
)]

use super::arrow::Arrow;
use super::beam::{Carrier, Inertia};
use super::coordinates::{Coordinates, GENERATOR, N_MODES, N_SHARED, N_TOWER, TORSION};
use super::frame::MovingFrame;
use super::machine::{Machine, Motion, Pitch};
use super::stations::Gathered;
use basis::Vector3;
use basis::blades::MAXIMUM_BLADES;

/// Both sides of the equations of motion at one instant, and what load recovery needs of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Balance {
    /// Mass matrix M (kg, kg m, kg m²).
    pub(super) mass: Arrow,
    /// Generalised forces f (N, N m): loads, gravity, stiffness, damping, less what velocities alone demand.
    pub(super) force: Coordinates,
    pub(super) motion: Motion,
    pub(super) tower: Inertia<N_TOWER>,
    pub(super) blades: [Inertia<N_MODES>; MAXIMUM_BLADES],
}

/// A body that has inertia about one axis only.
pub(super) struct Spinner {
    pub(super) axis: Vector3,
    pub(super) inertia: f64,
    pub(super) spin: Vector3,
}

impl Spinner {
    /// Moment (N m) that turning takes at the angular acceleration `acceleration` (rad/s²): d/dt of I (ω·a) a.
    pub(super) fn demand(&self, acceleration: Vector3) -> Vector3 {
        let momentum = self.inertia * self.spin.dot(self.axis);
        // The axis is carried round by what of the spin lies across it.
        self.axis * (self.inertia * acceleration.dot(self.axis))
            + self.spin.cross(self.axis) * momentum
    }
}

impl Machine {
    /// The nacelle about its own vertical.
    pub(super) fn nacelle_spinner(&self, motion: &Motion) -> Spinner {
        let nacelle = &motion.nacelle;
        Spinner { axis: nacelle.axes.z_axis, inertia: self.nacelle_inertia, spin: nacelle.spin }
    }

    /// The hub about the shaft.
    pub(super) fn hub_spinner(&self, motion: &Motion) -> Spinner {
        Spinner { axis: motion.hub.axes.x_axis, inertia: self.hub_inertia, spin: motion.hub.spin }
    }

    /// The generator's frame, turning `gear_ratio` times as fast as its azimuth.
    pub(super) fn generator(&self, motion: &Motion, v: &Coordinates) -> MovingFrame {
        let shaft = &motion.shaft;
        let mut frame =
            shaft.turning(shaft.axes.x_axis, self.gear_ratio * v.shared[GENERATOR], 0.0, &[]);
        frame.angular[GENERATOR] += shaft.axes.x_axis * self.gear_ratio;
        frame
    }

    /// The generator about the shaft, `frame` its own.
    pub(super) fn generator_spinner(&self, frame: &MovingFrame) -> Spinner {
        Spinner { axis: frame.axes.x_axis, inertia: self.generator_inertia, spin: frame.spin }
    }

    /// Both sides of the equations of motion at `q` and `v` under the loads `applied`.
    pub(super) fn balance(
        &self,
        q: &Coordinates,
        v: &Coordinates,
        pitch: &[Pitch],
        applied: &Gathered,
    ) -> Balance {
        let motion = self.motion(q, v, pitch);
        let ground = Carrier { acceleration: -self.gravity, ..Carrier::default() };
        let (tower_q, tower_v) = (q.tower(), v.tower());
        let mut balance = Balance {
            mass: Arrow::default(),
            force: Coordinates::default(),
            motion,
            tower: self.tower.inertia(&tower_q, &tower_v, &ground),
            blades: [Inertia::ZERO; MAXIMUM_BLADES],
        };
        let restoring = self.tower.restoring(&tower_q, &tower_v);
        for i in 0..N_TOWER {
            balance.mass.shared[i][..N_TOWER].copy_from_slice(&balance.tower.modal[i]);
            balance.force.shared[i] =
                applied.tower_modes[i] + restoring[i] - balance.tower.modal_demand[i];
        }
        let motion = &balance.motion;
        let (mass, force) = (&mut balance.mass.shared, &mut balance.force.shared);
        put_point(mass, force, &motion.top, self.yaw_bearing_mass, self.gravity);
        put_point(mass, force, &motion.nacelle, self.nacelle_mass, self.gravity);
        put_point(mass, force, &motion.hub, self.hub_mass, self.gravity);
        put_spinner(mass, force, &motion.nacelle, &self.nacelle_spinner(motion));
        put_spinner(mass, force, &motion.hub, &self.hub_spinner(motion));
        let generator = self.generator(motion, v);
        put_spinner(mass, force, &generator, &self.generator_spinner(&generator));
        for i in 0..N_TOWER {
            force[i] += motion.shaft.linear[i].dot(applied.nacelle);
        }
        force[GENERATOR] -= applied.generator_torque;
        force[TORSION] -=
            self.shaft_stiffness * q.shared[TORSION] + self.shaft_damping * v.shared[TORSION];
        for blade in 0..self.n_blades {
            self.put_blade(blade, q, v, applied, &mut balance);
        }
        balance
    }

    /// Adds a blade: six rigid motions of its frame, given by the shared coordinates, and its own modes.
    fn put_blade(
        &self,
        blade: usize,
        q: &Coordinates,
        v: &Coordinates,
        applied: &Gathered,
        balance: &mut Balance,
    ) {
        let frame = &balance.motion.blades[blade];
        let (q, v) = (&q.blades[blade], &v.blades[blade]);
        let own_from_farm = frame.axes.transpose();
        let carrier = Carrier {
            acceleration: own_from_farm * (frame.acceleration_rest - self.gravity),
            spin: own_from_farm * frame.spin,
            angular_acceleration: own_from_farm * frame.angular_rest,
        };
        let inertia = self.blade.inertia(q, v, &carrier);
        let mut net = applied.blade(blade);
        net.force -= inertia.demand.force;
        net.moment -= inertia.demand.moment;
        let restoring = self.blade.restoring(q, v);
        for mode in 0..N_MODES {
            balance.mass.blades[blade][mode] = inertia.modal[mode];
            balance.force.blades[blade][mode] =
                applied.modes[blade][mode] + restoring[mode] - inertia.modal_demand[mode];
        }
        // Torsion turns the rotor exactly as the generator does: its column repeats, so the loop ends before it.
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
            balance.force.shared[c] +=
                linear[column].dot(net.force) + angular[column].dot(net.moment);
            for mode in 0..N_MODES {
                balance.mass.coupling[blade][mode][c] = linear[column].dot(inertia.linear[mode])
                    + angular[column].dot(inertia.angular[mode]);
            }
            for d in 0..N_SHARED {
                balance.mass.shared[c][d] += block[own][d.min(GENERATOR)];
            }
        }
        balance.blades[blade] = inertia;
    }
}

/// Adds a point mass at the origin of `frame`.
fn put_point(
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

/// Adds a body's inertia about one axis.
fn put_spinner(
    mass: &mut [[f64; N_SHARED]; N_SHARED],
    force: &mut [f64; N_SHARED],
    frame: &MovingFrame,
    spinner: &Spinner,
) {
    let demand = spinner.demand(frame.angular_rest);
    let along: [f64; N_SHARED] = std::array::from_fn(|c| frame.angular[c].dot(spinner.axis));
    for c in 0..N_SHARED {
        for d in 0..N_SHARED {
            mass[c][d] += spinner.inertia * along[c] * along[d];
        }
        force[c] -= frame.angular[c].dot(demand);
    }
}
