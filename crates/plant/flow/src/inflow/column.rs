//! The mean of an atmosphere over height.

/// Mean wind and temperature over height: of the box of air that planes were taken out of, say.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanColumn {
    levels: Vec<ColumnLevel>,
}

/// Means of one height.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColumnLevel {
    /// Height above the ground (m).
    pub height: f64,
    /// Mean wind along x and y (m/s).
    pub wind: [f64; 2],
    /// Mean potential temperature (K).
    pub temperature: f64,
}

impl MeanColumn {
    /// That of `levels`, from the ground up; none without levels, or where their heights do not rise.
    pub fn new(levels: Vec<ColumnLevel>) -> Option<Self> {
        let rises = levels.windows(2).all(|pair| pair[0].height < pair[1].height);
        (rises && !levels.is_empty()).then_some(Self { levels })
    }

    /// Its levels, from the ground up; at least one.
    pub fn levels(&self) -> &[ColumnLevel] {
        &self.levels
    }

    /// The means at `height` (m): linear between levels, and of the nearest one beyond them.
    pub fn at(&self, height: f64) -> ColumnLevel {
        let levels = &self.levels;
        let above = levels.partition_point(|level| level.height <= height);
        let (low, high) = (levels[above.saturating_sub(1)], levels[above.min(levels.len() - 1)]);
        if low.height == high.height {
            return ColumnLevel { height, ..low };
        }
        let share = (height - low.height) / (high.height - low.height);
        let between = |low: f64, high: f64| low + share * (high - low);
        ColumnLevel {
            height,
            wind: std::array::from_fn(|axis| between(low.wind[axis], high.wind[axis])),
            temperature: between(low.temperature, high.temperature),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_linear_between_levels_and_that_of_the_nearest_beyond() {
        let level = |height: f64| ColumnLevel {
            height,
            wind: [0.1 * height, -0.02 * height],
            temperature: 288.0 + 0.01 * height,
        };
        let column = MeanColumn::new(vec![level(10.0), level(30.0), level(70.0)]).unwrap();
        let near = |found: ColumnLevel, expected: ColumnLevel| {
            (found.wind[0] - expected.wind[0]).abs() < 1e-12
                && (found.wind[1] - expected.wind[1]).abs() < 1e-12
                && (found.temperature - expected.temperature).abs() < 1e-12
        };
        for (height, of) in [(30.0, 30.0), (45.0, 45.0), (5.0, 10.0), (90.0, 70.0)] {
            assert!(near(column.at(height), level(of)), "{height}");
        }
        assert_eq!(MeanColumn::new(vec![level(30.0), level(30.0)]), None);
        assert_eq!(MeanColumn::new(Vec::new()), None);
    }
}
