//! The velocity that many segments induce: near ones one by one in single precision, far ones box by box.
//!
//! A treecode: places near each other go through the boxes together, sixteen to a vector. Barnes and Hut
//! (1986) for boxes within boxes, [`harmonics`](super::harmonics) for what one amounts to.

use super::division::Cluster;
use super::harmonics::{HIGHEST_DEGREE, LOWEST_DEGREE, n_coefficients};
use super::segment::{BEYOND, Segment};
use super::tree::{Narrow, Tree, UNIT};
use crate::pool::Pool;
use crate::simd::{Backend, MAXIMUM_LANES, Portable, Simd};
use basis::Vector3;

/// Distance from a box beyond which its cores are not felt, in the widest of them (–): 1 − h²/√(r⁴ + h⁴) is
/// 4e-4 at six cores beside a segment, and 7e-4 beyond its end.
const CORES_AWAY: f64 = 6.0;
/// Most segments that cost less one by one than their box (–).
const FEW: u32 = 2;
/// Places that go through the boxes together (–).
pub(super) const GROUP: usize = MAXIMUM_LANES;
/// Places that a thread takes at once (–).
pub(super) const CHUNK: usize = 4 * GROUP;

/// How exact the velocities are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Degree of the harmonics through which far boxes are seen (–), [`LOWEST_DEGREE`] to [`HIGHEST_DEGREE`].
    pub degree: usize,
    /// A box is far where its radius is less than this share of its distance (–); 0 and none is.
    pub opening: f64,
}

impl Accuracy {
    /// That of cases which say nothing of it: an error of less than 1e-3 of the velocity, in tangled wakes too.
    pub const USUAL: Self = Self { degree: 4, opening: 0.55 };
}

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
    let mut neighbours = super::neighbours::Neighbours::with_capacity(positions.len());
    neighbours.sort(positions, &mut pool);
    let mut sorted = vec![Vector3::ZERO; positions.len()];
    pool.for_chunks(&mut sorted, CHUNK, &|first, chunk| {
        field.sample(&neighbours.sorted()[first..first + chunk.len()], chunk);
    });
    neighbours.to_own_order(&sorted, velocities);
}

/// The velocity field of segments.
pub(super) struct Field {
    opening: f64,
    backend: Backend,
    tree: Tree,
    sum: Sum,
}

/// Adds the velocities of all boxes at the places of a group to the sums there.
type Sum = unsafe fn(&Field, &Group, &mut Lanes);
/// Three components at each place of a group.
type Lanes = [[f32; GROUP]; 3];

/// Places near each other.
struct Group {
    centre: Vector3,
    /// From the centre to the farthest place (m).
    radius: f64,
    /// Places about the centre, in [`UNIT`]s.
    places: Lanes,
}

impl Group {
    /// That of `positions` (m), one to [`GROUP`] of them.
    fn of(positions: &[Vector3]) -> Self {
        let (mut low, mut high) = (Vector3::INFINITY, Vector3::NEG_INFINITY);
        for &position in positions {
            low = low.min(position);
            high = high.max(position);
        }
        let centre = 0.5 * (low + high);
        let mut radius_squared = 0.0_f64;
        let mut places = [[0.0; GROUP]; 3];
        for (lane, &position) in positions.iter().enumerate() {
            let from = position - centre;
            radius_squared = radius_squared.max(from.length_squared());
            for (axis, places) in places.iter_mut().enumerate() {
                places[lane] = (from[axis] / UNIT) as f32;
            }
        }
        Self { centre, radius: radius_squared.sqrt(), places }
    }
}

impl Field {
    /// A field of no segments, with memory for `most`.
    pub(super) fn with_capacity(accuracy: Accuracy, backend: Backend, most: usize) -> Self {
        let degree = accuracy.degree.clamp(LOWEST_DEGREE, HIGHEST_DEGREE);
        let tree = Tree::with_capacity(degree, most);
        Self { opening: accuracy.opening, backend, tree, sum: sum_of(backend, degree) }
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

    /// On return `velocities` (m/s) holds the velocity at each of `positions` (m, farm frame), of the same
    /// length. The nearer those that follow on each other are, the faster it is.
    pub(super) fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (positions, velocities) in positions.chunks(GROUP).zip(velocities.chunks_mut(GROUP)) {
            let group = Group::of(positions);
            let mut sums = [[0.0; GROUP]; 3];
            // SAFETY: the back-end's instructions were found on this machine.
            unsafe { (self.sum)(self, &group, &mut sums) };
            for (lane, velocity) in velocities.iter_mut().enumerate() {
                *velocity = Vector3::from_array(sums.map(|sums| f64::from(sums[lane])));
            }
        }
    }
}

/// The loop for `backend`, whose instructions the caller has found on this machine, and harmonics of `degree`.
fn sum_of(backend: Backend, degree: usize) -> Sum {
    match degree {
        2 => at_degree::<2>(backend),
        3 => at_degree::<3>(backend),
        4 => at_degree::<4>(backend),
        5 => at_degree::<5>(backend),
        _ => at_degree::<HIGHEST_DEGREE>(backend),
    }
}

fn at_degree<const DEGREE: usize>(backend: Backend) -> Sum {
    match backend {
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => {
            #[target_feature(enable = "avx512f,fma")]
            unsafe fn sum<const DEGREE: usize>(field: &Field, group: &Group, sums: &mut Lanes) {
                // SAFETY: handed through.
                unsafe { visit::<crate::simd::Avx512, DEGREE>(field, group, sums) }
            }
            sum::<DEGREE>
        }
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => {
            #[target_feature(enable = "avx2,fma")]
            unsafe fn sum<const DEGREE: usize>(field: &Field, group: &Group, sums: &mut Lanes) {
                // SAFETY: handed through.
                unsafe { visit::<crate::simd::Avx2, DEGREE>(field, group, sums) }
            }
            sum::<DEGREE>
        }
        _ => visit::<Portable, DEGREE>,
    }
}

/// Sums over all boxes.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
unsafe fn visit<V: Simd, const DEGREE: usize>(field: &Field, group: &Group, sums: &mut Lanes) {
    let Tree { clusters, narrow, coefficients, .. } = &field.tree;
    let mut index = 0;
    while let Some(cluster) = clusters.get(index) {
        let way = group.centre - cluster.centre;
        // From the nearest of the places.
        let distance = way.length() - group.radius;
        let gap = distance - cluster.radius;
        let is_far = cluster.radius < field.opening * distance
            && gap * gap > CORES_AWAY * CORES_AWAY * cluster.core_squared;
        let is_leaf = cluster.is_leaf();
        if is_far && cluster.n > FEW {
            let first = index * n_coefficients(DEGREE);
            let coefficients = &coefficients[first..first + n_coefficients(DEGREE)];
            // SAFETY: handed through.
            unsafe { far::<V, DEGREE>(coefficients, cluster, way, &group.places, sums) };
            index = cluster.next as usize;
        } else {
            if is_leaf {
                // SAFETY: handed through.
                unsafe { near::<V>(cluster.segments(narrow), way, &group.places, sums) };
            }
            index += 1;
        }
    }
}

/// Adds what `cluster` with its `coefficients` amounts to at `places` about a centre that lies `way` (m) from
/// its own.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
unsafe fn far<V: Simd, const DEGREE: usize>(
    coefficients: &[f32],
    cluster: &Cluster,
    way: Vector3,
    places: &Lanes,
    sums: &mut Lanes,
) {
    let inverse = cluster.inverse_radius;
    let scale = V::splat((UNIT * inverse) as f32);
    let way = (way * inverse).to_array().map(|value| V::splat(value as f32));
    for lane in (0..GROUP).step_by(V::LANES) {
        // SAFETY: places and sums have as many values as a group, a multiple of the lanes, and there are as
        // many coefficients as the degree has.
        unsafe {
            let at: [V; 3] = std::array::from_fn(|a| {
                V::load(places[a].as_ptr().add(lane)).mul_add(scale, way[a])
            });
            let found = irregular::<V, DEGREE>(coefficients.as_ptr(), at);
            for (sums, found) in sums.iter_mut().zip(found) {
                let sums = sums.as_mut_ptr().add(lane);
                (V::load(sums) + found).store(sums);
            }
        }
    }
}

/// The block for each degree or order from one on, as a constant: what comes of loops is not unrolled by the
/// compiler, and numbers in them would be worked out at run time.
macro_rules! unrolled {
    ($n:ident $block:block) => {
        unrolled!($n $block; 1 2 3 4 5 6 7)
    };
    ($n:ident $block:block; $($value:literal)*) => {
        $({
            const $n: usize = $value;
            $block
        })*
    };
}

/// Sum of the products of `coefficients` and irregular harmonics at `at`, by their recurrences: along the
/// diagonal from order to order, and in each from degree to degree.
///
/// # Safety
/// [`n_coefficients`] can be read, on a machine with the instructions of `V`.
#[inline(always)]
#[expect(unused_assignments, reason = "the last of all unrolled steps prepares another one")]
unsafe fn irregular<V: Simd, const DEGREE: usize>(coefficients: *const f32, at: [V; 3]) -> [V; 3] {
    let inverse = dot(&at, &at).inverse_sqrt();
    let squared = inverse * inverse;
    let [x, y, z] = [at[0] * squared, at[1] * squared, at[2] * squared];
    // Sums of real and imaginary parts apart, so that one does not wait for the other.
    let mut sums = [[V::splat(0.0); 3]; 2];
    let (mut value, mut before) = (inverse, V::splat(0.0));
    unrolled!(N {
        if N <= DEGREE + 1 {
            let next = value * (z * V::splat((2 * N - 1) as f32));
            let back = squared * V::splat(((N - 1) * (N - 1)) as f32);
            (value, before) = (if N == 1 { next } else { back.sub_from(before, next) }, value);
            // SAFETY: three coefficients for each part of each harmonic.
            unsafe { add(coefficients, N - 1, value, &mut sums[N % 2]) };
        }
    });
    let (mut diagonal, mut index) = ([inverse, V::splat(0.0)], DEGREE + 1);
    unrolled!(M {
        if M <= DEGREE + 1 {
            let odd = V::splat((2 * M - 1) as f32);
            let [re, im] = [diagonal[0] * odd, diagonal[1] * odd];
            diagonal = match M {
                1 => [x * re, y * re],
                _ => [y.sub_from(im, x * re), y.mul_add(re, x * im)],
            };
            let (mut value, mut before) = (diagonal, [V::splat(0.0); 2]);
            unrolled!(N {
                if N >= M && N <= DEGREE + 1 {
                    if N > M {
                        let along = z * V::splat((2 * N - 1) as f32);
                        // (n + m − 1)(n − m − 1).
                        let back = ((N - 1) * (N - 1)) as f32 - (M * M) as f32;
                        let back = squared * V::splat(back);
                        let next = match N - 1 == M {
                            true => [value[0] * along, value[1] * along],
                            false => [
                                back.sub_from(before[0], value[0] * along),
                                back.sub_from(before[1], value[1] * along),
                            ],
                        };
                        (value, before) = (next, value);
                    }
                    // SAFETY: as above.
                    unsafe {
                        add(coefficients, index, value[0], &mut sums[0]);
                        add(coefficients, index + 1, value[1], &mut sums[1]);
                    }
                    index += 2;
                }
            });
        }
    });
    [sums[0][0] + sums[1][0], sums[0][1] + sums[1][1], sums[0][2] + sums[1][2]]
}

/// Adds the product of `part`, number `index` of all parts of harmonics, and its three `coefficients` to `sum`.
///
/// # Safety
/// They can be read, on a machine with the instructions of `V`.
#[inline(always)]
unsafe fn add<V: Simd>(coefficients: *const f32, index: usize, part: V, sum: &mut [V; 3]) {
    // SAFETY: the caller promises them.
    let [x, y, z] = unsafe { coefficients.add(3 * index).cast::<[f32; 3]>().read() };
    sum[0] = part.mul_add(V::splat(x), sum[0]);
    sum[1] = part.mul_add(V::splat(y), sum[1]);
    sum[2] = part.mul_add(V::splat(z), sum[2]);
}

/// Adds what `segments` of a box induce at `places` about a centre that lies `way` (m) from its own, one by
/// one: [`Segment::per_circulation`], with two inverse roots, each to four digits.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
unsafe fn near<V: Simd>(segments: &[Narrow], way: Vector3, places: &Lanes, sums: &mut Lanes) {
    let way = (way * (1.0 / UNIT)).to_array().map(|value| V::splat(value as f32));
    let (zero, two, tiny) = (V::splat(0.0), V::splat(2.0), V::splat(1e-37));
    for lane in (0..GROUP).step_by(V::LANES) {
        // SAFETY: places and sums have as many values as a group, a multiple of the lanes.
        let (at, mut sum): ([V; 3], [V; 3]) = unsafe {
            (
                std::array::from_fn(|a| V::load(places[a].as_ptr().add(lane)) + way[a]),
                std::array::from_fn(|a| V::load(sums[a].as_ptr().add(lane))),
            )
        };
        for segment in segments {
            let along = segment.along.map(V::splat);
            let squared = V::splat(segment.length_squared);
            let r1: [V; 3] = std::array::from_fn(|a| at[a] - V::splat(segment.from[a]));
            let r2: [V; 3] = std::array::from_fn(|a| r1[a] - along[a]);
            // e = r₁·l, d = r₁·r₂, c = r₁ × r₂ = l × r₁.
            let (q1, q2, e) = (dot(&r1, &r1), dot(&r2, &r2), dot(&r1, &along));
            let d = q1 - e;
            let c = cross(&along, &r1);
            let product = q1.mul_add(q2, tiny);
            let p = product * product.rough_inverse_sqrt();
            // (h l)², with l for the length, and what is added beyond the ends.
            let beyond = (e * (e - squared)).maximum(zero);
            let reach = beyond.mul_add(V::splat(BEYOND as f32), dot(&c, &c));
            // s = p + |d|; (p − d)/c² is 1/s ahead of both ends, and s/c² between them.
            let s = p + d.maximum(zero - d);
            let difference = d.where_negative(s * s, reach);
            // (r₁ + r₂)² = q₁ + q₂ + 2p; its root over p s √(…) is itself by one inverse root.
            let ends = p.mul_add(two, q1 + q2);
            let around = reach.mul_add(reach, V::splat(segment.core));
            let ps = p * s;
            let root = (ends * around * ps).mul_add(ps, tiny).rough_inverse_sqrt();
            let weight = V::splat(segment.strength) * difference * ends * root;
            for (sum, c) in sum.iter_mut().zip(c) {
                *sum = c.mul_add(weight, *sum);
            }
        }
        for (sums, sum) in sums.iter_mut().zip(sum) {
            // SAFETY: as above.
            unsafe { sum.store(sums.as_mut_ptr().add(lane)) };
        }
    }
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
