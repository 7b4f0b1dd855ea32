//! `spectra`: winds with and without a helix, and moments of a turbine that looks for one.

use super::{Analysis, Answer, FIGURES, Of, Request, drawn};
use crate::signals::line_json;
use crate::{PostprocessingError, SpectraAnswer, SpectraLine, spectra};
use report::Signals;
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "spectra",
    about: "Spectra of the wind where a turbine would stand, with a helix from upstream and without, and of the tilt moment of a turbine that looks for one: figures 3 and 5 of van Vondelen et al. (2025)",
    of: Of::Run("Folder of a study, such as runs/synchronised-helix"),
    settings: &[FIGURES],
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = spectra(request.run())?;
    let signals: Vec<Signals> = found.iter().map(SpectraAnswer::signals).collect();
    let remarks = Vec::from_iter(drawn(request, &signals)?);
    let texts: Vec<String> = found.iter().map(text).collect();
    Ok(Answer { text: texts.join("\n"), json: found.iter().map(json).collect(), remarks })
}

/// Line by line, with the conventions below.
fn text(answer: &SpectraAnswer) -> String {
    let mut text = format!(
        "{}, helix at {:.2} mHz\n{:<16} {:<12} {:<6} {:>14} {:>11} {:>12}\n",
        answer.turbine,
        1e3 * answer.frequency,
        "run",
        "of",
        "helix",
        "density there",
        "stands out",
        "noise MN m"
    );
    for SpectraLine { run, of, has_helix, peak, stands_out, noise } in &answer.lines {
        let has_helix = if *has_helix { "yes" } else { "no" };
        let noise = noise.map_or("–".to_owned(), |noise| format!("{noise:.3}"));
        text += &format!(
            "{run:<16} {of:<12} {has_helix:<6} {peak:>14.3} {stands_out:>11.1} {noise:>12}\n"
        );
    }
    text + "density: (m/s)²/Hz, (MN m)²/Hz; stands out: over that at two thirds and three halves of the frequency; noise: standard deviation above twice the frequency\n"
}

/// The numbers, and all that the figures draw.
fn json(answer: &SpectraAnswer) -> serde_json::Value {
    let lines = answer.lines.iter().map(|line| {
        json!({
            "run": line.run,
            "of": line.of,
            "has_helix": line.has_helix,
            "density_at_helix": line.peak,
            "stands_out": line.stands_out,
            "noise_mnm": line.noise,
        })
    });
    let figures = answer.winds.iter().chain(&answer.moments).map(|figure| {
        let rows = figure.rows.iter().map(|row| {
            let lines: Vec<_> = row.lines.iter().map(line_json).collect();
            json!({ "label": row.label, "lines": lines })
        });
        json!({ "name": figure.name, "rows": rows.collect::<Vec<_>>() })
    });
    json!({
        "turbine": answer.turbine,
        "frequency_hz": answer.frequency,
        "lines": lines.collect::<Vec<_>>(),
        "figures": figures.collect::<Vec<_>>(),
    })
}
