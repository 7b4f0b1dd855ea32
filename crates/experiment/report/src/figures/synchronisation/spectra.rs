//! Amplitudes around the excitation frequency, cases overlaid.

use super::SpectrumFigure;
use super::marks::{case_line, named, names, upright};
use crate::draw::axes::{Frame, Scale, legend};
use crate::draw::{Figure, Role, Shape};
use crate::figures::WIDTH;

const HEIGHT: f64 = 280.0;
const LEFT: f64 = 74.0;

/// From zero to twice the excitation frequency.
pub(super) fn spectra(figure: &SpectrumFigure) -> Option<Figure> {
    let excitation = figure.excitation_frequency;
    let lines: Vec<(usize, Vec<[f64; 2]>)> = figure
        .lines
        .iter()
        .map(|line| {
            let n_shown = (2.0 * excitation / line.frequency_step).ceil() as usize + 1;
            let points =
                line.values.iter().take(n_shown).enumerate().map(|(index, value)| {
                    [index as f64 * line.frequency_step / excitation, *value]
                });
            (line.colour, points.filter(|point| point[1].is_finite()).collect())
        })
        .collect();
    let values = || lines.iter().flat_map(|line| line.1.iter().map(|point| point[1]));
    let highest = values().fold(0.0, f64::max);
    if highest <= 0.0 {
        return None;
    }
    let mut shapes = Vec::new();
    let names = names(figure.lines.iter().map(|line| (line.colour, line.name.as_str())));
    let top = 22.0 + legend([LEFT, 22.0], WIDTH - 100.0, |_| Role::Plain, &names, &mut shapes);
    let frame = Frame {
        area: [LEFT, top, WIDTH - LEFT - 24.0, HEIGHT],
        x: Scale::linear(0.0, 2.0),
        y: Scale::linear(0.0, 1.06 * highest),
    };
    frame.rows(5, true, &mut shapes);
    frame.columns(8, true, &mut shapes);
    frame.x_label("frequency over excitation frequency", &mut shapes);
    frame.y_label(&figure.label, 50.0, &mut shapes);
    let mut inner: Vec<Shape> = Vec::new();
    upright(&frame, 1.0, "excitation", &mut inner);
    inner.extend(figure.lines.iter().zip(&lines).map(|(of, (colour, line))| {
        named(&of.name, vec![frame.line(line, case_line(*colour, 1.8))])
    }));
    shapes.push(frame.panel(inner, ["fe", ""]));
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: format!(
            "Amplitude of the sine at each frequency; the excitation is at {:.2}\u{a0}mHz.",
            1e3 * excitation
        ),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}
