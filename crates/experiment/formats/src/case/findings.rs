//! What is wrong with a case file, gathered while it is read: all of it, or the first hundred.

use super::document::Sources;
use super::error::{MOST_PROBLEMS, Problem, ProblemKind};
use std::cell::RefCell;
use std::ops::Range;

/// What was found wrong so far.
pub(super) struct Findings<'a> {
    sources: &'a Sources,
    problems: RefCell<Vec<Problem>>,
}

impl<'a> Findings<'a> {
    pub(super) fn new(sources: &'a Sources) -> Self {
        Self { sources, problems: RefCell::new(Vec::new()) }
    }

    /// Whether there are so many problems that no more are noted.
    pub(super) fn are_full(&self) -> bool {
        self.problems.borrow().len() >= MOST_PROBLEMS
    }

    /// Notes a problem at `span`, with the fix where one is known.
    pub(super) fn note(&self, span: Range<usize>, kind: ProblemKind, fix: Option<String>) {
        if self.are_full() {
            return;
        }
        let problem = Problem::new(self.sources, span, kind).with_fix(fix);
        self.problems.borrow_mut().push(problem);
    }

    pub(super) fn into_problems(self) -> Vec<Problem> {
        self.problems.into_inner()
    }
}
