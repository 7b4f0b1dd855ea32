//! Spectra that Mann's tensor implies, by numerical integration that shares nothing with the synthesis but Φ
//! itself.

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
    largest: [f64; 3],
    /// Half-widths of the cell around zero (rad/m). Waves whose k₂ and k₃ lie in it are uniform across a box;
    /// there a field without divergence has no u, and at k₁ in it, too, the box has its mean, which is zero.
    uniform: [f64; 3],
}

/// One-point spectra at one k₁, two-sided.
#[derive(Clone, Copy)]
pub(super) struct At {
    /// F₁₁, F₂₂, F₃₃.
    pub(super) power: [f64; 3],
    /// F₁₃, real.
    pub(super) shear: f64,
}

impl Theory {
    /// Over all wave numbers.
    pub(super) fn unbounded(length_scale: f64, anisotropy: f64) -> Self {
        Self::new(length_scale, anisotropy, [INFINITE / length_scale; 3], [0.0; 3])
    }

    /// Over the wave numbers that a box of `settings` can hold.
    pub(super) fn resolved(settings: &mann::MannSettings) -> Self {
        let largest = settings.spacing.map(|spacing| PI / spacing);
        let uniform = [0, 1, 2].map(|axis| largest[axis] / settings.n_points[axis] as f64);
        Self::new(settings.length_scale, settings.anisotropy, largest, uniform)
    }

    fn new(length_scale: f64, anisotropy: f64, largest: [f64; 3], uniform: [f64; 3]) -> Self {
        match SpectralTensor::new(length_scale, anisotropy) {
            Ok(tensor) => Self { tensor, largest, uniform },
            Err(error) => panic!("the tensor of the validation cannot be made: {error}"),
        }
    }

    /// One-point spectra at k₁ (rad/m).
    pub(super) fn one_point(&self, k1: f64) -> At {
        let all = self.within(k1, self.largest);
        let uniform = self.within(k1, self.uniform);
        At {
            power: [all.x_axis.x - uniform.x_axis.x, all.y_axis.y, all.z_axis.z],
            shear: all.x_axis.z - uniform.x_axis.z,
        }
    }

    /// Cross-spectrum of u at points `apart` (m along y, z), real and imaginary part, at k₁ (rad/m).
    pub(super) fn cross(&self, k1: f64, apart: [f64; 2]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (sign, limits) in [(1.0, self.largest), (-1.0, self.uniform)] {
            self.integrate(k1, limits, |density, k2, k3, weight| {
                let lateral = sign * weight * density.x_axis.x * (k2 * apart[0]).cos();
                sum[0] += lateral * (k3 * apart[1]).cos();
                sum[1] += lateral * (k3 * apart[1]).sin();
            });
        }
        sum
    }

    /// Variances of u, v, w.
    pub(super) fn variances(&self) -> [f64; 3] {
        let all = self.along(self.largest[0], |k1| self.one_point(k1).power);
        let mean = self.along(self.uniform[0], |k1| {
            let uniform = self.within(k1, self.uniform);
            [0.0, uniform.y_axis.y, uniform.z_axis.z]
        });
        [0, 1, 2].map(|component| all[component] - mean[component])
    }

    /// ∫ `of`(k₁) dk₁ over |k₁| up to `limit`.
    fn along(&self, limit: f64, of: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
        let a = 0.02 / self.tensor.length_scale();
        let step = (limit / a).asinh() / POINTS_ALONG as f64;
        let mut sum = [0.0; 3];
        for index in 0..POINTS_ALONG {
            let s = (index as f64 + 0.5) * step;
            for (sum, power) in sum.iter_mut().zip(of(a * s.sinh())) {
                *sum += 2.0 * a * s.cosh() * step * power;
            }
        }
        sum
    }

    /// ∬ Φ dk₂ dk₃ over |k₂|, |k₃| up to `limits`.
    fn within(&self, k1: f64, limits: [f64; 3]) -> Matrix3 {
        let mut sum = Matrix3::ZERO;
        self.integrate(k1, limits, |density, _, _, weight| sum += density * weight);
        sum
    }

    /// ∬ Φ(k₁, k₂, k₃) `of`(k₂, k₃) dk₂ dk₃ with points dense around zero: k = a sinh s, s equally spaced.
    fn integrate(&self, k1: f64, limits: [f64; 3], mut of: impl FnMut(Matrix3, f64, f64, f64)) {
        let a = 0.3 * k1.max(0.05 / self.tensor.length_scale());
        let axis = |limit: f64| {
            let step = (limit / a).asinh() / POINTS as f64;
            (0..POINTS).map(move |index| {
                let s = (index as f64 + 0.5) * step;
                (a * s.sinh(), a * s.cosh() * step)
            })
        };
        if limits[1] == 0.0 || limits[2] == 0.0 {
            return;
        }
        for (k2, weight2) in axis(limits[1]) {
            for (k3, weight3) in axis(limits[2]) {
                for k3 in [k3, -k3] {
                    // What is odd in k₂ cancels in every integral asked for here, the rest counts twice.
                    let density = self.tensor.density(Vector3::new(k1, k2, k3));
                    of(density, k2, k3, 2.0 * weight2 * weight3);
                }
            }
        }
    }
}
