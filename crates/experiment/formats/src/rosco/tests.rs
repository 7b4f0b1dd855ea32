//! Inputs of several versions, with a few lines each: the same constants, or an error that names the place.

use super::*;
use control::baseline::{PitchFloor, TorqueControl};
use std::fs;
use tempfile::TempDir;

pub(crate) const TABLE: &str = "# ----- Rotor performance tables for a turbine -----
# Pitch angle vector, 3 entries - x axis (matrix columns) (deg)
-1.0   0.0   2.0
# TSR vector, 2 entries - y axis (matrix rows) (-)
7.0   8.0
# Wind speed vector - z axis (m/s)
10.74

# Power coefficient

0.40  0.45  0.44
0.41  0.46  0.43

#  Thrust coefficient

0.70  0.72  0.65
0.75  0.80  0.70

# Torque coefficient

0.05  0.06  0.06
0.05  0.06  0.05
";

/// Version 2.10's keys, on the high-speed side of a gearbox of 50.
pub(crate) const DISCON: &str = "! Controller parameter input file
!------- CONTROLLER FLAGS ------
2                   ! F_LPFType       - 1: first-order, 2: second-order
1                   ! IPC_ControlMode - individual pitch
2                   ! VS_ControlMode  - 2- WSE TSR Tracking
1                   ! VS_ConstPower   - constant power
1                   ! SS_Mode         - Setpoint Smoother mode
1                   ! PS_Mode         - Pitch saturation mode
1                   ! TD_Mode         - Tower damper mode
!------- FILTERS ------
1.57080             ! F_LPFCornerFreq - [rad/s]
0.70000             ! F_LPFDamping    - [-]
2                   ! F_NumNotchFilts - Number
1.2 1.4799          ! F_NotchFreqs    - rad/s
0.0 0.1             ! F_NotchBetaNum
0.2 0.2500          ! F_NotchBetaDen
1                   ! F_GenSpdNotch_N
2                   ! F_GenSpdNotch_Ind
0.62830             ! F_SSCornerFreq
0.20944             ! F_WECornerFreq
0.25                ! F_VSRefSpdCornerFreq
!------- BLADE PITCH CONTROL ------
0.05 0.1 0.2        ! PC_GS_angles
-0.02 -0.015 -0.01  ! PC_GS_KP
-0.002 -0.0015 -0.001 ! PC_GS_KI
1.57                ! PC_MaxPit
0.0                 ! PC_MinPit
0.1                 ! PC_MaxRat
80.0                ! PC_RefSpd
0.0                 ! PC_FinePit
!------- INDIVIDUAL PITCH CONTROL ------
8.0 10.0            ! IPC_Vramp
3                   ! IPC_SatMode
0.1                 ! IPC_IntSat
1e-9 0.0            ! IPC_KP
2e-9 0.0            ! IPC_KI
0.3 0.0             ! IPC_aziOffset
!------- VS TORQUE CONTROL ------
94.4                ! VS_GenEff
5000.               ! VS_MaxRat
1100.               ! VS_MaxTq
0.0                 ! VS_MinTq
20.0                ! VS_MinOMSpd
0.1                 ! VS_Rgn2K
75000.              ! VS_RtPwr
1000.               ! VS_RtTq
-30.                ! VS_KP
-5.                 ! VS_KI
7.0                 ! VS_TSRopt
1.0                 ! SS_VSGain
0.01                ! SS_PCGain
!------- WIND SPEED ESTIMATOR ------
20.0                ! WE_BladeRadius
50.0                ! WE_GearboxRatio
1e6                 ! WE_Jtot
1.2                 ! WE_RhoAir
\"table.txt\"       ! PerfFileName
!------- TOWER CONTROL ------
0.02                ! FA_KI
0.1                 ! FA_HPFCornerFreq
0.05                ! FA_IntSat
!------- MINIMUM PITCH ------
3.0 10.0 20.0       ! PS_WindSpeeds
0.0 0.0 0.1         ! PS_BldPitchMin
";

/// Writes both files and reads them.
fn read_texts(discon: &str, table: &str) -> (TempDir, Result<Discon, TurbineFileError>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("DISCON.IN");
    fs::write(&path, discon).unwrap();
    fs::write(folder.path().join("table.txt"), table).unwrap();
    let result = read(&path);
    (folder, result)
}

fn constants(discon: &str) -> Constants {
    read_texts(discon, TABLE).1.unwrap().constants
}

fn refusal(from: &str, to: &str) -> String {
    assert!(DISCON.contains(from), "{from}");
    read_texts(&DISCON.replacen(from, to, 1), TABLE).1.unwrap_err().to_string()
}

#[test]
fn figures_are_read_on_the_low_speed_side() {
    let constants = constants(DISCON);
    assert!((constants.rated_rotor_speed - 80.0 / 50.0).abs() < 1e-12);
    assert!((constants.rated_torque - 5e4).abs() < 1e-6);
    assert!((constants.torque_gains.proportional - 30.0 * 2500.0).abs() < 1e-6);
    assert!((constants.pitch_gains[0].proportional - 1.0).abs() < 1e-12);
    assert!((constants.torque_gain - 0.1 * 125_000.0).abs() < 1e-6);
    assert_eq!(constants.rotor_radius, 20.0);
    assert!((constants.generator_efficiency - 0.944).abs() < 1e-12);
    assert_eq!(constants.torque_control(), TorqueControl::TipSpeedRatio);
    assert!(constants.constant_power);
    assert_eq!(constants.speed_filter_damping, Some(0.7));
    assert_eq!(constants.wind_speed_filter_corner, 0.25);
    let notch = constants.speed_notches[..].first().unwrap();
    assert_eq!((notch.frequency, notch.numerator_damping), (1.4799, 0.1));
    assert_eq!(constants.speed_notches.len(), 1);
    let individual = constants.individual_pitch.unwrap();
    assert_eq!((individual.integral, individual.floor), (2e-9, PitchFloor::Least));
    assert!((individual.azimuth_offset.unwrap() - 0.3).abs() < 1e-12);
    assert!((constants.tower_damping.unwrap().limit - 0.05).abs() < 1e-12);
    let estimator = constants.estimator.unwrap();
    assert_eq!((estimator.inertia, estimator.air_density), (1e6, 1.2));
    assert!((estimator.coefficients.power(7.5, 0.0) - 0.455).abs() < 1e-12);
    assert!((estimator.coefficients.power(7.0, 1f64.to_radians()) - 0.445).abs() < 1e-12);
    assert!((estimator.coefficients.thrust(8.0, 0.0) - 0.80).abs() < 1e-12);
}

#[test]
fn older_files_say_it_in_other_words() {
    // Up to 2.8 one number for torque and power, one notch, and no filter on the reference.
    let old = DISCON
        .replace("1                   ! VS_ConstPower   - constant power\n", "")
        .replace("0.25                ! F_VSRefSpdCornerFreq\n", "")
        .replace("1                   ! F_GenSpdNotch_N\n", "1 ! F_NotchType\n")
        .replace(
            "2                   ! F_GenSpdNotch_Ind\n",
            "3.355 ! F_NotchCornerFreq\n0.0 0.25 ! F_NotchBetaNumDen\n",
        )
        .replace("1                   ! TD_Mode         - Tower damper mode\n", "")
        .replace("1                   ! IPC_ControlMode - individual pitch\n", "");
    let read = constants(&old);
    assert_eq!(read.torque_control(), TorqueControl::TipSpeedRatio);
    assert!(!read.constant_power);
    assert_eq!(read.wind_speed_filter_corner, 0.20944);
    assert_eq!(read.speed_notches[0].frequency, 3.355);
    assert!(read.tower_damping.is_none() && read.individual_pitch.is_none());
    let read =
        constants(&old.replace("2                   ! VS_ControlMode", "1 ! VS_ControlMode"));
    assert_eq!(read.torque_control(), TorqueControl::KOmegaSquared);
    assert!(read.constant_power);
    let quiet = DISCON
        .replace("1                   ! PS_Mode", "0 ! PS_Mode")
        .replace("1                   ! SS_Mode", "0 ! SS_Mode");
    let read = constants(&quiet);
    assert!(read.minimum_pitch.is_empty());
    assert_eq!(read.set_point_smoothing.torque_shift, 0.0);
}

#[test]
fn errors_name_file_line_key_and_what_was_expected() {
    for (from, to, place, expected) in [
        (
            "20.0                ! WE_BladeRadius",
            "twenty ! WE_BladeRadius",
            "line 53, WE_BladeRadius",
            "a number",
        ),
        ("1e6                 ! WE_Jtot", "-1e6 ! WE_Jtot", "WE_Jtot", "above zero"),
        (
            "2                   ! VS_ControlMode",
            "7 ! VS_ControlMode",
            "line 5, VS_ControlMode",
            "1, 2 or 3",
        ),
        (
            "1                   ! IPC_ControlMode",
            "2 ! IPC_ControlMode",
            "IPC_ControlMode",
            "0 or 1",
        ),
        (
            "2                   ! F_GenSpdNotch_Ind",
            "3 ! F_GenSpdNotch_Ind",
            "F_GenSpdNotch_Ind",
            "from 1",
        ),
        ("7.0                 ! VS_TSRopt\n", "", "VS_TSRopt", "the key VS_TSRopt"),
        (
            "0.0 0.0 0.1         ! PS_BldPitchMin",
            "0.0 0.1 ! PS_BldPitchMin",
            "PS_BldPitchMin",
            "3 numbers",
        ),
    ] {
        let message = refusal(from, to);
        assert!(message.contains("DISCON.IN, line "), "{message}");
        assert!(message.contains(place) && message.contains(expected), "{message}");
    }
}

#[test]
fn figures_that_no_controller_can_have_are_refused_by_their_own_keys() {
    for (from, to, place, expected) in [
        ("1100.               ! VS_MaxTq", "900. ! VS_MaxTq", "line 41, VS_MaxTq", "50000 to"),
        ("-30.                ! VS_KP", "30. ! VS_KP", "VS_KP", "torque_proportional 0 to 1e12"),
        ("0.05 0.1 0.2        ! PC", "0.05 0.2 0.1 ! PC", "PC_GS_angles", "increases"),
        ("0.25                ! F_VS", "0.0 ! F_VS", "F_VSRefSpdCornerFreq", "above zero"),
        ("0.1                 ! FA_HPF", "0.0 ! FA_HPF", "FA_HPFCornerFreq", "above zero"),
    ] {
        let message = refusal(from, to);
        assert!(message.contains("DISCON.IN, line "), "{message}");
        assert!(message.contains(place) && message.contains(expected), "{message}");
    }
}

#[test]
fn without_its_table_a_file_tells_all_but_the_estimator() {
    let whole = read_texts(DISCON, TABLE).1.unwrap();
    assert_eq!((whole.text.as_str(), whole.table_text.as_str()), (DISCON, TABLE));
    assert_eq!(whole.missing_table, None);
    let alone = Constants { estimator: None, ..whole.constants };
    let (folder, read) = read_texts(&DISCON.replace("table.txt", "none.txt"), TABLE);
    let read = read.unwrap();
    assert_eq!(read.constants, alone);
    assert_eq!(read.missing_table, Some(folder.path().join("none.txt")));
    assert_eq!(read.table_text, "");
    let unnamed = DISCON.replace("\"table.txt\"       ! PerfFileName\n", "");
    let unnamed = read_texts(&unnamed, TABLE).1.unwrap();
    assert_eq!((unnamed.constants, unnamed.missing_table), (alone, None));
}

#[test]
fn a_table_that_does_not_fit_is_refused_with_its_line() {
    for (from, to, place) in [
        ("0.41  0.46  0.43\n", "", "line 11, power coefficient: expected 2 rows"),
        ("0.41  0.46  0.43", "0.41  0.46", "line 12, power coefficient: expected 3 numbers"),
        (
            "0.75  0.80",
            "0.75  much",
            "line 17, coefficients: expected a number from -1000 to 1000, found \"much\"",
        ),
        ("-1.0   0.0", "-1.0  -1.0", "line 3, pitch angles: expected increasing numbers"),
        ("# TSR vector", "# ratios", "tip-speed ratios: expected a line"),
        ("0.70  0.72", "0.70  nan", "line 16, coefficients: expected a number"),
    ] {
        assert!(TABLE.contains(from), "{from}");
        let message = parse_coefficients("t.txt", &TABLE.replacen(from, to, 1)).unwrap_err();
        assert!(message.to_string().contains(place), "{message}");
    }
    // Cut short anywhere, it is refused or whole, and never a panic.
    for end in 0..TABLE.len() {
        if TABLE.is_char_boundary(end) {
            let _ = parse_coefficients("t.txt", &TABLE[..end]);
        }
    }
}
