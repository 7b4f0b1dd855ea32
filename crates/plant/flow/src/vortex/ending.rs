//! How wakes end, and what one that ends induces at its rotor of what an endless one does.

/// Share of the wake's length over which its end fades (–).
const FADING: f64 = 0.15;
/// Way behind the disc to which an endless wake is summed (radii), and places summed for a radius (–).
const FAR: f64 = 40.0;
const PER_RADIUS: f64 = 50.0;

/// What is left of the circulation of a ring at `way` along the wake, over the wake's length (–).
pub(super) fn left_at(way: f64) -> f64 {
    let share = ((1.0 - way) / FADING).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Share (–) of an endless wake's induction that one of `length` (over the rotor's radius), its end fading as
/// that of a [`FreeWake`](super::FreeWake) does, has in the middle of its disc, where that of the endless one
/// is `induction` (–, less than ½).
///
/// The vortices of an evenly loaded disc are a tube of rings. With g = x/√(x² + 1) for the way x behind the
/// disc the air in it has the speed u = 1 − a (1 + g), the tube the square of the radius (1 − a)/u, and its
/// rings, carried with the mean of the winds on both sides, lie the closer the slower 1 − ½ a (1 + g) is.
/// With a small this is the cylinder's x/√(x² + 1).
///
/// Limits: the tube is taken to widen as it does in the wind that a cylinder induces on its axis.
pub fn share_of_endless(length: f64, induction: f64) -> f64 {
    // Symbols: a induction, g and x as above, r² the tube's radius squared.
    let a = induction;
    let ring = |x: f64| {
        let g = x / (x * x + 1.0).sqrt();
        let squared = (1.0 - a) / (1.0 - a * (1.0 + g));
        squared / (x * x + squared).powf(1.5) / (1.0 - 0.5 * a * (1.0 + g))
    };
    let n = (FAR * PER_RADIUS) as usize;
    let (mut ended, mut endless) = (0.0, 0.0);
    for k in 0..n {
        let x = (k as f64 + 0.5) / PER_RADIUS;
        endless += ring(x);
        ended += ring(x) * left_at(x / length);
    }
    // Beyond, a ring counts as x⁻³.
    endless += 0.5 * FAR * PER_RADIUS * ring(FAR);
    ended / endless
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_weak_wake_is_a_cylinder() {
        for length in [1.0, 2.0, 6.0] {
            // Half of what fades is missing; the bend of x/√(x² + 1) over that part makes the rest.
            let lasting: f64 = (1.0 - 0.5 * FADING) * length;
            let expected = lasting / (lasting * lasting + 1.0).sqrt();
            let found = share_of_endless(length, 0.0);
            assert!((found - expected).abs() < 2e-3, "{length} {found} {expected}");
        }
        assert!((share_of_endless(1e6, 0.0) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_strong_wake_is_wider_and_thicker_further_down() {
        for length in [1.0, 2.0, 4.0] {
            let shares = [0.0, 0.1, 0.2, 0.3].map(|a| share_of_endless(length, a));
            assert!(shares.windows(2).all(|pair| pair[1] < pair[0]), "{shares:?}");
        }
        let shares = [1.0, 2.0, 4.0, 16.0].map(|length| share_of_endless(length, 0.3));
        assert!(shares.windows(2).all(|pair| pair[1] > pair[0]), "{shares:?}");
        // Far behind r² is (1 − a)/(1 − 2a), and r²/2l² of a tube is missing beyond l; here half of what
        // fades comes off.
        let missing = 0.5 * 0.7 / 0.4 / (0.925_f64 * 16.0).powi(2);
        assert!((1.0 - shares[3] - missing).abs() < 0.2 * missing, "{shares:?} {missing}");
    }
}
