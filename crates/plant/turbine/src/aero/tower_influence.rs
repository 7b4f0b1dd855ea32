//! Tower influence on the wind: potential flow ahead of the tower, tower shadow behind it.
//!
//! Source: Bak, Madsen, Johansen, "Influence from blade-tower interaction on fatigue loads and dynamics",
//! EWEC 2001 (potential flow about a cylinder, with the drag's part); Powles, "The effects of tower shadow on
//! the dynamics of a horizontal-axis wind turbine", Wind Engineering 7, 1983 (wake). AeroDyn has both.

use crate::definition::{Definition, TowerProfile};
use basis::Vector3;
use std::f64::consts::PI;

/// Distance of the potential flow's centre upwind of the axis, in tower radii (–).
const OFFSET: f64 = 0.1;
/// Distance (tower radii) beyond which the wind is not changed: there the influence is a thousandth of it at
/// most.
const REACH: f64 = 80.0;

/// Which effects are active.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effects {
    /// Flow about the tower, ahead of it and beside it.
    pub potential: Potential,
    /// Tower shadow: the wake behind it.
    pub shadow: bool,
}

/// Potential flow about the tower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Potential {
    /// None.
    None,
    /// About a cylinder (AeroDyn's `TwrPotent` 1).
    Cylinder,
    /// After Bak: about a cylinder a little upwind, with a source for the tower's drag (`TwrPotent` 2).
    WithDrag,
}

/// A stiff, upright tower in the wind.
#[derive(Clone, Debug, PartialEq)]
pub struct TowerInfluence {
    foot: Vector3,
    profile: Vec<TowerProfile>,
    effects: Effects,
}

impl TowerInfluence {
    /// The tower of `definition` with its foot, the ground or the sea below it, at `foot` (m).
    pub fn new(definition: &Definition, foot: Vector3, effects: Effects) -> Self {
        Self { foot, profile: definition.tower.profile.clone(), effects }
    }

    /// Wind at `position` (m) where it would be `wind` (m/s) without the tower.
    ///
    /// At heights beside the tower only: above its top and below its foot the wind is as it was. On the
    /// tower's skin and within it the wind is that at the skin.
    pub fn felt(&self, position: Vector3, wind: Vector3) -> Vector3 {
        let Some((radius, drag)) = self.section(position.z - self.foot.z) else {
            return wind;
        };
        let (east, north) = (position.x - self.foot.x, position.y - self.foot.y);
        let reach = REACH * radius;
        let speed = wind.x.hypot(wind.y);
        if east * east + north * north > reach * reach || speed == 0.0 {
            return wind;
        }
        let along = Vector3::new(wind.x / speed, wind.y / speed, 0.0);
        let across = Vector3::new(-along.y, along.x, 0.0);
        let x = (east * along.x + north * along.y) / radius;
        let y = (east * across.x + north * across.y) / radius;
        let [slowed, turned] = self.disturbance(x, y, drag);
        wind + along * (speed * slowed) + across * (speed * turned)
    }

    /// Change of the wind along and across itself, over its speed (–), `x` downwind and `y` across in tower
    /// radii (–).
    fn disturbance(&self, x: f64, y: f64, drag: f64) -> [f64; 2] {
        let mut change = [0.0; 2];
        if self.effects.potential != Potential::None {
            let (x, drag) = match self.effects.potential {
                Potential::WithDrag => (x + OFFSET, drag),
                _ => (x, 0.0),
            };
            let square = (x * x + y * y).max(1.0);
            let source = drag / (2.0 * PI * square);
            change[0] += (y * y - x * x) / (square * square) + source * x;
            change[1] += -2.0 * x * y / (square * square) + source * y;
        }
        let width = x.hypot(y).max(1.0).sqrt();
        if self.effects.shadow && x > 0.0 && y.abs() < width {
            let cosine = (0.5 * PI * y / width).cos();
            change[0] -= drag / width * cosine * cosine;
        }
        change
    }

    /// Radius (m) and drag coefficient (–) at `height` (m) above the foot; None above and below the tower.
    fn section(&self, height: f64) -> Option<(f64, f64)> {
        let next = self.profile.partition_point(|row| row.height <= height);
        let (low, high) = (self.profile.get(next.checked_sub(1)?)?, self.profile.get(next)?);
        let share = (height - low.height) / (high.height - low.height);
        let between = |from: f64, to: f64| from + share * (to - from);
        Some((
            0.5 * between(low.diameter, high.diameter),
            between(low.drag_coefficient, high.drag_coefficient),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tower(drag: f64, potential: Potential, shadow: bool) -> TowerInfluence {
        let row =
            |height: f64, diameter: f64| TowerProfile { height, diameter, drag_coefficient: drag };
        TowerInfluence {
            foot: Vector3::new(5.0, -3.0, 0.0),
            profile: vec![row(10.0, 8.0), row(50.0, 8.0), row(100.0, 6.0)],
            effects: Effects { potential, shadow },
        }
    }

    #[test]
    fn a_cylinder_in_potential_flow() {
        // Stagnation ahead of the cylinder, twice the wind beside it.
        let tower = tower(0.5, Potential::Cylinder, false);
        let wind = Vector3::X * 10.0;
        let centre = tower.foot + Vector3::Z * 30.0;
        let ahead = tower.felt(centre - Vector3::X * 4.0, wind);
        assert!(ahead.length() < 1e-9, "{ahead}");
        let beside = tower.felt(centre + Vector3::Y * 4.0, wind);
        assert!((beside - wind * 2.0).length() < 1e-9, "{beside}");
        for far in [Vector3::X * -400.0, Vector3::Z * 80.0, Vector3::Z * -29.0] {
            assert_eq!(tower.felt(centre + far, wind), wind);
        }
        // It carries no air away: the flow through a circle about it vanishes.
        let sum: f64 = (0..720)
            .map(|k| {
                let angle = f64::from(k) * PI / 360.0;
                let outwards = Vector3::new(angle.cos(), angle.sin(), 0.0);
                (tower.felt(centre + outwards * 9.0, wind) - wind).dot(outwards)
            })
            .sum();
        assert!(sum.abs() < 1e-9);
    }

    #[test]
    fn drag_slows_the_wind_ahead_as_a_source_does() {
        // Far ahead the doublet has gone and the source's Cd R / 2πr is left.
        let tower = tower(0.5, Potential::WithDrag, false);
        let wind = Vector3::X * 10.0;
        let (radius, distance) = (4.0, 100.0);
        let felt = tower.felt(tower.foot + Vector3::new(-distance, 0.0, 30.0), wind);
        let source = 0.5 * radius / (2.0 * PI * distance);
        let doublet = (radius / distance).powi(2);
        assert!((1.0 - felt.x / 10.0 - source - doublet).abs() < 0.02 * source, "{felt}");
    }

    #[test]
    fn slower_ahead_and_behind_and_mirrored() {
        let (wind, height) = (Vector3::new(8.0, 6.0, 0.5), Vector3::Z * 70.0);
        let both = tower(0.5, Potential::WithDrag, true);
        let along = Vector3::new(0.8, 0.6, 0.0);
        let across = Vector3::new(-0.6, 0.8, 0.0);
        for distance in [-15.0, -8.0, 6.0, 30.0] {
            let felt = both.felt(both.foot + height + along * distance, wind);
            assert!(felt.dot(along) < 10.0 && felt.dot(across).abs() < 1e-9 && felt.z == 0.5);
            let [left, right] = [3.0, -3.0]
                .map(|side| both.felt(both.foot + height + along * distance + across * side, wind));
            assert!((left.dot(along) - right.dot(along)).abs() < 1e-9);
            assert!((left.dot(across) + right.dot(across)).abs() < 1e-9);
        }
        // Momentum behind it: the deficit's width times depth is the drag, Cd d over half the wind's square,
        // to first order.
        let shadow = tower(0.1, Potential::None, true);
        let deficit: f64 = (-4000..4000)
            .map(|k| {
                let side = across * (0.01 * f64::from(k));
                let felt = shadow.felt(shadow.foot + height * 0.5 + along * 60.0 + side, wind);
                0.01 * (10.0 - felt.dot(along)) / 10.0
            })
            .sum();
        assert!((deficit / (0.1 * 4.0) - 1.0).abs() < 1e-2, "{deficit}");
    }
}
