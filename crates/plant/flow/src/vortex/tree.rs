//! Segments in boxes within boxes.

use super::division::{
    Cluster, LEAF, MOST_SHARES, SHARED_AFTER, Share, divide, make_box, n_boxes, part,
};
use super::harmonics::{
    Moment, NO_MOMENT, add_element, n_coefficients, n_moments, raise, velocity_coefficients,
};
use super::narrow::Narrow;
use super::segment::Segment;
use crate::pool::Pool;
use basis::Vector3;
use std::f64::consts::PI;

/// Kinds of segments by their length, each with boxes of its own: in a tangled wake a few are so long that
/// boxes around them and their neighbours would reach far.
const N_KINDS: usize = 3;
/// Of all segments the longest so-manieth part, and of these again (–).
const LONG: usize = 8;
const MOST_PARTS: usize = N_KINDS * MOST_SHARES;

/// Boxes of segments, and what each amounts to from afar.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    degree: usize,
    pub(super) clusters: Vec<Cluster>,
    /// Segments in the tree's order.
    pub(super) narrow: Vec<Narrow>,
    /// Those of the velocity outside of each box, [`n_coefficients`] for each, places being told in its
    /// radii.
    pub(super) coefficients: Vec<f32>,
    /// Potential of vector strengths Γ l/4π about the centre of each box, [`n_moments`] for each.
    moments: Vec<Moment>,
    /// The widest core in each box (m).
    pub(super) cores: Vec<f64>,
    order: Vec<u32>,
    /// Boxes that threads make, each with all inside of it; in order.
    shares: Vec<Share>,
    /// Boxes around these.
    tops: Vec<usize>,
    /// Segments as boxes know them, and the boxes in which there are others now.
    known: Vec<Segment>,
    changed: Vec<bool>,
}

/// What a thread divides: a share, its boxes, and its segments in the tree's order.
type Boxes<'a> = (Share, &'a mut [Cluster], &'a mut [u32]);

/// What a thread makes of a share's boxes.
struct Part<'a> {
    share: Share,
    moments: &'a mut [Moment],
    coefficients: &'a mut [f32],
    cores: &'a mut [f64],
    narrow: &'a mut [Narrow],
}

impl Tree {
    /// Memory for `most` segments, boxes seen through harmonics up to `degree`.
    pub(super) fn with_capacity(degree: usize, most: usize) -> Self {
        let boxes = Self::most_boxes(most);
        Self {
            degree,
            clusters: Vec::with_capacity(boxes),
            narrow: Vec::with_capacity(most),
            coefficients: Vec::with_capacity(boxes * n_coefficients(degree)),
            moments: Vec::with_capacity(boxes * n_moments(degree)),
            cores: Vec::with_capacity(boxes),
            order: Vec::with_capacity(most),
            shares: Vec::with_capacity(MOST_PARTS),
            tops: Vec::with_capacity(MOST_PARTS),
            known: Vec::with_capacity(most),
            changed: Vec::with_capacity(boxes),
        }
    }

    /// Boxes that `most` segments have at the most (–): halves of halves, with half of [`LEAF`] or more
    /// in each that is not divided.
    pub(super) fn most_boxes(most: usize) -> usize {
        4 * most / LEAF + 2 * N_KINDS
    }

    /// Memory of a box seen through harmonics up to `degree` (bytes).
    pub(super) fn memory_of_box(degree: usize) -> usize {
        size_of::<Cluster>()
            + n_moments(degree) * size_of::<Moment>()
            + n_coefficients(degree) * size_of::<f32>()
            + size_of::<f64>()
            + size_of::<bool>()
    }

    /// Makes the boxes of `segments` anew.
    pub(super) fn rebuild(&mut self, segments: &[Segment], pool: &mut Pool) {
        let n = segments.len();
        self.order.clear();
        self.order.extend(0..n as u32);
        let kinds = part_by_length(segments, &mut self.order);
        self.shares.clear();
        self.tops.clear();
        let boxes = kinds.map(n_boxes);
        let n_clusters = boxes.iter().sum();
        self.clusters.clear();
        self.clusters.resize(n_clusters, Cluster::default());
        let (mut cluster, mut first) = (0, 0);
        for (n, n_clusters) in kinds.into_iter().zip(boxes) {
            self.divide_tops(segments, Share { cluster, n_clusters, first, n }, 0);
            (cluster, first) = (cluster + n_clusters, first + n);
        }
        self.divide_shares(segments, pool);
        self.narrow.resize(n, Narrow::default());
        self.moments.resize(n_clusters * n_moments(self.degree), NO_MOMENT);
        self.coefficients.resize(n_clusters * n_coefficients(self.degree), 0.0);
        self.cores.resize(n_clusters, 0.0);
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
        let mut parts: [Option<Boxes<'_>>; MOST_PARTS] = std::array::from_fn(|_| None);
        let (mut clusters, mut order) = (&mut clusters[..], &mut order[..]);
        let mut next_cluster = 0;
        for (place, share) in parts.iter_mut().zip(&*shares) {
            let (_, rest) = clusters.split_at_mut(share.cluster - next_cluster);
            let (mine, rest) = rest.split_at_mut(share.n_clusters);
            let (segments_of_mine, others) = order.split_at_mut(share.n);
            *place = Some((*share, mine, segments_of_mine));
            (clusters, order) = (rest, others);
            next_cluster = share.cluster + share.n_clusters;
        }
        pool.for_chunks(&mut parts, 1, &|_, part| {
            for (share, clusters, order) in part.iter_mut().flatten() {
                divide(segments, *share, clusters, order);
            }
        });
    }

    /// What `all` boxes amount to, or those in which `segments` are others than they were.
    fn take_up(&mut self, segments: &[Segment], all: bool, pool: &mut Pool) {
        self.find_changed(segments, all);
        let Self { degree, clusters, order, moments, coefficients, cores, narrow, .. } = self;
        let (degree, clusters, changed) = (*degree, &clusters[..], &self.changed[..]);
        let mut parts = parts_of(&self.shares, degree, moments, coefficients, cores, narrow);
        pool.for_chunks(&mut parts, 1, &|_, part| {
            for part in part.iter_mut().flatten() {
                part.take_up(degree, clusters, changed, order, segments);
            }
        });
        let (n, n_values) = (n_moments(degree), n_coefficients(degree));
        for &index in self.tops.iter().rev().filter(|&&index| changed[index]) {
            gather(degree, clusters, index, &mut moments[index * n..]);
            cores[index] = widest(clusters, index, &cores[index..]);
            let coefficients = &mut coefficients[index * n_values..][..n_values];
            let (mine, unit) = (&moments[index * n..][..n], clusters[index].radius);
            velocity_coefficients(degree, mine, unit, coefficients);
        }
    }

    /// On return boxes know which of them hold other segments than they knew of: `all`, where they are new.
    fn find_changed(&mut self, segments: &[Segment], all: bool) {
        let Self { clusters, order, known, changed, .. } = self;
        changed.clear();
        changed.resize(clusters.len(), all);
        if !all {
            for (index, cluster) in clusters.iter().enumerate().rev() {
                changed[index] = if cluster.is_leaf() {
                    let mut mine = cluster.segments(order).iter().map(|&of| of as usize);
                    mine.any(|of| known[of] != segments[of])
                } else {
                    changed[index + 1] || changed[clusters[index + 1].next as usize]
                };
            }
        }
        known.clear();
        known.extend_from_slice(segments);
    }
}

/// Puts the shorter of `segments` first in `order`, then longer ones, then the longest; gives how many each
/// kind has.
fn part_by_length(segments: &[Segment], order: &mut [u32]) -> [usize; N_KINDS] {
    let key = |index: u32| {
        let Segment { from, to, .. } = segments[index as usize];
        (to - from).length_squared()
    };
    let mut kinds = [0; N_KINDS];
    let mut rest = order;
    for kind in &mut kinds[..N_KINDS - 1] {
        *kind = rest.len() - rest.len() / LONG;
        if *kind < rest.len() {
            rest.select_nth_unstable_by(*kind, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        }
        rest = &mut rest[*kind..];
    }
    kinds[N_KINDS - 1] = rest.len();
    kinds
}

/// What threads make of the boxes of `shares`.
fn parts_of<'a>(
    shares: &[Share],
    degree: usize,
    mut moments: &'a mut [Moment],
    mut coefficients: &'a mut [f32],
    mut cores: &'a mut [f64],
    mut narrow: &'a mut [Narrow],
) -> [Option<Part<'a>>; MOST_PARTS] {
    let (n, n_values) = (n_moments(degree), n_coefficients(degree));
    let mut parts: [Option<Part<'_>>; MOST_PARTS] = std::array::from_fn(|_| None);
    let mut next = 0;
    for (part, &share) in parts.iter_mut().zip(shares) {
        let before = share.cluster - next;
        let mine: &mut [Moment];
        (_, moments) = moments.split_at_mut(before * n);
        (mine, moments) = moments.split_at_mut(share.n_clusters * n);
        let values: &mut [f32];
        (_, coefficients) = coefficients.split_at_mut(before * n_values);
        (values, coefficients) = coefficients.split_at_mut(share.n_clusters * n_values);
        let of_boxes: &mut [f64];
        (_, cores) = cores.split_at_mut(before);
        (of_boxes, cores) = cores.split_at_mut(share.n_clusters);
        let of_share: &mut [Narrow];
        (of_share, narrow) = narrow.split_at_mut(share.n);
        *part = Some(Part {
            share,
            moments: mine,
            coefficients: values,
            cores: of_boxes,
            narrow: of_share,
        });
        next = share.cluster + share.n_clusters;
    }
    parts
}

impl Part<'_> {
    /// What its boxes amount to, as far as they have `changed`.
    fn take_up(
        &mut self,
        degree: usize,
        clusters: &[Cluster],
        changed: &[bool],
        order: &[u32],
        segments: &[Segment],
    ) {
        let Self { share, moments, coefficients, cores, narrow } = self;
        let (n, n_values) = (n_moments(degree), n_coefficients(degree));
        // Boxes come before those inside of them.
        for local in (0..share.n_clusters).rev() {
            let index = share.cluster + local;
            if !changed[index] {
                continue;
            }
            let cluster = &clusters[index];
            if cluster.is_leaf() {
                let moments = &mut moments[local * n..][..n];
                moments.fill(NO_MOMENT);
                let mine = cluster.segments(order);
                let narrow = &mut narrow[cluster.first as usize - share.first..][..mine.len()];
                let mut core_squared = 0.0_f64;
                for (narrow, &segment) in narrow.iter_mut().zip(mine) {
                    let segment = &segments[segment as usize];
                    core_squared = core_squared.max(segment.core_squared);
                    *narrow = Narrow::of(segment, cluster.centre);
                    add_segment(degree, cluster, segment, moments);
                }
                cores[local] = core_squared.sqrt();
            } else {
                gather(degree, clusters, index, &mut moments[local * n..]);
                cores[local] = widest(clusters, index, &cores[local..]);
            }
            let coefficients = &mut coefficients[local * n_values..][..n_values];
            velocity_coefficients(degree, &moments[local * n..][..n], cluster.radius, coefficients);
        }
    }
}

impl Cluster {
    /// Its segments in `order`.
    pub(super) fn segments<'a, T>(&self, order: &'a [T]) -> &'a [T] {
        &order[self.first as usize..][..self.n as usize]
    }
}

/// Moments of box number `index` from those of the two inside of it, all of which follow it in `moments`.
fn gather(degree: usize, clusters: &[Cluster], index: usize, moments: &mut [Moment]) {
    let n = n_moments(degree);
    let (mine, inside) = moments.split_at_mut(n);
    mine.fill(NO_MOMENT);
    for child in [index + 1, clusters[index + 1].next as usize] {
        let from = &inside[(child - index - 1) * n..][..n];
        raise(degree, from, clusters[child].centre - clusters[index].centre, mine);
    }
}

/// Gauss's points on [−1, 1] with their weights' halves, as few as a polynomial of `degree` needs.
fn gauss(degree: usize) -> &'static [(f64, f64)] {
    const TWO: f64 = 0.577_350_269_189_625_8;
    const THREE: f64 = 0.774_596_669_241_483_4;
    const FOUR: [(f64, f64); 2] = [
        (0.861_136_311_594_052_6, 0.173_927_422_568_726_9),
        (0.339_981_043_584_856_3, 0.326_072_577_431_273_1),
    ];
    match degree {
        0..=3 => &[(-TWO, 0.5), (TWO, 0.5)],
        4..=5 => &[(-THREE, 5.0 / 18.0), (0.0, 4.0 / 9.0), (THREE, 5.0 / 18.0)],
        _ => &[
            (-FOUR[0].0, FOUR[0].1),
            (-FOUR[1].0, FOUR[1].1),
            (FOUR[1].0, FOUR[1].1),
            (FOUR[0].0, FOUR[0].1),
        ],
    }
}

/// The wider of the cores of the two boxes inside of number `index`, whose own stands first in `cores` (m).
fn widest(clusters: &[Cluster], index: usize, cores: &[f64]) -> f64 {
    cores[1].max(cores[clusters[index + 1].next as usize - index])
}

/// Adds what `segment` amounts to about the centre of `cluster` to its `moments`.
fn add_segment(degree: usize, cluster: &Cluster, segment: &Segment, moments: &mut [Moment]) {
    let along = segment.to - segment.from;
    let middle = 0.5 * (segment.from + segment.to) - cluster.centre;
    let strength = along * (segment.circulation / (4.0 * PI));
    for &(at, weight) in gauss(degree) {
        add_element(degree, strength * weight, middle + along * (0.5 * at), moments);
    }
}
