//! What turbines pitched in the frame that turns with their helix, and where they saw the hub vortex there,
//! as a part of a report.

use crate::PostprocessingError;
use crate::hub_vortex::{Shown, is_pitch, pitch};
use basis::Channel;
use basis::channels::{HUB_VORTEX_TILT, HUB_VORTEX_YAW, TIME};
use basis::records::{Series, Summary};
use farm::case::Case;
use formats::records::StudyRecords;
use report::{Along, Signals, TrackFigure, TrackLine, TrackRow};

/// Names of the findings that tell where the hub vortex was to be.
const REFERENCES: [&str; 2] = ["reference-tilt", "reference-yaw"];

/// A part for each turbine of `case` that pitched in that frame in a run of `records`.
///
/// # Errors
/// [`PostprocessingError`] for a series that cannot be read.
pub(super) fn of_study(
    case: &Case,
    records: &StudyRecords,
) -> Result<Vec<Signals>, PostprocessingError> {
    let mut parts = Vec::new();
    for turbine in case.turbines.iter().map(|turbine| &turbine.name) {
        let own = |channel: &str| is_pitch(turbine, channel) || is_vortex(turbine, channel);
        let mut read: Vec<(usize, &Summary, Series)> = Vec::new();
        for (colour, run) in records.runs.iter().enumerate() {
            if run.series.names().iter().any(|name| name != &TIME.name && own(name)) {
                read.push((colour, &run.summary, run.series.read(own)?));
            }
        }
        let shown = read.iter().map(|(colour, summary, series)| Shown {
            name: summary.run.clone(),
            colour: *colour,
            series,
        });
        let shown: Vec<Shown> = shown.collect();
        let Some(pitched) = pitch(turbine, &shown, case.time.spin_up) else { continue };
        let seen = seen(turbine, &read, case.time.spin_up, records.runs.len());
        parts.push(Signals {
            title: format!("{turbine} in the frame of its helix"),
            lead: "In the frame that turns with the helix its pitch, and the hub vortex of its wake, are at rest but for what wind, noise and a loop do."
                .to_owned(),
            tracks: [pitched].into_iter().chain(seen).collect(),
            ..Signals::default()
        });
    }
    Ok(parts)
}

fn is_vortex(turbine: &str, channel: &str) -> bool {
    [HUB_VORTEX_TILT, HUB_VORTEX_YAW].iter().any(|own| own.of(turbine).name == channel)
}

/// Where `turbine` saw its hub vortex, with where it was to be; none where it saw none. `n_runs` is the first
/// colour that no run has.
fn seen(
    turbine: &str,
    read: &[(usize, &Summary, Series)],
    from: f64,
    n_runs: usize,
) -> Option<TrackFigure> {
    let row = |label: &str, channel: Channel, reference: &str| {
        let mut lines = Vec::new();
        for (colour, summary, series) in read {
            let (Some(times), Some(values)) =
                (series.column(&TIME.name), series.column(&channel.clone().of(turbine).name))
            else {
                continue;
            };
            let line = |name: String, colour, [times, values]: [Vec<f64>; 2]| TrackLine {
                name,
                colour,
                times,
                values,
                band: Vec::new(),
            };
            lines.push(line(summary.run.clone(), *colour, [times.to_vec(), values.to_vec()]));
            let controls = summary.turbines.iter().filter(|other| other.name == turbine);
            let mut findings = controls.flat_map(|turbine| &turbine.control.findings);
            let wanted = findings.find(|finding| finding.name == reference);
            if let (Some(wanted), Some(end)) = (wanted.and_then(|f| f.value), times.last()) {
                let name = format!("reference of {}", summary.run);
                lines.push(line(name, n_runs + *colour, [vec![from, *end], vec![wanted; 2]]));
            }
        }
        TrackRow { label: label.to_owned(), is_angle: false, lines }
    };
    let rows = vec![
        row("tilt, up (m)", HUB_VORTEX_TILT, REFERENCES[0]),
        row("yaw, right (m)", HUB_VORTEX_YAW, REFERENCES[1]),
    ];
    (!rows[0].lines.is_empty()).then(|| TrackFigure {
        along: Along::TIME,
        name: format!("helix-frame-vortex-{turbine}"),
        title: format!("Hub vortex behind {turbine} in the frame of the helix"),
        caption: "As the controller saw it, by its own filter; zero until it has seen it. Dashed upright: the end of the spin-up."
            .to_owned(),
        rows,
        mark: Some(from),
    })
}
