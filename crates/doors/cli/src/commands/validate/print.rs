//! What `wakemix validate` prints: the list, rows as a table, rows as JSON.

use super::Done;
use super::record::Made;
use validation::gate::{Finding, holds};
use validation::record::Verdict;
use validation::{Tolerance, VALIDATIONS, Validation};
use wakemix::report::text_table::{Column, TextTable};

/// All validations by name, in `width` columns.
pub(super) fn list(width: usize) -> String {
    let columns = [Column::number("minutes"), Column::words("what")];
    let mut table = TextTable::new([Column::words("name")], columns);
    for Validation { name, cost, about, .. } in VALIDATIONS {
        table.row([(*name).to_owned(), cost.to_string(), (*about).to_owned()]);
    }
    table.fitted(width)
}

/// The rows of a validation in `width` columns, how many are met, fall short, and are not as recorded, and on
/// what day and machine they were recorded and are made.
pub(super) fn table(done: &Done, width: usize) -> String {
    let Done { validation, record, judgements } = done;
    let columns = [
        Column::number("measured"),
        Column::number("expected"),
        Column::number("tolerance"),
        Column::words("unit"),
        Column::words("met"),
        Column::words("record"),
    ];
    let mut table = TextTable::new([Column::words("what")], columns);
    for row in judgements {
        let tolerance = match row.tolerance {
            Tolerance::Within(most) => format!("{most:.2e}"),
            Tolerance::AtMost => "at most".to_owned(),
            Tolerance::AtLeast => "at least".to_owned(),
        };
        let met = if row.verdict == Verdict::Met { "yes" } else { "NO" };
        let mut record = row.finding.words().to_owned();
        if let (Some(then), Finding::Worse) = (row.recorded, row.finding) {
            record.push_str(&format!(", then {then}"));
        }
        table.row([
            row.claim.clone(),
            format!("{:.6}", row.measured.unwrap_or(f64::NAN)),
            format!("{:.6}", row.expected),
            tolerance,
            row.unit.to_string(),
            met.to_owned(),
            record,
        ]);
    }
    let mut text = table.fitted(width);
    let short = judgements.iter().filter(|row| row.verdict == Verdict::Short).count();
    let other = judgements.iter().filter(|row| row.finding != Finding::AsRecorded).count();
    let name = validation.name;
    let n_rows = judgements.len();
    text += &format!("{name}: {n_rows} rows, {short} fall short, {other} not as recorded\n");
    text += &format!("recorded {}, {}\n", record.date, record.conditions);
    let Made { date, conditions } = Made::here();
    text + &format!("now made {date}, {conditions}\n")
}

/// All rows of all that was repeated, as one JSON object.
pub(super) fn json(done: &[Done]) -> String {
    let Made { date, conditions } = Made::here();
    let made = serde_json::json!({ "date": date, "conditions": conditions });
    let validations: Vec<_> = done
        .iter()
        .map(|Done { validation, record, judgements }| {
            serde_json::json!({
                "name": validation.name,
                "about": validation.about,
                "as_recorded": holds(judgements),
                "recorded": { "date": record.date, "conditions": record.conditions },
                "made": made,
                "rows": judgements,
            })
        })
        .collect();
    let all = done.iter().all(|done| holds(&done.judgements));
    format!("{:#}\n", serde_json::json!({ "as_recorded": all, "validations": validations }))
}
