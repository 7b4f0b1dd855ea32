//! A flexible beam, blade or tower: its mass points, stiffness and damping, and their resultants in motion.

use super::quadrature::mass_points;
use super::shapes::{Place, PrincipalMode, Section, Shapes, modal_mass, stiffness, weighted};
use basis::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Parameters of a beam with N modes, in the frame of its clamped end: z along the beam, x and y across.
#[derive(Clone, Debug)]
pub(super) struct Beam<const N: usize> {
    /// Mass points from the clamped end on, two for each part between gauges.
    pub(super) points: Vec<MassPoint<N>>,
    /// Borders between the parts, clamped end first, free end last.
    pub(super) borders: Vec<Place<N>>,
    /// Generalised stiffness (N/m).
    pub(super) stiffness: [[f64; N]; N],
    /// Generalised damping (N s/m).
    pub(super) damping: [[f64; N]; N],
}

/// Mass lumped at a place of a beam.
#[derive(Clone, Copy, Debug)]
pub(super) struct MassPoint<const N: usize> {
    pub(super) mass: f64,
    pub(super) place: Place<N>,
}

/// A force and a moment about a stated point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrench {
    /// Force (N).
    pub force: Vector3,
    /// Moment (N m).
    pub moment: Vector3,
}

impl Wrench {
    /// Both turned by `rotation`.
    pub(super) fn turned(self, rotation: &Matrix3) -> Self {
        Self { force: *rotation * self.force, moment: *rotation * self.moment }
    }

    /// The same wrench about a point from which its own lies `arm` (m) away.
    pub(super) fn about(self, arm: Vector3) -> Self {
        Self { force: self.force, moment: self.moment + arm.cross(self.force) }
    }

    pub(super) fn add(&mut self, other: Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

/// Base motion: how the frame of a beam's clamped end moves, in components of that frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct BaseMotion {
    /// Acceleration of the origin less gravity (m/s²).
    pub(super) acceleration: Vector3,
    /// Angular velocity (rad/s).
    pub(super) spin: Vector3,
    /// Angular acceleration (rad/s²).
    pub(super) angular_acceleration: Vector3,
}

impl BaseMotion {
    /// [α]ₓ + [ω]ₓ [ω]ₓ, which times a position gives the acceleration (m/s²) of a point fixed in the frame.
    fn gradient(&self) -> Matrix3 {
        let (w, a) = (self.spin, self.angular_acceleration);
        let s = w.length_squared();
        Matrix3::from_cols(
            Vector3::new(w.x * w.x - s, w.x * w.y + a.z, w.x * w.z - a.y),
            Vector3::new(w.x * w.y - a.z, w.y * w.y - s, w.y * w.z + a.x),
            Vector3::new(w.x * w.z + a.y, w.y * w.z - a.x, w.z * w.z - s),
        )
    }
}

/// Mass matrix and bias forces of a beam about the origin of its frame, for six rigid and N modal motions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inertia<const N: usize> {
    /// ∫ dm (kg).
    pub(super) mass: f64,
    /// ∫ p dm (kg m).
    pub(super) first: Vector3,
    /// ∫ (p·p − p pᵀ) dm (kg m²).
    pub(super) second: Matrix3,
    /// ∫ ∂p/∂qᵢ dm (kg).
    pub(super) linear: [Vector3; N],
    /// ∫ p × ∂p/∂qᵢ dm (kg m).
    pub(super) angular: [Vector3; N],
    /// ∫ ∂p/∂qᵢ · ∂p/∂qⱼ dm (kg).
    pub(super) modal: [[f64; N]; N],
    /// Bias force and moment: inertial forces that do not depend on second derivatives of the coordinates,
    /// gravity included.
    pub(super) bias: Wrench,
    /// Bias force of each mode (N).
    pub(super) modal_bias: [f64; N],
}

impl<const N: usize> Inertia<N> {
    /// No mass.
    pub(super) const ZERO: Self = Self {
        mass: 0.0,
        first: Vector3::ZERO,
        second: Matrix3::ZERO,
        linear: [Vector3::ZERO; N],
        angular: [Vector3::ZERO; N],
        modal: [[0.0; N]; N],
        bias: Wrench { force: Vector3::ZERO, moment: Vector3::ZERO },
        modal_bias: [0.0; N],
    };
}

impl<const N: usize> Beam<N> {
    /// A beam of `length` (m) that begins `start` (m) along z from the origin, in `n_parts` equal parts of
    /// two mass points.
    ///
    /// Damping follows stiffness, C = √βᵢ Kᵢⱼ √βⱼ with βᵢ = 2 ζᵢ / ωᵢ and ωᵢ the frequency of the mode on the
    /// bare beam at rest, which is how the reports of the reference turbines define their damping ratios.
    pub(super) fn new(
        start: f64,
        length: f64,
        n_parts: usize,
        sections: &[Section],
        modes: &[PrincipalMode; N],
    ) -> (Self, Shapes<N>) {
        let shapes = Shapes::new(length, sections, modes);
        let borders: Vec<f64> = (0..=n_parts).map(|k| length * k as f64 / n_parts as f64).collect();
        let density: Vec<(f64, f64)> = sections.iter().map(|s| (s.position, s.mass)).collect();
        let points = mass_points(&density, &borders)
            .into_iter()
            .map(|(position, mass)| MassPoint { mass, place: shapes.place(position, start) })
            .collect();
        let stiffness = stiffness(length, sections, modes);
        let lag: [f64; N] = std::array::from_fn(|i| {
            let mode = &modes[i].mode;
            let frequency = (stiffness[i][i] / modal_mass(length, sections, mode)).sqrt();
            2.0 * mode.damping_ratio / frequency
        });
        let damping = std::array::from_fn(|i| {
            std::array::from_fn(|j| stiffness[i][j] * (lag[i] * lag[j]).sqrt())
        });
        let borders = borders.iter().map(|&border| shapes.place(border, start)).collect();
        (Self { points, borders, stiffness, damping }, shapes)
    }

    /// Inertia at the modal coordinates `q` and rates `v` on a base that moves with `base_motion`.
    pub(super) fn inertia(
        &self,
        q: &[f64; N],
        v: &[f64; N],
        base_motion: &BaseMotion,
    ) -> Inertia<N> {
        let gradient = base_motion.gradient();
        let twice_spin = 2.0 * base_motion.spin;
        let mut sum = Inertia::ZERO;
        let mut products = Matrix3::ZERO;
        for point in &self.points {
            let (position, partials) = point.place.at(q);
            let rate = weighted(&partials, v);
            let mut acceleration =
                base_motion.acceleration + gradient * position + twice_spin.cross(rate);
            acceleration.z += point.place.own_acceleration(v);
            let force = acceleration * point.mass;
            let moment_of_mass = position * point.mass;
            sum.mass += point.mass;
            sum.first += moment_of_mass;
            products.x_axis += moment_of_mass * position.x;
            products.y_axis += moment_of_mass * position.y;
            products.z_axis += moment_of_mass * position.z;
            sum.bias.force += force;
            sum.bias.moment += position.cross(force);
            for i in 0..N {
                let weighted = partials[i] * point.mass;
                sum.linear[i] += weighted;
                sum.angular[i] += position.cross(weighted);
                sum.modal_bias[i] += partials[i].dot(force);
                for (j, partial) in partials.iter().enumerate().skip(i) {
                    sum.modal[i][j] += weighted.dot(*partial);
                }
            }
        }
        for i in 0..N {
            for j in 0..i {
                sum.modal[i][j] = sum.modal[j][i];
            }
        }
        let trace = products.x_axis.x + products.y_axis.y + products.z_axis.z;
        sum.second = Matrix3::from_diagonal(Vector3::splat(trace)) - products;
        sum
    }

    /// Stiffness and damping forces of the modes (N), −K q − C v.
    pub(super) fn restoring(&self, q: &[f64; N], v: &[f64; N]) -> [f64; N] {
        std::array::from_fn(|i| {
            let terms = |j: usize| self.stiffness[i][j] * q[j] + self.damping[i][j] * v[j];
            -(0..N).map(terms).sum::<f64>()
        })
    }

    /// Elastic energy of the modes (J).
    pub(super) fn elastic_energy(&self, q: &[f64; N]) -> f64 {
        let none = [0.0; N];
        let forces = self.restoring(q, &none);
        -0.5 * forces.iter().zip(q).map(|(force, q)| force * q).sum::<f64>()
    }

    /// Calls `take(index, position, force)` for each mass point, free end first, with gravity less inertia as
    /// force (N).
    ///
    /// `base_motion` and `accelerations` are complete: they include the second derivatives of the
    /// coordinates.
    pub(super) fn inertial_forces(
        &self,
        q: &[f64; N],
        v: &[f64; N],
        accelerations: &[f64; N],
        base_motion: &BaseMotion,
        mut take: impl FnMut(usize, Vector3, Vector3),
    ) {
        let gradient = base_motion.gradient();
        for (index, point) in self.points.iter().enumerate().rev() {
            let (position, partials) = point.place.at(q);
            let mut acceleration = base_motion.acceleration
                + gradient * position
                + 2.0 * base_motion.spin.cross(weighted(&partials, v))
                + weighted(&partials, accelerations);
            acceleration.z += point.place.own_acceleration(v);
            take(index, position, acceleration * -point.mass);
        }
    }
}
