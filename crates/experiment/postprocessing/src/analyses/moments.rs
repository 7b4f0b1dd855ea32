//! `moments`: blade moments of a turbine that pitches a helix, beside those of the estimator's models.

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::{MomentsAnswer, MomentsLine, MomentsQuestion, PostprocessingError, moments};
use report::Signals;
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "moments",
    about: "Moments at the blade roots of a turbine that pitches a helix, measured and by the phase estimator's models, with and without azimuth offset: figure 4 of van Vondelen et al. (2025)",
    of: Of::Run("Folder of a run, such as runs/synchronised-helix/t1-only"),
    settings: &[
        AnalysisSetting {
            name: "turbine",
            value: "NAME",
            takes: Takes::Text,
            about: "Turbine that pitches a helix, best one in the free wind; the first that does when left out",
        },
        AnalysisSetting {
            name: "azimuth-offset",
            value: "DEG",
            takes: Takes::Number,
            about: "Azimuth offset of the pitch in the models; that which was identified before a run of the same study when left out",
        },
        AnalysisSetting {
            name: "from",
            value: "T",
            takes: Takes::Number,
            about: "First time that counts (s); the end of the spin-up when left out",
        },
        FIGURES,
    ],
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let answer = moments(&MomentsQuestion {
        run: request.run().to_owned(),
        turbine: request.text("turbine").map(str::to_owned),
        azimuth_offset: request.number("azimuth-offset").map(f64::to_radians),
        from: request.number("from"),
    })?;
    let signals = Signals { tracks: vec![answer.figure.clone()], ..Signals::default() };
    let mut remarks = Vec::from_iter(drawn(request, &[signals])?);
    if answer.azimuth_offset.is_none() {
        remarks.push("no azimuth offset was identified before a run of this study: give one with --azimuth-offset to see what it changes".to_owned());
    }
    Ok(Answer { text: text(&answer), json: json(&answer), remarks })
}

/// Line by line, with the conventions below.
fn text(answer: &MomentsAnswer) -> String {
    let offset = answer
        .azimuth_offset
        .map_or(String::new(), |offset| format!("; azimuth offset {:.1}°", offset.to_degrees()));
    let mut text = format!(
        "{} in {}{offset}\n{:<30} {:>9} {:>10} {:>10} {:>14} {:>14}\n",
        answer.turbine,
        answer.run,
        "moments",
        "wind m/s",
        "tilt MN m",
        "yaw MN m",
        "tilt lead deg",
        "yaw lead deg"
    );
    for MomentsLine { name, wind, amplitudes, leads } in &answer.lines {
        let wind = wind.map_or("–".to_owned(), |wind| format!("{wind:.2}"));
        let [tilt, yaw] = amplitudes.map(|amplitude| 1e-6 * amplitude);
        let [tilt_lead, yaw_lead] = leads.map(f64::to_degrees);
        text += &format!(
            "{name:<30} {wind:>9} {tilt:>10.3} {yaw:>10.3} {tilt_lead:>14.1} {yaw_lead:>14.1}\n"
        );
    }
    text + "tilt, yaw: amplitude at the helix's frequency; lead: its phase ahead of the measured one; models in a steady uniform wind with the measured pitch\n"
}

/// The numbers, and all that the figure draws.
fn json(answer: &MomentsAnswer) -> serde_json::Value {
    let axis = |line: &MomentsLine, axis: usize| {
        let (amplitude, lead) = (line.amplitudes[axis], line.leads[axis].to_degrees());
        json!({ "amplitude_nm": amplitude, "lead_deg": lead })
    };
    let lines = answer.lines.iter().map(|line| {
        json!({
            "name": line.name,
            "wind_m_s": line.wind,
            "tilt": axis(line, 0),
            "yaw": axis(line, 1),
        })
    });
    let rows = answer.figure.rows.iter().map(|row| {
        let lines = row.lines.iter().map(
            |line| json!({ "name": line.name, "times_s": line.times, "moments_mnm": line.values }),
        );
        json!({ "label": row.label, "lines": lines.collect::<Vec<_>>() })
    });
    json!({
        "run": answer.run,
        "turbine": answer.turbine,
        "azimuth_offset_deg": answer.azimuth_offset.map(f64::to_degrees),
        "lines": lines.collect::<Vec<_>>(),
        "rows": rows.collect::<Vec<_>>(),
    })
}
