//! The ground's hold on the wind, from the logarithmic law.
//!
//! The stress at the wall goes with the velocity a little above it: τ = (κ / ln(h/z₀))² |⟨u⟩| u, where ⟨u⟩ is
//! u filtered in time, so that the mean obeys the logarithmic law and the fluctuations go with the wind
//! (Schumann 1975, J. Comput. Phys. 18, 376; Grötzbach 1987, Encyclopedia of Fluid Mechanics 6, 1337; filter
//! in time instead of planes: Yang, Park, Moin 2017, Phys. Rev. Fluids 2, 104601). The stress acts as a force
//! on the lowest cells, above a ground that air slips along; what the ground takes is what the air loses, to
//! rounding.

use super::engine::Rows;
use super::layout::Layout;
use super::probe::RowState;
use super::scaling::Scaling;
use super::settings::{Ground, LatticeSettings};
use super::sweep::Share;

/// Von Kármán's constant (–).
pub const VON_KARMAN: f64 = 0.4;

/// Cell above the ground whose wind sets the stress: the lowest one has no resolved turbulence yet (Kawai,
/// Larsson 2012, Phys. Fluids 24, 015105).
pub(crate) const MATCHING_CELL: usize = 1;

/// The logarithmic law in lattice units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    /// Level of cells that the velocity is taken from.
    level: usize,
    /// (κ / ln(h/z₀))² (–).
    drag: f32,
    /// Weight of a new sample in the filter (–).
    weight: f32,
}

/// One thread's filtered velocities above its rows at the ground: x and y components, `row_stride` values a
/// row.
pub(crate) struct WallMemory {
    pub(crate) filtered: [Vec<f32>; 2],
    state: RowState,
}

impl WallMemory {
    /// Memory of `n_rows` rows; nothing is known yet.
    pub(crate) fn new(layout: &Layout, n_rows: usize) -> Self {
        let column = || vec![f32::NAN; n_rows * layout.row_stride];
        Self { filtered: [column(), column()], state: RowState::new(layout.n_cells[0]) }
    }

    /// Knows nothing, as at first.
    pub(crate) fn forget(&mut self) {
        for column in &mut self.filtered {
            column.fill(f32::NAN);
        }
    }
}

/// ln(z/z₀) at the centre of level `level` (–).
fn logarithm(level: usize, scaling: &Scaling, roughness_length: f64) -> f64 {
    ((level as f64 + 0.5) / scaling.to_lattice_length(roughness_length)).ln()
}

/// Weight of a new sample in the filter of the wind above a ground of `roughness_length` (m), per step.
pub(crate) fn filter_weight(
    settings: &LatticeSettings,
    scaling: &Scaling,
    roughness_length: f64,
) -> f64 {
    let level = MATCHING_CELL.min(settings.n_cells[2] - 1);
    let logarithm = logarithm(level, scaling, roughness_length);
    let friction_velocity = VON_KARMAN * settings.lattice_speed() / logarithm;
    // The eddies at the matching height turn over in h/(κ u*).
    let duration = (level as f64 + 0.5) / (VON_KARMAN * friction_velocity).max(f64::MIN_POSITIVE);
    1.0 / duration.clamp(1.0, 1e6)
}

impl Wall {
    /// The wall that `settings` ask for, if any.
    pub(crate) fn new(settings: &LatticeSettings, scaling: &Scaling) -> Option<Self> {
        let Ground::WallStress { roughness_length } = settings.ground else { return None };
        let level = MATCHING_CELL.min(settings.n_cells[2] - 1);
        let logarithm = logarithm(level, scaling, roughness_length);
        Some(Self {
            level,
            drag: (VON_KARMAN / logarithm).powi(2) as f32,
            weight: filter_weight(settings, scaling, roughness_length) as f32,
        })
    }

    /// Takes the velocities above the ground in; on return `share` holds the force of the wall on its rows at
    /// the ground.
    pub(crate) fn update(
        &self,
        rows: &impl Rows,
        layout: &Layout,
        memory: &mut WallMemory,
        share: &mut Share,
    ) {
        let n_y = layout.n_cells[1];
        let n = layout.n_cells[0];
        let at_ground = share.rows.start.min(n_y)..share.rows.end.min(n_y);
        let [filtered_x, filtered_y] = &mut memory.filtered;
        let [wall_x, wall_y] = &mut share.wall;
        for (index, row) in at_ground.enumerate() {
            rows.read_row(row + self.level * n_y, &mut memory.state);
            let [u, v, _] = &memory.state.velocity;
            let start = index * layout.row_stride;
            for x in 0..n {
                let (fx, fy) = (&mut filtered_x[start + x], &mut filtered_y[start + x]);
                if fx.is_nan() {
                    (*fx, *fy) = (u[x], v[x]);
                } else {
                    *fx += self.weight * (u[x] - *fx);
                    *fy += self.weight * (v[x] - *fy);
                }
                let rate = self.drag * (*fx * *fx + *fy * *fy).sqrt();
                wall_x[start + x] = -rate * u[x];
                wall_y[start + x] = -rate * v[x];
            }
        }
    }
}
