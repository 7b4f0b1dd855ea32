//! A box of turbulent fluctuations on a regular grid.

use super::InflowError;

/// Fluctuations u, v, w (m/s, farm frame) on a regular grid that repeats in all three directions.
///
/// x runs downwind, y to the left, z up. Carried past a fixed place, time runs *against* x: the planes of
/// greater x pass first.
#[derive(Clone, Debug, PartialEq)]
pub struct TurbulenceBox {
    n_points: [usize; 3],
    spacing: [f64; 3],
    velocity: [Vec<f32>; 3],
}

impl TurbulenceBox {
    /// A box of `n_points` along x, y, z at `spacing` (m); `velocity` u, v, w (m/s), each
    /// n_x × n_z × n_y with y fastest, x slowest.
    ///
    /// # Errors
    /// [`InflowError`] when a component's length does not fit, or a spacing is not positive.
    pub fn new(
        n_points: [usize; 3],
        spacing: [f64; 3],
        velocity: [Vec<f32>; 3],
    ) -> Result<Self, InflowError> {
        for spacing in spacing {
            super::positive("spacing (m)", spacing)?;
        }
        for points in n_points {
            super::positive("number of points (–)", points as f64)?;
        }
        let needed = n_points.iter().product();
        for (component, values) in velocity.iter().enumerate() {
            if values.len() != needed {
                let found = values.len();
                return Err(InflowError::Shape { n_points, component, needed, found });
            }
        }
        Ok(Self { n_points, spacing, velocity })
    }

    /// Points along x, y, z (–).
    pub fn n_points(&self) -> [usize; 3] {
        self.n_points
    }

    /// Distance of neighbouring points along x, y, z (m).
    pub fn spacing(&self) -> [f64; 3] {
        self.spacing
    }

    /// Length after which it repeats, along x, y, z (m).
    pub fn lengths(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.n_points[axis] as f64 * self.spacing[axis])
    }

    /// Component 0 to 2 (u, v, w; m/s) over all points, n_x × n_z × n_y, y fastest, x slowest.
    pub fn component(&self, component: usize) -> &[f32] {
        &self.velocity[component]
    }

    /// Component 0 to 2 (m/s) on plane `x_index`, n_z × n_y, y fastest.
    pub fn plane(&self, component: usize, x_index: usize) -> &[f32] {
        let size = self.n_points[1] * self.n_points[2];
        &self.velocity[component][x_index * size..(x_index + 1) * size]
    }

    /// Component 0 to 2 (m/s) at the point with indices `x`, `y`, `z`.
    pub fn at(&self, component: usize, [x, y, z]: [usize; 3]) -> f32 {
        self.velocity[component][(x * self.n_points[2] + z) * self.n_points[1] + y]
    }

    /// Means of u, v, w over all points (m/s).
    pub fn means(&self) -> [f64; 3] {
        std::array::from_fn(|component| {
            self.by_planes(component, f64::from) / self.velocity[component].len() as f64
        })
    }

    /// Standard deviations of u, v, w over all points (m/s).
    pub fn standard_deviations(&self) -> [f64; 3] {
        let means = self.means();
        std::array::from_fn(|component| {
            let squares =
                self.by_planes(component, |value| (f64::from(value) - means[component]).powi(2));
            (squares / self.velocity[component].len() as f64).sqrt()
        })
    }

    /// Mean product of the fluctuations u and w over all points (m²/s²), negative in shear.
    pub fn shear_stress(&self) -> f64 {
        let [mean_u, _, mean_w] = self.means();
        let product = |(u, w): (&f32, &f32)| (f64::from(*u) - mean_u) * (f64::from(*w) - mean_w);
        let sum: f64 = (0..self.n_points[0])
            .map(|x| self.plane(0, x).iter().zip(self.plane(2, x)).map(product).sum::<f64>())
            .sum();
        sum / self.velocity[0].len() as f64
    }

    /// All components times `factor` (–).
    pub(crate) fn scale(&mut self, factor: f64) {
        for value in self.velocity.iter_mut().flatten() {
            *value = (f64::from(*value) * factor) as f32;
        }
    }

    /// Sum of `of` over one component, plane by plane, which keeps the rounding small.
    fn by_planes(&self, component: usize, of: impl Fn(f32) -> f64 + Copy) -> f64 {
        (0..self.n_points[0])
            .map(|x| self.plane(component, x).iter().map(|value| of(*value)).sum::<f64>())
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_components_that_do_not_fit() {
        let component = vec![0.0; 24];
        let velocity = [component.clone(), vec![0.0; 23], component];
        let error = TurbulenceBox::new([2, 3, 4], [1.0; 3], velocity).unwrap_err();
        let expected =
            InflowError::Shape { n_points: [2, 3, 4], component: 1, needed: 24, found: 23 };
        assert_eq!(error, expected);
    }

    #[test]
    fn y_is_fastest_and_x_slowest() {
        let values: Vec<f32> = (0..24).map(|n| n as f32).collect();
        let turbulence =
            TurbulenceBox::new([2, 3, 4], [1.0; 3], std::array::from_fn(|_| values.clone()))
                .unwrap();
        assert_eq!(turbulence.at(0, [0, 1, 0]), 1.0);
        assert_eq!(turbulence.at(0, [0, 0, 1]), 3.0);
        assert_eq!(turbulence.at(0, [1, 0, 0]), 12.0);
        assert_eq!(turbulence.plane(2, 1)[0], 12.0);
        assert_eq!(turbulence.means(), [11.5; 3]);
        assert!(
            (turbulence.shear_stress() - turbulence.standard_deviations()[0].powi(2)).abs() < 1e-9
        );
    }
}
