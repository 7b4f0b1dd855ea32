//! The baseline on a rotor with a known power coefficient: settles where theory says, within its limits.

use basis::{Measurements, PerBlade};
use control::baseline::{
    Baseline, Constants, MinimumPitch, PitchGains, SetPointSmoothing, TorqueGains,
    greedy_torque_gain,
};
use control::{Controller, Excitation, Helix, Pulse, Sense, TurbineController};
use proptest::prelude::*;

const AIR_DENSITY: f64 = 1.225;
const RADIUS: f64 = 63.0;
const INERTIA: f64 = 4.37e7;
const RATED_SPEED: f64 = 1.267;
const RATED_POWER: f64 = 5e6;
const EFFICIENCY: f64 = 0.944;

/// Power coefficient (–) at tip-speed ratio and pitch (rad).
///
/// Source: Slootweg, de Haan, Polinder, Kling, "General model for representing variable speed wind turbines in
/// power system dynamics simulations", IEEE Trans. Power Syst. 18, 144–151, 2003.
fn power_coefficient(tip_speed_ratio: f64, pitch: f64) -> f64 {
    let beta = pitch.to_degrees().max(0.0);
    let inverse = 1.0 / (tip_speed_ratio - 0.02 * beta) - 0.003 / (beta.powi(3) + 1.0);
    let drag = 0.58 * beta + 0.002 * beta.powf(2.14) + 13.2;
    0.73 * (151.0 * inverse - drag) * (-18.4 * inverse).exp()
}

fn power(wind_speed: f64, rotor_speed: f64, pitch: f64) -> f64 {
    let area = std::f64::consts::PI * RADIUS * RADIUS;
    let coefficient = power_coefficient(rotor_speed * RADIUS / wind_speed, pitch);
    0.5 * AIR_DENSITY * area * wind_speed.powi(3) * coefficient
}

/// Tip-speed ratio of greatest power at zero pitch, and that power coefficient.
fn optimum() -> (f64, f64) {
    (400..1200)
        .map(|i| f64::from(i) * 0.01)
        .map(|ratio| (ratio, power_coefficient(ratio, 0.0)))
        .fold((0.0, 0.0), |best, next| if next.1 > best.1 { next } else { best })
}

/// Pitch gains that place the poles of rotor speed at 0.6 rad/s, damping 0.7, at each pitch above rated.
///
/// Source: Jonkman et al., NREL/TP-500-38060, 2009, §7.3.
fn pitch_gains() -> Vec<PitchGains> {
    (0..=10)
        .map(|row| {
            let pitch = (2.0 * f64::from(row)).to_radians();
            let wind_speed = (100..300)
                .map(|i| f64::from(i) * 0.1)
                .min_by(|a, b| {
                    let off =
                        |u: f64| (power(u, RATED_SPEED, pitch) * EFFICIENCY - RATED_POWER).abs();
                    off(*a).total_cmp(&off(*b))
                })
                .expect("the range is not empty");
            let step = 1e-4;
            let slope = (power(wind_speed, RATED_SPEED, pitch + step)
                - power(wind_speed, RATED_SPEED, pitch))
                / step;
            let scale = INERTIA * RATED_SPEED / -slope;
            PitchGains { pitch, proportional: 2.0 * 0.7 * 0.6 * scale, integral: 0.36 * scale }
        })
        .collect()
}

fn constants() -> Constants {
    let (ratio, coefficient) = optimum();
    let rated_torque = RATED_POWER / (EFFICIENCY * RATED_SPEED);
    Constants {
        rotor_radius: RADIUS,
        optimal_tip_speed_ratio: ratio,
        torque_gain: greedy_torque_gain(AIR_DENSITY, RADIUS, coefficient, ratio),
        minimum_rotor_speed: 0.45,
        rated_rotor_speed: RATED_SPEED,
        rated_torque,
        rated_power: RATED_POWER,
        generator_efficiency: EFFICIENCY,
        minimum_torque: 0.0,
        maximum_torque: 1.1 * rated_torque,
        maximum_torque_rate: 1.5e6,
        constant_power: true,
        torque_gains: TorqueGains { proportional: 6.57e6, integral: 9.83e5 },
        fine_pitch: 0.0,
        minimum_pitch: Vec::new(),
        maximum_pitch: 1.57,
        maximum_pitch_rate: 0.12,
        pitch_gains: pitch_gains(),
        set_point_smoothing: SetPointSmoothing {
            torque_shift: 1.0 / 0.524,
            pitch_shift: 0.05,
            filter_corner: 0.63,
        },
        speed_filter_corner: 1.57,
    }
}

/// A rigid rotor on a shaft; generator and pitch follow their commands at once.
struct Rotor {
    interval: f64,
    measurements: Measurements,
}

impl Rotor {
    fn new(interval: f64, rotor_speed: f64) -> Self {
        let measurements = Measurements {
            time: 0.0,
            interval,
            azimuth: 0.0,
            rotor_speed,
            generator_speed: rotor_speed,
            pitch: PerBlade::splat(3, 0.0),
            generator_torque: 0.0,
            power: 0.0,
            thrust: 0.0,
            aerodynamic_torque: 0.0,
            rotor_wind_speed: 0.0,
            flap_moments: PerBlade::splat(3, 0.0),
            edge_moments: PerBlade::splat(3, 0.0),
            tower_top_acceleration: 0.0,
        };
        Self { interval, measurements }
    }

    /// Runs `controller` for `n_steps` in `wind` (time to m/s); gives the measurements after each step.
    fn run(
        &mut self,
        controller: &mut impl Controller,
        n_steps: usize,
        wind: impl Fn(f64) -> f64,
    ) -> Vec<Measurements> {
        let first = (self.measurements.time / self.interval).round() as usize;
        (first..first + n_steps)
            .map(|step| {
                let now = &mut self.measurements;
                let commands = controller.update(now);
                now.pitch = commands.pitch;
                now.generator_torque = commands.generator_torque;
                let wind_speed = wind(now.time);
                now.aerodynamic_torque =
                    power(wind_speed, now.rotor_speed, now.pitch.mean()) / now.rotor_speed;
                let acceleration = (now.aerodynamic_torque - now.generator_torque) / INERTIA;
                now.azimuth = (now.azimuth + self.interval * now.rotor_speed)
                    .rem_euclid(std::f64::consts::TAU);
                now.rotor_speed += self.interval * acceleration;
                now.generator_speed = now.rotor_speed;
                now.power = EFFICIENCY * now.generator_torque * now.rotor_speed;
                now.time = (step + 1) as f64 * self.interval;
                *now
            })
            .collect()
    }
}

/// Mean and greatest distance from it.
fn spread(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    (mean, values.map(|v| (v - mean).abs()).fold(0.0, f64::max))
}

#[test]
fn settles_at_the_optimal_tip_speed_ratio_below_rated() {
    let constants = constants();
    for interval in [0.05, 0.1, 0.2, 0.3] {
        for wind_speed in [5.0, 7.0, 9.0] {
            let mut baseline = Baseline::new(constants.clone());
            let n_steps = (600.0 / interval) as usize;
            let run = Rotor::new(interval, 0.8).run(&mut baseline, n_steps, |_| wind_speed);
            let tail = &run[n_steps - (100.0 / interval) as usize..];
            let (speed, wobble) = spread(tail.iter().map(|m| m.rotor_speed));
            let ratio = speed * RADIUS / wind_speed / constants.optimal_tip_speed_ratio;
            assert!((ratio - 1.0).abs() < 2e-3, "{interval} s, {wind_speed} m/s: {ratio}");
            assert!(wobble < 1e-3 * speed, "{interval} s, {wind_speed} m/s: {wobble}");
            assert!(tail.iter().all(|m| m.pitch.mean() == constants.fine_pitch));
        }
    }
}

#[test]
fn holds_rated_speed_and_power_above_rated() {
    let constants = constants();
    for constant_power in [true, false] {
        let constants = Constants { constant_power, ..constants.clone() };
        for interval in [0.05, 0.1, 0.2, 0.3] {
            for wind_speed in [13.0, 17.0, 23.0] {
                let mut baseline = Baseline::new(constants.clone());
                let n_steps = (600.0 / interval) as usize;
                // Feathered, as after a start: at fine pitch this rotor would stall in a storm.
                let mut rotor = Rotor::new(interval, 1.2);
                rotor.measurements.pitch = PerBlade::splat(3, 0.3);
                let run = rotor.run(&mut baseline, n_steps, |_| wind_speed);
                let tail = &run[n_steps - (100.0 / interval) as usize..];
                let (speed, wobble) = spread(tail.iter().map(|m| m.rotor_speed));
                let (power, _) = spread(tail.iter().map(|m| m.power));
                assert!((speed / RATED_SPEED - 1.0).abs() < 1e-3, "{wind_speed} m/s: {speed}");
                assert!((power / RATED_POWER - 1.0).abs() < 1e-3, "{wind_speed} m/s: {power}");
                assert!(wobble < 1e-4, "{interval} s, {wind_speed} m/s: {wobble}");
            }
        }
    }
}

#[test]
fn keeps_minimum_rotor_speed_in_a_light_wind() {
    let constants = constants();
    let mut baseline = Baseline::new(constants.clone());
    let run = Rotor::new(0.1, 0.6).run(&mut baseline, 6000, |_| 3.0);
    let speed = run[5999].rotor_speed;
    assert!((speed / constants.minimum_rotor_speed - 1.0).abs() < 1e-3, "{speed}");
}

/// Around rated, where torque and pitch control meet, the rotor settles too.
#[test]
fn settles_at_every_wind_speed_around_rated() {
    let constants = constants();
    for tenth in 95..=130 {
        let wind_speed = f64::from(tenth) * 0.1;
        let mut baseline = Baseline::new(constants.clone());
        let run = Rotor::new(0.2, 1.1).run(&mut baseline, 5000, |_| wind_speed);
        let (speed, wobble) = spread(run[4500..].iter().map(|m| m.rotor_speed));
        assert!(wobble < 2e-4, "{wind_speed} m/s: {wobble}");
        assert!(speed < 1.01 * RATED_SPEED, "{wind_speed} m/s: {speed}");
    }
}

#[test]
fn power_rises_with_the_wind_up_to_rated_and_stays() {
    let constants = constants();
    let mut last = 0.0;
    for tenth in (40..200).step_by(4) {
        let wind_speed = f64::from(tenth) * 0.1;
        let mut baseline = Baseline::new(constants.clone());
        let run = Rotor::new(0.2, 1.0).run(&mut baseline, 5000, |_| wind_speed);
        let (power, _) = spread(run[4500..].iter().map(|m| m.power));
        assert!(power > last - 1e-3 * RATED_POWER, "{wind_speed} m/s: {power} after {last}");
        assert!(power < 1.002 * RATED_POWER, "{wind_speed} m/s: {power}");
        last = power;
    }
}

#[test]
fn least_pitch_follows_its_table_at_the_wind_speed_of_the_power() {
    let row = |wind_speed, pitch| MinimumPitch { wind_speed, pitch };
    let constants = Constants { minimum_pitch: vec![row(4.0, 0.0), row(9.0, 0.01)], ..constants() };
    let mut baseline = Baseline::new(constants);
    let run = Rotor::new(0.2, 0.8).run(&mut baseline, 5000, |_| 8.0);
    // Half a degree costs little power, so that the estimate is close to the wind.
    assert!((run[4999].pitch.mean() - 0.008).abs() < 3e-4, "{}", run[4999].pitch.mean());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Steps of the wind, up and down, at any interval.
    #[test]
    fn stays_within_its_limits_in_gusts(
        winds in prop::collection::vec(3.5..25.0_f64, 8), interval in 0.05..0.3_f64,
    ) {
        let constants = constants();
        let mut baseline = Baseline::new(constants.clone());
        let n_steps = (240.0 / interval) as usize;
        let gusts = |time: f64| winds[((time / 30.0) as usize).min(winds.len() - 1)];
        let run = Rotor::new(interval, 1.0).run(&mut baseline, n_steps, gusts);
        for pair in run.windows(2) {
            let torque = pair[1].generator_torque;
            prop_assert!((0.0..=constants.maximum_torque).contains(&torque));
            let torque_rate = (torque - pair[0].generator_torque).abs() / interval;
            prop_assert!(torque_rate <= constants.maximum_torque_rate * (1.0 + 1e-9));
            let pitch = pair[1].pitch.mean();
            prop_assert!((constants.fine_pitch..=constants.maximum_pitch).contains(&pitch));
            let pitch_rate = (pitch - pair[0].pitch.mean()).abs() / interval;
            prop_assert!(pitch_rate <= constants.maximum_pitch_rate * (1.0 + 1e-9));
            prop_assert!(pair[1].rotor_speed > 0.1 && pair[1].rotor_speed < 1.6 * RATED_SPEED);
        }
    }
}

fn gusts(time: f64) -> f64 {
    10.5 + 2.5 * (0.05 * time).sin() + (0.31 * time).sin()
}

fn bits(run: &[Measurements]) -> Vec<u64> {
    run.iter()
        .flat_map(|m| m.pitch.iter().copied().chain([m.generator_torque, m.rotor_speed]))
        .map(f64::to_bits)
        .collect()
}

#[test]
fn amplitude_zero_is_the_baseline_bit_for_bit() {
    let fly = |excitation| {
        let mut controller = TurbineController::new(Baseline::new(constants()), excitation);
        bits(&Rotor::new(0.2, 1.0).run(&mut controller, 2000, gusts))
    };
    let baseline = fly(Excitation::None);
    let helix = Helix::new(Sense::CounterClockwise, 0.0, 0.25, 10.5, 2.0 * RADIUS);
    assert_eq!(baseline, fly(Excitation::Helix(helix)));
    assert_eq!(baseline, fly(Excitation::Pulse(Pulse::new(0.0, 0.25, 10.5, 2.0 * RADIUS))));
    assert_ne!(baseline, fly(Excitation::Helix(Helix { amplitude: 0.01, ..helix })));
}

/// Before its start, an excitation of any amplitude is not there.
#[test]
fn nothing_is_added_before_the_start() {
    let fly = |excitation| {
        let mut controller = TurbineController::new(Baseline::new(constants()), excitation);
        bits(&Rotor::new(0.2, 1.0).run(&mut controller, 500, gusts))
    };
    let helix = Helix {
        start: 100.0,
        ..Helix::new(Sense::CounterClockwise, 0.07, 0.25, 10.5, 2.0 * RADIUS)
    };
    assert_eq!(fly(Excitation::None), fly(Excitation::Helix(helix)));
}

#[test]
fn a_stored_controller_goes_on_with_the_same_bits() {
    let helix = Helix::new(Sense::CounterClockwise, 0.07, 0.25, 10.5, 2.0 * RADIUS);
    let new = || TurbineController::new(Baseline::new(constants()), Excitation::Helix(helix));
    let mut rotor = Rotor::new(0.2, 1.0);
    let mut controller = new();
    rotor.run(&mut controller, 777, gusts);
    let stored = postcard::to_stdvec(&controller).expect("plain data serialises");
    let mut twin = Rotor { interval: rotor.interval, measurements: rotor.measurements };
    let mut restored: TurbineController =
        postcard::from_bytes(&stored).expect("what was written is read");
    assert_eq!(restored, controller);
    let uninterrupted = bits(&rotor.run(&mut controller, 500, gusts));
    assert_eq!(uninterrupted, bits(&twin.run(&mut restored, 500, gusts)));
    assert_eq!(restored, controller);
}

#[test]
fn a_reading_that_is_no_number_gives_commands_that_are() {
    let mut baseline = Baseline::new(constants());
    let mut rotor = Rotor::new(0.2, 1.0);
    rotor.run(&mut baseline, 100, gusts);
    rotor.measurements.rotor_speed = f64::NAN;
    let commands = baseline.update(&rotor.measurements);
    assert!(commands.generator_torque.is_finite() && commands.pitch[0].is_finite());
    rotor.measurements.rotor_speed = 1.0;
    let commands = baseline.update(&rotor.measurements);
    assert!(commands.generator_torque > 0.0);
}
