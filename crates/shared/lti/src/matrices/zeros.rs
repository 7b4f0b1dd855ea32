//! Invariant zeros.

use super::dense::{blocks, eigenvalues, inverse, part, singular_decomposition};
use super::{MatrixError, StateSpace};
use num_complex::Complex64;

/// Singular value, as a share of the matrices' norm, below which a rank ends.
const RANK: f64 = 1e-11;

impl StateSpace {
    /// Finite invariant zeros (rad/s in continuous time, – in discrete time): where the rank of
    /// (A − λ I, B; C, D) drops. A system without hidden modes has its transmission zeros alone; any number
    /// of inputs and outputs, in any units.
    ///
    /// Source: Emami-Naeini and Van Dooren, "Computation of zeros of linear multivariable systems",
    /// Automatica 18, 1982.
    pub fn invariant_zeros(&self) -> Result<Vec<Complex64>, MatrixError> {
        let scaled = signals_scaled(self);
        let whole = blocks(&[&[&scaled.a, &scaled.b], &[&scaled.c, &scaled.d]]);
        let tolerance = RANK * whole.norm_l2();
        let rows_full = with_full_rows(&scaled, tolerance)?;
        let square = with_full_rows(&rows_full.dual(), tolerance)?.dual();
        if square.order() == 0 {
            return Ok(Vec::new());
        }
        if square.inputs() != square.outputs() {
            return Err(MatrixError::NotConverged("the compression of the system's pencil"));
        }
        let direct = inverse(&square.d)
            .ok_or(MatrixError::NotConverged("the compression of the system's pencil"))?;
        eigenvalues(&(&square.a - &square.b * direct * &square.c))
    }
}

/// A system with the same zeros, whose states, inputs and outputs are in units that bring the columns of B
/// and the rows of C to the size of A: zeros belong to no unit, but ranks are told by size.
fn signals_scaled(system: &StateSpace) -> StateSpace {
    let mut scaled = system.prescaled();
    let size = match scaled.a.norm_l2() {
        size if size > 0.0 => size,
        _ => 1.0,
    };
    // By powers of two, which round nothing.
    let unit = |norm: f64| if norm > 0.0 { (size / norm).log2().round().exp2() } else { 1.0 };
    for input in 0..scaled.inputs() {
        let unit = unit(scaled.b.col(input).norm_l2().hypot(scaled.d.col(input).norm_l2()));
        scaled.b.col_mut(input).iter_mut().for_each(|entry| *entry *= unit);
        scaled.d.col_mut(input).iter_mut().for_each(|entry| *entry *= unit);
    }
    for output in 0..scaled.outputs() {
        let unit = unit(scaled.c.row(output).norm_l2().hypot(scaled.d.row(output).norm_l2()));
        scaled.c.row_mut(output).iter_mut().for_each(|entry| *entry *= unit);
        scaled.d.row_mut(output).iter_mut().for_each(|entry| *entry *= unit);
    }
    scaled
}

/// A system with the same finite zeros whose D has full row rank.
fn with_full_rows(system: &StateSpace, tolerance: f64) -> Result<StateSpace, MatrixError> {
    let mut system = system.clone();
    loop {
        let (outputs, inputs, order) = (system.outputs(), system.inputs(), system.order());
        let (turn, values, _) = singular_decomposition(&system.d)?;
        let rank = values.iter().filter(|value| **value > tolerance).count();
        if rank == outputs {
            return Ok(system);
        }
        let c = turn.transpose() * &system.c;
        let d = part(&(turn.transpose() * &system.d), 0, 0, rank, inputs);
        let without = part(&c, rank, 0, outputs - rank, order);
        // Outputs without direct gain stay zero only while the states that they show do.
        let (_, values, states) = singular_decomposition(&without)?;
        let shown = values.iter().filter(|value| **value > tolerance).count();
        let c = part(&c, 0, 0, rank, order);
        if shown == 0 {
            return Ok(StateSpace::new(system.a, system.b, c, d, system.interval));
        }
        let hidden = order - shown;
        let a = states.transpose() * &system.a * &states;
        let b = states.transpose() * &system.b;
        let c = &c * &states;
        system = StateSpace::new(
            part(&a, shown, shown, hidden, hidden),
            part(&b, shown, 0, hidden, inputs),
            blocks(&[&[&part(&a, 0, shown, shown, hidden)], &[&part(&c, 0, shown, rank, hidden)]]),
            blocks(&[&[&part(&b, 0, 0, shown, inputs)], &[&d]]),
            system.interval,
        );
    }
}

#[cfg(test)]
mod tests;
