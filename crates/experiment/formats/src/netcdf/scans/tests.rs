//! Scans come back as controllers saw them, and others read them.

use super::super::stored_scans::decode;
use super::super::{StoredScans, read_scans};
use super::*;
use basis::Sense;
use basis::scan::ScanBlocks;
use netcdf_reader::NcFile;
use std::fs;

const N_POINTS: usize = 6;

/// Three lines of sight at two ranges, on a turbine that is not the first.
fn setting(helix: Option<HelixFrame>) -> ScanSetting {
    let direction = |index: usize| [0.8, 0.6 * (index % 3) as f64 - 0.6, 0.0];
    let mut values = Values::none();
    values.set("scan", "rings");
    values.set("n_points", 3_u64);
    values.set("ranges_diameters", vec![1.0, 2.0]);
    ScanSetting {
        case: "small".into(),
        run: "helix".into(),
        turbine: "T2".into(),
        sensor: "lidar".into(),
        values,
        layout: ScanLayout {
            directions: (0..N_POINTS).map(direction).collect(),
            ranges: vec![126.0, 126.0, 126.0, 252.0, 252.0, 252.0],
            n_ranges: 2,
            rate: 10.0,
        },
        hub: [504.0, 10.0, 90.0],
        rotor_diameter: 126.0,
        helix,
        wind_speed: 10.0,
    }
}

fn helix() -> Option<HelixFrame> {
    Some(HelixFrame { sense: Sense::Clockwise, rate: 0.15 })
}

/// The reading of scan number `index`: a point was not measured yet, another's beam was lost.
fn reading(index: usize) -> Vec<f64> {
    let mut reading = vec![f64::NAN; Scan::n_values(N_POINTS)];
    let scan = ScanBlocks::of(&mut reading).unwrap();
    scan.head.copy_from_slice(&[(index + 1) as f64, 4.0 / 6.0]);
    for point in 0..N_POINTS - 1 {
        let value = 7.0 + 0.1 * (10 * index + point) as f64;
        scan.speeds[point] = if point == 1 { f64::NAN } else { f64::from(value as f32) };
        scan.places[0][point] = 126.0 * (1 + point / 3) as f64;
        scan.places[1][point] = f64::from(10.0_f32 * point as f32 - 20.3);
        scan.places[2][point] = f64::from(-3.1_f32 * point as f32);
        scan.times[point] = 0.1 * (index as f64) - 0.01 * point as f64;
    }
    reading
}

/// A nacelle turned by a quarter to the left, seen from above: its wake goes to the left.
fn turned() -> Matrix3 {
    Matrix3::from_cols(Vector3::Y, -Vector3::X, Vector3::Z)
}

fn write(writer: &mut ScanWriter, indices: std::ops::Range<usize>) {
    for index in indices {
        let reading = reading(index);
        let scan = Scan::of(&reading).unwrap();
        let (time, azimuth) = (0.1 * index as f64, 1.2 * 0.1 * index as f64);
        let origin = Vector3::new(500.0, 10.0, 92.0);
        writer.write(&ScanInstant { time, azimuth, origin, axes: turned(), scan }).unwrap();
    }
}

fn whole(path: &Path, helix: Option<HelixFrame>) -> StoredScans {
    let mut writer = ScanWriter::create(path, &setting(helix)).unwrap();
    write(&mut writer, 0..30);
    writer.finish().unwrap();
    read_scans(path).unwrap()
}

#[test]
fn scans_come_back_as_controllers_saw_them() {
    let folder = tempfile::tempdir().unwrap();
    for helix in [helix(), None] {
        let stored = whole(&folder.path().join("scans-T2.lidar.nc"), helix);
        assert_eq!((stored.n_scans(), stored.n_points()), (30, N_POINTS));
        assert_eq!((stored.turbine.as_str(), stored.sensor.as_str()), ("T2", "lidar"));
        assert_eq!((stored.pattern.as_str(), stored.helix), ("rings", helix));
        assert_eq!(stored.points_at(1), 3..6);
        let mut back = Vec::new();
        for index in 0..30 {
            stored.reading(index, 0..N_POINTS, &mut back);
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            let expected = reading(index);
            // Values of single precision come back to the bit; the share is that of the points here.
            assert_eq!(bits(&back[2..]), bits(&expected[2..]), "{index}");
            assert!((back[1] - 4.0 / 6.0).abs() < 1e-12 && back[0] == expected[0]);
            stored.reading(index, 3..6, &mut back);
            let scan = Scan::of(&back).unwrap();
            assert_eq!((scan.n_points(), scan.n_valid()), (3, 2));
            assert_eq!(scan.left()[0], Scan::of(&expected).unwrap().left()[3]);
        }
    }
}

#[test]
fn the_file_tells_units_places_phase_and_what_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scans.nc");
    whole(&path, helix());
    let bytes = fs::read(&path).unwrap();
    let file = NcFile::from_bytes(&bytes).unwrap();
    assert_eq!(file.variable(SPEED).unwrap().shape(), [30, N_POINTS as u64]);
    let unit = file.variable(SPEED).unwrap().attribute("units").unwrap().value.as_string();
    assert_eq!(unit.as_deref(), Some("m s-1"));
    let quality = file.read_variable::<i8>("quality").unwrap();
    assert_eq!(quality.iter().take(N_POINTS).copied().collect::<Vec<i8>>(), [0, 1, 0, 0, 0, 2]);
    let phases = file.read_variable::<f64>("helix_phase").unwrap();
    assert!(phases.iter().enumerate().all(|(k, phase)| (phase - 0.015 * k as f64).abs() < 1e-12));
    // Downwind of the turned nacelle is to the left of the farm, its left is upwind.
    let place =
        |name: &str| file.read_variable::<f32>(name).unwrap().iter().copied().nth(2).unwrap();
    let left = 10.0_f32 * 2.0 - 20.3;
    assert!((place("x") - (500.0 - left)).abs() < 1e-4 && (place("y") - 136.0).abs() < 1e-4);
    assert!((place("z") - (92.0 - 6.2)).abs() < 1e-4);
    let rings = file.global_attribute("lidar_scan").unwrap().value.as_string();
    assert_eq!(rings.as_deref(), Some("rings"));
    let [header, scan] = scan_bytes(N_POINTS as u64);
    let (most, length) = (header + 30 * scan, bytes.len() as u64);
    assert!(length <= most && most < length + (12 << 10), "{length} bytes, told {most}");
}

#[test]
fn a_file_that_goes_on_is_the_same_to_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    whole(&path("whole.nc"), helix());
    let (part, setting) = (path("part.nc"), setting(helix()));
    let mut writer = ScanWriter::create(&part, &setting).unwrap();
    write(&mut writer, 0..12);
    assert_eq!(writer.flush().unwrap(), 12);
    // What comes after the checkpoint goes.
    write(&mut writer, 12..17);
    drop(writer);
    let mut writer = ScanWriter::resume(&part, &setting, 12).unwrap();
    write(&mut writer, 12..20);
    writer.finish().unwrap();
    // A complete run that becomes longer.
    let mut writer = ScanWriter::resume(&part, &setting, 20).unwrap();
    write(&mut writer, 20..30);
    writer.finish().unwrap();
    assert_eq!(fs::read(&part).unwrap(), fs::read(path("whole.nc")).unwrap());
    let lost = ScanWriter::resume(&part, &setting, 31).unwrap_err().to_string();
    assert!(lost.contains("part.nc.part does not hold scans of a lidar"), "{lost}");
}

#[test]
fn another_file_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scans.nc");
    fs::write(&path, b"not NetCDF").unwrap();
    let error = read_scans(&path).unwrap_err().to_string();
    assert!(error.contains("scans.nc does not hold scans of a lidar"), "{error}");
    let mut other = NcFileBuilder::new();
    other.add_dimension("x", 3).unwrap();
    let (_, bytes) = other.to_vec(NcWriteOptions::default()).unwrap();
    assert_eq!(decode(&bytes).unwrap_err(), "it lacks `range`");
}
