//! What a step needs to know of the atmosphere, in lattice units.

use super::settings::{Atmosphere, Damping, Driving};
use crate::lattice::joint::Joint;
use crate::lattice::scaling::Scaling;
use crate::lattice::settings::LatticeSettings;
use basis::Vector3;

/// The same at every cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients {
    /// f/(1 + f²/4) and f²/2/(1 + f²/4): a step of Coriolis force that keeps energy (Crank, Nicolson).
    pub(crate) turning: [f32; 2],
    /// Wind that the pressure gradient balances (cells a step).
    pub(crate) geostrophic: [f32; 2],
    /// Upward acceleration per kelvin.
    pub(crate) buoyancy: f32,
    /// What a slope of temperature (K per cell) takes from the square of Smagorinsky's viscosity (Lilly 1962,
    /// Tellus 14, 148).
    pub(crate) stability: f32,
    /// Diffusivity over viscosity, for eddies.
    pub(crate) eddy_diffusivity: f32,
    /// The air's own diffusivity (cells² a step).
    pub(crate) conductivity: f32,
}

/// The same at every cell of a level.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    /// Temperature that buoyancy starts from: the level's mean (K above the reference).
    pub(crate) mean: f32,
    /// Temperature that fluxes count from: the same, but in a box of finer cells that of the level of the
    /// grid around, so that what passes from one to the other is counted alike.
    pub(crate) base: f32,
    /// Rate at which wind and temperature are damped (per step).
    pub(crate) damping: f32,
    /// Temperature that damping goes to (K above the reference).
    pub(crate) target: f32,
}

impl Level {
    /// Buoyancy and fluxes count from `mean` from now on.
    pub(crate) fn refer(&mut self, mean: f32) {
        (self.mean, self.base) = (mean, mean);
    }
}

impl Coefficients {
    /// Those of `atmosphere` in the box of `settings`.
    pub(crate) fn new(
        atmosphere: &Atmosphere,
        settings: &LatticeSettings,
        scaling: &Scaling,
    ) -> Self {
        let turn = atmosphere.coriolis * scaling.interval();
        let share = 1.0 / (1.0 + 0.25 * turn * turn);
        let Driving::Geostrophic([u, v]) = atmosphere.driving;
        let geostrophic = scaling.to_lattice_velocity(Vector3::new(u, v, 0.0));
        let per_kelvin = Vector3::Z * (atmosphere.gravity / atmosphere.reference_temperature);
        let buoyancy = scaling.to_lattice_acceleration(per_kelvin).z;
        let viscosity = scaling.to_lattice_viscosity(settings.kinematic_viscosity);
        // ν_t² = C⁴ (S² − N²/Pr_t).
        let stability = settings.subgrid.constant.powi(4) * buoyancy / atmosphere.subgrid_prandtl;
        Self {
            turning: [(turn * share) as f32, (0.5 * turn * turn * share) as f32],
            geostrophic: [geostrophic.x as f32, geostrophic.y as f32],
            buoyancy: buoyancy as f32,
            stability: stability as f32,
            eddy_diffusivity: (1.0 / atmosphere.subgrid_prandtl) as f32,
            conductivity: (viscosity / atmosphere.prandtl) as f32,
        }
    }
}

/// Levels of the box of `settings`, which lies as `joint` says, as at the start.
pub(crate) fn levels(
    atmosphere: &Atmosphere,
    settings: &LatticeSettings,
    joint: &Joint,
) -> Vec<Level> {
    let scaling = settings.scaling();
    (0..settings.n_cells[2])
        .map(|level| {
            let height = joint.floor + (level as f64 + 0.5) * settings.spacing;
            let departure = match &joint.targets {
                Some(targets) => targets[level],
                None => {
                    (atmosphere.temperature_at(height) - atmosphere.reference_temperature) as f32
                }
            };
            let damping = match atmosphere.damping {
                Some(Damping { from, rate }) if height > from => {
                    let share = (height - from) / (joint.top - from);
                    rate * (std::f64::consts::FRAC_PI_2 * share).sin().powi(2) * scaling.interval()
                }
                _ => 0.0,
            };
            Level { mean: departure, base: departure, damping: damping as f32, target: departure }
        })
        .collect()
}
