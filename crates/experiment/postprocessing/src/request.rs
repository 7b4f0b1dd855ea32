//! What can be set of an analysis, and a request to it with what is set.

use report::text_table;
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Something that can be set of an analysis, and may be left out.
#[derive(Clone, Copy, Debug)]
pub struct AnalysisSetting {
    /// Name on the command line, after `--`.
    pub name: &'static str,
    /// What stands for its value in the help, such as `NAME`.
    pub value: &'static str,
    /// What it takes.
    pub takes: Takes,
    /// What it means, and what holds without it.
    pub about: &'static str,
}

/// What a setting takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// Any text.
    Text,
    /// Any text, more than once.
    Texts,
    /// A number.
    Number,
    /// One of some words, each with its meaning.
    Choice(&'static [(&'static str, &'static str)]),
}

/// What an analysis that takes long tells while it works.
#[derive(Clone, Copy, Debug)]
pub enum Told<'a> {
    /// What it will cost, in words.
    Cost(&'a str),
    /// Share of the work that is done (–).
    Share(f64),
}

/// What is done with what is told.
type Listener = dyn Fn(&Told) + Send + Sync;

/// Who is told while an analysis works; nobody at first.
#[derive(Clone, Default)]
pub struct Watch(Option<Arc<Listener>>);

impl Watch {
    /// `listener` is told.
    pub fn new(listener: impl Fn(&Told) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(listener)))
    }

    /// Tells who watches.
    pub(crate) fn tell(&self, told: &Told) {
        if let Some(listener) = &self.0 {
            listener(told);
        }
    }
}

impl fmt::Debug for Watch {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let who = if self.0.is_some() { "somebody" } else { "nobody" };
        formatter.debug_tuple("Watch").field(&who).finish()
    }
}

/// A request to an analysis.
#[derive(Clone, Debug, Default)]
pub struct Request {
    /// Folders of the records.
    pub folders: Vec<PathBuf>,
    /// What is set, as text, by the name of the setting.
    pub values: BTreeMap<String, Vec<String>>,
    /// Columns that tables of the text may take (–); those of [`text_table::WIDTH`] when left out.
    pub columns: Option<usize>,
    /// Who is told while it takes long.
    pub watch: Watch,
}

impl Request {
    /// The records in `folder`, nothing set.
    pub fn of(folder: impl Into<PathBuf>) -> Self {
        Self { folders: vec![folder.into()], ..Self::default() }
    }

    /// The same with the setting called `name`.
    pub fn with(mut self, name: &str, value: &str) -> Self {
        self.values.entry(name.to_owned()).or_default().push(value.to_owned());
        self
    }

    /// Columns that tables of the text may take (–).
    pub(crate) fn width(&self) -> usize {
        self.columns.unwrap_or(text_table::WIDTH)
    }

    /// Folder of the run, the first of the folders.
    pub fn run(&self) -> &Path {
        self.folders.first().map_or(Path::new(""), PathBuf::as_path)
    }

    /// The text of the setting called `name`.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.texts(name).first().map(String::as_str)
    }

    /// All texts of the setting called `name`.
    pub fn texts(&self, name: &str) -> &[String] {
        self.values.get(name).map_or(&[], Vec::as_slice)
    }

    /// The number of the setting called `name`; not a number where its text is none.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.text(name).map(|text| text.parse().unwrap_or(f64::NAN))
    }
}
