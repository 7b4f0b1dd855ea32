//! The true wind that a filter is tuned to, and the process noise that it shows.

use super::options::positive;
use crate::EstimationError;
use basis::Sense;
use basis::angle::wrap_to_half_turn;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// The true wind at each sample of a record, filtered once: what a filter is tuned to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrueWave {
    /// Mean wind over the disc (m/s).
    pub average: Vec<f64>,
    /// Amplitudes of tilt and yaw (m/s).
    pub amplitudes: [Vec<f64>; 2],
    /// Phases of tilt and yaw (rad, any turn), as an estimate has them: the yaw's without the lead of its
    /// sense.
    pub phases: [Vec<f64>; 2],
}

/// Process noise intensities: variances per time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProcessNoise {
    /// Of the mean wind ((m/s)²/s).
    pub mean_wind: f64,
    /// Of the amplitude ((m/s)²/s).
    pub amplitude: f64,
    /// Of the phase (rad²/s).
    pub phase: f64,
    /// Of each sine and cosine component ((m/s)²/s).
    pub component: f64,
}

/// Amplitude (m/s) and phase (rad, unwrapped from the first) of the component of `signal` (m/s) at `rate`
/// (rad/s), sampled every `interval` (s) from `start` (s) on: A sin(ω t + φ), averaged around each sample
/// with weights that fall linearly to zero a period away.
///
/// The first and last period have no value: the columns begin a period after `start`.
///
/// # Errors
/// [`EstimationError`] for a record shorter than three periods, a rate above the Nyquist rate, or a sample
/// that is no number.
pub fn wave(
    signal: &[f64],
    start: f64,
    interval: f64,
    rate: f64,
) -> Result<(Vec<f64>, Vec<f64>), EstimationError> {
    positive("sampling interval (s)", interval)?;
    positive("excitation rate (rad/s)", rate)?;
    if rate * interval >= PI {
        let (rotor_speed, nyquist) = (0.0, PI / interval);
        return Err(EstimationError::AboveNyquist { rate, rotor_speed, interval, nyquist });
    }
    finite("the signal", signal)?;
    let period = (TAU / rate / interval).round() as usize;
    if signal.len() < 3 * period {
        let (n_samples, needed) = (signal.len(), 3 * period);
        return Err(EstimationError::TooShort { n_samples, needed, purpose: "a wave's phase" });
    }
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let turn = |index: usize| (rate * (start + index as f64 * interval)).sin_cos();
    let part = |(index, value): (usize, &f64)| 2.0 * (value - mean) * turn(index).0;
    let sines: Vec<f64> = signal.iter().enumerate().map(part).collect();
    let part = |(index, value): (usize, &f64)| 2.0 * (value - mean) * turn(index).1;
    let cosines: Vec<f64> = signal.iter().enumerate().map(part).collect();
    let twice = |column: &[f64]| moving_mean(&moving_mean(column, period), period);
    let (mut amplitudes, mut phases) = (Vec::new(), Vec::new());
    for (sine, cosine) in twice(&sines).into_iter().zip(twice(&cosines)) {
        amplitudes.push(sine.hypot(cosine));
        let phase = cosine.atan2(sine);
        let last = phases.last().copied().unwrap_or(phase);
        phases.push(last + wrap_to_half_turn(phase - last));
    }
    Ok((amplitudes, phases))
}

/// Mean of each `n` successive values.
fn moving_mean(column: &[f64], n: usize) -> Vec<f64> {
    let mut sum: f64 = column[..n].iter().sum();
    let mut means = vec![sum / n as f64];
    for index in n..column.len() {
        sum += column[index] - column[index - n];
        means.push(sum / n as f64);
    }
    means
}

impl TrueWave {
    /// From the true fixed-frame winds `average`, `tilt` and `yaw` (m/s) sampled every `interval` (s) from
    /// `start` (s) on, unfiltered, with the yaw of `sense`: amplitudes and phases as [`wave`] gives them. The
    /// first and last period repeat their neighbours.
    ///
    /// # Errors
    /// Those of [`wave`], and columns of different length.
    pub fn of_winds(
        [average, tilt, yaw]: [&[f64]; 3],
        start: f64,
        interval: f64,
        rate: f64,
        sense: Sense,
    ) -> Result<Self, EstimationError> {
        let mut found = Self { average: average.to_vec(), ..Self::default() };
        for (axis, (signal, lead)) in [(tilt, 0.0), (yaw, sense.yaw_lead())].into_iter().enumerate()
        {
            let (amplitudes, phases) = wave(signal, start, interval, rate)?;
            let half = (signal.len() - phases.len()) / 2;
            let at = |index: usize| index.saturating_sub(half).min(phases.len() - 1);
            found.amplitudes[axis] = (0..signal.len()).map(|index| amplitudes[at(index)]).collect();
            found.phases[axis] = (0..signal.len()).map(|index| phases[at(index)] - lead).collect();
        }
        found.check(average.len())?;
        Ok(found)
    }

    /// That all columns have `expected` samples.
    pub(super) fn check(&self, expected: usize) -> Result<(), EstimationError> {
        let columns = [
            ("the true mean wind", &self.average),
            ("the true tilt amplitude", &self.amplitudes[0]),
            ("the true yaw amplitude", &self.amplitudes[1]),
            ("the true tilt phase", &self.phases[0]),
            ("the true yaw phase", &self.phases[1]),
        ];
        for (name, column) in columns {
            let found = column.len();
            if found != expected {
                return Err(EstimationError::Length { name, found, expected });
            }
            finite(name, column)?;
        }
        Ok(())
    }

    /// The samples in `range`.
    pub(super) fn part(&self, range: Range<usize>) -> Self {
        let cut = |column: &Vec<f64>| column[range.clone()].to_vec();
        Self {
            average: cut(&self.average),
            amplitudes: self.amplitudes.each_ref().map(cut),
            phases: self.phases.each_ref().map(cut),
        }
    }
}

/// Process noise intensities of mean wind and helix, from the `truth` sampled every `interval` (s): Algorithm
/// 1, step 2. Mean squares of the changes over an excitation period, of `rate` (rad/s), per time.
///
/// A filtered signal is smooth: its changes from sample to sample grow with the interval, so that their
/// squares per time tell the interval, not the wind. Over a period, as long as filters remember, they do not.
///
/// # Errors
/// [`EstimationError`] for a truth that is shorter than two periods, or whose columns differ in length.
pub fn process_noise(
    truth: &TrueWave,
    interval: f64,
    rate: f64,
) -> Result<ProcessNoise, EstimationError> {
    positive("sampling interval (s)", interval)?;
    positive("excitation rate (rad/s)", rate)?;
    truth.check(truth.average.len())?;
    let lag = ((TAU / rate / interval).round() as usize).max(1);
    let (n_samples, needed) = (truth.average.len(), 2 * lag);
    if n_samples < needed {
        return Err(EstimationError::TooShort { n_samples, needed, purpose: "process noise" });
    }
    let per_time = |column: &[f64]| {
        let squares = column.iter().zip(&column[lag..]).map(|(from, to)| (to - from).powi(2));
        squares.sum::<f64>() / (column.len() - lag) as f64 / (lag as f64 * interval)
    };
    let both = |of: &dyn Fn(usize) -> f64| 0.5 * (of(0) + of(1));
    let component = |axis: usize| {
        let part = |of: fn(f64) -> f64| -> Vec<f64> {
            let waves = truth.amplitudes[axis].iter().zip(&truth.phases[axis]);
            waves.map(|(amplitude, phase)| amplitude * of(*phase)).collect()
        };
        0.5 * (per_time(&part(f64::cos)) + per_time(&part(f64::sin)))
    };
    Ok(ProcessNoise {
        mean_wind: per_time(&truth.average),
        amplitude: both(&|axis| per_time(&truth.amplitudes[axis])),
        phase: both(&|axis| per_time(&unwrapped(&truth.phases[axis]))),
        component: both(&component),
    })
}

/// `phases` (rad) without jumps of a turn.
fn unwrapped(phases: &[f64]) -> Vec<f64> {
    let mut last = phases.first().copied().unwrap_or_default();
    let turned = phases.iter().map(|phase| {
        last += wrap_to_half_turn(phase - last);
        last
    });
    turned.collect()
}

pub(super) fn finite(name: &'static str, signal: &[f64]) -> Result<(), EstimationError> {
    match signal.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => {
            let (value, expected) = (signal[index], "a finite number");
            Err(EstimationError::Sample { name, index, value, expected })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_gives_amplitude_and_phase() {
        let (rate, interval, sense) = (TAU / 100.0, 0.5, Sense::CounterClockwise);
        let signal: Vec<f64> = (0..4000)
            .map(|k| 3.0 + 0.8 * (rate * (7.0 + interval * f64::from(k)) + 1.2).sin())
            .collect();
        let winds = [&signal[..]; 3];
        let truth = TrueWave::of_winds(winds, 7.0, interval, rate, sense).unwrap();
        let [tilt, yaw] = &truth.phases;
        assert!(truth.amplitudes.iter().flatten().all(|a| (a - 0.8).abs() < 1e-9));
        assert!(tilt.iter().all(|phase| (phase - 1.2).abs() < 1e-9));
        assert!(yaw.iter().all(|phase| (phase - 1.2 + 0.5 * PI).abs() < 1e-9));
        let found = process_noise(&TrueWave { average: vec![3.0; 4000], ..truth }, interval, rate);
        let ProcessNoise { mean_wind, amplitude, phase, component } = found.unwrap();
        assert!([mean_wind, amplitude, phase, component].iter().all(|noise| *noise < 1e-18));
        let short =
            TrueWave::of_winds([&signal, &signal, &signal[1..]], 0.0, interval, rate, sense);
        assert!(matches!(short, Err(EstimationError::Length { .. })));
    }

    /// A smooth truth, as filters leave it, has the same intensities at every sampling interval; those of
    /// steps from sample to sample would be five times as large at a five times longer one.
    #[test]
    fn process_noise_does_not_depend_on_the_interval() {
        let rate = TAU / 100.0;
        let truth = |interval: f64| {
            let swing = |amplitude: f64, period: f64| -> Vec<f64> {
                let times = (0..(4000.0 / interval) as usize).map(|k| interval * k as f64);
                times.map(|time| amplitude * (TAU * time / period).sin()).collect()
            };
            let amplitudes = swing(0.2, 370.0).iter().map(|a| 1.0 + a).collect::<Vec<_>>();
            TrueWave {
                average: swing(0.5, 410.0),
                amplitudes: [amplitudes.clone(), amplitudes],
                phases: [swing(0.4, 333.0), swing(0.6, 290.0)],
            }
        };
        let [fine, coarse] = [0.1, 0.5].map(|dt| process_noise(&truth(dt), dt, rate).unwrap());
        let alike = |fine: f64, coarse: f64| (coarse / fine - 1.0).abs() < 0.01 && fine > 1e-6;
        assert!(alike(fine.mean_wind, coarse.mean_wind), "{fine:?} {coarse:?}");
        assert!(alike(fine.amplitude, coarse.amplitude), "{fine:?} {coarse:?}");
        assert!(alike(fine.phase, coarse.phase), "{fine:?} {coarse:?}");
        assert!(alike(fine.component, coarse.component), "{fine:?} {coarse:?}");
        // Of A sin ωt the changes over a lag T have the mean square 2 A² sin²(ωT/2).
        let expected = 2.0 * (0.5 * (TAU * 100.0 / 410.0 / 2.0).sin()).powi(2) / 100.0;
        assert!((fine.mean_wind / expected - 1.0).abs() < 0.05, "{} {expected}", fine.mean_wind);
    }
}
