//! The set of seven directions that carries temperature: rest and the faces of the cube.
//!
//! Populations hold the departure from the reference temperature. Their sum is the temperature; all relax
//! at one rate to an equilibrium with flux u θ and, along each axis, θ (c² + u²), which takes the wind out of
//! the diffusivity along the axes. One rate for all is stable down to no diffusion at all, which other rates
//! of the even moments are not (linear analysis, as in Ginzburg 2005, Adv. Water Resour. 28, 1171).

use crate::lattice::simd::Simd;

/// Populations of a cell (–).
pub(crate) const N_HEAT: usize = 7;

/// Directions, cells per step; the opposite of an odd index is the next one.
pub(crate) const DIRECTIONS: [[i8; 3]; N_HEAT] =
    [[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];

/// Square of the set's speed of sound, in cells² per step².
pub(crate) const SOUND_SQUARED: f32 = 0.25;

/// Temperature of a cell and its flux, one lane per cell.
#[derive(Clone, Copy)]
pub(crate) struct Heat<S> {
    /// Departure from the reference temperature (K).
    pub(crate) temperature: S,
    /// Its flux (K cells per step).
    pub(crate) flux: [S; 3],
}

/// Temperature and flux of `populations`.
#[inline(always)]
pub(crate) fn moments<S: Simd>(g: &[S; N_HEAT]) -> Heat<S> {
    Heat {
        temperature: g[0] + (g[1] + g[2]) + (g[3] + g[4]) + (g[5] + g[6]),
        flux: [g[1] - g[2], g[3] - g[4], g[5] - g[6]],
    }
}

/// Populations in equilibrium at `temperature` in air that moves with `velocity`.
#[inline(always)]
pub(crate) fn equilibrium<S: Simd>(temperature: S, velocity: [S; 3]) -> [S; N_HEAT] {
    let sound = S::splat(SOUND_SQUARED);
    let half = S::splat(0.5) * temperature;
    // No closures: they would not be compiled into the caller's instructions.
    let [ux, uy, uz] = velocity;
    let (jx, jy, jz) = (half * ux, half * uy, half * uz);
    let (sx, sy, sz) =
        (jx.mul_add(ux, half * sound), jy.mul_add(uy, half * sound), jz.mul_add(uz, half * sound));
    let all = sx + sy + sz;
    [temperature - (all + all), sx + jx, sx - jx, sy + jy, sy - jy, sz + jz, sz - jz]
}

/// Populations `g`, of `heat`, after a collision in air that moves with `velocity`: relaxed at `rate`, and
/// `source` (K) added.
#[inline(always)]
pub(crate) fn collide<S: Simd>(
    g: &[S; N_HEAT],
    heat: &Heat<S>,
    velocity: [S; 3],
    rate: S,
    source: S,
) -> [S; N_HEAT] {
    let mut after = equilibrium(heat.temperature, velocity);
    for (after, g) in after.iter_mut().zip(g) {
        *after = rate.mul_add(*after - *g, *g);
    }
    after[0] = after[0] + source;
    after
}
