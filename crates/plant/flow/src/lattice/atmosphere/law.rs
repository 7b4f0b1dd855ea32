//! What acts on a cell of an atmosphere beside its neighbours: rotation, buoyancy, damping, eddies that the
//! grid does not resolve.

use super::coefficients::{Coefficients, Level};
use crate::lattice::collision::{Relaxation, relaxation_rate_of, twice_relaxation_time};
use crate::lattice::fields::{Field, Fields, beyond};
use crate::lattice::stencil::Moments;
use crate::lattice::still::{Air, RowAir};
use crate::simd::Simd;

/// The atmosphere that a step finds.
pub(crate) struct Stratified<'a> {
    pub(super) fields: &'a Fields,
    /// Where the temperature of this step lies.
    pub(super) temperature: Field,
    pub(super) coefficients: &'a Coefficients,
    /// Levels, from the ground up.
    pub(super) levels: &'a [Level],
    /// Whether what leaves a row downstream enters it upstream.
    pub(super) periodic: bool,
}

/// What is the same at all cells of a level.
pub(super) struct Law<S> {
    level: [S; 2],
    turning: [S; 2],
    geostrophic: [S; 2],
    buoyancy: S,
    stability: S,
    eddy_diffusivity: S,
    conductivity: S,
    subgrid: S,
}

/// A row of an atmosphere.
pub(crate) struct StratifiedRow<S> {
    law: Law<S>,
    temperature: *const f32,
    slope: Slope,
    wind: [*mut f32; 3],
    diffusivity: *mut f32,
    /// Viscosity of eddies, where a pass of its own finds it, and diffusivity.
    viscosity: Option<*const f32>,
    n_cells: usize,
    periodic: bool,
    /// Wind along x behind its last cell, where what lies beyond its ends is given: whole vectors of cells
    /// are written, and it may be overwritten with them.
    given: Option<f32>,
}

/// The slope of temperature upwards at a row.
#[derive(Clone, Copy)]
pub(super) struct Slope {
    below: *const f32,
    above: *const f32,
    /// One over the distance between them (per cell).
    per_distance: f32,
}

impl Slope {
    /// That at row (`y`, `z`): between the levels below and above, where there are such.
    #[inline(always)]
    fn new(fields: &Fields, temperature: Field, [y, z]: [usize; 2]) -> Self {
        Self::between(fields, temperature, y, z, [fields.above(z, -1), fields.above(z, 1)])
    }

    /// The same among the cells of the box alone: what is given in the air around is of the last steps.
    pub(super) fn within(fields: &Fields, temperature: Field, [y, z]: [usize; 2]) -> Self {
        let beyond = [z == 0, z + 1 == fields.n_cells[2]];
        let [below, above] = [0, 1].map(|end| match beyond[end] && fields.joined[2][end] {
            true => None,
            false => fields.above(z, 2 * end as isize - 1),
        });
        Self::between(fields, temperature, y, z, [below, above])
    }

    /// That at row (`y`, `z`) between the levels `below` and `above`, where there are such.
    #[inline(always)]
    fn between(
        fields: &Fields,
        temperature: Field,
        y: usize,
        z: usize,
        [below, above]: [Option<usize>; 2],
    ) -> Self {
        let n_steps = usize::from(below.is_some()) + usize::from(above.is_some());
        Self {
            below: fields.row(temperature, y, below.unwrap_or(z)).cast_const(),
            above: fields.row(temperature, y, above.unwrap_or(z)).cast_const(),
            per_distance: 1.0 / n_steps.max(1) as f32,
        }
    }

    /// At the cells from `x` (K per cell).
    ///
    /// # Safety
    /// Whole vectors of a row from `x`, padding included.
    #[inline(always)]
    pub(super) unsafe fn at<S: Simd>(&self, x: usize) -> S {
        // SAFETY: handed through.
        let (below, above) = unsafe { (S::load(self.below.add(x)), S::load(self.above.add(x))) };
        S::splat(self.per_distance) * (above - below)
    }
}

impl Air for Stratified<'_> {
    type Row<S: Simd> = StratifiedRow<S>;

    #[inline(always)]
    fn row<S: Simd>(&self, [y, z]: [usize; 2], subgrid: f32) -> StratifiedRow<S> {
        let fields = self.fields;
        StratifiedRow {
            law: Law::new(self.coefficients, self.levels[z], subgrid),
            temperature: fields.row(self.temperature, y, z).cast_const(),
            slope: Slope::new(fields, self.temperature, [y, z]),
            wind: [
                fields.row(Field::Wind(0), y, z),
                fields.row(Field::Wind(1), y, z),
                fields.row(Field::Wind(2), y, z),
            ],
            diffusivity: fields.row(Field::Diffusivity, y, z),
            viscosity: fields
                .hold(Field::Viscosity)
                .then(|| fields.row(Field::Viscosity, y, z).cast_const()),
            n_cells: fields.n_cells[0],
            periodic: self.periodic,
            // SAFETY: the row's own padding.
            given: (fields.joined[0] != [false; 2])
                .then(|| unsafe { *fields.row(Field::Wind(0), y, z).add(fields.n_cells[0]) }),
        }
    }
}

impl<S: Simd> RowAir<S> for StratifiedRow<S> {
    const PUSHES: bool = true;

    #[inline(always)]
    unsafe fn judge(&self, state: &Moments<S>, time: S, x: usize, force: &[*mut f32; 3]) -> S {
        // SAFETY: rows of the fields and of the force are padded to whole vectors; this row is this thread's.
        unsafe {
            let temperature = S::load(self.temperature.add(x));
            let push = self.law.push(state, temperature);
            let half = S::splat(0.5) * state.per_density;
            for axis in 0..3 {
                let place = force[axis].add(x);
                let force = S::load(place) + push[axis];
                force.store(place);
                half.mul_add(force, state.velocity[axis]).store(self.wind[axis].add(x));
            }
            if let Some(viscosity) = self.viscosity {
                return relaxation_rate_of(S::load(viscosity.add(x)), time);
            }
            let [rate, diffusivity] = self.law.mixing(state, self.slope.at(x), time);
            diffusivity.store(self.diffusivity.add(x));
            rate
        }
    }

    #[inline(always)]
    unsafe fn close(&self) {
        let [u, v, w] = self.wind;
        // SAFETY: the row's own padding.
        unsafe {
            if let Some(given) = self.given {
                *u.add(self.n_cells) = given;
                beyond(self.diffusivity, self.n_cells, 1, false);
                return;
            }
            for row in [u, v, w, self.diffusivity] {
                beyond(row, self.n_cells, 1, self.periodic);
            }
        }
    }
}

impl<S: Simd> Law<S> {
    /// That of a level, under Smagorinsky's factor `subgrid`.
    #[inline(always)]
    pub(super) fn new(coefficients: &Coefficients, level: Level, subgrid: f32) -> Self {
        let Coefficients {
            turning,
            geostrophic,
            buoyancy,
            stability,
            eddy_diffusivity,
            conductivity,
        } = *coefficients;
        Self {
            level: [S::splat(level.mean), S::splat(level.damping)],
            turning: [S::splat(turning[0]), S::splat(turning[1] + level.damping)],
            geostrophic: [S::splat(geostrophic[0]), S::splat(geostrophic[1])],
            buoyancy: S::splat(buoyancy),
            stability: S::splat(stability),
            eddy_diffusivity: S::splat(eddy_diffusivity),
            conductivity: S::splat(conductivity),
            subgrid: S::splat(subgrid),
        }
    }

    /// What rotation, buoyancy and damping do to a cell in `state` and of this `temperature`.
    #[inline(always)]
    fn push(&self, state: &Moments<S>, temperature: S) -> [S; 3] {
        let [jx, jy, jz] = state.momentum;
        let [u, v] = self.geostrophic;
        let [along, across] = self.turning;
        let [mean, damping] = self.level;
        let rho = S::splat(1.0) + state.density_excess;
        let (dx, dy) = (u.sub_from(rho, jx), v.sub_from(rho, jy));
        let zero = S::splat(0.0);
        [
            across.sub_from(dx, along * dy),
            across.sub_from(dy, along.sub_from(dx, zero)),
            damping.sub_from(jz, self.buoyancy * (temperature - mean)),
        ]
    }

    /// Rate at which stress relaxes, and diffusivity of temperature, whose slope upwards is `slope`.
    #[inline(always)]
    pub(super) fn mixing(&self, state: &Moments<S>, slope: S, time: S) -> [S; 2] {
        let relaxation = Relaxation { time, subgrid: self.subgrid };
        let twice = twice_relaxation_time(state, &relaxation);
        let neutral = S::splat(1.0 / 6.0) * (twice - (time + time));
        let squared = self.stability.sub_from(slope, neutral * neutral);
        let viscosity = squared.maximum(S::splat(0.0)).sqrt();
        [
            S::splat(1.0).divide(S::splat(3.0).mul_add(viscosity, time)),
            self.eddy_diffusivity.mul_add(viscosity, self.conductivity),
        ]
    }
}
