//! Names that tell the studies and runs of a sweep: the key's end and the value, such as `strouhal-0.25`.

use super::Axis;
use basis::records::Setting;

/// The shortest end of each of `paths` that no other has, its parts joined by dashes.
pub(super) fn labels(paths: &[&[String]]) -> Vec<String> {
    let end = |path: &[String], n: usize| path[path.len() - n.min(path.len())..].join("-");
    let label = |(index, path): (usize, &&[String])| {
        let others = || paths.iter().enumerate().filter(move |(other, _)| *other != index);
        let is_alone = |n: &usize| others().all(|(_, other)| end(other, *n) != end(path, *n));
        let n = (1..=path.len()).find(is_alone).unwrap_or(path.len());
        plain(&end(path, n))
    };
    paths.iter().enumerate().map(label).collect()
}

/// `name`, or nothing, with the `settings` of `axes` behind it.
pub(super) fn with_settings(name: &str, axes: &[&Axis], settings: &[Setting]) -> String {
    let mut parts: Vec<String> = if name.is_empty() { Vec::new() } else { vec![name.to_owned()] };
    for (axis, setting) in axes.iter().zip(settings) {
        parts.push(format!("{}-{}", axis.label, plain(&setting.value.words())));
    }
    parts.join("-")
}

/// `words` with a dash for everything that cannot stand in the name of a folder.
fn plain(words: &str) -> String {
    let may_stand = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    words.chars().map(|c| if may_stand(c) { c } else { '-' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_is_as_short_as_it_can_be() {
        let of = |keys: &[&str]| {
            let paths: Vec<Vec<String>> =
                keys.iter().map(|key| key.split('.').map(str::to_owned).collect()).collect();
            labels(&paths.iter().map(Vec::as_slice).collect::<Vec<_>>())
        };
        assert_eq!(of(&["wind.speed", "control.T1.strouhal"]), ["speed", "strouhal"]);
        let two = of(&["control.T1.strouhal", "control.T2.strouhal", "wind.seed"]);
        assert_eq!(two, ["T1-strouhal", "T2-strouhal", "seed"]);
    }
}
