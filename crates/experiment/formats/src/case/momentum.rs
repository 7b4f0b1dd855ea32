//! Keys of `[[turbine]]` that only momentum theory uses, where the wind is prescribed: read and written.

use super::error::ProblemKind;
use super::section::Section;
use farm::case::{Placement, Solver, TowerInfluence};

/// Words for what a tower does to the wind.
const TOWER_INFLUENCES: [(&str, TowerInfluence); 4] = [
    ("none", TowerInfluence::None),
    ("potential", TowerInfluence::Potential),
    ("potential-with-drag", TowerInfluence::PotentialWithDrag),
    ("potential-and-shadow", TowerInfluence::PotentialAndShadow),
];

/// What the tower does to the wind that the blades of `turbine` meet; notes where the air of `solver` has no use for it.
pub(super) fn tower_influence_of(turbine: &Section, solver: Solver) -> TowerInfluence {
    let word = turbine.choice("tower_influence");
    let known = TOWER_INFLUENCES.iter().find(|(name, _)| *name == word);
    let influence = known.map_or(TowerInfluence::None, |(_, influence)| *influence);
    if influence != TowerInfluence::None && !solver.is_prescribed() {
        let why = "in flow.solver = \"lattice\" the tower's drag acts on the air itself";
        note_no_use(turbine, "tower_influence", why, WITHOUT_LATTICE);
    }
    influence
}

/// What mends a key that goes with prescribed wind.
const WITHOUT_LATTICE: &str =
    "leave it out, or take flow.solver = \"uniform\", \"turbulence\" or \"planes\"";

fn note_no_use(turbine: &Section, key: &str, why: &str, fix: &str) {
    let kind = ProblemKind::NoUse { key: turbine.key_path(key), why: why.to_owned() };
    turbine.findings().note(turbine.span_of(key), kind, Some(fix.to_owned()));
}

/// The keys as lines of `[[turbine]]`, those alone that differ from what holds without them: so the fingerprint of a case
/// that does not use them stays what it was.
pub(super) fn momentum_text(turbine: &Placement) -> String {
    let asked = turbine.tower_influence;
    let influence = TOWER_INFLUENCES.iter().find(|(_, influence)| *influence == asked);
    match influence {
        Some((word, influence)) if *influence != TowerInfluence::None => {
            format!("tower_influence = \"{word}\"\n")
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{fingerprint, keys, parse, table, write};

    const CASE: &str = r#"
name = "small"
[wind]
speed = 9
turbulence_intensity = 0.0
[flow]
solver = "uniform"
[time]
spin_up = 300
duration = 900.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0, 0.0]
KEYS
[[run]]
name = "baseline"
"#;

    fn text(keys: &str) -> String {
        CASE.replace("KEYS", keys)
    }

    /// The turbine of a case with `keys`, after it was written and read.
    fn read(keys: &str) -> Placement {
        let case = parse("small.toml", &text(keys), &[])
            .unwrap_or_else(|error| panic!("{}", error.to_lines()));
        assert_eq!(parse("again", &write(&case), &[]).expect("what was written"), case, "{keys}");
        case.turbines[0].clone()
    }

    /// What a user is told who asks for `keys` in the air of `solver`.
    fn told(keys: &str, solver: &str) -> String {
        let text = text(keys).replace("\"uniform\"", &format!("\"{solver}\""));
        parse("small.toml", &text, &[]).expect_err(keys).to_lines()
    }

    #[test]
    fn a_tower_is_not_felt_unless_asked_for() {
        assert_eq!(read("").tower_influence, TowerInfluence::None);
        for (word, influence) in TOWER_INFLUENCES {
            assert_eq!(read(&format!("tower_influence = \"{word}\"")).tower_influence, influence);
        }
        // The reader, the page and the schema know the same words.
        let key = keys::TURBINE.keys.iter().find(|key| key.name == "tower_influence");
        let Some(table::Kind::Choice(words)) = key.map(|key| key.kind) else { panic!("no choice") };
        assert_eq!(words, TOWER_INFLUENCES.map(|(word, _)| word));
    }

    #[test]
    fn what_is_of_no_use_is_told_with_its_line() {
        let expected = "small.toml:15: `turbine.T1.tower_influence` is of no use here: in flow.solver = \"lattice\" the tower's drag acts on the air itself; leave it out, or take flow.solver = \"uniform\"";
        let lines = told("tower_influence = \"potential\"", "lattice");
        assert!(lines.contains(expected), "{lines}");
        // This much is true there too.
        let still = text("tower_influence = \"none\"").replace("\"uniform\"", "\"lattice\"");
        assert!(parse("small.toml", &still, &[]).is_ok());
        let lines = told("tower_influence = \"potental\"", "uniform");
        assert!(lines.contains("did you mean \"potential\"?"), "{lines}");
    }

    #[test]
    fn defaults_leave_the_fingerprint_as_it_was() {
        let of = |keys: &str| fingerprint(&text(keys), "baseline");
        assert_eq!(of("tower_influence = \"none\""), of(""));
        assert_ne!(of("tower_influence = \"potential\""), of(""));
        let case = parse("small.toml", &text(""), &[]).expect("a sound case");
        assert!(!write(&case).contains("tower_influence"));
    }
}
