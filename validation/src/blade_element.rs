//! Blade-element momentum against published coefficient tables, and against AeroDyn on the same blades.

use crate::Row;
use crate::row::Tolerance::Within;
use turbine::Definition;
use turbine::aero::blade_element::Theory;
use turbine::aero::{Polar, PolarError, SectionCoefficients, UnsteadyConstants};
use turbine::steady::{SpanwisePoint, SteadyRotor};

const TABLES: &str = include_str!("../data/blade-element/coefficient-tables.csv");
const ROTOR: &str = include_str!("../data/blade-element/openfast-rotor.csv");
const SPANWISE: &str = include_str!("../data/blade-element/aerodyn-spanwise.csv");

/// Where the expected values come from.
const TABLE_SOURCE: &str = "published coefficient table, CCBlade";
const ROTOR_SOURCE: &str = "OpenFAST 5.0.0 with AeroDyn 15";
const ATTACHED_SOURCE: &str = "OpenFAST 5.0.0, UA_Mod 3";
const SPANWISE_SOURCE: &str = "AeroDyn 15, driver";

/// Margin required where the source's own method is comparable (–).
const MARGIN: f64 = 0.02;
/// Air density of the spanwise reference (kg/m³).
const AIR_DENSITY: f64 = 1.225;
/// Wind speed of the spanwise reference (m/s).
const WIND_SPEED: f64 = 9.0;
/// Rotor speed of the spanwise reference (rad/s).
const ROTOR_SPEED: f64 = 9.0 * WIND_SPEED / 120.97;

/// Power and thrust of the three library turbines, and loads along a blade; docs/validation/blade-element.md
/// explains the gaps.
///
/// # Panics
/// When a library turbine or the data that the program carries cannot be read.
pub fn blade_element() -> Vec<Row> {
    let mut rows = Vec::new();
    for name in ["iea-15mw", "iea-22mw", "nrel-5mw"] {
        let definition = definition_of(name);
        table_rows(name, &definition, &mut rows);
        rotor_rows(name, &definition, &mut rows);
    }
    attached_rows(&mut rows);
    spanwise_rows(&mut rows);
    rows
}

fn definition_of(name: &str) -> Definition {
    formats::library::load(name).expect("library turbines can be read").definition
}

/// Lines of `text` after comments and heading: text before the first number, and the numbers.
fn records(text: &'static str) -> impl Iterator<Item = (Vec<&'static str>, Vec<f64>)> {
    text.lines().filter(|line| !line.starts_with('#')).skip(1).map(|line| {
        let words: Vec<&str> =
            line.split(',').take_while(|cell| cell.parse::<f64>().is_err()).collect();
        let numbers = line.split(',').skip(words.len());
        let numbers = numbers.map(|cell| cell.parse().expect("a number")).collect();
        (words, numbers)
    })
}

/// Coefficient tables, tip-speed ratio 6 to 11, one row per pitch and coefficient: the largest deviation of
/// all tip-speed ratios.
fn table_rows(name: &str, definition: &Definition, rows: &mut Vec<Row>) {
    let rotor = SteadyRotor::at_stations(definition, Theory::default());
    let mut deviations: Vec<(f64, [Vec<f64>; 2])> = Vec::new();
    for (_, numbers) in records(TABLES).filter(|(words, _)| words[0] == name) {
        let [ratio, pitch_deg, power, thrust] = numbers[..] else { continue };
        let got = rotor.coefficients(ratio, pitch_deg.to_radians());
        if deviations.last().is_none_or(|(pitch, _)| *pitch < pitch_deg)
            && !deviations.iter().any(|(pitch, _)| *pitch == pitch_deg)
        {
            deviations.push((pitch_deg, Default::default()));
        }
        if let Some((_, lists)) = deviations.iter_mut().find(|(pitch, _)| *pitch == pitch_deg) {
            lists[0].push(got.power / power - 1.0);
            lists[1].push(got.thrust / thrust - 1.0);
        }
    }
    let mut within = [0, 0];
    let mut count = 0;
    for (pitch_deg, lists) in &deviations {
        count += lists[0].len();
        for (index, what) in ["power", "thrust"].into_iter().enumerate() {
            within[index] += lists[index].iter().filter(|d| d.abs() <= MARGIN).count();
            let largest = lists[index].iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
            rows.push(Row {
                what: format!("{name}, published table, pitch {pitch_deg}°: largest deviation of {what}, tip-speed ratio 6 to 11"),
                measured: 100.0 * largest.unwrap_or(f64::NAN),
                expected: 0.0,
                tolerance: Within(100.0 * MARGIN),
                unit: "%", source: TABLE_SOURCE });
        }
    }
    for (index, what) in ["power", "thrust"].into_iter().enumerate() {
        rows.push(Row {
            what: format!("{name}, published table: share of {count} points within 2 % in {what}"),
            measured: 100.0 * within[index] as f64 / count as f64,
            expected: 100.0,
            tolerance: Within(0.0),
            unit: "%",
            source: TABLE_SOURCE,
        });
    }
}

/// OpenFAST at its first instant, with straight blades, and settled, on the disc of its bent blades.
fn rotor_rows(name: &str, definition: &Definition, rows: &mut Vec<Row>) {
    let rotor = SteadyRotor::new(definition, Theory::default());
    for (words, numbers) in records(ROTOR).filter(|(words, _)| words[0] == name) {
        let [wind_speed, along_shaft, speed_rpm, pitch_deg, power, thrust] = numbers[..] else {
            continue;
        };
        let ratio = speed_rpm.to_radians() * 6.0 * definition.rotor_radius() / wind_speed;
        let got = rotor.coefficients(ratio, pitch_deg.to_radians());
        // AeroDyn refers to the wind along the shaft.
        let scale = wind_speed / along_shaft;
        let state = match words[1] {
            "start" => "AeroDyn, straight blades",
            _ => "OpenFAST, bent blades",
        };
        for (what, measured, expected) in [
            ("power", got.power * scale.powi(3), power),
            ("thrust", got.thrust * scale.powi(2), thrust),
        ] {
            rows.push(Row {
                what: format!("{name}, {state}, {wind_speed} m/s: {what} coefficient"),
                measured,
                expected,
                tolerance: Within(MARGIN * expected),
                unit: "–",
                source: ROTOR_SOURCE,
            });
        }
    }
}

/// What the unsteady airfoils of OpenFAST's NREL 5 MW take from a steady rotor: the change between its first
/// instant and its settled state, beside the change when polars are bent down to their own attached flow.
///
/// The model that the reference ran (Beddoes-Leishman after Minnema and Pierce, theory in NREL/TP-5000-66347)
/// writes a steady section as attached flow times separation. It cannot return more than attached flow, C_nα
/// (α − α₀) across the chord and that times tan α along it; these polars have up to a fifth more, being
/// corrected for stall delay.
fn attached_rows(rows: &mut Vec<Row>) {
    let name = "nrel-5mw";
    let definition = definition_of(name);
    let mut bent = definition.clone();
    for polar in &mut bent.polars {
        if let Some(constants) = polar.unsteady.clone() {
            *polar = at_most_attached(polar, &constants).expect("a polar stays one");
        }
    }
    let states: Vec<Vec<f64>> =
        records(ROTOR).filter(|(words, _)| words[0] == name).map(|(_, numbers)| numbers).collect();
    let [start, settled] = &states[..] else { panic!("two states of {name}") };
    let coefficients = |of: &Definition, state: &[f64]| {
        let ratio = state[2].to_radians() * 6.0 * of.rotor_radius() / state[0];
        SteadyRotor::new(of, Theory::default()).coefficients(ratio, state[3].to_radians())
    };
    let (before, after) = (coefficients(&definition, start), coefficients(&bent, settled));
    for (what, measured, column) in
        [("power", after.power / before.power, 4), ("thrust", after.thrust / before.thrust, 5)]
    {
        rows.push(Row {
            what: format!("{name}, polars bent down to attached flow, OpenFAST from straight to settled: change of {what}"),
            measured: 100.0 * (measured - 1.0),
            expected: 100.0 * (settled[column] / start[column] - 1.0),
            tolerance: Within(100.0 * MARGIN),
            unit: "%", source: ATTACHED_SOURCE });
    }
}

/// `polar` with forces of at most attached flow between its angle of no lift and 20°.
fn at_most_attached(polar: &Polar, constants: &UnsteadyConstants) -> Result<Polar, PolarError> {
    let mut columns: [Vec<f64>; 4] = Default::default();
    for (angle, at) in polar.rows() {
        let (sine, cosine) = angle.sin_cos();
        let friction = constants.zero_lift_drag;
        let attached = constants.normal_force_slope * (angle - constants.zero_lift_angle);
        let mut section = at;
        if (constants.zero_lift_angle..20f64.to_radians()).contains(&angle) && attached > 0.0 {
            let normal = (at.lift * cosine + (at.drag - friction) * sine).min(attached);
            let mut chordwise = at.lift * sine - (at.drag - friction) * cosine;
            if angle > 0.0 {
                chordwise = chordwise.min(attached * angle.tan());
            }
            section = SectionCoefficients {
                lift: normal * cosine + chordwise * sine,
                drag: normal * sine - chordwise * cosine + friction,
                ..at
            };
        }
        let row = [angle, section.lift, section.drag, section.moment];
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    let [angle, lift, drag, moment] = &columns;
    Polar::new(polar.name.clone(), angle, lift, drag, moment)
}

/// AeroDyn's driver on the flat IEA 15 MW rotor, node by node.
fn spanwise_rows(rows: &mut Vec<Row>) {
    let mut flat = definition_of("iea-15mw");
    flat.rotor.precone = 0.0;
    flat.rotor.shaft_tilt = 0.0;
    let rotor = SteadyRotor::at_stations(&flat, Theory::default());
    let mut points = vec![SpanwisePoint::default(); rotor.n_elements()];
    rotor.distribution(ROTOR_SPEED * flat.rotor_radius() / WIND_SPEED, 0.0, &mut points);
    let pressure = 0.5 * AIR_DENSITY * WIND_SPEED * WIND_SPEED;
    for (_, numbers) in records(SPANWISE) {
        let [radius, attack_deg, induction, lift, normal, tangential] = numbers[..] else {
            continue;
        };
        let nearest = |a: &&SpanwisePoint, b: &&SpanwisePoint| {
            (a.radius - radius).abs().total_cmp(&(b.radius - radius).abs())
        };
        let Some(point) = points.iter().min_by(nearest) else { continue };
        let compared = [
            ("angle of attack", point.inflow.angle_of_attack.to_degrees(), attack_deg, "°"),
            ("axial induction", point.inflow.axial_induction, induction, "–"),
            ("lift coefficient", point.inflow.section.lift, lift, "–"),
            ("normal force", pressure * point.normal_force, normal, "N/m"),
            ("tangential force", pressure * point.tangential_force, tangential, "N/m"),
        ];
        for (what, measured, expected, unit) in compared {
            rows.push(Row {
                what: format!("iea-15mw flat, AeroDyn node at {radius:.1} m: {what}"),
                measured,
                expected,
                tolerance: Within(MARGIN * expected.abs()),
                unit,
                source: SPANWISE_SOURCE,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_carried_data_is_whole() {
        assert!(records(TABLES).all(|(words, numbers)| words.len() == 1 && numbers.len() == 4));
        assert!(records(ROTOR).all(|(words, numbers)| words.len() == 2 && numbers.len() == 6));
        assert!(records(SPANWISE).all(|(words, numbers)| words.is_empty() && numbers.len() == 6));
    }

    #[test]
    fn straight_blades_agree_with_aerodyn_within_two_percent() {
        let rows = blade_element();
        let straight: Vec<&Row> = rows.iter().filter(|row| row.what.contains("AeroDyn")).collect();
        assert!(straight.len() > 70);
        for row in straight {
            assert!(row.passes(), "{row:?}");
        }
    }
}
