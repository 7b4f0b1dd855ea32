//! Estimates over the time of a series, and how well they know their own errors.

use super::{column, mean};
use crate::PostprocessingError;
use analysis::statistics::statistic;
use basis::Channel;
use basis::angle::wrap_to_half_turn;
use basis::channels::{
    EST_TRUST, EST_WIND, EST_WIND_DEV, EST_WIND_WAVES, EstimatedWave, PREVIEW_LAG, PREVIEW_SHARE,
};
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
    /// Share that came from a lidar (–), and its lag (s); none without a preview.
    pub(super) preview: Option<[Vec<f64>; 2]>,
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

/// How far an estimate came through a lidar that sees the helix ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviewUse {
    /// Mean share of it that came from the lidar (–), the rest from the blade loads.
    pub share: f64,
    /// Mean time by which that share lagged, since less than half a period of the helix was seen ahead (s); 0
    /// where it never came from there.
    pub lag: f64,
}

impl PreviewUse {
    /// What the samples `share` (–) and `lag` (s) come to.
    pub(super) fn of(share: &[f64], lag: &[f64]) -> Self {
        let seen: f64 = share.iter().sum();
        let lagged: f64 = share.iter().zip(lag).map(|(share, lag)| share * lag).sum();
        Self { share: mean(share), lag: if seen > 0.0 { lagged / seen } else { 0.0 } }
    }
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
    let preview = [PREVIEW_SHARE, PREVIEW_LAG].map(|channel| series.column(&channel.at(name)));
    let [share, lag] = preview.map(|samples| samples.map(<[f64]>::to_vec));
    Ok(Estimates {
        wind: channel(&EST_WIND)?,
        wind_deviation: channel(&EST_WIND_DEV)?,
        tilt: wave(&tilt)?,
        yaw: wave(&yaw)?,
        trust: channel(&EST_TRUST)?,
        preview: share.zip(lag).map(|(share, lag)| [share, lag]),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_preview_lags_where_it_counts() {
        // What it would lag by where it is blind does not matter: the loads tell there.
        let found = PreviewUse::of(&[1.0, 0.5, 0.0, 0.5], &[2.0, 2.0, 50.0, 6.0]);
        assert_eq!(found, PreviewUse { share: 0.5, lag: 3.0 });
        assert_eq!(PreviewUse::of(&[0.0], &[50.0]), PreviewUse { share: 0.0, lag: 0.0 });
    }

    #[test]
    fn what_a_run_recorded_of_its_preview_is_read_with_its_estimate() {
        let [tilt, yaw] = EST_WIND_WAVES;
        let of_wave = |wave: EstimatedWave| {
            [wave.amplitude, wave.phase, wave.phase_deviation, wave.deviation]
        };
        let estimate = [EST_WIND, EST_WIND_DEV, EST_TRUST].into_iter();
        let estimate: Vec<Channel> = estimate.chain(of_wave(tilt)).chain(of_wave(yaw)).collect();
        let series = |channels: &[Channel]| Series {
            names: channels.iter().map(|channel| channel.at("T2")).collect(),
            columns: (0..channels.len()).map(|place| vec![place as f64]).collect(),
        };
        let without = recorded(&series(&estimate), "T2").expect("all channels");
        assert!(without.preview.is_none() && without.trust == [2.0]);
        let all = [estimate, vec![PREVIEW_LAG, PREVIEW_SHARE]].concat();
        let with = recorded(&series(&all), "T2").expect("all channels");
        assert_eq!(with.preview, Some([vec![12.0], vec![11.0]]));
    }
}
