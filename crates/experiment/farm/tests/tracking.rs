//! What controllers are given about their rotor: coefficients, and who gets them in which air.

#[path = "../../../controller/estimation/tests/machine/mod.rs"]
mod machine;

use control::baseline::{
    Constants, PitchGains, SetPointSmoothing, TorqueControl, TorqueGains, WIND_SPEED_FILTER_CORNER,
};
use farm::assemble::TurbineModel;
use farm::case::Solver;
use farm::tracking::coefficient_table;
use machine::definition;
use std::borrow::Cow;
use turbine::aero::blade_element::Theory;
use turbine::steady::SteadyRotor;

const SOLVERS: [Solver; 4] = [Solver::LATTICE, Solver::UNIFORM, Solver::TURBULENCE, Solver::PLANES];
const AIR_DENSITY: f64 = 1.1;

fn model(torque_control: Option<TorqueControl>) -> TurbineModel {
    let gains = PitchGains { pitch: 0.0, proportional: 0.5, integral: 0.05 };
    let constants = Constants {
        rotor_radius: 120.0,
        optimal_tip_speed_ratio: 9.0,
        torque_gain: 3e7,
        minimum_rotor_speed: 0.5,
        rated_rotor_speed: 0.8,
        rated_torque: 2e7,
        rated_power: 15e6,
        generator_efficiency: 0.95,
        minimum_torque: 0.0,
        maximum_torque: 2.2e7,
        maximum_torque_rate: 4.5e6,
        constant_power: true,
        torque_gains: TorqueGains { proportional: 4e7, integral: 5e6 },
        fine_pitch: 0.0,
        minimum_pitch: Vec::new(),
        maximum_pitch: 1.5,
        maximum_pitch_rate: 0.1,
        pitch_gains: vec![gains],
        set_point_smoothing: SetPointSmoothing {
            torque_shift: 1.0,
            pitch_shift: 0.01,
            filter_corner: 0.6,
        },
        speed_filter_corner: 1.0,
        speed_filter_damping: None,
        speed_notches: Vec::new(),
        torque_control,
        wind_speed_filter_corner: WIND_SPEED_FILTER_CORNER,
        estimator: None,
        tower_damping: None,
        individual_pitch: None,
    };
    TurbineModel { definition: definition(), constants }
}

/// At its entries the table holds blade-element momentum, between them it stays near it where rotors run.
#[test]
fn the_table_is_blade_element_momentum() {
    let definition = definition();
    let table = coefficient_table(&definition);
    let rotor = SteadyRotor::new(&definition, Theory::default());
    for &tip_speed_ratio in table.tip_speed_ratios() {
        for &pitch in table.pitches() {
            let exact = rotor.coefficients(tip_speed_ratio, pitch);
            let [power, thrust] =
                [table.power(tip_speed_ratio, pitch), table.thrust(tip_speed_ratio, pitch)];
            assert!(power.is_finite() && thrust.is_finite());
            if exact.power.is_finite() && exact.thrust.is_finite() {
                assert!((power - exact.power).abs() < 1e-12, "{tip_speed_ratio} {pitch}");
                assert!((thrust - exact.thrust).abs() < 1e-12, "{tip_speed_ratio} {pitch}");
            }
        }
    }
    for tip_speed_ratio in [7.3, 8.8, 9.2, 10.3] {
        for pitch in [0.0, 0.4, 1.5, 2.7].map(f64::to_radians) {
            let exact = rotor.coefficients(tip_speed_ratio, pitch);
            let [power, thrust] =
                [table.power(tip_speed_ratio, pitch), table.thrust(tip_speed_ratio, pitch)];
            assert!((power / exact.power - 1.0).abs() < 0.01, "{power} {exact:?}");
            assert!((thrust / exact.thrust - 1.0).abs() < 0.01, "{thrust} {exact:?}");
        }
    }
}

#[test]
fn an_estimator_knows_inertia_air_and_rotor() {
    let plain = model(None);
    let equipped = plain.clone().with_estimator(AIR_DENSITY);
    let estimator = equipped.constants.estimator.as_ref().expect("it was just set");
    assert_eq!(estimator.inertia, plain.definition.drive_train_inertia());
    assert_eq!(estimator.air_density, AIR_DENSITY);
    assert_eq!(estimator.coefficients, coefficient_table(&plain.definition));
    assert_eq!(equipped.constants.torque_control(), TorqueControl::TipSpeedRatio);
    // All else is as it was.
    assert_eq!(Constants { estimator: None, ..equipped.constants }, plain.constants);
}

#[test]
fn turbines_track_in_prescribed_wind_and_follow_k_omega_squared_in_solved_air() {
    for solver in SOLVERS {
        let plain = model(None);
        let equipped = plain.equipped(solver, AIR_DENSITY);
        let expected = if solver == Solver::LATTICE {
            TorqueControl::KOmegaSquared
        } else {
            TorqueControl::TipSpeedRatio
        };
        assert_eq!(equipped.constants.torque_control(), expected, "{solver:?}");
        assert_eq!(equipped.constants.estimator.is_some(), !solver.resolves_induction);
    }
}

#[test]
fn the_turbines_file_has_the_last_word() {
    for solver in SOLVERS {
        for given in [TorqueControl::KOmegaSquared, TorqueControl::TipSpeedRatio] {
            let model = model(Some(given));
            let equipped = model.equipped(solver, AIR_DENSITY);
            assert_eq!(equipped.constants.torque_control(), given, "{solver:?}");
        }
    }
}

/// A table that came with the turbine, such as ROSCO's, is not replaced by our own.
#[test]
fn what_is_known_is_not_computed_again() {
    let mut equipped = model(None).with_estimator(AIR_DENSITY);
    let estimator = equipped.constants.estimator.as_mut().expect("it was just set");
    estimator.inertia = 1.0;
    for solver in SOLVERS {
        let equipped = equipped.equipped(solver, 1.3);
        assert!(matches!(equipped, Cow::Borrowed(_)), "{solver:?}");
        let estimator = equipped.constants.estimator.as_ref().expect("as before");
        assert_eq!((estimator.inertia, estimator.air_density), (1.0, AIR_DENSITY));
    }
}

#[test]
fn rotor_speed_follows_the_wind_between_its_limits() {
    let model = model(None);
    let at = |wind: f64| model.rotor_speed(wind);
    assert_eq!((at(1.0), at(40.0)), (0.5, 0.8));
    assert!((at(8.0) - 9.0 * 8.0 / 120.0).abs() < 1e-12);
    let footprint = model.footprint(8.0);
    assert_eq!((footprint.diameter, footprint.hub_height), (240.0, 150.0));
    assert!((footprint.tip_speed - 72.0).abs() < 1e-9);
}
