//! The shape of free wakes: the vortices that trail from the blades, from the side and from upwind.

use super::{WIDTH, rotors};
use crate::RunRecords;
use crate::draw::axes::{Frame, LARGE, Scale};
use crate::draw::colour::Ink;
use crate::draw::{Figure, Look, Shape, TextStyle, polyline, text};
use crate::layout::Rotor;
use crate::study::Study;
use crate::words::{SPACE, number};
use basis::records::{Filaments, PieceKind, Plane, PlaneAxes};
use std::collections::BTreeMap;

const LEFT: f64 = 58.0;
const RIGHT: f64 = 20.0;
/// Between the two views, and above and below them.
const GAP: f64 = 64.0;
const ABOVE: f64 = 36.0;
const BELOW: f64 = 26.0;
/// Highest view, where wakes are short.
const HIGHEST: f64 = 460.0;
/// How far behind its rotor a wake is drawn in the view from upwind (diameters): further down it would hide
/// what is before it.
const NEAR: f64 = 1.0;
/// Vortices of a blade that are drawn beside that of its tip, at most (–).
const MOST_INNER: usize = 8;
/// From here on a vortex is the tip's (distance from the root over the blade's length).
const TIP: f32 = 0.999;
/// Air around the wakes in the views (diameters).
const MARGIN: f64 = 0.1;

/// One vortex from a place of a blade on, the oldest point first (m).
struct Line {
    is_tip: bool,
    turbine: u32,
    points: Vec<[f32; 3]>,
}

/// The vortices of each run at its last instant; none where no run has any.
pub(super) fn geometry(study: &Study) -> Option<Figure> {
    let wakes: Vec<(&RunRecords, usize, Vec<Line>)> = study
        .runs()
        .iter()
        .zip(&study.colours)
        .filter_map(|(run, &colour)| Some((run, colour, lines(run.filaments.as_ref()?))))
        .filter(|(.., lines)| !lines.is_empty())
        .collect();
    let time = wakes.first()?.0.filaments.as_ref()?.time;
    let unit = study.diameter();
    let [x, y, z] = extent(study, wakes.iter().flat_map(|(.., lines)| lines))?;
    // One scale for both views of all runs: nothing is distorted.
    let width = WIDTH - LEFT - RIGHT - GAP;
    let scale = (width / (x[1] - x[0] + y[1] - y[0])).min(HIGHEST / (z[1] - z[0]));
    let height = scale * (z[1] - z[0]);
    let up = Scale::linear(z[0], z[1]);
    let mut shapes = Vec::new();
    for (index, (run, colour, lines)) in wakes.iter().enumerate() {
        let top = ABOVE + (height + ABOVE + BELOW) * index as f64;
        let across = scale * (y[1] - y[0]);
        let along = scale * (x[1] - x[0]);
        let side = Frame { area: [LEFT, top, along, height], x: Scale::linear(x[0], x[1]), y: up };
        // Looking downwind, y grows to the left.
        let area = [LEFT + along + GAP, top, across, height];
        let front = Frame { area, x: Scale::linear(y[1], y[0]), y: up };
        headed(run, *colour, &side, &mut shapes);
        let rotors: Vec<Rotor> = study.rotors_of(run).collect();
        view(&side, PlaneAxes::Streamwise, lines, &rotors, unit, &mut shapes);
        view(&front, PlaneAxes::Crosswind, lines, &rotors, unit, &mut shapes);
    }
    let caption = format!(
        "Vortices that trail from the blades at the last instant ({}{SPACE}s): dark from the tips, light from further in, \
         at most {MOST_INNER} of each blade. Left from the side; right looking downwind, the first {NEAR:.0}{SPACE}D behind \
         each rotor.",
        number(time, 0)
    );
    Some(Figure {
        name: "wake-geometry".to_owned(),
        title: "Shape of the wakes".to_owned(),
        caption,
        width: WIDTH,
        height: (height + ABOVE + BELOW) * wakes.len() as f64 + 20.0,
        shapes,
    })
}

/// Name and colour of `run` above `frame`.
fn headed(run: &RunRecords, colour: usize, frame: &Frame, shapes: &mut Vec<Shape>) {
    let [left, top, ..] = frame.area;
    let (center, look) = ([left + 5.0, top - 13.5], Look::fill(Ink::Run(colour)));
    shapes.push(Shape::Circle { center, radius: 4.5, look });
    let setting = TextStyle::plain(Ink::Text, LARGE).bold();
    shapes.push(text([left + 16.0, top - 9.0], run.summary.run.as_str(), setting));
}

/// One view of `lines` and `rotors` in `frame`, whose axes are in lengths of `unit` (m).
fn view(
    frame: &Frame,
    axes: PlaneAxes,
    lines: &[Line],
    rotors: &[Rotor],
    unit: f64,
    shapes: &mut Vec<Shape>,
) {
    let is_front = axes == PlaneAxes::Crosswind;
    let [light, dark] = [(0.6, 0.45), (1.0, 1.0)]
        .map(|(width, opacity)| Look::line(Ink::Text, width).opacity(opacity));
    let mut drawn = Vec::new();
    for (is_tip, look) in [(false, Look { stroke: Some(Ink::Muted), ..light }), (true, dark)] {
        for line in lines.iter().filter(|line| line.is_tip == is_tip) {
            let end = rotors.get(line.turbine as usize).map(|rotor| rotor.hub[0] + NEAR * unit);
            let is_shown =
                |point: &&[f32; 3]| !is_front || end.is_none_or(|end| f64::from(point[0]) < end);
            let across = if is_front { 1 } else { 0 };
            let place = |point: &[f32; 3]| {
                frame.point([point[across], point[2]].map(|value| f64::from(value) / unit))
            };
            let points: Vec<[f64; 2]> = line.points.iter().filter(is_shown).map(place).collect();
            drawn.push(polyline(points, look));
        }
    }
    for rotor in rotors {
        // The plane through the hub, or one behind all rotors.
        let origin = if is_front { [f64::INFINITY, 0.0, 0.0] } else { rotor.hub };
        let through = plane(axes, origin);
        drawn.extend(rotors::on_plane(std::iter::once(rotor), &through, frame, unit));
    }
    frame.columns(if is_front { 4 } else { 12 }, true, shapes);
    frame.heights(4, shapes);
    frame.x_label(if is_front { "y/D" } else { "x/D" }, shapes);
    frame.y_label("z/D", 38.0, shapes);
    shapes.push(frame.panel(drawn, ["D", "D"]));
}

/// A plane without values.
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

/// What the views show along x, y and z (diameters): all `lines` and all rotors; none without any line.
fn extent<'a>(study: &Study, lines: impl Iterator<Item = &'a Line>) -> Option<[[f64; 2]; 3]> {
    let unit = study.diameter();
    let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let mut take = |point: [f64; 3]| {
        for (span, value) in found.iter_mut().zip(point) {
            *span = [span[0].min(value / unit), span[1].max(value / unit)];
        }
    };
    for point in lines.flat_map(|line| &line.points) {
        take(point.map(f64::from));
    }
    for rotor in &study.rotors {
        let ([x, y, z], radius) = (rotor.hub, 0.5 * rotor.diameter);
        [-radius, radius].into_iter().for_each(|r| take([x, y + r, z + r]));
    }
    let is_wide = found.iter().all(|span| span[1] > span[0]);
    is_wide.then(|| {
        let [x, y, z] = found.map(|[low, high]| [low - MARGIN, high + MARGIN]);
        [x, y, [z[0].max(0.0).min(z[1] - MARGIN), z[1]]]
    })
}

/// The vortices of `filaments` that are drawn: of each blade that of its tip and some further in.
fn lines(filaments: &Filaments) -> Vec<Line> {
    // Positive numbers sort as their bits do.
    let mut chains: BTreeMap<(u32, u32, u32), Vec<Vec<u32>>> = BTreeMap::new();
    for piece in filaments.pieces.iter().filter(|piece| piece.kind == PieceKind::Trailing) {
        let key = (piece.turbine, piece.blade, piece.span.max(0.0).to_bits());
        let mine = chains.entry(key).or_default();
        let [young, old] = piece.ends;
        match mine.last_mut() {
            Some(chain) if chain.last() == Some(&old) => chain.push(young),
            _ => mine.push(vec![old, young]),
        }
    }
    // Most places of a blade have a vortex near the blade alone: those that go on further down are drawn.
    let length = |chains: &Vec<Vec<u32>>| chains.iter().map(Vec::len).sum::<usize>();
    let longest = chains.values().map(length).max().unwrap_or(0);
    chains.retain(|_, chains| 2 * length(chains) > longest);
    let mut lines = Vec::new();
    let blades: Vec<(u32, u32)> =
        chains.keys().map(|&(turbine, blade, _)| (turbine, blade)).collect();
    let mut last = None;
    for blade @ (turbine, number) in blades {
        if last.replace(blade) == Some(blade) {
            continue;
        }
        let of_blade = chains.range((turbine, number, 0)..=(turbine, number, u32::MAX));
        let stride = of_blade.clone().count().div_ceil(MOST_INNER + 1);
        for (place, (&(.., span), chains)) in of_blade.enumerate() {
            let is_tip = f32::from_bits(span) >= TIP;
            if !is_tip && place % stride != 0 {
                continue;
            }
            let point = |node: &u32| filaments.nodes[*node as usize];
            lines.extend(chains.iter().map(|chain| Line {
                is_tip,
                turbine,
                points: chain.iter().map(point).collect(),
            }));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::Piece;

    /// A blade with four vortices of `n_rows` pieces each and pieces across between them.
    fn wake(n_rows: u32) -> Filaments {
        let node = |row: u32, s: u32| 4 * row + s;
        let piece = |kind, ends, span| Piece {
            ends,
            kind,
            turbine: 0,
            blade: 1,
            span,
            age: 0.0,
            circulation: 10.0,
            core_radius: 1.0,
        };
        let mut found = Filaments::default();
        for row in 0..=n_rows {
            found.nodes.extend((0..4).map(|s| [(n_rows - row) as f32, s as f32, 90.0]));
            for s in (0..4).filter(|_| row < n_rows) {
                let ends = [node(row + 1, s), node(row, s)];
                found.pieces.push(piece(PieceKind::Trailing, ends, s as f32 / 3.0));
                found.pieces.push(piece(PieceKind::Shed, [node(row, s), node(row, s / 2)], 0.5));
            }
        }
        found
    }

    #[test]
    fn pieces_that_follow_each_other_are_one_line() {
        let lines = lines(&wake(5));
        assert_eq!(lines.len(), 4);
        assert_eq!(lines.iter().filter(|line| line.is_tip).count(), 1);
        for (s, line) in lines.iter().enumerate() {
            let expected: Vec<[f32; 3]> =
                (0..=5).rev().map(|x| [x as f32, s as f32, 90.0]).collect();
            assert_eq!(line.points, expected, "{s}");
        }
    }

    #[test]
    fn vortices_that_end_near_the_blade_are_left_out() {
        let mut wake = wake(8);
        // The second one only over its youngest two pieces.
        wake.pieces.retain(|piece| {
            piece.span != 1.0 / 3.0 || piece.kind != PieceKind::Trailing || piece.ends[1] > 24
        });
        let lines = lines(&wake);
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| line.points.len() == 9));
    }
}
