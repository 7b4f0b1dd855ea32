//! Tests of boxes in files.

use super::*;
use proptest::prelude::*;
use std::fs;
use std::path::PathBuf;

/// A box in which every value is another one.
pub(crate) fn stored([n_x, n_y, n_z]: [usize; 3]) -> StoredBox {
    let values = |component: usize| {
        (0..n_x * n_y * n_z).map(|n| ((37 * n + 11 * component) as f32 * 0.7).sin()).collect()
    };
    let velocity = std::array::from_fn(values);
    StoredBox {
        turbulence: TurbulenceBox::new([n_x, n_y, n_z], [2.5, 7.0, 9.0], velocity).unwrap(),
        hub_speed: 10.0,
        hub_height: 90.0,
        lowest_height: 4.5,
        mean_speeds: (0..n_z).map(|z| 8.0 + 0.1 * z as f64).collect(),
        description: "made for a test".into(),
    }
}

pub(super) fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

pub(super) fn complaint(path: &Path) -> (String, String) {
    match read(path).unwrap_err() {
        FileError::Content { path: named, problem, fix, .. } => {
            (format!("{} {problem}", named.display()), fix)
        }
        FileError::System { path: named, fix, .. } => (named.display().to_string(), fix),
        other => panic!("{other}"),
    }
}

#[test]
fn hawc_counts_in_order_of_arrival_left_to_right_upwards() {
    let folder = folder();
    let path = folder.path().join("box.toml");
    let stored = stored([4, 3, 2]);
    write(&path, &stored).unwrap();
    let bytes = fs::read(folder.path().join("box_v.bin")).unwrap();
    let value = |place: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[4 * place + byte]));
    let turbulence = &stored.turbulence;
    // x, y, z of the first values: plane 0 first, from the left (greatest y), z fastest.
    assert_eq!(value(0), turbulence.at(1, [0, 2, 0]));
    assert_eq!(value(1), turbulence.at(1, [0, 2, 1]));
    assert_eq!(value(2), turbulence.at(1, [0, 1, 0]));
    // The plane that arrives next stands one spacing upwind, which is the last one of a box that repeats.
    assert_eq!(value(6), turbulence.at(1, [3, 2, 0]));
    assert_eq!(value(18), turbulence.at(1, [1, 2, 0]));
}

#[test]
fn foreign_binaries_are_read_as_their_header_says() {
    let folder = folder();
    let path = folder.path().join("box.toml");
    write(&path, &stored([4, 3, 2])).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let other = text
        .replace("\"upwind\"", "\"downwind\"")
        .replace("y_runs = \"right\"", "y_runs = \"left\"");
    fs::write(&path, other).unwrap();
    let (read, ours) = (read(&path).unwrap().turbulence, stored([4, 3, 2]).turbulence);
    assert_eq!(read.at(0, [0, 0, 1]), ours.at(0, [0, 2, 1]));
    assert_eq!(read.at(0, [1, 2, 0]), ours.at(0, [3, 0, 0]));
}

#[test]
fn turbsim_counts_time_z_y_component() {
    let folder = folder();
    let path = folder.path().join("box.bts");
    let stored = stored([4, 3, 2]);
    write(&path, &stored).unwrap();
    let bytes = fs::read(&path).unwrap();
    assert_eq!(bytes[..2], [8, 0]);
    let count = |place: usize| i32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[place + byte]));
    assert_eq!([count(2), count(6), count(10), count(14)], [2, 3, 0, 4]);
    let number = |place: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[place + byte]));
    let six = [9.0, 7.0, 0.25, 10.0, 90.0, 4.5];
    assert_eq!(std::array::from_fn(|index| number(18 + 4 * index)), six);
    let start = FIXED + stored.description.len();
    let value = |step: usize, z: usize, y: usize, component: usize| {
        let place = start + 2 * (((step * 2 + z) * 3 + y) * 3 + component);
        let integer = i16::from_le_bytes([bytes[place], bytes[place + 1]]);
        (f32::from(integer) - number(46 + 8 * component)) / number(42 + 8 * component)
    };
    let turbulence = &stored.turbulence;
    // The first column is the right-most one; u holds the mean of its height.
    assert!((value(0, 1, 0, 0) - 8.1 - turbulence.at(0, [0, 0, 1])).abs() < 1e-4);
    assert!((value(0, 1, 2, 1) - turbulence.at(1, [0, 2, 1])).abs() < 1e-4);
    assert!((value(1, 0, 1, 2) - turbulence.at(2, [3, 1, 0])).abs() < 1e-4);
}

const FIXED: usize = 70;

#[test]
fn cut_and_overlong_files_are_named() {
    let folder = folder();
    let header = folder.path().join("box.toml");
    let field = folder.path().join("box.bts");
    write(&header, &stored([6, 3, 2])).unwrap();
    write(&field, &stored([6, 3, 2])).unwrap();
    let component = folder.path().join("box_w.bin");
    let whole = fs::read(&component).unwrap();
    fs::write(&component, &whole[..60]).unwrap();
    let (problem, fix) = complaint(&header);
    assert!(
        problem.contains("box_w.bin") && problem.contains("60 bytes instead of 144"),
        "{problem}"
    );
    assert!(problem.contains("ends within plane 3 of 6") && fix.contains("n_points"), "{problem}");
    fs::write(&component, [&whole[..], &[0; 4]].concat()).unwrap();
    assert!(complaint(&header).0.contains("goes on behind"));

    let whole = fs::read(&field).unwrap();
    fs::write(&field, &whole[..whole.len() - 40]).unwrap();
    assert!(complaint(&field).0.contains("ends within step 5 of 6"));
    fs::write(&field, &whole[..30]).unwrap();
    assert!(complaint(&field).0.contains("within the header"));
    fs::write(&field, [&whole[..], &[0; 2]].concat()).unwrap();
    assert!(complaint(&field).0.contains("goes on behind"));
}

#[test]
fn the_wrong_byte_order_is_recognised() {
    let folder = folder();
    let (header, field) = (folder.path().join("box.toml"), folder.path().join("box.bts"));
    write(&header, &stored([6, 3, 2])).unwrap();
    let component = folder.path().join("box_u.bin");
    let mut bytes = fs::read(&component).unwrap();
    bytes.chunks_exact_mut(4).for_each(<[u8]>::reverse);
    fs::write(&component, bytes).unwrap();
    let (problem, fix) = complaint(&header);
    assert!(
        problem.contains("big-endian") && problem.contains("byte ") && fix.contains("little"),
        "{problem}"
    );

    write(&field, &stored([6, 3, 2])).unwrap();
    let mut bytes = fs::read(&field).unwrap();
    bytes[..2].reverse();
    fs::write(&field, bytes).unwrap();
    assert!(complaint(&field).0.contains("big-endian"));
}

#[test]
fn what_is_no_wind_is_refused_with_its_place() {
    let folder = folder();
    let (header, field) = (folder.path().join("box.toml"), folder.path().join("box.bts"));
    write(&header, &stored([6, 3, 2])).unwrap();
    let component = folder.path().join("box_u.bin");
    let mut bytes = fs::read(&component).unwrap();
    bytes[4 * 16..4 * 17].copy_from_slice(&f32::NAN.to_le_bytes());
    fs::write(&component, bytes).unwrap();
    let (problem, _) = complaint(&header);
    assert!(problem.contains("byte 64 (plane 3, column 3, row 1) is NaN"), "{problem}");

    write(&field, &stored([6, 3, 2])).unwrap();
    let mut bytes = fs::read(&field).unwrap();
    bytes[42..46].copy_from_slice(&0.0_f32.to_le_bytes());
    fs::write(&field, bytes).unwrap();
    assert!(complaint(&field).0.contains("slope 0"));
}

#[test]
fn headers_that_do_not_fit_are_refused() {
    let folder = folder();
    let path = folder.path().join("box.toml");
    write(&path, &stored([6, 3, 2])).unwrap();
    let good = fs::read_to_string(&path).unwrap();
    for (from, to, message) in [
        ("hub_speed", "hub_sped", "line "),
        ("x_runs = \"upwind\"", "x_runs = \"left\"", "x_runs"),
        ("n_points = [6, 3, 2]", "n_points = [6, 0, 2]", "n_points"),
        ("spacing = [2.5,", "spacing = [-2.5,", "spacing"),
        ("hub_speed = 10.0", "hub_speed = 0.0", "hub_speed"),
        ("mean_speeds = [8.0, ", "mean_speeds = [", "1 speeds for 2 heights"),
    ] {
        assert!(good.contains(from), "{from}");
        fs::write(&path, good.replace(from, to)).unwrap();
        let (problem, _) = complaint(&path);
        assert!(problem.contains(message), "{problem}");
    }
}

#[test]
fn unknown_endings_and_missing_files_are_reported() {
    assert!(check_name(Path::new("box.bts")).is_ok() && check_name(Path::new("box")).is_err());
    assert!(complaint(&PathBuf::from("box.mat")).0.contains(".toml nor in .bts"));
    assert!(complaint(&PathBuf::from("nowhere/box.bts")).0.contains("nowhere/box.bts"));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn writing_and_reading_is_the_identity(n_x in 1_usize..9, n_y in 1_usize..6, n_z in 1_usize..6) {
        let folder = folder();
        let path = folder.path().join("box.toml");
        let stored = stored([n_x, n_y, n_z]);
        write(&path, &stored).unwrap();
        prop_assert_eq!(read(&path).unwrap(), stored);
    }

    /// TurbSim's file keeps 16 bits: total winds return to within half an integer.
    #[test]
    fn turbsim_returns_within_its_rounding(n_x in 2_usize..9, n_y in 1_usize..6, n_z in 1_usize..6) {
        let folder = folder();
        let path = folder.path().join("box.bts");
        let stored = stored([n_x, n_y, n_z]);
        write(&path, &stored).unwrap();
        let back = read(&path).unwrap();
        prop_assert!((back.hub_speed - 10.0).abs() + (back.lowest_height - 4.5).abs() < 1e-6);
        prop_assert!((back.turbulence.spacing()[0] - 2.5).abs() < 1e-6);
        prop_assert_eq!(&back.description, &stored.description);
        for x in 0..n_x {
            for y in 0..n_y {
                for z in 0..n_z {
                    for component in 0..3 {
                        let mean = |stored: &StoredBox| {
                            if component == 0 { stored.mean_speeds[z] } else { 0.0 }
                        };
                        let there = f64::from(back.turbulence.at(component, [x, y, z])) + mean(&back);
                        let here = f64::from(stored.turbulence.at(component, [x, y, z])) + mean(&stored);
                        prop_assert!((there - here).abs() < 5e-5);
                    }
                }
            }
        }
    }
}
