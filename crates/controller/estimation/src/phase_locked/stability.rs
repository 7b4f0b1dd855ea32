//! Stability of the whole loop, generator included, near lock to a tone.
//!
//! The loop filter's poles with a phase lag leave out that a generator's vector also pulsates at twice its
//! rate, which the centre, following ω̂, feeds back. This reduces the largest stable natural rate by a third
//! with the second-order and the mixed generator, and by more than half with the extended one's slow pole. So
//! the loop itself is simulated.

use super::generator::Generator;
use super::oscillator::{LoopSettings, Oscillator};
use std::f64::consts::TAU;

/// Samples per period, periods in which the generator settles, and periods at which errors are compared (–).
const N_SAMPLES: i32 = 100;
const SETTLING: i32 = 30;
const EARLY: i32 = 10;
const LATE: i32 = 40;

/// `fresh` after thirty periods of a sine of amplitude one, `n_samples` (–) per period, the last of them at
/// phase zero.
pub(super) fn settled(fresh: &Generator, n_samples: i32) -> Generator {
    let turned = TAU / f64::from(n_samples);
    let mut generator = *fresh;
    for step in -SETTLING * n_samples..=0 {
        generator.update(turned, (turned * f64::from(step)).sin());
    }
    generator
}

/// Growth (1/s) of small errors about the lock to a tone of `rate` (rad/s), over thirty periods; negative
/// where they decay.
pub(super) fn growth(settings: &LoopSettings, fresh: &Generator, rate: f64) -> f64 {
    let turned = TAU / f64::from(N_SAMPLES);
    let interval = turned / rate;
    let mut generator = settled(fresh, N_SAMPLES);
    // In lock but for a thousandth of one sample's turn, so that errors stay small while they grow.
    let centred = LoopSettings { rates: [0.5 * rate, 1.5 * rate], ..*settings };
    let mut oscillator = Oscillator::new(&centred);
    oscillator.turn(1e-3 * interval);
    let (mut early, mut late) = (0.0_f64, 0.0_f64);
    for step in 1..=LATE * N_SAMPLES {
        oscillator.follow(generator.in_phase(), generator.quadrature());
        let error = (oscillator.rate() / rate - 1.0).abs();
        let period = step / N_SAMPLES;
        if (EARLY - 5..EARLY).contains(&period) {
            early = early.max(error);
        } else if period >= LATE - 5 {
            late = late.max(error);
        }
        let turned_so = oscillator.turn(interval);
        generator.update(turned_so, (turned * f64::from(step)).sin());
    }
    let elapsed = f64::from(LATE - EARLY) * TAU / rate;
    // Below rounding there is nothing left to grow.
    if late < 1e-13 { -1.0 / elapsed } else { (late / early).ln() / elapsed }
}
