//! Statistics of the levels over time: kept, written, averaged over blocks.

use super::levels::{
    FRICTION, GEOSTROPHIC, HEAT_FLUX, HUB_DIRECTION, HUB_SPEED, INTENSITY, Instant, OF_LAYER,
    OF_LEVELS, STRESS, TEMPERATURE, depth, direction, wind,
};
use flow::lattice::atmosphere::{LevelStatistics, mean_stress};
use formats::FileError;
use formats::netcdf::{Column, TimeHeight, write_statistics};
use formats::records::{Drift, ProfileRow};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::Path;

/// What the levels have told so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct History {
    /// Times (s).
    times: Vec<f64>,
    /// Heights (m).
    heights: Vec<f64>,
    /// Of each quantity of the layer, a value for each time.
    series: Vec<Vec<f64>>,
    /// Of each quantity of a level, a value for each time and level, levels fastest.
    profiles: Vec<Vec<f64>>,
}

impl History {
    /// Adds what the box tells at `time` (s).
    pub(super) fn add(&mut self, time: f64, instant: Instant) {
        let levels = instant.levels;
        if self.times.is_empty() {
            self.heights = levels.iter().map(|level| level.height).collect();
            self.series = vec![Vec::new(); OF_LAYER.len()];
            self.profiles = vec![Vec::new(); OF_LEVELS.len()];
        }
        self.times.push(time);
        for (column, quantity) in self.series.iter_mut().zip(&OF_LAYER) {
            column.push((quantity.of)(instant));
        }
        for (column, quantity) in self.profiles.iter_mut().zip(&OF_LEVELS) {
            column.extend(levels.iter().map(quantity.of));
        }
    }

    /// Whether it is one of levels at as many heights as `n_levels`, with the quantities of this program.
    pub(super) fn fits(&self, n_levels: usize) -> bool {
        let n = self.times.len();
        let is_whole = |columns: &[Vec<f64>], size: usize| columns.iter().all(|c| c.len() == size);
        let has_all = self.heights.len() == n_levels
            && self.series.len() == OF_LAYER.len()
            && self.profiles.len() == OF_LEVELS.len();
        (n == 0 || has_all)
            && is_whole(&self.series, n)
            && is_whole(&self.profiles, n * self.heights.len())
    }

    /// Speed at hub height and friction velocity (m/s) at the latest time.
    pub(super) fn latest(&self) -> Option<[f64; 2]> {
        let last = self.times.len().checked_sub(1)?;
        Some([self.series[HUB_SPEED][last], self.series[FRICTION][last]])
    }

    /// Speed of the geostrophic wind (m/s) and where it comes from (deg) at the latest time.
    pub(super) fn last_geostrophic(&self) -> Option<[f64; 2]> {
        let last = self.times.len().checked_sub(1)?;
        Some(GEOSTROPHIC.map(|which| self.series[which][last]))
    }

    /// Writes all of it as `statistics.nc` at `path`, under `title`.
    ///
    /// # Errors
    /// [`FileError`].
    pub(super) fn write(&self, path: &Path, title: &str) -> Result<(), FileError> {
        let series = OF_LAYER.iter().zip(&self.series).map(|(quantity, values)| Column {
            name: quantity.name,
            unit: quantity.unit,
            meaning: quantity.meaning,
            values,
        });
        let profiles = OF_LEVELS.iter().zip(&self.profiles).map(|(quantity, values)| Column {
            name: quantity.name,
            unit: quantity.unit,
            meaning: quantity.meaning,
            values,
        });
        let statistics = TimeHeight {
            title,
            times: &self.times,
            heights: &self.heights,
            series: series.collect(),
            profiles: profiles.collect(),
        };
        write_statistics(path, &statistics)
    }

    /// Places of the times after `from` and up to `to` (s); rounding is no difference.
    fn places(&self, from: f64, to: f64) -> Range<usize> {
        let until = |time: f64| self.times.partition_point(|t| *t <= time + 1e-6);
        until(from)..until(to)
    }

    /// Mean wind at hub height towards east and north (m/s) after `from` and up to `to` (s), or at the latest
    /// time before where nothing is known of then.
    pub(super) fn hub_wind(&self, from: f64, to: f64) -> [f64; 2] {
        let places = self.places(from, to);
        let places =
            if places.is_empty() { places.end.saturating_sub(1)..places.end } else { places };
        let winds = places
            .clone()
            .map(|place| wind(self.series[HUB_SPEED][place], self.series[HUB_DIRECTION][place]));
        let sum = winds.fold([0.0; 2], |[x, y], [east, north]| [x + east, y + north]);
        sum.map(|sum| sum / places.len() as f64)
    }

    /// Mean of a quantity of the layer after `from` and up to `to` (s).
    fn mean(&self, which: usize, from: f64, to: f64) -> f64 {
        let values = &self.series[which][self.places(from, to)];
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// Friction velocity (m/s), and depth of the layer in the mean stress (m), after `from` and up to `to`
    /// (s).
    pub(super) fn layer(&self, from: f64, to: f64) -> [f64; 2] {
        [self.mean(FRICTION, from, to), depth(&self.mean_stress(from, to))]
    }

    /// Heights of the levels with the mean of their stress, as a vector, after `from` and up to `to` (s).
    fn mean_stress(&self, from: f64, to: f64) -> Vec<LevelStatistics> {
        let places = self.places(from, to);
        mean_stress(&self.heights, STRESS.map(|which| self.profiles[which].as_slice()), places)
    }

    /// Mean of a quantity of a level over the times at `places`.
    fn level_mean(&self, which: usize, level: usize, places: &Range<usize>) -> f64 {
        let at = |place: usize| self.profiles[which][place * self.heights.len() + level];
        places.clone().map(at).sum::<f64>() / places.len() as f64
    }

    /// What changed between the two blocks of length `block` (s) that end at `to` (s); none where nothing is
    /// known of one of them.
    pub(super) fn drift(&self, block: f64, to: f64) -> Option<Drift> {
        let blocks = [[to - 2.0 * block, to - block], [to - block, to]];
        if blocks.iter().any(|[from, to]| self.places(*from, *to).is_empty()) {
            return None;
        }
        let winds = blocks.map(|[from, to]| self.hub_wind(from, to));
        Some(Drift {
            block,
            hub_speed: winds.map(|[east, north]| east.hypot(north)),
            direction_deg: winds.map(direction),
            friction_velocity: blocks.map(|[from, to]| self.mean(FRICTION, from, to)),
        })
    }

    /// Means of the levels after `from` and up to `to` (s), or the latest before where nothing is known of
    /// then.
    pub(super) fn profile(&self, from: f64, to: f64) -> Vec<ProfileRow> {
        let places = self.places(from, to);
        let places =
            if places.is_empty() { places.end.saturating_sub(1)..places.end } else { places };
        if places.is_empty() {
            return Vec::new();
        }
        let columns = STRESS.map(|which| self.profiles[which].as_slice());
        let stress = mean_stress(&self.heights, columns, places.clone());
        let mean = |which: usize, level: usize| self.level_mean(which, level, &places);
        let row = |level: usize| {
            let wind = [mean(0, level), mean(1, level)];
            ProfileRow {
                height: self.heights[level],
                speed: wind[0].hypot(wind[1]),
                direction_deg: direction(wind),
                turbulence_intensity: mean(INTENSITY, level),
                stress: stress[level].whole_stress(),
                temperature: mean(TEMPERATURE, level),
                heat_flux: mean(HEAT_FLUX, level),
            }
        };
        (0..self.heights.len()).map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A record every ten seconds, whose wind turns from west to south-west and grows.
    fn history() -> History {
        let mut history = History::default();
        for index in 0..13 {
            let time = 10.0 * f64::from(index);
            let late = time > 60.0;
            let level = |height: f64| LevelStatistics {
                height,
                velocity: if late { [8.0, 8.0, 0.0] } else { [8.0, 0.0, 0.0] },
                stress: [0.04 - 1e-4 * height, 0.0],
                temperature: 288.0 + time,
                ..LevelStatistics::default()
            };
            let levels = [level(10.0), level(30.0), level(50.0)];
            history.add(time, Instant { levels: &levels, hub: 30.0, geostrophic: [9.0, 0.0] });
        }
        history
    }

    #[test]
    fn blocks_are_compared_with_the_one_before() {
        let drift = history().drift(60.0, 120.0).unwrap();
        assert_eq!(drift.direction_deg.map(f64::round), [270.0, 225.0]);
        assert!((drift.of_direction() + 45.0).abs() < 1e-9);
        assert!((drift.hub_speed[1] / drift.hub_speed[0] - 2f64.sqrt()).abs() < 1e-12);
        assert!((drift.friction_velocity[0] - 0.2).abs() < 1e-12);
        assert!(drift.of_friction().abs() < 1e-12);
        assert!(history().drift(70.0, 120.0).is_some() && history().drift(5.0, 120.0).is_none());
        assert_eq!(history().hub_wind(1000.0, 2000.0), history().hub_wind(110.0, 120.0));
    }

    #[test]
    fn the_depth_is_that_of_the_mean_stress() {
        let mut history = History::default();
        for index in 0..20 {
            // Waves swing about a stress that falls to nothing at 95 m: as much up as down.
            let wave = if index % 2 == 0 { 0.03 } else { -0.03 };
            let level = |index: u32| {
                let height = 10.0 + 20.0 * f64::from(index);
                let mean = (0.09 * (1.0 - height / 95.0)).max(0.0);
                let aloft = if index >= 2 { wave } else { 0.0 };
                LevelStatistics { height, stress: [-mean, aloft], ..LevelStatistics::default() }
            };
            let levels: Vec<LevelStatistics> = (0..10).map(level).collect();
            let at = Instant { levels: &levels, hub: 30.0, geostrophic: [9.0, 0.0] };
            assert_eq!(depth(&levels), 190.0);
            history.add(10.0 * f64::from(index), at);
        }
        let [_, found] = history.layer(-1.0, 200.0);
        // A twentieth of the ground's lies between the levels at 70 and 110 m, where the mean is zero.
        assert!((90.0..100.0).contains(&found), "{found} m");
        let profile = history.profile(-1.0, 200.0);
        assert!(profile[9].stress < 1e-12 && (profile[0].stress - 0.0805).abs() < 1e-3);
    }

    #[test]
    fn profiles_are_means_of_their_time() {
        let profile = history().profile(60.0, 120.0);
        assert_eq!(profile.len(), 3);
        assert!((profile[1].temperature - 288.0 - 95.0).abs() < 1e-9);
        assert!((profile[1].direction_deg - 225.0).abs() < 1e-9);
        // Where nothing is known of a time, the latest before it is told.
        assert_eq!(history().profile(1000.0, 2000.0), history().profile(110.0, 120.0));
        assert!(History::default().profile(0.0, 10.0).is_empty());
        assert!(history().fits(3) && !history().fits(4) && History::default().fits(4));
    }
}
