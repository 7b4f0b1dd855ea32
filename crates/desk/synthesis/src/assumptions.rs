//! The assumptions under which the Riccati equations of a synthesis have solutions.

use crate::SynthesisError;
use crate::generalised_plant::GeneralisedPlant;
use faer::Mat;
use lti::matrices::StateSpace;
use lti::matrices::dense::singular_decomposition;

/// Singular value (share of the largest) below which a gain without delay has no rank.
const RANK: f64 = 1e-9;
/// Distance from the border of stability (share of the zero's modulus) below which a zero is on it.
const ON_BORDER: f64 = 1e-8;

/// The first assumption that fails, if any.
///
/// Source: Zhou, Doyle and Glover, "Robust and Optimal Control", 1996, §14.2 and §17.1 (assumptions A1 to
/// A4).
pub(crate) fn check(plant: &GeneralisedPlant) -> Result<(), SynthesisError> {
    let system = &plant.system;
    let parts = plant.parts();
    let part = |b: &Mat<f64>, c: &Mat<f64>, d: &Mat<f64>| {
        StateSpace::new(system.a.clone(), b.clone(), c.clone(), d.clone(), system.interval)
    };
    let through_controls = part(&parts.b2, &parts.c2, &parts.d22);
    if let Some(mode) = through_controls.unstabilisable_mode()? {
        return Err(SynthesisError::NotStabilisable { mode });
    }
    if let Some(mode) = through_controls.undetectable_mode()? {
        return Err(SynthesisError::NotDetectable { mode });
    }
    ranks(plant)?;
    let to_errors = part(&parts.b2, &parts.c1, &parts.d12);
    if let Some(frequency) = border_zero(&to_errors)? {
        return Err(SynthesisError::ControlZero { frequency });
    }
    let to_measurements = part(&parts.b1, &parts.c2, &parts.d21);
    if let Some(frequency) = border_zero(&to_measurements)? {
        return Err(SynthesisError::MeasurementZero { frequency });
    }
    Ok(())
}

/// Whether D12 has full column rank and D21 full row rank.
fn ranks(plant: &GeneralisedPlant) -> Result<(), SynthesisError> {
    let parts = plant.parts();
    let (controls, measurements) = (plant.controls, plant.measurements);
    let rank = rank(&parts.d12)?;
    if rank < controls {
        return Err(SynthesisError::FreeControl { rank, controls });
    }
    let rank = self::rank(&parts.d21)?;
    if rank < measurements {
        return Err(SynthesisError::PerfectMeasurement { rank, measurements });
    }
    Ok(())
}

/// Rank to working precision.
fn rank(matrix: &Mat<f64>) -> Result<usize, SynthesisError> {
    let (_, values, _) = singular_decomposition(matrix)?;
    let least = RANK * values.first().copied().unwrap_or(0.0);
    Ok(values.iter().filter(|value| **value > least).count())
}

/// Frequency (rad/s) of a zero on the border of stability.
fn border_zero(system: &StateSpace) -> Result<Option<f64>, SynthesisError> {
    let scale = system.a.norm_l2();
    for zero in system.invariant_zeros()? {
        let growth = system.growth(zero).abs();
        let on_border = growth <= ON_BORDER * zero.norm().max(1e-4 * scale);
        if on_border {
            return Ok(Some(match system.interval {
                None => zero.im.abs(),
                Some(interval) => zero.arg().abs() / interval,
            }));
        }
    }
    Ok(None)
}
