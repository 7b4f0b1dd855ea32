//! A controller of others for trials: a small library in C, compiled as it is needed.
#![allow(dead_code, reason = "each test binary uses its part")]

use std::fs;
use std::path::Path;
use std::process::Command;

/// Gear ratio of the turbine that it controls (–), torque over speed squared (N m s²) and rated speed (rad/s)
/// on its high-speed side.
pub(crate) const GEAR_RATIO: f64 = 97.0;
pub(crate) const TORQUE_GAIN: f64 = 2.18e6 / (GEAR_RATIO * GEAR_RATIO * GEAR_RATIO);
pub(crate) const RATED_SPEED: f64 = 1.2 * GEAR_RATIO;
/// Proportional (s) and integral gain (–), and greatest pitch (rad).
pub(crate) const GAINS: [f64; 3] = [0.01, 0.002, 1.5];

/// On return `folder` holds `libdiscon.so`, compiled from `law.c` beside this file.
pub(crate) fn compiled(folder: &Path) {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join(LAW);
    let output = Command::new("cc")
        .args(["-O1", "-shared", "-fPIC", "-o"])
        .arg(folder.join("libdiscon.so"))
        .arg(source)
        .output()
        .expect("a C compiler");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Where the source is, seen from the crate that is tested.
const LAW: &str = "../../experiment/study/tests/foreign/law.c";

/// On return `folder` holds `DISCON.IN`: the library does `trick` from `when` (s) on.
pub(crate) fn input(folder: &Path, trick: &str, when: f64) {
    let [proportional, integral, greatest] = GAINS;
    let text = format!(
        "{TORQUE_GAIN:e} {RATED_SPEED} {proportional} {integral} {greatest} {trick} {when}\n"
    );
    fs::write(folder.join("DISCON.IN"), text).expect("an input file");
}
