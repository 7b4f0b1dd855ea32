//! The pulse: periodic collective pitch, which makes the wake breathe.

mod kind;

pub use kind::PULSE;

use crate::excitation::{Excitation, excitation_rate, share, words};
use basis::{Measurements, PerBlade};
use serde::{Deserialize, Serialize};

/// The pulse as it runs on one turbine; it has no state, its phase follows from time.
///
/// Source: Munters and Meyers, "Towards practical dynamic induction control of wind farms", Wind Energ. Sci.
/// 3, 409–425, 2018, in its pitch-driven form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pulse {
    /// Pitch amplitude (rad).
    pub amplitude: f64,
    /// Strouhal number that `rate` was made from (–).
    pub strouhal: f64,
    /// Excitation rate (rad/s).
    pub rate: f64,
    /// Phase at time zero (rad).
    pub phase: f64,
    /// Time at which it fades in, over one excitation period (s).
    pub start: f64,
    /// Time at which it fades out, over one excitation period (s); never when absent.
    pub stop: Option<f64>,
}

impl Pulse {
    /// A pulse of `amplitude` (rad) at `strouhal` (–) of the free-stream `wind_speed` (m/s) past a rotor of
    /// `diameter` (m), with phase and start zero, and no stop.
    pub fn new(amplitude: f64, strouhal: f64, wind_speed: f64, diameter: f64) -> Self {
        let rate = excitation_rate(strouhal, wind_speed, diameter);
        Self { amplitude, strouhal, rate, phase: 0.0, start: 0.0, stop: None }
    }

    /// What is added to every blade (rad) at `time` (s).
    pub fn pitch(&self, time: f64) -> f64 {
        let amplitude = self.amplitude * share(time, self.start, self.stop, self.rate);
        amplitude * (self.rate * time + self.phase).sin()
    }
}

impl Excitation for Pulse {
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        if self.amplitude == 0.0 {
            return;
        }
        let added = Pulse::pitch(self, measurements.time);
        for pitch in pitch.iter_mut() {
            *pitch += added;
        }
    }

    fn describe(&self) -> String {
        words("pulse", self.amplitude, self.strouhal)
    }
}
