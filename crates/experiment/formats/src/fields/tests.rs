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
        pressure: None,
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
    // No room is asked for points that the file cannot hold.
    fs::write(&path, text.replace("0 1 0", "0 99999999999 0")).unwrap();
    let error = FieldFile::open(&path, Lengths::Metres).err().unwrap().to_string();
    assert!(error.contains("fewer numbers than its extent says"), "{error}");
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

/// Numbers of other types, packed, filled, masked, in mm/s; some points of them, and at once.
#[test]
fn numbers_of_any_type_are_read_in_places_as_the_conventions_have_them() {
    use netcdf_writer::{NcAttrValue, NcFileBuilder, NcWriteOptions};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("packed.nc");
    let mut file = NcFileBuilder::new();
    let time = file.add_unlimited_dimension("time").unwrap();
    let z = file.add_dimension("z", 2).unwrap();
    let x = file.add_dimension("x", 3).unwrap();
    for (name, over, values) in
        [("time", time, &[0.5, 1.5][..]), ("z", z, &[0.0, 1.0]), ("x", x, &[0.0, 1.0, 2.0])]
    {
        let variable = file.add_variable::<f64>(name, &[over]).unwrap();
        file.write_variable(variable, values).unwrap();
    }
    let over = [time, z, x];
    let u = file.add_variable::<i16>("u", &over).unwrap();
    let stored: Vec<i16> = (0..12).map(|i| if i == 4 { -99 } else { 10 * i }).collect();
    file.write_variable(u, &stored).unwrap();
    let number = |value: f64| NcAttrValue::Doubles(vec![value]);
    file.add_variable_attribute(u, "scale_factor", number(0.5)).unwrap();
    file.add_variable_attribute(u, "add_offset", number(1.0)).unwrap();
    file.add_variable_attribute(u, "missing_value", number(-99.0)).unwrap();
    let v = file.add_variable::<f32>("v", &over).unwrap();
    file.write_variable(v, &(0..12).map(|i| i as f32).collect::<Vec<f32>>()).unwrap();
    file.add_variable_attribute(v, "valid_max", NcAttrValue::Floats(vec![10.0])).unwrap();
    let w = file.add_variable::<f64>("w", &over).unwrap();
    file.write_variable(w, &(0..12).map(|i| 0.25 * f64::from(i)).collect::<Vec<f64>>()).unwrap();
    for variable in [u, v, w] {
        let unit = NcAttrValue::Chars("mm/s".to_owned());
        file.add_variable_attribute(variable, "units", unit).unwrap();
    }
    fs::write(&path, file.to_vec(NcWriteOptions::classic()).unwrap().1).unwrap();
    let library = netcdf_reader::NcFile::open(&path).unwrap();
    let expected = ["u", "v", "w"].map(|name| {
        let values = library.read_variable_unpacked_masked(name).unwrap();
        values.into_iter().map(|value| (1e-3 * value) as f32).collect::<Vec<f32>>()
    });
    let mut file = FieldFile::open(&path, Lengths::Metres).unwrap();
    let mut found = [const { Vec::new() }; 3];
    file.read_points(0..2, 2..5, &mut found).unwrap();
    for (found, expected) in found.iter().zip(&expected) {
        let own = [&expected[2..5], &expected[8..11]].concat();
        let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<u32>>();
        assert_eq!(bits(found), bits(&own));
    }
    assert!(found[0][2].is_nan() && found[1][5] == 0.01_f32 && found[2][0] == 0.0005);
}

#[test]
fn a_file_that_was_cut_short_is_refused_when_it_is_opened() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("streamwise.nc");
    let mut writer = InstantWriter::create(&path, &PlaneSetting::example(), &plane(1.0)).unwrap();
    (1..4).for_each(|time| writer.write(&plane(f64::from(time))).unwrap());
    writer.finish().unwrap();
    let bytes = fs::read(&path).unwrap();
    fs::write(&path, &bytes[..bytes.len() - 1]).unwrap();
    let error = FieldFile::open(&path, Lengths::Metres).err().unwrap().to_string();
    assert!(error.contains("the file has only") && error.contains("streamwise.nc"), "{error}");
    // One that grows shorter while it is read.
    fs::write(&path, &bytes).unwrap();
    let mut file = FieldFile::open(&path, Lengths::Metres).unwrap();
    fs::File::options().write(true).open(&path).unwrap().set_len(bytes.len() as u64 - 8).unwrap();
    let mut velocity = [const { Vec::new() }; 3];
    file.read_points(0..3, 0..4, &mut velocity).unwrap();
    let error = file.read_points(2..3, 4..6, &mut velocity).unwrap_err().to_string();
    assert!(error.contains("cut short") && error.contains("streamwise.nc"), "{error}");
}
