//! A column of results.

/// Values of a column, one a row.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    Whole(Vec<Option<i64>>),
    Number(Vec<Option<f64>>),
    Text(Vec<Option<String>>),
}

/// A column of results.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) name: String,
    /// Unit of a number; empty of what has none.
    pub(crate) unit: String,
    pub(crate) values: Values,
}
