//! Velocity on planes, run by run, with the rotors drawn in.

use super::sheet::{Panel, Sheet, Window, extent, range, values};
use crate::RunRecords;
use crate::draw::Figure;
use crate::draw::colour::Map;
use crate::study::{Study, is_whole, plane};
use crate::words::{SPACE, number};
use basis::records::{Plane, PlaneAxes};

/// Above so many runs the slices stand in two columns.
const MOST_STACKED: usize = 3;

/// Mean velocity at hub height in each run.
pub(crate) fn mean(study: &Study) -> Option<Figure> {
    let panels = mean_panels(study, "hub-height");
    let caption =
        "Mean streamwise velocity at hub height, seen from above; black lines are rotors.";
    along(study, "mean-hub-height", "Mean wake at hub height", caption, &panels, mean_range(study))
}

/// Velocity at hub height at the last stored instant of each run.
pub(crate) fn instants(study: &Study) -> Option<Figure> {
    let panels = per_run(
        study,
        |run| {
            let planes = run.instant_planes.iter();
            planes
                .filter(|plane| plane.name == "hub-height" && is_whole(plane))
                .max_by(|a, b| a.time.total_cmp(&b.time))
        },
        |plane| format!(", at {}{SPACE}s", number(plane.time, 0)),
    );
    let caption = "Streamwise velocity at hub height at one instant; the inflow is the same in every \
                   run.";
    along(study, "instant-hub-height", "Wake at one instant", caption, &panels, None)
}

/// Mean velocity on the vertical plane through the rotors.
pub(crate) fn streamwise(study: &Study) -> Option<Figure> {
    let panels = mean_panels(study, "streamwise");
    let caption = "Mean streamwise velocity on the vertical plane through the rotors, in the colours \
                   of the hub-height figure; what lies beyond them keeps the last one.";
    along(study, "mean-streamwise", "Mean wake from the side", caption, &panels, mean_range(study))
}

/// What each run changes in the mean velocity of the run that it compares with.
pub(crate) fn difference(study: &Study) -> Option<Figure> {
    let mut panels = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let Some(name) = run.summary.compare_with.as_deref() else { continue };
        let reference = study.runs().iter().find(|other| other.summary.run == name)?;
        let planes =
            (plane(&run.mean_planes, "hub-height"), plane(&reference.mean_planes, "hub-height"));
        let (Some(plane), Some(minus)) = planes else { continue };
        if plane.n_points == minus.n_points && name != run.summary.run {
            let title = format!("{} minus {name}", run.summary.run);
            panels.push(Panel { run, colour, title, plane, minus: Some(minus) });
        }
    }
    let window = window(study, panels.first()?.plane);
    let all = panels.iter().flat_map(|panel| values(study, panel, window));
    let limit = all.map(f64::abs).fold(0.0, f64::max);
    let limit = (20.0 * 0.9 * limit).ceil().max(1.0) / 20.0;
    let sheet = Sheet {
        study,
        window,
        map: Map::Diverging,
        range: [-limit, limit],
        n_columns: if panels.len() > MOST_STACKED { 2 } else { 1 },
        labels: ["x/D", "y/D"],
        bar: "Δu/U∞",
    };
    let caption = "Change of the mean velocity at hub height: red is faster air than in the compared \
                   run, blue slower.";
    Some(sheet.draw("difference-hub-height", "What the excitation changes", caption, &panels))
}

/// Mean velocity on the planes across the wind: a row for each run, a column for each distance.
pub(crate) fn crosswind(study: &Study) -> Option<Figure> {
    const MOST_COLUMNS: usize = 6;
    let across = |run: &'_ RunRecords| -> Vec<usize> {
        let mut found: Vec<usize> = (0..run.mean_planes.len())
            .filter(|&index| {
                let plane = &run.mean_planes[index];
                plane.axes == PlaneAxes::Crosswind && is_whole(plane)
            })
            .collect();
        found.sort_by(|&a, &b| {
            run.mean_planes[a].origin[0].total_cmp(&run.mean_planes[b].origin[0])
        });
        found.truncate(MOST_COLUMNS);
        found
    };
    let n_columns = study.runs().iter().map(|run| across(run).len()).max().unwrap_or(0);
    let mut panels = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let found = across(run);
        if found.len() < n_columns || n_columns == 0 {
            continue;
        }
        for index in found {
            let plane = &run.mean_planes[index];
            let distance = number(plane.origin[0] / study.diameter(), 1);
            let distance = distance.strip_suffix(".0").unwrap_or(&distance);
            let title = format!("{}, {distance}{SPACE}D", run.summary.run);
            panels.push(Panel { run, colour, title, plane, minus: None });
        }
    }
    let (diameter, hub) = (study.diameter(), study.hub_height().unwrap_or(study.diameter()));
    let extent = extent(panels.first()?.plane);
    let center = study.side() * diameter;
    let window = [
        extent[0].max(center - 1.3 * diameter),
        extent[1].min(center + 1.3 * diameter),
        extent[2].max(0.0),
        extent[3].min(hub + 1.2 * diameter),
    ];
    if window[0] >= window[1] || window[2] >= window[3] {
        return None;
    }
    let range = mean_range(study).unwrap_or_else(|| range(study, &panels, window));
    let sheet = Sheet {
        study,
        window,
        map: Map::Sequential,
        range,
        n_columns,
        labels: ["y/D", "z/D"],
        bar: "u/U∞",
    };
    let caption = "Mean streamwise velocity across the wake, looking downwind; the circle is the first \
                   turbine's rotor.";
    Some(sheet.draw("mean-crosswind", "Across the wake", caption, &panels))
}

/// One panel for each run that has the plane.
fn per_run<'a>(
    study: &'a Study<'a>,
    find: impl Fn(&'a RunRecords) -> Option<&'a Plane>,
    remark: impl Fn(&Plane) -> String,
) -> Vec<Panel<'a>> {
    study
        .runs()
        .iter()
        .zip(&study.colours)
        .filter_map(|(run, &colour)| {
            let plane = find(run)?;
            let title = format!("{}{}", run.summary.run, remark(plane));
            Some(Panel { run, colour, title, plane, minus: None })
        })
        .collect()
}

/// One panel for each run that has the averaged plane called `name`.
fn mean_panels<'a>(study: &'a Study<'a>, name: &str) -> Vec<Panel<'a>> {
    per_run(study, |run| plane(&run.mean_planes, name), |_| String::new())
}

/// Ends of the colour bar that all figures of mean velocity share: those of the hub-height planes.
fn mean_range(study: &Study) -> Option<[f64; 2]> {
    let panels = mean_panels(study, "hub-height");
    let window = window(study, panels.first()?.plane);
    Some(range(study, &panels, window))
}

/// A figure of planes that run along the wind.
fn along(
    study: &Study,
    name: &str,
    title: &str,
    caption: &str,
    panels: &[Panel],
    shared_range: Option<[f64; 2]>,
) -> Option<Figure> {
    let first = panels.first()?.plane;
    let window = window(study, first);
    let sheet = Sheet {
        study,
        window,
        map: Map::Sequential,
        range: shared_range.unwrap_or_else(|| range(study, panels, window)),
        n_columns: if panels.len() > MOST_STACKED { 2 } else { 1 },
        labels: ["x/D", if first.axes == PlaneAxes::Horizontal { "y/D" } else { "z/D" }],
        bar: "u/U∞",
    };
    Some(sheet.draw(name, title, caption, panels))
}

/// What to show of a plane along the wind: all of its length, two diameters beside the row.
fn window(study: &Study, plane: &Plane) -> Window {
    let [left, right, low, high] = extent(plane);
    let diameter = study.diameter();
    let (lowest, highest) = if plane.axes == PlaneAxes::Horizontal {
        let sides = study.layout.iter().map(|place| place.position[1]);
        let (least, most) = sides.fold((0.0_f64, 0.0_f64), |(a, b), y| (a.min(y), b.max(y)));
        ((least - 1.75) * diameter, (most + 1.75) * diameter)
    } else {
        (0.0, study.hub_height().unwrap_or(diameter) + 1.5 * diameter)
    };
    let (low_shown, high_shown) = (low.max(lowest), high.min(highest));
    if low_shown < high_shown {
        [left, right, low_shown, high_shown]
    } else {
        [left, right, low, high]
    }
}
