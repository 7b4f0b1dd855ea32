//! What a far box amounts to at places next to each other.

use super::division::Cluster;
use super::narrow::UNIT;
use super::near::dot;
use super::neighbours::{GROUP, Lanes};
use crate::simd::Simd;
use basis::Vector3;

/// Adds what `cluster` with its `coefficients` amounts to at `places` about a centre that lies `way` (m) from
/// its own.
///
/// # Safety
/// On a machine with the instructions of `V`.
#[inline(always)]
pub(super) unsafe fn far<V: Simd, const DEGREE: usize>(
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
/// [`n_coefficients`](super::harmonics::n_coefficients) can be read, on a machine with the instructions
/// of `V`.
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

/// Adds the product of `part`, number `index` of all parts of harmonics, and its three `coefficients` to
/// `sum`.
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
