//! Mann's spectral tensor of uniformly sheared turbulence.

use super::lifetime::EddyLifetime;
use super::{InflowError, not_negative, positive};
use basis::{Matrix3, Vector3};

/// Spectral tensor Φᵢⱼ(k) of turbulence in uniform shear, for αε^(2/3) = 1 (m^(4/3)/s²).
///
/// Isotropic turbulence with von Karman's energy spectrum is sheared by the mean wind for the lifetime of
/// each eddy; components 1, 2, 3 run along x downwind, y left, z up, the mean wind grows with z.
/// Source: [Mann1994, eqs. 3.13-3.18]; [Mann1998, eqs. 10-13]. Limits: neutral, no blocking by the ground.
#[derive(Clone, Debug)]
pub struct SpectralTensor {
    length_scale: f64,
    lifetime: EddyLifetime,
}

impl SpectralTensor {
    /// For length scale L (m) and anisotropy Γ (–); Γ = 0 is isotropic.
    ///
    /// # Errors
    /// [`InflowError::Setting`] when L is not positive or Γ negative.
    pub fn new(length_scale: f64, anisotropy: f64) -> Result<Self, InflowError> {
        positive("length scale (m)", length_scale)?;
        not_negative("anisotropy Γ (–)", anisotropy)?;
        Ok(Self { length_scale, lifetime: EddyLifetime::new(anisotropy, length_scale) })
    }

    /// Length scale L (m).
    pub fn length_scale(&self) -> f64 {
        self.length_scale
    }

    /// Energy spectrum E(k) of von Karman (m³/s² for αε^(2/3) = 1) at `wave_number` (rad/m):
    /// L^(5/3) (Lk)⁴ / (1 + (Lk)²)^(17/6). Source: [Mann1998, eq. 9].
    pub fn energy(&self, wave_number: f64) -> f64 {
        let squared = (self.length_scale * wave_number).powi(2);
        self.length_scale.powf(5.0 / 3.0) * squared * squared / (1.0 + squared).powf(17.0 / 6.0)
    }

    /// A square root of the tensor: C with C Cᵀ = Φ (C in m^(3/2) m/s) at wave vector `k` (rad/m), not zero.
    /// Its columns are normal to `k`. Source: [Mann1998, eq. 22 with eqs. 11-13].
    pub fn factor(&self, k: Vector3) -> Matrix3 {
        // Symbols of [Mann1998]: beta sheared distance, k0 wave vector before the shear, zeta of eq. 11.
        let squared = k.length_squared();
        let beta = self.lifetime.at(squared.sqrt());
        let k30 = k.z + beta * k.x;
        let horizontal = k.x * k.x + k.y * k.y;
        let k0_squared = horizontal + k30 * k30;
        let (zeta1, zeta2) = if horizontal < 1e-24 * squared {
            // A horizontal wave moves no air up or down, which is all that ζ multiplies.
            (0.0, 0.0)
        } else {
            let c1_over_k1 = beta * k.x * (k0_squared - 2.0 * k30 * k30 + beta * k.x * k30)
                / (squared * horizontal);
            let root = horizontal.sqrt();
            // C₂/k₁ has a limit at k₁ = 0, where the formula itself is 0/0.
            let c2_over_k1 = if k.x.abs() < 1e-9 * root {
                beta * k.y / horizontal
            } else {
                let angle = (beta * k.x * root).atan2(k0_squared - k30 * k.x * beta);
                k.y * k0_squared / (horizontal * root) * angle / k.x
            };
            (k.x * c1_over_k1 - k.y * c2_over_k1, k.y * c1_over_k1 + k.x * c2_over_k1)
        };
        let stretched = k0_squared / squared;
        let amplitude =
            (self.energy(k0_squared.sqrt()) / (4.0 * std::f64::consts::PI)).sqrt() / k0_squared;
        amplitude
            * Matrix3::from_cols(
                Vector3::new(k.y * zeta1, k.y * zeta2 - k30, stretched * k.y),
                Vector3::new(k30 - k.x * zeta1, -k.x * zeta2, -stretched * k.x),
                Vector3::new(-k.y, k.x, 0.0),
            )
    }

    /// Φ(k) (m³ m²/s² for αε^(2/3) = 1), symmetric, at wave vector `k` (rad/m), not zero.
    pub fn density(&self, k: Vector3) -> Matrix3 {
        let factor = self.factor(k);
        factor * factor.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn largest(matrix: Matrix3) -> f64 {
        matrix.to_cols_array().iter().fold(0.0, |largest, value| value.abs().max(largest))
    }

    #[test]
    fn refuses_what_is_no_length_or_anisotropy() {
        assert!(SpectralTensor::new(0.0, 3.9).is_err());
        assert!(SpectralTensor::new(f64::NAN, 3.9).is_err());
        assert!(SpectralTensor::new(33.6, -1.0).is_err());
    }

    proptest! {
        /// Without shear: E(k) / (4π k⁴) (k² δᵢⱼ − kᵢ kⱼ).
        #[test]
        fn is_von_karmans_without_shear(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
            let k = Vector3::new(x, y, z);
            prop_assume!(k.length() > 1e-3);
            let tensor = SpectralTensor::new(33.6, 0.0).unwrap();
            let squared = k.length_squared();
            let outer = Matrix3::from_cols(k.x * k, k.y * k, k.z * k);
            let expected = (tensor.energy(k.length()) / (4.0 * std::f64::consts::PI * squared * squared))
                * (Matrix3::from_diagonal(Vector3::splat(squared)) - outer);
            prop_assert!(largest(tensor.density(k) - expected) < 1e-12 * largest(expected));
        }

        #[test]
        fn is_free_of_divergence(
            x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64, anisotropy in 0.0..6.0_f64,
        ) {
            let k = Vector3::new(x, y, z);
            prop_assume!(k.length() > 1e-3);
            let factor = SpectralTensor::new(33.6, anisotropy).unwrap().factor(k);
            let along = factor.transpose() * k;
            prop_assert!(along.length() < 1e-10 * largest(factor) * k.length());
        }

        /// The limit at k₁ = 0 joins what lies beside it.
        #[test]
        fn is_continuous_across_the_lateral_plane(y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
            prop_assume!(y.abs() > 1e-2);
            let tensor = SpectralTensor::new(33.6, 3.9).unwrap();
            let on = tensor.density(Vector3::new(0.0, y, z));
            let beside = tensor.density(Vector3::new(1e-7 * y, y, z));
            prop_assert!(largest(on - beside) < 1e-4 * largest(on));
        }

        /// Φ(−k) = Φ(k), since Φ is real; and a mirror in y changes the sign of what is odd in y.
        #[test]
        fn has_the_symmetries_of_sheared_flow(
            x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64,
        ) {
            let k = Vector3::new(x, y, z);
            prop_assume!(k.length() > 1e-2);
            let tensor = SpectralTensor::new(33.6, 3.9).unwrap();
            let density = tensor.density(k);
            prop_assert!(largest(tensor.density(-k) - density) < 1e-9 * largest(density));
            let mirror = Matrix3::from_diagonal(Vector3::new(1.0, -1.0, 1.0));
            let mirrored = mirror * tensor.density(mirror * k) * mirror;
            prop_assert!(largest(mirrored - density) < 1e-9 * largest(density));
        }
    }
}
