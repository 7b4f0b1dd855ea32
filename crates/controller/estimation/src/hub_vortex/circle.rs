//! The middle of a circle of which some arcs are missing.

/// Sums for the least-squares fit of places p = m + c e^(−iθ), complex numbers up + i right.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Circle {
    /// Σ w.
    weight: f64,
    /// Σ w p.
    place: [f64; 2],
    /// Σ w e^(iθ).
    turn: [f64; 2],
    /// Σ w e^(iθ) p.
    turned: [f64; 2],
}

/// Share of the circle's scatter that must be left beside the mean's (–): on a shorter arc the two cannot be
/// told apart.
const LEAST: f64 = 0.3;

impl Circle {
    /// Takes in a `place`, left and up, of `weight` at the angle θ of `turn` (cosine and sine).
    pub(super) fn add(&mut self, weight: f64, place: [f64; 2], turn: [f64; 2]) {
        let place = [place[1], -place[0]];
        let turned = product(turn, place);
        self.weight += weight;
        for axis in 0..2 {
            self.place[axis] += weight * place[axis];
            self.turn[axis] += weight * turn[axis];
            self.turned[axis] += weight * turned[axis];
        }
    }

    /// The plain mean, left and up.
    pub(super) fn mean(&self) -> [f64; 2] {
        let [up, right] =
            self.place.map(|sum| if self.weight > 0.0 { sum / self.weight } else { 0.0 });
        [-right, up]
    }

    /// The middle of the circle, left and up; the plain mean of too short an arc.
    pub(super) fn centre(&self) -> [f64; 2] {
        let squares = self.turn[0].powi(2) + self.turn[1].powi(2);
        let left = self.weight.powi(2) - squares;
        if left <= LEAST * self.weight.powi(2) {
            return self.mean();
        }
        let circle = product([self.turn[0], -self.turn[1]], self.turned);
        let middle = |axis: usize| (self.weight * self.place[axis] - circle[axis]) / left;
        [-middle(1), middle(0)]
    }
}

/// Product of two complex numbers.
fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of 7 m about (3, −2) m: the angle of its places runs against that of the frame.
    fn circle(angles: impl Iterator<Item = f64>) -> Circle {
        let mut sums = Circle::default();
        for angle in angles {
            let (up, right) = (-2.0 + 7.0 * angle.cos(), -3.0 - 7.0 * angle.sin());
            sums.add(0.5, [-right, up], [angle.cos(), angle.sin()]);
        }
        sums
    }

    #[test]
    fn a_gap_moves_the_mean_and_not_the_centre() {
        let most = |n: i32| (0..n).map(|step| std::f64::consts::TAU * f64::from(step) / 100.0);
        for n in [100, 70] {
            let sums = circle(most(n));
            let [left, up] = sums.centre();
            assert!((left - 3.0).hypot(up + 2.0) < 1e-12, "{n}: {left} {up}");
        }
        let off = |n| {
            let [left, up] = circle(most(n)).mean();
            (left - 3.0).hypot(up + 2.0)
        };
        assert!(off(100) < 1e-12 && off(70) > 2.0);
        // An eighth of a turn tells its mean alone.
        let short = circle(most(12));
        assert_eq!(short.centre(), short.mean());
        assert_eq!(Circle::default().centre(), [0.0; 2]);
    }
}
