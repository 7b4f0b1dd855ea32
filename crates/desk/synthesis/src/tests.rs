//! Whole ways from plant and weights to a checked controller, against closed forms and invariants.

use crate::*;
use faer::{Mat, mat};
use lti::matrices::dense::{eigenvalues, identity};
use lti::matrices::{
    StateSpace, TransferFunction, bilinear, feedback, inverse_bilinear, parallel, sample_delay,
    series, zero_order_hold,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

mod analysed;
mod quadratic;
mod robust;

/// A transfer function in continuous time, highest powers first.
fn rational(numerator: &[f64], denominator: &[f64]) -> StateSpace {
    let (numerator, denominator) = (numerator.to_vec(), denominator.to_vec());
    TransferFunction { numerator, denominator, interval: None }.state_space().unwrap()
}

/// Numbers between −1 and 1.
struct Numbers(ChaCha8Rng);

impl Numbers {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> Mat<f64> {
        let mut next = || (self.0.next_u64() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
        Mat::from_fn(rows, columns, |_, _| next())
    }

    /// A system whose least stable pole has this real part (rad/s).
    fn system(&mut self, order: usize, inputs: usize, outputs: usize, growth: f64) -> StateSpace {
        let free = (2.0 / (order as f64).sqrt()) * self.matrix(order, order);
        let found = eigenvalues(&free).unwrap().iter().map(|value| value.re).fold(-9.0, f64::max);
        StateSpace::new(
            free + (growth - found) * identity(order),
            self.matrix(order, inputs),
            self.matrix(outputs, order),
            Mat::zeros(outputs, inputs),
            None,
        )
    }
}

/// Performance and control weights of two channels, of order one each.
fn weights(channels: usize) -> SensitivityWeights {
    let performance = performance_weight(0.3, 2.0, 0.01).unwrap().repeated(channels).unwrap();
    let control = rational(&[1.0, 0.5], &[0.1, 10.0]).repeated(channels).unwrap();
    SensitivityWeights {
        performance: Some(performance),
        complementary: None,
        control: Some(control),
    }
}
