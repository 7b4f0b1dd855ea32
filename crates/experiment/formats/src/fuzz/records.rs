//! What a run left: summary, manifest, series, planes, checkpoint.

use super::{Refusal, survives};
use crate::case;
use crate::checkpoint::{CheckpointReader, CheckpointWriter, Identity};
use crate::netcdf::{Column, TimeHeight, read_statistics, write_statistics};
use crate::records::{
    self, AtPhase, Manifest, PlaneSetting, RunFolder, ScanInstant, ScanSetting, ScanWriter,
    SeriesWriter, StoredPhaseAverages, read_scans, read_study, write_phase_averages,
};
use basis::keys::Values;
use basis::records::{
    FieldSetting, Grid, Moments, PhaseAverages, PhaseBin, Plane, PlaneAxes, examples,
};
use basis::scan::{Scan, ScanLayout};
use basis::{HelixFrame, Matrix3, Sense, Vector3};
use farm::case::{Case, Time, Wind};
use std::fs;
use std::path::Path;

const CASE: &str = include_str!("../../../../../cases/quickstart.toml");
const HELIX: Identity =
    Identity { case_text: CASE, run: "helix", version: "0.1.0", backend: "portable" };

fn plane() -> Plane {
    Plane {
        name: "hub-height".into(),
        axes: PlaneAxes::Horizontal,
        origin: [0.0, 0.0, 150.0],
        spacing: [15.0, 15.0],
        n_points: [2, 3],
        time: 1500.0,
        averaged: 1200.0,
        velocity: [vec![9.0; 6], vec![0.0; 6], vec![0.1; 6]],
    }
}

/// The files of a study of one run.
fn study() -> Vec<(&'static str, Vec<u8>)> {
    let study = tempfile::tempdir().unwrap();
    let case = case::parse("quickstart.toml", CASE, &[]).unwrap();
    let folder = RunFolder::new(study.path(), "run");
    folder.create().unwrap();
    let manifest = Manifest::start("0.1.0", &case, CASE, 0, [("iea-15mw", "a turbine")]);
    records::write_manifest(&folder, &manifest).unwrap();
    let mut series = SeriesWriter::create(&folder.series_path(), &[basis::channels::TIME]).unwrap();
    series.write(&[0.1]).unwrap();
    series.finish().unwrap();
    let (setting, plane) = (PlaneSetting::example(), plane());
    records::write_mean_plane(&folder, &setting, &plane).unwrap();
    let at_phase = |phase| AtPhase { phase, n_instants: 3, plane: &plane };
    let phases = [0.0, 0.5].map(at_phase);
    records::write_phase_planes(&folder, &setting, &phases).unwrap();
    // A run without volumes has an empty folder of them, which a file of another kind keeps here.
    fs::write(folder.volumes_path().join("kept"), []).unwrap();
    records::write_summary(&folder, &examples::full()).unwrap();
    let files = [
        "run/manifest.json",
        "run/summary.json",
        "run/series.csv",
        "run/planes/hub-height-mean.nc",
        "run/planes/hub-height-phases.nc",
        "run/volumes/kept",
    ];
    files.map(|name| (name, fs::read(study.path().join(name)).unwrap())).to_vec()
}

#[test]
fn studies() {
    survives(study(), |folder| {
        for run in read_study(folder)?.runs {
            run.series.read(|_| true)?;
        }
        Ok(())
    });
}

/// Scans of a lidar of two points.
fn scans() -> Vec<(&'static str, Vec<u8>)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scans-T1.lidar.nc");
    let setting = ScanSetting {
        case: "small".into(),
        run: "helix".into(),
        turbine: "T1".into(),
        sensor: "lidar".into(),
        values: Values::none(),
        layout: ScanLayout {
            directions: vec![[1.0, 0.0, 0.0]; 2],
            ranges: vec![126.0; 2],
            n_ranges: 1,
            rate: 10.0,
        },
        hub: [0.0, 0.0, 90.0],
        rotor_diameter: 126.0,
        helix: Some(HelixFrame { sense: Sense::Clockwise, rate: 0.15 }),
        wind_speed: 10.0,
    };
    let mut writer = ScanWriter::create(&path, &setting).unwrap();
    let reading = vec![7.0; Scan::n_values(2)];
    let scan = Scan::of(&reading).unwrap();
    let (origin, axes) = (Vector3::ZERO, Matrix3::IDENTITY);
    writer.write(&ScanInstant { time: 0.1, azimuth: 0.0, origin, axes, scan }).unwrap();
    writer.finish().unwrap();
    vec![("scans-T1.lidar.nc", fs::read(path).unwrap())]
}

#[test]
fn scans_of_lidars() {
    survives(scans(), |folder| {
        let stored = read_scans(&folder.join("scans-T1.lidar.nc"))?;
        let mut reading = Vec::new();
        for index in 0..stored.n_scans() {
            stored.reading(index, 0..stored.n_points(), &mut reading);
        }
        Ok(())
    });
}

/// Averages by phase of two points in two bins.
fn averages() -> Vec<(&'static str, Vec<u8>)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("averages-line.nc");
    let (values, grid) =
        ([9.0_f32; 2], Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [2, 1, 1] });
    let moments = Moments {
        n_samples: vec![4; 2],
        mean: [values; 3].map(Vec::from),
        stress: [values; 6].map(Vec::from),
    };
    let bin = PhaseBin { rotor: 0.1, helix: Some(0.2), n_instants: 4, n_visits: 2 };
    let head = PhaseAverages {
        grid,
        rotor_width: 0.5,
        helix_width: Some(0.7),
        span: [0.0, 9.0],
        bins: vec![bin; 2],
        all: moments.clone(),
        pressure: Some(vec![0.5; 2]),
        each: Vec::new(),
    };
    let setting = FieldSetting {
        name: "small".into(),
        wind_speed: 5.0,
        turbulence_intensity: Some(0.02),
        diameter: 0.58,
        hub: [0.0; 3],
    };
    write_phase_averages(&path, &setting, &head, |_| moments.clone()).unwrap();
    vec![("averages-line.nc", fs::read(path).unwrap())]
}

#[test]
fn averages_by_phase() {
    survives(averages(), |folder| {
        StoredPhaseAverages::open(&folder.join("averages-line.nc"))?.averages()?;
        Ok(())
    });
}

/// The statistics of a precursor.
fn statistics() -> Vec<(&'static str, Vec<u8>)> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("statistics.nc");
    let column = |name, values| Column { name, unit: "m s-1", meaning: "speed", values };
    let statistics = TimeHeight {
        title: "small",
        times: &[60.0, 120.0],
        heights: &[10.0, 30.0, 50.0],
        series: vec![column("hub_speed", &[9.0, 9.1])],
        profiles: vec![column("speed", &[7.0, 8.0, 9.0, 7.1, 8.1, 9.1])],
    };
    write_statistics(&path, &statistics).unwrap();
    vec![("statistics.nc", fs::read(path).unwrap())]
}

#[test]
fn statistics_of_precursors() {
    survives(statistics(), |folder| {
        read_statistics(&folder.join("statistics.nc"), &["hub_speed"], &["speed"])?;
        Ok(())
    });
}

fn checkpoint(state: impl Fn(&mut CheckpointWriter)) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("checkpoint");
    let mut writer = CheckpointWriter::create(&path, &HELIX).unwrap();
    state(&mut writer);
    writer.stream("air", |bytes| bytes.write_all(&[1; 300])).unwrap();
    writer.finish().unwrap();
    fs::read(path).unwrap()
}

/// Numbers, texts, lists and choices to keep.
type Parts = (Wind, Time, String, Vec<f64>);

fn parts() -> Parts {
    let Case { wind, time, name, output, .. } = case::parse("quickstart.toml", CASE, &[]).unwrap();
    (wind, time, name, output.crosswind_diameters)
}

fn go_on(path: &Path) -> Result<(), Refusal> {
    let mut reader = CheckpointReader::open(path, &HELIX)?;
    reader.state::<Parts>("case")?;
    reader.stream("air", |bytes| bytes.read_exact(&mut [0; 300]))?;
    Ok(())
}

#[test]
fn checkpoints() {
    let case = parts();
    let bytes = checkpoint(|writer| writer.state("case", &case).unwrap());
    survives(vec![("checkpoint", bytes)], |folder| go_on(&folder.join("checkpoint")));
}

/// Checksums guard against damage, not against another program's state: here they are right, and the state is
/// not.
#[test]
fn foreign_states() {
    let case = parts();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state");
    let mut writer = CheckpointWriter::create(&path, &HELIX).unwrap();
    writer.state("case", &case).unwrap();
    writer.finish().unwrap();
    let mut state = Vec::new();
    let mut reader = CheckpointReader::open(&path, &HELIX).unwrap();
    reader.stream("case", |bytes| bytes.read_to_end(&mut state).map(|_| ())).unwrap();
    survives(vec![("state", state)], |folder| {
        let state = fs::read(folder.join("state")).unwrap_or_default();
        let write = |writer: &mut CheckpointWriter| {
            writer.stream("case", |bytes| bytes.write_all(&state)).unwrap();
        };
        let path = folder.join("state.checkpoint");
        fs::write(&path, checkpoint(write)).unwrap();
        go_on(&path)
    });
}
