//! Individual pitch control whose turbine file leaves its azimuth offset out works with the one that is found
//! before the runs.

mod small;

use basis::records::{PitchResponse, Summary};
use control::baseline::IndividualPitch;
use farm::assemble::{AssemblyError, TurbineModel, controller};
use farm::case::Control;
use farm::plan::PRESCRIBED_STEP;
use small::written;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use study::{
    Estimate, IdentificationProgress, Observer, OffsetQuestion, Outcome, Prepared, StudyOptions,
    azimuth_offset,
};
use tempfile::TempDir;

const MINE: &str = r#"model = "mine.toml""#;
/// Individual pitch control, but for its azimuth offset.
const CONTROL: &str =
    r#"integral = 1e-9, proportional = 0.0, limit_deg = 2.0, ramp = [5.0, 7.0], floor = "none""#;

/// A folder with a case of two turbines, whose file has the `keys` of individual pitch control beside those
/// of [`CONTROL`].
fn folder(keys: &str) -> TempDir {
    let runs = r#"[[run]]
name = "alone"
control.T2 = { kind = "absent" }
[[run]]
name = "both"
"#;
    let folder = written(&small::case("damped", "", [10.0, 60.0], &[MINE, MINE], runs));
    let text = formats::library::text("nrel-5mw").expect("a turbine of the library");
    let line = "speed_filter_corner = 1.5708";
    assert!(text.contains(line));
    let damped = format!("individual_pitch = {{ {keys}{CONTROL} }}\n{line}");
    let text = text.replacen(line, &damped, 1);
    fs::write(folder.path().join("mine.toml"), text).expect("a file");
    folder
}

/// What was reported.
#[derive(Default)]
struct Reports {
    n_identifications: usize,
    moved: bool,
    found: Vec<(String, PitchResponse, bool)>,
}

impl Observer for Reports {
    fn estimated(&mut self, estimate: &Estimate) {
        self.n_identifications = estimate.n_identifications;
    }

    fn identifying(&mut self, _: &IdentificationProgress) {
        self.moved = true;
    }

    fn identified(&mut self, turbine: &str, response: &PitchResponse, again: bool) {
        self.found.push((turbine.to_owned(), *response, again));
    }
}

fn run(folder: &Path, resume: bool, overrides: &[&str]) -> (Reports, Vec<Summary>) {
    let overrides = overrides.iter().map(|&text| text.to_owned()).collect();
    let options = StudyOptions { overrides, resume, ..small::options(folder) };
    let mut reports = Reports::default();
    let outcome =
        study::run(&options, &AtomicBool::new(false), &mut reports).expect("a sound case");
    let Outcome::Done { summaries, .. } = outcome else { panic!("{outcome:?}") };
    (reports, summaries)
}

/// With which azimuth offset the turbines of `summaries` worked, those of all runs (rad).
fn offsets(summaries: &[Summary]) -> Vec<Option<f64>> {
    let turbines = summaries.iter().flat_map(|summary| &summary.turbines);
    turbines.map(|turbine| turbine.individual_pitch_offset).collect()
}

#[test]
fn what_is_left_out_is_identified_once_reported_and_taken_again_with_the_same_bits() {
    let folder = folder("");
    let (first, summaries) = run(folder.path(), false, &[]);
    // Once for two turbines alike and both runs.
    assert_eq!((first.n_identifications, first.found.len()), (1, 1));
    assert!(first.moved);
    let (turbine, response, again) = &first.found[0];
    assert!(turbine == "T1" && !again);
    let PitchResponse::IndividualPitch { azimuth_offset } = *response else {
        panic!("{response:?}")
    };
    assert_eq!(offsets(&summaries), [Some(azimuth_offset); 3]);
    assert!(summaries.iter().all(|run| run.turbines[0].pitch_response.is_none()));

    let series = folder.path().join("out/both/series.csv");
    let before = fs::read(&series).expect("a series");
    fs::remove_dir_all(folder.path().join("out/both")).expect("a run");
    let (second, summaries) = run(folder.path(), true, &[]);
    assert_eq!((second.n_identifications, second.moved), (0, false));
    assert_eq!(second.found, [("T1".to_owned(), *response, true)]);
    assert_eq!(offsets(&summaries), [Some(azimuth_offset); 3]);
    let after = fs::read(&series).expect("a series");
    assert!(before == after, "a study that takes what was identified has other bits");
}

#[test]
fn what_is_given_is_not_identified() {
    let folder = folder("azimuth_offset_deg = 20.0, ");
    let (reports, summaries) = run(folder.path(), false, &[]);
    assert_eq!((reports.n_identifications, reports.found.len()), (0, 0));
    assert_eq!(offsets(&summaries), [Some(20f64.to_radians()); 3]);
}

/// The offset belongs to the turbine: a quicker helix tells the same within a degree. Pitch that is held over
/// longer steps lags by half of what they are longer.
#[test]
fn the_command_tells_what_the_study_finds() {
    const STEP: f64 = 0.1;
    let folder = folder("");
    let question = OffsetQuestion {
        model: folder.path().join("mine.toml").display().to_string(),
        wind_speed: 9.0,
        strouhal: 0.4,
        flexible: false,
    };
    let alone = azimuth_offset(&question).expect("a sound turbine").decoupling.azimuth_offset;
    let (reports, summaries) = run(folder.path(), false, &[&format!("flow.step={STEP}")]);
    let (_, PitchResponse::IndividualPitch { azimuth_offset: found }, _) = reports.found[0] else {
        panic!("{:?}", reports.found)
    };
    let rotor_speed = summaries[0].turbines[0].rotor_speed.mean;
    let lag = 0.5 * (STEP - PRESCRIBED_STEP) * rotor_speed;
    assert!((found - alone).abs() < lag + 2f64.to_radians(), "{found}, alone {alone}, lag {lag}");
}

#[test]
fn control_without_its_offset_is_not_put_together() {
    let folder = folder("");
    let setup = Prepared::read(&folder.path().join("case.toml"), &[]).expect("a sound case");
    let mut model = setup.models[0].clone();
    let built =
        |model: &TurbineModel| controller(&Control::baseline(), model, &setup.case, &setup.plan);
    let Err(error) = built(&model) else { panic!("nobody found the offset") };
    assert!(matches!(error, AssemblyError::NoIndividualPitchOffset), "{error:?}");
    assert!(error.to_string().contains("azimuth_offset_deg"), "{error}");
    let control = model.constants.individual_pitch.expect("it was asked for");
    let given = IndividualPitch { azimuth_offset: Some(0.3), ..control };
    model.constants.individual_pitch = Some(given);
    assert!(built(&model).is_ok());
    assert!(built(&model.without_individual_pitch()).is_ok());
}
