//! Signals over time in rows: estimates beside the truth, winds, pitch and moments of several cases.

use super::marks::{case_line, degree_rows, named, names, upright};
use super::{TrackFigure, TrackLine, TrackRow};
use crate::draw::axes::{Frame, Readout, Scale, legend};
use crate::draw::colour::Ink;
use crate::draw::{Figure, Look, Role, Shape};
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
            frame.x_label(figure.along.label, &mut shapes);
        }
        let mut inner: Vec<Shape> = Vec::new();
        if let Some(mark) = figure.mark {
            upright(&frame, mark, "", &mut inner);
        }
        for (line, bands) in row.lines.iter().zip(&drawn.bands) {
            inner.extend(bands.iter().map(|outline| band(outline, line.colour, &frame)));
        }
        for (line, pieces) in row.lines.iter().zip(&drawn.pieces) {
            let look = case_line(line.colour, 1.6);
            let pieces = pieces.iter().map(|piece| frame.line(piece, look)).collect();
            inner.push(named(&line.name, pieces));
        }
        let readout = frame.readout([figure.along.unit, if row.is_angle { "°" } else { "" }]);
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

/// A pale area within the `outline`, a closed line of values, in the colour of the case of index `colour`.
fn band(outline: &[[f64; 2]], colour: usize, frame: &Frame) -> Shape {
    let look = Look::fill(Ink::Run(colour)).opacity(0.2);
    Shape::Path { points: frame.points(outline), closed: true, look }
}

/// A row's lines as points, cut where an angle jumps, and the scale that holds them; outlines of their bands,
/// piece by piece.
struct Drawn {
    pieces: Vec<Vec<Vec<[f64; 2]>>>,
    bands: Vec<Vec<Vec<[f64; 2]>>>,
    scale: Scale,
}

/// The outline of the band of `line`: along its upper edge, and back along the lower one. Nothing where the
/// line has none.
fn outline(line: &TrackLine) -> Option<Vec<[f64; 2]>> {
    if line.band.is_empty() {
        return None;
    }
    let edge = |side: f64| -> Vec<f64> {
        line.values.iter().zip(&line.band).map(|(value, half)| value + side * half).collect()
    };
    let mut outline = envelope(&line.times, &edge(1.0), N_BUCKETS);
    outline.extend(envelope(&line.times, &edge(-1.0), N_BUCKETS).into_iter().rev());
    Some(outline)
}

impl Drawn {
    fn new(row: &TrackRow) -> Self {
        if row.is_angle {
            let middle = row.lines.first().map_or(0.0, |line| direction(&line.values));
            // Whole quarter turns, so that the same angles stand at the same height in neighbouring rows.
            let middle = (middle.to_degrees() / 90.0).round() * 90.0;
            let scale = Scale::linear(middle - 180.0, middle + 180.0);
            let pieces = row.lines.iter().map(|line| angles(line, middle)).collect();
            let bands = row.lines.iter().map(|line| angle_bands(line, middle)).collect();
            return Self { pieces, bands, scale };
        }
        let pieces: Vec<Vec<Vec<[f64; 2]>>> = row
            .lines
            .iter()
            .map(|line| vec![envelope(&line.times, &line.values, N_BUCKETS)])
            .collect();
        let bands: Vec<Vec<Vec<[f64; 2]>>> =
            row.lines.iter().map(|line| Vec::from_iter(outline(line))).collect();
        let values = pieces.iter().chain(&bands).flatten().flatten().map(|point| point[1]);
        let scale = Scale::around(values, 0.06);
        Self { pieces, bands, scale }
    }
}

/// Outlines (deg) of the band of the angles of `line` about `middle` (deg), one for each of its pieces; what
/// reaches beyond the axes is cut there.
fn angle_bands(line: &TrackLine, middle: f64) -> Vec<Vec<[f64; 2]>> {
    if line.band.is_empty() {
        return Vec::new();
    }
    let half = |time: f64| {
        let index = line.times.partition_point(|other| *other < time);
        line.band.get(index).copied().unwrap_or(0.0).to_degrees()
    };
    let outline = |piece: Vec<[f64; 2]>| {
        let upper = piece.iter().map(|[time, angle]| [*time, angle + half(*time)]);
        let lower = piece.iter().rev().map(|[time, angle]| [*time, angle - half(*time)]);
        upper.chain(lower).collect()
    };
    angles(line, middle).into_iter().map(outline).collect()
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
        let band = vec![0.1; times.len()];
        let line = TrackLine { name: "a".into(), colour: 0, times, values, band };
        let pieces = angles(&line, 90.0);
        // A band around each piece, there and back.
        let bands = angle_bands(&line, 90.0);
        assert_eq!(bands.len(), pieces.len());
        let (band, piece) = (&bands[0], &pieces[0]);
        assert_eq!(band.len(), 2 * piece.len());
        let width = band[0][1] - band[band.len() - 1][1];
        assert!((width - 0.2_f64.to_degrees()).abs() < 1e-12, "{width}");
        // 19.8 rad are three turns and a bit.
        assert_eq!(pieces.len(), 4);
        assert!(pieces.iter().flatten().all(|point| (-90.0..=270.0).contains(&point[1])));
        assert!(direction(&[0.1, std::f64::consts::TAU - 0.3]) + 0.1 < 1e-12);
    }
}
