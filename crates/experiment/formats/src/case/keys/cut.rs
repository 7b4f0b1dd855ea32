//! Keys of what is taken of recorded planes.

use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Table, above, from, key};

/// `[wind.cut]`.
pub(in crate::case) static CUT: Table = Table {
    heading: "[wind.cut]",
    about: "What is taken of the file of `wind.planes`, such as a slice behind a turbine that `kind = \"wind-slices\"` has recorded: a window of time on a rectangle around the hub of the first turbine, moved sideways. No file is made of it; `wakemix inflow cut` makes one for other programs. Between the points of the file the wind is bilinear, on them it is the file's own; planes are those of the file. Below its lowest row the wind of that row blows. What leaves the record is refused.",
    keys: &[
        key("from", from(0.0, 1e7), "s", Value("0"), "Where in the record the first block begins."),
        key(
            "duration",
            above(0.0, 1e7),
            "s",
            Otherwise("to the end of the record"),
            "Length of a block. It is longer than `time.duration`, by the time in which the wind passes half the width of the cut and 50 m before the rotor, and its radius where nacelles turn; what is too short is refused with the time that is needed.",
        ),
        key(
            "block",
            Holds::Whole { least: 1, most: 1_000_000 },
            "–",
            Value("1"),
            "Which of the blocks that follow one another, from 1: another block is another seed.",
        ),
        key(
            "width",
            above(0.0, 1e5),
            "m",
            Otherwise("that of the record"),
            "Width of the rectangle: a whole number of spacings.",
        ),
        key(
            "height",
            above(0.0, 1e4),
            "m",
            Otherwise("the rows of the record"),
            "Its height, half of it above the hub: a whole number of spacings.",
        ),
        key(
            "spacing",
            above(0.0, 1e3),
            "m",
            Otherwise("that of the record"),
            "Distance of its points along y and z; no finer than the record's.",
        ),
        key(
            "shift",
            from(-1e5, 1e5),
            "m",
            Value("0"),
            "How far the rectangle, and the rotor in its middle, stands to the left of the middle of the slice, looking downwind: of a slice behind a turbine that is the lateral displacement Δy.",
        ),
    ],
};
