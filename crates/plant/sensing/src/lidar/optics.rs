//! Where a lidar stands, where its beams point, and what they pass.

use super::pattern::Pattern;
use super::probe::Probe;
use crate::axes::level_axes;
use crate::sensor::Mount;
use basis::angle::wrap_to_half_turn;
use basis::keys::Values;
use basis::{Matrix3, Vector3, mbc};
use turbine::{Definition, Frame, Turbine};

/// Time over which the motion of the nacelle is differenced (s).
const MOTION_STEP: f64 = 1e-3;

/// What a lidar rides on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Carrier {
    /// The nacelle, levelled: it turns, sways and nods with it.
    Nacelle,
    /// The hub: its beams turn with the rotor about the shaft.
    Hub,
}

/// Everything of a lidar that does not change.
#[derive(Clone, Debug)]
pub(super) struct Optics {
    /// What it rides on.
    pub(super) carrier: Carrier,
    /// Whether it looks into the wind.
    pub(super) looks_upwind: bool,
    /// Foot of the tower, farm frame (m).
    pub(super) foot: Vector3,
    /// Where it stands from the rotor's centre: downwind, left, up, axes of its carrier (m).
    pub(super) arm: Vector3,
    /// Directions of the beams, axes of its carrier.
    pub(super) beams: Vec<Vector3>,
    /// Distances that each beam measures at (m), those of beam number `b` at `gates * b`.
    pub(super) distances: Vec<f64>,
    /// Distances of each beam (–).
    pub(super) n_gates: usize,
    /// Places along a beam from each distance (m) and their weights (–).
    pub(super) nodes: Vec<(f64, f64)>,
}

/// Where a lidar is at one instant, and how it moves; farm frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    /// Its place (m).
    pub(super) place: Vector3,
    /// Its velocity (m/s).
    pub(super) velocity: Vector3,
    /// Axes of its carrier: downwind, left, up.
    pub(super) axes: Matrix3,
    /// The rotor, bending of the tower included.
    pub(super) rotor: Frame,
    /// Azimuth of blade 1 (rad).
    pub(super) azimuth: f64,
}

impl Optics {
    /// The lidar that `values` ask for, on the machine of `mount`.
    pub(super) fn of(values: &Values, mount: &Mount) -> Self {
        let diameter = mount.definition.rotor_diameter();
        let gates: Vec<f64> = values.numbers("ranges_diameters").to_vec();
        let focus = values.optional_number("focal_distance_diameters").unwrap_or(1.0);
        // A pattern has its size where the beams are focused, or at the furthest range.
        let aim = diameter * gates.iter().copied().reduce(f64::max).unwrap_or(focus);
        let looks_upwind = values.word("looks") == "upwind";
        let (sine, cosine) = values.angle("tilt_deg").sin_cos();
        let along = if looks_upwind { -1.0 } else { 1.0 };
        let forward = Vector3::new(along * cosine, 0.0, sine);
        let up = Vector3::new(-along * sine, 0.0, cosine);
        let radius = diameter * values.number("radius_diameters");
        let points = pattern_of(values).points(values.number("n_points") as usize);
        let reach =
            |[left, height]: [f64; 2]| forward * aim + (Vector3::Y * left + up * height) * radius;
        let rays: Vec<Vector3> = points.into_iter().map(reach).collect();
        let distances = if gates.is_empty() {
            rays.iter().map(|ray| ray.length()).collect()
        } else {
            rays.iter().flat_map(|_| gates.iter().map(|gate| diameter * gate)).collect()
        };
        Self {
            carrier: carrier_of(values),
            looks_upwind,
            foot: mount.foot,
            arm: Vector3::new(values.number("downwind"), 0.0, values.number("above")),
            beams: rays.into_iter().map(Vector3::normalize).collect(),
            distances,
            n_gates: gates.len().max(1),
            nodes: probe_of(values).nodes(),
        }
    }

    /// Points of a scan (–).
    pub(super) fn n_points(&self) -> usize {
        self.distances.len()
    }

    /// Where it is on `turbine`, which bends and turns as it does now.
    pub(super) fn pose(&self, turbine: &Turbine) -> Pose {
        let structure = turbine.structure();
        let (unbent, azimuth) = (turbine.frame(), structure.azimuth());
        let at = |ahead: f64| self.pose_of(unbent, &structure.frame(ahead), azimuth);
        let mut now = at(0.0);
        let swing = at(MOTION_STEP).place - at(-MOTION_STEP).place;
        let turn = Vector3::Z * structure.state().yaw.rate;
        now.velocity = swing / (2.0 * MOTION_STEP) + turn.cross(now.place - self.foot);
        now
    }

    /// Where it is on a machine at rest whose rotor has come to `azimuth` (rad) and faces −x.
    pub(super) fn pose_at_rest(&self, definition: &Definition, azimuth: f64) -> Pose {
        let geometry = &definition.rotor;
        let apex =
            Vector3::new(-geometry.overhang * geometry.shaft_tilt.cos(), 0.0, geometry.hub_height);
        let rotor = Frame::new(self.foot + apex, geometry.shaft_tilt);
        self.pose_of(&rotor, &rotor, azimuth)
    }

    /// Where it is, at rest, on a machine whose rotor would stand as `unbent` and stands as `rotor`.
    fn pose_of(&self, unbent: &Frame, rotor: &Frame, azimuth: f64) -> Pose {
        let axes = match self.carrier {
            Carrier::Nacelle => axes_of(rotor) * axes_of(unbent).transpose() * level_axes(unbent),
            Carrier::Hub => axes_of(rotor) * Matrix3::from_rotation_x(azimuth),
        };
        let place = rotor.hub + axes * self.arm;
        Pose { place, velocity: Vector3::ZERO, axes, rotor: *rotor, azimuth }
    }

    /// Whether its beams pass the rotor's plane: those of a nacelle that look upwind.
    pub(super) fn passes_rotor(&self) -> bool {
        self.looks_upwind && self.carrier == Carrier::Nacelle
    }
}

impl Pose {
    /// Where a beam along `direction` (farm frame) passes the plane of the rotor: distance from its centre
    /// (m) and azimuth (rad).
    pub(super) fn crossing(&self, direction: Vector3) -> (f64, f64) {
        let Frame { hub, shaft, up, right } = self.rotor;
        let along = (hub - self.place).dot(shaft) / direction.dot(shaft);
        let from_hub = self.place + direction * along - hub;
        let (up, right) = (from_hub.dot(up), from_hub.dot(right));
        (up.hypot(right), right.atan2(up))
    }

    /// Whether hub or a blade of `definition` stands in the way of a beam along `direction` (farm frame):
    /// blades are as wide as their chord.
    pub(super) fn is_blocked(&self, definition: &Definition, direction: Vector3) -> bool {
        let (radius, azimuth) = self.crossing(direction);
        let hub_radius = definition.rotor.hub_radius;
        if radius < hub_radius {
            return true;
        }
        let half_chord = 0.5 * chord(definition, radius - hub_radius);
        (0..definition.n_blades).any(|blade| {
            let blade = mbc::blade_azimuth(self.azimuth, blade, definition.n_blades);
            radius * wrap_to_half_turn(azimuth - blade).abs() < half_chord
        })
    }
}

/// Axes of the shaft: downwind, left, up.
fn axes_of(rotor: &Frame) -> Matrix3 {
    Matrix3::from_cols(rotor.shaft, -rotor.right, rotor.up)
}

/// Chord (m) of a blade of `definition` at `span` (m) from its root; none beyond its tip.
fn chord(definition: &Definition, span: f64) -> f64 {
    let between = definition.blade.windows(2).find(|pair| span <= pair[1].span);
    between.map_or(0.0, |pair| {
        let share = (span - pair[0].span) / (pair[1].span - pair[0].span);
        pair[0].chord + share * (pair[1].chord - pair[0].chord)
    })
}

/// The pattern that `values` ask for.
pub(super) fn pattern_of(values: &Values) -> Pattern {
    let number = |key, otherwise| values.optional_number(key).unwrap_or(otherwise) as usize;
    match values.word("scan") {
        "rings" => Pattern::Rings { n_rings: number("rings", 3.0) },
        "rosette" => Pattern::Rosette { n_petals: number("petals", 5.0) },
        "beams" => Pattern::Beams,
        _ => Pattern::Plane,
    }
}

fn carrier_of(values: &Values) -> Carrier {
    if values.word("mount") == "hub" { Carrier::Hub } else { Carrier::Nacelle }
}

fn probe_of(values: &Values) -> Probe {
    match (values.word("probe"), values.number("probe_length")) {
        ("lorentzian", length) => Probe::Lorentzian(length),
        ("gaussian", length) => Probe::Gaussian(length),
        _ => Probe::None,
    }
}
