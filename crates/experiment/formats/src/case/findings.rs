//! What is wrong with a case file, gathered while it is read: all of it, or the first hundred.

use super::document::{Entry, Value, find};
use super::error::{MOST_PROBLEMS, Problem, ProblemKind};
use super::sources::Sources;
use super::spelling::{list, nearest};
use basis::keys::Objection;
use std::cell::RefCell;
use std::ops::Range;

/// What was found wrong so far.
pub(super) struct Findings<'a> {
    sources: &'a Sources,
    /// Names of the turbines, which other keys may say.
    turbines: Vec<&'a str>,
    problems: RefCell<Vec<Problem>>,
}

impl<'a> Findings<'a> {
    /// None so far in the file of `entries`.
    pub(super) fn new(entries: &'a [Entry], sources: &'a Sources) -> Self {
        let turbines = match find(entries, "turbine").map(|entry| &entry.node.value) {
            Some(Value::List(items)) => {
                items.iter().filter_map(|item| name_of(&item.value)).collect()
            }
            _ => Vec::new(),
        };
        Self { sources, turbines, problems: RefCell::new(Vec::new()) }
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

    /// Notes `objections` to the table at `path`, whose keys stand where `place_of` says; none is the table.
    pub(super) fn object(
        &self,
        path: &str,
        place_of: impl Fn(Option<&str>) -> Range<usize>,
        objections: Vec<Objection>,
    ) {
        for Objection { key, message, label, fix } in objections {
            let message = match key {
                Some(key) => format!("`{path}.{key}` {message}"),
                None => message,
            };
            self.note(place_of(key), ProblemKind::Objection { message, label }, Some(fix));
        }
    }

    /// Whether there is a turbine `name`; notes at `span` when there is none, as the value of `key` or as the
    /// key itself.
    pub(super) fn is_turbine(&self, key: String, name: &str, span: &Range<usize>) -> bool {
        let names = || self.turbines.iter().copied();
        let is_there = names().any(|other| other == name);
        if !is_there {
            let known = list(names());
            let kind =
                ProblemKind::UnknownName { key, what: "turbine", name: name.to_owned(), known };
            let fix = nearest(name, names()).map(|name| format!("did you mean `{name}`?"));
            self.note(span.clone(), kind, fix);
        }
        is_there
    }

    pub(super) fn into_problems(self) -> Vec<Problem> {
        self.problems.into_inner()
    }
}

/// The `name` of a table.
fn name_of(value: &Value) -> Option<&str> {
    let Value::Table(entries) = value else { return None };
    match &find(entries, "name")?.node.value {
        Value::Text(name) => Some(name),
        _ => None,
    }
}
