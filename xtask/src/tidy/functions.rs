//! Functions that one can see at once.
//!
//! Counted from the line of `fn` to that of the closing brace. Tests do not count, nor do tables of data:
//! functions in which nothing is decided or repeated (no `if`, `match`, `for`, `while`, `loop`) and nothing
//! named (no `let`).

use super::Finding;
use super::exceptions::Exceptions;
use super::room::Module;
use super::source::is_word;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Longest function (lines).
const MAXIMUM_LINES: usize = 60;

/// Adds the functions of `module` that are too long and not among `exceptions`; gives file and name of all
/// that are.
pub(super) fn check(
    module: &Module,
    exceptions: &Exceptions,
    findings: &mut Vec<Finding>,
) -> BTreeSet<(PathBuf, String)> {
    let mut found = BTreeSet::new();
    for Function { name, line, n_lines, is_table } in functions(module.product()) {
        if n_lines <= MAXIMUM_LINES || is_table {
            continue;
        }
        let key = (module.file.clone(), name.clone());
        if !exceptions.functions.contains(&key) {
            let message = format!("`{name}` has {n_lines} lines, {MAXIMUM_LINES} are the most");
            findings.push(Finding { file: module.file.clone(), line: Some(line), message });
        }
        found.insert(key);
    }
    found
}

struct Function {
    name: String,
    line: usize,
    n_lines: usize,
    is_table: bool,
}

fn functions(code: &str) -> Vec<Function> {
    let words = words(code);
    let mut functions = Vec::new();
    for pair in words.windows(2) {
        let [(at, word), (name_at, name)] = pair else { continue };
        // A type `fn(f64)` has no name right behind.
        let is_named = code[at + word.len()..*name_at].chars().all(char::is_whitespace);
        if *word != "fn" || !is_named {
            continue;
        }
        let Some(body) = body(code, *name_at) else { continue };
        let text = &code[body.clone()];
        let decides = ["if", "match", "for", "while", "loop", "let"];
        let mut inside = words.iter().filter(|(at, _)| body.contains(at));
        functions.push(Function {
            name: (*name).to_owned(),
            line: code[..*at].matches('\n').count() + 1,
            n_lines: code[*at..body.start].matches('\n').count() + text.matches('\n').count() + 1,
            is_table: inside.all(|(_, word)| !decides.contains(word)),
        });
    }
    functions
}

/// Words of `code` with where they begin.
fn words(code: &str) -> Vec<(usize, &str)> {
    let mut words = Vec::new();
    let mut start = None;
    for (at, c) in code.char_indices().chain([(code.len(), ' ')]) {
        match (is_word(c), start) {
            (true, None) => start = Some(at),
            (false, Some(from)) => {
                words.push((from, &code[from..at]));
                start = None;
            }
            _ => {}
        }
    }
    words
}

/// Where the braces of the function whose name stands at `name_at` are; none for one without a body.
fn body(code: &str, name_at: usize) -> Option<std::ops::Range<usize>> {
    let (mut depth, mut inside, mut start) = (0_usize, 0_usize, None);
    for (at, c) in code[name_at..].char_indices() {
        match c {
            '(' | '[' => inside += 1,
            ')' | ']' => inside = inside.saturating_sub(1),
            ';' if start.is_none() && inside == 0 => return None,
            '{' => {
                start.get_or_insert(name_at + at);
                depth += 1;
            }
            '}' if depth == 1 => return Some(start?..name_at + at + 1),
            '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    None
}
