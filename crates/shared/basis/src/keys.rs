//! Keys that a person may write: what a table of a case file is made of, as data that reader, reference and
//! schema share.

mod range;

pub use range::Range;

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

impl Table {
    /// The name of today of the key that was called `name` in earlier versions.
    pub fn renamed(&self, name: &str) -> Option<&'static str> {
        self.keys.iter().find(|key| key.former_names.contains(&name)).map(|key| key.name)
    }
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
    /// Its names in earlier versions, which are refused with its name of today.
    pub former_names: &'static [&'static str],
}

/// What a key may hold.
#[derive(Clone, Copy, Debug)]
pub enum Holds {
    /// Any text.
    Text,
    /// Letters, digits, `-` and `_`: it names folders, channels and keys.
    Name,
    /// The same, and `.` inside: it names folders alone.
    Folder,
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
    /// A file, or a table for each of several files.
    Files(&'static Table),
    /// A table whose key `kind` says which keys it has.
    Event,
    /// A table for each turbine that does more than baseline, by the turbine's name.
    Control,
    /// A table for each further sensor, by the sensor's name.
    Sensors,
    /// A table whose keys are those of what moves the air, and some more.
    Flow,
    /// A table for each further output, by the output's name.
    Outputs,
    /// A list of values for each of any keys of the file.
    Sweep,
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
    /// Factor to the right unit (–).
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
    Key { name, holds, unit, left_out, about, slips: &[], former_names: &[] }
}

impl Holds {
    /// Whether the key may hold `value`.
    pub fn accepts(&self, value: &Value) -> bool {
        match (self, value) {
            (Self::Number(range), Value::Number(number)) => range.contains(*number),
            (Self::Number(range), Value::Whole(number)) => range.contains(*number as f64),
            (Self::Whole { least, most }, Value::Whole(number)) => (least..=most).contains(&number),
            (Self::Choice(words), Value::Text(word)) => words.contains(&word.as_str()),
            (
                Self::Text | Self::Name | Self::Folder | Self::Model | Self::Files(_),
                Value::Text(_),
            ) => true,
            (Self::Numbers(range), Value::Numbers(numbers)) => {
                numbers.iter().all(|number| range.contains(*number))
            }
            (Self::Pair(range), Value::Numbers(numbers)) => {
                numbers.len() == 2 && numbers.iter().all(|number| range.contains(*number))
            }
            (Self::Turbines, Value::Names(_)) => true,
            (Self::Ground(_), Value::Text(word)) => word == "slip",
            (Self::Ground(table) | Self::Table(table), Value::Table(values)) => {
                let knows = |name: &str| table.keys.iter().find(|key| key.name == name);
                values
                    .iter()
                    .all(|(name, value)| knows(name).is_some_and(|k| k.holds.accepts(value)))
            }
            (Self::Tables(table) | Self::Files(table), Value::Tables(tables)) => tables
                .iter()
                .all(|values| Self::Table(table).accepts(&Value::Table(values.clone()))),
            _ => false,
        }
    }
}

impl Key {
    /// The key with what holds when it is left out; none where that is nothing that could stand in the file.
    pub fn default(&self) -> Option<(&'static str, Value)> {
        let LeftOut::Value(text) = self.left_out else { return None };
        let value = match self.holds {
            Holds::Number(_) => Value::Number(text.parse().ok()?),
            Holds::Whole { .. } => Value::Whole(text.parse().ok()?),
            Holds::Choice(_)
            | Holds::Text
            | Holds::Name
            | Holds::Folder
            | Holds::Model
            | Holds::Files(_)
            | Holds::Ground(_) => Value::Text(text.trim_matches('"').to_owned()),
            Holds::Numbers(_) | Holds::Pair(_) => {
                let numbers = items_of(text).map(str::parse).collect::<Result<_, _>>();
                Value::Numbers(numbers.ok()?)
            }
            Holds::Turbines => {
                Value::Names(items_of(text).map(|name| name.trim_matches('"').to_owned()).collect())
            }
            _ => return None,
        };
        Some((self.name, value))
    }

    /// The same key, with the units that people mistake for its own.
    pub const fn mistaken(mut self, slips: &'static [Slip]) -> Self {
        self.slips = slips;
        self
    }

    /// The same key, with its names in earlier versions.
    pub const fn formerly(mut self, names: &'static [&'static str]) -> Self {
        self.former_names = names;
        self
    }
}

/// The items of a list as it would stand in the file, such as `[2.0, 4.0]`.
fn items_of(list: &str) -> impl Iterator<Item = &str> {
    list.trim_matches(['[', ']']).split(',').map(str::trim).filter(|item| !item.is_empty())
}

/// What one key of a table holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, in the key's unit.
    Number(f64),
    /// A whole number.
    Whole(u64),
    /// A text or one of some words.
    Text(String),
    /// Several numbers, in the key's unit.
    Numbers(Vec<f64>),
    /// Several names.
    Names(Vec<String>),
    /// What the keys of a table hold.
    Table(Values),
    /// What the keys of each of several tables under one heading hold.
    Tables(Vec<Values>),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<u64> for Value {
    fn from(number: u64) -> Self {
        Self::Whole(number)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<Vec<f64>> for Value {
    fn from(numbers: Vec<f64>) -> Self {
        Self::Numbers(numbers)
    }
}

impl From<Values> for Value {
    fn from(values: Values) -> Self {
        Self::Table(values)
    }
}

/// What the keys of one table hold, those that are given or have a default; in the units of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(Vec<(&'static str, Value)>);

impl Values {
    /// Nothing.
    pub const fn none() -> Self {
        Self(Vec::new())
    }

    /// The defaults of `keys`, of those that have one.
    pub fn defaults(keys: &[Key]) -> Self {
        Self(keys.iter().filter_map(Key::default).collect())
    }

    /// Puts `value` under `key`, in the place of what was there.
    pub fn set(&mut self, key: &'static str, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(name, _)| *name == key) {
            Some((_, old)) => *old = value,
            None => self.0.push((key, value)),
        }
    }

    /// Puts each of `values` under its key.
    pub fn extend(&mut self, values: impl IntoIterator<Item = (&'static str, Value)>) {
        for (key, value) in values {
            self.set(key, value);
        }
    }

    /// What stands under `key`.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|(name, _)| *name == key).map(|(_, value)| value)
    }

    /// Whether there is anything under `key`.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    /// The number under `key`, in the key's unit.
    pub fn optional_number(&self, key: &str) -> Option<f64> {
        match self.get(key)? {
            Value::Number(number) => Some(*number),
            Value::Whole(number) => Some(*number as f64),
            _ => None,
        }
    }

    /// The number under `key`, in the key's unit; not a number when there is none.
    pub fn number(&self, key: &str) -> f64 {
        self.optional_number(key).unwrap_or(f64::NAN)
    }

    /// The angle under `key`, which is in degrees (rad).
    pub fn angle(&self, key: &str) -> f64 {
        self.number(key).to_radians()
    }

    /// The text or word under `key`; empty when there is none.
    pub fn word(&self, key: &str) -> &str {
        match self.get(key) {
            Some(Value::Text(text)) => text,
            _ => "",
        }
    }

    /// The numbers under `key`, in the key's unit; none when there are none.
    pub fn numbers(&self, key: &str) -> &[f64] {
        match self.get(key) {
            Some(Value::Numbers(numbers)) => numbers,
            _ => &[],
        }
    }

    /// The names under `key`; none when there are none.
    pub fn names(&self, key: &str) -> &[String] {
        match self.get(key) {
            Some(Value::Names(names)) => names,
            _ => &[],
        }
    }

    /// The table under `key`.
    pub fn table(&self, key: &str) -> Option<&Values> {
        match self.get(key) {
            Some(Value::Table(values)) => Some(values),
            _ => None,
        }
    }

    /// The tables under `key`, in the order of the file; none when there are none.
    pub fn tables(&self, key: &str) -> &[Values] {
        match self.get(key) {
            Some(Value::Tables(tables)) => tables,
            _ => &[],
        }
    }

    /// The same in the order of the keys of `table`.
    pub fn in_order_of(mut self, table: &Table) -> Self {
        self.0.sort_by_key(|(name, _)| table.keys.iter().position(|key| key.name == *name));
        self
    }

    /// Keys with what they hold, in the order in which they were set.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(key, value)| (*key, value))
    }
}

/// Something about the values of a table that cannot be, beyond what its keys say one by one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Objection {
    /// Key that it is about; none where it is about the whole table.
    pub key: Option<&'static str>,
    /// What is wrong, lower case, no full stop; where there is a key, what follows after its name.
    pub message: String,
    /// A word or two at the very place, such as "too late".
    pub label: &'static str,
    /// How to fix it.
    pub fix: String,
}

#[cfg(test)]
mod tests;
