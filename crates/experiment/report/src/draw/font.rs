//! The letters of the figures: Noto Sans, whose licence (SIL Open Font License 1.1) travels with
//! the `notosans` package.

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};

/// One of the two faces.
pub(crate) struct Face {
    font: FontRef<'static>,
}

impl Face {
    /// The regular or the bold face.
    pub(crate) fn new(bold: bool) -> Self {
        let bytes = if bold { notosans::BOLD_TTF } else { notosans::REGULAR_TTF };
        Self { font: FontRef::new(bytes).expect("the embedded font is whole") }
    }

    /// Length of `content` in letters of `size`.
    pub(crate) fn width(&self, content: &str, size: f64) -> f64 {
        let metrics = self.font.glyph_metrics(Size::new(size as f32), LocationRef::default());
        let charmap = self.font.charmap();
        content
            .chars()
            .filter_map(|letter| metrics.advance_width(charmap.map(letter)?))
            .map(f64::from)
            .sum()
    }

    /// Hands the outlines of `content` in letters of `size` to `pen`, from (0, 0) to the right, y
    /// upwards; `advance` tells the pen where each letter starts.
    pub(crate) fn outlines<P: OutlinePen>(
        &self,
        content: &str,
        size: f64,
        pen: &mut P,
        mut advance: impl FnMut(&mut P, f32),
    ) {
        let size = Size::new(size as f32);
        let metrics = self.font.glyph_metrics(size, LocationRef::default());
        let (charmap, glyphs) = (self.font.charmap(), self.font.outline_glyphs());
        let mut start = 0.0;
        for glyph in content.chars().filter_map(|letter| charmap.map(letter)) {
            advance(pen, start);
            if let Some(outline) = glyphs.get(glyph) {
                let settings = DrawSettings::unhinted(size, LocationRef::default());
                // A letter that cannot be drawn leaves its space empty.
                let _ = outline.draw(settings, pen);
            }
            start += metrics.advance_width(glyph).unwrap_or(0.0);
        }
    }
}

/// `items` joined by `separator`, in lines that are no longer than `width` in letters of `size`; an item that
/// is longer begins a line of its own and is broken between its words.
pub(crate) fn wrapped(
    items: &[String],
    separator: &str,
    face: &Face,
    size: f64,
    width: f64,
) -> Vec<String> {
    // Readers' own fonts may be wider than the one that is measured.
    let fits = |line: &str| 1.1 * face.width(line, size) <= width;
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for item in items {
        let mut between = separator;
        let whole = [item.as_str()];
        let words: Vec<&str> = item.split(' ').collect();
        let pieces: &[&str] = if fits(item) { &whole } else { &words };
        if pieces.len() > 1 && !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        for piece in pieces {
            let longer = format!("{line}{between}{piece}");
            if line.is_empty() {
                line = (*piece).to_owned();
            } else if fits(&longer) {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, (*piece).to_owned()));
            }
            between = " ";
        }
    }
    lines.extend((!line.is_empty()).then_some(line));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_items_and_long_items_between_words() {
        let face = Face::new(false);
        let items = ["9.0\u{a0}m/s", "TI 5 %", "a helix of which there is a lot to say"];
        let items = items.map(str::to_owned);
        let width = 1.1 * face.width("a helix of which there", 10.0) + 1.0;
        let lines = wrapped(&items, " · ", &face, 10.0, width);
        assert_eq!(lines[0], "9.0\u{a0}m/s · TI 5 %");
        assert_eq!(lines[1], "a helix of which there");
        assert!(lines.iter().all(|line| 1.1 * face.width(line, 10.0) <= width), "{lines:?}");
        assert_eq!(lines[1..].join(" "), items[2]);
        assert!(wrapped(&[], " · ", &face, 10.0, width).is_empty());
    }

    #[test]
    fn the_faces_hold_every_letter_of_the_figures() {
        for bold in [false, true] {
            let face = Face::new(bold);
            for letter in "azAZ09 °±−–·×∞Δσₑ%/,.()".chars() {
                assert!(face.font.charmap().map(letter).is_some(), "{letter} is missing");
            }
            assert!(face.width("mm", 12.0) > 2.0 * face.width("i", 12.0));
            assert!((face.width("power", 24.0) / face.width("power", 12.0) - 2.0).abs() < 0.01);
        }
    }
}
