//! `wakemix report`: the page and figures of a study, made anew from its records.

use super::output::{detail, print};
use miette::Result;
use std::path::Path;

/// Rebuilds the report of the study in `directory`; its path goes to stdout.
pub(crate) fn run(directory: &Path) -> Result<()> {
    let (summaries, page) = wakemix::postprocessing::report(directory)?;
    detail(&format!("read: {} runs in {}", summaries.len(), directory.display()));
    print(&format!("{}\n", page.display()))
}
