//! What an instrument does to what it measures.

use crate::InstrumentError;
use serde::{Deserialize, Serialize};

/// The instruments of a turbine; those of the blades are alike and err apart. Figures are in the unit of the
/// measurement.
///
/// Thrust, aerodynamic torque and the wind at the rotor have no instrument.
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

/// How one instrument falls short of the truth, in the order in which it happens; the default is perfect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Instrument {
    /// How it lags behind.
    pub lag: Lag,
    /// What it shows too much (in the unit of what it measures).
    pub bias: f64,
    /// Standard deviation of white noise in each reading (in the unit of what it measures).
    pub noise: f64,
    /// Distance of the values that it can show (in the unit of what it measures); 0 shows all.
    pub resolution: f64,
    /// Share of readings that fail and repeat the one before (–).
    pub dropout: f64,
}

/// How an instrument lags behind; a lag of either order ends at the truth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Lag {
    /// Not at all.
    #[default]
    None,
    /// Of first order.
    First {
        /// Time constant (s).
        time_constant: f64,
    },
    /// Of second order.
    Second {
        /// Natural frequency (rad/s).
        frequency: f64,
        /// Damping ratio (–).
        damping: f64,
    },
}

impl Instrument {
    /// Whether it shows the truth, bit for bit.
    pub fn is_perfect(&self) -> bool {
        *self == Self::default()
    }

    /// Nothing when the instrument, called `instrument`, can be.
    pub(crate) fn check(&self, instrument: &'static str) -> Result<(), InstrumentError> {
        let refuse =
            |figure, expected, found| Err(InstrumentError { instrument, figure, expected, found });
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let not_negative = |value: f64| value.is_finite() && value >= 0.0;
        if !self.bias.is_finite() {
            return refuse("bias", "a number", self.bias);
        }
        for (figure, value) in [("noise", self.noise), ("resolution", self.resolution)] {
            if !not_negative(value) {
                return refuse(figure, "zero or more", value);
            }
        }
        if !(0.0..1.0).contains(&self.dropout) {
            return refuse("dropout", "0 or more and below 1", self.dropout);
        }
        match self.lag {
            Lag::First { time_constant } if !positive(time_constant) => {
                refuse("time_constant", "above zero", time_constant)
            }
            Lag::Second { frequency, .. } if !positive(frequency) => {
                refuse("frequency", "above zero", frequency)
            }
            Lag::Second { damping, .. } if !not_negative(damping) => {
                refuse("damping", "zero or more", damping)
            }
            _ => Ok(()),
        }
    }
}
