//! Names, pages and records of the list agree.

use super::*;
use crate::Tolerance;
use crate::record::{Record, Verdict};
use std::collections::BTreeSet;

fn records() -> impl Iterator<Item = (&'static str, Record)> {
    let own = VALIDATIONS.iter().map(|validation| (validation.name, validation.recorded));
    let others = ELSEWHERE.iter().map(|elsewhere| (elsewhere.name, elsewhere.recorded));
    own.chain(others).map(|(name, text)| {
        (name, Record::parse(text).unwrap_or_else(|error| panic!("{name}: {error}")))
    })
}

#[test]
fn every_record_reads_and_names_its_rows_once() {
    for (name, record) in records() {
        let ids: BTreeSet<&str> = record.rows.iter().map(|row| row.id.as_str()).collect();
        assert_eq!(ids.len(), record.rows.len(), "{name}");
        assert_eq!(record.rows.is_empty(), record.conditions == "not recorded yet", "{name}");
        for row in &record.rows {
            // A figure that was not kept can only have been met.
            let met = row.measured.is_none_or(|m| row.tolerance.beyond(m, row.expected) == 0.0);
            let said = row.verdict == Verdict::Met;
            assert_eq!(met, said, "{name}, {}: figures and verdict differ", row.claim);
        }
    }
}

#[test]
fn every_record_holds_finite_figures_and_says_where_they_are_rounded() {
    for (name, record) in records() {
        for row in &record.rows {
            let figures = [row.measured.unwrap_or(0.0), row.expected];
            assert!(figures.iter().all(|figure| figure.is_finite()), "{name}, {}", row.claim);
        }
        let copied = record.conditions.contains("figures from docs/validation");
        assert_eq!(record.rounded, copied, "{name}");
    }
}

#[test]
fn no_effect_at_all_meets_no_claim_of_an_effect() {
    for (name, record) in records() {
        for row in &record.rows {
            let Tolerance::Within(most) = row.tolerance else { continue };
            // What is published as next to nothing is to be next to nothing here too: changes of a few
            // per cent within five points or one, and a hundredth of coherence.
            let small = match name {
                "meandering-disk" | "meandering-wake" => row.unit == "%" && most <= 5.0,
                "kaimal" => row.claim.contains("coherence") && row.expected.abs() < 0.01,
                _ => false,
            };
            let decides = row.expected == 0.0 || most < row.expected.abs() || small;
            assert!(decides, "{name}, {}: {} ± {most}", row.claim, row.expected);
        }
    }
}
