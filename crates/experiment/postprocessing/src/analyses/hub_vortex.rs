//! `hub-vortex`: where a lidar saw the hub vortex of its turbine's wake.

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::hub_vortex::{beside, names, signals};
use crate::{
    HubVortexAnswer, HubVortexQuestion, HubVortexTrack, PostprocessingError, VortexFilter,
    hub_vortex,
};
use basis::channels::{HUB_VORTEX, TIME};
use basis::{Channel, Sense, Unit};
use formats::records::SeriesWriter;
use serde_json::json;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "hub-vortex",
    about: "Where a lidar saw the hub vortex of its turbine's wake, in the fixed frame and in that of the helix, from the scans that a run kept: of one run, or of several beside the first: figures 6, 10 and 12 to 14 of Chen et al. (2026)",
    of: Of::Runs(
        "Folder of a run, such as runs/lidar-identification/probing; further ones stand beside the first",
    ),
    settings: &[
        setting(
            "turbine",
            "NAME",
            Takes::Text,
            "Turbine whose lidar it is; the first that has one when left out",
        ),
        setting(
            "lidar",
            "NAME",
            Takes::Text,
            "Name of the lidar among its sensors; its first when left out",
        ),
        AnalysisSetting {
            name: "filter",
            value: "FILTER",
            takes: Takes::Choice(&[
                ("published", "As in the paper: fast region, delay left in"),
                ("robust", "Weighted, with the filter's delay made good"),
                ("centroid", "In its place the centroid of the wind over the disc"),
            ]),
            about: "How the hub vortex is found; all ways when left out",
        },
        setting(
            "frequency",
            "HZ",
            Takes::Number,
            "Frequency of the helix (Hz); that which the turbine pitched when left out",
        ),
        AnalysisSetting {
            name: "sense",
            value: "SENSE",
            takes: Takes::Choice(&[
                ("ccw", "Blades pitch at rotor plus excitation frequency"),
                ("cw", "Blades pitch at rotor minus excitation frequency"),
            ]),
            about: "Sense of the helix; that which the turbine pitched when left out",
        },
        setting(
            "band",
            "HZ",
            Takes::Number,
            "Upper end of the band: cut-off of the low-pass filter (Hz); 0.05 when left out",
        ),
        setting(
            "interval",
            "S",
            Takes::Number,
            "Time between samples (s); the controller's `vortex_interval`, or the time between scans, when left out",
        ),
        setting(
            "range",
            "D",
            Takes::Number,
            "Which of a pulsed lidar's ranges (rotor diameters), the nearest; that nearest to 1 when left out",
        ),
        setting(
            "from",
            "T",
            Takes::Number,
            "First time that counts (s); the end of the spin-up when left out",
        ),
        setting(
            "csv",
            "FILE",
            Takes::Text,
            "CSV file to write the place over time in the first run into, with the channels of a series, which `wakemix identify` reads",
        ),
        FIGURES,
    ],
    run,
};

const fn setting(
    name: &'static str,
    value: &'static str,
    takes: Takes,
    about: &'static str,
) -> AnalysisSetting {
    AnalysisSetting { name, value, takes, about }
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let filter = request.text("filter");
    let named = |filter_of: &VortexFilter| filter.is_none_or(|name| name == filter_of.name());
    let ask = |run: &PathBuf| {
        hub_vortex(&HubVortexQuestion {
            run: run.clone(),
            turbine: request.text("turbine").map(str::to_owned),
            lidar: request.text("lidar").map(str::to_owned),
            filters: VortexFilter::ALL.into_iter().filter(named).collect(),
            frequency: request.number("frequency"),
            sense: request.text("sense").map(|word| match word {
                "cw" => Sense::Clockwise,
                _ => Sense::CounterClockwise,
            }),
            cut_off: request.number("band"),
            interval: request.number("interval"),
            range: request.number("range"),
            from: request.number("from"),
        })
    };
    let mut answers = request.folders.iter().map(ask).collect::<Result<Vec<_>, _>>()?;
    keep_common(&mut answers, &request.folders)?;
    let mut remarks = Vec::new();
    if let Some(path) = request.text("csv") {
        write_csv(&answers[0], Path::new(path))?;
        remarks.push(format!("written: {path}"));
    }
    if request.text(FIGURES.name).is_some() {
        let figures = match &answers[..] {
            [answer] => signals(answer),
            answers => beside(answers, &request.folders)?,
        };
        remarks.extend(drawn(request, &[figures])?);
    }
    let names = match &answers[..] {
        [answer] => vec![answer.run.clone()],
        _ => names(&request.folders)?,
    };
    let all = answers.iter().zip(&names);
    let text = all.map(|(answer, name)| text(answer, name)).collect::<String>() + CONVENTIONS;
    let mut all = answers.iter().zip(&names).map(|(answer, name)| {
        let mut found = json(answer);
        found["name"] = json!(name);
        found
    });
    let mut first = all.next().unwrap_or_default();
    let others: Vec<serde_json::Value> = all.collect();
    if !others.is_empty() {
        first["beside"] = json!(others);
    }
    Ok(Answer { text, json: first, remarks })
}

/// Keeps the filters that settled in all of the runs in `folders`, which are set beside each other.
fn keep_common(
    answers: &mut [HubVortexAnswer],
    folders: &[PathBuf],
) -> Result<(), PostprocessingError> {
    let settled = |answer: &HubVortexAnswer| -> Vec<VortexFilter> {
        answer.tracks.iter().map(|track| track.filter).collect()
    };
    let each: Vec<_> = answers.iter().map(settled).collect();
    for (answer, folder) in answers.iter_mut().zip(folders) {
        answer.tracks.retain(|track| each.iter().all(|all| all.contains(&track.filter)));
        if answer.tracks.is_empty() {
            return Err(PostprocessingError::Scans {
                path: folder.clone(),
                problem: "holds scans in which no filter settles that settles in those of the other runs too".to_owned(),
                fix: "count from an earlier time with --from, or leave the shortest run out".to_owned(),
            });
        }
    }
    Ok(())
}

/// What stands below the tables.
const CONVENTIONS: &str = "radius: mean distance of the filtered place from its mean, which is left and up of the rotor's centre looking downwind; tilt (up), yaw (to the right): in the frame that turns with the helix; ±: standard deviation over whole periods; blind: scans in which it was not found\n";

/// Filter by filter, of the run called `name`.
fn text(answer: &HubVortexAnswer, name: &str) -> String {
    let HubVortexAnswer { frame, diameter, interval, .. } = answer;
    let mut text = format!(
        "{} on {} in {}: helix {} at {:.2} mHz, seen {:.2} D away, a sample every {interval:.3} s from {} s on; {:.1} % of the points without a speed\n",
        answer.lidar,
        answer.turbine,
        name,
        frame.sense,
        1e3 * frame.rate / TAU,
        answer.range / diameter,
        answer.from,
        100.0 * answer.missing,
    );
    text += &format!(
        "{:<10} {:>14} {:>9} {:>9} {:>14} {:>14} {:>11} {:>7}\n",
        "filter", "radius m", "left m", "up m", "tilt m", "yaw m", "confidence", "blind %"
    );
    for HubVortexTrack { filter, numbers, .. } in &answer.tracks {
        let pair = |mean: f64, deviation: f64| format!("{mean:.2} ± {deviation:.2}");
        let [left, up] = numbers.centre;
        let [tilt, yaw] =
            [0, 1].map(|axis| pair(numbers.helix[axis], numbers.helix_deviation[axis]));
        text += &format!(
            "{:<10} {:>14} {left:>9.2} {up:>9.2} {tilt:>14} {yaw:>14} {:>11.2} {:>7.1}\n",
            filter.name(),
            pair(numbers.radius[0], numbers.radius[1]),
            numbers.confidence,
            100.0 * numbers.blind
        );
    }
    for filter in &answer.unsettled {
        text += &format!(
            "{:<10} has not settled between {} s and the end of the scans: --from an earlier time, or a longer run\n",
            filter.name(),
            answer.from
        );
    }
    text
}

/// The numbers, and the place over time.
fn json(answer: &HubVortexAnswer) -> serde_json::Value {
    let tracks = answer.tracks.iter().map(|HubVortexTrack { filter, vortices, numbers }| {
        let column = |of: &dyn Fn(&estimation::hub_vortex::HubVortex) -> f64| {
            vortices.iter().map(of).collect::<Vec<f64>>()
        };
        json!({
            "filter": filter.name(),
            "n_samples": numbers.n_samples,
            "radius_m": numbers.radius[0],
            "radius_deviation_m": numbers.radius[1],
            "centre_left_m": numbers.centre[0],
            "centre_up_m": numbers.centre[1],
            "tilt_m": numbers.helix[0],
            "yaw_m": numbers.helix[1],
            "tilt_deviation_m": numbers.helix_deviation[0],
            "yaw_deviation_m": numbers.helix_deviation[1],
            "confidence": numbers.confidence,
            "blind": numbers.blind,
            "found_left_m": column(&|vortex| vortex.place[0]),
            "found_up_m": column(&|vortex| vortex.place[1]),
            "filtered_left_m": column(&|vortex| vortex.filtered[0]),
            "filtered_up_m": column(&|vortex| vortex.filtered[1]),
            "tilts_m": column(&|vortex| vortex.helix[0]),
            "yaws_m": column(&|vortex| vortex.helix[1]),
            "confidences": column(&|vortex| vortex.confidence),
            "is_found": vortices.iter().map(|vortex| !vortex.held).collect::<Vec<bool>>(),
            "is_settled": vortices.iter().map(|vortex| vortex.settled).collect::<Vec<bool>>(),
        })
    });
    json!({
        "run": answer.run,
        "turbine": answer.turbine,
        "lidar": answer.lidar,
        "sense": answer.frame.sense.to_string(),
        "frequency_hz": answer.frame.rate / TAU,
        "range_m": answer.range,
        "rotor_diameter_m": answer.diameter,
        "interval_s": answer.interval,
        "given_centre_m": answer.given_centre,
        "from_s": answer.from,
        "missing": answer.missing,
        "times_s": answer.times,
        "filters": tracks.collect::<Vec<_>>(),
        "unsettled": answer.unsettled.iter().map(|filter| filter.name()).collect::<Vec<_>>(),
    })
}

/// Writes the place over time, `published.HubVortexLeft_m` and so on, into a table at `path`.
fn write_csv(answer: &HubVortexAnswer, path: &Path) -> Result<(), PostprocessingError> {
    let found = [("FoundLeft", Unit::Metre), ("FoundUp", Unit::Metre), ("Found", Unit::One)];
    let mut channels = vec![TIME];
    for track in &answer.tracks {
        let own = HUB_VORTEX.into_iter().chain(found.map(|(name, unit)| Channel::new(name, unit)));
        channels.extend(own.map(|channel| channel.of(track.filter.name())));
    }
    let mut writer = SeriesWriter::create(path, &channels)?;
    let mut row = Vec::with_capacity(channels.len());
    for (index, time) in answer.times.iter().enumerate() {
        row.clear();
        row.push(*time);
        for track in &answer.tracks {
            let vortex = &track.vortices[index];
            let [[left, up], [tilt, yaw]] = [vortex.filtered, vortex.helix];
            row.extend([left, up, tilt, yaw, vortex.confidence]);
            row.extend([vortex.place[0], vortex.place[1], f64::from(u8::from(!vortex.held))]);
        }
        writer.write(&row)?;
    }
    Ok(writer.finish()?)
}
