//! What drives a precursor: a geostrophic wind that is given, or one that makes a given wind at hub height.

use super::Precursor;
use flow::lattice::VON_KARMAN;
use std::f64::consts::FRAC_PI_2;

/// Rate at which the earth turns (rad/s).
const EARTH: f64 = 7.2921e-5;
/// Constants A and B of the resistance law of a neutral layer (–), as the European Wind Atlas has them (Troen
/// and Petersen 1989).
const RESISTANCE: [f64; 2] = [1.8, 4.5];
/// Direction of a wind that is given without one (rad): from the west.
const WEST: f64 = 1.5 * std::f64::consts::PI;

impl Precursor {
    /// Coriolis parameter (1/s), positive on the northern half.
    pub fn coriolis(&self) -> f64 {
        2.0 * EARTH * self.air.latitude.sin()
    }

    /// The wind at hub height towards east and north (m/s) that is to be held; none where the geostrophic one
    /// is given.
    pub fn held_wind(&self) -> Option<[f64; 2]> {
        let speed = self.air.hub_wind?;
        Some(towards(speed, self.air.hub_direction.unwrap_or(WEST)))
    }

    /// Geostrophic wind at the start, towards east and north (m/s): the given one, or the one that would make
    /// the wind at hub height in a neutral layer; not a number where neither is given.
    ///
    /// u* is that of the logarithmic law at hub height; G and the angle α that it is turned by at the ground
    /// follow from the resistance law κ G/u* (cos α, sin α) = (ln(u*/(|f| z₀)) − A, B), and at hub height as
    /// much of α is left as the layer rises above it.
    pub fn geostrophic(&self) -> [f64; 2] {
        let air = &self.air;
        let Some(wind) = self.held_wind() else {
            let speed = air.geostrophic_wind.unwrap_or(f64::NAN);
            return towards(speed, air.geostrophic_direction.unwrap_or(WEST));
        };
        let (speed, hub) = (wind[0].hypot(wind[1]), self.planes.hub_height);
        let friction = VON_KARMAN * speed / (hub / air.roughness_length).ln_1p();
        let [a, b] = RESISTANCE;
        let along = (friction / (self.coriolis().abs() * air.roughness_length)).ln() - a;
        let ratio = friction / VON_KARMAN * along.hypot(b) / speed;
        let at_ground = if along > 0.0 { (b / along).atan() } else { FRAC_PI_2 };
        let turned = at_ground * (1.0 - hub / air.inversion_height).clamp(0.0, 1.0);
        // The wind turns clockwise with height on the northern half.
        let (s, c) = (turned * -self.coriolis().signum()).sin_cos();
        let [east, north] = wind;
        [ratio * (c * east - s * north), ratio * (s * east + c * north)]
    }

    /// Speed of the geostrophic wind at the start (m/s).
    pub fn geostrophic_speed(&self) -> f64 {
        let [east, north] = self.geostrophic();
        east.hypot(north)
    }
}

/// Wind towards east and north of `speed` (m/s) that comes from `direction` (rad, clockwise from north).
fn towards(speed: f64, direction: f64) -> [f64; 2] {
    let (s, c) = direction.sin_cos();
    [-speed * s, -speed * c]
}
