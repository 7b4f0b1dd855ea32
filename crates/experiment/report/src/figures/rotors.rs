//! Rotors as they show on planes and along lines: each where it stands, as large as it is, with its name.

use crate::draw::axes::Frame;
use crate::draw::colour::Ink;
use crate::draw::font::Face;
use crate::draw::{Look, Shape, TextStyle, segment, text};
use crate::layout::Rotor;
use basis::records::{Plane, PlaneAxes};

/// Size of the names.
const SIZE: f64 = 11.0;

/// The `rotors` on `plane` in `frame`, whose axes are in lengths of `unit` (m): lines from above and from the
/// side, circles from upwind; those that the plane does not show are left out.
pub(super) fn on_plane<'a>(
    rotors: impl Iterator<Item = &'a Rotor>,
    plane: &Plane,
    frame: &Frame,
    unit: f64,
) -> Vec<Shape> {
    match plane.axes {
        PlaneAxes::Crosswind => circles(rotors, plane.origin[0], frame, unit),
        PlaneAxes::Horizontal => {
            let ends = rotors.map(|rotor| {
                let (sine, cosine) = rotor.yaw.sin_cos();
                let half = 0.5 * rotor.diameter;
                let arm = [-half * sine, half * cosine];
                (rotor, [rotor.hub[0], rotor.hub[1]], arm)
            });
            lines(ends, frame, unit)
        }
        PlaneAxes::Streamwise => {
            let cut = rotors.filter_map(|rotor| {
                let distance = plane.origin[1] - rotor.hub[1];
                let half = rotor.half_chord(distance)?;
                Some((rotor, [rotor.hub[0] + rotor.downwind(distance), rotor.hub[2]], [0.0, half]))
            });
            lines(cut, frame, unit)
        }
    }
}

/// Rotors, each with the middle of its line in `frame` and the way from there to its upper end (m).
fn lines<'a>(
    rotors: impl Iterator<Item = (&'a Rotor, [f64; 2], [f64; 2])>,
    frame: &Frame,
    unit: f64,
) -> Vec<Shape> {
    let halo = Look::line(Ink::FieldHalo, 5.0).opacity(0.75);
    let core = Look::line(Ink::OnField, 2.4);
    let mut shapes = Vec::new();
    let mut ends = Vec::new();
    for (rotor, middle, arm) in rotors {
        let place =
            |sign: f64| frame.point([0, 1].map(|axis| (middle[axis] + sign * arm[axis]) / unit));
        let [low, high] = [place(-1.0), place(1.0)];
        shapes.extend([halo, core].map(|look| segment(low, high, look)));
        ends.push((rotor.name.as_str(), low, high));
    }
    let mut names = Names::new(frame.area, on_field());
    for (_, low, high) in &ends {
        let (left, right) = (low[0].min(high[0]), low[0].max(high[0]));
        names.taken.push([left - 2.0, high[1], right - left + 4.0, low[1] - high[1]]);
    }
    for (name, low, high) in ends {
        let beside = [
            ([high[0] + 6.0, high[1] + SIZE], 0.0),
            ([high[0] - 6.0, high[1] + SIZE], 1.0),
            ([low[0] + 6.0, low[1] - 3.0], 0.0),
            ([low[0] - 6.0, low[1] - 3.0], 1.0),
            ([low[0], low[1] + SIZE + 2.0], 0.5),
            ([high[0], high[1] - 4.0], 0.5),
        ];
        shapes.extend(names.place(name, &beside));
    }
    shapes
}

/// Rotors upstream of a plane at `x` (m) as circles, those behind one another as one.
fn circles<'a>(
    rotors: impl Iterator<Item = &'a Rotor>,
    x: f64,
    frame: &Frame,
    unit: f64,
) -> Vec<Shape> {
    let mut found: Vec<(Vec<&str>, [f64; 2], f64)> = Vec::new();
    for rotor in rotors.filter(|rotor| rotor.hub[0] <= x + 1e-6 * unit) {
        let (place, radius) = ([rotor.hub[1], rotor.hub[2]], 0.5 * rotor.diameter);
        let near = 0.02 * unit;
        let same = found.iter_mut().find(|(_, other, size)| {
            (other[0] - place[0]).hypot(other[1] - place[1]) < near && (*size - radius).abs() < near
        });
        match same {
            Some((names, ..)) => names.push(&rotor.name),
            None => found.push((vec![&rotor.name], place, radius)),
        }
    }
    let mut shapes = Vec::new();
    let mut names = Names::new(frame.area, on_field());
    for (turbines, [y, z], radius) in found {
        let center = frame.point([y / unit, z / unit]);
        let radius = (frame.point([y / unit, (z + radius) / unit])[1] - center[1]).abs();
        for look in [
            Look::line(Ink::FieldHalo, 3.0).opacity(0.6),
            Look { dash: Some([5.0, 4.0]), ..Look::line(Ink::OnField, 1.4) },
        ] {
            shapes.push(Shape::Circle { center, radius, look });
        }
        let name = match turbines.as_slice() {
            [first, .., last] if turbines.len() > 2 => format!("{first} … {last}"),
            few => few.join(", "),
        };
        let [x, y] = center;
        let beside = [
            ([x, y - radius - 4.0], 0.5),
            ([x, y + radius - 6.0], 0.5),
            ([x, y - radius + SIZE + 4.0], 0.5),
            ([x, y + radius + SIZE + 2.0], 0.5),
        ];
        shapes.extend(names.place(&name, &beside));
    }
    shapes
}

/// Dashed lines with their names where `rotors` stand along the wind, in a frame of lines.
pub(super) fn along<'a>(
    rotors: impl Iterator<Item = &'a Rotor>,
    frame: &Frame,
    unit: f64,
    shapes: &mut Vec<Shape>,
) {
    let [left, top, width, height] = frame.area;
    let mut names = Names::new(frame.area, TextStyle::plain(Ink::Muted, SIZE));
    for rotor in rotors {
        let [x, _] = frame.point([rotor.hub[0] / unit, frame.y.low]);
        if !(left..=left + width).contains(&x) {
            continue;
        }
        let look = Look::line(Ink::Axis, 1.0).dashed(Some([4.0, 3.0]));
        shapes.push(segment([x, top], [x, top + height], look));
        let beside = [12.0, 25.0].map(|below| ([x + 4.0, top + below], 0.0));
        shapes.extend(names.place(&rotor.name, &beside));
    }
}

/// How names are set on a coloured field.
fn on_field() -> TextStyle {
    TextStyle::plain(Ink::OnField, SIZE).on_field()
}

/// Names on a sheet that keep clear of one another.
struct Names {
    face: Face,
    /// Left, top, width, height of the frame.
    frame: [f64; 4],
    /// The same of what must stay free.
    taken: Vec<[f64; 4]>,
    setting: TextStyle,
}

impl Names {
    fn new(frame: [f64; 4], setting: TextStyle) -> Self {
        Self { face: Face::new(false), frame, taken: Vec::new(), setting }
    }

    /// `name` at the first of the places (anchored so) where there is room; none where there is none.
    fn place(&mut self, name: &str, places: &[([f64; 2], f64)]) -> Option<Shape> {
        let width = 1.06 * self.face.width(name, SIZE) + 2.0;
        let height = SIZE + 1.0;
        for &([x, y], anchor) in places {
            let area = [x - anchor * width, y - SIZE + 1.0, width, height];
            let [left, top, all, high] = self.frame;
            let is_inside = area[0] >= left
                && area[0] + width <= left + all
                && area[1] >= top
                && area[1] + height <= top + high;
            if is_inside && !self.taken.iter().any(|other| overlap(area, *other)) {
                self.taken.push(area);
                return Some(text([x, y], name, self.setting.anchored(anchor)));
            }
        }
        None
    }
}

fn overlap([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4]) -> bool {
    a < e + g && e < a + c && b < f + h && f < b + d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw::axes::Scale;

    fn rotor(name: &str, hub: [f64; 3], diameter: f64) -> Rotor {
        Rotor { name: name.into(), hub, diameter, yaw: 0.0 }
    }

    /// A plane at 800 m along the third axis; what is on it does not matter here.
    fn plane(axes: PlaneAxes, origin: [f64; 3]) -> Plane {
        Plane {
            name: String::new(),
            axes,
            origin,
            spacing: [1.0; 2],
            n_points: [0; 2],
            time: 0.0,
            averaged: 0.0,
            velocity: [Vec::new(), Vec::new(), Vec::new()],
        }
    }

    /// A frame in which a unit is 100, with y downwards from 1000.
    fn frame() -> Frame {
        let scale = Scale::linear(0.0, 10.0);
        Frame { area: [0.0, 0.0, 1000.0, 1000.0], x: scale, y: scale }
    }

    fn names(shapes: &[Shape]) -> Vec<&str> {
        let mut found = Vec::new();
        for shape in shapes {
            if let Shape::Text { content, .. } = shape {
                found.push(content.as_str());
            }
        }
        found
    }

    #[test]
    fn rotors_are_as_long_as_what_a_plane_cuts_out_of_them() {
        let rotors = [
            rotor("A", [200.0, 300.0, 150.0], 100.0),
            rotor("B", [500.0, 330.0, 150.0], 200.0),
            rotor("C", [700.0, 600.0, 150.0], 100.0),
        ];
        let side = plane(PlaneAxes::Streamwise, [0.0, 300.0, 0.0]);
        let shapes = on_plane(rotors.iter(), &side, &frame(), 100.0);
        assert_eq!(names(&shapes), ["A", "B"]);
        let lengths: Vec<f64> = shapes
            .iter()
            .filter_map(|shape| match shape {
                Shape::Path { points, .. } => Some(points[0][1] - points[1][1]),
                _ => None,
            })
            .collect();
        let chord = 2.0 * (100f64.powi(2) - 30f64.powi(2)).sqrt();
        for (length, expected) in lengths.iter().zip([100.0, 100.0, chord, chord]) {
            assert!((length - expected).abs() < 1e-9, "{lengths:?}");
        }
        let above = plane(PlaneAxes::Horizontal, [0.0, 0.0, 150.0]);
        assert_eq!(names(&on_plane(rotors.iter(), &above, &frame(), 100.0)), ["A", "B", "C"]);
    }

    #[test]
    fn a_yawed_rotor_is_turned_counter_clockwise_seen_from_above() {
        let turned = Rotor { yaw: 0.5, ..rotor("A", [500.0, 500.0, 150.0], 200.0) };
        let above = plane(PlaneAxes::Horizontal, [0.0, 0.0, 150.0]);
        let shapes = on_plane([turned].iter(), &above, &frame(), 100.0);
        let Shape::Path { points, .. } = &shapes[0] else { panic!("no line") };
        // On the sheet y grows upwards, so the left end, with the greater y, has the lesser height.
        let arm = [100.0 * 0.5_f64.sin(), 100.0 * 0.5_f64.cos()];
        let expected = [[500.0 + arm[0], 500.0 + arm[1]], [500.0 - arm[0], 500.0 - arm[1]]];
        for (point, expected) in points.iter().zip(expected) {
            let apart = (point[0] - expected[0]).hypot(point[1] - expected[1]);
            assert!(apart < 1e-9, "{points:?}");
        }
    }

    #[test]
    fn circles_stand_upstream_of_their_plane_and_those_in_line_are_one() {
        let rotors = [
            rotor("A", [0.0, 300.0, 300.0], 100.0),
            rotor("B", [500.0, 300.0, 300.0], 100.0),
            rotor("C", [500.0, 600.0, 300.0], 120.0),
            rotor("D", [900.0, 300.0, 300.0], 100.0),
        ];
        let across = plane(PlaneAxes::Crosswind, [600.0, 0.0, 0.0]);
        let shapes = on_plane(rotors.iter(), &across, &frame(), 100.0);
        assert_eq!(names(&shapes), ["A, B", "C"]);
        let radii = shapes.iter().filter_map(|shape| match shape {
            Shape::Circle { radius, .. } => Some(*radius),
            _ => None,
        });
        for (radius, expected) in radii.zip([50.0, 50.0, 60.0, 60.0]) {
            assert!((radius - expected).abs() < 1e-9);
        }
    }

    #[test]
    fn names_that_would_cover_one_another_are_left_out() {
        let rotors: Vec<Rotor> = (0..200)
            .map(|index| rotor(&format!("T{index}"), [5.0 * f64::from(index), 500.0, 0.0], 100.0))
            .collect();
        let above = plane(PlaneAxes::Horizontal, [0.0; 3]);
        let shapes = on_plane(rotors.iter(), &above, &frame(), 100.0);
        let n_names = names(&shapes).len();
        assert!(n_names < rotors.len() && !shapes.is_empty(), "{n_names}");
    }
}
