//! Files as users have them, written here: read right, or refused with file, line, key and what was expected.

use super::*;
use crate::turbine_file;
use std::fs;
use tempfile::TempDir;

/// A made-up two-bladed turbine, each file in a style of its own: order, quotes, comments and blanks differ.
const MAIN: &str = "----- INPUT FILE -----
A small made-up machine
 1.20   AirDens   - Air density (kg/m^3)
parts\\ed.dat          EDFile    - structure, not quoted, backslash
\"parts/ad.dat\"        AeroFile  - aerodynamics
'parts/servo.dat'     ServoFile - generator
";

const ELASTODYN: &str = "----- ELASTODYN -----
title
--- DRIVETRAIN ---
 20.0   GBRatio  - Gearbox ratio (-)
 98.    GBoxEff  - (%)
 1.5D7  DTTorSpr - Fortran double
 2E4    DTTorDmp
--- CONFIGURATION ---
2       NumBl    - blades
-3.0    ShftTilt - (degrees)
-2.0    OverHang
1.0     Twr2Shft
40      TowerHt
0       TowerBsHt
21.0    TipRad
1.0     HubRad
-1.5    PreCone(1)
-1.5    PreCone(2)
1000    HubMass
500     HubIner
9000    NacMass
2e4     NacYIner
0.5     NacCMxn
0       NacCMyn
0.7     NacCMzn
12.0    GenIner
\"edblade.dat\"  BldFile1 - old name of the key
\"tower.dat\"    TwrFile
";

const ELASTODYN_BLADE: &str = "----- BLADE -----
title
  3    NBlInpSt  - stations
  0.5  BldFlDmp(1)
  0.6  BldFlDmp(2)
  0.7  BldEdDmp(1)
  1.10 AdjBlMs   - factor ! a remark
  BlFract  PitchAxis  StrcTwst  BMassDen  FlpStff  EdgStff
   (-)      (-)        (deg)     (kg/m)    (Nm^2)   (Nm^2)
   0.0      0.25       10.0      100.0     1.0E8    2.0E8
   0.5      0.25        5.0       50.0     1.0E7    2.0E7
   1.0      0.25        0.0       10.0     1.0E5    2.0E5
---- MODES ----
 0.5 BldFl1Sh(2)
 0.5 BldFl1Sh(3)
 0.0 BldFl1Sh(4)
 0.0 BldFl1Sh(5)
 0.001 BldFl1Sh(6)
 -1.0 BldFl2Sh(2)
 2.0 BldFl2Sh(3)
 0.0 BldFl2Sh(4)
 0.0 BldFl2Sh(5)
 0.0 BldFl2Sh(6)
 1.0 BldEdgSh(2)
 0.0 BldEdgSh(3)
 0.0 BldEdgSh(4)
 0.0 BldEdgSh(5)
 0.0 BldEdgSh(6)
";

const TOWER: &str = "----- TOWER -----
title
2  NTwInpSt
1.0 TwrFADmp(1)
1.0 TwrFADmp(2)
1.5 TwrSSDmp(1)
1.5 TwrSSDmp(2)
HtFract TMassDen TwFAStif TwSSStif
(-) (kg/m) (Nm^2) (Nm^2)
0.0 1000 1E10 1.1E10
1.0 500  5E9  6E9
";

fn tower() -> String {
    let modes = ["TwFAM1Sh", "TwFAM2Sh", "TwSSM1Sh", "TwSSM2Sh"];
    let lines = modes.map(|mode| {
        let rest: String = (3..7).map(|power| format!("0.0 {mode}({power})\n")).collect();
        format!("1.0 {mode}(2)\n{rest}")
    });
    format!("{TOWER}{}", lines.concat())
}

const AERODYN: &str = "----- AERODYN -----
title
11  WakeMod - a slip of the pen that is none of our business
1   InCol_Alfa
2   InCol_Cl
3   InCol_Cd
0   InCol_Cm  - no moments
2   NumAFfiles - files
\"round.dat\" AFNames - names
\"flat.dat\"
\"adblade.dat\" ADBlFile(1)
2   NumTwrNds
TwrElev TwrDiam TwrCd TwrTI !TwrTI unused
(m) (m) (-) (-)
 0.0  3.0  1.0  0.1
 40.0 2.0  1.0  0.1
END of input file
";

// Columns in another order than usual, one more at the end.
const AERODYN_BLADE: &str = "----- BLADE -----
title
3  NumBlNds
BlSpn  BlChord BlTwist  BlAFID  BlCrvAC BlSwpAC BlCrvAng BlCb
(m)    (m)     (deg)    (-)     (m)     (m)     (deg)    (-)
 0.0    1.0     10.0     1       0.0     0.0     0.0      0.0
 10.0   2.0      5.0     2      -0.1     0.05    0.0      0.0

! a remark in between
 20.0   0.5      0.0     2      -0.5     0.10    0.0      0.0
";

const ROUND: &str = "! airfoil
 0.75  Re ! in millions
 False InclUAdata
 3 NumAlf
!  Alpha  Cl  Cd
!  (deg)  (-) (-)
 -180.0  0.0  0.5
    0.0  0.0  0.5
  180.0  0.0  0.5
";

const FLAT: &str = "! airfoil
 3.0   Re
 True  InclUAdata
 -1.0  alpha0
 12.0  alpha1
 -9.0  alpha2
 6.2   C_nalpha
 1.5   Cn1
 -0.8  Cn2
 0.01  Cd0
 -0.05 Cm0
 3.0   T_f0
 6.0   T_V0
 1.7   T_p
 11.0  T_VL
 Default A1
 0.7   A2
 1.0   A5
 5 NumAlf
!  Alpha  Cl  Cd
 -180.0  0.0  0.02
    0.0  0.1  0.01
   12.0  1.4  0.02
   90.0  0.0  1.2
  180.0  0.0  0.02
";

const SERVODYN: &str = "----- SERVODYN -----
title
94.0  GenEff
\"control.in\" DLL_InFile - ROSCO
";

const DISCON: &str = "! ROSCO
2        ! VS_ControlMode - tracks
0        ! VS_ConstPower
0.05 0.1 0.2   ! PC_GS_angles - rad
-0.02 -0.015 -0.01 ! PC_GS_KP
-0.002 -0.0015 -0.001 ! PC_GS_KI
1.57     ! PC_MaxPit
0.0      ! PC_MinPit
0.1      ! PC_MaxRat
80.0     ! PC_RefSpd
0.0      ! PC_FinePit
20.0     ! VS_MinOMSpd
5000.    ! VS_MaxRat
1100.    ! VS_MaxTq
0.0      ! VS_MinTq
0.1      ! VS_Rgn2K
75000.   ! VS_RtPwr
1000.    ! VS_RtTq
-30.     ! VS_KP
-5.      ! VS_KI
7.0      ! VS_TSRopt
1.0      ! SS_VSGain
0.01     ! SS_PCGain
0.6      ! F_SSCornerFreq
1.5      ! F_LPFCornerFreq
3.14     ! PA_CornerFreq
0.7      ! PA_Damping
3.0 10.0 20.0  ! PS_WindSpeeds
0.0 0.0 0.1    ! PS_BldPitchMin
";

/// The deck, file by file.
pub(crate) fn files() -> [(&'static str, String); 10] {
    [
        ("small.fst", MAIN.into()),
        ("parts/ed.dat", ELASTODYN.into()),
        ("parts/edblade.dat", ELASTODYN_BLADE.into()),
        ("parts/tower.dat", tower()),
        ("parts/ad.dat", AERODYN.into()),
        ("parts/adblade.dat", AERODYN_BLADE.into()),
        ("parts/round.dat", ROUND.into()),
        ("parts/flat.dat", FLAT.into()),
        ("parts/servo.dat", SERVODYN.into()),
        ("parts/control.in", DISCON.into()),
    ]
}

/// Writes the deck to a folder, with one file changed, and imports it.
fn import_with(
    changed: &str,
    from: &str,
    to: &str,
) -> (TempDir, Result<Document, TurbineFileError>) {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    for (name, text) in files() {
        let text = if name == changed {
            assert!(text.contains(from), "{name} has no {from}");
            text.replacen(from, to, 1)
        } else {
            text
        };
        fs::write(folder.path().join(name), text).unwrap();
    }
    let result = import(&folder.path().join("small.fst"), &ImportOptions::default());
    (folder, result)
}

#[test]
fn a_deck_becomes_a_turbine() {
    let (_folder, document) = import_with("", "", "");
    let document = document.unwrap();
    let text = turbine_file::write(&document).text;
    let file = turbine_file::parse("small.toml", &text).unwrap();
    let definition = &file.definition;
    assert_eq!(
        (definition.name.as_str(), file.title.as_str()),
        ("small", "A small made-up machine")
    );
    assert_eq!(definition.n_blades, 2);
    assert_eq!(definition.rotor.overhang, 2.0);
    assert!((definition.rotor.hub_height - 41.0 - 2.0 * 3f64.to_radians().sin()).abs() < 1e-4);
    assert!((definition.rotor.precone.to_degrees() - 1.5).abs() < 1e-9);
    let tip = definition.blade[2];
    assert_eq!((tip.span, tip.chord, tip.prebend, tip.sweep, tip.polar), (20.0, 0.5, 0.5, 0.1, 1));
    assert_eq!(definition.polars[0].at(0.3).drag, 0.5);
    assert_eq!(definition.polars[0].reynolds_number, Some(7.5e5));
    assert!(definition.polars[0].unsteady.is_none());
    let unsteady = definition.polars[1].unsteady.as_ref().unwrap();
    assert!((unsteady.zero_lift_angle.to_degrees() + 1.0).abs() < 1e-9);
    assert_eq!(unsteady.time_constants, Some([3.0, 6.0, 1.7, 11.0]));
    assert_eq!(unsteady.indicial_amplitudes, None);
    // Mass with its factor: 1.1 × (75 + 30) × 10 kg.
    assert!((definition.blade_mass() - 1155.0).abs() < 1e-6);
    assert!((definition.blade_structure.flap_modes[0].shape(1.0) - 1.0).abs() < 1e-6);
    assert!((definition.blade_structure.flap_modes[1].damping_ratio - 0.006).abs() < 1e-12);
    assert_eq!(definition.tower.sections[1].height, 40.0);
    assert_eq!(definition.drive_train.stiffness, 1.5e7);
    // Low-speed side: torque × 20, gains × 400 and × −20, speed / 20.
    let controller = &file.controller;
    assert_eq!(controller.rated_torque, 2e4);
    assert!((controller.rated_rotor_speed - 4.0).abs() < 1e-6);
    assert_eq!(controller.torque_gains.proportional, 12_000.0);
    assert!((controller.pitch_gains[0].proportional - 0.4).abs() < 1e-9);
    assert!((controller.pitch_gains[0].pitch - 0.05).abs() < 1e-8);
    assert!((controller.minimum_pitch[2].pitch - 0.1).abs() < 1e-8);
    assert!((definition.pitch_actuator.maximum_rate - 0.1).abs() < 1e-8);
    assert!(file.sources.iter().any(|(group, source)| group == "hub" && source.contains("ed.dat")));
}

#[test]
fn a_controller_without_greedy_torque_gets_a_gain_that_fits() {
    let (_folder, document) = import_with("", "", "");
    let derived = document.unwrap().controller.unwrap();
    assert!(derived.source.contains("torque_gain by blade-element momentum"), "{}", derived.source);
    let (_folder, document) = import_with("parts/control.in", "2        ! VS_Con", "1 ! VS_Con");
    let kept = document.unwrap().controller.unwrap();
    assert!((kept.torque_gain - 0.1 * 8000.0).abs() < 1e-9);
    assert!(!kept.source.contains("torque_gain"));
}

#[test]
fn a_deck_without_controller_lacks_two_groups() {
    let (_folder, document) = import_with("parts/servo.dat", "\"control.in\"", "\"unused\"");
    let document = document.unwrap();
    let written = turbine_file::write(&document);
    assert_eq!(written.missing, ["pitch_actuator", "controller"]);
}

#[test]
fn errors_name_file_line_and_key() {
    let cases = [
        ("parts/ed.dat", "TipRad", "TopRad", "ed.dat", "TipRad: expected the key TipRad"),
        (
            "parts/ed.dat",
            "21.0    TipRad",
            "far TipRad",
            "line 15, TipRad",
            "a number, found \"far\"",
        ),
        ("parts/adblade.dat", "5.0     2 ", "5.0     7 ", "line 7, BlAFID", "1 to 2, found 7"),
        (
            "parts/adblade.dat",
            "3  NumBlNds",
            "9  NumBlNds",
            "line 3, NumBlNds",
            "9 rows below, found 3",
        ),
        ("parts/adblade.dat", "BlTwist", "BlTwost", "line 3, NumBlNds", "a column BlTwist"),
        (
            "parts/ad.dat",
            "\"flat.dat\"",
            "\"flot.dat\"",
            "line 10, AFNames",
            "the name of a file, found \"flot.dat\"",
        ),
        ("parts/ad.dat", "2   NumAFfiles", "0 NumAFfiles", "NumAFfiles", "above zero, found \"0\""),
        ("parts/flat.dat", "0.0  1.2", "0.0  oops", "line 24, Cd", "a number, found \"oops\""),
        ("parts/control.in", "-0.02 -0.015", "-0.015", "line 5, PC_GS_KP", "3 numbers"),
        ("parts/edblade.dat", "0.5 BldFl1Sh(3)", "0.7 BldFl1Sh(3)", "BldFl1Sh(2)", "add up to 1"),
        ("small.fst", "parts\\ed.dat", "parts\\id.dat", "line 4, EDFile", "the name of a file"),
    ];
    for (file, from, to, place, expected) in cases {
        let (_folder, result) = import_with(file, from, to);
        let message = result.unwrap_err().to_string();
        let name = file.rsplit('/').next().unwrap();
        assert!(message.contains(name), "{message}");
        assert!(message.contains(place) && message.contains(expected), "{message}");
    }
}

#[test]
fn a_stated_version_must_be_one_that_is_read() {
    // File, beginning of its first line above, one with a version that is read, one with another, and that.
    let cases = [
        ("small.fst", "----- INPUT", "- FAST v8.16.* INPUT", "- OPENFAST v9.9 INPUT", "v9.9"),
        ("parts/ed.dat", "----- ELASTODYN", "- ELASTODYN v1.03.*", "- ELASTODYN v7.77", "v7.77"),
        ("parts/edblade.dat", "----- BLADE", "- ELASTODYN V1.00.*", "- ELASTODYN V2.0.*", "v2.0"),
        ("parts/tower.dat", "----- TOWER", "- ELASTODYN V1.00.*", "- ELASTODYN V3", "v3"),
        ("parts/ad.dat", "----- AERODYN", "- AERODYN v15 for", "- AERODYN v99.77", "v99.77"),
        ("parts/adblade.dat", "----- BLADE", "- AERODYN v15.00.*", "- AERODYN v14.0", "v14.0"),
        ("parts/servo.dat", "----- SERVODYN", "- SERVODYN v1.05.*", "- v4294967297", "v4294967297"),
    ];
    for (file, from, known, unknown, found) in cases {
        let (_folder, result) = import_with(file, from, known);
        assert!(result.is_ok(), "{known}: {result:?}");
        let (_folder, result) = import_with(file, from, unknown);
        let Err(error) = result else { panic!("{unknown} is imported") };
        let message = error.to_string();
        let name = file.rsplit('/').next().unwrap();
        assert!(message.contains(&format!("{name}, line 1, ")), "{message}");
        assert!(message.ends_with(&format!(", found {found}")), "{message}");
        let TurbineFileError::Value { expected, fix, .. } = error else { panic!("{message}") };
        assert!(expected.starts_with("version v"), "{expected}");
        assert!(fix.contains("openfast_toolbox"), "{fix}");
    }
}
