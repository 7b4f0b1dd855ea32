//! Results of all tasks that are done, a row each: factors, seeds, numbers.

mod mean;

use crate::column::{Column, Values};
use crate::error::CampaignError;
use crate::numbers::{is_like, numbers};
use crate::table::{Meta, Table, parsed};
use crate::task::Task;
use basis::records::{Summary, SweptValue};
use formats::atomic;
use std::collections::BTreeMap;
use std::path::Path;

/// What the file holds, in words.
const WHAT: &str = "the results of a campaign";
/// Names that an error tells (–).
const TOLD: usize = 6;

/// What was collected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Collected {
    /// Rows: one a task, or one for all tasks that a mean is of (–).
    pub n_rows: usize,
    /// Columns (–).
    pub n_columns: usize,
    /// Tasks that are not done (–).
    pub n_missing: i64,
}

/// Writes the results of the campaign in `folder` into `path`, which ends with `.csv` or `.parquet`:
/// tasks that differ in the factors `mean_over` alone as one row of means.
///
/// # Errors
/// [`CampaignError`].
pub fn collect(
    folder: &Path,
    path: &Path,
    mean_over: &[String],
) -> Result<Collected, CampaignError> {
    let table = Table::open(folder)?;
    let (mut columns, mut n_rows) = columns(&table, folder)?;
    let n_missing = table.counts()?.all() - n_rows as i64;
    if !mean_over.is_empty() {
        let factors = table.meta()?.columns;
        (columns, n_rows) = mean::mean_over(columns, n_rows, &factors, mean_over)?;
    }
    let bytes = match path.extension().and_then(|end| end.to_str()) {
        Some("csv") => csv(&columns, n_rows).into_bytes(),
        Some("parquet") => parquet(&columns, path)?,
        _ => return Err(CampaignError::UnknownFormat { path: path.to_owned() }),
    };
    atomic::write(path, WHAT, &bytes)?;
    Ok(Collected { n_rows, n_columns: columns.len(), n_missing })
}

#[cfg(feature = "parquet")]
fn parquet(columns: &[Column], path: &Path) -> Result<Vec<u8>, CampaignError> {
    let failed = |error: ::parquet::errors::ParquetError| {
        formats::FileError::system("write", WHAT, path, std::io::Error::other(error))
    };
    Ok(crate::parquet::bytes(columns).map_err(failed)?)
}

#[cfg(not(feature = "parquet"))]
fn parquet(_columns: &[Column], _path: &Path) -> Result<Vec<u8>, CampaignError> {
    Err(CampaignError::NoParquet)
}

/// Numbers by their names, in the order in which they were met first, and the same of each row.
#[derive(Default)]
pub(crate) struct Gathered {
    places: BTreeMap<String, usize>,
    columns: Vec<(String, String, Vec<Option<f64>>)>,
    /// Row and name of the first that was met twice in a row.
    pub(crate) twice: Option<(usize, String)>,
}

impl Gathered {
    pub(crate) fn add(&mut self, row: usize, name: String, unit: String, value: Option<f64>) {
        let place = *self.places.entry(name.clone()).or_insert_with(|| {
            self.columns.push((name, unit, Vec::new()));
            self.columns.len() - 1
        });
        let (name, _, values) = &mut self.columns[place];
        if values.len() > row {
            self.twice.get_or_insert((row, name.clone()));
            return;
        }
        values.resize(row, None);
        values.push(value);
    }
}

/// The columns of all tasks of `table` that are done, and how many there are.
pub(crate) fn columns(table: &Table, folder: &Path) -> Result<(Vec<Column>, usize), CampaignError> {
    let meta = table.meta()?;
    let (mut ids, mut tasks, mut times) = (Vec::new(), Vec::new(), Vec::new());
    table.read(|connection| {
        const DONE: &str = "SELECT id, task, wall_time FROM tasks WHERE state = 'done' ORDER BY id";
        let mut query = connection.prepare(DONE)?;
        let mut rows = query.query([])?;
        while let Some(row) = rows.next()? {
            ids.push(row.get::<_, i64>(0)?);
            tasks.push(parsed::<Task>(row, 1)?);
            times.push(row.get::<_, Option<f64>>(2)?);
        }
        Ok(())
    })?;
    if ids.is_empty() {
        return Err(CampaignError::NothingDone { folder: folder.to_owned() });
    }
    let gathered = gathered(table, &ids)?;
    let mut columns =
        vec![plain("task", "", Values::Whole(ids.iter().copied().map(Some).collect()))];
    columns.extend(meta.columns.iter().map(|name| factor(name, &tasks)));
    columns.push(plain("wall_time", "s", Values::Number(times)));
    columns.extend(chosen(&meta, gathered, ids.len())?);
    Ok((columns, ids.len()))
}

fn plain(name: &str, unit: &str, values: Values) -> Column {
    Column { name: name.to_owned(), unit: unit.to_owned(), values }
}

/// The numbers of the tasks `ids`; of several runs, with the run's name in front.
fn gathered(table: &Table, ids: &[i64]) -> Result<Gathered, CampaignError> {
    const SUMMARIES: &str = "SELECT s.task, s.summary FROM summaries s JOIN tasks t ON t.id = s.task WHERE t.state = 'done' ORDER BY s.task, s.place";
    const MOST: &str = "SELECT coalesce(max(place), 0) FROM summaries";
    let gathered = table.read(|connection| {
        let several = connection.query_row(MOST, [], |row| row.get::<_, i64>(0))? > 0;
        let mut gathered = Gathered::default();
        let mut query = connection.prepare(SUMMARIES)?;
        let mut rows = query.query([])?;
        while let Some(found) = rows.next()? {
            // A task that ended since the others were read waits for the next time.
            let Ok(row) = ids.binary_search(&found.get(0)?) else { continue };
            let summary: Summary = parsed(found, 1)?;
            let front = if several { format!("{}.", summary.run) } else { String::new() };
            for number in numbers(&summary) {
                gathered.add(row, front.clone() + &number.name, number.unit, number.value);
            }
        }
        Ok(gathered)
    })?;
    match gathered.twice {
        Some((row, name)) => Err(CampaignError::TwiceNamed { task: ids[row], name }),
        None => Ok(gathered),
    }
}

/// Those of the numbers that the campaign asks for.
fn chosen(meta: &Meta, gathered: Gathered, n_rows: usize) -> Result<Vec<Column>, CampaignError> {
    let names = || gathered.columns.iter().map(|(name, _, _)| name);
    for pattern in &meta.collect {
        if !names().any(|name| is_like(name, pattern)) {
            let known = names().take(TOLD).cloned().collect::<Vec<_>>().join(", ");
            return Err(CampaignError::NoNumber { pattern: pattern.clone(), known });
        }
    }
    let is_wanted = |name: &str| {
        meta.collect.is_empty() || meta.collect.iter().any(|pattern| is_like(name, pattern))
    };
    let wanted = gathered.columns.into_iter().filter(|(name, _, _)| is_wanted(name));
    let column = |(name, unit, mut values): (String, String, Vec<Option<f64>>)| {
        values.resize(n_rows, None);
        Column { name, unit, values: Values::Number(values) }
    };
    Ok(wanted.map(column).collect())
}

/// The column of a factor of all `tasks`.
fn factor(name: &str, tasks: &[Task]) -> Column {
    let values: Vec<Option<&SweptValue>> = tasks
        .iter()
        .map(|task| task.columns.iter().find(|(own, _)| own == name).map(|(_, value)| value))
        .collect();
    let of = |value: &Option<&SweptValue>| value.and_then(SweptValue::number);
    let values = if values.iter().all(|v| matches!(v, Some(SweptValue::Whole(_)))) {
        Values::Whole(values.iter().map(|value| of(value).map(|number| number as i64)).collect())
    } else if values.iter().all(|value| of(value).is_some()) {
        Values::Number(values.iter().map(of).collect())
    } else {
        Values::Text(values.iter().map(|value| value.map(SweptValue::words)).collect())
    };
    plain(name, "", values)
}

/// `columns` as CSV, with units in brackets behind the names.
fn csv(columns: &[Column], n_rows: usize) -> String {
    let heading = |column: &Column| match column.unit.as_str() {
        "" | "–" => cell(&column.name),
        unit => cell(&format!("{} [{unit}]", column.name)),
    };
    let mut text = columns.iter().map(heading).collect::<Vec<_>>().join(",") + "\n";
    for row in 0..n_rows {
        let value = |column: &Column| match &column.values {
            Values::Whole(values) => values[row].map(|value| value.to_string()),
            Values::Number(values) => values[row].map(|value| format!("{value:?}")),
            Values::Text(values) => values[row].as_deref().map(cell),
        };
        let cells: Vec<String> =
            columns.iter().map(|column| value(column).unwrap_or_default()).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

/// `text` as one cell.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
