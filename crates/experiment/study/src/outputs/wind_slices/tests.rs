//! What the keys ask for, before any run.

use super::*;
use std::fs;

/// The quick start's turbine on few cells, with `keys` of slices.
fn setup(keys: &str) -> Result<Prepared, StudyError> {
    let text = format!(
        "name = \"slices\"\n[wind]\nspeed = 9.0\nturbulence_intensity = 0.0\n[flow]\ncells_per_diameter = 8\n\
         upstream_diameters = 1.5\ndownstream_diameters = 4\nwidth_diameters = 5\nheight_diameters = 3\n\
         [time]\nspin_up = 10.0\nduration = 30.0\n\
         [[turbine]]\nname = \"T1\"\nmodel = \"nrel-5mw\"\nposition_diameters = [0.0, 0.0]\n\
         [[run]]\nname = \"baseline\"\n\
         [output]\nfurther.wake = {{ kind = \"wind-slices\"{keys} }}\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("slices.toml");
    fs::write(&path, text).expect("a file");
    Prepared::read(&path, &[])
}

#[test]
fn points_memory_and_disk_are_known_before_the_run() {
    let setup =
        setup(", distances_diameters = [-1.0, 2.0, 3.5], width = 300, height = 160, spacing = 20")
            .expect("a sound case");
    let values = &setup.case.output.further[0].values;
    let slices = of(&setup, values).expect("a turbine");
    let grid = slices.grid();
    assert_eq!(([grid.n_y, grid.n_z], grid.first), ([16, 9], [-150.0, 10.0]));
    assert!((slices.foot(3.5).x - 3.5 * setup.plan.diameter).abs() < 1e-9);
    // A plane a second, as nearly as steps allow.
    assert!((grid.interval - 1.0).abs() <= 0.5 * setup.plan.interval);
    let n_planes = slices.schedule().count(setup.plan.n_steps);
    assert!((19..=23).contains(&n_planes), "{n_planes}");
    assert_eq!(memory(&setup), 3 * 16 * 9 * 72);
    assert_eq!(disk(&setup, &setup.case.runs[0], values), n_planes * 3 * 16 * 9 * 18);
    // Without further words four diameters wide, as fine as the cells, no row below the lowest cells.
    let setup = self::setup(", distances_diameters = [3.0]").expect("a sound case");
    let grid = of(&setup, &setup.case.output.further[0].values).expect("a turbine").grid();
    assert_eq!([grid.n_y, grid.n_z], [33, 10]);
    assert!(grid.first[1] >= 0.5 * setup.plan.spacing && grid.first[1] < 1.5 * setup.plan.spacing);
}

#[test]
fn what_cannot_be_recorded_is_refused_with_key_and_fix() {
    let cases = [
        ("", "output.further.wake.distances_diameters"),
        (", distances_diameters = []", "asks for no slice"),
        (", distances_diameters = [3.0, 3.0]", "names 3 D twice"),
        (
            ", distances_diameters = [3.0, 8.0]",
            "the slice 8 D behind the turbine lies outside of the domain, which reaches from -1.4",
        ),
        (
            ", distances_diameters = [3.0], width = 700",
            "wake.width: slices 692.3 m wide reach beyond the sides of the domain: give a width of 613.7 m at most",
        ),
        (", distances_diameters = [3.0], height = 700", "raise flow.height_diameters"),
        (
            ", distances_diameters = [3.0], turbine = \"T2\"",
            "there is no turbine T2: take one of T1",
        ),
        (", distances_diameters = [3.0], interval = 40", "lower interval"),
    ];
    for (keys, text) in cases {
        let error = setup(keys).err().unwrap_or_else(|| panic!("{keys} is taken"));
        let told = match &error {
            StudyError::Case(error) => error.to_lines(),
            error => error.to_string(),
        };
        assert!(told.contains(text), "{keys}: {told}");
    }
}
