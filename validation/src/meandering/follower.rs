//! The loop closed around three masses on springs: the source's figure 3-2.

use super::spring_mass::{SpringMass, answer};
use crate::random::Random;
use control::meandering::Followed;
use estimation::phase_locked::{
    Estimate, GeneratorKind, LoopSettings, Order, PhaseLockedError, PhaseLockedLoop,
    PhaseLockedSettings,
};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2, TAU};

/// Step (s), end and beginning of control (s). van Veldhoven (2024), §3-1-1, §3-2.
pub(super) const INTERVAL: f64 = 0.1;
pub(super) const END: f64 = 2000.0;
pub(super) const START: f64 = 200.0;

/// Rate (rad/s) of `strouhal` in 7 m/s past 240 m.
pub(super) fn rate_of(strouhal: f64) -> f64 {
    TAU * strouhal * 7.0 / 240.0
}

/// What pushes the first mass, and the target of its swing.
#[derive(Clone, Copy)]
pub(super) struct Case {
    /// Name, with the source's figure.
    pub(super) name: &'static str,
    /// That figure alone.
    pub(super) figure: &'static str,
    /// Strouhal number before and after 1000 s, or, where it sweeps, at both ends.
    pub(super) strouhals: [f64; 2],
    /// Whether the frequency goes evenly from the first to the last instead of at once.
    pub(super) sweeps: bool,
    /// Amplitude of the force (N) before and after 1000 s.
    pub(super) amplitudes: [f64; 2],
    /// Offset of the force (N) from 600 s on.
    pub(super) offset: f64,
    /// Deviation of white noise on the force over its first amplitude (–).
    pub(super) noise: f64,
    /// Target amplitude over that at St 0.2 under the first amplitude alone (–).
    pub(super) factor: f64,
    /// The place as it is, as the source has it, or less what the added force does to it.
    pub(super) followed: Followed,
}

/// One instant of a run.
#[derive(Clone, Copy)]
pub(super) struct Instant {
    /// Time (s).
    pub(super) time: f64,
    /// Rate of the force (rad/s).
    pub(super) rate: f64,
    /// Phase that the place has when the masses have settled under the force (rad).
    pub(super) phase: f64,
    /// Place of the first mass (m).
    pub(super) place: f64,
    /// The loop's estimate of what it follows (m).
    pub(super) estimate: Estimate,
    /// Amplitude of the place that goes with it (m).
    pub(super) amplitude: f64,
    /// Target amplitude (m).
    pub(super) reference: f64,
}

/// Settings of the loop around a generator of `kind`: between St 0.14 and 0.33, ω_n = 0.01 rad/s, ξ = 1/√2, k
/// = √2.
///
/// The source gives ξ and k, and ω_n only as less than ω₀.
pub(super) fn settings(kind: GeneratorKind) -> PhaseLockedSettings {
    let rates = [rate_of(0.14), rate_of(0.33)];
    let follower = LoopSettings {
        order: Order::QuasiTwo,
        natural_rate: 0.01,
        damping_ratio: FRAC_1_SQRT_2,
        rates,
    };
    PhaseLockedSettings { generator: kind, damping: SQRT_2, follower }
}

/// Integral gain of amplitude and offset (1/s), slow against the masses' own memory, which near their
/// resonance is some 190 s, and the largest force of either (N). The source gives neither.
const BANDWIDTH: f64 = 0.004;
const LARGEST_FORCE: f64 = 2.0;

/// Integral action that stops at its bounds (N).
#[derive(Default)]
struct Action(f64);

impl Action {
    /// Takes in a missing force (N).
    fn update(&mut self, missing: f64) {
        self.0 = (self.0 + BANDWIDTH * INTERVAL * missing).clamp(-LARGEST_FORCE, LARGEST_FORCE);
    }
}

/// Runs `case` under a loop with a generator of `kind`; without control where `controlled` is false.
///
/// The force that is added runs ahead by what the masses lag at the estimated rate, which takes the place of
/// the turbine's azimuth offset and delay; without it the masses, whose resonance lies in the band, would
/// turn the phase by 17 to 128°.
pub(super) fn run(
    case: &Case,
    kind: GeneratorKind,
    controlled: bool,
) -> Result<Vec<Instant>, PhaseLockedError> {
    let mut follower = PhaseLockedLoop::new(&settings(kind), INTERVAL)?;
    let mut masses = SpringMass::default();
    // What the added force does, known as a turbine knows its own: from a model, here a true one.
    let mut own = SpringMass::default();
    let mut noise = Random(1);
    let (mut swing, mut middle) = (Action::default(), Action::default());
    let ([static_gain, _], [gain, _]) = (answer(1e-9), answer(rate_of(0.2)));
    let reference = case.factor * case.amplitudes[0] * gain;
    let mut share = 0.0;
    let mut phase = 0.0;
    let n_steps = (END / INTERVAL) as usize;
    let mut run = Vec::with_capacity(n_steps);
    for step in 0..n_steps {
        let time = step as f64 * INTERVAL;
        let late = usize::from(time >= 0.5 * END);
        let strouhal = if case.sweeps {
            case.strouhals[0] + (case.strouhals[1] - case.strouhals[0]) * time / END
        } else {
            case.strouhals[late]
        };
        let rate = rate_of(strouhal);
        let offset = if time >= 600.0 { case.offset } else { 0.0 };
        let mut force = offset + case.amplitudes[late] * f64::sin(phase);
        force += case.noise * case.amplitudes[0] * normal(&mut noise);
        let followed = match case.followed {
            Followed::Load => masses.place(),
            Followed::Wake => masses.place() - own.place(),
        };
        let estimate = follower.update(INTERVAL, followed);
        // As on the turbine: nothing is learned, and the force fades, while there is no lock.
        let acts = controlled && time >= START && estimate.locked;
        let slew = estimate.rate * INTERVAL / TAU;
        share = f64::clamp(share + if acts { slew } else { -slew }, 0.0, 1.0);
        let [answer_now, lag] = answer(estimate.rate);
        let amplitude = match case.followed {
            Followed::Load => estimate.amplitude,
            Followed::Wake => estimate.amplitude + share * answer_now * swing.0,
        };
        if acts {
            swing.update((reference - amplitude) / gain);
            middle.update(-estimate.offset / static_gain);
        }
        let added = share * (swing.0 * (estimate.phase - lag).sin() + middle.0);
        force += added;
        let settled = phase + answer(rate)[1];
        run.push(Instant {
            time,
            rate,
            phase: settled,
            place: masses.place(),
            estimate,
            amplitude: amplitude.abs(),
            reference,
        });
        masses.advance(INTERVAL, force);
        own.advance(INTERVAL, added);
        phase = (phase + rate * INTERVAL) % TAU;
    }
    Ok(run)
}

/// The next value of white noise of deviation one, by Box and Muller.
fn normal(random: &mut Random) -> f64 {
    (-2.0 * random.uniform().ln()).sqrt() * (TAU * random.uniform()).cos()
}
