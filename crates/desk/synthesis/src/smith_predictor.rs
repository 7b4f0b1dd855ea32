//! The Smith predictor as one controller.

use crate::SynthesisError;
use faer::Mat;
use lti::matrices::{StateSpace, feedback, parallel, sample_delay, series};

/// The controller from r − y to u that holds its own model of the plant: K is given
/// r − (y − y_delayed + y_model), with y_model = G u and y_delayed that of `delay` samples ago.
///
/// `model` G is without the delay; G and K are in discrete time. Where the plant is the delayed model, the
/// loop from r to y is G K (I + G K)⁻¹ and then the delay. Source: Smith, "Closer control of loops with
/// dead time", Chem. Eng. Progress 53, 1957; Morari and Zafiriou, "Robust Process Control", 1989, §3.1
/// (internal model control). Stable models only: the predictor cannot move a mode of its model that is not.
pub fn smith_predictor(
    model: &StateSpace,
    delay: usize,
    controller: &StateSpace,
) -> Result<StateSpace, SynthesisError> {
    let needed = lti::matrices::MatrixError::Time { needed: "discrete" };
    let interval = model.interval.ok_or(needed)?;
    model.stable_or_error().map_err(SynthesisError::UnstableModel)?;
    let outputs = model.outputs();
    let direct = StateSpace::gain(Mat::identity(outputs, outputs), Some(interval));
    let delayed = sample_delay(outputs, delay, interval)?;
    // (1 − z⁻ᵈ) G u comes back to K with a minus sign.
    let ahead = series(model, &parallel(&direct, &delayed.scaled(-1.0))?)?;
    Ok(feedback(controller, &ahead)?)
}
