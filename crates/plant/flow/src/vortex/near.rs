//! What near segments induce at places next to each other, one by one.

use super::narrow::{Narrow, UNIT};
use super::neighbours::{GROUP, Lanes};
use super::segment::BEYOND;
use crate::simd::Simd;
use basis::Vector3;

/// Adds what `segments` of a box induce at `places` about a centre that lies `way` (m) from its own, one by
/// one: [`Segment::per_circulation`](super::Segment::per_circulation), with two inverse roots, each to
/// four digits.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
pub(super) unsafe fn near<V: Simd>(
    segments: &[Narrow],
    way: Vector3,
    places: &Lanes,
    sums: &mut Lanes,
) {
    let way = (way * (1.0 / UNIT)).to_array().map(|value| V::splat(value as f32));
    let (zero, one, two, tiny) = (V::splat(0.0), V::splat(1.0), V::splat(2.0), V::splat(1e-37));
    for lane in (0..GROUP).step_by(V::LANES) {
        // SAFETY: places and sums have as many values as a group, a multiple of the lanes.
        let (at, mut sum): ([V; 3], [V; 3]) = unsafe {
            (
                std::array::from_fn(|a| V::load(places[a].as_ptr().add(lane)) + way[a]),
                std::array::from_fn(|a| V::load(sums[a].as_ptr().add(lane))),
            )
        };
        for segment in segments {
            let (along, length) = (segment.along.map(V::splat), V::splat(segment.length));
            let r1: [V; 3] = std::array::from_fn(|a| at[a] - V::splat(segment.from[a]));
            let r2: [V; 3] = std::array::from_fn(|a| along[a].sub_from(length, r1[a]));
            // The way e along the line, d = r₁·r₂, and c = t × r₁, t being along the segment.
            let (q1, q2, e) = (dot(&r1, &r1), dot(&r2, &r2), dot(&r1, &along));
            let d = length.sub_from(e, q1);
            let c = cross(&along, &r1);
            let exact = q1 * q2;
            let product = exact + V::splat(segment.floor);
            let inverse = product.rough_inverse_sqrt();
            let p = product * inverse;
            // None of it where the place is an end but for rounding, as in `per_circulation`.
            let share = exact * inverse * inverse;
            // As little of it where the place is on the line but for rounding.
            let off = dot(&c, &c);
            let missing = off.sub_from(V::splat(segment.grain), one).maximum(zero);
            let share = missing.sub_from(share, share);
            // h², with what is added beyond the ends.
            let beyond = (e * (e - length)).maximum(zero);
            let reach = beyond.mul_add(V::splat(BEYOND as f32), off);
            // s = p + |d|; (p − d)/c² is 1/s ahead of both ends, and s/c² between them.
            let s = p + d.maximum(zero - d);
            let difference = d.where_negative(s * s * V::splat(segment.inverse_squared), reach);
            // (r₁ + r₂)² = q₁ + q₂ + 2p; its root over s √(h⁴ + r⁴) is itself by one inverse root.
            let ends = p.mul_add(two, q1 + q2);
            let around = reach.mul_add(reach, V::splat(segment.core));
            let root = (ends * around * s).mul_add(s, tiny).rough_inverse_sqrt();
            let weight = V::splat(segment.strength) * share * inverse * difference * (ends * root);
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
pub(super) fn dot<V: Simd>(a: &[V; 3], b: &[V; 3]) -> V {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

#[inline(always)]
fn cross<V: Simd>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    let part = |j: usize, k: usize| b[j].sub_from(a[k], a[j] * b[k]);
    [part(1, 2), part(2, 0), part(0, 1)]
}
