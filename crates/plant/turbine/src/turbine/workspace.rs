//! Working memory of a turbine: what one interval needs at its points, and the forces on the air that it ends
//! with.

use super::state::Readings;
use crate::actuator_line::Element;
use crate::bodies::Body;
use crate::motion::ElementMotion;
use crate::rotor::{BladeFrame, Frame};
use crate::structure::ElementLoad;
use basis::{BoundVortex, PointForce, Vector3};

/// Working memory; nothing in it outlasts an interval that the state does not hold.
#[derive(Clone, Debug)]
pub(super) struct Workspace {
    pub(super) stations: Vec<Vector3>,
    /// Directions of the blade elements where the winds are sampled.
    pub(super) axes: Vec<BladeFrame>,
    pub(super) motions: Vec<ElementMotion>,
    pub(super) loads: Vec<ElementLoad>,
    /// Sums over the steps of an interval: force on each element along normal and tangent (N).
    pub(super) sums: Vec<[f64; 2]>,
    /// Mean circulation of each element over the steps of an interval (m²/s); empty where the forces come
    /// without bound vortices.
    pub(super) circulations: Vec<f64>,
    /// Forces on the tower's points (N).
    pub(super) tower: Vec<Vector3>,
    pub(super) forces: Vec<PointForce>,
}

impl Workspace {
    /// Memory for `n_points` blade elements along `axes` and for `n_bodies`, the nacelle the last of them.
    pub(super) fn new(n_points: usize, n_bodies: usize, axes: BladeFrame) -> Self {
        let still =
            ElementMotion { position: Vector3::ZERO, velocity: Vector3::ZERO, axes, pitch: 0.0 };
        Self {
            stations: vec![Vector3::ZERO; n_points + n_bodies],
            axes: vec![still.axes; n_points],
            motions: vec![still; n_points],
            loads: vec![ElementLoad::default(); n_points],
            sums: vec![[0.0; 2]; n_points],
            circulations: vec![0.0; n_points],
            tower: vec![Vector3::ZERO; n_bodies - 1],
            forces: Vec::with_capacity(n_points + n_bodies),
        }
    }

    /// On return it holds the drag of the tower in `winds` (m/s) of `air_density` (kg/m³), and the forces of
    /// all `bodies` on the air, smeared over `smearing_length` (m), are its only ones; gives the drag of the
    /// nacelle (N), the last of them, in whose wind its own wake makes for `own_wake` (m/s).
    pub(super) fn drag_of_bodies(
        &mut self,
        bodies: &[Body],
        winds: &[Vector3],
        own_wake: Vector3,
        air_density: f64,
        smearing_length: f64,
    ) -> Vector3 {
        let Self { forces, tower, .. } = self;
        forces.clear();
        let mut nacelle = Vector3::ZERO;
        for (index, (body, wind)) in bodies.iter().zip(winds).enumerate() {
            let is_nacelle = index + 1 == bodies.len();
            let free = if is_nacelle { *wind - own_wake } else { *wind };
            let force = body.force(free, air_density, smearing_length);
            match tower.get_mut(index) {
                Some(point) => *point = -force.force,
                None => nacelle = -force.force,
            }
            forces.push(force);
        }
        nacelle
    }

    /// Adds `share` (–) of the loads of a step, in which the rotor stands as `frame` has it, to the sums over
    /// the interval and to `readings`.
    pub(super) fn add_loads(&mut self, share: f64, frame: &Frame, readings: &mut Readings) {
        let Self { loads, motions, sums, .. } = self;
        for ((load, motion), sum) in loads.iter().zip(&*motions).zip(sums) {
            sum[0] += share * load.force.dot(motion.axes.normal);
            sum[1] += share * load.force.dot(motion.axes.tangent);
            let arm = motion.position - frame.hub;
            readings.thrust += share * load.force.dot(frame.shaft);
            readings.aerodynamic_torque += share * arm.cross(load.force).dot(frame.shaft);
        }
    }

    /// On return it holds the forces on the air of blades of `elements` too, where the winds were sampled:
    /// half the force of a step acts before the instant and half after it, so that a blade's bound vortex
    /// does not induce a velocity on itself.
    pub(super) fn push(&mut self, elements: &[Element], smearing_length: f64) {
        let Self { forces, stations, axes, sums, circulations, .. } = self;
        let n_bodies = forces.len();
        for (index, ((axes, sum), position)) in axes.iter().zip(&*sums).zip(&*stations).enumerate()
        {
            let force = axes.normal * sum[0] + axes.tangent * sum[1];
            let bound = circulations.get(index).map(|&circulation| {
                let (blade, station) = (index / elements.len(), index % elements.len());
                let Element { width, inner_share, .. } = elements[station];
                let along = axes.span * width;
                BoundVortex {
                    blade,
                    station,
                    circulation,
                    along,
                    inner_share,
                    position_after: *position,
                    along_after: along,
                }
            });
            let position = *position;
            forces.push(PointForce {
                bound,
                ..PointForce::of_body(position, -force, smearing_length)
            });
        }
        forces.rotate_left(n_bodies);
    }

    /// On return the bound vortices among the forces of blades of `elements` know where they stand now.
    pub(super) fn tell_places(&mut self, elements: &[Element]) {
        let Self { forces, stations, axes, .. } = self;
        let places = stations.iter().zip(&*axes).zip(elements.iter().cycle());
        for (force, ((position, axes), element)) in forces.iter_mut().zip(places) {
            if let Some(bound) = &mut force.bound {
                bound.position_after = *position;
                bound.along_after = axes.span * element.width;
            }
        }
    }
}
