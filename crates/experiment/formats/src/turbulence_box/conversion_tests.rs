//! Tests of boxes that are converted without being held.

use super::tests::{folder, stored};
use super::*;
use crate::fuzz::memory::peak;
use std::ffi::OsString;
use std::fs;

const NAMES: [&str; 3] = ["box.toml", "box.bts", "box.wnd"];

/// Names and bytes of all that is in `folder`.
fn files(folder: &Path) -> Vec<(OsString, Vec<u8>)> {
    let mut files: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(Result::unwrap)
        .map(|entry| (entry.file_name(), fs::read(entry.path()).unwrap()))
        .collect();
    files.sort();
    files
}

/// More planes than are read at a time, and an odd number of them.
#[test]
fn a_converted_box_is_the_one_written_from_memory() {
    for name in NAMES {
        let source = folder();
        let from = source.path().join(name);
        write(&from, &stored([1101, 8, 8])).unwrap();
        let held = read(&from).unwrap();
        for to in NAMES {
            let (streamed, whole) = (folder(), folder());
            convert(&from, &streamed.path().join(to)).unwrap();
            write(&whole.path().join(to), &held).unwrap();
            assert!(files(streamed.path()) == files(whole.path()), "{name} to {to}");
        }
    }
}

#[test]
fn a_box_converted_to_itself_stays() {
    let folder = folder();
    write(&folder.path().join("box.toml"), &stored([6, 3, 2])).unwrap();
    let before = files(folder.path());
    convert(&folder.path().join("box.bin"), &folder.path().join("box.toml")).unwrap();
    assert!(files(folder.path()) == before);
}

/// The means that are taken off a full field are sums of rows, downwind, to the last bit; the rest is the
/// wind as it is.
#[test]
fn full_fields_are_taken_apart_row_by_row() {
    let folder = folder();
    for name in ["box.bts", "box.wnd"] {
        let path = folder.path().join(name);
        write(&path, &stored([7, 4, 3])).unwrap();
        let mut planes = open(&path).unwrap();
        let mut winds = vec![[[0.0_f32; 3]; 12]; 7];
        for (x, plane) in winds.iter_mut().enumerate() {
            planes.read(in_order_of_arrival(x, 7), plane).unwrap();
        }
        let back = read(&path).unwrap();
        for (z, mean) in back.mean_speeds.iter().enumerate() {
            let row = |plane: &[[f32; 3]; 12]| -> f64 {
                plane[4 * z..4 * z + 4].iter().map(|wind| f64::from(wind[0])).sum()
            };
            assert_eq!(*mean, winds.iter().map(row).sum::<f64>() / 28.0);
        }
        for (x, plane) in winds.iter().enumerate() {
            for (point, [u, v, w]) in plane.iter().enumerate() {
                let u = (f64::from(*u) - back.mean_speeds[point / 4]) as f32;
                let stored = [0, 1, 2].map(|component| back.turbulence.plane(component, x)[point]);
                assert_eq!(stored, [u, *v, *w], "{name} {x} {point}");
            }
        }
    }
}

/// Planes from memory, of which only some come.
struct Breaking<'a> {
    stored: &'a StoredBox,
    left: usize,
}

impl Source for Breaking<'_> {
    fn outline(&self) -> Outline {
        self.stored.outline()
    }

    fn plane(&mut self, x: usize) -> Result<[&[f32]; 3], FileError> {
        if self.left == 0 {
            return Err(FileError::content("a box", Path::new("box"), "it is cut", "none"));
        }
        self.left -= 1;
        self.stored.plane(x)
    }
}

/// Wherever a source breaks off, nothing is left; it is read as often as the header needs, and once.
#[test]
fn a_source_that_breaks_off_leaves_nothing() {
    let stored = stored([7, 4, 3]);
    for (name, times) in NAMES.into_iter().zip([1, 2, 3]) {
        let folder = folder();
        let path = folder.path().join(name);
        for left in 0..7 * times {
            assert!(write_from(&path, &mut Breaking { stored: &stored, left }).is_err());
            assert!(files(folder.path()).is_empty(), "{name} after {left} planes");
        }
        write_from(&path, &mut Breaking { stored: &stored, left: 7 * times }).unwrap();
        assert_eq!(read(&path).unwrap().turbulence.n_points(), [7, 4, 3]);
    }
}

#[test]
fn a_damaged_file_leaves_what_was_there_before() {
    let source = folder();
    let from = source.path().join("box.toml");
    write(&from, &stored([7, 4, 3])).unwrap();
    let component = source.path().join("box_w.bin");
    let whole = fs::read(&component).unwrap();
    let good = &whole[..whole.len() - 4];
    for (damaged, message) in [
        ([good, &f32::NAN.to_le_bytes()].concat(), "plane 7, column 4, row 3) is NaN"),
        (good.to_vec(), "ends within plane 7 of 7"),
    ] {
        fs::write(&component, damaged).unwrap();
        for name in NAMES {
            let target = folder();
            let path = target.path().join(name);
            fs::write(&path, "before").unwrap();
            let error = convert(&from, &path).unwrap_err().to_string();
            assert!(error.contains("box_w.bin") && error.contains(message), "{error}");
            assert_eq!(files(target.path()), [(OsString::from(name), b"before".to_vec())]);
        }
    }
}

/// Planes of 8 × 8 points, at least twice as many as are read at a time.
#[test]
fn memory_does_not_grow_with_the_length_of_a_box() {
    let held = |n_x: usize, from: &str, to: &str| {
        let (source, target) = (folder(), folder());
        let from = source.path().join(from);
        write(&from, &stored([n_x, 8, 8])).unwrap();
        let (result, bytes) = peak(|| convert(&from, &target.path().join(to)));
        result.unwrap();
        bytes
    };
    for (from, to) in [("box.toml", "box.bts"), ("box.bts", "box.wnd"), ("box.wnd", "box.toml")] {
        let (short, long) = (held(2048, from, to), held(4096, from, to));
        assert!(long <= short + 4096, "{from} to {to}: {short} and {long} bytes");
    }
}
