//! Ranges of numbers.

/// Numbers from `low` to `high`, `high` included, `low` only when not `open`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end (in the key's unit).
    pub low: f64,
    /// Whether the lower end itself is out.
    pub open: bool,
    /// Upper end (in the key's unit).
    pub high: f64,
}

impl Range {
    /// Whether `value` is in it; what is not a number never is.
    pub fn contains(&self, value: f64) -> bool {
        value <= self.high && if self.open { value > self.low } else { value >= self.low }
    }

    /// In words, such as `0 < speed <= 40 m/s`.
    pub fn describe(&self, name: &str, unit: &str) -> String {
        let sign = if self.open { "<" } else { "<=" };
        let unit = if unit == "–" { String::new() } else { format!(" {unit}") };
        format!("{} {sign} {name} <= {}{unit}", self.low, self.high)
    }
}
