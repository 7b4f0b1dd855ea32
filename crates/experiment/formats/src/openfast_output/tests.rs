//! Tests of OpenFAST's binary output.

use super::*;
use crate::FileError;
use crate::table::{Column, TableReader};
use proptest::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};

fn layout(names: &[&str]) -> Layout {
    let channels =
        names.iter().map(|name| Column { name: (*name).into(), unit: "kN-m".into() }).collect();
    Layout { description: "made for a test".into(), channels, start: 2.5, interval: 0.1 }
}

fn write(path: &Path, layout: Layout, encoding: Encoding, rows: &[Vec<f64>]) {
    let mut writer = OutbWriter::create(path, layout, encoding).unwrap();
    rows.iter().for_each(|row| writer.write(row).unwrap());
    writer.finish().unwrap();
}

/// All rows of all channels, time first.
fn read(path: &Path) -> Result<Vec<Vec<f64>>, FileError> {
    let mut table = TableReader::open(path)?;
    let names: Vec<String> = table.channels().map(|channel| channel.name.clone()).collect();
    table.select(&names.iter().map(String::as_str).collect::<Vec<_>>())?;
    let mut rows = Vec::new();
    let mut row = vec![0.0; names.len() + 1];
    while table.read(&mut row)? {
        rows.push(row.clone());
    }
    Ok(rows)
}

fn complaint<T: std::fmt::Debug>(result: Result<T, FileError>) -> String {
    match result.unwrap_err() {
        FileError::Content { problem, fix, .. } => format!("{problem} | {fix}"),
        other => panic!("{other}"),
    }
}

fn place() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.outb");
    (folder, path)
}

/// A file of kind 1 (listed times) or 2, byte by byte as the format says.
pub(crate) fn by_hand(kind: i16) -> Vec<u8> {
    let mut bytes = kind.to_le_bytes().to_vec();
    for count in [2_i32, 3] {
        bytes.extend(count.to_le_bytes());
    }
    // Listed: times are (integer + 100) / 1000; regular: from 0.5 s every 0.25 s.
    let clock = if kind == 1 { [1000.0, -100.0] } else { [0.5, 0.25] };
    bytes.extend(clock.iter().flat_map(|number: &f64| number.to_le_bytes()));
    bytes.extend([2.0_f32, 0.5, 10.0, -1.0].iter().flat_map(|number| number.to_le_bytes()));
    bytes.extend(4_i32.to_le_bytes());
    bytes.extend(b"hand");
    for word in ["Time", "GenSpeed", "RootMyc1", "(s)", "(rpm)", "(kN-m)"] {
        bytes.extend(format!("{word:<10}").as_bytes());
    }
    if kind == 1 {
        bytes.extend([0_i32, 300, 500].iter().flat_map(|time| time.to_le_bytes()));
    }
    let values = [0_i16, 0, 10, -1, -32768, 32767];
    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

#[test]
fn files_made_by_hand_read_as_the_format_says() {
    let (_folder, path) = place();
    for (kind, times) in [(1, [0.1, 0.4, 0.6]), (2, [0.5, 0.75, 1.0])] {
        fs::write(&path, by_hand(kind)).unwrap();
        let expected = [
            vec![times[0], -5.0, 2.0],
            vec![times[1], 0.0, 0.0],
            vec![times[2], -16389.0, 65536.0],
        ];
        assert_eq!(read(&path).unwrap(), expected);
        let table = TableReader::open(&path).unwrap();
        assert_eq!(table.description(), "hand");
        let channels: Vec<&Column> = table.channels().collect();
        assert_eq!((channels[0].name.as_str(), channels[0].unit.as_str()), ("GenSpeed", "rpm"));
    }
}

#[test]
fn bytes_written_are_the_format_s() {
    let (folder, path) = place();
    let rows = [vec![1.0, 2.0], vec![3.0, 4.0]];
    write(&path, layout(&["A", "B"]), Encoding::Exact, &rows);
    let bytes = fs::read(&path).unwrap();
    assert_eq!(bytes[..10], [3, 0, 2, 0, 0, 0, 2, 0, 0, 0]);
    assert_eq!(bytes[10..18], 2.5_f64.to_le_bytes());
    assert_eq!(bytes[26..30], 15_i32.to_le_bytes());
    assert_eq!(bytes[45..65], *b"Time      A         ");
    assert_eq!(bytes[bytes.len() - 8..], 4.0_f64.to_le_bytes());
    assert_eq!(bytes.len(), 45 + 60 + 32);

    write(&path, layout(&["AB1N001Alpha", "B"]), Encoding::Compressed, &rows);
    let bytes = fs::read(&path).unwrap();
    assert_eq!(bytes[..4], [4, 0, 12, 0]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    assert_eq!(TableReader::open(&path).unwrap().channels().next().unwrap().name, "AB1N001Alpha");
}

#[test]
fn what_is_not_finished_leaves_nothing() {
    let (folder, path) = place();
    let mut writer = OutbWriter::create(&path, layout(&["A"]), Encoding::Compressed).unwrap();
    (0..100_000).for_each(|step| writer.write(&[f64::from(step)]).unwrap());
    drop(writer);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    let empty = OutbWriter::create(&path, layout(&["A"]), Encoding::Exact).unwrap();
    assert!(complaint(empty.finish()).contains("no row to write"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_the_format_cannot_hold_is_reported() {
    let (_folder, path) = place();
    let message = |layout, encoding| complaint(OutbWriter::create(&path, layout, encoding));
    assert!(message(layout(&[]), Encoding::Exact).contains("no channel"));
    assert!(message(layout(&["two words"]), Encoding::Exact).contains("one word of ASCII"));
    assert!(message(layout(&["AB1N001Alpha"]), Encoding::Exact).contains("or write compressed"));
    let no_time = Layout { interval: 0.0, ..layout(&["A"]) };
    assert!(message(no_time, Encoding::Exact).contains("positive interval"));
    let mut writer = OutbWriter::create(&path, layout(&["A", "B"]), Encoding::Exact).unwrap();
    writer.write(&[1.0, 2.0]).unwrap();
    let message = complaint(writer.write(&[1.0, f64::NAN]));
    assert!(message.starts_with("at 2.6 s B is NaN"), "{message}");
}

#[test]
fn damaged_files_are_reported_with_place_and_fix() {
    let whole = by_hand(2);
    let changed = |place: usize, bytes: &[u8]| {
        let mut damaged = whole.clone();
        damaged[place..place + bytes.len()].copy_from_slice(bytes);
        damaged
    };
    let listed = by_hand(1);
    let cases = [
        (Vec::new(), "it ends after 0 bytes, within the kind of its header at byte 0"),
        (whole[..20].to_vec(), "it ends after 20 bytes, within the time of its header at byte 18"),
        (whole[..70].to_vec(), "within the names of its header at byte 50"),
        (whole[..whole.len() - 1].to_vec(), "it ends within row 3 of 3 | copy the file again"),
        (listed[..111].to_vec(), "it ends within the times"),
        ([whole.as_slice(), &[0]].concat(), "it goes on behind the last row"),
        (changed(0, &[0, 2]), "kind is 2 with its bytes swapped: the byte order is big-endian"),
        (changed(0, &[9, 0]), "its kind is 9, none of 1 to 4 | give a binary output of OpenFAST"),
        (changed(2, &[0; 4]), "byte 2: its header counts 0 channels"),
        (changed(6, &(-3_i32).to_le_bytes()), "byte 6: its header counts -3 rows"),
        (changed(2, &[255, 255, 255, 127]), "within the scales of its header"),
        (changed(18, &0.0_f64.to_le_bytes()), "its header has no valid time: 0.5 and 0"),
        (changed(26, &f32::NAN.to_le_bytes()), "row 1 (0.5 s): GenSpeed is NaN"),
    ];
    let (_folder, path) = place();
    for (bytes, expected) in cases {
        fs::write(&path, bytes).unwrap();
        let message = complaint(read(&path));
        assert!(message.contains(expected), "{message}\n{expected}");
    }
}

#[test]
fn a_channel_far_from_zero_keeps_its_small_range() {
    let (_folder, path) = place();
    let rows: Vec<Vec<f64>> = (0..500)
        .map(|step| {
            let wave = (0.1 * f64::from(step)).sin();
            vec![6.45 + 1e-4 * wave, -9e7 + wave, 42.0, 0.0, 1e-25 * wave, 3e20 * wave]
        })
        .collect();
    let names = ["A", "B", "C", "D", "E", "F"];
    write(&path, layout(&names), Encoding::Compressed, &rows);
    for (row, found) in rows.iter().zip(read(&path).unwrap()) {
        let tolerances = [2e-9, 2e-3, 1e-9, 1e-30, 3e-30, 1e16];
        for ((value, found), tolerance) in row.iter().zip(&found[1..]).zip(tolerances) {
            assert!((value - found).abs() <= tolerance, "{value} {found}");
        }
    }
}

/// Some rows of a few channels, each of its own size.
fn table() -> impl Strategy<Value = Vec<Vec<f64>>> {
    (1..5_usize, 1..40_usize).prop_flat_map(|(n_channels, n_rows)| {
        let value = prop_oneof![
            -1.0..1.0_f64,
            -1e9..1e9_f64,
            Just(0.0),
            (5.0..5.1_f64).prop_map(|value| 1e6 * value),
        ];
        prop::collection::vec(prop::collection::vec(value, n_channels), n_rows)
    })
}

proptest! {
    // Each case syncs a file to the disk.
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn exact_files_give_back_every_bit(rows in table()) {
        let (_folder, path) = place();
        let names = ["A", "B", "C", "D", "E"];
        write(&path, layout(&names[..rows[0].len()]), Encoding::Exact, &rows);
        let found = read(&path).unwrap();
        prop_assert_eq!(rows.len(), found.len());
        for (step, (row, found)) in rows.iter().zip(&found).enumerate() {
            prop_assert_eq!(found[0], 2.5 + 0.1 * step as f64);
            prop_assert_eq!(row, &found[1..]);
        }
    }

    #[test]
    fn compressed_files_err_by_half_a_step(rows in table()) {
        let (_folder, path) = place();
        let names = ["A", "B", "C", "D", "E"];
        write(&path, layout(&names[..rows[0].len()]), Encoding::Compressed, &rows);
        let found = read(&path).unwrap();
        prop_assert_eq!(rows.len(), found.len());
        for channel in 0..rows[0].len() {
            let values = || rows.iter().map(|row| row[channel]);
            let least = values().fold(f64::INFINITY, f64::min);
            let most = values().fold(f64::NEG_INFINITY, f64::max);
            let range = (most - least).max(1e-6 * least.abs().max(most.abs()));
            for (row, found) in rows.iter().zip(&found) {
                // Where a small range lies far from zero, up to half the steps are lost to the offset's 32
                // bits.
                let step = range / if most - least > 0.01 * most.abs() { 65_000.0 } else { 32_000.0 };
                prop_assert!((row[channel] - found[channel + 1]).abs() <= 0.5 * step);
            }
        }
    }

}

proptest! {
    #[test]
    fn no_bytes_make_the_reader_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), kind in 1..5_u8) {
        let (_folder, path) = place();
        fs::write(&path, [&[kind, 0], bytes.as_slice()].concat()).unwrap();
        let _ = read(&path);
        fs::write(&path, bytes).unwrap();
        let _ = read(&path);
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        kind in 1..3_i16, damaged in 0..130_usize, byte in any::<u8>(), end in 0..150_usize,
    ) {
        let (_folder, path) = place();
        let mut bytes = by_hand(kind);
        let damaged = damaged % bytes.len();
        bytes[damaged] = byte;
        bytes.truncate(end.max(damaged));
        fs::write(&path, bytes).unwrap();
        let _ = read(&path);
    }
}
