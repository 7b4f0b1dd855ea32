//! A state-space system in discrete time that steps without allocation.

use serde::{Deserialize, Serialize};

/// x(k+1) = A x(k) + B u(k), y(k) = C x(k) + D u(k), with x = 0 at first. Matrices are row after row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recursion {
    order: usize,
    inputs: usize,
    outputs: usize,
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
    d: Vec<f64>,
    /// Order × outputs: what the state learns of an output that was limited; empty where nothing.
    back: Vec<f64>,
    state: Vec<f64>,
    next: Vec<f64>,
}

impl Recursion {
    /// Of the matrices' rows: `a` order × order, `b` order × inputs, `c` outputs × order, `d` outputs ×
    /// inputs.
    ///
    /// # Panics
    /// Where the sizes do not fit one another.
    pub fn new(a: &[Vec<f64>], b: &[Vec<f64>], c: &[Vec<f64>], d: &[Vec<f64>]) -> Self {
        let (order, outputs) = (a.len(), d.len());
        let inputs = d.first().map_or(0, Vec::len);
        let of_size = |rows: &[Vec<f64>], height: usize, width: usize| {
            rows.len() == height && rows.iter().all(|row| row.len() == width)
        };
        assert!(
            of_size(a, order, order)
                && of_size(b, order, inputs)
                && of_size(c, outputs, order)
                && of_size(d, outputs, inputs),
            "the matrices' sizes fit one another"
        );
        Self {
            order,
            inputs,
            outputs,
            a: a.concat(),
            b: b.concat(),
            c: c.concat(),
            d: d.concat(),
            back: Vec::new(),
            state: vec![0.0; order],
            next: vec![0.0; order],
        }
    }

    /// It, whose state learns of limits by back-calculation: x(k+1) = A x + B u + L (y limited − y) with the
    /// rows of L, order × outputs.
    ///
    /// # Panics
    /// Where L has another size.
    pub fn with_back_calculation(mut self, gain: &[Vec<f64>]) -> Self {
        let is_row = |row: &Vec<f64>| row.len() == self.outputs;
        assert!(gain.len() == self.order && gain.iter().all(is_row), "order × outputs");
        self.back = gain.concat();
        self
    }

    /// Whether its state learns of limits; one without a state has nothing to learn.
    pub fn learns_of_limits(&self) -> bool {
        self.order == 0 || !self.back.is_empty()
    }

    /// Length of the input.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Length of the output.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// The output at this instant, then the state one step on.
    ///
    /// # Panics
    /// Where `input` or `output` has another length.
    pub fn step(&mut self, input: &[f64], output: &mut [f64]) {
        self.step_within(input, output, |_| ());
    }

    /// As [`step`](Self::step); `limit` brings the output within its limits before the state goes on.
    pub fn step_within(
        &mut self,
        input: &[f64],
        output: &mut [f64],
        limit: impl FnOnce(&mut [f64]),
    ) {
        self.look(input, output);
        limit(output);
        for i in 0..self.order {
            self.next[i] = row(&self.a, i, &self.state) + row(&self.b, i, input);
        }
        if !self.back.is_empty() {
            for (j, limited) in output.iter().enumerate() {
                let wanted = row(&self.c, j, &self.state) + row(&self.d, j, input);
                for (next, gains) in self.next.iter_mut().zip(self.back.chunks(self.outputs)) {
                    *next += gains[j] * (limited - wanted);
                }
            }
        }
        std::mem::swap(&mut self.state, &mut self.next);
    }

    /// On return `output` is that at this instant; the state stays where it is.
    ///
    /// # Panics
    /// Where `input` or `output` has another length.
    pub fn look(&self, input: &[f64], output: &mut [f64]) {
        let sizes = (self.inputs, self.outputs);
        assert_eq!((input.len(), output.len()), sizes, "as many as the matrices have");
        for (i, value) in output.iter_mut().enumerate() {
            *value = row(&self.c, i, &self.state) + row(&self.d, i, input);
        }
    }

    /// At rest again.
    pub fn reset(&mut self) {
        self.state.fill(0.0);
    }
}

/// Row `i` of a matrix times a column.
fn row(matrix: &[f64], i: usize, column: &[f64]) -> f64 {
    matrix[i * column.len()..][..column.len()].iter().zip(column).map(|(m, x)| m * x).sum()
}

#[cfg(test)]
mod tests {
    use super::Recursion;

    /// A first-order lag answers a step with 1 - a^k, one interval late.
    #[test]
    fn a_lag_answers_a_step_with_its_closed_form() {
        let mut lag = Recursion::new(&[vec![0.8]], &[vec![0.2]], &[vec![1.0]], &[vec![0.0]]);
        let mut output = [0.0];
        for k in 0..30 {
            lag.step(&[1.0], &mut output);
            assert!((output[0] - (1.0 - 0.8_f64.powi(k))).abs() < 1e-14);
        }
        lag.reset();
        lag.step(&[0.0], &mut output);
        assert_eq!(output[0], 0.0);
    }

    /// An integrator that asks for more than it gets comes back as soon as its input turns.
    #[test]
    fn a_limited_integrator_does_not_wind_up() {
        let integrator = Recursion::new(&[vec![1.0]], &[vec![0.1]], &[vec![1.0]], &[vec![0.0]]);
        let mut plain = integrator.clone();
        let mut conditioned = integrator.with_back_calculation(&[vec![1.0]]);
        let mut output = [0.0];
        for law in [&mut plain, &mut conditioned] {
            for _ in 0..200 {
                law.step_within(&[1.0], &mut output, |output| output[0] = output[0].min(1.0));
            }
            assert_eq!(output, [1.0]);
        }
        let mut after = |law: &mut Recursion| {
            for _ in 0..5 {
                law.step_within(&[-1.0], &mut output, |output| output[0] = output[0].min(1.0));
            }
            output[0]
        };
        assert_eq!(after(&mut plain), 1.0);
        assert!((after(&mut conditioned) - 0.6).abs() < 1e-12);
    }

    #[test]
    #[should_panic(expected = "sizes fit")]
    fn matrices_of_other_sizes_are_refused() {
        Recursion::new(&[vec![0.8]], &[vec![0.2, 0.1]], &[vec![1.0]], &[vec![0.0]]);
    }
}
