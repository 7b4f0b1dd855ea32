//! Pitch responses identified before the runs of a study: `DIR/probes.json`, so that a resumed study need
//! not identify them again.

use crate::{FileError, atomic};
use basis::records::PitchResponse;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

const WHAT: &str = "what was identified before the runs";
/// Version of the layout of [`Identified`].
///
/// 2: it tells its version, where it was a bare list of records.
const SCHEMA_VERSION: u32 = 2;

/// All that was identified. `probes.json` is this, written out.
#[derive(Serialize, Deserialize)]
struct Identified {
    /// Version of this layout.
    schema_version: u32,
    /// What was found, each key once.
    records: Vec<PitchResponseRecord>,
}

/// How the pitch of one turbine was found to act.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PitchResponseRecord {
    /// SHA-256 of everything that decides what is found, hexadecimal: equal for equal identifications alone.
    pub key: String,
    /// Name of the turbine for which it was found first.
    pub turbine: String,
    /// What was found.
    pub response: PitchResponse,
}

pub(super) fn path_in(study: &Path) -> PathBuf {
    study.join("probes.json")
}

/// Reads what was identified for the study in the folder `study`; nothing where nothing was.
///
/// # Errors
/// [`FileError::System`], and [`FileError::Content`] when it is something else or of another version of the
/// layout.
pub fn read_pitch_responses(study: &Path) -> Result<Vec<PitchResponseRecord>, FileError> {
    let path = path_in(study);
    if !path.is_file() {
        return Ok(Vec::new());
    }
    let read: Identified = super::read_layout(&path, WHAT, SCHEMA_VERSION)?;
    Ok(read.records)
}

/// Takes away what was identified for the study in the folder `study` where this program cannot read it, so
/// that runs which begin anew need not ask for it.
///
/// # Errors
/// [`FileError::System`].
pub fn discard_unreadable_pitch_responses(study: &Path) -> Result<(), FileError> {
    let path = path_in(study);
    if !path.is_file() {
        return Ok(());
    }
    let _lock = super::lock_shared(study, "probes")?;
    match read_pitch_responses(study) {
        Err(FileError::Content { .. }) => super::gone(fs::remove_file(&path), &path),
        read => read.map(|_| ()),
    }
}

/// Writes `records`, all that was identified, into the folder `study`, once nobody else does.
///
/// # Errors
/// [`FileError::System`].
pub fn write_pitch_responses(
    study: &Path,
    records: &[PitchResponseRecord],
) -> Result<(), FileError> {
    let _lock = super::lock_shared(study, "probes")?;
    put(study, records)
}

fn put(study: &Path, records: &[PitchResponseRecord]) -> Result<(), FileError> {
    atomic::create_folder(study)?;
    let all = Identified { schema_version: SCHEMA_VERSION, records: records.to_vec() };
    super::write_json(&path_in(study), WHAT, &all)
}

/// Adds `records` to what was identified for the study in the folder `study`, each key once; others may do so
/// at the same time.
///
/// # Errors
/// Those of [`read_pitch_responses`] and [`write_pitch_responses`].
pub fn add_pitch_responses(study: &Path, records: &[PitchResponseRecord]) -> Result<(), FileError> {
    let _lock = super::lock_shared(study, "probes")?;
    let mut all = read_pitch_responses(study)?;
    for record in records {
        match all.iter_mut().find(|known| known.key == record.key) {
            Some(known) => *known = record.clone(),
            None => all.push(record.clone()),
        }
    }
    put(study, &all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_several_add_at_once_is_all_there() {
        let study = tempfile::tempdir().unwrap();
        let folder = study.path().join("study");
        let record = |key: usize, azimuth_offset: f64| PitchResponseRecord {
            key: key.to_string(),
            turbine: "T1".into(),
            response: PitchResponse::IndividualPitch { azimuth_offset },
        };
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let (folder, record) = (&folder, &record);
                scope.spawn(move || {
                    let found: Vec<_> = (0..6).map(|n| record(10 * thread + n, 0.1)).collect();
                    (1..=6).for_each(|n| add_pitch_responses(folder, &found[..n]).unwrap());
                });
            }
        });
        assert_eq!(read_pitch_responses(&folder).unwrap().len(), 24);
        add_pitch_responses(&folder, &[record(0, 0.2)]).unwrap();
        let all = read_pitch_responses(&folder).unwrap();
        assert_eq!(all.len(), 24);
        assert!(all.contains(&record(0, 0.2)) && !all.contains(&record(0, 0.1)));
    }

    #[test]
    fn numbers_come_back_with_their_bits() {
        let study = tempfile::tempdir().unwrap();
        assert_eq!(read_pitch_responses(study.path()).unwrap(), []);
        let third = 1.0 / 3.0;
        let records: Vec<PitchResponseRecord> = (0..200)
            .map(|index| {
                let value = third * 1.1_f64.powi(index);
                let loads = PitchResponse::Loads {
                    azimuth_offset: -value,
                    delay: value.sqrt(),
                    gain: 1e8 * value.sin(),
                };
                PitchResponseRecord {
                    key: format!("{index}"),
                    turbine: "T2".into(),
                    response: loads,
                }
            })
            .collect();
        write_pitch_responses(study.path(), &records).unwrap();
        assert_eq!(read_pitch_responses(study.path()).unwrap(), records);
    }

    #[test]
    fn what_a_synchronised_turbine_was_given_comes_back_and_may_not_be_told() {
        let study = tempfile::tempdir().unwrap();
        let estimator = |transformation_offset| PitchResponse::Estimator {
            gain: 1.04,
            azimuth_offset: -0.01,
            before: 0.12,
            after: 0.0,
            transformation_offset,
        };
        let transformation = PitchResponse::Transformation { azimuth_offset: 0.6 };
        let individual = PitchResponse::IndividualPitch { azimuth_offset: 0.6 };
        let records =
            [estimator(Some(0.6)), estimator(None), transformation, individual].map(|response| {
                PitchResponseRecord { key: "a".to_owned(), turbine: "T2".to_owned(), response }
            });
        write_pitch_responses(study.path(), &records).unwrap();
        assert_eq!(read_pitch_responses(study.path()).unwrap(), records);
        let silent = r#"{"schema_version": 2, "records": [{"key": "a", "turbine": "T2", "response": {"kind":
            "estimator", "gain": 1.04, "azimuth_offset": -0.01, "before": 0.12, "after": 0.0}}]}"#;
        fs::write(path_in(study.path()), silent).unwrap();
        assert_eq!(read_pitch_responses(study.path()).unwrap(), &records[1..2]);
    }

    #[test]
    fn what_another_program_identified_says_who_wrote_it_and_what_to_do() {
        let study = tempfile::tempdir().unwrap();
        let path = path_in(study.path());
        let earlier = r#"[{"key": "a", "turbine": "T2", "response": {"azimuth_offset": 0.6}}]"#;
        let newer = r#"{"schema_version": 3}"#;
        let cases = [
            (earlier, "it has no schema_version, as that of an earlier wakemix; this one reads 2"),
            ("[]", "as that of an earlier wakemix"),
            ("{}", "as that of an earlier wakemix"),
            (newer, "its schema_version is 3, that of a later wakemix; this one reads 2"),
        ];
        for (text, expected) in cases {
            fs::write(&path, text).unwrap();
            let error = read_pitch_responses(study.path()).unwrap_err();
            let told = error.to_string();
            assert!(told.contains("probes.json") && told.contains(expected), "{told}");
            let help = miette::Diagnostic::help(&error).unwrap().to_string();
            assert!(help.contains("--overwrite") || text == newer, "{help}");
            // Who begins anew goes on without it.
            discard_unreadable_pitch_responses(study.path()).unwrap();
            assert!(!path.exists(), "{text}");
        }
        let response = PitchResponse::Transformation { azimuth_offset: 0.6 };
        let own = [PitchResponseRecord { key: "a".into(), turbine: "T2".into(), response }];
        write_pitch_responses(study.path(), &own).unwrap();
        discard_unreadable_pitch_responses(study.path()).unwrap();
        assert_eq!(read_pitch_responses(study.path()).unwrap(), own);
    }
}
