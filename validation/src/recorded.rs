//! One claim as it was recorded, and whether a row of today claims the same and got worse.

use crate::row::{Row, Tolerance};
use serde::{Deserialize, Serialize};

/// Share by which figures of a recorded claim and of one of today may differ: what rounding to six digits
/// leaves, and no more.
const SAME: f64 = 1e-5;

/// Share of a recorded shortfall by which it may grow: a case gives the same bits on one kind of processor,
/// and another rounds in another order, which a turbulent flow makes visible. A tenth of a shortfall is no
/// new finding.
const GROWTH: f64 = 0.1;
/// The same for shortfalls next to nothing: share of the tolerance, or of the limit.
const LEAST_GROWTH: f64 = 0.01;

/// A row as it was recorded.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordedRow {
    /// Name within its validation, [`Row::id`].
    pub id: String,
    /// What was measured, with its conditions.
    pub claim: String,
    /// Measured value, in `unit`; none where a claim was met and the figure was not kept.
    pub measured: Option<f64>,
    /// Expected value or limit, in `unit`.
    pub expected: f64,
    /// What is accepted around `expected`.
    pub tolerance: Tolerance,
    /// Unit of all three.
    pub unit: String,
    /// Where the expected value comes from.
    pub source: String,
    /// Whether the claim was met.
    pub verdict: Verdict,
}

/// What came out for a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Accepted.
    Met,
    /// Not accepted: a shortfall.
    Short,
}

impl RecordedRow {
    /// `row` as it is today, to six digits.
    pub(crate) fn of(row: &Row) -> Self {
        let tolerance = match row.tolerance {
            Tolerance::Within(most) => Tolerance::Within(six_digits(most)),
            one_sided => one_sided,
        };
        Self {
            id: row.id(),
            claim: row.what.clone(),
            measured: Some(six_digits(row.measured)),
            expected: six_digits(row.expected),
            tolerance,
            unit: row.unit.to_owned(),
            source: row.source.to_owned(),
            verdict: if row.passes() { Verdict::Met } else { Verdict::Short },
        }
    }

    /// How far the recorded figure lies beyond what is accepted, in its unit; zero for a claim that was met.
    pub fn shortfall(&self) -> f64 {
        match (self.verdict, self.measured) {
            (Verdict::Short, Some(measured)) => self.tolerance.beyond(measured, self.expected),
            // Without a figure nothing may be shorter.
            (Verdict::Short, None) | (Verdict::Met, _) => 0.0,
        }
    }

    /// Whether `row` claims what was recorded, in the same unit, but for rounding.
    pub(crate) fn claims_as(&self, row: &Row) -> bool {
        let same = match (self.tolerance, row.tolerance) {
            (Tolerance::Within(then), Tolerance::Within(now)) => (now - then).abs() <= SAME * then,
            (then, now) => then == now,
        };
        same && self.expects_as(row)
    }

    /// Whether `row` expects the recorded figure in the recorded unit, but for rounding.
    pub(crate) fn expects_as(&self, row: &Row) -> bool {
        let room = SAME * (row.tolerance.scale(row.expected) + row.expected.abs());
        self.unit == row.unit && (self.expected - row.expected).abs() <= room
    }

    /// Whether `row` is short where this was met, or shorter than this or to the other side, where the
    /// recorded figure is right to within `rounding`.
    pub(crate) fn is_worse_now(&self, row: &Row, rounding: f64) -> bool {
        if row.passes() {
            return false;
        }
        let now = row.tolerance.beyond(row.measured, row.expected);
        let Some(then) = self.measured.filter(|_| self.verdict == Verdict::Short) else {
            return true;
        };
        // A shortfall has a side: as far off to the other one is another finding.
        let crossed = (row.measured < row.expected) != (then < self.expected);
        let growth = GROWTH * self.shortfall();
        let room = growth.max(LEAST_GROWTH * row.tolerance.scale(row.expected)) + rounding;
        // Nothing is as short as what was no number, or is none.
        crossed || !(now.is_finite() && now <= self.shortfall() + room)
    }

    /// Half a unit of the last digit of the measured figure, as it stands in a notebook.
    pub(crate) fn half_a_digit(&self) -> f64 {
        let Some(measured) = self.measured else { return 0.0 };
        let text = measured.to_string();
        // The file has one decimal at least; noughts at its end count for nothing.
        let decimals = text.split_once('.').map_or(1, |(_, decimals)| decimals.len());
        0.5 * 10.0_f64.powi(-(decimals as i32))
    }

    /// The claim with its figures, those of `now` behind.
    pub(crate) fn beside(&self, now: &Self) -> String {
        let Self { claim, expected, tolerance, unit, .. } = self;
        format!(
            "{claim}: {expected} {tolerance:?} {unit} before, {} {:?} {} now",
            now.expected, now.tolerance, now.unit
        )
    }

    /// The claim with what was measured and what came out, those of `now` behind.
    pub(crate) fn figures_beside(&self, now: &Self) -> String {
        let said = |row: &Self| {
            let figure = row.measured.map_or("a figure not kept".to_owned(), |m| m.to_string());
            format!("{figure}, {}", if row.verdict == Verdict::Met { "met" } else { "short" })
        };
        format!("{}: {} before, {} now", self.claim, said(self), said(now))
    }

    /// Whether `row` accepts what the record does not.
    pub(crate) fn is_stricter_than(&self, row: &Row) -> bool {
        match (self.tolerance, row.tolerance) {
            (Tolerance::Within(then), Tolerance::Within(now)) => now > then * (1.0 + SAME),
            (then, now) => then != now,
        }
    }
}

/// `value` to six significant digits.
fn six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
