//! What is identified before the runs stands in the records, and a resumed study takes it from there, with
//! the same bits.

mod small;

use basis::records::PitchResponse;
use small::{NREL_5MW, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use study::{Estimate, IdentificationProgress, Observer, Outcome, StudyOptions};

fn case() -> String {
    let runs = r#"[[run]]
name = "monitor"
control.T1 = { kind = "meandering", factor = 1.0, amplitude_deg = 0.0 }
[[run]]
name = "amplify"
control.T1 = { kind = "meandering", factor = 1.5, amplitude_deg = 2.0 }
[[run]]
name = "attenuate"
control.T1 = { kind = "meandering", factor = 0.5, amplitude_deg = 2.0 }
"#;
    small::case("identified", "shear_exponent = 0.0\n", [10.0, 60.0], &[NREL_5MW], runs)
}

/// What was reported.
#[derive(Default)]
struct Reports {
    n_identifications: usize,
    shares: Vec<f64>,
    found: Vec<(PitchResponse, bool)>,
}

impl Observer for Reports {
    fn estimated(&mut self, estimate: &Estimate) {
        self.n_identifications = estimate.n_identifications;
        assert_eq!(estimate.n_identification_steps > 0, estimate.n_identifications > 0);
        assert_eq!(estimate.identification_share() > 0.0, estimate.n_identifications > 0);
    }

    fn identifying(&mut self, progress: &IdentificationProgress) {
        assert!(progress.time_left >= 0.0 && progress.index < progress.n_identifications);
        self.shares.push(progress.share);
    }

    fn identified(&mut self, turbine: &str, response: &PitchResponse, again: bool) {
        assert_eq!(turbine, "T1");
        self.found.push((*response, again));
    }
}

fn options(folder: &Path, resume: bool, overrides: &[&str]) -> StudyOptions {
    let overrides = overrides.iter().map(|&text| text.to_owned()).collect();
    StudyOptions { overrides, resume, ..small::options(folder) }
}

fn run(folder: &Path, resume: bool, overrides: &[&str]) -> (Reports, Vec<Option<PitchResponse>>) {
    let options = options(folder, resume, overrides);
    let mut reports = Reports::default();
    let outcome =
        study::run(&options, &AtomicBool::new(false), &mut reports).expect("a sound case");
    let Outcome::Done { summaries, .. } = outcome else { panic!("{outcome:?}") };
    let responses = summaries.iter().map(|summary| summary.turbines[0].pitch_response).collect();
    (reports, responses)
}

#[test]
fn a_resumed_study_takes_what_was_identified() {
    let folder = written(&case());
    let (first, responses) = run(folder.path(), false, &[]);
    // Once for both runs that act; the one that monitors needs nothing.
    assert_eq!((first.n_identifications, first.found.len()), (1, 1));
    assert!(!first.shares.is_empty());
    let (response, again) = first.found[0];
    assert!(!again);
    assert!(matches!(response, PitchResponse::Loads { gain, .. } if gain > 0.0), "{response:?}");
    assert_eq!(responses, [None, Some(response), Some(response)]);

    let before = fs::read(folder.path().join("out/attenuate/series.csv")).expect("a series");
    fs::remove_dir_all(folder.path().join("out/attenuate")).expect("a run");
    let (second, responses) = run(folder.path(), true, &[]);
    assert_eq!((second.n_identifications, second.shares.len()), (0, 0));
    assert_eq!(second.found, [(response, true)]);
    assert_eq!(responses[2], Some(response));
    let after = fs::read(folder.path().join("out/attenuate/series.csv")).expect("a series");
    assert!(before == after, "a study that takes what was identified has other bits");

    // Another wind is another identification.
    fs::remove_dir_all(folder.path().join("out/attenuate")).expect("a run");
    fs::remove_dir_all(folder.path().join("out/amplify")).expect("a run");
    fs::remove_dir_all(folder.path().join("out/monitor")).expect("a run");
    let (third, _) = run(folder.path(), true, &["wind.speed=8.0"]);
    assert_eq!((third.n_identifications, third.found.len()), (1, 1));
    assert!(!third.found[0].1 && third.found[0].0 != response);
}

/// Asks for an end as soon as an identification moves.
struct Impatient<'a>(&'a AtomicBool);

impl Observer for Impatient<'_> {
    fn identifying(&mut self, progress: &IdentificationProgress) {
        assert!(progress.share < 1.0, "the identification went on to its end");
        self.0.store(true, Ordering::Relaxed);
    }
}

#[test]
fn an_identification_stops_on_request() {
    let folder = written(&case());
    let stop = AtomicBool::new(false);
    let options = options(folder.path(), false, &[]);
    let outcome = study::run(&options, &stop, &mut Impatient(&stop)).expect("a sound case");
    assert!(matches!(outcome, Outcome::Interrupted { .. }), "{outcome:?}");
    assert!(!folder.path().join("out/monitor").exists(), "a run began after the end was asked for");
    // Nothing was begun that could be resumed.
    let (again, responses) = run(folder.path(), false, &[]);
    assert_eq!((again.n_identifications, responses.len()), (1, 3));
}
