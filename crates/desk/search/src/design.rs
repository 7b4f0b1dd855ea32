//! The first points, before anything is known.

use crate::SearchError;
use crate::draws::Draws;
use crate::space::{Space, distinct};

/// Points of a first design at least (–): fewer tell no length.
const FEWEST: usize = 2;
/// Latin hypercubes among which the best is chosen (–).
const N_TRIED: usize = 400;

/// How the first points are chosen.
#[derive(Clone, Debug, PartialEq)]
pub enum Design {
    /// A Latin hypercube whose closest points are furthest apart, of those drawn with a seed. Morris and
    /// Mitchell, "Exploratory designs for computational experiments", J. Stat. Plan. Inference 43, 1995.
    Hypercube,
    /// These.
    Points(Vec<Vec<f64>>),
}

impl Design {
    /// `n` points in `space`; all of those that are given.
    ///
    /// # Errors
    /// [`SearchError::FewPoints`], [`SearchError::Outside`].
    pub fn points(&self, space: &Space, n: usize, seed: u64) -> Result<Vec<Vec<f64>>, SearchError> {
        let points = match self {
            Self::Hypercube if n < FEWEST => {
                return Err(SearchError::FewPoints { n, needed: FEWEST });
            }
            Self::Hypercube => hypercube(space, n, seed),
            Self::Points(points) => {
                if let Some(index) = points.iter().position(|point| !space.holds(point)) {
                    return Err(SearchError::Outside { index });
                }
                distinct(points.iter().map(|point| space.snap(point)).collect())
            }
        };
        if points.len() < FEWEST {
            return Err(SearchError::FewPoints { n: points.len(), needed: FEWEST });
        }
        Ok(points)
    }
}

/// The best of many Latin hypercubes of `n` points.
fn hypercube(space: &Space, n: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut draws = Draws::new(seed, 1);
    let mut best: (f64, Vec<Vec<f64>>) = (f64::NEG_INFINITY, Vec::new());
    for _ in 0..N_TRIED {
        let columns: Vec<Vec<usize>> = (0..space.n_dimensions()).map(|_| draws.order(n)).collect();
        let point = |row: usize| {
            // In the middle of its cell.
            let share = |column: &Vec<usize>| (column[row] as f64 + 0.5) / n as f64;
            space.at(&columns.iter().map(share).collect::<Vec<f64>>())
        };
        let points = distinct((0..n).map(point).collect());
        let scaled: Vec<Vec<f64>> = points.iter().map(|point| space.scaled(point)).collect();
        let mut closest = f64::INFINITY;
        for (index, one) in scaled.iter().enumerate() {
            for other in &scaled[..index] {
                let square: f64 = one.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum();
                closest = closest.min(square);
            }
        }
        if (points.len(), closest) > (best.1.len(), best.0) {
            best = (closest, points);
        }
    }
    best.1
}
