//! Rows of nodes, and the vortex rings between them: oldest first.

use super::strain::Life;
use basis::Vector3;

/// A strip of vortex rings: between each row and the next, younger one a ring between neighbouring nodes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Strip {
    n_nodes: usize,
    /// Nodes, row after row, farm frame (m).
    pub(super) positions: Vec<Vector3>,
    /// Velocities with which they last moved (m/s).
    pub(super) velocities: Vec<Vector3>,
    /// Time since each row left its blade (s).
    pub(super) ages: Vec<f64>,
    /// Circulation of the rings between a row and the next, younger one (m²/s): `n_nodes − 1` for each row.
    pub(super) circulations: Vec<f64>,
    /// Lengths of what trails from the nodes of each row to the next, younger one: `n_nodes` for each row.
    pub(super) trailing: Vec<Life>,
    /// Lengths of what lies along each row: `n_nodes − 1` for each.
    pub(super) spanwise: Vec<Life>,
}

impl Strip {
    /// An empty strip with memory for `n_rows` rows of `n_nodes` nodes.
    pub(super) fn with_capacity(n_nodes: usize, n_rows: usize) -> Self {
        Self {
            n_nodes,
            positions: Vec::with_capacity(n_rows * n_nodes),
            velocities: Vec::with_capacity(n_rows * n_nodes),
            ages: Vec::with_capacity(n_rows),
            circulations: Vec::with_capacity(n_rows * (n_nodes - 1)),
            trailing: Vec::with_capacity(n_rows * n_nodes),
            spanwise: Vec::with_capacity(n_rows * (n_nodes - 1)),
        }
    }

    /// Rows (–).
    pub(super) fn n_rows(&self) -> usize {
        self.ages.len()
    }

    /// Nodes of a row (–).
    pub(super) fn n_nodes(&self) -> usize {
        self.n_nodes
    }

    /// Nodes of row number `row`.
    pub(super) fn row(&self, row: usize) -> &[Vector3] {
        &self.positions[row * self.n_nodes..(row + 1) * self.n_nodes]
    }

    /// Rings between row number `row` and the next.
    pub(super) fn rings(&self, row: usize) -> &[f64] {
        let n = self.n_nodes - 1;
        &self.circulations[row * n..(row + 1) * n]
    }

    /// What trails from row number `row`.
    pub(super) fn trailing(&self, row: usize) -> &[Life] {
        &self.trailing[row * self.n_nodes..(row + 1) * self.n_nodes]
    }

    /// What lies along row number `row`.
    pub(super) fn spanwise(&self, row: usize) -> &[Life] {
        let n = self.n_nodes - 1;
        &self.spanwise[row * n..(row + 1) * n]
    }

    /// Adds a youngest row of `nodes` with their velocities at `age`, and `rings` between it and what comes
    /// next. What lies along it is born; what trails from it begins when it is [told](Self::begin_trailing).
    pub(super) fn push(
        &mut self,
        nodes: impl Iterator<Item = (Vector3, Vector3)>,
        age: f64,
        rings: impl Iterator<Item = f64>,
    ) {
        for (position, velocity) in nodes {
            self.positions.push(position);
            self.velocities.push(velocity);
        }
        self.ages.push(age);
        self.circulations.extend(rings);
        let row = &self.positions[self.positions.len() - self.n_nodes..];
        self.spanwise
            .extend(row.windows(2).map(|ends| Life::new((ends[1] - ends[0]).length(), 0.0)));
        self.trailing.resize(self.positions.len(), Life::default());
    }

    /// What trails from row number `row` to the next one begins, as old as its ends are on the mean.
    pub(super) fn begin_trailing(&mut self, row: usize) {
        let n = self.n_nodes;
        let age = 0.5 * (self.ages[row] + self.ages[row + 1]);
        for node in row * n..(row + 1) * n {
            let length = (self.positions[node + n] - self.positions[node]).length();
            self.trailing[node] = Life::new(length, age);
        }
    }

    /// All filaments live on for `duration` (s) where they are; `younger` gives where those that trail from
    /// the youngest row end.
    pub(super) fn live(&mut self, duration: f64, younger: Option<&dyn Fn(usize) -> Vector3>) {
        let n = self.n_nodes;
        for (node, from) in self.positions.iter().enumerate() {
            let to = match self.positions.get(node + n) {
                Some(to) => *to,
                None => match younger {
                    Some(younger) => younger(node % n),
                    None => continue,
                },
            };
            self.trailing[node].live((to - *from).length(), duration);
        }
        let rows = self.positions.chunks_exact(n).zip(self.spanwise.chunks_exact_mut(n - 1));
        for (row, lives) in rows {
            for (ends, life) in row.windows(2).zip(lives) {
                life.live((ends[1] - ends[0]).length(), duration);
            }
        }
    }

    /// Adds the middle of every filament that trails from a row to the next, younger one, where each is felt
    /// as [`to_nodes`](Self::to_nodes) says; those of the youngest row end at `younger`. Where nothing
    /// trails from it, its nodes themselves.
    pub(super) fn push_middles(
        &self,
        younger: Option<&dyn Fn(usize) -> Vector3>,
        middles: &mut Vec<Vector3>,
    ) {
        let n = self.n_nodes;
        middles.extend(self.positions.iter().enumerate().map(|(node, from)| {
            match (self.positions.get(node + n), younger) {
                (Some(to), _) => 0.5 * (*from + *to),
                (None, Some(younger)) => 0.5 * (*from + younger(node % n)),
                (None, None) => *from,
            }
        }));
    }

    /// Removes the `n` oldest rows.
    pub(super) fn drop_oldest(&mut self, n: usize) {
        self.positions.drain(..n * self.n_nodes);
        self.velocities.drain(..n * self.n_nodes);
        self.ages.drain(..n);
        self.circulations.drain(..n * (self.n_nodes - 1));
        self.trailing.drain(..n * self.n_nodes);
        self.spanwise.drain(..n * (self.n_nodes - 1));
    }

    /// Mean place of row number `row` along x (m).
    pub(super) fn place(&self, row: usize) -> f64 {
        self.row(row).iter().map(|node| node.x).sum::<f64>() / self.n_nodes as f64
    }

    /// On return `values`, which held something in the middle of what trails from each node, hold the mean of
    /// what trails from it and what ends there, from row number `first` back to the second oldest; other rows
    /// keep theirs.
    ///
    /// A node lies outside of the arc that its chords stand for: as at the corner of a prism with the angle
    /// π − θ whose sides are vortex sheets, it is carried with the share (π − θ)/2π of what the wind jumps by
    /// across them in place of a half, and feels nothing of its own filament's bend. In the middle of a chord
    /// the share is right, and the bend is felt from a quarter of a chord on. θ is the turn from chord to
    /// chord.
    ///
    /// Limits: a strain of the air acts on a wave of m chords with the share cos² π/m. The oldest row, and
    /// the oldest nodes near the blade that are not kept further down, take what trails from them alone.
    pub(super) fn to_nodes(&self, first: usize, values: &mut [Vector3]) {
        let n = self.n_nodes;
        for node in (n..(first + 1) * n).rev() {
            values[node] = 0.5 * (values[node] + values[node - n]);
        }
    }

    /// Moves every node on by `interval` (s): `velocities` (m/s) hold that of each now. Second order after
    /// Adams and Bashforth; a row's first step is Euler's.
    pub(super) fn advance(&mut self, interval: f64, velocities: &[Vector3]) {
        for (row, age) in self.ages.iter_mut().enumerate() {
            let nodes = row * self.n_nodes..(row + 1) * self.n_nodes;
            let [now, before] = if *age == 0.0 { [1.0, 0.0] } else { [1.5, -0.5] };
            let moved =
                self.positions[nodes.clone()].iter_mut().zip(&mut self.velocities[nodes.clone()]);
            for ((position, last), velocity) in moved.zip(&velocities[nodes]) {
                *position += interval * (now * *velocity + before * *last);
                *last = *velocity;
            }
            *age += interval;
        }
    }
}
