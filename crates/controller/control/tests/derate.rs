//! De-rating on a rotor with a known power coefficient: the share of power that is asked for, at the speed of
//! greedy control, whichever way torque is controlled.

mod rotor;

use basis::PerBlade;
use control::baseline::{Baseline, CoefficientTable, Constants, MinimumPitch};
use control::{Controller, Derate};
use rotor::{RADIUS, Rotor, constants_of, heier, spread, tracking_constants};

const INTERVAL: f64 = 0.2;
/// Share of power (–) that the table of coefficients, in steps of a quarter of a degree, may miss.
const TOLERANCE: f64 = 5e-3;

fn table() -> CoefficientTable {
    let known = tracking_constants().estimator.expect("it has a table");
    known.coefficients
}

/// Settled power (W), rotor speed (rad/s) and pitch (rad) in `wind` (m/s).
fn settled(controller: &mut dyn Controller, wind: f64) -> [f64; 3] {
    let mut rotor = Rotor::heier(INTERVAL, 0.9);
    rotor.truth.pitch = PerBlade::splat(3, 0.05);
    rotor.truth.generator_torque = 1e6;
    let run = rotor.run(controller, 6000, |_| wind);
    let tail = || run[5000..].iter();
    let (power, wobble) = spread(tail().map(|truth| truth.power));
    assert!(wobble < 2e-3 * power, "{wind} m/s: {power} ± {wobble}");
    let (speed, _) = spread(tail().map(|truth| truth.rotor_speed));
    let (pitch, _) = spread(tail().map(|truth| truth.pitch.mean()));
    [power, speed, pitch]
}

/// Ratios of power and speed to those of greedy control, and the difference of pitch (rad).
fn compared(constants: &Constants, share: f64, wind: f64) -> [f64; 3] {
    let greedy = settled(&mut Baseline::new(constants.clone()), wind);
    let derated = settled(&mut Derate::new(constants, &table(), share), wind);
    [derated[0] / greedy[0], derated[1] / greedy[1], derated[2] - greedy[2]]
}

#[test]
fn the_turbine_takes_its_share_at_the_speed_of_greedy_control() {
    let k_omega_squared = constants_of(heier);
    for constants in [k_omega_squared, tracking_constants()] {
        for share in [0.9, 0.7] {
            for wind in [6.0, 8.0, 10.0, 16.0, 20.0] {
                let [power, speed, pitch] = compared(&constants, share, wind);
                assert!((power - share).abs() < TOLERANCE, "{share} at {wind} m/s: {power}");
                assert!((speed - 1.0).abs() < 5e-3, "{share} at {wind} m/s: speed {speed}");
                assert!(pitch > 0.0, "{share} at {wind} m/s: towards feather, {pitch}");
            }
        }
    }
}

#[test]
fn a_limit_on_thrust_is_derated_from_where_it_stands() {
    let row = |wind_speed, pitch| MinimumPitch { wind_speed, pitch };
    let minimum_pitch = vec![row(4.0, 0.03), row(7.0, 0.0), row(9.0, 0.02), row(12.0, 0.05)];
    let constants = Constants { minimum_pitch, ..tracking_constants() };
    let derated = Derate::new(&constants, &table(), 0.8);
    let now = derated.constants();
    for wind in [4.0, 7.0, 9.0, 12.0] {
        let ratio = (constants.optimal_tip_speed_ratio * wind / RADIUS)
            .clamp(constants.minimum_rotor_speed, constants.rated_rotor_speed)
            * RADIUS
            / wind;
        let least = |rows: &[MinimumPitch]| {
            let row = rows.iter().find(|row| row.wind_speed == wind);
            table().power(ratio, row.expect("it is kept").pitch)
        };
        let share = least(&now.minimum_pitch) / least(&constants.minimum_pitch);
        assert!((share - 0.8).abs() < 1e-6, "{wind} m/s: {share}");
    }
    let rising = now.minimum_pitch.windows(2).all(|pair| pair[1].wind_speed > pair[0].wind_speed);
    assert!(rising && now.fine_pitch > constants.fine_pitch);
}

#[test]
fn a_stored_derating_goes_on_with_the_same_bits() {
    let new = || Derate::new(&tracking_constants(), &table(), 0.8);
    let mut rotor = Rotor::heier(INTERVAL, 1.0);
    let mut controller = new();
    rotor.run(&mut controller, 300, rotor::gusts);
    let (mut twin, mut restored) = (rotor.clone(), new());
    restored.restore(&controller.save()).expect("its own state");
    let uninterrupted = rotor::bits(&rotor.run(&mut controller, 300, rotor::gusts));
    assert_eq!(uninterrupted, rotor::bits(&twin.run(&mut restored, 300, rotor::gusts)));
    assert_eq!(controller.describe(), "derate 80 %");
}
