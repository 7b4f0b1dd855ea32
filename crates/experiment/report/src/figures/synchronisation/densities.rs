//! Power spectral densities in rows, cases overlaid, on a logarithmic scale.

use super::marks::{case_line, named, names, upright};
use super::{DensityFigure, DensityRow};
use crate::draw::axes::{Frame, Scale, legend};
use crate::draw::colour::Ink;
use crate::draw::{Figure, Look, Role, Shape, rectangle};
use crate::figures::WIDTH;

const HEIGHT: f64 = 190.0;
const GAP: f64 = 16.0;
const LEFT: f64 = 74.0;
/// Decades below the highest value that are shown at most.
const DECADES: f64 = 6.0;
/// Highest frequency that is still drawn in millihertz (Hz): those of wakes and towers are, those of models
/// in tunnels are not.
const HIGHEST_IN_MILLI: f64 = 5.0;

/// The unit of frequency of a figure: how many a hertz has, and its name.
fn unit(figure: &DensityFigure) -> (f64, &'static str) {
    if figure.highest_frequency > HIGHEST_IN_MILLI { (1.0, "Hz") } else { (1e3, "mHz") }
}

/// A pair of axes for each row, over frequencies up to the highest.
pub(super) fn densities(figure: &DensityFigure) -> Option<Figure> {
    let rows: Vec<Drawn> = figure.rows.iter().filter_map(|row| Drawn::new(figure, row)).collect();
    if rows.is_empty() {
        return None;
    }
    let (each, unit) = unit(figure);
    let mut shapes = Vec::new();
    let lines = rows.iter().flat_map(|drawn| &drawn.row.lines);
    let names = names(lines.map(|line| (line.colour, line.name.as_str())));
    let top = 22.0 + legend([LEFT, 22.0], WIDTH - 100.0, |_| Role::Plain, &names, &mut shapes);
    let n_rows = rows.len();
    for (index, drawn) in rows.iter().enumerate() {
        let last = index + 1 == n_rows;
        let frame = Frame {
            area: [LEFT, top + (HEIGHT + GAP) * index as f64, WIDTH - LEFT - 24.0, HEIGHT],
            x: frequencies(figure),
            y: drawn.scale,
        };
        if let Some([low, high]) = figure.band {
            let ends = [[each * low, frame.y.low], [each * high, frame.y.high]];
            let band = frame.rectangle(ends[0], ends[1]);
            shapes.push(frame.behind(vec![rectangle(band, Look::fill(Ink::Band))]));
        }
        frame.rows(5, true, &mut shapes);
        frame.columns(9, last, &mut shapes);
        frame.y_label(&drawn.row.label, 56.0, &mut shapes);
        if last {
            frame.x_label(&format!("frequency ({unit})"), &mut shapes);
        }
        let mut inner: Vec<Shape> = Vec::new();
        for (frequency, name) in &figure.marks {
            let name = if index == 0 { name.as_str() } else { "" };
            upright(&frame, each * frequency, name, &mut inner);
        }
        inner.extend(drawn.row.lines.iter().zip(&drawn.points).map(|(line, points)| {
            named(&line.name, vec![frame.line(points, case_line(line.colour, 1.8))])
        }));
        shapes.push(frame.panel(inner, [unit, ""]));
    }
    Some(Figure {
        name: figure.name.clone(),
        title: figure.title.clone(),
        caption: figure.caption.clone(),
        width: WIDTH,
        height: top + (HEIGHT + GAP) * n_rows as f64 - GAP + 50.0,
        shapes,
    })
}

/// The axis of frequencies, in the figure's unit.
fn frequencies(figure: &DensityFigure) -> Scale {
    let (each, _) = unit(figure);
    Scale {
        low: each * figure.lowest_frequency.unwrap_or(0.0),
        high: each * figure.highest_frequency,
        logarithmic: figure.lowest_frequency.is_some(),
    }
}

/// A row's lines as points, and the scale that holds them.
struct Drawn<'a> {
    row: &'a DensityRow,
    points: Vec<Vec<[f64; 2]>>,
    scale: Scale,
}

impl<'a> Drawn<'a> {
    /// Nothing where no line has a value above zero.
    fn new(figure: &DensityFigure, row: &'a DensityRow) -> Option<Self> {
        let (each, _) = unit(figure);
        let points: Vec<Vec<[f64; 2]>> = row
            .lines
            .iter()
            .map(|line| {
                let points = line.values.iter().enumerate();
                let points = points.map(|(k, value)| [k as f64 * line.frequency_step, *value]);
                // Nothing is told of the mean, which was taken off.
                let shown = points.skip(1).filter(|[frequency, value]| {
                    *frequency <= figure.highest_frequency && value.is_finite() && *value > 0.0
                });
                shown.map(|[frequency, value]| [each * frequency, value]).collect()
            })
            .collect();
        let values = || points.iter().flatten().map(|point| point[1]);
        let highest = values().fold(0.0, f64::max);
        let lowest = values().fold(f64::INFINITY, f64::min);
        (highest > 0.0).then(|| {
            let high = 10f64.powf((2.0 * highest).log10());
            // A decade at least, so that there is a tick.
            let low = (0.5 * lowest).max(high * 10f64.powf(-DECADES)).min(0.05 * high);
            Self { row, points, scale: Scale { low, high, logarithmic: true } }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::synchronisation::SpectrumLine;

    /// A figure of the `values` at 1, 2, … mHz after that of the mean.
    fn figure(values: Vec<f64>) -> DensityFigure {
        let line = SpectrumLine { name: "a".into(), colour: 0, frequency_step: 1e-3, values };
        DensityFigure {
            name: "d".into(),
            title: String::new(),
            caption: String::new(),
            lowest_frequency: None,
            highest_frequency: 3e-3,
            marks: vec![(2e-3, "here".into())],
            band: Some([1e-3, 2e-3]),
            rows: vec![DensityRow { label: "u".into(), lines: vec![line] }],
        }
    }

    #[test]
    fn mean_zeros_gaps_and_what_is_beyond_are_left_out() {
        let figure = figure(vec![9.0, 4.0, f64::NAN, 0.01, 7.0]);
        let drawn = Drawn::new(&figure, &figure.rows[0]).expect("a row");
        assert_eq!(drawn.points, [[[1.0, 4.0], [3.0, 0.01]]]);
        assert!(drawn.scale.low < 0.01 && drawn.scale.high > 4.0);
        assert!(densities(&figure).is_some());
    }

    #[test]
    fn frequencies_are_logarithmic_from_a_lowest_on() {
        let linear = figure(vec![9.0, 4.0, 1.0]);
        let figure = DensityFigure { lowest_frequency: Some(3e-5), ..linear.clone() };
        assert_eq!(frequencies(&linear), Scale::linear(0.0, 3.0));
        assert_eq!(frequencies(&figure).ticks(9).0, [0.05, 0.1, 0.2, 0.5, 1.0, 2.0]);
        assert!(densities(&figure).is_some());
    }

    #[test]
    fn nothing_is_drawn_of_nothing() {
        assert!(densities(&figure(vec![1.0, 0.0, 0.0])).is_none());
    }
}
