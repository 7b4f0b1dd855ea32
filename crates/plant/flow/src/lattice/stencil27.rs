//! Rest, faces, edges and corners of the cube: what D3Q19 lacks makes streaks of eddies that the wind carries
//! (docs/validation/flow.md).

#![expect(
    clippy::needless_range_loop,
    reason = "loops over constants, to be unrolled; iterators hide the symmetry"
)]

use super::stencil::{D3Q19, Moments, Stencil, Sums};
use crate::simd::Simd;

/// Rest, faces, edges and corners of the cube.
pub(crate) struct D3Q27;

const fn directions() -> [[i8; 3]; 27] {
    let mut all = [[0; 3]; 27];
    let mut q = 0;
    while q < 19 {
        all[q] = D3Q19::DIRECTIONS[q];
        q += 1;
    }
    let corners = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]];
    let mut corner = 0;
    while corner < 4 {
        let [x, y, z] = corners[corner];
        all[q] = [x, y, z];
        all[q + 1] = [-x, -y, -z];
        q += 2;
        corner += 1;
    }
    all
}

impl Stencil<27> for D3Q27 {
    const DIRECTIONS: [[i8; 3]; 27] = directions();

    #[inline(always)]
    fn sums<S: Simd>(f: &[S; 27]) -> Sums<S> {
        // Corners count as two edges each, in turn: what D3Q19 sums over edges is here summed over edges and
        // corners.
        let (s19, d19) = (f[19] + f[20], f[19] - f[20]);
        let (s21, d21) = (f[21] + f[22], f[21] - f[22]);
        let (s23, d23) = (f[23] + f[24], f[23] - f[24]);
        let (s25, d25) = (f[25] + f[26], f[25] - f[26]);
        let corners = (s19 + s21) + (s23 + s25);
        let (s7, d7) = (f[7] + f[8], f[7] - f[8]);
        let (s9, d9) = (f[9] + f[10], f[9] - f[10]);
        let (s11, d11) = (f[11] + f[12], f[11] - f[12]);
        let (s13, d13) = (f[13] + f[14], f[13] - f[14]);
        let (s15, d15) = (f[15] + f[16], f[15] - f[16]);
        let (s17, d17) = (f[17] + f[18], f[17] - f[18]);
        let (sx, sy, sz) = (f[1] + f[2], f[3] + f[4], f[5] + f[6]);
        let (xy, xz, yz) = (s7 + s9, s11 + s13, s15 + s17);
        let density_excess = f[0] + (sx + sy + sz) + (xy + xz + yz) + corners;
        let jx = (f[1] - f[2]) + (d7 + d9) + (d11 + d13) + (d19 + d21) + (d23 - d25);
        let jy = (f[3] - f[4]) + (d7 - d9) + (d15 + d17) + (d19 + d21) + (d25 - d23);
        let jz = (f[5] - f[6]) + (d11 - d13) + (d15 - d17) + (d19 - d21) + (d23 + d25);
        let third = density_excess * S::splat(1.0 / 3.0);
        Sums {
            density_excess,
            momentum: [jx, jy, jz],
            flux: [
                sx + xy + xz + corners - third,
                sy + xy + yz + corners - third,
                sz + xz + yz + corners - third,
                s7 - s9 + (s19 + s21) - (s23 + s25),
                s11 - s13 + (s19 + s23) - (s21 + s25),
                s15 - s17 + (s19 + s25) - (s21 + s23),
            ],
        }
    }

    #[inline(always)]
    fn populations<S: Simd>(moments: &Moments<S>) -> [S; 27] {
        let mut m = central_moments(moments);
        let [jx, jy, jz] = moments.momentum;
        let [u, v, w] = moments.velocity;
        let n = S::splat;
        // Along x, y and z in turn central moments become raw ones, and these populations. What is left out
        // of moments of even order is their value in air at rest; it is needed where the wind carries it.
        for b in 0..3 {
            for c in 0..3 {
                let m0 = m[0][b][c];
                let m1 = match (b, c) {
                    (0, 0) => jx,
                    (1, 0) | (0, 1) | (2, 1) | (1, 2) => m[1][b][c],
                    (1, 1) => u * m0,
                    _ => u * (m0 + n(rest(b) * rest(c))),
                };
                let m2 = match (b, c) {
                    (1, 0) | (0, 1) | (2, 1) | (1, 2) => u * (m1 + m1),
                    _ => u.mul_add(m1, m[2][b][c]),
                };
                [m[0][b][c], m[1][b][c], m[2][b][c]] = along(m0, m1, m2);
            }
        }
        for c in 0..3 {
            let mut carried = n(0.0);
            for a in [1, 2, 0] {
                let [m0, k1, k2] = [m[a][0][c], m[a][1][c], m[a][2][c]];
                let full = if c == 1 { m0 } else { m0 + n(WEIGHT[a] * rest(c)) };
                // Momentum is kept without a rounding to and fro.
                let m1 = if c == 0 && a == 0 { jy - carried } else { v.mul_add(full, k1) };
                carried = carried + m1;
                let m2 = v.mul_add(k1 + m1, k2);
                [m[a][0][c], m[a][1][c], m[a][2][c]] = along(m0, m1, m2);
            }
        }
        let mut carried = n(0.0);
        for a in [1, 2, 0] {
            for b in [1, 2, 0] {
                let [m0, k1, k2] = m[a][b];
                let full = m0 + n(WEIGHT[a] * WEIGHT[b]);
                let m1 = if a == 0 && b == 0 { jz - carried } else { w.mul_add(full, k1) };
                carried = carried + m1;
                m[a][b] = along(m0, m1, w.mul_add(k1 + m1, k2));
            }
        }
        let mut populations = [n(0.0); 27];
        for q in 0..27 {
            let [x, y, z] = Self::DIRECTIONS[q];
            populations[q] = m[place(x)][place(y)][place(z)];
        }
        populations
    }
}

/// Share of air at rest that does not move along an axis, and that moves forward and backward.
const WEIGHT: [f32; 3] = [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0];

/// Moment of order `order` along an axis of air at rest.
#[inline(always)]
const fn rest(order: usize) -> f32 {
    match order {
        0 => 1.0,
        1 => 0.0,
        _ => 1.0 / 3.0,
    }
}

/// Populations at rest, forward and backward along an axis with these moments: f(±1) = (m2 ± m1)/2, f(0) =
/// m0 − m2.
#[inline(always)]
fn along<S: Simd>(m0: S, m1: S, m2: S) -> [S; 3] {
    let half = S::splat(0.5);
    let common = half * m2;
    [m0 - m2, half.mul_add(m1, common), half.sub_from(m1, common)]
}

/// Where a direction's component stands in an axis' triple: rest, forward, backward.
#[inline(always)]
const fn place(component: i8) -> usize {
    match component {
        0 => 0,
        1 => 1,
        _ => 2,
    }
}

/// Central moments, orders 0 to 2 along each axis, of a Gaussian of these moments, less those of air at rest.
///
/// Cumulants beyond the second vanish, so odd central moments do, and even ones follow from the second
/// (Isserlis). Of the sixth the products of three stresses are left out: a millionth of it.
#[inline(always)]
fn central_moments<S: Simd>(moments: &Moments<S>) -> [[[S; 3]; 3]; 3] {
    let [sxx, syy, szz, sxy, sxz, syz] = moments.stress;
    let excess = moments.density_excess;
    let per_density = moments.per_density;
    let n = S::splat;
    let (third, two, zero) = (n(1.0 / 3.0), n(2.0), n(0.0));
    let (e3, e9) = (excess * third, excess * n(1.0 / 9.0));
    // Products of stresses over density.
    let (txy, txz, tyz) = (sxy * per_density, sxz * per_density, syz * per_density);
    let pxy = (two * txy).mul_add(sxy, sxx * syy * per_density);
    let pxz = (two * txz).mul_add(sxz, sxx * szz * per_density);
    let pyz = (two * tyz).mul_add(syz, syy * szz * per_density);
    let k220 = (sxx + syy).mul_add(third, e9 + pxy);
    let k202 = (sxx + szz).mul_add(third, e9 + pxz);
    let k022 = (syy + szz).mul_add(third, e9 + pyz);
    let k211 = (two * txy).mul_add(sxz, sxx.mul_add(tyz, third * syz));
    let k121 = (two * txy).mul_add(syz, syy.mul_add(txz, third * sxz));
    let k112 = (two * txz).mul_add(syz, szz.mul_add(txy, third * sxy));
    let k222 =
        third.mul_add(pxy + pxz + pyz, (sxx + syy + szz).mul_add(n(1.0 / 9.0), e3 * n(1.0 / 9.0)));
    [
        [[excess, zero, e3 + szz], [zero, syz, zero], [e3 + syy, zero, k022]],
        [[zero, sxz, zero], [sxy, zero, k112], [zero, k121, zero]],
        [[e3 + sxx, zero, k202], [zero, k211, zero], [k220, zero, k222]],
    ]
}
