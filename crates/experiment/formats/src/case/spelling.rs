//! Names in sentences: lists of them, and which known one a misspelt one may have meant.

/// The name that `misspelt` may have meant, when one is near enough: a third of its letters wrong at most.
pub(crate) fn nearest<'n>(misspelt: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    // A name of any length can stand in a file; only what might be near is measured.
    if misspelt.len() > 80 {
        return None;
    }
    names
        .map(|name| (edits(&misspelt.to_lowercase(), &name.to_lowercase()), name))
        .filter(|(edits, name)| 3 * edits <= misspelt.chars().count().max(name.chars().count()))
        .min_by_key(|(edits, _)| *edits)
        .map(|(_, name)| name)
}

/// `a, b, c`, each in backticks.
pub(super) fn list<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Insertions, deletions, replacements and swaps of neighbours from `a` to `b` (Damerau's distance,
/// restricted).
fn edits(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![vec![0; b.len() + 1]; a.len() + 1];
    for i in 0..=a.len() {
        for j in 0..=b.len() {
            rows[i][j] = if i == 0 || j == 0 {
                i + j
            } else {
                let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
                let mut least = replaced.min(rows[i - 1][j] + 1).min(rows[i][j - 1] + 1);
                if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                    least = least.min(rows[i - 2][j - 2] + 1);
                }
                least
            };
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_edits_and_finds_the_near() {
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("seped", "speed"), 1);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(
            nearest("turbulence_intensty", ["speed", "turbulence_intensity"].into_iter()),
            Some("turbulence_intensity")
        );
        assert_eq!(nearest("colour", ["speed", "seed"].into_iter()), None);
    }
}
