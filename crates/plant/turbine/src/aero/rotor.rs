//! Blade-element momentum aerodynamics of a flexible rotor in a prescribed wind: dynamic inflow, skewed wake,
//! dynamic stall, tower.

use super::blade_element::Theory;
use super::dynamic_stall::{self, Stream};
use super::induction::{Decay, Induced, Induction, SkewedWake};
use super::section::{Section, sections};
use super::tower_influence::TowerInfluence;
use crate::actuator_line::{Element, Onset};
use crate::definition::Definition;
use crate::motion::ElementMotion;
use crate::rotor::Frame;
use crate::structure::{ElementLoad, Pitch};
use basis::Vector3;
use serde::{Deserialize, Serialize};

/// Settings of blade-element momentum theory: which parts are active.
#[derive(Clone, Debug, PartialEq)]
pub struct BemSettings {
    /// Model of the induction.
    pub induction: Induction,
    /// Losses and drag in the induction.
    pub theory: Theory,
    /// Whether a skewed wake changes the induction across the rotor.
    pub skewed_wake: bool,
    /// Whether sections have dynamic stall; otherwise their polars hold at once.
    pub dynamic_stall: bool,
    /// The tower, if the wind given does not contain its influence.
    pub tower: Option<TowerInfluence>,
}

/// The blades of a rotor, all alike; parameters only.
///
/// Sections see the flow normal to the local blade line, coned, prebent and bent; flow along it has no
/// effect. Shaft tilt, yaw and motion of the tower enter through the components of the wind and the
/// velocities of the elements.
#[derive(Clone, Debug)]
pub struct RotorAerodynamics {
    settings: BemSettings,
    air_density: f64,
    n_blades: usize,
    rotor_radius: f64,
    sections: Vec<Section>,
}

/// Rotor kinematics: position and motion of the rotor at one instant.
#[derive(Clone, Copy, Debug)]
pub struct RotorKinematics<'a> {
    /// Hub and shaft.
    pub frame: &'a Frame,
    /// Motion of the elements, blade after blade, root to tip.
    pub elements: &'a [ElementMotion],
    /// Pitch of each blade.
    pub pitch: &'a [Pitch],
}

/// State of the aerodynamics; a run restored from it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BemState {
    /// Whether a step has been made; the first one starts from the steady state.
    started: bool,
    /// Mean axial induction of the last instant (–).
    mean_induction: f64,
    elements: Vec<ElementState>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct ElementState {
    induced: Induced,
    stall: dynamic_stall::StallState,
}

/// Aerodynamic loads of the rotor, with the flow at its elements.
#[derive(Clone, Debug)]
pub struct Loads {
    /// Force and moment on each element, blade after blade, root to tip.
    pub elements: Vec<ElementLoad>,
    /// Flow at each element, in the same order.
    pub flows: Vec<ElementFlow>,
    /// Force along the shaft, downwind (N).
    pub thrust: f64,
    /// Moment about the shaft, driving (N m).
    pub torque: f64,
    /// Mean axial induction over the swept area (–).
    pub mean_induction: f64,
    /// Working memory: the lags of the two-constant model, element by element of a blade.
    decays: Vec<Decay>,
}

/// Flow past one element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElementFlow {
    /// Angle of attack (rad).
    pub angle_of_attack: f64,
    /// Relative speed (m/s).
    pub relative_speed: f64,
    /// Lift coefficient (–).
    pub lift: f64,
    /// Drag coefficient (–).
    pub drag: f64,
    /// Wind without induction, in the blade's frame.
    pub onset: Onset,
    /// Induced velocity against the wind across the plane of rotation (m/s).
    pub induced_normal: f64,
    /// Induced velocity against the rotation (m/s).
    pub induced_tangential: f64,
}

impl ElementFlow {
    /// Axial induction factor (–).
    pub fn axial_induction(&self) -> f64 {
        self.induced_normal / self.onset.normal
    }

    /// Tangential induction factor (–).
    pub fn tangential_induction(&self) -> f64 {
        self.induced_tangential / self.onset.tangential
    }
}

impl RotorAerodynamics {
    /// The blades of `definition`, divided into `elements` as
    /// [`ActuatorLine::elements`](crate::actuator_line::ActuatorLine::elements) gives them.
    ///
    /// The air has a density of `air_density` (kg/m³).
    pub fn new(
        definition: &Definition,
        elements: &[Element],
        air_density: f64,
        settings: BemSettings,
    ) -> Self {
        let mut sections = sections(definition, elements);
        if !settings.dynamic_stall {
            sections.iter_mut().for_each(|section| section.stall = None);
        }
        Self {
            settings,
            air_density,
            n_blades: definition.n_blades,
            rotor_radius: definition.rotor_radius(),
            sections,
        }
    }

    /// The state before the first step.
    pub fn start(&self) -> BemState {
        BemState {
            started: false,
            mean_induction: 0.0,
            elements: vec![ElementState::default(); self.n_blades * self.sections.len()],
        }
    }

    /// Loads to be filled by [`RotorAerodynamics::advance`].
    pub fn loads(&self) -> Loads {
        let n = self.n_blades * self.sections.len();
        Loads {
            elements: vec![ElementLoad::default(); n],
            flows: vec![ElementFlow::default(); n],
            thrust: 0.0,
            torque: 0.0,
            mean_induction: 0.0,
            decays: vec![Decay::default(); self.sections.len()],
        }
    }

    /// Advances `state` by the `interval` (s) before this instant, and fills `loads` with the loads at this
    /// instant.
    ///
    /// `winds` (m/s, farm frame) holds the wind at each element of `kinematics`. The first call starts from
    /// the steady state for this wind and these kinematics. With an interval of 0 only parts without lag
    /// change.
    pub fn advance(
        &self,
        interval: f64,
        winds: &[Vector3],
        kinematics: RotorKinematics<'_>,
        state: &mut BemState,
        loads: &mut Loads,
    ) {
        let Frame { hub, shaft, .. } = *kinematics.frame;
        let mean_wind = self.mean_wind(winds);
        let skew = if self.settings.skewed_wake {
            SkewedWake::new(mean_wind, shaft, state.mean_induction, self.rotor_radius)
        } else {
            SkewedWake::default()
        };
        self.fill_decays(interval, mean_wind.dot(shaft), state.mean_induction, &mut loads.decays);
        let n = self.sections.len();
        let (mut force, mut torque) = (Vector3::ZERO, 0.0);
        let (mut taken, mut offered) = (0.0, 0.0);
        for blade in 0..self.n_blades {
            let pitch = kinematics.pitch[blade];
            for (station, section) in self.sections.iter().enumerate() {
                let index = blade * n + station;
                let motion = &kinematics.elements[index];
                let arm = motion.position - hub;
                let now = Instant {
                    interval: if state.started { Some(interval) } else { None },
                    motion,
                    wind: self.met(motion.position, winds[index]),
                    radius: (arm - shaft * arm.dot(shaft)).length(),
                    pitch,
                    skew: skew.factor(arm),
                    decay: &loads.decays[station],
                };
                let (load, flow) = self.load(section, &now, &mut state.elements[index]);
                force += load.force;
                torque += arm.cross(load.force).dot(shaft);
                taken += section.area * flow.induced_normal;
                offered += section.area * flow.onset.normal;
                loads.elements[index] = load;
                loads.flows[index] = flow;
            }
        }
        state.started = true;
        state.mean_induction = if offered > 0.0 { (taken / offered).clamp(0.0, 1.0) } else { 0.0 };
        loads.mean_induction = state.mean_induction;
        loads.thrust = force.dot(shaft);
        loads.torque = torque;
    }

    /// Load and flow of one element; on return its `state` has been advanced.
    fn load(
        &self,
        section: &Section,
        now: &Instant<'_>,
        state: &mut ElementState,
    ) -> (ElementLoad, ElementFlow) {
        let BemSettings { induction, theory, .. } = &self.settings;
        let axes = &now.motion.axes;
        let relative = now.wind - now.motion.velocity;
        let onset =
            Onset { normal: relative.dot(axes.normal), tangential: -relative.dot(axes.tangent) };
        let annulus = section.ring.annulus_now(now.motion.pitch, now.radius);
        let induced = &mut state.induced;
        match now.interval {
            None => *induced = induction.settled(onset, &annulus, &section.polar, *theory),
            Some(interval) => {
                let (ring, polar) = (&section.ring, &section.polar);
                induction
                    .advance(interval, onset, ring, &annulus, polar, *theory, now.decay, induced);
            }
        }
        let induced_normal = now.skew * induced.normal.velocity;
        let induced_tangential = induced.tangential.velocity;
        let (through, along) =
            (onset.normal - induced_normal, onset.tangential + induced_tangential);
        let speed = (through * through + along * along).sqrt();
        if speed == 0.0 {
            return (ElementLoad::default(), ElementFlow { onset, ..ElementFlow::default() });
        }
        let (sine, cosine) = (through / speed, along / speed);
        let angle_of_attack = through.atan2(along) - annulus.section_pitch;
        let chord = section.ring.annulus.chord;
        let coefficients = match &section.stall {
            None => section.polar.at(angle_of_attack),
            Some(stall) => {
                let stream = Stream { angle_of_attack, speed, chord, rotation: -now.pitch.rate };
                if now.interval.is_none() {
                    state.stall = stall.settled(&stream, &section.polar);
                }
                let interval = now.interval.unwrap_or(0.0);
                stall.advance(interval, &stream, &section.polar, &mut state.stall)
            }
        };
        let scale = 0.5 * self.air_density * speed * speed * chord * section.width;
        let (lift, drag) = (coefficients.lift, coefficients.drag);
        let force = axes.normal * (scale * (lift * cosine + drag * sine))
            + axes.tangent * (scale * (lift * sine - drag * cosine));
        // Nose up turns about the blade's line, towards the tip.
        let moment = axes.span * (scale * chord * coefficients.moment);
        let flow = ElementFlow {
            angle_of_attack,
            relative_speed: speed,
            lift,
            drag,
            onset,
            induced_normal,
            induced_tangential,
        };
        (ElementLoad { force, moment }, flow)
    }

    /// Wind (m/s) averaged over the swept area.
    fn mean_wind(&self, winds: &[Vector3]) -> Vector3 {
        let (mut sum, mut area) = (Vector3::ZERO, 0.0);
        for (wind, section) in winds.iter().zip(self.sections.iter().cycle()) {
            sum += *wind * section.area;
            area += section.area;
        }
        sum / area
    }

    /// Wind at `position` (m) with the influence of the tower.
    fn met(&self, position: Vector3, wind: Vector3) -> Vector3 {
        match &self.settings.tower {
            Some(tower) => tower.felt(position, wind),
            None => wind,
        }
    }

    fn fill_decays(&self, interval: f64, wind: f64, mean_induction: f64, decays: &mut [Decay]) {
        if let Induction::TwoConstant(model) = &self.settings.induction {
            let slow = model.slow.value(self.rotor_radius, wind, mean_induction);
            for (decay, section) in decays.iter_mut().zip(&self.sections) {
                *decay = Decay::new(interval, slow, section.ring.share);
            }
        }
    }
}

/// Inputs of one element at one instant.
struct Instant<'a> {
    /// Since the last instant (s); None at the first one.
    interval: Option<f64>,
    motion: &'a ElementMotion,
    wind: Vector3,
    /// Distance from the shaft (m).
    radius: f64,
    pitch: Pitch,
    /// Factor of the skewed wake on axial induction (–).
    skew: f64,
    decay: &'a Decay,
}

#[cfg(test)]
mod tests;
