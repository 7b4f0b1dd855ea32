//! A straight vortex segment and its core: the law that everything else here sums.

use basis::Vector3;
use std::f64::consts::PI;

/// Lamb's constant α (–): a Lamb-Oseen vortex turns fastest at √(4 α ν t).
pub(super) const LAMB: f64 = 1.256_43;

/// Share with which the way beyond a segment's end counts in the distance from it (–), 2/e: with it
/// infinitely short pieces of a thin ring move it at Saffman's speed, (ln 8R/r − ½) Γ/4πR.
pub(super) const BEYOND: f64 = 2.0 / std::f64::consts::E;

/// A straight piece of vortex filament.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Segment {
    /// Where it begins, farm frame (m).
    pub from: Vector3,
    /// Where it ends (m).
    pub to: Vector3,
    /// Circulation, right-handed about the way from begin to end (m²/s).
    pub circulation: f64,
    /// Square of its core's radius (m²).
    pub core_squared: f64,
}

impl Segment {
    /// Velocity (m/s) that it induces at `position` (m, farm frame).
    ///
    /// The law of Biot and Savart, weighted as in a vortex after Vatistas with n = 2: h²/√(r⁴ + h⁴), with h
    /// the distance from the segment and r the core's radius. Beyond its ends way along the line counts too:
    /// a bent filament so feels its own bend from a core's radius on, as a bent vortex does (short pieces of
    /// a thin [ring](super::rings) move it at Saffman's speed), and not from √(2 r R) on, with R the radius
    /// of the bend. The price: a straight chain of pieces shorter than r is a tighter vortex than Vatistas',
    /// fastest at 0.75 r; one of pieces of 4 r is his within a tenth.
    /// Sources: Vatistas, Kozel, Mih (1991), eq. 4; van Garrel, ECN-C--03-079, for the form without angles.
    pub fn velocity(&self, position: Vector3) -> Vector3 {
        self.per_circulation(position) * self.circulation
    }

    /// The same per unit of circulation (1/m).
    pub fn per_circulation(&self, position: Vector3) -> Vector3 {
        // Symbols: r₁, r₂ from the ends to the position, p = |r₁||r₂|, d = r₁·r₂, c = r₁ × r₂.
        let (r1, r2) = (position - self.from, position - self.to);
        let p = (r1.length_squared() * r2.length_squared()).sqrt();
        let (d, c) = (r1.dot(r2), r1.cross(r2));
        let along = self.to - self.from;
        // (h l)², the length being l; at x beyond an end h² is that from the line and a share of x (x + l).
        let beyond = (r1.dot(along) * r2.dot(along)).max(0.0);
        let reach = c.length_squared() + BEYOND * beyond;
        let core = self.core_squared * along.length_squared();
        let around = (core * core + reach * reach).sqrt();
        if p == 0.0 || around == 0.0 {
            return Vector3::ZERO;
        }
        // (p − d)/c² is 1/(p + d): each where it does not cancel. With d < 0 the position is beside the
        // segment.
        let difference = if d > 0.0 { reach / (p + d) } else { p - d };
        let sum = (r1.length() + r2.length()) / p;
        c * (sum * difference / (4.0 * PI * around))
    }
}

/// How the cores of vortices begin and grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cores {
    /// Radius at birth over the width of the blade elements next to it (–).
    pub initial_widths: f64,
    /// Kinematic viscosity of the air ν (m²/s).
    pub kinematic_viscosity: f64,
    /// How eddies in the core speed its growth, a₁ in Squire's 1 + a₁ |Γ|/ν (–).
    pub eddy_constant: f64,
    /// Whether cores become thinner where their vortex is stretched, their volume being kept.
    pub strain: bool,
}

impl Cores {
    /// Square of the radius (m²) of a core that was `born` with such a square (m²), at `age` (s), of a
    /// segment of `circulation` (m²/s) that keeps its length: r² = r₀² + 4 α δ ν t, δ = 1 + a₁ |Γ|/ν.
    /// Sources: Squire (1965); Bhagwat and Leishman (2002), a₁ between 6·10⁻⁵ and 2·10⁻⁴.
    pub fn squared(&self, born: f64, age: f64, circulation: f64) -> f64 {
        let viscosity = self.kinematic_viscosity + self.eddy_constant * circulation.abs();
        born + 4.0 * LAMB * viscosity * age
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The integral of Biot and Savart along `segment`, cut into pieces of three Gauss points each.
    fn by_quadrature(segment: &Segment, position: Vector3) -> Vector3 {
        const PIECES: usize = 4000;
        let along = segment.to - segment.from;
        let points =
            [(-0.6_f64.sqrt(), 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.6_f64.sqrt(), 5.0 / 18.0)];
        let mut sum = Vector3::ZERO;
        for piece in 0..PIECES {
            for (at, weight) in points {
                let share = (piece as f64 + 0.5 + 0.5 * at) / PIECES as f64;
                let r = position - (segment.from + along * share);
                sum += along.cross(r) * (weight / r.length().powi(3) / PIECES as f64);
            }
        }
        sum * (segment.circulation / (4.0 * PI))
    }

    proptest! {
        #[test]
        fn a_thin_segment_is_the_integral_of_biot_and_savart(
            to in prop::array::uniform3(-3.0..3.0_f64),
            at in prop::array::uniform3(-4.0..4.0_f64),
            circulation in -50.0..50.0_f64,
        ) {
            let (from, to) = (Vector3::new(0.2, -0.1, 0.4), Vector3::from_array(to));
            let segment = Segment { from, to, circulation, core_squared: 0.0 };
            let position = Vector3::from_array(at);
            let along = to - from;
            let share = ((position - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            prop_assume!((position - from - along * share).length() > 0.05 && along.length() > 0.1);
            let expected = by_quadrature(&segment, position);
            let error = (segment.velocity(position) - expected).length();
            prop_assert!(error <= 1e-11 * circulation.abs().max(1.0) * (1.0 + expected.length()), "{error}");
        }
    }

    #[test]
    fn a_long_segment_is_a_vortex_after_vatistas() {
        let segment = Segment {
            from: Vector3::X * -1e6,
            to: Vector3::X * 1e6,
            circulation: 7.0,
            core_squared: 0.09,
        };
        for h in [0.01, 0.3, 2.0] {
            let found = segment.velocity(Vector3::Y * h);
            let expected = 7.0 / (2.0 * PI) * h / (0.09_f64.powi(2) + h.powi(4)).sqrt();
            assert!((found.z - expected).abs() < 1e-9 * expected, "{found} {expected}");
            assert!(found.x == 0.0 && found.y == 0.0);
        }
        // Far away on its own line, and at its ends, nothing is induced.
        for at in [Vector3::X * 2e6, segment.from, segment.to, Vector3::ZERO] {
            assert_eq!(segment.velocity(at), Vector3::ZERO);
        }
    }

    #[test]
    fn far_away_a_segment_is_a_vortex_element() {
        let core_squared = 0.04;
        let segment = Segment {
            from: Vector3::ZERO,
            to: Vector3::new(0.1, 0.2, -0.1),
            circulation: 3.0,
            core_squared,
        };
        let (middle, along) = (0.5 * segment.to, segment.to);
        let at = Vector3::new(900.0, -500.0, 400.0);
        let r = at - middle;
        let expected = along.cross(r) * (3.0 / (4.0 * PI * r.length().powi(3)));
        // The ends are at 2e-4 of the distance, whose square is missing; rounding in p + d is 1e-16.
        assert!((segment.velocity(at) - expected).length() < 1e-7 * expected.length());
    }

    #[test]
    fn cores_grow_as_squire_has_it() {
        let cores = Cores {
            initial_widths: 0.25,
            kinematic_viscosity: 1.5e-5,
            eddy_constant: 1e-4,
            strain: false,
        };
        // Γ/ν = 2e6: δ = 201.
        let squared = cores.squared(0.04, 10.0, -30.0);
        assert!((squared - (0.04 + 4.0 * 1.25643 * 201.0 * 1.5e-5 * 10.0)).abs() < 1e-12);
        assert_eq!(cores.squared(0.04, 0.0, 5.0), 0.04);
    }
}
