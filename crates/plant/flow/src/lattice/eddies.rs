//! The viscosity of unresolved eddies from the wind of neighbours, in a pass of its own after each sweep.
//!
//! The sweep leaves the wind of every cell behind, and finds the viscosity that the pass before it left: that
//! of the step before. Slopes are central differences; at a rough ground those between the lowest cell and
//! the next one; beside walls the wind beyond is what the wall makes of it, mirrored or turned back; at
//! inlet, outlet and open sides it is that of the last cell.
//!
//! # Safety
//! All threads read the wind and the temperature of all rows, and each writes viscosity and diffusivity of
//! its own rows only.

mod models;
mod noted;
mod slopes;

use super::atmosphere::stratification::Warmth;
use super::fields::{Field, Fields, beyond};
use super::settings::{Ends, Ground, LatticeSettings};
use super::subgrid::SubgridModel;
use crate::simd::Simd;
use models::{Heat, Viscosity};
pub(crate) use noted::Noted;
use slopes::Slopes;
use std::ops::Range;

/// What the pass needs to know of the box.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EddyLaw {
    pub(super) model: SubgridModel,
    /// The constant, as the model has it in front.
    pub(super) factor: f32,
    /// Whether the wind's slope at the ground is that between the two lowest cells.
    pub(super) rough: bool,
    /// Whether what leaves a row downstream enters it upstream.
    pub(super) periodic: bool,
}

impl EddyLaw {
    /// That of `settings`, where the model needs the wind of neighbours.
    pub(crate) fn new(settings: &LatticeSettings) -> Option<Self> {
        let subgrid = settings.subgrid;
        subgrid.model.needs_neighbours().then(|| Self {
            model: subgrid.model,
            factor: match subgrid.model {
                SubgridModel::Wale => subgrid.constant * subgrid.constant,
                _ => subgrid.constant,
            } as f32,
            rough: matches!(settings.ground, Ground::WallStress { .. }),
            periodic: settings.ends == Ends::Periodic,
        })
    }
}

/// What all rows of a pass share.
pub(crate) struct Mixing<'a> {
    pub(super) law: EddyLaw,
    pub(super) fields: &'a Fields,
    /// Temperature, where the air has one.
    pub(super) heat: Option<Warmth<'a>>,
}

impl<'a> Mixing<'a> {
    /// Viscosity of eddies on row number `row`, while nobody writes it.
    pub(crate) fn viscosity(&self, row: usize) -> &'a [f32] {
        let n_y = self.fields.n_cells[1];
        self.fields.cells(Field::Viscosity, row % n_y, row / n_y)
    }
}

/// Finds viscosity, and diffusivity where there is temperature, of the cells of the rows of `range`.
///
/// # Safety
/// As the module says; `S`'s instructions are there.
#[inline(always)]
pub(crate) unsafe fn rows<S: Simd>(pass: &Mixing<'_>, range: Range<usize>) {
    let [n, n_y, _] = pass.fields.n_cells;
    for row in range {
        let place = [row % n_y, row / n_y];
        // SAFETY: handed through.
        unsafe { cells::<S>(pass, place, n) };
    }
}

/// The same of the `n` cells of a row.
#[inline(always)]
unsafe fn cells<S: Simd>(pass: &Mixing<'_>, [y, z]: [usize; 2], n: usize) {
    let EddyLaw { model, factor, rough, periodic } = pass.law;
    let fields = pass.fields;
    let slopes = Slopes::new(fields, rough, [y, z]);
    let viscosity = fields.row(Field::Viscosity, y, z);
    let law = Viscosity { model, factor: S::splat(factor) };
    let mut x = 0;
    // SAFETY: rows are padded to whole vectors; what is written behind the last cell is padding.
    unsafe {
        match &pass.heat {
            None => {
                while x < n {
                    law.neutral(&slopes.wind::<S>(x)).store(viscosity.add(x));
                    x += S::LANES;
                }
            }
            Some(warmth) => {
                let diffusivity = fields.row(Field::Diffusivity, y, z);
                let heat = Heat::<S>::new(warmth.coefficients);
                let warm = slopes.of_temperature(fields, warmth, [y, z]);
                while x < n {
                    let [air, warmth] =
                        law.stratified(&slopes.wind::<S>(x), &warm.at::<S>(x), &heat);
                    air.store(viscosity.add(x));
                    warmth.store(diffusivity.add(x));
                    x += S::LANES;
                }
                beyond(diffusivity, n, 1, periodic);
            }
        }
    }
}
