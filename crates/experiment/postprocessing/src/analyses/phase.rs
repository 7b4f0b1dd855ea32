//! `phase`: how well a turbine finds the phase of the helix that meets it.

use super::{Analysis, AnalysisSetting, Answer, Of, Request, Takes};
use crate::{
    PhaseAnswer, PhaseAxis, PhaseQuestion, PostprocessingError, PreviewUse, Replayed, phases,
};
use analysis::phase::{Agreement, Band};
use control::phase_sync::PhaseEstimator;
use report::text_table::{Column, TextTable};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "phase",
    about: "How well a turbine estimates the phase of the incoming helix, against the true wind of a run without it",
    of: Of::Run("Folder of a run, such as runs/synchronised-helix/offset-150"),
    settings: SETTINGS,
    run,
};

/// What can be set of it, and of `tune`.
pub(super) const SETTINGS: &[AnalysisSetting] = &[
    AnalysisSetting {
        name: "turbine",
        value: "NAME",
        takes: Takes::Text,
        about: "Turbine that estimates the phase; when left out each that does, for `tune` the first of them",
    },
    AnalysisSetting {
        name: "truth",
        value: "RUN",
        takes: Takes::Text,
        about: "Folder of a run without that turbine, with the wind along lines at its place; one beside RUN when left out",
    },
    AnalysisSetting {
        name: "estimator",
        value: "NAME",
        takes: Takes::Choice(&[
            ("robust", "With states for model errors"),
            (
                "published",
                "The four states of van Vondelen et al. (2025), without the azimuth offset of their model",
            ),
            (
                "published-with-offset",
                "The same with the azimuth offset that was found before the run",
            ),
            (
                "smoothed",
                "The robust one forward over the record and then back, after Rauch, Tung and Striebel: it knows the future, as no turbine does",
            ),
            ("linear", "The linear filter of the earlier method, around the means of the record"),
        ]),
        about: "Run this estimator over the records, instead of reading the run's own estimate",
    },
    AnalysisSetting {
        name: "band",
        value: "LOW-HIGH",
        takes: Takes::Text,
        about: "Band (Hz) of the filter through which the true wind goes, such as 0.0073-0.15; from two thirds to three halves of the helix's frequency when left out",
    },
    AnalysisSetting {
        name: "from",
        value: "T",
        takes: Takes::Number,
        about: "First time that counts (s); the end of the spin-up when left out",
    },
];

/// The question that `request` puts.
///
/// # Errors
/// [`PostprocessingError::Setting`] for a band that is none.
pub(super) fn question(request: &Request) -> Result<PhaseQuestion, PostprocessingError> {
    Ok(PhaseQuestion {
        run: request.run().to_owned(),
        turbine: request.text("turbine").map(str::to_owned),
        truth: request.text("truth").map(Into::into),
        estimator: request.text("estimator").map(|name| match name {
            "published" => Replayed::InRun(PhaseEstimator::Published),
            "published-with-offset" => Replayed::InRun(PhaseEstimator::PublishedWithOffset),
            "smoothed" => Replayed::Smoothed,
            "linear" => Replayed::Linear,
            _ => Replayed::InRun(PhaseEstimator::Robust),
        }),
        band: request.text("band").map(band).transpose()?,
        from: request.number("from"),
    })
}

/// The band that `given` says, LOW-HIGH in Hz.
fn band(given: &str) -> Result<Band, PostprocessingError> {
    let ends = given.split_once('-');
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|end| end.is_finite());
    let band = ends.and_then(|(low, high)| Some(Band { low: number(low)?, high: number(high)? }));
    band.filter(|band| 0.0 < band.low && band.low < band.high).ok_or_else(|| {
        PostprocessingError::Setting {
            setting: "band",
            given: given.to_owned(),
            expected: "two frequencies above zero in Hz, the lower first",
            fix: "write it like --band 0.0073-0.0164",
        }
    })
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = phases(&question(request)?)?;
    let texts: Vec<String> =
        found.answers.iter().map(|answer| text(answer, request.width())).collect();
    Ok(Answer {
        text: texts.join("\n"),
        json: all_json(&found.answers),
        remarks: found.without_truth.iter().map(ToString::to_string).collect(),
    })
}

/// An object, or a list of them where several turbines look for a helix.
fn all_json(answers: &[PhaseAnswer]) -> serde_json::Value {
    match answers {
        [answer] => json(answer),
        several => several.iter().map(json).collect(),
    }
}

fn text(answer: &PhaseAnswer, width: usize) -> String {
    let [estimated, truth] = answer.mean_winds;
    let span = match (answer.times.first(), answer.times.last()) {
        (Some(first), Some(last)) => format!("{first:.0} to {last:.0} s"),
        _ => "no time".to_owned(),
    };
    let mut text = format!(
        "{} in {}, against the wind of {} at its place, {:.4} to {:.4} Hz; {span}\nmean wind {estimated:.2} m/s estimated, {truth:.2} m/s true; trust {:.2}\n",
        answer.turbine, answer.run, answer.truth, answer.band.low, answer.band.high, answer.trust
    );
    if let Some(PreviewUse { share, lag }) = answer.preview {
        text += &format!(
            "{:.0} % of the estimate through the lidar that sees ahead, {lag:.1} s late on the mean; the rest from the blade loads\n",
            100.0 * share
        );
    }
    let errors = ["amplitude m/s", "true m/s", "RMSE deg", "bias deg", "spread deg", "locking"];
    let at_helix = [
        Column::number("coherence").in_new_table(),
        Column::number("phase error deg"),
        Column::number("consistency"),
    ];
    let columns = errors.map(Column::number).into_iter().chain(at_helix);
    let mut table = TextTable::new([Column::words("axis")], columns);
    table.row(row("tilt", &answer.tilt));
    table.row(row("yaw", &answer.yaw));
    text += &table.fitted(width);
    text + &below(answer)
}

/// The row of the axis called `name`.
fn row(name: &str, axis: &PhaseAxis) -> [String; 10] {
    let agreement = &axis.agreement;
    let bias = match agreement.bias_half_width_95 {
        Some(half) => with_interval(agreement.bias, half),
        None => format!("{:.1}", agreement.bias.to_degrees()),
    };
    let coherence =
        axis.coherence.map_or("–".to_owned(), |found| format!("{:.3}", found.coherence));
    let error = axis.coherence.map_or("–".to_owned(), |found| {
        with_interval(found.phase_error, found.phase_error_half_width_95)
    });
    let consistency = axis
        .consistency
        .as_ref()
        .map_or("–".to_owned(), |found| super::with_interval(found, 1.0, 2));
    [
        name.to_owned(),
        format!("{:.2}", axis.amplitude),
        format!("{:.2}", axis.true_amplitude),
        rmse(agreement),
        bias,
        format!("{:.1}", agreement.spread.to_degrees()),
        format!("{:.3}", agreement.locking),
        coherence,
        error,
        consistency,
    ]
}

/// Conventions, and what else the records tell, below the table.
fn below(answer: &PhaseAnswer) -> String {
    let n_blocks = answer.tilt.agreement.n_blocks;
    let mut text = format!(
        "± and ranges: 95 % by Student's t from {n_blocks} blocks of {:.0} s; coherence and phase error, estimate before truth, at the helix's frequency, from the cross-spectrum\n\
         consistency: squared errors over the estimator's own variance of them, 1 where it knows them\n",
        answer.block
    );
    if let Some([tilt, yaw]) = &answer.published_band {
        text += &format!(
            "against the truth from {:.4} to {} Hz, the published upper edge: RMSE {}° in tilt, {}° in yaw\n",
            published_low(answer),
            Band::PUBLISHED_HIGH,
            rmse(tilt),
            rmse(yaw)
        );
    }
    if let Some([tilt, yaw]) = answer.zero_phase {
        let [tilt, yaw] =
            [tilt, yaw].map(|found| (found.spread.to_degrees(), found.bias.to_degrees()));
        text += &format!(
            "zero-phase estimate, the same blade moments through the filter of the truth: spread {:.1}° about {:+.1}° in tilt, {:.1}° about {:+.1}° in yaw\n",
            tilt.0, tilt.1, yaw.0, yaw.1
        );
    }
    text
}

/// Lower edge (Hz) of the published band of `answer`.
fn published_low(answer: &PhaseAnswer) -> f64 {
    answer.frequency / Band::RATIO
}

/// Root mean square of the error with its interval, in degrees.
fn rmse(agreement: &Agreement) -> String {
    let whole = format!("{:.1}", agreement.rmse.to_degrees());
    match agreement.rmse_95 {
        Some([low, high]) => {
            format!("{whole} ({:.0} to {:.0})", low.to_degrees(), high.to_degrees())
        }
        None => whole,
    }
}

/// An angle and its half width (rad), in degrees.
fn with_interval(angle: f64, half_width: f64) -> String {
    format!("{:.1} ± {:.1}", angle.to_degrees(), half_width.to_degrees())
}

fn json(answer: &PhaseAnswer) -> serde_json::Value {
    let axis = |axis: &PhaseAxis| {
        let agreement = &axis.agreement;
        json!({
            "amplitude_m_s": axis.amplitude,
            "true_amplitude_m_s": axis.true_amplitude,
            "rmse_deg": agreement.rmse.to_degrees(),
            "rmse_95_deg": agreement.rmse_95.map(|ends| ends.map(f64::to_degrees)),
            "bias_deg": agreement.bias.to_degrees(),
            "bias_half_width_95_deg": agreement.bias_half_width_95.map(f64::to_degrees),
            "spread_deg": agreement.spread.to_degrees(),
            "locking": agreement.locking,
            "coherence": axis.coherence.map(|found| found.coherence),
            "coherence_95": axis.coherence.map(|found| found.coherence_95),
            "phase_error_deg": axis.coherence.map(|found| found.phase_error.to_degrees()),
            "phase_error_half_width_95_deg":
                axis.coherence.map(|found| found.phase_error_half_width_95.to_degrees()),
            "consistency": axis.consistency.as_ref().map(|found| found.mean),
            "consistency_half_width_95": axis.consistency.as_ref().and_then(|found| found.half_width_95),
        })
    };
    json!({
        "run": answer.run,
        "turbine": answer.turbine,
        "truth": answer.truth,
        "band_hz": [answer.band.low, answer.band.high],
        "n_blocks": answer.tilt.agreement.n_blocks,
        "block_s": answer.block,
        "from_s": answer.times.first(),
        "to_s": answer.times.last(),
        "mean_wind_m_s": answer.mean_winds[0],
        "true_mean_wind_m_s": answer.mean_winds[1],
        "trust": answer.trust,
        "preview": answer.preview.map(|PreviewUse { share, lag }| json!({
            "share": share,
            "lag_s": lag,
        })),
        "tilt": axis(&answer.tilt),
        "yaw": axis(&answer.yaw),
        "zero_phase": answer.zero_phase.map(|axes| by_axis(axes.map(|found| json!({
            "spread_deg": found.spread.to_degrees(),
            "bias_deg": found.bias.to_degrees(),
        })))),
        "published_band": answer.published_band.map(|axes| by_axis(axes.map(|found| json!({
            "rmse_deg": found.rmse.to_degrees(),
            "rmse_95_deg": found.rmse_95.map(|ends| ends.map(f64::to_degrees)),
        })))),
    })
}

/// What is of tilt and yaw, by these names.
fn by_axis([tilt, yaw]: [serde_json::Value; 2]) -> serde_json::Value {
    json!({ "tilt": tilt, "yaw": yaw })
}

#[cfg(test)]
mod tests {
    use super::*;
    use analysis::phase::Coherence;
    use basis::records::Statistic;

    /// An axis with an error of `error` (deg) at the helix's frequency, or in a record too short to tell.
    fn axis(error: Option<f64>) -> PhaseAxis {
        let coherence = error.map(|error| Coherence {
            coherence: 0.9,
            coherence_95: [0.8, 0.95],
            floor_95: 0.2,
            phase_error: error.to_radians(),
            phase_error_half_width_95: 4.56_f64.to_radians(),
            gain: 1.0,
            n_segments: 8,
        });
        PhaseAxis {
            amplitude: 1.0,
            true_amplitude: 1.1,
            agreement: Agreement {
                rmse: 0.2,
                rmse_95: Some([0.17, 0.23]),
                n_blocks: 4,
                bias: 0.1,
                bias_half_width_95: Some(0.05),
                spread: 0.17,
                locking: 0.98,
            },
            coherence,
            consistency: error.map(|_| Statistic {
                mean: 1.5,
                standard_deviation: 1.0,
                half_width_95: Some(0.75),
                n_blocks: 4,
            }),
            wind: vec![0.7],
            wind_deviation: vec![0.2],
            true_wind: vec![0.8],
            phase: vec![0.0],
            phase_deviation: vec![0.3],
            true_phase: vec![0.0],
        }
    }

    #[test]
    fn the_phase_error_at_the_helix_frequency_stands_in_text_and_json() {
        let answer = PhaseAnswer {
            run: "joined".into(),
            turbine: "T2".into(),
            truth: "alone".into(),
            frequency: 0.0109,
            band: Band { low: 0.0073, high: 0.0164 },
            block: 366.0,
            times: vec![600.0],
            mean_winds: [8.0, 8.1],
            wind: vec![8.0],
            wind_deviation: vec![0.1],
            true_wind: vec![8.1],
            tilt: axis(Some(-12.34)),
            yaw: axis(None),
            trust: 0.5,
            preview: None,
            zero_phase: None,
            published_band: Some([axis(None).agreement; 2]),
        };
        let preview = Some(PreviewUse { share: 0.934, lag: 2.06 });
        let ahead = PhaseAnswer { preview, ..answer.clone() };
        let said = text(&ahead, 100);
        assert!(said.lines().nth(2).is_some_and(|line| line.starts_with("93 % ")), "{said}");
        assert!(
            said.contains(", 2.1 s late on the mean; the rest from the blade loads\n"),
            "{said}"
        );
        assert_eq!(json(&ahead)["preview"], json!({ "share": 0.934, "lag_s": 2.06 }));
        assert!(json(&answer)["preview"].is_null());
        let text = text(&answer, 100);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[2].ends_with("bias deg  spread deg  locking"), "{text}");
        assert!(lines[3].starts_with("tilt") && lines[3].contains(" 11.5 (10 to 13) "), "{text}");
        assert!(lines[6].ends_with("coherence  phase error deg  consistency"), "{text}");
        assert!(lines[7].starts_with("tilt") && lines[7].contains(" -12.3 ± 4.6 "), "{text}");
        assert!(lines[7].ends_with(" 1.50 ± 0.75"), "{text}");
        assert!(lines[8].starts_with("yaw") && lines[8].ends_with(" –"), "{text}");
        assert!(lines[9].contains("from 4 blocks of 366 s"), "{text}");
        assert!(
            lines[11].contains("0.0073 to 0.15 Hz") && lines[11].contains("11.5 (10 to 13)°"),
            "{text}"
        );
        let width = |line: &str| line.chars().count();
        assert_eq!([width(lines[3]), width(lines[4])], [width(lines[2]); 2], "{text}");
        assert_eq!([width(lines[7]), width(lines[8])], [width(lines[6]); 2], "{text}");
        let json = json(&answer);
        let half_width = json["tilt"]["phase_error_half_width_95_deg"].as_f64().expect("a number");
        assert!((half_width - 4.56).abs() < 1e-9, "{half_width}");
        assert_eq!(json["tilt"]["consistency"], 1.5);
        assert!(json["yaw"]["consistency"].is_null());
        assert!(json["yaw"]["phase_error_half_width_95_deg"].is_null());
    }

    #[test]
    fn a_band_is_two_frequencies() {
        assert_eq!(band("0.0073-0.15").expect("a band"), Band { low: 0.0073, high: 0.15 });
        for wrong in ["0.1", "0.2-0.1", "-0.1", "a-b", "0-0.1", "0.1-inf"] {
            let refused = band(wrong).expect_err("no band").to_string();
            assert!(refused.starts_with(&format!("--band {wrong}: two frequencies")), "{refused}");
        }
    }
}
