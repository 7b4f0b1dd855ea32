//! Figures of scans and of the hub vortex in them.

use super::{HubVortexAnswer, HubVortexQuestion, HubVortexTrack, Sampled, VortexFilter, follow};
use basis::scan::Scan;
use estimation::hub_vortex::HubVortex;
use report::{
    Along, DiscFigure, DiscPanel, DiscPath, DiscPoint, Signals, TrackFigure, TrackLine, TrackRow,
};
use std::f64::consts::TAU;

/// Looks at a helix cycle (–).
const N_PHASES: usize = 8;
/// Periods of the helix whose path is drawn, at the end of a record (–).
const SHOWN_PERIODS: f64 = 4.0;
/// Places of a path at most (–).
const MOST_PLACES: usize = 1500;

/// The figures of an `answer`: paths in the fixed frame, places over time in both frames.
pub(crate) fn signals(answer: &HubVortexAnswer) -> Signals {
    let place = format!("{}-{}", answer.turbine, answer.lidar);
    let panel = |(colour, track): (usize, &HubVortexTrack)| DiscPanel {
        title: track.filter.name().to_owned(),
        paths: vec![DiscPath {
            name: track.filter.name().to_owned(),
            colour: colour + 1,
            points: path(answer, track),
        }],
        ..DiscPanel::default()
    };
    let paths = DiscFigure {
        name: format!("hub-vortex-path-{place}"),
        title: format!("Path of the hub vortex behind {}", answer.turbine),
        caption: format!(
            "Place after the low-pass filter over the last periods of the helix, looking downwind, {:.2} D along the lines of sight from {}; the cross is the hub.",
            answer.range / answer.diameter,
            answer.lidar
        ),
        radius: 0.5 * answer.diameter,
        is_close: true,
        panels: answer.tracks.iter().enumerate().map(panel).collect(),
    };
    Signals {
        title: format!("Hub vortex behind {}", answer.turbine),
        discs: vec![paths],
        tracks: vec![over_time(answer, &format!("hub-vortex-{place}"))],
        ..Signals::default()
    }
}

/// Places over time: in the fixed frame as found and filtered, and in that of the helix.
fn over_time(answer: &HubVortexAnswer, name: &str) -> TrackFigure {
    type Part = fn(&HubVortex) -> f64;
    let rows: [(&str, Part); 5] = [
        ("y, left (m)", |vortex| vortex.filtered[0]),
        ("z, up (m)", |vortex| vortex.filtered[1]),
        ("tilt, helix frame (m)", |vortex| vortex.helix[0]),
        ("yaw, helix frame (m)", |vortex| vortex.helix[1]),
        ("confidence (–)", |vortex| vortex.confidence),
    ];
    let row = |(label, part): (&str, Part)| {
        let line = |(colour, track): (usize, &HubVortexTrack)| {
            let settled = answer.times.iter().zip(&track.vortices).filter(|(_, v)| v.settled);
            let (times, values) = settled.map(|(time, vortex)| (*time, part(vortex))).unzip();
            let name = track.filter.name().to_owned();
            TrackLine { name, colour: colour + 1, times, values, band: Vec::new() }
        };
        let lines = answer.tracks.iter().enumerate().map(line).collect();
        TrackRow { label: label.to_owned(), is_angle: false, lines }
    };
    TrackFigure {
        along: Along::TIME,
        name: name.to_owned(),
        title: format!("Hub vortex behind {} in {}", answer.turbine, answer.run),
        caption: "Place after the low-pass filter in the fixed frame, from the rotor's centre; its tilt (up) and yaw (to the right) in the frame that turns \
                  with the helix; how sure it is. The published filter is late by its delay, which turns its components."
            .to_owned(),
        rows: rows.into_iter().map(row).collect(),
        mark: Some(answer.from),
    }
}

/// What a lidar saw in one run, as much of it as a report shows.
pub(crate) struct Seen {
    run: String,
    /// The overview of this run alone, without paths.
    overview: DiscFigure,
    /// Path of the hub vortex (m); empty where it cannot be followed.
    path: Vec<[f64; 2]>,
    /// Scans over a cycle of the helix.
    cycle: DiscFigure,
    turbine: String,
}

/// What was `sampled` of the run called `run`, as a report shows it.
pub(crate) fn seen(run: &str, sampled: &Sampled) -> Seen {
    let stored = &sampled.stored;
    let (turbine, lidar) = (&stored.turbine, &stored.sensor);
    // As the controller saw it, where one did.
    let filter = sampled.filter.unwrap_or(VortexFilter::Robust);
    let filters = vec![filter];
    let question = HubVortexQuestion { filters, ..HubVortexQuestion::default() };
    // A record that is too short after its spin-up still has places to mark.
    let early = HubVortexQuestion { from: Some(0.0), ..question.clone() };
    let found = follow(sampled, &question).or_else(|_| follow(sampled, &early)).ok();
    let path = found.as_ref().map_or(Vec::new(), |found| path(found, &found.tracks[0]));
    let pattern = DiscPanel {
        title: format!("Where {lidar} measures"),
        points: points(sampled, sampled.samples.len() - 1, false),
        ..DiscPanel::default()
    };
    let (place, radius) = (format!("{turbine}-{lidar}"), 0.5 * stored.rotor_diameter);
    let overview = DiscFigure {
        name: format!("scan-pattern-{place}"),
        title: format!("The scan of {lidar} on {turbine}, and the hub vortex in it"),
        caption: format!(
            "Looking downwind from the rotor, whose rim is dashed: {} points ({}), {:.2} D along the lines of sight. The hub vortex by the {} filter, over the last periods of the helix.",
            sampled.points.len(),
            stored.pattern,
            sampled.range() / stored.rotor_diameter,
            filter.name()
        ),
        radius,
        is_close: false,
        panels: vec![pattern],
    };
    let cycle = DiscFigure {
        name: format!("scans-{place}-{run}"),
        title: format!("What {lidar} on {turbine} saw, {run}"),
        caption: cycle_caption(sampled, found.as_ref()),
        radius,
        is_close: false,
        panels: cycle(sampled, found.as_ref()),
    };
    Seen { run: run.to_owned(), overview, path, cycle, turbine: turbine.clone() }
}

/// What one lidar saw in the runs of a study: where it measures with the paths of the hub vortex, then its
/// scans, run by run; none without a run.
pub(crate) fn of_runs(runs: Vec<Seen>) -> Option<Signals> {
    let first = runs.first()?;
    let mut overview = first.overview.clone();
    let title = format!("What the lidar of {} saw", first.turbine);
    let followed = runs.iter().enumerate().filter(|(_, seen)| !seen.path.is_empty());
    let path = |(colour, seen): (usize, &Seen)| {
        let (name, points) = (seen.run.clone(), seen.path.clone());
        DiscPath { name, colour, points }
    };
    let paths: Vec<DiscPath> = followed.map(path).collect();
    if !paths.is_empty() {
        let title = "Path of the hub vortex".to_owned();
        overview.panels.push(DiscPanel { title, paths, ..DiscPanel::default() });
    }
    Some(Signals {
        title,
        lead: "Wind speed along the lines of sight, away from the lidar, over the rotor's disc, and the hub vortex, the fast air behind the hub that turns with a helix."
            .to_owned(),
        discs: std::iter::once(overview).chain(runs.into_iter().map(|seen| seen.cycle)).collect(),
        ..Signals::default()
    })
}

fn cycle_caption(sampled: &Sampled, found: Option<&HubVortexAnswer>) -> String {
    let what = match found {
        Some(found) => format!(
            "Speeds along the lines of sight at eight phases of the last whole cycle of the helix ({}, {:.2} mHz), looking downwind; ringed: the hub vortex as the {} filter finds it in that scan.",
            found.frame.sense,
            1e3 * found.frame.rate / TAU,
            found.tracks[0].filter.name()
        ),
        None => "Speeds along the lines of sight in the last scan, looking downwind.".to_owned(),
    };
    let missing = sampled.missing();
    let lost = if missing > 0.0005 {
        format!(" Crosses: points without a speed, {:.1} % of all.", 100.0 * missing)
    } else {
        String::new()
    };
    format!("{what} Dots: where it measured; colours between them are spread.{lost}")
}

/// Scans at eight phases of the last whole cycle of the helix; the last scan alone where there is none.
fn cycle(sampled: &Sampled, found: Option<&HubVortexAnswer>) -> Vec<DiscPanel> {
    let last = sampled.samples.len() - 1;
    let end = sampled.samples[last].0;
    let panel = |title: String, number: usize, found: Option<&HubVortexAnswer>| DiscPanel {
        title,
        points: points(sampled, number, true),
        mark: found
            .map(|found| found.tracks[0].vortices[number])
            .filter(|v| !v.held)
            .map(|v| v.place),
        ..DiscPanel::default()
    };
    let Some(found) = found else { return vec![panel(format!("{end:.1} s"), last, None)] };
    let period = TAU / found.frame.rate;
    // The cycle that ends with phase zero.
    let start = ((end / period).floor() - 1.0) * period;
    if start < found.times[0] {
        return vec![panel(format!("{end:.1} s"), last, Some(found))];
    }
    let at = |phase: usize| {
        let time = start + period * phase as f64 / N_PHASES as f64;
        let after = found.times.partition_point(|other| *other < time).clamp(1, last);
        let is_before = time - found.times[after - 1] < found.times[after] - time;
        let number = if is_before { after - 1 } else { after };
        let title = format!("{}°: {:.1} s", 360 * phase / N_PHASES, found.times[number]);
        panel(title, number, Some(found))
    };
    (0..N_PHASES).map(at).collect()
}

/// The points of sample `number`, with their speeds where `speeds`.
fn points(sampled: &Sampled, number: usize, speeds: bool) -> Vec<DiscPoint> {
    let mut reading = Vec::new();
    sampled.stored.reading(sampled.samples[number].1, sampled.points.clone(), &mut reading);
    let Some(scan) = Scan::of(&reading) else { return Vec::new() };
    let places = scan.left().iter().zip(scan.up()).zip(scan.speeds());
    places
        .map(|((left, up), speed)| DiscPoint {
            place: [*left, *up],
            speed: speeds.then_some(*speed),
        })
        .collect()
}

/// The filtered places of `track` over the last periods of the helix, once they count and are settled, as
/// many as a figure can show.
pub(super) fn path(answer: &HubVortexAnswer, track: &HubVortexTrack) -> Vec<[f64; 2]> {
    let end = answer.times.last().copied().unwrap_or(0.0);
    let start = answer.from.max(end - SHOWN_PERIODS * TAU / answer.frame.rate);
    let shown = answer.times.iter().zip(&track.vortices);
    let shown = shown.filter(|(time, vortex)| **time >= start && vortex.settled);
    let places: Vec<[f64; 2]> = shown.map(|(_, vortex)| vortex.filtered).collect();
    let stride = places.len().div_ceil(MOST_PLACES).max(1);
    places.into_iter().step_by(stride).collect()
}
