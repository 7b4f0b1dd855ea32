//! How segments are divided into boxes within boxes, by several threads at once.
//!
//! How many boxes there are follows from the number of segments alone, so that every thread knows where its
//! own begin, and the order of boxes is that of one thread.

use super::segment::Segment;
use basis::Vector3;

/// Most segments of a box that is not divided (–).
pub(super) const LEAF: usize = 16;
/// Divisions after which what is left is shared among threads (–), and how many shares that makes.
pub(super) const SHARED_AFTER: usize = 5;
pub(super) const MOST_SHARES: usize = 1 << SHARED_AFTER;
/// Least radius of a box (m): places are told in it.
const LEAST_RADIUS: f64 = 1e-3;

/// A box of segments; those inside of it follow, and `next` is the first after them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cluster {
    pub(super) centre: Vector3,
    /// From the centre to the farthest end of its segments (m).
    pub(super) radius: f64,
    /// One over it (1/m).
    pub(super) inverse_radius: f64,
    /// Its segments in the tree's order.
    pub(super) first: u32,
    pub(super) n: u32,
    /// Where to go on without looking inside.
    pub(super) next: u32,
}

impl Cluster {
    /// Whether no boxes are inside of it.
    pub(super) fn is_leaf(&self) -> bool {
        self.n as usize <= LEAF
    }
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
}

/// Boxes that there are of `n` segments, the one around all with those inside of it (–).
pub(super) fn n_boxes(n: usize) -> usize {
    if n <= LEAF { 1 } else { 1 + n_boxes(n / 2) + n_boxes(n - n / 2) }
}

impl Share {
    /// The two boxes that it is divided into.
    pub(super) fn halves(&self) -> [Self; 2] {
        let Self { cluster, n_clusters, first, n } = *self;
        let of_low = n_boxes(n / 2);
        let low = Self { cluster: cluster + 1, n_clusters: of_low, first, n: n / 2 };
        let high = Self {
            cluster: cluster + 1 + of_low,
            n_clusters: n_clusters - 1 - of_low,
            first: first + n / 2,
            n: n - n / 2,
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
    for &index in order {
        let Segment { from, to, .. } = segments[index as usize];
        low = low.min(from).min(to);
        high = high.max(from).max(to);
    }
    if share.n == 0 {
        (low, high) = (Vector3::ZERO, Vector3::ZERO);
    }
    let (edges, centre) = (high - low, 0.5 * (low + high));
    let from_centre = |&index: &u32| {
        let Segment { from, to, .. } = segments[index as usize];
        (from - centre).length_squared().max((to - centre).length_squared())
    };
    let radius_squared = order.iter().map(from_centre).fold(0.0, f64::max);
    let radius = radius_squared.sqrt().max(LEAST_RADIUS);
    *cluster = Cluster {
        centre,
        radius,
        inverse_radius: 1.0 / radius,
        first: share.first as u32,
        n: share.n as u32,
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
