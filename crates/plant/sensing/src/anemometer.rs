//! An anemometer with its vane: horizontal wind and its direction at one place of the nacelle.

use crate::sensor::{ForeignState, Mount, Scene, Sensor, SensorKind};
use basis::keys::LeftOut::Value;
use basis::keys::{Table, Values, above, from, key};
use basis::registry::Named;
use basis::{Channel, Unit, Vector3};

/// An anemometer.
pub(crate) struct AnemometerKind;

/// The kind.
pub(crate) static ANEMOMETER: AnemometerKind = AnemometerKind;

static TABLE: Table = Table {
    heading: "turbine.sensors.NAME = { kind = \"anemometer\", … }",
    about: "Cup and vane on the nacelle: horizontal wind speed, and its direction against the nacelle, positive when the wind comes round anticlockwise, seen from above. It shows the air of the flow solver as it is there: with the rotor's induction in a resolved flow, without in prescribed wind.",
    keys: &[
        key(
            "downwind",
            from(0.0, 100.0),
            "m",
            Value("0"),
            "Distance downwind of the rotor's centre; where OpenFAST takes its hub wind at 0.",
        ),
        key("above", from(-100.0, 100.0), "m", Value("0"), "Height above the rotor's centre."),
        key(
            "factor",
            above(0.0, 10.0),
            "–",
            Value("1"),
            "What its speed is multiplied by, such as the nacelle transfer function.",
        ),
    ],
};

impl Named for AnemometerKind {
    fn name(&self) -> &'static str {
        "anemometer"
    }
}

impl SensorKind for AnemometerKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn build(&self, values: &Values, mount: &Mount) -> Box<dyn Sensor> {
        let height = mount.definition.rotor.hub_height + values.number("above");
        let place = Vector3::new(values.number("downwind"), 0.0, height);
        Box::new(Anemometer { position: mount.foot + place, factor: values.number("factor") })
    }
}

struct Anemometer {
    /// Where it stands, farm frame (m).
    position: Vector3,
    /// What its speed is multiplied by (–).
    factor: f64,
}

impl Sensor for Anemometer {
    fn channels(&self) -> Vec<Channel> {
        vec![Channel::new("Speed", Unit::MetrePerSecond), Channel::new("Direction", Unit::Degree)]
    }

    fn read(&mut self, scene: &Scene, values: &mut [f64]) {
        let mut wind = [Vector3::ZERO];
        scene.wind.sample(&[self.position], &mut wind);
        let [wind] = wind;
        values.copy_from_slice(&[self.factor * wind.x.hypot(wind.y), wind.y.atan2(wind.x)]);
    }

    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let foreign = || ForeignState { sensor: "anemometer".to_owned() };
        if state.is_empty() { Ok(()) } else { Err(foreign()) }
    }
}
