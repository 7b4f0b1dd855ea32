//! What a Gaussian process says of changes over the phase offset.

use super::Drawn;
use analysis::statistics::standard_error;
use report::{CurveEnd, CurvePoint, OffsetPoint};
use std::f64::consts::TAU;
use surrogate::{Curve, CurveSettings, Extreme, FitSettings, GaussianProcess, Observations, Shape};

/// Fewest offsets through which a curve is drawn (–).
const FEWEST: usize = 6;
/// Different offsets at which a curve is shown (–); the first stands at the end once more.
const N_CURVE: usize = 120;
/// Curves drawn from the process (–): enough for ends of intervals to repeat within some degrees.
const N_DRAWS: usize = 1000;
const SEED: u64 = 1;

/// The curve through `points` with its ends; none where they are too few, or allow none.
pub(super) fn through(points: &[OffsetPoint]) -> Option<Drawn> {
    let (inputs, found) = curve(points)?;
    let [highest, lowest] = [found.highest, found.lowest].map(|extreme| Some(end(extreme)));
    Some(Drawn { curve: shown(&inputs, &found), highest, lowest })
}

fn end(extreme: Extreme) -> CurveEnd {
    let offset = extreme.input.rem_euclid(TAU);
    let turned = offset - extreme.input;
    let offset_95 = extreme.input_95.map(|end| end + turned);
    CurveEnd { offset, offset_95, change: extreme.value }
}

/// `curve` at `inputs`, and at the first of them a turn later.
fn shown(inputs: &[f64], curve: &Curve) -> Vec<CurvePoint> {
    let point = |index: usize| {
        let (mean, band_95) = (curve.means[index], curve.bands_95[index]);
        CurvePoint { offset: inputs[index], mean, band_95 }
    };
    let closing = CurvePoint { offset: TAU, ..point(0) };
    (0..inputs.len()).map(point).chain([closing]).collect()
}

/// Standard error of each point's change, and the degrees of freedom behind it; none unless every point has
/// them.
fn errors(points: &[OffsetPoint]) -> Option<(Vec<f64>, Vec<usize>)> {
    points.iter().map(|point| standard_error(&point.change)).collect()
}

fn curve(points: &[OffsetPoint]) -> Option<(Vec<f64>, Curve)> {
    if points.len() < FEWEST {
        return None;
    }
    let offsets = points.iter().map(|point| point.offset).collect();
    let values = points.iter().map(|point| point.change.mean).collect();
    let observations = Observations::of_curve(offsets, values);
    let (observations, degrees_of_freedom) = match errors(points) {
        Some((errors, freedom)) => (observations.with_deviations(&errors), freedom),
        None => (observations, Vec::new()),
    };
    let shape = Shape::Periodic { period: TAU };
    let process = GaussianProcess::fit(shape, observations, &FitSettings::default()).ok()?;
    let inputs: Vec<f64> = (0..N_CURVE).map(|index| TAU * index as f64 / N_CURVE as f64).collect();
    let settings =
        CurveSettings { degrees_of_freedom: &degrees_of_freedom, n_draws: N_DRAWS, seed: SEED };
    let curve = process.curve(&inputs, &settings).ok()?;
    Some((inputs, curve))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::offset_panel;
    use basis::records::Statistic;

    fn point(offset: f64, mean: f64, half_width: f64, n_blocks: usize) -> OffsetPoint {
        let (standard_deviation, half_width_95) = (0.0, Some(half_width));
        let change = Statistic { mean, standard_deviation, half_width_95, n_blocks };
        OffsetPoint { offset: offset.to_radians(), change }
    }

    /// Three blocks: 4.30 standard errors make the half width, not 1.96.
    #[test]
    fn a_point_counts_with_its_standard_error() {
        let points = [point(0.0, 0.1, 4.302_653, 3), point(90.0, 0.2, 12.706_205, 2)];
        let (errors, freedom) = errors(&points).expect("intervals");
        assert!(errors.iter().all(|error| (error - 1.0).abs() < 1e-6), "{errors:?}");
        assert_eq!(freedom, [2, 1]);
        let mut without = points;
        without[1].change.half_width_95 = None;
        assert!(super::errors(&without).is_none());
    }

    #[test]
    fn the_ends_of_the_interval_go_round_with_the_offset() {
        let best = end(Extreme { input: -0.1, value: 0.2, input_95: [-0.4, 0.3] });
        assert!((best.offset - (TAU - 0.1)).abs() < 1e-12);
        let expected = [TAU - 0.4, TAU + 0.3];
        assert!(best.offset_95.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn few_points_have_no_curve() {
        let points: Vec<OffsetPoint> =
            (0..5).map(|k| point(60.0 * f64::from(k), 0.1, 0.05, 3)).collect();
        let panel = offset_panel("T3".to_owned(), points);
        assert!(panel.curve.is_empty() && panel.highest.is_none() && panel.points.len() == 5);
    }
}
