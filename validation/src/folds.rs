//! Folds that keep what is not a number: `f64::max` drops it, and a claim would be met by what was never
//! measured.

/// The larger of `a` and `b`; not a number where either is none.
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The largest of `values`; not a number where one of them is none, and where there are no values.
pub(crate) fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().reduce(larger).unwrap_or(f64::NAN)
}

/// `one` over `other`; not a number where either is infinite, as the time is of what never settles.
pub(crate) fn ratio(one: f64, other: f64) -> f64 {
    if one.is_finite() && other.is_finite() { one / other } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Row;
    use crate::row::Tolerance::AtMost;
    use std::fs;
    use std::path::Path;

    #[test]
    fn what_is_not_a_number_is_the_worst() {
        assert_eq!(worst([1.0, -3.0, 2.0]), 2.0);
        for values in [&[f64::NAN, 1.0][..], &[1.0, f64::NAN], &[1.0, f64::NAN, 2.0], &[]] {
            let measured = worst(values.iter().copied());
            assert!(measured.is_nan(), "{values:?}");
            let what = "error".to_owned();
            let row =
                Row { what, measured, expected: 9.0, tolerance: AtMost, unit: "–", source: "" };
            assert!(!row.passes());
        }
        assert!(larger(0.0, f64::NAN).is_nan() && larger(f64::NAN, 0.0).is_nan());
    }

    #[test]
    fn nothing_is_a_share_of_what_never_settles() {
        assert_eq!(ratio(1.0, 2.0), 0.5);
        assert!(ratio(100.0, f64::INFINITY).is_nan() && ratio(f64::INFINITY, 100.0).is_nan());
    }

    /// Lines of the sources below `folder` in which a worst value is kept by `max`.
    fn folds_by_max(folder: &Path, found: &mut Vec<String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folds_by_max(&path, found);
            } else if !path.ends_with("folds.rs") {
                for line in fs::read_to_string(&path).unwrap().lines() {
                    // `worst = worst.max(…)`, or a fold.
                    let kept = line.split_once(" = ").is_some_and(|(name, value)| {
                        let name = name.trim().trim_start_matches('*');
                        value.trim_start_matches('*').starts_with(&format!("{name}.max("))
                    });
                    if kept || line.contains("f64::max") {
                        found.push(format!("{}: {}", path.display(), line.trim()));
                    }
                }
            }
        }
    }

    #[test]
    fn no_validation_keeps_its_worst_value_by_max() {
        let mut found = Vec::new();
        folds_by_max(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut found);
        assert!(found.is_empty(), "use folds::worst or folds::larger: {found:#?}");
    }
}
