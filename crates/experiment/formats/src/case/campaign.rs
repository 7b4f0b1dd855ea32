//! The file of a campaign: one case and what is varied in it, read with the places and fixes of case files.

mod excluded;
mod levels;
mod places;
mod points;

use super::document::{self, Entry, Value, find};
use super::error::{CaseError, Problem, ProblemKind};
use super::findings::Findings;
use super::keys::CAMPAIGN;
use super::section::Section;
use super::sources::Sources;
use crate::{FileError, atomic};
use basis::records::SweptValue;
use levels::Levels;
use places::Places;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What stays of a task once it is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Its numbers.
    Summary,
    /// Its numbers, and series and manifest of each run.
    Series,
    /// Everything that a run leaves.
    All,
}

/// A key with the value that a level puts there.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelSetting {
    /// The key as the campaign names it.
    pub key: String,
    /// The keys of the case that it stands for, with the name of each run where it is one of controls.
    pub places: Vec<String>,
    /// The value as TOML.
    pub text: String,
    /// The value; as its TOML text where it is neither number nor text.
    pub value: SweptValue,
}

/// A level of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// What it is called: its value, or its name where it sets several keys.
    pub name: SweptValue,
    /// What it sets.
    pub settings: Vec<LevelSetting>,
}

/// What is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// Its key, or its name where its levels set several keys.
    pub name: String,
    /// Whether its levels set several keys and have names.
    pub is_linked: bool,
    /// Its levels.
    pub levels: Vec<Level>,
}

/// Values of which a task that has them all is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Exclusion {
    /// Keys or linked factors, each with its values.
    pub conditions: Vec<(String, Vec<SweptValue>)>,
}

/// A part of a campaign, drawn by chance.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// Combinations that are drawn (–).
    pub n: usize,
    /// Keys and linked factors that are not: what is drawn of the others is made with all of their levels.
    pub whole: Vec<String>,
}

/// A campaign as its file tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct CampaignFile {
    /// Its name.
    pub name: String,
    /// The case file, or the name of a case that comes with the program.
    pub case: PathBuf,
    /// What is varied; the last one, which changes fastest, is the seed where there are several.
    pub factors: Vec<Factor>,
    /// What is left out.
    pub excluded: Vec<Exclusion>,
    /// What of it is made; all without one.
    pub draw: Option<Draw>,
    /// Runs of the case that are made; all when empty.
    pub runs: Vec<String>,
    /// What stays of a task.
    pub keep: Keep,
    /// Names of the numbers to collect, `*` for any part; all when empty.
    pub collect: Vec<String>,
    /// Threads of a task (–).
    pub threads: Option<usize>,
    /// The file's text.
    pub text: String,
    /// The file.
    pub path: PathBuf,
}

/// Gives the text of the case of this name that comes with the program; none where none does.
pub type Shipped<'a> = &'a dyn Fn(&str) -> Option<String>;

/// Reads the file of a campaign at `path`, whose case may be one of those that `shipped` gives.
///
/// # Errors
/// [`CaseError::File`] when it, its case or its table cannot be read, [`CaseError::Invalid`] with everything
/// that is wrong in it.
pub fn read_campaign(path: &Path, shipped: Shipped) -> Result<CampaignFile, CaseError> {
    let text = atomic::read_text(path, "the file of a campaign")?;
    let name = path.display().to_string();
    let (sources, document) = document::parse(&name, &text, &[]);
    let invalid = |problems| CaseError::Invalid { name: name.clone(), problems };
    let entries = document.map_err(invalid)?;
    let (file, problems) = read_entries(path, &text, (&entries, shipped), &sources)?;
    if problems.is_empty() { Ok(file) } else { Err(invalid(problems)) }
}

/// `error` of a file that the campaign at `path` names: where to mend its name.
fn named_in(error: CaseError, path: &Path) -> CaseError {
    match error {
        CaseError::File(FileError::System { verb, what, path: named, fix, source }) => {
            let fix = format!("{fix} in {}", path.display());
            CaseError::File(FileError::System { verb, what, path: named, fix, source })
        }
        other => other,
    }
}

/// What `entries` of the file of `text` at `path` say, and everything that is wrong in them.
///
/// # Errors
/// [`CaseError`] of a case or a table that cannot be read.
fn read_entries(
    path: &Path,
    text: &str,
    (entries, shipped): (&[Entry], Shipped),
    sources: &Sources,
) -> Result<(CampaignFile, Vec<Problem>), CaseError> {
    let findings = Findings::new(entries, sources);
    let end = text.len().saturating_sub(1)..text.len();
    let root = Section::open(&CAMPAIGN, entries, end.clone(), String::new(), &findings);
    let folder = path.parent().unwrap_or(Path::new(""));
    let case = case_of(&root.text("case"), folder, shipped);
    let places = match root.has("case") {
        true => Places::read(&case, shipped).map_err(|error| named_in(error, path))?,
        false => Places::none(),
    };
    if places.sweeps {
        let message = "the case has a [sweep] of its own".to_owned();
        let fix = "leave it out of the case, and give its keys under [factors]";
        object(&findings, root.span_of("case"), message, "sweeps", fix);
    }
    let mut levels = Levels::new(text, &places, &findings);
    levels.read_factors(root.entry("factors"));
    levels.read_linked(root.entry("linked"));
    if let Some(name) = root.optional_text("table") {
        levels
            .read_table(&folder.join(name), &root.span_of("table"))
            .map_err(|error| named_in(error, path))?;
    }
    let seed_key = root.optional_text("seed_key").unwrap_or_else(|| super::sweep::SEED.to_owned());
    levels.read_seeds(&seed_key, root.entry("seeds"));
    let factors = levels.into_factors(&end);
    let draw = read_draw(&root, &factors, seed_key, &findings);
    let excluded = excluded::read(root.entry("exclude"), text, &factors, &findings);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let file = CampaignFile {
        name: root.optional_text("name").unwrap_or(stem),
        case,
        factors,
        excluded,
        draw,
        runs: texts(&root, "runs", &findings),
        keep: match root.choice("keep") {
            "series" => Keep::Series,
            "all" => Keep::All,
            _ => Keep::Summary,
        },
        collect: texts(&root, "collect", &findings),
        threads: root.optional_whole("threads").map(|threads| threads as usize),
        text: text.to_owned(),
        path: path.to_owned(),
    };
    drop(root);
    Ok((file, findings.into_problems()))
}

/// What of `factors` is drawn; seeds, under `seed_key`, are not.
fn read_draw(
    root: &Section,
    factors: &[Factor],
    seed_key: String,
    findings: &Findings,
) -> Option<Draw> {
    let mut whole = vec![seed_key];
    for name in texts(root, "draw_whole", findings) {
        let Some(factor) = factors.iter().find(|factor| factor.name == name) else {
            let message = format!("`draw_whole` names `{name}`, which is no factor");
            let factors: Vec<&str> = factors.iter().map(|factor| factor.name.as_str()).collect();
            let fix = format!("name some of {}", factors.join(", "));
            object(findings, root.span_of("draw_whole"), message, "no factor", &fix);
            continue;
        };
        let keys = factor.levels.iter().flat_map(|level| &level.settings);
        whole.extend(keys.map(|setting| setting.key.clone()));
        whole.push(name);
    }
    let n = root.optional_whole("draw");
    if n.is_none() && root.has("draw_whole") {
        let message = "`draw_whole` is there without `draw`".to_owned();
        object(
            findings,
            root.span_of("draw_whole"),
            message,
            "nothing is drawn",
            "add draw, or leave this out",
        );
    }
    n.map(|n| Draw { n: n as usize, whole })
}

/// The case that a campaign in `folder` calls `name`: a file beside it, or one that comes with the program.
fn case_of(name: &str, folder: &Path, shipped: Shipped) -> PathBuf {
    let beside = folder.join(name);
    if !beside.is_file() && shipped(name).is_some() { PathBuf::from(name) } else { beside }
}

/// Texts in the list of `key`.
fn texts(root: &Section, key: &str, findings: &Findings) -> Vec<String> {
    let Some(entry) = root.entry(key) else { return Vec::new() };
    let items = match &entry.node.value {
        Value::List(items) if !items.is_empty() => items.as_slice(),
        _ => &[],
    };
    let text = |item: &document::Node| match &item.value {
        Value::Text(text) => Some(text.clone()),
        _ => None,
    };
    let texts: Option<Vec<String>> = items.iter().map(text).collect();
    texts.filter(|texts| !texts.is_empty()).unwrap_or_else(|| {
        let message = format!("`{key}` must be a list of texts");
        let fix = format!("write {key} = [\"...\"], or leave it out");
        object(findings, entry.node.span.clone(), message, "not such a list", fix);
        Vec::new()
    })
}

/// Notes the objection `message` at `span`.
fn object(
    findings: &Findings,
    span: Range<usize>,
    message: String,
    label: &'static str,
    fix: impl Into<String>,
) {
    findings.note(span, ProblemKind::Objection { message, label }, Some(fix.into()));
}

/// The `name` of a table.
fn name_of(entries: &[Entry]) -> Option<&str> {
    match &find(entries, "name")?.node.value {
        Value::Text(name) => Some(name),
        _ => None,
    }
}

#[cfg(test)]
mod tests;
