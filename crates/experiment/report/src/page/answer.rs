//! The page of an answer of the desk.

use super::{drawing, filled};
use crate::ReportError;
use crate::answer::{AnswerRecords, AnswerTable};
use crate::draw::Figure;
use crate::words;
use minijinja::{Value, context};

const TEMPLATE: &str = include_str!("answer.html");

/// The page of `records` with `figures`.
pub(crate) fn render(records: &AnswerRecords, figures: &[Figure]) -> Result<String, ReportError> {
    let drawings = figures.iter().map(drawing).collect::<Result<Vec<_>, _>>()?;
    let warnings = records.warnings.iter().map(|warning| words::capitalised(warning));
    let own = context! {
        title => records.name.clone(),
        kind => records.kind.clone(),
        version => records.version.clone(),
        headline => records.headline.clone(),
        warnings => warnings.collect::<Vec<_>>(),
        facts => records.facts.clone(),
        tables => records.tables.iter().map(table).collect::<Vec<_>>(),
        figures => drawings,
        file => records.file.clone(),
    };
    filled("answer.html", TEMPLATE, own)
}

fn table(table: &AnswerTable) -> Value {
    let AnswerTable { caption, headings, rows } = table;
    context! { caption, headings, rows }
}
