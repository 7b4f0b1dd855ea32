//! How long the air takes from upwind to the rotor, which slows it on the way.

/// Pieces of the way (–), an even number. Over ten radii Simpson's rule is exact to 1e-5 with them.
const N_PIECES: u32 = 32;

/// Share of the free speed (–) with which the air moves `upstream` (m) ahead of a rotor of `radius` (m) and
/// axial `induction` (–), on its axis: 1 − a (1 − s/√(s² + R²)).
///
/// Source: a cylinder of vortices behind the disc; Medici, Ivanell, Dahlberg, Alfredsson (2011), "The
/// upstream flow of a wind turbine: blockage effect", Wind Energy 14, 691, Eq. 1.
pub(super) fn speed_share(upstream: f64, radius: f64, induction: f64) -> f64 {
    1.0 - induction * (1.0 - upstream / upstream.hypot(radius))
}

/// Distance (m) that the free wind covers while the air comes from `upstream` (m) to the rotor: ∫ ds over its
/// [share](speed_share) of the free speed.
pub(super) fn free_way(upstream: f64, radius: f64, induction: f64) -> f64 {
    if induction == 0.0 {
        return upstream;
    }
    let piece = upstream / f64::from(N_PIECES);
    let slowness = |index: u32| 1.0 / speed_share(f64::from(index) * piece, radius, induction);
    let inner: f64 = (1..N_PIECES)
        .map(|index| if index.is_multiple_of(2) { 2.0 } else { 4.0 } * slowness(index))
        .sum();
    (slowness(0) + inner + slowness(N_PIECES)) * piece / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By a rule with a thousand times the pieces.
    #[test]
    fn the_way_is_the_integral_of_the_slowness() {
        for induction in [0.1, 0.25, 0.33, 0.4] {
            for upstream in [30.0, 126.0, 252.0, 630.0] {
                let n = 40_000;
                let piece = upstream / f64::from(n);
                let middle = |index: u32| (f64::from(index) + 0.5) * piece;
                let fine: f64 =
                    (0..n).map(|k| piece / speed_share(middle(k), 63.0, induction)).sum();
                let way = free_way(upstream, 63.0, induction);
                assert!((way / fine - 1.0).abs() < 1e-5, "{induction}, {upstream}: {way}, {fine}");
                // Slower than the free wind, faster than at the rotor.
                assert!(way > upstream && way < upstream / (1.0 - induction));
            }
        }
    }

    #[test]
    fn at_the_rotor_the_air_has_lost_the_induction_and_far_away_nothing() {
        assert_eq!(speed_share(0.0, 63.0, 0.3), 0.7);
        assert!((speed_share(1e6, 63.0, 0.3) - 1.0).abs() < 1e-8);
        assert_eq!(free_way(200.0, 63.0, 0.0), 200.0);
    }
}
