//! What IEC 61400-1 says of wind: turbulence classes, Kaimal's spectra, coherence, sizes of gusts.
//!
//! Source throughout: [IEC61400-1, edition 3 (2005)], §6.3 and annex B; edition numbers matter, since scales
//! and the coherence length differ from edition 2.

use super::{InflowError, positive};
use serde::{Deserialize, Serialize};

/// Standard deviations of u, v, w over that of u (–), §B.2 table B.1.
pub const DEVIATION_RATIOS: [f64; 3] = [1.0, 0.8, 0.5];
/// Integral scales of u, v, w over Λ₁ (–), table B.1.
pub const SCALE_RATIOS: [f64; 3] = [8.1, 2.7, 0.66];
/// Decay of coherence with distance (–), eq. B.16.
const COHERENCE_DECAY: f64 = 12.0;
/// Weight of distance over the coherence length (–), eq. B.16.
const COHERENCE_OFFSET: f64 = 0.12;

/// Category of turbulence at a site, §6.2 table 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum TurbulenceClass {
    /// Higher: 16 % at 15 m/s.
    A,
    /// Medium: 14 %.
    B,
    /// Lower: 12 %.
    C,
}

impl TurbulenceClass {
    /// Expected intensity at 15 m/s (–).
    pub fn reference_intensity(self) -> f64 {
        match self {
            Self::A => 0.16,
            Self::B => 0.14,
            Self::C => 0.12,
        }
    }

    /// Standard deviation of u (m/s) at hub speed `hub_speed` (m/s), 90 % quantile: normal turbulence model,
    /// eq. 11.
    pub fn standard_deviation(self, hub_speed: f64) -> f64 {
        self.reference_intensity() * (0.75 * hub_speed + 5.6)
    }
}

/// Longitudinal turbulence scale Λ₁ (m) at hub height `hub_height` (m), eq. 5.
pub fn turbulence_scale(hub_height: f64) -> f64 {
    0.7 * hub_height.min(60.0)
}

/// Kaimal's spectra with exponential coherence at one hub height and speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kaimal {
    hub_speed: f64,
    turbulence_scale: f64,
    standard_deviation: f64,
}

impl Kaimal {
    /// The model for `hub_height` (m), `hub_speed` (m/s) and the standard deviation of u `standard_deviation`
    /// (m/s).
    ///
    /// # Errors
    /// [`InflowError::Setting`] for a height or speed that is not positive, or a negative deviation.
    pub fn new(
        hub_height: f64,
        hub_speed: f64,
        standard_deviation: f64,
    ) -> Result<Self, InflowError> {
        positive("hub height (m)", hub_height)?;
        positive("mean speed at hub height (m/s)", hub_speed)?;
        super::not_negative("standard deviation (m/s)", standard_deviation)?;
        let turbulence_scale = turbulence_scale(hub_height);
        Ok(Self { hub_speed, turbulence_scale, standard_deviation })
    }

    /// Standard deviations of u, v, w (m/s) over all frequencies.
    pub fn standard_deviations(&self) -> [f64; 3] {
        DEVIATION_RATIOS.map(|ratio| ratio * self.standard_deviation)
    }

    /// Power of component 0 to 2 (u, v, w) at `frequency` (Hz), one-sided (m²/s² per Hz), eq. B.14.
    pub fn spectrum(&self, component: usize, frequency: f64) -> f64 {
        let time_scale = SCALE_RATIOS[component] * self.turbulence_scale / self.hub_speed;
        let deviation = DEVIATION_RATIOS[component] * self.standard_deviation;
        4.0 * deviation * deviation * time_scale
            / (1.0 + 6.0 * frequency * time_scale).powf(5.0 / 3.0)
    }

    /// Variance of component 0 to 2 (m²/s²) between frequencies `from` and `to` (Hz), in closed form.
    pub fn variance_between(&self, component: usize, from: f64, to: f64) -> f64 {
        let time_scale = SCALE_RATIOS[component] * self.turbulence_scale / self.hub_speed;
        let deviation = DEVIATION_RATIOS[component] * self.standard_deviation;
        let above = |frequency: f64| (1.0 + 6.0 * frequency * time_scale).powf(-2.0 / 3.0);
        deviation * deviation * (above(from) - above(to))
    }

    /// Coherence of u (–) at points `distance` (m) apart across the wind at `frequency` (Hz), eq. B.16: the
    /// modulus of the cross-spectrum over the spectrum, not its square.
    pub fn coherence(&self, frequency: f64, distance: f64) -> f64 {
        (-self.coherence_decay(frequency) * distance).exp()
    }

    /// Rate (1/m) at which coherence at `frequency` (Hz) falls with distance.
    pub(crate) fn coherence_decay(&self, frequency: f64) -> f64 {
        let length = SCALE_RATIOS[0] * self.turbulence_scale;
        COHERENCE_DECAY * (frequency / self.hub_speed).hypot(COHERENCE_OFFSET / length)
    }
}

/// Peak deficit of the extreme operating gust (m/s), eq. 17.
///
/// `standard_deviation` (m/s) of u, speed `hub_speed` (m/s) at `hub_height` (m), rotor diameter `diameter`
/// (m), reference speed of the class `reference_speed` (m/s): 50, 42.5, 37.5 for I, II, III.
pub fn operating_gust(
    standard_deviation: f64,
    hub_speed: f64,
    hub_height: f64,
    diameter: f64,
    reference_speed: f64,
) -> f64 {
    // At the hub V_e1 = 0.8 · 1.4 V_ref, eqs. 14 and 15.
    let of_year = 1.35 * (0.8 * 1.4 * reference_speed - hub_speed);
    let of_turbulence =
        3.3 * standard_deviation / (1.0 + 0.1 * diameter / turbulence_scale(hub_height));
    of_year.min(of_turbulence)
}

/// Change of direction (rad, at most π) of the extreme direction change, eq. 20; arguments as in
/// [`operating_gust`].
pub fn direction_change(
    standard_deviation: f64,
    hub_speed: f64,
    hub_height: f64,
    diameter: f64,
) -> f64 {
    let scaled = 1.0 + 0.1 * diameter / turbulence_scale(hub_height);
    (4.0 * (standard_deviation / (hub_speed * scaled)).atan()).min(std::f64::consts::PI)
}

/// Rise of speed in the extreme coherent gust (m/s), §6.3.2.5.
pub const COHERENT_GUST: f64 = 15.0;

/// Change of direction (rad) that comes with the coherent gust at `hub_speed` (m/s), eq. 23.
pub fn coherent_direction_change(hub_speed: f64) -> f64 {
    (720.0 / hub_speed.max(4.0)).to_radians()
}

/// Largest change of speed (m/s) one rotor radius off the hub in the extreme wind shear, eqs. 26 and 27;
/// arguments as in [`operating_gust`].
pub fn extreme_shear(standard_deviation: f64, hub_height: f64, diameter: f64) -> f64 {
    let scaled = (diameter / turbulence_scale(hub_height)).powf(0.25);
    // (1/2)(2.5 + 0.2 β σ₁ (D/Λ₁)^¼) (1 − cos) with β = 6.4: at half a diameter and mid-time (1 − cos) is 2.
    2.5 + 0.2 * 6.4 * standard_deviation * scaled
}

#[cfg(test)]
mod tests {
    use super::*;

    /// TurbSim's summary for 9 m/s and 6 % at 150 m: scale 42 m, integral scale 340.2 m, coherence decay 12
    /// with offset 0.353e-3/m.
    #[test]
    fn agrees_with_turbsim() {
        let model = Kaimal::new(150.0, 9.0, 0.54).unwrap();
        assert!((turbulence_scale(150.0) - 42.0).abs() < 1e-12);
        assert!((SCALE_RATIOS[0] * turbulence_scale(150.0) - 340.2).abs() < 1e-9);
        assert!((model.coherence_decay(0.0) - 12.0 * 0.353e-3).abs() < 12.0 * 0.5e-6);
    }

    #[test]
    fn spectra_hold_their_variance() {
        let model = Kaimal::new(90.0, 11.0, 1.7).unwrap();
        for component in 0..3 {
            let step = 1e-4;
            let sum: f64 =
                (0..100_000).map(|n| model.spectrum(component, (f64::from(n) + 0.5) * step)).sum();
            let expected = model.variance_between(component, 0.0, 10.0);
            assert!((sum * step / expected - 1.0).abs() < 1e-4);
            let all = model.standard_deviations()[component].powi(2);
            assert!((model.variance_between(component, 0.0, 1e9) / all - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn coherence_starts_at_one_and_falls() {
        let model = Kaimal::new(150.0, 9.0, 0.54).unwrap();
        assert_eq!(model.coherence(0.3, 0.0), 1.0);
        let expected = (-12.0_f64 * (0.03_f64 / 9.0).hypot(0.12 / 340.2) * 40.0).exp();
        assert!((model.coherence(0.03, 40.0) - expected).abs() < 1e-12);
        assert!(model.coherence(0.3, 80.0) < model.coherence(0.3, 40.0));
    }

    /// Class A at 15 m/s: σ₁ = 0.16 (0.75 · 15 + 5.6) = 2.696 m/s.
    #[test]
    fn classes_meet_the_standard() {
        assert!((TurbulenceClass::A.standard_deviation(15.0) - 2.696).abs() < 1e-12);
        let ratio =
            TurbulenceClass::C.standard_deviation(8.0) / TurbulenceClass::B.standard_deviation(8.0);
        assert!((ratio - 12.0 / 14.0).abs() < 1e-12);
    }

    #[test]
    fn gusts_are_bounded() {
        assert_eq!(coherent_direction_change(2.0), std::f64::consts::PI);
        assert!((coherent_direction_change(12.0) - 60_f64.to_radians()).abs() < 1e-12);
        assert!(direction_change(1e9, 5.0, 90.0, 126.0) <= std::f64::consts::PI);
        // Near V_e1 the year's gust is the smaller one.
        assert!((operating_gust(3.0, 55.0, 90.0, 126.0, 50.0) - 1.35).abs() < 1e-9);
    }
}
