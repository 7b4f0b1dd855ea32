//! Meandering synchronised: cyclic pitch in phase with a slow oscillation of the rotor's own loads, which it
//! amplifies to mix the wake or attenuates to spare the turbine.
//!
//! A phase-locked loop tells phase, amplitude and offset of tilt and yaw moment. Each axis' amplitude is
//! brought to a factor α of the baseline's by proportional and integral action, and what that asks for is
//! multiplied with the phase:
//!
//! ```text
//! tilt pitch = −(A_tilt sin(θ + λ) + b_tilt)/g          yaw pitch = −(A_yaw sin(θ ± π/2 + λ) + b_yaw)/g
//! ```
//!
//! with amplitudes A and offsets b that are to be added to the load (N m), the loss g of moment per pitch,
//! the lead λ that makes up for the load's delay, and the upper sign for a load that circles
//! counter-clockwise looking downwind. The blades' pitch follows by the inverse multi-blade transformation
//! with an azimuth offset.
//!
//! Source: van Veldhoven, "Closed-Loop Wake Meandering Control of Downstream Wind Turbines", TU Delft 2024,
//! Eqs. 2-37 to 2-40, 4-2; the azimuth offset by [`Decoupling::from_senses`], which the source leaves to
//! trial.

mod axis;
mod decoupling;
mod design;
mod kind;
mod outcome;
mod reference;
mod settings;

pub use decoupling::{Answer, Decoupling, relative_gain};
pub use design::{Followed, MeanderingControlSettings, MeanderingError};
pub use estimation::phase_locked::{Leader, PhaseLockedError, TwoAxisEstimate, TwoAxisSettings};
pub use kind::MEANDERING;
pub use reference::Reference;
pub use settings::MeanderingSettings;

use crate::controller::{ForeignState, from_bytes, to_bytes};
use crate::excitation::{Excitation, add};
use axis::AxisLoop;
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use basis::mbc::{to_blades, to_fixed_frame};
use basis::{Channel, FixedFrame, Measurements, PerBlade};
use estimation::phase_locked::{Axis, TwoAxisLoop};
use reference::Baseline;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Meandering control of one turbine; serialises whole, state included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meandering {
    settings: MeanderingControlSettings,
    follower: TwoAxisLoop,
    baseline: Baseline,
    tilt: AxisLoop,
    yaw: AxisLoop,
    /// Share of the command that is given (–).
    authority: f64,
    /// Tilt and yaw pitch last given (rad).
    commands: FixedFrame,
    /// Azimuth (rad) and rotor speed (rad/s) last read, to turn on by where they are not.
    azimuth: f64,
    rotor_speed: f64,
}

impl Meandering {
    /// Control with `settings` for measurements every `interval` (s).
    ///
    /// # Errors
    /// [`MeanderingError`] names what cannot be used; gains that would not be stable come with the pole that
    /// is not.
    pub fn new(
        settings: MeanderingControlSettings,
        interval: f64,
    ) -> Result<Self, MeanderingError> {
        settings.check()?;
        let follower = TwoAxisLoop::new(&settings.follower, interval)?;
        if settings.maximum_amplitude > 0.0 {
            settings.amplitude_loop().check(&settings.follower.signal)?;
        }
        Ok(Self {
            settings,
            follower,
            baseline: Baseline::default(),
            tilt: AxisLoop::default(),
            yaw: AxisLoop::default(),
            authority: 0.0,
            commands: FixedFrame::default(),
            azimuth: 0.0,
            rotor_speed: 0.0,
        })
    }

    /// Takes in `measurements` and adds the command of each blade to `pitch` (rad).
    ///
    /// Begins without a step, and fades out over a period whenever the loop loses the lock that it
    /// [needs](MeanderingControlSettings::needs_lock).
    pub fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        let interval = measurements.interval;
        let moments = to_fixed_frame(measurements.azimuth, &measurements.flap_moments);
        let own = match self.settings.followed {
            Followed::Load => FixedFrame::default(),
            Followed::Wake => {
                let before = self.follower.estimate();
                self.own(self.angles(&before, before.rate * interval))
            }
        };
        let [tilt, yaw] = [moments.tilt - own.tilt, moments.yaw - own.yaw];
        let estimate = self.follower.follow(interval, FixedFrame { average: 0.0, tilt, yaw });
        self.turn(measurements);
        self.learn(measurements, &estimate);
        let MeanderingControlSettings { reference, factor, start, .. } = self.settings;
        let amplitudes = self.baseline.amplitudes(estimate.rate, reference);
        let only_monitors = self.settings.only_monitors();
        let acts = self.trusts(&estimate)
            && !only_monitors
            && measurements.time >= start
            && amplitudes.is_some();
        let slew = interval * estimate.rate / TAU;
        self.authority = (self.authority + if acts { slew } else { -slew }).clamp(0.0, 1.0);
        if let Some([tilt, yaw]) = amplitudes
            && acts
            && !estimate.held
        {
            let loads = self.loads(&estimate);
            self.tilt.update(interval, &loads[0], factor * tilt, &self.settings);
            self.yaw.update(interval, &loads[1], factor * yaw, &self.settings);
        }
        if self.authority == 0.0 {
            self.commands = FixedFrame::default();
            return;
        }
        self.commands = self.target_pitch(&estimate);
        let azimuth = self.azimuth + self.settings.decoupling.azimuth_offset;
        let added = to_blades(azimuth, self.commands, pitch.len());
        add(pitch, &added);
    }

    /// Angles (rad) that pitch on tilt and yaw is meant for, `further` (rad) than the estimate: a quarter
    /// period apart, or, where the wake's own part is followed, each axis its own.
    fn angles(&self, estimate: &TwoAxisEstimate, further: f64) -> [f64; 2] {
        let angles = match self.settings.followed {
            Followed::Load => {
                [estimate.phase, estimate.phase + self.settings.follower.sense.yaw_lead()]
            }
            Followed::Wake => [estimate.tilt.phase, estimate.yaw.phase],
        };
        angles.map(|angle| angle + further)
    }

    /// What pitch adds to tilt and yaw moment (N m) when it is meant for `angles` (rad).
    fn own(&self, angles: [f64; 2]) -> FixedFrame {
        let load = |axis: &AxisLoop, angle: f64| {
            self.authority * (axis.added_amplitude() * angle.sin() + axis.added_offset())
        };
        let (tilt, yaw) = (load(&self.tilt, angles[0]), load(&self.yaw, angles[1]));
        FixedFrame { average: 0.0, tilt, yaw }
    }

    /// Tilt and yaw pitch (rad) that adds it `delay` later. van Veldhoven (2024), Eq. 2-40.
    fn target_pitch(&self, estimate: &TwoAxisEstimate) -> FixedFrame {
        let Decoupling { delay, gain, .. } = self.settings.decoupling;
        let load = self.own(self.angles(estimate, delay * estimate.rate));
        FixedFrame { average: 0.0, tilt: -load.tilt / gain, yaw: -load.yaw / gain }
    }

    /// The load on each axis, the wake's part and what pitch adds together; below zero where pitch adds more
    /// than it should.
    fn loads(&self, estimate: &TwoAxisEstimate) -> [Axis; 2] {
        let estimated = [estimate.tilt, estimate.yaw];
        if self.settings.followed == Followed::Load {
            return estimated;
        }
        let added = [&self.tilt, &self.yaw];
        std::array::from_fn(|index| Axis {
            amplitude: estimated[index].amplitude + self.authority * added[index].added_amplitude(),
            offset: estimated[index].offset + self.authority * added[index].added_offset(),
            phase: estimated[index].phase,
        })
    }

    /// Where the rotor stands; it turns on at its last speed where the encoder gives no number.
    fn turn(&mut self, measurements: &Measurements) {
        if measurements.rotor_speed.is_finite() {
            self.rotor_speed = measurements.rotor_speed;
        }
        self.azimuth = if measurements.azimuth.is_finite() {
            measurements.azimuth
        } else {
            wrap_to_turn(self.azimuth + self.rotor_speed * measurements.interval)
        };
    }

    fn trusts(&self, estimate: &TwoAxisEstimate) -> bool {
        estimate.locked || !self.settings.needs_lock
    }

    /// Keeps the baseline's amplitudes up while the loop is trusted.
    fn learn(&mut self, measurements: &Measurements, estimate: &TwoAxisEstimate) {
        let MeanderingControlSettings { reference, start, .. } = self.settings;
        let early = match reference {
            Reference::Learned { duration } => measurements.time < start - duration,
            Reference::Given { .. } | Reference::Observed => false,
        };
        if early || !self.trusts(estimate) || estimate.held {
            return;
        }
        let added = match self.settings.followed {
            Followed::Load => {
                [&self.tilt, &self.yaw].map(|axis| self.authority * axis.added_amplitude())
            }
            Followed::Wake => [0.0; 2],
        };
        let angles = self.angles(estimate, 0.0);
        let ahead = [estimate.tilt.phase - angles[0], estimate.yaw.phase - angles[1]]
            .map(wrap_to_half_turn);
        let axes = [&estimate.tilt, &estimate.yaw];
        let interval = measurements.interval;
        self.baseline.update(interval, estimate.rate, reference, axes, added, ahead);
    }

    /// Estimate of what is [`Followed`].
    pub fn estimate(&self) -> TwoAxisEstimate {
        self.follower.estimate()
    }

    /// Amplitudes of tilt and yaw moment that it takes for the baseline's (N m); nothing while they are being
    /// learned.
    pub fn baseline(&self) -> Option<[f64; 2]> {
        self.baseline.amplitudes(self.estimate().rate, self.settings.reference)
    }

    /// Tilt and yaw pitch last added (rad).
    pub fn commands(&self) -> FixedFrame {
        self.commands
    }

    /// Share of the command that is given (–), up to one while it acts.
    pub fn authority(&self) -> f64 {
        self.authority
    }

    /// Settings of the control.
    pub fn settings(&self) -> &MeanderingControlSettings {
        &self.settings
    }
}

impl Excitation for Meandering {
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        Meandering::add_to(self, pitch, measurements);
    }

    fn describe(&self) -> String {
        if self.settings.only_monitors() {
            return "baseline, monitoring meandering".to_owned();
        }
        format!("meandering × {} {}", self.settings.factor, self.settings.follower.sense)
    }

    fn signals(&self) -> Vec<Channel> {
        basis::channels::of_meandering()
    }

    fn write_signals(&self, values: &mut [f64]) {
        let estimate = self.estimate();
        // Zero while it is not known yet.
        let [tilt_reference, yaw_reference] = self.baseline().unwrap_or_default();
        values.copy_from_slice(&[
            estimate.rate,
            estimate.phase,
            estimate.tilt.amplitude,
            estimate.yaw.amplitude,
            estimate.tilt.phase,
            estimate.yaw.phase,
            estimate.tilt.offset,
            estimate.yaw.offset,
            tilt_reference,
            yaw_reference,
            f64::from(u8::from(estimate.locked)),
            self.authority,
            self.commands.tilt,
            self.commands.yaw,
        ]);
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(self)
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        *self = from_bytes(state)?;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
