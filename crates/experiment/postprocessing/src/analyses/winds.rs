//! `winds`: the wind of a helix as a turbine estimates it, beside the true one.

use super::phase::{SETTINGS, question};
use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, drawn};
use crate::winds::figure;
use crate::{PhaseAnswer, PostprocessingError, WindNumbers, phases, wind_numbers};
use report::Signals;
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "winds",
    about: "Average, tilt and yaw of the wind that a turbine estimates, over time, with their standard deviations, against the true wind of a run without it: figure 10 of van Vondelen et al. (2025)",
    of: Of::Run("Folder of a run, such as runs/synchronised-helix/bl-helix"),
    settings: &[SETTINGS[0], SETTINGS[1], SETTINGS[2], SETTINGS[3], SETTINGS[4], OWN],
    run,
};

const OWN: AnalysisSetting = FIGURES;

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = phases(&question(request)?)?;
    let signals = found.answers.iter().map(|answer| {
        let mut figure = figure(answer, None);
        figure.name = format!("winds-{}-{}", answer.run, answer.turbine);
        Signals { tracks: vec![figure], ..Signals::default() }
    });
    let drawn = drawn(request, &signals.collect::<Vec<_>>())?;
    let texts: Vec<String> = found.answers.iter().map(text).collect();
    let mut remarks: Vec<String> = found.without_truth.iter().map(ToString::to_string).collect();
    remarks.extend(drawn);
    Ok(Answer { text: texts.join("\n"), json: found.answers.iter().map(json).collect(), remarks })
}

/// Names of the components.
const COMPONENTS: [&str; 3] = ["average", "tilt", "yaw"];

/// Component by component, with the conventions below.
fn text(answer: &PhaseAnswer) -> String {
    let (first, last) = (answer.times.first(), answer.times.last());
    let span = first.zip(last).map_or_else(String::new, |(a, b)| format!("; {a:.0} to {b:.0} s"));
    let mut text = format!(
        "{} in {}, against the wind of {} at its place{span}\n{:<9} {:>10} {:>10} {:>12} {:>11} {:>10}\n",
        answer.turbine,
        answer.run,
        answer.truth,
        "component",
        "bias m/s",
        "RMSE m/s",
        "correlation",
        "over truth",
        "within σ"
    );
    for (name, found) in COMPONENTS.iter().zip(wind_numbers(answer)) {
        let WindNumbers { bias, rmse, correlation, ratio, within } = found;
        let within = within.map_or("–".to_owned(), |share| format!("{share:.2}"));
        text += &format!(
            "{name:<9} {bias:>10.3} {rmse:>10.3} {correlation:>12.3} {ratio:>11.3} {within:>10}\n"
        );
    }
    text += &format!(
        "tilt and yaw: the helix's, the truth band-passed from {:.4} to {:.4} Hz; average: the truth as it is\n\
         over truth: standard deviation of the estimate over that of the truth; within σ: share of the time in which the truth lies within the estimator's own standard deviation, 0.68 where it knows its errors\n",
        answer.band.low, answer.band.high
    );
    text
}

/// The numbers, and all that the figure draws.
fn json(answer: &PhaseAnswer) -> serde_json::Value {
    let tracks = [
        (&answer.wind, &answer.true_wind, &answer.wind_deviation),
        (&answer.tilt.wind, &answer.tilt.true_wind, &answer.tilt.wind_deviation),
        (&answer.yaw.wind, &answer.yaw.true_wind, &answer.yaw.wind_deviation),
    ];
    let components = COMPONENTS.iter().zip(wind_numbers(answer)).zip(tracks);
    let components = components.map(|((name, found), (estimated, truth, deviation))| {
        let of = json!({
            "bias_m_s": found.bias,
            "rmse_m_s": found.rmse,
            "correlation": found.correlation,
            "over_truth": found.ratio,
            "within_deviation": found.within,
            "estimated_m_s": estimated,
            "true_m_s": truth,
            "deviation_m_s": deviation,
        });
        ((*name).to_owned(), of)
    });
    let phases = |axis: &crate::PhaseAxis| {
        json!({
            "estimated_rad": axis.phase,
            "true_rad": axis.true_phase,
            "deviation_rad": axis.phase_deviation,
        })
    };
    json!({
        "run": answer.run,
        "turbine": answer.turbine,
        "truth": answer.truth,
        "band_hz": [answer.band.low, answer.band.high],
        "times_s": answer.times,
        "winds": components.collect::<serde_json::Map<_, _>>(),
        "phases": { "tilt": phases(&answer.tilt), "yaw": phases(&answer.yaw) },
    })
}
