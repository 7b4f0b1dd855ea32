//! What happens in a cell during a step: the whole physics of the bulk.
//!
//! Second central moments relax with the viscosity of air plus that of Smagorinsky's model; their trace is
//! set to equilibrium, third central moments to zero and higher ones to those of a Gaussian. All that is kept
//! of the old populations are density, velocity and stress, which is what makes the scheme stable at the
//! viscosity of real air (regularisation in the moving frame: Geier, Greiner, Korvink 2006, Phys. Rev. E 73,
//! 066705; De Rosis, Huang, Coreixas 2019, Phys. Fluids 31, 117102; cumulants: Geier, Schönherr, Pasquali,
//! Krafczyk 2015, Comput. Math. Appl. 70, 507).

use super::stencil::Moments;
use crate::simd::Simd;

/// What a collision needs to know beside the cell's own state, in lattice units.
#[derive(Clone, Copy)]
pub(crate) struct Relaxation<S> {
    /// Relaxation time of the air's own viscosity, 1/2 + 3 ν.
    pub(crate) time: S,
    /// Smagorinsky's model: 18 √2 C².
    pub(crate) subgrid: S,
}

/// 18 √2: Smagorinsky's closed form for the relaxation time, Hou, Sterling, Chen, Doolen (1996), Fields Inst.
/// Comm. 6, 151.
pub(crate) const SUBGRID_FACTOR: f64 = 25.455_844_122_715_71;

/// Rate at which the stress of a cell in state `before` relaxes.
#[inline(always)]
pub(crate) fn relaxation_rate<S: Simd>(before: &Moments<S>, relaxation: &Relaxation<S>) -> S {
    S::splat(2.0).divide(twice_relaxation_time(before, relaxation))
}

/// Rate at which stress relaxes with this `viscosity` of eddies and `time` for the air's own.
#[inline(always)]
pub(crate) fn relaxation_rate_of<S: Simd>(viscosity: S, time: S) -> S {
    S::splat(1.0).divide(S::splat(3.0).mul_add(viscosity, time))
}

/// Twice the time over which the stress of a cell in state `before` relaxes, in steps.
#[inline(always)]
pub(crate) fn twice_relaxation_time<S: Simd>(before: &Moments<S>, relaxation: &Relaxation<S>) -> S {
    // Symbols: s stress, t a third of its trace, d its deviator, q the deviator's norm, tau relaxation time.
    let [sxx, syy, szz, sxy, sxz, syz] = before.stress;
    let two = S::splat(2.0);
    let t = (sxx + syy + szz) * S::splat(1.0 / 3.0);
    let (dxx, dyy, dzz) = (sxx - t, syy - t, szz - t);
    let shear = sxy.mul_add(sxy, sxz.mul_add(sxz, syz * syz));
    let q = two.mul_add(shear, dxx.mul_add(dxx, dyy.mul_add(dyy, dzz * dzz))).sqrt();
    let squared =
        (q * before.per_density).mul_add(relaxation.subgrid, relaxation.time * relaxation.time);
    // tau = (tau0 + sqrt(tau0² + 18 √2 C² q/rho))/2.
    relaxation.time + squared.sqrt()
}

/// State after the collision of a cell in state `before`, its stress relaxed at `rate`, under `force`
/// (density per step).
///
/// The force shifts the velocity that the outgoing populations are built around by F/ρ (exact difference:
/// Kupershtokh, Medvedev, Karpov 2009, Comput. Math. Appl. 58, 965); the physical velocity lies half-way.
#[inline(always)]
pub(crate) fn collide<S: Simd>(before: &Moments<S>, rate: S, force: Option<[S; 3]>) -> Moments<S> {
    // Symbols as above; h what each axis lacks.
    let [sxx, syy, szz, sxy, sxz, syz] = before.stress;
    let [ux, uy, uz] = before.velocity;
    let third = S::splat(1.0 / 3.0);
    let per_density = before.per_density;
    let t = (sxx + syy + szz) * third;
    let (dxx, dyy, dzz) = (sxx - t, syy - t, szz - t);
    let kept = S::splat(1.0) - rate;

    // The lattice cannot tell c³ from c: without these terms the viscosity of normal strains would depend on
    // the speed of the grid through the air (Geier et al. 2015, eqs. 43-48, with bulk rate one).
    let hx = ux * ux * rate.mul_add(dxx, t);
    let hy = uy * uy * rate.mul_add(dyy, t);
    let hz = uz * uz * rate.mul_add(dzz, t);
    let trace = (hx + hy + hz) * third;
    let gain = rate.sub_from(S::splat(2.25), S::splat(4.5));
    let bulk = S::splat(2.25) * trace;

    let (momentum, velocity) = match force {
        Some([fx, fy, fz]) => {
            let [jx, jy, jz] = before.momentum;
            let [jx, jy, jz] = [jx + fx, jy + fy, jz + fz];
            ([jx, jy, jz], [jx * per_density, jy * per_density, jz * per_density])
        }
        None => (before.momentum, before.velocity),
    };
    Moments {
        density_excess: before.density_excess,
        per_density,
        momentum,
        velocity,
        stress: [
            kept.mul_add(dxx, gain.mul_add(hx - trace, bulk)),
            kept.mul_add(dyy, gain.mul_add(hy - trace, bulk)),
            kept.mul_add(dzz, gain.mul_add(hz - trace, bulk)),
            kept * sxy,
            kept * sxz,
            kept * syz,
        ],
    }
}
