//! How much a rotor slows the air ahead of it.

/// Share of the free speed (–) with which the air moves `upstream` (m) ahead of a rotor of `radius` (m) and
/// axial `induction` (–), on its axis: 1 − a (1 − s/√(s² + R²)).
///
/// Source: a cylinder of vortices behind the disc; Medici, Ivanell, Dahlberg, Alfredsson (2011), "The
/// upstream flow of a wind turbine: blockage effect", Wind Energy 14, 691, Eq. 1.
pub(super) fn speed_share(upstream: f64, radius: f64, induction: f64) -> f64 {
    1.0 - induction * (1.0 - upstream / upstream.hypot(radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_the_rotor_the_air_has_lost_the_induction_and_far_away_nothing() {
        assert_eq!(speed_share(0.0, 63.0, 0.3), 0.7);
        assert!((speed_share(63.0, 63.0, 0.3) - (0.7 + 0.3 / 2.0_f64.sqrt())).abs() < 1e-12);
        assert!((speed_share(1e6, 63.0, 0.3) - 1.0).abs() < 1e-8);
    }
}
