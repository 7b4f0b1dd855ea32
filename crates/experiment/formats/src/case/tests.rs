//! What the case file's users write is read, written back and compared; `errors` has what is refused.

mod errors;
mod lidar;
mod numbers;
mod refinement;

use super::*;
use control::meandering::{Followed, Leader, MeanderingSettings, Reference};
use control::phase_sync::{PhaseNoise, PhaseSyncSettings};
use farm::case::{Control, Ground, Method, Position, Sense, Sides};
use flow::lattice::{Stencil, SubgridModel};
use proptest::prelude::*;
use std::fs;

const SMALL: &str = r#"
name = "small"
[wind]
speed = 9
turbulence_intensity = 0.05
[time]
spin_up = 300
duration = 900.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0, 0.0]
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [5.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
compare_with = "baseline"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

fn small(overrides: &[&str]) -> Result<Case, CaseError> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse("small.toml", SMALL, &overrides)
}

#[test]
fn a_small_case_gets_the_documented_defaults() {
    let case = small(&[]).unwrap();
    assert_eq!(case.wind.length_scale, None);
    assert_eq!(case.wind.seed, 1);
    assert_eq!(case.flow.domain().cells_per_diameter, 16.0);
    let domain = case.flow.domain();
    assert_eq!((domain.ground, domain.sides), (Ground::Slip, Sides::Periodic));
    assert_eq!((case.flow.step, case.flow.threads), (None, None));
    assert_eq!(case.output.checkpoint_interval, 300.0);
    assert_eq!(case.runs[0].control, [Control::baseline(), Control::baseline()]);
    let helix = &case.runs[1].control[0];
    assert_eq!(helix.helix(), Some((Sense::CounterClockwise, 0.25)));
    assert_eq!(helix.values().angle("amplitude_deg"), 4f64.to_radians());
    assert_eq!(helix.values().number("start"), 0.0);
}

#[test]
fn helix_and_pulse_may_stop() {
    for kind in ["\"helix\", sense = \"cw\"", "\"pulse\""] {
        let control = format!("kind = {kind}, amplitude_deg = 4, strouhal = 0.25, stop = 300.5");
        let case = small(&[&format!("run.helix.control.T1={{ {control} }}")]).unwrap();
        let stop = case.runs[1].control[0].values().optional_number("stop");
        assert_eq!(stop, Some(300.5), "{kind}");
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    }
    let plain = write(&small(&[]).unwrap());
    assert!(!plain.contains("stop"), "{plain}");
}

/// The meandering control of a small case that says `keys` beside factor and amplitude, after it was written
/// and read.
fn meandering(keys: &str) -> MeanderingSettings {
    let control = format!("kind = \"meandering\", factor = 1.5, amplitude_deg = 4{keys}");
    let case = small(&[&format!("run.helix.control.T1={{ {control} }}")]);
    let case = case.unwrap_or_else(|error| panic!("{}", error.to_lines()));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case, "{keys}");
    MeanderingSettings::of(&case.runs[1].control[0]).expect("meandering")
}

#[test]
fn meandering_needs_little_to_be_said() {
    let usual = meandering("");
    assert_eq!((usual.factor, usual.amplitude, usual.offset), (1.5, 4f64.to_radians(), 0.0));
    assert_eq!(usual.strouhal, [0.15, 0.3]);
    assert_eq!((usual.sense, usual.leader), (Sense::Clockwise, Leader::Both));
    assert_eq!((usual.followed, usual.reference), (Followed::Wake, Reference::Observed));
    assert_eq!((usual.bandwidth, usual.decoupling, usual.start), (0.01, None, 0.0));

    let learned = meandering(", reference = \"learned\", followed = \"load\", leader = \"yaw\"");
    assert_eq!(learned.reference, Reference::Learned { duration: 300.0 });
    assert_eq!((learned.followed, learned.leader), (Followed::Load, Leader::Yaw));

    let given = meandering(
        ", reference = \"given\", reference_tilt_mnm = 7.77, reference_yaw_mnm = 10.87, \
         azimuth_offset_deg = 38.4, delay = 0.99, moment_per_degree_mnm = 4.2, sense = \"ccw\"",
    );
    assert_eq!(given.reference, Reference::Given { tilt: 7.77e6, yaw: 10.87e6 });
    let decoupling = given.decoupling.unwrap();
    assert_eq!((decoupling.azimuth_offset, decoupling.delay), (38.4f64.to_radians(), 0.99));
    assert!((decoupling.gain * 1f64.to_radians() - 4.2e6).abs() < 1e-3);
    assert_eq!(given.sense, Sense::CounterClockwise);
}

/// The phase synchronisation of T2 in a small case that says `keys` beside the needed ones, after it was
/// written and read.
fn phase_sync(keys: &str) -> PhaseSyncSettings {
    let control = format!("kind = \"phase-sync\", offset_deg = 90, amplitude_deg = 4{keys}");
    let case = small(&[&format!("run.helix.control.T2={{ {control} }}")]);
    let case = case.unwrap_or_else(|error| panic!("{}", error.to_lines()));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case, "{keys}");
    PhaseSyncSettings::of(&case.runs[1].control[1]).expect("phase-sync")
}

#[test]
fn noise_of_a_phase_estimator_is_its_own_unless_given() {
    assert_eq!(phase_sync("").noise, PhaseNoise::default());
    let robust =
        phase_sync(", measurement_noise_1s_mnm = 0.3141, process_noise_amplitude = 2.5e-4");
    assert_eq!(robust.noise.measurement, Some(0.3141 * 1e6));
    assert_eq!(robust.noise.process_noise_amplitude, Some(2.5e-4));
    assert_eq!(robust.noise.process_noise_phase, None);
    let published = phase_sync(", estimator = \"published\", process_noise_phase = 3e-4");
    let expected = PhaseNoise { process_noise_phase: Some(3e-4), ..PhaseNoise::default() };
    assert_eq!(published.noise, expected);
}

#[test]
fn the_azimuth_offset_of_a_synchronised_turbine_is_identified_unless_given() {
    assert_eq!(phase_sync("").azimuth_offset, None);
    assert_eq!(phase_sync(", azimuth_offset_deg = 0").azimuth_offset, Some(0.0));
    assert_eq!(phase_sync(", azimuth_offset_deg = 17").azimuth_offset, Some(17f64.to_radians()));
    // What only monitors pitches nothing; its records are those of a turbine that was given none.
    let monitoring = |keys: &str| {
        let control = "kind = \"phase-sync\", offset_deg = 90, amplitude_deg = 0";
        small(&[&format!("run.helix.control.T2={{ {control}{keys} }}")]).unwrap()
    };
    let case = monitoring("");
    let sync = PhaseSyncSettings::of(&case.runs[1].control[1]).expect("phase-sync");
    assert_eq!(sync.azimuth_offset, Some(0.0));
    assert_eq!(case, monitoring(", azimuth_offset_deg = 0"));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    // An open helix is turned by nothing that it does not ask for.
    let case = small(&[]).unwrap();
    assert_eq!(case.runs[1].control[0].values().number("azimuth_offset_deg"), 0.0);
}

#[test]
fn stall_is_dynamic_where_the_wind_is_prescribed_unless_the_case_says_otherwise() {
    let of = |overrides: &[&str]| {
        let case = small(overrides).unwrap();
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
        [0, 1].map(|index: usize| case.turbines[index].dynamic_stall)
    };
    assert_eq!(of(&[]), [false, false]);
    assert_eq!(of(&["flow.solver=turbulence"]), [true, true]);
    assert_eq!(of(&["turbine.T1.stall=dynamic"]), [true, false]);
    assert_eq!(of(&["flow.solver=uniform", "turbine.T2.stall=steady"]), [true, false]);
}

#[test]
fn the_stride_of_volumes_goes_with_their_interval() {
    let of = |overrides: &[&str]| {
        let case = small(overrides).unwrap();
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
        (case.output.volume_interval, case.output.volume_stride)
    };
    assert_eq!(of(&[]), (None, 2));
    assert_eq!(of(&["output.volume_interval=60"]), (Some(60.0), 2));
    assert_eq!(of(&["output.volume_interval=60", "output.volume_stride=1"]), (Some(60.0), 1));
}

#[test]
fn a_turbine_may_name_the_input_of_its_controller() {
    let case = small(&["turbine.T2.discon=rosco/DISCON.IN"]).unwrap();
    let requested: Vec<Option<&str>> = case.turbines.iter().map(|t| t.discon.as_deref()).collect();
    assert_eq!(requested, [None, Some("rosco/DISCON.IN")]);
    // Of one model, and yet not alike.
    assert_eq!(case.turbines[0].machine(), "iea-15mw");
    assert_ne!(case.turbines[0].machine(), case.turbines[1].machine());
    let written = write(&case);
    assert_eq!(parse("again", &written, &[]).unwrap(), case);
    let plain = write(&small(&[]).unwrap());
    assert!(!plain.contains("discon"), "{plain}");
    assert_ne!(fingerprint(&written, "helix"), fingerprint(&plain, "helix"));
    let lines = small(&["turbine.T2.discon=3"]).unwrap_err().to_lines();
    assert!(lines.contains("`turbine.T2.discon` must be text in quotes"), "{lines}");
}

#[test]
fn a_turbine_may_have_a_torque_of_its_own() {
    let case = small(&["turbine.T2.torque_gain=2.1e6"]).unwrap();
    assert_eq!(case.turbines[0].torque_gain, None);
    assert_eq!(case.turbines[1].torque_gain, Some(2.1e6));
    assert_ne!(case.turbines[0].machine(), case.turbines[1].machine());
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    let both = ["turbine.T2.torque_gain=2.1e6", "turbine.T2.discon=DISCON.IN"];
    let lines = small(&both).unwrap_err().to_lines();
    assert!(lines.contains("the input file of the controller has the gain"), "{lines}");
}

/// Whether the file at `path` is of a precursor, not of a study.
fn is_precursor(path: &Path) -> bool {
    path.file_name().unwrap().to_string_lossy().starts_with("precursor-")
}

#[test]
fn every_shipped_case_reads_and_reads_back() {
    for entry in fs::read_dir(root().join("cases")).unwrap() {
        let path = entry.unwrap().path();
        // Beside them stand control laws.
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        if is_precursor(&path) {
            let file = read_precursor(&path, &[]).unwrap_or_else(|e| panic!("{}", e.to_lines()));
            let again = parse_precursor(&path, &file.text, &[]).unwrap();
            assert_eq!(again, file, "{path:?}");
            continue;
        }
        if crate::fuzz::asks_for_what_studies_write(&fs::read_to_string(&path).unwrap()) {
            continue;
        }
        let files = read_all(&path, &[]).unwrap_or_else(|error| panic!("{}", error.to_lines()));
        for file in files.files {
            assert_eq!(parse("again", &write(&file.case), &[]).unwrap(), file.case, "{path:?}");
        }
    }
}

#[test]
fn overrides_reach_every_key() {
    let case = small(&[
        "wind.speed = 8",
        "flow.sides=slip",
        "flow.ground={ roughness_length = 0.001 }",
        "flow.velocity_set=d3q27",
        "flow.smagorinsky_constant=0.1",
        "turbine.0.model=iea-22mw",
        "turbine.T2.position_diameters=[7, 0]",
        "run.helix.control.T1.amplitude_deg=3",
        "run.baseline.control.T2={ kind = \"pulse\", amplitude_deg = 2, strouhal = 0.3 }",
    ])
    .unwrap();
    assert_eq!(case.wind.speed, 8.0);
    assert_eq!(case.flow.domain().sides, Sides::Slip);
    assert_eq!(case.flow.domain().ground, Ground::Rough { roughness_length: 0.001 });
    let method =
        Method { stencil: Stencil::D3Q27, subgrid: SubgridModel::Smagorinsky, constant: Some(0.1) };
    assert_eq!(case.flow.domain().method, method);
    assert_eq!(case.turbines[0].model, "iea-22mw");
    assert_eq!(case.turbines[1].position, Position::Diameters([7.0, 0.0]));
    let helix = &case.runs[1].control[0];
    assert_eq!(helix.values().angle("amplitude_deg"), 3f64.to_radians());
    assert!(case.runs[0].control[1].is(&control::pulse::PULSE));
}

#[test]
fn the_model_of_eddies_is_read_and_refused_where_it_does_not_fit() {
    let case = small(&["flow.subgrid=amd", "flow.subgrid_constant=0.2"]).unwrap();
    let method = case.flow.domain().method;
    assert_eq!((method.subgrid, method.constant), (SubgridModel::MinimumDissipation, Some(0.2)));
    assert_eq!(small(&[]).unwrap().flow.domain().method, Method::default());
    for (overrides, words) in [
        (
            &["flow.subgrid=wale", "flow.smagorinsky_constant=0.1"][..],
            [
                "smagorinsky_constant` has no use where flow.subgrid is \"wale\"",
                "give flow.subgrid_constant",
            ],
        ),
        (
            &["flow.subgrid_constant=0.1"],
            [
                "subgrid_constant` has no use where flow.subgrid is \"smagorinsky\"",
                "give flow.smagorinsky_constant",
            ],
        ),
        (
            &["flow.subgrid=vreman", "flow.refinement=[{ upstream_diameters = 2.0 }]"],
            ["needs the wind of neighbours", "leave out [[flow.refinement]]"],
        ),
        (&["flow.subgrid=wall"], ["`flow.subgrid`", "wale"]),
    ] {
        let lines = small(overrides).unwrap_err().to_lines();
        assert!(words.iter().all(|word| lines.contains(word)), "{overrides:?}: {lines}");
    }
}

#[test]
fn the_example_of_the_reference_page_reads() {
    let page = reference();
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    parse("docs/case-file.md", example, &[]).unwrap_or_else(|error| panic!("{}", error.to_lines()));
}

#[test]
fn every_default_of_the_table_is_what_the_reader_uses() {
    // Writing out a case writes every key; taking the keys with defaults away again must change nothing.
    let case = small(&[]).unwrap();
    let written = write(&case);
    for table in [&keys::WIND, keys::flow(case.flow.solver), &keys::OUTPUT] {
        for key in table.keys {
            let basis::keys::LeftOut::Value(default) = key.left_out else { continue };
            let stated =
                format!("{}.{}={default}", table.heading.trim_matches(['[', ']']), key.name);
            assert_eq!(
                parse("written", &written, std::slice::from_ref(&stated)).unwrap(),
                case,
                "{stated}"
            );
        }
    }
}

#[test]
fn a_fingerprint_is_of_what_decides_the_bits() {
    let of = |overrides: &[&str]| fingerprint(&write(&small(overrides).unwrap()), "helix");
    let plain = of(&[]);
    assert_eq!(plain, fingerprint(SMALL, "helix"));
    for harmless in [
        "flow.threads=3",
        "description=words",
        "output.checkpoint_interval=9",
        "run.baseline.control.T1={ kind = \"absent\" }",
    ] {
        assert_eq!(of(&[harmless]), plain, "{harmless}");
    }
    for decisive in [
        "wind.seed=2",
        "run.helix.control.T1.phase_deg=1",
        "time.duration=901",
        "output.plane_interval=5",
    ] {
        assert_ne!(of(&[decisive]), plain, "{decisive}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}") {
        let _ = parse("random", &text, std::slice::from_ref(&text));
    }

    #[test]
    fn no_damage_makes_the_reader_panic(
        cuts in prop::collection::vec((0usize..800, 0usize..12, "[\\[\\]{}=.,\"'#\n a-z0-9_-]{0,6}"), 1..4),
    ) {
        let mut text = SMALL.to_owned();
        for (start, length, insert) in cuts {
            let start = start.min(text.len());
            text.replace_range(start..(start + length).min(text.len()), &insert);
        }
        if let Err(error) = parse("damaged", &text, &[]) {
            prop_assert!(!error.to_lines().is_empty());
        }
    }

    #[test]
    fn any_case_in_range_reads_back_as_written(
        speed in 0.1..40.0, seed in 0..i64::MAX as u64, amplitude in 0.0..10.0, phase in -360.0..360.0,
        roughness in 1e-6..5.0, x in 1.0..500.0, threads in prop::option::of(1usize..1024),
    ) {
        let mut case = small(&[
            &format!("wind.speed={speed:?}"), &format!("wind.seed={seed}"),
            &format!("run.helix.control.T1.amplitude_deg={amplitude:?}"),
            &format!("run.helix.control.T1.phase_deg={phase:?}"),
            &format!("flow.ground={{ roughness_length = {roughness:?} }}"),
            &format!("turbine.T2.position_diameters=[-{x:?}, 0]"),
        ]).unwrap();
        case.flow.threads = threads;
        case.description = Some("a \"quoted\"\tline \\ with ü".to_owned());
        prop_assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    }
}
