//! A rotor with a known power coefficient on a shaft, its constants, and figures of its runs.
#![allow(dead_code, reason = "each test binary uses its part")]

use basis::Truth;
use control::Controller;
use control::baseline::{
    CoefficientTable, Constants, PitchGains, SetPointSmoothing, TorqueGains,
    WIND_SPEED_FILTER_CORNER, greedy_torque_gain,
};

pub(crate) const AIR_DENSITY: f64 = 1.225;
pub(crate) const RADIUS: f64 = 63.0;
pub(crate) const INERTIA: f64 = 4.37e7;
pub(crate) const RATED_SPEED: f64 = 1.267;
pub(crate) const RATED_POWER: f64 = 5e6;
pub(crate) const EFFICIENCY: f64 = 0.944;

/// Power coefficient (–) at tip-speed ratio and pitch (rad).
///
/// Source: Slootweg, de Haan, Polinder, Kling, "General model for representing variable speed wind turbines
/// in power system dynamics simulations", IEEE Trans. Power Syst. 18, 144–151, 2003.
pub(crate) fn slootweg(tip_speed_ratio: f64, pitch: f64) -> f64 {
    let beta = pitch.to_degrees().max(0.0);
    let inverse = 1.0 / (tip_speed_ratio - 0.02 * beta) - 0.003 / (beta.powi(3) + 1.0);
    let drag = 0.58 * beta + 0.002 * beta.powf(2.14) + 13.2;
    0.73 * (151.0 * inverse - drag) * (-18.4 * inverse).exp()
}

/// Power coefficient (–) at tip-speed ratio and pitch (rad) of a rotor that does not stall in strong wind.
///
/// Source: Heier, "Grid integration of wind energy conversion systems", Wiley, 1998, §2.1.
pub(crate) fn heier(tip_speed_ratio: f64, pitch: f64) -> f64 {
    let beta = pitch.to_degrees().max(0.0);
    let inverse = 1.0 / (tip_speed_ratio + 0.08 * beta) - 0.035 / (beta.powi(3) + 1.0);
    let lift = 116.0 * inverse - 0.4 * beta - 5.0;
    0.5176 * lift * (-21.0 * inverse).exp() + 0.0068 * tip_speed_ratio
}

/// Power coefficient (–) at tip-speed ratio (–) and pitch (rad).
pub(crate) type Coefficient = fn(f64, f64) -> f64;

pub(crate) fn power(of: Coefficient, wind_speed: f64, rotor_speed: f64, pitch: f64) -> f64 {
    let area = std::f64::consts::PI * RADIUS * RADIUS;
    let coefficient = of(rotor_speed * RADIUS / wind_speed, pitch);
    0.5 * AIR_DENSITY * area * wind_speed.powi(3) * coefficient
}

/// Tip-speed ratio of greatest power at zero pitch, and that power coefficient.
pub(crate) fn optimum(of: Coefficient) -> (f64, f64) {
    (400..1200)
        .map(|i| f64::from(i) * 0.01)
        .map(|ratio| (ratio, of(ratio, 0.0)))
        .fold((0.0, 0.0), |best, next| if next.1 > best.1 { next } else { best })
}

/// Pitch gains that place the poles of rotor speed at 0.6 rad/s, damping 0.7, at each pitch above rated.
///
/// Source: Jonkman et al., NREL/TP-500-38060, 2009, §7.3.
pub(crate) fn pitch_gains(of: Coefficient) -> Vec<PitchGains> {
    (0..=10)
        .map(|row| {
            let pitch = (2.0 * f64::from(row)).to_radians();
            let wind_speed = (100..300)
                .map(|i| f64::from(i) * 0.1)
                .min_by(|a, b| {
                    let off = |u: f64| {
                        (power(of, u, RATED_SPEED, pitch) * EFFICIENCY - RATED_POWER).abs()
                    };
                    off(*a).total_cmp(&off(*b))
                })
                .expect("the range is not empty");
            let step = 1e-4;
            let slope = (power(of, wind_speed, RATED_SPEED, pitch + step)
                - power(of, wind_speed, RATED_SPEED, pitch))
                / step;
            let scale = INERTIA * RATED_SPEED / -slope;
            PitchGains { pitch, proportional: 2.0 * 0.7 * 0.6 * scale, integral: 0.36 * scale }
        })
        .collect()
}

/// Constants for k ω² of the rotor of [`slootweg`].
pub(crate) fn constants() -> Constants {
    constants_of(slootweg)
}

pub(crate) fn constants_of(of: Coefficient) -> Constants {
    let (ratio, coefficient) = optimum(of);
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
        pitch_gains: pitch_gains(of),
        set_point_smoothing: SetPointSmoothing {
            torque_shift: 1.0 / 0.524,
            pitch_shift: 0.05,
            filter_corner: 0.63,
        },
        speed_filter_corner: 1.57,
        speed_filter_damping: None,
        speed_notches: Vec::new(),
        torque_control: None,
        wind_speed_filter_corner: WIND_SPEED_FILTER_CORNER,
        estimator: None,
        tower_damping: None,
        individual_pitch: None,
    }
}

/// Constants of the rotor of [`heier`] with the wind estimated from a table of it.
pub(crate) fn tracking_constants() -> Constants {
    let ratios = (4..=30).map(|k| 0.5 * f64::from(k)).collect();
    // A quarter of a degree: this rotor's power bends sharply within the first two.
    let pitches = (0..=140).map(|k| (0.25 * f64::from(k)).to_radians()).collect();
    let table = CoefficientTable::from_fn(ratios, pitches, |l, p| [heier(l, p), 0.8]);
    constants_of(heier).with_estimator(INERTIA, AIR_DENSITY, table.expect("axes rise"))
}

/// A rigid rotor on a shaft; generator and pitch follow their commands at once.
#[derive(Clone)]
pub(crate) struct Rotor {
    coefficient: Coefficient,
    pub(crate) interval: f64,
    pub(crate) truth: Truth,
}

impl Rotor {
    pub(crate) fn new(interval: f64, rotor_speed: f64) -> Self {
        let truth =
            Truth { interval, rotor_speed, generator_speed: rotor_speed, ..Truth::at_rest(3) };
        Self { coefficient: slootweg, interval, truth }
    }

    /// The rotor of [`heier`].
    pub(crate) fn heier(interval: f64, rotor_speed: f64) -> Self {
        Self { coefficient: heier, ..Self::new(interval, rotor_speed) }
    }

    /// Runs `controller` for `n_steps` in `wind` (time to m/s); gives the truth after each step.
    pub(crate) fn run(
        &mut self,
        controller: &mut dyn Controller,
        n_steps: usize,
        wind: impl Fn(f64) -> f64,
    ) -> Vec<Truth> {
        let first = (self.truth.time / self.interval).round() as usize;
        (first..first + n_steps)
            .map(|step| {
                let now = &mut self.truth;
                let commands = controller.update(&now.measured());
                now.pitch = commands.pitch;
                now.generator_torque = commands.generator_torque;
                let wind_speed = wind(now.time);
                now.aerodynamic_torque =
                    power(self.coefficient, wind_speed, now.rotor_speed, now.pitch.mean())
                        / now.rotor_speed;
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
pub(crate) fn spread(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    (mean, values.map(|v| (v - mean).abs()).fold(0.0, f64::max))
}

pub(crate) fn gusts(time: f64) -> f64 {
    10.5 + 2.5 * (0.05 * time).sin() + (0.31 * time).sin()
}

pub(crate) fn bits(run: &[Truth]) -> Vec<u64> {
    run.iter()
        .flat_map(|m| m.pitch.iter().copied().chain([m.generator_torque, m.rotor_speed]))
        .map(f64::to_bits)
        .collect()
}
