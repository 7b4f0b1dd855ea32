//! How segments are divided into boxes within boxes, by several threads at once.
//!
//! How many boxes and lanes there are follows from the number of segments alone, so that every thread knows
//! where its own begin, and the order of boxes is that of one thread.

use super::segment::Segment;
use super::tree::{Cluster, Tree};
use crate::pool::Pool;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;

/// Most segments of a box that is not divided (–).
pub(super) const LEAF: usize = 64;
/// Divisions after which what is left is shared among threads (–), and how many shares that makes.
const SHARED_AFTER: usize = 5;
pub(super) const MOST_SHARES: usize = 1 << SHARED_AFTER;
/// Flattest box over its longest edge (–): points on a plane would coincide.
const FLATTEST: f64 = 1e-3;

/// A box with all inside of it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    /// Its number, and how many boxes there are in all.
    pub(super) cluster: usize,
    pub(super) n_clusters: usize,
    /// Its segments in the tree's order.
    pub(super) first: usize,
    pub(super) n: usize,
    /// Where its lanes begin.
    pub(super) lanes: usize,
}

impl Tree {
    /// Makes the box of `share`, after `depth` divisions, and those inside of it as far as one thread makes
    /// them.
    pub(super) fn divide_tops(&mut self, segments: &[Segment], share: Share, depth: usize) {
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
    pub(super) fn divide_shares(&mut self, segments: &[Segment], pool: &mut Pool) {
        let Self { shares, clusters, order, .. } = self;
        let mut parts: [Option<(Share, &mut [Cluster], &mut [u32])>; MOST_SHARES] =
            std::array::from_fn(|_| None);
        let (mut clusters, mut order) = (&mut clusters[..], &mut order[..]);
        let (mut next_cluster, mut next) = (0, 0);
        for (part, share) in parts.iter_mut().zip(&*shares) {
            let (_, rest) = clusters.split_at_mut(share.cluster - next_cluster);
            let (mine, rest) = rest.split_at_mut(share.n_clusters);
            let (_, others) = order.split_at_mut(share.first - next);
            let (segments_of_mine, others) = others.split_at_mut(share.n);
            *part = Some((*share, mine, segments_of_mine));
            (clusters, order) = (rest, others);
            (next_cluster, next) = (share.cluster + share.n_clusters, share.first + share.n);
        }
        pool.for_chunks(&mut parts, 1, &|_, part| {
            for (share, clusters, order) in part.iter_mut().flatten() {
                divide(segments, *share, clusters, order);
            }
        });
    }
}

/// Boxes and lanes of the box of `n` segments with those inside of it.
pub(super) fn shape(n: usize) -> [usize; 2] {
    if n <= LEAF {
        return [1, n.next_multiple_of(MAXIMUM_LANES)];
    }
    let [low, high] = [shape(n / 2), shape(n - n / 2)];
    [1 + low[0] + high[0], low[1] + high[1]]
}

impl Share {
    /// The two boxes that it is divided into.
    fn halves(&self) -> [Self; 2] {
        let Self { cluster, n_clusters, first, n, lanes } = *self;
        let [of_low, low_lanes] = shape(n / 2);
        let low = Self { cluster: cluster + 1, n_clusters: of_low, first, n: n / 2, lanes };
        let high = Self {
            cluster: cluster + 1 + of_low,
            n_clusters: n_clusters - 1 - of_low,
            first: first + n / 2,
            n: n - n / 2,
            lanes: lanes + low_lanes,
        };
        [low, high]
    }
}

/// Makes `cluster`, the box of `share`, whose segments are those of `order`; gives its longest axis.
fn make_box(segments: &[Segment], order: &[u32], share: &Share, cluster: &mut Cluster) -> usize {
    let (mut low, mut high) = (Vector3::INFINITY, Vector3::NEG_INFINITY);
    let mut core_squared = 0.0_f64;
    for &index in order {
        let Segment { from, to, core_squared: core, .. } = segments[index as usize];
        low = low.min(from).min(to);
        high = high.max(from).max(to);
        core_squared = core_squared.max(core);
    }
    if share.n == 0 {
        (low, high) = (Vector3::ZERO, Vector3::ZERO);
    }
    let edges = high - low;
    let half = 0.5 * edges.max(Vector3::splat((FLATTEST * edges.max_element()).max(1e-6)));
    let n_lanes = if share.n <= LEAF { share.n.next_multiple_of(MAXIMUM_LANES) } else { 0 };
    *cluster = Cluster {
        centre: 0.5 * (low + high),
        half,
        radius: half.length(),
        core_squared,
        first: share.first as u32,
        n: share.n as u32,
        lanes: share.lanes as u32,
        n_lanes: n_lanes as u32,
        next: (share.cluster + share.n_clusters) as u32,
    };
    (0..3).max_by(|&a, &b| edges[a].total_cmp(&edges[b])).unwrap_or(0)
}

/// Puts the half of `order` whose segments lie lower along `axis` first.
fn part(segments: &[Segment], order: &mut [u32], axis: usize) {
    let key = |index: u32| {
        let segment = &segments[index as usize];
        segment.from[axis] + segment.to[axis]
    };
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
}

/// Makes the boxes of `share` in `clusters`, its segments those of `order`.
fn divide(segments: &[Segment], share: Share, clusters: &mut [Cluster], order: &mut [u32]) {
    let axis = make_box(segments, order, &share, &mut clusters[0]);
    if share.n <= LEAF {
        return;
    }
    part(segments, order, axis);
    let [low, high] = share.halves();
    let (of_low, of_high) = clusters[1..].split_at_mut(low.n_clusters);
    let (low_order, high_order) = order.split_at_mut(low.n);
    divide(segments, low, of_low, low_order);
    divide(segments, high, of_high, high_order);
}
