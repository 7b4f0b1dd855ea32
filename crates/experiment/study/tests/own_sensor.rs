//! A kind of sensor from outside that looks at the flow, and a controller that sees its readings by name.

mod small;

use basis::keys::LeftOut::Value as Otherwise;
use basis::keys::{Table, Values, above, key};
use basis::registry::Named;
use basis::{Channel, Commands, Measurements, Unit, Vector3};
use control::{CONTROLLERS, Control, ControlError, Controller, ControllerKind, ForeignState, Site};
use formats::table::TableReader;
use sensing::{Mount, SENSORS, Scene, Sensor, SensorKind};
use small::{case, done, options, written};
use std::fs;

/// A beam that looks upwind at hub height.
struct Beam {
    position: Vector3,
    n_readings: f64,
}

impl Sensor for Beam {
    fn channels(&self) -> Vec<Channel> {
        vec![
            Channel::new("Wind", Unit::MetrePerSecond),
            Channel::new("Readings", Unit::One),
            Channel::new("Turn", Unit::Degree),
        ]
    }

    fn read(&mut self, scene: &Scene, values: &mut [f64]) {
        let mut wind = [Vector3::ZERO];
        scene.wind.sample(&[self.position], &mut wind);
        self.n_readings += 1.0;
        // An angle that it does not know at once.
        let turn = if self.n_readings > 1.0 { 0.5 } else { f64::NAN };
        values.copy_from_slice(&[wind[0].x, self.n_readings, turn]);
    }

    fn save(&self) -> Vec<u8> {
        self.n_readings.to_le_bytes().to_vec()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), sensing::ForeignState> {
        let foreign = || sensing::ForeignState { sensor: "beam".to_owned() };
        self.n_readings = f64::from_le_bytes(state.try_into().map_err(|_| foreign())?);
        Ok(())
    }
}

struct BeamKind;

static BEAM: Table = Table {
    heading: "turbine.sensors.NAME = { kind = \"beam\", … }",
    about: "A beam that looks upwind at hub height.",
    keys: &[key(
        "ahead",
        above(0.0, 500.0),
        "m",
        Otherwise("100"),
        "Distance that it looks ahead.",
    )],
};

impl Named for BeamKind {
    fn name(&self) -> &'static str {
        "beam"
    }
}

impl SensorKind for BeamKind {
    fn table(&self) -> &'static Table {
        &BEAM
    }

    fn build(&self, values: &Values, mount: &Mount) -> Box<dyn Sensor> {
        let hub = mount.foot + Vector3::Z * mount.definition.rotor.hub_height;
        Box::new(Beam { position: hub - Vector3::X * values.number("ahead"), n_readings: 0.0 })
    }
}

/// Greedy control that stops taking torque once the beam sees a wind above a threshold.
struct Shy {
    inner: Box<dyn Controller>,
}

impl Controller for Shy {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let mut commands = self.inner.update(measurements);
        let seen = measurements.reading("Eye").map(|values| values[0]);
        if seen.is_some_and(|wind| wind > 10.0) {
            commands.generator_torque = 0.0;
        }
        commands
    }

    fn describe(&self) -> String {
        "shy".to_owned()
    }

    fn save(&self) -> Vec<u8> {
        self.inner.save()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        self.inner.restore(state)
    }
}

struct ShyKind;

static SHY: Table = Table {
    heading: "control.T1 = { kind = \"shy\" }",
    about: "Greedy until the beam sees more than 10 m/s.",
    keys: &[],
};

impl Named for ShyKind {
    fn name(&self) -> &'static str {
        "shy"
    }
}

impl ControllerKind for ShyKind {
    fn table(&self) -> &'static Table {
        &SHY
    }

    fn build(&self, _: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        Ok(Box::new(Shy { inner: site.baseline() }))
    }
}

#[test]
fn a_sensor_reads_the_flow_and_its_readings_reach_controller_and_series() {
    SENSORS.add(&BeamKind).expect("no kind is called so yet");
    CONTROLLERS.add(&ShyKind).expect("no kind is called so yet");
    let machine = format!("{}\nsensors.Eye = {{ kind = \"beam\", ahead = 80.0 }}", small::NREL_5MW);
    let step = "event = { kind = \"step\", start = 20.0, speed = 12.0 }\n";
    let runs = "[[run]]\nname = \"own\"\ncontrol.T1 = { kind = \"shy\" }\n";
    let text = case("sensor", step, [10.0, 40.0], &[&machine], runs);
    let folder = written(&text);
    done(&options(folder.path()));
    let series = fs::read_to_string(folder.path().join("out/own/series.csv")).expect("a series");
    let mut rows = series.lines();
    let names: Vec<&str> = rows.next().expect("a heading").split(',').collect();
    let place = |wanted: &str| {
        names
            .iter()
            .position(|name| *name == wanted)
            .unwrap_or_else(|| panic!("{wanted} is missing"))
    };
    let [time, eye, count, turn, torque] =
        ["Time_s", "T1.Eye.Wind_m/s", "T1.Eye.Readings_-", "T1.Eye.Turn_deg", "T1.GenTq_kN-m"]
            .map(place);
    let rows: Vec<Vec<f64>> = rows
        .map(|row| row.split(',').map(|value| value.parse().expect("a number")).collect())
        .collect();
    for (index, row) in rows.iter().enumerate() {
        let expected = if row[time] < 20.0 { 9.0 } else { 12.0 };
        assert!((row[eye] - expected).abs() < 1e-9, "{} m/s at {} s", row[eye], row[time]);
        assert_eq!(row[count], (index + 1) as f64);
        let known = index > 0;
        assert_eq!(row[turn].is_nan(), !known);
        assert!(!known || (row[turn] - 0.5_f64.to_degrees()).abs() < 1e-12);
    }
    let at = |wanted: f64| rows.iter().find(|row| row[time] >= wanted).expect("such a row");
    assert!(
        at(15.0)[torque] > 1.0 && at(25.0)[torque] < 0.01,
        "{} {}",
        at(15.0)[torque],
        at(25.0)[torque]
    );
    let case = formats::case::parse("sensor.toml", &text, &[]).expect("a sound case");
    let again = formats::case::parse("again", &formats::case::write(&case), &[]);
    assert_eq!(again.expect("what was written is read"), case);
    // What was not a number at some time has no place in OpenFAST's format.
    let outb = TableReader::open(&folder.path().join("out/own/T1.outb")).expect("an .outb");
    let names = || outb.channels().map(|column| column.name.as_str());
    for name in ["RootMyb1", "Eye.Wind", "Eye.Readings"] {
        assert!(names().any(|other| other == name), "{name}");
    }
    assert!(!names().any(|name| name == "Eye.Turn"));
    for page in [formats::case::reference(), formats::case::schema()] {
        assert!(page.contains("Distance that it looks ahead"), "the kind is told of");
    }
}
