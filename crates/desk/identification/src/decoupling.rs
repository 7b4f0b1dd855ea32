//! Which input moves which output, and the azimuth offset that takes tilt and yaw apart.

use crate::IdentificationError;
use faer::{Mat, c64};
use lti::matrices::{MatrixError, StateSpace, relative_gain_array};

/// Angles over half a turn that are looked at first (–).
const N_ANGLES: usize = 180;
/// How exactly an angle is found (rad).
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Relative gain array of a system at a `frequency` (rad/s): inputs × outputs, rows and columns add to one.
/// An identity says that each loop's gain is the same whether the others are closed or not.
///
/// # Errors
/// [`IdentificationError::Matrix`] for systems that are not square, poles there, and singular gains.
pub fn relative_gains(
    system: &StateSpace,
    frequency: f64,
) -> Result<Mat<c64>, IdentificationError> {
    Ok(relative_gain_array(&system.response(frequency)?)?)
}

/// Azimuth offset ψ (rad, above −π and up to π) with which the relative gains at rest are the identity, for
/// the `gain` at rest from tilt and yaw commands to tilt and yaw outputs (2 × 2).
///
/// The blades are given T⁻¹(ψ_blade + ψ) of the commands, which the system without offset takes for \[cos ψ,
/// sin ψ; −sin ψ, cos ψ\] of them. With G′ the gain times that matrix the first relative gain is g′₁₁
/// g′₂₂/det G = ½ + (P cos 2ψ + Q sin 2ψ)/(2 det G), P = g₁₁ g₂₂ + g₁₂ g₂₁, Q = g₁₁ g₂₁ − g₁₂ g₂₂. It is one
/// for cos(2ψ − atan2(Q, P)) = det G/√(P² + Q²), which always has solutions: those where one of the two
/// cross gains is zero. Of them the one is returned whose other cross gain is smaller, with g′₁₁ positive.
///
/// Source of the offset: Chen, van Vondelen and van Wingerden (2026), Wind Energ. Sci. 11, 1871, Eq. B3; the
/// closed form follows from it.
///
/// # Errors
/// [`IdentificationError::Sizes`] for other sizes, [`IdentificationError::Matrix`] for a singular gain.
pub fn azimuth_offset(gain: &Mat<f64>) -> Result<f64, IdentificationError> {
    two_by_two(gain.nrows(), gain.ncols())?;
    let (g11, g12, g21, g22) = (gain[(0, 0)], gain[(0, 1)], gain[(1, 0)], gain[(1, 1)]);
    let determinant = g11 * g22 - g12 * g21;
    let (p, q) = (g11 * g22 + g12 * g21, g11 * g21 - g12 * g22);
    let reach = p.hypot(q);
    if determinant.is_nan() || determinant.abs() <= f64::EPSILON * reach {
        return Err(MatrixError::Singular("the gain at rest").into());
    }
    let (middle, aside) = (q.atan2(p), (determinant / reach).clamp(-1.0, 1.0).acos());
    let cross = |angle: f64| {
        let turned = rotated(gain, angle);
        turned[(0, 1)].abs().max(turned[(1, 0)].abs())
    };
    let (first, second) = (0.5 * (middle + aside), 0.5 * (middle - aside));
    let angle = if cross(first) < cross(second) { first } else { second };
    let half_turn = if rotated(gain, angle)[(0, 0)] < 0.0 { std::f64::consts::PI } else { 0.0 };
    let (sine, cosine) = (angle + half_turn).sin_cos();
    Ok(sine.atan2(cosine))
}

/// Azimuth offset ψ (rad, above −π and up to π) with which the relative gains of a `system` of tilt and yaw
/// at a `frequency` (rad/s) are as near to the identity as an offset can bring them.
///
/// Away from rest gains are complex and an offset is one number: the first relative gain λ of the turned
/// system is as in [`azimuth_offset`] with complex P, Q and determinant, and |λ − 1|, by which all four
/// entries are off, is least somewhere in half a turn. The other half makes the real part of g′₁₁ positive.
///
/// # Errors
/// As [`azimuth_offset`], and for a pole at that frequency.
pub fn nearest_azimuth_offset(
    system: &StateSpace,
    frequency: f64,
) -> Result<f64, IdentificationError> {
    two_by_two(system.outputs(), system.inputs())?;
    let gain = system.response(frequency)?;
    let (g11, g12, g21, g22) = (gain[(0, 0)], gain[(0, 1)], gain[(1, 0)], gain[(1, 1)]);
    let determinant = g11 * g22 - g12 * g21;
    let (p, q) = (g11 * g22 + g12 * g21, g11 * g21 - g12 * g22);
    if determinant.is_nan() || determinant.norm() <= f64::EPSILON * (p.norm() + q.norm()) {
        return Err(MatrixError::Singular("the gain at that frequency").into());
    }
    // 2 (λ − 1), squared: a sum of waves of periods π and π/2, two valleys at the most.
    let off = |angle: f64| {
        let (sine, cosine) = (2.0 * angle).sin_cos();
        ((p * cosine + q * sine) / determinant - 1.0).norm_sqr()
    };
    let step = std::f64::consts::PI / N_ANGLES as f64;
    let angles = (0..N_ANGLES).map(|index| index as f64 * step);
    let lowest = angles.min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap_or(0.0);
    let (mut below, mut above) = (lowest - step, lowest + step);
    while above - below > ANGLE_TOLERANCE {
        let third = (above - below) / 3.0;
        if off(below + third) < off(above - third) { above -= third } else { below += third }
    }
    let angle = 0.5 * (below + above);
    let (sine, cosine) = angle.sin_cos();
    let upright = (g11 * cosine - g12 * sine).re >= 0.0;
    let half_turn = if upright { 0.0 } else { std::f64::consts::PI };
    let (sine, cosine) = (angle + half_turn).sin_cos();
    Ok(sine.atan2(cosine))
}

/// The `system` of tilt and yaw whose commands go through an azimuth `offset` (rad) on top of its own.
///
/// # Errors
/// [`IdentificationError::Sizes`] for other than two inputs.
pub fn with_azimuth_offset(
    system: &StateSpace,
    offset: f64,
) -> Result<StateSpace, IdentificationError> {
    two_by_two(2, system.inputs())?;
    let mut turned = system.clone();
    (turned.b, turned.d) = (rotated(&system.b, offset), rotated(&system.d, offset));
    Ok(turned)
}

/// Whether there are two outputs and two inputs.
fn two_by_two(outputs: usize, inputs: usize) -> Result<(), IdentificationError> {
    for (what, found) in [("outputs", outputs), ("inputs", inputs)] {
        if found != 2 {
            return Err(IdentificationError::Sizes { what, found, expected: 2 });
        }
    }
    Ok(())
}

/// The gain times \[cos ψ, sin ψ; −sin ψ, cos ψ\].
fn rotated(gain: &Mat<f64>, angle: f64) -> Mat<f64> {
    let (sine, cosine) = angle.sin_cos();
    gain * faer::mat![[cosine, sine], [-sine, cosine]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// What an offset of `angle` (rad) leaves of the first relative gain's distance from one at `frequency`.
    fn left(system: &StateSpace, angle: f64, frequency: f64) -> f64 {
        let turned = with_azimuth_offset(system, angle).expect("two inputs");
        let relative = relative_gains(&turned, frequency).expect("regular");
        (relative[(0, 0)] - 1.0).norm()
    }

    #[test]
    fn no_other_offset_comes_nearer_at_a_frequency() {
        let system = crate::simulate::oscillators(4);
        for frequency in [0.1, 0.2, 0.5, 1.0, 2.0] {
            let found = nearest_azimuth_offset(&system, frequency).expect("regular");
            let least = left(&system, found, frequency);
            let others = (0..3600).map(|index| left(&system, f64::from(index) * 1e-3, frequency));
            let others = others.fold(f64::INFINITY, f64::min);
            assert!(least <= others + 1e-9, "{frequency} rad/s: {least} {others}");
            let turned = with_azimuth_offset(&system, found).expect("two inputs");
            assert!(turned.response(frequency).expect("no pole")[(0, 0)].re >= 0.0);
        }
    }

    /// Of a system that is turned by −6° and otherwise acts on each axis alone 6° are the answer at rest and
    /// at any frequency.
    #[test]
    fn a_system_that_is_turned_alone_is_turned_back_at_every_frequency() {
        let lags = StateSpace::new(
            faer::mat![[0.9, 0.0], [0.0, 0.7]],
            faer::mat![[0.1, 0.0], [0.0, 0.4]],
            Mat::identity(2, 2),
            Mat::zeros(2, 2),
            Some(1.0),
        );
        let turned = with_azimuth_offset(&lags, (-6.0_f64).to_radians()).expect("two inputs");
        let gain = turned.gain_at_rest().expect("no pole");
        let at_rest = azimuth_offset(&gain).expect("regular").to_degrees();
        assert!((at_rest - 6.0).abs() < 1e-5, "{at_rest}");
        for frequency in [0.05, 0.3] {
            let there = nearest_azimuth_offset(&turned, frequency).expect("regular").to_degrees();
            assert!((there - 6.0).abs() < 1e-5, "{there}");
        }
        assert!(nearest_azimuth_offset(&lags.selected(&[0], &[0]).expect("one"), 0.1).is_err());
    }

    /// λ₁₁ = 1/(1 − g₁₂ g₂₁/(g₁₁ g₂₂)), at rest and at a frequency.
    #[test]
    fn relative_gains_of_two_by_two() {
        let system = crate::simulate::oscillators(4);
        for frequency in [0.0, 0.2, 1.0] {
            let g = system.response(frequency).expect("no pole there");
            let expected = 1.0 / (1.0 - g[(0, 1)] * g[(1, 0)] / (g[(0, 0)] * g[(1, 1)]));
            let found = relative_gains(&system, frequency).expect("regular");
            assert!((found[(0, 0)] - expected).norm() < 1e-10);
            assert!((found[(0, 0)] + found[(0, 1)] - 1.0).norm() < 1e-10);
            assert!((found[(1, 1)] - expected).norm() < 1e-10);
        }
    }

    /// A system that turns its inputs by −6° needs an offset of 6°.
    #[test]
    fn a_turned_system_is_turned_back() {
        let turned = rotated(&(faer::Scale(0.3) * Mat::<f64>::identity(2, 2)), -0.1);
        let found = azimuth_offset(&turned).expect("regular");
        assert!((found - 0.1).abs() < 1e-7, "{found}");
        let against = azimuth_offset(&(faer::Scale(-1.0) * turned)).expect("regular");
        assert!((against - (0.1 - std::f64::consts::PI)).abs() < 1e-7, "{against}");
        assert!(azimuth_offset(&faer::mat![[1.0, 2.0], [2.0, 4.0]]).is_err());
        assert!(azimuth_offset(&Mat::identity(3, 3)).is_err());
    }

    proptest! {
        #[test]
        fn relative_gains_become_the_identity(entries in prop::array::uniform4(-2.0..2.0_f64)) {
            let gain = faer::mat![[entries[0], entries[1]], [entries[2], entries[3]]];
            let determinant = entries[0] * entries[3] - entries[1] * entries[2];
            prop_assume!(determinant.abs() > 0.05);
            let angle = azimuth_offset(&gain).expect("regular");
            let turned = rotated(&gain, angle);
            prop_assert!(turned[(0, 0)] > 0.0);
            let relative = turned[(0, 0)] * turned[(1, 1)] / determinant;
            prop_assert!((relative - 1.0).abs() < 1e-6, "{}", relative);
        }
    }
}
