//! What a controller library is sent, record by record, and what is made of what it asks for.

mod small;

use basis::{Commands, Measurements, PerBlade, Reading};
use control::library::{Libraries, Library, LibraryError, Request};
use control::{Control, Controller};
use farm::assemble::site;
use small::{NREL_5MW, case, laid_out};
use std::sync::{Arc, Mutex};

/// Notes what it is sent, and asks for the same each time.
#[derive(Clone, Default)]
struct Notes(Arc<Mutex<Vec<Vec<f32>>>>);

impl Libraries for Notes {
    fn open(&self, asked: &Request) -> Result<Box<dyn Library>, LibraryError> {
        assert_eq!(asked.procedure, "DISCON");
        Ok(Box::new(self.clone()))
    }
}

impl Library for Notes {
    fn call(&mut self, swap: &mut [f32]) -> i32 {
        self.0.lock().expect("one thread").push(swap.to_vec());
        swap[41..45].copy_from_slice(&[0.1, 0.2, 0.3, 0.4]);
        swap[46] = 20_000.0;
        // What it may use as it likes, and what it switches.
        swap[26] = -1.0;
        swap[47] = 0.005;
        swap[34] = if swap[1] > 5.0 { 0.0 } else { 1.0 };
        0
    }

    fn message(&self) -> String {
        String::new()
    }
}

/// A controller over `notes` with `keys`, for the NREL 5 MW turbine in 9 m/s at steps of 0.2 s.
fn controller(notes: &Notes, keys: &[(&str, basis::keys::Value)]) -> Box<dyn Controller> {
    let text = case("records", "", [10.0, 60.0], &[NREL_5MW], "[[run]]\nname = \"baseline\"\n");
    let (case, plan, machine) = laid_out(&text, &[], "nrel-5mw");
    let given = [&[("library", "law.so".into())], keys].concat();
    let mut control = Control::new(&control::discon::DISCON, &given).expect("sound keys");
    control.libraries = Some(Arc::new(notes.clone()));
    control.build(&site(&machine, &case, &plan)).expect("it can be built")
}

/// What instruments show at `time` (s).
fn measured(time: f64, readings: &[Reading]) -> Measurements<'_> {
    Measurements {
        time,
        interval: 0.2,
        azimuth: 1.5,
        rotor_speed: 1.1,
        generator_speed: 1.125,
        pitch: PerBlade::from_fn(3, |blade| 0.01 * (blade + 1) as f64),
        generator_torque: 1.94e6,
        power: 2.06e6,
        flap_moments: PerBlade::from_fn(3, |blade| 1e6 * (blade + 1) as f64),
        edge_moments: PerBlade::from_fn(3, |blade| -1e5 * (blade + 1) as f64),
        tower_top_acceleration: 0.05,
        yaw: 0.25,
        readings,
    }
}

#[test]
fn every_record_is_where_the_interface_has_it() {
    let notes = Notes::default();
    let mut own = controller(&notes, &[]);
    let readings = [Reading { sensor: "anemometer".to_owned(), values: vec![8.5, -0.125] }];
    for time in [0.0, 0.2] {
        own.update(&measured(time, &readings));
    }
    drop(own);
    let calls = notes.0.lock().expect("one thread").clone();
    // First call, another, and the last one.
    assert_eq!(calls.iter().map(|swap| swap[0]).collect::<Vec<_>>(), [0.0, 1.0, -1.0]);
    // Bladed's record numbers; the gear ratio is 97, and constants those of turbines/nrel-5mw.toml.
    let rated = 97.0 * 12.10001 * std::f64::consts::PI / 30.0;
    let expected = [
        (2, 0.2),
        (3, 0.2),
        (4, 0.01),
        (33, 0.02),
        (34, 0.03),
        (5, 0.0),
        (10, 0.0),
        (13, 5e6),
        (14, 1.94e6 * 1.125),
        (15, 2.06e6),
        (16, 2_180_235.1 / 97.0_f64.powi(3)),
        (18, rated),
        (19, rated),
        (20, 97.0 * 1.125),
        (21, 1.1),
        (22, 4_180_069.5 / 97.0),
        (23, 1.94e6 / 97.0),
        (24, -0.125),
        (27, 8.5),
        (28, 1.0),
        (30, 1e6),
        (31, 2e6),
        (32, 3e6),
        (35, 1.0),
        (37, 0.25),
        (53, 0.05),
        (60, 1.5),
        (61, 3.0),
        (62, 0.0),
        (69, -1e5),
        (70, -2e5),
        (71, -3e5),
        (95, 1.225),
        (96, 9.0),
    ];
    for (record, value) in expected {
        let found = f64::from(calls[1][record - 1]);
        // Single precision, and figures of the file in seven digits.
        assert!(
            (found - value).abs() <= 1e-6 * value.abs(),
            "record {record}: {found}, not {value}"
        );
    }
    // A library reads its own demands back.
    assert_eq!(calls[1][41..45], [0.1, 0.2, 0.3, 0.4]);
}

#[test]
fn demands_are_read_where_the_interface_has_them() {
    let none: &[(&str, basis::keys::Value)] = &[("anemometer", "none".into())];
    let demanded = |keys: &[(&str, basis::keys::Value)], time: f64| {
        let Commands { pitch, generator_torque, yaw_rate } =
            controller(&Notes::default(), keys).update(&measured(time, &[]));
        assert_eq!(yaw_rate as f32, 0.005);
        ([pitch[0], pitch[1], pitch[2]].map(|pitch| pitch as f32), generator_torque)
    };
    assert_eq!(demanded(none, 0.0), ([0.1, 0.2, 0.3], 97.0 * 20_000.0));
    let collective = [none, &[("pitch_control", "collective".into())]].concat();
    assert_eq!(demanded(&collective, 0.0), ([0.4; 3], 97.0 * 20_000.0));
    // The generator is switched off.
    assert_eq!(demanded(none, 6.0).1, 0.0);
}
