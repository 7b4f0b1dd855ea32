//! What the program says: data on standard output, all else on standard error. Nothing else writes there.
//!
//! A pipe that its reader has closed ends the program in silence, as it does other programs; a device that is
//! full is an error. Names come from files and may hold anything: what would steer a terminal is escaped.

use super::{BAD_INPUT, CLOSED_PIPE, manner};
use miette::{
    Diagnostic, LabeledSpan, MietteHandlerOpts, Report, ReportHandler, Result, SourceCode, miette,
};
use std::borrow::Cow;
use std::error::Error;
use std::fmt::{self, Display};
use std::io::{ErrorKind, Write, stderr, stdout};
use std::process::ExitCode;
use terminal_size::{Width, terminal_size_of};
use wakemix::report::text_table::{WIDTH, wrapped};

/// Writes `text`, as it is but for what steers terminals, to standard output.
///
/// # Errors
/// An output that takes no more, such as a full disk. Where nobody reads it any more the program ends.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut out = stdout().lock();
    match out.write_all(clean(text).as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => {
            std::process::exit(i32::from(CLOSED_PIPE))
        }
        Err(error) => Err(miette!(
            help = "free some space, or send the output elsewhere",
            "cannot write to standard output: {error}"
        )),
        Ok(()) => Ok(()),
    }
}

/// Columns for tables and sentences on standard output (–): those of the terminal where it is a narrow one.
pub(crate) fn columns() -> usize {
    terminal_size_of(stdout()).map_or(WIDTH, |(Width(width), _)| WIDTH.min(usize::from(width)))
}

/// Writes `text`, made for people, to standard output: long sentences wrap.
///
/// # Errors
/// Those of [`print`].
pub(crate) fn print_text(text: &str) -> Result<()> {
    print(&wrapped(text, columns()))
}

/// Writes `value`, made for other programs, to standard output.
///
/// # Errors
/// Those of [`print`].
pub(crate) fn print_json(value: &serde_json::Value) -> Result<()> {
    print(&format!("{value:#}\n"))
}

/// Writes the line `text`, a remark, to standard error, unless less is to be said.
pub(crate) fn tell(text: &str) {
    if manner::says_remarks() {
        say(text);
    }
}

/// Writes `text`, which a reader of the numbers must know, to standard error, unless not even that is to be
/// said.
pub(crate) fn warn(text: &str) {
    if manner::says_warnings() {
        say(&format!("warning: {text}"));
    }
}

/// Writes the line `text` to standard error where more is to be said.
pub(crate) fn detail(text: &str) {
    if manner::says_details() {
        say(text);
    }
}

/// Writes the line `text` to standard error; nobody can be reached when that fails.
pub(crate) fn say(text: &str) {
    let text = clean(text);
    // What goes into a file stays one line, which can be searched for.
    let text = match terminal_size_of(stderr()) {
        Some((Width(width), _)) => Cow::Owned(wrapped(&text, usize::from(width).max(20))),
        None => text,
    };
    let _ = writeln!(stderr(), "{text}");
}

/// Draws `report` on standard error; gives the exit code of bad input.
pub(crate) fn refuse(report: &Report) -> ExitCode {
    let _ = writeln!(stderr(), "{}", Drawn(Cleaned::of(&**report)));
    ExitCode::from(BAD_INPUT)
}

/// Prints what the reader of arguments has to say: help or version, or what is wrong with them.
pub(crate) fn usage(error: &clap::Error) -> ExitCode {
    let plain = error.render().to_string();
    // Words of the command line may be names of files, which may hold anything.
    let printed = match clean(&plain) {
        Cow::Borrowed(_) => error.print(),
        Cow::Owned(cleaned) => write!(stderr(), "{cleaned}"),
    };
    match printed {
        Ok(()) => ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(BAD_INPUT)),
        Err(refused) if refused.kind() == ErrorKind::BrokenPipe => ExitCode::from(CLOSED_PIPE),
        Err(refused) => refuse(&miette!("cannot write: {refused}")),
    }
}

/// `text` with control characters, line ends and tabs aside, as escapes that can be read.
pub(crate) fn clean(text: &str) -> Cow<'_, str> {
    let steers = |c: char| c.is_control() && !matches!(c, '\n' | '\t');
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut cleaned = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        // The line ends of some systems.
        let ends_line = c == '\r' && characters.peek() == Some(&'\n');
        if steers(c) && !ends_line { cleaned.extend(c.escape_default()) } else { cleaned.push(c) }
    }
    Cow::Owned(cleaned)
}

/// A diagnostic whose words cannot steer a terminal. What it draws of a file is clean already.
struct Cleaned<'d> {
    message: String,
    code: Option<String>,
    help: Option<String>,
    labels: Vec<LabeledSpan>,
    source_code: Option<&'d dyn SourceCode>,
    related: Vec<Cleaned<'d>>,
    cause: Option<Box<Cleaned<'d>>>,
}

impl<'d> Cleaned<'d> {
    fn of(diagnostic: &'d dyn Diagnostic) -> Self {
        let word = |word: Box<dyn Display + '_>| clean(&word.to_string()).into_owned();
        let label = |label: LabeledSpan| {
            let text = label.label().map(|text| clean(text).into_owned());
            LabeledSpan::new_with_span(text, *label.inner())
        };
        let deeper = diagnostic.diagnostic_source().map(Self::of);
        let deeper = deeper.or_else(|| diagnostic.source().map(Self::of_error));
        Self {
            message: clean(&diagnostic.to_string()).into_owned(),
            code: diagnostic.code().map(word),
            help: diagnostic.help().map(word),
            labels: diagnostic.labels().into_iter().flatten().map(label).collect(),
            source_code: diagnostic.source_code(),
            related: diagnostic.related().into_iter().flatten().map(Self::of).collect(),
            cause: deeper.map(Box::new),
        }
    }

    fn of_error(error: &dyn Error) -> Self {
        Self {
            message: clean(&error.to_string()).into_owned(),
            code: None,
            help: None,
            labels: Vec::new(),
            source_code: None,
            related: Vec::new(),
            cause: error.source().map(|error| Box::new(Self::of_error(error))),
        }
    }
}

impl Display for Cleaned<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl fmt::Debug for Cleaned<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl Error for Cleaned<'_> {}

impl Diagnostic for Cleaned<'_> {
    fn code(&self) -> Option<Box<dyn Display + '_>> {
        self.code.as_ref().map(|code| Box::new(code) as Box<dyn Display>)
    }

    fn help(&self) -> Option<Box<dyn Display + '_>> {
        self.help.as_ref().map(|help| Box::new(help) as Box<dyn Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.source_code
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        (!self.labels.is_empty()).then(|| Box::new(self.labels.iter().cloned()) as Box<_>)
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        let related = self.related.iter().map(|one| one as &dyn Diagnostic);
        (!self.related.is_empty()).then(|| Box::new(related) as Box<_>)
    }

    fn diagnostic_source(&self) -> Option<&dyn Diagnostic> {
        self.cause.as_deref().map(|cause| cause as &dyn Diagnostic)
    }
}

/// A diagnostic as a terminal shows it.
struct Drawn<'d>(Cleaned<'d>);

impl Display for Drawn<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let asked = manner::color();
        let opts = asked.map_or_else(MietteHandlerOpts::new, |color| {
            let opts = MietteHandlerOpts::new().color(color);
            if color { opts } else { opts.terminal_links(false) }
        });
        opts.build().debug(&self.0, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_can_be_read_instead() {
        assert_eq!(clean("a\tb\r\nc\n"), "a\tb\r\nc\n");
        assert_eq!(clean("\u{1b}[31mred\u{7}\u{9b}2J\r."), r"\u{1b}[31mred\u{7}\u{9b}2J\r.");
    }

    #[test]
    fn an_error_is_clean_down_to_its_cause() {
        let cause = std::io::Error::other("no \u{1b}[2J");
        let report = Report::from_err(cause).wrap_err("cannot open \u{1b}]0;x\u{7}");
        let report = miette!(help = "not \u{1b}[1m", "{}", report).wrap_err(format!("{report}"));
        let drawn = Drawn(Cleaned::of(&*report)).to_string();
        for raw in ["\u{1b}]0", "\u{1b}[2J", "\u{7}"] {
            assert!(!drawn.contains(raw), "{drawn:?}");
        }
        assert!(drawn.contains(r"cannot open \u{1b}]0;x\u{7}"), "{drawn}");
    }
}
