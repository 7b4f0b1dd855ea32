//! `changes`: power and damage-equivalent loads over those of the compared run, wind by wind.

use super::{Analysis, AnalysisSetting, Answer, Of, Request, Takes, with_interval};
use crate::{
    Change, ChangesAnswer, ChangesQuestion, ChangesRow, ChangesWind, PostprocessingError, Quantity,
    changes,
};
use report::text_table::{Column, TextTable, wrapped};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "changes",
    about: "Changes of power and damage-equivalent loads of each turbine and of all, over the run that each compares with, in every wind of studies and sweeps, with 95 % intervals: table 5 of Chen et al. (2026)",
    of: Of::Studies(
        "Folders of studies, or of sweeps; those that differ in wind.seed count together",
    ),
    settings: &[
        AnalysisSetting {
            name: "run",
            value: "NAME",
            takes: Takes::Texts,
            about: "Only this run (may be repeated); all that compare with another when left out",
        },
        AnalysisSetting {
            name: "channel",
            value: "NAME",
            takes: Takes::Texts,
            about: "Channel whose damage-equivalent load is told (may be repeated); RootMyb1 and RootMxb1, flapwise and edgewise at the root of blade 1, when left out",
        },
    ],
    run,
};

/// Channels that are told when none is asked for, with what they are.
const USUAL: [(&str, &str); 2] = [("RootMyb1", "flapwise"), ("RootMxb1", "edgewise")];

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let channels = match request.texts("channel") {
        [] => USUAL.map(|(channel, _)| channel.to_owned()).to_vec(),
        channels => channels.to_vec(),
    };
    let studies = request.folders.clone();
    let runs = request.texts("run").to_vec();
    let answer = changes(&ChangesQuestion { studies, runs, channels })?;
    let text = text(&answer, request.width());
    Ok(Answer { text, json: json(&answer), remarks: answer.remarks })
}

/// What changes, in a word or two.
fn words(quantity: &Quantity) -> String {
    match quantity {
        Quantity::Power => "power".to_owned(),
        Quantity::Load { channel, .. } => {
            let usual = USUAL.iter().find(|(known, _)| known == channel);
            usual.map_or(channel.clone(), |(_, words)| (*words).to_owned())
        }
    }
}

/// Quantities and turbines × winds, in percent, in `width` columns; the conventions below.
fn text(answer: &ChangesAnswer, width: usize) -> String {
    let keys = ["run", "over", "change of", ""].map(Column::words);
    let columns = answer.winds.iter().map(|wind| Column::number(wind.name.clone()));
    let mut table = TextTable::new(keys, columns);
    for row in &answer.rows {
        let digits = if row.quantity == Quantity::Power { 2 } else { 1 };
        let cell = |change: &Option<Change>| {
            change.as_ref().map_or("–".to_owned(), |c| with_interval(&c.together, 100.0, digits))
        };
        let names =
            [row.run.clone(), row.compare_with.clone(), words(&row.quantity), row.part.clone()];
        table.row(names.into_iter().chain(row.changes.iter().map(cell)));
    }
    let mut text = format!("{}: changes, %\n{}", answer.case, table.fitted(width));
    text += &wrapped(&convention(answer), width);
    text
}

/// How the intervals in the winds of `answer` were found, and what its loads are.
fn convention(answer: &ChangesAnswer) -> String {
    // Values behind each change of a wind: studies of it whose seeds change nothing count once.
    let n_values = |wind: usize| -> Vec<usize> {
        let changes = answer.rows.iter().filter_map(|row| row.changes[wind].as_ref());
        changes.map(|change| change.each.len()).collect()
    };
    let n_values: Vec<Vec<usize>> = (0..answer.winds.len()).map(n_values).collect();
    let seeds = |wind: &ChangesWind| {
        let seeds = wind.studies.iter().map(|(_, seed)| seed.to_string());
        format!("{} (seeds {})", wind.name, seeds.collect::<Vec<_>>().join(", "))
    };
    let mut text = String::new();
    let several = answer.winds.iter().zip(&n_values).filter(|(_, n)| n.iter().any(|n| *n > 1));
    let winds: Vec<String> = several.map(|(wind, _)| seeds(wind)).collect();
    if !winds.is_empty() {
        text += &format!(
            "± 95 % by Student's t over winds taken as independent: {}\n",
            winds.join("; ")
        );
    }
    if n_values.iter().flatten().any(|n| *n == 1) {
        text += "± 95 % in one wind: from blocks, of ten minutes unless time.block says otherwise; none of fewer than two\n";
    }
    let loads = answer.rows.iter().filter_map(|row| match &row.quantity {
        Quantity::Load { slope, reference_frequency, .. } => {
            Some(format!("{reference_frequency} Hz and slope {slope}"))
        }
        Quantity::Power => None,
    });
    let mut loads: Vec<String> = loads.collect();
    loads.dedup();
    if !loads.is_empty() {
        text += &format!(
            "flapwise, edgewise and other channels: damage-equivalent loads, for {}; all: power of all turbines together, and the sum of their loads; each over the compared run in the same wind\n",
            loads.join(", ")
        );
    }
    text
}

fn json(answer: &ChangesAnswer) -> serde_json::Value {
    let wind = |wind: &ChangesWind| {
        let studies = wind
            .studies
            .iter()
            .map(|(folder, seed)| json!({ "folder": folder.display().to_string(), "seed": seed }));
        json!({
            "name": wind.name,
            "speed_m_s": wind.speed,
            "turbulence_intensity": wind.turbulence_intensity,
            "shear_exponent": wind.shear_exponent,
            "studies": studies.collect::<Vec<_>>(),
        })
    };
    let change = |(wind, change): (&ChangesWind, &Option<Change>)| {
        change.as_ref().map(|Change { together, each }| {
            json!({
                "wind": wind.name,
                "mean": together.mean,
                "half_width_95": together.half_width_95,
                "each": each,
            })
        })
    };
    let row = |row: &ChangesRow| {
        let (channel, slope, frequency) = match &row.quantity {
            Quantity::Power => (None, None, None),
            Quantity::Load { channel, slope, reference_frequency } => {
                (Some(channel), Some(slope), Some(reference_frequency))
            }
        };
        let changes = answer.winds.iter().zip(&row.changes).filter_map(change);
        json!({
            "run": row.run,
            "compare_with": row.compare_with,
            "quantity": if channel.is_some() { "damage-equivalent load" } else { "power" },
            "channel": channel,
            "slope": slope,
            "reference_frequency_hz": frequency,
            "part": row.part,
            "changes": changes.collect::<Vec<_>>(),
        })
    };
    json!({
        "case": answer.case,
        "winds": answer.winds.iter().map(wind).collect::<Vec<_>>(),
        "rows": answer.rows.iter().map(row).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::Statistic;

    fn answer() -> ChangesAnswer {
        let wind = |name: &str, n_seeds: u64| ChangesWind {
            name: name.to_owned(),
            speed: 10.0,
            turbulence_intensity: 0.06,
            shear_exponent: Some(0.2),
            studies: (1..=n_seeds).map(|seed| (format!("s{seed}").into(), seed)).collect(),
        };
        let change = |mean: f64, half_width_95: Option<f64>, n: usize| {
            let together = Statistic { mean, standard_deviation: 0.0, half_width_95, n_blocks: n };
            Some(Change { together, each: vec![mean; n] })
        };
        let row = |quantity, part: &str, changes| ChangesRow {
            run: "closed-loop".to_owned(),
            compare_with: "open-loop".to_owned(),
            quantity,
            part: part.to_owned(),
            changes,
        };
        let load = Quantity::Load {
            channel: "RootMyb1".to_owned(),
            slope: 10.0,
            reference_frequency: 1.0,
        };
        ChangesAnswer {
            case: "two".to_owned(),
            winds: vec![wind("shear 0.2", 1), wind("TI 6 %", 5)],
            rows: vec![
                row(
                    Quantity::Power,
                    "T1",
                    vec![change(-0.014, None, 1), change(0.003, Some(0.002), 5)],
                ),
                row(load, "all", vec![None, change(0.01, Some(0.04), 5)]),
            ],
            remarks: Vec::new(),
        }
    }

    #[test]
    fn each_quantity_has_a_line_and_each_wind_a_column() {
        let text = text(&answer(), 100);
        let lines: Vec<&str> = text.lines().collect();
        let cells = |line: &str| -> Vec<String> {
            line.split("  ").map(str::trim).filter(|c| !c.is_empty()).map(str::to_owned).collect()
        };
        assert_eq!(lines[0], "two: changes, %");
        assert_eq!(cells(lines[1]), ["run", "over", "change of", "shear 0.2", "TI 6 %"]);
        let expected = ["closed-loop", "open-loop", "power", "T1", "-1.40", "0.30 ± 0.20"];
        assert_eq!(cells(lines[2]), expected);
        assert_eq!(cells(lines[3])[2..], ["flapwise", "all", "–", "1.0 ± 4.0"]);
        assert!(text.contains("independent: TI 6 % (seeds 1, 2, 3, 4, 5)"), "{text}");
        assert!(text.contains("for 1 Hz and slope 10"), "{text}");
    }

    #[test]
    fn winds_are_told_to_be_several_by_how_many_values_count() {
        let mut answer = answer();
        // An even wind in two studies, whose seeds change nothing.
        answer.winds[0].studies.push(("s2".into(), 2));
        let said = convention(&answer);
        assert!(said.contains("independent: TI 6 % (seeds 1, 2, 3, 4, 5)\n"), "{said}");
        assert!(said.contains("in one wind"), "{said}");
        // Nothing is told of intervals that no change has.
        for row in &mut answer.rows {
            row.changes[0] = None;
        }
        assert!(!convention(&answer).contains("in one wind"));
        for row in &mut answer.rows {
            row.changes.remove(1);
        }
        answer.winds.remove(1);
        assert!(!convention(&answer).contains("Student"));
    }

    #[test]
    fn json_has_ratios_and_leaves_out_what_is_not_known() {
        let json = json(&answer());
        assert_eq!(json["winds"][1]["studies"].as_array().map(Vec::len), Some(5));
        assert_eq!(json["rows"][0]["changes"][0]["mean"], -0.014);
        assert_eq!(json["rows"][0]["channel"], serde_json::Value::Null);
        let load = &json["rows"][1];
        assert_eq!(load["changes"].as_array().map(Vec::len), Some(1));
        assert_eq!(load["changes"][0]["wind"], "TI 6 %");
        assert_eq!(load["changes"][0]["each"], json!(vec![0.01; 5]));
    }
}
