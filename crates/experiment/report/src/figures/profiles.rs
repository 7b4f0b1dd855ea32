//! The mean wake in lines: profiles at several distances, and its recovery along the row.

use super::{WIDTH, rotors};
use crate::draw::axes::{Frame, Readout, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::{Axis, Figure, Look, Role, Shape, TextStyle, rectangle, text};
use crate::layout::Lane;
use crate::study::{Study, plane, sample};
use crate::words::{self, SPACE, number};
use basis::records::{Plane, PlaneAxes};

/// Mean hub-height planes with the colours of their runs.
fn planes<'a>(study: &'a Study) -> Vec<(usize, &'a Plane)> {
    study
        .runs()
        .iter()
        .zip(&study.colours)
        .filter_map(|(run, &colour)| Some((colour, plane(&run.mean_planes, "hub-height")?)))
        .collect()
}

/// Places (diameters) along the wind at which profiles are drawn: those of the crosswind planes, else as many
/// over the length of the plane, every second diameter where that is enough.
fn distances(study: &Study, plane: &Plane) -> Vec<f64> {
    const MOST: usize = 7;
    let diameter = study.diameter();
    let end = plane.origin[0] + plane.spacing[0] * (plane.n_points[0] - 1) as f64;
    let mut distances: Vec<f64> = study.runs()[0]
        .mean_planes
        .iter()
        .filter(|plane| plane.axes == PlaneAxes::Crosswind)
        .map(|plane| plane.origin[0] / diameter)
        .filter(|distance| *distance > 0.0 && distance * diameter <= end)
        .collect();
    if distances.is_empty() {
        let step = (0.5 * end / diameter / MOST as f64).ceil().max(1.0) * 2.0;
        let places = (1..=MOST).map(|n| step * n as f64);
        distances = places.filter(|place| place * diameter <= end).collect();
    }
    distances.sort_by(f64::total_cmp);
    distances.dedup_by(|a, b| (*a - *b).abs() < 0.05);
    distances.truncate(MOST);
    distances
}

/// What is shown across the wind (diameters): all rotors with a diameter beside them.
fn sides(study: &Study) -> [f64; 2] {
    let diameter = study.diameter();
    let ends = study.rotors.iter().flat_map(|rotor| {
        [-0.5, 0.5].map(|side| (rotor.hub[1] + side * rotor.diameter) / diameter + 2.0 * side)
    });
    let (low, high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    if low < high { [low, high] } else { [-1.5, 1.5] }
}

/// Lines of one panel, each with the colour of its run.
type Lines = Vec<(usize, Vec<[f64; 2]>)>;

/// Velocity over the free stream against the place across the wake (diameters), `distance` (diameters) along
/// it.
fn across(study: &Study, planes: &[(usize, &Plane)], distance: f64) -> Lines {
    let (diameter, free_stream) = (study.diameter(), study.free_stream());
    let [low, high] = sides(study);
    let n_steps = ((40.0 * (high - low)).ceil() as u32).clamp(1, 400);
    let profile = |plane: &Plane| {
        (0..=n_steps)
            .filter_map(|index| {
                let y = low + (high - low) * f64::from(index) / f64::from(n_steps);
                let velocity = sample(plane, distance * diameter, y * diameter)?;
                Some([velocity / free_stream, y])
            })
            .collect()
    };
    planes.iter().map(|&(colour, plane)| (colour, profile(plane))).collect()
}

/// Each line of `lines` as its run is drawn, with `draw` making a shape of its points.
fn drawn(lines: &Lines, draw: impl Fn(&[[f64; 2]], Look) -> Shape) -> Vec<Shape> {
    let run = |(colour, line): &(usize, Vec<[f64; 2]>)| {
        let look = Look::line(Ink::Run(*colour), 2.0).dashed(run_dash(*colour));
        Shape::Group { role: Role::Run(*colour), clip: None, shapes: vec![draw(line, look)] }
    };
    lines.iter().map(run).collect()
}

/// Mean velocity over the width of the wake at several distances, runs overlaid.
pub(crate) fn profiles(study: &Study) -> Option<Figure> {
    const HEIGHT: f64 = 250.0;
    let planes = planes(study);
    let distances = distances(study, planes.first()?.1);
    let [low, high] = sides(study);
    let lines: Vec<Lines> =
        distances.iter().map(|distance| across(study, &planes, *distance)).collect();
    let values = || lines.iter().flatten().flat_map(|line| &line.1);
    values().next()?;
    let mut shapes = Vec::new();
    let top =
        22.0 + legend([58.0, 22.0], WIDTH - 90.0, Role::Run, &study.names(), &mut shapes) + 18.0;
    let gap = 16.0;
    let n_panels = distances.len() as f64;
    let width = ((WIDTH - 58.0 - 24.0 - gap * (n_panels - 1.0)) / n_panels).min(220.0);
    let scale = Scale::around(values().map(|value| value[0]), 0.05);
    for (index, (distance, lines)) in distances.iter().zip(&lines).enumerate() {
        let frame = Frame {
            area: [58.0 + (width + gap) * index as f64, top, width, HEIGHT],
            x: scale,
            y: Scale::linear(low, high),
        };
        shapes.push(frame.behind(bands(study, *distance, &frame)));
        frame.rows(6, index == 0, &mut shapes);
        if index == 0 {
            frame.y_label("y/D", 38.0, &mut shapes);
        }
        frame.columns(3, true, &mut shapes);
        let text_distance = number(*distance, 1);
        let text_distance = text_distance.strip_suffix(".0").unwrap_or(&text_distance);
        frame.title(&format!("{text_distance}{SPACE}D"), &mut shapes);
        frame.x_label("u/U∞", &mut shapes);
        let group = drawn(lines, |line, look| frame.line(line, look));
        let readout = frame.readout(["U∞", "D"]);
        shapes.push(Readout { along: Axis::Y, ..readout }.group(0.0, group));
    }
    Some(Figure {
        name: "profiles".to_owned(),
        title: "Velocity profiles across the wake".to_owned(),
        caption:
            "Mean streamwise velocity at hub height across the wake; grey bands are the rotors \
                  upstream."
                .to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

/// Bands as wide as the rotors upstream of `distance` (diameters), named where they stand beside one another.
fn bands(study: &Study, distance: f64, frame: &Frame) -> Vec<Shape> {
    let diameter = study.diameter();
    let (mut shapes, mut names) = (Vec::new(), Vec::new());
    for lane in &study.lanes {
        let all = lane.rotors.iter().map(|&index| &study.rotors[index]);
        let upstream = all.filter(|rotor| rotor.hub[0] / diameter < distance);
        let widest = upstream.max_by(|a, b| a.diameter.total_cmp(&b.diameter));
        let Some(rotor) = widest else { continue };
        let ends = [-0.5, 0.5].map(|side| (rotor.hub[1] + side * rotor.diameter) / diameter);
        let area = frame.rectangle([frame.x.low, ends[0]], [frame.x.high, ends[1]]);
        shapes.push(rectangle(area, Look::fill(Ink::Band)));
        let [left, top, _, height] = area;
        let place = [left + 4.0, top + 0.5 * height + 4.0];
        names.push(text(place, rotor.name.as_str(), TextStyle::plain(Ink::Muted, 10.5)));
    }
    if study.lanes.len() > 1 {
        shapes.extend(names);
    }
    shapes
}

/// Mean velocity on the axis and over the rotor's width, along the wind, for each line of rotors.
pub(crate) fn centre_line(study: &Study) -> Option<Figure> {
    const HEIGHT: f64 = 210.0;
    /// Lines of rotors that are shown at most (–).
    const MOST: usize = 4;
    let planes = planes(study);
    let first = planes.first()?.1;
    let diameter = study.diameter();
    let end = first.origin[0] + first.spacing[0] * (first.n_points[0] - 1) as f64;
    let ends = [first.origin[0] / diameter, end / diameter];
    let mut shapes = Vec::new();
    let mut top =
        22.0 + legend([58.0, 22.0], WIDTH - 90.0, Role::Run, &study.names(), &mut shapes) + 18.0;
    let n_shown = study.lanes.len().min(MOST);
    for (index, lane) in study.lanes.iter().take(MOST).enumerate() {
        let is_last = index + 1 == n_shown;
        for (column, panel) in panels(study, lane).into_iter().enumerate() {
            let area = [58.0 + 476.0 * column as f64, top, 430.0, HEIGHT];
            recovery(study, &planes, lane, panel, (area, ends, is_last), &mut shapes);
        }
        top += HEIGHT + if is_last { 50.0 } else { 56.0 };
    }
    if n_shown == 0 {
        return None;
    }
    let beyond = match study.lanes.len() {
        n if n > MOST => format!(" The first {MOST} of {n} lines of rotors are shown."),
        _ => String::new(),
    };
    Some(Figure {
        name: "recovery".to_owned(),
        title: "Recovery along the row".to_owned(),
        caption: format!(
            "Mean streamwise velocity at hub height along the wind; dashed lines are rotors.{beyond}"
        ),
        width: WIDTH,
        height: top,
        shapes,
    })
}

/// A panel of recoveries: its title, and the places beside the lane (m) over which it takes the mean.
type Along = (String, Vec<f64>);

/// The two panels of `lane`.
fn panels(study: &Study, lane: &Lane) -> [Along; 2] {
    const MOST_NAMED: usize = 4;
    let mut names = study.names_in(lane);
    if names.len() > MOST_NAMED {
        names = vec![names[0].clone(), format!("{} others", names.len() - 1)];
    }
    let lead = match study.lanes.len() {
        1 => String::new(),
        _ => format!("through {}: ", words::list(&names)),
    };
    let widest = lane.rotors.iter().map(|&index| study.rotors[index].diameter).fold(0.0, f64::max);
    let width = (0..21).map(|index| widest * (f64::from(index) - 10.0) / 20.0).collect();
    [
        (format!("{lead}on the axis"), vec![0.0]),
        (format!("{lead}mean over the rotor's width"), width),
    ]
}

/// One panel of recoveries at `area`, over the `ends` along the wind (diameters), labelled below where it is
/// in the last row.
fn recovery(
    study: &Study,
    planes: &[(usize, &Plane)],
    lane: &Lane,
    (title, sides): Along,
    (area, ends, is_last): ([f64; 4], [f64; 2], bool),
    shapes: &mut Vec<Shape>,
) {
    let lines: Lines = planes
        .iter()
        .map(|&(colour, plane)| (colour, along(study, plane, lane.y, &sides)))
        .collect();
    let velocities = lines.iter().flat_map(|line| line.1.iter().map(|point| point[1]));
    let y = Scale::around(velocities, 0.06);
    let frame = Frame { area, x: Scale::linear(ends[0], ends[1]), y };
    frame.rows(5, true, shapes);
    frame.columns(8, true, shapes);
    frame.title(&title, shapes);
    if is_last {
        frame.x_label("x/D", shapes);
    }
    if sides.len() == 1 {
        frame.y_label("u/U∞", 42.0, shapes);
    }
    let group = drawn(&lines, |line, look| frame.line(line, look));
    let mut inner = Vec::new();
    let there = lane.rotors.iter().map(|&index| &study.rotors[index]);
    rotors::along(there, &frame, study.diameter(), &mut inner);
    inner.extend(group);
    shapes.push(Readout { both: false, ..frame.readout(["D", "U∞"]) }.group(0.0, inner));
}

/// Velocity over the free stream, mean of the places `sides` (m) beside `center` (m), against the place
/// along the wind (diameters).
fn along(study: &Study, plane: &Plane, center: f64, sides: &[f64]) -> Vec<[f64; 2]> {
    let (diameter, free_stream) = (study.diameter(), study.free_stream());
    let stride = plane.n_points[0].div_ceil(400);
    (0..plane.n_points[0])
        .step_by(stride)
        .filter_map(|index| {
            let x = plane.origin[0] + plane.spacing[0] * index as f64;
            let velocities: Option<Vec<f64>> =
                sides.iter().map(|side| sample(plane, x, center + side)).collect();
            let velocities = velocities?;
            let mean = velocities.iter().sum::<f64>() / velocities.len() as f64;
            Some([x / diameter, mean / free_stream])
        })
        .collect()
}
