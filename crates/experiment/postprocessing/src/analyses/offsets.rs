//! `offsets`: power and loads over the phase offset, and the best offset with its interval.

use super::{Analysis, Answer, Of, Request, with_interval};
use crate::synchronisation::curve::CURVES;
use crate::{PostprocessingError, over_offset};
use report::{CurveEnd, CurvePoint, OffsetFigure, OffsetPanel};
use serde_json::json;

/// Points of a curve from one that is printed to the next (–): 30 degrees of the 120 that it has.
const PRINTED: usize = 10;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "offsets",
    about: "Power and loads over the phase offset of a turbine that joins a helix: the curve through them, and the best offset with its 95 % interval",
    of: Of::Run("Folder of a study, such as runs/synchronised-helix"),
    settings: &[],
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    if !CURVES {
        return Err(PostprocessingError::NoCurves);
    }
    let found = over_offset(request.run())?;
    let texts: Vec<String> = found.iter().flat_map(|(_, figures)| figures).map(text).collect();
    let json = found.iter().map(|(name, figures)| {
        let figures: Vec<_> = figures.iter().map(figure).collect();
        json!({ "turbine": name, "figures": figures })
    });
    Ok(Answer { text: texts.join("\n"), json: json.collect(), remarks: Vec::new() })
}

/// Panel by panel: what was simulated, the curve, and its ends; the conventions below.
pub(crate) fn text(figure: &OffsetFigure) -> String {
    let mut text = format!("{}: {}\n", figure.title, figure.label);
    for panel in &figure.panels {
        text += &format!(
            "{}\n{:>8} {:>16} {:>8} {:>18}\n",
            panel.title, "offset", "simulated", "curve", "band"
        );
        for line in lines(panel) {
            text += &line;
        }
        for (word, end) in [("highest", panel.highest), ("lowest", panel.lowest)] {
            let Some(CurveEnd { offset, offset_95: [low, high], change }) = end else { continue };
            let [offset, low, high] = [offset, low, high].map(f64::to_degrees);
            text += &format!(
                "{word} at {offset:.0}° ({low:.0} to {high:.0}°): {:+.2}\n",
                100.0 * change
            );
        }
    }
    text += "± and bands: 95 %; those of the curve from draws of a Gaussian process whose noise is known with the degrees of freedom of the blocks; hyperparameters at their most likely values; one wind for all offsets\n";
    text
}

/// The simulated offsets and every thirtieth degree of the curve, in order.
fn lines(panel: &OffsetPanel) -> Vec<String> {
    let simulated = panel.points.iter().map(|point| {
        let change = with_interval(&point.change, 100.0, 2);
        let degrees = point.offset.to_degrees();
        (degrees, 0, format!("{degrees:>7.0}° {change:>16}\n"))
    });
    let last = panel.curve.len().saturating_sub(1);
    let of_curve = panel.curve[..last].iter().step_by(PRINTED).map(|point: &CurvePoint| {
        let degrees = point.offset.to_degrees();
        let [low, high] = point.band_95.map(|end| format!("{:.2}", 100.0 * end));
        let band = format!("{low} to {high}");
        (degrees, 1, format!("{degrees:>7.0}° {:>16} {:>8.2} {band:>18}\n", "", 100.0 * point.mean))
    });
    let mut lines: Vec<(f64, usize, String)> = simulated.chain(of_curve).collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    lines.into_iter().map(|(.., line)| line).collect()
}

fn figure(figure: &OffsetFigure) -> serde_json::Value {
    let end = |end: &Option<CurveEnd>| {
        end.map(|end| {
            json!({
                "offset_deg": end.offset.to_degrees(),
                "offset_95_deg": end.offset_95.map(f64::to_degrees),
                "change": end.change,
            })
        })
    };
    let panel = |panel: &OffsetPanel| {
        json!({
            "name": panel.title,
            "points": panel.points.iter().map(|point| json!({
                "offset_deg": point.offset.to_degrees(),
                "change": point.change.mean,
                "half_width_95": point.change.half_width_95,
                "n_blocks": point.change.n_blocks,
            })).collect::<Vec<_>>(),
            "curve": panel.curve.iter().map(|point| json!({
                "offset_deg": point.offset.to_degrees(),
                "change": point.mean,
                "band_95": point.band_95,
            })).collect::<Vec<_>>(),
            "highest": end(&panel.highest),
            "lowest": end(&panel.lowest),
        })
    };
    json!({
        "name": figure.name,
        "label": figure.label,
        "panels": figure.panels.iter().map(panel).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::offset_panel;
    use basis::records::Statistic;
    use report::OffsetPoint;

    #[cfg(feature = "curves")]
    #[test]
    fn the_best_offset_stands_with_its_interval_in_text_and_json() {
        let best = 150_f64.to_radians();
        let point = |k: u32| {
            let offset = f64::from(45 * k).to_radians();
            let mean = 0.1 * (offset - best).cos() + 0.002 * f64::from(k % 3);
            let half_width_95 = Some(0.01);
            let change = Statistic { mean, standard_deviation: 0.0, half_width_95, n_blocks: 3 };
            OffsetPoint { offset, change }
        };
        let panel = offset_panel("T3".to_owned(), (0..8).map(point).collect());
        let found = panel.highest.expect("a curve");
        let [low, high] = found.offset_95;
        assert!(low < best && best < high && high - low < 0.4, "{found:?}");
        let over = OffsetFigure {
            name: "power-over-offset".into(),
            title: "Power over the phase offset of T2".into(),
            label: "power against the run bl-helix (%)".into(),
            panels: vec![panel],
        };
        let text = text(&over);
        let expected = format!(
            "highest at {:.0}° ({:.0} to {:.0}°): ",
            found.offset.to_degrees(),
            low.to_degrees(),
            high.to_degrees()
        );
        assert!(text.lines().any(|line| line.starts_with(&expected)), "{text}");
        // Eight offsets, twelve places of the curve.
        let rows =
            text.lines().filter(|line| line.trim_start().starts_with(|c: char| c.is_ascii_digit()));
        assert_eq!(rows.count(), 20, "{text}");
        let json = figure(&over);
        let told = json["panels"][0]["highest"]["offset_95_deg"][0].as_f64().expect("a number");
        assert!((told - low.to_degrees()).abs() < 1e-9);
    }
}
