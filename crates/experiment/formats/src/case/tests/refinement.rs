//! Boxes of finer cells as users write them.

use super::*;
use farm::refinement::{Asked, asked};

const BOXES: &str = r#"[flow]
cells_per_diameter = 12
[[flow.refinement]]
height_diameters = 3
width_diameters = 4.0
[[flow.refinement]]
around = ["T2"]
[time]"#;

fn boxed(overrides: &[&str]) -> Result<Case, CaseError> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse("small.toml", &SMALL.replace("[time]", BOXES), &overrides)
}

fn boxes(overrides: &[&str]) -> Vec<Asked> {
    let case = boxed(overrides).unwrap_or_else(|error| panic!("{}", error.to_lines()));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    asked(&case.flow.values)
}

#[test]
fn boxes_are_read_set_and_written() {
    let [one, two] = boxes(&[]).try_into().unwrap();
    assert_eq!((one.around.len(), one.height_diameters, one.width_diameters), (0, 3.0, 4.0));
    assert_eq!((one.upstream_diameters, one.downstream_diameters), (1.0, 2.0));
    assert_eq!((two.around, two.width_diameters), (vec!["T2".to_owned()], 2.0));
    assert_eq!(boxes(&["flow.refinement.1.width_diameters=3"])[1].width_diameters, 3.0);
    assert_eq!(boxes(&["flow.refinement=[{ upstream_diameters = 2.0 }]"]).len(), 1);
    // A case without one has nothing of it.
    let plain = small(&[]).unwrap();
    assert!(asked(&plain.flow.values).is_empty() && !write(&plain).contains("refinement"));
    // Other solvers read past it.
    assert!(boxes(&["flow.solver=uniform"]).is_empty());
    let [before, now] = [boxed(&[]), boxed(&["flow.refinement.1.width_diameters=3"])]
        .map(|case| write(&case.unwrap()));
    let differences = differences(&before, &now, "helix");
    let words: Vec<String> = differences.iter().map(Difference::to_string).collect();
    assert_eq!(words, ["flow.refinement.1.width_diameters: 2 before, 3 now"]);
}

#[test]
fn what_is_wrong_with_a_box_is_named() {
    let error = |key: &str| boxed(&[key]).unwrap_err().to_lines();
    for (key, words) in [
        ("flow.refinement.1.around=[\"T3\"]", "names the turbine `T3`"),
        (
            "flow.refinement.1.around=[]",
            "`flow.refinement` number 1: its `around` names no turbine",
        ),
        ("flow.refinement.0.width_diameter=3", "did you mean `width_diameters`?"),
        ("flow.refinement.0.height_diameters=0.1", "1 <= height_diameters <= 50"),
        ("flow.refinement={ height_diameters = 3 }", "must be one [[flow.refinement]] or more"),
        ("flow.refinement=3", "must be one [[flow.refinement]] or more"),
    ] {
        assert!(error(key).contains(words), "{key}: {}", error(key));
    }
    assert!(boxed(&["flow.refinement.2.width_diameters=3"]).is_err());
}

#[test]
fn a_box_is_pointed_at_by_its_number() {
    let text = SMALL.replace("[time]", BOXES);
    let case = parse("small.toml", &text, &[]).unwrap();
    let (path, overrides) = (PathBuf::from("small.toml"), Vec::new());
    let file = CaseFile { case, text, overrides, path, study: 0 };
    let at = |path: &[&str]| objection(&file, path, "why".to_owned()).to_lines();
    assert!(at(&["flow", "refinement", "0", "width_diameters"]).starts_with("small.toml:10: why"));
    assert!(at(&["flow", "refinement", "1", "width_diameters"]).starts_with("small.toml:11: why"));
}
