//! The source's chapter 3: three generators side by side on a frequency step and ramp, jumps, offset, noise,
//! attenuation.

use super::follower::{Case, END, INTERVAL, Instant, START, run};
use super::loops::kinds;
use crate::Row;
use crate::folds::{larger, ratio, worst};
use crate::least_squares::Fit;
use crate::row::Tolerance::{AtLeast, AtMost, Within};
use control::meandering::Followed;
use std::f64::consts::TAU;

/// Where the expected values come from.
const SOURCE: &str = "van Veldhoven (2024), chapter 3";

/// Plain amplification with 4 % noise, what all cases start from.
const STEP: Case = Case {
    name: "frequency step (3-3)",
    figure: "3-3",
    strouhals: [0.18, 0.22],
    sweeps: false,
    amplitudes: [1.0, 1.0],
    offset: 0.0,
    noise: 0.04,
    factor: 1.5,
    followed: Followed::Load,
};

const ATTENUATION: Case =
    Case { name: "attenuation (3-8)", figure: "3-8", factor: 0.1, strouhals: [0.2, 0.2], ..STEP };

/// The source's figures, a jump of the amplitude, which its section 3-2-1 tells of, and attenuation by the
/// way that the program takes by default. Their steps, jumps, offsets and references are not given in
/// numbers; these are ours, within the band of St 0.15 to 0.25.
pub(super) const CASES: [Case; 7] = [
    STEP,
    Case {
        name: "frequency ramp (3-4)",
        figure: "3-4",
        strouhals: [0.17, 0.22],
        sweeps: true,
        ..STEP
    },
    Case { name: "offset and step (3-5)", figure: "3-5", offset: 0.5, ..STEP },
    Case {
        name: "amplitude jump (3-2-1)",
        figure: "amplitude-jump",
        strouhals: [0.2, 0.2],
        amplitudes: [1.0, 1.4],
        ..STEP
    },
    Case { name: "50 % noise and step (3-7)", figure: "3-7", noise: 0.5, ..STEP },
    ATTENUATION,
    Case {
        name: "attenuation, wake followed",
        figure: "3-8-wake-followed",
        followed: Followed::Wake,
        ..ATTENUATION
    },
];

/// A rate has settled when it stays so near the true one (–).
const BAND: f64 = 0.02;

/// What a run of one generator comes to.
struct Outcome {
    /// Time after control begins, and after 1000 s, until the rate stays within [`BAND`] (s); infinite if it
    /// never does.
    settling: [f64; 2],
    /// Furthest that the rate goes beyond the new one after 1000 s, over the step (–), or over the rate where
    /// there is none.
    overshoot: f64,
    /// Largest error of the rate over the last 400 s (–).
    ripple: f64,
    /// Signal over noise of the first mass' place over the last 600 s (dB), the first six harmonics aside.
    signal_to_noise: f64,
    /// Third and fifth harmonic over the first, over the last 600 s (dB).
    harmonics: [f64; 2],
    /// Amplitude at the true frequency off the reference over the last 600 s, over the reference (–).
    amplitude_error: f64,
    /// Offset of the place over the reference over the last 600 s (–).
    offset: f64,
}

/// Repeats all cases with all generators; prints the table and gives what the source claims as rows.
pub fn bench() -> Vec<Row> {
    tell!(
        "| case | generator | settling after start, s | after 1000 s, s | overshoot | ripple of ω̂, % | SNR, dB | 3rd, dB | 5th, dB | amplitude error, % | offset, % |"
    );
    tell!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut rows = Vec::new();
    for case in &CASES {
        let outcomes = kinds().map(|(name, kind)| {
            let run = run(case, kind, true).expect("the bench's own settings are sound");
            let outcome = judged(case, &run);
            tell!("{}", outcome.line(case.name, name));
            outcome
        });
        rows.extend(claims(case, &outcomes));
    }
    rows
}

impl Outcome {
    fn line(&self, case: &str, generator: &str) -> String {
        let percent = |share: f64| 100.0 * share;
        let seconds =
            |time: f64| if time.is_finite() { format!("{time:.0}") } else { "never".into() };
        format!(
            "| {case} | {generator} | {} | {} | {:.2} | {:.2} | {:.1} | {:.1} | {:.1} | {:.1} | {:.1} |",
            seconds(self.settling[0]),
            seconds(self.settling[1]),
            self.overshoot,
            percent(self.ripple),
            self.signal_to_noise,
            self.harmonics[0],
            self.harmonics[1],
            percent(self.amplitude_error),
            percent(self.offset),
        )
    }
}

/// What the source says of `case`, beside what came out of the three generators.
fn claims(case: &Case, outcomes: &[Outcome; 3]) -> Vec<Row> {
    let [_, extended, mixed] = outcomes;
    let name = case.name;
    // A ratio that should be below one: MSTOGI's over ESOGI's.
    let less = |what: &str, mixed: f64, extended: f64| Row {
        what: format!("{name}: {what}, MSTOGI over ESOGI"),
        measured: ratio(mixed, extended),
        expected: 1.0,
        tolerance: AtMost,
        unit: "–",
        source: SOURCE,
    };
    let zero = |what: String, measured: f64, tolerance: f64, unit: &'static str| Row {
        what: format!("{name}: {what}"),
        measured,
        expected: 0.0,
        tolerance: Within(tolerance),
        unit,
        source: SOURCE,
    };
    let both = [("ESOGI", extended), ("MSTOGI", mixed)];
    let mut rows = Vec::new();
    if case.strouhals[0] != case.strouhals[1] && !case.sweeps && case.noise < 0.1 {
        rows.push(less("settling after the step", mixed.settling[1], extended.settling[1]));
        rows.push(less("overshoot of the step", mixed.overshoot, extended.overshoot));
    }
    for (generator, outcome) in both {
        if case.factor > 1.0 && case.noise < 0.1 {
            let what = format!("{generator} amplitude off its reference");
            rows.push(zero(what, outcome.amplitude_error, 0.05, "–"));
        }
        if case.factor < 1.0 {
            let what =
                format!("{generator} amplitude off its reference, over the one without control");
            rows.push(zero(what, outcome.amplitude_error * case.factor, 0.05, "–"));
        }
        if case.offset != 0.0 {
            let what = format!("{generator} offset left, over the reference");
            rows.push(zero(what, outcome.offset, 0.02, "–"));
        }
        if case.noise >= 0.1 {
            rows.push(Row {
                what: format!("{name}: {generator} SNR"),
                measured: outcome.signal_to_noise,
                expected: 12.0,
                tolerance: AtLeast,
                unit: "dB",
                source: SOURCE,
            });
        }
    }
    rows
}

fn judged(case: &Case, run: &[Instant]) -> Outcome {
    let after = |time: f64| &run[(time / INTERVAL) as usize..];
    let middle = 0.5 * END;
    let steps = after(middle);
    let change = steps[0].rate - run[0].rate;
    let overshoot = if case.sweeps || change == 0.0 {
        worst(steps.iter().map(|now| (now.estimate.rate / now.rate - 1.0).abs()))
    } else {
        let beyond = |now: &Instant| (now.estimate.rate - now.rate) / change;
        larger(worst(steps.iter().map(beyond)), 0.0)
    };
    let last = after(END - 400.0);
    let error = |now: &Instant| (now.estimate.rate / now.rate - 1.0).abs();
    let reference = run[0].reference;
    let powers = spectrum(after(END - 600.0));
    Outcome {
        settling: [
            settling(&run[(START / INTERVAL) as usize..(middle / INTERVAL) as usize]),
            settling(steps),
        ],
        overshoot,
        ripple: worst(last.iter().map(error)),
        signal_to_noise: 10.0 * (powers.fundamental / powers.rest).log10(),
        harmonics: [powers.third, powers.fifth]
            .map(|power| 10.0 * (power / powers.fundamental).log10()),
        amplitude_error: (2.0 * powers.fundamental).sqrt() / reference - 1.0,
        offset: powers.mean / reference,
    }
}

/// Time (s) from which the rate stays within [`BAND`] of the true one to the end of `run`.
fn settling(run: &[Instant]) -> f64 {
    let within = |now: &Instant| (now.estimate.rate / now.rate - 1.0).abs() <= BAND;
    match run.iter().rposition(|now| !within(now)) {
        None => 0.0,
        Some(last) if last + 1 == run.len() => f64::INFINITY,
        Some(last) => run[last].time - run[0].time,
    }
}

/// Mean (m) of the place, and mean squares of its parts (m²).
struct Powers {
    mean: f64,
    fundamental: f64,
    third: f64,
    fifth: f64,
    /// What is no mean and none of the first six harmonics.
    rest: f64,
}

/// Least squares of a mean and six harmonics of the true phase.
fn spectrum(run: &[Instant]) -> Powers {
    let mut phase = 0.0;
    let mut fit = Fit::<13>::default();
    for now in run {
        let mut row = [1.0; 13];
        for harmonic in 1..=6 {
            let (sine, cosine) = (harmonic as f64 * phase).sin_cos();
            (row[2 * harmonic - 1], row[2 * harmonic]) = (sine, cosine);
        }
        fit.add(row, now.place);
        phase = (phase + now.rate * INTERVAL) % TAU;
    }
    let parts = fit.parts();
    let power =
        |harmonic: usize| 0.5 * (parts[2 * harmonic - 1].powi(2) + parts[2 * harmonic].powi(2));
    let rest = fit.rest();
    Powers { mean: parts[0], fundamental: power(1), third: power(3), fifth: power(5), rest }
}
