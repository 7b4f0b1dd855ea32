//! Aerodynamic stations: blade elements and points of the tower, their motion and the loads on them.

use super::beam::Wrench;
use super::coordinates::{Coordinates, N_MODES, N_TOWER};
use super::frame::MovingFrame;
use super::machine::{Machine, ModeTables, Motion, N_BLADE_PARTS};
use super::projection::Projection;
use super::shapes::{Place, weighted};
use crate::definition::{BladeStation, Definition};
use crate::motion::ElementMotion;
use crate::rotor::BladeFrame;
use basis::Vector3;
use basis::blades::MAXIMUM_BLADES;

/// Aerodynamic load on one blade element, farm frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementLoad {
    /// Force on the blade (N).
    pub force: Vector3,
    /// Moment on the blade about the element's middle (N m).
    pub moment: Vector3,
}

/// External loads on the structure, constant over a step.
#[derive(Clone, Copy, Debug)]
pub struct AppliedLoads<'a> {
    /// On the blade elements, blade after blade; empty for none.
    pub elements: &'a [ElementLoad],
    /// Forces on the tower's points, farm frame (N); empty for none.
    pub tower: &'a [Vector3],
    /// Force on the nacelle at the rotor apex, farm frame (N).
    pub nacelle: Vector3,
    /// Torque of the generator on the low-speed side, holding the rotor back (N m).
    pub generator_torque: f64,
}

impl AppliedLoads<'_> {
    /// No load at all.
    pub const NONE: AppliedLoads<'static> =
        AppliedLoads { elements: &[], tower: &[], nacelle: Vector3::ZERO, generator_torque: 0.0 };
}

/// Aerodynamic stations of one blade and of the tower.
#[derive(Clone, Debug)]
pub(super) struct Stations {
    blade: Vec<Station>,
    tower: Vec<Place<N_TOWER>>,
    pub(super) projection: Projection,
}

#[derive(Clone, Copy, Debug)]
struct Station {
    place: Place<N_MODES>,
    /// Along the undeformed line of aerodynamic centres, in the pitched blade.
    along: Vector3,
    /// Direction that an untwisted section faces there, across that line.
    across: Vector3,
    /// Part of the blade that contains it.
    part: usize,
}

impl Station {
    /// Its place (m) and the direction of the blade's line there, farm frame, of a blade that stands as
    /// `frame` has it, where the station lies at `position` (m) in it and its section is turned by `turn`
    /// (rad).
    #[inline(always)]
    fn on_line(&self, frame: &MovingFrame, position: Vector3, turn: Vector3) -> (Vector3, Vector3) {
        let along = self.along + turn.cross(self.along);
        (frame.origin + frame.axes * position, (frame.axes * along).normalize())
    }
}

/// Resultants of applied loads: on each part of each blade about the rotor apex in the blade's axes, on the
/// tower about its foot.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LoadResultants {
    pub(super) parts: [[Wrench; N_BLADE_PARTS]; MAXIMUM_BLADES],
    pub(super) modes: [[f64; N_MODES]; MAXIMUM_BLADES],
    pub(super) tower: Wrench,
    pub(super) tower_modes: [f64; N_TOWER],
    pub(super) nacelle: Vector3,
    pub(super) generator_torque: f64,
}

impl LoadResultants {
    /// Resultant on `blade`, about the rotor apex in the blade's axes.
    pub(super) fn blade(&self, blade: usize) -> Wrench {
        let mut sum = Wrench::default();
        self.parts[blade].iter().for_each(|part| sum.add(*part));
        sum
    }
}

impl Stations {
    /// Elements at `spans` (m from the rotor apex along the pitch axis), points of the tower at `heights` (m
    /// above ground).
    ///
    /// Elements lie on the line of aerodynamic centres, off the pitch axis by prebend and sweep, and turn
    /// with their section.
    pub(super) fn new(
        definition: &Definition,
        tables: &ModeTables,
        spans: &[f64],
        heights: &[f64],
    ) -> Self {
        let hub_radius = definition.rotor.hub_radius;
        let station = |&span: &f64| {
            let (prebend, sweep, slope) = line_at(&definition.blade, span - hub_radius);
            let place = tables.blade.place(span - hub_radius, hub_radius);
            let share = (span - hub_radius) / definition.blade_length();
            Station {
                part: ((share * N_BLADE_PARTS as f64) as usize).min(N_BLADE_PARTS - 1),
                place: place.offset_by(Vector3::new(-prebend, sweep, 0.0)),
                along: Vector3::new(-slope, 0.0, 1.0),
                across: Vector3::new(1.0, 0.0, slope),
            }
        };
        let base = definition.tower.base_height;
        let point = |&height: &f64| tables.tower.place((height - base).max(0.0), 0.0);
        Self {
            blade: spans.iter().map(station).collect(),
            tower: heights.iter().map(point).collect(),
            projection: Projection::default(),
        }
    }

    /// Elements of each blade (–).
    pub(super) fn n_elements(&self) -> usize {
        self.blade.len()
    }

    /// Points of the tower (–).
    pub(super) fn n_tower(&self) -> usize {
        self.tower.len()
    }

    /// On return `elements` holds where each blade element is and how it moves, blade after blade.
    pub(super) fn observe(
        &self,
        machine: &Machine,
        motion: &Motion,
        q: &Coordinates,
        v: &Coordinates,
        elements: &mut [ElementMotion],
    ) {
        let hub = &motion.hub;
        for (blade, elements) in elements.chunks_exact_mut(self.blade.len()).enumerate() {
            let frame = &motion.blades[blade];
            let cone = machine.cone_axes(blade, motion);
            let (q, v) = (&q.blades[blade], &v.blades[blade]);
            let spin = frame.axes.transpose() * frame.spin;
            for (element, station) in elements.iter_mut().zip(&self.blade) {
                let (position, partials) = station.place.at(q);
                let velocity = spin.cross(position) + weighted(&partials, v);
                let turn = station.place.turn(q);
                let (position, span) = station.on_line(frame, position, turn);
                // To second order: where a blade bends in both directions, its sections also turn about it,
                // by half the product of the slopes. That goes with gravity once a turn and so leaves a
                // steady moment on the hub.
                let first = turn.cross(station.across);
                let facing = frame.axes * (station.across + first + 0.5 * turn.cross(first));
                let swept = hub.axes.x_axis.cross(position - hub.origin);
                let axes = self.projection.axes(span, swept, &cone);
                let pitch = self.projection.turn(&axes, span, facing, &cone);
                let velocity = frame.velocity + frame.axes * velocity;
                *element = ElementMotion { position, velocity, axes, pitch };
            }
        }
    }

    /// On return `positions` (m) and `axes` are those of the blade elements, blade after blade, farm frame:
    /// what [`observe`](Self::observe) finds of them, without how they move and face.
    pub(super) fn place(
        &self,
        machine: &Machine,
        motion: &Motion,
        q: &Coordinates,
        positions: &mut [Vector3],
        axes: &mut [BladeFrame],
    ) {
        let hub = &motion.hub;
        let n = self.blade.len();
        let blades = positions.chunks_exact_mut(n).zip(axes.chunks_exact_mut(n));
        for (blade, (positions, axes)) in blades.enumerate() {
            let frame = &motion.blades[blade];
            let cone = machine.cone_axes(blade, motion);
            let q = &q.blades[blade];
            for ((position, axes), station) in positions.iter_mut().zip(axes).zip(&self.blade) {
                let span;
                (*position, span) =
                    station.on_line(frame, station.place.at(q).0, station.place.turn(q));
                let swept = hub.axes.x_axis.cross(*position - hub.origin);
                *axes = self.projection.axes(span, swept, &cone);
            }
        }
    }

    /// On return `points` holds position (m) and velocity (m/s) of each point of the tower, farm frame.
    pub(super) fn observe_tower(
        &self,
        machine: &Machine,
        q: &Coordinates,
        v: &Coordinates,
        points: &mut [(Vector3, Vector3)],
    ) {
        for (point, place) in points.iter_mut().zip(&self.tower) {
            let (position, partials) = place.at(&q.tower());
            *point = (machine.base + position, weighted(&partials, &v.tower()));
        }
    }

    /// Resultants of `loads` at the coordinates `q`.
    pub(super) fn resultants(
        &self,
        motion: &Motion,
        q: &Coordinates,
        loads: &AppliedLoads<'_>,
    ) -> LoadResultants {
        let mut resultants = LoadResultants {
            nacelle: loads.nacelle,
            generator_torque: loads.generator_torque,
            ..LoadResultants::default()
        };
        if !self.blade.is_empty() {
            for (blade, loads) in loads.elements.chunks_exact(self.blade.len()).enumerate() {
                let own_from_farm = motion.blades[blade].axes.transpose();
                let modes = &mut resultants.modes[blade];
                for (load, station) in loads.iter().zip(&self.blade) {
                    let (position, partials) = station.place.at(&q.blades[blade]);
                    let (force, moment) = (own_from_farm * load.force, own_from_farm * load.moment);
                    let part = &mut resultants.parts[blade][station.part];
                    part.force += force;
                    part.moment += position.cross(force) + moment;
                    for mode in 0..N_MODES {
                        modes[mode] +=
                            partials[mode].dot(force) + station.place.turn[mode].dot(moment);
                    }
                }
            }
        }
        for (force, place) in loads.tower.iter().zip(&self.tower) {
            let (position, partials) = place.at(&q.tower());
            resultants.tower.force += *force;
            resultants.tower.moment += position.cross(*force);
            for (mode, partial) in resultants.tower_modes.iter_mut().zip(&partials) {
                *mode += partial.dot(*force);
            }
        }
        resultants
    }
}

/// Prebend (m), sweep (m) and slope of the prebend (–) at `span` (m) from the root, linear between
/// `stations`.
fn line_at(stations: &[BladeStation], span: f64) -> (f64, f64, f64) {
    let next =
        stations.partition_point(|station| station.span <= span).clamp(1, stations.len() - 1);
    let (low, high) = (&stations[next - 1], &stations[next]);
    let length = high.span - low.span;
    let share = (span - low.span) / length;
    (
        low.prebend + share * (high.prebend - low.prebend),
        low.sweep + share * (high.sweep - low.sweep),
        (high.prebend - low.prebend) / length,
    )
}
