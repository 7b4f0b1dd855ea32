//! From a model and weights to a controller that runs, and what it does.

use crate::DesignError;
use crate::model::{linear_model, rows, system};
use crate::weights::{Diagonals, Method, Weight, Weights, WeightsFile, bound};
use faer::Mat;
use formats::linear_model::{LinearModel, Role};
use lti::matrices::dense::blocks;
use lti::matrices::{
    MatrixError, StateSpace, bilinear, discrete_riccati, inverse_bilinear, sample_delay, series,
};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use synthesis::{
    ChannelMargins, DiscMargin, HInfinityOptions, Loop, LqgWeights, PredictedMargins,
    SensitivityWeights, SynthesisError, h_infinity, h2, lqg, lqg_with_integral_action,
    mixed_sensitivity, predicted_margins, reduced_to_order, smith_predictor, step_response,
};

/// Points of the frequency responses that are told (–), logarithmic.
const N_FREQUENCIES: usize = 120;
/// Time of a step response over that of the bandwidth's period (–).
const STEP_LENGTH: f64 = 2.0;
/// Most samples of a step response (–).
const MOST_SAMPLES: usize = 20_000;

/// What to synthesise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SynthesizeQuestion {
    /// The model's file.
    pub model: PathBuf,
    /// The weights' file.
    pub weights: PathBuf,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Synthesized {
    /// The controller as its file has it: from errors to controls, with its predictor.
    pub controller: LinearModel,
    /// How it was found.
    pub method: Method,
    /// Bound (–) of the weighted loop's H-infinity norm that the controller was made for.
    pub bound: Option<f64>,
    /// Norm (–) of the weighted loop: H-infinity, by its own Hamiltonian, or H2; none with integral action.
    pub achieved: Option<f64>,
    /// Relative residuals of the Riccati equations (–).
    pub riccati_residuals: Option<[f64; 2]>,
    /// Norm (–) of the weighted loop before the reduction, where there was one.
    pub before_reduction: Option<f64>,
    /// States of the controller, without and with its predictor (–).
    pub orders: [usize; 2],
    /// Samples of delay that the predictor bridges (–).
    pub delay_samples: usize,
    /// What these leave of the model's delay, which is no whole number of samples (s).
    pub delay_left: f64,
    /// Margins of each output, one opened at a time, of the loop without the delay.
    pub margins: Vec<ChannelMargins>,
    /// Of all outputs at once, the delay aside.
    pub disc: DiscMargin,
    /// Peaks of sensitivity and complementary sensitivity of the loop without the delay (–).
    pub peaks: [f64; 2],
    /// The same of what runs, the delay and its predictor in the loop; none of a model without delay.
    pub with_delay: Option<PredictedMargins>,
    /// Frequency up to which disturbances are held down (rad/s); none where they never are.
    pub bandwidth: Option<f64>,
    /// Sensitivities over frequency.
    pub responses: LoopResponses,
    /// Answer to a step of each reference (first), with the delay: at each sample (second) all outputs
    /// (third).
    pub steps: Vec<Vec<Vec<f64>>>,
}

/// Largest singular values over frequency.
#[derive(Clone, Debug, Default)]
pub struct LoopResponses {
    /// Frequencies (rad/s).
    pub frequencies: Vec<f64>,
    /// Of S, T and K S (–, –, control unit per output unit).
    pub gains: [Vec<f64>; 3],
    /// Bounds that the weights of S, T and K S ask for; empty where there is no weight, or one that leaves a
    /// direction free.
    pub bounds: [Vec<f64>; 3],
    /// Of each channel that has a weight of its own.
    pub channels: Vec<ChannelResponse>,
}

/// Largest gain from all references to one channel, over frequency.
#[derive(Clone, Debug)]
pub struct ChannelResponse {
    /// What is shaped: S (0), T (1) or K S (2).
    pub shaped: usize,
    /// The channel.
    pub name: String,
    /// Its gains (–, or control unit per output unit).
    pub gains: Vec<f64>,
    /// Bounds that its weight asks for (–, or control unit per output unit).
    pub bounds: Vec<f64>,
}

/// Synthesises a controller.
///
/// # Errors
/// [`DesignError`] naming the file and what is wrong with it.
pub fn synthesize(question: &SynthesizeQuestion) -> Result<Synthesized, DesignError> {
    let model = LinearModel::read(&question.model, Role::Model)?;
    let file = WeightsFile::read(&question.weights)?;
    let weights = file.on(&model, &question.weights)?;
    let diagonals = file.quadratic_on(&model, &question.weights)?;
    file.check_whole(&question.weights)?;
    check_modes(&system(&model), &question.model)?;
    found(&model, &file, &weights, &diagonals)
        .map_err(|source| DesignError::Synthesis { path: question.model.clone(), source })
}

/// Refuses a model, read from `path`, with a mode that is not stable and that no controller can hold.
fn check_modes(plant: &StateSpace, path: &Path) -> Result<(), DesignError> {
    let modes = || Ok([plant.unstabilisable_mode()?, plant.undetectable_mode()?]);
    let modes = modes().map_err(|source| DesignError::Matrix { path: path.to_owned(), source })?;
    for (mode, moved) in modes.into_iter().zip([false, true]) {
        if let Some(mode) = mode {
            let (path, sampled) = (path.to_owned(), plant.interval.is_some());
            return Err(DesignError::HiddenMode { path, mode, moved, sampled });
        }
    }
    Ok(())
}

/// A controller without its predictor, and how it was found.
struct Found {
    controller: StateSpace,
    bound: Option<f64>,
    achieved: Option<f64>,
    residuals: Option<[f64; 2]>,
    before_reduction: Option<f64>,
}

fn found(
    model: &LinearModel,
    file: &WeightsFile,
    weights: &Weights,
    diagonals: &Diagonals,
) -> Result<Synthesized, SynthesisError> {
    let plant = system(model);
    let inner = match file.method {
        Method::HInfinity | Method::H2 => weighted(&plant, file, weights)?,
        Method::Lqg | Method::Lqi => quadratic(&plant, diagonals, file.method)?,
    };
    let delay = model.delay_samples();
    let controller = if delay > 0 {
        smith_predictor(&plant, delay, &inner.controller)?
    } else {
        inner.controller.clone()
    };
    let closed = Loop::new(plant.clone(), inner.controller.clone())?;
    closed.stable_or_error()?;
    let bandwidth = closed.bandwidth()?;
    let [s, t] = [closed.sensitivity()?, closed.complementary_sensitivity()?];
    Ok(Synthesized {
        method: file.method,
        bound: inner.bound,
        achieved: inner.achieved,
        riccati_residuals: inner.residuals,
        before_reduction: inner.before_reduction,
        orders: [inner.controller.order(), controller.order()],
        delay_samples: delay,
        delay_left: model.interval_s.map_or(0.0, |t| model.output_delay_s - t * delay as f64),
        margins: closed.output_margins()?,
        disc: closed.output_disc_margin()?,
        peaks: [s.h_infinity_norm()?.gain, t.h_infinity_norm()?.gain],
        with_delay: (delay > 0).then(|| predicted_margins(&closed, delay)).transpose()?,
        bandwidth,
        responses: responses(&closed, weights, model, bandwidth)?,
        steps: steps(&t, delay, bandwidth)?,
        controller: in_a_file(model, file, &plant, &inner.controller, &controller)?,
    })
}

/// By weights over frequency, in continuous time; a model in discrete time goes there and back by the
/// bilinear transformation.
fn weighted(
    plant: &StateSpace,
    file: &WeightsFile,
    weights: &Weights,
) -> Result<Found, SynthesisError> {
    let continuous = match plant.interval {
        Some(_) => inverse_bilinear(plant)?,
        None => plant.clone(),
    };
    let whole = |weight: &Option<Weight>| weight.as_ref().map(|weight| weight.whole.clone());
    let [performance, complementary, control] = weights.each_ref().map(whole);
    let problem = mixed_sensitivity(
        &continuous,
        &SensitivityWeights { performance, complementary, control },
    )?;
    let mut found = if file.method == Method::H2 {
        let h2 = h2(&problem)?;
        Found {
            controller: h2.controller,
            bound: None,
            achieved: Some(h2.norm),
            residuals: Some(h2.riccati_residuals),
            before_reduction: None,
        }
    } else {
        let best = h_infinity(&problem, &HInfinityOptions::default())?;
        Found {
            controller: best.controller,
            bound: Some(best.bound),
            achieved: Some(best.achieved.gain),
            residuals: Some(best.riccati_residuals),
            before_reduction: None,
        }
    };
    if let Some(order) =
        file.order.map(NonZeroUsize::get).filter(|order| *order < found.controller.order())
    {
        let reduced = reduced_to_order(&problem, &found.controller, order)?;
        found.before_reduction = Some(reduced.norm_before);
        found.achieved = Some(reduced.norm_after);
        found.controller = reduced.controller;
    }
    if let Some(interval) = plant.interval {
        found.controller = bilinear(&found.controller, interval)?;
    }
    Ok(found)
}

/// By quadratic weights.
fn quadratic(
    plant: &StateSpace,
    diagonals: &Diagonals,
    method: Method,
) -> Result<Found, SynthesisError> {
    let of_outputs = plant.c.transpose() * &diagonals.outputs * &plant.c;
    let weights_of = |states| LqgWeights {
        states,
        controls: diagonals.controls.clone(),
        process_noise: &plant.b * &diagonals.input_noise * plant.b.transpose(),
        measurement_noise: diagonals.measurement_noise.clone(),
    };
    let (controller, norm) = if method == Method::Lqg {
        let best = lqg(plant, &weights_of(of_outputs))?;
        (best.controller, Some(best.norm))
    } else {
        let aside = Mat::<f64>::zeros(plant.order(), plant.outputs());
        let states = blocks(&[
            &[&of_outputs, &aside],
            &[&aside.transpose().to_owned(), &diagonals.integrals],
        ]);
        (lqg_with_integral_action(plant, &weights_of(states))?, None)
    };
    Ok(Found { controller, bound: None, achieved: norm, residuals: None, before_reduction: None })
}

/// The controller as its file has it. Its gain K makes the state learn of limits: the model inside the
/// predictor is given what was really commanded, and the controller's own states follow as a Kalman filter
/// would.
fn in_a_file(
    model: &LinearModel,
    weights: &WeightsFile,
    plant: &StateSpace,
    inner: &StateSpace,
    controller: &StateSpace,
) -> Result<LinearModel, SynthesisError> {
    let description = format!(
        "{:?} controller of order {} for: {}",
        weights.method,
        inner.order(),
        model.description
    );
    let ports = [model.outputs.clone(), model.inputs.clone()];
    let mut file = linear_model(Role::Controller, description, ports, controller);
    if controller.interval.is_none() {
        return Ok(file);
    }
    let own = back_calculation(inner)?;
    let (n_own, n_model) = (inner.order(), plant.order());
    let gain = Mat::from_fn(controller.order(), controller.outputs(), |row, column| {
        if row < n_own {
            own[(row, column)]
        } else if row < n_own + n_model && controller.order() > n_own {
            plant.b[(row - n_own, column)]
        } else {
            0.0
        }
    });
    file.k = Some(rows(&gain));
    Ok(file)
}

/// Gain L of x(k+1) = A x + B u + L (y limited − y) with which the limited `controller` forgets what it could
/// not do: that of a Kalman filter, for which the limits are measurements.
fn back_calculation(controller: &StateSpace) -> Result<Mat<f64>, MatrixError> {
    let StateSpace { a, b, c, d, .. } = controller;
    let n_outputs = controller.outputs();
    let scale = (0..n_outputs).map(|i| d.row(i).norm_l2().powi(2)).fold(1e-12, f64::max);
    let noise = d * d.transpose() + 1e-3 * scale * Mat::<f64>::identity(n_outputs, n_outputs);
    let inverse = lti::matrices::dense::inverse(&noise)
        .ok_or(MatrixError::Singular("the gain of a controller at high frequency"))?;
    let g = c.transpose() * &inverse * c;
    let x = discrete_riccati(&a.transpose().to_owned(), &g, &(b * b.transpose()))?;
    let innovation = lti::matrices::dense::inverse(&(c * &x * c.transpose() + &noise))
        .ok_or(MatrixError::Singular("the limits' innovation"))?;
    Ok(a * &x * c.transpose() * innovation)
}

/// Sensitivities over three decades about the `bandwidth` (rad/s).
fn responses(
    closed: &Loop,
    weights: &Weights,
    model: &LinearModel,
    bandwidth: Option<f64>,
) -> Result<LoopResponses, SynthesisError> {
    let middle = bandwidth.unwrap_or(0.1);
    let decades = |index| -2.0 + 3.5 * index as f64 / (N_FREQUENCIES - 1) as f64;
    let systems =
        [closed.sensitivity()?, closed.complementary_sensitivity()?, closed.control_sensitivity()?];
    let fastest = systems[0].interval.map_or(f64::INFINITY, |t| std::f64::consts::PI / t);
    let frequencies: Vec<f64> = (0..N_FREQUENCIES)
        .map(|index| middle * 10_f64.powf(decades(index)))
        .filter(|frequency| *frequency < fastest)
        .collect();
    let mut found = LoopResponses { frequencies, ..LoopResponses::default() };
    for (shaped, (system, weight)) in systems.iter().zip(weights).enumerate() {
        found.gains[shaped] = largest(system, &found.frequencies)?;
        let Some(weight) = weight else { continue };
        found.bounds[shaped] = bounds(&weight.whole, &found.frequencies)?;
        let ports = if shaped == 2 { &model.inputs } else { &model.outputs };
        let all: Vec<usize> = (0..system.inputs()).collect();
        for (channel, weight) in weight.by_channel.iter().enumerate() {
            found.channels.push(ChannelResponse {
                shaped,
                name: ports[channel].name.clone(),
                gains: largest(&system.selected(&[channel], &all)?, &found.frequencies)?,
                bounds: bounds(weight, &found.frequencies)?,
            });
        }
    }
    Ok(found)
}

/// Largest singular values (–) of a `system` at `frequencies` (rad/s).
fn largest(system: &StateSpace, frequencies: &[f64]) -> Result<Vec<f64>, MatrixError> {
    frequencies.iter().map(|frequency| Ok(system.singular_values(*frequency)?[0])).collect()
}

/// Bounds (–) that a `weight` asks for at `frequencies` (rad/s); empty where it leaves a direction free.
fn bounds(weight: &StateSpace, frequencies: &[f64]) -> Result<Vec<f64>, MatrixError> {
    let each = frequencies.iter().map(|frequency| bound(weight, *frequency));
    let each = each.collect::<Result<Vec<Option<f64>>, MatrixError>>()?;
    Ok(each.into_iter().collect::<Option<Vec<f64>>>().unwrap_or_default())
}

/// Step responses from every reference, with the delay; none in continuous time.
fn steps(
    complementary: &StateSpace,
    delay: usize,
    bandwidth: Option<f64>,
) -> Result<Vec<Vec<Vec<f64>>>, SynthesisError> {
    let Some(interval) = complementary.interval else { return Ok(Vec::new()) };
    let period = std::f64::consts::TAU / bandwidth.unwrap_or(0.1);
    let samples = ((STEP_LENGTH * period / interval) as usize).clamp(10, MOST_SAMPLES) + delay;
    let delayed = series(complementary, &sample_delay(complementary.outputs(), delay, interval)?)?;
    (0..delayed.inputs()).map(|input| step_response(&delayed, input, samples)).collect()
}
