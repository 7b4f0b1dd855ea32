//! Rust source read just far enough: comments and strings blanked, tests apart, paths spelled out.

/// `text` with comments, strings and characters blanked; lines stay where they are.
pub(super) fn code_of(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    let mut before = ' ';
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => rest.find("*/").map_or(rest.len(), |end| end + 2),
            '"' => quoted(rest),
            'r' if !is_word(before) => raw(rest),
            '\'' => character(rest),
            _ => 0,
        };
        if length == 0 {
            code.push(first);
            rest = &rest[first.len_utf8()..];
        } else {
            code.extend(rest[..length].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
            rest = &rest[length..];
        }
        before = first;
    }
    code
}

pub(super) fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Length (bytes) of the string that `rest` begins with.
fn quoted(rest: &str) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Length (bytes) of the raw string that `rest` begins with; zero where it is none.
fn raw(rest: &str) -> usize {
    let n_hashes = rest[1..].chars().take_while(|c| *c == '#').count();
    let start = 1 + n_hashes;
    if !rest[start..].starts_with('"') {
        return 0;
    }
    let end = format!("\"{}", "#".repeat(n_hashes));
    rest[start + 1..].find(&end).map_or(rest.len(), |at| start + 1 + at + end.len())
}

/// Length (bytes) of the character that `rest` begins with; zero where it is a lifetime.
fn character(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    match (chars.next(), chars.next()) {
        (Some((_, '\\')), _) => rest[2..].find('\'').map_or(0, |at| {
            // The escaped character may be the quote itself.
            if at == 0 { 4.min(rest.len()) } else { at + 3 }
        }),
        (Some(_), Some((at, '\''))) => at + 1,
        _ => 0,
    }
}

/// The part of `code` that is not an inline module of tests, which stands last in a file.
pub(super) fn product_of(code: &str) -> &str {
    let mut start = 0;
    for line in code.split_inclusive('\n') {
        let rest = code[start..].trim_start();
        let opens = |rest: &str| rest.trim_start().starts_with("mod ");
        if line.trim() == "#[cfg(test)]"
            && rest.strip_prefix("#[cfg(test)]").is_some_and(opens)
            && rest.split(['{', ';']).next().is_some_and(|head| rest[head.len()..].starts_with('{'))
        {
            return &code[..start];
        }
        start += line.len();
    }
    code
}

/// Modules in files of their own that `code` declares for tests alone.
pub(super) fn test_modules(code: &str) -> Vec<&str> {
    let mut modules = Vec::new();
    for part in code.split("#[cfg(test)]").skip(1) {
        let mut rest = part.trim_start();
        while rest.starts_with("#[") {
            rest = rest.split_once(']').map_or("", |(_, after)| after.trim_start());
        }
        if let Some(declared) = rest.strip_prefix("mod ")
            && let Some((name, _)) = declared.split_once(';')
            && name.chars().all(is_word)
        {
            modules.push(name);
        }
    }
    modules
}

/// Paths that `code` names, in `use` lines and elsewhere, segment by segment; `*` is a segment.
pub(super) fn paths(code: &str) -> Vec<Vec<String>> {
    let mut paths = Vec::new();
    let mut rest = code;
    let mut before = ' ';
    while let Some(first) = rest.chars().next() {
        if !is_word(first) || is_word(before) {
            before = first;
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let word = word_of(rest);
        let after = &rest[word.len()..];
        if word == "use" && after.starts_with(char::is_whitespace) {
            let (tree, behind) = after.split_once(';').unwrap_or((after, ""));
            expand(&[], tree, &mut paths);
            rest = behind;
            before = ';';
            continue;
        }
        // A path elsewhere: what follows `::` belongs to it.
        let (path, behind) = plain_path(rest);
        if path.len() > 1 && before != '.' {
            paths.push(path);
        }
        rest = behind;
        before = 'x';
    }
    paths
}

fn word_of(rest: &str) -> &str {
    &rest[..rest.find(|c| !is_word(c)).unwrap_or(rest.len())]
}

fn plain_path(mut rest: &str) -> (Vec<String>, &str) {
    let mut path = Vec::new();
    loop {
        let word = word_of(rest);
        path.push(word.to_owned());
        rest = &rest[word.len()..];
        match rest.strip_prefix("::") {
            Some(after) if after.starts_with(is_word) => rest = after,
            _ => return (path, rest),
        }
    }
}

/// Adds the paths of the `use` tree `tree` below `head`.
fn expand(head: &[String], tree: &str, paths: &mut Vec<Vec<String>>) {
    let tree = tree.trim();
    let (plain, group) = match tree.split_once('{') {
        Some((plain, group)) => (plain, group.rsplit_once('}').map(|(group, _)| group)),
        None => (tree, None),
    };
    let plain = plain.split(" as ").next().unwrap_or(plain);
    let mut path = head.to_vec();
    path.extend(plain.split("::").map(str::trim).filter(|s| !s.is_empty()).map(str::to_owned));
    let Some(group) = group else {
        if path.last().is_some_and(|last| last == "self") && path.len() > 1 {
            path.pop();
        }
        if !path.is_empty() {
            paths.push(path);
        }
        return;
    };
    let (mut depth, mut start) = (0, 0);
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                expand(&path, &group[start..at], paths);
                start = at + 1;
            }
            _ => {}
        }
    }
    expand_last(&path, &group[start..], paths);
}

/// As [`expand`], for what follows the last comma, which may be nothing.
fn expand_last(head: &[String], tree: &str, paths: &mut Vec<Vec<String>>) {
    if !tree.trim().is_empty() {
        expand(head, tree, paths);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(code: &str) -> Vec<String> {
        paths(code).iter().map(|path| path.join("::")).collect()
    }

    #[test]
    fn comments_strings_and_characters_are_blanked() {
        let text = "let a = \"x // {\"; // b::c\nlet d = '{'; let e: &'a str = r#\"f::g \"h\" \"#; /* i */ '\\''.j";
        let code = code_of(text);
        assert_eq!(code.lines().count(), 2);
        for gone in ['{', '"', '/', 'f', 'i', 'h', 'x'] {
            assert!(!code.replace("let", "").replace("str", "").contains(gone), "{gone}: {code}");
        }
        assert!(code.contains("&'a str") && code.ends_with(".j"), "{code}");
    }

    #[test]
    fn paths_are_spelled_out() {
        let code =
            "use a::{b, c::{d, self}, e as f};\npub use g;\nfn h() { i::j::k(); l.m::<n::O>(); }";
        assert_eq!(joined(code), ["a::b", "a::c::d", "a::c", "a::e", "g", "i::j::k", "n::O"]);
        assert_eq!(joined("use super::*;"), ["super::*"]);
    }

    #[test]
    fn tests_are_apart() {
        let code =
            "mod a;\n#[cfg(test)]\nmod b;\nfn c() {}\n#[cfg(test)]\nmod tests {\n use d::e;\n}\n";
        assert_eq!(product_of(code), "mod a;\n#[cfg(test)]\nmod b;\nfn c() {}\n");
        assert_eq!(test_modules(code), ["b"]);
    }
}
