//! What the pages in `docs/validation/` say of the records: a verdict and a table at the top of each, and the
//! list of all.

use crate::record::{Record, RecordError, RecordedRow, Verdict};
use crate::row::Tolerance;
use crate::{ELSEWHERE, VALIDATIONS};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// Folder of the pages, seen from the repository's root.
pub const FOLDER: &str = "docs/validation";
/// The page that lists all.
pub const INDEX: &str = "index";
/// Lines between which a page shows the record.
const MARKS: [&str; 2] = [
    "<!-- from the record, by `wakemix validate --pages`: begin -->",
    "<!-- from the record, by `wakemix validate --pages`: end -->",
];
/// Most met claims that stand open in a table; more are folded away, shortfalls never.
const OPEN: usize = 12;

/// A comparison with its record, as a page needs it.
pub struct Entry {
    name: &'static str,
    about: &'static str,
    repeat: String,
    cost: String,
    /// Whether no command sets it beside its record.
    by_hand: bool,
    page: &'static str,
    record: Record,
}

/// Every comparison with its record, read below `root`, the repository's.
///
/// # Errors
/// [`RecordError`] when a record cannot be read.
pub fn entries(root: &Path) -> Result<Vec<Entry>, RecordError> {
    let mut entries = Vec::new();
    for validation in VALIDATIONS {
        entries.push(Entry {
            name: validation.name,
            about: validation.about,
            repeat: format!("wakemix validate {}", validation.name),
            cost: format!("{} min", validation.cost),
            by_hand: false,
            page: validation.page,
            record: Record::read(root, validation.name)?,
        });
    }
    for elsewhere in ELSEWHERE {
        entries.push(Entry {
            name: elsewhere.name,
            about: elsewhere.about,
            repeat: elsewhere.repeat.to_owned(),
            cost: "by hand".to_owned(),
            by_hand: true,
            page: elsewhere.page,
            record: Record::read(root, elsewhere.name)?,
        });
    }
    Ok(entries)
}

/// Names of all pages, each once, the index last.
pub fn names() -> Vec<&'static str> {
    let own = VALIDATIONS.iter().map(|validation| validation.page);
    let pages: BTreeSet<&str> = own.chain(ELSEWHERE.iter().map(|other| other.page)).collect();
    pages.into_iter().chain([INDEX]).collect()
}

/// The text of the page `name` as `entries` have it; `text` is what it is now.
///
/// # Errors
/// When the page lacks the two lines between which the record stands, in words.
pub fn renewed(name: &str, text: &str, entries: &[Entry]) -> Result<String, String> {
    let [begin, end] = MARKS;
    let lacking = || format!("{FOLDER}/{name}.md lacks the lines `{begin}` and `{end}`");
    let (before, rest) = text.split_once(begin).ok_or_else(lacking)?;
    let (_, after) = rest.split_once(end).ok_or_else(lacking)?;
    let block = if name == INDEX { list(entries) } else { tables(name, entries) };
    Ok(format!("{before}{begin}\n\n{block}\n{end}{after}"))
}

/// Renews all pages below `root`, the repository's; gives the names of those that changed.
///
/// # Errors
/// When a record or a page cannot be read or written, in words.
pub fn write(root: &Path) -> Result<Vec<&'static str>, String> {
    let entries = entries(root).map_err(|error| error.to_string())?;
    let mut changed = Vec::new();
    for name in names() {
        let path = root.join(FOLDER).join(format!("{name}.md"));
        let named = |error: std::io::Error| format!("{}: {error}", path.display());
        let text = fs::read_to_string(&path).map_err(named)?;
        let renewed = renewed(name, &text, &entries)?;
        if renewed != text {
            fs::write(&path, renewed).map_err(named)?;
            changed.push(name);
        }
    }
    Ok(changed)
}

/// All comparisons in one table.
fn list(entries: &[Entry]) -> String {
    let [met, all] = sum(entries, |entry| !entry.by_hand);
    let mut text = format!(
        "{all} claims are recorded that `wakemix validate` repeats and sets beside their records: {met} are met, {} fall short.",
        all - met
    );
    let [met, all] = sum(entries, |entry| entry.by_hand);
    if all > 0 {
        let _ = write!(
            text,
            " By hand, with no command that sets them beside their records, {all} more: {met} are met, {} fall short.",
            all - met
        );
    }
    text.push_str(
        "\n\n| validation | what is compared | verdict | takes | recorded |\n| --- | --- | --- | --- | --- |\n",
    );
    for Entry { name, about, cost, page, record, .. } in entries {
        let verdict = match verdict(record) {
            short if record.n_met() < record.rows.len() => format!("**{short}**"),
            met => met,
        };
        let _ = writeln!(
            text,
            "| [{name}]({page}.md) | {about} | {verdict} | {cost} | {} |",
            record.date
        );
    }
    text
}

/// How many claims of those entries that `counts` are met, and how many are recorded. A row that stands on a
/// page more than once, because a part of a validation is one too, is one claim.
fn sum(entries: &[Entry], counts: impl Fn(&Entry) -> bool) -> [usize; 2] {
    let mut verdicts: BTreeMap<(&str, &str), Verdict> = BTreeMap::new();
    for entry in entries.iter().filter(|entry| counts(entry)) {
        for row in &entry.record.rows {
            let verdict = verdicts.entry((entry.page, &row.id)).or_insert(row.verdict);
            // Recorded twice with two verdicts, it falls short.
            if row.verdict == Verdict::Short {
                *verdict = Verdict::Short;
            }
        }
    }
    let met = verdicts.values().filter(|verdict| **verdict == Verdict::Met).count();
    [met, verdicts.len()]
}

/// What of `page` is recorded, one table for each of its comparisons.
fn tables(page: &str, entries: &[Entry]) -> String {
    let mut text = String::new();
    for entry in entries.iter().filter(|entry| entry.page == page) {
        if !text.is_empty() {
            text.push('\n');
        }
        table(entry, &mut text);
    }
    text
}

/// Shortfalls first, each of them; then what is met.
fn table(entry: &Entry, text: &mut String) {
    let Entry { name, repeat, record, .. } = entry;
    if record.rows.is_empty() {
        let verdict = verdict(record);
        let _ = writeln!(text, "**{name}: {verdict}.** Repeat with `{repeat}`.");
        return;
    }
    let _ = writeln!(
        text,
        "**{name}: {}.** Recorded {}, {}; repeat with `{repeat}`.\n",
        verdict(record),
        record.date,
        record.conditions
    );
    let (short, met): (Vec<_>, Vec<_>) =
        record.rows.iter().partition(|row| row.verdict == Verdict::Short);
    let fold = met.len() > OPEN;
    let open = if fold { short } else { [short, met.clone()].concat() };
    if !open.is_empty() {
        lines(&open, text);
    }
    if fold {
        if !open.is_empty() {
            text.push('\n');
        }
        let _ = writeln!(text, "<details><summary>{} claims that are met</summary>\n", met.len());
        lines(&met, text);
        text.push_str("\n</details>\n");
    }
    let sources: BTreeSet<&str> = record.rows.iter().map(|row| row.source.as_str()).collect();
    let sources: Vec<&str> = sources.into_iter().collect();
    let _ = writeln!(text, "\nExpected values: {}.", sources.join("; "));
}

/// How many claims are met, in words.
fn verdict(record: &Record) -> String {
    let (met, all) = (record.n_met(), record.rows.len());
    match all - met {
        _ if all == 0 => "not recorded yet".to_owned(),
        0 if all == 1 => "the one claim is met".to_owned(),
        0 if all == 2 => "both claims are met".to_owned(),
        0 => format!("all {all} claims are met"),
        1 => format!("{met} of {all} claims are met, 1 falls short"),
        short => format!("{met} of {all} claims are met, {short} fall short"),
    }
}

fn lines(rows: &[&RecordedRow], text: &mut String) {
    text.push_str("| claim | tolerance | result | verdict |\n| --- | --- | --- | --- |\n");
    for row in rows {
        let claim = row.claim.replace('|', "\\|");
        let verdict = if row.verdict == Verdict::Met { "met" } else { "**short**" };
        let expected = figure(row.expected);
        let unit = if ["-", "–", ""].contains(&row.unit.as_str()) {
            String::new()
        } else {
            format!(" {}", row.unit)
        };
        let accepted = match row.tolerance {
            Tolerance::Within(0.0) => format!("{expected}{unit}, exactly"),
            Tolerance::Within(most) => format!("{expected} ± {}{unit}", figure(most)),
            Tolerance::AtMost => format!("at most {expected}{unit}"),
            Tolerance::AtLeast => format!("at least {expected}{unit}"),
        };
        let result = match row.measured {
            Some(measured) => figure(measured) + &unit,
            None => "figure not kept".to_owned(),
        };
        let _ = writeln!(text, "| {claim} | {accepted} | {result} | {verdict} |");
    }
}

/// A number with four digits that count, and a minus sign that is one.
fn figure(value: f64) -> String {
    let size = value.abs();
    let text = if value.is_nan() {
        "not a number".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "inf".to_owned() } else { "-inf".to_owned() }
    } else if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e5).contains(&size) {
        let digits = (3 - size.log10().floor() as i32).max(0) as usize;
        let text = format!("{value:.digits$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    } else {
        format!("{value:.1e}")
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(rows: &str) -> Entry {
        let text = format!("date = \"2026-11-22\"\nconditions = \"one core\"\n{rows}");
        Entry {
            name: "wing",
            about: "lift against theory",
            repeat: "wakemix validate wing".to_owned(),
            cost: "1 min".to_owned(),
            by_hand: false,
            page: "wings",
            record: Record::parse(&text).unwrap(),
        }
    }

    fn row(claim: &str, tolerance: &str, verdict: &str) -> String {
        format!(
            "[[row]]\nid = \"{claim}\"\nclaim = \"{claim}\"\nmeasured = 1.25\nexpected = 1.0\n\
             tolerance = {tolerance}\nunit = \"MN\"\nsource = \"theory\"\nverdict = \"{verdict}\"\n"
        )
    }

    #[test]
    fn a_page_opens_with_its_shortfalls_and_keeps_its_notebook() {
        let rows = row("lift", "{ within = 0.5 }", "met") + &row("drag", "\"at-most\"", "short");
        let [begin, end] = MARKS;
        let text = format!("# Wings\n\n{begin}\nold\n{end}\n\nNotebook.\n");
        let page = renewed("wings", &text, &[entry(&rows)]).unwrap();
        assert!(page.starts_with("# Wings\n\n<!--") && page.ends_with("\n\nNotebook.\n"));
        assert!(!page.contains("old"));
        let drag = page.find("| drag | at most 1 MN | 1.25 MN | **short** |").unwrap();
        let lift = page.find("| lift | 1 ± 0.5 MN | 1.25 MN | met |").unwrap();
        assert!(drag < lift, "{page}");
        assert!(
            page.contains("**wing: 1 of 2 claims are met, 1 falls short.** Recorded 2026-11-22")
        );
        assert_eq!(renewed("wings", &page, &[entry(&rows)]).unwrap(), page);
        assert!(renewed("wings", "# Wings\n", &[entry(&rows)]).is_err());
    }

    #[test]
    fn what_is_not_recorded_is_not_said_to_be_met() {
        let mut text = String::new();
        table(&entry("row = []\n"), &mut text);
        assert_eq!(text, "**wing: not recorded yet.** Repeat with `wakemix validate wing`.\n");
        assert!(list(&[entry("row = []\n")]).contains("| not recorded yet |"));
    }

    #[test]
    fn many_met_claims_are_folded_and_no_shortfall_is() {
        let met: String =
            (0..20).map(|n| row(&format!("m{n}"), "{ within = 0.5 }", "met")).collect();
        let short: String =
            (0..20).map(|n| row(&format!("s{n}"), "{ within = 0.1 }", "short")).collect();
        let mut text = String::new();
        table(&entry(&(met + &short)), &mut text);
        let fold = text.find("<details>").unwrap();
        assert!(text.find("| s19 |").unwrap() < fold && text.find("| m0 |").unwrap() > fold);
    }

    #[test]
    fn sums_count_a_claim_once_and_what_is_kept_by_hand_apart() {
        let lift = row("lift", "{ within = 0.5 }", "met");
        let drag = row("drag", "\"at-most\"", "short");
        let all = entry(&(lift.clone() + &drag));
        let part = Entry { name: "wing-coarse", ..entry(&drag) };
        let by_hand = Entry { name: "sail", by_hand: true, page: "sails", ..entry(&lift) };
        let text = list(&[all, part, by_hand]);
        assert!(text.starts_with("2 claims are recorded that "), "{text}");
        assert!(text.contains(": 1 are met, 1 fall short. By hand, "), "{text}");
        assert!(text.contains(", 1 more: 1 are met, 0 fall short.\n"), "{text}");
        let elsewhere = Entry { page: "sails", ..entry(&drag) };
        let text = list(&[entry(&drag), elsewhere]);
        assert!(text.starts_with("2 claims") && text.contains(": 0 are met, 2 fall short.\n"));
    }

    #[test]
    fn a_unit_stands_before_what_is_said_of_a_figure() {
        let rows = row("lift", "{ within = 0.0 }", "short");
        let mut text = String::new();
        table(&entry(&rows), &mut text);
        assert!(text.contains("| lift | 1 MN, exactly | 1.25 MN | **short** |"), "{text}");
    }

    #[test]
    fn figures_keep_four_digits() {
        for (value, text) in [
            (0.0, "0"),
            (100.0, "100"),
            (-0.12345, "−0.1235"),
            (12345.6, "12346"),
            (3.2e-10, "3.2e−10"),
            (0.999_96, "1"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "−inf"),
        ] {
            assert_eq!(figure(value), text);
        }
    }
}
