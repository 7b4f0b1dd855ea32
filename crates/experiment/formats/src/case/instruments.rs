//! `[turbine.instruments]`: what a controller sees of its turbine, read and written.

use super::error::ProblemKind;
use super::keys::{ACCELERATION, ANGLE, INSTRUMENTS, MOMENT, POWER, SPEED};
use super::section::Section;
use super::text::shortest;
use basis::keys::Table;
use farm::case::{Instrument, Instruments, Lag};
use std::f64::consts::{PI, TAU};

/// Damping ratio of a lag of second order when none is given (–).
const DAMPING_RATIO: f64 = 0.7;

/// One instrument's place in the file and in memory.
struct Place {
    key: &'static str,
    table: &'static Table,
    /// What ends the keys of its figures.
    suffix: &'static str,
    /// SI units in one of the file's.
    unit: f64,
    of: fn(&mut Instruments) -> &mut Instrument,
}

/// All instruments, in the order in which they are written.
static PLACES: [Place; 9] = [
    place("azimuth", &ANGLE, "_deg", PI / 180.0, |all| &mut all.azimuth),
    place("pitch", &ANGLE, "_deg", PI / 180.0, |all| &mut all.pitch),
    place("rotor_speed", &SPEED, "_rpm", PI / 30.0, |all| &mut all.rotor_speed),
    place("generator_speed", &SPEED, "_rpm", PI / 30.0, |all| &mut all.generator_speed),
    place("generator_torque", &MOMENT, "_mnm", 1e6, |all| &mut all.generator_torque),
    place("flap_moments", &MOMENT, "_mnm", 1e6, |all| &mut all.flap_moments),
    place("edge_moments", &MOMENT, "_mnm", 1e6, |all| &mut all.edge_moments),
    place("power", &POWER, "_kw", 1e3, |all| &mut all.power),
    place("tower_top_acceleration", &ACCELERATION, "", 1.0, |all| &mut all.tower_top_acceleration),
];

const fn place(
    key: &'static str,
    table: &'static Table,
    suffix: &'static str,
    unit: f64,
    of: fn(&mut Instruments) -> &mut Instrument,
) -> Place {
    Place { key, table, suffix, unit, of }
}

/// The instruments that the `turbine` tells of; the others are perfect.
pub(super) fn instruments_of(turbine: &Section) -> Instruments {
    let section = turbine.section("instruments", &INSTRUMENTS);
    let mut instruments = Instruments::default();
    for place in &PLACES {
        if section.has(place.key) {
            let figures = section.section(place.key, place.table);
            *(place.of)(&mut instruments) = instrument_of(&figures, place);
        }
    }
    instruments
}

fn instrument_of(section: &Section, place: &Place) -> Instrument {
    let figure = |name: &str| place.unit * section.number(&format!("{name}{}", place.suffix));
    Instrument {
        lag: lag_of(section),
        bias: figure("bias"),
        noise: figure("noise"),
        resolution: figure("resolution"),
        dropout: section.number("dropout"),
    }
}

/// The lag of either order; notes keys that do not go together.
fn lag_of(section: &Section) -> Lag {
    let of_no_use = |key: &str, why: &str, fix: &str| {
        let kind = ProblemKind::NoUse { key: section.key_path(key), why: why.to_owned() };
        section.findings().note(section.span_of(key), kind, Some(fix.to_owned()));
    };
    let time_constant = section.optional_number("time_constant");
    let frequency = section.optional_number("frequency_hz");
    let damping = section.optional_number("damping_ratio");
    if time_constant.is_some() && frequency.is_some() {
        let why = "a lag is of first order or of second, not both";
        of_no_use("frequency_hz", why, "leave `time_constant` or `frequency_hz` out");
    }
    if damping.is_some() && frequency.is_none() {
        let why = "only a lag of second order has damping";
        of_no_use("damping_ratio", why, "add `frequency_hz`, or leave it out");
    }
    match (time_constant, frequency) {
        (Some(time_constant), _) => Lag::First { time_constant },
        (None, Some(frequency)) => {
            Lag::Second { frequency: TAU * frequency, damping: damping.unwrap_or(DAMPING_RATIO) }
        }
        (None, None) => Lag::None,
    }
}

/// The instruments as lines of `[[turbine]]`: those that are not perfect, with the figures that say
/// something.
pub(super) fn instruments_text(instruments: &Instruments) -> String {
    let mut instruments = *instruments;
    let mut text = String::new();
    for place in &PLACES {
        let instrument = *(place.of)(&mut instruments);
        if !instrument.is_perfect() {
            let figures = figures_text(&instrument, place).join(", ");
            text += &format!("instruments.{} = {{ {figures} }}\n", place.key);
        }
    }
    text
}

fn figures_text(instrument: &Instrument, place: &Place) -> Vec<String> {
    let figures = [
        ("noise", instrument.noise),
        ("bias", instrument.bias),
        ("resolution", instrument.resolution),
    ];
    let mut texts: Vec<String> = figures
        .into_iter()
        .filter(|(_, value)| *value != 0.0)
        .map(|(name, value)| {
            let written = shortest(value, value / place.unit, |number| place.unit * number);
            format!("{name}{} = {written:?}", place.suffix)
        })
        .collect();
    if instrument.dropout != 0.0 {
        texts.push(format!("dropout = {:?}", instrument.dropout));
    }
    match instrument.lag {
        Lag::None => {}
        Lag::First { time_constant } => texts.push(format!("time_constant = {time_constant:?}")),
        Lag::Second { frequency, damping } => {
            let hertz = shortest(frequency, frequency / TAU, |number| TAU * number);
            texts.push(format!("frequency_hz = {hertz:?}, damping_ratio = {damping:?}"));
        }
    }
    texts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{keys, parse, write};
    use basis::keys::Holds;
    use proptest::prelude::*;

    const CASE: &str = r#"
name = "small"
[wind]
speed = 9
turbulence_intensity = 0.05
[time]
spin_up = 300
duration = 900.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0, 0.0]
[turbine.instruments]
FIGURES
[[run]]
name = "baseline"
"#;

    fn read(figures: &str) -> Result<Instruments, String> {
        let case = parse("small.toml", &CASE.replace("FIGURES", figures), &[])
            .map_err(|error| error.to_lines())?;
        let again = parse("again", &write(&case), &[]).map_err(|error| error.to_lines())?;
        assert_eq!(again, case, "{figures}");
        Ok(case.turbines[0].instruments)
    }

    #[test]
    fn figures_come_in_their_units_and_the_rest_is_perfect() {
        assert!(read("").expect("an empty table").are_perfect());
        assert!(
            read("pitch = { noise_deg = 0, dropout = 0 }").expect("nothing said").are_perfect()
        );
        let read = read(
            "azimuth = { resolution_deg = 0.1, bias_deg = -2 }\n\
             flap_moments = { noise_mnm = 0.5, time_constant = 0.05 }\n\
             generator_speed = { noise_rpm = 0.02, frequency_hz = 2 }\n\
             rotor_speed = { frequency_hz = 2, damping_ratio = 1.0 }\n\
             power.bias_kw = 10\n\
             tower_top_acceleration = { noise = 0.01, dropout = 0.02 }",
        )
        .expect("a good table");
        assert_eq!(read.azimuth.resolution, 0.1f64.to_radians());
        assert_eq!(read.azimuth.bias, -(2f64.to_radians()));
        assert_eq!(read.flap_moments.noise, 5e5);
        assert_eq!(read.flap_moments.lag, Lag::First { time_constant: 0.05 });
        assert!((read.generator_speed.noise - 0.02 * TAU / 60.0).abs() < 1e-18);
        assert_eq!(read.generator_speed.lag, Lag::Second { frequency: 2.0 * TAU, damping: 0.7 });
        assert_eq!(read.rotor_speed.lag, Lag::Second { frequency: 2.0 * TAU, damping: 1.0 });
        assert_eq!(read.power.bias, 1e4);
        let accelerometer = read.tower_top_acceleration;
        assert_eq!((accelerometer.noise, accelerometer.dropout), (0.01, 0.02));
        assert!(read.pitch.is_perfect() && read.edge_moments.is_perfect());
    }

    #[test]
    fn what_cannot_be_names_file_line_key_and_fix() {
        let cases = [
            (
                "flap_moments = { noise_mnm = 500 }",
                "small.toml:14: `turbine.T1.instruments.flap_moments.noise_mnm` = 500 is out of range: 0 <= noise_mnm <= 100 MN m; did you mean 0.5 MN m? 500 kN m would be that",
            ),
            ("pitch = { noise_deg = -1 }", "0 <= noise_deg <= 180 deg"),
            (
                "pitch = { noise = 1 }",
                "there is no key `turbine.T1.instruments.pitch.noise`; turbine.instruments: azimuth, pitch = { … } knows `noise_deg`, `bias_deg`",
            ),
            (
                "flap_moment = { noise_mnm = 1 }",
                "there is no key `turbine.T1.instruments.flap_moment`; did you mean `flap_moments`?",
            ),
            ("power = 3", "`turbine.T1.instruments.power` must be a table, found a whole number"),
            ("pitch = { dropout = 5 }", "did you mean 0.05? 5 percent would be that"),
            ("pitch = { bias_deg = nan }", "is out of range"),
            ("pitch = { time_constant = 0 }", "0 < time_constant <= 1000 s"),
            (
                "pitch = { time_constant = 1, frequency_hz = 2 }",
                "`turbine.T1.instruments.pitch.frequency_hz` has no effect here: a lag is of first order or of second, not both; leave `time_constant` or `frequency_hz` out",
            ),
            (
                "pitch = { damping_ratio = 1 }",
                "only a lag of second order has damping; add `frequency_hz`",
            ),
        ];
        for (figures, expected) in cases {
            let message = read(figures).expect_err(figures);
            assert!(
                message.contains(expected),
                "{figures}\nexpected {expected}\nfound    {message}"
            );
        }
    }

    /// Reader, page and schema know the same instruments, and what the keys let through can be built.
    #[test]
    fn every_instrument_of_the_page_is_read() {
        assert_eq!(PLACES.len(), keys::INSTRUMENTS.keys.len());
        for key in keys::INSTRUMENTS.keys {
            let place = PLACES.iter().find(|place| place.key == key.name).expect(key.name);
            let Holds::Table(table) = key.holds else { panic!("{} is no table", key.name) };
            assert!(std::ptr::eq(table, place.table), "{}", key.name);
            assert_eq!(table.keys[0].name, format!("noise{}", place.suffix));
        }
    }

    proptest! {
        #[test]
        fn any_figures_read_back_as_written(
            noise in 0.0..100.0, bias in -100.0..100.0, dropout in 0.0..0.99, hertz in 1e-3..1e4,
            damping in 0.0..10.0,
        ) {
            let figures = |suffix| format!(
                "noise_{suffix} = {noise:?}, bias_{suffix} = {bias:?}, dropout = {dropout:?}, frequency_hz = {hertz:?}, damping_ratio = {damping:?}"
            );
            let keys = format!("azimuth = {{ {} }}\nrotor_speed = {{ {} }}", figures("deg"), figures("rpm"));
            // `read` compares what is written with what was read.
            let read = read(&keys);
            prop_assert!(read.is_ok(), "{:?}", read);
        }
    }
}
