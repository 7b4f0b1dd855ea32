//! H-infinity synthesis.

use crate::SynthesisError;
use crate::assumptions::check;
use crate::central::{Solutions, least_bound};
use crate::generalised_plant::GeneralisedPlant;
use crate::normalised::Normalised;
use lti::matrices::{PeakGain, StateSpace, bilinear, inverse_bilinear};

/// Factor between bounds while none is known on one side.
const STRIDE: f64 = 4.0;
/// Share (–) by which a bound is raised where its controller did not stand the check.
const BACK_OFF: f64 = 5e-5;
/// Relative residual (–) of a Riccati equation above which a controller does not stand the check.
const LARGEST_RESIDUAL: f64 = 1e-10;
/// Controllers that are checked at most; each is at twice the distance of the one before.
const MOST_CHECKS: u32 = 16;

/// Where the least bound is looked for, and how exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HInfinityOptions {
    /// Share (–) of the least bound within which it is found.
    pub tolerance: f64,
    /// Bound above which none is tried (–).
    pub largest: f64,
    /// Bound below which none is tried (–).
    pub smallest: f64,
}

impl Default for HInfinityOptions {
    fn default() -> Self {
        Self { tolerance: 1e-5, largest: 1e7, smallest: 1e-7 }
    }
}

/// A controller, and what it keeps.
#[derive(Clone, Debug)]
pub struct HInfinity {
    /// From measurements to controls, as many states as the generalised plant.
    pub controller: StateSpace,
    /// Bound of the closed loop's H-infinity norm for which the controller was made (–).
    pub bound: f64,
    /// The largest bound found that no controller keeps; 0 where none was found (–).
    pub lower_bound: f64,
    /// Relative residuals (–) of both Riccati equations at the bound.
    pub riccati_residuals: [f64; 2],
    /// Norm of the closed loop, by the eigenvalues of its own Hamiltonian.
    pub achieved: PeakGain,
}

/// The central controller of the least bound of the closed loop's H-infinity norm, by bisection; a plant in
/// discrete time goes through the bilinear transformation.
///
/// Source: Doyle, Glover, Khargonekar and Francis, IEEE Trans. Automatic Control 34, 1989; Glover and
/// Doyle, Systems & Control Letters 11, 1988.
pub fn h_infinity(
    plant: &GeneralisedPlant,
    options: &HInfinityOptions,
) -> Result<HInfinity, SynthesisError> {
    valid(options)?;
    let continuous = match plant.system.interval {
        None => plant.clone(),
        Some(_) => plant.with_system(inverse_bilinear(&plant.system)?),
    };
    let continuous = continuous.with_system(continuous.system.prescaled());
    check(&continuous)?;
    let normalised = Normalised::new(&continuous)?;
    let (mut lower, mut best) = bracket(&normalised, options)?;
    while best.bound > lower * (1.0 + options.tolerance) && best.bound > options.smallest {
        let middle = (lower.max(0.25 * best.bound) * best.bound).sqrt();
        match Solutions::at(&normalised, middle) {
            Some(found) => best = found,
            None => lower = middle,
        }
    }
    checked(plant, &normalised, best, lower, options)
}

/// The controller of the least bound from `best` on that stands its check.
fn checked(
    plant: &GeneralisedPlant,
    normalised: &Normalised,
    best: Solutions,
    lower_bound: f64,
    options: &HInfinityOptions,
) -> Result<HInfinity, SynthesisError> {
    let mut found = String::new();
    let first = best.bound;
    let (mut bound, mut solutions) = (first, Some(best));
    for attempt in 0..MOST_CHECKS {
        if attempt > 0 {
            bound = first * (1.0 + BACK_OFF * f64::from(2_u32.pow(attempt - 1)));
            solutions = Solutions::at(normalised, bound);
        }
        if let Some(solutions) = &solutions {
            match of_solutions(plant, normalised, solutions, lower_bound) {
                Ok(result) if stands(&result, options) => return Ok(result),
                Ok(result) => {
                    let [one, other] = result.riccati_residuals;
                    found = format!(
                        "a norm of {}, residuals of {one:.1e} and {other:.1e}",
                        result.achieved.gain
                    );
                }
                Err(error) => found = error.to_string(),
            }
        }
    }
    Err(SynthesisError::CheckFailed { bound, found })
}

/// Whether a closed loop keeps its bound and both equations are solved.
fn stands(result: &HInfinity, options: &HInfinityOptions) -> bool {
    result.achieved.gain <= result.bound * (1.0 + options.tolerance)
        && result.riccati_residuals.iter().all(|residual| *residual <= LARGEST_RESIDUAL)
}

/// The controller of a bound and the norm of its closed loop.
fn of_solutions(
    plant: &GeneralisedPlant,
    normalised: &Normalised,
    solutions: &Solutions,
    lower_bound: f64,
) -> Result<HInfinity, SynthesisError> {
    let controller = normalised.restored(&solutions.controller(normalised)?)?;
    let controller = match plant.system.interval {
        None => controller,
        Some(interval) => bilinear(&controller, interval)?,
    };
    let achieved = plant.closed(&controller)?.h_infinity_norm()?;
    Ok(HInfinity {
        controller,
        bound: solutions.bound,
        lower_bound,
        riccati_residuals: solutions.residuals,
        achieved,
    })
}

/// A bound that no controller keeps (0 where the smallest that is tried can be kept), and the solutions at
/// one that can be.
fn bracket(
    normalised: &Normalised,
    options: &HInfinityOptions,
) -> Result<(f64, Solutions), SynthesisError> {
    let mut lower = least_bound(&normalised.parts)?;
    let mut trial = if lower > 0.0 { 2.0 * lower } else { 1.0 };
    trial = trial.clamp(options.smallest, options.largest);
    let mut best = loop {
        if let Some(found) = Solutions::at(normalised, trial) {
            break found;
        }
        lower = lower.max(trial);
        if trial >= options.largest {
            return Err(SynthesisError::NoBound { largest: options.largest });
        }
        trial = (trial * STRIDE).min(options.largest);
    };
    while lower == 0.0 && best.bound > options.smallest {
        let trial = (best.bound / STRIDE).max(options.smallest);
        match Solutions::at(normalised, trial) {
            Some(found) => best = found,
            None => lower = trial,
        }
    }
    Ok((lower, best))
}

/// Whether the options are in their range.
fn valid(options: &HInfinityOptions) -> Result<(), SynthesisError> {
    let wrong = |what, value, needed| Err(SynthesisError::OutOfRange { what, value, needed });
    if !(options.tolerance > 0.0 && options.tolerance < 1.0) {
        return wrong("the tolerance of the bound", options.tolerance, "it is between 0 and 1");
    }
    if !(options.smallest > 0.0 && options.smallest.is_finite()) {
        return wrong("the smallest bound", options.smallest, "it is above zero and finite");
    }
    if !(options.largest > options.smallest && options.largest.is_finite()) {
        return wrong("the largest bound", options.largest, "it is above the smallest and finite");
    }
    Ok(())
}
