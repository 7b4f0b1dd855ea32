//! What is written comes back, in the shape that others expect.

use super::read::decode;
use super::*;
use netcdf_reader::NcFile;
use proptest::prelude::*;
use std::fs;
use std::io::Write;

fn setting() -> PlaneSetting {
    PlaneSetting::example()
}

fn one(axes: PlaneAxes) -> Vec<u8> {
    encode(&setting(), &plane(axes), &Over::Time { grows: false }).unwrap()
}

fn plane(axes: PlaneAxes) -> Plane {
    let values = |scale: f32| (0..12).map(|i| scale * (i as f32 + 0.1)).collect();
    Plane {
        name: "hub-height".into(),
        axes,
        origin: [-0.1 - 0.2, -37.5, 150.0],
        spacing: [15.0, 1.0 / 3.0],
        n_points: [4, 3],
        time: 1_500.000_000_1,
        averaged: 1200.0,
        velocity: [values(1.0), values(-0.3), values(1e-7)],
    }
}

#[test]
fn a_plane_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for axes in [PlaneAxes::Horizontal, PlaneAxes::Streamwise, PlaneAxes::Crosswind] {
        let path = folder.path().join("plane.nc");
        write_plane(&path, &setting(), &plane(axes)).unwrap();
        assert_eq!(read_plane(&path).unwrap(), plane(axes));
    }
}

#[test]
fn coordinates_lie_where_the_plane_was_taken() {
    let file = NcFile::from_bytes(&one(PlaneAxes::Streamwise)).unwrap();
    let coordinate = |name| {
        let array = file.read_variable::<f64>(name).unwrap();
        array.iter().copied().collect::<Vec<f64>>()
    };
    let start = -0.1 - 0.2;
    assert_eq!(coordinate("x"), [start, start + 15.0, start + 30.0, start + 45.0]);
    assert_eq!(coordinate("y"), [-37.5]);
    assert_eq!(coordinate("z"), [150.0, 150.0 + 1.0 / 3.0, 150.0 + 2.0 / 3.0]);
    assert_eq!(file.variable("u").unwrap().shape(), [1, 3, 1, 4]);
    let unit = file.variable("u").unwrap().attribute("units").unwrap().value.as_string();
    assert_eq!(unit.as_deref(), Some("m s-1"));
}

#[test]
fn another_file_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plane.nc");
    fs::write(&path, b"not NetCDF").unwrap();
    let error = read_plane(&path).unwrap_err();
    assert!(error.to_string().contains("plane.nc does not hold a plane of velocities"), "{error}");
    let mut other = NcFileBuilder::new();
    other.add_dimension("x", 3).unwrap();
    let (_, bytes) = other.to_vec(NcWriteOptions::default()).unwrap();
    assert_eq!(decode(&bytes).unwrap_err(), "it lacks `axes`");
}

#[test]
fn a_file_tells_of_wind_and_turbines() {
    let file = NcFile::from_bytes(&one(PlaneAxes::Horizontal)).unwrap();
    let attribute = |name: &str| file.global_attribute(name).unwrap().value.clone();
    for (name, expected) in [("case", "first-study"), ("run", "helix"), ("Conventions", "CF-1.8")] {
        assert_eq!(attribute(name).as_string().as_deref(), Some(expected), "{name}");
    }
    for (name, expected) in [
        ("wind_speed_m_s", 9.0),
        ("wind_from_direction_deg", 270.0),
        ("turbulence_intensity", 0.05),
        ("air_density_kg_m3", 1.225),
        ("rotor_diameter_m", 240.0),
        ("hub_height_m", 150.0),
    ] {
        assert_eq!(attribute(name).as_f64_vec().unwrap(), [expected], "{name}");
    }
    let numbers = |name: &str| -> Vec<f64> {
        file.read_variable::<f64>(name).unwrap().iter().copied().collect()
    };
    assert_eq!(numbers("hub_x"), [0.0, 1200.0]);
    assert_eq!(numbers("hub_y"), [0.0, 0.0]);
    assert_eq!(numbers("hub_z"), [150.0, 150.0]);
    assert_eq!(numbers("rotor_diameter"), [240.0, 240.0]);
    let present = file.read_variable::<i8>("turbine_present").unwrap();
    assert_eq!(present.iter().copied().collect::<Vec<i8>>(), [1, 0]);
    assert_eq!(file.variable("turbine").unwrap().shape(), [2, 7]);
}

#[test]
fn phases_come_back_from_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hub-height-phases.nc");
    let planes = [1.0_f32, 2.0, 3.0].map(|scale| {
        let mut plane = plane(PlaneAxes::Horizontal);
        plane.velocity[0].iter_mut().for_each(|value| *value *= scale);
        plane
    });
    let phases: Vec<AtPhase> = planes
        .iter()
        .enumerate()
        .map(|(k, plane)| AtPhase { phase: 2.1 * k as f64, n_instants: 7, plane })
        .collect();
    write_phases(&path, &setting(), &phases).unwrap();
    let back = read_phases(&path).unwrap();
    let expected = planes.iter().enumerate().map(|(k, plane)| (2.1 * k as f64, plane.clone()));
    assert_eq!(back, expected.collect::<Vec<_>>());
    let file = NcFile::from_bytes(&fs::read(&path).unwrap()).unwrap();
    assert_eq!(file.variable("u").unwrap().shape(), [3, 1, 3, 4]);
    // A plane without phases has none.
    write_plane(&path, &setting(), &planes[0]).unwrap();
    assert!(read_phases(&path).unwrap_err().to_string().contains("it lacks `phase`"));
}

fn instant(index: usize) -> Plane {
    let mut plane = plane(PlaneAxes::Streamwise);
    (plane.time, plane.averaged) = (0.1 * index as f64, 0.0);
    plane.velocity[1].iter_mut().for_each(|value| *value += index as f32);
    plane
}

#[test]
fn instants_of_a_stopped_run_are_those_of_one_that_went_on() {
    let folder = tempfile::tempdir().unwrap();
    let [path, other] = ["streamwise.nc", "other.nc"].map(|name| folder.path().join(name));
    let (setting, all) = (setting(), (0..9).map(instant).collect::<Vec<_>>());
    let begin = |path: &Path| InstantWriter::create(path, &setting, &all[0]).unwrap();
    let mut writer = begin(&other);
    all.iter().for_each(|plane| writer.write(plane).unwrap());
    writer.finish().unwrap();
    assert_eq!(read_planes(&other).unwrap(), all);
    let file = NcFile::from_bytes(&fs::read(&other).unwrap()).unwrap();
    assert_eq!(file.variable("u").unwrap().shape(), [9, 3, 1, 4]);

    let mut writer = begin(&path);
    all[..3].iter().for_each(|plane| writer.write(plane).unwrap());
    let kept = writer.flush().unwrap();
    // After the checkpoint, and half of the next one.
    writer.write(&all[8]).unwrap();
    writer.flush().unwrap();
    drop(writer);
    assert!(!path.exists());
    // What is there can be looked at.
    assert_eq!(read_planes(&atomic::part_of(&path)).unwrap().len(), 4);
    let part = fs::OpenOptions::new().append(true).open(atomic::part_of(&path)).unwrap();
    (&part).write_all(&[7; 5]).unwrap();
    assert!(InstantWriter::resume(&path, &setting, &all[0], 20).is_err());
    let mut writer = InstantWriter::resume(&path, &setting, &all[0], kept).unwrap();
    all[3..6].iter().for_each(|plane| writer.write(plane).unwrap());
    writer.finish().unwrap();
    assert_eq!(read_planes(&path).unwrap(), all[..6]);
    // A complete one is gone on with when its run is lengthened.
    let mut writer = InstantWriter::resume(&path, &setting, &all[0], 6).unwrap();
    assert!(!path.exists());
    all[6..].iter().for_each(|plane| writer.write(plane).unwrap());
    writer.finish().unwrap();
    assert!(fs::read(&path).unwrap() == fs::read(&other).unwrap());
    fs::remove_file(&path).unwrap();
    let error = InstantWriter::resume(&path, &setting, &all[0], 6).unwrap_err().to_string();
    assert!(error.contains("it is gone"), "{error}");
    // Nothing leaves nothing.
    begin(&path).finish().unwrap();
    assert!(!path.exists() && !atomic::part_of(&path).exists());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn no_damage_makes_the_reader_panic(
        cut in 0usize..4000,
        flips in prop::collection::vec((0usize..2000, any::<u8>()), 0..4),
    ) {
        let mut bytes = one(PlaneAxes::Crosswind);
        for (place, value) in flips {
            let place = place % bytes.len();
            bytes[place] = value;
        }
        bytes.truncate(cut);
        let _ = decode(&bytes);
    }
}
