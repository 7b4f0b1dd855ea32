//! What a rough ground takes from the wind and gives to the air, in stratified air.
//!
//! Stress and heat flux follow from wind and temperature a little above the ground, filtered in time, by
//! [similarity](super::similarity); they act on the lowest cells, as in [`wall`](crate::lattice::wall).

use super::settings::{Atmosphere, Heating};
use super::similarity::{Place, Similarity};
use super::stratification::{HeatShare, Stratification};
use crate::lattice::engine::Rows;
use crate::lattice::layout::LINE;
use crate::lattice::probe::RowState;
use crate::lattice::scaling::Scaling;
use crate::lattice::settings::{Ground, LatticeSettings};
use crate::lattice::sweep::Share;
use crate::lattice::values::{read_values, write_values};
use crate::lattice::wall::{MATCHING_CELL, VON_KARMAN, filter_weight};
use basis::Vector3;
use std::io::{Read, Result, Write};
use std::ops::Range;

/// Steps after which stability is found anew: the wind is filtered over far more.
const STRIDE: u64 = 8;

/// The law of the ground, in lattice units but for kelvin.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    similarity: Similarity,
    place: Place,
    heating: Heating,
    /// Departure of the ground's temperature at the start from the reference (K).
    departure: f64,
    /// g z/θ in cells² per step² per kelvin.
    buoyancy: f64,
    /// Step (s), and metres per second of a cell a step.
    interval: f64,
    velocity_unit: f64,
    weight: f32,
    /// Level of cells that wind and temperature are taken from.
    level: usize,
}

/// One thread's memory of its rows at the ground, `row_stride` values a row.
pub(crate) struct SurfaceMemory {
    /// Filtered wind along x and y, and temperature; height over Obukhov's length; drag u*²/U², exchange of
    /// heat u* κ/…/U.
    pub(crate) columns: [Vec<f32>; N_COLUMNS],
    /// What the ground adds to the temperature of the lowest cells (K a step).
    pub(crate) source: Vec<f32>,
}

/// Columns that a thread remembers (–).
pub(crate) const N_COLUMNS: usize = 6;

impl SurfaceMemory {
    /// Memory of `n_values`; nothing is known yet.
    pub(crate) fn new(n_values: usize) -> Self {
        Self {
            columns: std::array::from_fn(|_| vec![f32::NAN; n_values]),
            // A line more, for whole-vector reads past the last cell.
            source: vec![0.0; n_values + LINE],
        }
    }

    /// Knows nothing, as at first.
    pub(crate) fn forget(&mut self) {
        for column in &mut self.columns {
            column.fill(f32::NAN);
        }
    }

    /// Writes column number `column` of what it remembers: of all threads' rows one column after the other,
    /// so that the order does not hang on their number.
    pub(crate) fn write(
        &self,
        column: usize,
        writer: &mut dyn Write,
        bytes: &mut Vec<u8>,
    ) -> Result<()> {
        write_values(writer, bytes, &self.columns[column])
    }

    /// Goes on from what [`write`](Self::write) wrote.
    pub(crate) fn read(
        &mut self,
        column: usize,
        reader: &mut dyn Read,
        bytes: &mut Vec<u8>,
    ) -> Result<()> {
        read_values(reader, bytes, &mut self.columns[column])
    }
}

/// Wind and temperature of a row a little above the ground, and room for the stress on its lowest cells.
struct AboveGround<'a> {
    velocity: [&'a [f32]; 2],
    /// Departure from the reference temperature (K).
    temperature: &'a [f32],
    /// Receives the force density on the lowest cells, x and y.
    stress: [&'a mut [f32]; 2],
}

impl Surface {
    /// The ground that `settings` and `atmosphere` ask for, if air is to feel one.
    pub(crate) fn new(
        atmosphere: &Atmosphere,
        settings: &LatticeSettings,
        scaling: &Scaling,
    ) -> Option<Self> {
        let Ground::WallStress { roughness_length } = settings.ground else { return None };
        let level = MATCHING_CELL.min(settings.n_cells[2] - 1);
        let height = (level as f64 + 0.5) * settings.spacing;
        let per_kelvin = Vector3::Z * (atmosphere.gravity / atmosphere.reference_temperature);
        let departure = match atmosphere.heating {
            Heating::Ground { temperature, .. } => temperature - atmosphere.reference_temperature,
            _ => 0.0,
        };
        Some(Self {
            similarity: atmosphere.similarity,
            place: Place {
                logarithm: (height / roughness_length).ln(),
                roughness: roughness_length / height,
            },
            heating: atmosphere.heating,
            departure,
            buoyancy: scaling.to_lattice_acceleration(per_kelvin).z
                * scaling.to_lattice_length(height),
            interval: scaling.interval(),
            velocity_unit: scaling.si_velocity_unit(),
            weight: filter_weight(settings, scaling, roughness_length) as f32,
            level,
        })
    }

    /// Takes the air above the ground in before step number `step`; on return `share` and `heat` hold the
    /// stress and the heat of the ground on their rows.
    pub(crate) fn update(
        &self,
        step: u64,
        rows: &impl Rows,
        air: &Stratification,
        state: &mut RowState,
        share: &mut Share,
        heat: &mut HeatShare,
    ) {
        let [n, n_y, _] = air.n_cells();
        let at_ground = share.rows.start.min(n_y)..share.rows.end.min(n_y);
        for (index, row) in at_ground.enumerate() {
            let above = row + self.level * n_y;
            rows.read_row(above, state);
            let start = index * air.ground_stride;
            let range = start..start + n;
            let [u, v, _] = &state.velocity;
            let above = AboveGround {
                velocity: [&u[..n], &v[..n]],
                temperature: air.temperature(step, above),
                stress: share.wall.each_mut().map(|wall| &mut wall[range.clone()]),
            };
            self.update_row(step, &mut heat.surface, range, above);
        }
    }

    /// As [`Self::update`], a row that has `range` in `memory`.
    fn update_row(
        &self,
        step: u64,
        memory: &mut SurfaceMemory,
        range: Range<usize>,
        above: AboveGround<'_>,
    ) {
        let ground = self.departure + self.warming() * step as f64;
        let [fx, fy, theta, zeta, drag, exchange] =
            memory.columns.each_mut().map(|column| &mut column[range.clone()]);
        let source = &mut memory.source[range.clone()];
        let AboveGround { velocity: [u, v], temperature, stress: [stress_x, stress_y] } = above;
        let anew = step.is_multiple_of(STRIDE);
        for x in 0..range.len() {
            let first = fx[x].is_nan();
            if first {
                (fx[x], fy[x], theta[x], zeta[x]) = (u[x], v[x], temperature[x], 0.0);
            } else {
                fx[x] += self.weight * (u[x] - fx[x]);
                fy[x] += self.weight * (v[x] - fy[x]);
                theta[x] += self.weight * (temperature[x] - theta[x]);
            }
            if first || anew {
                let above = [fx[x], fy[x], theta[x]];
                [zeta[x], drag[x], exchange[x]] = self.stability(ground, above, zeta[x]);
            }
            let speed = (fx[x] * fx[x] + fy[x] * fy[x]).sqrt();
            let rate = drag[x] * speed;
            stress_x[x] = -rate * u[x];
            stress_y[x] = -rate * v[x];
            source[x] = match self.heating {
                Heating::None | Heating::Plates { .. } => 0.0,
                Heating::Flux(flux) => (flux / self.velocity_unit) as f32,
                Heating::Ground { .. } => exchange[x] * speed * (ground as f32 - temperature[x]),
            };
        }
    }

    /// Change of the ground's temperature (K a step).
    fn warming(&self) -> f64 {
        match self.heating {
            Heating::Ground { rate, .. } => rate * self.interval,
            _ => 0.0,
        }
    }

    /// Height over Obukhov's length, drag and exchange of heat for a filtered wind and temperature above a
    /// ground of temperature `ground`; `before` is the first of them as it was.
    fn stability(&self, ground: f64, [u, v, theta]: [f32; 3], before: f32) -> [f32; 3] {
        let squared = f64::from(u * u + v * v).max(1e-12);
        let zeta = match self.heating {
            Heating::None | Heating::Plates { .. } => 0.0,
            Heating::Flux(flux) => {
                let flux = VON_KARMAN * self.buoyancy * (flux / self.velocity_unit)
                    / (squared * squared.sqrt());
                self.similarity.of_flux(self.place, flux, f64::from(before))
            }
            Heating::Ground { .. } => {
                let richardson = self.buoyancy * (f64::from(theta) - ground) / squared;
                self.similarity.of_richardson(self.place, richardson)
            }
        };
        let [momentum, heat] = self.similarity.profiles(self.place, zeta);
        let drag = (VON_KARMAN / momentum).powi(2);
        [zeta as f32, drag as f32, (VON_KARMAN * VON_KARMAN / (momentum * heat)) as f32]
    }
}
