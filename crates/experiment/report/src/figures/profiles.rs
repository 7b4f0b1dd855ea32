//! The mean wake in lines: profiles at several distances, and its recovery along the row.

use super::WIDTH;
use crate::draw::axes::{Frame, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::{Figure, Look, Role, Shape, TextStyle, segment, text};
use crate::study::{Study, plane, sample};
use crate::words::{SPACE, number};
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

/// Distances (diameters) at which profiles are drawn: those of the crosswind planes, else every
/// second diameter behind the first turbine.
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
        distances = (1..=MOST).map(|n| 2.0 * n as f64).filter(|n| n * diameter <= end).collect();
    }
    distances.sort_by(f64::total_cmp);
    distances.dedup_by(|a, b| (*a - *b).abs() < 0.05);
    distances.truncate(MOST);
    distances
}

/// Lines of one panel, each with the colour of its run.
type Lines = Vec<(usize, Vec<[f64; 2]>)>;

/// Velocity over the free stream against the place across the wake (diameters), `distance` (diameters) along
/// it.
fn across(study: &Study, planes: &[(usize, &Plane)], distance: f64) -> Lines {
    let (diameter, free_stream) = (study.diameter(), study.free_stream());
    let profile = |plane: &Plane| {
        (-60..=60)
            .filter_map(|index| {
                let y = study.side() + f64::from(index) / 40.0;
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
    let center = study.side();
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
            y: Scale::linear(center - 1.5, center + 1.5),
        };
        let rotor = frame.rectangle([scale.low, center - 0.5], [scale.high, center + 0.5]);
        shapes.push(crate::draw::rectangle(rotor, Look::fill(Ink::Band)));
        frame.rows(6, index == 0, &mut shapes);
        if index == 0 {
            frame.y_label("y/D", 38.0, &mut shapes);
        }
        frame.columns(3, true, &mut shapes);
        let text_distance = number(*distance, 1);
        let text_distance = text_distance.strip_suffix(".0").unwrap_or(&text_distance);
        frame.title(&format!("{text_distance}{SPACE}D"), &mut shapes);
        frame.x_label("u/U∞", &mut shapes);
        let group = drawn(lines, |line, look| crate::draw::polyline(frame.points(line), look));
        shapes.push(Shape::Group { role: Role::Plain, clip: Some(frame.area), shapes: group });
    }
    Some(Figure {
        name: "profiles".to_owned(),
        title: "Velocity profiles behind the first turbine".to_owned(),
        caption:
            "Mean streamwise velocity at hub height across the wake; the grey band is the first \
             turbine's rotor."
                .to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

/// Mean velocity on the row's axis and over a rotor's width, along the wind.
pub(crate) fn centre_line(study: &Study) -> Option<Figure> {
    const HEIGHT: f64 = 210.0;
    let planes = planes(study);
    let diameter = study.diameter();
    let width: Vec<f64> = (0..21).map(|index| (f64::from(index) - 10.0) / 20.0).collect();
    let panels = [("on the axis", vec![0.0]), ("mean over the rotor's width", width)];
    let first = planes.first()?.1;
    let ends =
        [first.origin[0], first.origin[0] + first.spacing[0] * (first.n_points[0] - 1) as f64];
    let mut shapes = Vec::new();
    let top =
        22.0 + legend([58.0, 22.0], WIDTH - 90.0, Role::Run, &study.names(), &mut shapes) + 18.0;
    for (index, (title, sides)) in panels.iter().enumerate() {
        let lines: Lines =
            planes.iter().map(|&(colour, plane)| (colour, along(study, plane, sides))).collect();
        let velocities = lines.iter().flat_map(|line| line.1.iter().map(|point| point[1]));
        let frame = Frame {
            area: [58.0 + 476.0 * index as f64, top, 430.0, HEIGHT],
            x: Scale::linear(ends[0] / diameter, ends[1] / diameter),
            y: Scale::around(velocities, 0.06),
        };
        frame.rows(5, true, &mut shapes);
        frame.columns(8, true, &mut shapes);
        frame.title(title, &mut shapes);
        frame.x_label("x/D", &mut shapes);
        if index == 0 {
            frame.y_label("u/U∞", 42.0, &mut shapes);
        }
        rotors(study, &frame, &mut shapes);
        let group = drawn(&lines, |line, look| frame.line(line, look));
        shapes.push(frame.panel(group, ["D", "U∞"]));
    }
    Some(Figure {
        name: "recovery".to_owned(),
        title: "Recovery along the row".to_owned(),
        caption: "Mean streamwise velocity at hub height along the wind; dashed lines are rotors."
            .to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

/// Velocity over the free stream, mean of the places `sides` (diameters) beside the row, against the place
/// along it.
fn along(study: &Study, plane: &Plane, sides: &[f64]) -> Vec<[f64; 2]> {
    let (diameter, free_stream) = (study.diameter(), study.free_stream());
    let center = study.side() * diameter;
    let stride = plane.n_points[0].div_ceil(400);
    (0..plane.n_points[0])
        .step_by(stride)
        .filter_map(|index| {
            let x = plane.origin[0] + plane.spacing[0] * index as f64;
            let velocities: Option<Vec<f64>> =
                sides.iter().map(|side| sample(plane, x, center + side * diameter)).collect();
            let velocities = velocities?;
            let mean = velocities.iter().sum::<f64>() / velocities.len() as f64;
            Some([x / diameter, mean / free_stream])
        })
        .collect()
}

/// A dashed line with its name for every turbine.
fn rotors(study: &Study, frame: &Frame, shapes: &mut Vec<Shape>) {
    let [_, top, _, height] = frame.area;
    for place in &study.layout {
        let [x, _] = frame.point([place.position[0], frame.y.low]);
        let look = Look::line(Ink::Axis, 1.0).dashed(Some([4.0, 3.0]));
        shapes.push(segment([x, top], [x, top + height], look));
        let setting = TextStyle::plain(Ink::Muted, 11.5);
        shapes.push(text([x + 4.0, top + 12.0], place.name.as_str(), setting));
    }
}
