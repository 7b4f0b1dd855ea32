//! Aerodynamic loads on the blades: by actuator lines where the flow resolves the induction, by momentum
//! theory where not.

use super::answering::Answering;
use super::separation::{Flow, Separation};
use super::{Induction, N_ELEMENTS, TurbineSettings};
use crate::actuator_line::{ActuatorLine, Load, Onset, QuasiSteady, Scratch, Sections};
use crate::aero::TowerInfluence;
use crate::aero::rotor::{self, RotorAerodynamics, RotorKinematics};
use crate::definition::Definition;
use crate::motion::ElementMotion;
use crate::rotor::Frame;
use crate::structure::{ElementLoad, Pitch};
use basis::{Answer, PerBlade, Vector3};
use serde::{Deserialize, Serialize};

/// One of the two models, with its working memory.
#[derive(Clone, Debug)]
pub(super) enum Aerodynamics {
    /// The flow contains the induction; without [`Separation`] the sections' polars hold at once.
    Line(Box<(LineMemory, Option<Separation>)>),
    /// Momentum theory gives it.
    Momentum(Box<(RotorAerodynamics, rotor::Loads)>),
}

/// Working memory of the actuator line.
#[derive(Clone, Debug)]
pub(super) struct LineMemory {
    onsets: Vec<Onset>,
    /// Rotation of each section beside its twist (rad).
    pitch: Vec<f64>,
    loads: Vec<Load>,
    scratch: Scratch,
    /// Where the air answers to the circulation of elements.
    answering: Option<Answering>,
    /// The tower, where the air does not hold its influence.
    tower: Option<TowerInfluence>,
}

/// State of the aerodynamics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum AerodynamicState {
    /// Smearing correction, axial and tangential (m/s), blade after blade.
    Line(Vec<[f64; 2]>),
    /// Induction and dynamic stall.
    Momentum(rotor::BemState),
    /// As `Line`, with the flow about sections with dynamic stall.
    SeparatingLine(Vec<[f64; 2]>, Flow),
}

/// The middle of a step.
pub(super) struct Instant<'a> {
    /// Duration of the step (s).
    pub(super) interval: f64,
    /// Whether it is the first step since the winds were sampled.
    pub(super) first: bool,
    pub(super) winds: &'a [Vector3],
    pub(super) answer: Option<Answer<'a>>,
    pub(super) motions: &'a [ElementMotion],
    pub(super) pitch: &'a PerBlade<Pitch>,
    pub(super) frame: &'a Frame,
    pub(super) rotor_speed: f64,
}

impl Aerodynamics {
    pub(super) fn new(
        definition: &Definition,
        line: &ActuatorLine,
        settings: &TurbineSettings,
    ) -> Self {
        match &settings.induction {
            Induction::ByFlow { dynamic_stall, .. }
            | Induction::ByBoundVortices { dynamic_stall, .. } => {
                let n = definition.n_blades * N_ELEMENTS;
                let (answers, tower) = match &settings.induction {
                    Induction::ByBoundVortices { tower, .. } => (true, tower.clone()),
                    _ => (false, None),
                };
                if !answers {
                    // Now, for no step is to wait for it.
                    line.correction();
                }
                let memory = LineMemory {
                    onsets: vec![Onset::default(); n],
                    pitch: vec![0.0; n],
                    loads: vec![Load::default(); n],
                    scratch: Scratch::new(definition.n_blades, N_ELEMENTS),
                    answering: answers.then(|| Answering::new(n)),
                    tower,
                };
                let separation =
                    dynamic_stall.then(|| Separation::new(definition, line.elements()));
                Self::Line(Box::new((memory, separation)))
            }
            Induction::ByMomentum(theory) => {
                let rotor = RotorAerodynamics::new(
                    definition,
                    line.elements(),
                    settings.air_density,
                    theory.clone(),
                );
                let loads = rotor.loads();
                Self::Momentum(Box::new((rotor, loads)))
            }
        }
    }

    /// The state before the first step.
    pub(super) fn start(&self) -> AerodynamicState {
        match self {
            Self::Line(pair) => {
                let (memory, separation) = &**pair;
                let corrections = vec![[0.0; 2]; memory.loads.len()];
                match separation {
                    None => AerodynamicState::Line(corrections),
                    Some(separation) => {
                        AerodynamicState::SeparatingLine(corrections, separation.start())
                    }
                }
            }
            Self::Momentum(pair) => AerodynamicState::Momentum(pair.0.start()),
        }
    }

    /// On return `loads` holds the aerodynamic load on each element `now`, and `state` has been advanced.
    pub(super) fn loads(
        &mut self,
        line: &ActuatorLine,
        now: &Instant<'_>,
        state: &mut AerodynamicState,
        loads: &mut [ElementLoad],
    ) {
        match (self, state) {
            (Self::Line(pair), AerodynamicState::Line(corrections)) => {
                let (memory, _) = &mut **pair;
                memory.loads(line, now, &mut QuasiSteady(line), corrections);
                memory.apply(line, now, loads);
            }
            (Self::Line(pair), AerodynamicState::SeparatingLine(corrections, flow)) => {
                let (memory, Some(separation)) = &mut **pair else { mismatch() };
                let mut step = separation.step(flow, now.interval, &now.pitch[..]);
                memory.loads(line, now, &mut step, corrections);
                separation.store_in(flow);
                memory.apply(line, now, loads);
            }
            (Self::Momentum(pair), AerodynamicState::Momentum(state)) => {
                let (rotor, result) = &mut **pair;
                let kinematics = RotorKinematics {
                    frame: now.frame,
                    elements: now.motions,
                    pitch: &now.pitch[..],
                };
                let winds = &now.winds[..now.motions.len()];
                rotor.advance(now.interval, winds, kinematics, state, result);
                loads.copy_from_slice(&result.elements);
            }
            _ => mismatch(),
        }
    }

    /// Adds `share` (–) of the circulation (m²/s) that the last loads go with to each element's of
    /// `circulations`; where these are none, nothing is to be done.
    pub(super) fn add_circulations(
        &self,
        line: &ActuatorLine,
        share: f64,
        circulations: &mut [f64],
    ) {
        match self {
            Self::Line(pair) => {
                for (sum, load) in circulations.iter_mut().zip(&pair.0.loads) {
                    *sum += share * load.circulation;
                }
            }
            Self::Momentum(pair) => {
                let elements = line.elements().iter().cycle();
                for ((sum, flow), element) in
                    circulations.iter_mut().zip(&pair.1.flows).zip(elements)
                {
                    *sum += share * 0.5 * flow.relative_speed * element.chord * flow.lift;
                }
            }
        }
    }
}

fn mismatch() -> ! {
    unreachable!("a state comes from the aerodynamics that it goes back to")
}

impl LineMemory {
    /// On return its loads are those of `now`, and `corrections` have been relaxed.
    fn loads(
        &mut self,
        line: &ActuatorLine,
        now: &Instant<'_>,
        sections: &mut impl Sections,
        corrections: &mut [[f64; 2]],
    ) {
        let inputs = self.onsets.iter_mut().zip(&mut self.pitch);
        for (((onset, pitch), motion), wind) in inputs.zip(now.motions).zip(now.winds) {
            *pitch = motion.pitch;
            let wind = match &self.tower {
                Some(tower) => tower.felt(motion.position, *wind),
                None => *wind,
            };
            let relative = wind - motion.velocity;
            *onset = Onset {
                normal: relative.dot(motion.axes.normal),
                tangential: -relative.dot(motion.axes.tangent),
            };
        }
        let Self { onsets, pitch, loads, scratch, answering, .. } = self;
        if let Some(answering) = answering {
            if now.first {
                answering.begin(now.answer, now.motions);
            }
            answering.loads(line, onsets, pitch, sections, corrections, loads);
        } else if now.first {
            line.loads(onsets, now.rotor_speed, pitch, sections, corrections, loads, scratch);
        } else {
            // The wind has not been sampled anew, so the smearing correction is held as well.
            line.loads_under(onsets, pitch, sections, corrections, loads);
        }
    }

    /// On return `loads` holds the loads of `now` in the farm frame.
    fn apply(&self, line: &ActuatorLine, now: &Instant<'_>, loads: &mut [ElementLoad]) {
        let widths = line.elements().iter().cycle().map(|element| element.width);
        for (((applied, load), motion), width) in
            loads.iter_mut().zip(&self.loads).zip(now.motions).zip(widths)
        {
            let force = motion.axes.normal * load.normal + motion.axes.tangent * load.tangential;
            *applied = ElementLoad { force: force * width, moment: Vector3::ZERO };
        }
    }
}
