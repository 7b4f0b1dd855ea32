//! Times of control design and of the lidar loop: an identification, a synthesis, an instant.

mod instant;

use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::AtMost;
use crate::studies::failure;
use design::{IdentifyQuestion, Source, Trend, identify};
use faer::Mat;
use lti::matrices::StateSpace;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::Instant;
use synthesis::{
    HInfinityOptions, SensitivityWeights, control_weight, h_infinity, mixed_sensitivity,
    performance_weight,
};

/// Where the expected values come from.
const SOURCE: &str = "aim of the project, set before it was measured";
/// Samples of the record that is identified from, and of its windows (–).
const N_SAMPLES: usize = 9000;
const WINDOW: usize = 200;
/// States of the plant; with its weights the problem has thirty (–).
const ORDER: usize = 24;

/// Wall time of what a control engineer waits for, and of what a turbine does at each instant.
pub fn control_times() -> Vec<Row> {
    compare().unwrap_or_else(failure)
}

fn compare() -> Result<Vec<Row>, String> {
    let row = |what: &str, measured: f64, expected, unit| Row {
        what: what.to_owned(),
        measured,
        expected,
        tolerance: AtMost,
        unit,
        source: SOURCE,
    };
    let instant = instant::measured();
    tell!("lidar {:.1} µs, hub vortex, law and pitch {:.1} µs", instant[0], instant[1]);
    Ok(vec![
        row(
            "identification of 9000 samples of two inputs and two outputs from a CSV, windows of 200: wall time",
            identification()?,
            10.0,
            "s",
        ),
        row(
            "H-infinity controller of order 30, two inputs and two outputs: wall time",
            synthesis()?,
            1.0,
            "s",
        ),
        row(
            "nrel-5mw, an instant of a lidar of 80 points, hub vortex, law of 240 states, helix and baseline, best of 20 times 500: wall time",
            instant[0] + instant[1],
            100.0,
            "µs",
        ),
    ])
}

/// Seconds that all takes which `wakemix identify` does, from the file on.
fn identification() -> Result<f64, String> {
    let folder = std::env::temp_dir().join(format!("wakemix-times-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let timed = timed_identification(&folder.join("record.csv"));
    fs::remove_dir_all(&folder).map_err(|error| error.to_string())?;
    timed
}

fn timed_identification(file: &Path) -> Result<f64, String> {
    fs::write(file, record()).map_err(|error| error.to_string())?;
    let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
    let question = IdentifyQuestion {
        source: Source {
            file: file.to_owned(),
            inputs: names(["tilt", "yaw"]),
            outputs: names(["up", "right"]),
            span: [f64::NEG_INFINITY, f64::INFINITY],
        },
        decimate: 1,
        trend: Trend::Constant,
        windows: [WINDOW; 2],
        feedthrough: false,
        order: None,
        delay: 0.0,
        aside: 0.3,
        bandwidth: 0.02,
    };
    let started = Instant::now();
    let found = identify(&question).map_err(|error| error.to_string())?;
    let taken = started.elapsed().as_secs_f64();
    tell!("order {}, {:.1?} % kept aside", found.model.a.len(), found.accounted_for[1]);
    Ok(taken)
}

/// Two lags, coupled, under signs that hold for ten samples of 0.1 s, with noise.
fn record() -> String {
    let mut text = "Time (s),tilt (deg),yaw (deg),up (m),right (m)\n".to_owned();
    let mut random = Random(9000);
    let (mut input, mut state) = ([0.0; 2], [0.0; 2]);
    for sample in 0..N_SAMPLES {
        if sample % 10 == 0 {
            input = [0, 1].map(|_| (random.uniform() - 0.5).signum());
        }
        let [up, right] = state.map(|value: f64| value + 0.05 * random.normal());
        let line =
            writeln!(text, "{:.1},{},{},{up},{right}", 0.1 * sample as f64, input[0], input[1]);
        line.expect("a text takes a line");
        state = [
            0.98 * state[0] + 0.01 * state[1] + 0.04 * input[0],
            0.97 * state[1] - 0.01 * state[0] + 0.05 * input[1],
        ];
    }
    text
}

/// Seconds that the search for the least bound takes, check of the loop included.
fn synthesis() -> Result<f64, String> {
    let weights = SensitivityWeights {
        performance: Some(twice(performance_weight(0.05, 2.0, 0.01))?),
        complementary: None,
        control: Some(twice(control_weight(1.0, 10.0, 0.1))?),
    };
    let started = Instant::now();
    let problem = mixed_sensitivity(&plant(), &weights).map_err(|error| error.to_string())?;
    let found = h_infinity(&problem, &HInfinityOptions::default());
    let taken = started.elapsed().as_secs_f64();
    let found = found.map_err(|error| error.to_string())?;
    tell!("order {}, bound {:.4}", found.controller.order(), found.bound);
    Ok(taken)
}

/// A weight on both channels.
fn twice(weight: Result<StateSpace, synthesis::SynthesisError>) -> Result<StateSpace, String> {
    let weight = weight.map_err(|error| error.to_string())?;
    weight.repeated(2).map_err(|error| error.to_string())
}

/// Twelve damped modes from 0.05 rad/s on, each half as fast again as the one before, that both inputs move
/// and both outputs show.
fn plant() -> StateSpace {
    let mut random = Random(30);
    let mut entry = |_: usize, _: usize| random.uniform() - 0.5;
    let b = Mat::from_fn(ORDER, 2, &mut entry);
    let c = Mat::from_fn(2, ORDER, &mut entry);
    let a = Mat::from_fn(ORDER, ORDER, |row, column| {
        let rate = 0.05 * 1.5_f64.powi((row / 2) as i32);
        match (row / 2 == column / 2, row % 2, column % 2) {
            (false, ..) => 0.0,
            (true, 0, 1) => rate,
            (true, 1, 0) => -rate,
            _ => -0.3 * rate,
        }
    });
    StateSpace::new(a, b, c, Mat::zeros(2, 2), None)
}
