//! Tests of Bladed's full field.

use super::super::tests::{complaint, folder, stored};
use super::super::write;
use super::*;
use std::fs;

#[test]
fn counts_time_z_y_component_in_thousandths_of_a_deviation() {
    let folder = folder();
    let path = folder.path().join("box.wnd");
    let stored = stored([4, 3, 2]);
    write(&path, &stored).unwrap();
    let bytes = fs::read(&path).unwrap();
    let short = |place: usize| i16::from_le_bytes([bytes[place], bytes[place + 1]]);
    let long = |place: usize| i32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[place + byte]));
    let real = |place: usize| f32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[place + byte]));
    assert_eq!([short(0), short(2)], [-99, 4]);
    assert_eq!(long(4), 3);
    // Middle of the grid: 4.5 m and half of one spacing of 9 m.
    assert_eq!(real(16), 9.0);
    assert_eq!([real(32), real(36), real(40)], [9.0, 7.0, 2.5]);
    assert_eq!(long(44), 2);
    assert_eq!(real(48), 10.0);
    assert_eq!([long(72), long(76)], [2, 3]);
    let start = 104;
    assert_eq!(bytes.len(), start + 4 * 2 * 3 * 3 * 2);
    let value = |step: usize, z: usize, y: usize, component: usize| {
        let integer = short(start + 2 * (((step * 2 + z) * 3 + y) * 3 + component));
        f64::from(integer) * 1e-5 * f64::from(real(20 + 4 * component)) * 10.0
    };
    let turbulence = &stored.turbulence;
    // The first column is the right-most one; u is counted from the hub speed and holds the mean of its
    // height.
    let above = f64::from(turbulence.at(0, [0, 0, 1])) + 8.1 - 10.0;
    assert!((value(0, 1, 0, 0) - above).abs() < 1e-3);
    assert!((value(0, 1, 2, 1) - f64::from(turbulence.at(1, [0, 2, 1]))).abs() < 1e-3);
    assert!((value(1, 0, 1, 2) - f64::from(turbulence.at(2, [3, 1, 0]))).abs() < 1e-3);
}

/// The deviations that scale a file are those of the box, to the last bit, however it is summed up.
#[test]
fn deviations_are_those_of_the_box() {
    let stored = stored([6, 5, 4]);
    let mut source = &stored;
    let outline = source.outline();
    let found = spreads(&outline, &mut source).unwrap();
    assert_eq!(found.map(|spread| spread.deviation), stored.turbulence.standard_deviations());
    // v is counted from zero, u from the hub speed of 10 m/s: the lowest row has a mean of 8 m/s, and falls
    // to 7.
    let v = stored.turbulence.component(1).iter().map(|v| f64::from(v.abs()));
    assert_eq!(found[1].greatest, v.fold(0.0, f64::max));
    assert!((found[0].greatest - 3.0).abs() < 0.01);
}

#[test]
fn returns_within_its_rounding() {
    let folder = folder();
    let path = folder.path().join("box.wnd");
    for n_points in [[6, 3, 2], [5, 1, 4], [2, 2, 1]] {
        let stored = stored(n_points);
        write(&path, &stored).unwrap();
        let back = read(&path).unwrap();
        assert_eq!(back.turbulence.n_points(), n_points);
        assert!((back.hub_height - 90.0).abs() + (back.lowest_height - 4.5).abs() < 1e-3);
        assert!((back.hub_speed - 10.0).abs() < 1e-6);
        for x in 0..n_points[0] {
            for z in 0..n_points[2] {
                for component in 0..3 {
                    let total = |stored: &StoredBox| {
                        let mean = if component == 0 { stored.mean_speeds[z] } else { 0.0 };
                        mean + f64::from(stored.turbulence.at(component, [x, 0, z]))
                    };
                    assert!((total(&back) - total(&stored)).abs() < 1e-3);
                }
            }
        }
    }
}

/// A file of type 7, made by hand: 2 steps of 1 × 1 points after a header with two numbers more.
fn general_kaimal() -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend_from_slice(&(-99_i16).to_le_bytes());
    bytes.extend_from_slice(&7_i16.to_le_bytes());
    bytes.extend_from_slice(&92_i32.to_le_bytes());
    bytes.extend_from_slice(&3_i32.to_le_bytes());
    let real = |bytes: &mut Vec<u8>, value: f32| bytes.extend_from_slice(&value.to_le_bytes());
    let long = |bytes: &mut Vec<u8>, value: i32| bytes.extend_from_slice(&value.to_le_bytes());
    for value in [9.0, 7.0, 2.5] {
        real(&mut bytes, value);
    }
    long(&mut bytes, 1);
    for value in [12.0, 0.0, 0.0, 0.0] {
        real(&mut bytes, value);
    }
    for value in [0, 42, 1, 1] {
        long(&mut bytes, value);
    }
    for value in [0.0; 8] {
        real(&mut bytes, value);
    }
    for integer in [1000_i16, -500, 250, 0, 0, 0] {
        bytes.extend_from_slice(&integer.to_le_bytes());
    }
    bytes
}

#[test]
fn a_type_without_intensities_needs_its_summary() {
    let folder = folder();
    let path = folder.path().join("box.wnd");
    fs::write(&path, general_kaimal()).unwrap();
    let (problem, fix) = complaint(&path);
    assert!(problem.contains("no intensities") && fix.contains("box.sum"), "{problem}");
    let summary = "  T  Clockwise rotation\n  80.0  Hub height [m]\n UBar = 12 m/s\n TI(u) = 10.0 %\n TI(v) = 8 %\n TI(w) = 5 %\n Height Offset = 2.0 m\n";
    fs::write(path.with_extension("sum"), summary).unwrap();
    let stored = read(&path).unwrap();
    assert_eq!((stored.hub_height, stored.lowest_height), (80.0, 78.0));
    // The first step: u 12 + 1.2, v −0.5 · 0.96, w 0.25 · 0.6 m/s; the mean of u is 12.6.
    let wind = [0, 1, 2].map(|component| f64::from(stored.turbulence.at(component, [0, 0, 0])));
    assert!((stored.mean_speeds[0] - 12.6).abs() < 1e-6);
    assert!((wind[0] - 0.6).abs() + (wind[1] + 0.48).abs() + (wind[2] - 0.15).abs() < 1e-6);
}

#[test]
fn the_old_header_is_read() {
    let folder = folder();
    let path = folder.path().join("old.wnd");
    let header = [-3_i16, 9000, 7000, 2500, 1, 120, 0, 0, 0, 0, 42, 1000, 2000, 0, 0, 0, 0, 0, 0];
    let values = [0_i16, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 0];
    let bytes: Vec<u8> = header.iter().chain(&values).flat_map(|n| n.to_le_bytes()).collect();
    fs::write(&path, bytes).unwrap();
    fs::write(path.with_extension("sum"), "TI(U) = 10\nTI(V) = 8\nTI(W) = 5\n").unwrap();
    let stored = read(&path).unwrap();
    assert_eq!(stored.turbulence.n_points(), [2, 2, 1]);
    assert_eq!(stored.turbulence.spacing(), [2.5, 7.0, 9.0]);
    assert!((stored.hub_speed - 12.0).abs() < 1e-12);
    // The second column is the left one.
    assert!(stored.turbulence.at(0, [0, 1, 0]) > stored.turbulence.at(0, [0, 0, 0]));
}

#[test]
fn columns_run_as_the_summary_says() {
    let folder = folder();
    let path = folder.path().join("box.wnd");
    write(&path, &stored([4, 3, 2])).unwrap();
    let text = fs::read_to_string(path.with_extension("sum")).unwrap();
    let right = read(&path).unwrap().turbulence;
    fs::write(path.with_extension("sum"), text.replace("  F  Clock", "  T  Clock")).unwrap();
    let left = read(&path).unwrap().turbulence;
    assert_eq!(right.at(1, [2, 0, 1]), left.at(1, [2, 2, 1]));
}

#[test]
fn cut_swapped_and_foreign_files_are_named() {
    let folder = folder();
    let path = folder.path().join("box.wnd");
    write(&path, &stored([6, 3, 2])).unwrap();
    let whole = fs::read(&path).unwrap();
    let tell = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        complaint(&path).0
    };
    assert!(tell(&whole[..whole.len() - 40]).contains("ends within step 5 of 6"));
    assert!(tell(&whole[..50]).contains("ends after 50 bytes, within its header"));
    assert!(tell(&[&whole[..], &[0; 2]].concat()).contains("goes on behind"));
    assert!(tell(&[&[0xff, 0x9d], &whole[2..]].concat()).contains("big-endian"));
    assert!(tell(b"! Time  Wind  Wind\n! (sec) (m/s)").contains("identifier"));
    assert!(tell(&[]).contains("ends after 0 bytes"));
    let mut kind = whole.clone();
    kind[2] = 9;
    assert!(tell(&kind).contains("byte 2: the type of turbulence is 9"));
}
