//! Wind over time in a table: OpenFAST's uniform wind (`.wnd`, `.hh`), or CSV with names of its own.

use crate::{FileError, atomic};
use flow::inflow::tabulated::WindRow;
use std::path::Path;

const WHAT: &str = "wind over time";

/// A column: its name in CSV, the range of its values, and where they go, in the unit of the name.
struct Column {
    name: &'static str,
    range: [f64; 2],
    put: fn(&mut WindRow, f64),
}

/// Columns of CSV, and, in this order but for the sign of the direction, those of OpenFAST.
const COLUMNS: [Column; 8] = [
    Column { name: "time_s", range: [-1e6, 1e7], put: |row, value| row.time = value },
    Column { name: "speed_m_s", range: [0.0, 200.0], put: |row, value| row.speed = value },
    Column {
        name: "direction_deg",
        range: [-3600.0, 3600.0],
        put: |row, value| row.direction = value.to_radians(),
    },
    Column { name: "vertical_m_s", range: [-100.0, 100.0], put: |row, value| row.vertical = value },
    Column {
        name: "horizontal_shear",
        range: [-10.0, 10.0],
        put: |row, value| row.horizontal_shear = value,
    },
    Column {
        name: "shear_exponent",
        range: [-1.0, 2.0],
        put: |row, value| row.exponent = Some(value),
    },
    Column {
        name: "vertical_shear",
        range: [-10.0, 10.0],
        put: |row, value| row.vertical_shear = value,
    },
    Column { name: "gust_m_s", range: [-100.0, 100.0], put: |row, value| row.gust = value },
];

/// The rows of the table at `path`: of OpenFAST where its name ends in `.wnd` or `.hh`, else CSV whose first
/// line names [the columns](COLUMNS) that it has, `time_s` and `speed_m_s` at least.
///
/// # Errors
/// [`FileError`] names file, line, column, what was expected there and the fix.
pub fn read(path: &Path) -> Result<Vec<WindRow>, FileError> {
    let extension = path.extension().map(|end| end.to_string_lossy().to_lowercase());
    let text = atomic::read_text(path, WHAT)?;
    let is_openfast = matches!(extension.as_deref(), Some("wnd" | "hh"));
    let rows = if is_openfast { openfast(path, &text) } else { csv(path, &text) }?;
    if rows.is_empty() {
        return Err(refused(path, "there is no row".to_owned()));
    }
    Ok(rows)
}

fn refused(path: &Path, problem: String) -> FileError {
    let fix = "write rows of time (s), speed (m/s) and more: CSV with the names `time_s,speed_m_s,direction_deg,vertical_m_s,horizontal_shear,shear_exponent,vertical_shear,gust_m_s`, of which the first two must be there, or the eight columns of OpenFAST's uniform wind in a file .wnd or .hh";
    FileError::Content { what: WHAT, path: path.to_owned(), problem, fix: fix.to_owned() }
}

/// Rows of OpenFAST: eight columns, lines that begin with `!` or `#` left out.
fn openfast(path: &Path, text: &str) -> Result<Vec<WindRow>, FileError> {
    let columns: Vec<&Column> = COLUMNS.iter().collect();
    let mut rows = Vec::new();
    for (number, line) in lines(text) {
        if line.starts_with(['!', '#']) {
            continue;
        }
        let cells: Vec<&str> =
            line.split(|c: char| c.is_whitespace() || c == ',').filter(|c| !c.is_empty()).collect();
        // A ninth column, of newer versions, is the angle of upflow.
        let upflow = cells.get(8).is_some_and(|cell| cell.parse::<f64>().is_ok_and(|v| v != 0.0));
        if upflow {
            let problem = format!(
                "line {number}: an upflow angle (column 9) is not read; give the vertical speed (column 4)"
            );
            return Err(refused(path, problem));
        }
        let mut row = row_of(path, number, &columns, &cells)?;
        // OpenFAST counts directions clockwise.
        row.direction = -row.direction;
        add(path, number, &mut rows, row)?;
    }
    Ok(rows)
}

fn csv(path: &Path, text: &str) -> Result<Vec<WindRow>, FileError> {
    let mut lines = lines(text).filter(|(_, line)| !line.starts_with('#'));
    let Some((_, head)) = lines.next() else { return Ok(Vec::new()) };
    let mut columns: Vec<&Column> = Vec::new();
    for name in head.split(',').map(str::trim) {
        let column = COLUMNS.iter().find(|column| column.name.eq_ignore_ascii_case(name));
        let column =
            column.ok_or_else(|| refused(path, format!("no column is called `{name}`")))?;
        if columns.iter().any(|known| known.name == column.name) {
            return Err(refused(path, format!("two columns are called `{name}`")));
        }
        columns.push(column);
    }
    for needed in &COLUMNS[..2] {
        if !columns.iter().any(|column| column.name == needed.name) {
            return Err(refused(path, format!("the column `{}` is missing", needed.name)));
        }
    }
    let mut rows = Vec::new();
    for (number, line) in lines {
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let row = row_of(path, number, &columns, &cells)?;
        add(path, number, &mut rows, row)?;
    }
    Ok(rows)
}

/// Lines with something in them, with their numbers from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()));
    numbered.filter(|(_, line)| !line.is_empty())
}

/// The row of `cells` under `columns` in line `number`.
fn row_of(
    path: &Path,
    number: usize,
    columns: &[&Column],
    cells: &[&str],
) -> Result<WindRow, FileError> {
    if cells.len() < columns.len() {
        let (found, needed) = (cells.len(), columns.len());
        return Err(refused(path, format!("line {number} has {found} numbers of {needed}")));
    }
    let mut row = WindRow {
        time: 0.0,
        speed: 0.0,
        direction: 0.0,
        vertical: 0.0,
        horizontal_shear: 0.0,
        exponent: None,
        vertical_shear: 0.0,
        gust: 0.0,
    };
    for (column, cell) in columns.iter().zip(cells) {
        let Column { name, range: [low, high], put } = column;
        let value = cell.parse().ok().filter(|value: &f64| (*low..=*high).contains(value));
        let value = value.ok_or_else(|| {
            let problem = format!("line {number}, {name}: expected {low} to {high}, found {cell}");
            refused(path, problem)
        })?;
        put(&mut row, value);
    }
    Ok(row)
}

/// Adds `row` of line `number` to `rows`.
fn add(path: &Path, number: usize, rows: &mut Vec<WindRow>, row: WindRow) -> Result<(), FileError> {
    if let Some(last) = rows.last().filter(|last| row.time < last.time) {
        let problem = format!("line {number}: time falls from {} s to {} s", last.time, row.time);
        return Err(refused(path, problem));
    }
    rows.push(row);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn read_as(name: &str, text: &str) -> Result<Vec<WindRow>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        read(&path).map_err(|error| error.to_string())
    }

    #[test]
    fn both_formats_say_the_same() {
        let openfast = read_as(
            "gust.wnd",
            "! time speed dir vert hshr vshr linv gust\n0.0 9.0 0 0 0 0.1 0 0\n\n10.5\t12.0 -30 1 0.1 0.2 -0.1 2 0.0\n",
        );
        let csv = read_as(
            "gust.csv",
            "# a gust\ntime_s, speed_m_s, direction_deg, vertical_m_s, horizontal_shear, shear_exponent, vertical_shear, gust_m_s\n0, 9, 0, 0, 0, 0.1, 0, 0\n10.5, 12, 30, 1, 0.1, 0.2, -0.1, 2\n",
        );
        let rows = openfast.unwrap();
        assert_eq!(Ok(&rows), csv.as_ref());
        assert_eq!(rows[1].direction, 30.0_f64.to_radians());
        assert_eq!((rows[1].exponent, rows[1].gust), (Some(0.2), 2.0));
        let short = read_as("u.csv", "speed_m_s,time_s\n8,0\n9,60\n").unwrap();
        assert_eq!((short[1].time, short[1].speed, short[1].exponent), (60.0, 9.0, None));
    }

    #[test]
    fn what_is_no_table_is_refused_with_line_and_column() {
        for (name, text, words) in [
            ("u.csv", "", "there is no row"),
            ("u.csv", "time_s,speed\n0,9\n", "no column is called `speed`"),
            ("u.csv", "time_s,gust_m_s\n0,9\n", "the column `speed_m_s` is missing"),
            ("u.csv", "time_s,time_s\n0,9\n", "two columns are called `time_s`"),
            (
                "u.csv",
                "time_s,speed_m_s\n0,nan\n",
                "line 2, speed_m_s: expected 0 to 200, found nan",
            ),
            ("u.csv", "time_s,speed_m_s\n0,9\n1\n", "line 3 has 1 numbers of 2"),
            ("u.csv", "time_s,speed_m_s\n5,9\n1,9\n", "line 3: time falls from 5 s to 1 s"),
            ("u.wnd", "0 9 0 0 0 0 0\n", "line 1 has 7 numbers of 8"),
            ("u.hh", "0 9 0 0 0 0 0 0 8.0\n", "line 1: an upflow angle (column 9) is not read"),
        ] {
            let error = read_as(name, text).unwrap_err();
            assert!(error.contains(words), "{text:?}: {error}");
        }
    }
}
