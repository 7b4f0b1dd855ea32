//! The tunnel turbine with its swashplate, and the helix on the first of two, beside a published experiment.

mod vortices;
mod wake;

use crate::Row;
use crate::row::Tolerance::{AtLeast, AtMost, Within};
use crate::studies::{Carried, failure, find, summaries};
use basis::records::Summary;
use std::f64::consts::{PI, TAU};
use turbine::Definition;
use turbine::steady::steady;

/// Where the expected values come from.
const TUNNEL: &str = "van der Hoek et al. (2024), wind tunnel";
const CASE_ITSELF: &str = "the case itself";

const MODEL: &str = "mowito-06";
/// Tip-speed ratio of greatest power in the tunnel (–), and the electrical power coefficient there (–).
const BEST_RATIO: f64 = 5.0;
const POWER_COEFFICIENT: f64 = 0.27;
/// Wind (m/s) and air (kg/m³) of the cases.
const WIND_SPEED: f64 = 5.0;
const AIR_DENSITY: f64 = 1.225;
/// Run, Strouhal number (–), average amplitude of the blades (deg), gain of both turbines together (%), and
/// power of the second over its baseline (–). van der Hoek et al. (2024), Table 1, §3.5.
const RUNS: [(&str, f64, f64, f64, f64); 3] = [
    ("cw", 0.34, 2.5, 8.0, 2.0),
    ("ccw", 0.28, 2.0, 8.7, 2.0),
    ("ccw-optimum", 0.28, 2.4, 15.1, 3.0),
];
/// Accepted distances: of amplitudes, given to a tenth (deg); of gains, given without intervals (points of a
/// percent); of the second turbine's power, told in words (–).
const AMPLITUDE_TOLERANCE: f64 = 0.1;
const GAIN_TOLERANCE: f64 = 3.0;
const RATIO_TOLERANCE: f64 = 0.5;
/// Least loss of the first turbine that the experiment tells of (%).
const LEAST_LOSS: f64 = -10.0;

/// The turbine alone: power in steady wind, and what its swashplate makes of helices.
pub fn tunnel_turbine() -> Vec<Row> {
    let file = match formats::library::load(MODEL) {
        Ok(file) => file,
        Err(error) => return failure(error.to_string()),
    };
    let pitch = file.controller.fine_pitch;
    let mut rows = steady_rows(&file.definition, pitch);
    let case = Carried::Own(include_str!("../cases/tunnel-pitch.toml"));
    match summaries(case, "tunnel-turbine", Vec::new()) {
        Ok((summaries, _)) => rows.extend(delivered(&summaries, "prescribed wind")),
        Err(problem) => rows.extend(failure(problem)),
    }
    rows
}

/// Power of `definition` at `pitch` (rad) in steady wind, and whether it is the greatest there.
fn steady_rows(definition: &Definition, pitch: f64) -> Vec<Row> {
    let power = |ratio: f64, pitch: f64| steady(definition, ratio, pitch).power;
    let row = |what: &str, measured: f64, expected: f64, tolerance, unit| Row {
        what: what.to_owned(),
        measured,
        expected,
        tolerance,
        unit,
        source: TUNNEL,
    };
    let pitches = || (-60..=60).map(|step| pitch + f64::from(step) * 0.1 * PI / 180.0);
    let ratios = || (30..=90).map(|step| 0.1 * f64::from(step));
    let best = |values: &mut dyn Iterator<Item = (f64, f64)>| {
        values.fold((f64::NAN, f64::MIN), |best, next| if next.1 > best.1 { next } else { best }).0
    };
    let best_pitch = best(&mut pitches().map(|one| (one, power(BEST_RATIO, one))));
    let best_ratio = best(&mut ratios().map(|one| (one, power(one, pitch))));
    vec![
        row(
            "electrical power coefficient at tip-speed ratio 5, blade-element momentum",
            definition.efficiency() * power(BEST_RATIO, pitch),
            POWER_COEFFICIENT,
            Within(0.01),
            "–",
        ),
        row(
            "pitch of greatest power at tip-speed ratio 5, from the fine pitch",
            (best_pitch - pitch).to_degrees(),
            0.0,
            Within(0.5),
            "deg",
        ),
        row(
            "tip-speed ratio of greatest power at the fine pitch",
            best_ratio,
            BEST_RATIO,
            Within(0.5),
            "–",
        ),
    ]
}

/// What the blades of T1 got, in `air`.
fn delivered(summaries: &[Summary], air: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    for (run, strouhal, amplitude, ..) in RUNS {
        let delivered = find(summaries, run).and_then(|s| s.turbines[0].delivered_pitch);
        rows.push(Row {
            what: format!("delivered amplitude, {run}, St {strouhal}, 5 m/s, {air}"),
            measured: delivered.map_or(f64::NAN, |pitch| pitch.delivered_amplitude_deg),
            expected: amplitude,
            tolerance: Within(AMPLITUDE_TOLERANCE),
            unit: "deg",
            source: TUNNEL,
        });
        rows.push(Row {
            what: format!("delivered excitation frequency, {run}, St {strouhal}, {air}"),
            measured: delivered.map_or(f64::NAN, |pitch| pitch.excitation_frequency_hz),
            expected: find(summaries, run).map_or(f64::NAN, |summary| {
                strouhal * WIND_SPEED / summary.conditions.rotor_diameter
            }),
            tolerance: Within(0.02),
            unit: "Hz",
            source: CASE_ITSELF,
        });
    }
    rows
}

/// `cases/tunnel-helix.toml`: two turbines at 5 D, baseline and helices, in the lattice.
pub fn tunnel_helix() -> Vec<Row> {
    let case = Carried::Shipped("tunnel-helix");
    let (summaries, folder) = match summaries(case, "tunnel-helix", Vec::new()) {
        Ok(done) => done,
        Err(problem) => return failure(problem),
    };
    let mut rows = baseline(&summaries, "lattice, walls felt");
    rows.extend(delivered(&summaries, "lattice"));
    rows.extend(powers(&summaries, "TI 1 %"));
    rows.extend(wake::rows(&folder));
    rows
}

/// `cases/tunnel-tip-vortices.toml`: what the tip vortices of the first turbine do in free vortices.
pub fn tunnel_tip_vortices() -> Vec<Row> {
    match summaries(Carried::Shipped("tunnel-tip-vortices"), "tunnel-tip-vortices", Vec::new()) {
        Ok((_, folder)) => vortices::rows(&folder),
        Err(problem) => failure(problem),
    }
}

/// `cases/tunnel-helix-free-wake.toml`: two turbines in free vortices.
pub fn tunnel_free_wake() -> Vec<Row> {
    let case = Carried::Shipped("tunnel-helix-free-wake");
    let (summaries, folder) = match summaries(case, "tunnel-free-wake", Vec::new()) {
        Ok(done) => done,
        Err(problem) => return failure(problem),
    };
    let mut rows = baseline(&summaries, "free wake");
    rows.extend(delivered(&summaries, "free wake"));
    rows.extend(powers(&summaries, "free wake"));
    rows.extend(wake::rows(&folder));
    rows
}

/// Power and speed of T1 without a helix.
fn baseline(summaries: &[Summary], air: &str) -> Vec<Row> {
    let Some(summary) = find(summaries, "baseline") else { return Vec::new() };
    let (first, diameter) = (&summary.turbines[0], summary.conditions.rotor_diameter);
    let wind = 0.5 * AIR_DENSITY * PI / 4.0 * diameter * diameter * WIND_SPEED.powi(3);
    vec![
        Row {
            what: format!("electrical power coefficient of T1, baseline, {air}"),
            measured: first.power.mean / wind,
            expected: POWER_COEFFICIENT,
            tolerance: Within(0.02),
            unit: "–",
            source: TUNNEL,
        },
        Row {
            what: "rotor frequency of T1 over that of the ccw helix".to_owned(),
            measured: first.rotor_speed.mean / TAU * diameter / (RUNS[1].1 * WIND_SPEED),
            expected: 5.68,
            tolerance: Within(0.05),
            unit: "–",
            source: TUNNEL,
        },
    ]
}

/// What helices cost and give.
fn powers(summaries: &[Summary], air: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    let percent = |gain: Option<f64>| gain.map_or(f64::NAN, |gain| 100.0 * gain);
    let mut gains = [f64::NAN; 3];
    for ((run, strouhal, amplitude, expected, ratio), kept) in RUNS.into_iter().zip(&mut gains) {
        let summary = find(summaries, run);
        let conditions = format!("{run}, {amplitude}°, St {strouhal}, 5 D, 5 m/s, {air}");
        *kept = percent(summary.and_then(|s| s.array_power_gain).map(|gain| gain.mean));
        rows.push(Row {
            what: format!("gain of both turbines, {conditions}"),
            measured: *kept,
            expected,
            tolerance: Within(GAIN_TOLERANCE),
            unit: "%",
            source: TUNNEL,
        });
        let interval = summary.and_then(|s| s.array_power_gain).and_then(|gain| gain.half_width_95);
        rows.push(Row {
            what: format!("half of the 95 % interval of that gain, {run}"),
            measured: percent(interval),
            expected: GAIN_TOLERANCE,
            tolerance: AtMost,
            unit: "%",
            source: CASE_ITSELF,
        });
        let of = |turbine: usize| summary.and_then(|s| s.turbines[turbine].power_gain);
        rows.push(Row {
            what: format!("change of T1, {conditions}"),
            measured: percent(of(0).map(|gain| gain.mean)),
            expected: LEAST_LOSS,
            tolerance: AtMost,
            unit: "%",
            source: TUNNEL,
        });
        rows.push(Row {
            what: format!("power of T2 over baseline, {conditions}"),
            measured: of(1).map_or(f64::NAN, |gain| 1.0 + gain.mean),
            expected: ratio,
            tolerance: Within(RATIO_TOLERANCE),
            unit: "–",
            source: TUNNEL,
        });
    }
    rows.push(Row {
        what: "gain of the larger amplitude less that of the smaller, ccw".to_owned(),
        measured: gains[2] - gains[1],
        expected: 0.0,
        tolerance: AtLeast,
        unit: "%",
        source: TUNNEL,
    });
    rows
}
