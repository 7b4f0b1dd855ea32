//! What the keys ask for, before any run.

use super::*;
use std::fs;

/// The quick start's layout with a helix and `further` outputs, on so few cells that it runs in seconds.
fn case(further: &str) -> String {
    format!(
        "name = \"phases\"\n[wind]\nspeed = 9.0\nturbulence_intensity = 0.0\n[flow]\ncells_per_diameter = 8\n\
         upstream_diameters = 1.5\ndownstream_diameters = 2\nwidth_diameters = 3\nheight_diameters = 2\n\
         [time]\nspin_up = 10.0\nduration = 30.0\n\
         [[turbine]]\nname = \"T1\"\nmodel = \"nrel-5mw\"\nposition_diameters = [0.0, 0.0]\n\
         [[run]]\nname = \"baseline\"\n[[run]]\nname = \"helix\"\n\
         control.T1 = {{ kind = \"helix\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.35 }}\n\
         [output]\n{further}\n"
    )
}

fn setup(further: &str) -> Result<Prepared, StudyError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("phases.toml");
    fs::write(&path, case(further)).expect("a file");
    Prepared::read(&path, &[])
}

#[test]
fn bins_and_points_are_known_before_the_run() {
    let further = "further.wake = { kind = \"phase-averages\", height_diameters = [0.0], crosswind_diameters = [1.0, 1.5], \
        volume_stride = 2, x_diameters = [0.5, 1.5], y_diameters = [-0.6, 0.6], helix_cycles = 2 }";
    let setup = setup(further).expect("a sound case");
    let values = &setup.case.output.further[0].values;
    let [baseline, helix] = [0, 1].map(|run| sizes(&setup, &setup.case.runs[run], values).unwrap());
    assert_eq!(baseline.1.len(), 12);
    // 7.5 × 9 / 62.94 over 2π × 0.35 × 9 / 125.88: 6.82 revolutions a cycle, 14 in two.
    assert_eq!(helix.1.len(), 14 * 12);
    // A diameter has eight cells: eight along, ten across, sixteen up.
    let points: Vec<u64> = helix.0.iter().map(Place::n_points).collect();
    assert_eq!(points[0], 10 * 16);
    assert_eq!(points[1], points[0]);
    assert_eq!(points[2], 8 * 10);
    assert!((4 * 5 * 8..=5 * 5 * 8).contains(&points[3]), "{points:?}");
    let all: u64 = points.iter().sum();
    let sums = all * (169 * (4 + 72) + 12);
    // Beside them four numbers of four bytes at each point of whole planes and of the whole volume, and two
    // sums of pressure, of eight bytes.
    let [n_x, n_y, n_z] = setup.plan.n_points.map(|n| n as u64);
    let whole = 2 * n_y * n_z + n_x * n_y + n_x.div_ceil(2) * n_y.div_ceil(2) * n_z.div_ceil(2);
    assert_eq!(memory(&setup), 2 * (sums + 8 * all) + 16 * (all + whole));
    assert!(disk(&setup, &setup.case.runs[1], values) > 2 * sums);
}

#[test]
fn what_asks_for_nothing_is_refused_with_a_fix() {
    let refused = |keys: &str| {
        let further = format!("further.wake = {{ kind = \"phase-averages\"{keys} }}");
        let error = setup(&further).err().expect("it is refused");
        format!("{error} {error:?}")
    };
    let nothing = refused("");
    assert!(nothing.contains("no plane and no volume"), "{nothing}");
    let empty = refused(", volume_stride = 1, y_diameters = [1.0, -1.0]");
    assert!(empty.contains("y_diameters") && empty.contains("lower end first"), "{empty}");
}
