//! What a velocity set must bring along: its directions, its moments and their exact inverse.

use crate::simd::Simd;

/// Local state of the air in lattice units, one lane per cell.
#[derive(Clone, Copy)]
pub(crate) struct Moments<S> {
    /// Density less one.
    pub(crate) density_excess: S,
    /// One over density.
    pub(crate) per_density: S,
    /// Momentum per cell: kept beside the velocity so that a collision conserves it without a rounding to and
    /// fro.
    pub(crate) momentum: [S; 3],
    /// Momentum over density.
    pub(crate) velocity: [S; 3],
    /// Second central moments less those of equilibrium: xx, yy, zz, xy, xz, yz.
    pub(crate) stress: [S; 6],
}

impl<S: Simd> Moments<S> {
    /// Air of this density excess, velocity and stress.
    #[inline(always)]
    pub(crate) fn new(density_excess: S, velocity: [S; 3], stress: [S; 6]) -> Self {
        let rho = S::splat(1.0) + density_excess;
        let [ux, uy, uz] = velocity;
        let per_density = S::splat(1.0).divide(rho);
        Self {
            density_excess,
            per_density,
            momentum: [rho * ux, rho * uy, rho * uz],
            velocity,
            stress,
        }
    }
}

/// What populations add up to: all that a collision keeps of them.
#[derive(Clone, Copy)]
pub(crate) struct Sums<S> {
    /// Density less one.
    pub(crate) density_excess: S,
    /// Momentum per cell.
    pub(crate) momentum: [S; 3],
    /// Second raw moments less those of air of this density at rest: xx, yy, zz, xy, xz, yz.
    pub(crate) flux: [S; 6],
}

impl<S: Simd> Sums<S> {
    /// One over density.
    #[inline(always)]
    pub(crate) fn per_density(&self) -> S {
        S::splat(1.0).divide(S::splat(1.0) + self.density_excess)
    }

    /// The state of the air, given one over its density.
    #[inline(always)]
    pub(crate) fn moments(&self, per_density: S) -> Moments<S> {
        let [jx, jy, jz] = self.momentum;
        let [xx, yy, zz, xy, xz, yz] = self.flux;
        let (ux, uy, uz) = (jx * per_density, jy * per_density, jz * per_density);
        Moments {
            density_excess: self.density_excess,
            per_density,
            momentum: self.momentum,
            velocity: [ux, uy, uz],
            stress: [
                jx.sub_from(ux, xx),
                jy.sub_from(uy, yy),
                jz.sub_from(uz, zz),
                jx.sub_from(uy, xy),
                jx.sub_from(uz, xz),
                jy.sub_from(uz, yz),
            ],
        }
    }
}

/// A velocity set of `Q` directions.
///
/// Populations are shifted: slot q holds f_q − w_q, which keeps seven digits for the departure from air at
/// rest.
pub(crate) trait Stencil<const Q: usize> {
    /// Directions, cells per step; the opposite of an odd index is the next one.
    const DIRECTIONS: [[i8; 3]; Q];

    /// What shifted populations add up to.
    fn sums<S: Simd>(populations: &[S; Q]) -> Sums<S>;

    /// Density, velocity and stress of shifted populations.
    #[inline(always)]
    fn moments<S: Simd>(populations: &[S; Q]) -> Moments<S> {
        let sums = Self::sums(populations);
        sums.moments(sums.per_density())
    }

    /// Shifted populations with these moments, third central moments zero and higher ones those of a
    /// Gaussian.
    fn populations<S: Simd>(moments: &Moments<S>) -> [S; Q];
}

/// Index of the direction against direction `q`.
pub(crate) const fn opposite(q: usize) -> usize {
    if q == 0 {
        0
    } else if q % 2 == 1 {
        q + 1
    } else {
        q - 1
    }
}

/// Rest, faces and edges of the cube.
pub(crate) struct D3Q19;

impl Stencil<19> for D3Q19 {
    const DIRECTIONS: [[i8; 3]; 19] = [
        [0, 0, 0],
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
        [1, 1, 0],
        [-1, -1, 0],
        [1, -1, 0],
        [-1, 1, 0],
        [1, 0, 1],
        [-1, 0, -1],
        [1, 0, -1],
        [-1, 0, 1],
        [0, 1, 1],
        [0, -1, -1],
        [0, 1, -1],
        [0, -1, 1],
    ];

    #[inline(always)]
    fn sums<S: Simd>(f: &[S; 19]) -> Sums<S> {
        // Symbols: s and d are sums and differences of opposite populations; the rest as in `Moments`.
        let (sx, dx) = (f[1] + f[2], f[1] - f[2]);
        let (sy, dy) = (f[3] + f[4], f[3] - f[4]);
        let (sz, dz) = (f[5] + f[6], f[5] - f[6]);
        let (s7, d7) = (f[7] + f[8], f[7] - f[8]);
        let (s9, d9) = (f[9] + f[10], f[9] - f[10]);
        let (s11, d11) = (f[11] + f[12], f[11] - f[12]);
        let (s13, d13) = (f[13] + f[14], f[13] - f[14]);
        let (s15, d15) = (f[15] + f[16], f[15] - f[16]);
        let (s17, d17) = (f[17] + f[18], f[17] - f[18]);
        let (xy, xz, yz) = (s7 + s9, s11 + s13, s15 + s17);
        let density_excess = f[0] + (sx + sy + sz) + (xy + xz + yz);
        let jx = dx + (d7 + d9) + (d11 + d13);
        let jy = dy + (d7 - d9) + (d15 + d17);
        let jz = dz + (d11 - d13) + (d15 - d17);
        let third = density_excess * S::splat(1.0 / 3.0);
        Sums {
            density_excess,
            momentum: [jx, jy, jz],
            flux: [
                sx + xy + xz - third,
                sy + xy + yz - third,
                sz + xz + yz - third,
                s7 - s9,
                s11 - s13,
                s15 - s17,
            ],
        }
    }

    #[inline(always)]
    fn populations<S: Simd>(moments: &Moments<S>) -> [S; 19] {
        // Symbols: m_ab.. raw moments of the shifted populations, k_aa central ones; see docs of the
        // collision.
        let [jx, jy, jz] = moments.momentum;
        let [ux, uy, uz] = moments.velocity;
        let [sxx, syy, szz, sxy, sxz, syz] = moments.stress;
        let excess = moments.density_excess;
        let one_third = S::splat(1.0 / 3.0);
        let half = S::splat(0.5);
        let quarter = S::splat(0.25);
        let two = S::splat(2.0);
        let rho = S::splat(1.0) + excess;
        let per_density = moments.per_density;
        let third = excess * one_third;
        // Second raw moments, and second central ones with the background of air at rest.
        let m_xx = jx.mul_add(ux, third + sxx);
        let m_yy = jy.mul_add(uy, third + syy);
        let m_zz = jz.mul_add(uz, third + szz);
        let m_xy = jx.mul_add(uy, sxy);
        let m_xz = jx.mul_add(uz, sxz);
        let m_yz = jy.mul_add(uz, syz);
        let (full_xx, full_yy, full_zz) = (m_xx + one_third, m_yy + one_third, m_zz + one_third);
        // Third raw moments from vanishing third central moments: m_aab = 2 u_a k_ab + u_b m_aa.
        let (u2x, u2y, u2z) = (two * ux, two * uy, two * uz);
        let m_xxy = u2x.mul_add(sxy, uy * full_xx);
        let m_xxz = u2x.mul_add(sxz, uz * full_xx);
        let m_xyy = u2y.mul_add(sxy, ux * full_yy);
        let m_yyz = u2y.mul_add(syz, uz * full_yy);
        let m_xzz = u2z.mul_add(sxz, ux * full_zz);
        let m_yzz = u2z.mul_add(syz, uy * full_zz);
        // Fourth: k_aabb = (k_aa k_bb + 2 k_ab²)/rho, then m_aabb = k_aabb + u_a² m_bb + u_b² k_aa + 4 u_a
        // u_b k_ab.
        let ninth = third * one_third;
        let (k_xx, k_yy) = (rho.mul_add(one_third, sxx), rho.mul_add(one_third, syy));
        let product_xy = (two * sxy).mul_add(sxy, sxx * syy) * per_density;
        let product_xz = (two * sxz).mul_add(sxz, sxx * szz) * per_density;
        let product_yz = (two * syz).mul_add(syz, syy * szz) * per_density;
        let (uxx, uyy, uzz) = (ux * ux, uy * uy, uz * uz);
        let base_xy = (sxx + syy).mul_add(one_third, ninth + product_xy);
        let base_xz = (sxx + szz).mul_add(one_third, ninth + product_xz);
        let base_yz = (syy + szz).mul_add(one_third, ninth + product_yz);
        let m_xxyy = uxx.mul_add(full_yy, uyy.mul_add(k_xx, (u2x * u2y).mul_add(sxy, base_xy)));
        let m_xxzz = uxx.mul_add(full_zz, uzz.mul_add(k_xx, (u2x * u2z).mul_add(sxz, base_xz)));
        let m_yyzz = uyy.mul_add(full_zz, uzz.mul_add(k_yy, (u2y * u2z).mul_add(syz, base_yz)));
        // The inverse of the moments: edges first, faces and rest from what the edges leave.
        let [f7, f8] = pair(quarter, m_xxyy + m_xy, m_xyy + m_xxy);
        let [f9, f10] = pair(quarter, m_xxyy - m_xy, m_xyy - m_xxy);
        let [f11, f12] = pair(quarter, m_xxzz + m_xz, m_xzz + m_xxz);
        let [f13, f14] = pair(quarter, m_xxzz - m_xz, m_xzz - m_xxz);
        let [f15, f16] = pair(quarter, m_yyzz + m_yz, m_yzz + m_yyz);
        let [f17, f18] = pair(quarter, m_yyzz - m_yz, m_yzz - m_yyz);
        let [f1, f2] = pair(half, m_xx - m_xxyy - m_xxzz, jx - m_xyy - m_xzz);
        let [f3, f4] = pair(half, m_yy - m_xxyy - m_yyzz, jy - m_xxy - m_yzz);
        let [f5, f6] = pair(half, m_zz - m_xxzz - m_yyzz, jz - m_xxz - m_yyz);
        let rest = excess - (m_xx + m_yy + m_zz) + (m_xxyy + m_xxzz + m_yyzz);
        [rest, f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12, f13, f14, f15, f16, f17, f18]
    }
}

/// Populations along a direction and against it from what they have in common and what they differ by.
#[inline(always)]
fn pair<S: Simd>(share: S, even: S, odd: S) -> [S; 2] {
    let common = share * even;
    [share.mul_add(odd, common), share.sub_from(odd, common)]
}
