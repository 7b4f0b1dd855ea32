//! From a model and weights to a controller that runs, and what it does.

use crate::DesignError;
use crate::model::{linear_model, rows, system};
use crate::weights::{Method, Quadratic, Weight, WeightsFile};
use faer::Mat;
use formats::linear_model::{LinearModel, Role};
use lti::matrices::{
    MatrixError, StateSpace, bilinear, discrete_riccati, inverse_bilinear, sample_delay, series,
};
use std::path::PathBuf;
use synthesis::{
    ChannelMargins, DiscMargin, HInfinityOptions, Loop, LqgWeights, SensitivityWeights,
    SynthesisError, h_infinity, h2, lqg, lqg_with_integral_action, mixed_sensitivity,
    reduced_to_order, smith_predictor, step_response,
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
    /// Margins of each output, one opened at a time, of the loop without the delay.
    pub margins: Vec<ChannelMargins>,
    /// Of all outputs at once.
    pub disc: DiscMargin,
    /// Peaks of sensitivity and complementary sensitivity of the loop without the delay (–).
    pub peaks: [f64; 2],
    /// Frequency up to which disturbances are held down (rad/s); none where they never are.
    pub bandwidth: Option<f64>,
    /// Sensitivities over frequency.
    pub responses: LoopResponses,
    /// Answer of every output (second) to a step of each reference (first) with the delay, over samples.
    pub steps: Vec<Vec<Vec<f64>>>,
}

/// Largest singular values over frequency.
#[derive(Clone, Debug)]
pub struct LoopResponses {
    /// Frequencies (rad/s).
    pub frequencies: Vec<f64>,
    /// Of S, T and K S (–, –, control unit per output unit).
    pub gains: [Vec<f64>; 3],
    /// Bounds that the weights of S, T and K S ask for; empty where there is no weight.
    pub bounds: [Vec<f64>; 3],
}

/// Synthesises a controller.
///
/// # Errors
/// [`DesignError`] naming the file and what is wrong with it.
pub fn synthesize(question: &SynthesizeQuestion) -> Result<Synthesized, DesignError> {
    let model = LinearModel::read(&question.model, Role::Model)?;
    let weights = WeightsFile::read(&question.weights)?;
    found(&model, &weights)
        .map_err(|source| DesignError::Synthesis { path: question.model.clone(), source })
}

/// A controller without its predictor, and how it was found.
struct Found {
    controller: StateSpace,
    bound: Option<f64>,
    achieved: Option<f64>,
    residuals: Option<[f64; 2]>,
    before_reduction: Option<f64>,
}

fn found(model: &LinearModel, weights: &WeightsFile) -> Result<Synthesized, SynthesisError> {
    let plant = system(model);
    let inner = match weights.method {
        Method::HInfinity | Method::H2 => weighted(&plant, weights)?,
        Method::Lqg | Method::Lqi => quadratic(&plant, weights)?,
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
        method: weights.method,
        bound: inner.bound,
        achieved: inner.achieved,
        riccati_residuals: inner.residuals,
        before_reduction: inner.before_reduction,
        orders: [inner.controller.order(), controller.order()],
        delay_samples: delay,
        margins: closed.output_margins()?,
        disc: closed.output_disc_margin()?,
        peaks: [s.h_infinity_norm()?.gain, t.h_infinity_norm()?.gain],
        bandwidth,
        responses: responses(&closed, weights, bandwidth)?,
        steps: steps(&t, delay, bandwidth)?,
        controller: in_a_file(model, weights, &plant, &inner.controller, &controller)?,
    })
}

/// By weights over frequency, in continuous time; a model in discrete time goes there and back by the
/// bilinear transformation.
fn weighted(plant: &StateSpace, weights: &WeightsFile) -> Result<Found, SynthesisError> {
    let continuous = match plant.interval {
        Some(_) => inverse_bilinear(plant)?,
        None => plant.clone(),
    };
    let [n_y, n_u] = [plant.outputs(), plant.inputs()];
    let on = |weight: &Option<Weight>, n| weight.as_ref().map(|weight| weight.on(n)).transpose();
    let problem = mixed_sensitivity(
        &continuous,
        &SensitivityWeights {
            performance: on(&weights.performance, n_y)?,
            complementary: on(&weights.complementary, n_y)?,
            control: on(&weights.control, n_u)?,
        },
    )?;
    let mut found = if weights.method == Method::H2 {
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
    if let Some(order) = weights.order.filter(|order| *order < found.controller.order()) {
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
fn quadratic(plant: &StateSpace, weights: &WeightsFile) -> Result<Found, SynthesisError> {
    let Quadratic { outputs, controls, integrals, input_noise, measurement_noise } =
        weights.quadratic;
    let [n, n_u, n_y] = [plant.order(), plant.inputs(), plant.outputs()];
    let of_outputs = outputs * (plant.c.transpose() * &plant.c);
    let weights_of = |states| LqgWeights {
        states,
        controls: controls * Mat::<f64>::identity(n_u, n_u),
        process_noise: input_noise * (&plant.b * plant.b.transpose()),
        measurement_noise: measurement_noise * Mat::<f64>::identity(n_y, n_y),
    };
    let (controller, norm) = if weights.method == Method::Lqg {
        let best = lqg(plant, &weights_of(of_outputs))?;
        (best.controller, Some(best.norm))
    } else {
        let states = Mat::from_fn(n + n_y, n + n_y, |row, column| {
            if row < n && column < n {
                of_outputs[(row, column)]
            } else if row == column {
                integrals
            } else {
                0.0
            }
        });
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
    weights: &WeightsFile,
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
    let largest = |system: &StateSpace| {
        let values = frequencies.iter().map(|frequency| Ok(system.singular_values(*frequency)?[0]));
        values.collect::<Result<Vec<f64>, SynthesisError>>()
    };
    let bounds = |weight: &Option<Weight>| -> Result<Vec<f64>, SynthesisError> {
        let Some(weight) = weight else { return Ok(Vec::new()) };
        frequencies.iter().map(|frequency| Ok(weight.gain(*frequency)?.recip())).collect()
    };
    let [s, t, ks] = &systems;
    Ok(LoopResponses {
        gains: [largest(s)?, largest(t)?, largest(ks)?],
        bounds: [
            bounds(&weights.performance)?,
            bounds(&weights.complementary)?,
            bounds(&weights.control)?,
        ],
        frequencies,
    })
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
