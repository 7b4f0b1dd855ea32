//! Statistics of the levels of an atmosphere.

use super::atmosphere::{AirRow, LevelStatistics, Sums};
use super::solver::Lattice;

impl Lattice {
    /// Statistics of every level, from the ground up; none where the air has no temperature.
    pub fn level_statistics(&self) -> Vec<LevelStatistics> {
        let Some(atmosphere) = &self.settings().atmosphere else { return Vec::new() };
        let [n_x, n_y, n_z] = self.n_cells();
        let mut row = AirRow::new(n_x);
        (0..n_z)
            .map(|z| {
                let mut sums = Sums::default();
                for y in 0..n_y {
                    self.engine.read_air(z * n_y + y, &mut row);
                    sums.add(&row, n_x);
                }
                let unit = self.scaling().si_velocity_unit();
                let height = (z as f64 + 0.5) * self.settings().spacing;
                let mut level = sums.statistics((n_x * n_y) as f64, unit);
                level.height = height;
                level.temperature += atmosphere.reference_temperature;
                level
            })
            .collect()
    }
}
