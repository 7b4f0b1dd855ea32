//! What the levels of a box tell of the layer over its ground.

use super::statistics::LevelStatistics;
use std::ops::Range;

/// Stress over the ground's where the layer ends, before the rest is added (–): the definition of the
/// intercomparison of stable layers (Beare et al. 2006, Bound.-Layer Meteorol. 118, 247).
const LEAST_STRESS: f64 = 0.05;

impl LevelStatistics {
    /// Magnitude of the flux of momentum, unresolved included (m²/s²).
    pub fn whole_stress(&self) -> f64 {
        let [x, y] = self.stress;
        let [unresolved_x, unresolved_y] = self.subgrid_stress;
        (x + unresolved_x).hypot(y + unresolved_y)
    }

    /// Flux of heat upwards, unresolved included (K m/s).
    pub fn whole_heat_flux(&self) -> f64 {
        self.heat_flux + self.subgrid_heat_flux
    }
}

/// Friction velocity at the ground under `levels`, from the second and third (m/s).
pub fn friction_velocity(levels: &[LevelStatistics]) -> f64 {
    at_ground(levels, LevelStatistics::whole_stress).max(0.0).sqrt()
}

/// Flux of heat upwards at the ground under `levels`, from the second and third (K m/s).
pub fn ground_heat_flux(levels: &[LevelStatistics]) -> f64 {
    at_ground(levels, LevelStatistics::whole_heat_flux)
}

/// Height where the stress is a twentieth of the ground's, over 0.95 (m); none where it never gets so small.
pub fn layer_depth(levels: &[LevelStatistics]) -> Option<f64> {
    let limit = LEAST_STRESS * at_ground(levels, LevelStatistics::whole_stress);
    levels.windows(2).skip(1).find_map(|pair| {
        let [below, above] = [pair[0].whole_stress(), pair[1].whole_stress()];
        (above < limit).then(|| {
            let share = ((below - limit) / (below - above)).clamp(0.0, 1.0);
            let height = pair[0].height + share * (pair[1].height - pair[0].height);
            height / (1.0 - LEAST_STRESS)
        })
    })
}

/// Levels at `heights` (m) with the mean of their stress, as a vector, over the instants at `places`.
///
/// The depth of a layer is that of the mean stress: waves and streaks of an instant carry momentum up and
/// down beyond the layer, which a mean of the depths of instants would count. The columns are the flux of
/// momentum along x and y that is resolved and that is not (m²/s²), of one instant after the other, levels
/// fastest.
pub fn mean_stress(
    heights: &[f64],
    [x, y, unresolved_x, unresolved_y]: [&[f64]; 4],
    places: Range<usize>,
) -> Vec<LevelStatistics> {
    let n = places.len() as f64;
    let mean = |column: &[f64], level: usize| {
        let at = |place: usize| column[place * heights.len() + level];
        places.clone().map(at).sum::<f64>() / n
    };
    let level = |(level, height): (usize, &f64)| LevelStatistics {
        height: *height,
        stress: [x, y].map(|column| mean(column, level)),
        subgrid_stress: [unresolved_x, unresolved_y].map(|column| mean(column, level)),
        ..LevelStatistics::default()
    };
    heights.iter().enumerate().map(level).collect()
}

/// A flux at the ground: that of the second and third level drawn on, for in the first the ground's part
/// enters as a force.
fn at_ground(levels: &[LevelStatistics], flux: fn(&LevelStatistics) -> f64) -> f64 {
    match levels {
        [_, second, third, ..] => 2.5 * flux(second) - 1.5 * flux(third),
        _ => f64::NAN,
    }
}
