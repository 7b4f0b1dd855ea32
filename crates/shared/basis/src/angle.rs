//! Angles on the circle.

use std::f64::consts::{PI, TAU};

/// The same angle (rad) in [0, 2π).
pub fn wrap_to_turn(angle: f64) -> f64 {
    let wrapped = angle.rem_euclid(TAU);
    // `rem_euclid` rounds a tiny negative angle up to a full turn.
    if wrapped < TAU { wrapped } else { 0.0 }
}

/// The same angle (rad) in [−π, π).
pub fn wrap_to_half_turn(angle: f64) -> f64 {
    wrap_to_turn(angle + PI) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wraps_into_the_half_open_ranges() {
        for k in -7..=7 {
            let angle = 0.3 + f64::from(k) * TAU;
            assert!((wrap_to_turn(angle) - 0.3).abs() < 1e-12);
            assert!((wrap_to_half_turn(angle) - 0.3).abs() < 1e-12);
        }
        assert_eq!(wrap_to_turn(TAU), 0.0);
        assert_eq!(wrap_to_turn(-1e-18), 0.0);
        assert_eq!(wrap_to_half_turn(PI), -PI);
    }
}
