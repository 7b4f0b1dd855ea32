//! Lifting lines in air that feels bound vortices: the circulation of all elements, and the wind that it
//! brings about, found together.
//!
//! What leaves a blade in a step is longer than its elements are wide, so that a circulation taken from the
//! step before would overshoot from element to element. Here each element in turn is given the circulation
//! that its section has in the wind of the latest circulations of all, until none changes (Gauss-Seidel). The
//! wind answers to an element's own circulation more than to others', and that part is taken into account at
//! once with the slope of a thin aerofoil.
//!
//! A section whose lift falls with the angle of attack may have no circulation that its own answer bears out:
//! sweeps then do not end but grow, the wind of one circulation making the next. So sweeps that do not come
//! closer take smaller steps, and no answer is stronger than the wind that it answers to: what one step
//! leaves behind does not blow harder than what made it. Of attached flow neither changes a bit.

use crate::actuator_line::{ActuatorLine, Load, Onset, Sections};
use crate::motion::ElementMotion;
use basis::Answer;
use std::f64::consts::PI;

/// Most sweeps over the elements (–); a blade in attached flow needs about ten.
const MOST_SWEEPS: usize = 60;
/// Change of circulation over the greatest one at which the sweeps end (–).
const TOLERANCE: f64 = 1e-6;
/// Sweeps after which one that changes more than the one before halves the steps (–); until then the changes
/// of attached flow may rise too.
const PATIENCE: usize = 12;
/// Greatest answer over the wind that it answers to (–).
const STRONGEST: f64 = 1.0;

/// How the wind answers, seen along the axes of the elements, and how far it has.
#[derive(Clone, Debug)]
pub(super) struct Answering {
    /// Wind along an element's normal (row) per unit of circulation of another (column) (1/m).
    normal: Vec<f64>,
    /// The same along its tangent.
    tangential: Vec<f64>,
    /// Circulations with which the wind was sampled (m²/s).
    sampled: Vec<f64>,
    /// What is on top of them now (m²/s).
    changes: Vec<f64>,
    /// Whether the air answers.
    answers: bool,
}

impl Answering {
    /// Memory for `n` elements, all blades together.
    pub(super) fn new(n: usize) -> Self {
        let square = || vec![0.0; n * n];
        Self {
            normal: square(),
            tangential: square(),
            sampled: vec![0.0; n],
            changes: vec![0.0; n],
            answers: false,
        }
    }

    /// Takes `answer` up at the beginning of an interval, elements standing as `motions` has them. Blades and
    /// what leaves them turn together, so that it holds for the whole interval.
    pub(super) fn begin(&mut self, answer: Option<Answer<'_>>, motions: &[ElementMotion]) {
        let Self { normal, tangential, sampled, changes, answers } = self;
        *answers = answer.is_some();
        changes.fill(0.0);
        let Some(answer) = answer else { return };
        sampled.copy_from_slice(answer.circulations);
        let n = motions.len();
        for (row, motion) in motions.iter().enumerate() {
            let columns = row * n..(row + 1) * n;
            let parts = normal[columns.clone()].iter_mut().zip(&mut tangential[columns.clone()]);
            for ((normal, tangential), velocity) in parts.zip(&answer.influence[columns]) {
                *normal = velocity.dot(motion.axes.normal);
                *tangential = velocity.dot(motion.axes.tangent);
            }
        }
    }

    /// On return `loads` are those in the winds `onsets` and what they answer, which is in `corrections`
    /// (m/s); the rest as in [`ActuatorLine::loads`].
    pub(super) fn loads(
        &mut self,
        line: &ActuatorLine,
        onsets: &[Onset],
        pitch: &[f64],
        sections: &mut impl Sections,
        corrections: &mut [[f64; 2]],
        loads: &mut [Load],
    ) {
        corrections.fill([0.0; 2]);
        if self.answers {
            let (mut share, mut last) = (1.0, f64::INFINITY);
            for n_sweeps in 0..MOST_SWEEPS {
                let change = self.sweep(share, line, onsets, pitch, sections);
                if change <= TOLERANCE {
                    break;
                }
                if n_sweeps >= PATIENCE && change > last {
                    share *= 0.5;
                }
                last = change;
            }
            for (index, (correction, onset)) in corrections.iter_mut().zip(onsets).enumerate() {
                *correction = self.correction(index, *onset);
            }
        }
        line.loads_under(onsets, pitch, sections, corrections, loads);
    }

    /// Brings the circulation of each element in turn closer to its section's, by `share` (–) of the way;
    /// gives the greatest change over the greatest circulation (–).
    fn sweep(
        &mut self,
        share: f64,
        line: &ActuatorLine,
        onsets: &[Onset],
        pitch: &[f64],
        sections: &mut impl Sections,
    ) -> f64 {
        let n = onsets.len();
        let elements = line.elements();
        let (mut change, mut greatest) = (0.0_f64, f64::MIN_POSITIVE);
        for (index, onset) in onsets.iter().enumerate() {
            let felt = onset.with(self.correction(index, *onset));
            let found = line.load(index, felt, pitch[index], sections).circulation;
            let missing = found - (self.sampled[index] + self.changes[index]);
            // Γ reacts to an upwash with π c.
            let chord = elements[index % elements.len()].chord;
            let own = (PI * chord * self.normal[index * n + index]).min(0.0);
            let step = share * missing / (1.0 - own);
            self.changes[index] += step;
            change = change.max(step.abs());
            greatest = greatest.max(found.abs());
        }
        change / greatest
    }

    /// What the wind at element number `index` answers where it is `onset`, axial and tangential (m/s).
    fn correction(&self, index: usize, onset: Onset) -> [f64; 2] {
        let n = self.changes.len();
        let columns = index * n..(index + 1) * n;
        let answer = [&self.normal, &self.tangential].map(|influence| {
            let products = influence[columns.clone()].iter().zip(&self.changes);
            products.map(|(influence, change)| influence * change).sum::<f64>()
        });
        let strength = answer[0].hypot(answer[1]);
        let most = STRONGEST * onset.normal.hypot(onset.tangential);
        if strength > most { answer.map(|part| part * (most / strength)) } else { answer }
    }
}
