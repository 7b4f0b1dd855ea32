//! What is probed before the runs stands in the records, and a resumed study takes it from there, with the same bits.

mod small;

use basis::records::PitchResponse;
use small::{NREL_5MW, written};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use study::{Estimate, Options, Outcome, Probing, Watcher};

fn case() -> String {
    let runs = r#"[[run]]
name = "watch"
control.T1 = { kind = "meandering", factor = 1.0, amplitude_deg = 0.0 }
[[run]]
name = "amplify"
control.T1 = { kind = "meandering", factor = 1.5, amplitude_deg = 2.0 }
[[run]]
name = "attenuate"
control.T1 = { kind = "meandering", factor = 0.5, amplitude_deg = 2.0 }
"#;
    small::case("probed", "shear_exponent = 0.0\n", [10.0, 60.0], &[NREL_5MW], runs)
}

/// What was told.
#[derive(Default)]
struct Told {
    n_probes: usize,
    shares: Vec<f64>,
    found: Vec<(PitchResponse, bool)>,
}

impl Watcher for Told {
    fn estimated(&mut self, estimate: &Estimate) {
        self.n_probes = estimate.n_probes;
        assert_eq!(estimate.n_probe_steps > 0, estimate.n_probes > 0);
        assert_eq!(estimate.probe_share() > 0.0, estimate.n_probes > 0);
    }

    fn probing(&mut self, probing: &Probing) {
        assert!(probing.time_left >= 0.0 && probing.index < probing.n_probes);
        self.shares.push(probing.share);
    }

    fn probed(&mut self, turbine: &str, response: &PitchResponse, again: bool) {
        assert_eq!(turbine, "T1");
        self.found.push((*response, again));
    }
}

fn options(folder: &Path, resume: bool, overrides: &[&str]) -> Options {
    let overrides = overrides.iter().map(|&text| text.to_owned()).collect();
    Options { overrides, resume, ..small::options(folder) }
}

fn run(folder: &Path, resume: bool, overrides: &[&str]) -> (Told, Vec<Option<PitchResponse>>) {
    let options = options(folder, resume, overrides);
    let mut told = Told::default();
    let outcome = study::run(&options, &AtomicBool::new(false), &mut told).expect("a sound case");
    let Outcome::Done { summaries, .. } = outcome else { panic!("{outcome:?}") };
    let responses = summaries.iter().map(|summary| summary.turbines[0].pitch_response).collect();
    (told, responses)
}

#[test]
fn a_resumed_study_takes_what_was_probed() {
    let folder = written(&case());
    let (first, responses) = run(folder.path(), false, &[]);
    // Once for both runs that act; the one that watches needs nothing.
    assert_eq!((first.n_probes, first.found.len()), (1, 1));
    assert!(!first.shares.is_empty());
    let (response, again) = first.found[0];
    assert!(!again);
    assert!(matches!(response, PitchResponse::Loads { gain, .. } if gain > 0.0), "{response:?}");
    assert_eq!(responses, [None, Some(response), Some(response)]);

    let before = fs::read(folder.path().join("out/attenuate/series.csv")).expect("a series");
    fs::remove_dir_all(folder.path().join("out/attenuate")).expect("a run");
    let (second, responses) = run(folder.path(), true, &[]);
    assert_eq!((second.n_probes, second.shares.len()), (0, 0));
    assert_eq!(second.found, [(response, true)]);
    assert_eq!(responses[2], Some(response));
    let after = fs::read(folder.path().join("out/attenuate/series.csv")).expect("a series");
    assert!(before == after, "a study that takes what was probed has other bits");

    // Another wind is another probe.
    fs::remove_dir_all(folder.path().join("out/attenuate")).expect("a run");
    fs::remove_dir_all(folder.path().join("out/amplify")).expect("a run");
    fs::remove_dir_all(folder.path().join("out/watch")).expect("a run");
    let (third, _) = run(folder.path(), true, &["wind.speed=8.0"]);
    assert_eq!((third.n_probes, third.found.len()), (1, 1));
    assert!(!third.found[0].1 && third.found[0].0 != response);
}

/// Asks for an end as soon as a probe moves.
struct Impatient<'a>(&'a AtomicBool);

impl Watcher for Impatient<'_> {
    fn probing(&mut self, probing: &Probing) {
        assert!(probing.share < 1.0, "the probe went on to its end");
        self.0.store(true, Ordering::Relaxed);
    }
}

#[test]
fn a_probe_stops_when_asked() {
    let folder = written(&case());
    let stop = AtomicBool::new(false);
    let options = options(folder.path(), false, &[]);
    let outcome = study::run(&options, &stop, &mut Impatient(&stop)).expect("a sound case");
    assert!(matches!(outcome, Outcome::Interrupted { .. }), "{outcome:?}");
    assert!(!folder.path().join("out/watch").exists(), "a run began after the end was asked for");
    let (resumed, responses) = run(folder.path(), true, &[]);
    assert_eq!((resumed.n_probes, responses.len()), (1, 3));
}
