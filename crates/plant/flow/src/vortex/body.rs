//! The wakes of bluff bodies such as nacelles: rings that leave their edges.

use super::ending::left_at;
use super::segment::{Cores, Segment};
use super::strain::{Life, around};
use basis::{PointForce, Vector3};
use std::f64::consts::{PI, TAU};

/// Sides of a ring (–).
pub(super) const N_SIDES: usize = 12;
/// Distance at which one ring follows another at least, over their radius (–).
const SPACING: f64 = 0.5;

/// How far the wakes of bodies are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWakes {
    /// Length of a body's wake along x (m), its end fading; with 0 bodies leave none.
    pub length: f64,
    /// Bodies that leave one, for which memory is made (–).
    pub n_bodies: usize,
    /// Most rings of one; the oldest ones end beyond (–).
    pub most_rings: usize,
}

impl BodyWakes {
    /// Bodies leave nothing.
    pub const NONE: Self = Self { length: 0.0, n_bodies: 0, most_rings: 0 };

    /// Most segments that they can have (–).
    pub(super) fn most_segments(&self) -> usize {
        self.n_bodies * self.most_rings * N_SIDES
    }
}

/// A bluff body, a disc to the air, and the rings in its wake, oldest first.
///
/// Its drag D acts across a disc of area A, so that there is a step of pressure D/A, and vorticity leaves the
/// disc's edge as behind an actuator disc: dΓ/dt = D/(ρ A). What left it in a few steps is one ring. The
/// impulse ρ Γ A of what is left per time is the drag. Source: von Kármán and Burgers (1935), Aerodynamic
/// Theory, division E, ch. III: discs of constant load.
///
/// Limits: no air is pushed aside by the body's volume, and its wake does not grow by eddies of its own. Far
/// behind a disc the deficit is some 1 % less than momentum theory has it at a drag coefficient of 0.5: rings
/// are few, and polygons.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body {
    pub(super) turbine: usize,
    pub(super) radius: f64,
    /// Its centre (m).
    pub(super) position: Vector3,
    /// Unit vector of its force on the air.
    pub(super) way: Vector3,
    /// Nodes, ring after ring (m), right-handed about the way of the impulse.
    pub(super) positions: Vec<Vector3>,
    /// Velocities with which they last moved (m/s).
    pub(super) velocities: Vec<Vector3>,
    /// Time since each ring left (s).
    pub(super) ages: Vec<f64>,
    /// Its circulation (m²/s).
    pub(super) circulations: Vec<f64>,
    /// Its length since then.
    pub(super) lives: Vec<Life>,
    wakes: BodyWakes,
}

impl Body {
    /// A disc of `radius` (m) on `turbine`, with no wake yet.
    pub(super) fn new(turbine: usize, radius: f64, wakes: BodyWakes) -> Self {
        let n = wakes.most_rings + 1;
        Self {
            turbine,
            radius,
            position: Vector3::ZERO,
            way: Vector3::ZERO,
            positions: Vec::with_capacity(n * N_SIDES),
            velocities: Vec::with_capacity(n * N_SIDES),
            ages: Vec::with_capacity(n),
            circulations: Vec::with_capacity(n),
            lives: Vec::with_capacity(n),
            wakes,
        }
    }

    /// Those among `forces` whose wakes are followed.
    pub(super) fn all_of(forces: &[PointForce], wakes: BodyWakes) -> Vec<Self> {
        if wakes.length == 0.0 {
            return Vec::new();
        }
        let of = |force: &PointForce| Some(Self::new(force.turbine, force.disc_radius?, wakes));
        forces.iter().filter_map(of).collect()
    }

    /// Rings (–).
    pub(super) fn n_rings(&self) -> usize {
        self.ages.len()
    }

    fn ring(&self, index: usize) -> &[Vector3] {
        &self.positions[index * N_SIDES..(index + 1) * N_SIDES]
    }

    /// What its `force` on the air over an `interval` (s) leaves in air of `density` (kg/m³) goes into its
    /// youngest ring; says whether that is its first one.
    pub(super) fn shed(&mut self, force: &PointForce, interval: f64, density: f64) -> bool {
        self.position = force.position;
        let impulse = force.force * (interval / density);
        if impulse == Vector3::ZERO {
            return false;
        }
        self.way = impulse.normalize();
        let is_first = self.n_rings() == 0;
        if is_first {
            self.begin_ring();
        }
        let youngest = self.n_rings() - 1;
        let normal = area(self.ring(youngest)).normalize_or_zero();
        self.circulations[youngest] += impulse.dot(normal) / (PI * self.radius * self.radius);
        is_first
    }

    /// A new ring about the body, which has no circulation yet.
    fn begin_ring(&mut self) {
        if self.n_rings() >= self.wakes.most_rings {
            self.drop_oldest(1);
        }
        let normal = self.way;
        let across = normal.any_orthonormal_vector();
        let up = normal.cross(across);
        // The polygon has the area of the disc.
        let angle = TAU / N_SIDES as f64;
        let radius = self.radius * (angle / angle.sin()).sqrt();
        for side in 0..N_SIDES {
            let (sine, cosine) = (angle * side as f64).sin_cos();
            self.positions.push(self.position + radius * (across * cosine + up * sine));
            self.velocities.push(Vector3::ZERO);
        }
        self.ages.push(0.0);
        self.circulations.push(0.0);
        self.lives.push(Life::new(around(self.ring(self.ages.len() - 1)), 0.0));
    }

    /// On return its wake is as long as it becomes, where it has begun one: rings one behind the other that
    /// are carried along x by `way` (m) in each `interval` (s), with what has left it on the mean.
    pub(super) fn reach_full_length(&mut self, way: f64, interval: f64) {
        let Some(age) = self.ages.first().filter(|age| **age > 0.0) else { return };
        let shed = self.circulations.iter().sum::<f64>() * interval / age;
        self.drop_oldest(self.n_rings());
        self.begin_ring();
        let first = self.ring(0).to_vec();
        self.drop_oldest(1);
        // A ring leaves once the one before is far enough away, at the end of a step.
        let n_steps = (SPACING * self.radius / way).ceil().max(1.0);
        let n_rings = (self.wakes.length / (n_steps * way)).floor() as usize + 1;
        for ring in (0..n_rings.min(self.wakes.most_rings)).rev() {
            let age = ring as f64 * n_steps;
            self.positions.extend(first.iter().map(|node| *node + Vector3::X * (age * way)));
            self.velocities.extend([Vector3::X * (way / interval); N_SIDES]);
            self.ages.push(age * interval);
            self.circulations.push(n_steps * shed);
            self.lives.push(Life::new(around(&first), 0.0));
        }
    }

    fn drop_oldest(&mut self, n: usize) {
        self.positions.drain(..n * N_SIDES);
        self.velocities.drain(..n * N_SIDES);
        self.ages.drain(..n);
        self.circulations.drain(..n);
        self.lives.drain(..n);
    }

    /// What is left of the circulation of ring number `index` (–).
    fn share(&self, index: usize) -> f64 {
        let way = (centre(self.ring(index)) - self.position).x;
        left_at(way / self.wakes.length)
    }

    /// Moves every node on by `interval` (s): `velocities` (m/s) hold that of each now. Second order after
    /// Adams and Bashforth; a ring's first step is Euler's. Rings beyond the wake's length end, and a new one
    /// begins where there is room for it.
    pub(super) fn advance(&mut self, interval: f64, velocities: &[Vector3]) {
        self.live(0.5 * interval);
        for (ring, age) in self.ages.iter_mut().enumerate() {
            let nodes = ring * N_SIDES..(ring + 1) * N_SIDES;
            let [now, before] = if *age == 0.0 { [1.0, 0.0] } else { [1.5, -0.5] };
            let moved =
                self.positions[nodes.clone()].iter_mut().zip(&mut self.velocities[nodes.clone()]);
            for ((position, last), velocity) in moved.zip(&velocities[nodes]) {
                *position += interval * (now * *velocity + before * *last);
                *last = *velocity;
            }
            *age += interval;
        }
        self.live(0.5 * interval);
        let ended = (0..self.n_rings()).take_while(|&ring| self.share(ring) == 0.0).count();
        self.drop_oldest(ended);
        let youngest = self.n_rings().checked_sub(1);
        let way = |ring: usize| (centre(self.ring(ring)) - self.position).length();
        if youngest.is_some_and(|ring| way(ring) >= SPACING * self.radius) {
            self.begin_ring();
        }
    }

    /// Adds the middles of the sides of all rings, as many as there are nodes.
    pub(super) fn push_middles(&self, middles: &mut Vec<Vector3>) {
        self.positions.chunks_exact(N_SIDES).for_each(|nodes| middles.extend(middles_of(nodes)));
    }

    fn live(&mut self, duration: f64) {
        for (life, nodes) in self.lives.iter_mut().zip(self.positions.chunks_exact(N_SIDES)) {
            life.live(around(nodes), duration);
        }
    }

    /// Adds the segments of all rings to `segments`.
    pub(super) fn push_segments(&self, cores: &Cores, segments: &mut Vec<Segment>) {
        self.for_segments(cores, &mut |segment| segments.push(segment));
    }

    /// What its wake induces at the body itself (m/s).
    pub(super) fn own_velocity(&self, cores: &Cores) -> Vector3 {
        let mut sum = Vector3::ZERO;
        self.for_segments(cores, &mut |segment| sum += segment.velocity(self.position));
        sum
    }

    fn for_segments(&self, cores: &Cores, take: &mut dyn FnMut(Segment)) {
        let born = (cores.initial_widths * SPACING * self.radius).powi(2);
        for index in 0..self.n_rings() {
            let circulation = self.share(index) * self.circulations[index];
            let nodes = self.ring(index);
            let (age, life) = (self.ages[index], &self.lives[index]);
            let core_squared = cores.of(born, age, around(nodes), circulation, life);
            for (side, from) in nodes.iter().enumerate() {
                let (from, to) = (*from, nodes[(side + 1) % N_SIDES]);
                take(Segment { from, to, circulation, core_squared });
            }
        }
    }
}

/// Middles of the sides of a closed line.
pub(super) fn middles_of(nodes: &[Vector3]) -> impl Iterator<Item = Vector3> + '_ {
    (0..nodes.len()).map(|k| 0.5 * (nodes[k] + nodes[(k + 1) % nodes.len()]))
}

/// On return `velocities`, which held those in the middles of the sides of rings with `n` sides, hold those
/// of their nodes: the mean of both sides', for the reason that
/// [`Strip::to_nodes`](super::strip::Strip::to_nodes) gives.
pub(super) fn sides_to_nodes(n: usize, velocities: &mut [Vector3]) {
    for ring in velocities.chunks_exact_mut(n) {
        let mut before = ring[n - 1];
        for velocity in ring {
            (before, *velocity) = (*velocity, 0.5 * (before + *velocity));
        }
    }
}

fn centre(nodes: &[Vector3]) -> Vector3 {
    nodes.iter().copied().sum::<Vector3>() / nodes.len() as f64
}

/// Area of a closed line (m²), along its normal: ½ ∮ x × dl.
fn area(nodes: &[Vector3]) -> Vector3 {
    let (middle, n) = (centre(nodes), nodes.len());
    let of = |side: usize| (nodes[side] - middle).cross(nodes[(side + 1) % n] - middle);
    0.5 * (0..n).map(of).sum::<Vector3>()
}
