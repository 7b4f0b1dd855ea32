//! Estimates over the time of a series, and how well they know their own errors.

use super::column;
use crate::PostprocessingError;
use analysis::statistics::statistic;
use basis::Channel;
use basis::angle::wrap_to_half_turn;
use basis::channels::{EST_TRUST, EST_WIND, EST_WIND_DEV, EST_WIND_WAVES, EstimatedWave};
use basis::records::{Series, Statistic};

/// Estimates over the time of a series.
#[derive(Default)]
pub(crate) struct Estimates {
    pub(super) wind: Vec<f64>,
    /// Standard deviation that the estimator has of it (m/s); empty where it is not known.
    pub(super) wind_deviation: Vec<f64>,
    pub(super) tilt: Wave,
    pub(super) yaw: Wave,
    pub(super) trust: Vec<f64>,
}

#[derive(Default)]
pub(super) struct Wave {
    pub(super) amplitude: Vec<f64>,
    pub(super) phase: Vec<f64>,
    /// Standard deviation that the estimator has of the phase (rad); empty where it is not known.
    pub(super) deviation: Vec<f64>,
    /// Standard deviation that it has of the wave's wind (m/s); empty where it is not known.
    pub(super) wind_deviation: Vec<f64>,
}

/// Estimate of turbine `name` during the run.
pub(crate) fn recorded(series: &Series, name: &str) -> Result<Estimates, PostprocessingError> {
    let channel = |what: &Channel| column(series, &what.at(name)).map(<[f64]>::to_vec);
    let wave = |estimated: &EstimatedWave| {
        Ok::<Wave, PostprocessingError>(Wave {
            amplitude: channel(&estimated.amplitude)?,
            phase: channel(&estimated.phase)?,
            deviation: channel(&estimated.phase_deviation)?,
            wind_deviation: channel(&estimated.deviation)?,
        })
    };
    let [tilt, yaw] = EST_WIND_WAVES;
    Ok(Estimates {
        wind: channel(&EST_WIND)?,
        wind_deviation: channel(&EST_WIND_DEV)?,
        tilt: wave(&tilt)?,
        yaw: wave(&yaw)?,
        trust: channel(&EST_TRUST)?,
    })
}

/// Mean of the squared errors of `phase` against `truth` (rad) over the square of their `deviation` (rad),
/// one each `interval` (s), with its interval from blocks of `block` (s).
///
/// Source: Bar-Shalom, Li, Kirubarajan, "Estimation with Applications to Tracking and Navigation", 2001, §5.4
/// (normalised estimation error squared). Its bounds by chi-square take errors as independent from instant to
/// instant; these last as long as the filter remembers, so that the interval is that of block means.
pub(super) fn consistency(
    phase: &[f64],
    truth: &[f64],
    deviation: &[f64],
    interval: f64,
    block: f64,
) -> Result<Statistic, PostprocessingError> {
    let squares = phase.iter().zip(truth).zip(deviation).map(|((phase, truth), deviation)| {
        (wrap_to_half_turn(phase - truth) / deviation.max(f64::MIN_POSITIVE)).powi(2)
    });
    Ok(statistic(&squares.collect::<Vec<_>>(), interval, block)?)
}
