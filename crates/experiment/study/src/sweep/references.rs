//! Runs that take a reference from another run: that one is made first, by whichever of the studies.

use super::Opened;
use crate::StudyError;
use crate::linear_laws::{not_complete, reference_run};
use crate::prepared::Prepared;
use formats::FileError;
use formats::records::RunFolder;
use std::cmp::Reverse;
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

/// Which of the runs in folders `own` each takes a reference from, whose folders are its `needs`; folders of
/// no such run are left out.
fn among(own: &[PathBuf], needs: &[Vec<PathBuf>]) -> Vec<Vec<usize>> {
    let of = |needed: &PathBuf| own.iter().position(|folder| folder == needed);
    needs.iter().map(|needed| needed.iter().filter_map(of).collect()).collect()
}

/// An order of runs in folders `own`, and the places in it of those that each takes a reference from, whose
/// folders are its `needs`: those come first, through however many others they are needed, else nothing
/// moves. Rings, in which there is no such order, are [refused](check) before.
pub(super) fn in_order(own: &[PathBuf], needs: &[Vec<PathBuf>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let needs = among(own, needs);
    // How many runs stand in a row behind each that cannot be made before it.
    let mut behind = vec![0_usize; own.len()];
    for _ in 0..own.len() {
        let before = behind.clone();
        for (run, needed) in needs.iter().enumerate() {
            for &needed in needed {
                behind[needed] = behind[needed].max(behind[run] + 1);
            }
        }
        if behind == before {
            break;
        }
    }
    let mut order: Vec<usize> = (0..own.len()).collect();
    order.sort_by_key(|run| Reverse(behind[*run]));
    let after = |(place, run): (usize, &usize)| -> Vec<usize> {
        (0..place).filter(|other| needs[*run].contains(&order[*other])).collect()
    };
    let after = order.iter().enumerate().map(after).collect();
    (order, after)
}

/// Runs each of which takes its reference from the next one, and the last from the first; none where no such
/// ring is among those that take references from their `needs`.
fn ring(needs: &[Vec<usize>]) -> Option<Vec<usize>> {
    let mut left: Vec<usize> = (0..needs.len()).collect();
    loop {
        let waits = |run: &usize| needs[*run].iter().any(|needed| left.contains(needed));
        let waiting: Vec<usize> = left.iter().copied().filter(waits).collect();
        if waiting.len() == left.len() {
            break;
        }
        left = waiting;
    }
    let mut walk = vec![*left.first()?];
    loop {
        let next = *needs[*walk.last()?].iter().find(|needed| left.contains(needed))?;
        if let Some(first) = walk.iter().position(|run| *run == next) {
            return Some(walk.split_off(first));
        }
        walk.push(next);
    }
}

/// Nothing where every run of reference of an open run of `studies` is complete, or is made with them before
/// it.
///
/// # Errors
/// [`StudyError::File`].
pub(super) fn check(studies: &[Opened]) -> Result<(), StudyError> {
    let (mut open, mut needs) = (Vec::new(), Vec::new());
    for Opened { study, prepared, .. } in studies {
        for &index in &study.open {
            open.push(place(study.folders[index].path()));
            needs.push((places(prepared, index), &prepared.case.runs[index].name));
        }
    }
    for (places, run) in &needs {
        for needed in places {
            if !open.contains(needed) && !RunFolder::new(needed, "").is_complete() {
                return Err(not_complete(needed, run).into());
            }
        }
    }
    let needs: Vec<Vec<PathBuf>> = needs.into_iter().map(|(places, _)| places).collect();
    match ring(&among(&open, &needs)) {
        Some(ring) => {
            Err(in_a_ring(&ring.iter().map(|&run| &*open[run]).collect::<Vec<_>>()).into())
        }
        None => Ok(()),
    }
}

/// That the runs in folders `ring`, one or more, each wait for the next one, and the last for the first.
fn in_a_ring(ring: &[&Path]) -> FileError {
    let others: Vec<String> =
        ring[1..].iter().chain(&ring[..1]).map(|run| run.display().to_string()).collect();
    let problem = format!(
        "its `reference_run` leads back to it, so that none of them can be made first: it takes its reference from {}",
        others.join(", which takes its own from ")
    );
    let fix = "give one of them `reference_tilt` and `reference_yaw` in the place of `reference_run`, or name a run there that takes no reference from these";
    FileError::content("a run of reference", ring[0], problem, fix)
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
    fn a_chain_of_references_is_made_from_its_end() {
        // The first takes its reference from the second, that from the third, that from the last.
        let own = ["a", "b", "c", "alone", "d"].map(PathBuf::from);
        let from = |index: usize| vec![own[index].clone()];
        let needs = [from(1), from(2), from(4), vec![PathBuf::from("elsewhere")], vec![]];
        let (order, after) = in_order(&own, &needs);
        assert_eq!(order, [4, 2, 1, 0, 3]);
        assert_eq!(after, [vec![], vec![0], vec![1], vec![2], vec![]]);
        assert_eq!(ring(&among(&own, &needs)), None);
    }

    #[test]
    fn a_ring_of_references_is_found_and_told() {
        // The first waits for the ring without being of it, the last for nobody.
        let needs = [vec![1], vec![5, 3], vec![1], vec![4], vec![2], vec![]];
        assert_eq!(ring(&needs), Some(vec![1, 3, 4, 2]));
        assert_eq!(ring(&[vec![], vec![1]]), Some(vec![1]));
        assert_eq!(ring(&[]), None);
        let said = in_a_ring(&["out/a", "out/b"].map(Path::new)).to_string();
        assert!(said.contains("`reference_run`") && said.contains("out/a"), "{said}");
        assert!(said.contains("from out/b, which takes its own from out/a"), "{said}");
        let said = in_a_ring(&[Path::new("out/a")]).to_string();
        assert!(said.contains("takes its reference from out/a"), "{said}");
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
