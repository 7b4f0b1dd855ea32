//! Runs that take a reference from another run: that one is made first, by whichever of the studies.

use super::Opened;
use crate::StudyError;
use crate::linear_laws::{not_complete, reference_run};
use crate::prepared::Prepared;
use formats::records::RunFolder;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// Time between looks at whether a run of reference is complete.
const WAIT: Duration = Duration::from_millis(50);

/// Which of some runs are made, for those that wait for one. Runs of reference come before those that take
/// theirs from them, so that whoever makes one is at it.
pub(super) struct MadeSoFar(Vec<AtomicBool>);

impl MadeSoFar {
    /// None of `n_runs` (–).
    pub(super) fn of(n_runs: usize) -> Self {
        Self((0..n_runs).map(|_| AtomicBool::new(false)).collect())
    }

    /// The run at `place` is made.
    pub(super) fn add(&self, place: usize) {
        self.0[place].store(true, Ordering::Release);
    }

    /// Waits for those at the places `after`; whether all are made, and not all `is_over` before.
    pub(super) fn wait(&self, after: &[usize], is_over: impl Fn() -> bool) -> bool {
        while !after.iter().all(|&place| self.0[place].load(Ordering::Acquire)) {
            if is_over() {
                return false;
            }
            std::thread::sleep(WAIT);
        }
        true
    }
}

/// Sets what it holds where its thread panics, so that others do not wait for it.
pub(super) struct ToldOfPanic<'a>(pub(super) &'a AtomicBool);

impl Drop for ToldOfPanic<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

/// `path` as others that mean the same folder have it, whether it is there or not.
pub(super) fn place(path: &Path) -> PathBuf {
    if let Ok(there) = path.canonicalize() {
        return there;
    }
    let mut place = PathBuf::new();
    for component in std::path::absolute(path).unwrap_or_else(|_| path.to_owned()).components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                place.pop();
            }
            component => place.push(component),
        }
    }
    place
}

/// Folders of the runs that run number `index` of `prepared` takes references from.
pub(super) fn places(prepared: &Prepared, index: usize) -> Vec<PathBuf> {
    let controls = prepared.case.runs[index].control.iter();
    let runs = controls.filter_map(reference_run);
    runs.map(|run| place(&prepared.folder().join(run))).collect()
}

/// An order of runs in folders `own`, and the places in it of those that each takes a reference from, whose
/// folders are its `needs`: those come first, else nothing moves.
pub(super) fn in_order(own: &[PathBuf], needs: &[Vec<PathBuf>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let mut order: Vec<usize> = (0..own.len()).collect();
    order.sort_by_key(|run| !needs.iter().flatten().any(|needed| *needed == own[*run]));
    let after = |(place, run): (usize, &usize)| -> Vec<usize> {
        let before = order[..place].iter().enumerate();
        before.filter(|(_, other)| needs[*run].contains(&own[**other])).map(|(p, _)| p).collect()
    };
    let after = order.iter().enumerate().map(after).collect();
    (order, after)
}

/// Nothing where every run of reference of an open run of `studies` is complete, or is made with them.
///
/// # Errors
/// [`StudyError::File`].
pub(super) fn check(studies: &[Opened]) -> Result<(), StudyError> {
    let open = studies.iter().flat_map(|opened| {
        opened.study.open.iter().map(|&index| place(opened.study.folders[index].path()))
    });
    let open: Vec<PathBuf> = open.collect();
    for Opened { study, prepared, .. } in studies {
        for &index in &study.open {
            for needed in places(prepared, index) {
                let own = place(study.folders[index].path());
                let is_made = open.contains(&needed) && needed != own;
                if !is_made && !RunFolder::new(&needed, "").is_complete() {
                    return Err(not_complete(&needed, &prepared.case.runs[index].name).into());
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_referred_to_comes_first_and_nothing_else_moves() {
        let own = ["a/baseline", "a/closed", "b/open", "b/closed"].map(PathBuf::from);
        let needs = [vec![], vec![own[2].clone()], vec![], vec![own[2].clone()]];
        let (order, after) = in_order(&own, &needs);
        assert_eq!(order, [2, 0, 1, 3]);
        assert_eq!(after, [vec![], vec![], vec![0], vec![0]]);
    }

    #[test]
    fn whoever_waits_goes_on_when_it_is_made_or_all_is_over() {
        let made = MadeSoFar::of(2);
        assert!(made.wait(&[], || true));
        assert!(!made.wait(&[1], || true));
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| made.wait(&[1], || false));
            made.add(1);
            assert!(waiting.join().unwrap());
        });
    }

    #[test]
    fn one_folder_has_one_place() {
        let here = std::env::current_dir().unwrap();
        let there = here.join("runs/none/open");
        assert_eq!(place(Path::new("cases/../runs/./none/open")), place(&there));
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        assert_eq!(place(&folder.path().join("a/../a")), place(&folder.path().join("a")));
    }
}
