//! Lidar loops that take their reference from another run: that one is made first, wherever it stands, and
//! what is not there is told before anything runs.

mod small;

use basis::records::{Summary, TurbineSummary};
use formats::linear_model::{LinearModel, Port, Role};
use formats::records::{RunFolder, read_manifest, read_summary};
use small::{options, written};
use std::fs;
use std::path::Path;
use study::{StudyError, StudyOptions};

/// A turbine whose lidar sees a disk of fast air that circles, in two winds: the open loop of the second is
/// the reference in both.
fn case() -> String {
    let disk = "event = { kind = \"rotating-disk\", speed = 13.0, strouhal = 0.25, strouhal_last = 0.25, radius_diameters = 0.1, edge_diameters = 0.1, sense = \"ccw\" }\n";
    let lidar = "model = \"nrel-5mw\"\nsensors.lidar = { kind = \"lidar\", rate_hz = 2.5 }";
    let common = "sense = \"ccw\", amplitude_deg = 1.0, strouhal = 0.25, vortex_interval = 0.4";
    let runs = format!(
        "[[run]]\nname = \"baseline\"\n\
         [[run]]\nname = \"open\"\ncontrol.T1 = {{ kind = \"probing\", {common}, noise_amplitude_deg = 0.0 }}\n\
         [[run]]\nname = \"closed\"\ncompare_with = \"open\"\ncontrol.T1 = {{ kind = \"lidar-loop\", {common}, controller = \"law.json\", reference_run = \"./out/speed-10/open\", reference_shift_yaw = 0.5 }}\n\
         [sweep]\n\"wind.speed\" = [9.0, 10.0]\n"
    );
    small::case("referred", disk, [60.0, 90.0], &[lidar], &runs)
}

/// A law that pitches `gain` (deg/m) against the error, in `folder`.
fn law(folder: &Path, gain: f64) {
    let ports = |[tilt, yaw]: [&str; 2], unit: &str| {
        [tilt, yaw].map(|name| Port { name: name.to_owned(), unit: unit.to_owned() }).to_vec()
    };
    let ports = [ports(["VortexTilt", "VortexYaw"], "m"), ports(["Tilt", "Yaw"], "deg")];
    let direct = vec![vec![gain, 0.0], vec![0.0, gain]];
    let matrices = [Vec::new(), Vec::new(), vec![Vec::new(); 2], direct];
    let model = LinearModel::new(Role::Controller, "a gain".to_owned(), Some(0.4), ports, matrices);
    model.write(&folder.join("law.json")).expect("a file");
}

fn summary(out: &Path, run: &str) -> Summary {
    read_summary(&RunFolder::new(out, run)).expect("a summary")
}

fn finding(summary: &Summary, name: &str) -> f64 {
    let TurbineSummary { control, .. } = &summary.turbines[0];
    let found = control.findings.iter().find(|finding| finding.name == name);
    found.and_then(|finding| finding.value).expect(name)
}

#[test]
fn the_run_of_reference_is_made_first_and_decides_the_closed_loops_alone() {
    let folder = written(&case());
    law(folder.path(), 0.05);
    let options = StudyOptions { jobs: Some(2), ..options(folder.path()) };
    let out = small::done(&options);
    let open = summary(&out, "speed-10/open");
    let mean = ["hub-vortex-tilt", "hub-vortex-yaw"].map(|name| finding(&open, name));
    assert!(mean[0].hypot(mean[1]) > 2.0, "{mean:?}");
    for speed in ["speed-9", "speed-10"] {
        let closed = summary(&out, &format!("{speed}/closed"));
        assert_eq!(finding(&closed, "reference-tilt"), mean[0]);
        assert_eq!(finding(&closed, "reference-yaw"), mean[1] + 0.5);
        assert!(finding(&closed, "helix-pitch") > 0.0 && closed.compare_with.is_some());
    }
    assert!((finding(&open, "helix-pitch") - 1.0).abs() < 1e-9);
    let told = |run: &str| read_manifest(&RunFolder::new(&out, run)).expect("it").turbines_sha256;
    assert!(told("speed-9/closed").contains_key("law.json"));
    assert!(!told("speed-9/open").contains_key("law.json"));

    // Another law leaves the others as they are, and is refused where it decided.
    law(folder.path(), 0.06);
    let resumed = StudyOptions { resume: true, ..options.clone() };
    let alone = |run: &str| StudyOptions { runs: vec![run.to_owned()], ..resumed.clone() };
    small::done(&alone("baseline"));
    small::done(&alone("open"));
    let refused = small::run(&alone("closed")).expect_err("another law");
    assert!(matches!(refused, StudyError::OtherFile { ref file, .. } if file == "law.json"));
    law(folder.path(), 0.05);
    small::done(&resumed);
}

#[test]
fn a_run_of_reference_that_nobody_makes_is_told_at_once() {
    let folder = written(&case());
    law(folder.path(), 0.05);
    let runs = ["speed-9/open", "speed-9/closed"].map(str::to_owned).to_vec();
    let options = StudyOptions { runs, ..options(folder.path()) };
    let refused = small::run(&options).expect_err("no reference").to_string();
    assert!(refused.contains("speed-10") && refused.contains("closed takes its"), "{refused}");
    assert!(fs::metadata(folder.path().join("out/speed-9/open/series.csv")).is_err());
    // In a dry run of all it is among those to be made.
    let dry = StudyOptions { runs: Vec::new(), dry_run: true, ..options };
    assert!(small::run(&dry).is_ok());
}

#[test]
fn a_run_that_leads_back_to_itself_is_told_at_once() {
    let there = "reference_run = \"./out/speed-10/";
    let text = case().replace(&format!("{there}open"), &format!("{there}closed"));
    let folder = written(&text);
    law(folder.path(), 0.05);
    let refused = small::run(&options(folder.path())).expect_err("a ring").to_string();
    assert!(refused.contains("speed-10") && refused.contains("leads back to it"), "{refused}");
    assert!(fs::metadata(folder.path().join("out/speed-9/baseline/series.csv")).is_err());
}
