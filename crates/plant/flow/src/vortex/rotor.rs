//! The lifting lines of one turbine, as its forces tell of them.

use super::segment::{Cores, Segment};
use super::sheet::Sheet;
use crate::pool::Pool;
use basis::{Answer, PointForce, Vector3};

/// The lifting lines of one turbine, and how the wind at them answers to their circulation.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rotor {
    turbine: usize,
    /// Elements of each blade (–).
    n_elements: Vec<usize>,
    /// Circulation of every element (m²/s), blade after blade.
    pub(super) circulations: Vec<f64>,
    /// Middles of the elements now (m).
    pub(super) stations: Vec<Vector3>,
    /// Ends of the elements now, neighbours' ends joined: one more on every blade (m).
    pub(super) nodes: Vec<Vector3>,
    /// The same at the end of the step.
    stations_after: Vec<Vector3>,
    nodes_after: Vec<Vector3>,
    /// The youngest ring of every element, of unit circulation.
    rings: Vec<Option<[Segment; 4]>>,
    /// Wind at an element (row) per unit of circulation of another (column) (1/m).
    influence: Vec<Vector3>,
    answers: bool,
    /// What the wake of its nacelle brings about where that stands (m/s).
    pub(super) at_nacelle: Vector3,
}

impl Rotor {
    /// Those of all turbines with bound vortices among `forces`, whose elements come blade after blade.
    pub(super) fn all_of(forces: &[PointForce]) -> Vec<Self> {
        let mut found: Vec<(usize, Vec<usize>)> = Vec::new();
        for force in forces {
            let Some(bound) = &force.bound else { continue };
            if found.last().is_none_or(|(turbine, _)| *turbine != force.turbine) {
                found.push((force.turbine, Vec::new()));
            }
            if let Some((_, n_elements)) = found.last_mut() {
                n_elements.resize(bound.blade + 1, 0);
                n_elements[bound.blade] += 1;
            }
        }
        found.into_iter().map(|(turbine, n_elements)| Self::of(turbine, n_elements)).collect()
    }

    /// That of `turbine`, `n_elements` on each blade, which has no circulation yet.
    pub(super) fn of(turbine: usize, n_elements: Vec<usize>) -> Self {
        let n: usize = n_elements.iter().sum();
        let n_nodes = n + n_elements.len();
        Self {
            turbine,
            n_elements,
            circulations: vec![0.0; n],
            stations: vec![Vector3::ZERO; n],
            nodes: vec![Vector3::ZERO; n_nodes],
            stations_after: vec![Vector3::ZERO; n],
            nodes_after: vec![Vector3::ZERO; n_nodes],
            rings: Vec::with_capacity(n),
            influence: vec![Vector3::ZERO; n * n],
            answers: false,
            at_nacelle: Vector3::ZERO,
        }
    }

    /// Its place among the farm's machines.
    pub(super) fn turbine(&self) -> usize {
        self.turbine
    }

    /// Mean height of its elements (m): that of its hub, but for how blades bend.
    pub(super) fn height(&self) -> f64 {
        self.middle().z
    }

    /// Elements of each blade (–).
    pub(super) fn blades(&self) -> impl Iterator<Item = usize> + '_ {
        self.n_elements.iter().copied()
    }

    /// Takes circulations and places of its elements from `forces`.
    pub(super) fn read(&mut self, forces: &[PointForce]) {
        self.nodes.fill(Vector3::ZERO);
        self.nodes_after.fill(Vector3::ZERO);
        let mine = forces.iter().filter(|force| force.turbine == self.turbine);
        let bound = mine.filter_map(|force| force.bound.map(|bound| (force.position, bound)));
        for (index, (position, bound)) in bound.enumerate() {
            self.circulations[index] = bound.circulation;
            self.stations[index] = position;
            self.stations_after[index] = bound.position_after;
            let last = bound.station + 1 == self.n_elements[bound.blade];
            let node = index + bound.blade;
            let ends = [
                (&mut self.nodes, position, bound.along),
                (&mut self.nodes_after, bound.position_after, bound.along_after),
            ];
            for (nodes, middle, along) in ends {
                // Neighbours' ends meet half-way.
                let share = if bound.station == 0 { 1.0 } else { 0.5 };
                nodes[node] += share * (middle - bound.inner_share * along);
                let share = if last { 1.0 } else { 0.5 };
                nodes[node + 1] += share * (middle + (1.0 - bound.inner_share) * along);
            }
        }
    }

    /// Middle of its elements (m): near the hub.
    pub(super) fn middle(&self) -> Vector3 {
        self.stations.iter().copied().sum::<Vector3>() / self.stations.len() as f64
    }

    /// Angle (rad) by which the blade turns in the step that turns most, from root to tip.
    pub(super) fn turn(&self) -> f64 {
        let way = |nodes: &[Vector3], first: usize, n: usize| nodes[first + n] - nodes[first];
        let mut first = 0;
        let of_blade = |n: &usize| {
            let turned =
                way(&self.nodes, first, *n).angle_between(way(&self.nodes_after, first, *n));
            first += n + 1;
            turned
        };
        self.n_elements.iter().map(of_blade).fold(0.0, f64::max)
    }

    /// From now on its elements stand where they are at the end of the step.
    pub(super) fn move_on(&mut self) {
        self.stations.copy_from_slice(&self.stations_after);
        self.nodes.copy_from_slice(&self.nodes_after);
    }

    fn first_element(&self, blade: usize) -> usize {
        self.n_elements[..blade].iter().sum()
    }

    /// Circulations of `blade`'s elements (m²/s).
    pub(super) fn circulations_of(&self, blade: usize) -> &[f64] {
        let first = self.first_element(blade);
        &self.circulations[first..first + self.n_elements[blade]]
    }

    /// Ends of `blade`'s elements.
    pub(super) fn line_of(&self, blade: usize) -> &[Vector3] {
        let first = self.first_element(blade) + blade;
        &self.nodes[first..first + self.n_elements[blade] + 1]
    }

    /// On return it knows what the youngest rings of its blades' `sheets` do to its elements. Images below
    /// the ground are too far away to matter within a step.
    pub(super) fn feel_rings<'a>(
        &mut self,
        sheets: impl Iterator<Item = &'a Sheet>,
        cores: &Cores,
        pool: &mut Pool,
    ) {
        let n = self.stations.len();
        self.rings.clear();
        for sheet in sheets {
            self.rings.extend((0..sheet.n_elements()).map(|s| sheet.youngest_ring(cores, s)));
        }
        self.answers = self.rings.len() == n && self.rings.iter().all(Option::is_some);
        let mut influence = std::mem::take(&mut self.influence);
        let Self { stations, rings, .. } = &*self;
        pool.for_chunks(&mut influence, n, &|first, row| {
            let station = stations[first / n];
            for (velocity, ring) in row.iter_mut().zip(rings) {
                let sides = ring.iter().flatten();
                *velocity = sides.map(|side| side.per_circulation(station)).sum();
            }
        });
        self.influence = influence;
    }

    /// How its wind answers; none before it has a wake.
    pub(super) fn answer(&self) -> Option<Answer<'_>> {
        let Self { circulations, influence, answers, at_nacelle, .. } = self;
        answers.then_some(Answer { circulations, influence, at_nacelle: *at_nacelle })
    }
}
