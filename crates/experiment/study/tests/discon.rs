//! A turbine whose case names ROSCO's input file runs under the constants in that file, and no other does.

mod small;

use small::{NREL_5MW, options};
use std::fs;
use std::path::Path;
use study::{Outcome, Prepared, StudyError, StudyOptions};
use tempfile::TempDir;

fn case() -> String {
    let controlled = r#"model = "nrel-5mw"
discon = "control/DISCON.IN""#;
    let run = r#"[[run]]
name = "baseline"
"#;
    small::case("rosco", "", [10.0, 40.0], &[NREL_5MW, controlled], run)
}

/// ROSCO on the generator side of a gearbox of 97, with a rated speed of its own.
const DISCON: &str = "! Controller parameter input file
2           ! F_LPFType
1.57080     ! F_LPFCornerFreq
0.70000     ! F_LPFDamping
0.62830     ! F_SSCornerFreq
0.20944     ! F_WECornerFreq
0.05 0.2    ! PC_GS_angles
-0.02 -0.01 ! PC_GS_KP
-0.008 -0.004 ! PC_GS_KI
1.57        ! PC_MaxPit
0.13962     ! PC_MaxRat
116.4       ! PC_RefSpd
0.0         ! PC_FinePit
94.4        ! VS_GenEff
1           ! VS_ControlMode
1           ! VS_ConstPower
15000.      ! VS_MaxRat
48000.      ! VS_MaxTq
0.0         ! VS_MinTq
70.0        ! VS_MinOMSpd
2.5         ! VS_Rgn2K
5000000.    ! VS_RtPwr
45000.      ! VS_RtTq
-800.       ! VS_KP
-140.       ! VS_KI
7.5         ! VS_TSRopt
0           ! SS_Mode
1.0         ! SS_VSGain
0.01        ! SS_PCGain
0           ! PS_Mode
63.0        ! WE_BladeRadius
97.0        ! WE_GearboxRatio
43702538.0  ! WE_Jtot
1.225       ! WE_RhoAir
\"table.txt\" ! PerfFileName
";

const TABLE: &str = "# Pitch angle vector
-1.0 0.0 2.0
# TSR vector
7.0 8.0
# Power coefficient
0.40 0.45 0.44
0.41 0.46 0.43
# Thrust coefficient
0.70 0.72 0.65
0.75 0.80 0.70
";

/// The case with the files of its controller.
fn written(discon: &str) -> TempDir {
    let folder = small::written(&case());
    fs::create_dir(folder.path().join("control")).expect("a folder");
    fs::write(folder.path().join("control/DISCON.IN"), discon).expect("a file");
    fs::write(folder.path().join("control/table.txt"), TABLE).expect("a file");
    folder
}

fn setup(folder: &Path) -> Result<Prepared, StudyError> {
    Prepared::read(&folder.join("case.toml"), &[])
}

#[test]
fn a_turbine_runs_under_the_constants_of_its_file_alone() {
    let folder = written(DISCON);
    let setup = setup(folder.path()).expect("a sound case");
    let library = formats::library::load("nrel-5mw").expect("a turbine of the library");
    let [own, given] = [0, 1].map(|index: usize| &setup.models[index].constants);
    assert_eq!(own.rated_rotor_speed, library.controller.rated_rotor_speed);
    assert!((given.rated_rotor_speed - 116.4 / 97.0).abs() < 1e-12, "{}", given.rated_rotor_speed);
    assert!((given.rated_torque - 97.0 * 45_000.0).abs() < 1e-6, "{}", given.rated_torque);
    assert_eq!(given.optimal_tip_speed_ratio, 7.5);
    let read = formats::rosco::read(&folder.path().join("control/DISCON.IN")).expect("sound files");
    assert_eq!(*given, read.constants);
    let estimator = given.estimator.as_ref().expect("the table is there");
    assert!((estimator.coefficients.power(7.5, 0.0) - 0.455).abs() < 1e-12);
    assert_eq!(setup.models[0].definition.name, setup.models[1].definition.name);
    assert!(!setup.warnings.iter().any(|warning| warning.message.contains("DISCON.IN")));
}

#[test]
fn what_the_file_lacks_or_does_not_fit_is_reported() {
    let folder = written(&DISCON.replace("table.txt", "none.txt").replace("63.0 ", "80.0 "));
    let given = setup(folder.path()).expect("a sound case").warnings;
    for expected in ["control/none.txt", "a rotor of 80.0 m radius"] {
        assert!(
            given.iter().any(|warning| warning.message.contains(expected)),
            "{expected}: {given:?}"
        );
    }

    let folder = written(&DISCON.replace("48000.", "40000."));
    let Err(error) = setup(folder.path()) else { panic!("no such torque can be") };
    assert!(error.to_string().contains("DISCON.IN, line 18, VS_MaxTq"), "{error}");

    fs::remove_file(folder.path().join("control/DISCON.IN")).expect("a file");
    let Err(StudyError::Case(error)) = setup(folder.path()) else { panic!("no file is there") };
    let problem = &error.problems()[0];
    assert_eq!(problem.line(), 20, "{problem}");
    assert!(problem.to_string().contains("T2 has no controller"), "{problem}");
}

/// The records keep both texts; a run that was made with others is not gone on with.
#[test]
fn other_texts_of_file_or_table_are_noticed() {
    let folder = written(DISCON);
    let output = folder.path().join("out");
    let go = |resume| small::run(&StudyOptions { resume, ..options(folder.path()) });
    let first = go(false);
    assert!(matches!(first, Ok(Outcome::Done { .. })), "{first:?}");
    let manifest = fs::read_to_string(output.join("baseline/manifest.json")).expect("a manifest");
    assert!(manifest.contains("VS_Rgn2K") && manifest.contains("TSR vector"), "{manifest}");
    let again = go(true);
    assert!(matches!(again, Ok(Outcome::Done { .. })), "{again:?}");

    for (name, sound, other) in [
        ("control/DISCON.IN", DISCON, DISCON.replace("2.5 ", "2.6 ")),
        ("control/table.txt", TABLE, TABLE.replace("0.46", "0.47")),
    ] {
        assert_ne!(sound, other);
        fs::write(folder.path().join(name), other).expect("a file");
        let outcome = go(true);
        let Err(StudyError::OtherFile { file, sha256, .. }) = outcome else {
            panic!("{outcome:?}")
        };
        assert!(file.contains("discon control/DISCON.IN"), "{name}: {file}");
        assert_eq!(sha256, Some(formats::records::sha256(sound.as_bytes())), "{name}");
        fs::write(folder.path().join(name), sound).expect("a file");
    }
    fs::remove_file(folder.path().join("control/table.txt")).expect("a file");
    let outcome = go(true);
    assert!(matches!(outcome, Err(StudyError::OtherFile { .. })), "{outcome:?}");
}
