//! Loops alone: tones, ramps, transfer functions, and where a loop can come to rest.

use crate::Row;
use crate::folds::{larger, ratio};
use crate::row::Tolerance::{AtMost, Within};
use basis::angle::wrap_to_half_turn;
use estimation::phase_locked::{
    Gains, Generator, GeneratorKind, Order, PhaseLockedLoop, PhaseLockedSettings, transfer,
};
use std::f64::consts::{FRAC_1_SQRT_2, PI, SQRT_2, TAU};

/// Where the expected values come from.
const SOURCE: &str = "closed form, or van Veldhoven (2024), chapter 2";

/// Step (s).
const INTERVAL: f64 = 0.1;
/// Rates (rad/s) of St 0.15 in 9 m/s to St 0.3 in 10.5 m/s, past 240 m, and what a loop is given to look in.
const BAND: [f64; 2] = [TAU * 0.15 * 9.0 / 240.0, TAU * 0.3 * 10.5 / 240.0];
const RATES: [f64; 2] = [0.6 * BAND[0], 1.3 * BAND[1]];

/// Everything above.
pub fn loops() -> Vec<Row> {
    [tones(), ramps(), steps(), transfers(), equilibria()].concat()
}

/// The three generators of damping √2, each with its name.
pub(super) fn kinds() -> [(&'static str, GeneratorKind); 3] {
    let extended = GeneratorKind::extended(SQRT_2, 1.0).expect("damping √2 has a dc gain");
    [("SOGI", GeneratorKind::Second), ("ESOGI", extended), ("MSTOGI", GeneratorKind::Mixed)]
}

fn follower(kind: GeneratorKind, order: Order) -> (PhaseLockedSettings, PhaseLockedLoop) {
    let mut settings =
        PhaseLockedSettings { generator: kind, ..PhaseLockedSettings::between(RATES) };
    settings.follower.order = order;
    if order == Order::Three {
        // A type-three loop with ESOGI is unstable at the natural rate of the others.
        settings.follower.natural_rate *= 0.5;
    }
    let follower = PhaseLockedLoop::new(&settings, INTERVAL).expect("a sound loop");
    (settings, follower)
}

fn none(what: String, measured: f64, tolerance: f64, unit: &'static str) -> Row {
    Row { what, measured, expected: 0.0, tolerance: Within(tolerance), unit, source: SOURCE }
}

/// Steady errors on 2 sin θ + 3 at 31 rates, the worst of each; and the time it takes to be within them.
fn tones() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, kind) in &kinds()[1..] {
        let mut worst = [0.0; 4];
        for part in 0..=30 {
            let rate = BAND[0] + (BAND[1] - BAND[0]) * f64::from(part) / 30.0;
            let (_, mut follower) = follower(*kind, Order::QuasiTwo);
            let n_steps = (60.0 * TAU / rate / INTERVAL) as usize;
            let last = (TAU / rate / INTERVAL) as usize;
            for step in 0..n_steps {
                let phase = rate * INTERVAL * step as f64;
                let estimate = follower.update(INTERVAL, 3.0 + 2.0 * phase.sin());
                if step + last >= n_steps {
                    let errors = [
                        wrap_to_half_turn(estimate.phase - phase).abs().to_degrees(),
                        (estimate.rate / rate - 1.0).abs(),
                        (estimate.offset / 3.0 - 1.0).abs(),
                        (estimate.amplitude / 2.0 - 1.0).abs(),
                    ];
                    worst = std::array::from_fn(|index| larger(worst[index], errors[index]));
                }
            }
        }
        let whats = [
            ("phase", 0.1, "deg"),
            ("frequency", 1e-3, "–"),
            ("offset", 1e-6, "–"),
            ("amplitude", 1e-6, "–"),
        ];
        rows.extend(whats.into_iter().zip(worst).map(|((what, tolerance, unit), worst)| {
            none(
                format!("{name}, tones after 60 periods: worst error of {what}"),
                worst,
                tolerance,
                unit,
            )
        }));
    }
    rows
}

/// Phase error at the end of a ramp over the band in 8000 s.
fn ramps() -> Vec<Row> {
    let duration = 8000.0;
    let growth = (BAND[1] - BAND[0]) / duration;
    let mut rows = Vec::new();
    for (name, kind) in &kinds()[1..] {
        for order in [Order::QuasiTwo, Order::Three, Order::Two] {
            let (settings, mut follower) = follower(*kind, order);
            let mut error = 0.0;
            for step in 0..(duration / INTERVAL) as usize {
                let time = INTERVAL * step as f64;
                let phase = BAND[0] * time + 0.5 * growth * time * time;
                let estimate = follower.update(INTERVAL, 3.0 + 2.0 * phase.sin());
                error = wrap_to_half_turn(phase - estimate.phase).to_degrees();
            }
            // Eq. 2-27, whose amplitude the half tangent takes off.
            let lag = (growth / settings.follower.gains().integral).to_degrees();
            let what = format!(
                "{name}, ramp of {:.1e} rad/s²: steady phase error, type {order:?}",
                growth
            );
            rows.push(match order {
                Order::Two => Row {
                    what,
                    measured: error,
                    expected: lag,
                    tolerance: Within(0.02 * lag),
                    unit: "deg",
                    source: SOURCE,
                },
                Order::QuasiTwo | Order::Three => none(what, error, 0.1, "deg"),
            });
        }
    }
    rows
}

/// Time (s) until the rate stays within 2 % of a tone's, and how far it strays, over the tone's rate (–),
/// after a step of frequency (St 0.18 to 0.22), of offset (by the amplitude) and of amplitude (by half) at 9
/// m/s.
fn steps() -> Vec<Row> {
    const N_STEPS: u32 = 80_000;
    let rate_of = |strouhal: f64| TAU * strouhal * 9.0 / 240.0;
    let [first, last] = [0.18, 0.22].map(rate_of);
    // Rates, offsets and amplitudes before and after.
    let cases = [
        ("frequency step", [first, last], [0.0, 0.0], [1.0, 1.0]),
        ("offset step", [last, last], [0.0, 1.0], [1.0, 1.0]),
        ("amplitude step", [last, last], [0.0, 0.0], [1.0, 1.5]),
    ];
    tell!(
        "| loop alone | generator | settling, s | largest excursion of ω̂ beyond the new rate, % |"
    );
    tell!("| --- | --- | --- | --- |");
    let mut rows = Vec::new();
    for (case, rates, offsets, amplitudes) in cases {
        let outcomes = kinds().map(|(name, kind)| {
            let (_, mut follower) = follower(kind, Order::QuasiTwo);
            let (mut phase, mut settled, mut beyond) = (0.0, 0.0, 0.0);
            for step in 0..N_STEPS {
                let time = INTERVAL * f64::from(step) - 4000.0;
                let late = usize::from(time >= 0.0);
                let estimate =
                    follower.update(INTERVAL, offsets[late] + amplitudes[late] * f64::sin(phase));
                phase = (phase + rates[late] * INTERVAL) % TAU;
                if late == 1 {
                    let off = estimate.rate / rates[1] - 1.0;
                    let outside = off.is_nan() || off.abs() > 0.02;
                    settled = if outside { time } else { settled };
                    // Before a step of frequency the rate is too low; what counts is beyond the new one.
                    let sided = if rates[0] < rates[1] { off } else { off.abs() };
                    beyond = larger(beyond, sided);
                }
            }
            let last = INTERVAL * f64::from(N_STEPS - 1) - 4000.0;
            let settled = if settled == last { f64::INFINITY } else { settled };
            tell!("| {case} | {name} | {settled:.0} | {:.2} |", 100.0 * beyond);
            [settled, beyond]
        });
        let [_, extended, mixed] = outcomes;
        for (index, what) in ["settling", "excursion"].into_iter().enumerate() {
            rows.push(Row {
                what: format!("loop alone, {case}: {what}, MSTOGI over ESOGI"),
                measured: ratio(mixed[index], extended[index]),
                expected: 1.0,
                tolerance: AtMost,
                unit: "–",
                source: SOURCE,
            });
        }
    }
    rows
}

/// Discrete generators against the closed form at 40 frequencies, centres at both ends of the band.
fn transfers() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, kind) in kinds() {
        let mut worst = [0.0; 3];
        for centre in BAND {
            for part in 0..40 {
                // From a third of the centre rate to three times it.
                let ratio = 3.0_f64.powf(-1.0 + 2.0 * f64::from(part) / 39.0);
                let closed = transfer(kind, SQRT_2, ratio);
                let closed = [closed.in_phase, closed.quadrature, closed.offset];
                for ((worst, found), closed) in
                    worst.iter_mut().zip(response(kind, centre, ratio)).zip(closed)
                {
                    let [re, im] =
                        [closed.gain * closed.phase.cos(), closed.gain * closed.phase.sin()];
                    let distance = (found[0] - re).hypot(found[1] - im);
                    // Where the notch lets nothing through there is nothing to be a share of.
                    if closed.gain > 1e-6 {
                        *worst = larger(*worst, distance / closed.gain);
                    }
                }
            }
        }
        for (output, worst) in ["in-phase", "quadrature", "offset"].into_iter().zip(worst) {
            if (name, output) != ("SOGI", "offset") {
                let what =
                    format!("{name}, {output} signal: worst distance from the transfer function");
                rows.push(none(what, worst, 0.01, "–"));
            }
        }
    }
    rows
}

/// In-phase, quadrature and offset of a generator at `centre` (rad/s) per sine at `ratio` times that, as
/// cosine and sine part.
fn response(kind: GeneratorKind, centre: f64, ratio: f64) -> [[f64; 2]; 3] {
    let mut generator = Generator::new(kind, SQRT_2).expect("a sound generator");
    let n_period = (TAU / (ratio * centre * INTERVAL)).round();
    let interval = TAU / (ratio * centre) / n_period;
    let mut sums = [[0.0; 2]; 3];
    let n_steps = (40.0 * n_period * ratio.max(1.0)).round();
    let n_steps = (n_steps / n_period).ceil() * n_period;
    for step in 0..n_steps as usize {
        let (sine, cosine) = (ratio * centre * interval * step as f64).sin_cos();
        generator.update(centre * interval, sine);
        if step as f64 >= n_steps - n_period {
            let outputs = [generator.in_phase(), generator.quadrature(), generator.offset()];
            for (sum, output) in sums.iter_mut().zip(outputs) {
                sum[0] += output * sine * 2.0 / n_period;
                sum[1] += output * cosine * 2.0 / n_period;
            }
        }
    }
    sums
}

/// Phase errors of a loop without its generator, θ̃' = ω̃, ω̃' = −k_p e'(θ̃) ω̃ − k_i e(θ̃): what Eqs. 2-31
/// to 2-33 come to when the phase that is compared is the oscillator's.
struct Large {
    gains: Gains,
    /// e and its slope.
    error: fn(f64) -> [f64; 2],
}

/// e = 2 tan(θ̃/2), Eq. 2-21, and its slope.
fn half_tangent(error: f64) -> [f64; 2] {
    let tangent = (0.5 * error).tan();
    [2.0 * tangent, 1.0 + tangent * tangent]
}

/// e = sin θ̃, of the plain loop, and its slope.
fn sine(error: f64) -> [f64; 2] {
    [error.sin(), error.cos()]
}

impl Large {
    fn slope(&self, [phase, rate]: [f64; 2]) -> [f64; 2] {
        let [error, slope] = (self.error)(phase);
        [rate, -self.gains.proportional * slope * rate - self.gains.integral * error]
    }

    /// Largest real part (1/s) of the linearised motion about `phase` at rest, by differences.
    fn growth(&self, phase: f64) -> f64 {
        let step = 1e-6;
        let column = |by: [f64; 2]| {
            let ahead = self.slope([phase + by[0], by[1]]);
            let behind = self.slope([phase - by[0], -by[1]]);
            [0, 1].map(|row| (ahead[row] - behind[row]) / (2.0 * step))
        };
        let ([a, c], [b, d]) = (column([step, 0.0]), column([0.0, step]));
        let (half_trace, determinant) = (0.5 * (a + d), a * d - b * c);
        let square = half_trace * half_trace - determinant;
        half_trace + square.max(0.0).sqrt()
    }

    /// Phase error (rad) at which the loop comes to rest from `start`, by fourth-order Runge-Kutta.
    fn rest(&self, start: [f64; 2]) -> f64 {
        let mut state = start;
        let mut time = 0.0;
        let end = 40.0 / self.gains.proportional;
        while time < end {
            // Steps follow the slope of e, which has no bound.
            let [_, slope] = (self.error)(state[0]);
            let step = 0.02 / (self.gains.proportional * slope.abs().max(1.0));
            let shifted =
                |slope: [f64; 2], by: f64| [state[0] + by * slope[0], state[1] + by * slope[1]];
            let k1 = self.slope(state);
            let k2 = self.slope(shifted(k1, 0.5 * step));
            let k3 = self.slope(shifted(k2, 0.5 * step));
            let k4 = self.slope(shifted(k3, step));
            state = [0, 1].map(|i| state[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
            time += step;
        }
        state[0]
    }
}

/// Where loops come to rest from 32 × 17 phase and frequency errors, and whether they stay there.
fn equilibria() -> Vec<Row> {
    let natural = PhaseLockedSettings::between(RATES).follower.natural_rate;
    let gains = Gains::new(Order::QuasiTwo, natural, FRAC_1_SQRT_2);
    let [half, plain] = [half_tangent, sine].map(|error| Large { gains, error });
    let share = |large: &Large| {
        let (mut home, mut n) = (0, 0);
        for i in 0..32 {
            for j in -8..=8 {
                let phase = PI * (f64::from(i) + 0.5) / 16.0 - PI;
                let rest = large.rest([phase, 2.5 * natural * f64::from(j) / 4.0]);
                n += 1;
                home += usize::from(rest.abs() < 1e-3);
            }
        }
        f64::from(home as u32) / f64::from(n)
    };
    let row = |what: &str, measured: f64, expected: f64, tolerance: f64, unit: &'static str| Row {
        what: what.to_owned(),
        measured,
        expected,
        tolerance: Within(tolerance),
        unit,
        source: SOURCE,
    };
    let slow = -FRAC_1_SQRT_2 * natural;
    // At half a turn the sine's slope is −1: s² − k_p s − k_i has the root below.
    let saddle =
        0.5 * gains.proportional + (0.25 * gains.proportional.powi(2) + gains.integral).sqrt();
    vec![
        row("half tangent: growth about phase error 0", half.growth(0.0), slow, 1e-6, "1/s"),
        row("sine: growth about phase error 0", plain.growth(0.0), slow, 1e-6, "1/s"),
        row("sine: growth about half a turn, a saddle", plain.growth(PI), saddle, 1e-6, "1/s"),
        row(
            "half tangent: share of starts that come to rest in their own turn",
            share(&half),
            1.0,
            0.0,
            "–",
        ),
        // 254 of the 544 starts by the midpoint rule in steps of 0.002 over the natural rate, a computation
        // of its own; a start on the edge may go either way.
        row("sine: the same, by another integration", share(&plain), 254.0 / 544.0, 0.01, "–"),
    ]
}
