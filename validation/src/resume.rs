//! Kills at random moments: a run that is killed and resumed ends with the same bits as one that is not.

use crate::Row;
use crate::row::Tolerance::Within;
use crate::studies::command;
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

/// Files that differ between an undisturbed run and one that was killed [`N_KILLS`] times, out of those
/// compared.
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
        Ok((kills, compared, different)) => {
            tell!("{compared} files compared");
            vec![
                row(
                    "kills at random moments, each followed by --resume",
                    f64::from(kills),
                    f64::from(N_KILLS),
                ),
                row("files with other bits (series, planes, volumes)", different.len() as f64, 0.0),
            ]
        }
        Err(problem) => vec![row(&format!("could not be made: {problem}"), f64::NAN, 0.0)],
    }
}

fn kill_and_compare() -> Result<(u32, usize, Vec<PathBuf>), String> {
    let folder = std::env::temp_dir().join(format!("wakemix-kills-{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let case = folder.join("kills.toml");
    fs::write(&case, CASE).map_err(|error| error.to_string())?;
    let (whole, broken) = (folder.join("whole"), folder.join("broken"));
    let started = Instant::now();
    run_to_end(&case, &whole)?;
    // About how long a whole run takes; others on the machine may come and go.
    let mut undisturbed = started.elapsed();

    // Knuth's generator is random enough to spread the kills.
    let mut random: u64 = 20_261_121;
    let mut kills = 0;
    while kills < N_KILLS {
        random =
            random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let share = (random >> 33) as f64 / f64::from(u32::MAX >> 1);
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
    let mut compared = 0;
    let mut different = Vec::new();
    compare(&whole.join("helix"), &broken.join("helix"), &mut compared, &mut different)?;
    fs::remove_dir_all(&folder).map_err(|error| error.to_string())?;
    Ok((kills, compared, different))
}

fn run_to_end(case: &Path, output: &Path) -> Result<(), String> {
    let status = command(case, output).status().map_err(|error| error.to_string())?;
    if status.success() { Ok(()) } else { Err(format!("the run ended with {status}")) }
}

/// Compares what the simulation wrote; summary, manifest and checkpoint hold times of day and are left out.
fn compare(
    whole: &Path,
    broken: &Path,
    compared: &mut usize,
    different: &mut Vec<PathBuf>,
) -> Result<(), String> {
    for entry in fs::read_dir(whole).map_err(|error| error.to_string())? {
        let path = entry.map_err(|error| error.to_string())?.path();
        let Some(name) = path.file_name() else { continue };
        let other = broken.join(name);
        if path.is_dir() {
            compare(&path, &other, compared, different)?;
        } else if path
            .extension()
            .is_some_and(|kind| kind == "csv" || kind == "nc" || kind == "vti")
        {
            *compared += 1;
            if fs::read(&path).ok() != fs::read(&other).ok() {
                different.push(path);
            }
        }
    }
    Ok(())
}
