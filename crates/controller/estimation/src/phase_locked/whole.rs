//! Whether a whole loop, generator and all, comes closer to a tone that it is nearly locked to.
//!
//! The loop filter's poles over a lag of the phase leave out that a generator's vector also breathes at twice its rate, which
//! the centre, following ω̂, feeds back. It costs a third of the natural rate with which the second-order and the mixed
//! generator are stable, and more than half with the extended one's slow pole. So the loop itself is asked.

use super::generator::Generator;
use super::oscillator::{LoopSettings, Oscillator};
use std::f64::consts::TAU;

/// Samples a period, periods that the generator settles over, and those after which errors are compared.
const N_SAMPLES: i32 = 100;
const SETTLING: i32 = 30;
const EARLY: i32 = 10;
const LATE: i32 = 40;

/// `fresh` after thirty periods of a sine of amplitude one, `n_samples` (–) a period, the last of them at phase zero.
pub(super) fn settled(fresh: &Generator, n_samples: i32) -> Generator {
    let turned = TAU / f64::from(n_samples);
    let mut generator = *fresh;
    for step in -SETTLING * n_samples..=0 {
        generator.update(turned, (turned * f64::from(step)).sin());
    }
    generator
}

/// Growth (1/s) of small errors about the lock to a tone of `rate` (rad/s), over thirty periods; negative where they decay.
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
