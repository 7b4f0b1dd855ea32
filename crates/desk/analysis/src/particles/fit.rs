//! The polynomial of a bin, out of its sums.

use super::basis_functions::{MOST_TERMS, linear_term, n_terms};
use super::{BinSettings, Order};
use basis::records::STRESSES;

/// Share of a term's own sum that must be left after the terms before it (–): less means that the samples
/// do not tell the terms apart.
const APART: f64 = 1e-6;

/// Share of the samples' scatter that a polynomial must leave (–), so that what is left tells how far they
/// scatter: one that goes through them all tells nothing.
const LEAST_FREE: f64 = 0.25;

/// The sums of one bin, as [`BinSettings::stride`] lays them out.
pub(super) struct Sums<'a> {
    /// Lower triangle of the products of terms by the squares of the weights, row by row: what scatters alike
    /// in all samples makes coefficients scatter by.
    squares: &'a [f64],
    /// Lower triangle of the products of terms, row by row.
    products: &'a [f64],
    /// Terms times u, v, w, one component after the other.
    moments: &'a [f64],
    /// Products of velocities, as [`STRESSES`] orders them.
    velocities: &'a [f64],
    n_terms: usize,
}

/// What a bin says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fitted {
    pub(super) order: Order,
    /// At the middle (m/s), from the reference.
    pub(super) mean: [f64; 3],
    /// Slope of each component along each axis, in half sizes of the bin (m/s); not a number where it has
    /// none.
    pub(super) slope: [[f64; 3]; 3],
    /// Stresses of what the polynomial leaves (m²/s²), as [`STRESSES`] orders them.
    pub(super) stress: [f64; 6],
    /// Standard error of the mean (m/s).
    pub(super) error: [f64; 3],
}

impl<'a> Sums<'a> {
    pub(super) fn of(bin: &'a [f64], n_terms: usize) -> Self {
        let n_products = n_terms * (n_terms + 1) / 2;
        let (squares, rest) = bin.split_at(n_products);
        let (products, rest) = rest.split_at(n_products);
        let (moments, velocities) = rest.split_at(3 * n_terms);
        Self { squares, products, moments, velocities, n_terms }
    }

    /// The polynomial of the highest order for which `n` samples are enough and apart; none where there are
    /// too few for any.
    pub(super) fn fitted(&self, n: u32, settings: &BinSettings) -> Option<Fitted> {
        let allowed = |order: &Order| *order <= settings.order && n >= settings.needed(*order);
        let orders = Order::DESCENDING.into_iter().filter(allowed);
        orders.into_iter().find_map(|order| self.of_order(order, settings.axes))
    }

    fn of_order(&self, order: Order, axes: [bool; 3]) -> Option<Fitted> {
        let n = n_terms(order, axes);
        let lower = self.factor(n)?;
        let weight = self.products[0];
        let coefficients = [0, 1, 2].map(|component| {
            solved(&lower, n, |term| self.moments[component * self.n_terms + term])
        });
        let (spread, taken) = self.spread(&lower, n);
        let free = 1.0 - taken / weight;
        if order > Order::Constant && free < LEAST_FREE {
            return None;
        }
        let free = free.max(f64::EPSILON);
        let moment = |component: usize, term: usize| self.moments[component * self.n_terms + term];
        let stress = std::array::from_fn(|place| {
            let [first, second] = STRESSES[place];
            let explained: f64 =
                (0..n).map(|term| coefficients[first][term] * moment(second, term)).sum();
            let left = (self.velocities[place] - explained) / (weight * free);
            // Rounding may leave less than nothing of a square.
            if first == second { left.max(0.0) } else { left }
        });
        let slope = coefficients.map(|of| {
            [0, 1, 2].map(|axis| {
                let term = linear_term(axis, axes).filter(|_| order >= Order::Linear);
                term.map_or(f64::NAN, |term| of[term])
            })
        });
        Some(Fitted {
            order,
            mean: coefficients.map(|of| of[0]),
            slope,
            stress,
            error: [0, 1, 2].map(|component| (stress[component] * spread).sqrt()),
        })
    }

    fn product(&self, row: usize, column: usize) -> f64 {
        self.products[row * (row + 1) / 2 + column]
    }

    /// The first `n` rows of the Cholesky factor of the products; none where terms are not apart.
    fn factor(&self, n: usize) -> Option<[[f64; MOST_TERMS]; MOST_TERMS]> {
        let mut lower = [[0.0; MOST_TERMS]; MOST_TERMS];
        for row in 0..n {
            for column in 0..=row {
                let before: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
                let left = self.product(row, column) - before;
                if column < row {
                    lower[row][column] = left / lower[column][column];
                } else if left > APART * self.product(row, row) && left.is_finite() {
                    lower[row][row] = left.sqrt();
                } else {
                    return None;
                }
            }
        }
        Some(lower)
    }

    /// Variance of the first of `n` coefficients over that of a sample, and the sum of weights that the fit
    /// takes from what is left (–), by the factor `lower` of the products.
    ///
    /// Of samples that scatter alike by σ, weighted least squares has the covariance σ² A⁻¹ B A⁻¹, with A the
    /// products of terms by the weights and B those by their squares, and leaves σ² (Σw − tr A⁻¹B).
    fn spread(&self, lower: &[[f64; MOST_TERMS]; MOST_TERMS], n: usize) -> (f64, f64) {
        let square = |row: usize, column: usize| {
            let (row, column) = (row.max(column), row.min(column));
            self.squares[row * (row + 1) / 2 + column]
        };
        let (mut variance, mut trace) = (0.0, 0.0);
        for column in 0..n {
            let inverse = solved(lower, n, |term| f64::from(u8::from(term == column)));
            for row in 0..n {
                trace += inverse[row] * square(row, column);
                if column == 0 {
                    let sum: f64 = (0..n).map(|k| square(row, k) * inverse[k]).sum();
                    variance += inverse[row] * sum;
                }
            }
        }
        (variance, trace)
    }
}

/// What the matrix with the factor `lower` of `n` rows makes `right` of.
fn solved(
    lower: &[[f64; MOST_TERMS]; MOST_TERMS],
    n: usize,
    right: impl Fn(usize) -> f64,
) -> [f64; MOST_TERMS] {
    let mut found = [0.0; MOST_TERMS];
    for row in 0..n {
        let before: f64 = (0..row).map(|k| lower[row][k] * found[k]).sum();
        found[row] = (right(row) - before) / lower[row][row];
    }
    for row in (0..n).rev() {
        let after: f64 = (row + 1..n).map(|k| lower[k][row] * found[k]).sum();
        found[row] = (found[row] - after) / lower[row][row];
    }
    found
}
