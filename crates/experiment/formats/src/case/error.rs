//! What is wrong with a case file: where, what, and the fix.

use super::sources::Sources;
use crate::FileError;
use miette::{Diagnostic, LabeledSpan, NamedSource, SourceCode};
use std::fmt::{Display, Write};
use std::ops::Range;
use std::sync::Arc;
use thiserror::Error;

/// Longest line (bytes) that is drawn: what draws counts at most 65535 columns, and a tab takes several.
const LONGEST_DRAWN: usize = 2000;
/// Problems after which no more are looked for (–): who has so many has another kind of file.
pub(super) const MOST_PROBLEMS: usize = 100;
/// Lines that are drawn above and below a problem, and one.
const DRAWN_AROUND: usize = 2;

/// Why a case file cannot be run.
#[derive(Debug, Error, Diagnostic)]
pub enum CaseError {
    /// It could not be read.
    #[error(transparent)]
    #[diagnostic(transparent)]
    File(#[from] FileError),
    /// It was read, but something in it is wrong.
    #[error("{name} cannot be run: {}", amount(problems.len()))]
    #[diagnostic(code(wakemix::case))]
    Invalid {
        /// The file.
        name: String,
        /// Everything that is wrong, from top to bottom.
        #[related]
        problems: Vec<Problem>,
    },
}

/// In words, how many entries are wrong.
fn amount(n_problems: usize) -> String {
    match n_problems {
        1 => "1 of its entries is wrong".to_owned(),
        MOST_PROBLEMS => {
            format!("{n_problems} of its entries are wrong, or more: the rest is not looked at")
        }
        _ => format!("{n_problems} of its entries are wrong"),
    }
}

impl CaseError {
    /// Everything that is wrong; empty when the file could not be read.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::File(_) => &[],
            Self::Invalid { problems, .. } => problems,
        }
    }

    /// Without arrows: a line `file:line: problem; fix` for each problem.
    pub fn to_lines(&self) -> String {
        let mut lines = String::new();
        match self {
            Self::File(error) => {
                let _ = writeln!(lines, "{error}");
            }
            Self::Invalid { problems, .. } => {
                for problem in problems {
                    let _ = write!(lines, "{}:{}: {problem}", problem.file(), problem.line());
                    let _ = match problem.help() {
                        Some(help) => writeln!(lines, "; {help}"),
                        None => writeln!(lines),
                    };
                }
            }
        }
        lines
    }
}

/// One thing that is wrong, with its place.
#[derive(Debug, Error)]
#[error("{kind}")]
pub struct Problem {
    /// What is wrong.
    pub kind: ProblemKind,
    text: Arc<NamedSource<String>>,
    span: Range<usize>,
    fix: Option<String>,
}

impl Problem {
    pub(super) fn new(sources: &Sources, span: Range<usize>, kind: ProblemKind) -> Self {
        let (text, span) = sources.locate(span);
        let fix = kind.usual_fix();
        Self { kind, text, span, fix }
    }

    /// The same with a better `fix` than the usual one, where there is one.
    pub(super) fn with_fix(mut self, fix: Option<String>) -> Self {
        self.fix = fix.or(self.fix);
        self
    }

    /// Whether it stands in `place` of the case file.
    pub(super) fn stands_in(&self, place: &Range<usize>) -> bool {
        place.contains(&self.span.start)
    }

    /// Line in the file, from 1.
    pub fn line(&self) -> usize {
        let before = &self.text.inner().as_bytes()[..self.span.start];
        1 + before.iter().filter(|byte| **byte == b'\n').count()
    }

    /// Whether the lines around it are short enough to be drawn.
    fn can_be_drawn(&self) -> bool {
        let (before, after) = self.text.inner().as_bytes().split_at(self.span.start);
        let is_end = |byte: &u8| *byte == b'\n';
        let is_short = |line: &[u8]| line.len() <= LONGEST_DRAWN;
        let n_lines = after[..self.span.len()].iter().filter(|byte| is_end(byte)).count();
        let above = before.rsplit(is_end).take(1 + DRAWN_AROUND);
        let below = after.split(is_end).take(1 + n_lines + DRAWN_AROUND);
        above.chain(below).all(is_short)
    }

    /// The file, or `--set` for an override.
    pub fn file(&self) -> &str {
        self.text.name()
    }
}

impl Diagnostic for Problem {
    fn code(&self) -> Option<Box<dyn Display + '_>> {
        // Without a drawing the place stands here.
        let place = || Box::new(format!("{}:{}", self.file(), self.line())) as Box<dyn Display>;
        (!self.can_be_drawn()).then(place)
    }

    fn help(&self) -> Option<Box<dyn Display + '_>> {
        self.fix.as_ref().map(|fix| Box::new(fix) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.can_be_drawn().then_some(&self.text as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::new_with_span(Some(self.kind.label()), self.span.clone());
        Some(Box::new(std::iter::once(label)))
    }
}

/// What is wrong with one entry of a case file.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ProblemKind {
    /// It is not TOML.
    #[error("this is not TOML: {message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// No such key.
    #[error("there is no key `{key}`")]
    UnknownKey {
        /// Where it stands, dotted.
        key: String,
    },
    /// A value that the case's flow solver cannot take.
    #[error("{why}")]
    NotWithSolver {
        /// The flow solver.
        solver: &'static str,
        /// Why not.
        why: String,
    },
    /// A key that must be there is not.
    #[error("`{key}` is missing")]
    Missing {
        /// The key, dotted.
        key: String,
    },
    /// A value of another type.
    #[error("`{key}` must be {expected}, found {found}")]
    WrongType {
        /// The key, dotted.
        key: String,
        /// What it must be.
        expected: String,
        /// What it is.
        found: String,
    },
    /// A number outside its range.
    #[error("`{key}` = {value} is out of range: {range}")]
    OutOfRange {
        /// The key, dotted.
        key: String,
        /// The value as written.
        value: String,
        /// The range with its unit.
        range: String,
    },
    /// None of the words that may stand here.
    #[error("`{key}` = \"{value}\" is unknown; expected one of {known}")]
    UnknownChoice {
        /// The key, dotted.
        key: String,
        /// The word.
        value: String,
        /// The words that exist.
        known: String,
    },
    /// A name of nothing in the file.
    #[error("`{key}` names the {what} `{name}`, which the file does not have; it has {known}")]
    UnknownName {
        /// The key, dotted.
        key: String,
        /// `turbine` or `run`.
        what: &'static str,
        /// The name.
        name: String,
        /// The names that the file has.
        known: String,
    },
    /// A name that cannot name a folder, a channel or a key.
    #[error("`{key}` = \"{name}\" is not a valid name: use 1 to 64 letters, digits, `-` and `_`")]
    BadName {
        /// The key, dotted.
        key: String,
        /// What stands there.
        name: String,
    },
    /// A name given twice.
    #[error("the {what} name `{name}` is used twice")]
    Duplicate {
        /// `turbine` or `run`.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A name that the study's folder has in use.
    #[error("`{key}` cannot be that: {why}")]
    Taken {
        /// The key, dotted.
        key: String,
        /// Why not.
        why: String,
    },
    /// Turbines in each other's way.
    #[error(
        "turbines {first} and {second} overlap: they stand {distance:.2} diameters apart, at least 1 is needed"
    )]
    Overlap {
        /// One turbine.
        first: String,
        /// The other, at which the arrow points.
        second: String,
        /// Distance of their towers (diameters of the first turbine).
        distance: f64,
    },
    /// Nothing is left to analyse.
    #[error(
        "`time.duration` = {duration} s is not longer than `time.spin_up` = {spin_up} s: nothing is left to analyse"
    )]
    NothingAnalysed {
        /// Time in all (s).
        duration: f64,
        /// Time not analysed (s).
        spin_up: f64,
    },
    /// What would start after the end.
    #[error("`{key}` = {start} s is not before the end of the run, `time.duration` = {duration} s")]
    StartsTooLate {
        /// The key, dotted.
        key: String,
        /// Start (s).
        start: f64,
        /// End (s).
        duration: f64,
    },
    /// What a kind of controller or sensor objects to.
    #[error("{message}")]
    Objection {
        /// What is wrong.
        message: String,
        /// A word or two at its place.
        label: &'static str,
    },
    /// A key that another key's value leaves without use.
    #[error("`{key}` has no effect here: {why}")]
    NoUse {
        /// The key, dotted.
        key: String,
        /// Why.
        why: String,
    },
    /// A run compared with itself.
    #[error("run `{name}` is compared with itself")]
    ComparedWithItself {
        /// The run.
        name: String,
    },
    /// A run compared with one that is made after it.
    #[error("run `{name}` is compared with `{other}`, which comes after it")]
    ComparedWithLater {
        /// The run.
        name: String,
        /// The later one.
        other: String,
    },
    /// Nobody is there.
    #[error("run `{name}` has no turbine left: every one is absent")]
    NobodyThere {
        /// The run.
        name: String,
    },
    /// What the case's turbines make impossible.
    #[error("{message}")]
    Unfit {
        /// What does not fit, and the fix.
        message: String,
    },
    /// An override that cannot be applied.
    #[error("the override `{text}` cannot be applied: {why}")]
    Override {
        /// The override.
        text: String,
        /// Why.
        why: String,
    },
}

impl ProblemKind {
    /// How to fix it where nothing better is known.
    fn usual_fix(&self) -> Option<String> {
        Some(match self {
            Self::Syntax { .. } => {
                "TOML has `key = value`, text in quotes, and tables under their [heading]"
                    .to_owned()
            }
            Self::WrongType { expected, .. } => format!("write {expected} there"),
            Self::OutOfRange { range, .. } => format!("use a value in the range, {range}"),
            Self::UnknownName { known, .. } => format!("name one of {known}"),
            Self::StartsTooLate { .. } => {
                "begin earlier, or raise `time.duration`, which counts from the start of the run"
                    .to_owned()
            }
            Self::NobodyThere { .. } => "take `absent` from one of the turbines".to_owned(),
            Self::Override { .. } => "write key.path=value, such as wind.speed=8".to_owned(),
            _ => return None,
        })
    }

    fn label(&self) -> String {
        let words = match self {
            Self::Syntax { .. } => "here",
            Self::UnknownKey { .. } => "no such key",
            Self::Missing { .. } => "should stand in here",
            Self::NotWithSolver { solver, .. } => {
                return format!("not with flow.solver = \"{solver}\"");
            }
            Self::WrongType { expected, .. } => return format!("must be {expected}"),
            Self::OutOfRange { range, .. } => range,
            Self::UnknownChoice { .. } => "no such choice",
            Self::UnknownName { what, .. } => return format!("no such {what}"),
            Self::BadName { .. } => "not a name",
            Self::Duplicate { .. } | Self::Taken { .. } => "used already",
            Self::Overlap { .. } => "too close",
            Self::NothingAnalysed { .. } => "too short",
            Self::StartsTooLate { .. } => "too late",
            Self::Objection { label, .. } => label,
            Self::NoUse { .. } => "no effect",
            Self::ComparedWithItself { .. } => "itself",
            Self::ComparedWithLater { .. } => "comes later",
            Self::NobodyThere { .. } => "nobody there",
            Self::Unfit { .. } => "does not fit",
            Self::Override { .. } => "this override",
        };
        words.to_owned()
    }
}
