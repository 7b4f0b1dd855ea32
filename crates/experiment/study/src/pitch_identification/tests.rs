//! What an identification needs, and what a run is given of it.

use super::*;
use crate::{OffsetQuestion, Silent, azimuth_offset};
use control::phase_sync::{PhaseNoise, PhaseSyncSettings};
use estimation::helix::{Adaptation, Form, HelixOptions, Measurement, Wake};
use farm::pitch_response::OwnPitch;
use formats::records::{read_pitch_responses, write_pitch_responses};

/// A case whose T2 joins the helix of T1 with `keys` beside the needed ones, under `overrides`.
fn setup(keys: &str, overrides: &[&str]) -> Prepared {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("case.toml");
    let text = format!(
        r#"
name = "joined"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 10.0
duration = 60.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "joined"
control.T1 = {{ kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }}
control.T2 = {{ kind = "phase-sync", offset_deg = 90.0, amplitude_deg = 2.0{keys} }}
"#
    );
    std::fs::write(&path, text).expect("a file");
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    Prepared::read(&path, &overrides).expect("a sound case")
}

fn key(keys: &str) -> String {
    key_of(&setup(keys, &[]))
}

fn key_of(setup: &Prepared) -> String {
    let control = &setup.case.runs[0].control[1];
    let needed = control.kind().identification(control).expect("a calibration");
    setup.key(1, &Needed::Control(needed))
}

/// How T2 of `setup` is set to join the helix.
fn sync_of(setup: &Prepared) -> PhaseSyncSettings {
    PhaseSyncSettings::of(&setup.case.runs[0].control[1]).expect("phase-sync")
}

/// Pitch response given to T2 of `setup`, and the progress of its identification.
fn identified_for(setup: &Prepared) -> (OwnPitch, Vec<f64>) {
    let (case, plan, model) = (&setup.case, &setup.plan, &setup.models[1]);
    let mut shares = Vec::new();
    let mut reported = |share: f64| {
        shares.push(share);
        ControlFlow::Continue(())
    };
    let found = own_pitch(case, plan, model, 1, &sync_of(setup), &mut reported);
    (found.expect("a sound turbine"), shares)
}

#[test]
fn noise_that_is_given_is_another_calibration_and_none_leaves_no_trace() {
    assert_eq!(trace(&PhaseNoise::default()), "");
    let usual = key("");
    assert_eq!(key(", start = 20.0"), usual);
    let given = key(", measurement_noise_1s_mnm = 0.5");
    assert_ne!(given, usual);
    assert_ne!(key(", measurement_noise_1s_mnm = 0.6"), given);
    assert_ne!(key(", process_noise_amplitude = 0.5"), given);
}

#[test]
fn another_velocity_set_or_constant_is_another_calibration() {
    let key = |more: &[&str]| {
        let resolved = ["flow.solver=lattice", "flow.cells_per_diameter=8", "flow.step=0.05"];
        key_of(&setup("", &[&resolved[..], more].concat()))
    };
    let usual = key(&[]);
    assert_eq!(key(&["flow.velocity_set=d3q19"]), usual);
    assert_ne!(key(&["flow.velocity_set=d3q27"]), usual);
    assert_ne!(key(&["flow.smagorinsky_constant=0.1"]), usual);
}

#[test]
fn what_is_given_is_not_identified_and_a_turbine_that_monitors_needs_nothing() {
    let asks = |keys: &str, overrides: &[&str]| {
        let setup = setup(keys, overrides);
        let control = &setup.case.runs[0].control[1];
        control.kind().identification(control).is_some()
    };
    assert!(asks("", &[]) && asks(", azimuth_offset_deg = 10", &[]));
    assert!(asks(", estimator = \"published\"", &[]));
    assert!(!asks(", estimator = \"published\", azimuth_offset_deg = 10", &[]));
    for keys in ["", ", estimator = \"published\""] {
        let monitoring = setup(keys, &["run.joined.control.T2.amplitude_deg=0"]);
        let control = &monitoring.case.runs[0].control[1];
        assert!(control.kind().identification(control).is_none());
        assert_eq!(sync_of(&monitoring).azimuth_offset, Some(0.0));
        assert_eq!(control.kind().pitch_response(control), None);
    }
    let [found, none, ten] = ["", ", azimuth_offset_deg = 0", ", azimuth_offset_deg = 10"].map(key);
    assert!(found != none && found != ten && none != ten);
}

/// `turbine offset` in the wind and at the rate of the identification: the same turbine, the same two
/// helices.
#[test]
fn the_offset_is_the_turbines_whatever_moves_the_air() {
    let question = OffsetQuestion {
        model: "nrel-5mw".to_owned(),
        wind_speed: 6.75,
        strouhal: 0.25 / 0.75,
        flexible: false,
    };
    let alone = azimuth_offset(&question).expect("a sound turbine").decoupling.azimuth_offset;
    let published = ", estimator = \"published\"";
    let prescribed = setup(published, &["turbine.T2.structure=rigid", "flow.step=0.02"]);
    let (found, _) = identified_for(&prescribed);
    assert!((found.azimuth_offset - alone).abs() < 1e-3, "{found:?}, alone {alone}");
    assert_eq!(found.calibration, None);

    let resolved = [
        "turbine.T2.structure=rigid",
        "turbine.T2.stall=dynamic",
        "flow.solver=lattice",
        "flow.cells_per_diameter=8",
        "flow.step=0.05",
    ];
    let resolved = setup(published, &resolved);
    let (found, _) = identified_for(&resolved);
    // Torque is controlled otherwise in resolved flow, so that the rotor turns a little slower or faster.
    assert!((found.azimuth_offset - alone).abs() < 5f64.to_radians(), "{found:?}, alone {alone}");
    // Its steps are those of prescribed wind, not the lattice's.
    let steps = |setup: &Prepared| {
        let (case, plan, model) = (&setup.case, &setup.plan, &setup.models[1]);
        own_pitch_cost(case, plan, model, &sync_of(setup)).n_steps
    };
    assert_eq!(steps(&resolved), steps(&prescribed));
}

#[test]
fn both_parts_of_an_identification_move_its_progress() {
    let (found, shares) = identified_for(&setup("", &["turbine.T2.structure=rigid"]));
    assert!(found.calibration.is_some());
    assert!(shares.windows(2).all(|pair| pair[0] < pair[1]), "{shares:?}");
    let [first, last] = [shares[0], shares[shares.len() - 1]];
    assert!(first > 0.0 && (last - 1.0).abs() < 1e-12, "{first} to {last}");
}

#[test]
fn a_resumed_study_is_given_the_same_to_the_last_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    // How many identifications were made, and how T2 was set to join the helix.
    let reported = |keys: &str, resume: bool| {
        let mut setup = setup(keys, &["turbine.T2.structure=rigid"]);
        let known = if resume {
            read_pitch_responses(folder.path()).expect("sound records")
        } else {
            Vec::new()
        };
        let identifications = setup.identifications(&[0], known);
        let n_identifications = identifications.costs(&mut BTreeSet::new()).len();
        let keep = &mut |found: &[_]| Ok(write_pitch_responses(folder.path(), found)?);
        let ended = setup.calibrate(identifications, keep, &AtomicBool::new(false), &mut Silent);
        assert!(ended.expect("a sound turbine").is_continue());
        (n_identifications, setup.case.runs[0].control[1].clone())
    };
    let (n_identifications, joined) = reported("", false);
    let Some(PitchResponse::Estimator { azimuth_offset, transformation_offset, .. }) =
        joined.kind().pitch_response(&joined)
    else {
        panic!("{joined:?}")
    };
    let found = transformation_offset.expect("an azimuth offset");
    assert!(n_identifications == 1 && found != azimuth_offset, "{joined:?}");
    assert_eq!(reported("", true), (0, joined));

    let (n_identifications, published) = reported(", estimator = \"published\"", true);
    let response = PitchResponse::Transformation { azimuth_offset: found };
    assert_eq!(
        (n_identifications, published.kind().pitch_response(&published)),
        (1, Some(response))
    );
    assert_eq!(reported(", estimator = \"published\"", true), (0, published));

    let (_, given) = reported(", azimuth_offset_deg = 10", true);
    let given = PhaseSyncSettings::of(&given).expect("phase-sync");
    assert_eq!(given.azimuth_offset, Some(10f64.to_radians()));
}

#[test]
fn the_estimator_of_a_run_assumes_the_noise_that_is_given() {
    let options = |keys: &str| -> HelixOptions {
        let setup = setup(&format!("{keys}, azimuth_offset_deg = 0"), &[]);
        let control = &setup.case.runs[0].control[1];
        let given = PhaseSyncSettings::of(control).expect("phase-sync");
        given.estimator_options(setup.case.flow.solver.resolves_induction)
    };
    let usual = options("");
    let given = options(", measurement_noise_1s_mnm = 0.5, process_noise_amplitude = 3e-3");
    assert_eq!(given.noise.measurement, Measurement::Moment(5e5));
    assert_eq!((given.noise.amplitude, given.noise.phase), (3e-3, usual.noise.phase));
    assert_eq!(HelixOptions { noise: usual.noise, ..given }, usual);
    let published = options(", estimator = \"published\", process_noise_phase = 3e-4");
    let own = HelixOptions::published().noise;
    assert_eq!((published.noise.phase, published.noise.amplitude), (3e-4, own.amplitude));
    assert_eq!(published.noise.measurement, own.measurement);
}

#[test]
fn what_an_estimator_can_do_can_be_chosen() {
    let options = |keys: &str| -> HelixOptions {
        let setup = setup(&format!("{keys}, azimuth_offset_deg = 17"), &[]);
        let control = &setup.case.runs[0].control[1];
        let given = PhaseSyncSettings::of(control).expect("phase-sync");
        given.estimator_options(true)
    };
    assert_eq!(options(""), HelixOptions::default());
    assert_eq!(options(", process_noise_rate = 1e-9").rate, Some(1e-9));
    assert_eq!(options(", process_noise_mean_wind = 0.01").noise.mean_wind, 0.01);
    assert_eq!(options(", adaptation = \"none\"").adaptation, None);
    let wave = options(", adaptation = \"noise-and-wave\"").adaptation.expect("adapts");
    assert_eq!(wave, Adaptation { wave: true, ..Adaptation::USUAL });
    let slower = options(", wake_time_factor = 0.5").rotor.wake;
    assert_eq!(slower, Wake::InAir { time_factor: 0.5, share: 0.6 });
    let two_constant = options(", dynamic_inflow = \"two-constant\"").rotor.wake;
    assert_eq!(two_constant, Wake::TwoConstantWithBlades);
    let published = |keys: &str| options(&format!(", estimator = \"published\"{keys}"));
    assert_eq!(published(""), HelixOptions::published());
    assert_eq!(published(", amplitudes = \"separate\"").form, Form::SeparateAmplitudes);
    assert_eq!(published(", adaptation = \"noise\"").adaptation, Some(Adaptation::USUAL));
    let offset = options(", estimator = \"published-with-offset\"");
    assert_eq!(offset, HelixOptions::published().with_azimuth_offset(17f64.to_radians()));
}
