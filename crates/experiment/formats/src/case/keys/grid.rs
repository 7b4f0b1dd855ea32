//! Keys of the points on which turbulence is made around rotors.

use basis::keys::LeftOut::Required;
use basis::keys::{Holds, Table, above, key};

/// Fewest and most points along either direction (–).
const POINTS: Holds = Holds::Whole { least: 2, most: 1000 };

/// `[wind.grid]`.
pub(in crate::case) static GRID: Table = Table {
    heading: "[wind.grid]",
    about: "Points in a plane across the wind on which turbulence is made where `flow.solver` is `turbulence` or `vortex`: as many columns and rows as TurbSim would be told, the hub of the first turbine in their middle. Between them the wind is bilinear, beyond them that of the nearest. They hold every rotor, and lie above the ground.",
    keys: &[
        key("width", above(0.0, 1e5), "m", Required, "From the first column to the last."),
        key(
            "height",
            above(0.0, 1e4),
            "m",
            Required,
            "From the lowest row to the highest; at most twice the hub height.",
        ),
        key("columns", POINTS, "–", Required, "Points along the width."),
        key("rows", POINTS, "–", Required, "Points along the height."),
    ],
};
