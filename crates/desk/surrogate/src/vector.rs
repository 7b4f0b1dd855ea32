//! Loops over many numbers, compiled for each instruction set and chosen at run time.
//!
//! Plain arithmetic in a fixed order, never fused: each instruction set gives the same bits.

use crate::Shape;
use crate::kernel::{matern32, matern52, rational_quadratic, squared_exponential};

/// Numbers that are worked on side by side (–).
const LANES: usize = 32;

macro_rules! vectorised {
    ($(#[$doc:meta])* fn $name:ident($($argument:ident: $type:ty),* $(,)?) $body:block) => {
        $(#[$doc])*
        pub(crate) fn $name($($argument: $type),*) {
            #[inline(always)]
            fn plain($($argument: $type),*) $body

            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f")]
                fn of_eight($($argument: $type),*) {
                    plain($($argument),*);
                }
                #[target_feature(enable = "avx2")]
                fn of_four($($argument: $type),*) {
                    plain($($argument),*);
                }
                if is_x86_feature_detected!("avx512f") {
                    // SAFETY: the instructions were found on this machine.
                    return unsafe { of_eight($($argument),*) };
                }
                if is_x86_feature_detected!("avx2") {
                    // SAFETY: as above.
                    return unsafe { of_four($($argument),*) };
                }
            }
            plain($($argument),*);
        }
    };
}

/// exp(`x`) for `x` ≤ 0, within two units of the last place; below −708 that of −708, some 10⁻³⁰⁸.
///
/// exp(x) = 2ⁿ exp(r) with |r| ≤ ln 2/2, and Taylor's series of 14 terms, whose rest is below 2⁻⁵³.
#[inline(always)]
pub(crate) fn exp(x: f64) -> f64 {
    /// Adding it rounds to a whole number, which then stands in the last bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
    const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    const COEFFICIENTS: [f64; 14] = [
        1.0 / 6_227_020_800.0,
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
        1.0,
        1.0,
    ];
    let x = if x > -708.0 { x } else { -708.0 };
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    let rest = (x - n * LN_2_HIGH) - n * LN_2_LOW;
    let mut sum = COEFFICIENTS[0];
    for coefficient in &COEFFICIENTS[1..] {
        sum = sum * rest + coefficient;
    }
    f64::from_bits(sum.to_bits().wrapping_add(shifted.to_bits() << 52))
}

vectorised! {
    /// On return `squares` are Σ (column − other)² over the columns.
    fn square_distances(squares: &mut [f64], columns: &[&[f64]], others: &[f64]) {
        let n = squares.len();
        let whole = n - n % LANES;
        for start in (0..whole).step_by(LANES) {
            let mut sums = [0.0; LANES];
            for (column, other) in columns.iter().zip(others) {
                let column = &column[start..start + LANES];
                for (sum, value) in sums.iter_mut().zip(column) {
                    let away = value - other;
                    *sum += away * away;
                }
            }
            squares[start..start + LANES].copy_from_slice(&sums);
        }
        for (index, square) in squares.iter_mut().enumerate().skip(whole) {
            *square = 0.0;
            for (column, other) in columns.iter().zip(others) {
                let away = column[index] - other;
                *square += away * away;
            }
        }
    }
}

vectorised! {
    /// Adds (2 gain sin(a − other))² to `squares`, of the sines and cosines of a and of `other`.
    fn add_turns(squares: &mut [f64], sines: &[f64], cosines: &[f64], other: [f64; 2], gain: f64) {
        let factor = 4.0 * gain * gain;
        for ((square, sine), cosine) in squares.iter_mut().zip(sines).zip(cosines) {
            let away = sine * other[1] - cosine * other[0];
            *square += factor * (away * away);
        }
    }
}

vectorised! {
    /// On return `values` and `slopes` are the shape's function and its derivative at `squares`.
    fn profile(shape: Shape, squares: &[f64], values: &mut [f64], slopes: &mut [f64]) {
        macro_rules! each {
            ($of:expr) => {
                for ((square, value), slope) in squares.iter().zip(values).zip(slopes) {
                    (*value, *slope) = $of(*square);
                }
            };
        }
        match shape {
            Shape::SquaredExponential | Shape::Periodic { .. } => {
                each!(|square| squared_exponential(square, exp))
            }
            Shape::Matern32 => each!(|square| matern32(square, exp)),
            Shape::Matern52 => each!(|square| matern52(square, exp)),
            Shape::RationalQuadratic { exponent } => {
                each!(|square| rational_quadratic(square, exponent))
            }
        }
    }
}

vectorised! {
    /// Multiplies `values` by `factors`.
    fn multiply(values: &mut [f64], factors: &[f64]) {
        for (value, factor) in values.iter_mut().zip(factors) {
            *value *= factor;
        }
    }
}

vectorised! {
    /// Adds `factor` times `values` to `sums`.
    fn add_scaled(sums: &mut [f64], values: &[f64], factor: f64) {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += factor * value;
        }
    }
}

vectorised! {
    /// Adds Σ a b to `sum`, in eight sums side by side.
    fn add_product(sum: &mut f64, a: &[f64], b: &[f64]) {
        let mut sums = [0.0; 8];
        let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
        let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
        for (a, b) in a.zip(b) {
            for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
                *sum += a * b;
            }
        }
        *sum += sums.iter().sum::<f64>() + rest;
    }
}

vectorised! {
    /// Adds Σ weight (column − other)² to `sum`, likewise.
    fn add_weighted_squares(sum: &mut f64, weights: &[f64], column: &[f64], other: f64) {
        let mut sums = [0.0; 8];
        let (weights, column) = (weights.chunks_exact(8), column.chunks_exact(8));
        let mut rest = 0.0;
        for (weight, value) in weights.remainder().iter().zip(column.remainder()) {
            rest += weight * ((value - other) * (value - other));
        }
        for (weights, values) in weights.zip(column) {
            for ((sum, weight), value) in sums.iter_mut().zip(weights).zip(values) {
                *sum += weight * ((value - other) * (value - other));
            }
        }
        *sum += sums.iter().sum::<f64>() + rest;
    }
}

#[cfg(test)]
mod tests;
