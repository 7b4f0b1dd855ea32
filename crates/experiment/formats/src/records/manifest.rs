//! The manifest of a run: what was run, by which program, on which machine, when.

use crate::clock::now;
use crate::{FileError, library};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

/// Bytes of a file that are taken in at once.
const BUFFER: usize = 1 << 20;
/// Version of the layout of [`Manifest`].
///
/// 2: what is of files and models is in lists, where their names were keys.
const SCHEMA_VERSION: u32 = 2;

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
    #[serde(with = "digests")]
    pub turbines_sha256: BTreeMap<String, String>,
    /// SHA-256 of each file of wind that the run blew from, hexadecimal, by its path as the case names it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", with = "digests")]
    pub wind_sha256: BTreeMap<String, String>,
    /// Text of each turbine model and input file that is not of the library, so that records can be asked
    /// anew without its file.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", with = "texts")]
    pub own_turbines: BTreeMap<String, String>,
    /// Where the mean wind of the case comes from (deg, clockwise from north); absent in manifests that do
    /// not tell, whose wind is from the west.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wind_direction_deg: Option<f64>,
    /// The machine.
    pub machine: Machine,
    /// What of the machine decides the bits of the run, in words; absent until it is complete.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backend: Option<String>,
    /// Start of the run's first part (UTC, RFC 3339).
    pub started: String,
    /// End of the run's last part (UTC, RFC 3339); absent while it goes on.
    pub finished: Option<String>,
}

/// A map from names to texts, written as a list of objects with `name` and a field for the text.
macro_rules! listed {
    ($(#[$about:meta])* $module:ident, $field:ident) => {
        $(#[$about])*
        mod $module {
            use serde::{Deserialize, Deserializer, Serialize, Serializer};
            use std::collections::BTreeMap;

            #[derive(Serialize, Deserialize)]
            struct Entry {
                name: String,
                $field: String,
            }

            pub(super) fn serialize<S: Serializer>(
                map: &BTreeMap<String, String>,
                serializer: S,
            ) -> Result<S::Ok, S::Error> {
                let entry = |(name, value): (&String, &String)| Entry {
                    name: name.clone(),
                    $field: value.clone(),
                };
                serializer.collect_seq(map.iter().map(entry))
            }

            pub(super) fn deserialize<'de, D: Deserializer<'de>>(
                deserializer: D,
            ) -> Result<BTreeMap<String, String>, D::Error> {
                let entries = Vec::<Entry>::deserialize(deserializer)?;
                Ok(entries.into_iter().map(|entry| (entry.name, entry.$field)).collect())
            }
        }
    };
}

listed!(
    /// Digests by name.
    digests,
    sha256
);
listed!(
    /// Texts by name.
    texts,
    text
);

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
            wind_sha256: BTreeMap::new(),
            own_turbines,
            wind_direction_deg: Some(case.wind.direction_deg()),
            backend: None,
            machine: Machine::here(),
            started: now(),
            finished: None,
        }
    }

    /// The manifest of the same run, number `run_index` of the case in `case_text`, that goes on.
    pub fn going_on(self, case_text: &str, run_index: usize) -> Self {
        let case_sha256 = sha256(case_text.as_bytes());
        let case_text = case_text.to_owned();
        Self { case_text, case_sha256, run_index, finished: None, ..self }
    }

    /// The manifest of the same run in the wind of files with these SHA-256.
    pub fn in_wind(self, wind_sha256: BTreeMap<String, String>) -> Self {
        Self { wind_sha256, ..self }
    }

    /// The manifest of the same run with shared `libraries` and their inputs, SHA-256 by name, among its
    /// machines.
    pub fn with_libraries(mut self, libraries: &BTreeMap<String, String>) -> Self {
        self.turbines_sha256.extend(libraries.clone());
        self
    }

    /// The manifest of the same run, ended now, computed with `backend`.
    pub fn finish(self, backend: &str) -> Self {
        Self { finished: Some(now()), backend: Some(backend.to_owned()), ..self }
    }
}

/// SHA-256 of `bytes`, hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(Sha256::new_with_prefix(bytes))
}

/// SHA-256 of the file at `path`, which holds `what`, as `sha256sum` prints it; of any length in little
/// memory.
///
/// # Errors
/// [`FileError::System`].
pub fn sha256_of_file(path: &Path, what: &'static str) -> Result<String, FileError> {
    let failed = |source| FileError::system("read", what, path, source);
    let mut file = File::open(path).map_err(failed)?;
    let (mut digest, mut bytes) = (Sha256::new(), vec![0; BUFFER]);
    loop {
        match file.read(&mut bytes).map_err(failed)? {
            0 => return Ok(hexadecimal(digest)),
            n => digest.update(&bytes[..n]),
        }
    }
}

fn hexadecimal(digest: Sha256) -> String {
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Reads a manifest.
///
/// # Errors
/// [`FileError::System`] or [`FileError::Content`].
pub fn read_manifest(folder: &super::RunFolder) -> Result<Manifest, FileError> {
    super::read_layout(&folder.manifest_path(), "the manifest of a run", SCHEMA_VERSION)
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
    fn digests_are_those_of_the_standard() {
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), expected);
        let file = tempfile::NamedTempFile::new().unwrap();
        for bytes in [&b"abc"[..], &[], &[7; BUFFER], &[7; 2 * BUFFER + 12_345]] {
            fs::write(file.path(), bytes).unwrap();
            assert_eq!(sha256_of_file(file.path(), "bytes").unwrap(), sha256(bytes));
        }
    }

    #[test]
    fn the_processor_is_read_where_the_system_reports_it() {
        let text = "processor\t: 0\nmodel name\t: Some CPU @ 2 GHz\nflags\t: x\n";
        assert_eq!(processor_of(text).as_deref(), Some("Some CPU @ 2 GHz"));
        assert_eq!(processor_of("BogoMIPS : 5\n"), None);
    }
}
