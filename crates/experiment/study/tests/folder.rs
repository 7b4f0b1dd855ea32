//! What a study does with its folder: stopped while turbulence is made, reckoned on the disk, tidied of what
//! killed processes left.

mod small;

use small::{options, written};
use std::fs::{self, File};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};
use study::{Estimate, Observer, Outcome, Prepared, StudyOptions};

/// Two flexible turbines in turbulence of `model`, for a minute.
fn case(model: &str) -> String {
    format!(
        r#"
name = "folder"
[wind]
speed = 9.0
turbulence_intensity = 0.1
turbulence_model = "{model}"
[flow]
solver = "turbulence"
[time]
spin_up = 5.0
duration = 60.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = {{ kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }}
"#
    )
}

/// Asks for an end as soon as a share of the turbulence is made.
struct Stopping<'a> {
    stop: &'a AtomicBool,
    share: f64,
    last: f64,
}

impl Observer for Stopping<'_> {
    fn preparing(&mut self, what: &str, share: f64) {
        if what == "turbulence" {
            assert!(!self.stop.load(Ordering::Relaxed), "it went on after it was stopped");
            self.last = share;
            self.stop.store(share >= self.share, Ordering::Relaxed);
        }
    }
}

#[test]
fn a_stop_is_heard_while_turbulence_is_made() {
    for model in ["kaimal", "mann"] {
        let folder = written(&case(model));
        let stop = AtomicBool::new(false);
        let mut observer = Stopping { stop: &stop, share: 0.4, last: 0.0 };
        let outcome = study::run(&options(folder.path()), &stop, &mut observer);
        assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{model}: {outcome:?}");
        assert!(observer.last >= 0.4 && observer.last < 1.0, "{model}: {}", observer.last);
        assert!(!folder.path().join("out/baseline/series.csv.part").exists(), "{model}");
    }
    // What was stopped there goes on from there.
    let folder = written(&case("kaimal"));
    let stop = AtomicBool::new(false);
    let mut observer = Stopping { stop: &stop, share: 0.1, last: 0.0 };
    let outcome = study::run(&options(folder.path()), &stop, &mut observer);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    let resumed = StudyOptions { resume: true, ..options(folder.path()) };
    let outcome = small::run(&resumed);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
}

/// Keeps what was told of the disk.
#[derive(Default)]
struct Told(Option<Estimate>);

impl Observer for Told {
    fn estimated(&mut self, estimate: &Estimate) {
        self.0.get_or_insert_with(|| estimate.clone());
    }
}

#[test]
fn the_disk_that_is_told_is_what_is_taken_or_little_more() {
    let folder = written(&case("kaimal"));
    let mut told = Told::default();
    let outcome = study::run(&options(folder.path()), &AtomicBool::new(false), &mut told);
    assert!(matches!(outcome, Ok(Outcome::Done { .. })), "{outcome:?}");
    let Some(estimate) = told.0 else { panic!("nothing was told") };
    let mut in_all = 0;
    for run in ["baseline", "helix"] {
        let taken = formats::machine::size_of_folder(&folder.path().join("out").join(run));
        // What lies beside the files on the way is gone by now.
        let ratio = estimate.disk as f64 / taken as f64;
        assert!((1.0..1.5).contains(&ratio), "{run}: {} told, {taken} taken", estimate.disk);
        in_all += taken;
    }
    // The report, which is not made here, is reckoned with.
    let report = 4 << 20;
    let ratio = (estimate.disk_in_all - report) as f64 / in_all as f64;
    assert!((1.0..1.5).contains(&ratio), "{} told, {in_all} taken", estimate.disk_in_all);
    // So is each row of a series, without what stands around them.
    let csv = fs::metadata(folder.path().join("out/helix/series.csv")).expect("a series").len();
    let outb: u64 = ["T1.outb", "T2.outb"]
        .iter()
        .filter_map(|name| fs::metadata(folder.path().join("out/helix").join(name)).ok())
        .map(|file| file.len())
        .sum();
    let ratio = (estimate.n_rows * estimate.row) as f64 / (csv + outb) as f64;
    assert!((0.95..1.5).contains(&ratio), "{} bytes a row told, {ratio}", estimate.row);
    // Its channels are counted, not guessed.
    let header = fs::read_to_string(folder.path().join("out/helix/series.csv")).expect("a series");
    let header = header.lines().next().expect("a header");
    let setup = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    assert_eq!(setup.channels_of_run(1), header.split(',').count() as u64);
}

#[test]
fn what_killed_processes_left_goes_when_the_folder_is_taken_again() {
    let text = small::case("left", "", [1.0, 10.0], &[small::NREL_5MW], "[[run]]\nname = \"a\"\n");
    let folder = written(&text);
    small::done(&options(folder.path()));
    let out = folder.path().join("out");
    let of_run = ["a/.T1.outb.4711.rows", "a/.summary.json.4711.part", "a/planes/.x.nc.7.part"];
    let of_study = [".probes.json.4711.part", ".report.html.12.4711.part"];
    for name in of_run.iter().chain(&of_study) {
        let file = File::create(out.join(name)).expect("a file");
        let old = SystemTime::now() - Duration::from_secs(3600);
        file.set_modified(old).expect("a time");
    }
    // A turbine that is not in this version of the case.
    fs::write(out.join("a/T9.outb"), "old").expect("a file");
    let again = StudyOptions { overwrite: true, ..options(folder.path()) };
    small::done(&again);
    for name in of_run.iter().chain(&of_study).chain(&["a/T9.outb"]) {
        assert!(!out.join(name).exists(), "{name} is still there");
    }
    assert!(out.join("a/T1.outb").is_file());
}
