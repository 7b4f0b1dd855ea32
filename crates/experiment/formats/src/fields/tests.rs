//! Fields of other programs: units, times, axes, holes, and what is refused.

use super::*;
use crate::netcdf::{InstantWriter, PlaneSetting};
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};
use flow::lattice::Volume;
use std::fs;

fn plane(time: f64) -> Plane {
    let values = |add: f32| (0..6).map(|i| add + i as f32 + time as f32).collect();
    Plane {
        name: "streamwise".into(),
        axes: PlaneAxes::Streamwise,
        origin: [10.0, 0.0, 5.0],
        spacing: [2.0, 0.5],
        n_points: [3, 2],
        time,
        averaged: 0.0,
        velocity: [values(8.0), values(0.0), values(-1.0)],
    }
}

#[test]
fn planes_of_a_run_come_back_as_fields_with_their_setting() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("streamwise.nc");
    let setting = PlaneSetting::example();
    let mut writer = InstantWriter::create(&path, &setting, &plane(1.0)).unwrap();
    for time in [1.0, 1.5, 2.5] {
        writer.write(&plane(time)).unwrap();
    }
    writer.finish().unwrap();
    let mut file = FieldFile::open(&path, Lengths::Millimetres).unwrap();
    assert_eq!(file.times(), [1.0, 1.5, 2.5]);
    assert_eq!(file.grid().n_points, [3, 1, 2]);
    assert_eq!((file.grid().origin, file.grid().spacing[0]), ([10.0, 0.0, 5.0], 2.0));
    let mut field = file.empty();
    file.read(2, &mut field).unwrap();
    assert_eq!((field.time, &field.velocity), (2.5, &plane(2.5).velocity));
    let strip = file.read_strip(1..3, 1..2).unwrap();
    let row = |time: f64| plane(time).velocity.map(|values| values[3..].to_vec());
    let expected: [Vec<f32>; 3] =
        [0, 1, 2].map(|axis| [&row(1.5)[axis][..], &row(2.5)[axis]].concat());
    assert_eq!(strip, expected);
    let found = file.found();
    assert_eq!((found.diameter, found.wind_speed), (Some(240.0), Some(9.0)));
    assert_eq!(found.hub, Some([0.0, 0.0, 150.0]));
    assert_eq!(found.name.as_deref(), Some("first-study, helix"));
}

#[test]
fn volumes_for_paraview_come_back_as_fields() {
    let folder = tempfile::tempdir().unwrap();
    let volume = |time: f64| Volume {
        origin: Vector3::new(1.0, -1.0, 0.5),
        spacing: 0.25,
        n_points: [3, 2, 2],
        time,
        velocity: [0.0, 100.0, 200.0].map(|add| (0..12).map(|i| add + i as f32).collect()),
    };
    for (index, time) in [4.0, 6.0].into_iter().enumerate() {
        let path = folder.path().join(format!("velocity-{index:04}.vti"));
        crate::vtk::write_volume(&path, &volume(time)).unwrap();
    }
    let mut file = FieldFile::open(folder.path(), Lengths::Metres).unwrap();
    assert_eq!((file.times(), file.grid().n_points), (&[4.0, 6.0][..], [3, 2, 2]));
    let mut field = file.empty();
    file.read(1, &mut field).unwrap();
    assert_eq!(field.velocity, volume(6.0).velocity);
    let text = r#"<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 0 0 0" Origin="0 0 0" Spacing="1 1 1"><DataArray Name="velocity" NumberOfComponents="3" format="ascii">1 2 3 nan 5 6</DataArray>"#;
    let path = folder.path().join("text.vti");
    fs::write(&path, text).unwrap();
    let mut file = FieldFile::open(&path, Lengths::Metres).unwrap();
    file.read(0, &mut field).unwrap();
    assert_eq!((field.velocity[1][0], field.velocity[2][1]), (2.0, 6.0));
    assert!(field.velocity[0][1].is_nan() && !file.has_times());
    let odd = [
        (text.replace("Spacing", r#"Direction="0 1 0 1 0 0 0 0 1" Spacing"#), "axes are turned"),
        (text.replace("<DataArray", r#"<Piece Extent="0 0 0 0 0 0"><DataArray"#), "in pieces"),
        (
            text.replace("<DataArray", r#"<DataArray Name="TimeValue">soon</DataArray><DataArray"#),
            "`TimeValue` is `soon`",
        ),
        (text.replace("velocity", "pressure"), "lacks a `DataArray` called `velocity`"),
        (text.replace("1 2 3", "1 2"), "5 numbers, not 6"),
    ];
    for (text, expected) in odd {
        fs::write(&path, text).unwrap();
        let read = FieldFile::open(&path, Lengths::Metres).and_then(|mut f| f.read(0, &mut field));
        let error = read.unwrap_err().to_string();
        assert!(error.contains(expected) && error.contains("text.vti"), "{error}");
    }
}

const HEAD: &str =
    "VARIABLES = \"x [mm]\" \"y [mm]\" \"z [mm]\" \"u [m/s]\" \"v [m/s]\" \"w [m/s]\"\n";

#[test]
fn zones_of_points_and_of_blocks_are_instants() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.dat");
    let points = "0 0 5 1 2 3\n10 0 5 4 5 6\n0 20 5 7 8 9\n10 20 5 1 1 1\n";
    let block = "0 10 0 10\n0 0 20 20\n5 5 5 5\n1 4 7 1\n2 5 8 1\n3 6 9 1\n";
    let text = format!(
        "{HEAD}ZONE I=2, J=2, F=POINT, SOLUTIONTIME=1.5\n{points}ZONE I=2 J=2 DATAPACKING=BLOCK SOLUTIONTIME=2\n{block}"
    );
    fs::write(&path, text).unwrap();
    let mut file = FieldFile::open(&path, Lengths::Metres).unwrap();
    assert_eq!((file.times(), file.grid().n_points), (&[1.5, 2.0][..], [2, 2, 1]));
    assert!((file.grid().spacing[1] - 0.02).abs() < 1e-15);
    assert!((file.grid().origin[2] - 0.005).abs() < 1e-15);
    assert_eq!(file.read_strip(0..2, 1..2).unwrap()[1], [8.0, 1.0, 8.0, 1.0]);
    let mut field = file.empty();
    for index in [1, 0, 1] {
        file.read(index, &mut field).unwrap();
        assert_eq!(field.velocity[0], [1.0, 4.0, 7.0, 1.0], "{index}");
        assert_eq!(field.velocity[2], [3.0, 6.0, 9.0, 1.0], "{index}");
    }
}

/// A velocity of zeros counts, and is a hole where it is told to be one.
#[test]
fn zeros_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.dat");
    fs::write(&path, format!("{HEAD}ZONE I=2\n0 0 5 0 0 0\n10 0 5 0 5 6\n")).unwrap();
    for (zeros, is_hole) in [(Zeros::Air, false), (Zeros::Holes, true)] {
        let mut file = FieldFile::open(&path, Lengths::Metres).unwrap().with_zeros(zeros);
        let mut field = file.empty();
        file.read(0, &mut field).unwrap();
        assert_eq!((file.n_zeros(), field.velocity[0][0].is_nan()), (1, is_hole));
        assert_eq!(field.velocity[0][1], 0.0);
    }
}

#[test]
fn what_is_wrong_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.dat");
    let one = "0 0 5 1 2 3\n10 0 5 4 5 6\n";
    let cases = [
        (format!("{HEAD}ZONE I=3\n{one}"), "12 numbers, not 3 × 6"),
        (
            format!("{HEAD}ZONE I=2, SOLUTIONTIME=2\n{one}ZONE I=2, SOLUTIONTIME=1\n{one}"),
            "time runs back",
        ),
        (format!("{HEAD}ZONE I=2\n{one}ZONE I=1\n0 0 5 1 2 3\n"), "other points"),
        (format!("{HEAD}ZONE I=2 SOLUTIONTIME=1\n{one}ZONE I=2\n{one}"), "SOLUTIONTIME"),
        (format!("{HEAD}ZONE I=3\n{one}50 0 5 4 5 6\n"), "not evenly spaced"),
        (format!("{HEAD}{one}"), "before a ZONE"),
        ("VARIABLES = x y u v w\nZONE I=2\n1 1 1 1 1\n2 1 1 1 1\n".to_owned(), "no column `z`"),
    ];
    for (text, expected) in cases {
        fs::write(&path, text).unwrap();
        let error = FieldFile::open(&path, Lengths::Metres).err().unwrap().to_string();
        assert!(error.contains(expected) && error.contains("fields.dat"), "{error}");
    }
    let empty = folder.path().join("none");
    fs::create_dir(&empty).unwrap();
    let error = FieldFile::open(&empty, Lengths::Metres).err().unwrap().to_string();
    assert!(error.contains("it holds no .vti"), "{error}");
}
