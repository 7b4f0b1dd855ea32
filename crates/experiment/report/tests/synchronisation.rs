//! Figures of a phase synchronisation: all of them are drawn, and none of what is missing.

mod synchronised;

use report::Synchronisation;
use std::fs;

#[test]
fn every_figure_is_drawn_in_both_forms() {
    let folder = tempfile::tempdir().expect("a folder");
    let names =
        report::write_synchronisation(&synchronised::all(), folder.path()).expect("figures");
    assert_eq!(
        names,
        [
            "phases",
            "tilt-responses",
            "power-over-offset",
            "tilt-moments",
            "phase-averaged-wake",
            "recentred-deficits"
        ]
    );
    for name in &names {
        let path = |form: &str| folder.path().join(format!("figures/{name}.{form}"));
        let text = fs::read_to_string(path("svg")).expect("a drawing");
        for absent in ["NaN", "inf", "None"] {
            assert!(!text.contains(absent), "{name}: {absent}");
        }
        let picture = fs::read(path("png")).expect("a picture");
        let reader = png::Decoder::new(std::io::Cursor::new(picture)).read_info().expect("a PNG");
        assert_eq!(reader.info().width, 2000, "{name}");
    }
    let offsets = fs::read_to_string(folder.path().join("figures/power-over-offset.svg"));
    let offsets = offsets.expect("a drawing");
    // Three panels; the eight runs of each, that at zero on both ends.
    assert_eq!(offsets.matches("<circle").count(), 3 * 9);
    assert!(offsets.contains(">150° (117 to 182°)<") && offsets.contains("T2 + T3"));
}

#[test]
fn what_is_missing_or_broken_is_left_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let none = report::write_synchronisation(&Synchronisation::default(), folder.path());
    assert!(none.expect("nothing to draw").is_empty());
    let mut records = synchronised::all();
    for panel in &mut records.offsets[0].panels {
        panel.curve.clear();
        panel.highest = None;
    }
    records.offsets[0].panels[1].points[2].change.mean = f64::NAN;
    records.offsets[0].panels[0].points.clear();
    records.tracks[0].rows[3].lines[1].values[100] = f64::NAN;
    records.tracks[1].rows.clear();
    records.spectra[0].lines.clear();
    let slices = records.slices.as_mut().expect("slices");
    slices.planes.clear();
    slices.centre_lines[0].points.clear();
    records.deficits.as_mut().expect("deficits").panels.clear();
    let names = report::write_synchronisation(&records, folder.path()).expect("figures");
    assert_eq!(names, ["phases", "power-over-offset", "phase-averaged-wake"]);
    for name in names {
        let text = fs::read_to_string(folder.path().join(format!("figures/{name}.svg")));
        assert!(!text.expect("a drawing").contains("NaN"), "{name}");
    }
}
