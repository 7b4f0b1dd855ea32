//! `meandering`: amplitude, bias and frequency of the load of turbines that follow a meandering wake.

use super::{Analysis, Answer, FIGURES, Of, Request, drawn};
use crate::signals::line_json;
use crate::{MeanderingAxisNumbers, MeanderingNumbers, PostprocessingError, meandering};
use report::{DensityRow, Signals, TrackFigure, TrackRow};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "meandering",
    about: "Tilt and yaw moment of turbines that amplify or attenuate the meandering of a wake, over time and over frequency, with amplitude error, bias and frequency: figures 4-4 to 4-7 of van Veldhoven (2024)",
    of: Of::Run("Folder of a study, such as runs/meandering-disk"),
    settings: &[FIGURES],
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let (numbers, signals) = meandering(request.run())?;
    let remarks = Vec::from_iter(drawn(request, &signals)?);
    let runs: Vec<_> = numbers.iter().map(json).collect();
    let figures: Vec<_> = signals.iter().flat_map(figures).collect();
    Ok(Answer { text: text(&numbers), json: json!({ "runs": runs, "figures": figures }), remarks })
}

/// Run by run and axis by axis, with the conventions below.
fn text(numbers: &[MeanderingNumbers]) -> String {
    let mut text = format!(
        "{:<8} {:<18} {:>6} {:<5} {:>11} {:>11} {:>10} {:>16} {:>18} {:>9}\n",
        "turbine",
        "run",
        "factor",
        "axis",
        "target MN m",
        "error MN m",
        "rms MN m",
        "bias MN m",
        "frequency mHz",
        "error %"
    );
    for found in numbers {
        let factor = found.factor.map_or("–".to_owned(), |factor| format!("{factor}"));
        let [mean, deviation] = found.frequency.map(|frequency| 1e3 * frequency);
        let frequency = format!("{mean:.2} ± {deviation:.2}");
        let error = found.frequency_error;
        let error = error.map_or("–".to_owned(), |error| format!("{:.2}", 100.0 * error));
        for (axis, of) in ["tilt", "yaw"].iter().zip(&found.axes) {
            let MeanderingAxisNumbers { amplitude_error, amplitude_rms, target, .. } = of;
            let [target, wrong, rms] =
                [target, amplitude_error, amplitude_rms].map(|moment| number(1e-6 * moment));
            let bias = format!("{:.2} ± {:.2}", 1e-6 * of.bias, 1e-6 * of.bias_deviation);
            text += &format!(
                "{:<8} {:<18} {factor:>6} {axis:<5} {target:>11} {wrong:>11} {rms:>10} {bias:>16} {frequency:>18} {error:>9}\n",
                found.turbine, found.run
            );
        }
    }
    text + "error: target minus estimated amplitude, its mean and root mean square while there is a target; ±: standard deviation over the analysed time; error of the frequency: rms over the disk's own, where a disk circles in the wind\n"
}

/// `value` with three digits behind the point; a dash where there is none.
fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.3}") } else { "–".to_owned() }
}

fn json(found: &MeanderingNumbers) -> serde_json::Value {
    let axis = |of: &MeanderingAxisNumbers| {
        json!({
            "target_nm": of.target,
            "amplitude_error_nm": of.amplitude_error,
            "amplitude_rms_nm": of.amplitude_rms,
            "bias_nm": of.bias,
            "bias_deviation_nm": of.bias_deviation,
        })
    };
    json!({
        "run": found.run,
        "turbine": found.turbine,
        "factor": found.factor,
        "tilt": axis(&found.axes[0]),
        "yaw": axis(&found.axes[1]),
        "frequency_hz": found.frequency[0],
        "frequency_deviation_hz": found.frequency[1],
        "frequency_error": found.frequency_error,
    })
}

/// All that the figures of `signals` draw.
fn figures(signals: &Signals) -> Vec<serde_json::Value> {
    let tracks = |figure: &TrackFigure| {
        let rows = figure.rows.iter().map(|TrackRow { label, lines, .. }| {
            let lines = lines.iter().map(
                |line| json!({ "run": line.name, "times_s": line.times, "values": line.values }),
            );
            json!({ "label": label, "lines": lines.collect::<Vec<_>>() })
        });
        json!({ "name": figure.name, "rows": rows.collect::<Vec<_>>() })
    };
    let densities = signals.densities.iter().map(|figure| {
        let rows = figure.rows.iter().map(|DensityRow { label, lines }| {
            let lines: Vec<_> = lines.iter().map(line_json).collect();
            json!({ "label": label, "lines": lines })
        });
        json!({ "name": figure.name, "rows": rows.collect::<Vec<_>>() })
    });
    signals.tracks.iter().map(tracks).chain(densities).collect()
}
