//! Segments of a blade's wake, made of its rings: trailing and spanwise filaments with their cores.

use super::segment::{Cores, Segment};
use super::strain::Life;
use basis::Vector3;

/// Core of a blade's bound vortex over the width of its elements (–): a bent blade is no straight line, and
/// its bound vortex is to have little effect on its own elements. What is left is that of the bend, some
/// 0.02 m/s on a blade of 117 m that bends by 4 m.
const BOUND_CORE: f64 = 0.5;

/// Squares of cores at birth (m²) on the bound vortex `line`.
pub(super) struct Births<'a> {
    line: &'a [Vector3],
    initial_widths: f64,
}

impl<'a> Births<'a> {
    pub(super) fn of(line: &'a [Vector3], cores: &Cores) -> Self {
        Self { line, initial_widths: cores.initial_widths }
    }

    /// Of what trails from node `s`, between elements whose mean width decides.
    pub(super) fn at(&self, s: usize) -> f64 {
        let (low, high) = (s.saturating_sub(1), (s + 1).min(self.line.len() - 1));
        let width = (self.line[high] - self.line[low]).length() / (high - low) as f64;
        (self.initial_widths * width).powi(2)
    }

    /// Of the bound vortex of element `s`.
    pub(super) fn bound(&self, s: usize) -> f64 {
        BOUND_CORE.powi(2) * (self.line[s + 1] - self.line[s]).length_squared()
    }
}

/// Segments as they are added.
pub(super) struct Filaments<'a> {
    pub(super) cores: &'a Cores,
    pub(super) segments: &'a mut Vec<Segment>,
}

impl Filaments<'_> {
    /// From the younger row, whose nodes are `young`, to the `old` one: what a ring has more than its outer
    /// neighbour. `ages` (s) are those of old and young, `gamma` the rings' circulations, `lives` those of
    /// the filaments.
    pub(super) fn trailing(
        &mut self,
        old: &[Vector3],
        young: impl Fn(usize) -> Vector3,
        ages: [f64; 2],
        gamma: impl Fn(usize) -> f64,
        born: impl Fn(usize) -> f64,
        lives: &[Life],
    ) {
        let (n, age) = (old.len() - 1, 0.5 * (ages[0] + ages[1]));
        let mut inner = 0.0;
        for (s, to) in old.iter().enumerate() {
            let outer = if s < n { gamma(s) } else { 0.0 };
            self.push([young(s), *to], inner - outer, born(s), age, &lives[s]);
            inner = outer;
        }
    }

    /// Along a `row` of `age` (s), from root to tip.
    pub(super) fn spanwise(
        &mut self,
        row: &[Vector3],
        age: f64,
        gamma: impl Fn(usize) -> f64,
        born: impl Fn(usize) -> f64,
        lives: &[Life],
    ) {
        for (s, ends) in row.windows(2).enumerate() {
            self.push([ends[0], ends[1]], gamma(s), born(s), age, &lives[s]);
        }
    }

    fn push(&mut self, ends: [Vector3; 2], circulation: f64, born: f64, age: f64, life: &Life) {
        let [from, to] = ends;
        let length = (to - from).length();
        let core_squared = self.cores.of(born, age, length, circulation, life);
        self.segments.push(Segment { from, to, circulation, core_squared });
    }
}
