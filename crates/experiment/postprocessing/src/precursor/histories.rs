//! What the layer as a whole did over time.

use flow::lattice::atmosphere::{layer_depth, mean_stress};
use formats::netcdf::StoredStatistics;
use report::{Along, TrackFigure, TrackLine, TrackRow};

/// Columns over time that are shown.
pub(super) const SERIES: [&str; 5] =
    ["hub_speed", "hub_direction", "friction_velocity", "inversion_height", "geostrophic_speed"];
/// Columns over time and height that the depth of the layer follows from.
pub(super) const PROFILES: [&str; 4] = ["uw", "vw", "uw_unresolved", "vw_unresolved"];
/// Blocks over which stress is averaged (–), at most.
const MOST_BLOCKS: usize = 40;

/// Histories of `statistics`, with a mark at `record_from` (s).
pub(super) fn histories(statistics: &StoredStatistics, record_from: f64) -> TrackFigure {
    let line = |name: &str, colour: usize, times: &[f64], values: Vec<f64>| TrackLine {
        name: name.to_owned(),
        colour,
        times: times.to_vec(),
        values,
        band: Vec::new(),
    };
    let row = |label: &str, lines| TrackRow { label: label.to_owned(), is_angle: false, lines };
    let of = |name: &str| statistics.column(name).to_vec();
    let times = statistics.times.as_slice();
    let (middles, depths) = depths(statistics);
    TrackFigure {
        along: Along::TIME,
        name: "histories".to_owned(),
        title: "Over time".to_owned(),
        caption: "Means over each level. The layer ends where the stress, averaged over blocks of time first, is a twentieth of the ground's, over 0.95. The dashed line is the beginning of the record.".to_owned(),
        rows: vec![
            row("speed (m/s)", vec![
                line("at hub height", 2, times, of("hub_speed")),
                line("geostrophic", 1, times, of("geostrophic_speed")),
            ]),
            row("from (°)", vec![line("at hub height", 2, times, steady(&of("hub_direction")))]),
            row("u* (m/s)", vec![line("friction velocity", 3, times, of("friction_velocity"))]),
            row("height (m)", vec![
                line("layer", 4, &middles, depths),
                line("inversion", 5, times, of("inversion_height")),
            ]),
        ],
        mark: Some(record_from),
    }
}

/// Directions (deg) without jumps of a whole turn.
fn steady(directions: &[f64]) -> Vec<f64> {
    let mut last = directions.first().copied().unwrap_or(0.0);
    let near = |direction: &f64| {
        last += (direction - last + 180.0).rem_euclid(360.0) - 180.0;
        last
    };
    directions.iter().map(near).collect()
}

/// Middles (s) of blocks of time, and the depth of the layer (m) in each.
fn depths(statistics: &StoredStatistics) -> (Vec<f64>, Vec<f64>) {
    let (times, heights) = (&statistics.times, &statistics.heights);
    let columns = PROFILES.map(|name| statistics.column(name));
    let n_each = times.len().div_ceil(MOST_BLOCKS).max(1);
    let starts = (0..times.len()).step_by(n_each);
    starts
        .filter_map(|start| {
            let places = start..(start + n_each).min(times.len());
            let levels = mean_stress(heights, columns, places.clone());
            let middle = 0.5 * (times[places.start] + times[places.end - 1]);
            Some((middle, layer_depth(&levels)?))
        })
        .unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_do_not_jump_through_north() {
        assert_eq!(steady(&[350.0, 358.0, 3.0, 355.0]), [350.0, 358.0, 363.0, 355.0]);
        assert!(steady(&[]).is_empty());
    }
}
