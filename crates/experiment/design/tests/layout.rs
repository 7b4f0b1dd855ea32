//! Turbines behind one another, in winds of which every quarter of a rotor is known, with surrogates of a
//! law that is known.

use design::layout::{Layout, draw_layout, predict_layout};
use design::regression::{KernelText, TrainQuestion, train};
use flow::inflow::{InflowError, PlaneGrid, Planes};
use formats::turbulence_box::{self, Origin};
use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use surrogate::Trend;

const DIAMETER: f64 = 100.0;
const HUB: f64 = 80.0;
/// Wind in the middle of the wake's record (m/s), and by how much more blows a metre to the left (1/s).
const SPEED: f64 = 7.0;
const ASIDE: f64 = 0.004;
/// Wind across the axis in every record (m/s), to the left.
const ACROSS: f64 = 0.5;
const INPUTS: [&str; 5] = [
    "T1.sector_left.wind_speed",
    "T1.sector_right.wind_speed",
    "T1.sector_up.turbulence_intensity",
    YAW,
    "control.T1.amplitude_deg",
];
/// The input of the nacelle: its turn from the axis, or from the wind.
const YAW: &str = "turbine.T1.yaw_deg";
const MISALIGNMENT: &str = "T1.yaw_misalignment_deg";

/// Wind that grows evenly to the left, with waves that pass.
struct Record {
    slope: f64,
    speed: f64,
}

impl Planes for Record {
    fn grid(&self) -> PlaneGrid {
        PlaneGrid {
            n_y: 41,
            n_z: 14,
            spacing: [10.0, 10.0],
            first: [-200.0, 15.0],
            interval: 1.0,
            speed: self.speed,
            n_steps: 80,
            repeats: false,
        }
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        let wave = 0.4 * (TAU * step as f64 / 8.0).sin();
        for (point, value) in values.iter_mut().enumerate() {
            let y = -200.0 + 10.0 * (point % 41) as f64;
            *value = [self.speed + self.slope * y + wave, ACROSS, 0.0].map(|value| value as f32);
        }
        Ok(())
    }
}

fn record(path: &Path, speed: f64, slope: f64) {
    let origin = Origin { path, hub_height: HUB, description: "a slope" };
    turbulence_box::write_planes(path, &mut Record { slope, speed }, origin).expect("a record");
}

/// What the surrogates are trained on: linear in all inputs, so that they have it exactly.
fn law(x: &[f64]) -> [f64; 2] {
    let power = 2.0 * (x[0] + x[1]) - 0.05 * x[4];
    [power, 1.0 + 3.0 * (x[0] - x[1]) + 40.0 * x[2] + 0.02 * x[3] + 0.5 * x[4]]
}

/// Surrogates of power and load, in `folder`; that of the load knows the nacelle by `yaw`.
fn surrogates(folder: &Path, yaw: &str) {
    let mut text = String::new();
    for row in 0..60 {
        let share = |of: f64| (of * f64::from(row)).fract();
        let x = [
            4.0 + 6.0 * share(0.618),
            4.0 + 6.0 * share(0.755),
            0.01 + 0.1 * share(0.569),
            -10.0 + 20.0 * share(0.414),
            4.5 * share(0.303),
        ];
        let [power, load] = law(&x);
        x.iter().for_each(|x| write!(text, "{x},").expect("a string takes it"));
        writeln!(text, "{power},{load}").expect("a string takes it");
    }
    for (output, yaw) in [("power", YAW), ("load", yaw)] {
        let inputs = INPUTS.map(|input| if input == YAW { yaw } else { input });
        let file = folder.join(format!("{output}.csv"));
        let heading = inputs.join(",") + ",power [MW],load [MN-m]\n";
        fs::write(&file, heading + &text).expect("written");
        let question = TrainQuestion {
            file,
            inputs: inputs.map(str::to_owned).to_vec(),
            output: output.to_owned(),
            kernel: KernelText::new("se").expect("a kernel"),
            trend: Trend::Linear,
            deviation: None,
            group: None,
            estimates_noise: true,
            split: 1.0,
            seed: 1,
            n_starts: 2,
            n_inducing: None,
        };
        let found = train(&question).expect("a surrogate");
        found.model.write(&folder.join(format!("{output}.json"))).expect("written");
    }
}

const LAYOUT: &str = r#"
wind_speed = 8.0
diameter = 100.0
hub_height = 80.0

[surrogates]
power = "power.json"
load = "load.json"

[block]
duration = 79.0

[directions]
from = -4.0
to = 4.0
step = 0.5
deviation = 2.5

[displacements]
from = -100.0
to = 100.0
step = 50.0

[along]
turbine = "T1"
input = "amplitude_deg"
from = 0.0
to = 4.0
step = 1.0

[[turbine]]
name = "T1"
position = [0.0, 0.0]

[[turbine]]
name = "T2"
position_diameters = [5.0, 0.0]
behind = "T1"

[[strategy]]
name = "greedy"
wind = { T1 = "free.bts", T2 = "wake.bts" }
inputs = { T1 = { amplitude_deg = 0.0 }, T2 = { amplitude_deg = 0.0 } }

[[strategy]]
name = "helix"
wind = { T1 = "free.bts", T2 = "mixed.bts" }
inputs = { T1 = { "control.T1.amplitude_deg" = 4.0 }, T2 = { amplitude_deg = 0.0 } }
"#;

/// A folder with records, surrogates and the layout of `text`.
fn written(text: &str, yaw: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    record(&at("free.bts"), 8.0, 0.0);
    record(&at("wake.bts"), SPEED, ASIDE);
    record(&at("mixed.bts"), SPEED + 0.5, ASIDE);
    surrogates(folder.path(), yaw);
    fs::write(at("layout.toml"), text).expect("written");
    folder
}

fn found(text: &str, yaw: &str) -> (tempfile::TempDir, Layout) {
    let folder = written(text, yaw);
    let found = predict_layout(&folder.path().join("layout.toml")).expect("predictions");
    (folder, found)
}

/// The surrogates' inputs of a rotor `shift` (m) to the left in a wind of `speed` and `slope`, which is
/// turned by `direction`.
fn inputs([speed, slope]: [f64; 2], shift: f64, direction: f64, amplitude: f64) -> [f64; 5] {
    let away = 8.0 * FRAC_PI_4.sin() * 0.5 * DIAMETER / (3.0 * PI);
    let intensity = (0.16 / 2.0 / 3.0_f64).sqrt() / 8.0;
    let at = |y: f64| speed + slope * (shift + y);
    [at(away), at(-away), intensity, -direction, amplitude]
}

/// Every prediction is the law at the wind that is known there. A full field holds its wind to 1/65535 of
/// its range of 2.4 m/s, quarters are averaged to 1e-4 of their slope, and the surrogates have the law
/// within 1e-4 of an output's spread of 3.
#[test]
fn turbines_meet_the_wind_of_their_place_in_the_wake() {
    let (_folder, found) = found(LAYOUT, YAW);
    assert_eq!(
        found.outputs.iter().map(|port| port.name.as_str()).collect::<Vec<_>>(),
        ["load", "power"]
    );
    assert_eq!((found.directions.len(), found.displacements.len()), (2 * 2 * 17, 2 * 5));
    let wind = |strategy: usize, turbine: usize| match (strategy, turbine) {
        (_, 0) => [8.0, 0.0],
        (0, _) => [SPEED, ASIDE],
        _ => [SPEED + 0.5, ASIDE],
    };
    for (rows, turned) in [(&found.directions, true), (&found.displacements, false)] {
        for row in rows {
            let amplitude = if (row.strategy, row.turbine) == (1, 0) { 4.0 } else { 0.0 };
            let direction = if turned { row.at } else { 0.0 };
            let shift = match (turned, row.turbine) {
                (false, _) => row.at,
                (true, 0) => 0.0,
                // Where the wind turns to the left, T2 stands to the right of the wake.
                (true, _) => -5.0 * DIAMETER * row.at.to_radians().sin(),
            };
            assert!((row.shift - shift).abs() < 1e-9, "{row:?}");
            let [power, load] =
                law(&inputs(wind(row.strategy, row.turbine), shift, direction, amplitude));
            let [load_found, power_found] = [0, 1].map(|output| row.predictions[output].mean);
            assert!((power_found - power).abs() < 1e-3, "{row:?}: {power}");
            assert!((load_found - load).abs() < 1e-3, "{row:?}: {load}");
        }
    }
    let (input, along) = found.along.as_ref().expect("asked for");
    assert_eq!((input.as_str(), along.len()), ("amplitude_deg", 5));
    for row in along {
        let [_, load] = law(&inputs([8.0, 0.0], 0.0, 0.0, row.at));
        assert!((row.predictions[0].mean - load).abs() < 1e-3, "{row:?}");
    }
    assert!(found.warnings.is_empty(), "{:?}", found.warnings);
}

/// A surrogate that knows the turn of the nacelle from the wind is told how the record blows across the
/// rotor, atan(v/u) with the mean of u over the rotor, one beside it that knows its turn from the axis is
/// not. The nacelle of T2 is turned by 3° itself.
#[test]
fn wind_across_a_rotor_is_as_good_as_yaw() {
    let yawed = "T2 = { amplitude_deg = 0.0, yaw_deg = 3.0 } }";
    let text = LAYOUT.replace("T2 = { amplitude_deg = 0.0 } }", yawed);
    let (_folder, found) = found(&text, MISALIGNMENT);
    for (rows, turned, n) in [(&found.displacements, 0.0, 5), (&found.directions, 1.0, 17)] {
        let of_t2 = rows.iter().filter(|row| (row.strategy, row.turbine) == (0, 1));
        let of_t2: Vec<_> = of_t2.collect();
        assert_eq!(of_t2.len(), n);
        for row in of_t2 {
            let across = ACROSS.atan2(SPEED + ASIDE * row.shift).to_degrees();
            assert!((3.8..4.4).contains(&across), "{across}");
            let turn = turned * row.at + across - 3.0;
            let [power, load] = law(&inputs([SPEED, ASIDE], row.shift, turn, 0.0));
            let [load_found, power_found] = [0, 1].map(|output| row.predictions[output].mean);
            assert!((load_found - load).abs() < 1e-3, "{row:?}: {load}");
            assert!((power_found - power).abs() < 1e-3, "{row:?}: {power}");
        }
    }
    // What follows from the record cannot be told.
    let folder =
        written(&text.replace("yaw_deg = 3.0", "yaw_misalignment_deg = 3.0"), MISALIGNMENT);
    let error = predict_layout(&folder.path().join("layout.toml")).expect_err("refused");
    let told = format!("{:?}", miette::Report::new(error));
    assert!(told.contains("yaw_misalignment_deg follows from"), "{told}");
}

/// Weights of directions make up one and fall off as a Gaussian of 2.5°; what is odd in the direction
/// averages out.
#[test]
fn means_over_the_direction_have_gaussian_weights() {
    let (folder, found) = found(LAYOUT, YAW);
    let of_t1: Vec<_> =
        found.directions.iter().filter(|row| row.strategy == 0 && row.turbine == 0).collect();
    let total: f64 = of_t1.iter().map(|row| row.weight).sum();
    let ratio = of_t1[0].weight / of_t1[8].weight;
    assert!((total - 1.0).abs() < 1e-12 && (ratio - (-0.5 * 1.6_f64.powi(2)).exp()).abs() < 1e-12);
    let average = |strategy: usize, turbine: Option<usize>| {
        let is_it = |one: &&design::layout::LayoutAverage| {
            one.strategy == strategy && one.turbine == turbine
        };
        found.averages.iter().find(is_it).expect("an average")
    };
    let [free, wake, mixed] = [
        law(&inputs([8.0, 0.0], 0.0, 0.0, 0.0))[0],
        law(&inputs([SPEED, ASIDE], 0.0, 0.0, 0.0))[0],
        law(&inputs([SPEED + 0.5, ASIDE], 0.0, 0.0, 0.0))[0],
    ];
    let power = |strategy, turbine| average(strategy, turbine).values[1].expect("power").mean;
    assert!((power(0, Some(1)) - wake).abs() < 1e-3 && (power(0, None) - free - wake).abs() < 2e-3);
    let gain = average(1, None).changes[1].expect("a gain").mean;
    let expected = (free - 0.2 + mixed) / (free + wake) - 1.0;
    assert!((gain - expected).abs() < 3e-4, "{gain} {expected}");
    assert_eq!((average(1, None).values[0], average(0, Some(0)).changes[1]), (None, None));

    let names = draw_layout(&found, folder.path()).expect("drawn");
    for name in [
        "layout-direction-power",
        "layout-displacement-load",
        "layout-input-load",
        "layout-gain-against-load",
    ] {
        assert!(names.iter().any(|found| found == name), "{names:?}");
        assert!(folder.path().join(format!("figures/{name}.svg")).exists());
    }
    found.write(&folder.path().join("out.csv")).expect("written");
    let text = fs::read_to_string(folder.path().join("out.csv")).expect("read");
    let head = "over,at,strategy,turbine,shift [m],weight,load [MN-m],load_deviation [MN-m],power [MW],power_deviation [MW]";
    assert_eq!(text.lines().next(), Some(head));
    assert_eq!(text.lines().count(), 1 + 68 + 10 + 5);
}

#[test]
fn what_is_wrong_is_named_with_the_fix() {
    let folder = written(LAYOUT, YAW);
    let path = folder.path().join("layout.toml");
    let told = |text: String| {
        fs::write(&path, text).expect("written");
        let error = miette::Report::new(predict_layout(&path).expect_err("refused"));
        let drawn = format!("{error:?}").replace('│', " ");
        drawn.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for (from, to, words) in [
        ("diameter = 100.0", "diameter = -1.0", "`diameter` is -1"),
        ("hub_height = 80.0", "hub_hight = 80.0", "hub_hight"),
        ("step = 0.5", "step = 0.3", "`directions` goes from -4 to 4 by 0.3"),
        ("behind = \"T1\"", "behind = \"T9\"", "`turbine.T2.behind` names T9, which is no turbine"),
        (", T2 = \"wake.bts\" }", " }", "strategy greedy has no wind for turbine T2"),
        (
            ", T2 = { amplitude_deg = 0.0 } }",
            " }",
            "add inputs.T2 = { \"control.T1.amplitude_deg\" = … }",
        ),
        (
            "T2 = { amplitude_deg = 0.0 } }",
            "T2 = { amplitud_deg = 0.0 } }",
            "no surrogate has the input amplitud_deg",
        ),
        ("duration = 79.0", "duration = 90.0", "the record ends at 79.0 s"),
        ("to = 100.0", "to = 200.0", "record a wider or higher slice"),
        ("load = \"load.json\"", "load = \"none.json\"", "none.json"),
    ] {
        let text = LAYOUT.replacen(from, to, 1);
        assert_ne!(text, LAYOUT);
        let told = told(text);
        assert!(told.contains(words), "{told}\nlacks: {words}");
    }
    // Beyond the training data it answers, and warns.
    let text = LAYOUT.replacen("to = 4.0\nstep = 1.0", "to = 9.0\nstep = 1.0", 1);
    fs::write(&path, text).expect("written");
    let warnings = predict_layout(&path).expect("predictions").warnings;
    let words = "of control.T1.amplitude_deg that was trained on, the furthest is 9 (strategy greedy, turbine T1)";
    assert!(warnings.iter().any(|told| told.contains(words)), "{warnings:?}");
}
