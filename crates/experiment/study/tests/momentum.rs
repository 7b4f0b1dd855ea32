//! What a case says of momentum theory reaches the blades of a turbine in prescribed wind.

mod small;

use basis::{Commands, PerBlade, Truth};
use farm::assemble;
use farm::{Air, Farm, Recorder};
use small::{laid_out, uniform_air};
use std::f64::consts::PI;

const CASE: &str = r#"
name = "momentum"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.05
[time]
spin_up = 1.0
duration = 40.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [3.0, -1.0]
structure = "rigid"
[[run]]
name = "baseline"
"#;

/// Steps of a bit more than two turns of the rotor.
const N_STEPS: usize = 250;

/// The farm of the case with `overrides`, in wind that is the same everywhere.
fn farm_of(overrides: &[&str]) -> Farm<Air> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let (case, plan, model) = laid_out(CASE, &overrides, "nrel-5mw");
    let air = uniform_air(&case);
    assemble::farm(&case, &case.runs[0], &plan, &[model], air).expect("such a farm can be")
}

#[derive(Default)]
struct Records(Vec<Truth>);

impl Recorder for Records {
    fn record(&mut self, _turbine: usize, truth: &Truth, _commands: &Commands) {
        self.0.push(*truth);
    }
}

fn records(overrides: &[&str]) -> Vec<Truth> {
    let mut farm = farm_of(overrides);
    let mut records = Records::default();
    for _ in 0..N_STEPS {
        farm.advance(&mut records).expect("prescribed wind blows on");
    }
    records.0
}

/// Out-of-plane root moment of blade 1 that the tower adds (N m), instant after instant.
fn added(influence: &str, free: &[Truth]) -> Vec<f64> {
    let felt = records(&[&format!("turbine.T1.tower_influence={influence}")]);
    felt.iter().zip(free).map(|(felt, free)| felt.flap_moments[0] - free.flap_moments[0]).collect()
}

fn deepest(moments: &[f64]) -> f64 {
    moments.iter().copied().fold(0.0, f64::min)
}

/// A blade loses load when it passes the tower, and only then. Ahead of a cylinder of radius R the wind lacks
/// (R/x)²: here from a seventh at the blade's root to a twenty-fifth at its tip.
#[test]
fn a_tower_takes_load_from_a_blade_once_a_turn() {
    let free = records(&[]);
    assert_eq!(records(&["turbine.T1.tower_influence=none"]), free);
    let added_by_cylinder = added("potential", &free);
    let dip = deepest(&added_by_cylinder);
    let mean =
        free[1..].iter().map(|read| read.flap_moments[0]).sum::<f64>() / (N_STEPS - 1) as f64;
    assert!(dip < -0.01 * mean && dip > -0.2 * mean, "{dip} of {mean} N m");

    let from_below = |read: &Truth| (read.azimuth - PI).abs();
    let mut n_dips = 0;
    let mut is_in_dip = false;
    for (added, read) in added_by_cylinder.iter().zip(&free) {
        let is_deep = *added < 0.5 * dip;
        if is_deep {
            assert!(from_below(read) < 25f64.to_radians(), "{added} N m at {} rad", read.azimuth);
        }
        if from_below(read) > 60f64.to_radians() {
            assert!(added.abs() < -0.3 * dip, "{added} N m at {} rad", read.azimuth);
        }
        n_dips += usize::from(is_deep && !is_in_dip);
        is_in_dip = is_deep;
    }
    let passes = free.windows(2).filter(|two| two[0].azimuth < PI && two[1].azimuth >= PI);
    assert_eq!(n_dips, passes.count());
    assert_eq!(n_dips, 2);

    // The drag's source slows the wind ahead further; behind the tower no blade of an upwind rotor passes.
    assert!(deepest(&added("potential-with-drag", &free)) < 1.1 * dip);
    assert_eq!(added("potential-and-shadow", &free), added_by_cylinder);
}

/// Rise of the pitch at once (rad).
const STEP: f64 = 0.05;
/// When it rises (s).
const STEP_AT: f64 = 5.0;
/// Time that is recorded afterwards (s).
const OBSERVED: f64 = 120.0;

/// Thrust (N) of the turbine of the case with `overrides`, instant after instant, at held rotor speed in a
/// wind along its shaft, the same on every blade wherever it stands; its pitch steps meanwhile.
fn thrusts(overrides: &[&str]) -> Vec<f64> {
    let interval = 0.1;
    let farm = farm_of(overrides);
    let mut turbine = farm.machines()[0].turbine.clone().without_bodies().at_held_speed();
    let wind = turbine.frame().shaft * 9.0;
    let winds = vec![wind; turbine.stations().len()];
    let mut thrusts = Vec::new();
    for step in 0..((STEP_AT + OBSERVED) / interval) as usize {
        let pitch = if step as f64 * interval < STEP_AT { 0.0 } else { STEP };
        let pitch = PerBlade::splat(turbine.definition().n_blades, pitch);
        turbine.advance(
            interval,
            &winds,
            &Commands { pitch, generator_torque: 0.0, yaw_rate: 0.0 },
        );
        thrusts.push(turbine.truth(0.0, interval).thrust);
    }
    thrusts
}

/// Before and long after a step of the pitch momentum theory says how much thrust there is, whatever the
/// delay. In between the old wake still slows the wind: less thrust than without delay, each model at its own
/// pace.
#[test]
fn every_dynamic_inflow_answers_a_step_of_the_pitch_in_its_own_way() {
    let of = |inflow: &str| thrusts(&[&format!("turbine.T1.dynamic_inflow={inflow}")]);
    let [none, two_constant, snel_schepers] = ["none", "two-constant", "snel-schepers"].map(of);
    let slow = thrusts(&["turbine.T1.slow_constant=60"]);
    assert_eq!(thrusts(&[]), two_constant);

    let (before, last) = (40, none.len() - 1);
    let (first, rest) = (none[before], none[last]);
    assert!(rest < 0.95 * first, "{first} N, {rest} N");
    for delayed in [&two_constant, &snel_schepers] {
        assert!((delayed[before] / first - 1.0).abs() < 1e-3, "{} {first}", delayed[before]);
        assert!((delayed[last] / rest - 1.0).abs() < 3e-3, "{} {rest}", delayed[last]);
    }
    // Three seconds after the step the pitch has come to rest.
    let after = 80;
    for delayed in [&two_constant, &snel_schepers, &slow] {
        assert!(delayed[after] < 0.99 * none[after], "{} {}", delayed[after], none[after]);
    }
    // A slow constant of 60 s is some five times that of wind and load.
    assert!(slow[150] < two_constant[150] - 5e-3 * rest, "{} {}", slow[150], two_constant[150]);
    let apart = two_constant.iter().zip(&snel_schepers).map(|(a, b)| (a - b).abs());
    let farthest = apart.fold(0.0, f64::max);
    assert!(farthest > 3e-3 * rest, "{farthest} N of {rest} N");
}
