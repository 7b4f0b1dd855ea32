//! The models' formulas at a cell, in lattice units: the filter is one cell wide.

use super::slopes::WarmSlope;
use crate::lattice::atmosphere::coefficients::Coefficients;
use crate::lattice::subgrid::SubgridModel;
use crate::simd::Simd;

/// Square of a gradient that counts as none (per step²): a wind of a tenth of a cell a step is known to 1e-8
/// in single precision, and its slopes no better.
const NONE: f32 = 1e-20;

/// Slope of velocity i along axis j (per step).
type Gradient<S> = [[S; 3]; 3];

/// A model and its constant.
pub(super) struct Viscosity<S> {
    pub(super) model: SubgridModel,
    pub(super) factor: S,
}

/// What temperature does to eddies.
pub(super) struct Heat<S> {
    /// Upward acceleration per kelvin.
    buoyancy: S,
    /// Diffusivity over viscosity.
    per_prandtl: S,
    /// The air's own diffusivity.
    conductivity: S,
}

impl<S: Simd> Heat<S> {
    /// That of `coefficients`.
    #[inline(always)]
    pub(super) fn new(coefficients: &Coefficients) -> Self {
        Self {
            buoyancy: S::splat(coefficients.buoyancy),
            per_prandtl: S::splat(coefficients.eddy_diffusivity),
            conductivity: S::splat(coefficients.conductivity),
        }
    }
}

impl<S: Simd> Viscosity<S> {
    /// Viscosity of eddies under the gradient `g` of the wind (cells² a step).
    #[inline(always)]
    pub(super) fn neutral(&self, g: &Gradient<S>) -> S {
        match self.model {
            SubgridModel::Wale => self.factor * wale(g),
            SubgridModel::Vreman => self.factor * vreman(g),
            _ => self.factor * minimum_dissipation(g, S::splat(0.0)),
        }
    }

    /// Viscosity of eddies, and diffusivity with the air's own, under the gradients `g` of the wind and
    /// `warm` of temperature.
    #[inline(always)]
    pub(super) fn stratified(
        &self,
        g: &Gradient<S>,
        warm: &WarmSlope<S>,
        heat: &Heat<S>,
    ) -> [S; 2] {
        let zero = S::splat(0.0);
        if self.model == SubgridModel::MinimumDissipation {
            // Energy that heavy air takes, or light air gives: that of ∂w/∂k ∂(θ − ⟨θ⟩)/∂k.
            let [tx, ty, _] = warm.along;
            let [wx, wy, wz] = g[2];
            let lift = heat.buoyancy * wx.mul_add(tx, wy.mul_add(ty, wz * warm.departing));
            let viscosity = self.factor * minimum_dissipation(g, lift);
            let diffusivity = self.factor * minimum_variance(g, &warm.along);
            return [viscosity, heat.conductivity + diffusivity];
        }
        // Against the square of all slopes, which in pure shear is that of the strain: air that turns without
        // strain has eddies by these models, and unstable air there would have them without bound.
        let neutral = self.neutral(g);
        let stability = heat.buoyancy * warm.along[2];
        let share = (heat.per_prandtl * stability).divide(squared(&products(g)));
        let viscosity = neutral * (S::splat(1.0) - share).maximum(zero).sqrt();
        [viscosity, heat.per_prandtl.mul_add(viscosity, heat.conductivity)]
    }
}

/// Rate of strain of `g`: xx, yy, zz, xy, xz, yz.
#[inline(always)]
fn strain<S: Simd>(g: &Gradient<S>) -> [S; 6] {
    let half = S::splat(0.5);
    [
        g[0][0],
        g[1][1],
        g[2][2],
        half * (g[0][1] + g[1][0]),
        half * (g[0][2] + g[2][0]),
        half * (g[1][2] + g[2][1]),
    ]
}

/// The sum of products of two symmetric tensors.
#[inline(always)]
fn contracted<S: Simd>(a: &[S; 6], b: &[S; 6]) -> S {
    let normal = a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]));
    let shear = a[3].mul_add(b[3], a[4].mul_add(b[4], a[5] * b[5]));
    S::splat(2.0).mul_add(shear, normal)
}

/// The sum of products of two vectors.
#[inline(always)]
fn dot<S: Simd>(a: &[S; 3], b: &[S; 3]) -> S {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// ∂u_i/∂x_k ∂u_j/∂x_k: xx, yy, zz, xy, xz, yz.
#[inline(always)]
fn products<S: Simd>(g: &Gradient<S>) -> [S; 6] {
    let [u, v, w] = g;
    [dot(u, u), dot(v, v), dot(w, w), dot(u, v), dot(u, w), dot(v, w)]
}

/// Square of all slopes, and at least [`NONE`].
#[inline(always)]
fn squared<S: Simd>([xx, yy, zz, ..]: &[S; 6]) -> S {
    (*xx + *yy + *zz).maximum(S::splat(NONE))
}

/// √(B/(α α)) of Vreman (2004), eq. 5.
#[inline(always)]
fn vreman<S: Simd>(g: &Gradient<S>) -> S {
    let beta = products(g);
    let [xx, yy, zz, xy, xz, yz] = beta;
    let q = squared(&beta);
    let minors = [xy.sub_from(xy, xx * yy), xz.sub_from(xz, xx * zz), yz.sub_from(yz, yy * zz)];
    let b = (minors[0] + minors[1] + minors[2]).maximum(S::splat(0.0));
    b.divide(q).sqrt()
}

/// (S^d S^d)^(3/2) / ((S S)^(5/2) + (S^d S^d)^(5/4)) of Nicoud and Ducros (1999), eq. 13, of a gradient that
/// is scaled to one so that single precision holds the powers.
#[inline(always)]
fn wale<S: Simd>(g: &Gradient<S>) -> S {
    let q = squared(&products(g));
    let mut square = [[S::splat(0.0); 3]; 3];
    for (row, of_row) in g.iter().zip(&mut square) {
        for (j, value) in of_row.iter_mut().enumerate() {
            *value = dot(row, &[g[0][j], g[1][j], g[2][j]]);
        }
    }
    let third = S::splat(1.0 / 3.0) * (square[0][0] + square[1][1] + square[2][2]);
    let mut d = strain(&square);
    for normal in &mut d[..3] {
        *normal = *normal - third;
    }
    let strain = strain(g);
    let a = contracted(&d, &d).divide(q).divide(q);
    let b = contracted(&strain, &strain).divide(q);
    let root = a.sqrt();
    let below = (b * b).mul_add(b.sqrt(), a * root.sqrt()).maximum(S::splat(NONE));
    (q.sqrt() * (a * root)).divide(below)
}

/// max(−∂u_i/∂x_k ∂u_j/∂x_k S_ij + `lift`, 0)/(∂u_i/∂x_j)² of Rozema et al. (2015).
#[inline(always)]
fn minimum_dissipation<S: Simd>(g: &Gradient<S>, lift: S) -> S {
    let beta = products(g);
    let made = lift - contracted(&beta, &strain(g));
    made.maximum(S::splat(0.0)).divide(squared(&beta))
}

/// max(−∂u_i/∂x_k ∂θ/∂x_k ∂θ/∂x_i, 0)/(∂θ/∂x_j)² of Abkar and Moin (2017).
#[inline(always)]
fn minimum_variance<S: Simd>(g: &Gradient<S>, slope: &[S; 3]) -> S {
    let made = dot(&[dot(&g[0], slope), dot(&g[1], slope), dot(&g[2], slope)], slope);
    let zero = S::splat(0.0);
    (zero - made).maximum(zero).divide(dot(slope, slope).maximum(S::splat(NONE)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{MAXIMUM_LANES, Portable};

    /// A gradient of no symmetry (per step), and slopes of temperature (K per cell).
    const GRADIENT: [[f64; 3]; 3] =
        [[0.011, -0.023, 0.007], [0.016, -0.019, 0.004], [-0.013, 0.021, 0.008]];
    const WARM: [f64; 3] = [0.3, -0.2, 0.5];
    const DEPARTING: f64 = 0.1;

    fn first(value: Portable) -> f64 {
        let mut lanes = [0.0; MAXIMUM_LANES];
        // SAFETY: room for the widest vector.
        unsafe { value.store(lanes.as_mut_ptr()) };
        f64::from(lanes[0])
    }

    fn splat(value: f64) -> Portable {
        Portable::splat(value as f32)
    }

    /// Viscosity and diffusivity under a buoyancy and a Prandtl number, in air that conducts 0.001.
    fn found(model: SubgridModel, buoyancy: f64, per_prandtl: f64) -> [f64; 2] {
        let law = Viscosity { model, factor: splat(0.3) };
        let warm = WarmSlope { along: WARM.map(splat), departing: splat(DEPARTING) };
        let heat = Heat {
            buoyancy: splat(buoyancy),
            per_prandtl: splat(per_prandtl),
            conductivity: splat(0.001),
        };
        law.stratified(&GRADIENT.map(|row| row.map(splat)), &warm, &heat).map(first)
    }

    #[test]
    fn stable_air_holds_eddies_back_as_it_does_smagorinskys_in_shear() {
        let g = GRADIENT.map(|row| row.map(splat));
        let all_squared: f64 = GRADIENT.iter().flatten().map(|slope| slope * slope).sum();
        for model in [SubgridModel::Wale, SubgridModel::Vreman] {
            let neutral = first(Viscosity { model, factor: splat(0.3) }.neutral(&g));
            assert!(neutral > 1e-4, "{model:?}: {neutral}");
            for richardson in [-1.0, 0.0, 0.2, 0.45] {
                // N² = buoyancy times slope; Pr = 1/2.
                let buoyancy = richardson * all_squared / WARM[2];
                let [viscosity, diffusivity] = found(model, buoyancy, 2.0);
                let expected = neutral * (1.0 - 2.0 * richardson).sqrt();
                assert!((viscosity - expected).abs() < 1e-5 * neutral + 1e-6, "{model:?}");
                assert!((diffusivity - 2.0 * viscosity - 0.001).abs() < 1e-7, "{model:?}");
            }
            assert_eq!(found(model, all_squared, 4.0)[0], 0.0, "{model:?}: past the critical one");
        }
    }

    #[test]
    fn unstable_air_that_turns_without_strain_has_bounded_eddies() {
        // A turn about z at 0.02 per step, in air whose N² is minus that squared.
        let turn = 0.02;
        let g = [[0.0, -turn, 0.0], [turn, 0.0, 0.0], [0.0; 3]].map(|row: [f64; 3]| row.map(splat));
        let warm = WarmSlope { along: [0.0, 0.0, 1.0].map(splat), departing: splat(1.0) };
        let heat = Heat {
            buoyancy: splat(-turn * turn),
            per_prandtl: splat(3.0),
            conductivity: splat(0.0),
        };
        for model in [SubgridModel::Wale, SubgridModel::Vreman] {
            let law = Viscosity { model, factor: splat(0.3) };
            let neutral = first(law.neutral(&g));
            let [viscosity, _] = law.stratified(&g, &warm, &heat).map(first);
            // √(1 + 3 · turn²/2 turn²)
            assert!(neutral > 1e-4 && (viscosity / neutral - 2.5_f64.sqrt()).abs() < 1e-4);
        }
    }

    #[test]
    fn minimum_dissipation_counts_what_buoyancy_gives_and_what_stirs_temperature() {
        let model = SubgridModel::MinimumDissipation;
        let (mut all, mut made, mut stirred, mut slopes) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..3 {
            slopes += WARM[i].powi(2);
            for j in 0..3 {
                all += GRADIENT[i][j].powi(2);
                let strain = 0.5 * (GRADIENT[i][j] + GRADIENT[j][i]);
                let product: f64 = GRADIENT[i].iter().zip(&GRADIENT[j]).map(|(a, b)| a * b).sum();
                made -= product * strain;
                stirred -= GRADIENT[i][j] * WARM[j] * WARM[i];
            }
        }
        let lift = GRADIENT[2][0] * WARM[0] + GRADIENT[2][1] * WARM[1] + GRADIENT[2][2] * DEPARTING;
        for buoyancy in [0.0, -1e-3, 1e-3] {
            let [viscosity, diffusivity] = found(model, buoyancy, 3.0);
            let expected = (0.3 * (made + buoyancy * lift) / all).max(0.0);
            assert!((viscosity - expected).abs() < 1e-6, "{viscosity} of {expected}");
            let expected = 0.001 + (0.3 * stirred / slopes).max(0.0);
            assert!((diffusivity - expected).abs() < 1e-7, "{diffusivity} of {expected}");
        }
        // Neither is cut off in these numbers, so that both were looked at.
        assert!(made > 0.0 && stirred > 0.0 && lift < 0.0, "{made} {stirred} {lift}");
    }
}
