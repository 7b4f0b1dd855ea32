//! Numbers as a reader wants them: rounded, signed, with their unit.

use basis::records::Statistic;

/// A space that does not break a number from its unit.
pub(crate) const SPACE: char = '\u{a0}';

/// `value` with `decimals` digits after the point and a true minus sign; never "−0".
pub(crate) fn number(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = format!("{value:.decimals$}");
    let is_zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    match text.strip_prefix('-') {
        Some(rest) if is_zero => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// `value` with its sign, plus included.
pub(crate) fn signed(value: f64, decimals: usize) -> String {
    let text = number(value, decimals);
    let has_sign = text.starts_with('−') || text.starts_with('–');
    if has_sign || text.bytes().all(|byte| matches!(byte, b'0' | b'.')) {
        text
    } else {
        format!("+{text}")
    }
}

/// A share as a signed percentage: 0.053 is "+5.3 %".
pub(crate) fn signed_percent(share: f64) -> String {
    format!("{}{SPACE}%", signed(100.0 * share, 1))
}

/// A share as a percentage.
pub(crate) fn percent(share: f64) -> String {
    format!("{}{SPACE}%", number(100.0 * share, 1))
}

/// "± x" in units of `scale`, or words for an interval that is not there.
pub(crate) fn interval(statistic: &Statistic, scale: f64, decimals: usize) -> String {
    match statistic.half_width_95 {
        Some(width) if width.is_finite() => {
            format!("±{SPACE}{}", number(width / scale, decimals))
        }
        _ => "no interval".to_owned(),
    }
}

/// A gain and its interval: "+5.3 % ± 1.2 %".
pub(crate) fn gain(statistic: &Statistic) -> String {
    with_interval(signed_percent(statistic.mean), statistic)
}

/// The same without the sign.
pub(crate) fn size(statistic: &Statistic) -> String {
    with_interval(percent(statistic.mean), statistic)
}

fn with_interval(mean: String, statistic: &Statistic) -> String {
    match statistic.half_width_95 {
        Some(width) if width.is_finite() => format!("{mean} ±{SPACE}{}", percent(width)),
        _ => format!("{mean} (no interval)"),
    }
}

/// Significant digits after the point for a quantity of size `value`: three figures in all.
pub(crate) fn three_figures(value: f64) -> usize {
    match value.abs() {
        size if size >= 100.0 => 0,
        size if size >= 10.0 => 1,
        size if size >= 1.0 => 2,
        _ => 3,
    }
}

/// A count with thin groups of three digits: 1234567 is "1 234 567".
pub(crate) fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(SPACE);
        }
        text.push(digit);
    }
    text
}

/// A duration in the unit that suits it (s).
pub(crate) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{}{SPACE}s", number(s, three_figures(s).min(1))),
        s if s < 6000.0 => format!("{}{SPACE}min", number(s / 60.0, 1)),
        s => format!("{}{SPACE}h", number(s / 3600.0, 1)),
    }
}

/// An amount of memory in the unit that suits it (bytes).
pub(crate) fn memory(bytes: u64) -> String {
    let size = bytes as f64;
    if size < 1e9 {
        format!("{}{SPACE}MB", number(size / 1e6, 0))
    } else {
        format!("{}{SPACE}GB", number(size / 1e9, 1))
    }
}

/// "one", "two", …; digits from thirteen on.
pub(crate) fn small_count(value: usize) -> String {
    const NAMES: [&str; 13] = [
        "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten",
        "eleven", "twelve",
    ];
    NAMES.get(value).map_or_else(|| value.to_string(), |name| (*name).to_owned())
}

/// "a", "a and b", "a, b and c".
pub(crate) fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// `text` with a capital first letter.
pub(crate) fn capitalised(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_true_signs_and_zero_has_none() {
        assert_eq!(number(-2.14, 1), "−2.1");
        assert_eq!(number(-0.04, 1), "0.0");
        assert_eq!(signed_percent(0.0534), "+5.3\u{a0}%");
        assert_eq!(signed_percent(-0.021), "−2.1\u{a0}%");
        assert_eq!(signed_percent(-0.0001), "0.0\u{a0}%");
        assert_eq!(number(f64::NAN, 1), "–");
        assert_eq!(signed(f64::INFINITY, 1), "–");
    }

    #[test]
    fn counts_durations_and_lists_read_naturally() {
        assert_eq!(count(1_234_567), "1\u{a0}234\u{a0}567");
        assert_eq!(count(12), "12");
        assert_eq!(duration(42.26), "42.3\u{a0}s");
        assert_eq!(duration(165.0), "2.8\u{a0}min");
        assert_eq!(duration(7200.0), "2.0\u{a0}h");
        assert_eq!(list(&["a".into(), "b".into(), "c".into()]), "a, b and c");
        assert_eq!(capitalised("éa"), "Éa");
        assert_eq!(small_count(2), "two");
        assert_eq!(small_count(40), "40");
    }
}
