//! From point forces to forces on cells: Gaussian weights that keep total force and moment.
//!
//! A point force is spread with the separable Gaussian of its smearing length ε, one factor per axis, over
//! the cells whose centres lie within [`REACH`] ε. Cutting the tail, sampling at cell centres and a nearby
//! wall all spoil sum and first moment of the weights, so each factor wᵢ = exp(−(xᵢ − x)²/ε²) becomes wᵢ (a +
//! b (xᵢ − x)), with a and b such that Σ wᵢ = 1 and Σ wᵢ xᵢ = x. The products of such factors conserve force
//! and moment exactly.

use super::cell_box::CellBox;
use super::forces::ForceBlock;
use super::scaling::Scaling;
use basis::PointForce;
use std::ops::Range;

/// Where the Gaussian is cut, in smearing lengths (–): the weight there is 1.2e-4 of the peak.
pub const REACH: f64 = 3.0;

/// Spreads point forces over boxes of cells; keeps its storage from step to step.
#[derive(Clone, Debug)]
pub struct Spreader {
    scaling: Scaling,
    n_cells: [usize; 3],
    /// Levels along z whose cells are filled.
    levels: Range<usize>,
    blocks: Vec<ForceBlock>,
    /// Cells that each point reaches.
    reaches: Vec<CellBox>,
    /// Disjoint boxes around all reaches.
    boxes: Vec<CellBox>,
    weights: [Vec<f64>; 3],
    row: [Vec<f32>; 3],
}

impl Spreader {
    /// A spreader onto the `n_cells` cells (along x, y, z) of the lattice that `scaling` describes.
    pub fn new(scaling: Scaling, n_cells: [usize; 3]) -> Self {
        Self {
            scaling,
            n_cells,
            levels: 0..n_cells[2],
            blocks: Vec::new(),
            reaches: Vec::new(),
            boxes: Vec::new(),
            weights: Default::default(),
            row: Default::default(),
        }
    }

    /// The same spreader, filling only cells on `levels` along z, with the values that they have without
    /// this: so that threads share the work.
    pub fn on_levels(mut self, levels: Range<usize>) -> Self {
        self.levels = levels;
        self
    }

    /// Boxes of cells, none overlapping another, that carry `forces` in lattice units.
    ///
    /// Points whose reaches overlap share a box. Near a wall the weights stay inside the domain; a point
    /// outside the domain by more than its reach carries nothing. The result depends on the order of `forces`
    /// only by rounding, and the same `forces` give the same bits.
    pub fn spread(&mut self, forces: &[PointForce]) -> &[ForceBlock] {
        self.reaches.clear();
        for point in forces {
            self.reaches.push(self.reach(point));
        }
        self.group();
        // Blocks beyond those in use keep their storage for a step that needs more of them.
        self.blocks.resize_with(self.blocks.len().max(self.boxes.len()), ForceBlock::default);
        for (block, CellBox { low, high }) in self.blocks.iter_mut().zip(&self.boxes) {
            block.reset(*low, std::array::from_fn(|axis| high[axis] - low[axis]));
        }
        for (index, point) in forces.iter().enumerate() {
            let reach = self.reaches[index];
            let filled = self.filled(&reach);
            if !filled.is_empty()
                && let Some(block) = self.boxes.iter().position(|b| b.overlaps(&filled))
            {
                self.add(point, reach, block);
            }
        }
        &self.blocks[..self.boxes.len()]
    }

    /// Cells whose centres lie within [`REACH`] smearing lengths of `point`, and never fewer than the two
    /// around it.
    fn reach(&self, point: &PointForce) -> CellBox {
        let centre = self.scaling.to_lattice_position(point.position);
        let radius = (REACH * self.scaling.to_lattice_length(point.smearing_length)).max(1.0);
        let n = self.n_cells.map(|n| n as f64);
        // The casts saturate: a point far outside, or one that is not a number, reaches no cell.
        CellBox {
            low: std::array::from_fn(|axis| {
                (centre[axis] - radius).ceil().clamp(0.0, n[axis]) as usize
            }),
            high: std::array::from_fn(|axis| {
                ((centre[axis] + radius).floor() + 1.0).clamp(0.0, n[axis]) as usize
            }),
        }
    }

    /// The boxes of the last [`Spreader::spread`]; none before the first.
    pub fn blocks(&self) -> &[ForceBlock] {
        &self.blocks[..self.boxes.len()]
    }

    /// The part of `reach` that lies on this spreader's levels.
    fn filled(&self, reach: &CellBox) -> CellBox {
        let mut filled = *reach;
        filled.low[2] = filled.low[2].max(self.levels.start);
        filled.high[2] = filled.high[2].min(self.levels.end);
        filled
    }

    /// On return `boxes` holds disjoint boxes that cover every reach.
    fn group(&mut self) {
        self.boxes.clear();
        for index in 0..self.reaches.len() {
            let mut joined = self.filled(&self.reaches[index]);
            if joined.is_empty() {
                continue;
            }
            // Growing may touch boxes that the reach alone did not: look again until none is left.
            while let Some(index) = self.boxes.iter().position(|b| b.overlaps(&joined)) {
                joined = joined.join(&self.boxes.remove(index));
            }
            self.boxes.push(joined);
        }
    }

    fn add(&mut self, point: &PointForce, reach: CellBox, block: usize) {
        let centre = self.scaling.to_lattice_position(point.position);
        let width = self.scaling.to_lattice_length(point.smearing_length);
        for (axis, weights) in self.weights.iter_mut().enumerate() {
            let offset = reach.low[axis] as f64 - centre[axis];
            axis_weights(offset, width, reach.high[axis] - reach.low[axis], weights);
        }
        let force = self.scaling.to_lattice_force(point.force);
        for (row, component) in self.row.iter_mut().zip(force.to_array()) {
            row.clear();
            row.extend(self.weights[0].iter().map(|weight| (weight * component) as f32));
        }
        let ForceBlock { origin, size, force: cells } = &mut self.blocks[block];
        let x = reach.low[0] - origin[0];
        let n = self.weights[0].len();
        for (level, weight_z) in (reach.low[2]..).zip(&self.weights[2]) {
            if !self.levels.contains(&level) {
                continue;
            }
            let z = level - origin[2];
            for (j, weight_y) in self.weights[1].iter().enumerate() {
                let y = reach.low[1] - origin[1] + j;
                let weight = (weight_z * weight_y) as f32;
                let first = x + size[0] * (y + size[1] * z);
                for (component, row) in cells.iter_mut().zip(&self.row) {
                    for (cell, value) in component[first..first + n].iter_mut().zip(row) {
                        *cell += weight * value;
                    }
                }
            }
        }
    }
}

/// Writes into `weights` those of `n` cells, the first `offset` cells from the point, for a Gaussian `width`
/// cells wide.
///
/// On return they sum to one and their first moment about the point is zero, unless fewer than two cells are
/// reached.
fn axis_weights(offset: f64, width: f64, n: usize, weights: &mut Vec<f64>) {
    weights.clear();
    let inverse_width = 1.0 / width;
    let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
    for i in 0..n {
        let distance = offset + i as f64;
        let scaled = distance * inverse_width;
        let weight = (-scaled * scaled).exp();
        weights.push(weight);
        sum += weight;
        first += weight * distance;
        second += weight * distance * distance;
    }
    let determinant = sum * second - first * first;
    if determinant > 1e-6 * sum * sum {
        let (constant, slope) = (second / determinant, -first / determinant);
        for (i, weight) in weights.iter_mut().enumerate() {
            *weight *= constant + slope * (offset + i as f64);
        }
    } else {
        // All weight sits on one cell: too narrow a Gaussian; split it linearly over the two nearest cells.
        let lower = (-offset).floor().clamp(0.0, n.saturating_sub(2) as f64) as usize;
        let share = -offset - lower as f64;
        for (i, weight) in weights.iter_mut().enumerate() {
            *weight = match i {
                _ if n < 2 => 1.0,
                _ if i == lower => 1.0 - share,
                _ if i == lower + 1 => share,
                _ => 0.0,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::Vector3;
    use proptest::prelude::*;

    const SPACING: f64 = 10.0;

    fn scaling() -> Scaling {
        Scaling::new(Vector3::new(-100.0, -200.0, 0.0), SPACING, 0.1, 1.2)
    }

    fn spreader() -> Spreader {
        Spreader::new(scaling(), [64, 40, 48])
    }

    /// Total force (N) and moment (N m) about the origin of what lies on the cells.
    fn totals(blocks: &[ForceBlock]) -> (Vector3, Vector3) {
        let (mut total, mut moment) = (Vector3::ZERO, Vector3::ZERO);
        for block in blocks {
            for (index, position) in centres(block).enumerate() {
                let force = [0, 1, 2].map(|c: usize| f64::from(block.force[c][index]));
                let force = scaling().to_si_force(Vector3::from_array(force));
                total += force;
                moment += position.cross(force);
            }
        }
        (total, moment)
    }

    fn centres(block: &ForceBlock) -> impl Iterator<Item = Vector3> {
        let (start, n) = (block.origin, block.size);
        (0..n[0] * n[1] * n[2]).map(move |index| {
            let cell = [index % n[0], index / n[0] % n[1], index / n[0] / n[1]];
            scaling().to_si_position(Vector3::from_array(std::array::from_fn(|a| {
                (start[a] + cell[a]) as f64
            })))
        })
    }

    fn point(x: f64, y: f64, z: f64, smearing_length: f64, force: Vector3) -> PointForce {
        PointForce::of_body(Vector3::new(x, y, z), force, smearing_length)
    }

    prop_compose! {
        /// Anywhere at least a cell inside the domain, walls included.
        fn any_point()(
            x in -85.0..520.0_f64, y in -185.0..185.0_f64, z in 15.0..465.0_f64, width in 0.02..4.0_f64,
            force in (-1e3..1e3_f64, -1e3..1e3_f64, -1e3..1e3_f64),
        ) -> PointForce {
            point(x, y, z, width * SPACING, Vector3::new(force.0, force.1, force.2))
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn spreading_keeps_force_and_moment(points in prop::collection::vec(any_point(), 1..12)) {
            let mut spreader = spreader();
            let (total, moment) = totals(spreader.spread(&points));
            let expected: Vector3 = points.iter().map(|p| p.force).sum();
            let expected_moment: Vector3 = points.iter().map(|p| p.position.cross(p.force)).sum();
            let scale: f64 = points.iter().map(|p| p.force.length()).sum();
            // f32 cells: a few units in the last place of the largest terms, times a lever of the domain's
            // size.
            prop_assert!((total - expected).length() < 3e-6 * scale);
            prop_assert!((moment - expected_moment).length() < 3e-6 * scale * 600.0);
        }

        #[test]
        fn boxes_never_overlap(points in prop::collection::vec(any_point(), 1..12)) {
            let mut spreader = spreader();
            spreader.spread(&points);
            for (index, first) in spreader.boxes.iter().enumerate() {
                for second in &spreader.boxes[index + 1..] {
                    prop_assert!(!first.overlaps(second));
                }
            }
        }
    }

    #[test]
    fn weights_conserve_to_rounding_even_at_a_wall() {
        let mut weights = Vec::new();
        for (offset, width, n) in
            [(-6.3, 2.0, 13), (0.5, 2.0, 7), (-0.1, 1.0, 4), (-0.4, 0.05, 2), (-6.0, 2.0, 7)]
        {
            axis_weights(offset, width, n, &mut weights);
            let sum: f64 = weights.iter().sum();
            let first: f64 = weights.iter().enumerate().map(|(i, w)| w * (offset + i as f64)).sum();
            assert!((sum - 1.0).abs() < 1e-13, "sum {sum} at offset {offset}");
            assert!(first.abs() < 1e-12, "first moment {first} at offset {offset}");
        }
    }

    #[test]
    fn far_from_walls_the_density_is_the_gaussian() {
        let force = Vector3::new(100.0, 0.0, 0.0);
        let at = point(203.0, 4.0, 247.0, 20.0, force);
        let mut spreader = spreader();
        let blocks = spreader.spread(&[at]);
        let peak = 100.0 * SPACING.powi(3) / (20.0_f64.powi(3) * std::f64::consts::PI.powf(1.5));
        let peak = scaling().to_lattice_force(Vector3::X * peak).x;
        for (index, centre) in centres(&blocks[0]).enumerate() {
            let exact = peak * (-(centre - at.position).length_squared() / 400.0).exp();
            assert!((f64::from(blocks[0].force[0][index]) - exact).abs() < 1e-3 * peak);
        }
    }

    #[test]
    fn storage_is_reused_and_the_bits_repeat() {
        let points: Vec<_> = (0..40)
            .map(|i| {
                point(200.0, 0.0, 100.0 + 5.0 * f64::from(i), 20.0, Vector3::new(1.0, 0.3, -0.2))
            })
            .collect();
        let mut spreader = spreader();
        let first = spreader.spread(&points).to_vec();
        let storage = spreader.blocks[0].force[0].as_ptr();
        spreader.spread(&points[..20]);
        assert_eq!(spreader.spread(&points), first);
        assert_eq!(spreader.blocks[0].force[0].as_ptr(), storage);
    }

    #[test]
    fn parts_together_are_the_whole() {
        let points: Vec<_> = (0..30)
            .map(|i| {
                let at = f64::from(i);
                point(200.0 + at, 3.0 * at, 100.0 + 7.0 * at, 20.0, Vector3::new(1.0, 0.3, -0.2))
            })
            .collect();
        let mut whole = spreader();
        whole.spread(&points);
        for levels in [0..13, 13..14, 14..48] {
            let mut part = spreader().on_levels(levels.clone());
            part.spread(&points);
            for (x, y, z) in (0..64 * 40 * 48).map(|i| (i % 64, i / 64 % 40, i / 64 / 40)) {
                let value =
                    |spreader: &Spreader| spreader.blocks().iter().find_map(|b| b.at(x, y, z));
                if levels.contains(&z) {
                    let zero = [0.0; 3];
                    assert_eq!(value(&part).unwrap_or(zero), value(&whole).unwrap_or(zero));
                } else {
                    assert_eq!(value(&part), None);
                }
            }
        }
    }

    #[test]
    fn far_rotors_get_boxes_of_their_own_and_strays_none() {
        let force = Vector3::new(1.0, 0.0, 0.0);
        let mut spreader = spreader();
        let near = point(0.0, 0.0, 100.0, 20.0, force);
        let far = point(400.0, 0.0, 100.0, 20.0, force);
        let outside = point(0.0, 900.0, 100.0, 20.0, force);
        assert_eq!(spreader.spread(&[near, far]).len(), 2);
        assert_eq!(spreader.spread(&[outside]).len(), 0);
        let bridge = point(200.0, 0.0, 100.0, 60.0, force);
        assert_eq!(spreader.spread(&[near, far, bridge]).len(), 1);
    }
}
