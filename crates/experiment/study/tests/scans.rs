//! The scans of lidars that runs keep: to the same bits after a break, as large as was told, or not at all.

mod small;

use basis::scan::Scan;
use formats::records::{RunFolder, StoredScans, read_scans, read_series};
use small::{HALFWAY, NREL_5MW, STOP, options, written};
use std::fs;
use std::path::Path;
use study::outputs::Outputs;
use study::{Outcome, Prepared, Silent, StudyOptions};

/// Two lidars on T1, of which one measures point by point and loses some of them, and none on T2; a run
/// without T1.
fn case(duration: f64, output: &str) -> String {
    let lidars = "model = \"nrel-5mw\"\n\
        sensors.eye = { kind = \"lidar\", n_points = 12, rate_hz = 1.0, ranges_diameters = [0.5, 1.0] }\n\
        sensors.lidar = { kind = \"lidar\", n_points = 16, order = \"in-turn\", rate_hz = 7.0, dropout = 0.2, seed = 3 }";
    let without = "[[run]]\nname = \"without\"\ncontrol.T1 = { kind = \"absent\" }\n";
    let rest = format!(
        "[[run]]\nname = \"baseline\"\n{}{without}[output]\n{output}",
        small::behind_helix("helix", &["{ kind = \"baseline\" }"])
    );
    let disk = "event = { kind = \"rotating-disk\", speed = 6.0, strouhal = 0.25 }\n";
    small::case("scans", disk, [5.0, duration], &[lidars, NREL_5MW], &rest)
}

fn scans(out: &Path, run: &str, sensor: &str) -> StoredScans {
    read_scans(&RunFolder::new(out, run).scans_path("T1", sensor)).expect("scans")
}

#[test]
fn scans_are_those_that_controllers_saw_after_a_break_too() {
    let folder = written(&case(20.0, ""));
    let whole = small::done(&options(folder.path()));
    let (eye, lidar) = (scans(&whole, "helix", "eye"), scans(&whole, "helix", "lidar"));
    // One a second from time zero on; point by point something new at every control instant.
    assert_eq!((eye.n_scans(), lidar.n_scans()), (20, 100));
    assert_eq!((eye.n_points(), eye.n_ranges), (24, 2));
    assert!(eye.times.iter().enumerate().all(|(k, time)| (time - k as f64).abs() < 1e-9));
    assert!(eye.helix.is_some() && scans(&whole, "baseline", "eye").helix.is_none());
    let near = 0.5 * eye.rotor_diameter;
    assert!(eye.ranges[..12].iter().all(|range| (range - near).abs() < 1e-9), "{:?}", eye.ranges);

    // The series holds the speeds that the same sensor showed at the same instants.
    let series = read_series(&whole.join("helix/series.csv"), |_| true).expect("a series");
    let mut reading = Vec::new();
    for row in 0..lidar.n_scans() {
        lidar.reading(row, 0..16, &mut reading);
        let scan = Scan::of(&reading).expect("a scan");
        for (point, speed) in scan.speeds().iter().enumerate() {
            let shown = series.column(&format!("T1.lidar.Los{:03}", point + 1)).expect("it")[row];
            assert_eq!(speed.is_nan(), shown.is_nan(), "row {row}, point {point}");
            assert!(speed.is_nan() || (speed - shown).abs() < 1e-6, "row {row}, point {point}");
            // What was not measured yet has no time; what was lost has one.
            assert!(!scan.times()[point].is_nan() || speed.is_nan());
        }
        let azimuth = series.column("T1.Azimuth").expect("the azimuth")[row];
        assert!((lidar.azimuths[row] - azimuth).abs() < 1e-9);
    }

    let stopped =
        StudyOptions { output: Some(folder.path().join("stopped")), ..options(folder.path()) };
    let outcome =
        study::run_with(&stopped, &Outputs::standard().with(&HALFWAY), &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    let part = folder.path().join("stopped/baseline/scans-T1.eye.nc.part");
    assert!(part.is_file());
    let stopped = small::done(&StudyOptions { resume: true, ..stopped });
    assert!(!part.exists());
    // And one that becomes longer.
    let short = written(&case(12.0, ""));
    small::done(&options(short.path()));
    fs::write(short.path().join("case.toml"), case(20.0, "")).expect("a case");
    let longer = small::done(&StudyOptions { resume: true, ..options(short.path()) });
    for other in [&stopped, &longer] {
        for file in ["scans-T1.eye.nc", "scans-T1.lidar.nc"] {
            for run in ["baseline", "helix"] {
                let read = |out: &Path| fs::read(out.join(run).join(file)).expect(file);
                assert!(read(other) == read(&whole), "{run}/{file} has other bits");
            }
        }
    }
    assert!(!whole.join("without/scans-T1.eye.nc").exists());
}

#[test]
fn their_disk_is_told_before_and_none_are_kept_where_none_are_wanted() {
    let disk = |folder: &Path| -> u64 {
        let setup = Prepared::read(&folder.join("case.toml"), &[]).expect("a sound case");
        Outputs::standard().disk_of_run(&setup, &setup.case.runs[0])
    };
    let (kept, none) = (written(&case(20.0, "")), written(&case(20.0, "scans = \"none\"\n")));
    let told = disk(kept.path()) - disk(none.path());
    let out = small::done(&options(kept.path()));
    let length = |sensor: &str| {
        let path = RunFolder::new(&out, "baseline").scans_path("T1", sensor);
        fs::metadata(path).expect("scans").len()
    };
    let taken = length("eye") + length("lidar");
    // What is told of a file before its first scan is for cases with long words.
    assert!(taken <= told && told - taken < 2 * (12 << 10) + 4000, "{taken} bytes, told {told}");
    let out = small::done(&options(none.path()));
    let names = fs::read_dir(out.join("baseline")).expect("a folder");
    let names = names.map(|entry| entry.expect("a file").file_name().into_string().expect("text"));
    assert!(!names.collect::<Vec<_>>().iter().any(|name| name.starts_with("scans")));
}
