//! The letters of the figures: Noto Sans, whose licence (SIL Open Font License 1.1) travels with
//! the `notosans` package.

use ttf_parser::{GlyphId, OutlineBuilder};

/// One of the two faces.
pub(crate) struct Face {
    font: ttf_parser::Face<'static>,
}

impl Face {
    /// The regular or the bold face.
    pub(crate) fn new(bold: bool) -> Self {
        let bytes = if bold { notosans::BOLD_TTF } else { notosans::REGULAR_TTF };
        Self { font: ttf_parser::Face::parse(bytes, 0).expect("the embedded font is whole") }
    }

    /// Length of `content` in letters of `size`.
    pub(crate) fn width(&self, content: &str, size: f64) -> f64 {
        self.glyphs(content).map(|glyph| f64::from(self.advance(glyph, size))).sum()
    }

    fn glyphs(&self, content: &str) -> impl Iterator<Item = GlyphId> {
        content.chars().filter_map(move |letter| self.font.glyph_index(letter))
    }

    /// Way from the start of `glyph` to that of the next in letters of `size`, rounded as FreeType does: a
    /// scale in 65536ths of 64ths.
    fn advance(&self, glyph: GlyphId, size: f64) -> f32 {
        let units = u64::from(self.font.units_per_em());
        let scale = ((((64.0 * size) as u64) << 16) + units / 2) / units;
        let advance = u64::from(self.font.glyph_hor_advance(glyph).unwrap_or(0));
        ((scale * advance + 32) / 64) as f32 / 65536.0
    }

    /// Hands the outlines of `content` in letters of `size` to `pen`, from (0, 0) to the right, y
    /// upwards; `advance` tells the pen where each letter starts.
    pub(crate) fn outlines<P: OutlineBuilder>(
        &self,
        content: &str,
        size: f64,
        pen: &mut P,
        mut advance: impl FnMut(&mut P, f32),
    ) {
        let scale = size as f32 / f32::from(self.font.units_per_em());
        let mut start = 0.0;
        for glyph in self.glyphs(content) {
            advance(pen, start);
            // A letter without an outline leaves its space empty.
            self.font.outline_glyph(glyph, &mut Scaled { pen: &mut *pen, scale });
            start += self.advance(glyph, size);
        }
    }
}

/// A pen that is given the units of the font.
struct Scaled<'p, P> {
    pen: &'p mut P,
    scale: f32,
}

impl<P: OutlineBuilder> OutlineBuilder for Scaled<'_, P> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.pen.move_to(self.scale * x, self.scale * y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.pen.line_to(self.scale * x, self.scale * y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let [x1, y1, x, y] = [x1, y1, x, y].map(|place| self.scale * place);
        self.pen.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let [x1, y1, x2, y2, x, y] = [x1, y1, x2, y2, x, y].map(|place| self.scale * place);
        self.pen.curve_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.pen.close();
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
                assert!(face.font.glyph_index(letter).is_some(), "{letter} is missing");
            }
            assert!(face.width("mm", 12.0) > 2.0 * face.width("i", 12.0));
            assert!((face.width("power", 24.0) / face.width("power", 12.0) - 2.0).abs() < 0.01);
        }
    }
}
