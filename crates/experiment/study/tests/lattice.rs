//! A study in resolved flow, from case to report, stopped on the way: what it leaves has the same bits.

mod small;

use formats::records::SeriesFile;
use formats::table::{Column, TableReader};
use small::{HALFWAY, STOP, assert_alike, left, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{Estimate, Observer, Outcome, Outputs, Prepared, Silent, StudyOptions};

const CASE: &str = r#"
name = "small"
[wind]
speed = 9.0
turbulence_intensity = 0.08
[flow]
cells_per_diameter = 8
upstream_diameters = 2.0
downstream_diameters = 3.0
width_diameters = 4.0
height_diameters = 3.0
[time]
spin_up = 40.0
duration = 160.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [1.5, 0.0]
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 3.0, strouhal = 0.3 }
control.T2 = { kind = "absent" }
[output]
lines_at = ["T2"]
inflow_at = ["T2"]
plane_interval = 20.0
volume_interval = 60.0
volume_stride = 1
helix_phases = 4
crosswind_diameters = [1.0]
"#;

fn options(folder: &Path, output: &str) -> StudyOptions {
    StudyOptions { output: Some(folder.join(output)), ..small::options(folder) }
}

#[test]
fn a_lengthened_run_leaves_what_one_of_the_full_length_does() {
    // Turbulence is in a box that is as long as the run.
    let calm = CASE.replace("turbulence_intensity = 0.08", "turbulence_intensity = 0.0");
    let folder = written(&calm.replace("duration = 160.0", "duration = 90.0"));
    let mut lengthened = options(folder.path(), "lengthened");
    small::done(&lengthened);
    let run = folder.path().join("lengthened/helix");
    assert!(run.join("checkpoint").is_file());
    let short = left(&run);
    fs::write(folder.path().join("case.toml"), &calm).expect("a case");
    small::done(&options(folder.path(), "whole"));
    lengthened.resume = true;
    small::done(&lengthened);
    assert_alike(&folder.path().join("whole/helix"), &run);
    assert_ne!(short, left(&run));
    // What is complete at that length is left alone.
    let before = fs::read(run.join("summary.json")).expect("a summary");
    small::done(&lengthened);
    assert_eq!(before, fs::read(run.join("summary.json")).expect("a summary"));
}

#[test]
fn a_stopped_study_leaves_what_one_that_was_left_alone_does() {
    let folder = written(CASE);
    let outcome = small::run(&options(folder.path(), "whole"));
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");

    let mut again = options(folder.path(), "stopped");
    let outputs = Outputs::standard().with(&HALFWAY);
    let outcome = study::run_with(&again, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    let run = folder.path().join("stopped/helix");
    assert!(run.join("checkpoint").is_file());
    // As a process leaves it that is killed while it writes.
    let [half, plane] = [".checkpoint.4711.part", "planes/.mean-hub-height.nc.4711.part"];
    for name in [half, plane] {
        fs::write(run.join(name), b"half").expect("a file");
    }
    again.resume = true;
    let outcome = small::run(&again);
    let Ok(Outcome::Done { summaries, .. }) = outcome else { panic!("{outcome:?}") };
    let cost = &summaries[0].cost;
    assert_eq!(cost.peak_memory.is_some(), formats::machine::peak_memory().is_some());
    // The air is not all that is held.
    assert!(cost.peak_memory.is_none_or(|peak_memory| peak_memory > cost.memory), "{cost:?}");

    assert_alike(&folder.path().join("whole/helix"), &run);
    let whole = left(&folder.path().join("whole/helix"));
    // Loads of every blade, in both files.
    let series = SeriesFile::open(&run.join("series.csv")).expect("a series");
    let outb = TableReader::open(&run.join("T1.outb")).expect("an .outb");
    for channel in basis::channels::loads_of(3) {
        assert!(series.names().contains(&channel.at("T1")), "{}", channel.name);
        let is_it = |column: &&Column| column.name == channel.name;
        let column = outb.channels().find(is_it).expect("each channel of the series");
        assert_eq!(column.unit, channel.unit.symbol());
    }

    // All instants of a plane are in one file, all phases in another, and volumes are as fine as the flow.
    let planes = formats::netcdf::read_planes(&run.join("planes/hub-height.nc")).expect("instants");
    let times: Vec<f64> = planes.iter().map(|plane| plane.time).collect();
    assert_eq!(times.len(), 5, "{times:?}");
    assert!(times.is_sorted() && (times[0] - 60.0).abs() < 0.1, "{times:?}");
    let phases = formats::netcdf::read_phases(&run.join("planes/hub-height-phases.nc"));
    assert_eq!(phases.expect("phases").len(), 4);
    let volume = fs::read(run.join("volumes/velocity-0000.vti")).expect("a volume");
    let setup = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    let [n_x, n_y, n_z] = setup.plan.n_cells.map(|n| n - 1);
    let header = String::from_utf8_lossy(&volume[..400]).into_owned();
    assert!(header.contains(&format!("\"0 {n_x} 0 {n_y} 0 {n_z}\"")), "{header}");

    // What it takes on the disk was known beforehand, what goes with the checkpoint included.
    let reported = Outputs::standard().disk_of_run(&setup, &setup.case.runs[0]) as f64;
    let taken: usize = whole.iter().map(|(_, bytes)| bytes.len()).sum();
    assert!(
        (1.0..2.0).contains(&(reported / taken as f64)),
        "{reported} bytes reported, {taken} taken"
    );
}

/// The cost as it was told last.
#[derive(Default)]
struct Told(Option<Estimate>);

impl Observer for Told {
    fn estimated(&mut self, estimate: &Estimate) {
        self.0 = Some(estimate.clone());
    }
}

#[test]
fn a_dry_run_times_turbines_whose_pitch_is_yet_to_be_identified() {
    let joining = "{ kind = \"phase-sync\", offset_deg = 90.0, amplitude_deg = 3.0 }";
    let folder = written(&CASE.replace("{ kind = \"absent\" }", joining));
    let dry = StudyOptions { dry_run: true, ..options(folder.path(), "dry") };
    let mut told = Told::default();
    let outcome = study::run(&dry, &AtomicBool::new(false), &mut told);
    assert!(matches!(outcome, Ok(Outcome::Estimated)), "{outcome:?}");
    let estimate = told.0.expect("a cost");
    assert!(estimate.n_identifications > 0);
    assert!(estimate.wall_time().is_some_and(|time| time > 0.0 && time.is_finite()));
    assert!(!folder.path().join("dry").exists());
}
