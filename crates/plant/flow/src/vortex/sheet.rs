//! The wake of one blade: a strip of rings as fine as its elements, which becomes coarser further down.

use super::ending::left_at;
use super::filaments::{Births, Filaments};
use super::segment::{Cores, Segment};
use super::strain::Life;
use super::strip::Strip;
use basis::Vector3;

/// Most that a ring has of the mean circulation of those which it stands for, and the inverse of the least
/// (–).
const MOST_OF_MEAN: f64 = 1.4;

/// How the wakes of blades are resolved, and where they end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Rows behind the blade that are as fine as steps and elements (–).
    pub near_rows: usize,
    /// Steps from row to row further down (–).
    pub far_stride: usize,
    /// Trailing vortices of a blade further down (–).
    pub far_filaments: usize,
    /// Length of the wake along x behind its blade (m); its last part fades.
    pub length: f64,
    /// Where wakes that would be longer end, along x (m, farm frame); infinite where nothing ends them.
    pub end: f64,
    /// Most rows further down (–); the oldest ones end beyond.
    pub far_rows: usize,
}

impl Resolution {
    /// Length of the wake of a blade that stands at `place` along x (m).
    pub fn length_behind(&self, place: f64) -> f64 {
        self.length.min(self.end - place)
    }
}

/// The wake of one blade, its youngest row the blade's bound vortex itself.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sheet {
    /// Turbine and blade that it belongs to.
    pub(super) owner: [usize; 2],
    pub(super) near: Strip,
    /// Its youngest rings end at the oldest row of `near`.
    pub(super) far: Strip,
    /// Nodes of `near` that `far` keeps.
    kept: Vec<usize>,
    resolution: Resolution,
}

impl Sheet {
    /// Nothing yet, behind blade `owner` (turbine, blade) of `n_elements`.
    pub(super) fn new(owner: [usize; 2], n_elements: usize, resolution: Resolution) -> Self {
        let n_kept = resolution.far_filaments.clamp(2, n_elements + 1) - 1;
        let kept: Vec<usize> =
            (0..=n_kept).map(|k| (2 * k * n_elements + n_kept) / (2 * n_kept)).collect();
        let near_rows = resolution.near_rows + resolution.far_stride + 2;
        Self {
            owner,
            near: Strip::with_capacity(n_elements + 1, near_rows),
            far: Strip::with_capacity(kept.len(), resolution.far_rows + 1),
            kept,
            resolution,
        }
    }

    /// Nodes of the strip near the blade that the one further down keeps.
    pub(super) fn kept(&self) -> &[usize] {
        &self.kept
    }

    /// Steps from row to row further down (–).
    pub(super) fn far_stride(&self) -> usize {
        self.resolution.far_stride
    }

    /// Elements of its blade (–).
    pub(super) fn n_elements(&self) -> usize {
        self.near.n_nodes() - 1
    }

    /// Most segments (–) that the wakes of `n_blades` blades of `n_elements` can have at `resolution`, with
    /// `far_rows` rows further down in all.
    pub(super) fn most_segments(
        n_blades: usize,
        n_elements: usize,
        resolution: &Resolution,
        far_rows: usize,
    ) -> usize {
        let of_row = |n_nodes: usize| 2 * n_nodes - 1;
        let near_rows = n_blades * (resolution.near_rows + resolution.far_stride + 1);
        near_rows * of_row(n_elements + 1)
            + (far_rows + n_blades) * of_row(resolution.far_filaments.min(n_elements + 1))
    }

    /// The bound vortex now has the nodes of `line`, and rings of `circulations` (m²/s) leave it. The rings
    /// of what was the youngest row before end here.
    pub(super) fn place_line(&mut self, line: &[Vector3], circulations: &[f64]) {
        let at_rest = line.iter().map(|node| (*node, Vector3::ZERO));
        self.near.push(at_rest, 0.0, circulations.iter().copied());
        if self.near.n_rows() > 1 {
            let row = self.near.n_rows() - 2;
            self.leave(row, circulations);
            self.near.begin_trailing(row);
        }
        if self.near.n_rows() > self.resolution.near_rows + self.resolution.far_stride {
            self.coarsen();
        }
        self.shorten();
    }

    /// The rings that leave the blade in this step have `circulations` (m²/s).
    pub(super) fn release(&mut self, circulations: &[f64]) {
        if let Some(row) = self.near.n_rows().checked_sub(2) {
            self.leave(row, circulations);
        }
    }

    fn leave(&mut self, row: usize, circulations: &[f64]) {
        let n = circulations.len();
        self.near.circulations[row * n..(row + 1) * n].copy_from_slice(circulations);
    }

    /// Makes one row further down of the oldest rows near the blade. A ring has as much circulation times
    /// vector area as those that it stands for, so that the impulse of the wake stays although chords cut
    /// arcs short and sheets roll up.
    fn coarsen(&mut self) {
        let Self { near, far, kept, resolution, .. } = self;
        let stride = resolution.far_stride;
        let area = |rows: [usize; 2], nodes: [usize; 2]| {
            let [old, young] = rows.map(|row| near.row(row));
            let diagonals = [young[nodes[1]] - old[nodes[0]], young[nodes[0]] - old[nodes[1]]];
            0.5 * diagonals[0].cross(diagonals[1])
        };
        let ring = |pair: &[usize]| {
            let (mut impulse, mut circulation, mut areas) = (Vector3::ZERO, 0.0, 0.0);
            for row in 0..stride {
                for s in pair[0]..pair[1] {
                    let of_ring = area([row, row + 1], [s, s + 1]);
                    impulse += of_ring * near.rings(row)[s];
                    circulation += of_ring.length() * near.rings(row)[s];
                    areas += of_ring.length();
                }
            }
            let own = area([0, stride], [pair[0], pair[1]]);
            let mean = if areas > 0.0 { circulation / areas } else { 0.0 };
            // A folded ring has no area to speak of: there the mean has to do.
            let (few, many) = (mean / MOST_OF_MEAN, mean * MOST_OF_MEAN);
            let found = impulse.dot(own) / own.length_squared();
            if found.is_finite() { found.clamp(few.min(many), few.max(many)) } else { mean }
        };
        let nodes = kept.iter().map(|&s| (near.positions[s], near.velocities[s]));
        far.push(nodes, near.ages[0], kept.windows(2).map(ring));
        self.join_lives();
        self.near.drop_oldest(stride);
    }

    /// On return what lies along the youngest row further down and trails from it has the lives of what it
    /// stands for: the rows near the blade up to the next one that stays.
    fn join_lives(&mut self) {
        let Self { near, far, kept, resolution, .. } = self;
        let stride = resolution.far_stride;
        let last = far.n_rows() - 1;
        let between = |from: Vector3, to: Vector3| (to - from).length();
        for (k, &s) in kept.iter().enumerate() {
            let (mut life, mut lengths) = (Life::default(), 0.0);
            for row in 0..stride {
                life += near.trailing(row)[s];
                lengths += between(near.row(row)[s], near.row(row + 1)[s]);
            }
            let length = between(near.row(0)[s], near.row(stride)[s]);
            far.trailing[last * kept.len() + k] = life.joined(lengths, length);
        }
        for (k, pair) in kept.windows(2).enumerate() {
            let (mut life, mut lengths) = (Life::default(), 0.0);
            for s in pair[0]..pair[1] {
                life += near.spanwise(0)[s];
                lengths += between(near.row(0)[s], near.row(0)[s + 1]);
            }
            let length = between(near.row(0)[pair[0]], near.row(0)[pair[1]]);
            far.spanwise[last * (kept.len() - 1) + k] = life.joined(lengths, length);
        }
    }

    /// Adds the places at which vortices carry its nodes, those of the strip further down first: as many as
    /// there are nodes.
    pub(super) fn push_middles(&self, middles: &mut Vec<Vector3>) {
        let Self { near, far, kept, .. } = self;
        if near.n_rows() > 0 {
            far.push_middles(Some(&|k| near.row(0)[kept[k]]), middles);
        }
        near.push_middles(None, middles);
    }

    /// On return `velocities` (m/s), which held those at its [places](Self::push_middles), hold those with
    /// which vortices carry its nodes.
    pub(super) fn to_nodes(&self, velocities: &mut [Vector3]) {
        let Self { near, far, kept, resolution, .. } = self;
        let (of_far, of_near) = velocities.split_at_mut(far.positions.len());
        // Nothing trails from the blade yet: its own nodes are carried by what is there.
        let Some(trailing) = near.n_rows().checked_sub(2) else { return };
        near.to_nodes(trailing, of_near);
        let Some(last) = far.n_rows().checked_sub(1) else { return };
        // What ends at the oldest row near the blade is longer than what trails from it.
        let share = 1.0 / (1.0 + resolution.far_stride as f64);
        for (from, &s) in of_far[last * kept.len()..].iter().zip(kept) {
            of_near[s] += share * (*from - of_near[s]);
        }
        far.to_nodes(last, of_far);
    }

    /// All filaments live on for `duration` (s) where they are.
    pub(super) fn live(&mut self, duration: f64) {
        let Self { near, far, kept, .. } = self;
        if near.n_rows() > 0 {
            far.live(duration, Some(&|k| near.row(0)[kept[k]]));
        }
        near.live(duration, None);
    }

    /// Drops rows that lie beyond the wake's length.
    fn shorten(&mut self) {
        let line = self.near.place(self.near.n_rows() - 1);
        let end = line + self.resolution.length_behind(line);
        let beyond = |strip: &Strip, rows: usize| {
            (0..rows).take_while(|&row| strip.place(row) > end).count()
        };
        // A row stays as long as the next one is within reach: a ring fades before it goes.
        let n_far = self.far.n_rows();
        let n = beyond(&self.far, n_far)
            .saturating_sub(1)
            .max(n_far.saturating_sub(self.resolution.far_rows));
        self.far.drop_oldest(n);
        if self.far.n_rows() == 0 {
            let rows = self.near.n_rows().saturating_sub(2);
            let n = beyond(&self.near, rows).saturating_sub(1);
            self.near.drop_oldest(n);
        }
    }

    /// What of the circulation of rings between two places along x (m) is left where the wake fades (–).
    fn share(&self, places: [f64; 2], line: f64) -> f64 {
        let way = 0.5 * (places[0] + places[1]) - line;
        left_at(way / self.resolution.length_behind(line))
    }

    /// Adds the segments of all rings to `segments`, neighbours joined.
    pub(super) fn push_segments(&self, cores: &Cores, segments: &mut Vec<Segment>) {
        let Some(newest) = self.near.n_rows().checked_sub(1) else { return };
        let line = self.near.place(newest);
        let births = Births::of(self.near.row(newest), cores);
        let mut filaments = Filaments { cores, segments };
        let share = self.push_far(line, &births, &mut filaments);
        self.push_near(line, &births, share, &mut filaments);
    }

    /// Adds those of the rings further down; gives what is left of the youngest of them (–).
    fn push_far(&self, line: f64, births: &Births, filaments: &mut Filaments) -> f64 {
        let Self { near, far, kept, .. } = self;
        let born = |s: usize| births.at(kept[s]);
        let mut older_share = 0.0;
        for row in 0..far.n_rows() {
            let is_last = row + 1 == far.n_rows();
            let young = if is_last { near.row(0) } else { far.row(row + 1) };
            let node = |s: usize| young[if is_last { kept[s] } else { s }];
            let (age, place) = match is_last {
                true => (near.ages[0], near.place(0)),
                false => (far.ages[row + 1], far.place(row + 1)),
            };
            let share = self.share([far.place(row), place], line);
            let (old, rings) = (far.row(row), far.rings(row));
            let older = &far.circulations[row.saturating_sub(1) * rings.len()..];
            let ages = [far.ages[row], age];
            filaments.trailing(old, node, ages, |s| share * rings[s], born, far.trailing(row));
            let excess = |s: usize| older_share * older[s] - share * rings[s];
            let core = |s: usize| 0.5 * (born(s) + born(s + 1));
            filaments.spanwise(old, far.ages[row], excess, core, far.spanwise(row));
            older_share = share;
        }
        older_share
    }

    /// Adds those of the rings near the blade, behind which rings are left with `older_share` (–).
    fn push_near(
        &self,
        line: f64,
        births: &Births,
        mut older_share: f64,
        filaments: &mut Filaments,
    ) {
        let Self { near, far, kept, .. } = self;
        let newest = near.n_rows() - 1;
        let born = |s: usize| births.at(s);
        for row in 0..newest {
            let share = self.share([near.place(row), near.place(row + 1)], line);
            let (old, young, rings) = (near.row(row), near.row(row + 1), near.rings(row));
            let ages = [near.ages[row], near.ages[row + 1]];
            let lives = near.trailing(row);
            filaments.trailing(old, |s| young[s], ages, |s| share * rings[s], born, lives);
            let older = |s: usize| match (row, far.n_rows()) {
                (0, 0) => 0.0,
                (0, n) => far.rings(n - 1)[kept.partition_point(|&k| k <= s) - 1],
                _ => near.rings(row - 1)[s],
            };
            let excess = |s: usize| older_share * older(s) - share * rings[s];
            let core = |s: usize| 0.5 * (born(s) + born(s + 1));
            filaments.spanwise(old, near.ages[row], excess, core, near.spanwise(row));
            older_share = share;
        }
        if let Some(last) = newest.checked_sub(1) {
            let bound = |s: usize| older_share * near.rings(last)[s];
            let (line, lives) = (near.row(newest), near.spanwise(newest));
            filaments.spanwise(line, 0.0, bound, |s| births.bound(s), lives);
        }
    }

    /// The four sides of the youngest ring of element number `s`, of unit circulation; none as long as the
    /// blade has left nothing.
    pub(super) fn youngest_ring(&self, cores: &Cores, s: usize) -> Option<[Segment; 4]> {
        let near = &self.near;
        let newest = near.n_rows().checked_sub(2)? + 1;
        let (old, young) = (near.row(newest - 1), near.row(newest));
        let births = Births::of(young, cores);
        let gamma = near.rings(newest - 1)[s];
        let age = near.ages[newest - 1];
        let side = |from: Vector3, to: Vector3, born: f64, age: f64, life: &Life| {
            let core_squared = cores.of(born, age, (to - from).length(), gamma, life);
            Segment { from, to, circulation: 1.0, core_squared }
        };
        let spanwise = 0.5 * (births.at(s) + births.at(s + 1));
        let (bound, shed) = (near.spanwise(newest), near.spanwise(newest - 1));
        let trailing = near.trailing(newest - 1);
        Some([
            side(young[s], young[s + 1], births.bound(s), 0.0, &bound[s]),
            side(young[s + 1], old[s + 1], births.at(s + 1), 0.5 * age, &trailing[s + 1]),
            side(old[s + 1], old[s], spanwise, age, &shed[s]),
            side(old[s], young[s], births.at(s), 0.5 * age, &trailing[s]),
        ])
    }
}

#[cfg(test)]
mod tests;
