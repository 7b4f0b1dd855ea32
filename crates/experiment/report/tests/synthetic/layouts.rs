//! Made-up studies of other layouts: staggered rows, mixed rotors, long rows, wind without wakes.

use super::{INTERVAL, SPIN_UP, WIND_SPEED, noise, sampled, two_runs};
use basis::records::{
    FlowSummary, Plane, PlaneAxes, Rotor, Series, Statistic, TurbineSummary, examples,
};
use report::{RunRecords, StudyRecords};

/// Diameter (m) and hub height (m) of two machines.
const LARGE: [f64; 2] = [240.0, 150.0];
const SMALL: [f64; 2] = [126.0, 90.0];

/// A rotor to make up: diameter and hub height (m), x and y (large diameters).
type Placed = ([f64; 2], [f64; 2]);

/// Five turbines on three lines, two of them small; the interval of one is far longer than the others'.
pub(crate) fn staggered() -> StudyRecords {
    let placed: [Placed; 5] = [
        (LARGE, [0.0, 0.0]),
        (LARGE, [4.0, 0.9]),
        (SMALL, [4.0, -0.7]),
        (LARGE, [8.0, 0.0]),
        (SMALL, [8.0, 0.9]),
    ];
    let mut study = study("staggered", &placed);
    let gain = &mut study.runs[1].summary.turbines[2].power_gain;
    *gain = gain.map(|gain| Statistic { half_width_95: Some(1.3), ..gain });
    let power = &mut study.runs[0].summary.turbines[2].power;
    power.half_width_95 = Some(0.9 * power.mean);
    study
}

/// Fifteen turbines in one line.
pub(crate) fn long_row() -> StudyRecords {
    let placed: Vec<Placed> = (0..15).map(|index| (LARGE, [5.0 * f64::from(index), 0.0])).collect();
    study("long-row", &placed)
}

/// Two turbines in wind that does not feel them.
pub(crate) fn without_wakes() -> StudyRecords {
    let mut study = two_runs();
    for run in &mut study.runs {
        let summary = &mut run.summary;
        summary.flow = Some(FlowSummary {
            solver: "uniform".into(),
            has_wakes: false,
            limits: String::new(),
            grids: Vec::new(),
        });
        summary.conditions.cells_per_diameter = None;
        run.mean_planes.clear();
        run.instant_planes.clear();
    }
    study
}

fn study(name: &str, placed: &[Placed]) -> StudyRecords {
    let mut study = two_runs();
    study.case_name = name.into();
    study.description = Some(format!("{} turbines, made up to look at.", placed.len()));
    study.case_text = format!("name = \"{name}\"\n");
    for (index, run) in study.runs.iter_mut().enumerate() {
        let is_helix = index > 0;
        let excited = run.summary.turbines[0].clone();
        let turbines = placed.iter().enumerate().map(|(index, placed)| {
            let turbine = turbine(index, placed, is_helix);
            match (index, is_helix) {
                (0, true) => TurbineSummary {
                    control: excited.control.clone(),
                    delivered_pitch: excited.delivered_pitch,
                    ..turbine
                },
                _ => turbine,
            }
        });
        let turbines: Vec<TurbineSummary> = turbines.collect();
        run.series = series(&turbines, &run.series);
        run.summary.array_power = statistic(turbines.iter().map(|t| t.power.mean).sum(), 0.02);
        run.summary.turbines = turbines;
        planes(run, placed, is_helix);
    }
    study
}

fn statistic(mean: f64, relative: f64) -> Statistic {
    let half_width_95 = Some(relative * mean.abs());
    Statistic { mean, standard_deviation: 0.1 * mean.abs(), half_width_95, n_blocks: 3 }
}

fn turbine(index: usize, &([diameter, height], [x, y]): &Placed, is_helix: bool) -> TurbineSummary {
    let name = format!("T{}", index + 1);
    let change = [-0.02, 0.11, 0.06, 0.04, 0.03][index % 5];
    let power = 9.0e6 * (diameter / 240.0).powi(2) / (1.0 + 0.3 * (index as f64).min(3.0));
    let power = power * (1.0 + if is_helix { change } else { 0.0 });
    TurbineSummary {
        model: if diameter > 200.0 { "iea-15mw" } else { "nrel-5mw" }.into(),
        rotor: Some(Rotor { diameter, hub: [240.0 * x, 240.0 * y, height], yaw_deg: 0.0 }),
        power: statistic(power, 0.02),
        power_gain: is_helix.then(|| statistic(change, 0.25)),
        ..examples::turbine(&name, power)
    }
}

/// Power and rotor speed of `turbines` at the times of `like`, and the pitch of T1 as it is there.
fn series(turbines: &[TurbineSummary], like: &Series) -> Series {
    let times = like.columns[0].clone();
    let mut series = Series { names: vec!["Time".into()], columns: vec![times.clone()] };
    for (index, turbine) in turbines.iter().enumerate() {
        let gust =
            |time: f64| 0.07 * (time / 47.0 + index as f64).sin() + 0.04 * (time / 9.0).cos();
        let power = |(step, time): (usize, &f64)| {
            turbine.power.mean * (1.0 + gust(*time) + 0.012 * noise(step, index))
        };
        series.names.push(format!("{}.GenPwr", turbine.name));
        series.columns.push(times.iter().enumerate().map(power).collect());
        series.names.push(format!("{}.RotSpeed", turbine.name));
        series.columns.push(times.iter().map(|time| 0.7 * (1.0 + 0.3 * gust(*time))).collect());
    }
    for (name, column) in like.names.iter().zip(&like.columns) {
        if name.starts_with("T1.BldPitch") {
            series.names.push(name.clone());
            series.columns.push(column.clone());
        }
    }
    assert!(times.len() as f64 * INTERVAL > SPIN_UP);
    series
}

/// Velocity behind all rotors: Gaussian wakes that grow and add.
fn velocity(placed: &[Placed], is_helix: bool, [x, y, z]: [f64; 3]) -> f64 {
    let mut velocity = WIND_SPEED * (z.max(10.0) / 150.0).powf(0.1);
    let growth = if is_helix { 0.06 } else { 0.04 };
    for ([diameter, height], place) in placed {
        let distance = (x - 240.0 * place[0]) / diameter;
        let width = 0.36 + growth * distance.max(0.0);
        let entry = 1.0 / (1.0 + (-8.0 * (distance - 0.2)).exp());
        let radius = ((y - 240.0 * place[1]) / diameter).hypot((z - height) / diameter);
        let deficit = 0.55 * (0.36 / width).powi(2) * (-0.5 * (radius / width).powi(2)).exp();
        velocity -= WIND_SPEED * entry * deficit;
    }
    velocity.max(2.0)
}

/// Planes at hub height, along each line of rotors and across the wind.
fn planes(run: &mut RunRecords, placed: &[Placed], is_helix: bool) {
    let step = 20.0;
    let sides = placed.iter().map(|placed| 240.0 * placed.1[1]);
    let (low, high) = sides.clone().fold((0.0_f64, 0.0_f64), |(a, b), y| (a.min(y), b.max(y)));
    let end = 240.0 * placed.iter().map(|placed| placed.1[0]).fold(0.0, f64::max) + 960.0;
    let n = |from: f64, to: f64| ((to - from) / step).round() as usize + 1;
    let (left, right) = (low - 600.0, high + 600.0);
    let make = |name: String, axes, origin: [f64; 3], n_points: [usize; 2], averaged: f64| {
        let plane = sampled(axes, origin, n_points, step, |at| velocity(placed, is_helix, at));
        Plane { name, time: 2400.0, averaged, ..plane }
    };
    let from_above = [n(-480.0, end), n(left, right)];
    let start = [-480.0, left, 150.0];
    let (flat, average) = (PlaneAxes::Horizontal, 2100.0);
    run.instant_planes = vec![make("hub-height".into(), flat, start, from_above, 0.0)];
    run.mean_planes = vec![make("hub-height".into(), flat, start, from_above, average)];
    let mut lines: Vec<f64> = Vec::new();
    for (y, index) in sides.zip(1..) {
        if lines.contains(&y) {
            continue;
        }
        let name =
            if lines.is_empty() { "streamwise".into() } else { format!("streamwise-T{index}") };
        let (start, size) = ([-480.0, y, 10.0], [n(-480.0, end), 30]);
        run.mean_planes.push(make(name, PlaneAxes::Streamwise, start, size, average));
        lines.push(y);
    }
    for distance in [3.0, 6.0, 11.0] {
        let (start, size) = ([240.0 * distance, left, 10.0], [n(left, right), 30]);
        let name = format!("{distance}D");
        run.mean_planes.push(make(name, PlaneAxes::Crosswind, start, size, average));
    }
}
