//! The wind that meets a turbine as it estimates it, beside the true one: figure 10 of van Vondelen et al.
//! (2025).

use crate::phase::{PhaseAnswer, PhaseAxis};
use report::{Along, TrackFigure, TrackLine, TrackRow};

/// How well one component of the wind was estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindNumbers {
    /// Mean of the error, estimate minus truth (m/s).
    pub bias: f64,
    /// Its root mean square (m/s).
    pub rmse: f64,
    /// Correlation of estimate and truth (–); not a number where either rests.
    pub correlation: f64,
    /// Standard deviation of the estimate over that of the truth (–).
    pub ratio: f64,
    /// Share of the time in which the truth lies within one standard deviation that the estimator has of its
    /// estimate (–): 0.68 where errors are normal and it knows them. Absent where that was not kept.
    pub within: Option<f64>,
}

/// Average, tilt and yaw of `answer`.
pub fn wind_numbers(answer: &PhaseAnswer) -> [WindNumbers; 3] {
    let axis = |axis: &PhaseAxis| numbers(&axis.wind, &axis.true_wind, &axis.wind_deviation);
    [
        numbers(&answer.wind, &answer.true_wind, &answer.wind_deviation),
        axis(&answer.tilt),
        axis(&answer.yaw),
    ]
}

fn numbers(estimated: &[f64], truth: &[f64], deviation: &[f64]) -> WindNumbers {
    let n = estimated.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let (own, other) = (mean(estimated), mean(truth));
    let pairs = || estimated.iter().zip(truth);
    let product = |a: &[f64], b: &[f64], means: [f64; 2]| {
        a.iter().zip(b).map(|(a, b)| (a - means[0]) * (b - means[1])).sum::<f64>() / n
    };
    let spreads = [product(estimated, estimated, [own; 2]), product(truth, truth, [other; 2])];
    let [spread, true_spread] = spreads.map(f64::sqrt);
    let n_within = || {
        let held = pairs().zip(deviation).filter(|((a, b), half)| (**a - **b).abs() <= **half);
        held.count() as f64
    };
    WindNumbers {
        bias: own - other,
        rmse: (pairs().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / n).sqrt(),
        correlation: product(estimated, truth, [own, other]) / (spread * true_spread),
        ratio: spread / true_spread,
        within: (!deviation.is_empty()).then(|| n_within() / n),
    }
}

/// Winds and phases of `answer` over time, estimates with a band of one standard deviation to either side;
/// `mark` is the time at which the turbine begins to pitch (s), where it does within the record.
pub(crate) fn figure(answer: &PhaseAnswer, mark: Option<f64>) -> TrackFigure {
    let row = |label: &str, is_angle: bool, series: [&[f64]; 3]| {
        let [truth, estimate, deviation] = series;
        let line = |name: &str, colour: usize, values: &[f64], band: &[f64]| TrackLine {
            name: name.to_owned(),
            colour,
            times: answer.times.clone(),
            values: values.to_vec(),
            band: band.to_vec(),
        };
        let lines = vec![line("true", 0, truth, &[]), line("estimated", 1, estimate, deviation)];
        TrackRow { label: label.to_owned(), is_angle, lines }
    };
    let wind = |label: &str, axis: &PhaseAxis| {
        row(label, false, [&axis.true_wind, &axis.wind, &axis.wind_deviation])
    };
    let phase = |label: &str, axis: &PhaseAxis| {
        row(label, true, [&axis.true_phase, &axis.phase, &axis.phase_deviation])
    };
    let (turbine, run) = (&answer.turbine, &answer.run);
    let band = if answer.tilt.wind_deviation.is_empty() {
        ""
    } else {
        " The band about an estimate is one standard deviation of it to either side, as the estimator has it."
    };
    TrackFigure {
        along: Along::TIME,
        name: format!("phases-{run}"),
        title: format!("Wind and phase of the helix at {turbine}, estimated and true: {run}"),
        caption: format!(
            "The truth is the wind at {turbine}'s place in the run {}: its average as it is, tilt and yaw band-passed around \
             the excitation.{band}",
            answer.truth
        ),
        rows: vec![
            row("average (m/s)", false, [&answer.true_wind, &answer.wind, &answer.wind_deviation]),
            wind("tilt (m/s)", &answer.tilt),
            wind("yaw (m/s)", &answer.yaw),
            phase("phase of tilt (deg)", &answer.tilt),
            phase("phase of yaw (deg)", &answer.yaw),
        ],
        mark,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_a_scaled_and_shifted_truth() {
        let truth: Vec<f64> = (0..1000).map(|index| (0.1 * f64::from(index)).sin()).collect();
        let estimated: Vec<f64> = truth.iter().map(|truth| 0.8 * truth + 0.3).collect();
        let found = numbers(&estimated, &truth, &[0.3; 1000]);
        let mean = truth.iter().sum::<f64>() / 1000.0;
        assert!((found.bias - (0.3 - 0.2 * mean)).abs() < 1e-12);
        assert!((found.correlation - 1.0).abs() < 1e-12 && (found.ratio - 0.8).abs() < 1e-12);
        // Errors of 0.3 − 0.2 sin: within 0.3 while the sine is not below zero, and hence half of the time.
        assert!((found.within.expect("known") - 0.5).abs() < 0.01);
        assert_eq!(numbers(&estimated, &truth, &[]).within, None);
        let square = truth.iter().map(|sine| (0.3 - 0.2 * sine).powi(2)).sum::<f64>() / 1000.0;
        assert!((found.rmse - square.sqrt()).abs() < 1e-12);
    }
}
