//! Numbers and names of the command line, checked before any work is done.

use miette::{Result, miette};
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Most classes that ranges of loads may be sorted into (–): finer than a double tells apart loads.
const MOST_BINS: usize = 1_000_000;

/// A number that is one.
pub(crate) fn finite(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.abs() <= 1e12);
    number.ok_or_else(|| format!("\"{text}\" is no number from -1e12 to 1e12"))
}

/// A number above zero.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    finite(text)
        .ok()
        .filter(|number| *number > 0.0)
        .ok_or_else(|| format!("\"{text}\" is no number above zero and up to 1e12"))
}

/// A number of bins.
pub(crate) fn bins(text: &str) -> Result<NonZeroUsize, String> {
    let bins = text.trim().parse().ok().filter(|bins: &NonZeroUsize| bins.get() <= MOST_BINS);
    bins.ok_or_else(|| {
        format!("\"{text}\" is no number of bins: give 1 to {MOST_BINS}, such as 200")
    })
}

/// Most winds that one command makes (–): a study each.
const MOST_SEEDS: usize = 1000;
/// Most runs at a time (–).
const MOST_JOBS: usize = 1024;

/// A number of winds.
pub(crate) fn seeds(text: &str) -> Result<usize, String> {
    count(text, 2, MOST_SEEDS, "winds")
}

/// A number of runs at a time.
pub(crate) fn jobs(text: &str) -> Result<usize, String> {
    count(text, 1, MOST_JOBS, "runs at a time")
}

/// A whole number of `what` between `least` and `most`.
pub(crate) fn count(text: &str, least: usize, most: usize, what: &str) -> Result<usize, String> {
    let count = text.trim().parse().ok().filter(|count| (least..=most).contains(count));
    count.ok_or_else(|| format!("\"{text}\" is no number of {what}: give {least} to {most}"))
}

/// Nothing when each of `files` can be made where it is to stand: there is none yet, or `overwrite` gives it
/// up, and its folder is there.
///
/// # Errors
/// The first that cannot, with the fix.
pub(crate) fn check_free(files: &[PathBuf], overwrite: bool) -> Result<()> {
    for file in files {
        let place = file.display();
        if fs::symlink_metadata(file).is_ok() {
            if file.is_dir() {
                return Err(miette!(help = "name a file in it", "{place} is a folder"));
            }
            if !overwrite {
                return Err(miette!(
                    help = "give another name, or --overwrite to lose what is there",
                    "{place} is there already"
                ));
            }
        }
        let above = file.parent().filter(|above| !above.as_os_str().is_empty());
        let folder = above.unwrap_or(Path::new("."));
        if !folder.is_dir() {
            let folder = folder.display();
            return Err(miette!(help = "make it, or name another", "there is no folder {folder}"));
        }
        wakemix::formats::atomic::check_folder(folder)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_numbers() {
        assert_eq!((finite("-3.5"), positive(" 2")), (Ok(-3.5), Ok(2.0)));
        for text in ["nan", "inf", "-inf", "1e308", "noon"] {
            assert!(finite(text).is_err() && positive(text).is_err(), "{text}");
        }
        assert!(positive("0").is_err() && positive("-1").is_err());
        assert_eq!(bins("200").map(NonZeroUsize::get), Ok(200));
        assert_eq!((seeds("5"), jobs("1")), (Ok(5), Ok(1)));
        assert!(seeds("1").unwrap_err().contains("2 to 1000") && jobs("0").is_err());
        for text in ["0", "4000000000", "-1", "few"] {
            assert!(bins(text).unwrap_err().contains("1 to 1000000"), "{text}");
        }
    }

    #[test]
    fn what_is_there_is_not_lost() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("case.toml");
        assert!(check_free(std::slice::from_ref(&file), false).is_ok());
        fs::write(&file, "mine").unwrap();
        let refused = check_free(std::slice::from_ref(&file), false).unwrap_err().to_string();
        assert!(refused.contains("is there already"), "{refused}");
        assert!(check_free(std::slice::from_ref(&file), true).is_ok());
        assert!(check_free(&[folder.path().to_owned()], true).is_err());
        assert!(check_free(&[folder.path().join("none/a.bts")], true).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
