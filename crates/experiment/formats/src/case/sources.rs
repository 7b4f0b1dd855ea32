//! The texts of a case, file and overrides: where a problem stands.

use miette::NamedSource;
use std::ops::Range;
use std::sync::Arc;

/// The case file and the overrides, laid end to end, so that one number tells file and place.
#[derive(Debug)]
pub(super) struct Sources {
    parts: Vec<(usize, Arc<NamedSource<String>>)>,
    end: usize,
}

impl Sources {
    pub(super) fn new() -> Self {
        Self { parts: Vec::new(), end: 0 }
    }

    /// Adds a text; gives the place of its first byte.
    pub(super) fn add(&mut self, name: &str, text: &str) -> usize {
        let start = self.end;
        self.parts.push((start, Arc::new(NamedSource::new(name, drawable(text)))));
        // One byte apart, so that the end of one text is not the start of the next.
        self.end = start + text.len() + 1;
        start
    }

    /// The text that holds `span`, and the span in it.
    pub(super) fn locate(&self, span: Range<usize>) -> (Arc<NamedSource<String>>, Range<usize>) {
        let part = self.parts.iter().rev().find(|(start, _)| *start <= span.start);
        let (start, source) = part.unwrap_or(&self.parts[0]);
        let length = source.inner().len();
        let within = |place: usize| place.saturating_sub(*start).min(length);
        (Arc::clone(source), within(span.start)..within(span.end))
    }
}

/// `text` with marks of the same length in the place of characters that would steer the terminal which draws
/// it.
fn drawable(text: &str) -> String {
    let mark = |c: char| match c {
        '\n' | '\t' => c,
        '\r' => ' ',
        c if c.is_control() && c.len_utf8() == 1 => '?',
        c if c.is_control() => '¿',
        c => c,
    };
    text.chars().map(mark).collect()
}
