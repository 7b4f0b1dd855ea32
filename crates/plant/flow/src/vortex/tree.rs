//! Segments in boxes within boxes.

use super::division::{
    Cluster, LEAF, MOST_SHARES, SHARED_AFTER, Share, divide, make_box, part, shape,
};
use super::interpolation::Points;
use super::segment::Segment;
use crate::pool::Pool;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;
use std::f64::consts::PI;

/// Lengths are divided by so much in single precision, so that fourth powers stay within its range (m); a
/// power of two, which loses nothing.
pub(super) const UNIT: f64 = 64.0;

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
    pub(super) order: Vec<u32>,
    /// Boxes that threads make, each with all inside of it; in order.
    pub(super) shares: Vec<Share>,
    /// Boxes around these.
    pub(super) tops: Vec<usize>,
    /// Segments as boxes know them, and the boxes in which there are others now.
    known: Vec<Segment>,
    changed: Vec<bool>,
}

/// What a thread makes: a share, its boxes, and its segments in the tree's order.
type Part<'a> = (Share, &'a mut [Cluster], &'a mut [u32]);

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
            shares: Vec::with_capacity(MOST_SHARES),
            tops: Vec::with_capacity(MOST_SHARES),
            known: Vec::new(),
            changed: Vec::new(),
        };
        // Halves of halves: at least LEAF/2 segments in each box that is not divided.
        let leaves = 2 * most / LEAF + 2;
        tree.clusters.reserve(2 * leaves);
        tree.changed.reserve(2 * leaves);
        tree.order.reserve(most);
        tree.known.reserve(most);
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
        self.order.clear();
        self.order.extend(0..segments.len() as u32);
        let [n_clusters, n_lanes] = shape(segments.len());
        self.clusters.clear();
        self.clusters.resize(n_clusters, Cluster::default());
        self.shares.clear();
        self.tops.clear();
        let whole = Share { n_clusters, n: segments.len(), ..Share::default() };
        self.divide_tops(segments, whole, 0);
        self.divide_shares(segments, pool);
        let Lanes { from, to, strength, core } = &mut self.lanes;
        let all = from.iter_mut().chain(to).chain([strength, core]);
        all.for_each(|lane| lane.resize(n_lanes, 0.0));
        let (n, padded) = (self.points.n_in_cube(), self.n_padded());
        self.exact.resize(n_clusters * n, Vector3::ZERO);
        self.moments.iter_mut().for_each(|m| m.resize(n_clusters * padded, 0.0));
        self.take_up(segments, true, pool);
    }

    /// Takes the circulations and cores of `segments` up, which stand where they stood at the last
    /// [`rebuild`](Self::rebuild). Boxes in which nothing has changed stay as they are.
    pub(super) fn refresh(&mut self, segments: &[Segment], pool: &mut Pool) {
        self.take_up(segments, false, pool);
    }

    /// Makes the box of `share`, after `depth` divisions, and those inside of it as far as one thread makes
    /// them.
    fn divide_tops(&mut self, segments: &[Segment], share: Share, depth: usize) {
        let Share { cluster, first, n, .. } = share;
        if depth == SHARED_AFTER || n <= LEAF {
            self.shares.push(share);
            return;
        }
        self.tops.push(cluster);
        let order = &mut self.order[first..first + n];
        let axis = make_box(segments, order, &share, &mut self.clusters[cluster]);
        part(segments, order, axis);
        for half in share.halves() {
            self.divide_tops(segments, half, depth + 1);
        }
    }

    /// Makes the boxes of all shares.
    fn divide_shares(&mut self, segments: &[Segment], pool: &mut Pool) {
        let Self { shares, clusters, order, .. } = self;
        let mut parts: [Option<Part<'_>>; MOST_SHARES] = std::array::from_fn(|_| None);
        let (mut clusters, mut order) = (&mut clusters[..], &mut order[..]);
        let (mut next_cluster, mut next) = (0, 0);
        for (place, share) in parts.iter_mut().zip(&*shares) {
            let (_, rest) = clusters.split_at_mut(share.cluster - next_cluster);
            let (mine, rest) = rest.split_at_mut(share.n_clusters);
            let (_, others) = order.split_at_mut(share.first - next);
            let (segments_of_mine, others) = others.split_at_mut(share.n);
            *place = Some((*share, mine, segments_of_mine));
            (clusters, order) = (rest, others);
            (next_cluster, next) = (share.cluster + share.n_clusters, share.first + share.n);
        }
        pool.for_chunks(&mut parts, 1, &|_, part| {
            for (share, clusters, order) in part.iter_mut().flatten() {
                divide(segments, *share, clusters, order);
            }
        });
    }

    /// Moments and lanes of `all` boxes, or of those in which `segments` are others than they were.
    fn take_up(&mut self, segments: &[Segment], all: bool, pool: &mut Pool) {
        self.find_changed(segments, all);
        let n = self.points.n_in_cube();
        let Self { points, clusters, order, exact, shares, changed, .. } = self;
        let mut parts: [Option<(Share, &mut [Vector3])>; MOST_SHARES] =
            std::array::from_fn(|_| None);
        let (mut rest, mut next) = (&mut exact[..], 0);
        for (part, share) in parts.iter_mut().zip(&*shares) {
            let (_, others) = rest.split_at_mut((share.cluster - next) * n);
            let (mine, others) = others.split_at_mut(share.n_clusters * n);
            *part = Some((*share, mine));
            (rest, next) = (others, share.cluster + share.n_clusters);
        }
        let (clusters, changed) = (&clusters[..], &changed[..]);
        pool.for_chunks(&mut parts, 1, &|_, part| {
            for (share, exact) in part.iter_mut().flatten() {
                // Boxes come before those inside of them.
                for index in (share.cluster..share.cluster + share.n_clusters).rev() {
                    let from = (index - share.cluster) * n;
                    if !changed[index] {
                        continue;
                    }
                    let cluster = &clusters[index];
                    if cluster.n_lanes == 0 {
                        gather(points, clusters, index, &mut exact[from..]);
                        continue;
                    }
                    let moments = &mut exact[from..from + n];
                    moments.fill(Vector3::ZERO);
                    for &segment in cluster.segments(order) {
                        add_moments(points, cluster, &segments[segment as usize], moments);
                    }
                }
            }
        });
        for &index in self.tops.iter().rev().filter(|&&index| changed[index]) {
            gather(points, clusters, index, &mut exact[index * n..]);
        }
        self.fill_lanes(segments);
        self.round();
    }

    /// On return boxes know which of them hold other segments than they knew of: `all`, where they are new.
    fn find_changed(&mut self, segments: &[Segment], all: bool) {
        let Self { clusters, order, known, changed, .. } = self;
        changed.clear();
        changed.resize(clusters.len(), all);
        if !all {
            for (index, cluster) in clusters.iter().enumerate().rev() {
                let mut mine = cluster.segments(order).iter().map(|&of| of as usize);
                changed[index] = if cluster.n_lanes > 0 {
                    mine.any(|of| known[of] != segments[of])
                } else {
                    cluster.n > 0
                        && (changed[index + 1] || changed[clusters[index + 1].next as usize])
                };
            }
        }
        known.clear();
        known.extend_from_slice(segments);
    }

    /// Moments of changed boxes in single precision.
    fn round(&mut self) {
        let (n, padded) = (self.points.n_in_cube(), self.n_padded());
        let all = self.exact.chunks_exact(n).zip(&self.changed).enumerate();
        for (index, (exact, _)) in all.filter(|(_, (_, changed))| **changed) {
            for (k, moment) in exact.iter().enumerate() {
                for (axis, moments) in self.moments.iter_mut().enumerate() {
                    moments[index * padded + k] = moment[axis] as f32;
                }
            }
        }
    }

    /// Lanes of all changed boxes that are not divided.
    fn fill_lanes(&mut self, segments: &[Segment]) {
        let Self { clusters, order, lanes, changed, .. } = self;
        for (cluster, _) in clusters.iter().zip(&*changed).filter(|(_, changed)| **changed) {
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

/// Moments of box number `index` from those of the two inside of it, all of which follow it in `exact`.
fn gather(points: &Points, clusters: &[Cluster], index: usize, exact: &mut [Vector3]) {
    let cluster = &clusters[index];
    let n = points.n_in_cube();
    let (mine, inside) = exact.split_at_mut(n);
    mine.fill(Vector3::ZERO);
    if cluster.n == 0 {
        return;
    }
    for child in [index + 1, clusters[index + 1].next as usize] {
        let Cluster { centre, half, .. } = clusters[child];
        let place = (centre - cluster.centre) / cluster.half;
        let from = &inside[(child - index - 1) * n..(child - index) * n];
        points.raise(from, place, half / cluster.half, mine);
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
