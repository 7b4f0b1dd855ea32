//! Induction of a rotor in a prescribed wind: induced velocity at each blade element by momentum theory,
//! quasi-steady or with dynamic inflow.
//!
//! Every element of every blade has an annulus of its own, as if all blades did what this one does: a blade
//! that pitches alone, or meets a gust alone, has its own induction. Lags rotate with the blade; they are not
//! fixed in space.

pub mod skew;
pub mod snel_schepers;
pub mod two_constant;

use super::Polar;
use super::blade_element::{self, Annulus, Theory, WarmStart};
use crate::actuator_line::Onset;
use crate::breakdown::within;
use serde::{Deserialize, Serialize};
pub use skew::SkewedWake;
pub use snel_schepers::SnelSchepers;
pub use two_constant::{Decay, Lagged, SlowConstant, TwoConstant};

/// Largest induced velocity over the sum of the wind's components (–); in the propeller state momentum theory
/// has no bound of its own.
const LARGEST_SHARE: f64 = 1.5;

/// Model of the wake's induction at the blades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Induction {
    /// None: the wind given already contains it.
    Resolved,
    /// Quasi-steady: blade-element momentum at every instant.
    QuasiSteady,
    /// Dynamic inflow after Snel and Schepers.
    SnelSchepers(SnelSchepers),
    /// Dynamic inflow with two time constants, after Øye.
    TwoConstant(TwoConstant),
}

/// Annulus of a blade element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Its geometry when nothing bends, blade unpitched.
    pub annulus: Annulus,
    /// Radius over that of the rotor (–).
    pub share: f64,
    /// Rotor radius times f_a of Snel and Schepers (m).
    pub inertia: f64,
}

impl Ring {
    /// Of `annulus`, whose tip radius is the rotor's.
    pub fn new(annulus: Annulus) -> Self {
        let share = annulus.radius / annulus.tip_radius;
        let inertia = annulus.tip_radius * snel_schepers::radial_factor(share);
        Self { annulus, share, inertia }
    }

    /// At the instant: a blade pitched by `pitch` (rad) whose element is `radius` (m) from the shaft.
    ///
    /// Tip and hub losses are those of the straight blade; the solidity follows the radius.
    pub fn annulus_now(&self, pitch: f64, radius: f64) -> Annulus {
        let Annulus { chord, radius: straight, section_pitch, .. } = self.annulus;
        Annulus {
            chord: chord * straight / radius.max(0.5 * straight),
            section_pitch: section_pitch + pitch,
            ..self.annulus
        }
    }
}

/// Induced velocity at one element, and the states of the models.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Induced {
    /// Against the wind across the plane of rotation, positive where it slows it (m/s).
    pub normal: Lagged,
    /// Along the swirl, against the rotation (m/s).
    pub tangential: Lagged,
    warm_start: WarmStart,
}

impl Induction {
    /// Steady induced velocity in the wind `onset`, at a blade in `annulus` with sections of `polar`.
    pub fn settled(
        &self,
        onset: Onset,
        annulus: &Annulus,
        polar: &Polar,
        theory: Theory,
    ) -> Induced {
        let mut induced = Induced::default();
        if *self == Self::Resolved {
            return induced;
        }
        let steady = steady(onset, annulus, polar, theory, &mut induced.warm_start);
        let coupling = match self {
            Self::TwoConstant(model) => model.coupling,
            _ => 0.0,
        };
        induced.normal = Lagged::settled(steady[0], coupling);
        induced.tangential = Lagged::settled(steady[1], coupling);
        induced
    }

    /// Advances `induced` by `interval` (s), to the instant at which the wind without induction is `onset` at
    /// a blade in `annulus`, which is `ring`'s at that instant, with sections of `polar`. Only the
    /// two-constant model uses `decay`.
    pub fn advance(
        &self,
        interval: f64,
        onset: Onset,
        ring: &Ring,
        annulus: &Annulus,
        polar: &Polar,
        theory: Theory,
        decay: &Decay,
        induced: &mut Induced,
    ) {
        match self {
            Self::Resolved => {}
            Self::QuasiSteady => {
                let [normal, tangential] =
                    steady(onset, annulus, polar, theory, &mut induced.warm_start);
                induced.normal.velocity = normal;
                induced.tangential.velocity = tangential;
            }
            Self::SnelSchepers(model) => {
                let inertia = model.time_factor * ring.inertia;
                let velocities = [&mut induced.normal.velocity, &mut induced.tangential.velocity];
                snel_schepers::advance(
                    interval, onset, annulus, polar, theory, inertia, velocities,
                );
            }
            Self::TwoConstant(model) => {
                let [normal, tangential] =
                    steady(onset, annulus, polar, theory, &mut induced.warm_start);
                induced.normal.advance(decay, model.coupling, normal);
                induced.tangential.advance(decay, model.coupling, tangential);
            }
        }
    }
}

/// Induced velocities (m/s) of blade-element momentum.
fn steady(
    onset: Onset,
    annulus: &Annulus,
    polar: &Polar,
    theory: Theory,
    warm_start: &mut WarmStart,
) -> [f64; 2] {
    let section = |angle: f64| polar.at(angle);
    let Onset { normal, tangential } = onset;
    let factors =
        blade_element::solve_near(annulus, normal, tangential, section, theory, warm_start);
    let limit = largest(onset);
    [factors.axial * normal, factors.tangential * tangential]
        .map(|velocity| within(velocity, [-limit, limit]))
}

/// Largest induced velocity (m/s) in a wind of `onset`.
fn largest(onset: Onset) -> f64 {
    LARGEST_SHARE * (onset.normal.abs() + onset.tangential.abs())
}

#[cfg(test)]
mod tests;
