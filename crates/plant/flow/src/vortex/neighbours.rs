//! Places in an order in which those next to each other are near each other.

use crate::pool::Pool;
use crate::simd::MAXIMUM_LANES;
use basis::Vector3;

/// Places that go through the boxes together (–).
pub(super) const GROUP: usize = MAXIMUM_LANES;
/// Three components at each place of a group.
pub(super) type Lanes = [[f32; GROUP]; 3];

/// Divisions after which what is left is shared among threads (–), and how many shares that makes.
const SHARED_AFTER: u32 = 4;
const MOST_SHARES: usize = 1 << SHARED_AFTER;

/// Places sorted so that each [`GROUP`] of them, from the first on, stands close together.
#[derive(Clone, Debug, Default)]
pub(super) struct Neighbours {
    order: Vec<u32>,
    sorted: Vec<Vector3>,
}

impl Neighbours {
    /// Memory for `most` places.
    pub(super) fn with_capacity(most: usize) -> Self {
        Self { order: Vec::with_capacity(most), sorted: Vec::with_capacity(most) }
    }

    /// Sorts `places` (m).
    pub(super) fn sort(&mut self, places: &[Vector3], pool: &mut Pool) {
        let Self { order, sorted } = self;
        order.clear();
        order.extend(0..places.len() as u32);
        let mut shares: [&mut [u32]; MOST_SHARES] = std::array::from_fn(|_| &mut [][..]);
        share(places, order, SHARED_AFTER, &mut shares);
        pool.for_chunks(&mut shares, 1, &|_, share| {
            share.iter_mut().for_each(|order| divide(places, order));
        });
        sorted.clear();
        sorted.extend(order.iter().map(|&index| places[index as usize]));
    }

    /// The places (m) in their order.
    pub(super) fn sorted(&self) -> &[Vector3] {
        &self.sorted
    }

    /// On return `values` are, each at its place's own number, what `sorted` has in the order of places.
    pub(super) fn to_own_order(&self, sorted: &[Vector3], values: &mut [Vector3]) {
        for (&index, value) in self.order.iter().zip(sorted) {
            values[index as usize] = *value;
        }
    }
}

/// Divides `order` into halves, `depth` times; the parts go into `shares`.
fn share<'a>(places: &[Vector3], order: &'a mut [u32], depth: u32, shares: &mut [&'a mut [u32]]) {
    if depth == 0 {
        shares[0] = order;
        return;
    }
    let (low, high) = halves(places, order);
    let (of_low, of_high) = shares.split_at_mut(1 << (depth - 1));
    share(places, low, depth - 1, of_low);
    share(places, high, depth - 1, of_high);
}

fn divide(places: &[Vector3], order: &mut [u32]) {
    if order.len() > GROUP {
        let (low, high) = halves(places, order);
        divide(places, low);
        divide(places, high);
    }
}

/// Those of `order` whose places lie lower along the longest edge of the box around all, whole groups of
/// them, and the others.
fn halves<'a>(places: &[Vector3], order: &'a mut [u32]) -> (&'a mut [u32], &'a mut [u32]) {
    let middle = order.len().div_ceil(GROUP) / 2 * GROUP;
    if middle == 0 {
        return order.split_at_mut(0);
    }
    let (mut low, mut high) = (Vector3::INFINITY, Vector3::NEG_INFINITY);
    for &index in &*order {
        low = low.min(places[index as usize]);
        high = high.max(places[index as usize]);
    }
    let edges = high - low;
    let axis = (0..3).max_by(|&a, &b| edges[a].total_cmp(&edges[b])).unwrap_or(0);
    let key = |index: u32| places[index as usize][axis];
    order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    order.split_at_mut(middle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_hold_neighbours_and_every_place_once() {
        // A cube of points, told in an order that runs through it back and forth.
        const N: usize = 12;
        let place = |index: usize| {
            let shuffled = index * 577 % N.pow(3);
            Vector3::new(
                (shuffled / (N * N)) as f64,
                (shuffled / N % N) as f64,
                (shuffled % N) as f64,
            )
        };
        for n in [0, 1, GROUP, GROUP + 1, 5 * GROUP - 3, N.pow(3)] {
            let places: Vec<Vector3> = (0..n).map(place).collect();
            let mut neighbours = Neighbours::default();
            neighbours.sort(&places, &mut Pool::new(2));
            let mut back = vec![Vector3::NAN; n];
            neighbours.to_own_order(neighbours.sorted(), &mut back);
            assert_eq!(back, places);
            let widest = neighbours
                .sorted()
                .chunks(GROUP)
                .map(|group| {
                    let high = group.iter().copied().fold(Vector3::NEG_INFINITY, Vector3::max);
                    let low = group.iter().copied().fold(Vector3::INFINITY, Vector3::min);
                    (high - low).max_element()
                })
                .fold(0.0, f64::max);
            // Sixteen of a cube's points lie in a box of 2 x 2 x 4 of them, some cuts aside.
            assert!(n < N.pow(3) || widest <= 4.0, "{widest}");
        }
    }
}
