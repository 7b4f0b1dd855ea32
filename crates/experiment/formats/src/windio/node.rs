//! YAML in which every value knows its line and the path that leads to it.

use crate::atomic;
use crate::turbine_file::TurbineFileError;
use saphyr::{LoadableYamlNode, MarkedYaml, YamlData};
use saphyr_parser::{Event, Parser};
use std::path::{Path, PathBuf};

/// Lists and groups within each other at most (–); turbines have some ten.
const DEEPEST: usize = 64;

/// A YAML file.
pub(super) struct File {
    path: PathBuf,
    text: String,
}

/// A value of the file.
#[derive(Clone)]
pub(super) struct Node<'a> {
    file: &'a Path,
    yaml: MarkedYaml<'a>,
    key: String,
}

impl File {
    pub(super) fn read(path: &Path) -> Result<Self, TurbineFileError> {
        let bytes = atomic::read_whole(path)
            .map_err(|source| TurbineFileError::unreadable(path, source))?;
        Ok(Self { path: path.to_owned(), text: String::from_utf8_lossy(&bytes).into_owned() })
    }

    /// The top of the file.
    pub(super) fn root(&self) -> Result<Node<'_>, TurbineFileError> {
        let file = self.path.as_path();
        let error = |line, message: String| TurbineFileError::Syntax {
            file: file.display().to_string(),
            line,
            message,
            fix: "correct the YAML there".to_owned(),
        };
        check_depth(&self.text).map_err(|(line, message)| error(line, message))?;
        let documents = MarkedYaml::load_from_str(&self.text)
            .map_err(|problem| error(problem.marker().line(), problem.info().to_owned()))?;
        let yaml = documents
            .into_iter()
            .next()
            .ok_or_else(|| error(1, "nothing is in the file".to_owned()))?;
        Ok(Node { file, yaml, key: String::new() })
    }
}

/// Makes sure that the lists and groups of `text` do not lie deeper within each other than what reads them
/// can go down.
///
/// # Errors
/// Line and problem; what is no YAML is not reported here.
fn check_depth(text: &str) -> Result<(), (usize, String)> {
    let mut depth = 0;
    for event in Parser::new_from_str(text) {
        let Ok((event, span)) = event else { return Ok(()) };
        match event {
            Event::SequenceStart(..) | Event::MappingStart(..) => depth += 1,
            Event::SequenceEnd | Event::MappingEnd => depth -= 1,
            _ => {}
        }
        if depth > DEEPEST {
            let message = format!("lists and groups lie more than {DEEPEST} deep in each other");
            return Err((span.start.line(), message));
        }
    }
    Ok(())
}

impl<'a> Node<'a> {
    fn child(&self, key: &str, yaml: MarkedYaml<'a>) -> Self {
        let key = if self.key.is_empty() { key.to_owned() } else { format!("{}.{key}", self.key) };
        Self { file: self.file, yaml, key }
    }

    /// The value of `key`, if there is one.
    pub(super) fn optional(&self, key: &str) -> Option<Self> {
        let YamlData::Mapping(mapping) = &self.yaml.data else { return None };
        let found = mapping.iter().find(|(name, _)| name.data.as_str() == Some(key))?;
        Some(self.child(key, found.1.clone()))
    }

    /// The value of `key`.
    pub(super) fn get(&self, key: &str) -> Result<Self, TurbineFileError> {
        self.optional(key).ok_or_else(|| {
            let path =
                if self.key.is_empty() { key.to_owned() } else { format!("{}.{key}", self.key) };
            TurbineFileError::Value {
                file: self.file.display().to_string().into(),
                line: self.line(),
                key: path.into(),
                expected: format!("the key {key} in this group").into(),
                found: "none".into(),
                fix: format!("add {key}; the format is windIO's, as WISDEM 2 and 3 write it")
                    .into(),
            }
        })
    }

    /// Items of a list.
    pub(super) fn items(&self) -> Result<Vec<Self>, TurbineFileError> {
        let YamlData::Sequence(items) = &self.yaml.data else {
            return Err(self.error("a list", "a YAML list"));
        };
        let item = |(index, yaml): (usize, &MarkedYaml<'a>)| {
            self.child(&format!("{}", index + 1), yaml.clone())
        };
        Ok(items.iter().enumerate().map(item).collect())
    }

    /// A text.
    pub(super) fn text(&self) -> Result<&str, TurbineFileError> {
        self.yaml.data.as_str().ok_or_else(|| self.error("a text", "a text"))
    }

    fn as_number(yaml: &MarkedYaml) -> Option<f64> {
        let data = &yaml.data;
        let number = data.as_floating_point().or_else(|| data.as_integer().map(|n| n as f64));
        number.filter(|number| number.is_finite())
    }

    /// The number of `key`.
    pub(super) fn number(&self, key: &str) -> Result<f64, TurbineFileError> {
        let node = self.get(key)?;
        Self::as_number(&node.yaml).ok_or_else(|| node.error("a number", "a number"))
    }

    /// The number of `key`, or `otherwise` where there is no such key.
    pub(super) fn number_or(&self, key: &str, otherwise: f64) -> Result<f64, TurbineFileError> {
        if self.optional(key).is_some() { self.number(key) } else { Ok(otherwise) }
    }

    /// A list of numbers.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, TurbineFileError> {
        let items = self.items()?;
        items
            .iter()
            .map(|item| {
                Self::as_number(&item.yaml).ok_or_else(|| item.error("a number", "a number"))
            })
            .collect()
    }

    /// Line in the file, from 1.
    fn line(&self) -> usize {
        self.yaml.span.start.line()
    }

    /// The error that `expected` should be here; `fix` says what to write.
    pub(super) fn error(&self, expected: &str, fix: &str) -> TurbineFileError {
        let found = match &self.yaml.data {
            YamlData::Mapping(_) => "a group".to_owned(),
            YamlData::Sequence(items) => format!("a list of {}", items.len()),
            data => data
                .as_str()
                .map_or_else(|| "another value".to_owned(), |text| format!("\"{text}\"")),
        };
        TurbineFileError::Value {
            file: self.file.display().to_string().into(),
            line: self.line(),
            key: self.key.as_str().into(),
            expected: expected.into(),
            found: found.into(),
            fix: format!("write {fix}").into(),
        }
    }
}

/// Values over a grid, linear between and constant beyond.
pub(super) struct Curve {
    grid: Vec<f64>,
    values: Vec<f64>,
}

impl Curve {
    /// The `grid` and `values` of `node`.
    pub(super) fn read(node: &Node) -> Result<Self, TurbineFileError> {
        let (grid, values) = (node.get("grid")?.numbers()?, node.get("values")?);
        let numbers = values.numbers()?;
        if numbers.len() != grid.len() || grid.is_empty() {
            return Err(values.error(
                &format!("{} numbers, one per grid point", grid.len()),
                "as many values as grid points",
            ));
        }
        if grid.windows(2).any(|pair| pair[1] < pair[0]) {
            return Err(node.get("grid")?.error("a rising grid", "grid points in rising order"));
        }
        Ok(Self { grid, values: numbers })
    }

    pub(super) fn grid(&self) -> &[f64] {
        &self.grid
    }

    pub(super) fn last(&self) -> f64 {
        self.values[self.values.len() - 1]
    }

    pub(super) fn at(&self, place: f64) -> f64 {
        let high = self.grid.partition_point(|point| *point < place);
        if high == 0 {
            return self.values[0];
        }
        let Some(end) = self.grid.get(high) else { return self.last() };
        let (start, low, up) = (self.grid[high - 1], self.values[high - 1], self.values[high]);
        low + (place - start) / (end - start) * (up - low)
    }
}
