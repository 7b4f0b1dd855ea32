//! Tests of planes read one at a time, and of files that hold anything.

use super::tests::{folder, stored};
use super::*;
use flow::inflow::prescribed::Placement;
use flow::inflow::{MeanProfile, PrescribedWind, TurbulentInflow};
use flow::{FlowSolver, Inflow, WindField};
use proptest::prelude::*;
use std::fs;
use std::sync::Arc;

const NAMES: [&str; 3] = ["box.bts", "box.wnd", "box.toml"];

/// Planes from a file are those of the box that was written, in order of arrival, with the mean.
#[test]
fn planes_are_those_of_the_box() {
    let folder = folder();
    let stored = stored([7, 4, 3]);
    for name in NAMES {
        let path = folder.path().join(name);
        write(&path, &stored).unwrap();
        let mut planes = open(&path).unwrap();
        let grid = planes.grid();
        assert_eq!((grid.n_y, grid.n_z, grid.n_steps, grid.repeats), (4, 3, 7, true));
        assert!((grid.first[0] + 10.5).abs() + (grid.first[1] - 4.5).abs() < 1e-4);
        assert!((grid.interval - 0.25).abs() + (grid.speed - 10.0).abs() < 1e-6);
        let mut values = vec![[0.0; 3]; 12];
        // Not in order: a run may start anywhere, and go round.
        for step in [0, 1, 2, 6, 0, 3] {
            planes.read(step, &mut values).unwrap();
            for (point, wind) in values.iter().enumerate() {
                for (component, value) in wind.iter().enumerate() {
                    let x = in_order_of_arrival(step, 7);
                    let mean = if component == 0 { stored.mean_speeds[point / 4] } else { 0.0 };
                    let there = mean + f64::from(stored.turbulence.plane(component, x)[point]);
                    assert!((f64::from(*value) - there).abs() < 1e-3, "{name} {step} {point}");
                }
            }
        }
    }
}

/// A turbine meets the same wind whether the box is in memory, carried past an inlet, or read plane by plane.
#[test]
fn all_ways_of_blowing_agree_at_the_points_of_the_box() {
    let folder = folder();
    let stored = stored([16, 4, 3]);
    let speed = stored.hub_speed;
    let origin = basis::Vector3::new(0.0, -10.5, 4.5);
    let uniform = MeanProfile::Uniform { speed };
    let carried =
        TurbulentInflow::new(Arc::new(stored.turbulence.clone()), uniform, origin).unwrap();
    for name in NAMES {
        let path = folder.path().join(name);
        write(&path, &stored).unwrap();
        let placement = Placement { origin_x: 0.0, shift_y: 0.0, extent: [-5.0, 5.0] };
        let mut wind = PrescribedWind::over_planes(open(&path).unwrap(), placement).unwrap();
        for step in 0..40 {
            let place = basis::Vector3::new(2.5, 3.5, 13.5);
            let (mut one, mut other) = ([basis::Vector3::ZERO], [basis::Vector3::ZERO]);
            wind.sample(&[place], &mut one);
            carried.sample(0.25 * f64::from(step), &[place], &mut other);
            other[0].x += stored.mean_speeds[1] - speed;
            assert!((one[0] - other[0]).length() < 3e-3, "{name} {step}");
            wind.advance(0.25, &[]).unwrap();
        }
    }
}

/// A file that shrinks during the run is reported with its name and the plane.
#[test]
fn a_plane_that_is_gone_is_named() {
    let folder = folder();
    for name in ["box.bts", "box.wnd"] {
        let path = folder.path().join(name);
        write(&path, &stored([9, 4, 3])).unwrap();
        let mut planes = open(&path).unwrap();
        fs::write(&path, b"").unwrap();
        let error = planes.read(5, &mut [[0.0; 3]; 12]).unwrap_err().to_string();
        assert!(error.contains("plane 5") && error.contains(name), "{error}");
    }
}

#[test]
fn binaries_lead_to_their_header() {
    let folder = folder();
    let stored = stored([4, 3, 2]);
    write(&folder.path().join("box.bin"), &stored).unwrap();
    for name in ["box_u.bin", "box_w.bin", "box.bin", "box.toml"] {
        assert_eq!(read(&folder.path().join(name)).unwrap(), stored);
    }
}

/// The first bytes of `whole` with one of them another one, or anything at all.
fn spoilt(whole: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let n = whole.len();
    let mended = (prop::collection::vec((0..n.min(160), any::<u8>()), 1..4), 0..=n + 8).prop_map(
        move |(spots, length)| {
            let mut bytes = whole.clone();
            for (place, byte) in spots {
                bytes[place] = byte;
            }
            bytes.resize(length, 7);
            bytes
        },
    );
    prop_oneof![3 => mended, 1 => prop::collection::vec(any::<u8>(), 0..400)]
}

fn bytes_of(name: &str) -> Vec<u8> {
    let folder = folder();
    let path = folder.path().join(name);
    write(&path, &stored([4, 3, 2])).unwrap();
    fs::read(&path).unwrap()
}

/// Reads whatever `bytes` are under the name `name`: no panic, and errors name the file and a fix.
fn survives(name: &str, bytes: &[u8]) -> Result<(), TestCaseError> {
    let folder = folder();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    if let Err(error) = open(&path) {
        let (FileError::Content { path: named, fix, .. }
        | FileError::System { path: named, fix, .. }) = error
        else {
            return Err(TestCaseError::fail("an error without a path"));
        };
        prop_assert!(named.ends_with(name) && !fix.is_empty());
        prop_assert!(read(&path).is_err());
    } else {
        let stored = read(&path);
        prop_assert!(stored.is_ok_and(|stored| stored.hub_speed > 0.0));
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn any_turbsim_file_is_read_or_refused(bytes in spoilt(bytes_of("box.bts"))) {
        survives("box.bts", &bytes)?;
    }

    #[test]
    fn any_bladed_file_is_read_or_refused(bytes in spoilt(bytes_of("box.wnd"))) {
        survives("box.wnd", &bytes)?;
    }
}
