//! `[sweep]`: lists of values for keys, and the cases that every combination of them makes.
//!
//! Keys of `control` and `run` make more runs of one study; all others make more studies, for a study has one
//! wind and one layout. Values stand in the trees of these cases with their places in the list, so that
//! whatever is wrong with one of them points there.

mod names;
mod runs;

use super::document::{Entry, Node, Value, find, insert};
use super::error::{Problem, ProblemKind};
use super::sources::Sources;
use basis::records::{SWEEP_SCHEMA_VERSION, Setting, Sweep, SweptKey, SweptStudy, SweptValue};
use farm::case::{Case, Instruments, Placement};
use farm::solvers::WindSource;
use names::{labels, with_settings};
pub(super) use runs::takes;
use std::cell::RefCell;
use std::ops::Range;

/// Most studies of a sweep, and most runs of a study (–).
const MOST: usize = 1000;
/// The key of the seed of the wind.
pub(super) const SEED: &str = "wind.seed";

/// The cases that a file makes: one, or those of its sweep.
#[derive(Debug)]
pub(super) struct Expanded {
    /// The tree of each study.
    pub(super) studies: Vec<Vec<Entry>>,
    /// What is swept; none where nothing is.
    pub(super) sweep: Option<Sweep>,
    /// The tree as it stands in the file, without the sweep, and the places of values in it that others
    /// replace: they are in no study, and are to be sound all the same.
    pub(super) replaced: (Vec<Entry>, Vec<Range<usize>>),
}

/// One swept key with its list.
#[derive(Debug)]
struct Axis {
    path: Vec<String>,
    span: Range<usize>,
    /// Its end by which names call it.
    label: String,
    items: Vec<(SweptValue, Node)>,
}

impl Axis {
    fn key(&self) -> String {
        self.path.join(".")
    }

    fn segments(&self) -> Vec<&str> {
        self.path.iter().map(String::as_str).collect()
    }

    fn is_of_studies(&self) -> bool {
        !matches!(self.path[0].as_str(), "control" | "run")
    }

    fn setting(&self, place: usize) -> Setting {
        Setting { key: self.key(), value: self.items[place].0.clone() }
    }
}

/// The cases of the file of `entries`, whose own text has `length` bytes; what comes after it in `sources`
/// are overrides.
///
/// # Errors
/// Everything that is wrong with the sweep.
pub(super) fn expand(
    mut entries: Vec<Entry>,
    length: usize,
    sources: &Sources,
) -> Result<Expanded, Vec<Problem>> {
    let Some(place) = entries.iter().position(|entry| entry.key == "sweep") else {
        return Ok(Expanded { studies: vec![entries], sweep: None, replaced: Default::default() });
    };
    let table = entries.remove(place);
    let sweeping = Sweeping { sources, length, replaced: RefCell::default() };
    let axes = sweeping.axes(&table)?;
    sweeping.check_overrides(&axes, &entries)?;
    let (of_studies, of_runs): (Vec<&Axis>, Vec<&Axis>) =
        axes.iter().partition(|axis| axis.is_of_studies());
    let mut studies = Vec::new();
    let (mut swept_studies, mut swept_runs) = (Vec::new(), Vec::new());
    for choice in sweeping.combinations(&of_studies, "studies", &table.key_span)? {
        let mut tree = entries.clone();
        let mut settings = Vec::with_capacity(of_studies.len());
        for (axis, &place) in of_studies.iter().zip(&choice) {
            sweeping.put(&mut tree, axis, &axis.segments(), place)?;
            settings.push(axis.setting(place));
        }
        swept_runs = sweeping.runs(&mut tree, &of_runs)?;
        let folder = with_settings("", &of_studies, &settings);
        swept_studies.push(SweptStudy { folder, settings });
        studies.push(tree);
    }
    let keys = axes.iter().map(|axis| SweptKey {
        key: axis.key(),
        label: axis.label.clone(),
        of_studies: axis.is_of_studies(),
    });
    let sweep = Sweep {
        schema_version: SWEEP_SCHEMA_VERSION,
        case: name_of(&entries),
        keys: keys.collect(),
        studies: swept_studies,
        runs: swept_runs,
    };
    let replaced = (entries, sweeping.replaced.into_inner());
    Ok(Expanded { studies, sweep: Some(sweep), replaced })
}

/// The `name` of the case of `entries`; empty where it has none, which is noted elsewhere.
fn name_of(entries: &[Entry]) -> String {
    match find(entries, "name").map(|entry| &entry.node.value) {
        Some(Value::Text(name)) => name.clone(),
        _ => String::new(),
    }
}

/// Where problems of a sweep are told.
struct Sweeping<'a> {
    sources: &'a Sources,
    /// Bytes of the file; what is beyond comes from overrides.
    length: usize,
    /// Places of values that others replace.
    replaced: RefCell<Vec<Range<usize>>>,
}

impl Sweeping<'_> {
    fn problem(
        &self,
        span: &Range<usize>,
        message: String,
        label: &'static str,
        fix: impl Into<String>,
    ) -> Problem {
        let kind = ProblemKind::Objection { message, label };
        Problem::new(self.sources, span.clone(), kind).with_fix(Some(fix.into()))
    }

    fn is_override(&self, span: &Range<usize>) -> bool {
        span.start > self.length
    }

    /// The swept keys of the table `sweep`.
    fn axes(&self, sweep: &Entry) -> Result<Vec<Axis>, Vec<Problem>> {
        const FIX: &str = "write [sweep] and below it \"control.T1.strouhal\" = [0.2, 0.25]";
        let Value::Table(entries) = &sweep.node.value else {
            let message = format!("`sweep` must be a table, found {}", sweep.node.kind());
            return Err(vec![self.problem(&sweep.node.span, message, "not a table", FIX)]);
        };
        let mut lists: Vec<(Vec<String>, &Entry)> = Vec::new();
        for (path, entry) in flat(entries, &[]) {
            match lists.iter_mut().find(|(known, _)| *known == path) {
                Some(known) if self.is_override(&entry.key_span) => known.1 = entry,
                Some(_) => {
                    let message = format!("`{}` is swept twice", path.join("."));
                    let fix = "leave one of them out";
                    return Err(vec![self.problem(&entry.key_span, message, "again", fix)]);
                }
                None => lists.push((path, entry)),
            }
        }
        if lists.is_empty() {
            let message = "`sweep` is empty".to_owned();
            return Err(vec![self.problem(&sweep.key_span, message, "nothing here", FIX)]);
        }
        let paths: Vec<&[String]> = lists.iter().map(|(path, _)| path.as_slice()).collect();
        let labels = labels(&paths);
        let axes = lists.into_iter().zip(labels);
        let (mut good, mut problems) = (Vec::new(), Vec::new());
        for ((path, entry), label) in axes {
            match self.axis(path, entry, label) {
                Ok(axis) => good.push(axis),
                Err(found) => problems.extend(found),
            }
        }
        if problems.is_empty() { Ok(good) } else { Err(problems) }
    }

    fn axis(&self, path: Vec<String>, entry: &Entry, label: String) -> Result<Axis, Vec<Problem>> {
        let key = path.join(".");
        if matches!(path[0].as_str(), "name" | "description") || path.last().is_some_and(is_name) {
            let fix = "leave it out: runs and studies of a sweep are named by their values";
            let message = format!("`{key}` cannot be swept");
            return Err(vec![self.problem(&entry.key_span, message, "a name", fix)]);
        }
        let Value::List(items) = &entry.node.value else {
            let message = format!("`sweep.{key}` must be a list, found {}", entry.node.kind());
            let fix = format!("write \"{key}\" = [ ... ] with the values to be taken");
            return Err(vec![self.problem(&entry.node.span, message, "must be a list", fix)]);
        };
        let mut values: Vec<(SweptValue, Node)> = Vec::with_capacity(items.len());
        for item in items {
            let Some(value) = value_of(item) else {
                let message = format!("`sweep.{key}` holds {}", item.kind());
                let fix = "give numbers, texts or lists of numbers";
                return Err(vec![self.problem(&item.span, message, "cannot be swept", fix)]);
            };
            if values.iter().any(|(other, _)| other.words() == value.words()) {
                let message = format!("`sweep.{key}` holds {} twice", value.words());
                return Err(vec![self.problem(
                    &item.span,
                    message,
                    "again",
                    "leave one of them out",
                )]);
            }
            values.push((value, item.clone()));
        }
        if values.is_empty() {
            let message = format!("`sweep.{key}` holds no value");
            let fix = "give one value or more, or leave the key out";
            return Err(vec![self.problem(&entry.node.span, message, "empty", fix)]);
        }
        Ok(Axis { path, span: entry.key_span.clone(), label, items: values })
    }

    /// Nothing where no override sets a key that is swept: it would have no effect.
    fn check_overrides(&self, axes: &[Axis], entries: &[Entry]) -> Result<(), Vec<Problem>> {
        for axis in axes.iter().filter(|axis| axis.is_of_studies()) {
            if let Some(node) = locate(entries, &axis.segments())
                && self.is_override(&node.span)
            {
                let key = axis.key();
                let message = format!("`{key}` is swept, so that to set it has no effect");
                let fix = format!("give other values with --set 'sweep.{key}=[...]'");
                return Err(vec![self.problem(&node.span, message, "no effect", fix)]);
            }
        }
        Ok(())
    }

    /// Every combination of values of `axes`, as their places in the lists; the last one changes fastest.
    fn combinations(
        &self,
        axes: &[&Axis],
        what: &str,
        span: &Range<usize>,
    ) -> Result<Vec<Vec<usize>>, Vec<Problem>> {
        let count = axes.iter().try_fold(1_usize, |n, axis| n.checked_mul(axis.items.len()));
        if count.is_none_or(|count| count > MOST) {
            let message = format!("the sweep makes more than {MOST} {what}");
            let fix = "give fewer values, or split the sweep into several cases";
            return Err(vec![self.problem(span, message, "too many", fix)]);
        }
        let mut all = vec![Vec::new()];
        for axis in axes {
            let longer = all.iter().flat_map(|choice: &Vec<usize>| {
                (0..axis.items.len()).map(|place| {
                    let mut choice = choice.clone();
                    choice.push(place);
                    choice
                })
            });
            all = longer.collect();
        }
        Ok(all)
    }

    /// Puts value number `place` of `axis` at `path` into `tree`.
    fn put(
        &self,
        tree: &mut Vec<Entry>,
        axis: &Axis,
        path: &[&str],
        place: usize,
    ) -> Result<(), Vec<Problem>> {
        let node = axis.items[place].1.clone();
        let old = locate(tree, path).map(|node| node.span.clone());
        let is_new = |span: &Range<usize>| !self.replaced.borrow().contains(span);
        if let Some(span) = old.filter(is_new) {
            self.replaced.borrow_mut().push(span);
        }
        insert(tree, path, node, axis.span.clone()).map_err(|why| {
            let message = format!("`{}` cannot be swept: {why}", axis.key());
            let fix = "name tables under one heading by their number, from 0, or their name";
            vec![self.problem(&axis.span, message, "no such place", fix)]
        })
    }
}

/// Whether a key with this last part is a name.
fn is_name(last: &String) -> bool {
    last == "name" || last == "compare_with"
}

/// The lists of a table and of those in it, each with its path; a quoted key may be a path of its own.
fn flat<'e>(entries: &'e [Entry], above: &[String]) -> Vec<(Vec<String>, &'e Entry)> {
    let mut found = Vec::new();
    for entry in entries {
        let mut path = above.to_vec();
        path.extend(entry.key.split('.').map(|part| part.trim().to_owned()));
        match &entry.node.value {
            Value::Table(inner) => found.extend(flat(inner, &path)),
            _ => found.push((path, entry)),
        }
    }
    found
}

/// The value of an item of a list; none of what cannot be swept.
pub(super) fn value_of(node: &Node) -> Option<SweptValue> {
    match &node.value {
        Value::Text(text) => Some(SweptValue::Text(text.clone())),
        Value::Whole(number) => i64::try_from((*number)?).ok().map(SweptValue::Whole),
        Value::Number(number) => Some(SweptValue::Number(*number)),
        Value::List(items) => {
            let number = |item: &Node| value_of(item)?.number();
            items.iter().map(number).collect::<Option<_>>().map(SweptValue::Numbers)
        }
        _ => None,
    }
}

/// What stands at `path` below `entries`.
pub(super) fn locate<'e>(entries: &'e [Entry], path: &[&str]) -> Option<&'e Node> {
    let (first, rest) = path.split_first()?;
    let node = &find(entries, first)?.node;
    match (&node.value, rest) {
        (_, []) => Some(node),
        (Value::Table(inner), _) => locate(inner, rest),
        (Value::List(items), [which, after @ ..]) => {
            let named = items.iter().find(|item| super::document::named(item, which));
            let item = named.or_else(|| items.get(which.parse::<usize>().ok()?))?;
            match (&item.value, after) {
                (_, []) => Some(item),
                (Value::Table(inner), _) => locate(inner, after),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Nothing where every one of `cases`, whose `sweep` may be over the seed of the wind, has a wind that the
/// seed changes.
///
/// # Errors
/// That a seed changes nothing.
pub(super) fn check_seeds(
    sweep: &Sweep,
    cases: &[Case],
    sources: &Sources,
) -> Result<(), Vec<Problem>> {
    if !sweep.keys.iter().any(|key| key.key == SEED) {
        return Ok(());
    }
    // The seed of the wind is that of the instruments' noise, too.
    let is_exact = |turbine: &Placement| {
        turbine.instruments == Instruments::default() && turbine.sensors.is_empty()
    };
    let is_still = |case: &Case| {
        let is_made = case.wind_source() != WindSource::Planes && !case.wind.is_brought();
        let is_turbulent = is_made && case.wind.turbulence_intensity > 0.0;
        !is_turbulent && case.turbines.iter().all(is_exact)
    };
    if !cases.iter().any(is_still) {
        return Ok(());
    }
    let message = "`wind.seed` is swept, and there is no turbulence that it would change";
    let kind = ProblemKind::Unfit { message: message.to_owned() };
    let fix = "give wind.turbulence_intensity and a flow.solver that makes turbulence, `lattice` or `turbulence`; \
               with recorded wind sweep wind.planes or wind.precursor";
    Err(vec![Problem::new(sources, 0..0, kind).with_fix(Some(fix.to_owned()))])
}
