//! What there is to tell of an answer of the desk: a model, a controller, a surrogate.

use crate::Signals;

/// Everything that the page of an answer tells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnswerRecords {
    /// What kind of answer it is, in a word or two.
    pub kind: String,
    /// Its name.
    pub name: String,
    /// What came out, in a sentence.
    pub headline: String,
    /// What a reader of the numbers must know.
    pub warnings: Vec<String>,
    /// Facts: what it is, value with unit, remark.
    pub facts: Vec<[String; 3]>,
    /// Tables of numbers.
    pub tables: Vec<AnswerTable>,
    /// Figures.
    pub signals: Vec<Signals>,
    /// The file that came of it, with its name; none where there is none to show.
    pub file: Option<[String; 2]>,
    /// Version of the program that made it.
    pub version: String,
}

/// A table of numbers, each row with its name in front.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnswerTable {
    /// What it tells, in a sentence.
    pub caption: String,
    /// Headings: of the names, then of the numbers with their units.
    pub headings: Vec<String>,
    /// Name and numbers of each row, as many as headings.
    pub rows: Vec<Vec<String>>,
}
