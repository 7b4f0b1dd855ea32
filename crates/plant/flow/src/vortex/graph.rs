//! The vortices of all wakes as a graph of nodes and pieces, to be looked at.

use super::sheet::Sheet;
use super::strip::Strip;
use super::wake::FreeWake;
use basis::Vector3;
use basis::records::{Filaments, Piece, PieceKind};

impl FreeWake {
    /// All vortices now, piece by piece as [`segments`](Self::segments) has them.
    pub fn filaments(&self) -> Filaments {
        let mut found = Filaments { time: self.time(), nodes: Vec::new(), pieces: Vec::new() };
        for sheet in &self.sheets {
            let first = found.nodes.len();
            let n_far = sheet.far.positions.len();
            let nodes = sheet.far.positions.iter().chain(&sheet.near.positions);
            found.nodes.extend(nodes.map(|node| node.to_array().map(|value| value as f32)));
            let turbine = self.rotors[sheet.owner[0]].turbine();
            Graph::new(sheet, [turbine, sheet.owner[1]], [first, first + n_far])
                .add(&mut found.pieces);
        }
        for (piece, segment) in found.pieces.iter_mut().zip(self.segments()) {
            piece.circulation = segment.circulation as f32;
            piece.core_radius = segment.core_squared.sqrt() as f32;
        }
        found
    }
}

/// The pieces of one blade's wake in the order of its segments.
struct Graph<'a> {
    sheet: &'a Sheet,
    /// Turbine and blade.
    owner: [usize; 2],
    /// Places of the first nodes of the strip further down and of that near the blade.
    first: [usize; 2],
    /// Distance of each node of the blade from its root over the blade's length (–).
    spans: Vec<f32>,
}

impl<'a> Graph<'a> {
    fn new(sheet: &'a Sheet, owner: [usize; 2], first: [usize; 2]) -> Self {
        let n_rows = sheet.near.n_rows();
        let line = if n_rows > 0 { sheet.near.row(n_rows - 1) } else { &[] };
        let from_root = |node: &Vector3| (*node - line[0]).length();
        let length = line.last().map_or(1.0, from_root).max(f64::MIN_POSITIVE);
        let spans = line.iter().map(|node| (from_root(node) / length) as f32).collect();
        Self { sheet, owner, first, spans }
    }

    fn add(&self, pieces: &mut Vec<Piece>) {
        let Sheet { near, far, .. } = self.sheet;
        let Some(newest) = near.n_rows().checked_sub(1) else { return };
        let kept = self.sheet.kept();
        let of_far = |row: usize, s: usize| self.first[0] + row * far.n_nodes() + s;
        let of_near = |row: usize, s: usize| self.first[1] + row * near.n_nodes() + s;
        for row in 0..far.n_rows() {
            // The youngest ring further down ends at the oldest row near the blade.
            let is_last = row + 1 == far.n_rows();
            let younger = |s: usize| if is_last { of_near(0, kept[s]) } else { of_far(row + 1, s) };
            let age = if is_last { near.ages[0] } else { far.ages[row + 1] };
            let span = |s: usize| self.spans[kept[s]];
            self.row(far, row, age, (younger, |s| of_far(row, s)), span, pieces);
        }
        for row in 0..newest {
            let age = near.ages[row + 1];
            let nodes = (|s| of_near(row + 1, s), |s| of_near(row, s));
            self.row(near, row, age, nodes, |s| self.spans[s], pieces);
        }
        if newest > 0 {
            let ends = |s: usize| [of_near(newest, s), of_near(newest, s + 1)];
            let span = |s: usize| 0.5 * (self.spans[s] + self.spans[s + 1]);
            let bound = (0..near.n_nodes() - 1)
                .map(|s| self.piece(PieceKind::Bound, ends(s), 0.0, span(s)));
            pieces.extend(bound);
        }
    }

    /// Adds the pieces from row number `row` of `strip` to the next, younger one of `younger_age` (s), then
    /// those along it; `nodes` gives the places of the younger row's nodes and of its own.
    fn row(
        &self,
        strip: &Strip,
        row: usize,
        younger_age: f64,
        nodes: (impl Fn(usize) -> usize, impl Fn(usize) -> usize),
        span: impl Fn(usize) -> f32,
        pieces: &mut Vec<Piece>,
    ) {
        let ((young, old), age) = (nodes, strip.ages[row]);
        let between = 0.5 * (age + younger_age);
        pieces.extend(
            (0..strip.n_nodes())
                .map(|s| self.piece(PieceKind::Trailing, [young(s), old(s)], between, span(s))),
        );
        pieces.extend((1..strip.n_nodes()).map(|s| {
            let middle = 0.5 * (span(s - 1) + span(s));
            self.piece(PieceKind::Shed, [old(s - 1), old(s)], age, middle)
        }));
    }

    /// Circulation and core are those of its segment, which the caller knows.
    fn piece(&self, kind: PieceKind, ends: [usize; 2], age: f64, span: f32) -> Piece {
        Piece {
            ends: ends.map(|end| end as u32),
            kind,
            turbine: self.owner[0] as u32,
            blade: self.owner[1] as u32,
            span,
            age: age as f32,
            circulation: 0.0,
            core_radius: 0.0,
        }
    }
}
