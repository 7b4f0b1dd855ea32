//! Today's rows against the record: what is as recorded, what got worse, and what is better than the record
//! says.

use crate::record::{Record, RecordedRow, Verdict};
use crate::row::{Row, Tolerance};
use serde::Serialize;

/// What a row is beside its record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// Met as recorded, or as short as recorded.
    AsRecorded,
    /// Recorded as met and short now, shorter than recorded, or short to the other side.
    Worse,
    /// Recorded as short and met now: the record is to be renewed.
    ShortfallGone,
    /// Expected value, tolerance or unit are others than the recorded ones.
    ClaimChanged,
    /// The record knows nothing of it.
    NotRecorded,
    /// The record knows it, and it was not measured.
    Missing,
}

impl Finding {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::AsRecorded => "as recorded",
            Self::Worse => "WORSE",
            Self::ShortfallGone => "SHORTFALL GONE",
            Self::ClaimChanged => "CLAIM CHANGED",
            Self::NotRecorded => "NOT RECORDED",
            Self::Missing => "MISSING",
        }
    }
}

/// What kind of figure was measured, of which data in JSON show nothing where it is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Figure {
    /// A finite number.
    Finite,
    /// Infinite, above all numbers.
    PlusInfinite,
    /// Infinite, below all numbers.
    MinusInfinite,
    /// Not a number.
    NotANumber,
    /// The row was not measured.
    NotMeasured,
}

impl Figure {
    fn of(measured: f64) -> Self {
        match measured {
            _ if measured.is_nan() => Self::NotANumber,
            f64::INFINITY => Self::PlusInfinite,
            f64::NEG_INFINITY => Self::MinusInfinite,
            _ => Self::Finite,
        }
    }
}

/// A row beside its record, as data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judgement {
    /// Name of the row within its validation.
    pub id: String,
    /// What was measured, with its conditions.
    pub claim: String,
    /// Measured value, in `unit`; none where nothing was measured.
    pub measured: Option<f64>,
    /// What kind of figure that is.
    pub figure: Figure,
    /// Expected value or limit, in `unit`.
    pub expected: f64,
    /// What is accepted around `expected`.
    pub tolerance: Tolerance,
    /// Unit of all three.
    pub unit: String,
    /// Where the expected value comes from.
    pub source: String,
    /// Whether the claim is met now.
    pub verdict: Verdict,
    /// Whether it was met when it was recorded.
    pub recorded_verdict: Option<Verdict>,
    /// What was measured when it was recorded, in `unit`.
    pub recorded: Option<f64>,
    /// Both together.
    pub finding: Finding,
}

/// Each of `rows` beside `record`, then what the record has and they have not.
pub fn judge(rows: &[Row], record: &Record) -> Vec<Judgement> {
    let mut judgements: Vec<Judgement> = Vec::new();
    for row in rows {
        let id = row.id();
        // A second row of the same name has no record of its own.
        let first = judgements.iter().all(|judgement| judgement.id != id);
        let recorded = record.row(&id).filter(|_| first);
        judgements.push(Judgement {
            id,
            claim: row.what.clone(),
            measured: Some(row.measured),
            figure: Figure::of(row.measured),
            expected: row.expected,
            tolerance: row.tolerance,
            unit: row.unit.to_owned(),
            source: row.source.to_owned(),
            verdict: if row.passes() { Verdict::Met } else { Verdict::Short },
            recorded_verdict: recorded.map(|recorded| recorded.verdict),
            recorded: recorded.and_then(|recorded| recorded.measured),
            finding: recorded
                .map_or(Finding::NotRecorded, |recorded| beside(row, recorded, record)),
        });
    }
    for recorded in &record.rows {
        if judgements.iter().all(|judgement| judgement.id != recorded.id) {
            judgements.push(missing(recorded));
        }
    }
    judgements
}

/// Whether all is as recorded.
pub fn holds(judgements: &[Judgement]) -> bool {
    judgements.iter().all(|judgement| judgement.finding == Finding::AsRecorded)
}

fn beside(row: &Row, recorded: &RecordedRow, record: &Record) -> Finding {
    if !recorded.claims_as(row) {
        return Finding::ClaimChanged;
    }
    match (recorded.verdict, row.passes()) {
        (Verdict::Short, true) => Finding::ShortfallGone,
        _ if record.is_worse(row, recorded) => Finding::Worse,
        _ => Finding::AsRecorded,
    }
}

fn missing(recorded: &RecordedRow) -> Judgement {
    Judgement {
        id: recorded.id.clone(),
        claim: recorded.claim.clone(),
        measured: None,
        figure: Figure::NotMeasured,
        expected: recorded.expected,
        tolerance: recorded.tolerance,
        unit: recorded.unit.clone(),
        source: recorded.source.clone(),
        verdict: Verdict::Short,
        recorded_verdict: Some(recorded.verdict),
        recorded: recorded.measured,
        finding: Finding::Missing,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Worse;
    use crate::row::Tolerance::{AtLeast, AtMost, Within};

    fn row(what: &str, measured: f64, expected: f64, tolerance: Tolerance) -> Row {
        Row { what: what.to_owned(), measured, expected, tolerance, unit: "%", source: "made up" }
    }

    fn recorded(rows: &[Row]) -> Record {
        Record::default().renewed(rows, "2026-11-22", "made up", Worse::Refused).unwrap()
    }

    fn findings(then: &[Row], now: &[Row]) -> Vec<Finding> {
        judge(now, &recorded(then)).iter().map(|judgement| judgement.finding).collect()
    }

    #[test]
    fn met_short_worse_and_vanished_rows_are_distinguished() {
        let claim = |what: &str, measured: f64| row(what, measured, 1.0, Within(0.1));
        let then =
            [claim("met", 1.05), claim("short", 1.5), claim("worse", 1.05), claim("gone", 2.0)];
        let now =
            [claim("met", 0.95), claim("short", 1.52), claim("worse", 1.2), claim("gone", 1.0)];
        assert_eq!(
            findings(&then, &now),
            [Finding::AsRecorded, Finding::AsRecorded, Finding::Worse, Finding::ShortfallGone]
        );
        assert!(holds(&judge(&now[..2], &recorded(&then[..2]))));
        for place in 2..4 {
            let (then, now) = (&then[place..=place], &now[place..=place]);
            assert!(!holds(&judge(now, &recorded(then))));
        }
    }

    #[test]
    fn a_shortfall_may_grow_by_a_tenth_and_no_more() {
        let then = [row("short", 3.0, 1.0, AtMost)];
        for (measured, finding) in
            [(3.19, Finding::AsRecorded), (3.21, Finding::Worse), (f64::NAN, Finding::Worse)]
        {
            assert_eq!(findings(&then, &[row("short", measured, 1.0, AtMost)]), [finding]);
        }
        // Next to nothing: a hundredth of the tolerance.
        let then = [row("short", 1.1001, 1.0, Within(0.1))];
        assert_eq!(
            findings(&then, &[row("short", 1.1009, 1.0, Within(0.1))]),
            [Finding::AsRecorded]
        );
        assert_eq!(findings(&then, &[row("short", 1.1013, 1.0, Within(0.1))]), [Finding::Worse]);
    }

    #[test]
    fn other_claims_other_rows_and_lost_rows_do_not_pass() {
        let then = [row("one", 1.0, 1.0, Within(0.1)), row("two", 1.0, 1.0, AtMost)];
        let now = [row("one", 1.0, 1.0, Within(0.2)), row("three", 1.0, 1.0, AtMost)];
        assert_eq!(
            findings(&then, &now),
            [Finding::ClaimChanged, Finding::NotRecorded, Finding::Missing]
        );
        let tighter = [row("one", 1.0, 1.0, Within(0.05))];
        assert_eq!(findings(&then[..1], &tighter), [Finding::ClaimChanged]);
        let twice = [then[1].clone(), then[1].clone()];
        assert_eq!(findings(&then[1..], &twice), [Finding::AsRecorded, Finding::NotRecorded]);
    }

    #[test]
    fn a_shortfall_to_the_other_side_is_worse() {
        let then = [row("short", 1.5, 1.0, Within(0.1))];
        for (measured, finding) in [
            (1.5, Finding::AsRecorded),
            (0.5, Finding::Worse),
            (0.85, Finding::Worse),
            (0.95, Finding::ShortfallGone),
        ] {
            assert_eq!(findings(&then, &[row("short", measured, 1.0, Within(0.1))]), [finding]);
        }
    }

    #[test]
    fn what_is_not_finite_is_worse_whatever_was_recorded() {
        let infinite = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
        for tolerance in [Within(0.1), AtMost, AtLeast] {
            for then in [1.0, 1.5, 0.5] {
                let then = row("claim", then, 1.0, tolerance);
                for measured in infinite {
                    let now = row("claim", measured, 1.0, tolerance);
                    assert!(!now.passes());
                    assert_eq!(findings(std::slice::from_ref(&then), &[now]), [Finding::Worse]);
                }
            }
            // A record that holds such a figure, by hand, lets nothing pass beside it.
            let mut record = recorded(&[row("claim", 1.0, 1.0, tolerance)]);
            for measured in infinite {
                (record.rows[0].measured, record.rows[0].verdict) =
                    (Some(measured), Verdict::Short);
                let judged = judge(&[row("claim", measured, 1.0, tolerance)], &record);
                assert_eq!(judged[0].finding, Finding::Worse);
            }
        }
    }

    #[test]
    fn a_figure_from_a_notebook_is_right_to_half_its_last_digit() {
        let claim = |measured: f64| row("share", measured, 1.0, Within(0.02));
        for (rounded, measured, finding) in [
            // 1.03 for 1.0349: the shortfall of 0.01 is one of 0.0149.
            (true, 1.0349, Finding::AsRecorded),
            (false, 1.0349, Finding::Worse),
            (true, 1.0365, Finding::Worse),
            (true, 0.9651, Finding::Worse),
        ] {
            let record = Record { rounded, ..recorded(&[claim(1.03)]) };
            assert_eq!(judge(&[claim(measured)], &record)[0].finding, finding, "{measured}");
        }
        // Met is met: the digits that were left out make no room there.
        let record = Record { rounded: true, ..recorded(&[claim(1.019)]) };
        assert_eq!(judge(&[claim(1.021)], &record)[0].finding, Finding::Worse);
    }

    #[test]
    fn a_claim_in_another_unit_is_another_claim() {
        let then = [row("lift", 1.0, 1.0, Within(0.1))];
        let now = Row { unit: "kN", ..then[0].clone() };
        assert_eq!(findings(&then, &[now]), [Finding::ClaimChanged]);
        // As much more as rounding never is.
        let wider = row("lift", 1.0, 1.0, Within(0.1005));
        assert_eq!(findings(&then, &[wider]), [Finding::ClaimChanged]);
    }

    #[test]
    fn data_tell_what_kind_of_figure_was_measured() {
        let then = [row("one", 1.0, 1.0, AtMost), row("lost", 1.0, 1.0, AtMost)];
        for (measured, figure) in [
            (1.0, Figure::Finite),
            (f64::INFINITY, Figure::PlusInfinite),
            (f64::NEG_INFINITY, Figure::MinusInfinite),
            (f64::NAN, Figure::NotANumber),
        ] {
            let judged = judge(&[row("one", measured, 1.0, AtMost)], &recorded(&then));
            assert_eq!([judged[0].figure, judged[1].figure], [figure, Figure::NotMeasured]);
        }
    }
}
