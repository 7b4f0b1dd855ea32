//! Cost of one update of the helix estimator on one core: `cargo bench -p wakemix-benches --bench estimator`.
//!
//! IEA 15 MW, blade moments of a helix in 9 m/s, an update every 0.1 s. The best of short repeats counts, so
//! that on a loaded machine some go undisturbed. A number after `--` sets the repeats.

use basis::angle::wrap_to_turn;
use basis::mbc::to_blades;
use basis::{FixedFrame, Measurements, Sense};
use estimation::Estimator;
use estimation::helix::{HelixEstimator, HelixOptions, HelixSettings, Jacobian, MeasurementModel};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const INTERVAL: f64 = 0.1;
const ROTOR_SPEED: f64 = 0.68;
const N_UPDATES: usize = 500;

fn main() {
    let n_repeats = std::env::args().skip(1).find_map(|a| a.parse().ok()).unwrap_or(100);
    let file = formats::library::load("iea-15mw").expect("the library's own turbines are readable");
    let definition = Arc::new(file.definition);
    let differences = Jacobian::CentralDifferences { step: 1e-5 };
    let cases = [
        ("robust", HelixOptions::default(), HelixSettings::N_ELEMENTS),
        ("robust, 32 elements", HelixOptions::default(), 32),
        (
            "robust, by differences",
            HelixOptions { jacobian: differences, ..HelixOptions::default() },
            HelixSettings::N_ELEMENTS,
        ),
        ("published", HelixOptions::published(), HelixSettings::N_ELEMENTS),
    ];
    println!("microseconds an update, best of {n_repeats}");
    for (name, options, n_elements) in cases {
        let setting = HelixSettings {
            sense: Sense::CounterClockwise,
            rate: TAU / 91.4,
            interval: INTERVAL,
            air_density: 1.225,
            n_elements,
        };
        let record = record(&definition, &setting, &options);
        let mut estimator = HelixEstimator::new(&definition, &setting, options)
            .expect("the bench's own setting can be used");
        record[..10].iter().for_each(|read| _ = estimator.update(read));
        let started = estimator.state().clone();
        let best = (0..n_repeats)
            .map(|_| {
                estimator.restore(started.clone());
                let start = Instant::now();
                for measurements in &record[10..] {
                    black_box(estimator.update(black_box(measurements)));
                }
                start.elapsed().as_secs_f64()
            })
            .fold(f64::INFINITY, f64::min);
        println!("{name:<26} {:>8.1}", 1e6 * best / (record.len() - 10) as f64);
    }
}

fn record(
    definition: &Arc<turbine::Definition>,
    setting: &HelixSettings,
    options: &HelixOptions,
) -> Vec<Measurements<'static>> {
    let mut model = MeasurementModel::new(definition, setting, options)
        .expect("the bench's own setting can be used");
    (0..N_UPDATES)
        .map(|step| {
            let time = INTERVAL * step as f64;
            let (azimuth, angle) = (ROTOR_SPEED * time, setting.rate * time);
            let wind = FixedFrame { average: 9.0, tilt: angle.sin(), yaw: angle.cos() };
            let own =
                FixedFrame { average: 0.0, tilt: 0.07 * angle.cos(), yaw: 0.07 * angle.sin() };
            let pitch = to_blades(azimuth, own, 3);
            let moments = model.moments(INTERVAL, wind, azimuth, ROTOR_SPEED, &pitch);
            Measurements {
                time,
                interval: INTERVAL,
                azimuth: wrap_to_turn(azimuth),
                rotor_speed: ROTOR_SPEED,
                generator_speed: ROTOR_SPEED,
                pitch,
                flap_moments: moments,
                ..Measurements::at_rest(3)
            }
        })
        .collect()
}
