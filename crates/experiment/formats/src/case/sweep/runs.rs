//! The runs of a study that swept keys make of those in the file.

use super::names::with_settings;
use super::{Axis, Sweeping, locate};
use crate::case::document::{Entry, Node, Value, find};
use crate::case::error::Problem;
use crate::case::section::LONGEST_NAME;
use basis::records::SweptRun;
use control::CONTROLLERS;

/// A run that is made of one in the file.
struct Made {
    swept: SweptRun,
    table: Vec<Entry>,
    /// Its place in the file.
    span: std::ops::Range<usize>,
}

impl Sweeping<'_> {
    /// Puts the runs that `axes` make in the place of those of `tree`; gives them.
    pub(super) fn runs(
        &self,
        tree: &mut [Entry],
        axes: &[&Axis],
    ) -> Result<Vec<SweptRun>, Vec<Problem>> {
        let Some(entry) = tree.iter_mut().find(|entry| entry.key == "run") else {
            return Ok(Vec::new());
        };
        let Value::List(items) = &entry.node.value else { return Ok(Vec::new()) };
        let mut made: Vec<Made> = Vec::new();
        let mut taken = vec![false; axes.len()];
        for item in items {
            let Value::Table(table) = &item.value else { return Ok(Vec::new()) };
            let base = name_of(table);
            let takes = |axis: &&Axis| takes(table, &base, &axis.segments());
            let own: Vec<&Axis> = axes.iter().copied().filter(takes).collect();
            for (axis, taken) in axes.iter().zip(&mut taken) {
                *taken |= takes(axis);
            }
            for choice in self.combinations(&own, "runs of a study", &item.span)? {
                made.push(self.run(item, table, &base, &own, &choice)?);
            }
        }
        let untaken = axes.iter().zip(&taken).filter(|(_, taken)| !**taken);
        let problems: Vec<Problem> = untaken.map(|(axis, _)| self.untaken(axis, items)).collect();
        if !problems.is_empty() {
            return Err(problems);
        }
        compare(&mut made);
        let swept = made.iter().map(|made| made.swept.clone()).collect();
        let nodes =
            made.into_iter().map(|made| Node { value: Value::Table(made.table), span: made.span });
        entry.node.value = Value::List(nodes.collect());
        Ok(swept)
    }

    /// The run of `table`, called `base`, with the values of `axes` at `choice`.
    fn run(
        &self,
        item: &Node,
        table: &[Entry],
        base: &str,
        axes: &[&Axis],
        choice: &[usize],
    ) -> Result<Made, Vec<Problem>> {
        let mut table = table.to_vec();
        let mut settings = Vec::with_capacity(axes.len());
        for (axis, &place) in axes.iter().zip(choice) {
            let path = axis.segments();
            let path = if path[0] == "run" { &path[2..] } else { &path[..] };
            if let Some(node) = locate(&table, path)
                && self.is_override(&node.span)
            {
                let key = axis.key();
                let message = format!("`{key}` is swept, so that to set it has no effect");
                let fix = format!("give other values with --set 'sweep.{key}=[...]'");
                return Err(vec![self.problem(&node.span, message, "no effect", fix)]);
            }
            self.put(&mut table, axis, path, place)?;
            settings.push(axis.setting(place));
        }
        let run = with_settings(base, axes, &settings);
        if run.len() > LONGEST_NAME && !axes.is_empty() {
            let message =
                format!("a run of the sweep would be called `{run}`, longer than {LONGEST_NAME}");
            let fix = "shorten the name of the [[run]] in the file";
            return Err(vec![self.problem(&item.span, message, "too long a name", fix)]);
        }
        if let Some(entry) = table.iter_mut().find(|entry| entry.key == "name")
            && matches!(entry.node.value, Value::Text(_))
        {
            entry.node.value = Value::Text(run.clone());
        }
        let swept = SweptRun { run, base: base.to_owned(), settings };
        Ok(Made { swept, table, span: item.span.clone() })
    }

    /// That no run of `items` takes `axis`.
    fn untaken(&self, axis: &Axis, items: &[Node]) -> Problem {
        let (key, path) = (axis.key(), axis.segments());
        let names: Vec<String> = items
            .iter()
            .filter_map(|item| match &item.value {
                Value::Table(table) => Some(name_of(table)),
                _ => None,
            })
            .collect();
        let (message, fix) = match path[..] {
            ["run", name, ..] => (
                format!("there is no run `{name}` that takes `{key}`"),
                format!("the runs are {}", names.join(", ")),
            ),
            ["control", turbine, ref rest @ ..] if !rest.is_empty() => (
                format!("no run takes `{key}`: none has a control of {turbine} that knows `{}`", rest[0]),
                format!("give a [[run]] control.{turbine} = {{ kind = ... }} of a kind that has that key"),
            ),
            _ => (
                format!("`{key}` names no key of a control"),
                "write it as \"control.T1.strouhal\", or \"run.helix.control.T1.strouhal\" for one run"
                    .to_owned(),
            ),
        };
        self.problem(&axis.span, message, "no run takes it", fix)
    }
}

/// Name of the run of `table`.
fn name_of(table: &[Entry]) -> String {
    match find(table, "name").map(|entry| &entry.node.value) {
        Some(Value::Text(name)) => name.clone(),
        _ => String::new(),
    }
}

/// Whether the run of `table`, called `base`, takes the key at `path`: its control of the turbine is of a
/// kind that has the key.
pub(in crate::case) fn takes(table: &[Entry], base: &str, path: &[&str]) -> bool {
    let path = match path {
        ["run", name, rest @ ..] if *name == base => rest,
        ["run", ..] => return false,
        whole => whole,
    };
    let ["control", turbine, key, ..] = *path else { return false };
    let control = locate(table, &["control", turbine]).map(|node| &node.value);
    let Some(Value::Table(control)) = control else { return false };
    match find(control, "kind").map(|entry| &entry.node.value) {
        Some(Value::Text(kind)) => CONTROLLERS.find(kind).is_some_and(|kind| {
            key == "kind" || kind.table().keys.iter().any(|own| own.name == key)
        }),
        // What is missing or wrong there is told once the case is read.
        _ => true,
    }
}

/// Gives each of `made` the run that it compares with: of those that the run of the file, or else the first
/// one, became, that of the same values as far as it has them.
fn compare(made: &mut [Made]) {
    let Some(first) = made.first().map(|made| made.swept.base.clone()) else { return };
    let all: Vec<SweptRun> = made.iter().map(|made| made.swept.clone()).collect();
    for made in made {
        let named = find(&made.table, "compare_with").map(|entry| &entry.node.value);
        let other = match named {
            Some(Value::Text(other)) => other.clone(),
            Some(_) => continue,
            None => first.clone(),
        };
        let become_of = || all.iter().filter(|run| run.base == other);
        let is_swept = become_of().any(|run| !run.settings.is_empty());
        if !is_swept || other == made.swept.base {
            continue;
        }
        let alike = |run: &&SweptRun| {
            run.settings.iter().filter(|setting| made.swept.settings.contains(setting)).count()
        };
        // The first of those that are alike in most.
        let most = become_of().map(|run| alike(&run)).max();
        let Some(best) = become_of().find(|run| Some(alike(run)) == most) else { continue };
        set_text(&mut made.table, "compare_with", &best.run, &made.span);
    }
}

/// Puts `text` under `key`, at `span` where there was nothing.
fn set_text(table: &mut Vec<Entry>, key: &str, text: &str, span: &std::ops::Range<usize>) {
    let value = Value::Text(text.to_owned());
    match table.iter_mut().find(|entry| entry.key == key) {
        Some(entry) => entry.node.value = value,
        None => table.push(Entry {
            key: key.to_owned(),
            key_span: span.clone(),
            node: Node { value, span: span.clone() },
        }),
    }
}
