//! Sweeps: keys of controllers make runs, all others make studies; whatever the number of jobs, the bits are
//! the same.

mod small;

use small::{options, written};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use study::{Estimate, Observer, Outcome, StudyError, StudyOptions};

/// A baseline and a helix behind which nobody stands, for 20 s of `wind`, with `more` at its end.
fn case(more: &str) -> String {
    let runs = format!("[[run]]\nname = \"baseline\"\n{}", small::behind_helix("helix", &[]));
    small::case("swept", "", [5.0, 20.0], &[small::NREL_5MW], &(runs + more))
}

const STROUHAL: &str = "[sweep]\n\"control.T1.strouhal\" = [0.2, 0.25]\n";

/// The series of every run below `folder`, by the run's folder.
fn series(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in fs::read_dir(&next).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else if path.ends_with("series.csv") {
                let run = next.strip_prefix(folder).expect("below").to_owned();
                found.insert(run, fs::read(&path).expect("a series"));
            }
        }
    }
    found
}

fn names(found: &BTreeMap<PathBuf, Vec<u8>>) -> Vec<String> {
    found.keys().map(|run| run.display().to_string()).collect()
}

#[test]
fn keys_of_controllers_make_runs_of_the_one_study() {
    let folder =
        written(&case(&(STROUHAL.to_owned() + "\"control.T1.amplitude_deg\" = [2, 3.5]\n")));
    let out = small::done(&options(folder.path()));
    let found = series(&out);
    let expected = [
        "baseline",
        "helix-strouhal-0.2-amplitude_deg-2",
        "helix-strouhal-0.2-amplitude_deg-3.5",
        "helix-strouhal-0.25-amplitude_deg-2",
        "helix-strouhal-0.25-amplitude_deg-3.5",
    ];
    assert_eq!(names(&found), expected);
    // Each is the run that a case without a sweep makes.
    let alone = case("").replace("amplitude_deg = 4.0", "amplitude_deg = 3.5");
    let other = written(&alone);
    let alone = series(&small::done(&options(other.path())));
    assert_eq!(found[Path::new(expected[4])], alone[Path::new("helix")]);
    let different = found[Path::new(expected[1])] != found[Path::new(expected[4])];
    assert!(different, "the values have no effect");
}

#[test]
fn other_keys_make_studies_and_any_number_of_jobs_gives_the_same_bits() {
    let text = case(&(STROUHAL.to_owned() + "wind.speed = [8, 9.5]\n"));
    let [one, three] = [1, 3].map(|jobs| {
        let folder = written(&text);
        let out = small::done(&StudyOptions { jobs: Some(jobs), ..options(folder.path()) });
        series(&out)
    });
    assert_eq!(
        names(&one),
        [
            "speed-8/baseline",
            "speed-8/helix-strouhal-0.2",
            "speed-8/helix-strouhal-0.25",
            "speed-9.5/baseline",
            "speed-9.5/helix-strouhal-0.2",
            "speed-9.5/helix-strouhal-0.25",
        ]
    );
    assert!(one == three, "jobs change the bits");
    assert_ne!(one[Path::new("speed-8/baseline")], one[Path::new("speed-9.5/baseline")]);
}

/// Keeps the first cost that is told.
#[derive(Default)]
struct Told(Option<Estimate>);

impl Observer for Told {
    fn estimated(&mut self, estimate: &Estimate) {
        self.0.get_or_insert_with(|| estimate.clone());
    }
}

fn told(options: &StudyOptions) -> Estimate {
    let mut told = Told::default();
    let stop = std::sync::atomic::AtomicBool::new(false);
    study::run(options, &stop, &mut told).expect("a sound case");
    told.0.expect("a cost")
}

#[test]
fn a_sweep_that_grows_makes_what_is_new_alone() {
    let folder = written(&case(STROUHAL));
    let first = options(folder.path());
    let dry = told(&StudyOptions { dry_run: true, ..first.clone() });
    assert_eq!((dry.n_runs, dry.n_studies), (3, 1));
    assert_eq!(dry.work, 3.0 * 100.0);
    let out = small::done(&first);
    let before = fs::read(out.join("helix-strouhal-0.2/summary.json")).expect("a summary");
    let longer = STROUHAL.replace("[0.2, 0.25]", "[0.15, 0.2, 0.25]");
    fs::write(folder.path().join("case.toml"), case(&longer)).expect("a case");
    let again = StudyOptions { resume: true, ..first };
    assert_eq!(told(&StudyOptions { dry_run: true, ..again.clone() }).n_runs, 1);
    small::done(&again);
    assert!(out.join("helix-strouhal-0.15/summary.json").is_file());
    let after = fs::read(out.join("helix-strouhal-0.2/summary.json")).expect("a summary");
    assert_eq!(before, after);
    // The records do not take it for another case, and stand in the order of the file.
    let records = formats::records::read_study(&out).expect("sound records");
    assert!(records.warnings.is_empty(), "{:?}", records.warnings);
    let runs: Vec<&str> = records.runs.iter().map(|run| run.summary.run.as_str()).collect();
    let ends = ["0.15", "0.2", "0.25"].map(|value| format!("helix-strouhal-{value}"));
    assert_eq!(runs[0], "baseline");
    assert_eq!(runs[1..], ends.each_ref().map(String::as_str));
}

#[test]
fn runs_are_picked_by_name_by_the_run_of_the_file_and_by_study() {
    let text = case(&(STROUHAL.to_owned() + "wind.speed = [8, 9]\n"));
    let picked = |names: &[&str]| {
        let folder = written(&text);
        let runs = names.iter().map(|&name| name.to_owned()).collect();
        let all = StudyOptions { runs, dry_run: true, ..options(folder.path()) };
        told(&all).n_runs
    };
    assert_eq!(picked(&["baseline"]), 2);
    assert_eq!(picked(&["helix"]), 4);
    assert_eq!(picked(&["speed-8/helix", "speed-8/helix-strouhal-0.2"]), 2);
    let folder = written(&text);
    let unknown = StudyOptions { runs: vec!["speed-7/helix".into()], ..options(folder.path()) };
    assert!(matches!(small::run(&unknown), Err(StudyError::UnknownRun { .. })));
}

#[test]
fn a_folder_of_another_kind_is_refused() {
    let folder = written(&case(STROUHAL));
    let first = options(folder.path());
    small::done(&first);
    let text = case(&(STROUHAL.to_owned() + "wind.speed = [8, 9]\n"));
    fs::write(folder.path().join("case.toml"), text).expect("a case");
    let error = small::run(&StudyOptions { resume: true, ..first }).expect_err("another kind");
    let StudyError::OtherSweep { found, expected, .. } = &error else { panic!("{error:?}") };
    assert_eq!(found, "one study");
    assert_eq!(expected, "a study for each value of wind.speed");
}

#[test]
fn seeds_make_a_study_each_and_more_of_them_later() {
    let turbulent = case("")
        .replace("turbulence_intensity = 0.0", "turbulence_intensity = 0.1\nseed = 7")
        .replace("solver = \"uniform\"", "solver = \"turbulence\"");
    let folder = written(&turbulent);
    let first = StudyOptions { seeds: Some(2), ..options(folder.path()) };
    let out = small::done(&first);
    let found = series(&out);
    assert_eq!(
        names(&found),
        ["seed-7/baseline", "seed-7/helix", "seed-8/baseline", "seed-8/helix"]
    );
    assert_ne!(found[Path::new("seed-7/baseline")], found[Path::new("seed-8/baseline")]);
    let more = StudyOptions { seeds: Some(3), resume: true, ..first };
    assert_eq!(told(&StudyOptions { dry_run: true, ..more.clone() }).n_runs, 2);
    let Ok(Outcome::Done { summaries, .. }) = small::run(&more) else { panic!("not done") };
    assert_eq!(summaries.len(), 6);
    // Where no seed changes anything there is nothing to make several of.
    let calm = written(&case(""));
    let error = small::run(&StudyOptions { seeds: Some(2), ..options(calm.path()) });
    let error = error.expect_err("there is no turbulence");
    let StudyError::Case(error) = error else { panic!("{error:?}") };
    assert!(error.to_lines().contains("wind.turbulence_intensity"), "{}", error.to_lines());
}
