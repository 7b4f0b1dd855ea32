//! Instruments and sensors: what a controller sees of the truth.
//!
//! A turbine's standard [`Instruments`] show the truth with lag, bias, noise, resolution and drop-outs; they
//! are perfect unless they are set otherwise, and then every bit of the truth goes through. Further
//! [sensors](Sensor) have names and may look at the flow. Noise belongs to a seed, a quantity and the number
//! of the reading, so that a run that was killed goes on with the same noise.

mod anemometer;
mod axes;
mod channel;
mod instrument;
mod lidar;
mod noise;
mod quantity;
mod sensor;

pub use axes::level_axes;
pub use instrument::{Instrument, Instruments, Lag};
pub use sensor::{ForeignState, Mount, Mounted, Scene, Sensor, SensorKind};

use basis::registry::Registry;
use basis::{Measurements, Reading, Truth};
use channel::Channel;
use quantity::{QUANTITIES, Quantity};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The kinds of sensors; programs built on this one add their own.
pub static SENSORS: Registry<dyn SensorKind> =
    Registry::new(&[&anemometer::ANEMOMETER, &lidar::LIDAR]);

/// The seed of the noise of turbine number `turbine` of a layout in a wind of `seed`: another wind and
/// another turbine have other noise.
pub fn seed_of_turbine(seed: u64, turbine: usize) -> u64 {
    basis::mixed(basis::mixed(seed).wrapping_add(turbine as u64))
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

/// One instrument that errs, at work on its quantity.
#[derive(Clone, Debug)]
struct Gauge {
    quantity: &'static Quantity,
    instrument: Instrument,
    /// One for each value of the quantity.
    channels: [Channel; basis::blades::MAXIMUM_BLADES],
}

/// What a turbine's controller sees it with.
pub struct Sensing {
    instruments: Instruments,
    seed: u64,
    /// Those that err; the others show the truth.
    gauges: Vec<Gauge>,
    sensors: Vec<Box<dyn Sensor>>,
    readings: Vec<Reading>,
    /// Values of each reading that have a channel.
    n_recorded: Vec<usize>,
    n_readings: u64,
}

/// Everything of instruments and sensors that time changes, each by its name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SensingState {
    n_readings: u64,
    gauges: Vec<(String, Vec<Channel>)>,
    sensors: Vec<(String, Vec<u8>)>,
}

impl Sensing {
    /// `instruments` whose noise belongs to `seed`; they settle at their first reading.
    ///
    /// # Errors
    /// [`InstrumentError`] naming the instrument and its figure that cannot be.
    pub fn new(instruments: Instruments, seed: u64) -> Result<Self, InstrumentError> {
        let mut gauges = Vec::new();
        for quantity in &QUANTITIES {
            let instrument = (quantity.instrument)(&instruments);
            instrument.check(quantity.name)?;
            if !instrument.is_perfect() {
                gauges.push(Gauge { quantity, instrument, channels: Default::default() });
            }
        }
        Ok(Self { instruments, seed, gauges, ..Self::perfect() })
    }

    /// Instruments that show the truth.
    pub fn perfect() -> Self {
        Self {
            instruments: Instruments::default(),
            seed: 0,
            gauges: Vec::new(),
            sensors: Vec::new(),
            readings: Vec::new(),
            n_recorded: Vec::new(),
            n_readings: 0,
        }
    }

    /// The same with `sensor`, whose readings go by `name`.
    pub fn with_sensor(mut self, name: &str, sensor: Box<dyn Sensor>) -> Self {
        let values = vec![0.0; sensor.n_values()];
        self.n_recorded.push(sensor.channels().len());
        self.readings.push(Reading { sensor: name.to_owned(), values });
        self.sensors.push(sensor);
        self
    }

    /// Which standard instruments they are.
    pub fn instruments(&self) -> &Instruments {
        &self.instruments
    }

    /// What the further sensors showed last, by their names.
    pub fn readings(&self) -> &[Reading] {
        &self.readings
    }

    /// The further sensors by their names, in the order of [`Self::readings`].
    pub fn sensors(&self) -> impl Iterator<Item = (&str, &dyn Sensor)> {
        let named = self.readings.iter().zip(&self.sensors);
        named.map(|(reading, sensor)| (reading.sensor.as_str(), sensor.as_ref()))
    }

    /// What of the readings has a channel, in the order of [`Self::channels`]: one slice for each sensor.
    pub fn recorded(&self) -> impl Iterator<Item = &[f64]> {
        let named = self.readings.iter().zip(&self.n_recorded);
        named.map(|(reading, n_recorded)| &reading.values[..*n_recorded])
    }

    /// Channels of the further sensors, `SENSOR.CHANNEL`, in the order of [`Self::readings`].
    pub fn channels(&self) -> Vec<basis::Channel> {
        let named = self.readings.iter().zip(&self.sensors);
        named
            .flat_map(|(reading, sensor)| {
                let channels = sensor.channels().into_iter();
                channels.map(|channel| channel.of(&reading.sensor))
            })
            .collect()
    }

    /// What instruments and sensors show of `scene`.
    pub fn read(&mut self, scene: &Scene) -> Measurements<'_> {
        let truth = scene.truth;
        for (sensor, reading) in self.sensors.iter_mut().zip(&mut self.readings) {
            sensor.read(scene, &mut reading.values);
        }
        Measurements {
            readings: &self.readings,
            ..gauged(&mut self.gauges, self.seed, &mut self.n_readings, truth)
        }
    }

    /// What the standard instruments show of `truth`.
    pub fn gauge(&mut self, truth: &Truth) -> Measurements<'static> {
        gauged(&mut self.gauges, self.seed, &mut self.n_readings, truth)
    }

    /// Whether anything of it changes in time, so that a checkpoint must hold it.
    pub fn has_state(&self) -> bool {
        !self.gauges.is_empty() || !self.sensors.is_empty()
    }

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> SensingState {
        let gauge = |gauge: &Gauge| (gauge.quantity.name.to_owned(), gauge.channels.to_vec());
        let named = self.readings.iter().zip(&self.sensors);
        SensingState {
            n_readings: self.n_readings,
            gauges: self.gauges.iter().map(gauge).collect(),
            sensors: named.map(|(reading, own)| (reading.sensor.clone(), own.save())).collect(),
        }
    }

    /// Continues from `state`, which the same instruments and sensors gave.
    ///
    /// # Errors
    /// [`ForeignState`] where a sensor does not know its own.
    pub fn restore(&mut self, state: SensingState) -> Result<(), ForeignState> {
        self.n_readings = state.n_readings;
        for gauge in &mut self.gauges {
            let stored = state.gauges.iter().find(|(name, _)| name == gauge.quantity.name);
            for (channel, stored) in gauge.channels.iter_mut().zip(stored.iter().flat_map(|s| &s.1))
            {
                *channel = *stored;
            }
        }
        for (sensor, reading) in self.sensors.iter_mut().zip(&self.readings) {
            let stored = state.sensors.iter().find(|(name, _)| *name == reading.sensor);
            let foreign = || ForeignState { sensor: reading.sensor.clone() };
            sensor.restore(&stored.ok_or_else(foreign)?.1)?;
        }
        Ok(())
    }
}

/// What `gauges` with noise of `seed` show of `truth`, `n_readings` after the first.
fn gauged(
    gauges: &mut [Gauge],
    seed: u64,
    n_readings: &mut u64,
    truth: &Truth,
) -> Measurements<'static> {
    let mut shown = truth.measured();
    for Gauge { quantity, instrument, channels } in gauges {
        let values = (quantity.values)(&mut shown);
        for (index, (value, channel)) in values.iter_mut().zip(channels).enumerate() {
            let noise = noise::Draw { seed, channel: quantity.stream(index), reading: *n_readings };
            // The azimuth is followed through full turns, and shown within one.
            let input = if quantity.is_azimuth { channel.unrolled(*value) } else { *value };
            *value = channel.read(*instrument, truth.interval, input, noise);
            if quantity.is_azimuth {
                *value = basis::angle::wrap_to_turn(*value);
            }
        }
    }
    *n_readings += 1;
    shown
}

#[cfg(test)]
mod tests;
