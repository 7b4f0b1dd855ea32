//! The velocity that many segments induce: near ones one by one in single precision, far ones box by box.
//!
//! A treecode: places near each other go through the boxes together, as many as the widest vector has values.
//! Barnes and Hut (1986) for boxes within boxes, [`harmonics`](super::harmonics) for what one amounts to.

use super::far::far;
use super::harmonics::{HIGHEST_DEGREE, LOWEST_DEGREE, n_coefficients};
use super::narrow::UNIT;
use super::near::near;
use super::neighbours::{GROUP, Lanes};
use super::segment::Segment;
use super::tree::Tree;
use crate::pool::Pool;
use crate::simd::{Backend, Portable, Simd};
use basis::Vector3;

/// Distance from a box beyond which its cores are not felt, in the widest of them (–): 1 − h²/√(r⁴ + h⁴) is
/// 4e-4 at six cores beside a segment, and 7e-4 beyond its end.
const CORES_AWAY: f64 = 6.0;
/// Most segments that cost less one by one than their box (–).
const FEW: u32 = 2;
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
    /// That of cases which say nothing of it: in wakes of 30 000 segments, tidy or tangled, the root of the
    /// mean square of the error is less than 1e-3 of that of the velocity.
    pub const USUAL: Self = Self { degree: 4, opening: 0.5 };
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

    /// Memory that boxes of `most` segments take (bytes).
    pub(super) fn memory_of_boxes(accuracy: Accuracy, most: usize) -> u64 {
        let degree = accuracy.degree.clamp(LOWEST_DEGREE, HIGHEST_DEGREE);
        (Tree::most_boxes(most) * Tree::memory_of_box(degree)) as u64
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

/// The loop for `backend`, whose instructions the caller has found on this machine, and harmonics of
/// `degree`.
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
    let Tree { clusters, narrow, coefficients, cores, .. } = &field.tree;
    let mut index = 0;
    while let Some(cluster) = clusters.get(index) {
        let way = group.centre - cluster.centre;
        // From the nearest of the places.
        let distance = way.length() - group.radius;
        let gap = distance - cluster.radius;
        let is_far = cluster.radius < field.opening * distance && gap > CORES_AWAY * cores[index];
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
