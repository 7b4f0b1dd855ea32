//! The helix ahead of its arrival: its phase from the scans of a lidar that looks upwind.
//!
//! What a lidar sees `s` ahead of the rotor is at its place a time of travel later (Taylor's frozen
//! turbulence), so that the wind of half a period before and half a period after an instant is known at that
//! instant. Least squares over that whole period ([`window`]) have no lag, where a filter over loads, which
//! knows the past alone, lags by its memory.
//!
//! The helix is that of the wind at the rotor's place without the rotor, against which estimates are judged;
//! air that the rotor slows comes some 10° later, which is left out. So the time of travel is the distance
//! over the free speed. That is the mean over the scan's points, each with the square of its distance from
//! the axis, as which a slope in the wind weighs it, for it is the slopes that are carried; brought to the
//! free speed where a rotor of the given induction slows the air at the scan ([`slowing`]); smoothed over a
//! period. An error of a percent in that speed turns the phase by a percent of the time of travel: 1.8°
//! where half a period is looked ahead.
//!
//! What is not known is taken as it is best: lines of sight as if they came from the rotor's centre (a lidar
//! a few metres behind it sees everything a percent too strong), winds across the line of sight as none.

mod slowing;
mod window;

use super::estimate::HelixEstimate;
use super::trust::Trust;
use super::wave::{Axis, UNKNOWN_PHASE};
use crate::EstimationError;
use basis::angle::wrap_to_turn;
use basis::scan::Scan;
use basis::{FixedFrame, Sense};
use lti::lag::kept;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use window::{Fit, N_AXIS, N_SLOTS, Slots, TILT, Unknowns};

/// Coverage of a window (–) up to which the preview counts for nothing, and from which it counts for all.
const COVERAGE: [f64; 2] = [0.5, 0.9];
/// Excitation periods over which the steadiness of the found wave is judged (–).
const JUDGING: f64 = 4.0;
/// Longest look ahead (excitation periods) that is of use: its slots would take the place of those of now.
const LONGEST: f64 = 6.0;
/// Least share (–) of the axial wind that a line of sight must show: 60° off the axis. Beyond that noise and
/// the wind across the line, which is taken as none, would count more than the axial wind does.
const LEAST_ALONG: f64 = 0.5;
/// Slowest wind (m/s) that carries anything to the rotor.
const SLOWEST: f64 = 0.5;

/// What a preview is told of the helix and its turbine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviewSettings {
    /// Sense of the helix.
    pub sense: Sense,
    /// Excitation rate (rad/s).
    pub rate: f64,
    /// Radius of the rotor (m).
    pub radius: f64,
    /// Speed at which the helix travels over the free one that the scan shows (–).
    pub speed_factor: f64,
}

/// Estimates the wave of a helix from the scans of a lidar that looks upwind.
#[derive(Clone, Debug)]
pub struct PreviewEstimator {
    settings: PreviewSettings,
    state: PreviewState,
}

/// State of the preview; a run restored from it continues with the same bits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PreviewState {
    slots: Slots,
    /// Time of the newest point that was used (s), and how long its air takes to the rotor (s).
    newest: Option<[f64; 2]>,
    /// Sums over the points seen, older ones fading over a period: of squared distances from the axis (in
    /// radii) times free speeds (m/s), and of the former alone.
    speeds: [f64; 2],
    steadiness: Steadiness,
}

/// What a preview tells of the helix at the rotor now.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PreviewEstimate {
    /// Helix in the tilt component.
    pub tilt: Axis,
    /// Helix in the yaw component; its phase is without the sense's lead of yaw over tilt.
    pub yaw: Axis,
    /// Confidence in the phases.
    pub trust: Trust,
    /// How much of the estimate is to be this one's (–): 1 where the lidar sees, 0 where it is blind.
    pub share: f64,
    /// How long the air that the lidar sees takes to the rotor (s); 0 before it saw any.
    pub ahead: f64,
    /// By how much the estimate lags since that is less than half a period (s).
    pub lag: f64,
}

/// How steadily the found wave keeps its phase: running means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Steadiness {
    /// Sine and cosine components of tilt and yaw (m/s).
    mean: [f64; 4],
    /// Their sum of squares (m²/s²).
    square: f64,
    weight: f64,
}

impl Steadiness {
    /// Takes in the `wave`, with a `share` of the means (–).
    fn observe(&mut self, share: f64, wave: [f64; 4]) {
        for (mean, component) in self.mean.iter_mut().zip(wave) {
            *mean += share * (component - *mean);
        }
        let square: f64 = wave.iter().map(|component| component * component).sum();
        self.square += share * (square - self.square);
        self.weight += share * (1.0 - self.weight);
    }

    /// Near 1 for a helix, near 0 for turbulence alone (–).
    fn coherence(&self) -> f64 {
        if self.square <= 0.0 {
            return 0.0;
        }
        let mean: f64 = self.mean.iter().map(|mean| mean * mean).sum();
        let steady = mean / (self.square * self.weight);
        // Means over one period forget each other within a period: what chance leaves of them in an
        // exponential mean over several.
        let chance = 1.0 / (1.0 + self.weight * (2.0 * JUDGING - 1.0));
        ((steady - chance) / (1.0 - chance)).clamp(0.0, 1.0)
    }
}

impl PreviewEstimator {
    /// One that has seen nothing.
    ///
    /// # Errors
    /// [`EstimationError::Setting`] for a rate, radius or factor that is not above zero.
    pub fn new(settings: PreviewSettings) -> Result<Self, EstimationError> {
        use super::options::positive;
        positive("excitation rate (rad/s)", settings.rate)?;
        positive("rotor radius (m)", settings.radius)?;
        positive("speed of the helix over the scan's (–)", settings.speed_factor)?;
        let state = PreviewState {
            slots: Slots::empty(),
            newest: None,
            speeds: [0.0; 2],
            steadiness: Steadiness::default(),
        };
        Ok(Self { settings, state })
    }

    /// Period of the helix (s).
    pub fn period(&self) -> f64 {
        TAU / self.settings.rate
    }

    /// Least distance (m) at which a wind of `speed` (m/s) must be seen for an estimate without lag: what it
    /// covers in half a period.
    pub fn least_distance(&self, speed: f64) -> f64 {
        0.5 * speed * self.period()
    }

    /// Free speed of the wind that carries the helix (m/s); none before it was seen.
    pub fn speed(&self) -> Option<f64> {
        let [weighted, weights] = self.state.speeds;
        (weights > 0.0).then(|| weighted / weights)
    }

    /// Takes in what of `scan` was measured since the last one, if there is a scan, and gives the helix at
    /// the rotor at `time` (s), an `interval` (s) after the last one; `induction` (–) is the axial one of the
    /// rotor where the air ahead of it shows that.
    pub fn update(
        &mut self,
        (time, interval): (f64, f64),
        scan: Option<&Scan>,
        induction: f64,
    ) -> PreviewEstimate {
        if let Some(scan) = scan {
            self.take_in(interval, scan, induction);
        }
        self.estimate(time, interval)
    }

    fn take_in(&mut self, interval: f64, scan: &Scan, induction: f64) {
        let PreviewSettings { radius, rate, speed_factor, .. } = self.settings;
        let period = TAU / rate;
        let [before, _] = self.state.newest.unwrap_or([f64::NEG_INFINITY; 2]);
        let free = |point: Point| {
            let share = slowing::speed_share(point.upstream, radius, induction);
            Point { wind: point.wind / share, ..point }
        };
        let points = (0..scan.n_points()).filter_map(|index| point(scan, index));
        let fresh = points.filter(|point| point.time > before).map(free);
        let (mut speeds, mut newest) = ([0.0; 2], before);
        for point in fresh.clone() {
            let weight = (point.up * point.up + point.right * point.right) / (radius * radius);
            speeds[0] += weight * point.wind;
            speeds[1] += weight;
            newest = newest.max(point.time);
        }
        if newest == before {
            return;
        }
        let passed = if before.is_finite() { newest - before } else { interval };
        let kept = kept(passed, period);
        for (sum, new) in self.state.speeds.iter_mut().zip(speeds) {
            *sum = kept * *sum + new;
        }
        let Some(speed) = self.speed() else { return };
        let carried = (speed_factor * speed).max(SLOWEST);
        let slot = period / N_SLOTS as f64;
        let mut furthest = 0.0_f64;
        for point in fresh {
            let ahead = point.upstream / carried;
            if ahead > LONGEST * period {
                continue;
            }
            let arrival = point.time + ahead;
            let number = (arrival / slot).floor() as i64;
            let factors = factors(&point, arrival, &self.settings);
            self.state.slots.add(number, &factors, point.wind);
            furthest = furthest.max(ahead);
        }
        self.state.newest = Some([newest, furthest]);
    }

    fn estimate(&mut self, time: f64, interval: f64) -> PreviewEstimate {
        let period = self.period();
        let ahead = self.state.newest.map_or(0.0, |[_, ahead]| ahead);
        let lag = (0.5 * period - ahead).max(0.0);
        let slot = period / N_SLOTS as f64;
        // The window ends half a period after now, or with the newest air that could be seen.
        let last = ((time + 0.5 * period - lag) / slot).floor() as i64;
        let coverage = self.state.slots.coverage(last);
        let fit = self.state.slots.fit(last).filter(|_| coverage > COVERAGE[0]);
        let Some(fit) = fit else { return PreviewEstimate { ahead, lag, ..PreviewEstimate::NONE } };
        let share = ((coverage - COVERAGE[0]) / (COVERAGE[1] - COVERAGE[0])).min(1.0);
        let [tilt, yaw] = [0, 1].map(|axis| self.axis(&fit, axis));
        let wave = [0, 1].map(|axis| components(&fit.found, axis));
        let judged = 1.0 - kept(interval, JUDGING * period);
        self.state.steadiness.observe(judged, [wave[0][0], wave[0][1], wave[1][0], wave[1][1]]);
        let variance = tilt.phase_variance.max(yaw.phase_variance);
        let trust = Trust {
            certainty: (-0.5 * variance).exp(),
            coherence: self.state.steadiness.coherence(),
            consistency: 1.0,
        };
        PreviewEstimate { tilt, yaw, trust, share, ahead, lag }
    }

    /// The wave of `axis`, 0 tilt and 1 yaw, in `fit`.
    ///
    /// What is left over is taken for eddies that live half a diameter over the speed, as the load-based
    /// filter's: a component over a period T of noise with the spectral density S at its frequency varies by
    /// 2 S/T.
    fn axis(&self, fit: &Fit, axis: usize) -> Axis {
        let PreviewSettings { radius, rate, .. } = self.settings;
        let lives = radius / self.speed().unwrap_or(SLOWEST).max(SLOWEST);
        let density = 2.0 * fit.left_over[axis] * lives / (1.0 + (rate * lives).powi(2));
        let variance = 2.0 * density / self.period();
        let [sine, cosine] = components(&fit.found, axis);
        let amplitude = sine.hypot(cosine);
        let phase_variance = variance / (amplitude * amplitude).max(f64::MIN_POSITIVE);
        Axis {
            amplitude,
            amplitude_variance: variance,
            phase: wrap_to_turn(cosine.atan2(sine)),
            phase_variance: phase_variance.min(UNKNOWN_PHASE),
        }
    }

    /// The state.
    pub fn state(&self) -> &PreviewState {
        &self.state
    }

    /// Continues with the same bits from `state`, which came from a preview with the same settings.
    pub fn restore(&mut self, state: PreviewState) {
        self.state = state;
    }
}

/// Sine and cosine component of `axis` in `found` (m/s).
fn components(found: &Unknowns, axis: usize) -> [f64; 2] {
    let at = TILT + N_AXIS * axis;
    [found[at + 1], found[at + 2]]
}

/// A point of a scan ahead of the rotor.
#[derive(Clone, Copy)]
struct Point {
    time: f64,
    /// Places ahead of the rotor, above its centre and to the right of it, looking downwind (m).
    upstream: f64,
    up: f64,
    right: f64,
    /// Axial wind (m/s).
    wind: f64,
}

/// Point number `index` of `scan`; none where it has no speed, does not lie ahead of the rotor, or shows less
/// than [`LEAST_ALONG`] of the axial wind.
fn point(scan: &Scan, index: usize) -> Option<Point> {
    let (downwind, left, up) = (scan.downwind()[index], scan.left()[index], scan.up()[index]);
    let (speed, time) = (scan.speeds()[index], scan.times()[index]);
    let along = downwind / (downwind * downwind + left * left + up * up).sqrt();
    let wind = speed / along;
    let is_ahead = along <= -LEAST_ALONG && wind.is_finite() && time.is_finite();
    is_ahead.then_some(Point { time, upstream: -downwind, up, right: -left, wind })
}

/// What each unknown counts for at `point`, whose air arrives at `arrival` (s).
fn factors(point: &Point, arrival: f64, settings: &PreviewSettings) -> Unknowns {
    let [up, right] = [point.up, point.right].map(|place| 2.0 * place / settings.radius);
    let angle = settings.rate * arrival;
    let (sine, cosine) = angle.sin_cos();
    let (yaw_sine, yaw_cosine) = (angle + settings.sense.yaw_lead()).sin_cos();
    [1.0, up, up * sine, up * cosine, right, right * yaw_sine, right * yaw_cosine]
}

impl PreviewEstimate {
    /// Of a lidar that sees nothing.
    const NONE: Self = Self {
        tilt: Axis::UNKNOWN,
        yaw: Axis::UNKNOWN,
        trust: Trust { certainty: 0.0, coherence: 0.0, consistency: 0.0 },
        share: 0.0,
        ahead: 0.0,
        lag: 0.0,
    };
}

impl Axis {
    const UNKNOWN: Self =
        Self { amplitude: 0.0, amplitude_variance: 0.0, phase: 0.0, phase_variance: UNKNOWN_PHASE };

    /// `share` (–) of `other` in the place of its own: phases by their directions, the rest linearly.
    fn blended(self, other: Self, share: f64) -> Self {
        let mean = |own: f64, other: f64| (1.0 - share) * own + share * other;
        let direction = [f64::sin, f64::cos].map(|of| mean(of(self.phase), of(other.phase)));
        Self {
            amplitude: mean(self.amplitude, other.amplitude),
            amplitude_variance: mean(self.amplitude_variance, other.amplitude_variance),
            phase: wrap_to_turn(direction[0].atan2(direction[1])),
            phase_variance: mean(self.phase_variance, other.phase_variance),
        }
    }
}

impl HelixEstimate {
    /// It, with the wave of `preview` in the place of its own as far as the lidar sees; mean wind and what is
    /// not the helix stay its own.
    pub fn with_preview(self, preview: &PreviewEstimate) -> Self {
        let share = preview.share;
        if share == 0.0 {
            return self;
        }
        let mean = |own: f64, other: f64| (1.0 - share) * own + share * other;
        let tilt = self.tilt.blended(preview.tilt, share);
        let yaw = self.yaw.blended(preview.yaw, share);
        let yaw_angle = self.angle + self.sense.yaw_lead() + yaw.phase;
        let own = self.helix_deviation;
        let seen = [preview.tilt, preview.yaw].map(|axis| axis.amplitude_variance.sqrt());
        let trust = |of: fn(&Trust) -> f64| mean(of(&self.trust), of(&preview.trust));
        Self {
            tilt,
            yaw,
            helix: FixedFrame {
                average: 0.0,
                tilt: tilt.amplitude * (self.angle + tilt.phase).sin(),
                yaw: yaw.amplitude * yaw_angle.sin(),
            },
            helix_deviation: [0, 1].map(|axis| mean(own[axis], seen[axis])),
            trust: Trust {
                certainty: trust(|trust| trust.certainty),
                coherence: trust(|trust| trust.coherence),
                consistency: trust(|trust| trust.consistency),
            },
            ..self
        }
    }
}

#[cfg(test)]
mod tests;
