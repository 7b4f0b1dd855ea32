//! Coherence of the wind side by side over distance, a line for each frequency.

use crate::draw::axes::{Frame, Scale, legend};
use crate::draw::colour::Ink;
use crate::draw::{Figure, Look, Role, Shape};
use crate::figures::WIDTH;
use crate::precursor::PrecursorRecords;
use crate::words::{SPACE, number};

const HEIGHT: f64 = 260.0;
const LEFT: f64 = 64.0;

/// Lines over the distance, with those of the model dashed.
pub(super) fn coherence(records: &PrecursorRecords) -> Option<Figure> {
    let lines = &records.coherence;
    let farthest = lines.iter().flat_map(|line| &line.points).map(|point| point[0]);
    let farthest = farthest.fold(0.0, f64::max);
    if farthest <= 0.0 {
        return None;
    }
    let mut shapes = Vec::new();
    let names: Vec<String> =
        lines.iter().map(|line| format!("{}{SPACE}mHz", number(1e3 * line.frequency, 1))).collect();
    let entries: Vec<(usize, &str)> =
        names.iter().enumerate().map(|(index, name)| (index + 1, name.as_str())).collect();
    let used = legend([LEFT, 22.0], WIDTH - 90.0, |_| Role::Plain, &entries, &mut shapes);
    let top = 22.0 + used;
    let frame = Frame {
        area: [LEFT, top, WIDTH - LEFT - 24.0, HEIGHT],
        x: Scale::linear(0.0, farthest),
        y: Scale::linear(0.0, 1.0),
    };
    frame.rows(5, true, &mut shapes);
    frame.columns(9, true, &mut shapes);
    frame.x_label("distance across the wind (m)", &mut shapes);
    frame.y_label("coherence of u (–)", 46.0, &mut shapes);
    let mut inner: Vec<Shape> = Vec::new();
    for (index, (line, name)) in lines.iter().zip(&names).enumerate() {
        let ink = Ink::Run(index + 1);
        let named = |name: String, shape| Shape::Group {
            role: Role::Line(name),
            clip: None,
            shapes: vec![shape],
        };
        let model = frame.line(&line.model, Look::line(ink, 1.2).dashed(Some([5.0, 3.0])));
        inner.push(named(format!("{name}, model"), model));
        inner.push(named(name.clone(), frame.line(&line.points, Look::line(ink, 2.0))));
    }
    shapes.push(frame.panel(inner, ["m", ""]));
    Some(Figure {
        name: "coherence".to_owned(),
        title: "Coherence side by side".to_owned(),
        caption: "Modulus of the cross-spectrum of u at points side by side at hub height over the spectrum, mean over all pairs of the record; dashed: the exponential model of IEC 61400-1 (2005, eq. B.16). Where few segments were to be had, unrelated points show a little coherence, too.".to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}
