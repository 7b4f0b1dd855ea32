//! Rotor-effective wind speed by an extended Kalman filter on rotor speed.

use super::constants::WindSpeedEstimator;
use lti::LowPass;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Length scale of turbulence over rotor radius (–).
const LENGTH_SCALE: f64 = 6.0;
/// Turbulence intensity that the filter expects (–).
const TURBULENCE_INTENSITY: f64 = 0.18;
/// Power of what drives rotor speed beside the modelled torque ((rad/s)²/s).
const SPEED_NOISE: f64 = 1e-5;
/// Power of the drift of the mean wind ((m/s)²/s): 2 m/s in ten minutes.
const MEAN_NOISE: f64 = 2.0 * 2.0 / 600.0;
/// Power of the noise on measured rotor speed ((rad/s)² s): 0.02 (rad/s)² in every sample at the 0.02 s of
/// common simulations. As a power it gives the same estimate at any interval.
const MEASUREMENT_NOISE: f64 = 0.02 * 0.02;
/// First variances of rotor speed ((rad/s)²), turbulence and mean wind ((m/s)²).
const FIRST_VARIANCES: [f64; 3] = [0.01, 0.01, 1.0];
/// Least wind speed (m/s), rotor speed (rad/s) and power coefficient (–) that the model is evaluated at.
const LEAST_WIND_SPEED: f64 = 1.0;
const LEAST_ROTOR_SPEED: f64 = 1e-2;
const LEAST_POWER_COEFFICIENT: f64 = 0.01;

/// State of the estimator.
///
/// Rotor speed turns by J ω′ = ½ ρ π R² v³ C_P(λ, β)/ω − Q with v = v_t + v_m; turbulence v_t fades as
/// v_t′ = −π v_m/(2 L) v_t + noise, the mean v_m drifts. Where all stands still the estimate is the wind in
/// which the *table's* rotor gives the torque that the real one gives, so an error ε of the table's power
/// coefficient is an error of −ε/3 of the wind speed.
///
/// Source: Abbas, Zalkind, Pao, Wright, Wind Energ. Sci. 7, 53–73, 2022, §2.4; model of the wind after
/// Knudsen, Bak, Soltani, "Prediction models for wind speed at turbine locations in a wind farm", Wind Energy
/// 14, 2011. Limits: intervals up to about 0.5 s; noise on measured speed is per second, not per sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Estimator {
    rotor_speed: f64,
    turbulence: f64,
    mean: f64,
    covariance: [[f64; 3]; 3],
    smoothed: LowPass,
}

impl Estimator {
    /// An estimator that has settled where a rotor of radius `rotor_radius` (m) turns steadily at
    /// `rotor_speed` (rad/s) under `torque` (N m) and `pitch` (rad).
    pub(super) fn settled(
        rotor_speed: f64,
        torque: f64,
        pitch: f64,
        rotor_radius: f64,
        constants: &WindSpeedEstimator,
        filter_corner: f64,
    ) -> Self {
        let wind_speed = steady_wind_speed(rotor_speed, torque, pitch, rotor_radius, constants);
        let mut covariance = [[0.0; 3]; 3];
        for (k, variance) in FIRST_VARIANCES.into_iter().enumerate() {
            covariance[k][k] = variance;
        }
        Self {
            rotor_speed: rotor_speed.max(0.0),
            turbulence: 0.0,
            mean: wind_speed,
            covariance,
            smoothed: LowPass::settled(filter_corner, wind_speed),
        }
    }

    /// Smoothed wind speed (m/s) after `interval` (s) with `torque` (N m) at the generator and `pitch` (rad),
    /// at whose end `rotor_speed` (rad/s) is measured.
    pub(super) fn update(
        &mut self,
        interval: f64,
        rotor_speed: f64,
        torque: f64,
        pitch: f64,
        rotor_radius: f64,
        constants: &WindSpeedEstimator,
    ) -> f64 {
        self.predict(interval, rotor_speed, torque, pitch, rotor_radius, constants);
        self.correct(interval, rotor_speed);
        self.smoothed.update(interval, self.wind_speed())
    }

    /// Wind speed (m/s).
    pub(super) fn wind_speed(&self) -> f64 {
        (self.turbulence + self.mean).max(LEAST_WIND_SPEED)
    }

    /// Wind speed smoothed (m/s).
    pub(super) fn smoothed(&self) -> f64 {
        self.smoothed.value()
    }

    fn predict(
        &mut self,
        interval: f64,
        rotor_speed: f64,
        torque: f64,
        pitch: f64,
        rotor_radius: f64,
        constants: &WindSpeedEstimator,
    ) {
        // Symbols of the source: v wind, omega rotor speed, lambda tip-speed ratio, cp power coefficient, f
        // Jacobian of the states' rates, p covariance, q power of the noise that drives them.
        let (v, omega) = (self.wind_speed(), rotor_speed.max(LEAST_ROTOR_SPEED));
        let lambda = omega * rotor_radius / v;
        let table = &constants.coefficients;
        let cp = table.power(lambda, pitch).max(LEAST_POWER_COEFFICIENT);
        let slope = table.power_slope(lambda, pitch);
        let scale = half_density_area(rotor_radius, constants) / (constants.inertia * omega);
        let acceleration = scale * v.powi(3) * cp - torque / constants.inertia;
        // Deep in stall more wind may give less torque; a gain of the wrong sign would never find back.
        let by_wind = scale * v * v * (3.0 * cp - lambda * slope).max(cp);
        let by_speed = scale * v.powi(3) * (lambda * slope - cp) / omega;
        let mean = self.mean.max(LEAST_WIND_SPEED);
        let fading = PI * mean / (2.0 * LENGTH_SCALE * rotor_radius);
        let f = [
            [by_speed, by_wind, by_wind],
            [0.0, -fading, -fading * self.turbulence / mean],
            [0.0; 3],
        ];
        let gustiness = PI * mean.powi(3) * TURBULENCE_INTENSITY * TURBULENCE_INTENSITY
            / (LENGTH_SCALE * rotor_radius);
        let q = [SPEED_NOISE, gustiness, MEAN_NOISE];

        self.rotor_speed += interval * acceleration;
        self.turbulence -= interval * fading * self.turbulence;
        let p = self.covariance;
        for i in 0..3 {
            for j in 0..3 {
                let spread: f64 = (0..3).map(|k| f[i][k] * p[k][j] + p[i][k] * f[j][k]).sum();
                self.covariance[i][j] += interval * (spread + if i == j { q[i] } else { 0.0 });
            }
        }
    }

    fn correct(&mut self, interval: f64, rotor_speed: f64) {
        if !rotor_speed.is_finite() {
            return;
        }
        let p = self.covariance;
        let variance = p[0][0] + MEASUREMENT_NOISE / interval;
        let gain = [p[0][0], p[1][0], p[2][0]].map(|covariance| covariance / variance);
        let error = rotor_speed - self.rotor_speed;
        self.rotor_speed += gain[0] * error;
        self.turbulence += gain[1] * error;
        self.mean = (self.mean + gain[2] * error).max(LEAST_WIND_SPEED);
        for (row, gain) in self.covariance.iter_mut().zip(gain) {
            for (entry, first) in row.iter_mut().zip(p[0]) {
                *entry -= gain * first;
            }
        }
    }
}

/// Wind speed (m/s) in which the table's rotor, radius `rotor_radius` (m), turns steadily at `rotor_speed`
/// (rad/s) under `torque` (N m) and `pitch` (rad).
pub(super) fn steady_wind_speed(
    rotor_speed: f64,
    torque: f64,
    pitch: f64,
    rotor_radius: f64,
    constants: &WindSpeedEstimator,
) -> f64 {
    let tip_speed = rotor_speed.max(LEAST_ROTOR_SPEED) * rotor_radius;
    let full = half_density_area(rotor_radius, constants) * tip_speed.powi(3);
    let power = torque.max(0.0) * rotor_speed.max(0.0);
    let ratio = constants.coefficients.tip_speed_ratio(power / full, pitch);
    (tip_speed / ratio).max(LEAST_WIND_SPEED)
}

/// ½ ρ π R² (kg/m).
fn half_density_area(rotor_radius: f64, constants: &WindSpeedEstimator) -> f64 {
    0.5 * constants.air_density * PI * rotor_radius * rotor_radius
}
