//! The list of outputs agrees with the case file.

use super::*;

/// Keys that the run itself follows, or that stand for outputs asked for by name.
const OF_THE_RUN: [&str; 3] = ["checkpoint_interval", "last_checkpoint", "further"];

/// Keys of `[output]` that `kind` follows.
fn followed(kind: &OutputKind) -> &'static [&'static str] {
    match kind.keys {
        Keys::OfOutput(keys) => keys,
        Keys::Own(_) => &[],
    }
}

/// Keys under `[output]` of the reference.
fn keys() -> Vec<String> {
    let reference = formats::case::reference();
    let (_, output) = reference.split_once("## `[output]`").expect("the table");
    let table = output.split("\n## ").next().expect("its rows");
    let key = |line: &str| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned());
    table.lines().filter_map(key).collect()
}

#[test]
fn each_key_of_the_case_file_belongs_to_one_output() {
    let keys = keys();
    assert!(keys.len() > 5, "{keys:?}");
    for key in keys.iter().filter(|key| !OF_THE_RUN.contains(&key.as_str())) {
        let owners = STANDARD.iter().filter(|kind| followed(kind).contains(&key.as_str()));
        assert_eq!(owners.count(), 1, "{key}");
    }
    for kind in STANDARD {
        let unknown = followed(kind).iter().find(|name| !keys.iter().any(|key| key == *name));
        assert_eq!(unknown, None, "{}", kind.name);
    }
}

#[test]
fn a_staggered_row_has_a_plane_along_the_wind_through_each_line_of_turbines() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case.toml");
    let mut case = "name = \"row\"\n[wind]\nspeed = 9.0\nturbulence_intensity = 0.0\n\
                    [flow]\nsolver = \"uniform\"\n[time]\nspin_up = 10.0\nduration = 60.0\n"
        .to_owned();
    for (index, side) in [0.0, 0.8, 0.02, -0.8, 0.8, 1.6, 2.4].into_iter().enumerate() {
        let (name, x) = (format!("T{}", index + 1), 4.0 * index as f64);
        case += &format!(
            "[[turbine]]\nname = \"{name}\"\nmodel = \"nrel-5mw\"\nposition_diameters = [{x:.1}, {side}]\n"
        );
    }
    case += "[[run]]\nname = \"baseline\"\n";
    std::fs::write(&path, case).expect("a file");
    let setup = Prepared::read(&path, &[]).expect("a sound case");
    let along: Vec<(String, f64)> = slices::of(&setup)
        .into_iter()
        .filter(|slice| slice.axes == basis::records::PlaneAxes::Streamwise)
        .map(|slice| (slice.name, slice.position / setup.plan.diameter))
        .collect();
    // Four at most.
    let expected = [
        ("streamwise", 0.0),
        ("streamwise-T2", 0.8),
        ("streamwise-T4", -0.8),
        ("streamwise-T6", 1.6),
    ];
    assert_eq!(along.len(), expected.len());
    for ((name, y), (expected_name, expected_y)) in along.iter().zip(expected) {
        assert_eq!(name, expected_name);
        assert!((y - expected_y).abs() < 1e-12, "{name}: {y}");
    }
}
