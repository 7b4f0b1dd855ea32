//! Maps of fields in planes, in rotor diameters from the hub.

use super::shown::shown;
use super::{Averaged, conditions};
use crate::PostprocessingError;
use analysis::grids::widened;
use basis::records::{FieldSetting, Grid, Moments};
use report::{MapColours, MapFigure, MapPanel};

const AXES: [&str; 3] = ["x", "y", "z"];

/// A map of `values` over the axes that `grid` spans, in diameters of `setting` from its hub; none of a grid
/// that spans no plane. Holes are shown as zero.
pub(crate) fn panel(
    grid: &Grid,
    setting: &FieldSetting,
    title: impl Into<String>,
    values: &[f64],
) -> Option<MapPanel> {
    let [first, second]: [usize; 2] = grid.spanned().try_into().ok()?;
    let along = |axis: usize| {
        let place = |step| (grid.coordinate(axis, step) - setting.hub[axis]) / setting.diameter;
        (0..grid.n_points[axis]).map(place).collect()
    };
    let shown = values.iter().map(|value| if value.is_finite() { *value } else { 0.0 });
    Some(MapPanel {
        title: title.into(),
        places: [along(first), along(second)],
        values: shown.collect(),
        ..MapPanel::default()
    })
}

/// Labels of the axes of the plane that `grid` spans.
pub(crate) fn axes(grid: &Grid) -> [String; 2] {
    let spanned = grid.spanned();
    [0, 1].map(|place| format!("{}/D", AXES[spanned.get(place).copied().unwrap_or(place)]))
}

/// Mean velocity along the wind of `averaged`, and that at some phases, in the plane of `grid`; `downwind`
/// gives it there (m/s), `marks` what is marked in a bin (diameters from the hub).
///
/// # Errors
/// [`PostprocessingError::File`].
pub(crate) fn by_phase(
    averaged: &Averaged,
    grid: &Grid,
    downwind: impl Fn(&Moments) -> Vec<f64>,
    marks: impl Fn(usize) -> Vec<[f64; 2]>,
) -> Result<MapFigure, PostprocessingError> {
    let setting = &averaged.setting;
    let map = |title: String, moments: &Moments, points: Vec<[f64; 2]>| {
        let over: Vec<f64> = downwind(moments).iter().map(|u| u / setting.wind_speed).collect();
        Some(MapPanel { points, ..panel(grid, setting, title, &over)? })
    };
    let mut panels = Vec::from_iter(map("mean".to_owned(), &averaged.head.all, Vec::new()));
    for index in shown(&averaged.head).into_iter().filter(|index| averaged.has_bin(*index)) {
        let n = averaged.head.bins[index].n_instants;
        let title = format!("{}, n = {n}", averaged.name_of_bin(index));
        panels.extend(map(title, &averaged.bin(index)?, marks(index)));
    }
    Ok(MapFigure {
        name: "phases-velocity".to_owned(),
        title: "Velocity along the wind by phase".to_owned(),
        caption: format!(
            "u over the free stream: mean over all instants, and means of bins of n instants. {}; {}.",
            conditions(setting),
            averaged.samples()
        ),
        along: axes(grid),
        unit: "U".to_owned(),
        colours: MapColours::FromLeast,
        is_to_scale: true,
        has_lines: false,
        panels,
    })
}

/// The same of all points, nothing marked.
///
/// # Errors
/// [`PostprocessingError::File`].
pub(crate) fn velocity_by_phase(averaged: &Averaged) -> Result<MapFigure, PostprocessingError> {
    by_phase(averaged, averaged.grid(), |moments| widened(&moments.mean[0]), |_| Vec::new())
}
