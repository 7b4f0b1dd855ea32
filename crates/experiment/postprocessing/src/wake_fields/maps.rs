//! Maps of fields in planes, in rotor diameters from the hub.

use basis::records::{FieldSetting, Grid};
use report::MapPanel;

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
