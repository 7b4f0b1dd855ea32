//! Winds in closed form: shear, veer, steps and ramps, the gusts of IEC 61400-1, a disk of slow air that
//! circles.

mod change;
mod disk;

pub use change::Change;
pub use disk::RotatingDisk;

use super::{InflowError, MeanProfile, positive};
use crate::Inflow;
use basis::Vector3;
use std::f64::consts::TAU;

/// Duration of the extreme operating gust (s).
pub const OPERATING_GUST_DURATION: f64 = 10.5;
/// Duration of the extreme direction change (s).
pub const DIRECTION_CHANGE_DURATION: f64 = 6.0;
/// Rise time of the extreme coherent gust with direction change (s).
pub const COHERENT_GUST_DURATION: f64 = 10.0;
/// Duration of the extreme wind shear (s).
pub const EXTREME_SHEAR_DURATION: f64 = 12.0;

/// A deterministic wind: a mean profile that veers with height, and one event in time.
///
/// The event comes to all places at once, wherever they lie along x. Directions are angles of the horizontal
/// wind from x, counter-clockwise seen from above: positive blows towards +y, to the left looking downwind.
#[derive(Clone, Debug, PartialEq)]
pub struct DeterministicWind {
    /// Speed over height before the event.
    pub profile: MeanProfile,
    /// Hub height (m), where veer is zero.
    pub hub_height: f64,
    /// Veer (rad/m): the wind turns clockwise, seen from above, by so much per metre upwards, as it does in
    /// the boundary layer of the northern hemisphere; negative backs.
    pub veer: f64,
    /// What happens.
    pub event: Event,
}

/// What happens in time. Times in s since the run's start.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Nothing.
    Steady,
    /// The wind changes at all places alike.
    Everywhere(Change),
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
        /// Largest change of speed one radius above the hub (m/s),
        /// [`extreme_shear`](super::iec::extreme_shear), either sign.
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
    /// [`InflowError::Setting`] names what cannot be used: a number that is not finite, a duration or length
    /// that is not positive.
    pub fn check(&self) -> Result<(), InflowError> {
        self.profile.check()?;
        positive("hub height (m)", self.hub_height)?;
        finite("veer (rad/m)", self.veer)?;
        match &self.event {
            Event::Steady => Ok(()),
            Event::Everywhere(change) => change.check(self.profile.hub_speed()),
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
        match &self.event {
            Event::Steady => {}
            Event::Everywhere(change) => change.apply(self.profile.hub_speed(), time, &mut now),
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

fn finite(name: &'static str, value: f64) -> Result<(), InflowError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(InflowError::Setting { name, value, expected: "a finite number" })
    }
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
