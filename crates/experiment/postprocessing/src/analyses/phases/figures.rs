//! Figures of a wake by phase: samples of the bins, velocity, fluctuations.

use crate::PostprocessingError;
use crate::wake_fields::{Averaged, axes, conditions, panel, velocity_by_phase};
use analysis::phases::Decomposition;
use report::{Along, MapColours, MapFigure, MapPanel, Signals, TrackFigure, TrackLine, TrackRow};

/// The figures of the fields of `found`, whose parts are `parts`.
///
/// # Errors
/// [`PostprocessingError::File`].
pub(super) fn signals(
    found: &Averaged,
    parts: &Decomposition,
) -> Result<Signals, PostprocessingError> {
    let caption = format!("{}; {}.", conditions(&found.setting), found.counts());
    Ok(Signals {
        title: "Phases of the wake".to_owned(),
        maps: vec![velocity_by_phase(found)?, fluctuations(found, parts)],
        tracks: vec![samples(vec![samples_row(found, "all", 1)], &caption)],
        ..Signals::default()
    })
}

/// The figure of instants in bins, with a row for each run, and `of` what they are in its caption.
pub(crate) fn samples(rows: Vec<TrackRow>, of: &str) -> TrackFigure {
    TrackFigure {
        along: Along { label: "bin", unit: "" },
        name: "phases-samples".to_owned(),
        title: "Samples by phase".to_owned(),
        caption: format!("Instants in each bin. {of}"),
        rows,
        mark: None,
    }
}

/// Instants in the bins of `found`, in the row of a run called `name` with this `colour`.
pub(crate) fn samples_row(found: &Averaged, name: &str, colour: usize) -> TrackRow {
    let bins = &found.head.bins;
    let line = TrackLine {
        name: name.to_owned(),
        colour,
        times: (0..bins.len()).map(|index| index as f64).collect(),
        values: bins.iter().map(|bin| bin.n_instants as f64).collect(),
        band: Vec::new(),
    };
    TrackRow { label: "instants".to_owned(), is_angle: false, lines: vec![line] }
}

/// ⟨u'u'⟩: all, periodic, random.
fn fluctuations(found: &Averaged, parts: &Decomposition) -> MapFigure {
    let scale = found.setting.wind_speed.powi(2);
    let over = |values: &[f64]| -> Vec<f64> { values.iter().map(|value| value / scale).collect() };
    let panels =
        [("all", &parts.total[0]), ("periodic", &parts.periodic[0]), ("random", &parts.random[0])];
    let panels: Vec<MapPanel> = panels
        .iter()
        .filter_map(|(title, values)| panel(found.grid(), &found.setting, *title, &over(values)))
        .collect();
    MapFigure {
        colours: MapColours::AboutZero,
        is_to_scale: true,
        has_lines: false,
        name: "phases-stress-uu".to_owned(),
        title: "Fluctuations along the wind".to_owned(),
        caption: format!(
            "⟨u'u'⟩ over the squared free stream. {}; {}.",
            conditions(&found.setting),
            found.samples()
        ),
        along: axes(found.grid()),
        unit: "–".to_owned(),
        panels,
    }
}
