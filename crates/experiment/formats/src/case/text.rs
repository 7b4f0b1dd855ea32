//! Numbers and texts as they stand in a case file.

/// The degrees with the fewest digits that give `angle` (rad) back, bit for bit where any do.
pub(super) fn degrees(angle: f64) -> f64 {
    shortest(angle, angle.to_degrees(), f64::to_radians)
}

/// The number near `exact` with the fewest digits that `back` makes `value` of again, bit for bit where any
/// does.
pub(super) fn shortest(value: f64, exact: f64, back: impl Fn(f64) -> f64) -> f64 {
    (0..17)
        .filter_map(|digits| format!("{exact:.digits$e}").parse::<f64>().ok())
        .chain([exact, exact.next_up(), exact.next_down()])
        .find(|number| back(*number) == value)
        .unwrap_or(exact)
}

/// `text` in quotes, as TOML has it.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
