//! The velocity that many segments induce: near ones one by one in single precision, far ones box by box.
//!
//! Barycentric Lagrange treecode: Wang, Krasny, Tlupova (2020); boxes with segments of cores, and shares that
//! are raised from box to box, are this house's.

use super::division::Cluster;
use super::interpolation::{HIGHEST_DEGREE, LOWEST_DEGREE};
use super::segment::{BEYOND, Segment};
use super::tree::{Tree, UNIT};
use crate::pool::Pool;
use crate::simd::{Backend, MAXIMUM_LANES, Portable, Simd};
use basis::Vector3;

/// Distance from a box beyond which its cores are not felt, in the widest of them (–): 1 − h²/√(r⁴ + h⁴) is
/// 4e-4 at six cores beside a segment, and 7e-4 beyond its end.
const CORES_AWAY: f64 = 6.0;
/// Cost of a point of a box over that of a segment (–).
const COST_OF_POINT: f64 = 0.5;

/// How exact the velocities are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Degree of the polynomials through which far boxes are seen (–), [`LOWEST_DEGREE`] to
    /// [`HIGHEST_DEGREE`].
    pub degree: usize,
    /// A box is far where its radius is less than this share of its distance (–); 0 and none is.
    pub opening: f64,
}

impl Accuracy {
    /// That of cases which say nothing of it: an error of some 1e-4 of the velocity.
    pub const USUAL: Self = Self { degree: 3, opening: 0.6 };
}

/// Positions that a thread takes at once (–).
pub(super) const CHUNK: usize = 32;

/// On return `velocities` (m/s) holds what `segments` induce at each of `positions` (m, farm frame), of the
/// same length, boxes taken as `accuracy` has it, on `n_threads` threads, whose number changes no bit. For
/// many calls a [`FreeWake`] keeps boxes and threads.
///
/// [`FreeWake`]: super::FreeWake
pub fn induced(
    segments: &[Segment],
    accuracy: Accuracy,
    n_threads: usize,
    positions: &[Vector3],
    velocities: &mut [Vector3],
) {
    let mut field = Field::with_capacity(accuracy, Backend::detect(), segments.len());
    let mut pool = Pool::new(n_threads);
    field.rebuild(segments, &mut pool);
    pool.for_chunks(velocities, CHUNK, &|first, chunk| {
        for (velocity, position) in chunk.iter_mut().zip(&positions[first..]) {
            *velocity = field.velocity(*position);
        }
    });
}

/// The velocity field of segments.
pub(super) struct Field {
    opening: f64,
    backend: Backend,
    tree: Tree,
    /// Where the points of a box are in it.
    cube: [Vec<f32>; 3],
    sum: unsafe fn(&Field, Vector3) -> Vector3,
}

impl Field {
    /// A field of no segments, with memory for `most`.
    pub(super) fn with_capacity(accuracy: Accuracy, backend: Backend, most: usize) -> Self {
        let degree = accuracy.degree.clamp(LOWEST_DEGREE, HIGHEST_DEGREE);
        let tree = Tree::with_capacity(degree, most);
        let mut cube: [Vec<f32>; 3] = std::array::from_fn(|_| vec![0.0; tree.n_padded()]);
        for point in 0..tree.points.n_in_cube() {
            for (cube, place) in cube.iter_mut().zip(tree.points.place(point)) {
                cube[point] = place as f32;
            }
        }
        Self { opening: accuracy.opening, backend, tree, cube, sum: sum_of(backend) }
    }

    /// Instructions that it runs on.
    pub(super) fn backend(&self) -> Backend {
        self.backend
    }

    /// Becomes the field of `segments`.
    pub(super) fn rebuild(&mut self, segments: &[Segment], pool: &mut Pool) {
        self.tree.rebuild(segments, pool);
    }

    /// As [`rebuild`](Self::rebuild) where only circulations and cores have changed since.
    pub(super) fn refresh(&mut self, segments: &[Segment], pool: &mut Pool) {
        self.tree.refresh(segments, pool);
    }

    /// Velocity (m/s) at `position` (m, farm frame).
    pub(super) fn velocity(&self, position: Vector3) -> Vector3 {
        // SAFETY: the back-end's instructions were found on this machine.
        unsafe { (self.sum)(self, position) }
    }
}

/// The loop for `backend`, whose instructions the caller has found on this machine.
fn sum_of(backend: Backend) -> unsafe fn(&Field, Vector3) -> Vector3 {
    match backend {
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => {
            #[target_feature(enable = "avx512f,fma")]
            unsafe fn sum(field: &Field, position: Vector3) -> Vector3 {
                // SAFETY: handed through.
                unsafe { visit::<crate::simd::Avx512>(field, position) }
            }
            sum
        }
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => {
            #[target_feature(enable = "avx2,fma")]
            unsafe fn sum(field: &Field, position: Vector3) -> Vector3 {
                // SAFETY: handed through.
                unsafe { visit::<crate::simd::Avx2>(field, position) }
            }
            sum
        }
        _ => visit::<Portable>,
    }
}

/// Sums over all boxes.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
unsafe fn visit<V: Simd>(field: &Field, position: Vector3) -> Vector3 {
    let Tree { clusters, points, .. } = &field.tree;
    let n_points = points.n_in_cube();
    let opening = field.opening * field.opening;
    let mut sum = [V::splat(0.0); 3];
    let mut index = 0;
    while let Some(cluster) = clusters.get(index) {
        let from = position - cluster.centre;
        let distance = from.length_squared();
        let gap = distance.sqrt() - cluster.radius;
        let is_far = cluster.radius * cluster.radius < opening * distance
            && gap > 0.0
            && gap * gap > CORES_AWAY * CORES_AWAY * cluster.core_squared;
        let is_leaf = cluster.n_lanes > 0;
        let costs_more = (f64::from(cluster.n_lanes)) < COST_OF_POINT * n_points as f64;
        if is_far && !(is_leaf && costs_more) {
            // SAFETY: handed through.
            unsafe { far::<V>(field, index, cluster, from, &mut sum) };
            index = cluster.next as usize;
        } else {
            if is_leaf {
                // SAFETY: handed through.
                unsafe { near::<V>(field, cluster, from, &mut sum) };
            }
            index += 1;
        }
    }
    Vector3::from_array(sum.map(|lanes| total(lanes)))
}

/// Sum over the lanes of a vector.
#[inline(always)]
fn total<V: Simd>(lanes: V) -> f64 {
    let mut values = [0.0_f32; MAXIMUM_LANES];
    // SAFETY: no vector is wider, and one exists.
    unsafe { lanes.store(values.as_mut_ptr()) };
    values[..V::LANES].iter().map(|value| f64::from(*value)).sum()
}

/// Adds what the box `cluster`, number `index`, amounts to at `from` its centre (m).
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
unsafe fn far<V: Simd>(
    field: &Field,
    index: usize,
    cluster: &Cluster,
    from: Vector3,
    sum: &mut [V; 3],
) {
    let padded = field.tree.n_padded();
    let at = from.to_array().map(|value| V::splat(value as f32));
    let half = cluster.half.to_array().map(|value| V::splat(value as f32));
    for lane in (0..padded).step_by(V::LANES) {
        // SAFETY: `cube` and each box's moments have `padded` values, a multiple of the lanes.
        let (cube, m) = unsafe {
            let cube: [V; 3] = std::array::from_fn(|a| V::load(field.cube[a].as_ptr().add(lane)));
            let base = index * padded + lane;
            let m: [V; 3] =
                std::array::from_fn(|a| V::load(field.tree.moments[a].as_ptr().add(base)));
            (cube, m)
        };
        let r: [V; 3] = std::array::from_fn(|a| cube[a].sub_from(half[a], at[a]));
        let squared = r[2].mul_add(r[2], r[1].mul_add(r[1], r[0] * r[0]));
        let inverse = squared.inverse_sqrt();
        let weight = inverse * inverse * inverse;
        let cross = cross(&m, &r);
        for (sum, cross) in sum.iter_mut().zip(cross) {
            *sum = cross.mul_add(weight, *sum);
        }
    }
}

/// Adds what the segments of `cluster` induce at `from` its centre (m), one by one:
/// [`Segment::per_circulation`], with one inverse and roots by their inverses.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
unsafe fn near<V: Simd>(field: &Field, cluster: &Cluster, from: Vector3, sum: &mut [V; 3]) {
    let lanes = &field.tree.lanes;
    let at = from.to_array().map(|value| V::splat((value / UNIT) as f32));
    let (zero, tiny) = (V::splat(0.0), V::splat(1e-35));
    let first = cluster.lanes as usize;
    for lane in (first..first + cluster.n_lanes as usize).step_by(V::LANES) {
        // SAFETY: lanes of a box lie within all vectors, and are a multiple of the widest.
        let (r1, r2, strength, core) = unsafe {
            let r1: [V; 3] =
                std::array::from_fn(|a| at[a] - V::load(lanes.from[a].as_ptr().add(lane)));
            let r2: [V; 3] =
                std::array::from_fn(|a| at[a] - V::load(lanes.to[a].as_ptr().add(lane)));
            (
                r1,
                r2,
                V::load(lanes.strength.as_ptr().add(lane)),
                V::load(lanes.core.as_ptr().add(lane)),
            )
        };
        let (q1, q2, d) = (dot(&r1, &r1), dot(&r2, &r2), dot(&r1, &r2));
        let p = root(q1 * q2, tiny);
        let c = cross(&r1, &r2);
        // (h l)², with l for the length, and what is added beyond the ends.
        let beyond = ((q1 - d) * (d - q2)).maximum(zero);
        let reach = beyond.mul_add(V::splat(BEYOND as f32), dot(&c, &c));
        // s = p + |d|; (p − d)/c² is 1/s ahead of both ends, and s/c² between them.
        let s = p + d.maximum(zero - d);
        let difference = d.where_negative(s * s, reach);
        // (r₁ + r₂)² = q₁ + q₂ + 2p.
        let sums = q1 + q2 + p + p;
        let around = reach.mul_add(reach, core);
        let weight = root(sums * around, tiny) * difference;
        let weight = strength * weight * (around * p).mul_add(s, tiny).inverse();
        for (sum, c) in sum.iter_mut().zip(c) {
            *sum = c.mul_add(weight, *sum);
        }
    }
}

/// Square root of a number that is not negative, that of `tiny` at the least.
#[inline(always)]
fn root<V: Simd>(value: V, tiny: V) -> V {
    let value = value.maximum(tiny);
    value * value.inverse_sqrt()
}

#[inline(always)]
fn dot<V: Simd>(a: &[V; 3], b: &[V; 3]) -> V {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

#[inline(always)]
fn cross<V: Simd>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    let part = |j: usize, k: usize| b[j].sub_from(a[k], a[j] * b[k]);
    [part(1, 2), part(2, 0), part(0, 1)]
}
