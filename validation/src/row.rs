//! One line of a validation: what was measured beside what was expected.

use serde::{Deserialize, Serialize};

/// How far a measured figure may lie from the expected one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tolerance {
    /// To either side, by at most this much, in the row's unit.
    Within(f64),
    /// Not above the expected figure.
    AtMost,
    /// Not below the expected figure.
    AtLeast,
}

impl Tolerance {
    /// How far `measured` lies beyond what is accepted around `expected`; zero where it is accepted, infinite
    /// for what is not a finite number, on whichever side of a limit.
    pub fn beyond(self, measured: f64, expected: f64) -> f64 {
        if !measured.is_finite() || expected.is_nan() {
            return f64::INFINITY;
        }
        let beyond = match self {
            Self::Within(most) => (measured - expected).abs() - most,
            Self::AtMost => measured - expected,
            Self::AtLeast => expected - measured,
        };
        // A tolerance that is not a number accepts nothing.
        if beyond.is_nan() { f64::INFINITY } else { beyond.max(0.0) }
    }

    /// What a small difference is measured against, in the row's unit: the tolerance itself, or the limit
    /// where there is one only.
    pub(crate) fn scale(self, expected: f64) -> f64 {
        match self {
            Self::Within(most) => most.abs(),
            Self::AtMost | Self::AtLeast => expected.abs(),
        }
    }
}

/// One measured figure with its expectation.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What was measured, with its conditions. It names the row, so no measured figure stands in it.
    pub what: String,
    /// Measured value, in `unit`.
    pub measured: f64,
    /// Expected value from an independent source, or the limit, in `unit`.
    pub expected: f64,
    /// What is accepted around `expected`.
    pub tolerance: Tolerance,
    /// Unit of all three.
    pub unit: &'static str,
    /// Where the expected value comes from.
    pub source: &'static str,
}

impl Row {
    /// Whether the measured figure is accepted; never for one that is not a finite number.
    pub fn passes(&self) -> bool {
        self.tolerance.beyond(self.measured, self.expected) == 0.0
    }

    /// Name of the row within its validation: `what` in lower case, with hyphens for all that is neither
    /// letter nor digit. A claim that is worded anew is a new row, and recorded as one.
    pub fn id(&self) -> String {
        let mut id = String::new();
        for letter in self.what.chars().flat_map(char::to_lowercase) {
            match letter {
                // A sign makes another claim, and so does a decimal point.
                '-' | '−' if id.is_empty() || id.ends_with('-') => id.push('m'),
                '+' => id.push_str("plus"),
                '.' => id.push('p'),
                '%' => id.push_str("pc"),
                letter if letter.is_alphanumeric() => id.push(letter),
                _ if !id.ends_with('-') => id.push('-'),
                _ => {}
            }
        }
        id.trim_matches('-').to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_accepted_is_distinguished_from_what_is_not() {
        use Tolerance::{AtLeast, AtMost, Within};
        assert_eq!(Within(0.5).beyond(1.5, 1.0), 0.0);
        assert_eq!(Within(0.5).beyond(0.25, 1.0), 0.25);
        assert_eq!(AtMost.beyond(-3.0, 1.0), 0.0);
        assert_eq!(AtMost.beyond(3.0, 1.0), 2.0);
        assert_eq!(AtLeast.beyond(3.0, 1.0), 0.0);
        assert_eq!(AtLeast.beyond(-1.0, 1.0), 2.0);
        for tolerance in [Within(1.0), AtMost, AtLeast] {
            for measured in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert_eq!(tolerance.beyond(measured, 1.0), f64::INFINITY);
            }
        }
        assert_eq!(Within(f64::NAN).beyond(1.0, 1.0), f64::INFINITY);
    }

    #[test]
    fn a_row_is_named_after_its_claim() {
        let named = |what: &str| {
            let (measured, expected, tolerance) = (1.0, 1.0, Tolerance::AtMost);
            Row { what: what.to_owned(), measured, expected, tolerance, unit: "–", source: "" }.id()
        };
        assert_eq!(named("nrel-5mw: tower fore-aft 1"), "nrel-5mw-tower-fore-aft-1");
        assert_eq!(named("T1 power, ccw 2°, St 0.25"), "t1-power-ccw-2-st-0p25");
        assert_ne!(named("array, 1P + f_e"), named("array, 1P − f_e"));
    }
}
