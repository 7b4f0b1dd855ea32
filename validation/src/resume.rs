//! Kills at random moments: a run that is killed and resumed ends with the same bits as one that is not.

use crate::Row;
use crate::random::Random;
use crate::row::Tolerance::Within;
use crate::studies::command;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Instant;

/// Where the expected values come from.
const SOURCE: &str = "the same bits";

const N_KILLS: u32 = 20;
/// A small row in turbulent wind: every state that a run has, in seconds. The estimator is one that is not
/// calibrated first, and the azimuth offset is given, or most kills would hit their identification.
const CASE: &str = r#"
name = "kills"
[wind]
speed = 9.0
turbulence_intensity = 0.06
shear_exponent = 0.1
[flow]
cells_per_diameter = 14
upstream_diameters = 2.0
downstream_diameters = 2.0
width_diameters = 3.0
height_diameters = 3.0
ground = { roughness_length = 0.001 }
[time]
spin_up = 30.0
duration = 1230.0
[output]
plane_interval = 60.0
volume_interval = 600.0
crosswind_diameters = [1.0]
checkpoint_interval = 1
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [3.0, 0.2]
instruments.flap_moments = { noise_mnm = 0.3, dropout = 0.02, time_constant = 0.1 }
instruments.rotor_speed = { resolution_rpm = 0.01 }
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
control.T2 = { kind = "phase-sync", offset_deg = 90.0, amplitude_deg = 3.0, start = 60.0, estimator = "published", azimuth_offset_deg = 0.0 }
"#;

/// Series, planes and volumes that the case writes (–).
const N_FILES: f64 = 69.0;
/// Their ends; summary, manifest and checkpoint hold times of day and are not compared.
const COMPARED: [&str; 3] = ["csv", "nc", "vti"];

/// How many files were compared of an undisturbed run and one that was killed [`N_KILLS`] times at random
/// moments, each kill followed by `--resume`, and how many differ.
pub fn resume() -> Vec<Row> {
    let row = |what: &str, measured: f64, expected: f64| Row {
        what: what.to_owned(),
        measured,
        expected,
        tolerance: Within(0.0),
        unit: "-",
        source: SOURCE,
    };
    match kill_and_compare() {
        Ok(Compared { same, different }) => {
            different.iter().for_each(|file| tell!("not the same: {}", file.display()));
            vec![
                row(
                    "files compared (series, planes, volumes)",
                    (same + different.len()) as f64,
                    N_FILES,
                ),
                row(
                    "files with other bits, missing or left over after 20 kills and resumes",
                    different.len() as f64,
                    0.0,
                ),
            ]
        }
        Err(problem) => vec![row(&format!("could not be made: {problem}"), f64::NAN, 0.0)],
    }
}

fn kill_and_compare() -> Result<Compared, String> {
    let folder = std::env::temp_dir().join(format!("wakemix-kills-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let case = folder.join("kills.toml");
    fs::write(&case, CASE).map_err(|error| error.to_string())?;
    let (whole, broken) = (folder.join("whole"), folder.join("broken"));
    let started = Instant::now();
    run_to_end(&case, &whole)?;
    // About how long a whole run takes; others on the machine may come and go.
    let mut undisturbed = started.elapsed();

    let mut random = Random(20_261_121);
    let mut kills = 0;
    while kills < N_KILLS {
        let share = (random.bits() >> 33) as f64 / f64::from(u32::MAX >> 1);
        let mut child = command(&case, &broken).spawn().map_err(|error| error.to_string())?;
        sleep(undisturbed.mul_f64(0.2 + 0.3 * share));
        let ended = child.try_wait().map_err(|error| error.to_string())?;
        child.kill().map_err(|error| error.to_string())?;
        child.wait().map_err(|error| error.to_string())?;
        if ended.is_some() {
            // It came to its end before the kill: start over, so that all kills hit a running program.
            fs::remove_dir_all(&broken).map_err(|error| error.to_string())?;
            undisturbed = undisturbed.mul_f64(0.7);
        } else {
            kills += 1;
        }
    }
    run_to_end(&case, &broken)?;
    let compared = compare(&whole.join("helix"), &broken.join("helix"))?;
    fs::remove_dir_all(&folder).map_err(|error| error.to_string())?;
    Ok(compared)
}

fn run_to_end(case: &Path, output: &Path) -> Result<(), String> {
    let status = command(case, output).status().map_err(|error| error.to_string())?;
    if status.success() { Ok(()) } else { Err(format!("the run ended with {status}")) }
}

/// What came out of a comparison of two folders.
#[derive(Debug, Default, PartialEq)]
struct Compared {
    /// How many files have the same bits (–).
    same: usize,
    /// Those with other bits, and those of any kind that only one of the folders has.
    different: Vec<PathBuf>,
}

/// Compares what the simulation wrote.
fn compare(whole: &Path, broken: &Path) -> Result<Compared, String> {
    let [mut here, mut there] = [BTreeSet::new(), BTreeSet::new()];
    files(whole, Path::new(""), &mut here)?;
    files(broken, Path::new(""), &mut there)?;
    let mut compared = Compared::default();
    for file in here.union(&there) {
        let in_both = here.contains(file) && there.contains(file);
        let holds_bits =
            COMPARED.iter().any(|kind| file.extension().is_some_and(|end| end == *kind));
        if in_both && !holds_bits {
            continue;
        }
        let read = |folder: &Path| fs::read(folder.join(file)).map_err(|error| error.to_string());
        if in_both && read(whole)? == read(broken)? {
            compared.same += 1;
        } else {
            compared.different.push(file.clone());
        }
    }
    Ok(compared)
}

/// Adds the files in `folder` and below, seen from it, to `found`; `place` is where `folder` is seen from the
/// first.
fn files(folder: &Path, place: &Path, found: &mut BTreeSet<PathBuf>) -> Result<(), String> {
    let named = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(named)? {
        let entry = entry.map_err(named)?;
        let place = place.join(entry.file_name());
        if entry.path().is_dir() {
            files(&entry.path(), &place, found)?;
        } else {
            found.insert(place);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_bits_missing_files_and_files_left_over_are_seen() {
        let root = std::env::temp_dir().join(format!("wakemix-compare-{}", std::process::id()));
        let [whole, broken] = ["whole", "broken"].map(|name| root.join(name));
        let write = |folder: &Path, name: &str, text: &str| {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        };
        for folder in [&whole, &broken] {
            write(folder, "series.csv", "1\n");
            write(folder, "planes/1.nc", "a");
            // Times of day.
            write(folder, "summary.json", &folder.display().to_string());
        }
        assert_eq!(compare(&whole, &broken).unwrap(), Compared { same: 2, different: vec![] });
        write(&broken, "planes/1.nc", "b");
        write(&broken, "planes/2.nc", "a");
        write(&broken, "series.csv.part", "1");
        write(&whole, "volumes/1.vti", "a");
        let compared = compare(&whole, &broken).unwrap();
        let different = ["planes/1.nc", "planes/2.nc", "series.csv.part", "volumes/1.vti"];
        assert_eq!(compared, Compared { same: 1, different: different.map(PathBuf::from).into() });
        // Nothing is not the same as nothing.
        assert!(compare(&root.join("no"), &root.join("such")).is_err());
        fs::remove_dir_all(&root).unwrap();
    }
}
