//! Signals over time in rows: estimates beside the truth, winds, pitch and moments of several cases.

use super::marks::{case_line, degree_rows, named, names, upright};
use super::{TrackFigure, TrackLine, TrackRow};
use crate::draw::axes::{Frame, Readout, Scale, legend};
use crate::draw::{Figure, Role, Shape};
use crate::figures::WIDTH;
use crate::trace::envelope;
use basis::angle::wrap_to_half_turn;

const HEIGHT: f64 = 120.0;
const GAP: f64 = 16.0;
const LEFT: f64 = 74.0;
/// Points of a line at most, twice this.
const N_BUCKETS: usize = 600;

/// A row of axes for each row of the figure, over one time.
pub(super) fn tracks(figure: &TrackFigure) -> Option<Figure> {
    let lines = || figure.rows.iter().flat_map(|row| &row.lines);
    let times = lines().flat_map(|line| line.times.iter().copied()).filter(|t| t.is_finite());
    let (start, end) =
        times.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)));
    if start >= end {
        return None;
    }
    let mut shapes = Vec::new();
    let names = names(lines().map(|line| (line.colour, line.name.as_str())));
    let top = 22.0 + legend([LEFT, 22.0], WIDTH - 100.0, |_| Role::Plain, &names, &mut shapes);
    let n_rows = figure.rows.len();
    for (index, row) in figure.rows.iter().enumerate() {
        let area = [LEFT, top + (HEIGHT + GAP) * index as f64, WIDTH - LEFT - 24.0, HEIGHT];
        let drawn = Drawn::new(row);
        let frame = Frame { area, x: Scale::linear(start, end), y: drawn.scale };
        if row.is_angle {
            degree_rows(&frame, 90.0, &mut shapes);
        } else {
            frame.rows(4, true, &mut shapes);
        }
        frame.columns(9, index + 1 == n_rows, &mut shapes);
        frame.y_label(&row.label, 50.0, &mut shapes);
        if index + 1 == n_rows {
            frame.x_label("time (s)", &mut shapes);
        }
        let mut inner: Vec<Shape> = Vec::new();
        if let Some(mark) = figure.mark {
            upright(&frame, mark, "", &mut inner);
        }
        for (line, pieces) in row.lines.iter().zip(&drawn.pieces) {
            let look = case_line(line.colour, 1.6);
            let pieces = pieces.iter().map(|piece| frame.line(piece, look)).collect();
            inner.push(named(&line.name, pieces));
        }
        let readout = frame.readout(["s", if row.is_angle { "°" } else { "" }]);
        shapes.push(Readout { both: false, ..readout }.group(0.0, inner));
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

/// A row's lines as points, cut where an angle jumps, and the scale that holds them.
struct Drawn {
    pieces: Vec<Vec<Vec<[f64; 2]>>>,
    scale: Scale,
}

impl Drawn {
    fn new(row: &TrackRow) -> Self {
        if row.is_angle {
            let middle = row.lines.first().map_or(0.0, |line| direction(&line.values));
            // Whole quarter turns, so that the same angles stand at the same height in neighbouring rows.
            let middle = (middle.to_degrees() / 90.0).round() * 90.0;
            let pieces = row.lines.iter().map(|line| angles(line, middle)).collect();
            return Self { pieces, scale: Scale::linear(middle - 180.0, middle + 180.0) };
        }
        let pieces: Vec<Vec<Vec<[f64; 2]>>> = row
            .lines
            .iter()
            .map(|line| vec![envelope(&line.times, &line.values, N_BUCKETS)])
            .collect();
        let values = pieces.iter().flatten().flatten().map(|point| point[1]);
        let scale = Scale::around(values, 0.06);
        Self { pieces, scale }
    }
}

/// Mean direction of angles (rad).
fn direction(angles: &[f64]) -> f64 {
    let finite = || angles.iter().filter(|angle| angle.is_finite());
    let (sine, cosine) =
        finite().fold((0.0, 0.0), |(sine, cosine), a| (sine + a.sin(), cosine + a.cos()));
    sine.atan2(cosine)
}

/// The angles (deg) within half a turn of `middle` (deg), cut where they leave it on one side and come back
/// on the other.
fn angles(line: &TrackLine, middle: f64) -> Vec<Vec<[f64; 2]>> {
    let stride = line.times.len().div_ceil(2 * N_BUCKETS).max(1);
    let mut pieces: Vec<Vec<[f64; 2]>> = vec![Vec::new()];
    for (time, value) in line.times.iter().zip(&line.values).step_by(stride) {
        let shown = middle + wrap_to_half_turn(value - middle.to_radians()).to_degrees();
        let last = pieces.last().and_then(|piece| piece.last());
        if last.is_some_and(|last| (shown - last[1]).abs() > 180.0) {
            pieces.push(Vec::new());
        }
        if let (true, Some(piece)) = (shown.is_finite(), pieces.last_mut()) {
            piece.push([*time, shown]);
        }
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_that_goes_round_is_cut_and_stays_inside() {
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        let values = times.iter().map(|t| 0.2 * t).collect();
        let line = TrackLine { name: "a".into(), colour: 0, times, values };
        let pieces = angles(&line, 90.0);
        // 19.8 rad are three turns and a bit.
        assert_eq!(pieces.len(), 4);
        assert!(pieces.iter().flatten().all(|point| (-90.0..=270.0).contains(&point[1])));
        assert!(direction(&[0.1, std::f64::consts::TAU - 0.3]) + 0.1 < 1e-12);
    }
}
