//! Places of turbines on the map and the turn of their nacelles: keys of `[[turbine]]`, read and written.

use super::error::ProblemKind;
use super::section::Section;
use super::text::degrees;
use farm::case::{Placement, Position};

/// Key of a place in diameters of the first turbine.
const DIAMETERS: &str = "position_diameters";
/// Key of a place in metres.
const METRES: &str = "position";

/// Where `turbine` stands, whose layout has the `others`; notes a place that is given twice or not at all,
/// and one in another unit than the others'.
pub(super) fn position_of(turbine: &Section, others: &[Placement]) -> Position {
    let note = |key: &str, kind, fix: &str| {
        turbine.findings().note(turbine.span_of(key), kind, Some(fix.to_owned()));
    };
    let no_use = |key, why: &str| {
        note(key, ProblemKind::NoUse { key: turbine.key_path(key), why: why.to_owned() }, FIX);
    };
    let position = match (turbine.has(DIAMETERS), turbine.has(METRES)) {
        (_, false) => Position::Diameters(turbine.pair(DIAMETERS)),
        (false, true) => Position::Metres(turbine.pair(METRES)),
        (true, true) => {
            no_use(METRES, "the turbine stands where `position_diameters` says");
            Position::Diameters(turbine.pair(DIAMETERS))
        }
    };
    if !turbine.has(DIAMETERS) && !turbine.has(METRES) {
        let fix = "add it, in diameters of the first turbine, or `position` in metres";
        note(DIAMETERS, ProblemKind::Missing { key: turbine.key_path(DIAMETERS) }, fix);
        return position;
    }
    let key = if turbine.has(DIAMETERS) { DIAMETERS } else { METRES };
    match (position, others.first().map(|first| first.position)) {
        (Position::Diameters(_), Some(Position::Metres(_))) => {
            no_use(key, "the first turbine's place is in metres");
        }
        (Position::Metres(_), Some(Position::Diameters(_))) => {
            no_use(key, "the first turbine's place is in diameters");
        }
        _ => {}
    }
    position
}

const FIX: &str = "give all places as `position_diameters`, or all as `position` in metres";

/// Notes that `turbine` at `position` overlaps one of the `others`, as far as can be said without knowing the
/// rotors: in diameters.
pub(super) fn check_overlap(
    turbine: &Section,
    name: &str,
    position: Position,
    others: &[Placement],
) {
    let Position::Diameters([x, y]) = position else { return };
    for other in others {
        let Position::Diameters([other_x, other_y]) = other.position else { continue };
        let distance = (x - other_x).hypot(y - other_y);
        if distance < 1.0 {
            let (first, second) = (other.name.clone(), name.to_owned());
            let kind = ProblemKind::Overlap { first, second, distance };
            let fix = "move one of them; positions are in diameters of the first turbine";
            turbine.findings().note(turbine.span_of(DIAMETERS), kind, Some(fix.into()));
            return;
        }
    }
}

/// The place of `turbine` as a line of `[[turbine]]`.
pub(super) fn position_text(turbine: &Placement) -> String {
    let key = match turbine.position {
        Position::Diameters(_) => DIAMETERS,
        Position::Metres(_) => METRES,
    };
    let [x, y] = turbine.position.own();
    format!("{key} = [{x:?}, {y:?}]")
}

/// The turn of the nacelle of `turbine` as a line of `[[turbine]]`; nothing where it faces the wind, so that
/// the fingerprint of a case without it stays what it was.
pub(super) fn yaw_text(turbine: &Placement) -> String {
    match turbine.yaw {
        0.0 => String::new(),
        yaw => format!("yaw_deg = {:?}\n", degrees(yaw)),
    }
}

/// How wrong the blades of `turbine` are mounted as a line of `[[turbine]]`; nothing where they are not, for
/// the same reason.
pub(super) fn misalignment_text(turbine: &Placement) -> String {
    if turbine.pitch_misalignment.is_empty() {
        return String::new();
    }
    let angles: Vec<f64> = turbine.pitch_misalignment.iter().map(|one| degrees(*one)).collect();
    format!("pitch_misalignment_deg = {angles:?}\n")
}

#[cfg(test)]
mod tests {
    use crate::case::{fingerprint, parse, write};
    use farm::case::Position;

    /// A case of two turbines with `keys` in the place of T1's position and `others` in that of T2's.
    fn text(wind: &str, keys: &str, others: &str) -> String {
        format!(
            "name = \"small\"\n[wind]\nspeed = 9\nturbulence_intensity = 0.0\n{wind}\n[flow]\nsolver = \"uniform\"\n\
             [time]\nspin_up = 0\nduration = 60\n[[turbine]]\nname = \"T1\"\nmodel = \"nrel-5mw\"\n{keys}\n\
             [[turbine]]\nname = \"T2\"\nmodel = \"nrel-5mw\"\n{others}\n[[run]]\nname = \"r\"\n"
        )
    }

    fn message(keys: &str, others: &str) -> String {
        parse("small.toml", &text("", keys, others), &[]).unwrap_err().to_lines()
    }

    #[test]
    fn places_directions_and_yaw_come_back_from_what_is_written() {
        let layouts = [
            ("position_diameters = [0, 0]", "position_diameters = [5, 1]"),
            ("position = [431250.5, 120.0]\nyaw_deg = -17.3", "position = [432000, -3]"),
            ("position = [0, 0]\npitch_misalignment_deg = [0.3, -1.7, 0]", "position = [900, 0]"),
        ];
        for (first, second) in layouts {
            for wind in ["", "direction_deg = 0", "direction_deg = 241.7", "direction_deg = 360"] {
                let case =
                    parse("small.toml", &text(wind, first, second), &[]).unwrap_or_else(|e| {
                        panic!("{wind} {first}: {}", e.to_lines());
                    });
                let again = parse("again.toml", &write(&case), &[]).unwrap();
                assert_eq!(again, case);
                let given = matches!(case.turbines[0].position, Position::Metres(_));
                assert_eq!(given, first.starts_with("position ="));
            }
        }
    }

    #[test]
    fn what_is_as_it_always_was_leaves_no_trace() {
        let (first, second) = ("position_diameters = [0, 0]", "position_diameters = [5, 1]");
        let plain = text("", first, second);
        let said = text("direction_deg = 270.0", &format!("{first}\nyaw_deg = 0.0"), second);
        assert_eq!(fingerprint(&plain, "r"), fingerprint(&said, "r"));
        for other in [text("direction_deg = 271", first, second), plain.replace("5, 1", "5, 1.5")] {
            assert_ne!(fingerprint(&plain, "r"), fingerprint(&other, "r"));
        }
    }

    #[test]
    fn errors_name_the_place_and_the_fix() {
        let diameters = "position_diameters = [0, 0]";
        let both = message(
            "position = [0, 0]\nposition_diameters = [0, 0]",
            "position_diameters = [5, 0]",
        );
        assert!(both.contains("`turbine.T1.position`"), "{both}");
        let mixed = message(diameters, "position = [5000, 0]");
        assert!(
            mixed.contains("first turbine's place is in diameters; give all places as"),
            "{mixed}"
        );
        let none = message(diameters, "");
        assert!(none.contains("`turbine.T2.position_diameters` is missing; add it"), "{none}");
        let near = message(diameters, "position_diameters = [0.5, 0]");
        assert!(near.contains("turbines T1 and T2 overlap"), "{near}");
        let turned = message(&format!("{diameters}\nyaw_deg = 90"), "position_diameters = [5, 0]");
        assert!(
            turned.contains("`turbine.T1.yaw_deg` = 90 is out of range: -60 <= yaw_deg"),
            "{turned}"
        );
    }
}
