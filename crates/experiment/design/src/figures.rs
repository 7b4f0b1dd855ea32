//! Figures of a model and of a controller.

use crate::model::short;
use crate::{Identified, LoopResponses, Responses, Synthesized};
use formats::linear_model::Port;
use report::{
    Along, DensityFigure, DensityRow, Signals, SpectrumLine, TrackFigure, TrackLine, TrackRow,
};
use std::f64::consts::TAU;

/// The figures of what was identified.
pub(crate) fn of_identified(found: &Identified) -> Signals {
    Signals {
        densities: vec![frequency_response(found)],
        tracks: vec![phases(found), singular_values(found)],
        ..Signals::default()
    }
}

/// The figures of what was synthesised.
pub(crate) fn of_synthesized(found: &Synthesized) -> Signals {
    let mut tracks = vec![sensitivities(found)];
    tracks.extend(by_channel(&found.responses));
    tracks.extend(step_responses(found));
    Signals { tracks, ..Signals::default() }
}

/// Gain of every path over frequency, record and model.
fn frequency_response(found: &Identified) -> DensityFigure {
    let response = &found.response;
    let [inputs, outputs] = [&found.model.inputs, &found.model.outputs];
    let step = response.frequencies.first().map_or(1.0, |first| first / TAU);
    let mut rows = Vec::new();
    for (i, output) in outputs.iter().enumerate() {
        for (j, input) in inputs.iter().enumerate() {
            let line = |name: &str, colour: usize, of: &[Vec<Vec<lti::Complex64>>]| SpectrumLine {
                name: name.to_owned(),
                colour,
                frequency_step: step,
                // What stands at zero frequency is not looked at: means were taken off.
                values: std::iter::once(of[0][i][j].norm())
                    .chain(of.iter().map(|response| response[i][j].norm()))
                    .collect(),
            };
            rows.push(DensityRow {
                label: format!("{} / {}", short(&output.name), short(&input.name)),
                lines: vec![
                    line("record", 0, &response.measured),
                    line("model", 1, &response.modelled),
                ],
            });
        }
    }
    DensityFigure {
        name: "frequency-response".to_owned(),
        title: "Frequency response".to_owned(),
        caption: "Gain from each input to each output: of the record, averaged spectra, and of the model."
            .to_owned(),
        lowest_frequency: Some(step),
        highest_frequency: last_told(&found.response) / TAU,
        marks: vec![(found.bandwidth / TAU, "of interest".to_owned())],
        band: None,
        rows,
    }
}

/// Phase of every path over frequency, record and model.
fn phases(found: &Identified) -> TrackFigure {
    let response = &found.response;
    let highest = last_told(response);
    let n = response.frequencies.iter().take_while(|rate| **rate <= highest).count();
    let [inputs, outputs] = [&found.model.inputs, &found.model.outputs];
    let row = |(i, output): (usize, &Port)| {
        let line = |of: &[Vec<Vec<lti::Complex64>>], j: usize, what: &str, colour| TrackLine {
            name: format!("{what}, from {}", short(&inputs[j].name)),
            colour,
            times: response.frequencies[..n].iter().map(|rate| rate.log10()).collect(),
            values: of[..n].iter().map(|at| at[i][j].arg()).collect(),
            band: Vec::new(),
        };
        let both = |j| {
            [
                line(&response.measured, j, "record", 2 * j),
                line(&response.modelled, j, "model", 2 * j + 1),
            ]
        };
        TrackRow {
            label: format!("{} (°)", short(&output.name)),
            is_angle: true,
            lines: (0..inputs.len()).flat_map(both).collect(),
        }
    };
    let rows = outputs.iter().enumerate().map(row).collect();
    TrackFigure {
        along: Along { label: "log₁₀ of frequency in rad/s", unit: "" },
        name: "phase-response".to_owned(),
        title: "Phase response".to_owned(),
        caption: "Phase of each output behind each input, the delay that was given aside: of the record, averaged spectra, and of the model. Dashed: the frequency of interest.".to_owned(),
        rows,
        mark: Some(found.bandwidth.log10()),
    }
}

/// Highest frequency (rad/s) at which some path of the record has an error below the model's largest gain:
/// beyond, an excitation that is limited to a band leaves nothing but noise.
fn last_told(response: &Responses) -> f64 {
    let gains = response.modelled.iter().flatten().flatten().map(|gain| gain.norm());
    let largest = gains.fold(0.0, f64::max);
    let tells = |errors: &Vec<Vec<f64>>| errors.iter().flatten().any(|error| *error <= largest);
    let last = response.deviations.iter().rposition(tells).unwrap_or(0).max(3);
    response.frequencies.get(last).copied().unwrap_or(1.0)
}

/// The singular values that tell the order.
fn singular_values(found: &Identified) -> TrackFigure {
    let values: Vec<f64> = found.singular_values.iter().map(|value| value.log10()).collect();
    let numbers = (1..=values.len()).map(|number| number as f64).collect();
    let line = TrackLine {
        name: "deviation of a state".to_owned(),
        colour: 0,
        times: numbers,
        values,
        band: Vec::new(),
    };
    TrackFigure {
        along: Along { label: "number of the state (–)", unit: "–" },
        name: "singular-values".to_owned(),
        title: "Singular values".to_owned(),
        caption: "The order is where they fall.".to_owned(),
        rows: vec![TrackRow {
            label: "log₁₀ (–)".to_owned(), is_angle: false, lines: vec![line]
        }],
        mark: Some(found.model.a.len() as f64),
    }
}

/// What a controller shapes.
const SHAPED: [&str; 3] = ["S", "T", "K S"];

/// A row of `gains` with the `bounds` of its weight, if any, in dB over the frequencies.
fn shaped(responses: &LoopResponses, label: String, gains: &[f64], bounds: &[f64]) -> TrackRow {
    let line = |name: &str, colour, gains: &[f64]| TrackLine {
        name: name.to_owned(),
        colour,
        times: responses.frequencies.iter().map(|w| w.log10()).collect(),
        values: gains.iter().map(|gain| 20.0 * gain.log10()).collect(),
        band: Vec::new(),
    };
    let mut lines = vec![line("largest gain", 0, gains)];
    if !bounds.is_empty() {
        lines.push(line("1 / weight", 1, bounds));
    }
    TrackRow { label, is_angle: false, lines }
}

/// The channels that have weights of their own; none where all have the same.
fn by_channel(responses: &LoopResponses) -> Option<TrackFigure> {
    let rows: Vec<TrackRow> = responses
        .channels
        .iter()
        .map(|channel| {
            let label = format!("{}, {} (dB)", SHAPED[channel.shaped], short(&channel.name));
            shaped(responses, label, &channel.gains, &channel.bounds)
        })
        .collect();
    (!rows.is_empty()).then(|| TrackFigure {
        along: Along { label: "log₁₀ of frequency in rad/s", unit: "" },
        name: "sensitivities-by-channel".to_owned(),
        title: "Sensitivities, channel by channel".to_owned(),
        caption: "Largest gain from all references to one channel of S, T and K S, the delay aside; the weight of the channel asks it to stay below γ times its line."
            .to_owned(),
        rows,
        mark: None,
    })
}

/// S, T and K S with the bounds of their weights.
fn sensitivities(found: &Synthesized) -> TrackFigure {
    let responses = &found.responses;
    let rows = SHAPED.into_iter().zip(&responses.gains).zip(&responses.bounds);
    let rows = rows
        .map(|((what, gains), bounds)| shaped(responses, format!("{what} (dB)"), gains, bounds));
    TrackFigure {
        along: Along { label: "log₁₀ of frequency in rad/s", unit: "" },
        name: "sensitivities".to_owned(),
        title: "Sensitivities".to_owned(),
        caption: "Largest singular values of sensitivity S, complementary sensitivity T and control K S, the delay aside; the weights ask them to stay below γ times their lines. Dashed: the bandwidth."
            .to_owned(),
        rows: rows.collect(),
        mark: found.bandwidth.map(f64::log10),
    }
}

/// Answers to steps of the references; none in continuous time.
fn step_responses(found: &Synthesized) -> Option<TrackFigure> {
    let interval = found.controller.interval_s?;
    let outputs = &found.controller.inputs;
    let rows = found.steps.iter().enumerate().map(|(input, samples)| TrackRow {
        label: format!("step of {}", short(&outputs[input].name)),
        is_angle: false,
        lines: outputs
            .iter()
            .enumerate()
            .map(|(output, port)| TrackLine {
                name: port.name.clone(),
                colour: output,
                times: (0..samples.len()).map(|sample| sample as f64 * interval).collect(),
                values: samples.iter().map(|row| row[output]).collect(),
                band: Vec::new(),
            })
            .collect(),
    });
    Some(TrackFigure {
        along: Along::TIME,
        name: "step-responses".to_owned(),
        title: "Step responses".to_owned(),
        caption: "Answers to a unit step of each reference, the delay in them, where the plant is the model."
            .to_owned(),
        rows: rows.collect(),
        mark: None,
    })
}
