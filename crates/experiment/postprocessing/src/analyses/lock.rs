//! `lock`: how well a meandering loop would lock to the loads of a turbine in records.

use super::{Analysis, AnalysisSetting, Answer, Of, Request, Takes};
use crate::{LockAnswer, LockQuestion, PostprocessingError, lock};
use basis::Sense;
use report::text_table::{Column, TextTable};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "lock",
    about: "How well a phase-locked loop would follow the slow oscillation of a turbine's blade moments in the records of a run, whatever its control",
    of: Of::Run("Folder of a run, such as runs/meandering/baseline"),
    settings: &[
        AnalysisSetting {
            name: "turbine",
            value: "NAME",
            takes: Takes::Text,
            about: "Turbine whose blade moments are used; each that is there when left out",
        },
        AnalysisSetting {
            name: "strouhal-low",
            value: "ST",
            takes: Takes::Number,
            about: "Lowest Strouhal number that is followed; the turbine's own, or 0.15, when left out",
        },
        AnalysisSetting {
            name: "strouhal-high",
            value: "ST",
            takes: Takes::Number,
            about: "Highest Strouhal number that is followed; the turbine's own, or 0.3, when left out",
        },
        AnalysisSetting {
            name: "sense",
            value: "WAY",
            takes: Takes::Choice(&[("cw", "Clockwise"), ("ccw", "Counter-clockwise")]),
            about: "Sense in which the loads rotate, looking downwind; the turbine's own, or cw, when left out",
        },
        AnalysisSetting {
            name: "from",
            value: "T",
            takes: Takes::Number,
            about: "First time that counts (s); the end of the spin-up when left out",
        },
    ],
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let answers = lock(&LockQuestion {
        run: request.run().to_owned(),
        turbine: request.text("turbine").map(str::to_owned),
        strouhal: ["strouhal-low", "strouhal-high"].map(|name| request.number(name)),
        sense: request.text("sense").map(|way| match way {
            "ccw" => Sense::CounterClockwise,
            _ => Sense::Clockwise,
        }),
        from: request.number("from"),
    })?;
    Ok(Answer {
        text: text(&answers, request.width()),
        json: answers.iter().map(json).collect(),
        remarks: Vec::new(),
    })
}

/// Turbine by turbine: what was followed, the median phase error, how often it was locked, in `width`
/// columns; the convention below.
fn text(answers: &[LockAnswer], width: usize) -> String {
    let words = ["sense", "Strouhal", "time s"].map(Column::words);
    let numbers = ["phase error rad", "locked %", "found St"].map(Column::number);
    let mut table = TextTable::new([Column::words("turbine")], words.into_iter().chain(numbers));
    for answer in answers {
        let [low, high] = answer.strouhal_range;
        let [first, last] = answer.times;
        table.row([
            answer.turbine.clone(),
            answer.sense.to_string(),
            format!("{low} to {high}"),
            format!("{first:.0} to {last:.0}"),
            format!("{:.2}", answer.phase_error),
            format!("{:.1}", 100.0 * answer.locked_share),
            format!("{:.3}", answer.strouhal),
        ]);
    }
    let text = table.fitted(width);
    text + "phase error: median of its root mean square over a period; a loop locks below 0.7 and loses it above 1.2\n"
}

fn json(answer: &LockAnswer) -> serde_json::Value {
    json!({
        "turbine": answer.turbine,
        "sense": answer.sense.to_string(),
        "strouhal_range": answer.strouhal_range,
        "from_s": answer.times[0],
        "to_s": answer.times[1],
        "phase_error_rad": answer.phase_error,
        "locked_share": answer.locked_share,
        "strouhal": answer.strouhal,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_is_reported_in_one_line() {
        let answer = LockAnswer {
            turbine: "T2".into(),
            sense: Sense::CounterClockwise,
            strouhal_range: [0.15, 0.3],
            times: [600.0, 3200.0],
            phase_error: 0.512,
            locked_share: 0.924,
            strouhal: 0.2034,
        };
        let text = text(std::slice::from_ref(&answer), 100);
        let lines: Vec<&str> = text.lines().collect();
        let cells: Vec<&str> = lines[1].split_whitespace().collect();
        let own = ["T2", "ccw", "0.15", "to", "0.3", "600", "to", "3200", "0.51", "92.4", "0.203"];
        assert_eq!(cells, own);
        // Cells stand under their headings.
        assert_eq!(lines[1].len(), lines[0].len(), "{text}");
        assert_eq!(json(&answer)["phase_error_rad"], 0.512);
    }
}
