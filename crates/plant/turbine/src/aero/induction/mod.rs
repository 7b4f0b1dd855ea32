//! Induction of a rotor in a wind that knows nothing of it: what momentum theory takes from the wind at each blade element,
//! at once or with the wake's delay.
//!
//! Every element of every blade has a ring of air of its own, as if all blades did what this one does: a blade that pitches
//! alone, or flies through a gust alone, meets its own induction. Delays run with the blade, not in the air that it crosses.

pub mod skew;
pub mod snel_schepers;
pub mod two_constant;

use super::Polar;
use super::blade_element::{self, Annulus, Theory, WarmStart};
use crate::actuator_line::Onset;
use serde::{Deserialize, Serialize};
pub use skew::SkewedWake;
pub use snel_schepers::SnelSchepers;
pub use two_constant::{Decay, Lagged, SlowConstant, TwoConstant};

/// Most that momentum theory may take from the wind, or add to the swirl, over the sum of the wind's components (–); beyond
/// it, as on blades that drive the air, the theory has no bound.
const LARGEST_SHARE: f64 = 1.5;

/// How the rotor's wake makes itself felt at its blades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Induction {
    /// Not at all: the wind that is handed in already contains it.
    Resolved,
    /// At once: blade-element momentum at every instant.
    QuasiSteady,
    /// With the delay of Snel and Schepers.
    SnelSchepers(SnelSchepers),
    /// With two time constants, after Øye.
    TwoConstant(TwoConstant),
}

/// Ring of air that an element stands for.
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

    /// At the instant: a blade pitched by `pitch` (rad) whose element has come to `radius` (m) from the shaft.
    ///
    /// Losses at tip and hub stay those of the straight blade; the blades' share of the ring's circumference follows the radius.
    pub fn annulus_now(&self, pitch: f64, radius: f64) -> Annulus {
        let Annulus { chord, radius: straight, section_pitch, .. } = self.annulus;
        Annulus {
            chord: chord * straight / radius.max(0.5 * straight),
            section_pitch: section_pitch + pitch,
            ..self.annulus
        }
    }
}

/// Induced velocity at one element, and what the models remember of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Induced {
    /// Against the wind across the plane of rotation, positive where it slows it (m/s).
    pub normal: Lagged,
    /// Along the swirl, against the rotation (m/s).
    pub tangential: Lagged,
    warm_start: WarmStart,
}

impl Induction {
    /// Induced velocity in a wind that has always been `onset`, at a blade in `annulus` with sections of `polar`.
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

    /// Moves `induced` on by `interval` (s), to the instant at which the wind without induction is `onset` at a blade in
    /// `annulus`, which is `ring`'s at that instant, with sections of `polar`. `decay` is the two-constant model's, unused by others.
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
        .map(|velocity| velocity.clamp(-limit, limit))
}

/// Largest induced velocity (m/s) in a wind of `onset`.
fn largest(onset: Onset) -> f64 {
    LARGEST_SHARE * (onset.normal.abs() + onset.tangential.abs())
}

#[cfg(test)]
mod tests;
