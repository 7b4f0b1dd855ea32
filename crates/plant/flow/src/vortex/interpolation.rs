//! Polynomials on a box: Chebyshev points, and the shares that a source inside has in them.

use basis::Vector3;
use std::f64::consts::PI;

/// Lowest degree at which a cluster says anything (–).
pub const LOWEST_DEGREE: usize = 2;
/// Highest degree: beyond it single precision is what limits (–).
pub const HIGHEST_DEGREE: usize = 6;
const MOST: usize = HIGHEST_DEGREE + 1;

/// Chebyshev points of the second kind along each axis of the cube [−1, 1]³.
#[derive(Clone, Debug)]
pub(super) struct Points {
    /// Along one axis.
    nodes: Vec<f64>,
    /// Π (node − other nodes), upside down.
    scales: Vec<f64>,
}

/// Shares of a place in the points along each of three axes; the first `degree + 1` of each count.
pub(super) type Shares = [[f64; MOST]; 3];

impl Points {
    /// Those of polynomials of `degree`.
    pub(super) fn new(degree: usize) -> Self {
        let nodes: Vec<f64> =
            (0..=degree).map(|k| -(PI * k as f64 / degree as f64).cos()).collect();
        let scale = |node: &f64| {
            1.0 / nodes.iter().filter(|other| *other != node).map(|o| node - o).product::<f64>()
        };
        let scales = nodes.iter().map(scale).collect();
        Self { nodes, scales }
    }

    /// Points along one axis (–).
    pub(super) fn n(&self) -> usize {
        self.nodes.len()
    }

    /// Points in the cube (–), the last axis fastest.
    pub(super) fn n_in_cube(&self) -> usize {
        self.n().pow(3)
    }

    /// Where point number `index` of the cube is.
    pub(super) fn place(&self, index: usize) -> [f64; 3] {
        let n = self.n();
        [index / (n * n), index / n % n, index % n].map(|k| self.nodes[k])
    }

    /// Lagrange's polynomials at `place` in the cube.
    pub(super) fn shares(&self, place: Vector3) -> Shares {
        let mut shares = [[0.0; MOST]; 3];
        for (shares, at) in shares.iter_mut().zip(place.to_array()) {
            *shares = self.along(at);
        }
        shares
    }

    fn along(&self, at: f64) -> [f64; MOST] {
        let mut shares = [0.0; MOST];
        for (k, share) in shares[..self.n()].iter_mut().enumerate() {
            *share = self.scales[k];
            for (j, node) in self.nodes.iter().enumerate() {
                if j != k {
                    *share *= at - node;
                }
            }
        }
        shares
    }

    /// Adds what sources in the points of a box at `middle` of `half` extents (both in the cube of another
    /// one) amount to in the points of that other one. `from` and `to` hold vectors in the points.
    pub(super) fn raise(
        &self,
        from: &[Vector3],
        middle: Vector3,
        half: Vector3,
        to: &mut [Vector3],
    ) {
        let n = self.n();
        // Shares of child point (second) in parent point (first) along each axis.
        let tables: [[[f64; MOST]; MOST]; 3] = std::array::from_fn(|axis| {
            let mut table = [[0.0; MOST]; MOST];
            for (child, node) in self.nodes.iter().enumerate() {
                let shares = self.along(middle[axis] + half[axis] * node);
                for (row, share) in table.iter_mut().zip(shares) {
                    row[child] = share;
                }
            }
            table
        });
        let mut passed = [[Vector3::ZERO; MOST * MOST * MOST]; 2];
        passed[0][..from.len()].copy_from_slice(from);
        for (axis, table) in tables.iter().enumerate() {
            let stride = n.pow(2 - axis as u32);
            let [first, second] = &mut passed;
            let (input, output) = if axis % 2 == 0 { (first, second) } else { (second, first) };
            for (index, value) in output[..n.pow(3)].iter_mut().enumerate() {
                let k = index / stride % n;
                let base = index - k * stride;
                *value = (0..n).map(|j| input[base + j * stride] * table[k][j]).sum();
            }
        }
        for (to, value) in to.iter_mut().zip(&passed[1]) {
            *to += *value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_reproduce_polynomials_and_raising_keeps_them() {
        let points = Points::new(3);
        let polynomial = |x: [f64; 3]| 1.0 + x[0].powi(3) - 2.0 * x[1].powi(2) * x[2] + x[0] * x[2];
        let place = Vector3::new(0.3, -0.7, 0.1);
        let shares = points.shares(place);
        let spread = |shares: &Shares| -> Vec<Vector3> {
            let n = points.n();
            (0..points.n_in_cube())
                .map(|i| {
                    let [a, b, c] = [i / (n * n), i / n % n, i % n];
                    Vector3::X * shares[0][a] * shares[1][b] * shares[2][c]
                })
                .collect()
        };
        let weights = spread(&shares);
        let sum: f64 =
            weights.iter().enumerate().map(|(i, w)| w.x * polynomial(points.place(i))).sum();
        assert!((sum - polynomial(place.to_array())).abs() < 1e-13);
        // A box in the upper corner of another one.
        let (middle, half) = (Vector3::new(0.4, 0.5, 0.2), Vector3::new(0.6, 0.5, 0.3));
        let mut raised = vec![Vector3::ZERO; points.n_in_cube()];
        points.raise(&weights, middle, half, &mut raised);
        let at_once = spread(&points.shares(middle + half * place));
        for (raised, expected) in raised.iter().zip(at_once) {
            assert!((*raised - expected).length() < 1e-13);
        }
    }
}
