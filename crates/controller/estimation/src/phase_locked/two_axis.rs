//! Phase-locked loop for two signals of a turbine: tilt and yaw moments of its blades, followed by one
//! oscillator.

use super::PhaseLockedError;
use super::generator::{Generator, is_usable};
use super::lock::Lock;
use super::oscillator::{LONGEST_TURN, Oscillator};
use super::single::PhaseLockedSettings;
use crate::{Estimator, Oscillation, Quantity};
use basis::angle::wrap_to_turn;
use basis::mbc::to_fixed_frame;
use basis::{FixedFrame, Measurements, Sense};
use serde::{Deserialize, Serialize};

/// Which signal the oscillator follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Leader {
    /// The tilt moment alone.
    Tilt,
    /// The yaw moment alone, without its lead.
    Yaw,
    /// Both, each with the weight of its amplitude.
    #[default]
    Both,
}

/// Settings of a phase-locked loop for two axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoAxisSettings {
    /// Generator of each, and the loop.
    pub signal: PhaseLockedSettings,
    /// Sense in which the load circles, looking downwind; the yaw moment leads the tilt moment by
    /// [`Sense::yaw_lead`]. van Veldhoven (2024), Eq. 2-5, whose signs of yaw and sense are the opposite of
    /// ours.
    pub sense: Sense,
    /// Which signal the oscillator follows.
    pub leader: Leader,
}

/// Estimate of one axis, b + A sin θ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Amplitude A (N m).
    pub amplitude: f64,
    /// Offset b (N m); zero where the generator does not estimate it.
    pub offset: f64,
    /// Phase of this axis' own signal (rad, [0, 2π)).
    pub phase: f64,
}

/// Estimate of a rotor's slow oscillation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TwoAxisEstimate {
    /// Phase θ of the oscillation, the tilt moment's (rad, [0, 2π)).
    pub phase: f64,
    /// Rate of the phase (rad/s).
    pub rate: f64,
    /// Tilt moment.
    pub tilt: Axis,
    /// Yaw moment.
    pub yaw: Axis,
    /// Whether the loop has locked.
    pub locked: bool,
    /// Whether the last moments were unusable and the estimate was held.
    pub held: bool,
}

/// A phase-locked loop over the blades' tilt and yaw moments; serialises whole.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TwoAxisLoop {
    leader: Leader,
    sense: Sense,
    tilt: Generator,
    yaw: Generator,
    oscillator: Oscillator,
    lock: Lock,
    held: bool,
}

impl TwoAxisLoop {
    /// A loop of `settings` for measurements every `interval` (s).
    ///
    /// # Errors
    /// Those of [`PhaseLockedLoop::new`](super::PhaseLockedLoop::new).
    pub fn new(settings: &TwoAxisSettings, interval: f64) -> Result<Self, PhaseLockedError> {
        let generator = settings.signal.checked(interval)?;
        Ok(Self {
            leader: settings.leader,
            sense: settings.sense,
            tilt: generator,
            yaw: generator,
            oscillator: Oscillator::new(&settings.signal.follower),
            lock: Lock::new(),
            held: false,
        })
    }

    /// Takes in `moments` (N m, fixed frame), `interval` (s) after the ones before.
    ///
    /// Where either is unusable, or comes after a long gap, both axes turn on as before, and
    /// [`TwoAxisEstimate::held`] is true.
    pub fn follow(&mut self, interval: f64, moments: FixedFrame) -> TwoAxisEstimate {
        let turned = self.oscillator.turn(interval);
        self.held = turned > LONGEST_TURN || !is_usable(moments.tilt) || !is_usable(moments.yaw);
        if self.held {
            self.tilt.coast(turned);
            self.yaw.coast(turned);
            self.oscillator.coast();
            self.lock.miss(turned);
        } else {
            self.tilt.update(turned, moments.tilt);
            self.yaw.update(turned, moments.yaw);
            let ([in_phase, quadrature], residual) = self.led();
            self.oscillator.follow(in_phase, quadrature);
            let amplitude = in_phase.hypot(quadrature);
            let (error, limited) = (self.oscillator.error(), self.oscillator.is_limited());
            self.lock.update(turned, error, residual, amplitude, limited);
        }
        self.estimate()
    }

    /// Vector that the oscillator follows, in the tilt axis' phase, and the residual that goes with it (N m).
    fn led(&self) -> ([f64; 2], f64) {
        let tilt = [self.tilt.in_phase(), self.tilt.quadrature()];
        let (sine, cosine) = self.sense.yaw_lead().sin_cos();
        // A sin(θ − lead) and −A cos(θ − lead) of the yaw axis' θ.
        let [x, y] = [self.yaw.in_phase(), self.yaw.quadrature()];
        let yaw = [x * cosine + y * sine, y * cosine - x * sine];
        let residuals = [self.tilt.residual(), self.yaw.residual()];
        match self.leader {
            Leader::Tilt => (tilt, residuals[0]),
            Leader::Yaw => (yaw, residuals[1]),
            Leader::Both => {
                ([tilt[0] + yaw[0], tilt[1] + yaw[1]], residuals[0].hypot(residuals[1]))
            }
        }
    }

    /// Root mean square of the oscillator's phase error, an exponential mean over one period of the
    /// oscillation (rad): the criterion of the lock, 1 before the first sample.
    pub fn phase_error(&self) -> f64 {
        self.lock.phase_error()
    }

    /// The present estimate.
    pub fn estimate(&self) -> TwoAxisEstimate {
        let phase = self.oscillator.phase();
        let axis = |generator: &Generator| Axis {
            amplitude: generator.amplitude(),
            offset: generator.offset(),
            phase: wrap_to_turn(
                phase + self.oscillator.lead_of(generator.in_phase(), generator.quadrature()),
            ),
        };
        TwoAxisEstimate {
            phase,
            rate: self.oscillator.rate(),
            tilt: axis(&self.tilt),
            yaw: axis(&self.yaw),
            locked: self.lock.is_locked(),
            held: self.held,
        }
    }
}

impl Estimator for TwoAxisLoop {
    type Estimate = TwoAxisEstimate;
    type State = Self;

    /// The estimate after the blades' out-of-plane moments of this instant.
    fn update(&mut self, measurements: &Measurements) -> TwoAxisEstimate {
        let moments = to_fixed_frame(measurements.azimuth, &measurements.flap_moments);
        self.follow(measurements.interval, moments)
    }

    fn state(&self) -> &Self {
        self
    }

    fn restore(&mut self, state: Self) {
        *self = state;
    }
}

impl From<TwoAxisEstimate> for Oscillation {
    fn from(estimate: TwoAxisEstimate) -> Self {
        let TwoAxisEstimate { rate, tilt, yaw, locked, held, .. } = estimate;
        Self {
            quantity: Quantity::Load,
            rate,
            phases: [tilt.phase, yaw.phase],
            amplitudes: [tilt.amplitude, yaw.amplitude],
            trust: f64::from(u8::from(locked)),
            held,
        }
    }
}
