//! Rows of nodes, and the vortex rings between them: oldest first.

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

    /// Adds a youngest row of `nodes` with their velocities at `age`, and `rings` between it and what comes
    /// next.
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
    }

    /// Removes the `n` oldest rows.
    pub(super) fn drop_oldest(&mut self, n: usize) {
        self.positions.drain(..n * self.n_nodes);
        self.velocities.drain(..n * self.n_nodes);
        self.ages.drain(..n);
        self.circulations.drain(..n * (self.n_nodes - 1));
    }

    /// Mean place of row number `row` along x (m).
    pub(super) fn place(&self, row: usize) -> f64 {
        self.row(row).iter().map(|node| node.x).sum::<f64>() / self.n_nodes as f64
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
