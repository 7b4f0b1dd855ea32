//! From pitch commands to the pitch of the blades: an actuator on each, or a swashplate for all.

use super::Turbine;
use crate::actuators::{N_RODS, PitchState};
use crate::structure::Pitch;
use basis::{Commands, PerBlade};

/// What the actuators are asked for over an interval.
pub(super) enum Asked {
    /// Pitch of each blade (rad).
    OfBlades(PerBlade<f64>),
    /// Angle of each motor of the swashplate (rad).
    OfMotors([f64; N_RODS]),
}

impl Turbine {
    /// What `commands` ask of the actuators. A swashplate is told how it shall stand, and the blades go round
    /// on it: it takes what it is asked for at the azimuth at which that was decided, now.
    pub(super) fn asked(&self, commands: &Commands) -> Asked {
        match &self.definition.swashplate {
            Some(plate) => {
                Asked::OfMotors(plate.motors_for(self.structure.azimuth(), &commands.pitch))
            }
            None => Asked::OfBlades(commands.pitch),
        }
    }

    /// Advances the pitch actuators by `step` (s) towards what is `asked`; gives pitch in the middle of it.
    /// On return `limited` is true if a limit acted.
    pub(super) fn pitch_blades(
        &mut self,
        step: f64,
        asked: &Asked,
        limited: &mut bool,
    ) -> PerBlade<Pitch> {
        let before = self.state.pitch;
        let after = match asked {
            Asked::OfBlades(commands) => self.pitch_each(step, commands, limited),
            Asked::OfMotors(motors) => self.pitch_by_plate(step, motors, limited),
        };
        self.state.pitch = after;
        PerBlade::from_fn(after.len(), |blade| {
            let (before, after) = (before[blade], after[blade]);
            Pitch {
                angle: 0.5 * (before.pitch + after.pitch) + self.misalignment[blade],
                rate: (after.pitch - before.pitch) / step,
                acceleration: (after.rate - before.rate) / step,
            }
        })
    }

    /// Pitch of the blades (rad, rad/s) a `step` (s) later, each with an actuator of its own.
    fn pitch_each(
        &self,
        step: f64,
        commands: &PerBlade<f64>,
        limited: &mut bool,
    ) -> PerBlade<PitchState> {
        let mut blades = self.state.pitch;
        for (blade, command) in blades.iter_mut().zip(commands.iter()) {
            *limited |= self.definition.pitch_actuator.advance(blade, step, *command);
        }
        blades
    }

    /// The same on a swashplate.
    fn pitch_by_plate(
        &mut self,
        step: f64,
        motors: &[f64; N_RODS],
        limited: &mut bool,
    ) -> PerBlade<PitchState> {
        let n_blades = self.state.pitch.len();
        let (Some(plate), Some(state)) = (&self.definition.swashplate, &mut self.state.swashplate)
        else {
            return self.state.pitch;
        };
        *limited |= plate.advance(&self.definition.pitch_actuator, state, step, motors);
        let speed = self.structure.rotor_speed();
        plate.blades(state, self.structure.azimuth() + speed * step, speed, n_blades)
    }
}

#[cfg(test)]
mod tests;
