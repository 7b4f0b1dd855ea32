//! A swashplate: three rods move a plate across the shaft, from which all blades are pitched.
//!
//! Symbols: ψ azimuth of a blade, γ_k azimuth of rod k, s_k travel of rod k, r_a and r_l distance of rods and
//! pitch links from the shaft, h length of the blades' pitch horns. A plane through the rods' ends has
//!
//! ```text
//! average = Σ s_k / 3     tilt = 2/3 r_l/r_a Σ s_k cos γ_k     yaw = 2/3 r_l/r_a Σ s_k sin γ_k
//! ```
//!
//! and a blade's pitch β follows from h sin β = average + tilt cos ψ + yaw sin ψ: the multi-blade
//! transformation as a mechanism. Rods need to be no faster than the excitation in the fixed frame, however
//! fast the rotor turns. What it cannot do is pitch blades otherwise than by average, tilt and yaw.
//!
//! A real plate has play and is not quite flat on its shaft: van der Hoek et al., Wind Energy (2024),
//! doi:10.1002/we.2896, §2.2, measured other amplitudes for the same motors where the tilt goes round with
//! the rotor than where it goes against it, and a bias of yaw, so that the amplitude varies over a period.
//! Where from the two amplitudes come they do not say. Here the plate has play about the shaft: it follows
//! the direction in which the rods tilt it with a lag of the slack, and leans on one flank or on the other,
//! each with a gain of its own.

use super::{PitchActuator, PitchState};
use basis::angle::wrap_to_half_turn;
use basis::mbc::{blade_azimuth, to_blades, to_fixed_frame};
use basis::{FixedFrame, PerBlade};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Rods (–).
pub const N_RODS: usize = 3;
/// A plate tilted by less than this over the length of the horns has no direction (–).
const LEAST_TILT: f64 = 1e-9;

/// What turns the angle of a motor into the travel of its rod.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    /// A nut on a threaded shaft.
    Screw {
        /// Travel over angle (m/rad).
        lead: f64,
    },
    /// An arm on the motor, across the rod at angle zero.
    Crank {
        /// Length of the arm (m).
        length: f64,
    },
}

impl Drive {
    /// Travel (m) at `angle` (rad) of the motor.
    pub fn travel(&self, angle: f64) -> f64 {
        match *self {
            Self::Screw { lead } => lead * angle,
            Self::Crank { length } => length * angle.sin(),
        }
    }

    /// Angle of the motor (rad) at `travel` (m); a crank stops a quarter of a turn away.
    pub fn angle(&self, travel: f64) -> f64 {
        match *self {
            Self::Screw { lead } => travel / lead,
            Self::Crank { length } => (travel / length).clamp(-1.0, 1.0).asin(),
        }
    }

    /// Travel over angle about angle zero (m/rad).
    fn ratio(&self) -> f64 {
        match *self {
            Self::Screw { lead } => lead,
            Self::Crank { length } => length,
        }
    }
}

/// A swashplate as plain data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swashplate {
    /// What moves the rods.
    pub drive: Drive,
    /// Shaft to rods (m).
    pub rod_radius: f64,
    /// Shaft to pitch links (m).
    pub link_radius: f64,
    /// Pitch axis of a blade to its link (m).
    pub horn_length: f64,
    /// Azimuth of the first rod (rad); the others follow a third of a turn apart, as blades do.
    pub rod_azimuth: f64,
    /// Tilt and yaw of the blades' pitch with the plate straight (rad).
    pub bias: [f64; 2],
    /// Play of the plate about the shaft, either way (rad).
    pub slack: f64,
    /// Tilt of the plate over that of the rods (–): where its direction goes round with the rotor, and
    /// where it goes against it.
    pub gains: [f64; 2],
}

/// State of a swashplate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SwashplateState {
    /// Angle of each motor and its rate (rad, rad/s).
    pub motors: [PitchState; N_RODS],
    /// Share of the slack that is used up (–): 1 on the flank of a direction that goes with the rotor, −1 on
    /// the other.
    flank: f64,
    /// Azimuth at which the rods' plane has most travel (rad); none before they tilted it.
    direction: Option<f64>,
}

impl Swashplate {
    /// The state with all blades at `pitch` (rad), at rest.
    pub fn at_rest(&self, pitch: f64) -> SwashplateState {
        let angle = self.motor_at(pitch);
        let motors = [PitchState { pitch: angle, rate: 0.0 }; N_RODS];
        SwashplateState { motors, flank: 0.0, direction: None }
    }

    /// Angles of the motors (rad) that a straight plate without play would need for the `pitch` (rad) of
    /// blades of which the first is at `azimuth` (rad). What of the pitch no plate can do is lost.
    pub fn motors_for(&self, azimuth: f64, pitch: &PerBlade<f64>) -> [f64; N_RODS] {
        let links = pitch.map(|pitch| self.horn_length * pitch.sin());
        let FixedFrame { average, tilt, yaw } = to_fixed_frame(azimuth, &links);
        let lever = self.rod_radius / self.link_radius;
        let rods = FixedFrame { average, tilt: lever * tilt, yaw: lever * yaw };
        let travels = to_blades(self.rod_azimuth, rods, N_RODS);
        std::array::from_fn(|rod| self.drive.angle(travels[rod]))
    }

    /// Advances `state` by `interval` (s) towards the constant `angles` (rad) of the motors, each of which is
    /// an `actuator` whose limits are those of collective pitch; true if a limit acted.
    pub fn advance(
        &self,
        actuator: &PitchActuator,
        state: &mut SwashplateState,
        interval: f64,
        angles: &[f64; N_RODS],
    ) -> bool {
        let motor = PitchActuator {
            maximum_rate: actuator.maximum_rate * self.horn_length / self.drive.ratio(),
            minimum_pitch: self.motor_at(actuator.minimum_pitch),
            maximum_pitch: self.motor_at(actuator.maximum_pitch),
            ..*actuator
        };
        let mut limited = false;
        for (state, angle) in state.motors.iter_mut().zip(angles) {
            limited |= motor.advance(state, interval, *angle);
        }
        let plane = self.plane(&state.motors.map(|motor| self.drive.travel(motor.pitch)));
        self.follow(state, plane);
        limited
    }

    /// Pitch and pitch rate of `n_blades` blades on the plate in `state`, the first at `azimuth` (rad), at
    /// `rotor_speed` (rad/s).
    pub fn blades(
        &self,
        state: &SwashplateState,
        azimuth: f64,
        rotor_speed: f64,
        n_blades: usize,
    ) -> PerBlade<PitchState> {
        let plane = self.plane(&state.motors.map(|motor| self.drive.travel(motor.pitch)));
        let rates = self.plane(&state.motors.map(|motor| {
            let slope = match self.drive {
                Drive::Screw { lead } => lead,
                Drive::Crank { length } => length * motor.pitch.cos(),
            };
            slope * motor.rate
        }));
        let (plate, rates) = (self.lean(state, plane), self.lean(state, rates));
        let [bias_tilt, bias_yaw] = self.bias;
        PerBlade::from_fn(n_blades, |blade| {
            let (sine, cosine) = blade_azimuth(azimuth, blade, n_blades).sin_cos();
            let link = plate.average + plate.tilt * cosine + plate.yaw * sine;
            let moves = rates.average + rates.tilt * cosine + rates.yaw * sine;
            let turns = rotor_speed * (plate.yaw * cosine - plate.tilt * sine);
            let angle = (link / self.horn_length).clamp(-1.0, 1.0).asin();
            let reach = self.horn_length * angle.cos().max(LEAST_TILT);
            PitchState {
                pitch: angle + bias_tilt * cosine + bias_yaw * sine,
                rate: (moves + turns) / reach
                    + rotor_speed * (bias_yaw * cosine - bias_tilt * sine),
            }
        })
    }

    /// Angle of all motors (rad) that pitches all blades by `pitch` (rad).
    pub fn motor_at(&self, pitch: f64) -> f64 {
        self.drive.angle(self.horn_length * pitch.sin())
    }

    /// The plane through the ends of rods with `travels` (m), at the radius of the links (m).
    fn plane(&self, travels: &[f64; N_RODS]) -> FixedFrame {
        let rods = to_fixed_frame(self.rod_azimuth, &PerBlade::from_fn(N_RODS, |rod| travels[rod]));
        let lever = self.link_radius / self.rod_radius;
        FixedFrame { tilt: lever * rods.tilt, yaw: lever * rods.yaw, ..rods }
    }

    /// On return the plate in `state` leans on the flank to which the tilt of `plane` (m) took it.
    fn follow(&self, state: &mut SwashplateState, plane: FixedFrame) {
        if plane.tilt.hypot(plane.yaw) < LEAST_TILT * self.horn_length {
            return;
        }
        let direction = plane.yaw.atan2(plane.tilt);
        let turned = state.direction.map_or(0.0, |before| wrap_to_half_turn(direction - before));
        state.direction = Some(direction);
        // Without slack the flank changes with the sense.
        let share = turned / self.slack.max(f64::MIN_POSITIVE);
        state.flank = (state.flank + share).clamp(-1.0, 1.0);
    }

    /// What the plate in `state` makes of the rods' `plane`: turned back by the slack that is used up, with
    /// the gain of its flank.
    fn lean(&self, state: &SwashplateState, plane: FixedFrame) -> FixedFrame {
        let [with, against] = self.gains;
        let gain = 0.5 * (with + against) + 0.5 * (with - against) * state.flank;
        let (sine, cosine) = (state.flank * self.slack).sin_cos();
        FixedFrame {
            average: plane.average,
            tilt: gain * (plane.tilt * cosine + plane.yaw * sine),
            yaw: gain * (plane.yaw * cosine - plane.tilt * sine),
        }
    }

    /// Amplitude of cyclic pitch (rad) that a straight plate without play makes of motors that go to and fro
    /// by `angle` (rad), a third of a period apart.
    pub fn amplitude_of(&self, angle: f64) -> f64 {
        let link = self.link_radius / self.rod_radius * self.drive.travel(angle);
        (link / self.horn_length).clamp(-1.0, 1.0).asin()
    }

    /// Turns of a motor over those of the blades in collective pitch, about zero (–).
    pub fn motor_ratio(&self) -> f64 {
        self.horn_length / self.drive.ratio()
    }
}

/// Travel over angle (m/rad) of a screw with `travel` (m) a turn.
pub fn lead_of(travel: f64) -> f64 {
    travel / TAU
}

#[cfg(test)]
mod tests;
