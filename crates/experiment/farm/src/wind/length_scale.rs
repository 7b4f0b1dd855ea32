//! How large the eddies of a wind are where its case does not say so.

use crate::case::{Shear, Wind};

/// 0.8 Λ₁ of IEC 61400-1 with Λ₁ = 42 m, for hubs at 60 m and higher (m). The standard has it for every hub
/// above 60 m, so that it is the least here and what stands where the wind does not shear.
pub(crate) const STANDARD: f64 = 33.6;
/// Most hub heights that an eddy at a hub is long: the ground and the top of a boundary layer are no farther.
const LONGEST: f64 = 2.0;

/// Length scale L of Mann's tensor (m) of `wind` at `hub_height` (m): what its case says, or else the
/// [usual] one.
///
/// [usual]: usual_length_scale
pub fn length_scale(wind: &Wind, hub_height: f64) -> f64 {
    let usual = || usual_length_scale(wind.shear, wind.turbulence_intensity, hub_height);
    wind.length_scale.unwrap_or_else(usual)
}

/// σ_u / (dU/dz) (m) at `hub_height` (m) in wind of `turbulence_intensity` (–), between [`STANDARD`] and
/// twice the hub height.
///
/// Source: Kelly (2018), Wind Energ. Sci. 3, 533: in neutral air σ_u / (dU/dz) is Mann's length scale, found
/// so from what an anemometer mast measures.
pub fn usual_length_scale(shear: Shear, turbulence_intensity: f64, hub_height: f64) -> f64 {
    // Heights over which the wind at the hub would change by as much as it is: U / (dU/dz).
    let depth = match shear {
        Shear::PowerLaw { exponent } if exponent > 0.0 => hub_height / exponent,
        Shear::PowerLaw { .. } => return STANDARD,
        Shear::LogLaw { roughness_length } => hub_height * (hub_height / roughness_length).ln(),
    };
    (turbulence_intensity * depth).min(LONGEST * hub_height).max(STANDARD)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{FROM_WEST, TurbulenceModel};

    fn wind(turbulence_intensity: f64, shear: Shear) -> Wind {
        Wind {
            speed: 9.0,
            direction: FROM_WEST,
            turbulence_intensity,
            shear,
            length_scale: None,
            anisotropy: 3.9,
            seed: 1,
            air_density: 1.225,
            kinematic_viscosity: 1.46e-5,
            turbulence_model: TurbulenceModel::Mann,
            grid: None,
            planes: None,
            precursor: None,
            precursor_beside: false,
            beyond_planes: None,
            cut: None,
            table: None,
            veer: 0.0,
            event: None,
        }
    }

    #[test]
    fn it_is_standard_deviation_over_shear() {
        // The slope of the profile itself, by a small step about the hub.
        let slope = |shear: Shear| {
            let speed = |z: f64| match shear {
                Shear::PowerLaw { exponent } => 9.0 * (z / 150.0_f64).powf(exponent),
                Shear::LogLaw { roughness_length } => {
                    9.0 * (z / roughness_length).ln() / (150.0 / roughness_length).ln()
                }
            };
            (speed(150.1) - speed(149.9)) / 0.2
        };
        for shear in [Shear::PowerLaw { exponent: 0.1 }, Shear::LogLaw { roughness_length: 0.01 }] {
            let expected = 0.05 * 9.0 / slope(shear);
            let found = length_scale(&wind(0.05, shear), 150.0);
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        }
    }

    #[test]
    fn it_stays_between_the_standard_and_twice_the_hub() {
        let found = |intensity, exponent| {
            length_scale(&wind(intensity, Shear::PowerLaw { exponent }), 150.0)
        };
        assert_eq!(found(0.01, 0.2), STANDARD);
        assert_eq!(found(0.2, 0.05), 300.0);
        for exponent in [0.0, -0.1] {
            assert_eq!(found(0.1, exponent), STANDARD);
        }
    }

    #[test]
    fn what_the_case_says_stands() {
        let given =
            Wind { length_scale: Some(12.0), ..wind(0.05, Shear::PowerLaw { exponent: 0.1 }) };
        assert_eq!(length_scale(&given, 150.0), 12.0);
    }
}
