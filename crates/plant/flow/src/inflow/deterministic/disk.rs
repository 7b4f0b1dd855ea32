//! A disk of other air that circles through the wind: a meandering wake in its simplest form.

use crate::inflow::{InflowError, not_negative, positive};
use basis::Vector3;
use std::f64::consts::TAU;

/// A disk, normal to x, inside which the wind has another speed; its centre runs on an ellipse.
///
/// The centre starts at the top of the ellipse at time zero and goes round clockwise or counter-clockwise,
/// looking downwind. Its frequency goes linearly from the first to the last of `frequencies` over `sweep`,
/// then stays. Source: van Veldhoven, "Closed-Loop Wake Meandering Control of Downstream Wind Turbines", TU
/// Delft 2024, §4-1-3: offsets 0.2 D and 0.1 D, St from 0.18 to 0.22 over 1500 s, 16 m/s outside and 8 m/s
/// inside. It leaves open the radius, for which [`of_wake`](Self::of_wake) takes that of the rotor, and where
/// the disk is at time zero; its wind stands on a grid of 13.8 m × 15.3 m, which smears the edge as `edge`
/// does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotatingDisk {
    /// Middle of the ellipse along y and z (m), the hub.
    pub middle: [f64; 2],
    /// Half-axes of the ellipse along y and z (m).
    pub offsets: [f64; 2],
    /// Radius of the disk (m).
    pub radius: f64,
    /// Width over which the speed changes linearly at the edge (m), half inside, half outside; 0 is sharp.
    pub edge: f64,
    /// Speed inside (m/s).
    pub speed: f64,
    /// Frequency of circling at time zero and after the sweep (Hz).
    pub frequencies: [f64; 2],
    /// Duration of the sweep (s); 0 has the last frequency from the start.
    pub sweep: f64,
    /// Whether it goes round clockwise, looking downwind.
    pub clockwise: bool,
}

impl RotatingDisk {
    /// The disk of the source behind a rotor of `diameter` (m) with its hub at `hub_height` (m) and y = 0, in
    /// the ambient speed `ambient_speed` (m/s), which also makes frequencies of Strouhal numbers.
    pub fn of_wake(diameter: f64, hub_height: f64, ambient_speed: f64, clockwise: bool) -> Self {
        Self {
            middle: [0.0, hub_height],
            offsets: [0.2 * diameter, 0.1 * diameter],
            radius: 0.5 * diameter,
            edge: 0.0,
            speed: 0.5 * ambient_speed,
            frequencies: [0.18, 0.22].map(|strouhal| strouhal * ambient_speed / diameter),
            sweep: 1500.0,
            clockwise,
        }
    }

    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used.
    pub fn check(&self) -> Result<(), InflowError> {
        for place in self.middle {
            if !place.is_finite() {
                let (name, expected) = ("middle of the disk's path (m)", "a finite number");
                return Err(InflowError::Setting { name, value: place, expected });
            }
        }
        for offset in self.offsets {
            not_negative("offset of the disk (m)", offset)?;
        }
        positive("radius of the disk (m)", self.radius)?;
        not_negative("edge of the disk (m)", self.edge)?;
        not_negative("speed inside the disk (m/s)", self.speed)?;
        for frequency in self.frequencies {
            not_negative("frequency of the disk (Hz)", frequency)?;
        }
        not_negative("sweep of the disk (s)", self.sweep)
    }

    /// Phase of circling (rad) at `time` (s), zero at time zero, not wrapped.
    pub fn phase(&self, time: f64) -> f64 {
        let [first, last] = self.frequencies;
        if self.sweep <= 0.0 {
            return TAU * last * time;
        }
        let within = time.clamp(0.0, self.sweep);
        let swept = first * within + 0.5 * (last - first) * within * within / self.sweep;
        TAU * (swept + first * time.min(0.0) + last * (time - self.sweep).max(0.0))
    }

    /// Frequency of circling (Hz) at `time` (s).
    pub fn frequency(&self, time: f64) -> f64 {
        let [first, last] = self.frequencies;
        let share = if self.sweep > 0.0 { (time / self.sweep).clamp(0.0, 1.0) } else { 1.0 };
        first + share * (last - first)
    }

    /// Centre along y and z (m) at `time` (s).
    pub fn centre(&self, time: f64) -> [f64; 2] {
        let (sine, cosine) = self.phase(time).sin_cos();
        // Left is +y: clockwise from the top goes to the right first.
        let right = if self.clockwise { sine } else { -sine };
        [self.middle[0] - self.offsets[0] * right, self.middle[1] + self.offsets[1] * cosine]
    }

    /// Share of the disk's speed (–) at `position` (m) when its centre is at `centre`: 1 inside, 0 outside.
    pub(super) fn share(&self, centre: [f64; 2], position: Vector3) -> f64 {
        let inside = self.radius - (position.y - centre[0]).hypot(position.z - centre[1]);
        if self.edge > 0.0 {
            (inside / self.edge + 0.5).clamp(0.0, 1.0)
        } else {
            f64::from(inside >= 0.0)
        }
    }
}
