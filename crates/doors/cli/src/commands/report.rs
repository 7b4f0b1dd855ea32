//! `wakemix report`: the page and figures of a study or a precursor, made anew from its records.

use super::output::{detail, print};
use miette::Result;
use std::path::Path;

/// Rebuilds the report of the study or precursor in `directory`; its path goes to stdout.
pub(crate) fn run(directory: &Path) -> Result<()> {
    let made = wakemix::postprocessing::report(directory)?;
    detail(&format!("read: {} runs in {}", made.summaries.len(), directory.display()));
    print(&format!("{}\n", made.page.display()))
}
