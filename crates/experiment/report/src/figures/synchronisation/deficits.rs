//! Deficits about the wake's own centre, cases overlaid, a panel for each distance.

use super::marks::{case_line, free_stream, named, names};
use super::{DeficitFigure, DeficitLine};
use crate::draw::axes::{Frame, Readout, Scale, legend};
use crate::draw::colour::Ink;
use crate::draw::{Axis, Figure, Look, Role, Shape, rectangle};
use crate::figures::WIDTH;

const HEIGHT: f64 = 250.0;
const LEFT: f64 = 62.0;
const GAP: f64 = 16.0;

/// Deficit over the free stream against the distance from the centre over the diameter.
pub(super) fn deficits(figure: &DeficitFigure) -> Option<Figure> {
    let lines = || figure.panels.iter().flat_map(|panel| &panel.lines);
    let values = || lines().flat_map(|line| line.deficits.iter().map(|d| d / figure.free_stream));
    let reach = lines()
        .flat_map(|line| &line.offsets)
        .fold(0.0_f64, |reach, offset| reach.max(offset.abs() / figure.diameter));
    values().next()?;
    if reach <= 0.0 {
        return None;
    }
    let mut shapes = Vec::new();
    let names = names(lines().map(|line| (line.colour, line.name.as_str())));
    let top =
        22.0 + legend([LEFT, 22.0], WIDTH - 100.0, |_| Role::Plain, &names, &mut shapes) + 18.0;
    let n_panels = figure.panels.len() as f64;
    let width = ((WIDTH - LEFT - 24.0 - GAP * (n_panels - 1.0)) / n_panels).min(300.0);
    let scale = Scale::around(values().chain([0.0]), 0.05);
    for (index, panel) in figure.panels.iter().enumerate() {
        let frame = Frame {
            area: [LEFT + (width + GAP) * index as f64, top, width, HEIGHT],
            x: scale,
            y: Scale::linear(-reach, reach),
        };
        let rotor = frame.rectangle([scale.low, -0.5], [scale.high, 0.5]);
        shapes.push(frame.behind(vec![rectangle(rotor, Look::fill(Ink::Band))]));
        frame.rows(6, index == 0, &mut shapes);
        frame.columns(if width > 200.0 { 4 } else { 3 }, true, &mut shapes);
        frame.title(&panel.title, &mut shapes);
        frame.x_label("(U∞ − u)/U∞", &mut shapes);
        if index == 0 {
            frame.y_label("(y − centre)/D", 40.0, &mut shapes);
        }
        let inner = panel.lines.iter().map(|line| drawn(figure, line, &frame)).collect();
        let readout = frame.readout(["U∞", "D"]);
        shapes.push(Readout { along: Axis::Y, ..readout }.group(0.0, inner));
    }
    Some(Figure {
        name: "recentred-deficits".to_owned(),
        title: "Deficits about the wake's own centre".to_owned(),
        caption: format!(
            "Mean deficit at hub height, shifted at each phase by the wake's centre, so that its swing does not pass for \
             mixing; the grey band is as wide as a rotor. {}.",
            free_stream(figure.free_stream)
        ),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

/// A mean deficit over the free stream across the wake.
fn drawn(figure: &DeficitFigure, line: &DeficitLine, frame: &Frame) -> Shape {
    let points: Vec<[f64; 2]> = line
        .deficits
        .iter()
        .zip(&line.offsets)
        .map(|(deficit, offset)| [deficit / figure.free_stream, offset / figure.diameter])
        .collect();
    named(&line.name, vec![frame.line(&points, case_line(line.colour, 2.0))])
}
