//! Rotor speed held by torque: at its reference in any wind below rated, and with the same bits after a
//! restart.

mod rotor;

use basis::PerBlade;
use control::held_speed::HeldSpeed;
use control::{Baseline, Controller};
use rotor::{RADIUS, Rotor, bits, constants_of, heier, spread};

const INTERVAL: f64 = 0.2;

fn rotor() -> Rotor {
    let mut rotor = Rotor::heier(INTERVAL, 0.9);
    rotor.truth.pitch = PerBlade::splat(3, 0.0);
    rotor.truth.generator_torque = 1e6;
    rotor
}

#[test]
fn the_speed_is_held_whatever_the_wind() {
    let constants = constants_of(heier);
    let reference = 7.5 * 8.0 / RADIUS;
    // Integral action leaves no offset; the wind may be above or below the one that the speed suits.
    for wind in [7.0, 8.0, 9.0] {
        let mut controller = HeldSpeed::new(&constants, 7.5, 8.0);
        let run = rotor().run(&mut controller, 4000, |_| wind);
        let (speed, wobble) = spread(run[3000..].iter().map(|truth| truth.rotor_speed));
        assert!((speed / reference - 1.0).abs() < 1e-3, "{wind} m/s: {speed}");
        assert!(wobble < 1e-3 * reference, "{wind} m/s: ± {wobble}");
        assert!(run[3000..].iter().all(|truth| truth.pitch.mean().abs() < 1e-3));
    }
}

#[test]
fn a_gust_moves_the_speed_less_than_under_greedy_control() {
    let constants = constants_of(heier);
    // Slow beside the loop, which swings at √(K_i / J) = 0.15 rad/s: a torque of ± 2e5 N m moves the speed by
    // 0.02 × 2e5 / K_i = 0.004 rad/s, where greedy control follows the wind, ± 5 % of 0.95 rad/s.
    let gusty = |time: f64| 8.0 + 0.4 * (0.02 * time).sin();
    let moved = |controller: &mut dyn Controller| {
        let run = rotor().run(controller, 6000, gusty);
        spread(run[3000..].iter().map(|truth| truth.rotor_speed)).1
    };
    let held = moved(&mut HeldSpeed::new(&constants, 7.5, 8.0));
    let greedy = moved(&mut Baseline::new(constants.clone()));
    assert!(held < 0.2 * greedy, "{held} beside {greedy}");
}

#[test]
fn a_state_that_was_kept_goes_on_with_the_same_bits() {
    let constants = constants_of(heier);
    let mut first = HeldSpeed::new(&constants, 7.0, 8.5);
    let mut rotor = rotor();
    rotor.run(&mut first, 100, |_| 8.5);
    let mut second = HeldSpeed::new(&constants, 7.0, 8.5);
    second.restore(&first.save()).expect("its own state");
    assert!(second.restore(b"?").is_err());
    second.restore(&first.save()).expect("its own state");
    let mut twin = rotor.clone();
    let one = rotor.run(&mut first, 50, |_| 9.0);
    assert_eq!(bits(&one), bits(&twin.run(&mut second, 50, |_| 9.0)));
}
