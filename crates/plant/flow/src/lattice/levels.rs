//! The levels of an atmosphere: their statistics, and the wind that drives them.

use super::atmosphere::{AirRow, LevelStatistics, Sums};
use super::solver::Lattice;
use basis::Vector3;
use std::ops::Range;

impl Lattice {
    /// Statistics of every level, from the ground up; none where the air has no temperature.
    pub fn level_statistics(&self) -> Vec<LevelStatistics> {
        self.statistics_of(0..self.n_cells()[2])
    }

    /// Statistics of the levels whose numbers are in `levels`, as far as there are such; none where the air
    /// has no temperature.
    pub fn statistics_of(&self, levels: Range<usize>) -> Vec<LevelStatistics> {
        let Some(atmosphere) = &self.settings().atmosphere else { return Vec::new() };
        let [n_x, n_y, n_z] = self.n_cells();
        let mut row = AirRow::new(n_x);
        (levels.start..levels.end.min(n_z))
            .map(|z| {
                let mut sums = Sums::default();
                for y in 0..n_y {
                    self.engine.read_air(z * n_y + y, &mut row);
                    sums.add(&row, n_x);
                }
                let unit = self.scaling().si_velocity_unit();
                let height = self.floor + (z as f64 + 0.5) * self.settings().spacing;
                let mut level = sums.statistics((n_x * n_y) as f64, unit);
                level.height = height;
                level.temperature += atmosphere.reference_temperature;
                level
            })
            .collect()
    }

    /// The geostrophic wind towards x and y is `wind` (m/s) from now on, in place of that of the settings;
    /// false where there is no atmosphere to be driven. It is no part of the state that is written: who
    /// changes it sets it again.
    pub fn drive(&mut self, [x, y]: [f64; 2]) -> bool {
        let wind = self.scaling().to_lattice_velocity(Vector3::new(x, y, 0.0)).as_vec3();
        self.engine.drive([wind.x, wind.y])
    }
}
