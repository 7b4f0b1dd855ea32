//! Runs beside each other: paths of their hub vortices, and what was pitched, as Figs. 10 and 12 to 14 of
//! Chen, van Vondelen, van Wingerden (2026) have them.

use super::HubVortexAnswer;
use super::figures::path;
use crate::PostprocessingError;
use crate::changes::names_of_runs;
use crate::phase::query::folder_of;
use basis::Channel;
use basis::channels::{HELIX_FRAME, TIME};
use basis::records::{Series, Summary};
use formats::records::{read_series, read_summary};
use report::{Along, DiscFigure, DiscPanel, DiscPath, Signals, TrackFigure, TrackLine, TrackRow};
use std::path::{Path, PathBuf};

/// One of several runs, as figures show it.
pub(crate) struct Shown<'a> {
    /// Name that tells it from the others.
    pub(crate) name: String,
    /// Its colour: 0 is that of the run which others stand beside.
    pub(crate) colour: usize,
    /// Its channels over time.
    pub(crate) series: &'a Series,
}

/// Tilt and yaw of `turbine` over time in the frame of the helix, run by run; none where no run tells of it.
pub(crate) fn pitch(turbine: &str, runs: &[Shown], mark: f64) -> Option<TrackFigure> {
    let [tilt, yaw] = HELIX_FRAME;
    let part = |shown: &Shown, of: &dyn Fn([f64; 2]) -> f64| -> Option<TrackLine> {
        let column = |channel: &Channel| shown.series.column(&channel.of(turbine).name);
        let (times, tilts, yaws) =
            (shown.series.column(&TIME.name)?, column(&tilt)?, column(&yaw)?);
        let pairs = tilts.iter().zip(yaws);
        Some(TrackLine {
            name: shown.name.clone(),
            colour: shown.colour,
            times: times.to_vec(),
            values: pairs.map(|(tilt, yaw)| of([*tilt, *yaw]).to_degrees()).collect(),
            band: Vec::new(),
        })
    };
    let row = |label: &str, of: &dyn Fn([f64; 2]) -> f64| TrackRow {
        label: label.to_owned(),
        is_angle: false,
        lines: runs.iter().filter_map(|shown| part(shown, of)).collect(),
    };
    let rows = vec![
        row("tilt (°)", &|[tilt, _]| tilt),
        row("yaw (°)", &|[_, yaw]| yaw),
        row("magnitude (°)", &|[tilt, yaw]| tilt.hypot(yaw)),
    ];
    (!rows[0].lines.is_empty()).then(|| TrackFigure {
        along: Along::TIME,
        name: format!("helix-frame-pitch-{turbine}"),
        title: format!("Pitch of {turbine} in the frame that turns with the helix"),
        caption:
            "Tilt and yaw that are commanded before the azimuth offset, and their magnitude; an open helix is at rest here. Dashed: from here on it counts."
                .to_owned(),
        rows,
        mark: Some(mark),
    })
}

/// Series of runs as far as [`pitch`] of `turbine` draws them.
pub(crate) fn is_pitch(turbine: &str, channel: &str) -> bool {
    channel == TIME.name || HELIX_FRAME.iter().any(|own| own.of(turbine).name == channel)
}

/// Names that tell the runs in `folders` from each other.
///
/// # Errors
/// [`PostprocessingError::File`] for a summary that cannot be read.
pub(crate) fn names(folders: &[PathBuf]) -> Result<Vec<String>, PostprocessingError> {
    let mut summaries: Vec<(&Path, Summary)> = Vec::with_capacity(folders.len());
    for folder in folders {
        summaries.push((folder, read_summary(&folder_of(folder))?));
    }
    Ok(names_of_runs(&summaries))
}

/// The figures of `answers`, which `folders` hold: the path of the first run with that of each other one, the
/// vortex in the frame of the helix, and what was pitched there.
///
/// # Errors
/// [`PostprocessingError::File`] for records that cannot be read.
pub(crate) fn beside(
    answers: &[HubVortexAnswer],
    folders: &[PathBuf],
) -> Result<Signals, PostprocessingError> {
    let names = names(folders)?;
    let first = &answers[0];
    let mut series = Vec::with_capacity(folders.len());
    for (folder, answer) in folders.iter().zip(answers) {
        let path = folder_of(folder).series_path();
        series.push(read_series(&path, |channel| is_pitch(&answer.turbine, channel))?);
    }
    let shown = names.iter().zip(&series).enumerate();
    let shown: Vec<Shown> = shown
        .map(|(colour, (name, series))| Shown { name: name.clone(), colour, series })
        .collect();
    let mut tracks = vec![in_frame(answers, &names)];
    tracks.extend(pitch(&first.turbine, &shown, first.from));
    Ok(Signals {
        title: format!("Hub vortices behind {}", first.turbine),
        discs: vec![paths(answers, &names)],
        tracks,
        ..Signals::default()
    })
}

/// A panel for each run but the first, whose path is in all of them.
fn paths(answers: &[HubVortexAnswer], names: &[String]) -> DiscFigure {
    let one = |place: usize| {
        let points = answers[place].tracks.last().map(|track| path(&answers[place], track));
        DiscPath { name: names[place].clone(), colour: place, points: points.unwrap_or_default() }
    };
    let panel = |place: usize| DiscPanel {
        title: names[place].clone(),
        paths: vec![one(0), one(place)],
        ..DiscPanel::default()
    };
    let first = &answers[0];
    DiscFigure {
        name: format!("hub-vortex-paths-{}-{}", first.turbine, first.lidar),
        title: format!("Paths of the hub vortex behind {}", first.turbine),
        caption: format!(
            "Place by the {} filter over the last periods of the helix, looking downwind, {:.2} D along the lines of sight; in every panel that of {} beside it; the cross is the hub.",
            filter(first),
            first.range / first.diameter,
            names[0]
        ),
        radius: 0.5 * first.diameter,
        is_close: true,
        panels: (1..answers.len()).map(panel).collect(),
    }
}

/// The filter whose track is drawn.
fn filter(answer: &HubVortexAnswer) -> &'static str {
    answer.tracks.last().map_or("", |track| track.filter.name())
}

/// Tilt and yaw of the hub vortices over time in the frame of the helix.
fn in_frame(answers: &[HubVortexAnswer], names: &[String]) -> TrackFigure {
    let row = |label: &str, axis: usize| {
        let line = |(colour, (answer, name)): (usize, (&HubVortexAnswer, &String))| {
            let vortices = answer.tracks.last()?.vortices.iter();
            let settled = answer.times.iter().zip(vortices).filter(|(_, v)| v.settled);
            let (times, values) = settled.map(|(time, v)| (*time, v.helix[axis])).unzip();
            Some(TrackLine { name: name.clone(), colour, times, values, band: Vec::new() })
        };
        let lines = answers.iter().zip(names).enumerate().filter_map(line).collect();
        TrackRow { label: label.to_owned(), is_angle: false, lines }
    };
    let first = &answers[0];
    TrackFigure {
        along: Along::TIME,
        name: format!("hub-vortices-{}-{}", first.turbine, first.lidar),
        title: format!("Hub vortices behind {} in the frame of the helix", first.turbine),
        caption: format!(
            "Tilt (up) and yaw (to the right) by the {} filter, in the frame that turns with the helix. Dashed: from here on it counts.",
            filter(first)
        ),
        rows: vec![row("tilt (m)", 0), row("yaw (m)", 1)],
        mark: Some(first.from),
    }
}
