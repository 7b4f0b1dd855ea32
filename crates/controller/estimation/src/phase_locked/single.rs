//! Phase-locked loop for one signal: generator, loop filter, oscillator and lock detection.

use super::PhaseLockedError;
use super::generator::{Generator, GeneratorKind};
use super::lock::Lock;
use super::oscillator::{LONGEST_TURN, LoopSettings, Oscillator, Pole};
use super::stability::growth;
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;

/// Settings of a phase-locked loop for one signal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseLockedSettings {
    /// Generator of the two quadrature signals.
    pub generator: GeneratorKind,
    /// Damping k of the generator (–), √2 as a rule.
    pub damping: f64,
    /// Loop filter and oscillator.
    pub follower: LoopSettings,
}

impl PhaseLockedSettings {
    /// A mixed generator of damping √2 in a quasi-type-2 loop between `rates` (rad/s), see
    /// [`LoopSettings::between`].
    pub fn between(rates: [f64; 2]) -> Self {
        let follower = LoopSettings::between(rates);
        Self { generator: GeneratorKind::Mixed, damping: SQRT_2, follower }
    }

    /// The generator, if all settings are valid at `interval` (s).
    ///
    /// # Errors
    /// Those of [`Generator::new`] and [`LoopSettings::check`].
    pub(super) fn checked(&self, interval: f64) -> Result<Generator, PhaseLockedError> {
        let generator = Generator::new(self.generator, self.damping)?;
        let lag = self.generator.lag(self.damping);
        self.follower.check(lag, interval)?;
        // The generator is slowest at the lowest rate.
        let rate = self.follower.rates[0];
        let growth = growth(&self.follower, &generator, rate);
        if growth >= 0.0 {
            let Pole { imaginary, .. } = self.follower.gains().slowest_pole(lag / rate);
            return Err(PhaseLockedError::Unstable {
                pole: Pole { real: growth, imaginary },
                rate,
            });
        }
        Ok(generator)
    }
}

/// Estimate of one signal b + A sin θ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Phase θ (rad, [0, 2π)).
    pub phase: f64,
    /// Rate of the phase (rad/s).
    pub rate: f64,
    /// Amplitude A (unit of the samples).
    pub amplitude: f64,
    /// Offset b (unit of the samples); zero where the generator does not estimate it.
    pub offset: f64,
    /// Whether the loop has locked.
    pub locked: bool,
    /// Whether the last sample was unusable and the estimate was held.
    pub held: bool,
}

/// A phase-locked loop that follows one signal; serialises whole.
///
/// ```
/// use estimation::phase_locked::{PhaseLockedLoop, PhaseLockedSettings};
/// // 3 + 2 sin(0.05 t) sampled ten times a second, looked for between 0.03 and 0.08 rad/s
/// let interval = 0.1;
/// let mut follower = PhaseLockedLoop::new(&PhaseLockedSettings::between([0.03, 0.08]), interval)?;
/// // 60 periods: what is left of the first error fades with exp(−0.3 · 0.03 rad/s · t/√2)
/// for step in 0..75_400 {
///     follower.update(interval, 3.0 + 2.0 * (0.05 * interval * f64::from(step)).sin());
/// }
/// let estimate = follower.estimate();
/// assert!(estimate.locked && (estimate.rate - 0.05).abs() < 1e-9);
/// assert!((estimate.amplitude - 2.0).abs() < 1e-6 && (estimate.offset - 3.0).abs() < 1e-6);
/// # Ok::<(), estimation::phase_locked::PhaseLockedError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseLockedLoop {
    generator: Generator,
    oscillator: Oscillator,
    lock: Lock,
    held: bool,
}

impl PhaseLockedLoop {
    /// A loop of `settings` for samples every `interval` (s).
    ///
    /// # Errors
    /// [`PhaseLockedError`] names the invalid setting; unstable gains come with the unstable pole.
    pub fn new(settings: &PhaseLockedSettings, interval: f64) -> Result<Self, PhaseLockedError> {
        let generator = settings.checked(interval)?;
        let oscillator = Oscillator::new(&settings.follower);
        Ok(Self { generator, oscillator, lock: Lock::new(), held: false })
    }

    /// Takes in `sample` (any unit), `interval` (s) after the one before.
    ///
    /// With an unusable sample oscillator and generator turn on as before, and [`Estimate::held`] is true;
    /// after half a period of them the lock is lost.
    pub fn update(&mut self, interval: f64, sample: f64) -> Estimate {
        let turned = self.oscillator.turn(interval);
        // After a long gap the sample is not used.
        let sample = if turned > LONGEST_TURN { f64::NAN } else { sample };
        self.held = !self.generator.update(turned, sample);
        if self.held {
            self.oscillator.coast();
            self.lock.miss(turned);
        } else {
            let generator = &self.generator;
            self.oscillator.follow(generator.in_phase(), generator.quadrature());
            let (error, limited) = (self.oscillator.error(), self.oscillator.is_limited());
            let (residual, amplitude) = (generator.residual(), generator.amplitude());
            self.lock.update(turned, error, residual, amplitude, limited);
        }
        self.estimate()
    }

    /// The present estimate.
    pub fn estimate(&self) -> Estimate {
        Estimate {
            phase: self.oscillator.phase(),
            rate: self.oscillator.rate(),
            amplitude: self.generator.amplitude(),
            offset: self.generator.offset(),
            locked: self.lock.is_locked(),
            held: self.held,
        }
    }

    /// The generator of quadrature signals.
    pub fn generator(&self) -> &Generator {
        &self.generator
    }

    /// Loop filter and oscillator.
    pub fn oscillator(&self) -> &Oscillator {
        &self.oscillator
    }
}
