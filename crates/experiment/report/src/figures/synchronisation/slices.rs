//! The wake from above at one phase of the excitation: deficits of single cases, centre lines of all.

use super::marks::{case_line, free_stream, named, names};
use super::{SliceFigure, SlicePanel, SliceRotor};
use crate::draw::axes::{FieldValues, Frame, MEDIUM, Readout, Scale, legend};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Role, Shape, TextStyle, polyline, text};
use crate::figures::sheet::{colour_bar, stretched};
use crate::figures::{WIDTH, rotors};
use crate::layout::Rotor;
use crate::study::sample;

const LEFT: f64 = 62.0;
const RIGHT: f64 = 84.0;
/// Height of the panel with the centre lines.
const LINES: f64 = 210.0;
/// What is shown of a plane beside the rotors (diameters).
const BESIDE: f64 = 1.0;

/// A field for each panel, then all centre lines.
pub(super) fn slices(figure: &SliceFigure) -> Option<Figure> {
    let diameter = figure.diameter;
    let ends = extent(figure)?;
    let width = WIDTH - LEFT - RIGHT;
    let scale = Scale::linear(ends[0] / diameter, ends[1] / diameter);
    let sides = sides(figure);
    let true_height = width * (sides[1] - sides[0]) * diameter / (ends[1] - ends[0]);
    let height = true_height.clamp(84.0, 460.0);
    let across = Scale::linear(sides[0], sides[1]);
    let range = range(figure);
    let mut shapes = Vec::new();
    let mut top = 34.0;
    for (index, panel) in figure.planes.iter().enumerate() {
        let frame = Frame { area: [LEFT, top, width, height], x: scale, y: across };
        field(figure, panel, range, &frame, &mut shapes);
        frame.columns(12, index + 1 == figure.planes.len(), &mut shapes);
        frame.heights(4, &mut shapes);
        frame.y_label("y/D", 40.0, &mut shapes);
        top += height + 40.0;
    }
    if !figure.planes.is_empty() {
        let bar = [WIDTH - RIGHT + 22.0, 34.0, 14.0, height];
        colour_bar(bar, range, Map::Sequential, 5, "u/U∞", &mut shapes);
    }
    if figure.centre_lines.iter().any(|line| !line.points.is_empty()) {
        let named = figure.centre_lines.iter().map(|line| (line.colour, line.name.as_str()));
        top +=
            4.0 + legend([LEFT, top], WIDTH - 100.0, |_| Role::Plain, &names(named), &mut shapes);
        centres(figure, [LEFT, top, width, LINES], scale, &mut shapes);
        top += LINES + 40.0;
    }
    let setting = TextStyle::plain(Ink::Muted, MEDIUM).anchored(0.5);
    shapes.push(text([LEFT + 0.5 * width, top - 2.0], "x/D", setting));
    Some(Figure {
        name: "phase-averaged-wake".to_owned(),
        title: format!("The wake by phase of the excitation, {}", figure.phase),
        caption: format!(
            "Streamwise velocity at hub height averaged at one phase, seen from above, with the wake's centre; below, the \
             centres of all cases on a stretched scale.{} {}.",
            stretched(height / true_height),
            free_stream(figure.free_stream)
        ),
        width: WIDTH,
        height: top + 10.0,
        shapes,
    })
}

/// The wake's centre along `x` in all cases, drawn in `area`.
fn centres(figure: &SliceFigure, area: [f64; 4], x: Scale, shapes: &mut Vec<Shape>) {
    let diameter = figure.diameter;
    let lines: Vec<Vec<[f64; 2]>> = figure
        .centre_lines
        .iter()
        .map(|line| line.points.iter().map(|p| [p[0] / diameter, p[1] / diameter]).collect())
        .collect();
    let y = Scale::around(lines.iter().flatten().map(|point| point[1]), 0.1);
    let frame = Frame { area, x, y };
    frame.rows(5, true, shapes);
    frame.columns(12, true, shapes);
    frame.y_label("y/D of the centre", 46.0, shapes);
    let mut inner = Vec::new();
    rotors::along(there(figure).iter(), &frame, diameter, &mut inner);
    for (line, points) in figure.centre_lines.iter().zip(&lines) {
        inner.push(named(&line.name, vec![frame.line(points, case_line(line.colour, 2.0))]));
    }
    shapes.push(frame.panel(inner, ["D", "D"]));
}

/// Lowest and highest x (m) of everything that is drawn.
fn extent(figure: &SliceFigure) -> Option<[f64; 2]> {
    let planes = figure.planes.iter().flat_map(|panel| {
        let plane = &panel.plane;
        let length = plane.spacing[0] * plane.n_points[0].saturating_sub(1) as f64;
        [plane.origin[0], plane.origin[0] + length]
    });
    let lines = figure.centre_lines.iter().flat_map(|line| line.points.iter().map(|p| p[0]));
    let (low, high) = planes
        .chain(lines)
        .filter(|x| x.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    (low < high).then_some([low, high])
}

/// Ends of the colours: round, without the outermost hundredths.
fn range(figure: &SliceFigure) -> [f64; 2] {
    let mut values: Vec<f64> = figure
        .planes
        .iter()
        .flat_map(|panel| panel.plane.velocity[0].iter().step_by(7))
        .map(|u| f64::from(*u) / figure.free_stream)
        .filter(|value| value.is_finite())
        .collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values.get((share * values.len() as f64) as usize).copied();
    let low = (10.0 * at(0.005).unwrap_or(0.0)).floor() / 10.0;
    let high = (10.0 * at(0.995).unwrap_or(1.0)).ceil() / 10.0;
    [low, high.max(low + 0.1)]
}

fn field(
    figure: &SliceFigure,
    panel: &SlicePanel,
    range: [f64; 2],
    frame: &Frame,
    shapes: &mut Vec<Shape>,
) {
    let [left, top, width, height] = frame.area;
    let size = [width.round() as usize, height.round() as usize];
    let diameter = figure.diameter;
    let picture = Picture::new(size, Map::Sequential, range, |column, row| {
        let share = [(column as f64 + 0.5) / size[0] as f64, (row as f64 + 0.5) / size[1] as f64];
        let x = frame.x.low + share[0] * (frame.x.high - frame.x.low);
        let y = frame.y.high + share[1] * (frame.y.low - frame.y.high);
        sample(&panel.plane, x * diameter, y * diameter)
            .map_or(f64::NAN, |speed| speed / figure.free_stream)
    });
    let look = Look::fill(Ink::Run(panel.colour));
    shapes.push(Shape::Circle { center: [left + 5.0, top - 13.5], radius: 4.5, look });
    let setting = TextStyle::plain(Ink::Text, MEDIUM).bold();
    shapes.push(text([left + 16.0, top - 9.0], panel.title.as_str(), setting));
    let mut inner = vec![Shape::Field { area: frame.area, picture }];
    inner.extend(rotors::on_plane(there(figure).iter(), &panel.plane, frame, diameter));
    let centres: Vec<[f64; 2]> =
        panel.centre_line.iter().map(|p| [p[0] / diameter, p[1] / diameter]).collect();
    for look in
        [Look::line(Ink::FieldHalo, 4.5).opacity(0.8), Look::line(Ink::Run(panel.colour), 2.4)]
    {
        inner.push(polyline(frame.points(&centres), look));
    }
    let field =
        FieldValues {
            name: panel.title.clone(), run: panel.colour, range, unit: "U∞".to_owned()
        };
    let readout = Readout { field: Some(field), ..frame.readout(["D", "D"]) };
    shapes.push(readout.group(0.0, inner));
}

/// The rotors, as other figures know them.
fn there(figure: &SliceFigure) -> Vec<Rotor> {
    let rotor = |rotor: &SliceRotor| Rotor {
        name: rotor.name.clone(),
        hub: rotor.hub,
        diameter: rotor.diameter,
        yaw: rotor.yaw,
    };
    figure.rotors.iter().map(rotor).collect()
}

/// What is shown across the wind (diameters): all rotors with room beside them.
fn sides(figure: &SliceFigure) -> [f64; 2] {
    let ends = figure.rotors.iter().flat_map(|rotor| {
        let reach = 0.5 * rotor.diameter + BESIDE * figure.diameter;
        [rotor.hub[1] - reach, rotor.hub[1] + reach].map(|y| y / figure.diameter)
    });
    let (low, high) =
        ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), y| (a.min(y), b.max(y)));
    if low < high { [low, high] } else { [-1.5, 1.5] }
}
