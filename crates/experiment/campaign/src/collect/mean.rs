//! Rows that differ in seeds alone, as one.

use crate::column::{Column, Values};
use crate::error::CampaignError;
use std::collections::BTreeMap;

/// Name of the column that says how many rows are behind one.
const COUNT: &str = "n_rows";

/// The rows of `columns` that have the same in each of `factors` but those of `over`, as one: the mean of
/// every number that is no factor, how many there were, and of the rest what the first of them has. A
/// number that one of them lacks is lacking.
///
/// # Errors
/// [`CampaignError::NoFactor`] for one of `over` that is not varied.
pub(super) fn mean_over(
    columns: Vec<Column>,
    n_rows: usize,
    factors: &[String],
    over: &[String],
) -> Result<(Vec<Column>, usize), CampaignError> {
    if let Some(key) = over.iter().find(|key| !factors.contains(key)) {
        let known = factors.join(", ");
        return Err(CampaignError::NoFactor { key: key.clone(), known });
    }
    let is_factor = |column: &Column| factors.contains(&column.name);
    let kept: Vec<&Column> =
        columns.iter().filter(|column| is_factor(column) && !over.contains(&column.name)).collect();
    let mut groups: BTreeMap<Vec<String>, Vec<usize>> = BTreeMap::new();
    for row in 0..n_rows {
        let key = kept.iter().map(|column| column.words(row)).collect();
        groups.entry(key).or_default().push(row);
    }
    let mut groups: Vec<Vec<usize>> = groups.into_values().collect();
    groups.sort();
    let counts = groups.iter().map(|rows| Some(rows.len() as i64)).collect();
    let mut found = Vec::new();
    for column in columns.iter().filter(|column| !over.contains(&column.name)) {
        let of_first = is_factor(column) || column.name == "task";
        let values = match &column.values {
            Values::Number(values) if !of_first => {
                Values::Number(groups.iter().map(|rows| mean(values, rows)).collect())
            }
            Values::Number(values) => Values::Number(first(values, &groups)),
            Values::Whole(values) => Values::Whole(first(values, &groups)),
            Values::Text(values) => Values::Text(first(values, &groups)),
        };
        found.push(Column { values, ..column.clone() });
    }
    let count =
        Column { name: COUNT.to_owned(), unit: String::new(), values: Values::Whole(counts) };
    found.insert(1, count);
    Ok((found, groups.len()))
}

fn first<T: Clone>(values: &[Option<T>], groups: &[Vec<usize>]) -> Vec<Option<T>> {
    groups.iter().map(|rows| values[rows[0]].clone()).collect()
}

fn mean(values: &[Option<f64>], rows: &[usize]) -> Option<f64> {
    let sum = rows.iter().map(|row| values[*row]).sum::<Option<f64>>()?;
    Some(sum / rows.len() as f64)
}

impl Column {
    /// What row number `row` has, in words that differ where it does.
    fn words(&self, row: usize) -> String {
        match &self.values {
            Values::Whole(values) => format!("{:?}", values[row]),
            Values::Number(values) => format!("{:?}", values[row]),
            Values::Text(values) => format!("{:?}", values[row]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str, values: Values) -> Column {
        Column { name: name.to_owned(), unit: String::new(), values }
    }

    #[test]
    fn seeds_are_averaged_and_a_number_that_is_lacking_lacks() {
        let some = |values: &[f64]| Values::Number(values.iter().copied().map(Some).collect());
        let lacking = vec![Some(1.0), Some(5.0), None, Some(7.0), Some(9.0)];
        let shared = ["a", "b", "a", "b", "a"].map(|text| Some(text.to_owned()));
        let columns = vec![
            column("task", Values::Whole([1, 2, 3, 4, 5].map(Some).to_vec())),
            column("wind.planes", Values::Text(shared.to_vec())),
            column("wind.cut.shift", some(&[0.0, 0.0, 0.0, 0.0, 130.0])),
            column("wind.cut.block", Values::Whole([1, 1, 2, 2, 1].map(Some).to_vec())),
            column("load", some(&[1.0, 2.0, 3.0, 6.0, 7.0])),
            column("other", Values::Number(lacking)),
        ];
        let factors = ["wind.planes", "wind.cut.shift", "wind.cut.block"].map(str::to_owned);
        let over = [factors[2].clone()];
        let (found, n_rows) = mean_over(columns.clone(), 5, &factors, &over).unwrap();
        assert_eq!(n_rows, 3);
        let named = |name: &str| {
            found.iter().find(|column| column.name == name).map(|column| column.values.clone())
        };
        assert_eq!(named("load"), Some(some(&[2.0, 4.0, 7.0])));
        assert_eq!(named("other"), Some(Values::Number(vec![None, Some(6.0), Some(9.0)])));
        assert_eq!(named("n_rows"), Some(Values::Whole([2, 2, 1].map(Some).to_vec())));
        assert_eq!(named("task"), Some(Values::Whole([1, 2, 5].map(Some).to_vec())));
        assert_eq!(named("wind.cut.shift"), Some(some(&[0.0, 0.0, 130.0])));
        assert_eq!(named("wind.cut.block"), None);
        let error = mean_over(columns, 5, &factors, &["load".to_owned()]).unwrap_err();
        assert!(error.to_string().contains("`load`"), "{error}");
    }
}
