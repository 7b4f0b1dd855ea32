//! Complex numbers, as much of them as poles and frequency responses need.

use std::ops::{Add, Div, Mul, Sub};

/// A complex number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Complex {
    pub(super) re: f64,
    pub(super) im: f64,
}

impl Complex {
    pub(super) const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    pub(super) const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    pub(super) fn norm(self) -> f64 {
        self.re.hypot(self.im)
    }

    pub(super) fn argument(self) -> f64 {
        self.im.atan2(self.re)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let re = self.re * other.re - self.im * other.im;
        Self::new(re, self.re * other.im + self.im * other.re)
    }
}

impl Mul<Complex> for f64 {
    type Output = Complex;
    fn mul(self, other: Complex) -> Complex {
        Complex::new(self * other.re, self * other.im)
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let square = other.re * other.re + other.im * other.im;
        let conjugate = Self::new(other.re, -other.im);
        (1.0 / square) * (self * conjugate)
    }
}

/// Roots of the monic polynomial x^N + c\[N−1\] x^(N−1) + … + c\[0\], by simultaneous iteration (Weierstrass).
///
/// Coefficients should be of order one; the roots come in no particular order.
pub(super) fn roots<const N: usize>(coefficients: [f64; N]) -> [Complex; N] {
    let value = |x: Complex| {
        coefficients.iter().rev().fold(Complex::real(1.0), |sum, c| sum * x + Complex::real(*c))
    };
    // Powers of a number that is neither real nor a root of unity, on the circle that bounds the roots.
    let radius = coefficients.iter().fold(0.0_f64, |most, c| most.max(c.abs())).max(1e-300);
    let radius = radius.powf(1.0 / N as f64);
    let seed = Complex::new(0.4, 0.9);
    let mut power = Complex::real(radius);
    let mut roots = [(); N].map(|()| {
        power = power * seed;
        power
    });
    for _ in 0..200 {
        let mut moved = 0.0_f64;
        for index in 0..N {
            let x = roots[index];
            let others = roots.iter().enumerate().filter(|(other, _)| *other != index);
            let product = others.fold(Complex::real(1.0), |product, (_, y)| product * (x - *y));
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
            let known = Complex::new(known[0], known[1]);
            let nearest = roots.iter().map(|x| (*x - known).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-12, "{known:?}: {nearest}");
        }
    }

    #[test]
    fn division_undoes_multiplication() {
        let (x, y) = (Complex::new(0.3, -2.0), Complex::new(-1.5, 0.7));
        assert!(((x * y) / y - x).norm() < 1e-15);
        assert!((Complex::new(-1.0, 0.0).argument() - std::f64::consts::PI).abs() < 1e-15);
    }
}
