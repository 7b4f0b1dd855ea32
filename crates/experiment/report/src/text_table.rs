//! Tables of text that fit a terminal: what has no room beside the rest stands in a further table below.

/// Columns that text for people takes where no terminal says less (–).
pub const WIDTH: usize = 100;
/// Fewest columns that a table is laid out for (–).
const LEAST_WIDTH: usize = 40;
/// What stands between two columns.
const GAP: &str = "  ";

/// A column of a [`TextTable`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    heading: String,
    is_words: bool,
    begins: bool,
}

impl Column {
    /// Words under `heading`, which wrap where there is little room.
    pub fn words(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), is_words: true, begins: false }
    }

    /// Numbers under `heading`, which stay in one piece.
    pub fn number(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), is_words: false, begins: false }
    }

    /// The same, in a further table with the columns behind it.
    pub fn in_new_table(self) -> Self {
        Self { begins: true, ..self }
    }
}

/// Rows of cells under headings.
///
/// ```
/// use report::text_table::{Column, TextTable};
///
/// let mut table = TextTable::new([Column::words("turbine")], [Column::number("power kW")]);
/// table.row(["T1", "9862 ± 4395"]);
/// assert_eq!(table.fitted(100), "turbine     power kW\nT1       9862 ± 4395\n");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextTable {
    n_keys: usize,
    columns: Vec<Column>,
    rows: Vec<Vec<String>>,
}

impl TextTable {
    /// A table without rows; `keys` stand in front of `columns`, in every further table again.
    pub fn new(
        keys: impl IntoIterator<Item = Column>,
        columns: impl IntoIterator<Item = Column>,
    ) -> Self {
        let mut all: Vec<Column> = keys.into_iter().collect();
        let n_keys = all.len();
        all.extend(columns);
        Self { n_keys, columns: all, rows: Vec::new() }
    }

    /// Adds the row of `cells`, those of the keys first; cells that are left out are empty.
    pub fn row<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        let mut row: Vec<String> = cells.into_iter().map(Into::into).collect();
        row.resize(self.columns.len(), String::new());
        self.rows.push(row);
    }

    /// The table in at most `width` columns, or in as few as its numbers allow. Columns without any cell are
    /// left out; a further table has no row for which it has nothing.
    pub fn fitted(&self, width: usize) -> String {
        let width = width.max(LEAST_WIDTH);
        let mut widths: Vec<usize> = (0..self.columns.len()).map(|at| self.natural(at)).collect();
        // Keys leave most of the width to what they are keys of.
        self.shrink(&mut widths, &self.keys(), 2 * width / 5, 8);
        let groups = self.groups();
        for group in &groups {
            let room = width.saturating_sub(total(&widths, &self.keys()) + GAP.len());
            self.shrink(&mut widths, group, room, width / 4);
        }
        let parts = groups.iter().flat_map(|group| self.parts(group, &widths, width));
        let texts: Vec<String> =
            parts.enumerate().map(|(place, part)| self.part(&part, &widths, place == 0)).collect();
        texts.join("\n")
    }

    fn keys(&self) -> Vec<usize> {
        (0..self.n_keys).collect()
    }

    /// Width of column `at` when nothing wraps.
    fn natural(&self, at: usize) -> usize {
        let cells = self.rows.iter().map(|row| columns_of(&row[at]));
        cells.chain([columns_of(&self.columns[at].heading)]).max().unwrap_or(0)
    }

    /// Columns that stand together where there is room: those with any cell, from one that begins a table to
    /// the next.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut groups = vec![Vec::new()];
        for at in self.n_keys..self.columns.len() {
            if self.columns[at].begins {
                groups.push(Vec::new());
            }
            let is_filled = self.rows.is_empty() || self.rows.iter().any(|row| !row[at].is_empty());
            if let Some(group) = groups.last_mut().filter(|_| is_filled) {
                group.push(at);
            }
        }
        groups.retain(|group| !group.is_empty());
        groups
    }

    /// Narrows columns of words among those at `places`, the widest first and none below `least`, until all
    /// have no more than `room`.
    fn shrink(&self, widths: &mut [usize], places: &[usize], room: usize, least: usize) {
        while total(widths, places) > room {
            let words = places.iter().copied().filter(|&at| {
                let heading = longest_word(&self.columns[at].heading);
                self.columns[at].is_words && widths[at] > least.max(heading)
            });
            let Some(widest) = words.max_by_key(|&at| widths[at]) else { return };
            widths[widest] -= 1;
        }
    }

    /// `group` in as many parts as it takes, each with room for the keys before it.
    fn parts(&self, group: &[usize], widths: &[usize], width: usize) -> Vec<Vec<usize>> {
        let mut parts = vec![self.keys()];
        for &at in group {
            let last = parts.len() - 1;
            let has_own = parts[last].len() > self.n_keys;
            parts[last].push(at);
            if has_own && total(widths, &parts[last]) > width {
                parts[last].pop();
                let mut part = self.keys();
                part.push(at);
                parts.push(part);
            }
        }
        parts
    }

    /// The columns at `places`, with all rows or only those that have something there.
    fn part(&self, places: &[usize], widths: &[usize], with_all: bool) -> String {
        let heading = |&at: &usize| self.columns[at].heading.as_str();
        let mut text = self.lines(places, widths, &places.iter().map(heading).collect::<Vec<_>>());
        for row in &self.rows {
            let own = &places[self.n_keys.min(places.len())..];
            if with_all || own.iter().any(|&at| !row[at].is_empty()) {
                let cells: Vec<&str> = places.iter().map(|&at| row[at].as_str()).collect();
                text += &self.lines(places, widths, &cells);
            }
        }
        text
    }

    /// `cells` of the columns at `places` side by side, on as many lines as the longest takes.
    fn lines(&self, places: &[usize], widths: &[usize], cells: &[&str]) -> String {
        let wrapped: Vec<Vec<String>> =
            cells.iter().zip(places).map(|(cell, &at)| pieces(cell, widths[at])).collect();
        let n_lines = wrapped.iter().map(Vec::len).max().unwrap_or(0);
        let mut text = String::new();
        for line in 0..n_lines.max(1) {
            let mut columns = Vec::with_capacity(places.len());
            for (pieces, &at) in wrapped.iter().zip(places) {
                let piece = pieces.get(line).map_or("", String::as_str);
                let width = widths[at];
                columns.push(match self.columns[at].is_words {
                    true => format!("{piece:<width$}"),
                    false => format!("{piece:>width$}"),
                });
            }
            text += columns.join(GAP).trim_end();
            text.push('\n');
        }
        text
    }
}

/// Width of the columns at `places` with the gaps between them.
fn total(widths: &[usize], places: &[usize]) -> usize {
    let own: usize = places.iter().map(|&at| widths[at]).sum();
    own + GAP.len() * places.len().saturating_sub(1)
}

fn columns_of(text: &str) -> usize {
    text.chars().count()
}

fn longest_word(text: &str) -> usize {
    text.split(' ').map(columns_of).max().unwrap_or(0)
}

/// `text` in pieces of at most `width` columns, broken between words; a word that is longer is broken behind
/// a dash, or where the room ends.
fn pieces(text: &str, width: usize) -> Vec<String> {
    let mut pieces = vec![String::new()];
    for word in text.split(' ') {
        let mut word = word;
        let last = pieces.len() - 1;
        let gap = usize::from(!pieces[last].is_empty());
        if columns_of(&pieces[last]) + gap + columns_of(word) <= width {
            pieces[last] += &" "[..gap];
            pieces[last] += word;
            continue;
        }
        if gap > 0 {
            pieces.push(String::new());
        }
        while columns_of(word) > width {
            let end = word.char_indices().nth(width.max(1)).map_or(word.len(), |(end, _)| end);
            let dash = word[..end].rfind(['-', '_', '/']).map_or(end, |dash| dash + 1);
            let last = pieces.len() - 1;
            pieces[last] += &word[..dash];
            pieces.push(String::new());
            word = &word[dash..];
        }
        let last = pieces.len() - 1;
        pieces[last] += word;
    }
    pieces
}

/// `text` with every line that is longer than `width` broken between words, what follows indented; words
/// themselves, such as the path of a file, stay whole.
pub fn wrapped(text: &str, width: usize) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (body, end) = line.strip_suffix('\n').map_or((line, ""), |body| (body, "\n"));
        if columns_of(body) <= width {
            out += line;
            continue;
        }
        let indent = columns_of(body) - columns_of(body.trim_start());
        out += &" ".repeat(indent);
        let mut column = indent;
        for (place, word) in body.trim_start().split(' ').enumerate() {
            if place > 0 && column > indent && column + 1 + columns_of(word) > width {
                out += "\n";
                out += &" ".repeat(indent + 2);
                column = indent + 2;
            } else if place > 0 {
                out += " ";
                column += 1;
            }
            out += word;
            column += columns_of(word);
        }
        out += end;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> TextTable {
        let mut table = TextTable::new(
            [Column::words("run"), Column::words("")],
            [
                Column::words("control"),
                Column::number("power kW"),
                Column::number("nothing"),
                Column::number("load").in_new_table(),
                Column::number("change %"),
            ],
        );
        let control = "phase-sync 4.0° at an offset of 150°";
        table.row(["helix-of-four-degrees", "T1", control, "9862 ± 4395", "", "24.8", "1.0 ± 0.1"]);
        table.row(["helix-of-four-degrees", "all", "", "13792 ± 4908"]);
        table
    }

    #[test]
    fn a_further_table_has_the_keys_again_and_no_empty_rows_or_columns() {
        let text = table().fitted(WIDTH);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 6, "{text}");
        assert_eq!(lines[3], "");
        assert_eq!(lines[4].split_whitespace().collect::<Vec<_>>(), ["run", "load", "change", "%"]);
        assert!(lines[5].starts_with("helix-of-four-degrees  T1   "), "{text}");
        assert!(lines[5].ends_with("24.8  1.0 ± 0.1") && !text.contains("nothing"), "{text}");
        // Numbers end under the end of their headings.
        assert_eq!(columns_of(lines[0]), columns_of(lines[1]), "{text}");
    }

    #[test]
    fn what_has_no_room_wraps_or_goes_below() {
        for width in [90, 72, 60, 50, 40, 20] {
            let text = table().fitted(width);
            let widest = text.lines().map(columns_of).max().unwrap_or(0);
            assert!(widest <= width.max(LEAST_WIDTH), "{widest} of {width}:\n{text}");
            let words: Vec<&str> = text.split_whitespace().collect();
            // No number is torn, no word lost.
            for part in ["9862", "24.8", "1.0", "offset", "150°", "13792"] {
                assert!(words.contains(&part), "{part} at {width}:\n{text}");
            }
        }
    }

    #[test]
    fn a_word_that_is_too_long_breaks_at_a_dash() {
        assert_eq!(pieces("helix-of-four", 8), ["helix-", "of-four"]);
        assert_eq!(pieces("abcdefghij kl", 4), ["abcd", "efgh", "ij", "kl"]);
        assert_eq!(pieces("ä ö", 1), ["ä", "ö"]);
        assert_eq!(pieces("", 5), [""]);
    }

    #[test]
    fn long_lines_wrap_and_others_stay() {
        let text =
            "short\n  a line of many words that goes on\n/a/path/that/is/longer/than/the/line\n";
        let expected = "short\n  a line of many\n    words that\n    goes on\n/a/path/that/is/longer/than/the/line\n";
        assert_eq!(wrapped(text, 16), expected);
        assert_eq!(wrapped("end without line end", 100), "end without line end");
    }
}
