//! The Kalman filter proper: prediction of the states, correction by the moments, adaptation of the noise.

use super::leftover::Leftover;
use super::options::{Adaptation, HelixOptions};
use super::rotor::{Expected, WINDS};
use super::state_estimate::{
    BIAS, MEAN_WIND, N_STATES, PASSING, RATE, RESPONSE, StateEstimate, Vector, WAVE,
};
use super::trust::TrustMonitor;
use super::wave::Axis;
use basis::angle::wrap_to_half_turn;
use basis::mbc::{blade_azimuth, to_fixed_frame};
use basis::{FixedFrame, PerBlade, Sense};
use lti::lag::kept;
use serde::{Deserialize, Serialize};

/// Standard deviation of the mean wind at the start (m/s).
const INITIAL_WIND: f64 = 1.0;
/// Standard deviation of the constant tilt and yaw at the start over the mean wind (–).
const INITIAL_BIAS: f64 = 0.15;
/// Standard deviation of the excitation rate at the start over the nominal rate (–).
const INITIAL_RATE: f64 = 0.03;
/// Standard deviation of an unknown phase (rad).
const INITIAL_PHASE: f64 = 1.8;

/// Parameters.
#[derive(Clone, Debug)]
pub(super) struct Filter {
    pub(super) options: HelixOptions,
    pub(super) sense: Sense,
    /// Excitation rate (rad/s).
    pub(super) rate: f64,
    /// Rotor diameter (m).
    pub(super) diameter: f64,
    /// Time that a reading stands for (s): from update to update as set. A late reading is no better for it.
    pub(super) interval: f64,
    pub(super) n_blades: usize,
}

/// State of the filter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FilterState {
    pub(super) estimate: StateEstimate,
    pub(super) monitor: TrustMonitor,
    /// Adapted noise intensity of the moments over that of the options (–).
    measurement: f64,
    /// What has been left of the readings over since the intensity was adapted last.
    leftover: Leftover,
    /// Adapted variance of the eddies (m²/s²).
    eddies: f64,
    /// Adapted process noise intensity of the wave over that of the options (–).
    process_noise: f64,
    /// Instantaneous wind from the blade moments (m/s).
    pub(super) instantaneous: FixedFrame,
    /// Wind equivalent of the rotor's own pitch at the last update, tilt and yaw (m/s).
    pub(super) pitch_wind: [f64; 2],
    /// Which amplitudes the last correction turned over.
    pub(super) turned: [bool; 2],
}

/// Slopes of the wind's average, tilt and yaw over the states.
#[derive(Clone, Copy, Debug)]
pub(super) struct WindSlopes {
    average: Vector,
    tilt: Vector,
    yaw: Vector,
}

/// Instant of an update, and the predicted wind.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant {
    /// Time since the last update (s).
    pub(super) interval: f64,
    /// Angle of the excitation (rad).
    pub(super) angle: f64,
    /// Azimuth of blade 1 (rad).
    pub(super) azimuth: f64,
    /// Wind in the fixed frame (m/s).
    pub(super) wind: FixedFrame,
    /// Wind equivalent of the rotor's pitch, tilt and yaw (m/s).
    pub(super) pitch_wind: [f64; 2],
}

/// Blade-root moments (N m), where they are usable.
pub(super) type Readings = PerBlade<Option<f64>>;

impl Filter {
    pub(super) fn blank(&self) -> FilterState {
        FilterState {
            estimate: StateEstimate::zero(),
            monitor: TrustMonitor::default(),
            measurement: 1.0,
            leftover: Leftover::new(self.n_blades),
            eddies: self.options.eddies.map_or(0.0, |eddies| eddies.deviation.powi(2)),
            process_noise: 1.0,
            instantaneous: FixedFrame::default(),
            pitch_wind: [0.0; 2],
            turned: [false; 2],
        }
    }

    /// The initial state when only the mean `wind` (m/s) is known.
    pub(super) fn start(&self, wind: f64) -> StateEstimate {
        let HelixOptions { form, noise, bias, rate, .. } = self.options;
        let mut estimate = StateEstimate::zero();
        let mut variances = [0.0; N_STATES];
        estimate.mean[MEAN_WIND] = wind;
        variances[MEAN_WIND] = INITIAL_WIND.powi(2);
        let amplitude = noise.initial_amplitude;
        for index in (0..4).filter(|index| form.is_used(*index)) {
            let phase = form.is_phase(index);
            variances[WAVE + index] = if phase { INITIAL_PHASE } else { amplitude }.powi(2);
            // A phase has no slope where there is no amplitude to begin with.
            if !phase && form.is_phase(1) {
                estimate.mean[WAVE + index] = amplitude;
            }
        }
        if bias.is_some() {
            variances[BIAS..BIAS + 2].fill((INITIAL_BIAS * wind).powi(2));
        }
        if let Some(eddies) = self.options.eddies {
            variances[PASSING..PASSING + 2].fill(eddies.deviation.powi(2));
        }
        if let Some(response) = self.options.response {
            variances[RESPONSE..RESPONSE + 2].fill(response * response);
        }
        if rate.is_some() {
            variances[RATE] = (INITIAL_RATE * self.rate).powi(2);
        }
        let pairs = self.pairs(|index| variances[WAVE + index]);
        estimate.spread(&variances, &pairs);
        estimate
    }

    /// Prediction over `interval` (s).
    pub(super) fn predict(&self, interval: f64, state: &mut FilterState) {
        let HelixOptions { form, noise, bias, eddies, rate, .. } = self.options;
        let mut incoming = [0.0; N_STATES];
        if rate.is_some() {
            self.turn(interval, &mut state.estimate);
        }
        incoming[MEAN_WIND] = noise.mean_wind * interval;
        // The process noise of the wave scales with the variance of the eddies, so that the filter keeps its
        // bandwidth: with adapted eddies alone it would become ever slower, and a slow filter takes the helix
        // for eddies.
        let stirred = eddies.map_or(1.0, |eddies| state.eddies / eddies.deviation.powi(2));
        for index in (0..4).filter(|index| form.is_used(*index)) {
            let density = if form.is_phase(index) { noise.phase } else { noise.amplitude };
            incoming[WAVE + index] = stirred * state.process_noise * density * interval;
        }
        incoming[BIAS..BIAS + 2].fill(bias.unwrap_or(0.0) * interval);
        incoming[RATE] = rate.unwrap_or(0.0) * interval;
        if let Some(eddies) = eddies {
            let kept = self.kept(eddies, interval, state.estimate.mean[MEAN_WIND]);
            for index in [PASSING, PASSING + 1] {
                state.estimate.mean[index] *= kept;
                for other in 0..N_STATES {
                    state.estimate.covariance[index][other] *= kept;
                    state.estimate.covariance[other][index] *= kept;
                }
                incoming[index] = state.eddies * (1.0 - kept * kept);
            }
        }
        let pairs = self.pairs(|index| incoming[WAVE + index]);
        state.estimate.spread(&incoming, &pairs);
    }

    /// The fixed frame's wind (m/s) at `angle` (rad) of the excitation where the states are `mean`, and its
    /// derivatives by them; `pitch_wind` is the wind equivalent of the rotor's pitch, tilt and yaw (m/s).
    pub(super) fn wind(
        &self,
        mean: &Vector,
        angle: f64,
        pitch_wind: [f64; 2],
    ) -> (FixedFrame, WindSlopes) {
        let swing = self.options.form.swing(self.sense, &mean[WAVE..WAVE + 4], angle);
        let mut slopes =
            WindSlopes { average: [0.0; N_STATES], tilt: [0.0; N_STATES], yaw: [0.0; N_STATES] };
        slopes.average[MEAN_WIND] = 1.0;
        slopes.tilt[WAVE..WAVE + 4].copy_from_slice(&swing.tilt_slopes);
        slopes.yaw[WAVE..WAVE + 4].copy_from_slice(&swing.yaw_slopes);
        for lasting in [BIAS, PASSING] {
            slopes.tilt[lasting] = 1.0;
            slopes.yaw[lasting + 1] = 1.0;
        }
        slopes.tilt[RESPONSE..RESPONSE + 2].copy_from_slice(&[pitch_wind[0], -pitch_wind[1]]);
        slopes.yaw[RESPONSE..RESPONSE + 2].copy_from_slice(&[pitch_wind[1], pitch_wind[0]]);
        let missed = [
            mean[RESPONSE] * pitch_wind[0] - mean[RESPONSE + 1] * pitch_wind[1],
            mean[RESPONSE] * pitch_wind[1] + mean[RESPONSE + 1] * pitch_wind[0],
        ];
        let wind = FixedFrame {
            average: mean[MEAN_WIND],
            tilt: swing.tilt + mean[BIAS] + mean[PASSING] + missed[0],
            yaw: swing.yaw + mean[BIAS + 1] + mean[PASSING + 1] + missed[1],
        };
        (wind, slopes)
    }

    /// Corrects `state` by the `readings` of `now`, given the `expected` moments and their `slopes` over the
    /// states; gives the number of blades used.
    pub(super) fn correct(
        &self,
        now: &Instant,
        expected: &Expected,
        slopes: &PerBlade<Vector>,
        readings: &Readings,
        state: &mut FilterState,
    ) -> usize {
        (state.pitch_wind, state.turned) = (now.pitch_wind, [false; 2]);
        let n_blades = readings.len();
        let mean_moment = expected.moments.mean().abs();
        let nominal = self.options.noise.measurement.variance(self.interval, mean_moment);
        let variance = nominal * state.measurement;
        let limit = self.options.huber_limit.unwrap_or(f64::INFINITY);
        let before = state.estimate.mean;
        let (mut n_used, mut square) = (0, 0.0);
        for blade in 0..n_blades {
            let Some(reading) = readings[blade] else { continue };
            let slopes = &slopes[blade];
            let moved: f64 =
                (0..N_STATES).map(|k| slopes[k] * (state.estimate.mean[k] - before[k])).sum();
            let innovation = reading - expected.moments[blade] - moved;
            let spread = state.estimate.variance_along(slopes);
            let total = spread + variance;
            let distance = innovation.abs() / total.sqrt();
            let inflation = (distance / limit).max(1.0);
            let inflated = inflation * total - spread;
            state.estimate.correct(slopes, innovation, inflated);
            n_used += 1;
            square += (distance * distance).min(1e6);
            let residual = innovation * inflated / (inflation * total);
            let most = limit * variance.sqrt();
            let left_spread = state.estimate.variance_along(slopes);
            state.leftover.add(blade, residual.clamp(-most, most), left_spread, nominal);
        }
        if n_used == 0 {
            return 0;
        }
        state.turned = self.options.form.tidy(&mut state.estimate);
        state.estimate.mean[MEAN_WIND] = state.estimate.mean[MEAN_WIND].clamp(WINDS[0], WINDS[1]);
        if n_used == n_blades {
            self.record_instantaneous_wind(now, expected, readings, state);
        }
        let n = n_used as f64;
        state.monitor.compare(now.interval, self.rate, square / n);
        if let Some(adaptation) = self.options.adaptation {
            self.learn(now.interval, adaptation, &before, state);
        }
        n_used
    }

    /// Slopes of each blade's moment over the states, by the chain rule, blade 1 at `azimuth` (rad).
    pub(super) fn blade_slopes(
        azimuth: f64,
        expected: &Expected,
        wind: &WindSlopes,
    ) -> PerBlade<Vector> {
        let n_blades = expected.slopes.len();
        let places =
            PerBlade::from_fn(n_blades, |blade| blade_azimuth(azimuth, blade, n_blades).sin_cos());
        let mut slopes = PerBlade::splat(n_blades, [0.0; N_STATES]);
        for index in 0..N_STATES {
            let [average, tilt, yaw] = [wind.average[index], wind.tilt[index], wind.yaw[index]];
            let still = PerBlade::from_fn(n_blades, |blade| {
                let (sine, cosine) = places[blade];
                expected.slopes[blade] * (average + tilt * cosine + yaw * sine)
            });
            let bent = expected.bend.apply(&still);
            for (slopes, bent) in slopes.iter_mut().zip(bent.iter()) {
                slopes[index] = *bent;
            }
        }
        slopes
    }

    pub(super) fn axes(&self, estimate: &StateEstimate) -> [Axis; 2] {
        self.options.form.axes(estimate)
    }

    /// Records the instantaneous wind: the predicted one plus the innovation of the moments in terms of wind.
    fn record_instantaneous_wind(
        &self,
        now: &Instant,
        expected: &Expected,
        readings: &Readings,
        state: &mut FilterState,
    ) {
        let over = PerBlade::from_fn(readings.len(), |blade| {
            readings[blade].map_or(0.0, |reading| reading - expected.moments[blade])
        });
        let over = expected.bend.undo(&over);
        let over = PerBlade::from_fn(over.len(), |blade| {
            let slope = expected.slopes[blade];
            if slope > 0.0 { over[blade] / slope } else { 0.0 }
        });
        let over = to_fixed_frame(now.azimuth, &over);
        state.instantaneous = FixedFrame {
            average: now.wind.average + over.average,
            tilt: now.wind.tilt + over.tilt,
            yaw: now.wind.yaw + over.yaw,
        };
        let mean = &state.estimate.mean;
        let (pitch_wind, missed) = (now.pitch_wind, &mean[RESPONSE..RESPONSE + 2]);
        let passing = FixedFrame {
            tilt: state.instantaneous.tilt - mean[BIAS] - missed[0] * pitch_wind[0]
                + missed[1] * pitch_wind[1],
            yaw: state.instantaneous.yaw
                - mean[BIAS + 1]
                - missed[0] * pitch_wind[1]
                - missed[1] * pitch_wind[0],
            ..state.instantaneous
        };
        // Moments that no wind can cause would spoil the running means for periods.
        if passing.tilt.abs().max(passing.yaw.abs()) < WINDS[1] {
            state.monitor.observe(now.interval, self.rate, now.angle, passing);
        }
    }

    /// Adapts the noise over the `interval` (s); `before` are the states before the correction.
    fn learn(
        &self,
        interval: f64,
        adaptation: Adaptation,
        before: &Vector,
        state: &mut FilterState,
    ) {
        let share = 1.0 - kept(interval, adaptation.time_constant);
        let bound = adaptation.bound * adaptation.bound;
        if let Some((over, left)) = state.leftover.take(interval, self.interval) {
            let share = 1.0 - kept(over, adaptation.time_constant);
            state.measurement += share * (left - state.measurement);
            state.measurement = state.measurement.clamp(1.0 / bound, bound);
        }
        let StateEstimate { mean, covariance } = &state.estimate;
        if let Some(eddies) = self.options.eddies {
            // Expected square of the eddies' states: square of the mean plus variance.
            let square = |k: usize| mean[k] * mean[k] + covariance[k][k];
            let seen = 0.5 * (square(PASSING) + square(PASSING + 1));
            let nominal = eddies.deviation * eddies.deviation;
            state.eddies += share * (seen - state.eddies);
            state.eddies = state.eddies.clamp(nominal / bound, nominal * bound);
        }
        if adaptation.wave {
            // In a steady filter the corrections have the variance of the process noise.
            let noise = self.options.noise;
            let (mut sum, mut n) = (0.0, 0.0);
            for index in (0..4).filter(|index| self.options.form.is_used(*index)) {
                let phase = self.options.form.is_phase(index);
                let density = if phase { noise.phase } else { noise.amplitude };
                let step = wrap_if(phase, mean[WAVE + index] - before[WAVE + index]);
                sum += step * step / (density * interval);
                n += 1.0;
            }
            state.process_noise += share * (sum / n - state.process_noise);
            state.process_noise = state.process_noise.clamp(1.0 / bound, bound);
        }
    }

    /// Covariances of the process noise of tilt and yaw, where `variance` is that of each state of the wave.
    fn pairs(&self, variance: impl Fn(usize) -> f64) -> [(usize, usize, f64); 2] {
        let mut pairs = [(WAVE, WAVE + 1, 0.0); 2];
        for (pair, (a, b)) in pairs.iter_mut().zip(self.options.form.pairs()) {
            let covariance = self.options.roundness * (variance(*a) * variance(*b)).sqrt();
            *pair = (WAVE + a, WAVE + b, covariance);
        }
        pairs
    }
}

fn wrap_if(phase: bool, angle: f64) -> f64 {
    if phase { wrap_to_half_turn(angle) } else { angle }
}
