//! Tip-speed-ratio tracking on a rotor with a known power coefficient: unbiased estimate, tracked ratio,
//! rated power held.

mod rotor;

use basis::{PerBlade, Truth};
use control::Controller;
use control::baseline::{
    Baseline, CoefficientTable, Constants, MinimumPitch, PitchGains, SetPointSmoothing,
    TorqueControl, TorqueGains, WIND_SPEED_FILTER_CORNER,
};
use proptest::prelude::*;
use rotor::{
    RADIUS, RATED_POWER, RATED_SPEED, Rotor, bits, constants, gusts, spread, tracking_constants,
};

/// Runs `baseline` for `n_steps`; after each the measurements and the estimated wind speed (m/s).
fn simulate(
    baseline: &mut Baseline,
    rotor: &mut Rotor,
    n_steps: usize,
    wind: impl Fn(f64) -> f64 + Copy,
) -> Vec<(Truth, f64)> {
    let mut step = || {
        let measurements = rotor.run(baseline, 1, wind)[0];
        (measurements, baseline.wind_speed().expect("it has been updated"))
    };
    (0..n_steps).map(|_| step()).collect()
}

/// A rotor that starts as an operator would start it: feathered in a storm.
fn started(interval: f64, wind_speed: f64) -> Rotor {
    let speed = (8.1 * wind_speed / RADIUS).clamp(0.5, 1.2);
    let mut rotor = Rotor::heier(interval, speed);
    let pitch = (0.03 * (wind_speed - 11.5)).clamp(0.0, 0.35);
    rotor.truth.pitch = PerBlade::splat(3, pitch);
    rotor
}

#[test]
fn the_estimate_is_unbiased_and_the_set_points_are_held() {
    let constants = tracking_constants();
    for interval in [0.02, 0.2] {
        for half in 10..=40 {
            let wind_speed = 0.5 * f64::from(half);
            let mut baseline = Baseline::new(constants.clone());
            let n_steps = (400.0 / interval) as usize;
            let run = simulate(&mut baseline, &mut started(interval, wind_speed), n_steps, |_| {
                wind_speed
            });
            let tail = &run[n_steps - (60.0 / interval) as usize..];
            let (estimate, _) = spread(tail.iter().map(|(_, estimate)| *estimate));
            let off = estimate / wind_speed - 1.0;
            assert!(off.abs() < 0.02, "{interval} s, {wind_speed} m/s: estimate off by {off}");
            let (speed, wobble) = spread(tail.iter().map(|(m, _)| m.rotor_speed));
            assert!(wobble < 2e-3 * speed, "{interval} s, {wind_speed} m/s: {wobble}");
            let optimal = constants.optimal_tip_speed_ratio * wind_speed / RADIUS;
            if optimal < 0.98 * RATED_SPEED {
                let off = speed / optimal - 1.0;
                assert!(off.abs() < 0.01, "{interval} s, {wind_speed} m/s: speed off by {off}");
            }
            if wind_speed > 12.0 {
                let (power, _) = spread(tail.iter().map(|(m, _)| m.power));
                let off = power / RATED_POWER - 1.0;
                assert!(off.abs() < 0.01, "{interval} s, {wind_speed} m/s: power off by {off}");
            }
        }
    }
}

#[test]
fn the_estimate_follows_a_gust() {
    // A rise by 3 m/s and back within a minute, below rated and above.
    for (calm, pitch) in [(7.0, 0.0), (15.0, 0.15)] {
        let wind = |time: f64| {
            let phase = (time - 300.0) / 60.0;
            let inside = (0.0..1.0).contains(&phase);
            calm + if inside { 1.5 * (1.0 - (std::f64::consts::TAU * phase).cos()) } else { 0.0 }
        };
        let mut rotor = started(0.1, calm);
        rotor.truth.pitch = PerBlade::splat(3, pitch);
        let mut baseline = Baseline::new(tracking_constants());
        let run = simulate(&mut baseline, &mut rotor, 4500, wind);
        let within = &run[2950..4200];
        let (bias, _) = spread(within.iter().map(|(m, estimate)| estimate - wind(m.time)));
        assert!(bias.abs() < 0.02 * calm, "{calm} m/s: {bias}");
        // A gust of 0.1 rad/s through a filter of 0.21 rad/s: a tenth is lost.
        let peak = within.iter().map(|(_, estimate)| *estimate).fold(0.0, f64::max);
        assert!((calm + 2.4..calm + 3.1).contains(&peak), "{calm} m/s: peak {peak}");
    }
}

#[test]
fn nothing_jumps_at_the_start() {
    // From any point of operation that lasts: torque and pitch in force go on.
    for (wind_speed, interval) in [(6.0, 0.1), (9.0, 0.02), (11.0, 0.1), (16.0, 0.2)] {
        let n_steps = (600.0 / interval) as usize;
        let mut rotor = started(interval, wind_speed);
        let before = rotor.run(&mut Baseline::new(tracking_constants()), n_steps, |_| wind_speed);
        let before = before[n_steps - 1];
        let run = rotor.run(&mut Baseline::new(tracking_constants()), n_steps / 2, |_| wind_speed);
        for (k, after) in run.iter().enumerate() {
            let torque = after.generator_torque / before.generator_torque - 1.0;
            assert!(torque.abs() < 0.01, "{wind_speed} m/s, step {k}: torque by {torque}");
            let pitch = after.pitch.mean() - before.pitch.mean();
            assert!(pitch.abs() < 2e-3, "{wind_speed} m/s, step {k}: pitch by {pitch}");
            let speed = after.rotor_speed / before.rotor_speed - 1.0;
            assert!(speed.abs() < 0.005, "{wind_speed} m/s, step {k}: speed by {speed}");
        }
    }
}

/// Through rated and back, no loop fights the other: power rises and falls with the wind.
#[test]
fn the_transition_through_rated_is_smooth() {
    let ramp = |time: f64| 9.0 + 5.0 * (1.0 - (std::f64::consts::TAU * time / 1200.0).cos()) / 2.0;
    let mut rotor = Rotor::heier(0.1, 1.1);
    let run = rotor.run(&mut Baseline::new(tracking_constants()), 12_000, ramp);
    let most = run.iter().map(|m| m.power).fold(0.0, f64::max);
    assert!(most < 1.02 * RATED_POWER, "{most}");
    let fastest = run.iter().map(|m| m.rotor_speed).fold(0.0, f64::max);
    assert!(fastest < 1.03 * RATED_SPEED, "{fastest}");
    // On the way up, after the start has died down, it never dips by more than it may be off above rated.
    for pair in run[2000..6000].windows(50) {
        let change = pair[49].power - pair[0].power;
        assert!(change > -1e-2 * RATED_POWER, "{} s: {change}", pair[0].time);
    }
}

#[test]
fn least_pitch_follows_its_table_at_the_estimated_wind() {
    let row = |wind_speed, pitch| MinimumPitch { wind_speed, pitch };
    let constants =
        Constants { minimum_pitch: vec![row(4.0, 0.0), row(9.0, 0.05)], ..tracking_constants() };
    let mut baseline = Baseline::new(constants);
    let run = Rotor::heier(0.2, 0.8).run(&mut baseline, 5000, |_| 8.0);
    assert!((run[4999].pitch.mean() - 0.04).abs() < 1e-3, "{}", run[4999].pitch.mean());
}

#[test]
fn the_deck_may_ask_for_the_other_kind_of_torque_control() {
    assert_eq!(constants().torque_control(), TorqueControl::KOmegaSquared);
    assert_eq!(tracking_constants().torque_control(), TorqueControl::TipSpeedRatio);
    let given = |torque_control| Constants { torque_control: Some(torque_control), ..constants() };
    assert_eq!(given(TorqueControl::TipSpeedRatio).torque_control(), TorqueControl::KOmegaSquared);
    let greedy =
        Constants { torque_control: Some(TorqueControl::KOmegaSquared), ..tracking_constants() };
    assert_eq!(greedy.torque_control(), TorqueControl::KOmegaSquared);
    // Without a limit that asks for the wind, the estimate changes nothing along k ω².
    let plain = Constants { estimator: None, ..greedy.clone() };
    let fly =
        |constants| bits(&Rotor::heier(0.2, 1.0).run(&mut Baseline::new(constants), 2000, gusts));
    assert_eq!(fly(greedy), fly(plain));
}

#[test]
fn a_stored_controller_goes_on_with_the_same_bits() {
    let new = || Baseline::new(tracking_constants());
    let mut rotor = Rotor::heier(0.1, 1.0);
    let mut controller = new();
    rotor.run(&mut controller, 777, gusts);
    let stored = controller.save();
    let mut twin = rotor.clone();
    let mut restored = new();
    restored.restore(&stored).expect("its own state");
    let uninterrupted = bits(&rotor.run(&mut controller, 500, gusts));
    assert_eq!(uninterrupted, bits(&twin.run(&mut restored, 500, gusts)));
}

#[test]
fn readings_that_are_no_numbers_do_no_lasting_harm() {
    let mut baseline = Baseline::new(tracking_constants());
    let mut rotor = Rotor::heier(0.1, f64::NAN);
    assert!(baseline.update(&rotor.truth.measured()).generator_torque.is_finite());
    rotor.truth.rotor_speed = 1.0;
    rotor.truth.generator_speed = 1.0;
    let run = rotor.run(&mut baseline, 6000, |_| 9.0);
    let ratio = run[5999].rotor_speed * RADIUS / 9.0 / baseline.constants().optimal_tip_speed_ratio;
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// Steps of the wind, up and down, at any interval.
    #[test]
    fn stays_within_its_limits_in_gusts(
        winds in prop::collection::vec(4.0..24.0_f64, 8), interval in 0.02..0.3_f64,
    ) {
        let constants = tracking_constants();
        let mut baseline = Baseline::new(constants.clone());
        let n_steps = (240.0 / interval) as usize;
        let gusts = |time: f64| winds[((time / 30.0) as usize).min(winds.len() - 1)];
        let run = simulate(&mut baseline, &mut started(interval, winds[0]), n_steps, gusts);
        for pair in run.windows(2) {
            let [(before, _), (after, estimate)] = [pair[0], pair[1]];
            prop_assert!((0.0..=constants.maximum_torque).contains(&after.generator_torque));
            let torque_rate = (after.generator_torque - before.generator_torque).abs() / interval;
            prop_assert!(torque_rate <= constants.maximum_torque_rate * (1.0 + 1e-9));
            let pitch_rate = (after.pitch.mean() - before.pitch.mean()).abs() / interval;
            prop_assert!(pitch_rate <= constants.maximum_pitch_rate * (1.0 + 1e-9));
            prop_assert!(after.rotor_speed > 0.1 && after.rotor_speed < 1.6 * RATED_SPEED);
            prop_assert!(estimate.is_finite() && (0.5..60.0).contains(&estimate), "{estimate}");
        }
    }
}

/// Steady states of the IEA 15 MW turbine in OpenFAST 5.0.0 under ROSCO 2.10.1: wind (m/s), electrical power
/// (kW), rpm.
const OPENFAST: [[f64; 3]; 4] =
    [[7.0, 4485.1, 5.0286], [8.0, 6684.4, 5.7425], [9.0, 9467.2, 6.4487], [10.0, 12862.5, 7.1418]];

/// Its rotor runs at a tip-speed ratio of 9.05 to 9.1 and not at its target of 9: the table of the input set
/// gives it a power coefficient of 0.469 where OpenFAST's own rotor has 0.48 to 0.49, so that the estimate of
/// the wind is high by a third of the difference. With the same table, so is ours.
#[test]
fn a_table_that_is_too_low_gives_roscos_rotor_speeds() {
    let radius = 120.97;
    let rpm = std::f64::consts::PI / 30.0;
    let efficiency = 0.95756;
    // Cp_Ct_Cq.IEA15MW.txt of the input set IEA-15-240-RWT, commit 6b3fd8a: tip-speed ratios 8 to 10.5, pitch
    // -1 to 2°.
    let power = [
        [0.467887, 0.463986, 0.454086, 0.438469],
        [0.47036, 0.469685, 0.462112, 0.4475],
        [0.465482, 0.469256, 0.465301, 0.452924],
        [0.453992, 0.46341, 0.463981, 0.454979],
        [0.437099, 0.452466, 0.458747, 0.453923],
        [0.416885, 0.437225, 0.44974, 0.449954],
    ];
    let table = CoefficientTable::new(
        vec![8.0, 8.5, 9.0, 9.5, 10.0, 10.5],
        [-1.0_f64, 0.0, 1.0, 2.0].map(f64::to_radians).to_vec(),
        power.concat(),
        vec![0.8; 24],
    );
    let constants = Constants {
        rotor_radius: radius,
        optimal_tip_speed_ratio: 9.0,
        torque_gain: 3.2e7,
        minimum_rotor_speed: 5.0 * rpm,
        rated_rotor_speed: 0.79168,
        rated_torque: 19_786_767.5,
        rated_power: 15e6,
        generator_efficiency: efficiency,
        minimum_torque: 0.0,
        maximum_torque: 21_765_444.2,
        maximum_torque_rate: 4.5e6,
        constant_power: false,
        torque_gains: TorqueGains { proportional: 36_117_936.9, integral: 4_499_370.3 },
        fine_pitch: 0.0,
        minimum_pitch: Vec::new(),
        maximum_pitch: 1.57,
        maximum_pitch_rate: 0.0349,
        pitch_gains: vec![PitchGains {
            pitch: 0.064332,
            proportional: 1.156615,
            integral: 0.120737,
        }],
        set_point_smoothing: SetPointSmoothing {
            torque_shift: 1.908397,
            pitch_shift: 0.001,
            filter_corner: 0.6283,
        },
        speed_filter_corner: 1.0081,
        speed_filter_damping: Some(0.7),
        wind_speed_filter_corner: WIND_SPEED_FILTER_CORNER,
        ..constants()
    }
    .with_estimator(312_456_272.0, 1.225, table.expect("axes rise"));
    for [wind_speed, power_kw, expected] in OPENFAST {
        // OpenFAST's power stands for its rotor: the coefficient is flat about the optimum.
        let aerodynamic = 1e3 * power_kw / efficiency;
        let mut baseline = Baseline::new(constants.clone());
        let mut rotor = Rotor::heier(0.05, 9.0 * wind_speed / radius);
        for _ in 0..20_000 {
            let commands = baseline.update(&rotor.truth.measured());
            let now = &mut rotor.truth;
            let torque = aerodynamic / now.rotor_speed - commands.generator_torque;
            now.rotor_speed += 0.05 * torque / 312_456_272.0;
            now.generator_speed = now.rotor_speed;
            now.generator_torque = commands.generator_torque;
        }
        let speed = rotor.truth.rotor_speed / rpm;
        assert!((speed / expected - 1.0).abs() < 1e-3, "{wind_speed} m/s: {speed} rpm");
    }
}
