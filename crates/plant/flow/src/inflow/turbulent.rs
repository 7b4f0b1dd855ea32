//! Turbulence carried past the farm on top of a mean profile.

use super::profile::veered;
use super::walk::walk;
use super::{InflowError, MeanProfile, TurbulenceBox};
use crate::Inflow;
use basis::Vector3;
use std::sync::Arc;

/// Turbulence carried past by Taylor's hypothesis: wind = mean profile + box at x − `x` of the origin − U t.
///
/// U is the profile's speed at hub height, for all heights. The box repeats in x, y and z; time runs against
/// its x. Interpolation: at points of the box in y and z the value itself, elsewhere linear in y and z; in x,
/// that is in time, Catmull-Rom's cubic. Variance that it keeps, averaged over places between points: 100 %
/// of waves of 16 points, 99 % of 8, 89 % of 4, 64 % of 2.7 and 49 % of 2 (a straight line: 97, 90, 67, 43,
/// 33 %). Linear interpolation between points in y or z costs the straight line's share again in each: put
/// the box's points on the flow's ([`aligned`](Self::aligned)).
///
/// Near the ground the vertical component is blocked: with [`blocked`](Self::blocked) it is multiplied by
/// (z²/(z² + h²))^(1/6), zero at the ground, where its variance then grows as z^(2/3), one well above h.
/// Streamwise and lateral components are left as they are.
#[derive(Clone, Debug)]
pub struct TurbulentInflow {
    turbulence: Arc<TurbulenceBox>,
    profile: MeanProfile,
    origin: Vector3,
    blocking_height: f64,
    /// Veer (rad/m), and the height (m) at which the mean wind blows along x.
    veer: f64,
    hub_height: f64,
}

/// Blocking height over the length scale of Mann's tensor (–): with it the variance near the ground is
/// 1.8 (εz)^(2/3), Hunt (1984), for the dissipation ε of unsheared von Karman turbulence with α = 1.7.
pub const BLOCKING_HEIGHT: f64 = 0.52;

/// Points within this share of a spacing (–) of a box point count as being there.
const SAME: f64 = 1e-6;

impl TurbulentInflow {
    /// `turbulence` on top of `profile`; the box's first point stands at `origin` (m, farm frame) at time
    /// zero.
    ///
    /// # Errors
    /// [`InflowError::Setting`] when the profile's speed, with which the box is carried along, is not
    /// positive.
    pub fn new(
        turbulence: Arc<TurbulenceBox>,
        profile: MeanProfile,
        origin: Vector3,
    ) -> Result<Self, InflowError> {
        super::positive("mean speed at hub height (m/s)", profile.hub_speed())?;
        let (blocking_height, veer, hub_height) = (0.0, 0.0, 0.0);
        Ok(Self { turbulence, profile, origin, blocking_height, veer, hub_height })
    }

    /// As [`new`](Self::new), with the box's points on the cell centres of a flow grid whose lowest corner is
    /// at `corner` (m, farm frame) and whose cells have the box's spacing.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn aligned(
        turbulence: Arc<TurbulenceBox>,
        profile: MeanProfile,
        corner: Vector3,
    ) -> Result<Self, InflowError> {
        let centre = corner + 0.5 * Vector3::from_array(turbulence.spacing());
        Self::new(turbulence, profile, centre)
    }

    /// The same with the vertical component blocked by the ground below about `height` (m); 0 lifts the
    /// blocking. [`BLOCKING_HEIGHT`] length scales is the height that theory gives.
    pub fn blocked(mut self, height: f64) -> Self {
        self.blocking_height = height.max(0.0);
        self
    }

    /// The same, its mean wind turned by `veer` (rad/m) per metre above `hub_height` (m): clockwise seen from
    /// above, upwards, as [`DeterministicWind::veer`](super::DeterministicWind::veer). The fluctuations are
    /// not turned, and all is carried along x as before.
    pub fn veering(self, veer: f64, hub_height: f64) -> Self {
        Self { veer, hub_height, ..self }
    }

    /// The turbulence.
    pub fn turbulence(&self) -> &TurbulenceBox {
        &self.turbulence
    }

    /// The mean profile.
    pub fn profile(&self) -> &MeanProfile {
        &self.profile
    }

    fn planes(&self, x: f64, time: f64) -> Planes<'_> {
        let [n_x, ..] = self.turbulence.n_points();
        let travelled = self.profile.hub_speed() * time;
        let (index, weight) =
            place((x - self.origin.x - travelled) / self.turbulence.spacing()[0], n_x);
        let around = [index + n_x - 1, index, index + 1, index + 2].map(|index| index % n_x);
        let s = weight as f32;
        // Catmull and Rom's cubic through the two inner points with the slopes of central differences.
        let weights = [
            s * (-0.5 + s * (1.0 - 0.5 * s)),
            1.0 + s * s * (-2.5 + 1.5 * s),
            s * (0.5 + s * (2.0 - 1.5 * s)),
            s * s * (-0.5 + 0.5 * s),
        ];
        let values = [0, 1, 2].map(|component| around.map(|x| self.turbulence.plane(component, x)));
        Planes { values, weights }
    }

    fn rows(&self, height: f64) -> Rows {
        let [_, n_y, n_z] = self.turbulence.n_points();
        let (index, weight) = place((height - self.origin.z) / self.turbulence.spacing()[2], n_z);
        Rows {
            mean: veered(self.profile.speed(height), self.veer, height - self.hub_height),
            vertical: self.vertical_share(height),
            below: index * n_y,
            above: (index + 1) % n_z * n_y,
            weight: weight as f32,
        }
    }

    /// Share of the vertical fluctuations that the ground leaves at `height` (m).
    fn vertical_share(&self, height: f64) -> f64 {
        if self.blocking_height == 0.0 {
            return 1.0;
        }
        let squared = height.max(0.0).powi(2);
        (squared / (squared + self.blocking_height.powi(2))).powf(1.0 / 6.0)
    }
}

/// The four planes around one x, with their weights.
struct Planes<'a> {
    values: [[&'a [f32]; 4]; 3],
    weights: [f32; 4],
}

impl Planes<'_> {
    #[inline(always)]
    fn at(&self, point: usize) -> [f32; 3] {
        let [a, b, c, d] = self.weights;
        self.values.map(|planes| {
            a * planes[0][point]
                + b * planes[1][point]
                + c * planes[2][point]
                + d * planes[3][point]
        })
    }
}

/// What belongs to one height.
struct Rows {
    /// Mean of u and v (m/s).
    mean: [f64; 2],
    vertical: f64,
    below: usize,
    above: usize,
    weight: f32,
}

/// Point at or before `place` (in spacings) on a grid that repeats after `n` points, and how far behind it
/// (–).
#[inline(always)]
fn place(place: f64, n: usize) -> (usize, f64) {
    let period = n as f64;
    let wrapped = if (0.0..period).contains(&place) {
        place
    } else {
        place - period * (place / period).floor()
    };
    let nearest = (wrapped + 0.5) as usize;
    if (wrapped - nearest as f64).abs() < SAME {
        return (if nearest >= n { 0 } else { nearest }, 0.0);
    }
    let index = wrapped as usize;
    (if index >= n { 0 } else { index }, wrapped - index as f64)
}

impl Inflow for TurbulentInflow {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        let [_, n_y, _] = self.turbulence.n_points();
        let per_point = 1.0 / self.turbulence.spacing()[1];
        let wind = |planes: &Planes<'_>, rows: &Rows, y: f64| {
            let (y, across) = place((y - self.origin.y) * per_point, n_y);
            let mut fluctuation = planes.at(rows.below + y);
            if across != 0.0 || rows.weight != 0.0 {
                let next = if y + 1 == n_y { 0 } else { y + 1 };
                let across = across as f32;
                let right = planes.at(rows.below + next);
                let up = planes.at(rows.above + y);
                let up_right = planes.at(rows.above + next);
                for axis in 0..3 {
                    let low = fluctuation[axis] + across * (right[axis] - fluctuation[axis]);
                    let high = up[axis] + across * (up_right[axis] - up[axis]);
                    fluctuation[axis] = low + rows.weight * (high - low);
                }
            }
            let [u, v, w] = fluctuation.map(f64::from);
            let [along, across] = rows.mean;
            Vector3::new(along + u, across + v, rows.vertical * w)
        };
        walk(positions, velocities, |x| self.planes(x, time), |z| self.rows(z), wind);
    }
}

#[cfg(test)]
#[path = "turbulent_tests.rs"]
mod tests;
