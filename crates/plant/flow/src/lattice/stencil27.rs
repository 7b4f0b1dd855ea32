//! Rest, faces, edges and corners of the cube: twice the cost of D3Q19, kept to judge it by
//! (docs/validation/flow.md).

#![expect(
    clippy::needless_range_loop,
    reason = "loops over constants, to be unrolled; iterators hide the symmetry"
)]

use super::simd::Simd;
use super::stencil::{D3Q19, Moments, Stencil, Sums};

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
        let mut m = raw_moments(moments);
        // The inverse of the moments, one axis after the other: f(±1) = (m2 ± m1)/2, f(0) = m0 − m2.
        let half = S::splat(0.5);
        for a in 0..3 {
            for b in 0..3 {
                let [m0, m1, m2] = [m[0][a][b], m[1][a][b], m[2][a][b]];
                [m[0][a][b], m[1][a][b], m[2][a][b]] =
                    [m0 - m2, half * (m2 + m1), half * (m2 - m1)];
            }
        }
        for a in 0..3 {
            for b in 0..3 {
                let [m0, m1, m2] = [m[a][0][b], m[a][1][b], m[a][2][b]];
                [m[a][0][b], m[a][1][b], m[a][2][b]] =
                    [m0 - m2, half * (m2 + m1), half * (m2 - m1)];
            }
        }
        for a in 0..3 {
            for b in 0..3 {
                let [m0, m1, m2] = m[a][b];
                m[a][b] = [m0 - m2, half * (m2 + m1), half * (m2 - m1)];
            }
        }
        let mut populations = [S::splat(0.0); 27];
        for q in 0..27 {
            let [x, y, z] = Self::DIRECTIONS[q];
            populations[q] = m[place(x)][place(y)][place(z)];
        }
        populations
    }
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

/// Raw moments, orders 0 to 2 along each axis, of shifted populations with a Gaussian's central moments.
#[inline(always)]
fn raw_moments<S: Simd>(moments: &Moments<S>) -> [[[S; 3]; 3]; 3] {
    // Symbols: k central moments, a to c components of the velocity; cumulants beyond the second vanish, so
    // odd central moments do, and even ones follow from the second (Isserlis).
    let [jx, jy, jz] = moments.momentum;
    let [a, b, c] = moments.velocity;
    let [sxx, syy, szz, sxy, sxz, syz] = moments.stress;
    let excess = moments.density_excess;
    let per_density = moments.per_density;
    let n = S::splat;
    let rho = n(1.0) + excess;
    let third = n(1.0 / 3.0);
    let two = n(2.0);
    let four = n(4.0);
    let k_xx = rho.mul_add(third, sxx);
    let k_yy = rho.mul_add(third, syy);
    let k_zz = rho.mul_add(third, szz);
    let (aa, bb, cc) = (a * a, b * b, c * c);
    let (ab, ac, bc) = (a * b, a * c, b * c);

    let m200 = jx.mul_add(a, excess.mul_add(third, sxx));
    let m020 = jy.mul_add(b, excess.mul_add(third, syy));
    let m002 = jz.mul_add(c, excess.mul_add(third, szz));
    let m110 = jx.mul_add(b, sxy);
    let m101 = jx.mul_add(c, sxz);
    let m011 = jy.mul_add(c, syz);
    let (full_xx, full_yy, full_zz) = (m200 + third, m020 + third, m002 + third);

    let m210 = (two * a).mul_add(sxy, b * full_xx);
    let m201 = (two * a).mul_add(sxz, c * full_xx);
    let m120 = (two * b).mul_add(sxy, a * full_yy);
    let m021 = (two * b).mul_add(syz, c * full_yy);
    let m102 = (two * c).mul_add(sxz, a * full_zz);
    let m012 = (two * c).mul_add(syz, b * full_zz);
    let m111 = a * m011 + b.mul_add(sxz, c * sxy);

    // Fourth central moments; those with even orders less their value in air at rest.
    let ninth = excess * n(1.0 / 9.0);
    let k220 =
        (sxx + syy).mul_add(third, ninth) + (two * sxy).mul_add(sxy, sxx * syy) * per_density;
    let k202 =
        (sxx + szz).mul_add(third, ninth) + (two * sxz).mul_add(sxz, sxx * szz) * per_density;
    let k022 =
        (syy + szz).mul_add(third, ninth) + (two * syz).mul_add(syz, syy * szz) * per_density;
    let k211 = (two * sxy).mul_add(sxz, k_xx * syz) * per_density;
    let k121 = (two * sxy).mul_add(syz, k_yy * sxz) * per_density;
    let k112 = (two * sxz).mul_add(syz, k_zz * sxy) * per_density;
    let m220 = k220 + aa * full_yy + bb * k_xx + four * ab * sxy;
    let m202 = k202 + aa * full_zz + cc * k_xx + four * ac * sxz;
    let m022 = k022 + bb * full_zz + cc * k_yy + four * bc * syz;
    let m211 = k211 + bc * full_xx + two * a * (c * sxy + b * sxz) + aa * syz;
    let m121 = k121 + ac * full_yy + two * b * (c * sxy + a * syz) + bb * sxz;
    let m112 = k112 + ab * full_zz + two * c * (b * sxz + a * syz) + cc * sxy;

    let (full_220, full_202, full_022) =
        (m220 + n(1.0 / 9.0), m202 + n(1.0 / 9.0), m022 + n(1.0 / 9.0));
    let m221 = c * full_220 + two * (b * k211 + a * k121 + a * bb * sxz + b * aa * syz);
    let m212 = b * full_202 + two * (c * k211 + a * k112 + a * cc * sxy + c * aa * syz);
    let m122 = a * full_022 + two * (c * k121 + b * k112 + b * cc * sxy + c * bb * sxz);

    let pairs = sxx * syy + sxx * szz + syy * szz;
    let squares = k_xx * syz * syz + k_yy * sxz * sxz + k_zz * sxy * sxy;
    let k222 = excess * n(1.0 / 27.0)
        + (sxx + syy + szz) * n(1.0 / 9.0)
        + pairs * third * per_density
        + (sxx * syy * szz + two * squares + n(8.0) * sxy * sxz * syz) * per_density * per_density;
    let rest = n(1.0 / 9.0);
    let m222 = k222
        + aa * (k022 + rest)
        + bb * (k202 + rest)
        + cc * (k220 + rest)
        + four * (ab * k112 + ac * k121 + bc * k211)
        + aa * bb * k_zz
        + aa * cc * k_yy
        + bb * cc * k_xx
        + four * (ab * cc * sxy + ac * bb * sxz + bc * aa * syz)
        + rho * aa * bb * cc;

    [
        [[excess, jz, m002], [jy, m011, m012], [m020, m021, m022]],
        [[jx, m101, m102], [m110, m111, m112], [m120, m121, m122]],
        [[m200, m201, m202], [m210, m211, m212], [m220, m221, m222]],
    ]
}
