//! Pitch, or a turn of the nacelle, on top of what another controller decides, to mix the wake or to take it
//! elsewhere.
//!
//! # The sense of the helix
//!
//! Symbols of van Vondelen et al. (2025), Eqs. 1-7: A amplitude, ω_e excitation rate, ω_r rotor speed, φ
//! phase, ψ_i = ω_r t + ψ_i0 azimuth of blade i, ψ_o azimuth offset. The fixed-frame commands are (Eq. 2)
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
//! The second line carries a minus that Eq. 7 leaves out; it is half a turn of phase and changes no
//! frequency. Here **ccw is the upper sign: blades pitch at rotor frequency plus excitation frequency**.

use crate::controller::{Controller, ForeignState, from_bytes, to_bytes};
use basis::{Channel, Commands, Measurements, PerBlade};
use std::f64::consts::{PI, TAU};

/// Pitch, or a turn of the nacelle, on top of what another controller decides.
pub trait Excitation: Send {
    /// Adds the excitation at the instant of `measurements` to `pitch` (rad); amplitude zero leaves every bit
    /// as it was. Must not allocate, block or fail.
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements);

    /// Rate at which it turns the nacelle at the instant of `measurements`, counter-clockwise seen from above
    /// (rad/s), on top of what turns it already. Must not allocate, block or fail.
    fn yaw_rate(&self, _measurements: &Measurements) -> f64 {
        0.0
    }

    /// What it is, in a few words: "helix ccw 4.0° St 0.25".
    fn describe(&self) -> String;

    /// As [`Controller::signals`].
    fn signals(&self) -> Vec<Channel> {
        Vec::new()
    }

    /// As [`Controller::write_signals`].
    fn write_signals(&self, _values: &mut [f64]) {}

    /// As [`Controller::save`]; nothing where it follows from time alone.
    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    /// As [`Controller::restore`].
    ///
    /// # Errors
    /// [`ForeignState`] for bytes that such an excitation did not write.
    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        if state.is_empty() { Ok(()) } else { Err(ForeignState) }
    }

    /// It, on top of `inner`.
    fn on_top_of(self, inner: Box<dyn Controller>) -> Box<dyn Controller>
    where
        Self: Sized + 'static,
    {
        let n_signals = self.signals().len();
        Box::new(OnTop { inner, excitation: self, n_signals })
    }
}

/// A controller with an excitation on top.
pub struct OnTop<E> {
    inner: Box<dyn Controller>,
    excitation: E,
    /// Signals of the excitation (–).
    n_signals: usize,
}

impl<E: Excitation> Controller for OnTop<E> {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let mut commands = self.inner.update(measurements);
        self.excitation.add_to(&mut commands.pitch, measurements);
        commands.yaw_rate += self.excitation.yaw_rate(measurements);
        commands
    }

    fn describe(&self) -> String {
        self.excitation.describe()
    }

    fn signals(&self) -> Vec<Channel> {
        let mut signals = self.inner.signals();
        signals.extend(self.excitation.signals());
        signals
    }

    fn write_signals(&self, values: &mut [f64]) {
        let (inner, own) = values.split_at_mut(values.len() - self.n_signals);
        self.inner.write_signals(inner);
        self.excitation.write_signals(own);
    }

    fn failure(&self) -> Option<&str> {
        self.inner.failure()
    }

    fn remarks(&self) -> Vec<String> {
        self.inner.remarks()
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&[self.inner.save(), self.excitation.save()])
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let [inner, own]: [Vec<u8>; 2] = from_bytes(state)?;
        self.inner.restore(&inner)?;
        self.excitation.restore(&own)
    }
}

/// On return each blade's `pitch` (rad) has what is `added` on top.
pub(crate) fn add(pitch: &mut PerBlade<f64>, added: &PerBlade<f64>) {
    for (pitch, added) in pitch.iter_mut().zip(added.iter()) {
        *pitch += added;
    }
}

/// "KIND 4.0° St 0.25" of an excitation of `amplitude` (rad) at `strouhal` (–).
pub(crate) fn words(kind: &str, amplitude: f64, strouhal: f64) -> String {
    format!("{kind} {:.1}° St {strouhal:.2}", amplitude.to_degrees())
}

/// Excitation rate ω_e = 2π St U / D (rad/s) of Strouhal number `strouhal` (–) in a free stream of
/// `wind_speed` U (m/s) past a rotor of `diameter` D (m). van Vondelen et al. (2025), Eq. 3.
pub fn excitation_rate(strouhal: f64, wind_speed: f64, diameter: f64) -> f64 {
    TAU * strouhal * wind_speed / diameter
}

/// Share of the amplitude (–) at `time` (s): nothing up to `start` (s), then a raised cosine over one period
/// of `rate` (rad/s), then all. Steps to all at `start` when `rate` is zero.
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

/// Share of the amplitude (–) at `time` (s) of what fades in at `start` (s) and, where it has a `stop` (s),
/// out from then on, each over one period of `rate` (rad/s). Both fades add up to one, so it lies between 0
/// and 1 for a stop at or after the start.
pub(crate) fn share(time: f64, start: f64, stop: Option<f64>, rate: f64) -> f64 {
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
