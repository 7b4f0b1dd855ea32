//! Checkpoints come back bit for bit, and no damage goes unnoticed.

use super::*;
use proptest::prelude::*;
use std::fs;

const HELIX: Identity =
    Identity { case_text: "some case", run: "helix", version: "0.1.0", backend: "avx512" };

fn write(path: &Path, numbers: &[f64], air: &[u8]) {
    let mut writer = CheckpointWriter::create(path, &HELIX).unwrap();
    writer.state("run", &numbers).unwrap();
    writer.stream("air", |bytes| bytes.write_all(air)).unwrap();
    writer.finish().unwrap();
}

fn read(path: &Path) -> Result<(Vec<f64>, Vec<u8>), FileError> {
    let mut reader = CheckpointReader::open(path, &HELIX)?;
    let mut air = Vec::new();
    let numbers = reader.state("run")?;
    reader.stream("air", |bytes| bytes.read_to_end(&mut air).map(|_| ()))?;
    Ok((numbers, air))
}

fn problem(result: Result<impl Sized, FileError>) -> CheckpointProblem {
    match result.err().expect("it was read") {
        FileError::Checkpoint { problem, .. } => problem,
        other => panic!("{other}"),
    }
}

#[test]
fn state_and_field_come_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    let numbers = [0.1 + 0.2, f64::MIN_POSITIVE, -0.0, f64::NAN];
    // Longer than two chunks, not a whole number of them.
    let air: Vec<u8> = (0..2 * CHUNK + 12_345).map(|i| (i * 31 % 251) as u8).collect();
    write(&path, &numbers, &air);
    let (numbers_back, air_back) = read(&path).unwrap();
    assert!(numbers.iter().zip(&numbers_back).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(air, air_back);
}

#[test]
fn sections_are_found_in_any_order_and_missing_ones_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    write(&path, &[1.0], &[1, 2, 3]);
    let mut reader = CheckpointReader::open(&path, &HELIX).unwrap();
    reader.stream("air", |_| Ok(())).unwrap();
    assert_eq!(reader.state::<Vec<f64>>("run").unwrap(), [1.0]);
    assert!(reader.holds("air") && !reader.holds("wake"));
    assert_eq!(
        problem(reader.state::<Vec<f64>>("wake")),
        CheckpointProblem::Missing { section: "wake".into() }
    );
    let unfitting = problem(reader.state::<(String, String)>("run"));
    assert!(matches!(unfitting, CheckpointProblem::Unfitting { .. }), "{unfitting}");
}

#[test]
fn another_run_case_version_or_file_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    write(&path, &[1.0], &[]);
    let other_run = problem(CheckpointReader::open(&path, &Identity { run: "pulse", ..HELIX }));
    assert!(matches!(other_run, CheckpointProblem::OtherRun { .. }));
    let other_case =
        problem(CheckpointReader::open(&path, &Identity { case_text: "some other case", ..HELIX }));
    assert_eq!(other_case, CheckpointProblem::OtherCase);
    let found = |identity| CheckpointReader::open(&path, &identity);
    let error = found(Identity { version: "0.2.0", ..HELIX }).unwrap_err();
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(error.to_string().contains("wakemix 0.1.0 wrote it, this is wakemix 0.2.0"), "{error}");
    assert!(help.contains("--overwrite"), "{help}");
    let error = found(Identity { backend: "portable", ..HELIX }).unwrap_err();
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(
        error.to_string().contains("on \"avx512\", this machine computes on \"portable\""),
        "{error}"
    );
    assert!(help.contains("same instructions"), "{help}");
    let mut bytes = fs::read(&path).unwrap();
    bytes[8] = 9;
    fs::write(&path, &bytes).unwrap();
    assert_eq!(problem(read(&path)), CheckpointProblem::OtherVersion { found: 9 });
    fs::write(&path, b"name = \"quickstart\"\n").unwrap();
    assert_eq!(problem(read(&path)), CheckpointProblem::NoCheckpoint);
    fs::write(&path, b"").unwrap();
    assert_eq!(problem(read(&path)), CheckpointProblem::NoCheckpoint);
    let missing = CheckpointReader::open(&folder.path().join("none"), &HELIX);
    assert!(missing.unwrap_err().to_string().contains("cannot read the checkpoint"));
}

#[test]
fn every_cut_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    write(&path, &[1.0, 2.0], &[7; 100]);
    let bytes = fs::read(&path).unwrap();
    for length in 8..bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let cut_off = CheckpointProblem::CutOff { bytes: length as u64 };
        assert_eq!(problem(read(&path)), cut_off);
    }
}

#[test]
fn a_failure_while_writing_leaves_the_last_good_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    write(&path, &[1.0], &[5; 10]);
    let mut writer = CheckpointWriter::create(&path, &HELIX).unwrap();
    let full = |bytes: &mut dyn Write| {
        bytes.write_all(&[0; 3 * CHUNK])?;
        Err(ErrorKind::StorageFull.into())
    };
    let error = writer.stream("air", full).unwrap_err();
    assert!(error.to_string().contains("cannot write the checkpoint"), "{error}");
    drop(writer);
    assert_eq!(read(&path).unwrap(), (vec![1.0], vec![5; 10]));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn no_damage_goes_unnoticed(place in 0usize..400, flip in 1u8..=255) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("checkpoint");
        write(&path, &[1.0, 2.0], &[7; 100]);
        let mut bytes = fs::read(&path).unwrap();
        let place = place % bytes.len();
        bytes[place] ^= flip;
        fs::write(&path, &bytes).unwrap();
        prop_assert!(read(&path).is_err());
    }
}
