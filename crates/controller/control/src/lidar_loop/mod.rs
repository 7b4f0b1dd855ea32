//! The lidar loop: the hub vortex of the own wake, seen by a lidar, is held where it is wanted in the frame
//! that turns with the helix.
//!
//! ```text
//!  reference ──>(+)──error──> law (a file) ──> limits ──>(+)──> tilt, yaw in the helix frame ──> blades
//!                ^-                                       ^
//!  lidar ──> hub vortex in the helix frame                open helix
//! ```
//!
//! Source: Chen, van Vondelen, van Wingerden (2026), "Lidar-enhanced closed-loop active helix approach",
//! Wind Energ. Sci. 11, 1871, section 3.3. The law of `wakemix synthesize` holds the Smith predictor of its
//! Fig. 7. Laws made at several wind speeds make a family, which is blended by the wind that is measured; the
//! paper has one law, at one wind speed.
//!
//! What the paper leaves open: the command is limited in size and rate and the law learns of it by
//! back-calculation; a lidar that has been blind for too long fades the loop out to the open helix. A loop
//! that fades out does so wholly before it closes again: its law would go on from the wake of before.

mod checks;
mod family;
mod findings;
mod kind;
mod watch;

pub(crate) use checks::no_lidar;
pub use findings::MEAN_HUB_VORTEX;
pub(crate) use findings::{CHANNELS, findings};
pub use kind::LIDAR_LOOP;
pub(crate) use watch::{Watch, WatchState};

use crate::controller::{ForeignState, from_bytes, to_bytes};
use crate::excitation::{Excitation, add, share, words};
use crate::samples::Samples;
use basis::mbc::to_blades;
use basis::{Channel, FixedFrame, HelixFrame, Measurements, PerBlade, channels};
use family::{Family, FamilyState};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Settings of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Settings {
    frame: HelixFrame,
    /// Amplitude of the open helix, for words (rad), and its Strouhal number (–).
    amplitude: f64,
    strouhal: f64,
    /// The open helix in its frame (rad).
    helix: [f64; 2],
    azimuth_offset: f64,
    /// Where the hub vortex is to be in the helix frame: tilt, yaw (m).
    reference: [f64; 2],
    /// Times at which the helix and the loop begin (s).
    starts: [f64; 2],
    /// Longest time without a vortex after which the loop fades out (s).
    blind_after: f64,
    /// Least confidence with which it is taken to be seen (–).
    least_trust: f64,
    limits: Limits,
}

/// Limits of what the loop adds.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limits {
    /// Greatest length of tilt and yaw in the helix frame (rad).
    size: f64,
    /// Greatest rate of their change (rad/s).
    rate: f64,
}

impl Limits {
    /// `wanted` (rad) brought within what can be reached `interval` (s) after it was `before` (rad);
    /// directions are kept.
    fn limited(&self, wanted: [f64; 2], before: [f64; 2], interval: f64) -> [f64; 2] {
        let wanted = shortened(wanted, self.size);
        let step = shortened([0, 1].map(|axis| wanted[axis] - before[axis]), self.rate * interval);
        [0, 1].map(|axis| before[axis] + step[axis])
    }
}

/// `components` no longer than `most`; nothing where they are no numbers.
fn shortened(components: [f64; 2], most: f64) -> [f64; 2] {
    let length = components[0].hypot(components[1]);
    if length <= most {
        components
    } else if length.is_finite() {
        components.map(|component| component * most / length)
    } else {
        [0.0; 2]
    }
}

/// The loop as it runs on one turbine.
#[derive(Clone, Debug)]
pub struct LidarLoop {
    settings: Settings,
    watch: Watch,
    family: Family,
    state: LoopState,
}

/// What time changes of it beside the watch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct LoopState {
    laws: FamilyState,
    samples: Samples,
    /// Whether the law steps; it begins at rest.
    closed: bool,
    /// What the law asks for within what can be reached until it is asked again (rad), in the helix frame.
    wanted: [f64; 2],
    /// Share of it that is to be given (–).
    share: f64,
    /// What is added (rad), in the helix frame.
    correction: [f64; 2],
    /// Tilt and yaw that are pitched, in the helix frame (rad).
    commands: [f64; 2],
}

impl LidarLoop {
    /// The loop with the laws of a `family`, which are at rest in `laws`.
    fn new(settings: Settings, watch: Watch, family: Family, laws: FamilyState) -> Self {
        let state = LoopState {
            laws,
            samples: Samples::NONE,
            closed: false,
            wanted: [0.0; 2],
            share: 0.0,
            correction: [0.0; 2],
            commands: [0.0; 2],
        };
        Self { settings, watch, family, state }
    }

    /// Tilt and yaw (rad) in the helix frame at the instant of `measurements`.
    fn advance(&mut self, measurements: &Measurements) -> [f64; 2] {
        let Self { settings, watch, family, state } = self;
        let time = measurements.time;
        watch.update(measurements);
        family.watch_wind(&mut state.laws, measurements);
        let due = state.samples.due(time, family.interval);
        let seen = watch.vortex().filter(|vortex| {
            vortex.settled
                && vortex.trust >= settings.least_trust
                && watch.blind() <= settings.blind_after
                && time >= settings.starts[1]
                && family.is_known(&state.laws)
        });
        state.closed = seen.is_some() && (state.closed || state.share == 0.0);
        let step = measurements.interval * settings.frame.rate / TAU;
        // A law begins at rest: it need not fade in.
        state.share = if state.closed { 1.0 } else { (state.share - step).max(0.0) };
        if let (true, true, Some(vortex)) = (due, state.closed, seen) {
            let errors = [0, 1].map(|axis| settings.reference[axis] - vortex.helix[axis]);
            let before = state.correction;
            family.step_within(&mut state.laws, &errors, |wanted| {
                let wanted = wanted.map(f64::to_radians);
                state.wanted = settings.limits.limited(wanted, before, family.interval);
                state.wanted.map(f64::to_degrees)
            });
        }
        if state.share == 0.0 && !state.closed {
            // What was known of the wake is of no use any more.
            state.laws.reset();
            state.wanted = [0.0; 2];
        }
        let target = state.wanted.map(|wanted| state.share * wanted);
        let before = state.correction;
        state.correction = settings.limits.limited(target, before, measurements.interval);
        let open = share(time, settings.starts[0], None, settings.frame.rate);
        [0, 1].map(|axis| open * settings.helix[axis] + state.correction[axis])
    }
}

impl Excitation for LidarLoop {
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        let commands = self.advance(measurements);
        self.state.commands = commands;
        let [tilt, yaw] = self.settings.frame.to_fixed(measurements.time, commands);
        let azimuth = measurements.azimuth + self.settings.azimuth_offset;
        let added = to_blades(azimuth, FixedFrame { average: 0.0, tilt, yaw }, pitch.len());
        add(pitch, &added);
    }

    fn describe(&self) -> String {
        let Settings { frame, amplitude, strouhal, .. } = self.settings;
        words(&format!("lidar loop {}", frame.sense), amplitude, strouhal)
    }

    fn signals(&self) -> Vec<Channel> {
        let mut signals = channels::of_lidar_loop();
        signals.extend(self.family.schedule.as_ref().map(|_| channels::LOOP_WIND));
        signals
    }

    fn write_signals(&self, values: &mut [f64]) {
        let (commands, rest) = values.split_at_mut(2);
        commands.copy_from_slice(&self.state.commands);
        let (watched, rest) = rest.split_at_mut(channels::HUB_VORTEX.len());
        self.watch.write_signals(watched);
        rest[0] = self.state.share;
        if let (Some(shown), Some(wind)) = (rest.get_mut(1), self.state.laws.wind()) {
            *shown = wind;
        }
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&(&self.state, self.watch.save()))
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let (state, watch): (LoopState, WatchState) = from_bytes(state)?;
        self.state = state;
        self.watch.restore(watch);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
