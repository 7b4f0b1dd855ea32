//! What a file may say, line by line.

use super::{Finding, architecture::Rules};
use std::path::Path;

/// Longest source file (lines).
const MAXIMUM_LINES: usize = 400;

/// Words with no place in any file, and why. Split so that this list does not find itself.
const FORBIDDEN_ANYWHERE: [(&str, &str); 5] = [
    (concat!("/wo", "rk/"), "names a place on one machine"),
    (concat!("/ho", "me/"), "names a place on one machine"),
    (concat!("../sha", "red"), "names a folder outside the repository"),
    (concat!("index.crat", "es.io"), "names a registry host"),
    (concat!("static.crat", "es.io"), "names a registry host"),
];

/// Unfinished or switched-off code.
const FORBIDDEN_IN_SOURCE: [(&str, &str); 4] = [
    (concat!("to", "do!("), "unfinished code"),
    (concat!("unimpl", "emented!("), "unfinished code"),
    (concat!("db", "g!("), "left over from debugging"),
    (concat!("#[ig", "nore"), "a test that never runs"),
];

/// What only the rooms listed in ARCHITECTURE.md do, and how it shows in a source file.
const PERMITTED: [(&str, &[&str]); 3] = [
    ("open files", &["std::fs", "fs::File", "File::open", "File::create", "tempfile::"]),
    ("read a clock", &[concat!("Instant::", "now"), concat!("System", "Time")]),
    (
        "reach a network",
        &[concat!("std::", "net"), concat!("Tcp", "Stream"), concat!("Udp", "Socket")],
    ),
];

/// Adds what is wrong with `text`, the content of `file` (relative to the root).
pub(super) fn check(file: &Path, text: &str, rules: &Rules, findings: &mut Vec<Finding>) {
    let mut report = |line: Option<usize>, message: String| {
        findings.push(Finding { file: file.to_owned(), line, message });
    };
    for (number, line) in numbered(text) {
        for (word, reason) in FORBIDDEN_ANYWHERE {
            if line.contains(word) {
                report(Some(number), format!("`{word}` {reason}"));
            }
        }
    }
    if file.extension().is_none_or(|extension| extension != "rs") {
        return;
    }
    if !text.starts_with("//!") {
        report(Some(1), "the file does not start with `//!` and what it is for".to_owned());
    }
    let n_lines = text.lines().count();
    if n_lines > MAXIMUM_LINES {
        report(None, format!("{n_lines} lines, {MAXIMUM_LINES} are the most"));
    }
    for (number, line) in numbered(text) {
        for (word, reason) in FORBIDDEN_IN_SOURCE {
            if line.contains(word) {
                report(Some(number), format!("`{word}…`: {reason}"));
            }
        }
    }
    check_units(text, &mut report);
    check_permits(file, text, rules, &mut report);
}

/// A public number says its unit in parentheses, or that it shares one with something else.
fn check_units(text: &str, report: &mut impl FnMut(Option<usize>, String)) {
    let mut doc = String::new();
    for (number, line) in numbered(text) {
        let line = line.trim();
        if let Some(words) = line.strip_prefix("///") {
            doc.push_str(words);
        } else if is_public_number(line) {
            let has_unit = (doc.contains('(') && doc.contains(')')) || doc.contains("unit");
            if !has_unit {
                let name = line.split(':').next().unwrap_or(line);
                report(
                    Some(number),
                    format!("`{name}` has no unit in its doc, such as (m) or (–)"),
                );
            }
            doc.clear();
        } else if !line.starts_with("#[") {
            doc.clear();
        }
    }
}

fn is_public_number(line: &str) -> bool {
    let Some((name, kind)) = line.strip_prefix("pub ").and_then(|field| field.split_once(": "))
    else {
        return false;
    };
    let is_name = name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    is_name && ["f64,", "Option<f64>,", "Vec<f64>,", "PerBlade<f64>,"].contains(&kind)
}

fn check_permits(
    file: &Path,
    text: &str,
    rules: &Rules,
    report: &mut impl FnMut(Option<usize>, String),
) {
    let Some(room) = rules.room_of(file) else { return };
    // Tests may write where the room itself may not.
    if file.components().any(|part| part.as_os_str() == "tests" || part.as_os_str() == "tests.rs") {
        return;
    }
    for (permit, signs) in PERMITTED {
        let permitted = rules.permits.get(permit).is_some_and(|rooms| rooms.contains(room));
        if permitted {
            continue;
        }
        for (number, line) in numbered(text) {
            let code = line.split("//").next().unwrap_or(line);
            if let Some(sign) = signs.iter().find(|sign| code.contains(**sign)) {
                report(Some(number), format!("`{sign}`: {room} is not among those that {permit}"));
            }
        }
    }
}

fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(index, line)| (index + 1, line))
}
