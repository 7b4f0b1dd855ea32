//! What `wakemix validate` prints: the list, rows as a table, rows as JSON.

use super::Done;
use super::record::Made;
use validation::gate::{Finding, holds};
use validation::record::Verdict;
use validation::{Tolerance, VALIDATIONS};

/// All validations by name.
pub(super) fn list() {
    println!("{:<20} {:>8}  what", "name", "minutes");
    for validation in VALIDATIONS {
        println!("{:<20} {:>8}  {}", validation.name, validation.cost, validation.about);
    }
}

/// The rows of a validation, how many are met, fall short, and are not as recorded, and on what day and
/// machine they were recorded and are made.
pub(super) fn table(done: &Done) {
    let Done { validation, record, judgements } = done;
    println!(
        "{:<64} {:>12} {:>12} {:>10} {:<6} {:<5} record",
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
        println!(
            "{:<64} {measured:>12.6} {:>12.6} {tolerance:>10} {:<6} {met:<5} {record}",
            row.claim, row.expected, row.unit
        );
    }
    let short = judgements.iter().filter(|row| row.verdict == Verdict::Short).count();
    let other = judgements.iter().filter(|row| row.finding != Finding::AsRecorded).count();
    let name = validation.name;
    println!("{name}: {} rows, {short} fall short, {other} not as recorded", judgements.len());
    let Made { date, conditions } = Made::here();
    println!("recorded {}, {}", record.date, record.conditions);
    println!("now made {date}, {conditions}");
}

/// All rows of all that was repeated, as one JSON object.
pub(super) fn json(done: &[Done]) {
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
    println!("{:#}", serde_json::json!({ "as_recorded": all, "validations": validations }));
}
