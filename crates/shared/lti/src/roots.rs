//! Roots of polynomials, which are the poles of a transfer function.

use num_complex::Complex64;

/// Roots of the monic polynomial x^N + c\[N−1\] x^(N−1) + … + c\[0\], by simultaneous iteration
/// (Weierstrass).
///
/// `coefficients` c should be of order one; the roots come in no particular order.
///
/// ```
/// // x² + 2 x + 5 = (x + 1 − 2 i)(x + 1 + 2 i)
/// let roots = lti::roots([5.0, 2.0]);
/// assert!(roots.iter().all(|root| (root.re + 1.0).abs() < 1e-12 && (root.im.abs() - 2.0).abs() < 1e-12));
/// ```
pub fn roots<const N: usize>(coefficients: [f64; N]) -> [Complex64; N] {
    let one = Complex64::new(1.0, 0.0);
    let value = |x: Complex64| coefficients.iter().rev().fold(one, |sum, c| sum * x + c);
    // Powers of a number that is neither real nor a root of unity, on the circle that bounds the roots.
    let radius = coefficients.iter().fold(0.0_f64, |most, c| most.max(c.abs())).max(1e-300);
    let radius = radius.powf(1.0 / N as f64);
    let seed = Complex64::new(0.4, 0.9);
    let mut power = Complex64::new(radius, 0.0);
    let mut roots = [(); N].map(|()| {
        power *= seed;
        power
    });
    for _ in 0..200 {
        let mut moved = 0.0_f64;
        for index in 0..N {
            let x = roots[index];
            let others = roots.iter().enumerate().filter(|(other, _)| *other != index);
            let product = others.fold(one, |product, (_, y)| product * (x - y));
            let step = value(x) / product;
            roots[index] = x - step;
            moved = moved.max(step.norm());
        }
        if moved <= 1e-15 * radius {
            break;
        }
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_a_quartic_with_known_ones() {
        // (x + 1)(x − 2)(x² + 2 x + 5)
        let roots = roots([-10.0, -9.0, 1.0, 1.0]);
        for known in [[-1.0, 0.0], [2.0, 0.0], [-1.0, 2.0], [-1.0, -2.0]] {
            let known = Complex64::new(known[0], known[1]);
            let nearest = roots.iter().map(|x| (x - known).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12, "{known:?}: {nearest}");
        }
    }
}
