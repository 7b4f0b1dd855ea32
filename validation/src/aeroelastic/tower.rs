//! What the tower does to the loads of blades and tower top by the wind about it, beside the reference with
//! its tower and without.

use super::CHANGE_SHARE;
use super::rig::{CHANNELS, Conditions, run};
use crate::Row;
use crate::least_squares::Fit;
use crate::row::Tolerance::Within;
use turbine::aero::tower_influence::{Effects, Potential};

/// Where the expected values come from.
const SOURCE: &str = "OpenFAST 5.0.0, TwrPotent 1 and TwrShadow 1";

/// Harmonics of the rotor's speed that are resolved: as many as two rows a second, which the reference
/// kept, hold.
const N_HARMONICS: usize = 9;
const N_PARTS: usize = 1 + 2 * N_HARMONICS;

/// As AeroDyn's `TwrPotent` 1 and `TwrShadow` 1, which the published deck has.
const EFFECTS: Effects = Effects { potential: Potential::Cylinder, shadow: true };
/// Rotor speed of the reference without and with the tower in its wind (rpm): means of 100 to 200 s.
const ROTOR_SPEEDS: [f64; 2] = [6.44348, 6.43871];

/// What the tower changes of one channel.
struct Change {
    /// Place in [`CHANNELS`].
    channel: usize,
    /// Of the mean (MN m), where that is looked at.
    mean: Option<f64>,
    /// Harmonics, each with the amplitude of its change (MN m).
    amplitudes: &'static [(usize, f64)],
}

/// The reference, 100 to 200 s with the tower less the same without, harmonics by least squares on the
/// azimuth.
///
/// The halves of that time give each figure within 2 % of these.
const CHANGES: [Change; 3] = [
    Change {
        channel: 0,
        mean: Some(-0.0631),
        amplitudes: &[(1, 0.0863), (2, 0.1459), (3, 0.1335)],
    },
    Change { channel: 6, mean: None, amplitudes: &[(1, 0.0260), (2, 0.0361)] },
    Change { channel: 2, mean: Some(0.1041), amplitudes: &[(3, 0.3879)] },
];
/// Change of the mean thrust of the same (MN).
const THRUST: f64 = -0.002_833;

/// Changes by the tower in 9 m/s, the rotor held at the speeds of the reference.
pub(super) fn changes() -> Vec<Row> {
    let at = |rotor_speed, tower| {
        run(&Conditions { rotor_speed, tower, ..Conditions::in_nine_metres_a_second() })
    };
    let [without, with] = [at(ROTOR_SPEEDS[0], None), at(ROTOR_SPEEDS[1], Some(EFFECTS))];
    let mut rows = vec![row("mean thrust", with.thrust - without.thrust, THRUST, "MN")];
    for Change { channel, mean, amplitudes } in CHANGES {
        let name = CHANNELS[channel];
        let parts = [&without, &with].map(|run| harmonics(&run.azimuth, &run.samples[channel]));
        if let Some(mean) = mean {
            rows.push(row(&format!("mean {name}"), parts[1][0] - parts[0][0], mean, "MN m"));
        }
        for &(harmonic, expected) in amplitudes {
            let [sine, cosine] =
                [2 * harmonic - 1, 2 * harmonic].map(|part| parts[1][part] - parts[0][part]);
            let what = format!("{name}, amplitude at {harmonic}P");
            rows.push(row(&what, sine.hypot(cosine), expected, "MN m"));
        }
    }
    rows
}

fn row(what: &str, measured: f64, expected: f64, unit: &'static str) -> Row {
    let what = format!("iea-15mw, 9 m/s, change by the tower of {what}");
    Row {
        what,
        measured,
        expected,
        tolerance: Within(CHANGE_SHARE * expected.abs()),
        unit,
        source: SOURCE,
    }
}

/// Mean of `samples`, then sine and cosine of each harmonic of `azimuth` (rad), from the first, in their
/// unit.
fn harmonics(azimuth: &[f64], samples: &[f64]) -> [f64; N_PARTS] {
    let mut fit = Fit::<N_PARTS>::default();
    for (azimuth, sample) in azimuth.iter().zip(samples) {
        fit.add(waves(*azimuth), *sample);
    }
    fit.parts()
}

/// One, then sine and cosine of the multiples of `azimuth` (rad).
fn waves(azimuth: f64) -> [f64; N_PARTS] {
    std::array::from_fn(|part| {
        let angle = part.div_ceil(2) as f64 * azimuth;
        if part.is_multiple_of(2) { angle.cos() } else { angle.sin() }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_of_a_known_load_over_a_broken_number_of_turns() {
        let azimuth: Vec<f64> = (0..400).map(|step| 0.17 * f64::from(step)).collect();
        let load = |azimuth: f64| 50.0 + 3.0 * azimuth.sin() - 0.2 * (3.0 * azimuth).cos();
        let samples: Vec<f64> = azimuth.iter().copied().map(load).collect();
        let parts = harmonics(&azimuth, &samples);
        for (part, value) in parts.into_iter().enumerate() {
            let expected = match part {
                0 => 50.0,
                1 => 3.0,
                6 => -0.2,
                _ => 0.0,
            };
            assert!((value - expected).abs() < 1e-9, "{part}: {value}");
        }
    }
}
