//! Whatever is wrong with the records: a refusal names the file or folder, and what to do.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use miette::Diagnostic;
use postprocessing::analyses::{ANALYSES, Request};
use small::{DISK, MONITORING, NREL_5MW, behind_helix, done, options, written};
use std::fs;
use std::path::Path;

/// A run in which T2 looks for a helix and nobody kept the true wind; one without a helix.
fn case() -> String {
    let runs = behind_helix("monitoring", &[MONITORING]) + "[[run]]\nname = \"baseline\"\n";
    small::case(
        "refused",
        DISK,
        [10.0, 60.0],
        &[NREL_5MW; 2],
        &(runs + "[output]\ninterval = 0.4\n"),
    )
}

/// What the analysis called `name` says against `request`, which is about what stands in `folder`.
fn refused(name: &str, request: &Request, folder: &Path) -> String {
    let analysis = ANALYSES.iter().find(|analysis| analysis.name == name).expect("it is listed");
    let error = (analysis.run)(request).expect_err("nothing can be answered");
    let mut refusal = error.to_string();
    let mut cause = std::error::Error::source(&error);
    while let Some(deeper) = cause {
        refusal += &format!(": {deeper}");
        cause = deeper.source();
    }
    let place = folder.display().to_string();
    assert!(refusal.contains(&place), "{name} does not say where: {refusal}");
    let help = error.help().map(|help| help.to_string()).unwrap_or_default();
    assert!(help.len() > 20, "{name} does not say what to do: {refusal}");
    format!("{refusal}; {help}")
}

#[test]
fn every_refusal_names_file_and_fix() {
    let folder = written(&case());
    let out = done(&options(folder.path()));
    let [monitoring, baseline] = ["monitoring", "baseline"].map(|run| out.join(run));

    for name in ["phase", "tune", "lock"] {
        let none = out.join("none");
        refused(name, &Request::of(&none), &none);
        let unknown = Request::of(&monitoring).with("turbine", "T9");
        assert!(refused(name, &unknown, &monitoring).contains("T1, T2"));
    }
    for name in ["phase", "tune"] {
        refused(name, &Request::of(&monitoring), &out);
        refused(name, &Request::of(&baseline), &baseline);
        let first = Request::of(&monitoring).with("turbine", "T1");
        refused(name, &first, &out);
        let behind_nobody = Request::of(&baseline).with("turbine", "T2");
        assert!(
            refused(name, &behind_nobody, &baseline)
                .contains("no turbine upstream of T2 pitches a helix")
        );
    }
    let late = Request::of(&monitoring).with("from", "1e9");
    let refusal = refused("lock", &late, &monitoring.join("series.csv"));
    assert!(refusal.contains("--from"), "{refusal}");
    let nowhere = Request::of(&monitoring).with("strouhal-low", "30").with("strouhal-high", "40");
    refused("lock", &nowhere, &monitoring.join("series.csv"));
    let backwards =
        Request::of(&monitoring).with("strouhal-low", "0.4").with("strouhal-high", "0.2");
    refused("lock", &backwards, &monitoring.join("series.csv"));
    let twice = Request { folders: vec![out.clone(), out.clone()], ..Request::default() };
    refused("gains", &twice, &out);

    damaged(&monitoring);
}

/// Refusals of records that somebody has changed.
fn damaged(run: &Path) {
    let (series, manifest) = (run.join("series.csv"), run.join("manifest.json"));
    let sound = fs::read_to_string(&series).expect("a series");
    let lines: Vec<&str> = sound.lines().collect();
    let gap = [&lines[..60], &lines[64..]].concat().join("\n") + "\n";
    for (text, said) in [
        (sound.replace("T2.Azimuth_deg", "T2.Azimut_deg"), "has no channel `T2.Azimuth`"),
        (gap, "not evenly spaced"),
        (sound.replace("T2.RootMyc3_kN-m", "T2.RootMycx_kN-m"), "2 blades"),
        // As earlier programs wrote it.
        (sound.replacen("Time_s,", "time_s,", 1), "names and units of an earlier program"),
        (lines[..2].join("\n") + "\n", "too few"),
    ] {
        assert_ne!(text, sound);
        fs::write(&series, text).expect("a file");
        let refusal = refused("lock", &Request::of(run).with("turbine", "T2"), &series);
        assert!(refusal.contains(said), "{refusal}");
    }
    fs::write(&series, sound).expect("a file");
    let sound = fs::read_to_string(&manifest).expect("a manifest");
    for (from, to) in [("\"run_index\": 0", "\"run_index\": 7"), ("speed = 9", "sped = 9")] {
        let text = sound.replace(from, to);
        assert_ne!(text, sound, "{from}");
        fs::write(&manifest, text).expect("a file");
        for name in ["phase", "tune", "lock"] {
            refused(name, &Request::of(run), &manifest);
        }
    }
}
