//! Boxes of finer cells in the box of cells: their keys of `[[flow.refinement]]`, and what they say.

use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Key, Objection, Table, Values, from, key};

/// The key of `[flow]` under which boxes stand.
pub const NAME: &str = "refinement";

/// The key of `[flow]` for solvers that have boxes of finer cells.
pub static KEY: Key = key(
    NAME,
    Holds::Tables(&TABLE),
    "",
    Otherwise("the same cells everywhere"),
    "Boxes of cells of half the size, one `[[flow.refinement]]` each.",
);

/// `[[flow.refinement]]`.
pub static TABLE: Table = Table {
    heading: "[[flow.refinement]]",
    about: "A box of finer cells around turbines, from the ground upwards: half as large as those around it, moved by steps of half the length. A box within another halves once more. It is sized from the layout as the domain is, in diameters of the first turbine, and rounded up to whole cells. A rotor stands in it with six of its cells to spare, which is how far forces are spread, or as far outside. It ends at least two cells (three in the atmosphere of a precursor) before the sides of what is around it, before other boxes, and before the cells at the outlet in which eddies are stilled (a tenth of the domain, 24 at most). `flow.step` is that of the finest cells. One is set by its number from 0: `--set flow.refinement.0.width_diameters=3`.",
    keys: &[
        key(
            "around",
            Holds::Turbines,
            "",
            Otherwise("all turbines"),
            "Turbines that it is laid around.",
        ),
        key(
            "upstream_diameters",
            from(0.5, 50.0),
            "D",
            Value("1"),
            "From the foremost of these turbines upstream to its beginning.",
        ),
        key(
            "downstream_diameters",
            from(0.5, 100.0),
            "D",
            Value("2"),
            "From the last of them downstream to its end.",
        ),
        key(
            "width_diameters",
            from(1.0, 100.0),
            "D",
            Value("2"),
            "Its width, on top of the lateral spread of these turbines. As wide as the domain it has the domain's sides.",
        ),
        key(
            "height_diameters",
            from(1.0, 50.0),
            "D",
            Value("2"),
            "Its height above the ground. As high as the domain it has the domain's top.",
        ),
    ],
};

/// What the keys of one box say.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Names of the turbines that it is laid around; all where there are none.
    pub around: Vec<String>,
    /// From the foremost of them to its beginning (diameters of the first turbine).
    pub upstream_diameters: f64,
    /// From the last of them to its end (diameters).
    pub downstream_diameters: f64,
    /// Its width (diameters), plus their lateral spread.
    pub width_diameters: f64,
    /// Its height (diameters).
    pub height_diameters: f64,
}

/// The boxes that the `values` of `[flow]` ask for, in the order of the file.
pub fn asked(values: &Values) -> Vec<Asked> {
    values.tables(NAME).iter().map(Asked::of).collect()
}

/// What about the boxes in the `values` of `[flow]` cannot be, whatever the turbines.
pub fn check(values: &Values) -> Vec<Objection> {
    let tables = values.tables(NAME);
    let names_none = |table: &Values| table.has("around") && table.names("around").is_empty();
    let object = |(number, _): (usize, &Values)| Objection {
        key: Some(NAME),
        message: format!("number {number}: its `around` names no turbine"),
        label: "around nothing",
        fix: "name turbines, such as around = [\"T1\"], or leave it out for all".to_owned(),
    };
    tables.iter().enumerate().filter(|(_, table)| names_none(table)).map(object).collect()
}

impl Asked {
    fn of(values: &Values) -> Self {
        let mut all = Values::defaults(TABLE.keys);
        all.extend(values.iter().map(|(key, value)| (key, value.clone())));
        Self {
            around: all.names("around").to_vec(),
            upstream_diameters: all.number("upstream_diameters"),
            downstream_diameters: all.number("downstream_diameters"),
            width_diameters: all.number("width_diameters"),
            height_diameters: all.number("height_diameters"),
        }
    }
}
