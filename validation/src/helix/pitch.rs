//! What a helix does to the blades: nothing without amplitude, one line with it.

use super::{Carried, failure, find, summaries};
use crate::Row;
use crate::row::Tolerance::{AtMost, Within};
use basis::Sense;
use basis::records::Series;
use std::f64::consts::TAU;
use std::fs;

/// Where the expected values come from.
const SOURCE: &str = "the case itself";

/// Strouhal number of the case (–).
const STROUHAL: f64 = 0.25;
/// Amplitude of the case's helices (deg).
const AMPLITUDE: f64 = 3.0;
/// First time that counts (s): the helix is whole.
const FROM: f64 = 200.0;
/// Time, azimuth and pitch of T1's first blade in a series.
const CHANNELS: [&str; 3] = ["Time", "T1.Azimuth", "T1.BldPitch1"];
/// Share of the pitch's variance that may lie beside its line (–).
const BESIDE: f64 = 0.02;

/// `validation/cases/helix-pitch.toml`: bits of a helix without amplitude, lines of one with.
pub fn helix_pitch() -> Vec<Row> {
    let case = Carried::Own(include_str!("../../cases/helix-pitch.toml"));
    let (summaries, folder) = match summaries(case, "helix-pitch", Vec::new()) {
        Ok(done) => done,
        Err(problem) => return failure(problem),
    };
    let study = match formats::records::read_study(&folder) {
        Ok(study) => study,
        Err(error) => return failure(error.to_string()),
    };
    let series = |run: &str| fs::read(folder.join(run).join("series.csv")).unwrap_or_default();
    let (without, none) = (series("baseline"), series("ccw-0"));
    let differ = without.iter().zip(&none).filter(|(a, b)| a != b).count();
    let mut rows = vec![Row {
        what: "bytes of the series of all turbines that a helix of 0° changes".to_owned(),
        // Two files that could not be read differ in nothing.
        measured: if without.is_empty() || without.len() != none.len() {
            f64::NAN
        } else {
            differ as f64
        },
        expected: 0.0,
        tolerance: Within(0.0),
        unit: "–",
        source: SOURCE,
    }];
    for (run, sense, place) in
        [("ccw-3", Sense::CounterClockwise, "1P + f_e"), ("cw-3", Sense::Clockwise, "1P − f_e")]
    {
        let conditions = find(&summaries, run).map(|summary| &summary.conditions);
        let rate = conditions
            .map_or(f64::NAN, |at| TAU * STROUHAL * at.target_wind_speed / at.rotor_diameter);
        let series = study.runs.iter().find(|records| records.summary.run == run);
        let channels = |name: &str| CHANNELS.contains(&name);
        let series = series.and_then(|records| records.series.read(channels).ok());
        let line = series.and_then(|series| line(&series, sense, rate));
        let [amplitude, beside] = line.unwrap_or([f64::NAN; 2]);
        rows.push(Row {
            what: format!("{run}, blade 1: amplitude of the pitch at {place}"),
            measured: amplitude.to_degrees(),
            expected: AMPLITUDE,
            tolerance: Within(0.02 * AMPLITUDE),
            unit: "deg",
            source: SOURCE,
        });
        rows.push(Row {
            what: format!("{run}, blade 1: share of the pitch's variance beside that line"),
            measured: beside,
            expected: BESIDE,
            tolerance: AtMost,
            unit: "–",
            source: SOURCE,
        });
    }
    rows
}

/// Amplitude (rad) of T1's first blade at the line of a helix of `sense` and `rate` (rad/s), which turns with
/// the azimuth, and the share of its pitch's variance that lies beside it (–).
fn line(series: &Series, sense: Sense, rate: f64) -> Option<[f64; 2]> {
    let [times, azimuth, pitch] = CHANNELS.map(|channel| series.column(channel));
    let (times, azimuth, pitch) = (times?, azimuth?, pitch?);
    let first = times.iter().position(|time| *time >= FROM)?;
    let n = (times.len() - first) as f64;
    let mean = pitch[first..].iter().sum::<f64>() / n;
    let turn = sense.yaw_lead().signum();
    let (mut variance, mut with, mut across) = (0.0, 0.0, 0.0);
    for ((time, azimuth), pitch) in times.iter().zip(azimuth).zip(pitch).skip(first) {
        let (sine, cosine) = (azimuth + turn * rate * time).sin_cos();
        let pitch = pitch - mean;
        variance += pitch * pitch / n;
        with += pitch * sine / n;
        across += pitch * cosine / n;
    }
    let amplitude = 2.0 * with.hypot(across);
    Some([amplitude, 1.0 - 0.5 * amplitude * amplitude / variance])
}
