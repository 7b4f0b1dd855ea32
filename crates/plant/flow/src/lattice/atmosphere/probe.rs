//! Reading wind, temperature and the fluxes that the grid does not resolve out of a row.

use super::stratification::Stratification;
use crate::lattice::collision::relaxation_rate_of;
use crate::lattice::fields::Field;
use crate::lattice::layout::read_direction;
use crate::lattice::probe::View;
use crate::lattice::stencil::Stencil;
use crate::simd::{MAXIMUM_LANES, Portable, Simd};

/// State of a row of cells, in lattice units but for kelvin; padded to whole vectors.
#[derive(Clone, Debug)]
pub struct AirRow {
    /// Velocity, forces aside.
    pub velocity: [Vec<f32>; 3],
    /// Potential temperature above the reference (K).
    pub temperature: Vec<f32>,
    /// Flux of x and y momentum upwards that the grid does not resolve, over density.
    pub stress: [Vec<f32>; 2],
    /// Flux of temperature upwards that it does not resolve.
    pub heat_flux: Vec<f32>,
}

impl AirRow {
    /// Room for a row of `n_cells`.
    pub fn new(n_cells: usize) -> Self {
        let column = || vec![0.0; n_cells.next_multiple_of(MAXIMUM_LANES)];
        Self {
            velocity: [column(), column(), column()],
            temperature: column(),
            stress: [column(), column()],
            heat_flux: column(),
        }
    }
}

/// On return `state` holds that of row number `row` after `n_steps` steps; no sweep is running.
pub(crate) fn read_row<L: Stencil<Q>, const Q: usize>(
    view: &View<'_>,
    air: &Stratification,
    (times, subgrid): (&[f32], f32),
    n_steps: u64,
    row: usize,
    state: &mut AirRow,
) {
    let [y, z] = view.layout.place(row);
    let addresses: [usize; Q] = view.layout.addresses(view.parity, y, z);
    let (law, slope) = air.law::<Portable>(n_steps, [y, z], subgrid);
    let told = |field| air.fields.row(field, y, z).cast_const();
    let of_eddies = air
        .fields
        .hold(Field::Viscosity)
        .then(|| [told(Field::Viscosity), told(Field::Diffusivity)]);
    let one = Portable::splat(1.0);
    let half = Portable::splat(0.5);
    state.temperature[..view.layout.n_cells[0]].copy_from_slice(air.temperature(n_steps, row));
    let mut x = 0;
    while x < view.layout.n_cells[0] {
        // SAFETY: rows and buffers are padded to whole vectors.
        unsafe {
            let mut f = [Portable::splat(0.0); Q];
            for slot in 0..Q {
                f[read_direction(view.parity, slot)] =
                    Portable::load(view.air.add(addresses[slot] + x));
            }
            let moments = L::moments(&f);
            let time = Portable::load(times.as_ptr().add(x));
            let slope = slope.at::<Portable>(x);
            let [rate, diffusivity] = match of_eddies {
                Some([viscosity, diffusivity]) => [
                    relaxation_rate_of(Portable::load(viscosity.add(x)), time),
                    Portable::load(diffusivity.add(x)),
                ],
                None => law.mixing(&moments, slope, time),
            };
            let kept = half.sub_from(rate, one) * moments.per_density;
            for (component, column) in moments.velocity.iter().zip(&mut state.velocity) {
                component.store(column.as_mut_ptr().add(x));
            }
            let [_, _, _, _, xz, yz] = moments.stress;
            (kept * xz).store(state.stress[0].as_mut_ptr().add(x));
            (kept * yz).store(state.stress[1].as_mut_ptr().add(x));
            let conducted = diffusivity.sub_from(slope, Portable::splat(0.0));
            conducted.store(state.heat_flux.as_mut_ptr().add(x));
        }
        x += Portable::LANES;
    }
}
