//! Fields of a tunnel, made by a formula: from file to phases, energy, vortices, modes; and particles.

use basis::records::{Plane, PlaneAxes};
use formats::records::{InstantWriter, PlacedTurbine, PlaneSetting};
use postprocessing::PostprocessingError;
use postprocessing::analyses::{ANALYSES, Answer, Request};
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

const DIAMETER: f64 = 0.58;
const WIND: f64 = 5.0;
const ROTOR_HZ: f64 = 8.0;
/// Revolutions a helix cycle: 17 in three.
const RATIO: f64 = 17.0 / 3.0;
const INTERVAL: f64 = 0.0051;

fn run(name: &str, request: &Request) -> Result<Answer, PostprocessingError> {
    let analysis = ANALYSES.iter().find(|analysis| analysis.name == name).expect("a listed one");
    (analysis.run)(request)
}

/// A plane along the wind at `time`: u waves with the helix above and below, w against it, and vortices that
/// a rotor of one blade sheds go by at z = 0.29 m.
fn plane(time: f64) -> Plane {
    let (n_x, n_z, spacing) = (61, 61, 0.02);
    let mut velocity = [const { Vec::new() }; 3];
    for index in 0..n_x * n_z {
        let (x, z) = (0.2 + spacing * (index % n_x) as f64, -0.6 + spacing * (index / n_x) as f64);
        let angle = TAU * ROTOR_HZ / RATIO * time - 3.0 * x;
        let (mut u, mut w) = (WIND + 0.4 * angle.cos(), -0.2 * angle.cos() * z.signum());
        for number in 0..40 {
            let middle = 0.1 + 4.0 * (time - f64::from(number - 20) / ROTOR_HZ);
            let (dx, dz) = (x - middle, z - 0.29);
            let square = dx * dx + dz * dz;
            if square > 0.0 && square < 0.36 {
                let turn = -0.15 * -(-square / 0.0025).exp_m1() / (TAU * square);
                u -= turn * dz;
                w += turn * dx;
            }
        }
        velocity[0].push(u as f32);
        velocity[1].push(0.0);
        velocity[2].push(w as f32);
    }
    velocity[0][7] = if time > 1.0 { f32::NAN } else { velocity[0][7] };
    Plane {
        name: "streamwise".into(),
        axes: PlaneAxes::Streamwise,
        origin: [0.2, 0.0, -0.6],
        spacing: [spacing; 2],
        n_points: [n_x, n_z],
        time,
        averaged: 0.0,
        velocity,
    }
}

/// 400 instants with their azimuths in `folder`.
fn tunnel(folder: &Path) -> (PathBuf, PathBuf) {
    let (fields, azimuths) = (folder.join("tunnel.nc"), folder.join("azimuths.csv"));
    let turbine = PlacedTurbine {
        name: "T1".into(),
        hub: [0.0; 3],
        rotor_diameter: DIAMETER,
        is_there: true,
    };
    let setting = PlaneSetting {
        case: "tunnel".into(),
        run: "ccw".into(),
        wind_speed: WIND,
        wind_direction_deg: 270.0,
        turbulence_intensity: 0.02,
        air_density: 1.2,
        turbines: vec![turbine],
    };
    let mut writer = InstantWriter::create(&fields, &setting, &plane(0.0)).unwrap();
    let mut table = "time_s,Azimuth_deg,Helix_deg\n".to_owned();
    for step in 0..400 {
        let time = INTERVAL * f64::from(step);
        writer.write(&plane(time)).unwrap();
        let turns = ROTOR_HZ * time;
        let (rotor, helix) = (360.0 * turns.fract(), 360.0 * (turns / RATIO).fract());
        writeln!(table, "{time},{rotor},{helix}").unwrap();
    }
    writer.finish().unwrap();
    fs::write(&azimuths, table).unwrap();
    (fields, azimuths)
}

fn number(json: &serde_json::Value, pointer: &str) -> f64 {
    json.pointer(pointer).and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN)
}

#[test]
fn fields_of_a_tunnel_go_from_file_to_phases_energy_vortices_and_modes() {
    let folder = tempfile::tempdir().unwrap();
    let (fields, azimuths) = tunnel(folder.path());
    let out = folder.path().join("averages.nc");
    let with_phases = Request::of(&fields).with("azimuths", azimuths.to_str().unwrap());
    let request = with_phases.clone().with("out", out.to_str().unwrap());
    let phases = run("phases", &request).unwrap();
    let json = &phases.json;
    assert_eq!(json["bins"].as_array().map(Vec::len), Some(204));
    assert!((number(json, "/rotor_hz") - ROTOR_HZ).abs() < 1e-3);
    assert!((number(json, "/helix_hz") - ROTOR_HZ / RATIO).abs() < 1e-3);
    assert_eq!(json["helix_sense"], "ccw");
    // A point has a hole in the later instants: it is told.
    assert!(
        phases.remarks.iter().any(|remark| remark.contains("are holes")),
        "{:?}",
        phases.remarks
    );
    let rows = json["widths"].as_array().unwrap();
    let error = |row: usize| rows[row]["error_of_instants"].as_f64().unwrap();
    assert!(error(3) > 0.0 && rows.len() == 4);
    assert!(phases.text.contains("turbulence intensity 2.0 %"), "{}", phases.text);

    let figures = folder.path().join("pictures");
    let request = Request::of(&out).with("figures", figures.to_str().unwrap());
    let energy = run("entrainment", &request).unwrap();
    let through = |name: &str| {
        let all = energy.json["fluxes"].as_array().unwrap();
        all.iter().find(|one| one["through"] == name).unwrap().clone()
    };
    // Below, the wave alone: u falls where w rises against it, −½ 0.4 · 0.2, and inward is upward.
    let lower = number(&through("lower"), "/integral_over_u3d/periodic");
    let expected = 0.5 * 0.4 * 0.2 * WIND * 1.2 / (WIND.powi(3) * DIAMETER);
    assert!((lower / expected - 1.0).abs() < 0.15, "{lower} {expected}");
    assert!(figures.join("figures/entrainment-over-distance.svg").is_file());

    let request = Request::of(&out).with("rotor-hz", "8");
    let found = run("vortices", &request).unwrap();
    let tracks = found.json["tracks"].as_array().unwrap();
    let longest =
        tracks.iter().map(|track| track["sightings"].as_array().unwrap()).max_by_key(|s| s.len());
    let longest = longest.unwrap();
    assert!(longest.len() > 12, "{}", longest.len());
    let circulation = number(&longest[6], "/vortex/circulation_m2_s");
    assert!((circulation / -0.15 - 1.0).abs() < 0.1, "{circulation}");

    let modes = run("modes", &with_phases.clone().with("block", "200")).unwrap();
    assert!(modes.text.contains("f_e"), "{}", modes.text);
    let share = number(&modes.json, "/pod/energies_m2_s2/0");
    assert!(share > 0.0 && modes.json["n_masked"] == 1);
    let named = modes.json["named_frequencies"].as_array().unwrap();
    assert!((number(&named[0], "/frequency_hz") - ROTOR_HZ / RATIO).abs() < 1e-3);
    let refused = run("budget", &Request::of(&out)).unwrap_err().to_string();
    assert!(refused.contains("spans no volume"), "{refused}");
}

#[test]
fn fields_that_do_not_tell_what_is_needed_are_refused_with_the_fix() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bare.dat");
    let head = "VARIABLES = x y z u v w\nZONE I=2 J=2\n";
    fs::write(&path, format!("{head}0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n1 1 0 1 0 0\n"))
        .unwrap();
    let error = run("phases", &Request::of(&path)).unwrap_err();
    assert!(error.to_string().contains("does not tell the free-stream speed"), "{error}");
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(help.contains("--wind-speed"), "{help}");
    let request = Request::of(&path).with("wind-speed", "5").with("diameter", "0.58");
    let request = request.with("hub", "0,0,0");
    let told = run("entrainment", &request).unwrap();
    assert!(told.remarks.iter().any(|remark| remark.contains("no azimuths are told")));
}

#[test]
fn particles_become_fields_that_other_analyses_take() {
    let folder = tempfile::tempdir().unwrap();
    let (path, out) = (folder.path().join("tracks.csv"), folder.path().join("fields.nc"));
    let mut table = "x [mm],y [mm],z [mm],u [m/s],v [m/s],w [m/s]\n".to_owned();
    let mut state = 1_u64;
    let mut even = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for index in 0..20_000 {
        let place = [200.0 * even(), 100.0 * (even() - 0.5), 100.0 * (even() - 0.5)];
        let u = if index % 500 == 0 { 30.0 } else { 4.0 + 0.005 * place[2] + 0.1 * (even() - 0.5) };
        let [x, y, z] = place;
        writeln!(table, "{x},{y},{z},{u},0,0").unwrap();
    }
    table += "nan,0,0,4,0,0\n";
    fs::write(&path, table).unwrap();
    let request = Request::of(&path).with("wind-speed", "5").with("diameter", "0.08");
    let request = request.with("hub", "0,0,0").with("bounds", "0.02,0.18,-0.04,0.04,-0.04,0.04");
    let found = run("particles", &request.with("out", out.to_str().unwrap())).unwrap();
    let refused = number(&found.json, "/particles/outliers");
    assert!((35.0..60.0).contains(&refused), "{refused}");
    assert_eq!(number(&found.json, "/particles/without_numbers"), 1.0);
    assert_eq!(number(&found.json, "/cells/empty") + number(&found.json, "/cells/too_few"), 0.0);
    let energy = run("entrainment", &Request::of(&out)).unwrap();
    // u = 4 + 5 z over a disc of 40 mm: the mean cube over 5³ is 0.8³ (1 + 3 (5 · 0.02 / 4)²).
    let expected = 0.512 * (1.0 + 3.0 * (5.0_f64 * 0.02 / 4.0).powi(2));
    let power = number(&energy.json, "/available_power/5/f_ap");
    assert!((power / expected - 1.0).abs() < 0.01, "{power} {expected}");
}

/// Particles of a wave with the rotor's azimuth come back bin by bin.
#[test]
fn particles_are_averaged_by_phase() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut tracks = "time [s],x [mm],y [mm],z [mm],u [m/s],v [m/s],w [m/s]\n".to_owned();
    let mut azimuths = "time_s,Azimuth_deg\n".to_owned();
    let mut state = 3_u64;
    let mut even = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    for step in 0..600 {
        let time = f64::from(step) * 0.0103;
        let turns = ROTOR_HZ * time;
        writeln!(azimuths, "{time},{}", 360.0 * turns.fract()).unwrap();
        for _ in 0..40 {
            let [x, y, z] = [0, 1, 2].map(|_| 80.0 * (even() - 0.5));
            let u = 4.0 + (TAU * turns).cos() + 0.1 * (even() - 0.5);
            writeln!(tracks, "{time},{x},{y},{z},{u},0,0").unwrap();
        }
    }
    fs::write(path("tracks.csv"), &tracks).unwrap();
    fs::write(path("azimuths.csv"), azimuths).unwrap();
    let text = |name: &str| path(name).to_str().unwrap().to_owned();
    let request = Request::of(path("tracks.csv")).with("wind-speed", "5").with("diameter", "0.08");
    let request = request.with("hub", "0,0,0").with("bounds", "-0.02,0.02,-0.02,0.02,-0.02,0.02");
    let by_phase = request.clone().with("azimuths", &text("azimuths.csv"));
    let found = run("particles", &by_phase.with("out", &text("fields.nc"))).unwrap();
    let bins = found.json["phases"].as_array().unwrap();
    assert_eq!(bins.len(), 12);
    let n: f64 = bins.iter().map(|bin| number(bin, "/n_instants")).sum();
    assert_eq!(n, 600.0);
    let parts = run("phases", &Request::of(path("fields.nc"))).unwrap();
    // Of a wave of 1 m/s bins of 30° keep sin 15° / 15°: 0.9886.
    let row = &parts.json["fluctuations_over_free_stream"][0];
    let periodic = number(row, "/periodic");
    assert!((periodic / (0.9886 * 0.5_f64.sqrt() / 5.0) - 1.0).abs() < 0.02, "{periodic}");
    // Of time that is not told azimuths say nothing.
    let bare = tracks.replace("time [s]", "track");
    fs::write(path("bare.csv"), bare).unwrap();
    let request = Request { folders: vec![path("bare.csv")], ..request };
    let error = run("particles", &request.with("azimuths", &text("azimuths.csv"))).unwrap_err();
    assert!(error.to_string().contains("does not tell the times"), "{error}");
}

#[test]
fn azimuths_and_times_that_tell_nothing_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let text = |name: &str| path(name).to_str().unwrap().to_owned();
    let zone = |time: &str| {
        format!("ZONE I=2 J=2{time}\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n1 1 0 1 0 0\n")
    };
    let head = "VARIABLES = x y z u v w\n";
    fs::write(path("bare.dat"), format!("{head}{}{}", zone(""), zone(""))).unwrap();
    let timed = [" SOLUTIONTIME=0", " SOLUTIONTIME=0.5"].map(zone);
    fs::write(path("timed.dat"), format!("{head}{}", timed.concat())).unwrap();
    fs::write(path("sparse.csv"), "time_s,Azimuth_deg\n0,0\n1,170\n2,340\n").unwrap();
    fs::write(path("turns.csv"), "time_s,Azimuth [grad]\n0,0\n1,1\n").unwrap();
    fs::write(path("short.csv"), "time_s,Azimuth_rad\n0,0\n0.2,1\n").unwrap();
    let cases = [
        ("bare.dat", "short.csv", "does not tell the times"),
        ("timed.dat", "sparse.csv", "a row each 170°"),
        ("timed.dat", "turns.csv", "in grad"),
        ("timed.dat", "short.csv", "instant at 0.5 s, beyond the azimuths"),
    ];
    for (fields, azimuths, expected) in cases {
        let request = Request::of(path(fields)).with("wind-speed", "5").with("diameter", "0.58");
        let request = request.with("hub", "0,0,0").with("azimuths", &text(azimuths));
        let error = run("phases", &request).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn what_has_no_modes_names_the_file_and_the_fix() {
    let folder = tempfile::tempdir().unwrap();
    let (fields, azimuths) = tunnel(folder.path());
    let request = Request::of(&fields).with("azimuths", azimuths.to_str().unwrap());
    let refused = run("modes", &request.clone().with("from", "2.02")).unwrap_err();
    let help = miette::Diagnostic::help(&refused).map(|help| help.to_string()).unwrap_or_default();
    let message = refused.to_string();
    assert!(message.contains("tunnel.nc") && message.contains("are too few"), "{message}");
    assert!(help.contains("output.plane_interval"), "{help}");
    let high = run("modes", &request.with("excitation-hz", "-1")).unwrap_err().to_string();
    assert!(high.contains("above 0"), "{high}");
}
