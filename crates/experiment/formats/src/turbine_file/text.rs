//! Keys, tables and groups of a turbine file as text.

use super::document::Mode;

/// Text of a turbine file as far as it is written, and what it lacks.
#[derive(Default)]
pub(super) struct Text {
    pub(super) text: String,
    group: &'static str,
    pub(super) missing: Vec<String>,
}

impl Text {
    pub(super) fn line(&mut self, line: &str) {
        self.text.push_str(line.trim_end());
        self.text.push('\n');
    }

    pub(super) fn text(&mut self, key: &str, text: &str) {
        self.line(&format!("{key} = {}", quoted(text)));
    }

    /// A comment where `key` should stand, with what is known of it.
    pub(super) fn missing(&mut self, key: &str, known: &str) {
        self.missing.push(format!("{}.{key}", self.group));
        self.line(&format!("# {key} = {known}  # not in the source; complete by hand"));
    }

    pub(super) fn number(&mut self, key: &str, value: f64, comment: &str) {
        if !value.is_finite() {
            return self.missing(key, "?");
        }
        let comment = if comment.is_empty() { String::new() } else { format!("  # {comment}") };
        self.line(&format!("{key} = {}{comment}", number(value)));
    }

    pub(super) fn group<Group>(
        &mut self,
        name: &'static str,
        group: &Option<Group>,
        write: fn(&mut Self, &Group),
    ) {
        self.line("");
        self.group = name;
        match group {
            Some(group) => {
                self.line(&format!("[{name}]"));
                write(self, group);
            }
            None => {
                self.missing.push(name.to_owned());
                self.line(&format!("# [{name}] is not in the source; complete by hand"));
            }
        }
    }

    pub(super) fn table<Cells: IntoIterator<Item = String>>(
        &mut self,
        key: &str,
        columns: &[&str],
        rows: impl IntoIterator<Item = Cells>,
    ) {
        let rows: Vec<Vec<String>> =
            rows.into_iter().map(|row| row.into_iter().collect()).collect();
        if rows.is_empty() && key != "minimum_pitch" {
            return self.missing(key, "[]");
        }
        self.line(&format!("{key} = ["));
        let mut widths: Vec<usize> = columns.iter().map(|name| name.chars().count()).collect();
        for row in &rows {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(cell.len());
            }
        }
        let join = |cells: Vec<String>| cells.join("  ");
        let pad = |cells: &mut dyn Iterator<Item = (&str, &str)>| -> Vec<String> {
            cells
                .zip(&widths)
                .map(|((cell, end), width)| {
                    let blanks = width.saturating_sub(cell.chars().count());
                    format!("{}{cell}{end}", " ".repeat(blanks))
                })
                .collect()
        };
        let head = pad(&mut columns.iter().map(|name| (*name, " ")));
        self.line(&format!("  # {}", join(head)));
        for row in &rows {
            let last = row.len() - 1;
            let cells = row.iter().enumerate();
            let cells =
                pad(&mut cells.map(|(k, cell)| (cell.as_str(), if k == last { "" } else { "," })));
            self.line(&format!("  [ {} ],", join(cells)));
        }
        self.line("]");
    }

    pub(super) fn mode(&mut self, key: &str, mode: &Mode) {
        if !mode.coefficients.iter().chain([&mode.damping_ratio]).all(|value| value.is_finite()) {
            return self.missing(key, "{ coefficients = [?], damping_ratio = ? }");
        }
        let coefficients: Vec<String> = mode.coefficients.iter().map(|c| number(*c)).collect();
        let damping = number(mode.damping_ratio);
        let coefficients = coefficients.join(", ");
        self.line(&format!(
            "{key} = {{ coefficients = [{coefficients}], damping_ratio = {damping} }}"
        ));
    }
}

/// Seven significant digits, as TOML reads them as a number with a point.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0.0".to_owned();
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..9).contains(&magnitude) {
        let text = format!("{value:.6e}");
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
        return format!("{mantissa}e{exponent}");
    }
    let decimals = usize::try_from(6 - magnitude).unwrap_or(0).max(1);
    let text = format!("{value:.decimals$}");
    let trimmed = text.trim_end_matches('0');
    if trimmed.ends_with('.') { format!("{trimmed}0") } else { trimmed.to_owned() }
}

pub(super) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

pub(super) fn numbers<const N: usize>(row: &[f64; N]) -> [String; N] {
    row.map(number)
}
