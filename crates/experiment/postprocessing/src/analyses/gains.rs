//! `gains`: gains of one case in several winds, and all of them together.

use super::{Analysis, AnalysisSetting, Answer, Of, Request, Takes, with_interval};
use crate::{GainsAnswer, GainsQuestion, PartGains, PostprocessingError, gains_over_seeds};
use report::text_table::{Column, TextTable};
use serde_json::json;
use std::path::PathBuf;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "gains",
    about: "Gains of one case in several winds, from studies that differ in wind.seed, each and all together with a 95 % interval",
    of: Of::Studies("Folders of two studies or more of one case that differ in wind.seed"),
    settings: &[AnalysisSetting {
        name: "run",
        value: "NAME",
        takes: Takes::Texts,
        about: "Only this run (may be repeated); all that compare with another when left out",
    }],
    run,
};

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let question =
        GainsQuestion { studies: request.folders.clone(), runs: request.texts("run").to_vec() };
    let answer = gains_over_seeds(&question)?;
    let json = json(&answer, &question.studies);
    Ok(Answer { text: text(&answer, request.width()), json, remarks: answer.undefined })
}

/// Runs × turbines: gain in each wind and in all of them, in percent, in `width` columns; the conventions
/// below.
fn text(answer: &GainsAnswer, width: usize) -> String {
    let seeds = answer.seeds.iter().map(|seed| Column::number(format!("seed {seed}")));
    // What all winds say comes first: it is what was asked.
    let columns = [Column::number("all")].into_iter().chain(seeds);
    let keys = [Column::words("run"), Column::words("over"), Column::words("")];
    let mut table = TextTable::new(keys, columns);
    for run in &answer.runs {
        for part in &run.parts {
            let names = [run.run.clone(), run.compare_with.clone(), part.name.clone()];
            let all = with_interval(&part.together, 100.0, 2);
            let gains = part.gains.iter().map(|gain| format!("{:.2}", 100.0 * gain));
            table.row(names.into_iter().chain([all]).chain(gains));
        }
    }
    let mut text = format!("{}: gains of power, %\n{}", answer.case, table.fitted(width));
    text += &format!(
        "± 95 % by Student's t from {} winds, taken as independent; each gain is over the other run in the same wind\n",
        answer.seeds.len()
    );
    if answer.downstream.len() > 1 {
        text += &format!("downstream: {} together\n", answer.downstream.join(" + "));
    }
    text
}

fn json(answer: &GainsAnswer, studies: &[PathBuf]) -> serde_json::Value {
    let folder = |place: usize| studies[place].display().to_string();
    let part = |part: &PartGains| {
        let gain = |(place, (seed, gain)): (usize, (&u64, &f64))| {
            let study = folder(place);
            json!({ "study": study, "seed": seed, "gain": gain })
        };
        let gains = answer.seeds.iter().zip(&part.gains).enumerate().map(gain);
        json!({
            "name": part.name,
            "gains": gains.collect::<Vec<_>>(),
            "mean": part.together.mean,
            "half_width_95": part.together.half_width_95,
        })
    };
    let studies = studies.iter().zip(&answer.seeds);
    json!({
        "case": answer.case,
        "studies": studies
            .map(|(folder, seed)| json!({ "folder": folder.display().to_string(), "seed": seed }))
            .collect::<Vec<_>>(),
        "downstream": answer.downstream,
        "runs": answer.runs.iter().map(|run| json!({
            "run": run.run,
            "compare_with": run.compare_with,
            "parts": run.parts.iter().map(part).collect::<Vec<_>>(),
        })).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RunGains;
    use basis::records::Statistic;

    fn answer() -> GainsAnswer {
        let part = |name: &str, gains: [f64; 2], half_width: f64| PartGains {
            name: name.into(),
            gains: gains.to_vec(),
            together: Statistic {
                mean: 0.5 * (gains[0] + gains[1]),
                standard_deviation: 0.0,
                half_width_95: Some(half_width),
                n_blocks: 2,
            },
        };
        GainsAnswer {
            case: "row".into(),
            seeds: vec![1, 12],
            downstream: vec!["T2".into(), "T3".into()],
            runs: vec![RunGains {
                run: "offset-090".into(),
                compare_with: "bl-helix".into(),
                parts: vec![
                    part("T2", [-0.018, -0.019], 0.0064),
                    part("downstream", [0.047, 0.043], 0.0254),
                ],
            }],
            undefined: Vec::new(),
        }
    }

    #[test]
    fn gains_stand_beside_each_other_and_together() {
        let text = text(&answer(), 100);
        let lines: Vec<&str> = text.lines().collect();
        let cells = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(lines[0], "row: gains of power, %");
        assert_eq!(cells(lines[1]), ["run", "over", "all", "seed", "1", "seed", "12"]);
        let own = ["offset-090", "bl-helix", "T2", "-1.85", "±", "0.64", "-1.80", "-1.90"];
        assert_eq!(cells(lines[2]), own);
        assert_eq!(cells(lines[3])[2..], ["downstream", "4.50", "±", "2.54", "4.70", "4.30"]);
        // Cells stand under their headings.
        let width = |line: &str| line.chars().count();
        assert_eq!([width(lines[2]), width(lines[3])], [width(lines[1]); 2], "{text}");
        assert!(lines[4].starts_with("± 95 % by Student's t from 2 winds"), "{text}");
        assert_eq!(lines[5], "downstream: T2 + T3 together");
    }

    #[test]
    fn many_winds_go_below() {
        let mut many = answer();
        many.seeds = (1..=12).collect();
        for part in &mut many.runs[0].parts {
            part.gains = vec![-0.0123; 12];
        }
        for width in [100, 60] {
            let text = text(&many, width);
            let table = text.lines().filter(|line| !line.starts_with('±'));
            assert!(table.clone().all(|line| line.chars().count() <= width), "{text}");
            assert_eq!(text.matches("-1.23").count(), 24, "{text}");
            assert!(table.filter(|line| line.starts_with("run")).count() > 1, "{text}");
        }
    }

    #[test]
    fn json_holds_ratios_and_the_seed_of_each_folder() {
        let json = json(&answer(), &["a".into(), "b".into()]);
        assert_eq!(json["studies"][1], json!({ "folder": "b", "seed": 12 }));
        let part = &json["runs"][0]["parts"][1];
        assert_eq!(part["name"], "downstream");
        let gains = [("a", 1, 0.047), ("b", 12, 0.043)]
            .map(|(study, seed, gain)| json!({ "study": study, "seed": seed, "gain": gain }));
        assert_eq!(part["gains"], json!(gains));
        assert_eq!(part["half_width_95"], 0.0254);
    }
}
