//! Keys of `kind = "wind-slices"`.

use super::super::output::OwnKeys;
use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Objection, Range, Table, Values, above, key};

pub(super) static OWN: OwnKeys = OwnKeys {
    table: Table {
        heading: "output.further.NAME = { kind = \"wind-slices\", … }",
        about: "Wind on slices across it, from the end of the spin-up on, each a full field in TurbSim's format that does not repeat: `RUN/slices-NAME-3D.bts` at 3 D. `wind.cut` takes blocks of them as the wind of other cases, `wakemix inflow cut` writes these for other programs. A point takes 6 bytes of disk a plane, 12 more until the run is complete, which stay with `last_checkpoint = \"keep\"` so that it can go on, and 72 bytes of memory, however long it is; `--dry-run` tells both. Runs without the turbine, `kind = \"absent\"`, record the undisturbed wind.",
        keys: &[
            key(
                "distances_diameters",
                Holds::Numbers(Range { low: -500.0, open: false, high: 500.0 }),
                "D",
                Required,
                "Distances of the slices behind the turbine; negative ones lie before it, in the wind that comes in.",
            ),
            key(
                "turbine",
                Holds::Name,
                "",
                Otherwise("the first one"),
                "Turbine whose hub is in the middle of the slices. In runs without it they lie at the same places.",
            ),
            key(
                "interval",
                above(0.0, 1e3),
                "s",
                Value("1"),
                "Time between planes, rounded to whole steps, one at least.",
            ),
            key(
                "width",
                above(0.0, 1e5),
                "m",
                Otherwise("four diameters"),
                "Width of the slices, as many whole spacings as it holds: that of a cut, and its farthest shift to either side.",
            ),
            key(
                "height",
                above(0.0, 1e4),
                "m",
                Otherwise("1.2 diameters"),
                "Their height, half of it above the hub; rows less than half a cell above the ground are left out.",
            ),
            key(
                "spacing",
                above(0.0, 1e3),
                "m",
                Otherwise("the edge of a cell outside of all boxes of finer ones"),
                "Distance of points. Between the middles of cells the wind is linear: points that stand closer than cells hold no more of it.",
            ),
        ],
    },
    check,
};

fn check(values: &Values) -> Vec<Objection> {
    let distances = values.numbers("distances_diameters");
    let twice = distances.iter().enumerate().find(|(at, one)| distances[..*at].contains(one));
    let (message, label) = match twice {
        Some((_, distance)) => (format!("names {distance} D twice"), "twice"),
        None if distances.is_empty() => ("asks for no slice".to_owned(), "of nothing"),
        None => return Vec::new(),
    };
    let fix = "name each distance once, such as distances_diameters = [-2.0, 3.0, 5.0]".to_owned();
    vec![Objection { key: Some("distances_diameters"), message, label, fix }]
}
