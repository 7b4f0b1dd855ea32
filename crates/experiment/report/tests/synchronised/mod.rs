//! A made-up phase synchronisation of three turbines in closed form, with the shape that a real one has.

use basis::records::{Plane, PlaneAxes, Statistic};
use report::{
    Along, CentreLine, CurveEnd, CurvePoint, DeficitFigure, DeficitLine, DeficitPanel,
    OffsetFigure, OffsetPanel, OffsetPoint, SliceFigure, SlicePanel, SliceRotor, SpectrumFigure,
    SpectrumLine, Synchronisation, TrackFigure, TrackLine, TrackRow,
};
use std::f64::consts::{PI, TAU};

const DIAMETER: f64 = 240.0;
const SPEED: f64 = 10.5;
const PERIOD: f64 = 91.4;
/// Best and worst offset (deg).
const CASES: [(&str, usize, f64); 3] =
    [("bl-helix", 0, 0.0), ("sync-150", 1, 1.0), ("sync-330", 2, -0.6)];

/// Everything at once.
pub(crate) fn all() -> Synchronisation {
    Synchronisation {
        name: "T2".into(),
        phases: Vec::new(),
        offsets: vec![power()],
        tracks: vec![estimates(), responses()],
        spectra: vec![moments()],
        slices: Some(wake()),
        deficits: Some(deficits()),
    }
}

/// Smooth and never the same, about one in size.
fn wander(time: f64, seed: f64) -> f64 {
    0.5 * (TAU * time / 410.0 + seed).sin()
        + 0.3 * (TAU * time / 163.0 + 2.0 * seed).sin()
        + 0.2 * (TAU * time / 37.0 + 3.0 * seed).sin()
}

fn power() -> OffsetFigure {
    let offsets = [0.0, 90.0, 120.0, 150.0, 180.0, 210.0, 270.0, 330.0];
    let panel = |title: &str, mean: f64, swing: f64, half: f64| {
        let law = |offset: f64| mean + swing * (offset - 150_f64.to_radians()).cos();
        let point = |(index, offset): (usize, &f64)| {
            let offset = offset.to_radians();
            let change = Statistic {
                mean: law(offset) + 0.6 * half * wander(97.0 * index as f64, 1.0),
                standard_deviation: half,
                half_width_95: Some(half),
                n_blocks: 9,
            };
            OffsetPoint { offset, change }
        };
        let curve = (0..=72).map(|index| {
            let offset = TAU * f64::from(index) / 72.0;
            let wide = half * (0.55 + 0.25 * (offset - 0.8).sin().powi(2));
            let mean = law(offset);
            CurvePoint { offset, mean, band_95: [mean - wide, mean + wide] }
        });
        OffsetPanel {
            title: title.into(),
            points: offsets.iter().enumerate().map(point).collect(),
            curve: curve.collect(),
            highest: Some(CurveEnd {
                offset: 150_f64.to_radians(),
                offset_95: [117_f64.to_radians(), 182_f64.to_radians()],
                change: mean + swing,
            }),
            lowest: Some(CurveEnd {
                offset: 330_f64.to_radians(),
                offset_95: [301_f64.to_radians(), 365_f64.to_radians()],
                change: mean - swing,
            }),
        }
    };
    OffsetFigure {
        name: "power-over-offset".into(),
        title: "Power over the phase offset".into(),
        label: "power against bl-helix (%)".into(),
        panels: vec![
            panel("T2", -0.025, 0.012, 0.008),
            panel("T3", 0.012, 0.085, 0.02),
            panel("T2 + T3", -0.005, 0.055, 0.012),
        ],
    }
}

fn times() -> Vec<f64> {
    (0..2100).map(|index| 600.0 + f64::from(index)).collect()
}

fn line(name: &str, colour: usize, value: impl Fn(f64) -> f64) -> TrackLine {
    let times = times();
    let values = times.iter().map(|time| value(*time)).collect();
    TrackLine { name: name.into(), colour, times, values, band: Vec::new() }
}

/// Estimates converge from a wrong start to the truth, with a bias.
fn estimates() -> TrackFigure {
    let rate = TAU / PERIOD;
    let phase = |time: f64, axis: f64| 2.4 + 0.6 * wander(time, 5.0 + axis);
    let estimated = |time: f64, axis: f64| {
        phase(time, axis) + 0.25 + 0.35 * wander(3.0 * time, axis)
            - 2.6 * (-(time - 600.0) / 120.0).exp()
    };
    let wind = |label: &str, axis: f64, lead: f64| TrackRow {
        label: label.into(),
        is_angle: false,
        lines: vec![
            line("ground truth", 0, move |t| 0.9 * (rate * t + lead + phase(t, axis)).sin()),
            line("estimate", 1, move |t| 0.75 * (rate * t + lead + estimated(t, axis)).sin()),
        ],
    };
    let angle = |label: &str, axis: f64| TrackRow {
        label: label.into(),
        is_angle: true,
        lines: vec![
            line("ground truth", 0, move |t| phase(t, axis)),
            line("estimate", 1, move |t| estimated(t, axis)),
        ],
    };
    TrackFigure {
        along: Along::TIME,
        name: "phases".into(),
        title: "Estimated and true wind of the helix at T2".into(),
        caption: "Wind and wind phases in the run bl-helix.".into(),
        rows: vec![
            TrackRow {
                label: "average (m/s)".into(),
                is_angle: false,
                lines: vec![
                    line("ground truth", 0, |t| 7.1 + 0.4 * wander(t, 0.3)),
                    line("estimate", 1, |t| 7.5 + 0.42 * wander(t - 4.0, 0.3)),
                ],
            },
            wind("tilt (m/s)", 0.0, 0.0),
            wind("yaw (m/s)", 1.0, 0.5 * PI),
            angle("phase of tilt (°)", 0.0),
            angle("phase of yaw (°)", 1.0),
        ],
        mark: Some(700.0),
    }
}

/// Wind, pitch and moment of the tilt axis for several offsets.
fn responses() -> TrackFigure {
    let row = |label: &str, of: fn(f64, f64) -> f64| TrackRow {
        label: label.into(),
        is_angle: false,
        lines: CASES
            .iter()
            .map(|&(name, colour, share)| line(name, colour, move |t| of(TAU / PERIOD * t, share)))
            .collect(),
    };
    TrackFigure {
        along: Along::TIME,
        name: "tilt-responses".into(),
        title: "Tilt of wind, pitch and moment at T2".into(),
        caption: "Moments below 0.01 Hz.".into(),
        rows: vec![
            row("wind (m/s)", |angle, _| 0.8 * angle.sin()),
            row("pitch (°)", |angle, share| 4.0 * share * (angle + 2.6).sin()),
            row("moment (MN m)", |angle, share| 6.0 * (1.0 + share) * (angle + 0.2).sin()),
        ],
        mark: None,
    }
}

fn moments() -> SpectrumFigure {
    let lines = CASES.iter().map(|&(name, colour, share)| {
        let value = |index: usize| {
            let ratio = 0.02 * index as f64;
            let peak = 8.0 * (1.0 + 0.6 * share) / (1.0 + ((ratio - 1.0) / 0.025).powi(2));
            peak + 0.5 * (1.0 + wander(300.0 * ratio, share)) * ratio.sqrt().min(1.0)
        };
        let values = (0..400).map(value).collect();
        SpectrumLine { name: name.into(), colour, frequency_step: 0.02 / PERIOD, values }
    });
    SpectrumFigure {
        name: "tilt-moments".into(),
        title: "Tilt moment of T2".into(),
        label: "amplitude (MN m)".into(),
        excitation_frequency: 1.0 / PERIOD,
        lines: lines.collect(),
    }
}

/// Centre of the wake (m) at `x` (m): a helix that grows behind T1 and is helped or held back at T2.
fn centre(x: f64, share: f64) -> f64 {
    let grown = |x: f64| if x > 0.0 { 0.16 * DIAMETER * (x / (5.0 * DIAMETER)) } else { 0.0 };
    let helped = if x > 5.0 * DIAMETER { 1.0 + 0.5 * share } else { 1.0 };
    helped * grown(x).min(0.3 * DIAMETER) * (TAU * x / (0.85 * SPEED * PERIOD)).sin()
}

fn wake() -> SliceFigure {
    let plane = |share: f64| {
        let (n_points, spacing) = ([241, 81], [15.0, 10.0]);
        let mut u = Vec::new();
        for second in 0..n_points[1] {
            for first in 0..n_points[0] {
                let (x, y) = (-360.0 + 15.0 * first as f64, -400.0 + 10.0 * second as f64);
                let width = 100.0 + 0.02 * x.max(0.0);
                let strength = if x < 0.0 {
                    0.0
                } else if x < 1200.0 {
                    5.0 - 0.0018 * x
                } else {
                    5.4 - (0.0012 + 0.0003 * share) * (x - 1200.0)
                };
                u.push(
                    (SPEED - strength * (-0.5 * ((y - centre(x, share)) / width).powi(4)).exp())
                        as f32,
                );
            }
        }
        let zero = vec![0.0; u.len()];
        Plane {
            name: "hub-height".into(),
            axes: PlaneAxes::Horizontal,
            origin: [-360.0, -400.0, 150.0],
            spacing,
            n_points,
            time: 2700.0,
            averaged: 1900.0,
            velocity: [u, zero.clone(), zero],
        }
    };
    let line = |share: f64| -> Vec<[f64; 2]> {
        (0..210).map(|i| 15.0 * f64::from(i)).map(|x| [x, centre(x, share)]).collect()
    };
    let panels = CASES[1..].iter().map(|&(name, colour, share)| SlicePanel {
        title: name.into(),
        colour,
        plane: plane(share),
        centre_line: line(share),
    });
    let lines = CASES.iter().map(|&(name, colour, share)| CentreLine {
        name: name.into(),
        colour,
        points: line(share),
    });
    SliceFigure {
        diameter: DIAMETER,
        free_stream: SPEED,
        rotors: [0.0, 1200.0, 2400.0]
            .into_iter()
            .enumerate()
            .map(|(index, x)| SliceRotor {
                name: format!("T{}", index + 1),
                hub: [x, 0.0, 150.0],
                diameter: DIAMETER,
                yaw: 0.0,
            })
            .collect(),
        planes: panels.collect(),
        centre_lines: lines.collect(),
        phase: "t = 0 Te".into(),
    }
}

fn deficits() -> DeficitFigure {
    let panel = |distance: f64| DeficitPanel {
        title: format!("{distance} D behind T2"),
        lines: CASES
            .iter()
            .map(|&(name, colour, share)| {
                let offsets: Vec<f64> = (-36..=36).map(|i| 10.0 * f64::from(i)).collect();
                let peak = 5.4 - (0.35 + 0.1 * share) * distance;
                let width = 105.0 + 8.0 * distance;
                let deficit = |y: &f64| peak * (-0.5 * (y / width).powi(4)).exp();
                let deficits = offsets.iter().map(deficit).collect();
                DeficitLine { name: name.into(), colour, offsets, deficits }
            })
            .collect(),
    };
    let panels = [1.0, 2.0, 3.0, 4.0, 5.0].map(panel).into();
    DeficitFigure { diameter: DIAMETER, free_stream: SPEED, panels }
}
