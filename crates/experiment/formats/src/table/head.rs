//! What a table has above its rows: where it comes from, and its columns.

/// What a table holds, in words.
pub(crate) const WHAT: &str = "a table of channels over time";

/// One column: what it is and its unit.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// Name, as in `RootMyc1`.
    pub name: String,
    /// Unit without parentheses, as in `kN-m`; empty where the file says none.
    pub unit: String,
}

/// What stands above the rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Head {
    /// Where the table comes from, in words; empty where the file does not say.
    pub(crate) description: String,
    /// All columns, time among them.
    pub(crate) columns: Vec<Column>,
    /// Which column is time.
    pub(crate) time: usize,
}
