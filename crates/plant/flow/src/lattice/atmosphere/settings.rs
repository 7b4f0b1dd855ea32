//! What makes the air of a box an atmosphere.

use super::similarity::Similarity;
use crate::lattice::settings::Ground;
use std::f64::consts::TAU;
use thiserror::Error;

/// Acceleration of free fall (m/s²).
pub const GRAVITY: f64 = 9.81;

/// An atmosphere: rotation, potential temperature, what drives and damps it.
///
/// Buoyancy is Boussinesq's. Temperatures are potential ones, in kelvin.
#[derive(Clone, Debug, PartialEq)]
pub struct Atmosphere {
    /// Coriolis parameter f = 2 Ω sin(latitude) (1/s), positive on the northern half.
    pub coriolis: f64,
    /// What drives the air.
    pub driving: Driving,
    /// Acceleration of free fall (m/s²); 0 leaves temperature without effect on the wind.
    pub gravity: f64,
    /// Temperature that buoyancy refers to, and that is stored the departure from (K).
    pub reference_temperature: f64,
    /// Temperature at the start over height: pairs of height (m) and temperature (K), linear in between and
    /// beyond, heights rising.
    pub temperature: Vec<[f64; 2]>,
    /// Heat through the ground.
    pub heating: Heating,
    /// How wind and temperature near the ground follow from what passes through it.
    pub similarity: Similarity,
    /// Prandtl number of air itself (–).
    pub prandtl: f64,
    /// Prandtl number of the eddies that the grid does not resolve (–).
    pub subgrid_prandtl: f64,
    /// What takes waves out near the top.
    pub damping: Option<Damping>,
    /// What buoyancy is measured from.
    pub reference: Reference,
    /// Noise on the first temperatures, from which eddies grow.
    pub perturbation: Option<Perturbation>,
}

/// What the buoyancy of a cell is measured from: pressure holds the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reference {
    /// The mean temperature of its level at each step: for air that is alike from place to place.
    Mean,
    /// The profile of temperature at its height.
    Start,
}

/// Noise on the first temperatures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Height up to which there is any (m).
    pub below: f64,
    /// Its greatest (K).
    pub amplitude: f64,
    /// Number that it follows from.
    pub seed: u64,
}

/// What drives the air of an atmosphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Driving {
    /// The pressure gradient of a geostrophic wind (m/s), x and y.
    Geostrophic([f64; 2]),
}

/// Heat through the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Heating {
    /// None.
    None,
    /// Kinematic flux upwards (K m/s).
    Flux(f64),
    /// The ground has a temperature, which changes evenly.
    Ground {
        /// At the start (K).
        temperature: f64,
        /// Change (K/s).
        rate: f64,
    },
    /// Ground and top are plates of these temperatures (K), and conduct.
    Plates {
        /// Of the ground.
        ground: f64,
        /// Of the top.
        top: f64,
    },
}

/// A layer below the top in which what differs from the geostrophic wind and the profile of temperature dies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damping {
    /// Where it begins (m above the ground).
    pub from: f64,
    /// Rate at the top (1/s); it rises from zero with the square of a sine.
    pub rate: f64,
}

/// Why an atmosphere cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AtmosphereError {
    /// A quantity is not finite or has the wrong sign.
    #[error("the {name} must be {expected}, not {value}")]
    Value {
        /// Quantity.
        name: &'static str,
        /// What it must be.
        expected: &'static str,
        /// Its value, in SI units.
        value: f64,
    },
    /// The profile of temperature is empty or its heights do not rise.
    #[error("the profile of temperature needs at least one height, and heights that rise")]
    Profile,
    /// Heat through a ground along which air slips.
    #[error("heat passes through a rough ground only: give a roughness length")]
    NoRoughness,
    /// Plates where air comes back from the other side.
    #[error("plates need a ground and a top, and this box is periodic upwards")]
    NoPlates,
    /// The step is too long for what the air does in it.
    #[error(
        "air in this stratification swings {steps:.1} times a period, at least 20 steps are needed; use a step of at most {longest:.4} s"
    )]
    Step {
        /// Steps in a period of the fastest buoyancy oscillation (–).
        steps: f64,
        /// Longest step (s).
        longest: f64,
    },
}

impl Atmosphere {
    /// Dry air at `temperature` (K) everywhere, at rest on the earth and not driven.
    pub fn new(temperature: f64) -> Self {
        Self {
            coriolis: 0.0,
            driving: Driving::Geostrophic([0.0; 2]),
            gravity: GRAVITY,
            reference_temperature: temperature,
            temperature: vec![[0.0, temperature]],
            heating: Heating::None,
            similarity: Similarity::default(),
            prandtl: 0.71,
            subgrid_prandtl: 1.0 / 3.0,
            damping: None,
            reference: Reference::Mean,
            perturbation: None,
        }
    }

    /// Temperature at the start (K) at `height` (m).
    pub fn temperature_at(&self, height: f64) -> f64 {
        let profile = &self.temperature;
        let [first, .., last] = profile.as_slice() else {
            return profile.first().map_or(self.reference_temperature, |[_, value]| *value);
        };
        let above = profile.partition_point(|[z, _]| *z <= height).clamp(1, profile.len() - 1);
        let [[z0, t0], [z1, t1]] = [profile[above - 1], profile[above]];
        if z1 == z0 {
            return if height < first[0] { first[1] } else { last[1] };
        }
        t0 + (t1 - t0) * (height - z0) / (z1 - z0)
    }

    /// Checks values, and the step `interval` (s) against the fastest buoyancy oscillation.
    ///
    /// # Errors
    /// [`AtmosphereError`] names the quantity and what would do.
    pub fn check(&self, interval: f64, ground: Ground) -> Result<(), AtmosphereError> {
        let value = |name, expected, value| AtmosphereError::Value { name, expected, value };
        let Driving::Geostrophic([u, v]) = self.driving;
        for (name, number) in [
            ("Coriolis parameter", self.coriolis),
            ("geostrophic wind", u),
            ("geostrophic wind", v),
        ] {
            if !number.is_finite() {
                return Err(value(name, "a number", number));
            }
        }
        if !(self.gravity.is_finite() && self.gravity >= 0.0) {
            return Err(value("acceleration of free fall", "zero or positive", self.gravity));
        }
        for (name, number) in [
            ("reference temperature", self.reference_temperature),
            ("Prandtl number", self.prandtl),
            ("subgrid Prandtl number", self.subgrid_prandtl),
        ] {
            if !(number.is_finite() && number > 0.0) {
                return Err(value(name, "positive", number));
            }
        }
        if let Some(Damping { from, rate }) = self.damping
            && !(from.is_finite() && rate.is_finite() && rate >= 0.0 && rate * interval <= 0.5)
        {
            return Err(value(
                "damping rate",
                "at least 0 and at most half a step's inverse",
                rate,
            ));
        }
        let rises = self.temperature.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        let finite = self.temperature.iter().flatten().all(|number| number.is_finite());
        if self.temperature.is_empty() || !rises || !finite {
            return Err(AtmosphereError::Profile);
        }
        self.check_heating()?;
        match (self.heating, ground) {
            (Heating::Flux(_) | Heating::Ground { .. }, Ground::WallStress { .. })
            | (Heating::None, _) => {}
            (Heating::Flux(_) | Heating::Ground { .. }, _) => {
                return Err(AtmosphereError::NoRoughness);
            }
            (Heating::Plates { .. }, Ground::Periodic) => return Err(AtmosphereError::NoPlates),
            (Heating::Plates { .. }, _) => {}
        }
        let steepest = self
            .temperature
            .windows(2)
            .map(|pair| (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]))
            .fold(0.0, f64::max);
        let period = TAU / (self.gravity * steepest / self.reference_temperature).sqrt();
        let steps = period / interval;
        if steps < 20.0 {
            return Err(AtmosphereError::Step { steps, longest: period / 20.0 });
        }
        Ok(())
    }

    /// Checks the numbers of heating, similarity and perturbation.
    fn check_heating(&self) -> Result<(), AtmosphereError> {
        let value = |name, expected, value| AtmosphereError::Value { name, expected, value };
        let temperatures = match self.heating {
            Heating::None => [0.0; 2],
            Heating::Flux(flux) => [flux; 2],
            Heating::Ground { temperature, rate } => [temperature, rate],
            Heating::Plates { ground, top } => [ground, top],
        };
        let similarity = self.similarity;
        let noise = self.perturbation.map_or([0.0; 2], |noise| [noise.below, noise.amplitude]);
        for (name, number) in
            temperatures.map(|number| ("heating of the ground", number)).into_iter().chain([
                ("similarity constant", similarity.stable_momentum),
                ("similarity constant", similarity.stable_heat),
                ("similarity constant", similarity.unstable),
                ("height of the perturbation", noise[0]),
                ("perturbation", noise[1]),
            ])
        {
            if !number.is_finite() {
                return Err(value(name, "a number", number));
            }
        }
        Ok(())
    }
}
