//! What acts on a cell of an atmosphere beside its neighbours: rotation, buoyancy, damping, eddies that the
//! grid does not resolve.

use super::coefficients::{Coefficients, Level};
use super::heat::{self, Heat};
use crate::lattice::collision::{Relaxation, twice_relaxation_time};
use crate::lattice::simd::Simd;
use crate::lattice::stencil::Moments;

/// What is the same at all cells of a level.
pub(crate) struct Law<S> {
    level: [S; 3],
    turning: [S; 2],
    geostrophic: [S; 2],
    buoyancy: S,
    stability: S,
    eddy_diffusivity: S,
    heat_time: S,
    subgrid: S,
    /// What becomes of populations that leave downwards and upwards: a factor, and what is added.
    pub(crate) leaving: [[S; 2]; 2],
}

impl<S: Simd> Law<S> {
    /// That of a level, under Smagorinsky's factor `subgrid`.
    #[inline(always)]
    pub(crate) fn new(coefficients: &Coefficients, level: Level, subgrid: f32) -> Self {
        let Coefficients { turning, geostrophic, buoyancy, stability, eddy_diffusivity, heat_time } =
            *coefficients;
        let [below, above] = level.leaving;
        Self {
            level: [S::splat(level.mean), S::splat(level.damping), S::splat(level.target)],
            turning: [S::splat(turning[0]), S::splat(turning[1] + level.damping)],
            geostrophic: [S::splat(geostrophic[0]), S::splat(geostrophic[1])],
            buoyancy: S::splat(buoyancy),
            stability: S::splat(stability),
            eddy_diffusivity: S::splat(eddy_diffusivity),
            heat_time: S::splat(heat_time),
            subgrid: S::splat(subgrid),
            leaving: [
                [S::splat(below[0]), S::splat(below[1])],
                [S::splat(above[0]), S::splat(above[1])],
            ],
        }
    }

    /// What rotation, buoyancy and damping do to a cell in `state` and of this `temperature`.
    #[inline(always)]
    pub(crate) fn force(&self, state: &Moments<S>, temperature: S) -> [S; 3] {
        let [jx, jy, jz] = state.momentum;
        let [u, v] = self.geostrophic;
        let [along, across] = self.turning;
        let [mean, damping, _] = self.level;
        let rho = S::splat(1.0) + state.density_excess;
        let (dx, dy) = (u.sub_from(rho, jx), v.sub_from(rho, jy));
        let zero = S::splat(0.0);
        [
            across.sub_from(dx, along * dy),
            across.sub_from(dy, along.sub_from(dx, zero)),
            damping.sub_from(jz, self.buoyancy * (temperature - mean)),
        ]
    }

    /// Rates at which stress and flux of temperature relax; `w` is the vertical velocity.
    #[inline(always)]
    pub(crate) fn rates(&self, state: &Moments<S>, heat: &Heat<S>, w: S, time: S) -> [S; 2] {
        let relaxation = Relaxation { time, subgrid: self.subgrid };
        let twice = twice_relaxation_time(state, &relaxation);
        let neutral = S::splat(1.0 / 6.0) * (twice - (time + time));
        // The slope of temperature from its flux: jz - w theta = -tau c² slope, 1/tau to second order.
        let conduction = heat.flux[2] - w * heat.temperature;
        let rate = (self.eddy_diffusivity * neutral).sub_from(S::splat(4.0), S::splat(2.0));
        let slope = S::splat(-1.0 / heat::SOUND_SQUARED) * (rate * conduction);
        let squared = self.stability.sub_from(slope, neutral * neutral);
        let viscosity = squared.maximum(S::splat(0.0)).sqrt();
        let one = S::splat(1.0);
        [
            one.divide(S::splat(3.0).mul_add(viscosity, time)),
            // Heat without the correction: nothing else takes the noise out that stirring leaves in
            // stable air.
            one.divide(self.eddy_diffusivity.mul_add(neutral.maximum(viscosity), self.heat_time)),
        ]
    }

    /// What damping adds to `temperature`.
    #[inline(always)]
    pub(crate) fn warming(&self, temperature: S) -> S {
        let [_, damping, target] = self.level;
        damping * (target - temperature)
    }
}
