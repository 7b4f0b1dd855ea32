//! What `wakemix validate` prints: the list, rows as a table, rows as JSON.

use super::Done;
use super::record::Made;
use validation::gate::{Finding, holds};
use validation::record::Verdict;
use validation::{Tolerance, VALIDATIONS, Validation};

/// All validations by name.
pub(super) fn list() -> String {
    let mut text = format!("{:<20} {:>8}  what\n", "name", "minutes");
    for Validation { name, cost, about, .. } in VALIDATIONS {
        text += &format!("{name:<20} {cost:>8}  {about}\n");
    }
    text
}

/// The rows of a validation, how many are met, fall short, and are not as recorded, and on what day and
/// machine they were recorded and are made.
pub(super) fn table(done: &Done) -> String {
    let Done { validation, record, judgements } = done;
    let mut text = format!(
        "{:<64} {:>12} {:>12} {:>10} {:<6} {:<5} record\n",
        "what", "measured", "expected", "tolerance", "unit", "met"
    );
    for row in judgements {
        let tolerance = match row.tolerance {
            Tolerance::Within(most) => format!("{most:.2e}"),
            Tolerance::AtMost => "at most".to_owned(),
            Tolerance::AtLeast => "at least".to_owned(),
        };
        let measured = row.measured.unwrap_or(f64::NAN);
        let met = if row.verdict == Verdict::Met { "yes" } else { "NO" };
        let mut record = row.finding.words().to_owned();
        if let (Some(then), Finding::Worse) = (row.recorded, row.finding) {
            record.push_str(&format!(", then {then}"));
        }
        text += &format!(
            "{:<64} {measured:>12.6} {:>12.6} {tolerance:>10} {:<6} {met:<5} {record}\n",
            row.claim, row.expected, row.unit
        );
    }
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
