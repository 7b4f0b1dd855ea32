//! The manifest of a run: what was run, by which program, on which machine, when.

use crate::{FileError, library};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::time::{SystemTime, UNIX_EPOCH};

/// Version of the layout of [`Manifest`].
const SCHEMA_VERSION: u32 = 1;

/// What was run, by which program, on which machine, when.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of this layout.
    pub schema_version: u32,
    /// Version of the program.
    pub version: String,
    /// Name of the case.
    pub case: String,
    /// What the case is for.
    pub description: Option<String>,
    /// Name of the run.
    pub run: String,
    /// Place of the run among the case's runs, from 0.
    pub run_index: usize,
    /// The case file as run, overrides included.
    pub case_text: String,
    /// SHA-256 of `case_text`, hexadecimal.
    pub case_sha256: String,
    /// SHA-256 of the text of each turbine model, and of each controller's own input file and its table,
    /// hexadecimal.
    pub turbines_sha256: BTreeMap<String, String>,
    /// Text of each of them that is not of the library, so that records can be asked anew without its file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub own_turbines: BTreeMap<String, String>,
    /// The machine.
    pub machine: Machine,
    /// Start of the run's first session (UTC, RFC 3339).
    pub started: String,
    /// End of the run's last session (UTC, RFC 3339); absent while it goes on.
    pub finished: Option<String>,
}

/// Where a run was made.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Name of the processor, where the system tells it.
    pub processor: Option<String>,
    /// Cores that the program may use (–).
    pub n_cores: usize,
    /// Operating system and architecture.
    pub system: String,
}

impl Machine {
    /// This machine.
    pub fn here() -> Self {
        let n_cores = std::thread::available_parallelism().map_or(1, usize::from);
        let system = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        let processor =
            fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| processor_of(&text));
        Self { processor, n_cores, system }
    }
}

fn processor_of(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

impl Manifest {
    /// The manifest of a run that starts now: run number `run_index` (from 0), `run`, of the case in
    /// `case_text`.
    ///
    /// `turbines` holds the text of each turbine model's file by the model's name, and of each controller's
    /// input file; `version` is the program's.
    pub fn start<'a>(
        version: &str,
        case: &farm::case::Case,
        case_text: &str,
        run_index: usize,
        turbines: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Self {
        let (mut turbines_sha256, mut own_turbines) = (BTreeMap::new(), BTreeMap::new());
        for (name, text) in turbines {
            turbines_sha256.insert(name.to_owned(), sha256(text.as_bytes()));
            if library::text(name).is_none() {
                own_turbines.insert(name.to_owned(), text.to_owned());
            }
        }
        Self {
            schema_version: SCHEMA_VERSION,
            version: version.to_owned(),
            case: case.name.clone(),
            description: case.description.clone(),
            run: case.runs.get(run_index).map(|run| run.name.clone()).unwrap_or_default(),
            run_index,
            case_text: case_text.to_owned(),
            case_sha256: sha256(case_text.as_bytes()),
            turbines_sha256,
            own_turbines,
            machine: Machine::here(),
            started: now(),
            finished: None,
        }
    }

    /// The manifest of the same run, ended now.
    pub fn finish(mut self) -> Self {
        self.finished = Some(now());
        self
    }
}

/// SHA-256 of `bytes`, hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// This moment (UTC, RFC 3339, whole seconds).
pub fn now() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    moment(since.as_secs())
}

/// The moment so many seconds after the start of 1970, UTC, proleptic Gregorian.
fn moment(seconds: u64) -> String {
    let (days, second) = (seconds / 86_400, seconds % 86_400);
    // Years that start in March, in cycles of 400 years, put the odd day last.
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 { march_month + 3 } else { march_month - 9 };
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    let (hour, minute, second) = (second / 3_600, second / 60 % 60, second % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

/// Reads a manifest.
///
/// # Errors
/// [`FileError::System`] or [`FileError::Content`].
pub fn read_manifest(folder: &super::RunFolder) -> Result<Manifest, FileError> {
    super::read_json(&folder.manifest_path(), "the manifest of a run")
}

/// Writes `manifest` into `folder`.
///
/// # Errors
/// [`FileError::System`].
pub fn write_manifest(folder: &super::RunFolder, manifest: &Manifest) -> Result<(), FileError> {
    super::write_json(&folder.manifest_path(), "the manifest of a run", manifest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_follow_the_calendar() {
        assert_eq!(moment(0), "1970-01-01T00:00:00Z");
        assert_eq!(moment(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(moment(1_000_000_000), "2001-09-09T01:46:40Z");
        assert_eq!(moment(4_107_542_399), "2100-02-28T23:59:59Z");
        assert_eq!(moment(4_107_542_400), "2100-03-01T00:00:00Z");
    }

    #[test]
    fn digests_are_those_of_the_standard() {
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), expected);
    }

    #[test]
    fn the_processor_is_read_where_the_system_reports_it() {
        let text = "processor\t: 0\nmodel name\t: Some CPU @ 2 GHz\nflags\t: x\n";
        assert_eq!(processor_of(text).as_deref(), Some("Some CPU @ 2 GHz"));
        assert_eq!(processor_of("BogoMIPS : 5\n"), None);
    }
}
