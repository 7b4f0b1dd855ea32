//! Threads that a case asks for, against the cores of this machine.

use crate::StudyError;
use formats::case::{CaseFile, objection};
use std::thread;

/// Threads for each core beyond which a step takes longer than anybody waits (–): all of them wait for each
/// other.
const MOST_PER_CORE: usize = 16;

/// Cores that this process may use (–).
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// Nothing when the case of `file` asks for no more threads than this machine can carry.
///
/// # Errors
/// [`StudyError::Case`] at `flow.threads`.
pub(crate) fn check(file: &CaseFile) -> Result<(), StudyError> {
    let (n_cores, most) = (cores(), MOST_PER_CORE * cores());
    match file.case.flow.threads {
        Some(threads) if threads > most => {
            let message = format!(
                "flow.threads = {threads} on {n_cores} cores would wait for each other more than compute; at most {most}, or leave the key out"
            );
            Err(StudyError::Case(objection(file, &["flow", "threads"], message)))
        }
        _ => Ok(()),
    }
}
