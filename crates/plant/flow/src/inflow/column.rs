//! The mean of an atmosphere over height.

use super::{InflowError, Planes};
use crate::Inflow;
use basis::Vector3;
use std::ops::ControlFlow;

/// Instants of which the mean of a wind over time is taken (–).
const INSTANTS: u32 = 1000;

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

    /// The mean wind of each row of points of `planes` over the record and its width, all of it read now;
    /// `progress` receives the share read, and a break ends it. Of temperature it says nothing.
    ///
    /// # Errors
    /// [`InflowError`] when the grid makes no sense or a plane cannot be had, [`InflowError::BrokenOff`]
    /// after a break.
    pub fn of_planes(
        planes: &mut dyn Planes,
        progress: &dyn Fn(f64) -> ControlFlow<()>,
    ) -> Result<Self, InflowError> {
        let grid = planes.grid();
        grid.check()?;
        let mut values = vec![[0.0; 3]; grid.n_y * grid.n_z];
        let mut sums = vec![[0.0_f64; 2]; grid.n_z];
        for step in 0..grid.n_steps {
            if progress(step as f64 / grid.n_steps as f64).is_break() {
                return Err(InflowError::BrokenOff);
            }
            planes.read(step, &mut values)?;
            for (sum, row) in sums.iter_mut().zip(values.chunks(grid.n_y)) {
                for [u, v, _] in row {
                    *sum = [sum[0] + f64::from(*u), sum[1] + f64::from(*v)];
                }
            }
        }
        let per_value = 1.0 / (grid.n_steps * grid.n_y) as f64;
        let level = |(row, sum): (usize, &[f64; 2])| ColumnLevel {
            height: grid.first[1] + row as f64 * grid.spacing[1],
            wind: sum.map(|sum| sum * per_value),
            temperature: 0.0,
        };
        Ok(Self { levels: sums.iter().enumerate().map(level).collect() })
    }

    /// The mean of `inflow` over `duration` (s) from the start, at the place of `foot` (m, farm frame) at
    /// each of `heights` (m), which rise; of temperature it says nothing.
    pub fn over_time(
        inflow: &dyn Inflow,
        duration: f64,
        foot: Vector3,
        heights: &[f64],
    ) -> Option<Self> {
        let places: Vec<Vector3> =
            heights.iter().map(|&height| Vector3::new(foot.x, foot.y, height)).collect();
        let mut winds = vec![Vector3::ZERO; places.len()];
        let mut sums = winds.clone();
        for instant in 0..INSTANTS {
            let time = (f64::from(instant) + 0.5) * duration / f64::from(INSTANTS);
            inflow.sample(time, &places, &mut winds);
            sums.iter_mut().zip(&winds).for_each(|(sum, wind)| *sum += *wind);
        }
        let level = |(&height, sum): (&f64, &Vector3)| ColumnLevel {
            height,
            wind: [sum.x, sum.y].map(|sum| sum / f64::from(INSTANTS)),
            temperature: 0.0,
        };
        Self::new(heights.iter().zip(&sums).map(level).collect())
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
    use crate::inflow::planes::BoxPlanes;
    use crate::inflow::{MeanProfile, TabulatedWind, TurbulenceBox};
    use std::sync::Arc;

    const PROFILE: MeanProfile =
        MeanProfile::PowerLaw { hub_height: 100.0, speed: 8.0, exponent: 0.2 };

    #[test]
    fn of_planes_it_is_the_mean_of_each_row() {
        // Fluctuations whose mean over a row of all planes is zero.
        let n_points = [4, 6, 5];
        let n: usize = n_points.iter().product();
        let one = |k: usize| if k.is_multiple_of(2) { 0.7 } else { -0.7 };
        let values = || (0..n).map(one).collect::<Vec<f32>>();
        let components = [values(), values(), values()];
        let turbulence = TurbulenceBox::new(n_points, [5.0, 10.0, 20.0], components);
        let turbulence = Arc::new(turbulence.expect("as many values as points"));
        let mut planes = BoxPlanes::new(turbulence, &PROFILE, 30.0).expect("a sound box");
        let goes_on = |_: f64| ControlFlow::Continue(());
        let column = MeanColumn::of_planes(&mut planes, &goes_on).expect("planes in memory");
        for height in [30.0, 50.0, 110.0] {
            let [u, v] = column.at(height).wind;
            assert!((u - PROFILE.speed(height)).abs() < 1e-5 && v.abs() < 1e-6, "{height} {u} {v}");
        }
        let broken = MeanColumn::of_planes(&mut planes, &|_| ControlFlow::Break(()));
        assert_eq!(broken, Err(InflowError::BrokenOff));
    }

    #[test]
    fn over_time_it_is_the_mean_of_what_changes() {
        let row = |time: f64, speed: f64| crate::inflow::tabulated::WindRow {
            time,
            speed,
            direction: 0.0,
            vertical: 0.3,
            horizontal_shear: 0.0,
            exponent: Some(0.5),
            vertical_shear: 0.0,
            gust: 0.0,
        };
        let hub = Vector3::new(0.0, 5.0, 100.0);
        let table = TabulatedWind::new(PROFILE, hub, 120.0, vec![row(0.0, 6.0), row(60.0, 12.0)]);
        let table = table.expect("a sound table");
        let column = MeanColumn::over_time(&table, 60.0, hub, &[25.0, 100.0]).expect("heights");
        for (height, expected) in [(25.0, 4.5), (100.0, 9.0)] {
            let [u, v] = column.at(height).wind;
            assert!((u - expected).abs() < 1e-9 && v == 0.0, "{height} {u} {v}");
        }
        assert_eq!(MeanColumn::over_time(&table, 60.0, hub, &[]), None);
    }

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
