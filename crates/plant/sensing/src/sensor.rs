//! Sensors beyond the standard instruments: they see the turbine and look at the flow, and their readings
//! cross the wall by name.

use basis::keys::{Objection, Table, Values};
use basis::registry::Named;
use basis::scan::ScanLayout;
use basis::{Channel, Truth, Vector3};
use flow::WindField;
use std::fmt;
use thiserror::Error;
use turbine::Turbine;

/// What a sensor can see at one control instant.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// True state of the turbine.
    pub truth: &'a Truth,
    /// The turbine that it is mounted on.
    pub turbine: &'a Turbine,
    /// The wind, everywhere, at this instant.
    pub wind: &'a dyn WindField,
}

/// A sensor at work on one turbine.
pub trait Sensor: Send {
    /// Names of its values and their units in files, such as `LineOfSight1` in m/s.
    fn channels(&self) -> Vec<Channel>;

    /// Its values (–): one for each channel, and behind them those that controllers see and no series keeps.
    fn n_values(&self) -> usize {
        self.channels().len()
    }

    /// What of its scans does not change; none where its reading is no [`Scan`](basis::scan::Scan). Runs keep
    /// the scans of a sensor that has some.
    fn scan_layout(&self) -> Option<ScanLayout> {
        None
    }

    /// On return `values`, as many as [`n_values`](Self::n_values) says, hold what it shows of `scene`, in SI
    /// units. Must not allocate.
    fn read(&mut self, scene: &Scene, values: &mut [f64]);

    /// Everything that time changes, for a checkpoint.
    fn save(&self) -> Vec<u8>;

    /// Continues from what a sensor of the same settings [saved](Self::save).
    ///
    /// # Errors
    /// [`ForeignState`] for bytes that such a sensor did not write.
    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState>;
}

/// Bytes that are no state of this sensor.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the stored state of sensor `{sensor}` does not belong to such a sensor")]
pub struct ForeignState {
    /// Name of the sensor.
    pub sensor: String,
}

/// Where a sensor stands.
#[derive(Clone, Copy, Debug)]
pub struct Mount<'a> {
    /// The machine.
    pub definition: &'a turbine::Definition,
    /// Foot of its tower, farm frame (m).
    pub foot: Vector3,
    /// Control interval (s).
    pub interval: f64,
    /// Seed of its noise.
    pub seed: u64,
}

/// A kind of sensor: everything that the program knows of it.
pub trait SensorKind: Named + Sync {
    /// Its keys in the case file, beside `kind`.
    fn table(&self) -> &'static Table;

    /// What about `values` cannot be, beyond what the keys say.
    fn check(&self, _values: &Values) -> Vec<Objection> {
        Vec::new()
    }

    /// What about `values` cannot be at `mount`: on this machine, at this control interval.
    fn check_at(&self, _values: &Values, _mount: &Mount) -> Vec<Objection> {
        Vec::new()
    }

    /// The sensor with `values` at `mount`.
    fn build(&self, values: &Values, mount: &Mount) -> Box<dyn Sensor>;
}

/// One sensor of a turbine, as the case file has it.
#[derive(Clone)]
pub struct Mounted {
    /// Its name: readings go by it.
    pub name: String,
    /// What it is.
    pub kind: &'static dyn SensorKind,
    /// What its keys hold.
    pub values: Values,
}

impl fmt::Debug for Mounted {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, values } = self;
        write!(formatter, "{name}: {} {values:?}", kind.name())
    }
}

impl PartialEq for Mounted {
    fn eq(&self, other: &Self) -> bool {
        let parts = |own: &Self| (own.name.clone(), own.kind.name(), own.values.clone());
        parts(self) == parts(other)
    }
}
