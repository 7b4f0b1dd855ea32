//! Winds in closed form: shear, veer, steps and ramps, the gusts of IEC 61400-1, a disk of slow air that circles.

mod disk;

pub use disk::RotatingDisk;

use super::{InflowError, MeanProfile, not_negative, positive};
use crate::Inflow;
use basis::Vector3;
use std::f64::consts::{PI, TAU};

/// Duration of the extreme operating gust (s).
pub const OPERATING_GUST_DURATION: f64 = 10.5;
/// Duration of the extreme direction change (s).
pub const DIRECTION_CHANGE_DURATION: f64 = 6.0;
/// Rise time of the extreme coherent gust with direction change (s).
pub const COHERENT_GUST_DURATION: f64 = 10.0;
/// Duration of the extreme wind shear (s).
pub const EXTREME_SHEAR_DURATION: f64 = 12.0;

/// A wind without chance: a mean profile that veers with height, and one event in time.
///
/// The event comes to all places at once, wherever they lie along x. Directions are angles of the horizontal wind
/// from x, counter-clockwise seen from above: positive blows towards +y, to the left looking downwind.
#[derive(Clone, Debug, PartialEq)]
pub struct DeterministicWind {
    /// Speed over height before the event.
    pub profile: MeanProfile,
    /// Hub height (m), where veer is zero.
    pub hub_height: f64,
    /// Veer (rad/m): the wind turns clockwise, seen from above, by so much per metre upwards, as it does in the
    /// boundary layer of the northern hemisphere; negative backs.
    pub veer: f64,
    /// What happens.
    pub event: Event,
}

/// What happens in time. Times in s since the run's start.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Nothing.
    Steady,
    /// The whole profile is multiplied so that its hub speed becomes `speed` at once.
    Step {
        /// Time of the step (s).
        start: f64,
        /// Hub speed afterwards (m/s).
        speed: f64,
    },
    /// As [`Step`](Self::Step), linearly over `duration`.
    Ramp {
        /// Beginning (s).
        start: f64,
        /// How long it takes (s).
        duration: f64,
        /// Hub speed afterwards (m/s).
        speed: f64,
    },
    /// Steps of equal rise, each held for `hold`.
    Staircase {
        /// Time of the first step (s).
        start: f64,
        /// Time between steps (s).
        hold: f64,
        /// Rise of the hub speed per step (m/s), negative falls.
        rise: f64,
        /// Number of steps (–).
        n_steps: u32,
    },
    /// Extreme operating gust: a dip, a rise, a dip. [IEC61400-1 ed. 3, eq. 18]
    OperatingGust {
        /// Beginning (s).
        start: f64,
        /// Duration (s), [`OPERATING_GUST_DURATION`].
        duration: f64,
        /// Gust V_gust (m/s), [`operating_gust`](super::iec::operating_gust).
        gust: f64,
    },
    /// Extreme direction change. [IEC61400-1 ed. 3, eq. 21]
    DirectionChange {
        /// Beginning (s).
        start: f64,
        /// Duration (s), [`DIRECTION_CHANGE_DURATION`].
        duration: f64,
        /// Change (rad), [`direction_change`](super::iec::direction_change), either sign.
        change: f64,
    },
    /// Extreme coherent gust with direction change. [IEC61400-1 ed. 3, eqs. 22, 24]
    CoherentGust {
        /// Beginning (s).
        start: f64,
        /// Rise time (s), [`COHERENT_GUST_DURATION`].
        duration: f64,
        /// Rise of the speed (m/s), [`COHERENT_GUST`](super::iec::COHERENT_GUST).
        rise: f64,
        /// Change of direction (rad), [`coherent_direction_change`](super::iec::coherent_direction_change), either sign.
        change: f64,
    },
    /// Extreme wind shear, vertical or horizontal or both. [IEC61400-1 ed. 3, eqs. 26, 27]
    ExtremeShear {
        /// Beginning (s).
        start: f64,
        /// Duration (s), [`EXTREME_SHEAR_DURATION`].
        duration: f64,
        /// Rotor diameter (m).
        diameter: f64,
        /// Lateral place of the hub (m).
        hub_y: f64,
        /// Largest change of speed one radius above the hub (m/s), [`extreme_shear`](super::iec::extreme_shear), either sign.
        vertical: f64,
        /// The same one radius to the left of the hub, looking downwind (m/s).
        horizontal: f64,
    },
    /// Slow air that circles.
    RotatingDisk(RotatingDisk),
}

impl DeterministicWind {
    /// `profile` alone, the same for all time; `hub_height` in m.
    pub fn steady(profile: MeanProfile, hub_height: f64) -> Self {
        Self { profile, hub_height, veer: 0.0, event: Event::Steady }
    }

    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used: a number that is not finite, a duration or length that is
    /// not positive.
    pub fn check(&self) -> Result<(), InflowError> {
        let finite = |name, value: f64| {
            let expected = "a finite number";
            if value.is_finite() {
                Ok(())
            } else {
                Err(InflowError::Setting { name, value, expected })
            }
        };
        self.profile.check()?;
        positive("hub height (m)", self.hub_height)?;
        finite("veer (rad/m)", self.veer)?;
        match &self.event {
            Event::Steady => Ok(()),
            Event::Step { start, speed } => {
                finite("start of the step (s)", *start)?;
                not_negative("speed after the step (m/s)", *speed)
            }
            Event::Ramp { start, duration, speed } => {
                finite("start of the ramp (s)", *start)?;
                positive("duration of the ramp (s)", *duration)?;
                not_negative("speed after the ramp (m/s)", *speed)
            }
            Event::Staircase { start, hold, rise, n_steps } => {
                finite("start of the staircase (s)", *start)?;
                positive("time between steps (s)", *hold)?;
                finite("rise per step (m/s)", *rise)?;
                let last = self.profile.hub_speed() + rise * f64::from(*n_steps);
                not_negative("speed after the last step (m/s)", last)
            }
            Event::OperatingGust { start, duration, gust } => {
                finite("start of the gust (s)", *start)?;
                positive("duration of the gust (s)", *duration)?;
                finite("gust (m/s)", *gust)
            }
            Event::DirectionChange { start, duration, change } => {
                finite("start of the direction change (s)", *start)?;
                positive("duration of the direction change (s)", *duration)?;
                finite("change of direction (rad)", *change)
            }
            Event::CoherentGust { start, duration, rise, change } => {
                finite("start of the gust (s)", *start)?;
                positive("rise time of the gust (s)", *duration)?;
                finite("rise of the gust (m/s)", *rise)?;
                finite("change of direction (rad)", *change)
            }
            Event::ExtremeShear { start, duration, diameter, hub_y, vertical, horizontal } => {
                finite("start of the shear (s)", *start)?;
                positive("duration of the shear (s)", *duration)?;
                positive("rotor diameter (m)", *diameter)?;
                finite("lateral place of the hub (m)", *hub_y)?;
                finite("vertical shear (m/s)", *vertical)?;
                finite("horizontal shear (m/s)", *horizontal)
            }
            Event::RotatingDisk(disk) => disk.check(),
        }
    }

    /// Wind (m/s, farm frame) at `time` (s) and `position` (m, farm frame).
    pub fn wind(&self, time: f64, position: Vector3) -> Vector3 {
        self.at(&self.now(time), position)
    }

    /// What of the event holds everywhere at `time` (s).
    fn now(&self, time: f64) -> Now {
        let mut now = Now::default();
        let to_speed = |speed: f64, share: f64| {
            let hub_speed = self.profile.hub_speed();
            if hub_speed > 0.0 { 1.0 + share * (speed / hub_speed - 1.0) } else { 1.0 }
        };
        match &self.event {
            Event::Steady => {}
            Event::Step { start, speed } => {
                now.factor = to_speed(*speed, f64::from(time >= *start));
            }
            Event::Ramp { start, duration, speed } => {
                now.factor = to_speed(*speed, ((time - start) / duration).clamp(0.0, 1.0));
            }
            Event::Staircase { start, hold, rise, n_steps } => {
                let steps = ((time - start) / hold).floor() + 1.0;
                let rise = rise * steps.clamp(0.0, f64::from(*n_steps));
                now.factor = to_speed(self.profile.hub_speed() + rise, 1.0);
            }
            Event::OperatingGust { start, duration, gust } => {
                let turn = (time - start) / duration;
                if (0.0..=1.0).contains(&turn) {
                    let shape = (3.0 * PI * turn).sin() * (1.0 - (TAU * turn).cos());
                    now.added = -0.37 * gust * shape;
                }
            }
            Event::DirectionChange { start, duration, change } => {
                now.direction = change * rise((time - start) / duration);
            }
            Event::CoherentGust { start, duration, rise: gust, change } => {
                let share = rise((time - start) / duration);
                now.added = gust * share;
                now.direction = change * share;
            }
            Event::ExtremeShear { start, duration, diameter, vertical, horizontal, .. } => {
                let turn = (time - start) / duration;
                if (0.0..=1.0).contains(&turn) {
                    // Whole at one radius and mid-time, where 1 − cos is 2.
                    let share = (1.0 - (TAU * turn).cos()) / diameter;
                    now.upwards = vertical * share;
                    now.leftwards = horizontal * share;
                }
            }
            Event::RotatingDisk(disk) => now.disk_centre = disk.centre(time),
        }
        now
    }

    /// Wind at `position` while `now` holds.
    fn at(&self, now: &Now, position: Vector3) -> Vector3 {
        let height = position.z - self.hub_height;
        let mut speed = self.profile.speed(position.z) * now.factor + now.added;
        match &self.event {
            Event::ExtremeShear { hub_y, .. } => {
                speed += now.upwards * height + now.leftwards * (position.y - hub_y);
            }
            Event::RotatingDisk(disk) => {
                let inside = disk.share(now.disk_centre, position);
                speed += inside * (disk.speed - speed);
            }
            _ => {}
        }
        let direction = now.direction - self.veer * height;
        if direction == 0.0 {
            return Vector3::new(speed, 0.0, 0.0);
        }
        let (sine, cosine) = direction.sin_cos();
        Vector3::new(speed * cosine, speed * sine, 0.0)
    }
}

/// (1 − cos π t)/2 from 0 to 1 while `turn` goes from 0 to 1, constant outside.
fn rise(turn: f64) -> f64 {
    0.5 * (1.0 - (PI * turn.clamp(0.0, 1.0)).cos())
}

/// An event at one time.
struct Now {
    /// Factor on the profile (–).
    factor: f64,
    /// Speed added everywhere (m/s).
    added: f64,
    /// Direction (rad).
    direction: f64,
    /// Speed added per metre above the hub and to its left (1/s).
    upwards: f64,
    leftwards: f64,
    /// Centre of the disk along y and z (m).
    disk_centre: [f64; 2],
}

impl Default for Now {
    fn default() -> Self {
        Self {
            factor: 1.0,
            added: 0.0,
            direction: 0.0,
            upwards: 0.0,
            leftwards: 0.0,
            disk_centre: [0.0; 2],
        }
    }
}

impl Inflow for DeterministicWind {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let now = self.now(time);
        for (position, velocity) in positions.iter().zip(velocities) {
            *velocity = self.at(&now, *position);
        }
    }
}

#[cfg(test)]
#[path = "deterministic_tests.rs"]
mod tests;
