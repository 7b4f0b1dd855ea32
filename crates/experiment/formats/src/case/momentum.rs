//! Keys of `[[turbine]]` that only momentum theory uses, where the wind is prescribed, and that of the tower,
//! which blades among free vortices feel too: read and written.

use super::error::ProblemKind;
use super::section::Section;
use farm::case::{DynamicInflow, Placement, Solver, TowerInfluence};
use farm::solvers::without_induction;

/// Words for what a tower does to the wind.
const TOWER_INFLUENCES: [(&str, TowerInfluence); 4] = [
    ("none", TowerInfluence::None),
    ("potential", TowerInfluence::Potential),
    ("potential-with-drag", TowerInfluence::PotentialWithDrag),
    ("potential-and-shadow", TowerInfluence::PotentialAndShadow),
];

/// How the induction of `turbine` follows its loads; notes where the air of `solver`, or another key, has no
/// use for it.
pub(super) fn dynamic_inflow_of(turbine: &Section, solver: Solver) -> DynamicInflow {
    if solver.resolves_induction {
        let why =
            format!("the air of flow.solver = \"{}\" has the rotor's wake in it", solver.name);
        for key in ["dynamic_inflow", "slow_constant"].into_iter().filter(|key| turbine.has(key)) {
            note_no_use(turbine, key, &why, &other_solver());
        }
    }
    let word = turbine.choice("dynamic_inflow");
    let slow_constant = turbine.optional_number("slow_constant");
    if !solver.resolves_induction && word != "two-constant" && slow_constant.is_some() {
        let why = format!("it applies only with dynamic_inflow = \"two-constant\", not \"{word}\"");
        note_no_use(turbine, "slow_constant", &why, "leave it out");
    }
    match word {
        "none" => DynamicInflow::None,
        "snel-schepers" => DynamicInflow::SnelSchepers,
        _ => DynamicInflow::TwoConstant { slow_constant },
    }
}

/// What the tower does to the wind that the blades of `turbine` meet; notes where the air of `solver` has no
/// use for it.
pub(super) fn tower_influence_of(turbine: &Section, solver: Solver) -> TowerInfluence {
    let word = turbine.choice("tower_influence");
    let known = TOWER_INFLUENCES.iter().find(|(name, _)| *name == word);
    let influence = known.map_or(TowerInfluence::None, |(_, influence)| *influence);
    let air_feels_it = solver.resolves_induction && !solver.uses_bound_vortices;
    if influence != TowerInfluence::None && air_feels_it {
        let name = solver.name;
        let why = format!("in flow.solver = \"{name}\" the tower's drag acts on the air itself");
        note_no_use(turbine, "tower_influence", &why, &other_solver());
    }
    influence
}

/// How to fix a key that goes with prescribed wind.
fn other_solver() -> String {
    format!("leave it out, or use flow.solver = {}", without_induction())
}

fn note_no_use(turbine: &Section, key: &str, why: &str, fix: &str) {
    let kind = ProblemKind::NoUse { key: turbine.key_path(key), why: why.to_owned() };
    turbine.findings().note(turbine.span_of(key), kind, Some(fix.to_owned()));
}

/// The keys as lines of `[[turbine]]`, those alone that differ from what holds without them: so the
/// fingerprint of a case that does not use them stays what it was.
pub(super) fn momentum_text(turbine: &Placement) -> String {
    let mut text = match turbine.dynamic_inflow {
        DynamicInflow::None => "dynamic_inflow = \"none\"\n".to_owned(),
        DynamicInflow::SnelSchepers => "dynamic_inflow = \"snel-schepers\"\n".to_owned(),
        DynamicInflow::TwoConstant { slow_constant: Some(constant) } => {
            format!("slow_constant = {constant:?}\n")
        }
        DynamicInflow::TwoConstant { slow_constant: None } => String::new(),
    };
    let requested = turbine.tower_influence;
    let influence = TOWER_INFLUENCES.iter().find(|(_, influence)| *influence == requested);
    if let Some((word, _)) = influence.filter(|_| requested != TowerInfluence::None) {
        text += &format!("tower_influence = \"{word}\"\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{fingerprint, keys, parse, write};
    use basis::keys::Holds;

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

    /// Message for `keys` in the air of `solver`.
    fn message(keys: &str, solver: &str) -> String {
        let text = text(keys).replace("\"uniform\"", &format!("\"{solver}\""));
        parse("small.toml", &text, &[]).expect_err(keys).to_lines()
    }

    #[test]
    fn a_tower_has_no_influence_by_default() {
        assert_eq!(read("").tower_influence, TowerInfluence::None);
        for (word, influence) in TOWER_INFLUENCES {
            assert_eq!(read(&format!("tower_influence = \"{word}\"")).tower_influence, influence);
        }
        // The reader, the page and the schema know the same words.
        let key = keys::TURBINE.keys.iter().find(|key| key.name == "tower_influence");
        let Some(Holds::Choice(words)) = key.map(|key| key.holds) else { panic!("no choice") };
        assert_eq!(words, TOWER_INFLUENCES.map(|(word, _)| word));
    }

    #[test]
    fn induction_follows_with_two_constants_by_default() {
        let of = |keys: &str| read(keys).dynamic_inflow;
        let usual = DynamicInflow::TwoConstant { slow_constant: None };
        assert_eq!((of(""), DynamicInflow::default()), (usual, usual));
        assert_eq!(of("dynamic_inflow = \"two-constant\""), usual);
        assert_eq!(of("dynamic_inflow = \"snel-schepers\""), DynamicInflow::SnelSchepers);
        assert_eq!(of("dynamic_inflow = \"none\""), DynamicInflow::None);
        let fixed = DynamicInflow::TwoConstant { slow_constant: Some(12.6) };
        assert_eq!(of("slow_constant = 12.6"), fixed);
        assert_eq!(of("dynamic_inflow = \"two-constant\"\nslow_constant = 12.6"), fixed);
    }

    #[test]
    fn what_cannot_be_is_reported_with_its_line() {
        let cases = [
            (
                "tower_influence = \"potential\"",
                "lattice",
                "small.toml:15: `turbine.T1.tower_influence` has no effect here: in flow.solver = \"lattice\" the tower's drag acts on the air itself; leave it out, or use flow.solver = \"uniform\"",
            ),
            ("tower_influence = \"potental\"", "uniform", "did you mean \"potential\"?"),
            (
                "dynamic_inflow = \"two-constant\"",
                "lattice",
                "small.toml:15: `turbine.T1.dynamic_inflow` has no effect here: the air of flow.solver = \"lattice\" has the rotor's wake in it; leave it out, or use flow.solver = \"uniform\"",
            ),
            ("slow_constant = 12.6", "lattice", "`turbine.T1.slow_constant` has no effect here"),
            (
                "dynamic_inflow = \"none\"\nslow_constant = 12.6",
                "turbulence",
                "small.toml:16: `turbine.T1.slow_constant` has no effect here: it applies only with dynamic_inflow = \"two-constant\", not \"none\"; leave it out",
            ),
            ("slow_constant = 0", "uniform", "0 < slow_constant <= 1000 s"),
            (
                "dynamic_inflow = \"oye\"",
                "uniform",
                "`turbine.T1.dynamic_inflow` = \"oye\" is unknown; expected one of \"two-constant\", \"snel-schepers\", \"none\"",
            ),
        ];
        for (keys, solver, expected) in cases {
            let lines = message(keys, solver);
            assert!(lines.contains(expected), "{keys}\nexpected {expected}\nfound    {lines}");
        }
        // Free vortices do not feel the tower: its blades do.
        let free = text("tower_influence = \"potential\"").replace("\"uniform\"", "\"vortex\"");
        let free = parse("small.toml", &free, &[]).expect("a sound case");
        assert_eq!(free.turbines[0].tower_influence, TowerInfluence::Potential);
        // This much is true of resolved flow too.
        let still = text("tower_influence = \"none\"").replace("\"uniform\"", "\"lattice\"");
        assert!(parse("small.toml", &still, &[]).is_ok());
    }

    #[test]
    fn defaults_leave_the_fingerprint_as_it_was() {
        let of = |keys: &str| fingerprint(&text(keys), "baseline");
        let usual = "tower_influence = \"none\"\ndynamic_inflow = \"two-constant\"";
        assert_eq!(of(usual), of(""));
        for keys in [
            "tower_influence = \"potential\"",
            "dynamic_inflow = \"snel-schepers\"",
            "dynamic_inflow = \"none\"",
            "slow_constant = 12.6",
        ] {
            assert_ne!(of(keys), of(""), "{keys}");
        }
        let case = parse("small.toml", &text(usual), &[]).expect("a sound case");
        let written = write(&case);
        let keys = ["tower_influence", "dynamic_inflow", "slow_constant"];
        assert!(!keys.iter().any(|key| written.contains(key)), "{written}");
    }
}
