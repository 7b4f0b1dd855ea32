//! The helix: tilt and yaw commands a quarter period apart, through the inverse multi-blade transformation.

mod chirp;
mod kind;

pub use chirp::Chirp;
pub use kind::HELIX;

use crate::excitation::{Excitation, add, excitation_rate, share, words};
use basis::mbc::to_blades;
use basis::{FixedFrame, Measurements, PerBlade, Sense};
use serde::{Deserialize, Serialize};

/// The helix as it runs on one turbine; it has no state, its phase follows from time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Helix {
    /// Which way it winds.
    pub sense: Sense,
    /// Pitch amplitude (rad).
    pub amplitude: f64,
    /// Strouhal number that `rate` was made from (–).
    pub strouhal: f64,
    /// Excitation rate in the fixed frame (rad/s).
    pub rate: f64,
    /// Phase of the tilt command at time zero (rad).
    pub phase: f64,
    /// Azimuth offset ψ_o of the inverse multi-blade transformation (rad).
    pub azimuth_offset: f64,
    /// Time at which it fades in, over one excitation period (s).
    pub start: f64,
    /// Time at which it fades out, over one excitation period (s); never when absent.
    pub stop: Option<f64>,
    /// Change of the rate with time; `rate` throughout when absent.
    pub chirp: Option<Chirp>,
}

impl Helix {
    /// A helix of `amplitude` (rad) at `strouhal` (–) of the free-stream `wind_speed` (m/s) past a rotor of
    /// `diameter` (m), with phase, azimuth offset and start zero, and no stop.
    pub fn new(
        sense: Sense,
        amplitude: f64,
        strouhal: f64,
        wind_speed: f64,
        diameter: f64,
    ) -> Self {
        let rate = excitation_rate(strouhal, wind_speed, diameter);
        Self {
            sense,
            amplitude,
            strouhal,
            rate,
            phase: 0.0,
            azimuth_offset: 0.0,
            start: 0.0,
            stop: None,
            chirp: None,
        }
    }

    /// Tilt and yaw commands (rad) at `time` (s); the average is zero. van Vondelen et al. (2025), Eq. 2.
    pub fn commands(&self, time: f64) -> FixedFrame {
        let amplitude = self.amplitude * share(time, self.start, self.stop, self.rate);
        let turned = match self.chirp {
            Some(chirp) => chirp.angle(self.rate, time),
            None => self.rate * time,
        };
        let angle = turned + self.phase;
        FixedFrame {
            average: 0.0,
            tilt: amplitude * angle.sin(),
            yaw: amplitude * (angle + self.sense.yaw_lead()).sin(),
        }
    }

    /// What is added to each of `n_blades` blades (rad) at `time` (s), blade 1 at `azimuth` (rad).
    /// van Vondelen et al. (2025), Eqs. 1 and 5.
    pub fn pitch(&self, time: f64, azimuth: f64, n_blades: usize) -> PerBlade<f64> {
        to_blades(azimuth + self.azimuth_offset, self.commands(time), n_blades)
    }
}

impl Excitation for Helix {
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        if self.amplitude == 0.0 {
            return;
        }
        let added = Helix::pitch(self, measurements.time, measurements.azimuth, pitch.len());
        add(pitch, &added);
    }

    fn describe(&self) -> String {
        words(&format!("helix {}", self.sense), self.amplitude, self.strouhal)
    }
}
