//! Velocity on planes, run by run, with the rotors drawn in.

use super::sheet::{Panel, Sheet, Window, extent, range, values};
use crate::RunRecords;
use crate::draw::Figure;
use crate::draw::colour::Map;
use crate::layout::Rotor;
use crate::study::{Study, is_whole, plane};
use crate::words::{self, SPACE, number};
use basis::records::{Plane, PlaneAxes};

/// Above so many runs the slices stand in two columns.
const MOST_STACKED: usize = 3;

/// Mean velocity at hub height in each run.
pub(crate) fn mean(study: &Study) -> Option<Figure> {
    let panels = mean_panels(study, "hub-height");
    let caption = "Mean streamwise velocity at hub height, seen from above. Black lines are rotors, as long as those \
         are wide and turned as they were on average.";
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

/// Mean velocity on the vertical planes through the rotors.
pub(crate) fn streamwise(study: &Study) -> Option<Figure> {
    let mut panels = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let along = run.mean_planes.iter();
        for plane in along.filter(|plane| plane.axes == PlaneAxes::Streamwise && is_whole(plane)) {
            let through = match study.lanes.len() {
                0 | 1 => String::new(),
                _ => format!(", {}", through(study, run, plane)),
            };
            let title = format!("{}{through}", run.summary.run);
            panels.push(Panel { run, colour, title, plane, minus: None });
        }
    }
    // Runs at the same place stand together, so that they can be compared.
    let first = study.rotors.first().map_or(0.0, |rotor| rotor.hub[1]);
    let place = |panel: &Panel| (panel.plane.origin[1] - first).abs() > 1e-6 * study.diameter();
    panels.sort_by(|a, b| {
        let y = a.plane.origin[1].total_cmp(&b.plane.origin[1]);
        place(a).cmp(&place(b)).then(y)
    });
    let caption = match study.lanes.len() {
        0 | 1 => {
            "Mean streamwise velocity on the vertical plane through the rotors, in the colours of the \
                  hub-height figure; what lies beyond them keeps the last one. Black lines are rotors."
        }
        _ => {
            "Mean streamwise velocity on vertical planes through rotors of the staggered row, in the \
              colours of the hub-height figure; what lies beyond them keeps the last one. Black lines are \
              rotors, as long as what the plane cuts out of them."
        }
    };
    along(study, "mean-streamwise", "Mean wake from the side", caption, &panels, mean_range(study))
}

/// Which rotors of `run` a plane along the wind goes through, in words: "through T1 and T3".
fn through(study: &Study, run: &RunRecords, plane: &Plane) -> String {
    const MOST_NAMED: usize = 4;
    /// Share of a diameter that a rotor is cut in at least for the plane to go through it (–).
    const LEAST_CUT: f64 = 0.95;
    let y = plane.origin[1];
    let is_cut = |rotor: &Rotor| {
        let half = rotor.half_chord(y - rotor.hub[1]).unwrap_or(0.0);
        2.0 * half >= LEAST_CUT * rotor.diameter
    };
    let names: Vec<String> = study.rotors_of(run).filter(is_cut).map(|rotor| rotor.name).collect();
    match names.len() {
        0 => format!("y = {}{SPACE}D", number(y / study.diameter(), 1)),
        n if n > MOST_NAMED => format!("through {} and {} others", names[0], n - 1),
        _ => format!("through {}", words::list(&names)),
    }
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
            let title = format!("{}, {}{SPACE}D", run.summary.run, behind_first(study, plane));
            panels.push(Panel { run, colour, title, plane, minus: None });
        }
    }
    let extent = extent(panels.first()?.plane);
    let window = across_rotors(study, extent);
    if window[0] >= window[1] || window[2] >= window[3] {
        return None;
    }
    let range = mean_range(study).unwrap_or_else(|| range(study, &panels, window));
    // Wide rows want wide panels.
    let shape = (window[1] - window[0]) / (window[3] - window[2]);
    let n_columns = n_columns.min(if shape > 3.0 {
        2
    } else if shape > 1.8 {
        3
    } else {
        MOST_COLUMNS
    });
    let sheet = Sheet {
        study,
        window,
        map: Map::Sequential,
        range,
        n_columns,
        labels: ["y/D", "z/D"],
        bar: "u/U∞",
    };
    let first = study.rotors.first().map_or("the first turbine", |rotor| rotor.name.as_str());
    let caption = format!(
        "Mean streamwise velocity across the wake, looking downwind, at distances from {first}; circles are \
         the rotors upstream."
    );
    Some(sheet.draw("mean-crosswind", "Across the wake", &caption, &panels))
}

/// How far behind the first turbine `plane` lies (diameters), as a reader wants it.
fn behind_first(study: &Study, plane: &Plane) -> String {
    let first = study.rotors.first().map_or(0.0, |rotor| rotor.hub[0]);
    let distance = number((plane.origin[0] - first) / study.diameter(), 1);
    distance.strip_suffix(".0").unwrap_or(&distance).to_owned()
}

/// What to show of planes across the wind of this `extent`: all rotors with some room around them.
fn across_rotors(study: &Study, extent: Window) -> Window {
    let room = 0.8 * study.diameter();
    let (mut low, mut high, mut top) = (f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
    for rotor in &study.rotors {
        let radius = 0.5 * rotor.diameter;
        low = low.min(rotor.hub[1] - radius - room);
        high = high.max(rotor.hub[1] + radius + room);
        top = top.max(rotor.hub[2] + radius + room);
    }
    if low > high {
        return extent;
    }
    [extent[0].max(low), extent[1].min(high), extent[2].max(0.0), extent[3].min(top)]
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

/// What to show of a plane along the wind: all of its length, with room beside and above the rotors.
fn window(study: &Study, plane: &Plane) -> Window {
    let [left, right, low, high] = extent(plane);
    let room = 1.25 * study.diameter();
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    let axis = if plane.axes == PlaneAxes::Horizontal { 1 } else { 2 };
    for rotor in &study.rotors {
        let radius = 0.5 * rotor.diameter;
        lowest = lowest.min(rotor.hub[axis] - radius - room);
        highest = highest.max(rotor.hub[axis] + radius + room);
    }
    if axis == 2 {
        lowest = 0.0;
    }
    let (low_shown, high_shown) = (low.max(lowest), high.min(highest));
    if low_shown < high_shown {
        [left, right, low_shown, high_shown]
    } else {
        [left, right, low, high]
    }
}
