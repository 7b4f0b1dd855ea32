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

#[cfg(test)]
mod tests {
    use super::*;

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
