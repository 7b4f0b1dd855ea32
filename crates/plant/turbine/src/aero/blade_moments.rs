//! A reduced dynamic blade-element momentum model: from the wind at each blade to the moment at each blade
//! root.
//!
//! The measurement function of van Vondelen et al. (2025), Eq. 13, and Coquelet et al. (2024, Wind Energ.
//! Sci. 9): winds, rotor speed and pitch in, out-of-plane moments out. Blades are stiff, each in a uniform
//! wind of its own; sections respond at once and induction follows the chosen model.
//! [`BladeMoments::moments`] does not change the wake, so that an estimator can evaluate neighbouring winds
//! before [`BladeMoments::advance`] advances the wake with the estimated one.

use super::Induction;
use super::blade_element::Theory;
use super::induction::{Decay, Induced};
use super::section::{Section, sections};
use crate::actuator_line::{Element, Onset};
use crate::definition::Definition;
use basis::PerBlade;
use basis::mbc::blade_azimuth;
use serde::{Deserialize, Serialize};

/// The model; parameters only.
#[derive(Clone, Debug)]
pub struct BladeMoments {
    n_blades: usize,
    air_density: f64,
    rotor_radius: f64,
    induction: Induction,
    theory: Theory,
    parts: Vec<Part>,
}

/// One element of a blade.
#[derive(Clone, Debug)]
struct Part {
    section: Section,
    /// Cosine of the local cone angle (–).
    cosine: f64,
    /// Distance from the blade root along the pitch axis (m).
    lever: f64,
}

/// Inputs of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Wind along the shaft at each blade, without induction (m/s).
    pub winds: PerBlade<f64>,
    /// Rotor speed (rad/s).
    pub rotor_speed: f64,
    /// Pitch of each blade (rad).
    pub pitch: PerBlade<f64>,
}

/// Wake of the model: induced velocities, blade after blade.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Wake {
    induced: Vec<Induced>,
    mean_induction: f64,
}

impl BladeMoments {
    /// The blades of `definition`, divided into `elements`, in air of `air_density` (kg/m³).
    pub fn new(
        definition: &Definition,
        elements: &[Element],
        induction: Induction,
        theory: Theory,
        air_density: f64,
    ) -> Self {
        let parts = sections(definition, elements)
            .into_iter()
            .zip(elements)
            .map(|(section, element)| Part {
                section,
                cosine: element.cone_angle.cos(),
                lever: element.span - definition.rotor.hub_radius,
            })
            .collect();
        Self {
            n_blades: definition.n_blades,
            air_density,
            rotor_radius: definition.rotor_radius(),
            induction,
            theory,
            parts,
        }
    }

    /// The steady wake in `conditions`.
    pub fn settled(&self, conditions: &Conditions) -> Wake {
        let mut wake = Wake {
            induced: Vec::with_capacity(self.n_blades * self.parts.len()),
            mean_induction: 0.0,
        };
        for blade in 0..self.n_blades {
            for part in &self.parts {
                let ring = &part.section.ring;
                let annulus = ring.annulus_now(conditions.pitch[blade], ring.annulus.radius);
                let onset = part.onset(conditions, blade);
                let polar = &part.section.polar;
                wake.induced.push(self.induction.settled(onset, &annulus, polar, self.theory));
            }
        }
        wake.mean_induction = self.mean_induction(&wake, conditions);
        wake
    }

    /// Advances `wake` by `interval` (s), to the instant of `conditions`.
    pub fn advance(&self, interval: f64, conditions: &Conditions, wake: &mut Wake) {
        let mean_wind = conditions.winds.mean();
        for (station, part) in self.parts.iter().enumerate() {
            let ring = &part.section.ring;
            let decay = match &self.induction {
                Induction::TwoConstant(model) => {
                    let slow = model.slow.value(self.rotor_radius, mean_wind, wake.mean_induction);
                    Decay::new(interval, slow, ring.share)
                }
                _ => Decay::default(),
            };
            for blade in 0..self.n_blades {
                let annulus = ring.annulus_now(conditions.pitch[blade], ring.annulus.radius);
                let onset = part.onset(conditions, blade);
                let induced = &mut wake.induced[blade * self.parts.len() + station];
                let polar = &part.section.polar;
                self.induction.advance(
                    interval,
                    onset,
                    ring,
                    &annulus,
                    polar,
                    self.theory,
                    &decay,
                    induced,
                );
            }
        }
        wake.mean_induction = self.mean_induction(wake, conditions);
    }

    /// Out-of-plane moment at each blade root (N m), positive downwind, in `conditions` with the `wake` held.
    pub fn moments(&self, conditions: &Conditions, wake: &Wake) -> PerBlade<f64> {
        PerBlade::from_fn(self.n_blades, |blade| {
            let induced = &wake.induced[blade * self.parts.len()..];
            self.parts
                .iter()
                .zip(induced)
                .map(|(part, induced)| part.moment(conditions, blade, induced))
                .sum::<f64>()
                * 0.5
                * self.air_density
        })
    }

    /// The [`BladeMoments::moments`] and their derivatives by their own blade's wind (N m/(m/s)), the wake
    /// held.
    ///
    /// With the wake held a blade's moment does not depend on the other blades' winds, so this is the whole
    /// Jacobian. The polars are linear between their rows, so derivatives jump at the rows.
    pub fn moments_with_slopes(
        &self,
        conditions: &Conditions,
        wake: &Wake,
    ) -> (PerBlade<f64>, PerBlade<f64>) {
        let mut slopes = PerBlade::splat(self.n_blades, 0.0);
        let moments = PerBlade::from_fn(self.n_blades, |blade| {
            let induced = &wake.induced[blade * self.parts.len()..];
            let (mut moment, mut slope) = (0.0, 0.0);
            for (part, induced) in self.parts.iter().zip(induced) {
                let with_slope = part.moment_with_slope(conditions, blade, induced);
                moment += with_slope[0];
                slope += with_slope[1];
            }
            slopes[blade] = slope * 0.5 * self.air_density;
            moment * 0.5 * self.air_density
        });
        (moments, slopes)
    }

    /// Induction at the blades from sectors fixed in the non-rotating frame.
    ///
    /// `still` is a wake whose blade k represents the sector at azimuth 2π k/n, advanced with the wind and
    /// pitch there. On return `met` holds the induction at each blade with blade 1 at `azimuth` (rad): the
    /// average, tilt and yaw components of the sectors' induced velocities at that blade, tilt and yaw times
    /// `share` (–).
    pub fn meet(&self, still: &Wake, azimuth: f64, share: f64, met: &mut Wake) {
        let n_blades = self.n_blades;
        let n_parts = self.parts.len();
        for blade in 0..n_blades {
            let place = blade_azimuth(azimuth, blade, n_blades);
            let weights = PerBlade::from_fn(n_blades, |sector| {
                let between = place - blade_azimuth(0.0, sector, n_blades);
                (1.0 + 2.0 * share * between.cos()) / n_blades as f64
            });
            for part in 0..n_parts {
                let sum = |of: fn(&Induced) -> f64| -> f64 {
                    let sectors = (0..n_blades).map(|sector| sector * n_parts + part);
                    sectors.zip(weights.iter()).map(|(at, w)| w * of(&still.induced[at])).sum()
                };
                let induced = &mut met.induced[blade * n_parts + part];
                induced.normal.velocity = sum(|induced| induced.normal.velocity);
                induced.tangential.velocity = sum(|induced| induced.tangential.velocity);
            }
        }
        met.mean_induction = still.mean_induction;
    }

    fn mean_induction(&self, wake: &Wake, conditions: &Conditions) -> f64 {
        let (mut taken, mut offered) = (0.0, 0.0);
        for (index, induced) in wake.induced.iter().enumerate() {
            let (blade, part) = (index / self.parts.len(), &self.parts[index % self.parts.len()]);
            taken += part.section.area * induced.normal.velocity;
            offered += part.section.area * part.onset(conditions, blade).normal;
        }
        if offered > 0.0 { (taken / offered).clamp(0.0, 1.0) } else { 0.0 }
    }
}

impl Part {
    fn onset(&self, conditions: &Conditions, blade: usize) -> Onset {
        Onset {
            normal: conditions.winds[blade] * self.cosine,
            tangential: conditions.rotor_speed * self.section.ring.annulus.radius,
        }
    }

    /// Moment at the blade root over half the air density (m⁵/s²).
    fn moment(&self, conditions: &Conditions, blade: usize, induced: &Induced) -> f64 {
        let Onset { normal, tangential } = self.onset(conditions, blade);
        let through = normal - induced.normal.velocity;
        let along = tangential + induced.tangential.velocity;
        let annulus = &self.section.ring.annulus;
        let angle = through.atan2(along) - annulus.section_pitch - conditions.pitch[blade];
        let section = self.section.polar.at(angle);
        let speed = through.hypot(along);
        let force = annulus.chord * speed * (section.lift * along + section.drag * through);
        force * self.section.width * self.lever
    }

    /// [`Part::moment`] and its slope over the blade's wind (m⁴/s).
    fn moment_with_slope(
        &self,
        conditions: &Conditions,
        blade: usize,
        induced: &Induced,
    ) -> [f64; 2] {
        let Onset { normal, tangential } = self.onset(conditions, blade);
        let through = normal - induced.normal.velocity;
        let along = tangential + induced.tangential.velocity;
        let annulus = &self.section.ring.annulus;
        let angle = through.atan2(along) - annulus.section_pitch - conditions.pitch[blade];
        let section = self.section.polar.at(angle);
        let turned = self.section.polar.slopes_at(angle);
        let speed = through.hypot(along);
        let load = section.lift * along + section.drag * through;
        let scale = annulus.chord * self.section.width * self.lever;
        if speed == 0.0 {
            return [0.0; 2];
        }
        // Over the wind through the disc: the speed grows by its share, the angle turns by along/speed².
        let turning = along / speed * (turned.lift * along + turned.drag * through);
        let slope = through / speed * load + turning + speed * section.drag;
        let moment = annulus.chord * speed * load * self.section.width * self.lever;
        [moment, scale * slope * self.cosine]
    }
}

#[cfg(test)]
mod tests;
