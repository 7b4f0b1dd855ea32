//! The optimum, and how well it is known.

use crate::SearchError;
use crate::draws::Draws;
use crate::model::Normal;
use crate::normal::{NORMAL_97_5, quantile};
use crate::sum::Sum;

/// Curves drawn (–).
const N_CURVES: usize = 800;
/// Points at which they are drawn (–): those that may be the highest.
const N_POINTS: usize = 200;
/// Ends of a central 95 % interval (–).
const ENDS: [f64; 2] = [0.025, 0.975];

/// Where the sum is greatest.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// The point of the greatest mean (units of the variables).
    pub point: Vec<f64>,
    /// The sum there (unit of the sum); its deviation holds what all evaluations share.
    pub value: Normal,
    /// Each output there (its unit).
    pub outputs: Vec<Normal>,
    /// For each variable the central 95 % of where drawn curves are greatest (its unit).
    pub place_95: Vec<[f64; 2]>,
    /// Central 95 % of the greatest value of drawn curves (unit of the sum).
    pub greatest_95: [f64; 2],
    /// Points at which drawn curves are greatest, and the share of them (–), the largest first.
    pub places: Vec<(Vec<f64>, f64)>,
}

impl Optimum {
    /// The optimum of `sum` among `candidates`, at which it is `values`.
    ///
    /// # Errors
    /// [`SearchError::Surrogate`].
    pub(crate) fn new(
        sum: &Sum,
        n_outputs: usize,
        candidates: &[Vec<f64>],
        values: &[Normal],
        seed: u64,
    ) -> Result<Self, SearchError> {
        let best = greatest(values.iter().map(|value| value.mean));
        let point = candidates[best].clone();
        let mut likely: Vec<usize> = (0..candidates.len()).collect();
        let bound = |place: usize| values[place].mean + 3.0 * values[place].deviation;
        likely.sort_by(|a, b| bound(*b).total_cmp(&bound(*a)).then(a.cmp(b)));
        likely.truncate(N_POINTS);
        if !likely.contains(&best) {
            likely.push(best);
        }
        let points: Vec<Vec<f64>> = likely.iter().map(|place| candidates[*place].clone()).collect();
        let curves = sum.samples(&points, N_CURVES, seed)?;
        let mut draws = Draws::new(seed, 5);
        let mut tops = Vec::with_capacity(curves.len());
        let mut counts = vec![0_usize; points.len()];
        for curve in &curves {
            let top = greatest(curve.iter().copied());
            counts[top] += 1;
            tops.push(curve[top] + sum.shared_deviation() * draws.normal());
        }
        tops.sort_by(f64::total_cmp);
        let mut places: Vec<(Vec<f64>, f64)> = points
            .iter()
            .zip(&counts)
            .filter(|(_, count)| **count > 0)
            .map(|(point, count)| (point.clone(), *count as f64 / curves.len() as f64))
            .collect();
        places.sort_by(|a, b| b.1.total_cmp(&a.1));
        let spread = |variable: usize| {
            let mut along: Vec<f64> = points
                .iter()
                .zip(&counts)
                .flat_map(|(point, count)| std::iter::repeat_n(point[variable], *count))
                .collect();
            along.sort_by(f64::total_cmp);
            ENDS.map(|share| quantile(&along, share))
        };
        let place_95 = (0..point.len()).map(spread).collect();
        let deviation = values[best].deviation.hypot(sum.shared_deviation());
        let value = Normal { mean: values[best].mean, deviation };
        let at = |output| Ok(sum.output(output, std::slice::from_ref(&point))?[0]);
        let outputs = (0..n_outputs).map(at).collect::<Result<_, SearchError>>()?;
        let greatest_95 = ENDS.map(|share| quantile(&tops, share));
        Ok(Self { point, value, outputs, place_95, greatest_95, places })
    }

    /// Half width of the 95 % interval of the sum there (unit of the sum).
    pub fn half_width_95(&self) -> f64 {
        NORMAL_97_5 * self.value.deviation
    }
}

/// Place of the first of the greatest `values`.
pub(crate) fn greatest(values: impl Iterator<Item = f64>) -> usize {
    let mut found = (f64::NEG_INFINITY, 0);
    for (place, value) in values.enumerate() {
        if value > found.0 {
            found = (value, place);
        }
    }
    found.1
}
