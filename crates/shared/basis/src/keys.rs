//! Keys that a person may write: what a table of a case file is made of, as data that reader, reference and schema share.

/// One table of the case file.
#[derive(Debug)]
pub struct Table {
    /// Heading in the file, such as `[wind]`.
    pub heading: &'static str,
    /// What it is about, in a sentence.
    pub about: &'static str,
    /// Its keys, in the order in which they are written.
    pub keys: &'static [Key],
}

/// One key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name in the file.
    pub name: &'static str,
    /// What it may hold.
    pub holds: Holds,
    /// Unit of a number, `–` without one.
    pub unit: &'static str,
    /// What holds without it.
    pub left_out: LeftOut,
    /// What it means.
    pub about: &'static str,
    /// Units that people mistake for the right one, with the factor to the right one.
    pub slips: &'static [Slip],
}

/// What a key may hold.
#[derive(Clone, Copy, Debug)]
pub enum Holds {
    /// Any text.
    Text,
    /// Letters, digits, `-` and `_`: it names folders, channels and keys.
    Name,
    /// A turbine of the library, or a file.
    Model,
    /// A number in a range.
    Number(Range),
    /// A whole number in a range, ends included.
    Whole {
        /// Least.
        least: u64,
        /// Greatest.
        most: u64,
    },
    /// One of some words.
    Choice(&'static [&'static str]),
    /// Two numbers in a range.
    Pair(Range),
    /// Any count of numbers in a range.
    Numbers(Range),
    /// Any count of names of turbines of the layout.
    Turbines,
    /// `"slip"` or a table with a roughness length.
    Ground(&'static Table),
    /// One table.
    Table(&'static Table),
    /// One table or more under the same heading.
    Tables(&'static Table),
    /// A table whose key `kind` says which keys it has.
    Event,
    /// A table for each turbine that does more than baseline, by the turbine's name.
    Control,
}

/// Numbers from `low` to `high`, `high` included, `low` only when not `open`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower end.
    pub low: f64,
    /// Whether the lower end itself is out.
    pub open: bool,
    /// Upper end.
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

/// What holds when a key is left out.
#[derive(Clone, Copy, Debug)]
pub enum LeftOut {
    /// It cannot be left out.
    Required,
    /// This value, as it would stand in the file.
    Value(&'static str),
    /// This happens.
    Otherwise(&'static str),
}

/// A mistaken unit.
#[derive(Debug)]
pub struct Slip {
    /// The mistaken unit.
    pub unit: &'static str,
    /// Factor to the right one.
    pub factor: f64,
}

/// A number above `low`, up to `high`.
pub const fn above(low: f64, high: f64) -> Holds {
    Holds::Number(Range { low, open: true, high })
}

/// A number from `low` to `high`.
pub const fn from(low: f64, high: f64) -> Holds {
    Holds::Number(Range { low, open: false, high })
}

/// A key without a unit that people mistake for its own.
pub const fn key(
    name: &'static str,
    holds: Holds,
    unit: &'static str,
    left_out: LeftOut,
    about: &'static str,
) -> Key {
    Key { name, holds, unit, left_out, about, slips: &[] }
}

impl Key {
    /// The same key, with the units that people mistake for its own.
    pub const fn mistaken(mut self, slips: &'static [Slip]) -> Self {
        self.slips = slips;
        self
    }
}
