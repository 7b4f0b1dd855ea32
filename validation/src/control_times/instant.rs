//! An instant of the lidar loop on one core.
//!
//! NREL 5 MW, a lidar of 80 points a diameter downwind, all read at every instant from a wind in closed form;
//! the hub vortex in its scan; a law of two errors with a predictor of 112 samples (240 states), at every
//! instant. What a flow takes to tell its wind at 80 points is not in it. The best of short repeats counts.

use basis::keys::{Value, Values};
use basis::{Measurements, Vector3};
use control::lidar_loop::LIDAR_LOOP;
use control::{Control, Controller, LinearLaw, LinearLaws, Site};
use flow::WindField;
use lti::Recursion;
use sensing::{Mount, SENSORS, Scene, Sensing};
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;
use turbine::{Definition, Induction, Turbine, TurbineSettings};

const INTERVAL: f64 = 0.1;
const N_INSTANTS: usize = 500;
const N_REPEATS: usize = 20;
/// Helix rate of Strouhal number 0.3 in 10 m/s on 126 m (rad/s).
const RATE: f64 = 0.15;
/// States of the law (–): a controller of order 8, a model of order 4 twice, and 112 samples of two outputs.
const ORDER: usize = 240;

/// A wake with a jet that circles.
struct Wake {
    time: f64,
    hub: Vector3,
}

impl WindField for Wake {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        let (sine, cosine) = (RATE * self.time).sin_cos();
        for (position, velocity) in positions.iter().zip(velocities) {
            let place = *position - self.hub;
            let far = (place.y - 13.0 * cosine).powi(2) + (place.z - 13.0 * sine).powi(2);
            *velocity = Vector3::new(5.0 + 4.0 * (-far / 200.0).exp(), 0.0, 0.0);
        }
    }
}

/// Microseconds that an instant takes: lidar, and hub vortex with law and pitch.
///
/// # Panics
/// When the library's own turbine cannot be had.
pub(super) fn measured() -> [f64; 2] {
    let file = formats::library::load("nrel-5mw").expect("the library's own turbines are readable");
    let definition = Arc::new(file.definition);
    let turbine = turbine_of(&definition);
    let site = Site {
        constants: &file.controller,
        rotor: &definition,
        coefficients: |_| unreachable!("its base is baseline control"),
        wind_speed: 10.0,
        diameter: 2.0 * definition.rotor_radius(),
        air_density: 1.225,
        interval: INTERVAL,
        duration: 1000.0,
        flow_resolves_induction: true,
    };
    let mut sensing = sensing(&definition);
    let mut controller = controller(&site);
    let mut wake = Wake { time: 0.0, hub: Vector3::Z * definition.rotor.hub_height };
    let reading = best_of(|time| {
        wake.time = time;
        let truth = turbine.truth(time, INTERVAL);
        black_box(sensing.read(&Scene { truth: &truth, turbine: &turbine, wind: &wake }));
    });
    let readings = sensing.readings().to_vec();
    let deciding = best_of(|time| {
        let (interval, readings) = (INTERVAL, readings.as_slice());
        let measured = Measurements { time, interval, readings, ..Measurements::at_rest(3) };
        black_box(controller.update(black_box(&measured)));
    });
    [1e6 * reading, 1e6 * deciding]
}

/// The turbine, stiff.
fn turbine_of(definition: &Arc<Definition>) -> Turbine {
    let settings = TurbineSettings {
        induction: Induction::ByFlow {
            smearing_length: 8.0,
            sample_spacing: 0.0,
            dynamic_stall: false,
        },
        flexible: false,
        air_density: 1.225,
        yaw: 0.0,
        rotor_speed: 1.0,
        azimuth: 0.0,
        pitch: 0.0,
    };
    Turbine::new(definition.clone(), Vector3::ZERO, settings).expect("a turbine")
}

/// Seconds that `instant` takes, at times an interval apart; the least mean over a repeat.
fn best_of(mut instant: impl FnMut(f64)) -> f64 {
    let mut step = 0_u32;
    (0..N_REPEATS)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..N_INSTANTS {
                instant(f64::from(step) * INTERVAL);
                step += 1;
            }
            start.elapsed().as_secs_f64() / N_INSTANTS as f64
        })
        .fold(f64::INFINITY, f64::min)
}

/// A turbine's instruments and the source's lidar.
fn sensing(definition: &Definition) -> Sensing {
    let kind = SENSORS.find("lidar").expect("it is one of the kinds");
    let values = Values::defaults(kind.table().keys);
    let mount = Mount { definition, foot: Vector3::ZERO, interval: INTERVAL, seed: 1 };
    Sensing::perfect().with_sensor("lidar", kind.build(&values, &mount))
}

/// The loop, with a law as large as the source's with its predictor.
fn controller(site: &Site) -> Box<dyn Controller> {
    let numbers: [(&str, Value); 7] = [
        ("sense", "ccw".into()),
        ("amplitude_deg", 3.0.into()),
        ("strouhal", 0.3.into()),
        ("controller", "law.json".into()),
        ("reference_tilt", 0.0.into()),
        ("reference_yaw", 13.0.into()),
        ("least_trust", 0.0.into()),
    ];
    let entry = |row: usize, column: usize| if row == column + 2 { 1.0 } else { 1e-4 };
    let matrix = |height: usize, width: usize| -> Vec<Vec<f64>> {
        (0..height).map(|row| (0..width).map(|column| entry(row, column)).collect()).collect()
    };
    let recursion =
        Recursion::new(&matrix(ORDER, ORDER), &matrix(ORDER, 2), &matrix(2, ORDER), &matrix(2, 2))
            .with_back_calculation(&matrix(ORDER, 2));
    let mut control = Control::new(&LIDAR_LOOP, &numbers).expect("sound numbers");
    let laws = vec![LinearLaw { file: "law.json".to_owned(), recursion }];
    let laws = LinearLaws { laws, interval: INTERVAL, reference: None };
    control.linear_laws = Some(Arc::new(laws));
    control.kind().build(&control, site).expect("the bench's own setting can be used")
}
