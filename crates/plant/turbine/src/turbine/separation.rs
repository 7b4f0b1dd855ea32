//! Dynamic stall of the sections of actuator lines: flow separates and reattaches with delay.
//!
//! The delay of lift in attached flow is left out ([`Attached::Steady`]): it models the wake that a section
//! sheds, and a flow that resolves the induction contains the part of that wake farther away than the
//! smearing length.

use crate::actuator_line::{Element, Sections};
use crate::aero::Polar;
use crate::aero::dynamic_stall::{Attached, DynamicStall, StallState, Stream};
use crate::definition::Definition;
use crate::structure::Pitch;
use serde::{Deserialize, Serialize};

/// The sections of a rotor, with working memory.
#[derive(Clone, Debug)]
pub(super) struct Separation {
    /// Of one blade; all are alike.
    sections: Vec<Section>,
    /// State of every section of every blade at the end of the step.
    next: Vec<StallState>,
}

#[derive(Clone, Debug)]
struct Section {
    polar: Polar,
    chord: f64,
    /// None for cylinders.
    stall: Option<DynamicStall>,
}

/// State of the flow about all sections.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Flow {
    /// Whether a step has been made; the first one starts from the steady state.
    started: bool,
    sections: Vec<StallState>,
}

/// A time step of the flow about the sections.
pub(super) struct Step<'a> {
    separation: &'a mut Separation,
    before: &'a Flow,
    interval: f64,
    pitch: &'a [Pitch],
}

impl Separation {
    /// The sections of `elements` on each blade of `definition`.
    pub(super) fn new(definition: &Definition, elements: &[Element]) -> Self {
        let section = |element: &Element| {
            let polar = element.polar(definition);
            let stall = DynamicStall::new(&polar, Attached::Steady);
            Section { polar, chord: element.chord, stall }
        };
        let next = vec![StallState::default(); definition.n_blades * elements.len()];
        Self { sections: elements.iter().map(section).collect(), next }
    }

    /// The flow before the first step.
    pub(super) fn start(&self) -> Flow {
        Flow { started: false, sections: vec![StallState::default(); self.next.len()] }
    }

    /// The step from `before` by `interval` (s) under the `pitch` of each blade.
    pub(super) fn step<'a>(
        &'a mut self,
        before: &'a Flow,
        interval: f64,
        pitch: &'a [Pitch],
    ) -> Step<'a> {
        Step { separation: self, before, interval, pitch }
    }

    /// On return `flow` is the state at the end of the last step.
    pub(super) fn store_in(&self, flow: &mut Flow) {
        flow.started = true;
        flow.sections.copy_from_slice(&self.next);
    }
}

impl Sections for Step<'_> {
    fn coefficients(&mut self, index: usize, angle_of_attack: f64, speed: f64) -> [f64; 2] {
        let Separation { sections, next } = &mut *self.separation;
        let n = sections.len();
        let Section { polar, chord, stall } = &sections[index % n];
        let Some(stall) = stall else {
            let steady = polar.at(angle_of_attack);
            return [steady.lift, steady.drag];
        };
        let rotation = -self.pitch[index / n].rate;
        let stream = Stream { angle_of_attack, speed, chord: *chord, rotation };
        let state = &mut next[index];
        let interval = if self.before.started {
            *state = self.before.sections[index];
            self.interval
        } else {
            *state = stall.settled(&stream, polar);
            0.0
        };
        let now = stall.advance(interval, &stream, polar, state);
        [now.lift, now.drag]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator_line::{ActuatorLine, QuasiSteady};
    use crate::turbine::tests::machine;

    /// Seconds; a section travels about half a chord in it.
    const INTERVAL: f64 = 0.02;

    fn pitch(rate: f64) -> [Pitch; 3] {
        [Pitch { rate, ..Pitch::default() }; 3]
    }

    /// However often the sections are evaluated, they advance once a step, as the model alone does.
    #[test]
    fn the_last_call_counts() {
        let definition = machine();
        let line = ActuatorLine::new(definition.clone(), 8, 1.2, 12.0, 0.0);
        let mut separation = Separation::new(&definition, line.elements());
        let mut flow = separation.start();
        let (index, speed) = (13, 60.0);
        let Section { polar, chord, stall } = separation.sections[index % 8].clone();
        let stall = stall.expect("an aerofoil");
        let mut alone: Option<StallState> = None;
        for step in 0..50 {
            let angle_of_attack = 0.2 + 0.15 * (0.3 * f64::from(step)).sin();
            let rate = 0.02 * (0.3 * f64::from(step)).cos();
            let blades = pitch(rate);
            let mut now = separation.step(&flow, INTERVAL, &blades);
            let mut answer = [0.0; 2];
            for trial in [0.1, -0.05, 0.0] {
                for index in 0..24 {
                    let shown = now.coefficients(index, angle_of_attack + trial, speed);
                    if index == 13 {
                        answer = shown;
                    }
                }
            }
            separation.store_in(&mut flow);
            let stream = Stream { angle_of_attack, speed, chord, rotation: -rate };
            let interval = if alone.is_some() { INTERVAL } else { 0.0 };
            let state = alone.get_or_insert_with(|| stall.settled(&stream, &polar));
            let expected = stall.advance(interval, &stream, &polar, state);
            assert_eq!(answer, [expected.lift, expected.drag], "step {step}");
        }
        assert_eq!(flow.sections[index], alone.expect("a state"));
    }

    #[test]
    fn flow_that_does_not_change_answers_as_the_polar() {
        let definition = machine();
        let line = ActuatorLine::new(definition.clone(), 8, 1.2, 12.0, 0.0);
        let mut separation = Separation::new(&definition, line.elements());
        let mut flow = separation.start();
        let blades = pitch(0.0);
        for (step, angle) in [(0, 0.05), (1, 0.05), (2, 0.05)] {
            let mut now = separation.step(&flow, INTERVAL, &blades);
            for index in 0..24 {
                let [lift, drag] = now.coefficients(index, angle, 60.0);
                let [steady_lift, steady_drag] =
                    QuasiSteady(&line).coefficients(index, angle, 60.0);
                assert!((lift - steady_lift).abs() < 1e-12, "{step} {index}: {lift} {steady_lift}");
                assert!((drag - steady_drag).abs() < 1e-12, "{step} {index}: {drag} {steady_drag}");
            }
            separation.store_in(&mut flow);
        }
    }
}
