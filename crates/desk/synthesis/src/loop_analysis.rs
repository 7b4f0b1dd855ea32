//! A closed loop and its transfer functions.

use crate::SynthesisError;
use faer::Mat;
use lti::matrices::dense::{complex_singular_values, identity};
use lti::matrices::{MatrixError, StateSpace, feedback, inverse_bilinear, series};

/// Plant and controller with negative feedback: y = G u, u = K (r − y).
#[derive(Clone, Debug)]
pub struct Loop {
    pub(crate) plant: StateSpace,
    controller: StateSpace,
}

impl Loop {
    /// Of a plant G and a controller K in the same kind of time.
    pub fn new(plant: StateSpace, controller: StateSpace) -> Result<Self, SynthesisError> {
        // Sizes, sample times and the loop itself are checked where it is closed.
        feedback(&controller, &plant)?;
        Ok(Self { plant, controller })
    }

    /// L = G K: broken at the plant's outputs.
    pub fn open(&self) -> Result<StateSpace, MatrixError> {
        series(&self.controller, &self.plant)
    }

    /// K G: broken at the plant's inputs.
    pub fn open_at_inputs(&self) -> Result<StateSpace, MatrixError> {
        series(&self.plant, &self.controller)
    }

    /// S = (I + L)⁻¹: from the reference to the error.
    pub fn sensitivity(&self) -> Result<StateSpace, MatrixError> {
        sensitivity(&self.open()?)
    }

    /// T = L (I + L)⁻¹: from the reference to the output.
    pub fn complementary_sensitivity(&self) -> Result<StateSpace, MatrixError> {
        let open = self.open()?;
        feedback(&open, &unity(open.outputs(), open.interval))
    }

    /// K S: from the reference to the control.
    pub fn control_sensitivity(&self) -> Result<StateSpace, MatrixError> {
        feedback(&self.controller, &self.plant)
    }

    /// An error that names a pole where the loop is not stable; hidden modes count.
    pub fn stable_or_error(&self) -> Result<(), MatrixError> {
        self.control_sensitivity()?.stable_or_error()
    }

    /// Bandwidth (rad/s): the lowest frequency at which the largest singular value of S reaches 1/√2 from
    /// below; none where it starts above it, or never reaches it.
    ///
    /// Source: Skogestad and Postlethwaite 2005, §2.4.5.
    pub fn bandwidth(&self) -> Result<Option<f64>, MatrixError> {
        self.stable_or_error()?;
        let (system, interval) = in_continuous_time(&self.sensitivity()?)?;
        let level = std::f64::consts::FRAC_1_SQRT_2;
        let largest = |frequency: f64| -> Result<f64, MatrixError> {
            let values = complex_singular_values(&system.response(frequency)?)?;
            Ok(values.first().copied().unwrap_or(0.0))
        };
        if largest(0.0)? >= level {
            return Ok(None);
        }
        for frequency in system.frequencies_with_gain(level)? {
            if (largest(frequency)? / level - 1.0).abs() < 1e-5 {
                return Ok(Some(in_its_time(frequency, interval)));
            }
        }
        Ok(None)
    }
}

/// (I + L)⁻¹.
pub(crate) fn sensitivity(open: &StateSpace) -> Result<StateSpace, MatrixError> {
    feedback(&unity(open.outputs(), open.interval), open)
}

/// The system itself, or that of which the bilinear transformation makes it, and the sample time.
pub(crate) fn in_continuous_time(
    system: &StateSpace,
) -> Result<(StateSpace, Option<f64>), MatrixError> {
    match system.interval {
        None => Ok((system.clone(), None)),
        Some(interval) => Ok((inverse_bilinear(system)?, Some(interval))),
    }
}

/// The frequency (rad/s) at which a system has the response that its bilinear transform has at `frequency`.
pub(crate) fn in_its_time(frequency: f64, interval: Option<f64>) -> f64 {
    interval.map_or(frequency, |t| 2.0 / t * (0.5 * frequency * t).atan())
}

/// The gain I.
fn unity(size: usize, interval: Option<f64>) -> StateSpace {
    StateSpace::gain(identity(size), interval)
}

/// Outputs of a system in discrete time for a unit step of its `input`: one row of outputs a sample.
pub fn step_response(
    system: &StateSpace,
    input: usize,
    samples: usize,
) -> Result<Vec<Vec<f64>>, SynthesisError> {
    if system.interval.is_none() {
        return Err(MatrixError::Time { needed: "discrete" }.into());
    }
    if input >= system.inputs() {
        let what = "inputs of a step response";
        return Err(SynthesisError::Signals { what, found: system.inputs(), needed: input + 1 });
    }
    let step = Mat::from_fn(system.inputs(), 1, |i, _| f64::from(u8::from(i == input)));
    let mut state = Mat::<f64>::zeros(system.order(), 1);
    let mut rows = Vec::with_capacity(samples);
    for _ in 0..samples {
        let outputs = &system.c * &state + &system.d * &step;
        rows.push((0..system.outputs()).map(|i| outputs[(i, 0)]).collect());
        state = &system.a * &state + &system.b * &step;
    }
    Ok(rows)
}
