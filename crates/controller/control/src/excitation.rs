//! Periodic pitch on top of the baseline, to mix the wake: the helix and the pulse.
//!
//! # The sense of the helix
//!
//! Symbols of van Vondelen et al. (2025), Eqs. 1-7: A amplitude, ω_e excitation rate, ω_r rotor speed, φ phase,
//! ψ_i = ω_r t + ψ_i0 azimuth of blade i, ψ_o azimuth offset. The fixed-frame commands are (Eq. 2)
//!
//! ```text
//! tilt = A sin(ω_e t + φ)            yaw = A sin(ω_e t + φ ± π/2) = ± A cos(ω_e t + φ)
//! ```
//!
//! and blade i pitches by tilt cos(ψ_i + ψ_o) + yaw sin(ψ_i + ψ_o) (Eq. 5). With the upper sign the sum is
//! sin(ω_e t + φ) cos(…) + cos(ω_e t + φ) sin(…), hence
//!
//! ```text
//! upper sign:  β_i =  A sin((ω_r + ω_e) t + ψ_i0 + ψ_o + φ)     rotor + excitation frequency: ccw
//! lower sign:  β_i = −A sin((ω_r − ω_e) t + ψ_i0 + ψ_o − φ)     rotor − excitation frequency: cw
//! ```
//!
//! The second line carries a minus that Eq. 7 leaves out; it is half a turn of phase and changes no frequency.
//! Here **ccw is the upper sign: blades pitch at rotor frequency plus excitation frequency**.

mod helix;
mod pulse;

pub use basis::Sense;
pub use helix::Helix;
pub use pulse::Pulse;

use crate::meandering::Meandering;
use crate::phase_sync::{PhaseSync, SyncState};
use basis::{Measurements, PerBlade};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// What is added to the baseline's pitch.
#[derive(Clone, Debug, Default)]
pub enum Excitation {
    /// Nothing.
    #[default]
    None,
    /// Individual pitch that moves the thrust centre on a circle.
    Helix(Helix),
    /// Collective pitch, periodic.
    Pulse(Pulse),
    /// Individual pitch that joins the helix that comes from upstream.
    PhaseSync(Box<PhaseSync>),
    /// Individual pitch that amplifies or attenuates a slow oscillation of the turbine's own loads.
    Meandering(Box<Meandering>),
}

/// Everything of an excitation that time changes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum ExcitationState {
    /// It follows from time alone.
    #[default]
    None,
    /// Of [`Excitation::PhaseSync`].
    PhaseSync(Box<SyncState>),
    /// Of [`Excitation::Meandering`].
    Meandering(Box<Meandering>),
}

impl Excitation {
    /// Adds the excitation at `measurements.time` to `pitch` (rad); amplitude zero leaves every bit as it was.
    pub fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        let silent = self.amplitude() == 0.0;
        let added = match self {
            Self::PhaseSync(sync) => sync.pitch(measurements),
            Self::Meandering(meandering) => return meandering.add_to(pitch, measurements),
            _ if silent => return,
            Self::None => return,
            Self::Helix(helix) => helix.pitch(measurements.time, measurements.azimuth, pitch.len()),
            Self::Pulse(pulse) => PerBlade::splat(pitch.len(), pulse.pitch(measurements.time)),
        };
        if silent {
            return;
        }
        for (pitch, added) in pitch.iter_mut().zip(added.iter()) {
            *pitch += added;
        }
    }

    /// Pitch amplitude (rad); the largest allowed where it varies.
    pub fn amplitude(&self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Helix(helix) => helix.amplitude,
            Self::Pulse(pulse) => pulse.amplitude,
            Self::PhaseSync(sync) => sync.settings().amplitude,
            Self::Meandering(meandering) => meandering.settings().maximum_amplitude,
        }
    }

    /// Excitation rate ω_e in the fixed frame (rad/s), that believed in where it is estimated; zero without an excitation.
    pub fn rate(&self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Helix(helix) => helix.rate,
            Self::Pulse(pulse) => pulse.rate,
            Self::PhaseSync(sync) => sync.settings().rate,
            Self::Meandering(meandering) => meandering.estimate().rate,
        }
    }

    /// In words: "baseline", "helix ccw 4.0° St 0.25", "pulse 2.5° St 0.25", "synchronised ccw 4.0° at 150°",
    /// "meandering × 1.5".
    pub fn describe(&self) -> String {
        let words = |kind: &str, amplitude: f64, strouhal: f64| {
            format!("{kind} {:.1}° St {strouhal:.2}", amplitude.to_degrees())
        };
        match self {
            Self::None => "baseline".to_owned(),
            Self::Helix(helix) => {
                words(&format!("helix {}", helix.sense), helix.amplitude, helix.strouhal)
            }
            Self::Pulse(pulse) => words("pulse", pulse.amplitude, pulse.strouhal),
            Self::PhaseSync(sync) => sync.describe(),
            Self::Meandering(meandering) => meandering.describe(),
        }
    }

    /// Everything that time changes, for a checkpoint.
    pub fn state(&self) -> ExcitationState {
        match self {
            Self::PhaseSync(sync) => ExcitationState::PhaseSync(Box::new(sync.state())),
            Self::Meandering(meandering) => ExcitationState::Meandering(meandering.clone()),
            Self::None | Self::Helix(_) | Self::Pulse(_) => ExcitationState::None,
        }
    }

    /// Continues from `state`, which an excitation of the same settings gave; a state of another kind changes nothing.
    pub fn restore(&mut self, state: ExcitationState) {
        match (self, state) {
            (Self::PhaseSync(sync), ExcitationState::PhaseSync(state)) => sync.restore(*state),
            (Self::Meandering(meandering), ExcitationState::Meandering(state)) => {
                *meandering = state;
            }
            _ => {}
        }
    }
}

/// Excitation rate ω_e = 2π St U / D (rad/s) of Strouhal number `strouhal` (–) in a free stream of
/// `wind_speed` U (m/s) past a rotor of `diameter` D (m). van Vondelen et al. (2025), Eq. 3.
pub fn excitation_rate(strouhal: f64, wind_speed: f64, diameter: f64) -> f64 {
    TAU * strouhal * wind_speed / diameter
}

/// Share of the amplitude (–) at `time` (s): nothing up to `start` (s), then a raised cosine over one period of
/// `rate` (rad/s), then all. Steps to all at `start` when `rate` is zero.
pub(crate) fn fade_in(time: f64, start: f64, rate: f64) -> f64 {
    let turns = (time - start) * rate.abs() / TAU;
    if time <= start {
        0.0
    } else if rate == 0.0 || turns >= 1.0 {
        1.0
    } else {
        0.5 - 0.5 * (PI * turns).cos()
    }
}

/// Share of the amplitude (–) at `time` (s) of what fades in at `start` (s) and, where it has a `stop` (s), out from then
/// on, each over one period of `rate` (rad/s). Both fades add up to one, so it lies between 0 and 1 for a stop at or after
/// the start.
fn share(time: f64, start: f64, stop: Option<f64>, rate: f64) -> f64 {
    fade_in(time, start, rate) - stop.map_or(0.0, |stop| fade_in(time, stop, rate))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fades_out_as_it_fades_in() {
        let (start, stop, rate) = (100.0, 700.0, 0.1);
        let period = TAU / rate;
        for step in 0..=2000 {
            let later = 1.1 * period * f64::from(step) / 2000.0;
            let [rising, falling] =
                [start, stop].map(|from| share(from + later, start, Some(stop), rate));
            assert!((rising + falling - 1.0).abs() < 1e-12, "{later} s after start and stop");
            assert_eq!(rising, share(start + later, start, None, rate));
        }
        // A quarter of the way through a raised cosine: (1 + cos 45°) / 2.
        let quarter = share(stop + 0.25 * period, start, Some(stop), rate);
        assert!((quarter - (2.0 + 2.0_f64.sqrt()) / 4.0).abs() < 1e-12);
        assert_eq!(share(stop, start, Some(stop), rate), 1.0);
        assert_eq!(share(stop + 1.001 * period, start, Some(stop), rate), 0.0);
        assert_eq!(share(1e9, start, None, rate), 1.0);
    }

    #[test]
    fn fades_in_over_one_period_without_a_step() {
        let rate = 0.1;
        let period = TAU / rate;
        assert_eq!(fade_in(99.0, 100.0, rate), 0.0);
        assert_eq!(fade_in(100.0, 100.0, rate), 0.0);
        assert!((fade_in(100.0 + 0.5 * period, 100.0, rate) - 0.5).abs() < 1e-12);
        assert_eq!(fade_in(100.0 + 1.001 * period, 100.0, rate), 1.0);
        let mut last = 0.0;
        for step in 0..=2000 {
            let share = fade_in(100.0 + 1.1 * period * f64::from(step) / 2000.0, 100.0, rate);
            assert!(share >= last && share - last < 1e-3);
            last = share;
        }
        assert_eq!(fade_in(0.1, 0.0, 0.0), 1.0);
    }

    #[test]
    fn strouhal_number_gives_the_rate() {
        // St 0.25 at 10.5 m/s past 240 m: period 91.4 s.
        assert!((TAU / excitation_rate(0.25, 10.5, 240.0) - 240.0 / 2.625).abs() < 1e-12);
    }
}
