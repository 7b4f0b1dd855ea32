//! Segments in boxes within boxes.

use super::interpolation::Points;
use super::segment::Segment;
use crate::pool::Pool;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;
use std::f64::consts::PI;

/// Most segments of a box that is not divided (–).
const LEAF: usize = 64;
/// Flattest box over its longest edge (–): points on a plane would coincide.
const FLATTEST: f64 = 1e-3;
/// Lengths are divided by so much in single precision, so that fourth powers stay within its range (m); a
/// power of two, which loses nothing.
pub(super) const UNIT: f64 = 64.0;

/// A box of segments; those inside of it follow, and `next` is the first after them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    pub(super) centre: Vector3,
    /// Half of its edges (m).
    pub(super) half: Vector3,
    /// From the centre to its corners (m).
    pub(super) radius: f64,
    /// The widest core of its segments, squared (m²).
    pub(super) core_squared: f64,
    /// Its segments in the tree's order.
    first: u32,
    n: u32,
    /// Where its lanes begin, if it is not divided.
    pub(super) lanes: u32,
    /// How many there are, a multiple of the widest vector's; 0 where it is divided.
    pub(super) n_lanes: u32,
    /// Where to go on without looking inside.
    pub(super) next: u32,
}

/// Segments in single precision, relative to the centre of the box that they are in and in [`UNIT`]s.
#[derive(Clone, Debug, Default)]
pub(super) struct Lanes {
    pub(super) from: [Vec<f32>; 3],
    pub(super) to: [Vec<f32>; 3],
    /// Γ/4π (m²/s over the unit).
    pub(super) strength: Vec<f32>,
    /// (r l)⁴ for a core r and a length l.
    pub(super) core: Vec<f32>,
}

/// Boxes of segments, and what each amounts to from afar.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub(super) points: Points,
    pub(super) clusters: Vec<Cluster>,
    pub(super) lanes: Lanes,
    /// Vector strengths Γ l/4π in the points of each box, [`padded`](Self::n_padded), in single precision.
    pub(super) moments: [Vec<f32>; 3],
    exact: Vec<Vector3>,
    order: Vec<u32>,
}

impl Tree {
    /// Memory for `most` segments, boxes seen through polynomials of `degree`.
    pub(super) fn with_capacity(degree: usize, most: usize) -> Self {
        let points = Points::new(degree);
        let mut tree = Self {
            points,
            clusters: Vec::new(),
            lanes: Lanes::default(),
            moments: std::array::from_fn(|_| Vec::new()),
            exact: Vec::new(),
            order: Vec::new(),
        };
        // Halves of halves: at least LEAF/2 segments in each box that is not divided.
        let leaves = 2 * most / LEAF + 2;
        tree.clusters.reserve(2 * leaves);
        tree.order.reserve(most);
        tree.exact.reserve(2 * leaves * tree.points.n_in_cube());
        let padded = tree.n_padded();
        tree.moments.iter_mut().for_each(|m| m.reserve(2 * leaves * padded));
        let Lanes { from, to, strength, core } = &mut tree.lanes;
        let all = from.iter_mut().chain(to).chain([strength, core]);
        all.for_each(|lane| lane.reserve(leaves * (LEAF + MAXIMUM_LANES)));
        tree
    }

    /// Points of a box, filled up to whole vectors (–).
    pub(super) fn n_padded(&self) -> usize {
        self.points.n_in_cube().next_multiple_of(MAXIMUM_LANES)
    }

    /// Makes the boxes of `segments` anew.
    pub(super) fn rebuild(&mut self, segments: &[Segment], pool: &mut Pool) {
        self.clusters.clear();
        self.order.clear();
        self.order.extend(0..segments.len() as u32);
        let n_lanes = self.divide(segments, 0, segments.len(), 0);
        let Lanes { from, to, strength, core } = &mut self.lanes;
        let all = from.iter_mut().chain(to).chain([strength, core]);
        all.for_each(|lane| lane.resize(n_lanes, 0.0));
        let (n, padded) = (self.points.n_in_cube(), self.n_padded());
        self.exact.resize(self.clusters.len() * n, Vector3::ZERO);
        self.moments.iter_mut().for_each(|m| m.resize(self.clusters.len() * padded, 0.0));
        self.refresh(segments, pool);
    }

    /// Makes the box of segments `first .. first + n` of the order and those inside of it, lanes from `lanes`
    /// on; gives the end of the lanes.
    fn divide(&mut self, segments: &[Segment], first: usize, n: usize, lanes: usize) -> usize {
        let mine = &mut self.order[first..first + n];
        let (mut low, mut high) = (Vector3::INFINITY, Vector3::NEG_INFINITY);
        let mut core_squared = 0.0_f64;
        for &index in &*mine {
            let Segment { from, to, core_squared: core, .. } = segments[index as usize];
            low = low.min(from).min(to);
            high = high.max(from).max(to);
            core_squared = core_squared.max(core);
        }
        if n == 0 {
            (low, high) = (Vector3::ZERO, Vector3::ZERO);
        }
        let edges = high - low;
        let half = 0.5 * edges.max(Vector3::splat((FLATTEST * edges.max_element()).max(1e-6)));
        let here = self.clusters.len();
        let is_leaf = n <= LEAF;
        let n_lanes = if is_leaf { n.next_multiple_of(MAXIMUM_LANES) } else { 0 };
        self.clusters.push(Cluster {
            centre: 0.5 * (low + high),
            half,
            radius: half.length(),
            core_squared,
            first: first as u32,
            n: n as u32,
            lanes: lanes as u32,
            n_lanes: n_lanes as u32,
            next: 0,
        });
        let end = if is_leaf {
            lanes + n_lanes
        } else {
            let axis = (0..3).max_by(|&a, &b| edges[a].total_cmp(&edges[b])).unwrap_or(0);
            let key = |index: u32| {
                let segment = &segments[index as usize];
                segment.from[axis] + segment.to[axis]
            };
            mine.select_nth_unstable_by(n / 2, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            let middle = self.divide(segments, first, n / 2, lanes);
            self.divide(segments, first + n / 2, n - n / 2, middle)
        };
        self.clusters[here].next = self.clusters.len() as u32;
        end
    }

    /// Takes the circulations and cores of `segments` up, which stand where they stood at the last
    /// [`rebuild`](Self::rebuild).
    pub(super) fn refresh(&mut self, segments: &[Segment], pool: &mut Pool) {
        let n = self.points.n_in_cube();
        let Self { points, clusters, order, exact, .. } = self;
        pool.for_chunks(exact, n, &|first, moments| {
            moments.fill(Vector3::ZERO);
            let cluster = &clusters[first / n];
            for &index in cluster.segments(order) {
                add_moments(points, cluster, &segments[index as usize], moments);
            }
        });
        self.fill_lanes(segments);
        // Boxes come before those inside of them.
        for index in (0..self.clusters.len()).rev() {
            let cluster = self.clusters[index];
            if cluster.n_lanes > 0 || cluster.n == 0 {
                continue;
            }
            let second = self.clusters[index + 1].next as usize;
            let (mine, inside) = self.exact[index * n..].split_at_mut(n);
            for child in [index + 1, second] {
                let Cluster { centre, half, .. } = self.clusters[child];
                let place = (centre - cluster.centre) / cluster.half;
                let from = &inside[(child - index - 1) * n..(child - index) * n];
                self.points.raise(from, place, half / cluster.half, mine);
            }
        }
        let padded = self.n_padded();
        for (index, exact) in self.exact.chunks_exact(n).enumerate() {
            for (k, moment) in exact.iter().enumerate() {
                for (axis, moments) in self.moments.iter_mut().enumerate() {
                    moments[index * padded + k] = moment[axis] as f32;
                }
            }
        }
    }

    /// Lanes of all boxes that are not divided.
    fn fill_lanes(&mut self, segments: &[Segment]) {
        let Self { clusters, order, lanes, .. } = self;
        for cluster in clusters {
            let mut mine = cluster.segments(order).iter();
            for lane in cluster.lanes..cluster.lanes + cluster.n_lanes {
                match mine.next() {
                    Some(&of) => lanes.put(lane as usize, &segments[of as usize], cluster.centre),
                    None => lanes.fill_up(lane as usize),
                }
            }
        }
    }
}

impl Cluster {
    /// Its segments in `order`, if it is not divided; else none.
    fn segments<'a>(&self, order: &'a [u32]) -> &'a [u32] {
        let n = if self.n_lanes > 0 { self.n as usize } else { 0 };
        &order[self.first as usize..][..n]
    }
}

/// Adds what `segment` amounts to in the points of `cluster` to its `moments`.
fn add_moments(points: &Points, cluster: &Cluster, segment: &Segment, moments: &mut [Vector3]) {
    let n = points.n();
    let along = segment.to - segment.from;
    let strength = along * (0.5 * segment.circulation / (4.0 * PI));
    for at in [-1.0, 1.0] {
        // Gauss's two points, at which the way to the ends' fourth powers is free of error.
        let share = 0.5 + at * 0.5 / 3.0_f64.sqrt();
        let place = (segment.from + along * share - cluster.centre) / cluster.half;
        let shares = points.shares(place);
        let mut point = 0;
        for x in &shares[0][..n] {
            for y in &shares[1][..n] {
                let source = strength * (x * y);
                for z in &shares[2][..n] {
                    moments[point] += source * *z;
                    point += 1;
                }
            }
        }
    }
}

impl Lanes {
    fn put(&mut self, lane: usize, segment: &Segment, centre: Vector3) {
        let Segment { from, to, circulation, core_squared } = *segment;
        let length_squared = (to - from).length_squared();
        for axis in 0..3 {
            self.from[axis][lane] = ((from - centre)[axis] / UNIT) as f32;
            self.to[axis][lane] = ((to - centre)[axis] / UNIT) as f32;
        }
        self.strength[lane] = (circulation / (4.0 * PI * UNIT)) as f32;
        let core = (core_squared * length_squared / UNIT.powi(4)).powi(2);
        // Never zero: a position on the line of a thin segment has no velocity.
        self.core[lane] = (core as f32).max(f32::MIN_POSITIVE);
    }

    /// A segment without circulation, far from everything.
    fn fill_up(&mut self, lane: usize) {
        for axis in 0..3 {
            self.from[axis][lane] = 1e3;
            self.to[axis][lane] = 1e3;
        }
        self.strength[lane] = 0.0;
        self.core[lane] = 1.0;
    }
}
