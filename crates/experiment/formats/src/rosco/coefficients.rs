//! ROSCO's table of power, thrust and torque coefficient against tip-speed ratio and pitch.

use crate::turbine_file::TurbineFileError;
use control::baseline::{CoefficientTable, CoefficientTableError};

/// Greatest number that is an angle (deg), a ratio or a coefficient.
const GREATEST: f64 = 1000.0;

/// What a line of numbers belongs to, by the remark above it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Pitches,
    TipSpeedRatios,
    Power,
    Thrust,
    Other,
}

/// A line of numbers.
struct Row {
    /// From 1.
    line: usize,
    part: Part,
    numbers: Vec<f64>,
}

/// The table in `text`, which errors call `file`: pitch angles in degrees and tip-speed ratios, each below a
/// remark that names them, then a row for each tip-speed ratio, first of the power, then of the thrust
/// coefficient.
///
/// # Errors
/// [`TurbineFileError::Value`] naming file, line and what was expected: for words among the numbers, a row
/// with more or fewer numbers than pitch angles, more or fewer rows than tip-speed ratios, axes that do not
/// rise.
pub fn parse_coefficients(file: &str, text: &str) -> Result<CoefficientTable, TurbineFileError> {
    let rows = rows(file, text)?;
    let axis = |part, key: &'static str| {
        let lines: Vec<&Row> = rows.iter().filter(|row| row.part == part).collect();
        let Some(first) = lines.first() else {
            let expected = format!("a line of {key} below a remark that names them");
            return Err(error(file, text.lines().count(), key, &expected, "none"));
        };
        let numbers: Vec<f64> = lines.iter().flat_map(|row| row.numbers.clone()).collect();
        Ok((first.line, numbers))
    };
    let (pitch_line, pitches) = axis(Part::Pitches, "pitch angles")?;
    let (ratio_line, ratios) = axis(Part::TipSpeedRatios, "tip-speed ratios")?;
    let matrix = |part, key: &'static str| {
        let lines: Vec<&Row> = rows.iter().filter(|row| row.part == part).collect();
        let last = lines.last().map_or(text.lines().count(), |row| row.line);
        for row in &lines {
            if row.numbers.len() != pitches.len() {
                let expected = format!("{} numbers, one for each pitch angle", pitches.len());
                let found = row.numbers.len().to_string();
                return Err(error(file, row.line, key, &expected, &found));
            }
        }
        if lines.len() != ratios.len() {
            let expected = format!("{} rows, one for each tip-speed ratio", ratios.len());
            return Err(error(file, last, key, &expected, &lines.len().to_string()));
        }
        Ok(lines.iter().flat_map(|row| row.numbers.clone()).collect::<Vec<f64>>())
    };
    let power = matrix(Part::Power, "power coefficient")?;
    let thrust = matrix(Part::Thrust, "thrust coefficient")?;
    let pitches = pitches.iter().map(|pitch: &f64| pitch.to_radians()).collect();
    CoefficientTable::new(ratios, pitches, power, thrust).map_err(|cause| {
        let (line, key) = match &cause {
            CoefficientTableError::Axis { axis: "pitch angles", .. } => {
                (pitch_line, "pitch angles")
            }
            _ => (ratio_line, "tip-speed ratios"),
        };
        error(file, line, key, "increasing numbers", &cause.to_string())
    })
}

/// The lines of numbers in `text`, each with the part that the remark above it names.
fn rows(file: &str, text: &str) -> Result<Vec<Row>, TurbineFileError> {
    let mut part = Part::Other;
    let mut rows = Vec::new();
    for (index, text) in text.lines().enumerate() {
        if let Some(remark) = text.trim_start().strip_prefix('#') {
            let remark = remark.to_lowercase();
            let names = |word: &str| remark.contains(word);
            part = if names("pitch angle") {
                Part::Pitches
            } else if names("tsr") {
                Part::TipSpeedRatios
            } else if names("power") {
                Part::Power
            } else if names("thrust") {
                Part::Thrust
            } else if names("torque") || names("wind speed") {
                Part::Other
            } else {
                part
            };
            continue;
        }
        let words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|w| !w.is_empty());
        let number = |word: &str| {
            let number = word.parse::<f64>().ok().filter(|number| number.abs() <= GREATEST);
            number.ok_or_else(|| {
                let expected = format!("a number from -{GREATEST} to {GREATEST}");
                error(file, index + 1, "coefficients", &expected, &format!("\"{word}\""))
            })
        };
        let numbers = words.map(number).collect::<Result<Vec<f64>, _>>()?;
        if !numbers.is_empty() && part != Part::Other {
            rows.push(Row { line: index + 1, part, numbers });
        }
    }
    Ok(rows)
}

fn error(file: &str, line: usize, key: &str, expected: &str, found: &str) -> TurbineFileError {
    TurbineFileError::Value {
        file: file.into(),
        line,
        key: key.into(),
        expected: expected.into(),
        found: found.into(),
        fix: "write the table anew with ROSCO's toolbox, or correct this line".into(),
    }
}
