//! How segments are divided into boxes within boxes, by several threads at once.
//!
//! How many boxes and lanes there are follows from the number of segments alone, so that every thread knows
//! where its own begin, and the order of boxes is that of one thread.

use super::segment::Segment;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;

/// Most segments of a box that is not divided (–).
pub(super) const LEAF: usize = 64;
/// Divisions after which what is left is shared among threads (–), and how many shares that makes.
pub(super) const SHARED_AFTER: usize = 5;
pub(super) const MOST_SHARES: usize = 1 << SHARED_AFTER;
/// Flattest box over its longest edge (–): points on a plane would coincide.
const FLATTEST: f64 = 1e-3;

/// A box of segments; those inside of it follow, and `next` is the first after them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cluster {
    pub(super) centre: Vector3,
    /// Half of its edges (m).
    pub(super) half: Vector3,
    /// From the centre to its corners (m).
    pub(super) radius: f64,
    /// The widest core of its segments, squared (m²).
    pub(super) core_squared: f64,
    /// Its segments in the tree's order.
    pub(super) first: u32,
    pub(super) n: u32,
    /// Where its lanes begin, if it is not divided.
    pub(super) lanes: u32,
    /// How many there are, a multiple of the widest vector's; 0 where it is divided.
    pub(super) n_lanes: u32,
    /// Where to go on without looking inside.
    pub(super) next: u32,
}

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
    pub(super) fn halves(&self) -> [Self; 2] {
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
pub(super) fn make_box(
    segments: &[Segment],
    order: &[u32],
    share: &Share,
    cluster: &mut Cluster,
) -> usize {
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
pub(super) fn part(segments: &[Segment], order: &mut [u32], axis: usize) {
    let key = |index: u32| {
        let segment = &segments[index as usize];
        segment.from[axis] + segment.to[axis]
    };
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
}

/// Makes the boxes of `share` in `clusters`, its segments those of `order`.
pub(super) fn divide(
    segments: &[Segment],
    share: Share,
    clusters: &mut [Cluster],
    order: &mut [u32],
) {
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
