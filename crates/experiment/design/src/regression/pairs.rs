//! Rows of a table beside what a regression says of them, with the noise of each row.

use crate::DesignError;
use formats::FileError;
use formats::table::Samples;
use std::collections::BTreeMap;
use surrogate::{LeaveOneOut, Regression, SurrogateError, Validation};

/// What a table knows of the noise of its rows.
pub(super) struct Columns {
    /// Number of the noise group of each row, where a column says so.
    pub(super) groups: Option<Vec<usize>>,
    /// Column of the known deviations, the first is 0.
    pub(super) deviation: Option<usize>,
}

impl Columns {
    /// Of `samples` whose columns are inputs, output, then what of `deviation` and `group` is named.
    pub(super) fn new(
        samples: &Samples,
        n_inputs: usize,
        deviation: &Option<String>,
        group: &Option<String>,
    ) -> Result<Self, DesignError> {
        let deviation = deviation.as_ref().map(|_| n_inputs + 1);
        let column = n_inputs + 1 + usize::from(deviation.is_some());
        let number = |row: usize| {
            let value = samples.row(row)[column];
            if value < 0.0 || value.fract() != 0.0 || value > 1e6 {
                let (name, line) = (&samples.columns[column].name, samples.lines[row]);
                let problem = format!("line {line}: {name} is {value}, no number of a noise group");
                let fix = "number the groups 0, 1, 2, … without gaps";
                let found = FileError::content("a table of samples", &samples.path, problem, fix);
                return Err(DesignError::from(found));
            }
            Ok(value as usize)
        };
        let all = || (0..samples.lines.len()).map(number).collect::<Result<Vec<usize>, _>>();
        Ok(Self { groups: group.as_ref().map(|_| all()).transpose()?, deviation })
    }

    /// Group of each of `rows`; 0 where no column says so.
    pub(super) fn groups_of(&self, rows: &[usize]) -> Vec<usize> {
        let of = |row: &usize| self.groups.as_ref().map_or(0, |groups| groups[*row]);
        rows.iter().map(of).collect()
    }
}

/// Rows of a table: inputs first, then the output.
pub(super) struct Pairs<'a> {
    pub(super) samples: &'a Samples,
    pub(super) rows: &'a [usize],
    pub(super) n_inputs: usize,
    pub(super) noise: &'a Columns,
}

/// A regression held against rows.
pub(super) struct Held {
    pub(super) pairs: Vec<LeaveOneOut>,
    pub(super) validation: Option<Validation>,
    /// Why it cannot be told how many values lie in their band.
    pub(super) unknown: Option<String>,
}

/// Holds `found` against `table`.
pub(super) fn held(found: &Regression, table: &Pairs) -> Result<Held, SurrogateError> {
    let pairs = pairs(found, table)?;
    let unknown = unknown(found, table);
    let mut validation = Validation::of(&pairs);
    if let (Some(validation), Some(_)) = (&mut validation, &unknown) {
        validation.covered_95 = None;
    }
    Ok(Held { pairs, validation, unknown })
}

/// What of the noise of `table` is not known, and what to do.
fn unknown(found: &Regression, table: &Pairs) -> Option<String> {
    let path = table.samples.path.display();
    let n_groups = found.parameters().noise.len();
    let not_told = "how many values lie in their 95 % band is not told";
    if n_groups > 1 && table.noise.groups.is_none() {
        return Some(format!(
            "{path}: the surrogate has {n_groups} groups of noise, and of no row it is said which is its own: {not_told}; name the column with --group"
        ));
    }
    if found.collapsed().known.iter().any(|known| *known > 0.0) && table.noise.deviation.is_none() {
        return Some(format!(
            "{path}: the surrogate was trained with a known deviation of each row, and of these rows none is given: {not_told}; name the column with --deviation"
        ));
    }
    let groups = table.noise.groups_of(table.rows);
    let place = groups.iter().position(|group| n_groups > 0 && *group >= n_groups)?;
    Some(format!(
        "{path}: line {} is of noise group {}, of which the surrogate was trained on no row: {not_told}",
        table.samples.lines[table.rows[place]], groups[place]
    ))
}

/// Means of the output at the different inputs of `table` beside what `found` says of them. The mean of n
/// rows with noise variances v has Σ v / n²; a group that `found` does not have counts as without noise.
fn pairs(found: &Regression, table: &Pairs) -> Result<Vec<LeaveOneOut>, SurrogateError> {
    let mut place_of: BTreeMap<Vec<u64>, usize> = BTreeMap::new();
    let (mut inputs, mut rows_of) = (Vec::new(), Vec::<Vec<[f64; 2]>>::new());
    let estimated = &found.parameters().noise;
    for (row, group) in table.rows.iter().zip(table.noise.groups_of(table.rows)) {
        let row = table.samples.row(*row);
        let input = &row[..table.n_inputs];
        let key = input.iter().map(|x| (x + 0.0).to_bits()).collect();
        let place = *place_of.entry(key).or_insert(rows_of.len());
        if place == rows_of.len() {
            inputs.extend_from_slice(input);
            rows_of.push(Vec::new());
        }
        let known = table.noise.deviation.map_or(0.0, |column| row[column] * row[column]);
        let variance = known + estimated.get(group).copied().unwrap_or(0.0);
        rows_of[place].push([row[table.n_inputs], variance]);
    }
    let predictions = found.predict(&inputs, 0)?;
    let pair = |(rows, prediction): (&Vec<[f64; 2]>, surrogate::Prediction)| {
        let n = rows.len() as f64;
        let noise = rows.iter().map(|[_, variance]| variance).sum::<f64>() / (n * n);
        LeaveOneOut {
            value: rows.iter().map(|[value, _]| value).sum::<f64>() / n,
            mean: prediction.mean,
            standard_deviation: (prediction.standard_deviation.powi(2) + noise).sqrt(),
        }
    };
    Ok(rows_of.iter().zip(predictions).map(pair).collect())
}
