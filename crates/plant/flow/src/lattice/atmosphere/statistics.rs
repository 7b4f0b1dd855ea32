//! Means, variances and fluxes over the levels of the box at an instant.

use super::probe::AirRow;

/// Statistics of one level, over all its cells at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LevelStatistics {
    /// Height of the cells' centres (m).
    pub height: f64,
    /// Mean velocity (m/s).
    pub velocity: [f64; 3],
    /// Mean potential temperature (K).
    pub temperature: f64,
    /// Variances of u, v, w (m²/s²).
    pub variance: [f64; 3],
    /// Variance of temperature (K²).
    pub temperature_variance: f64,
    /// Resolved flux of momentum u'w', v'w' (m²/s²).
    pub stress: [f64; 2],
    /// What the grid does not resolve of it, viscous stress included (m²/s²).
    pub subgrid_stress: [f64; 2],
    /// Resolved flux of heat w'θ' (K m/s).
    pub heat_flux: f64,
    /// What the grid does not resolve of it (K m/s).
    pub subgrid_heat_flux: f64,
}

impl LevelStatistics {
    /// Adds `share` of those of another instant at the same height, so that shares that add up to one give a
    /// mean. Variances and fluxes stay those about the mean of each instant.
    pub fn add(&mut self, other: &Self, share: f64) {
        self.height = other.height;
        let mut other = *other;
        for (number, other) in self.numbers().into_iter().zip(other.numbers()) {
            *number += share * *other;
        }
    }

    /// All but the height.
    fn numbers(&mut self) -> [&mut f64; 14] {
        let [u, v, w] = &mut self.velocity;
        let [uu, vv, ww] = &mut self.variance;
        let [uw, vw] = &mut self.stress;
        let [sub_uw, sub_vw] = &mut self.subgrid_stress;
        [
            u,
            v,
            w,
            &mut self.temperature,
            uu,
            vv,
            ww,
            &mut self.temperature_variance,
            uw,
            vw,
            sub_uw,
            sub_vw,
            &mut self.heat_flux,
            &mut self.subgrid_heat_flux,
        ]
    }
}

/// Sums over the cells of a level, in lattice units but for kelvin.
#[derive(Default)]
pub(crate) struct Sums {
    /// u, v, w, θ.
    first: [f64; 4],
    /// Their squares.
    second: [f64; 4],
    /// w times u, v, θ.
    upwards: [f64; 3],
    /// What is not resolved of these.
    subgrid: [f64; 3],
}

impl Sums {
    /// Takes the first `n` cells of `row` in.
    pub(crate) fn add(&mut self, row: &AirRow, n: usize) {
        let [u, v, w] = &row.velocity;
        let theta = &row.temperature;
        for x in 0..n {
            let values = [u[x], v[x], w[x], theta[x]].map(f64::from);
            for ((first, second), value) in self.first.iter_mut().zip(&mut self.second).zip(values)
            {
                *first += value;
                *second += value * value;
            }
            let [u, v, w, theta] = values;
            for (sum, value) in self.upwards.iter_mut().zip([u, v, theta]) {
                *sum += w * value;
            }
        }
        for (sum, column) in
            self.subgrid.iter_mut().zip([&row.stress[0], &row.stress[1], &row.heat_flux])
        {
            *sum += column[..n].iter().copied().map(f64::from).sum::<f64>();
        }
    }

    /// Statistics over `n` cells, with `unit` (m/s) for a cell a step; height and reference temperature are
    /// to come.
    pub(crate) fn statistics(&self, n: f64, unit: f64) -> LevelStatistics {
        let mean = self.first.map(|sum| sum / n);
        let variance: [f64; 4] = std::array::from_fn(|which| {
            (self.second[which] / n - mean[which] * mean[which]).max(0.0)
        });
        let [u, v, w, theta] = mean;
        let [wu, wv, wt] = self.upwards.map(|sum| sum / n);
        let [sub_u, sub_v, sub_t] = self.subgrid.map(|sum| sum / n);
        let squared = unit * unit;
        LevelStatistics {
            height: 0.0,
            velocity: [u * unit, v * unit, w * unit],
            temperature: theta,
            variance: [variance[0] * squared, variance[1] * squared, variance[2] * squared],
            temperature_variance: variance[3],
            stress: [(wu - w * u) * squared, (wv - w * v) * squared],
            subgrid_stress: [sub_u * squared, sub_v * squared],
            heat_flux: (wt - w * theta) * unit,
            subgrid_heat_flux: sub_t * unit,
        }
    }
}
