//! Links between pages lead somewhere.

use super::Finding;
use std::path::Path;

/// Adds every link of the Markdown page `file` (relative to `root`) that leads to no file of the repository.
pub(super) fn check(root: &Path, file: &Path, text: &str, findings: &mut Vec<Finding>) {
    if file.extension().is_none_or(|extension| extension != "md") {
        return;
    }
    let folder = root.join(file.parent().unwrap_or(Path::new("")));
    for (index, line) in text.lines().enumerate() {
        for part in line.split("](").skip(1) {
            let Some(target) = part.split(')').next() else { continue };
            let path = target.split(['#', ' ']).next().unwrap_or(target);
            let is_elsewhere = target.contains("://") || target.starts_with("mailto:");
            if !path.is_empty() && !is_elsewhere && !folder.join(path).exists() {
                let message = format!("the link to {path} leads nowhere");
                findings.push(Finding { file: file.to_owned(), line: Some(index + 1), message });
            }
        }
    }
}
