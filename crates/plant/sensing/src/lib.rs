//! Instruments: what a controller sees of the truth, with lag, bias, noise, resolution and drop-outs.
//!
//! Instruments are perfect unless they are told otherwise, and then every bit of the truth goes through. Noise belongs to
//! a seed, a channel and the number of the reading, so that a run that was killed goes on with the same noise.

mod channel;
mod instrument;
mod noise;

pub use instrument::{Instrument, Lag};

use basis::{Measurements, PerBlade};
use channel::Channel;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Channels of one turbine: six of the machine, three of each blade.
const N_CHANNELS: usize = N_MACHINE + N_BLADE * basis::blades::MAXIMUM_BLADES;
const N_MACHINE: usize = 6;
const N_BLADE: usize = 3;

/// The instruments of a turbine; those of the blades are alike and err apart. Figures are in the unit of the measurement.
///
/// Thrust, aerodynamic torque and the wind at the rotor have no instrument: records show the truth, controllers leave them alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Instruments {
    /// Azimuth encoder (rad).
    pub azimuth: Instrument,
    /// Encoder of rotor speed (rad/s).
    pub rotor_speed: Instrument,
    /// Encoder of generator speed, low-speed side (rad/s).
    pub generator_speed: Instrument,
    /// Generator torque (N m).
    pub generator_torque: Instrument,
    /// Electrical power (W).
    pub power: Instrument,
    /// Accelerometer at the tower top (m/s²).
    pub tower_top_acceleration: Instrument,
    /// Pitch encoders (rad).
    pub pitch: Instrument,
    /// Strain gauges at the blade roots, out of plane (N m).
    pub flap_moments: Instrument,
    /// Strain gauges at the blade roots, in plane (N m).
    pub edge_moments: Instrument,
}

impl Instruments {
    /// Whether all of them show the truth, bit for bit.
    pub fn are_perfect(&self) -> bool {
        *self == Self::default()
    }
}

/// The seed of the noise of turbine number `turbine` of a layout in a wind of `seed`: another wind and another turbine
/// have other noise.
pub fn seed_of_turbine(seed: u64, turbine: usize) -> u64 {
    noise::mixed(noise::mixed(seed).wrapping_add(turbine as u64))
}

/// An instrument that cannot be.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("instrument {instrument}: {figure} must be {expected}, it is {found}")]
pub struct InstrumentError {
    /// Which instrument, as the fields of [`Instruments`] are called.
    pub instrument: &'static str,
    /// Which of its figures.
    pub figure: &'static str,
    /// What it may be.
    pub expected: &'static str,
    /// What it is (in its own unit).
    pub found: f64,
}

/// The instruments of one turbine at work.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensing {
    instruments: Instruments,
    seed: u64,
    state: State,
}

/// Everything of instruments that time changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    n_readings: u64,
    channels: [Channel; N_CHANNELS],
}

impl Sensing {
    /// `instruments` whose noise belongs to `seed`; they settle at their first reading.
    ///
    /// # Errors
    /// [`InstrumentError`] naming the instrument and its figure that cannot be.
    pub fn new(instruments: Instruments, seed: u64) -> Result<Self, InstrumentError> {
        for (name, instrument) in [
            ("azimuth", instruments.azimuth),
            ("rotor_speed", instruments.rotor_speed),
            ("generator_speed", instruments.generator_speed),
            ("generator_torque", instruments.generator_torque),
            ("power", instruments.power),
            ("tower_top_acceleration", instruments.tower_top_acceleration),
            ("pitch", instruments.pitch),
            ("flap_moments", instruments.flap_moments),
            ("edge_moments", instruments.edge_moments),
        ] {
            instrument.check(name)?;
        }
        Ok(Self { instruments, seed, state: State::default() })
    }

    /// Instruments that show the truth.
    pub fn perfect() -> Self {
        Self { instruments: Instruments::default(), seed: 0, state: State::default() }
    }

    /// Which instruments they are.
    pub fn instruments(&self) -> &Instruments {
        &self.instruments
    }

    /// What the instruments show of `truth`.
    pub fn read(&mut self, truth: &Measurements) -> Measurements {
        let instruments = self.instruments;
        let mut shown = *truth;
        shown.azimuth = self.angle(0, instruments.azimuth, truth);
        let scalars = [
            (instruments.rotor_speed, &mut shown.rotor_speed),
            (instruments.generator_speed, &mut shown.generator_speed),
            (instruments.generator_torque, &mut shown.generator_torque),
            (instruments.power, &mut shown.power),
            (instruments.tower_top_acceleration, &mut shown.tower_top_acceleration),
        ];
        for (k, (instrument, value)) in scalars.into_iter().enumerate() {
            *value = self.channel(1 + k, instrument, truth.interval, *value);
        }
        let blades: [(Instrument, &mut PerBlade<f64>); N_BLADE] = [
            (instruments.pitch, &mut shown.pitch),
            (instruments.flap_moments, &mut shown.flap_moments),
            (instruments.edge_moments, &mut shown.edge_moments),
        ];
        for (k, (instrument, values)) in blades.into_iter().enumerate() {
            for (blade, value) in values.iter_mut().enumerate() {
                let index = N_MACHINE + N_BLADE * blade + k;
                *value = self.channel(index, instrument, truth.interval, *value);
            }
        }
        self.state.n_readings += 1;
        shown
    }

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Continues from `state`, which the same instruments gave.
    pub fn restore(&mut self, state: State) {
        self.state = state;
    }

    fn channel(&mut self, index: usize, instrument: Instrument, interval: f64, truth: f64) -> f64 {
        if instrument.is_perfect() {
            return truth;
        }
        let noise = noise::Draw { seed: self.seed, channel: index, reading: self.state.n_readings };
        self.state.channels[index].read(instrument, interval, truth, noise)
    }

    /// As [`Sensing::channel`] for the azimuth: followed through full turns, shown within one.
    fn angle(&mut self, index: usize, instrument: Instrument, truth: &Measurements) -> f64 {
        if instrument.is_perfect() {
            return truth.azimuth;
        }
        let unrolled = self.state.channels[index].unrolled(truth.azimuth);
        let shown = self.channel(index, instrument, truth.interval, unrolled);
        basis::angle::wrap_to_turn(shown)
    }
}

#[cfg(test)]
mod tests;
