//! Dynamic stall: unsteady lift and drag of a section, with the shed wake's delay in attached flow and lagged
//! trailing-edge separation.
//!
//! Source: Hansen, Gaunaa, Madsen, "A Beddoes-Leishman type dynamic stall model in state-space and indicial
//! formulations", Risø-R-1354, 2004 (four states per section; AeroDyn's `UAMod` 4), with the lift response of
//! a flat plate after Jones, NACA report 681, 1940. Its parameters follow from the section's polar.
//!
//! Inputs are those of one section: angle of attack, relative speed, chord, rotation. A rotor in prescribed
//! wind uses the model, and so can one in a flow that resolves its induction. That flow contains, smeared,
//! part of the wake that the attached-flow delay models; [`Attached::Steady`] leaves this delay out and keeps
//! that of separation.

use super::{Polar, SectionCoefficients};
use basis::angle::wrap_to_half_turn;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Amplitudes of the lift response of a flat plate (–), and their rates per half chord travelled (–).
const AMPLITUDES: [f64; 2] = [0.165, 0.335];
const RATES: [f64; 2] = [0.0455, 0.3];
/// Delay of the leading edge's pressure, and of the separation point, in half chords travelled (–).
const PRESSURE_DELAY: f64 = 1.7;
const SEPARATION_DELAY: f64 = 3.0;
/// Angles of attack (rad) up to which the model holds fully, and beyond which the polar alone does; blended
/// in between.
const FULL: f64 = 45.0 * PI / 180.0;
const NONE: f64 = 60.0 * PI / 180.0;
/// Range of angles from the zero-lift angle (rad) in which the slope of attached flow is searched.
const LINEAR: [f64; 2] = [1.5 * PI / 180.0, 8.0 * PI / 180.0];
/// Range in which the zero-lift angle is searched, ± (rad).
const ZERO_LIFT: f64 = 15.0 * PI / 180.0;
/// Least slope of lift (1/rad) of an aerofoil; sections with less are cylinders.
const LEAST_SLOPE: f64 = 1.0;
/// Width around the zero-lift angle (rad) in which flow counts as attached: lift over its linear law is 0/0
/// there.
const ATTACHED_WIDTH: f64 = PI / 180.0;
/// Least relative speed (m/s) that delays are computed with.
const LEAST_SPEED: f64 = 0.01;

/// Whether lift in attached flow has a delay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Attached {
    /// Lift follows the shed wake.
    #[default]
    Delayed,
    /// Lift follows the angle of attack at once, for a flow that resolves the wake.
    Steady,
}

/// Parameters of the model, from a section's polar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicStall {
    /// Angle of attack without lift α₀ (rad).
    pub zero_lift_angle: f64,
    /// Slope of lift in attached flow (1/rad).
    pub lift_slope: f64,
    /// Drag coefficient without lift (–).
    pub zero_lift_drag: f64,
    /// Amplitudes of the wake's delay (–).
    amplitudes: [f64; 2],
}

/// Flow past a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stream {
    /// Angle of attack at the aerodynamic centre (rad).
    pub angle_of_attack: f64,
    /// Relative speed (m/s).
    pub speed: f64,
    /// Chord (m).
    pub chord: f64,
    /// Rate at which the section turns nose up (rad/s); minus the pitch rate of a blade.
    pub rotation: f64,
}

/// State of the flow about a section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StallState {
    /// Lagged parts of the downwash at three quarters of the chord (m/s).
    downwashes: [f64; 2],
    /// Lift coefficient lagged by the leading-edge pressure (–).
    pressure_lift: f64,
    /// Share of the chord over which flow is attached (–).
    attachment: f64,
    /// Inputs of the four lags at the last instant.
    driven_by: Drive,
}

/// Inputs of the states: speed (m/s), downwash (m/s), lift coefficient of attached flow and attachment (–).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Drive {
    speed: f64,
    downwash: f64,
    lift: f64,
    attachment: f64,
}

impl StallState {
    /// Share of the chord, from the leading edge, over which flow is attached (–).
    pub fn attachment(&self) -> f64 {
        self.attachment
    }
}

impl DynamicStall {
    /// Parameters from `polar`; None for a section that is no aerofoil, such as a cylinder, whose polar holds
    /// at once.
    ///
    /// The zero-lift angle is where lift rises through zero nearest to 0°, within 15°; the slope is the
    /// steepest line from there to the polar between 1.5° and 8° on either side.
    pub fn new(polar: &Polar, attached: Attached) -> Option<Self> {
        let rows: Vec<(f64, SectionCoefficients)> = polar.rows().collect();
        let zero_lift_angle = rows
            .windows(2)
            .filter(|rows| rows[0].1.lift < 0.0 && rows[1].1.lift >= 0.0)
            .map(|rows| {
                let [(from, low), (to, high)] = [rows[0], rows[1]];
                from - low.lift * (to - from) / (high.lift - low.lift)
            })
            .filter(|angle| angle.abs() < ZERO_LIFT)
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let lift_slope = rows
            .iter()
            .map(|(angle, section)| (angle - zero_lift_angle, section.lift))
            .filter(|(angle, _)| (LINEAR[0]..=LINEAR[1]).contains(&angle.abs()))
            .map(|(angle, lift)| lift / angle)
            .fold(0.0, f64::max);
        let amplitudes = match attached {
            Attached::Delayed => AMPLITUDES,
            Attached::Steady => [0.0; 2],
        };
        let zero_lift_drag = polar.at(zero_lift_angle).drag;
        (lift_slope > LEAST_SLOPE).then_some(Self {
            zero_lift_angle,
            lift_slope,
            zero_lift_drag,
            amplitudes,
        })
    }

    /// Steady state of a section of `polar` in `stream`.
    pub fn settled(&self, stream: &Stream, polar: &Polar) -> StallState {
        let Stream { speed, chord, rotation, .. } = *stream;
        let speed = speed.max(LEAST_SPEED);
        let angle = within_reach(stream.angle_of_attack) + 0.5 * chord * rotation / speed;
        let downwash = speed * angle;
        let lift = self.attached_lift(angle) + 0.5 * PI * chord / speed * rotation;
        let attachment =
            self.steady_attachment(lift / self.lift_slope + self.zero_lift_angle, polar);
        StallState {
            downwashes: self.amplitudes.map(|amplitude| amplitude * downwash),
            pressure_lift: lift,
            attachment,
            driven_by: Drive { speed, downwash, lift, attachment },
        }
    }

    /// Coefficients of a section of `polar` in `stream`; on return `state` has been advanced by `interval`
    /// (s) to this instant.
    ///
    /// Exact for inputs held at the mean of the interval's ends, so that any interval is stable.
    pub fn advance(
        &self,
        interval: f64,
        stream: &Stream,
        polar: &Polar,
        state: &mut StallState,
    ) -> SectionCoefficients {
        // Symbols of Hansen et al. 2004: alpha_e and alpha_f effective angles, f and x4 attachment.
        let angle_of_attack = if stream.angle_of_attack.abs() <= PI {
            stream.angle_of_attack
        } else {
            wrap_to_half_turn(stream.angle_of_attack)
        };
        let share = ((NONE - angle_of_attack.abs()) / (NONE - FULL)).min(1.0);
        if share <= 0.0 {
            *state = self.settled(&Stream { angle_of_attack, ..*stream }, polar);
            return polar.at(angle_of_attack);
        }
        let speed = stream.speed.max(LEAST_SPEED);
        let inverse_speed = 1.0 / speed;
        let half_chord_time = 0.5 * stream.chord * inverse_speed;
        let before = state.driven_by;
        let travelled = interval * (speed + before.speed) / stream.chord;
        let decay = |rate: f64| (-rate * travelled).exp();

        let angle = angle_of_attack + half_chord_time * stream.rotation;
        let downwash = speed * angle;
        let mean_downwash = 0.5 * (downwash + before.downwash);
        let [a1, a2] = self.amplitudes;
        let mut alpha_e = angle * (1.0 - a1 - a2);
        if a1 != 0.0 {
            for ((part, amplitude), rate) in
                state.downwashes.iter_mut().zip(self.amplitudes).zip(RATES)
            {
                let reached = amplitude * mean_downwash;
                *part = reached + (*part - reached) * decay(rate);
                alpha_e += *part * inverse_speed;
            }
        }
        // Downwash from a faster flow, over a speed near zero, would give any angle.
        let alpha_e = within_reach(alpha_e);
        let apparent_mass = PI * half_chord_time * stream.rotation;
        let lift = self.attached_lift(alpha_e) + apparent_mass;
        let mean_lift = 0.5 * (lift + before.lift);
        state.pressure_lift =
            mean_lift + (state.pressure_lift - mean_lift) * decay(1.0 / PRESSURE_DELAY);
        let alpha_f = state.pressure_lift / self.lift_slope + self.zero_lift_angle;
        let attachment = self.steady_attachment(alpha_f, polar);
        let mean_attachment = 0.5 * (attachment + before.attachment);
        state.attachment =
            mean_attachment + (state.attachment - mean_attachment) * decay(1.0 / SEPARATION_DELAY);
        state.driven_by = Drive { speed, downwash, lift, attachment };
        let angles = [angle_of_attack, alpha_e];
        let dynamic = self.separating(angles, state.attachment, apparent_mass, polar);
        if share < 1.0 { fade(dynamic, polar.at(angle_of_attack), share) } else { dynamic }
    }

    /// Coefficients at the geometric and the effective angle of attack (rad) of a section whose flow is
    /// attached to the share `x4` (–), with `apparent_mass` as a lift coefficient (–).
    fn separating(
        &self,
        [angle_of_attack, alpha_e]: [f64; 2],
        x4: f64,
        apparent_mass: f64,
        polar: &Polar,
    ) -> SectionCoefficients {
        // Symbols of Hansen et al. 2004, as above.
        let steady = polar.at(alpha_e);
        let linear = self.attached_lift(alpha_e);
        let root = self.separation_root(steady.lift, linear, alpha_e);
        let f = (2.0 * root - 1.0) * (2.0 * root - 1.0);
        // Fully separated lift, from C_st = linear · f + separated · (1 − f) with f of the polar.
        let separated =
            if root > 0.5 { linear * (3.0 * root - 1.0) / (4.0 * root) } else { steady.lift };
        let circulatory = steady.lift + (x4 - f) * (linear - separated);
        let lift = circulatory + apparent_mass;
        let separation_drag = 0.5 * (2.0 * root - 1.0 - x4.sqrt()) - 0.25 * (f - x4);
        let drag = steady.drag
            + (angle_of_attack - alpha_e) * lift
            + (steady.drag - self.zero_lift_drag) * separation_drag;
        let moment = steady.moment - 0.5 * apparent_mass;
        SectionCoefficients { lift, drag, moment }
    }

    fn attached_lift(&self, angle: f64) -> f64 {
        self.lift_slope * (angle - self.zero_lift_angle)
    }

    /// Attachment of steady flow (–) at `angle` (rad).
    fn steady_attachment(&self, angle: f64, polar: &Polar) -> f64 {
        let angle = within_reach(angle);
        let lift = polar.at(angle).lift;
        let root = self.separation_root(lift, self.attached_lift(angle), angle);
        (2.0 * root - 1.0) * (2.0 * root - 1.0)
    }

    /// (1 + √f)/2 of Kirchhoff's flow (–), between one half (separated) and one, from `lift` at `angle` (rad)
    /// and that of attached flow, `linear`.
    fn separation_root(&self, lift: f64, linear: f64, angle: f64) -> f64 {
        if angle.abs() >= NONE {
            return 0.5;
        }
        let width = ATTACHED_WIDTH * self.lift_slope;
        let ratio = (lift * linear + width * width) / (linear * linear + width * width);
        ratio.clamp(0.25, 1.0).sqrt()
    }
}

/// The angle (rad) limited to the range of the model.
fn within_reach(angle: f64) -> f64 {
    angle.clamp(-NONE, NONE)
}

/// Blend of `dynamic` coefficients with weight `share` (–) and the polar's with the rest.
fn fade(
    dynamic: SectionCoefficients,
    steady: SectionCoefficients,
    share: f64,
) -> SectionCoefficients {
    let blend = |to: f64, from: f64| from + share * (to - from);
    SectionCoefficients {
        lift: blend(dynamic.lift, steady.lift),
        drag: blend(dynamic.drag, steady.drag),
        moment: blend(dynamic.moment, steady.moment),
    }
}

#[cfg(test)]
mod tests;
