//! A study in closed form: Gaussian wakes that a helix makes recover sooner, sinusoidal pitch.

pub(crate) mod layouts;

use basis::Sense;
use basis::records::{
    Conditions, Cost, DeliveredPitch, PitchResponse, Plane, PlaneAxes, Series, Statistic, Summary,
    TurbineSummary, Warning, WarningKind, examples,
};
use report::{RunRecords, StudyRecords};
use std::f64::consts::TAU;

/// Rotor diameter (m).
const DIAMETER: f64 = 240.0;
/// Free stream (m/s).
const WIND_SPEED: f64 = 9.0;
/// Hub height (m).
const HUB_HEIGHT: f64 = 150.0;
/// Strouhal number of every excitation.
const STROUHAL: f64 = 0.25;
const SPACING: f64 = 5.0;
const SPIN_UP: f64 = 300.0;
const DURATION: f64 = 2400.0;
const INTERVAL: f64 = 0.25;
const ROTOR_SPEED: f64 = 0.75;

/// One run to make up: name, sense (+1 ccw, −1 cw) and amplitude (deg), gains of T1, T2, array.
#[derive(Clone, Copy)]
struct Recipe {
    /// Name of the run.
    name: &'static str,
    /// +1 counter-clockwise, −1 clockwise.
    sense: f64,
    /// Amplitude on T1 (deg).
    amplitude_deg: f64,
    /// Gains of T1, T2 and both.
    gains: [f64; 3],
}

/// Baseline and one counter-clockwise helix.
pub(crate) fn two_runs() -> StudyRecords {
    let helix =
        Recipe { name: "helix-ccw", sense: 1.0, amplitude_deg: 4.0, gains: [-0.021, 0.142, 0.053] };
    study(&[helix])
}

/// Baseline and both senses at four amplitudes.
pub(crate) fn nine_runs() -> StudyRecords {
    let names = ["ccw-2", "ccw-3", "ccw-4", "ccw-5", "cw-2", "cw-3", "cw-4", "cw-5"];
    let recipes = names.into_iter().enumerate().map(|(index, name)| {
        let amplitude_deg = 2.0 + (index % 4) as f64;
        let sense = if index < 4 { 1.0 } else { -1.0 };
        let gain = (0.012 + 0.005 * sense) * amplitude_deg;
        let loss = -0.0016 * amplitude_deg * amplitude_deg;
        Recipe { name, sense, amplitude_deg, gains: [loss, 2.4 * gain, gain] }
    });
    study(&recipes.collect::<Vec<_>>())
}

/// Baseline and the given runs.
fn study(recipes: &[Recipe]) -> StudyRecords {
    let baseline = Recipe { name: "baseline", sense: 1.0, amplitude_deg: 0.0, gains: [0.0; 3] };
    let runs = std::iter::once(&baseline).chain(recipes).map(run).collect();
    StudyRecords {
        case_name: "quickstart".into(),
        description: Some("What a helix on T1 does to a row of two IEA 15 MW turbines.".into()),
        case_text: format!(
            "name = \"quickstart\" # <script>alert(1)</script>\n\n[wind]\nspeed = {WIND_SPEED:.1}\n\n\
             [[turbine]]\nname = \"T1\"\nposition_diameters = [0.0, 0.0]\n\n\
             [[turbine]]\nname = \"T2\"\nposition_diameters = [{SPACING:.1}, 0.0]\n"
        ),
        runs,
        incomplete: Vec::new(),
        synchronisation: Vec::new(),
        signals: Vec::new(),
        version: "0.1.0".into(),
    }
}

fn statistic(mean: f64, relative: f64) -> Statistic {
    Statistic {
        mean,
        standard_deviation: 3.0 * relative * mean,
        half_width_95: Some(relative * mean),
        n_blocks: 3,
    }
}

fn run(recipe: &Recipe) -> RunRecords {
    let is_baseline = recipe.amplitude_deg == 0.0;
    let powers = [9.1e6 * (1.0 + recipe.gains[0]), 4.3e6 * (1.0 + recipe.gains[1])];
    let gain = |mean: f64, half: f64| {
        let statistic =
            Statistic { mean, standard_deviation: half, half_width_95: Some(half), n_blocks: 3 };
        (!is_baseline).then_some(statistic)
    };
    let excitation = STROUHAL * WIND_SPEED / DIAMETER;
    let sense = if recipe.sense > 0.0 { Sense::CounterClockwise } else { Sense::Clockwise };
    let made = |index: usize, name: &str| examples::turbine(name, powers[index]);
    let turbines = ["T1", "T2"].iter().enumerate().map(|(index, name)| TurbineSummary {
        control: if index == 0 && !is_baseline {
            examples::helix(sense, recipe.amplitude_deg)
        } else {
            made(index, name).control
        },
        power: statistic(powers[index], 0.02 + 0.02 * index as f64),
        thrust: statistic([1.7e6, 1.1e6][index], 0.01),
        rotor_speed: statistic(ROTOR_SPEED * [1.0, 0.82][index], 0.01),
        pitch: statistic(0.0, 0.0),
        delivered_pitch: (index == 0 && !is_baseline).then_some(DeliveredPitch {
            commanded_amplitude_deg: recipe.amplitude_deg,
            delivered_amplitude_deg: 0.97 * recipe.amplitude_deg,
            frequency_hz: ROTOR_SPEED / TAU + recipe.sense * excitation,
            excitation_frequency_hz: excitation,
            clipped_share: 0.0,
        }),
        power_gain: gain(recipe.gains[index], [0.004, 0.021][index]),
        pitch_response: (index == 1).then_some(PitchResponse::Loads {
            azimuth_offset: 0.25,
            delay: 3.5,
            gain: 1.6e8,
        }),
        ..made(index, name)
    });
    let summary = examples::summary(recipe.name, turbines.collect());
    RunRecords {
        summary: Summary {
            case: "quickstart".into(),
            compare_with: (!is_baseline).then(|| "baseline".into()),
            conditions: Conditions {
                target_wind_speed: WIND_SPEED,
                direction_deg: 270.0,
                realised_wind_speed: 8.94,
                rotor_diameter: DIAMETER,
                spin_up: SPIN_UP,
                duration: DURATION,
                ..summary.conditions
            },
            array_power: statistic(powers[0] + powers[1], 0.025),
            array_power_gain: gain(recipe.gains[2], 0.012),
            cost: Cost {
                wall_time: 82.4,
                n_cells: 1_258_291,
                n_steps: 19_200,
                updates_per_second: 293e6,
                n_threads: 2,
                memory: 119_537_664,
                peak_memory: (!is_baseline).then_some(297_800_000),
            },
            warnings: if is_baseline {
                Vec::new()
            } else {
                let message =
                    "power of T1 differs from blade-element momentum by 6.1 % (limit 5 %)";
                vec![Warning { kind: WarningKind::Setup, turbine: None, message: message.into() }]
            },
            ..summary
        },
        series: series(recipe, powers),
        mean_planes: planes(recipe, None),
        filaments: None,
        instant_planes: [900.0, 2400.0].iter().flat_map(|t| planes(recipe, Some(*t))).collect(),
    }
}

/// A number in [−1, 1) from an index, without any generator.
fn noise(index: usize, seed: usize) -> f64 {
    let mut bits = (index as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (seed as u64) << 17;
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ bits >> 31) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn series(recipe: &Recipe, powers: [f64; 2]) -> Series {
    let n_samples = (DURATION / INTERVAL) as usize;
    let times: Vec<f64> = (1..=n_samples).map(|step| step as f64 * INTERVAL).collect();
    let mut series = Series { names: vec!["Time".into()], columns: vec![times.clone()] };
    let excitation = TAU * STROUHAL * WIND_SPEED / DIAMETER;
    for (turbine, power) in powers.into_iter().enumerate() {
        let name = |channel: &str| format!("T{}.{channel}", turbine + 1);
        let speed = ROTOR_SPEED * [1.0, 0.82][turbine];
        let gust = |time: f64| {
            0.07 * (time / 47.0 + turbine as f64).sin()
                + 0.05 * (time / 19.0).sin()
                + 0.03 * (time / 6.3).cos()
        };
        let rise = |time: f64| if turbine == 0 { 1.0 } else { 1.0 + 0.9 * (-time / 90.0).exp() };
        series.names.push(name("GenPwr"));
        series.columns.push(
            times
                .iter()
                .enumerate()
                .map(|(index, &t)| power * (rise(t) + gust(t) + 0.012 * noise(index, turbine)))
                .collect(),
        );
        series.names.push(name("RotSpeed"));
        series.columns.push(times.iter().map(|&t| speed * (1.0 + 0.3 * gust(t))).collect());
        series.names.push(name("Azimuth"));
        series.columns.push(times.iter().map(|&t| (speed * t).rem_euclid(TAU)).collect());
        for blade in 1..=3 {
            let amplitude =
                if turbine == 0 { 0.97 * recipe.amplitude_deg.to_radians() } else { 0.0 };
            let shift = TAU * f64::from(blade - 1) / 3.0;
            series.names.push(name(&format!("BldPitch{blade}")));
            series.columns.push(
                times
                    .iter()
                    .map(|&t| {
                        let phase = (speed + recipe.sense * excitation) * t + shift;
                        0.003 + amplitude * phase.cos()
                    })
                    .collect(),
            );
        }
    }
    series
}

/// Velocity at a point: two Gaussian wakes, wider and weaker with the amplitude, that meander at
/// an instant.
fn velocity(recipe: &Recipe, [x, y, z]: [f64; 3], time: Option<f64>) -> f64 {
    let mut velocity = WIND_SPEED * (z.max(10.0) / HUB_HEIGHT).powf(0.1);
    let mixing = 1.0 + 0.10 * recipe.amplitude_deg * if recipe.sense > 0.0 { 1.0 } else { 0.6 };
    for (index, turbine) in [0.0, SPACING * DIAMETER].into_iter().enumerate() {
        let distance = (x - turbine) / DIAMETER;
        let width = 0.36 + 0.035 * mixing * mixing * distance.max(0.0);
        let strength = [0.62, 0.5][index] * (0.36 / width).powi(2);
        let entry = 1.0 / (1.0 + (-8.0 * (distance - 0.2)).exp());
        let swing = time.map_or(0.0, |time| {
            let phase = TAU * STROUHAL * (WIND_SPEED * time / DIAMETER - distance);
            0.04 * recipe.amplitude_deg * distance.clamp(0.0, 4.0) * phase.sin() * 0.35
        });
        let radius = (y / DIAMETER - swing).hypot((z - HUB_HEIGHT) / DIAMETER);
        velocity -= WIND_SPEED * strength * entry * (-0.5 * (radius / width).powi(2)).exp();
    }
    if let Some(time) = time {
        let ripple =
            |k: f64, p: f64| ((x - WIND_SPEED * time) * k + p).sin() * (y * k * 1.3 + p).cos();
        velocity += 0.25 * (ripple(0.02, 0.3) + ripple(0.047, 1.9) + ripple(0.09, 4.0));
    }
    velocity
}

/// A plane without a name at time zero, its points `step` (m) apart, with `velocity` (m/s) along the wind.
pub(crate) fn sampled(
    axes: PlaneAxes,
    origin: [f64; 3],
    n_points: [usize; 2],
    step: f64,
    velocity: impl Fn([f64; 3]) -> f64,
) -> Plane {
    let mut streamwise = Vec::with_capacity(n_points[0] * n_points[1]);
    for second in 0..n_points[1] {
        for first in 0..n_points[0] {
            let (a, b) = (first as f64 * step, second as f64 * step);
            let offset = match axes {
                PlaneAxes::Horizontal => [a, b, 0.0],
                PlaneAxes::Streamwise => [a, 0.0, b],
                PlaneAxes::Crosswind => [0.0, a, b],
            };
            let point = [0, 1, 2].map(|axis| origin[axis] + offset[axis]);
            streamwise.push(velocity(point) as f32);
        }
    }
    let still = vec![0.0; streamwise.len()];
    let (velocity, spacing) = ([streamwise, still.clone(), still], [step; 2]);
    Plane {
        name: String::new(),
        axes,
        origin,
        spacing,
        n_points,
        time: 0.0,
        averaged: 0.0,
        velocity,
    }
}

fn planes(recipe: &Recipe, time: Option<f64>) -> Vec<Plane> {
    let step = DIAMETER / 16.0;
    let mut planes = Vec::new();
    let mut add = |name: String, axes, origin: [f64; 3], n_points: [usize; 2]| {
        let plane = sampled(axes, origin, n_points, step, |point| velocity(recipe, point, time));
        let averaged = if time.is_some() { 0.0 } else { DURATION - SPIN_UP };
        planes.push(Plane { name, time: time.unwrap_or(DURATION), averaged, ..plane });
    };
    let half_width = 2.5 * DIAMETER;
    let start = [-2.0 * DIAMETER, -half_width, HUB_HEIGHT];
    add("hub-height".into(), PlaneAxes::Horizontal, start, [16 * 11 + 1, 16 * 5 + 1]);
    if time.is_none() {
        let start = [-2.0 * DIAMETER, 0.0, 0.5 * step];
        add("streamwise".into(), PlaneAxes::Streamwise, start, [16 * 11 + 1, 16 * 3]);
    }
    for distance in [2.0, 3.0, 4.0, 5.0, 7.0] {
        let start = [distance * DIAMETER, -half_width, 0.5 * step];
        add(format!("{distance}D"), PlaneAxes::Crosswind, start, [16 * 5 + 1, 16 * 3]);
    }
    planes
}
