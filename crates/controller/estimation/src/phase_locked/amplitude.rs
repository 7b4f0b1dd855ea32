//! Stability of a loop that controls an amplitude, measured by a generator, to a reference.
//!
//! For a slow change of amplitude a generator is a lag τ (see
//! [`GeneratorKind::lag`](super::GeneratorKind::lag) over the rate). With proportional and integral action P
//! and I, and a delay T from the control action to the signal,
//!
//! ```text
//! s (1 + τ s) + (P s + I) e^(−s T) = 0
//! at the border, s = jν:   P + cos νT = τν sin νT ,   I = ν (τν cos νT + sin νT)
//! ```
//!
//! which without delay is stable for every I. This is too optimistic where I or 1/T comes near the rate
//! itself: the signals of a disturbed generator pulsate at twice the rate. So the loop itself is simulated,
//! with the phase in lock.

use super::PhaseLockedError;
use super::generator::Generator;
use super::oscillator::Pole;
use super::single::PhaseLockedSettings;
use super::stability::settled;
use std::f64::consts::{PI, TAU};

/// Samples per period (–).
const N_SAMPLES: i32 = 200;
/// Periods at which the early and the late window of the errors begin, and at which the simulation ends (–).
const EARLY: i32 = 10;
const LATE: i32 = 25;
const END: i32 = 40;
/// Initial disturbance, and the error that counts as diverged, over the amplitude (–).
const PUSH: f64 = 1e-6;
const AWAY: f64 = 1.0;

/// Proportional and integral action on the amplitude measured by a generator; their sum is added to the
/// signal in phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplitudeLoop {
    /// Integral action: amplitude added per time and amplitude error (1/s).
    pub integral: f64,
    /// Proportional action: amplitude added per amplitude error (–).
    pub proportional: f64,
    /// Delay from the control action to the signal (s); none below zero.
    pub delay: f64,
    /// Whether the control action is subtracted from the signal before the generator, and counted separately.
    pub is_taken_off: bool,
}

impl AmplitudeLoop {
    /// Checks the loop around the generator of `signal`, whose rates are sound, at the lowest and the highest
    /// of them.
    ///
    /// # Errors
    /// [`PhaseLockedError::AmplitudeUnstable`] with the unstable pole and the largest stable integral action;
    /// those of [`Generator::new`].
    pub fn check(&self, signal: &PhaseLockedSettings) -> Result<(), PhaseLockedError> {
        let generator = settled(&Generator::new(signal.generator, signal.damping)?, N_SAMPLES);
        for rate in signal.follower.rates {
            let pole = self.pole(&generator, rate);
            if pole.real >= 0.0 {
                let (integral, largest) = (self.integral, self.border(&generator, rate));
                return Err(PhaseLockedError::AmplitudeUnstable { pole, rate, integral, largest });
            }
        }
        Ok(())
    }

    /// Growth and frequency of a small amplitude error about a tone of `rate` (rad/s) that `generator` has
    /// settled on.
    fn pole(&self, generator: &Generator, rate: f64) -> Pole {
        let turned = TAU / f64::from(N_SAMPLES);
        let interval = turned / rate;
        let mut generator = *generator;
        // An action takes effect at the next sample at the earliest; a delay beyond the end has no effect.
        let n_late = (self.delay.max(0.0) / interval).min(f64::from(END * N_SAMPLES)).round();
        let mut delayed = vec![0.0; n_late as usize + 1];
        let (mut integral, mut sum) = (PUSH, 0.0);
        let (mut early, mut late, mut before) = (0.0_f64, 0.0_f64, 0.0);
        let mut crossings = Crossings::default();
        for step in 1..=END * N_SAMPLES {
            let place = step as usize % delayed.len();
            let own = if self.is_taken_off { sum } else { 0.0 };
            let amplitude = 1.0 + delayed[place] - own;
            generator.update(turned, amplitude * (turned * f64::from(step)).sin());
            let error = 1.0 - generator.amplitude() - own;
            integral += self.integral * interval * error;
            sum = integral + self.proportional * error;
            delayed[place] = sum;
            if error * before < 0.0 {
                crossings.add(step);
            }
            before = error;
            match step / N_SAMPLES {
                EARLY..LATE => early = early.max(error.abs()),
                LATE.. => late = late.max(error.abs()),
                _ => {}
            }
            if error.abs() > AWAY {
                let elapsed = f64::from(step) * interval;
                let real = (error.abs() / PUSH).ln() / elapsed;
                return Pole { real, imaginary: crossings.rate() / interval };
            }
        }
        let elapsed = f64::from(LATE - EARLY) * TAU / rate;
        // Below rounding there is nothing left to grow.
        let real = if late < 1e-13 { -1.0 / elapsed } else { (late / early).ln() / elapsed };
        Pole { real, imaginary: crossings.rate() / interval }
    }

    /// Largest stable integral action (1/s) at `rate` (rad/s), below this loop's own; zero where none is
    /// stable.
    fn border(&self, generator: &Generator, rate: f64) -> f64 {
        let is_stable = |integral: f64| Self { integral, ..*self }.pole(generator, rate).real < 0.0;
        let part = |n: i32| self.integral * f64::from(n) / 32.0;
        // From below, since beyond the first unstable gain there may be stable ones again.
        let first = (1..32).find(|&n| !is_stable(part(n))).unwrap_or(32);
        let (mut low, mut high) = (part(first - 1), part(first));
        for _ in 0..20 {
            let middle = 0.5 * (low + high);
            if is_stable(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

/// Zero crossings of an error, by steps.
#[derive(Default)]
struct Crossings {
    first: Option<i32>,
    last: i32,
    n: i32,
}

impl Crossings {
    fn add(&mut self, step: i32) {
        self.first.get_or_insert(step);
        self.last = step;
        self.n += 1;
    }

    /// Half turns over the steps between the first crossing and the last (rad); zero with fewer than two.
    fn rate(&self) -> f64 {
        match self.first {
            Some(first) if self.n > 1 => PI * f64::from(self.n - 1) / f64::from(self.last - first),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::GeneratorKind;
    use super::*;
    use std::f64::consts::SQRT_2;

    const RATE: f64 = 0.05;

    /// Border of the lag τ with a delay T, both over the rate: ν and I of the module's head, by halves.
    fn border(lag: f64, delay: f64, proportional: f64) -> [f64; 2] {
        let (mut low, mut high) = (0.0, PI / delay);
        for _ in 0..60 {
            let middle: f64 = 0.5 * (low + high);
            let (sine, cosine) = (middle * delay).sin_cos();
            let beyond = lag * middle * sine > proportional + cosine;
            (low, high) = if beyond { (low, middle) } else { (middle, high) };
        }
        let (sine, cosine) = (low * delay).sin_cos();
        [low, low * (lag * low * cosine + sine)]
    }

    fn signal(generator: GeneratorKind) -> PhaseLockedSettings {
        PhaseLockedSettings { generator, ..PhaseLockedSettings::between([RATE, 1.01 * RATE]) }
    }

    /// With a delay of three periods everything is slow against the rate, and a generator is a pure lag:
    /// borders within 3 % of the closed form, the frequency of the pole that crosses within 5 % of ν.
    #[test]
    fn the_border_is_that_of_the_closed_form_where_the_delay_is_long() {
        for kind in [
            GeneratorKind::Second,
            GeneratorKind::extended(SQRT_2, 1.0).unwrap(),
            GeneratorKind::Mixed,
        ] {
            let [turning, largest] = border(kind.lag(SQRT_2), 20.0, 0.0).map(|by| by * RATE);
            let with = |share: f64| AmplitudeLoop {
                integral: share * largest,
                proportional: 0.0,
                delay: 20.0 / RATE,
                is_taken_off: false,
            };
            assert_eq!(with(0.95).check(&signal(kind)), Ok(()));
            let refused = with(1.05).check(&signal(kind));
            let Err(PhaseLockedError::AmplitudeUnstable { pole, rate, largest: found, .. }) =
                refused
            else {
                panic!("{kind:?}: {refused:?}")
            };
            assert_eq!(rate, RATE);
            assert!(pole.real > 0.0 && (pole.imaginary / turning - 1.0).abs() < 0.05, "{pole}");
            assert!((found / largest - 1.0).abs() < 0.03, "{kind:?}: {found} {largest}");
        }
    }

    /// Without delay the closed form has no border; the second-order generator has one near its own rate, the
    /// mixed one none.
    #[test]
    fn pulsation_is_refused_although_the_closed_form_allows_it() {
        let at_once = AmplitudeLoop {
            integral: 2.0 * RATE,
            proportional: 0.0,
            delay: 0.0,
            is_taken_off: false,
        };
        let refused = at_once.check(&signal(GeneratorKind::Second));
        let Err(PhaseLockedError::AmplitudeUnstable { largest, .. }) = refused else {
            panic!("{refused:?}")
        };
        assert!((0.5 * RATE..2.0 * RATE).contains(&largest), "{largest}");
        assert_eq!(
            AmplitudeLoop { integral: largest, ..at_once }.check(&signal(GeneratorKind::Second)),
            Ok(())
        );
        assert_eq!(at_once.check(&signal(GeneratorKind::Mixed)), Ok(()));
    }

    /// Subtracted before the generator, the control action acts at once: stable for proportional action below
    /// one.
    #[test]
    fn a_subtracted_control_action_is_stable_up_to_a_proportional_action_of_one() {
        let with = |proportional: f64| {
            AmplitudeLoop { integral: 0.1 * RATE, proportional, delay: 0.0, is_taken_off: true }
                .check(&signal(GeneratorKind::Mixed))
        };
        assert_eq!(with(0.9), Ok(()));
        assert!(matches!(with(1.1), Err(PhaseLockedError::AmplitudeUnstable { .. })));
    }
}
