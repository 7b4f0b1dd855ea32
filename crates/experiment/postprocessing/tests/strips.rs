//! Averages of fields strip by strip: the same as in one piece, whatever the memory.

use basis::records::{Plane, PlaneAxes};
use formats::records::{InstantWriter, PlacedTurbine, PlaneSetting};
use postprocessing::PostprocessingError;
use postprocessing::analyses::{ANALYSES, Answer, Request, Told, Watch};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Points along x and z.
const N_POINTS: [usize; 2] = [300, 24];

fn run(name: &str, request: &Request) -> Result<Answer, PostprocessingError> {
    let analysis = ANALYSES.iter().find(|analysis| analysis.name == name).expect("a listed one");
    (analysis.run)(request)
}

/// `n_instants` in a file of NetCDF, with holes and zeros in some rows, and a table of azimuths.
fn fields(folder: &Path, n_instants: usize) -> (PathBuf, PathBuf) {
    let (fields, azimuths) = (folder.join("tunnel.nc"), folder.join("azimuths.csv"));
    let turbine =
        PlacedTurbine { name: "T1".into(), hub: [0.0; 3], rotor_diameter: 1.0, is_there: true };
    let setting = PlaneSetting {
        case: "tunnel".into(),
        run: "ccw".into(),
        wind_speed: 5.0,
        wind_direction_deg: 270.0,
        turbulence_intensity: 0.02,
        air_density: 1.2,
        turbines: vec![turbine],
    };
    let mut writer: Option<InstantWriter> = None;
    let mut table = "time_s,Azimuth_deg,Helix_deg\n".to_owned();
    for step in 0..n_instants {
        let mut plane = plane(step);
        let row = 11 * N_POINTS[0];
        plane.velocity[step % 3][row + step % 50] = f32::NAN;
        plane.velocity.iter_mut().for_each(|values| values[row + 100] = 0.0);
        let writer =
            writer.get_or_insert_with(|| InstantWriter::create(&fields, &setting, &plane).unwrap());
        writer.write(&plane).unwrap();
        let turns = 0.07 * step as f64;
        let (rotor, helix) = (360.0 * turns.fract(), 360.0 * (3.0 * turns / 17.0).fract());
        writeln!(table, "{},{rotor},{helix}", plane.time).unwrap();
    }
    writer.unwrap().finish().unwrap();
    fs::write(&azimuths, table).unwrap();
    (fields, azimuths)
}

fn plane(step: usize) -> Plane {
    let mut state = step as u64 + 1;
    let mut even = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1_u64 << 24) as f32
    };
    let n = N_POINTS[0] * N_POINTS[1];
    Plane {
        name: "streamwise".into(),
        axes: PlaneAxes::Streamwise,
        origin: [0.5, 0.0, -0.5],
        spacing: [0.05; 2],
        n_points: N_POINTS,
        time: 0.01 * step as f64,
        averaged: 0.0,
        velocity: [5.0, 0.0, 0.0].map(|mean| (0..n).map(|_| mean + even()).collect()),
    }
}

/// One strip and many, one batch of instants and several (more than 64 in few bins): the file of averages and
/// all numbers are the same, bit by bit, with a hole in one strip; and the cost is told before.
#[test]
fn strips_give_the_same_bits_as_one_piece() {
    let folder = tempfile::tempdir().unwrap();
    let (fields, azimuths) = fields(folder.path(), 300);
    let averaged = |bins: &str, cycles: &str, memory: &str| {
        let out = folder.path().join(format!("{bins}-{cycles}-{memory}.nc"));
        let told = Arc::new(Mutex::new(Vec::new()));
        let heard = told.clone();
        let request = Request::of(&fields)
            .with("azimuths", azimuths.to_str().unwrap())
            .with("bins", bins)
            .with("cycles", cycles)
            .with("memory", memory)
            .with("out", out.to_str().unwrap());
        let listen = move |what: &Told| {
            heard.lock().unwrap().push(match what {
                Told::Cost(text) => (*text).to_owned(),
                Told::Share(share) => format!("{share:.2}"),
            });
        };
        let answer = run("phases", &Request { watch: Watch::new(listen), ..request }).unwrap();
        let told = told.lock().unwrap().clone();
        (fs::read(out).unwrap(), answer, told)
    };
    for (bins, cycles, little) in [("12", "3", "14"), ("4", "0", "2")] {
        let (whole, answer, told) = averaged(bins, cycles, "4000");
        assert_eq!(told, ["1.00"]);
        let (strips, other, told) = averaged(bins, cycles, little);
        assert!(told[0].contains("strips of at most"), "{told:?}");
        assert!(told.len() > 3 && told.last().unwrap() == "1.00", "{told:?}");
        assert!(whole == strips, "{bins} bins");
        assert_eq!((answer.json, answer.text), (other.json, other.text));
        assert!(answer.remarks.iter().any(|remark| remark.contains("300 of 2160000 samples are")));
        assert!(answer.remarks.iter().any(|remark| remark.contains("are exactly zero")));
    }
    let request = Request::of(&fields).with("azimuths", azimuths.to_str().unwrap());
    let error = run("phases", &request.with("memory", "1")).unwrap_err();
    assert!(error.to_string().contains("rows of 300 points"), "{error}");
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    let least = help.strip_prefix("ask for --memory ").unwrap();
    let request = Request::of(&fields).with("azimuths", azimuths.to_str().unwrap());
    assert!(run("phases", &request.with("memory", least)).is_ok());
}

/// Bins that are kept come out as they do from a file of averages.
#[test]
fn bins_in_memory_are_those_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let (fields, azimuths) = fields(folder.path(), 120);
    let out = folder.path().join("averages.nc");
    let request = Request::of(&fields).with("azimuths", azimuths.to_str().unwrap());
    run("phases", &request.clone().with("memory", "30").with("out", out.to_str().unwrap()))
        .unwrap();
    let now = run("entrainment", &request.with("memory", "20")).unwrap();
    let stored = run("entrainment", &Request::of(&out)).unwrap();
    assert_eq!(
        (&now.json["fluxes"], &now.json["wake_edge"]),
        (&stored.json["fluxes"], &stored.json["wake_edge"])
    );
}

#[test]
fn a_file_cut_short_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let (fields, _) = fields(folder.path(), 5);
    let bytes = fs::read(&fields).unwrap();
    fs::write(&fields, &bytes[..bytes.len() - 100]).unwrap();
    let error = run("phases", &Request::of(&fields)).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("tunnel.nc") && text.contains("the file has only"), "{text}");
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(help.contains("cut short"), "{help}");
}
