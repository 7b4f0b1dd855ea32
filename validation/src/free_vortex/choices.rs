//! How finely a wake must be resolved: what each part of it does to a rotor's power, and to the time of a
//! step.

use super::held::flat;
use super::rotor::{Fineness, USUAL, turned};
use crate::Row;
use crate::row::Tolerance::Within;
use std::time::Instant;

/// Accepted change of the power (–).
const CLOSE: f64 = 0.01;
/// As cases have it, but for its length: half, and half the time to settle.
const BASE: Fineness = Fineness { length: 4.0, settling: 20.0, ..USUAL };

/// A wake that is resolved otherwise in one respect: in words, and how.
type Choice = (&'static str, Fineness);

/// Those of the turbine that all are tried on,
const ALL: [Choice; 9] = [
    ("5 filaments a blade", Fineness { far_filaments: 5, ..BASE }),
    ("17 filaments a blade", Fineness { far_filaments: 17, ..BASE }),
    ("33 filaments a blade", Fineness { far_filaments: 33, ..BASE }),
    ("a ring each step", Fineness { far_stride: 1, ..BASE }),
    ("a ring every 4 steps", Fineness { far_stride: 4, ..BASE }),
    ("a near wake of 0.1 D", Fineness { near: 0.1, ..BASE }),
    ("a near wake of 0.5 D", Fineness { near: 0.5, ..BASE }),
    ("18 steps a turn", Fineness { steps_per_turn: 18.0, ..BASE }),
    ("72 steps a turn", Fineness { steps_per_turn: 72.0, ..BASE }),
];
/// and of the one whose power is too high.
const HIGH: [Choice; 4] = [ALL[1], ALL[2], ALL[6], ALL[8]];

/// Power with each choice over that of the usual one.
pub(super) fn rows() -> Vec<Row> {
    let mut rows = of_turbine("nrel-5mw", 8.0, &ALL);
    rows.extend(of_turbine("iea-22mw", 8.0, &HIGH));
    rows
}

fn of_turbine(name: &str, wind_speed: f64, choices: &[Choice]) -> Vec<Row> {
    let model = flat(name);
    let power = |words: &str, fineness: Fineness| {
        let start = Instant::now();
        let (found, _) = turned(&model, wind_speed, fineness, &[]);
        let power = found.coefficients.power;
        tell!("{name}, {words}: power {power:.4}, {:.0} s", start.elapsed().as_secs_f64());
        power
    };
    let usual = power("as cases have it", BASE);
    let row = |&(words, fineness): &Choice| Row {
        what: format!(
            "{name} flat, {wind_speed} m/s, best tip-speed ratio, wake of 4 D: power with {words} over that with {} filaments, a ring every {} steps, a near wake of {} D and {} steps a turn",
            BASE.far_filaments, BASE.far_stride, BASE.near, BASE.steps_per_turn
        ),
        measured: power(words, fineness) / usual,
        expected: 1.0,
        tolerance: Within(CLOSE),
        unit: "–",
        source: "this program, as cases have it",
    };
    choices.iter().map(row).collect()
}
