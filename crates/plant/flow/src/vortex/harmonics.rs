//! Solid harmonics: what vortex elements in a ball amount to outside of it.
//!
//! Regular ones Υ and irregular ones Θ, for which 1/|x − y| = Σ Υ̅(y) Θ(x) where y is nearer to the origin,
//! are those of Legendre's functions P without the sign of Condon and Shortley: Υ = rⁿ P e^(imφ) / (n + m)!,
//! Θ = (n − m)! P e^(imφ) / rⁿ⁺¹. Orders below zero follow from those above,
//! f(n, −m) = (−1)ᵐ f̅(n, m), so that only those from zero on are kept, degree after degree.
//!
//! Source for recurrences and sums of places: Dehnen (2014), Computational Astrophysics and Cosmology 1:1,
//! appendix A, with other signs.

use basis::Vector3;
use rustfft::num_complex::Complex64;

/// Lowest degree at which a box says anything of the way its vortices lie in it (–).
pub const LOWEST_DEGREE: usize = 2;
/// Highest degree: beyond it single precision is what limits (–).
pub const HIGHEST_DEGREE: usize = 6;

/// A vector of three complex components.
pub(super) type Moment = [Complex64; 3];

const ZERO: Complex64 = Complex64 { re: 0.0, im: 0.0 };
pub(super) const NO_MOMENT: Moment = [ZERO; 3];
const MOST: usize = n_moments(HIGHEST_DEGREE);

/// Moments up to `degree` (–).
pub(super) const fn n_moments(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// Values that [`velocity_coefficients`] gives at `degree` (–).
pub(super) const fn n_coefficients(degree: usize) -> usize {
    3 * ((degree + 2) * (degree + 2) - 1)
}

const fn place_of(n: usize, m: usize) -> usize {
    n * (n + 1) / 2 + m
}

/// Regular harmonics at `at` up to `degree`.
fn regular(degree: usize, at: Vector3) -> [Complex64; MOST] {
    let mut all = [ZERO; MOST];
    let across = Complex64::new(at.x, at.y);
    let squared = at.length_squared();
    let mut diagonal = Complex64::new(1.0, 0.0);
    for m in 0..=degree {
        if m > 0 {
            diagonal *= across / (2 * m) as f64;
        }
        let (mut before, mut value) = (ZERO, diagonal);
        all[place_of(m, m)] = value;
        for n in m + 1..=degree {
            let next = (value * (at.z * (2 * n - 1) as f64) - before * squared)
                / ((n - m) * (n + m)) as f64;
            (before, value) = (value, next);
            all[place_of(n, m)] = value;
        }
    }
    all
}

/// Adds what an element of `strength` at `at` from the centre (m) amounts to up to `degree` to `moments`.
pub(super) fn add_element(degree: usize, strength: Vector3, at: Vector3, moments: &mut [Moment]) {
    let all = regular(degree, at);
    for (moment, harmonic) in moments.iter_mut().zip(&all[..n_moments(degree)]) {
        for (value, strength) in moment.iter_mut().zip(strength.to_array()) {
            *value += harmonic.conj() * strength;
        }
    }
}

/// Adds what the `moments` of a box amount to about a centre from which its own lies `way` (m) to `sum`.
pub(super) fn raise(degree: usize, moments: &[Moment], way: Vector3, sum: &mut [Moment]) {
    let shifts = regular(degree, way);
    for n in 0..=degree {
        for m in 0..=n {
            let mut raised = NO_MOMENT;
            for k in 0..=n {
                let (k_, m_, left) = (k as isize, m as isize, (n - k) as isize);
                for l in (m_ - left).max(-k_)..=(m_ + left).min(k_) {
                    let shift = at_order(k, l, |place| shifts[place]).conj();
                    for (axis, value) in raised.iter_mut().enumerate() {
                        *value += shift * at_order(n - k, m_ - l, |place| moments[place][axis]);
                    }
                }
            }
            for (sum, value) in sum[place_of(n, m)].iter_mut().zip(raised) {
                *sum += value;
            }
        }
    }
}

/// The value of degree `n` and order `m`, of either sign, of which `value` has those not below zero.
fn at_order(n: usize, m: isize, value: impl Fn(usize) -> Complex64) -> Complex64 {
    let found = value(place_of(n, m.unsigned_abs()));
    match (m < 0, m % 2 == 0) {
        (false, _) => found,
        (true, true) => found.conj(),
        (true, false) => -found.conj(),
    }
}

/// On return `coefficients` hold those of the velocity, the curl of what `moments` of `degree` are the
/// potential of, by irregular harmonics of places in units of `unit` (m): order after order, in each from the
/// lowest degree on, three components of the real part, then, but for order zero, three of the imaginary one.
pub(super) fn velocity_coefficients(
    degree: usize,
    moments: &[Moment],
    unit: f64,
    coefficients: &mut [f32],
) {
    let mut rest = coefficients.iter_mut();
    let mut put = |values: [f64; 3]| {
        for (value, target) in values.into_iter().zip(rest.by_ref()) {
            *target = value as f32;
        }
    };
    for m in 0..=degree + 1 {
        for n in m.max(1)..=degree + 1 {
            let curl = curl_at(n, m as isize, moments);
            let scale = unit.powi(-(n as i32 + 1));
            if m == 0 {
                put(curl.map(|value| value.re * scale));
            } else {
                // Orders above and below zero together: twice the real part of the product.
                put(curl.map(|value| 2.0 * value.re * scale));
                put(curl.map(|value| -2.0 * value.im * scale));
            }
        }
    }
}

/// The curl's coefficient of degree `n` ≥ 1 and order `m`: derivatives of an irregular harmonic are others of
/// one degree more, ∂z Θ(n, m) = −Θ(n + 1, m), (∂x ± i ∂y) Θ(n, m) = ∓Θ(n + 1, m ± 1).
fn curl_at(n: usize, m: isize, moments: &[Moment]) -> Moment {
    let of = |m: isize, axis: usize| {
        if m.unsigned_abs() >= n {
            return ZERO;
        }
        at_order(n - 1, m, |place| moments[place][axis])
    };
    let half = Complex64::new(0.0, 0.5);
    let along = |derivative: usize, axis: usize| match derivative {
        0 => (of(m + 1, axis) - of(m - 1, axis)) * 0.5,
        1 => (of(m + 1, axis) + of(m - 1, axis)) * half,
        _ => -of(m, axis),
    };
    [along(1, 2) - along(2, 1), along(2, 0) - along(0, 2), along(0, 1) - along(1, 0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    const DEGREE: usize = 6;
    const ELEMENTS: [(Vector3, Vector3); 3] = [
        (Vector3::new(0.3, -0.2, 0.5), Vector3::new(1.0, 2.0, -0.5)),
        (Vector3::new(-0.4, 0.1, -0.3), Vector3::new(-0.7, 0.4, 1.5)),
        (Vector3::new(0.1, 0.45, 0.2), Vector3::new(0.2, -1.1, 0.6)),
    ];

    fn moments_about(centre: Vector3) -> Vec<Moment> {
        let mut moments = vec![NO_MOMENT; n_moments(DEGREE)];
        for (at, strength) in ELEMENTS {
            add_element(DEGREE, strength, at - centre, &mut moments);
        }
        moments
    }

    /// Sum of coefficients and irregular harmonics at `at`, by Legendre's functions in place of recurrences
    /// from degree to degree.
    fn velocity(coefficients: &[f32], at: Vector3) -> Vector3 {
        let r = at.length();
        let mut value = Vector3::ZERO;
        let mut rest = coefficients.chunks_exact(3);
        for m in 0..=DEGREE + 1 {
            let turned = Complex64::from_polar(1.0, m as f64 * at.y.atan2(at.x));
            for n in m.max(1)..=DEGREE + 1 {
                let size = factorial(n - m) * legendre(n, m, at.z / r) / r.powi(n as i32 + 1);
                for part in [size * turned.re, size * turned.im].iter().take(1 + m.min(1)) {
                    let of_part = rest.next().expect("three for each part");
                    value += *part * Vector3::from_array([0, 1, 2].map(|k| f64::from(of_part[k])));
                }
            }
        }
        value
    }

    fn factorial(n: usize) -> f64 {
        (1..=n).map(|k| k as f64).product()
    }

    /// Legendre's function without the sign of Condon and Shortley, by its sum over powers:
    /// P = (1 − x²)^(m/2) dᵐ⁺ⁿ/dxᵐ⁺ⁿ (x² − 1)ⁿ / 2ⁿ n!.
    fn legendre(n: usize, m: usize, x: f64) -> f64 {
        let term = |k: usize| {
            let power = 2 * (n - k);
            if power < n + m {
                return 0.0;
            }
            let binomial = factorial(n) / (factorial(k) * factorial(n - k));
            let derived = factorial(power) / factorial(power - n - m);
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * binomial * derived * x.powi((power - n - m) as i32)
        };
        let sum: f64 = (0..=n).map(term).sum();
        (1.0 - x * x).powf(0.5 * m as f64) * sum / (2.0_f64.powi(n as i32) * factorial(n))
    }

    #[test]
    fn far_away_elements_are_what_biot_and_savart_have() {
        let unit = 0.8;
        let mut coefficients = vec![0.0; n_coefficients(DEGREE)];
        velocity_coefficients(DEGREE, &moments_about(Vector3::ZERO), unit, &mut coefficients);
        for at in [Vector3::new(4.0, 2.0, -3.0), Vector3::new(-1.0, 0.5, 5.0), Vector3::X * 6.0] {
            let found = velocity(&coefficients, at / unit);
            let expected: Vector3 = ELEMENTS
                .map(|(place, strength)| {
                    let from = at - place;
                    strength.cross(from) / from.length().powi(3)
                })
                .into_iter()
                .sum();
            // Elements lie within 0.62 of the centre, places 5 from it: 8 (0.124)⁷ is left out.
            assert!((found - expected).length() < 4e-6 * expected.length(), "{found} {expected}");
        }
    }

    #[test]
    fn raised_moments_are_those_about_the_other_centre() {
        let (low, high) = (Vector3::new(0.1, 0.2, -0.1), Vector3::new(-0.5, 0.3, 0.4));
        let mut raised = vec![NO_MOMENT; n_moments(DEGREE)];
        raise(DEGREE, &moments_about(low), low - high, &mut raised);
        for (raised, expected) in raised.iter().flatten().zip(moments_about(high).iter().flatten())
        {
            assert!((raised - expected).norm() < 1e-13, "{raised} {expected}");
        }
    }
}
