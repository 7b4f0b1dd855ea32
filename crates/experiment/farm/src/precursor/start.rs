//! The wind that a precursor starts with: sheared, and waved near the ground so that eddies grow.

use super::Precursor;
use basis::Vector3;
use flow::Inflow;
use std::f64::consts::TAU;

/// Height where the first wind has become geostrophic, over that of the inversion (–).
const SHEARED: f64 = 0.5;
/// Wind of the waves over the geostrophic one (–), their height over that of the inversion (–) and at least
/// in cells, their length over that of the inversion (–) and at least in cells.
const WAVES: f64 = 0.1;
const WAVE_HEIGHT: f64 = 0.1;
const LOWEST_WAVE: f64 = 1.5;
const WAVE_LENGTH: f64 = 0.5;
const SHORTEST_WAVE: f64 = 8.0;

/// The first wind.
///
/// The mean grows with the logarithm of height to the geostrophic wind and has its direction; where the wind
/// at hub height is held, it is that one there and below, and goes over into the geostrophic one up to the
/// inversion, so that nothing has to be put right at once. On top stand waves √e a (z/h) exp(−z²/2h²), of u
/// across y and of v across x: free of divergence, and strongest, a, at height h. So starts the field's own
/// practice (AMR-Wind, "perturb_velocity").
pub(super) struct Start {
    /// Wind up to `foot`, but for its logarithm, and from `top` on, towards east and north (m/s).
    winds: [[f64; 2]; 2],
    roughness_length: f64,
    /// Height up to which the mean grows with the logarithm, and where it is geostrophic (m).
    foot: f64,
    top: f64,
    /// a (m/s) and h (m).
    wave: [f64; 2],
    /// Wave numbers along x and y (rad/m).
    numbers: [f64; 2],
}

impl Start {
    /// That of `precursor`.
    pub(super) fn new(precursor: &Precursor) -> Self {
        let (air, cell) = (&precursor.air, precursor.domain.cell);
        let [length, width, _] = precursor.domain.size;
        let wave_length = (WAVE_LENGTH * air.inversion_height).max(SHORTEST_WAVE * cell);
        let number = |along: f64| TAU * (along / wave_length).floor().max(1.0) / along;
        let height = (WAVE_HEIGHT * air.inversion_height).max(LOWEST_WAVE * cell);
        let (geostrophic, sheared) = (precursor.geostrophic(), SHEARED * air.inversion_height);
        let hub = precursor.planes.hub_height;
        let (low, foot, top) = match precursor.held_wind() {
            Some(wind) => (wind, hub, air.inversion_height.max(hub + cell)),
            None => (geostrophic, sheared, sheared),
        };
        Self {
            winds: [low, geostrophic],
            roughness_length: air.roughness_length,
            foot,
            top,
            wave: [WAVES * precursor.geostrophic_speed(), height],
            numbers: [number(length), number(width)],
        }
    }

    /// The mean at `height` (m), towards east and north (m/s).
    fn mean(&self, height: f64) -> [f64; 2] {
        let [low, high] = self.winds;
        if height >= self.top {
            return high;
        }
        if height > self.foot {
            let share = (height - self.foot) / (self.top - self.foot);
            return std::array::from_fn(|axis| low[axis] + share * (high[axis] - low[axis]));
        }
        let logarithm = |height: f64| (height / self.roughness_length).ln_1p();
        let share = logarithm(height.max(0.0)) / logarithm(self.foot);
        low.map(|component| share * component)
    }
}

impl Inflow for Start {
    fn sample(&self, _: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let [amplitude, reach] = self.wave;
        for (position, velocity) in positions.iter().zip(velocities) {
            let height = position.z / reach;
            let wave = amplitude * height * (0.5 - 0.5 * height * height).exp();
            let [east, north] = self.mean(position.z);
            *velocity = Vector3::new(
                east + wave * (self.numbers[1] * position.y).cos(),
                north + wave * (self.numbers[0] * position.x).sin(),
                0.0,
            );
        }
    }
}
