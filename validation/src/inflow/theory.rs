//! Spectra that Mann's tensor implies, by numerical integration that shares nothing with the synthesis but Φ itself.

use basis::{Matrix3, Vector3};
use flow::inflow::{SpectralTensor, mann};
use std::f64::consts::PI;

/// Points along each half-axis of the lateral wave numbers.
const POINTS: usize = 96;
/// Points of the streamwise wave number in variances.
const POINTS_ALONG: usize = 160;
/// Wave number (times L) that stands for infinity: what lies beyond holds 1e-4 of the variance.
const INFINITE: f64 = 1e6;

/// Integrals of the tensor over a range of wave numbers, for αε^(2/3) = 1.
pub(super) struct Theory {
    tensor: SpectralTensor,
    /// Largest |k₁|, |k₂|, |k₃| (rad/m).
    limits: [f64; 3],
}

/// One-point spectra at one k₁, two-sided.
pub(super) struct At {
    /// F₁₁, F₂₂, F₃₃.
    pub(super) power: [f64; 3],
    /// F₁₃, real.
    pub(super) shear: f64,
}

impl Theory {
    /// Over all wave numbers.
    pub(super) fn unbounded(length_scale: f64, anisotropy: f64) -> Self {
        Self::new(length_scale, anisotropy, [INFINITE / length_scale; 3])
    }

    /// Over the wave numbers that a box of `settings` resolves.
    pub(super) fn resolved(settings: &mann::Settings) -> Self {
        let limits = settings.spacing.map(|spacing| PI / spacing);
        Self::new(settings.length_scale, settings.anisotropy, limits)
    }

    fn new(length_scale: f64, anisotropy: f64, limits: [f64; 3]) -> Self {
        match SpectralTensor::new(length_scale, anisotropy) {
            Ok(tensor) => Self { tensor, limits },
            Err(error) => panic!("the tensor of the validation cannot be made: {error}"),
        }
    }

    /// ∬ Φ(k₁, k₂, k₃) `of`(k₂, k₃) dk₂ dk₃ with points dense around zero: k = a sinh s, s equally spaced.
    fn integrate(&self, k1: f64, mut of: impl FnMut(Matrix3, f64, f64, f64)) {
        let a = 0.3 * k1.max(0.05 / self.tensor.length_scale());
        let axis = |limit: f64| {
            let step = (limit / a).asinh() / POINTS as f64;
            (0..POINTS).map(move |index| {
                let s = (index as f64 + 0.5) * step;
                (a * s.sinh(), a * s.cosh() * step)
            })
        };
        for (k2, weight2) in axis(self.limits[1]) {
            for (k3, weight3) in axis(self.limits[2]) {
                for k3 in [k3, -k3] {
                    // What is odd in k₂ cancels in every integral asked for here, the rest counts twice.
                    let density = self.tensor.density(Vector3::new(k1, k2, k3));
                    of(density, k2, k3, 2.0 * weight2 * weight3);
                }
            }
        }
    }

    /// One-point spectra at k₁ (rad/m).
    pub(super) fn one_point(&self, k1: f64) -> At {
        let mut sum = Matrix3::ZERO;
        self.integrate(k1, |density, _, _, weight| sum += density * weight);
        At { power: [sum.x_axis.x, sum.y_axis.y, sum.z_axis.z], shear: sum.x_axis.z }
    }

    /// Cross-spectrum of u at points `apart` (m along y, z), real and imaginary part, at k₁ (rad/m).
    pub(super) fn cross(&self, k1: f64, apart: [f64; 2]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        self.integrate(k1, |density, k2, k3, weight| {
            let lateral = weight * density.x_axis.x * (k2 * apart[0]).cos();
            sum[0] += lateral * (k3 * apart[1]).cos();
            sum[1] += lateral * (k3 * apart[1]).sin();
        });
        sum
    }

    /// Variances of u, v, w.
    pub(super) fn variances(&self) -> [f64; 3] {
        let a = 0.02 / self.tensor.length_scale();
        let step = (self.limits[0] / a).asinh() / POINTS_ALONG as f64;
        let mut sum = [0.0; 3];
        for index in 0..POINTS_ALONG {
            let s = (index as f64 + 0.5) * step;
            let at = self.one_point(a * s.sinh());
            for (sum, power) in sum.iter_mut().zip(at.power) {
                *sum += 2.0 * a * s.cosh() * step * power;
            }
        }
        sum
    }
}
