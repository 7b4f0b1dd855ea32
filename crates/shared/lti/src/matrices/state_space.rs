//! A linear time-invariant system with several inputs and outputs.

use faer::Mat;

use crate::Recursion;

/// Passes over all states when they are scaled.
const MOST_SWEEPS: usize = 20;

/// dx/dt = A x + B u, y = C x + D u, or x(k+1) = A x(k) + B u(k) every `interval`.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// Order × order.
    pub a: Mat<f64>,
    /// Order × inputs.
    pub b: Mat<f64>,
    /// Outputs × order.
    pub c: Mat<f64>,
    /// Outputs × inputs.
    pub d: Mat<f64>,
    /// Time between samples (s); `None` in continuous time.
    pub interval: Option<f64>,
}

impl StateSpace {
    /// Of its matrices.
    ///
    /// # Panics
    /// Where the sizes do not fit one another.
    pub fn new(a: Mat<f64>, b: Mat<f64>, c: Mat<f64>, d: Mat<f64>, interval: Option<f64>) -> Self {
        let (order, inputs, outputs) = (a.nrows(), d.ncols(), d.nrows());
        assert!(
            a.ncols() == order
                && (b.nrows(), b.ncols()) == (order, inputs)
                && (c.nrows(), c.ncols()) == (outputs, order),
            "the matrices' sizes fit one another"
        );
        Self { a, b, c, d, interval }
    }

    /// A gain without a state.
    pub fn gain(d: Mat<f64>, interval: Option<f64>) -> Self {
        let (inputs, outputs) = (d.ncols(), d.nrows());
        Self::new(Mat::zeros(0, 0), Mat::zeros(0, inputs), Mat::zeros(outputs, 0), d, interval)
    }

    /// States.
    pub fn order(&self) -> usize {
        self.a.nrows()
    }

    /// Inputs.
    pub fn inputs(&self) -> usize {
        self.d.ncols()
    }

    /// Outputs.
    pub fn outputs(&self) -> usize {
        self.d.nrows()
    }

    /// The same system with states scaled by powers of two, so that what moves each is of the size of what
    /// each moves; the response keeps all its bits but rounding.
    ///
    /// Source: Osborne, "On pre-conditioning of matrices", J. ACM 7, 1960, with inputs and outputs beside
    /// A.
    pub fn prescaled(&self) -> Self {
        let mut scaled = self.clone();
        for _ in 0..MOST_SWEEPS {
            let mut changed = false;
            for i in 0..scaled.order() {
                let others = || (0..scaled.order()).filter(|j| *j != i);
                let moving = others().map(|j| scaled.a[(i, j)].abs()).sum::<f64>()
                    + scaled.b.row(i).iter().map(|value| value.abs()).sum::<f64>();
                let moved = others().map(|j| scaled.a[(j, i)].abs()).sum::<f64>()
                    + scaled.c.col(i).iter().map(|value| value.abs()).sum::<f64>();
                let power = 0.5 * (moving / moved).log2();
                if !power.is_finite() || power.abs() < 1.0 {
                    continue;
                }
                scaled.scale_state(i, power.round().exp2());
                changed = true;
            }
            if !changed {
                break;
            }
        }
        scaled
    }

    /// State `i` in units `unit` times as large.
    fn scale_state(&mut self, i: usize, unit: f64) {
        for j in 0..self.order() {
            self.a[(i, j)] /= unit;
            self.a[(j, i)] *= unit;
        }
        for j in 0..self.inputs() {
            self.b[(i, j)] /= unit;
        }
        for j in 0..self.outputs() {
            self.c[(j, i)] *= unit;
        }
    }

    /// What steps in time.
    ///
    /// # Panics
    /// In continuous time.
    pub fn recursion(&self) -> Recursion {
        assert!(self.interval.is_some(), "a system in discrete time");
        Recursion::new(&rows(&self.a), &rows(&self.b), &rows(&self.c), &rows(&self.d))
    }
}

/// A matrix row by row.
fn rows(matrix: &Mat<f64>) -> Vec<Vec<f64>> {
    (0..matrix.nrows()).map(|i| (0..matrix.ncols()).map(|j| matrix[(i, j)]).collect()).collect()
}
