//! The generalised plant of a synthesis: from disturbances and controls to errors and measurements.

use crate::SynthesisError;
use faer::Mat;
use lti::matrices::dense::{blocks, identity, part};
use lti::matrices::{StateSpace, append, lower_fractional, series};

/// A system whose last inputs are the controls and whose last outputs are the measurements.
#[derive(Clone, Debug)]
pub struct GeneralisedPlant {
    /// From (disturbances, controls) to (errors, measurements).
    pub system: StateSpace,
    /// The last outputs that the controller sees.
    pub measurements: usize,
    /// The last inputs that the controller sets.
    pub controls: usize,
    /// Name of each input.
    pub input_names: Vec<String>,
    /// Name of each output.
    pub output_names: Vec<String>,
}

/// The parts of a generalised plant.
pub(crate) struct Parts {
    pub(crate) b1: Mat<f64>,
    pub(crate) b2: Mat<f64>,
    pub(crate) c1: Mat<f64>,
    pub(crate) c2: Mat<f64>,
    pub(crate) d11: Mat<f64>,
    pub(crate) d12: Mat<f64>,
    pub(crate) d21: Mat<f64>,
    pub(crate) d22: Mat<f64>,
}

impl GeneralisedPlant {
    /// Of a system, with signals named w1.., u1.., z1.., y1...
    pub fn new(
        system: StateSpace,
        measurements: usize,
        controls: usize,
    ) -> Result<Self, SynthesisError> {
        for (what, found, needed) in [
            ("controls among the inputs", system.inputs(), controls),
            ("measurements among the outputs", system.outputs(), measurements),
        ] {
            if found < needed || needed == 0 {
                return Err(SynthesisError::Signals { what, found, needed: needed.max(1) });
            }
        }
        let mut input_names = numbered("w", system.inputs() - controls);
        input_names.extend(numbered("u", controls));
        let mut output_names = numbered("z", system.outputs() - measurements);
        output_names.extend(numbered("y", measurements));
        Ok(Self { system, measurements, controls, input_names, output_names })
    }

    /// Disturbances.
    pub fn disturbances(&self) -> usize {
        self.system.inputs() - self.controls
    }

    /// Errors.
    pub fn errors(&self) -> usize {
        self.system.outputs() - self.measurements
    }

    /// From disturbances to errors with `controller` in the loop.
    pub fn closed(&self, controller: &StateSpace) -> Result<StateSpace, SynthesisError> {
        for (what, found, needed) in [
            ("inputs of the controller", controller.inputs(), self.measurements),
            ("outputs of the controller", controller.outputs(), self.controls),
        ] {
            if found != needed {
                return Err(SynthesisError::Signals { what, found, needed });
            }
        }
        Ok(lower_fractional(&self.system, controller)?)
    }

    /// The same plant with another system of the same signals.
    pub(crate) fn with_system(&self, system: StateSpace) -> Self {
        Self { system, ..self.clone() }
    }

    /// Its parts.
    pub(crate) fn parts(&self) -> Parts {
        let StateSpace { b, c, d, .. } = &self.system;
        let n = self.system.order();
        let (n_w, n_z) = (self.disturbances(), self.errors());
        let (n_u, n_y) = (self.controls, self.measurements);
        Parts {
            b1: part(b, 0, 0, n, n_w),
            b2: part(b, 0, n_w, n, n_u),
            c1: part(c, 0, 0, n_z, n),
            c2: part(c, n_z, 0, n_y, n),
            d11: part(d, 0, 0, n_z, n_w),
            d12: part(d, 0, n_w, n_z, n_u),
            d21: part(d, n_z, 0, n_y, n_w),
            d22: part(d, n_z, n_w, n_y, n_u),
        }
    }
}

/// name1, name2, …
fn numbered(name: &str, count: usize) -> Vec<String> {
    (1..=count).map(|index| format!("{name}{index}")).collect()
}

/// Weights of a mixed-sensitivity problem; what has none is not weighted.
#[derive(Clone, Debug, Default)]
pub struct SensitivityWeights {
    /// W_P of the sensitivity S = (I + G K)⁻¹: as many inputs as the plant has outputs.
    pub performance: Option<StateSpace>,
    /// W_T of the complementary sensitivity T = G K (I + G K)⁻¹: as many inputs as the plant has outputs.
    pub complementary: Option<StateSpace>,
    /// W_U of the control K (I + G K)⁻¹: as many inputs as the plant has.
    pub control: Option<StateSpace>,
}

/// The generalised plant whose closed loop is (W_P S; W_T T; W_U K S), with negative feedback.
///
/// The disturbance is the reference r, the measurement r − G u. Source: Eqs. 9 and 10 of the source on
/// closed-loop control of the helical wake; Skogestad and Postlethwaite 2005, §9.3.6.
pub fn mixed_sensitivity(
    plant: &StateSpace,
    weights: &SensitivityWeights,
) -> Result<GeneralisedPlant, SynthesisError> {
    let (n_y, n_u, interval) = (plant.outputs(), plant.inputs(), plant.interval);
    let named = [
        ("performance", "z_performance", &weights.performance, n_y),
        ("complementary", "z_complementary", &weights.complementary, n_y),
        ("control", "z_control", &weights.control, n_u),
    ];
    let none = |width| StateSpace::gain(Mat::zeros(0, width), interval);
    let mut systems = Vec::new();
    let mut output_names = Vec::new();
    for (weight, name, system, width) in named {
        if let Some(system) = system {
            stable_weight(weight, system)?;
        }
        let system = system.clone().unwrap_or_else(|| none(width));
        if system.inputs() != width {
            let what = "inputs of a weight";
            return Err(SynthesisError::Signals { what, found: system.inputs(), needed: width });
        }
        output_names.extend(numbered(name, system.outputs()));
        systems.push(system);
    }
    output_names.extend(numbered("y", n_y));
    // (r, u) to (r, G u, u) to (e, G u, u, e), which the weights and the measurement then have.
    let (one, controls) = (identity(n_y), identity(n_u));
    let split = blocks(&[
        &[&one, &Mat::zeros(n_y, n_u)],
        &[&Mat::zeros(n_u, n_y), &controls],
        &[&Mat::zeros(n_u, n_y), &controls],
    ]);
    let (wide, square) = (Mat::zeros(n_y, n_u), Mat::zeros(n_y, n_y));
    let error: [&Mat<f64>; 3] = [&one, &(-&one), &wide];
    let tall = Mat::zeros(n_u, n_y);
    let join = blocks(&[&error, &[&square, &one, &wide], &[&tall, &tall, &controls], &error]);
    let gain = |matrix| StateSpace::gain(matrix, interval);
    let middle = append(&[&gain(one.clone()), plant, &gain(controls.clone())])?;
    let signals = series(&series(&gain(split), &middle)?, &gain(join))?;
    let measured = gain(one.clone());
    let weighted = append(&[&systems[0], &systems[1], &systems[2], &measured])?;
    let mut input_names = numbered("r", n_y);
    input_names.extend(numbered("u", n_u));
    let named = GeneralisedPlant::new(series(&signals, &weighted)?, n_y, n_u)?;
    Ok(GeneralisedPlant { input_names, output_names, ..named })
}

/// An error where a weight has a pole that is not stable: no controller reaches it.
fn stable_weight(weight: &'static str, system: &StateSpace) -> Result<(), SynthesisError> {
    match system.least_stable_pole()? {
        Some(pole) if system.growth(pole) >= 0.0 => {
            Err(SynthesisError::UnstableWeight { weight, pole })
        }
        _ => Ok(()),
    }
}
