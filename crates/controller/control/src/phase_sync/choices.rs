//! What of a phase estimator can be chosen beside its form and its noise.

use basis::keys::{Objection, Values};
use estimation::helix::{Adaptation, Form, HelixOptions, Wake};

/// Choices of a phase estimator; what is absent stays as its form has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EstimatorChoices {
    /// Process noise intensity of the excitation rate ((rad/s)²/s), where it is a state.
    pub process_noise_rate: Option<f64>,
    /// What is adapted to the innovation.
    pub adaptation: Option<Adapts>,
    /// Whether each axis of a published form has its own amplitude.
    pub separate_amplitudes: bool,
    /// Whether the wake's delay is Øye's.
    pub two_constant_inflow: bool,
    /// Factor on the time constant of Snel and Schepers's delay (–).
    pub wake_time_factor: Option<f64>,
}

/// What an estimator adapts to its innovation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adapts {
    /// Nothing.
    Nothing,
    /// Noise of moments and eddies.
    Noise,
    /// Process noise of the wave too.
    NoiseAndWave,
}

impl EstimatorChoices {
    /// What `values` say.
    pub(super) fn of(values: &Values) -> Self {
        let adaptation = values.has("adaptation").then(|| match values.word("adaptation") {
            "none" => Adapts::Nothing,
            "noise" => Adapts::Noise,
            _ => Adapts::NoiseAndWave,
        });
        Self {
            process_noise_rate: values.optional_number("process_noise_rate"),
            adaptation,
            separate_amplitudes: values.word("amplitudes") == "separate",
            two_constant_inflow: values.word("dynamic_inflow") == "two-constant",
            wake_time_factor: values.optional_number("wake_time_factor"),
        }
    }

    /// `options` with these choices.
    pub fn apply(&self, options: HelixOptions) -> HelixOptions {
        let mut options = options;
        options.rate = self.process_noise_rate.or(options.rate);
        options.adaptation = match self.adaptation {
            None => options.adaptation,
            Some(Adapts::Nothing) => None,
            Some(Adapts::Noise) => Some(Adaptation::USUAL),
            Some(Adapts::NoiseAndWave) => Some(Adaptation { wave: true, ..Adaptation::USUAL }),
        };
        if self.separate_amplitudes && options.form == Form::SharedAmplitude {
            options.form = Form::SeparateAmplitudes;
        }
        if self.two_constant_inflow {
            options.rotor.wake = Wake::TwoConstantWithBlades;
        } else if let Some(factor) = self.wake_time_factor
            && let Wake::WithBlades { time_factor } | Wake::InAir { time_factor, .. } =
                &mut options.rotor.wake
        {
            *time_factor = factor;
        }
        options
    }
}

/// What about the choices in `values` cannot be.
pub(super) fn objections(values: &Values) -> Vec<Objection> {
    let mut objections = Vec::new();
    let mut useless = |key: &'static str, why: &str| {
        objections.push(Objection {
            key: Some(key),
            message: format!("has no effect here: {why}"),
            label: "no effect",
            fix: "leave it out".to_owned(),
        });
    };
    if values.word("estimator") == "robust" {
        if values.has("process_noise_phase") {
            useless(
                "process_noise_phase",
                "it applies only with a published estimator; the states of \"robust\" are sine and cosine components, whose process noise is process_noise_amplitude",
            );
        }
        if values.has("amplitudes") {
            useless(
                "amplitudes",
                "it applies only with a published estimator; the sine and cosine components of \"robust\" are each axis' own",
            );
        }
    }
    if values.has("wake_time_factor") && values.word("dynamic_inflow") == "two-constant" {
        useless(
            "wake_time_factor",
            "it applies only with dynamic_inflow = \"snel-schepers\"; Øye's time constants follow wind and induction",
        );
    }
    objections
}
