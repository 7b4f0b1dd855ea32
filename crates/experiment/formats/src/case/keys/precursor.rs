//! Keys of the file of a precursor: the box, the air in it, how long it lasts, what is recorded.

use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Slip, Table, above, from, key};
use farm::domain::SUBGRID_WORDS;

/// Greatest seed: the lattice's noise tells so many apart.
const SEED_MOST: u64 = (1 << 24) - 1;

/// The whole file.
pub(in crate::case) static PRECURSOR: Table = Table {
    heading: "(top of the file)",
    about: "What the precursor is called. One file is one box of atmosphere.",
    keys: &[
        key(
            "name",
            Holds::Name,
            "",
            Required,
            "Name of the precursor: letters, digits, `-` and `_`.",
        ),
        key(
            "description",
            Holds::Text,
            "",
            Otherwise("no description"),
            "What it is for, in one line.",
        ),
        key(
            "seed",
            Holds::Whole { least: 0, most: SEED_MOST },
            "–",
            Value("1"),
            "Seed of the first noise; another seed is another hour of the same climate.",
        ),
        key("box", Holds::Table(&BOX), "", Required, "The periodic box of cells."),
        key("atmosphere", Holds::Table(&ATMOSPHERE), "", Required, "The air in it."),
        key("time", Holds::Table(&TIME), "", Required, "How long it lasts."),
        key("planes", Holds::Table(&PLANES), "", Required, "What is recorded for studies."),
    ],
};

/// `[box]`.
pub(in crate::case) static BOX: Table = Table {
    heading: "[box]",
    about: "A box of cubic cells: what leaves on one side enters on the other; at the top the air slips. Each length is a whole number of cells.",
    keys: &[
        key("length", above(10.0, 1e5), "m", Required, "Length along x, which points east; at least three times `atmosphere.inversion_height`, better five, so that the layer's eddies do not meet themselves.")
            .mistaken(&[Slip { unit: "km", factor: 1000.0 }]),
        key("width", above(10.0, 1e5), "m", Required, "Length along y, which points north; likewise.")
            .mistaken(&[Slip { unit: "km", factor: 1000.0 }]),
        key("height", above(10.0, 2e4), "m", Required, "Height; the inversion and the damped layer have their place in it.")
            .mistaken(&[Slip { unit: "km", factor: 1000.0 }]),
        key("cell", above(0.0, 500.0), "m", Required, "Edge of a cell: half as large takes sixteen times as long. At least eight lie below the inversion."),
        key("subgrid", Holds::Choice(&SUBGRID_WORDS), "", Otherwise("`smagorinsky`"), "Model of the eddies that cells do not resolve. `smagorinsky`: from the strain of the cell, with the constant 0.16. From the velocity gradient between neighbours, in a pass of its own: `wale` (Nicoud, Ducros 1999), `vreman` (Vreman 2004), `amd`: anisotropic minimum dissipation (Rozema et al. 2015). docs/validation/atmosphere.md compares them."),
        key("threads", Holds::Whole { least: 1, most: 1024 }, "–", Otherwise("all cores"), "Threads. The result does not depend on it."),
    ],
};

/// `[atmosphere]`.
pub(in crate::case) static ATMOSPHERE: Table = Table {
    heading: "[atmosphere]",
    about: "The air at the start and what drives it. Temperatures are potential ones. The pressure gradient is that of a geostrophic wind; the wind near the ground follows, slower and turned towards low pressure. The geostrophic wind is given, or the wind at hub height that it is to make.",
    keys: &[
        key("latitude_deg", from(-90.0, 90.0), "deg", Required, "Latitude, positive on the northern half; 5° from the equator at least. The Coriolis parameter is 2 Ω sin(latitude)."),
        key("roughness_length", above(0.0, 5.0), "m", Required, "Roughness length z₀: about 0.0002 on calm sea, 0.001 on open sea, 0.03 on farmland.")
            .mistaken(&[Slip { unit: "mm", factor: 0.001 }]),
        key("geostrophic_wind", above(0.0, 60.0), "m/s", Otherwise("as `hub_wind` needs it"), "Speed of the geostrophic wind, which blows above the layer. At hub height offshore it is about a tenth less.")
            .mistaken(&[Slip { unit: "km/h", factor: 1.0 / 3.6 }]),
        key("geostrophic_direction_deg", from(0.0, 360.0), "deg", Otherwise("270, where `geostrophic_wind` is given"), "Where it comes from, clockwise from north: 270 is along the box's x axis. Where it blows aslant to the box, long streaks do not come back into themselves."),
        key("hub_wind", above(0.0, 60.0), "m/s", Otherwise("what `geostrophic_wind` makes of it"), "In its place: speed of the mean wind at `planes.hub_height`. The geostrophic wind follows, by a control that acts over hours.")
            .mistaken(&[Slip { unit: "km/h", factor: 1.0 / 3.6 }]),
        key("hub_direction_deg", from(0.0, 360.0), "deg", Otherwise("270, where `hub_wind` is given"), "Where that wind comes from, clockwise from north."),
        key("temperature", from(200.0, 350.0), "K", Value("288.15"), "Temperature from the ground to the inversion."),
        key("inversion_height", above(0.0, 2e4), "m", Required, "Height where the inversion begins."),
        key("inversion_strength", from(0.0, 50.0), "K", Required, "Rise of temperature through the inversion; 0 leaves it out."),
        key("inversion_depth", above(0.0, 5000.0), "m", Value("100"), "Depth of the inversion."),
        key("lapse_rate", from(0.0, 0.1), "K/m", Value("0.003"), "Rise of temperature above the inversion.")
            .mistaken(&[Slip { unit: "K/km", factor: 0.001 }]),
        key("heat_flux", from(-0.5, 0.5), "K m/s", Otherwise("no heat passes through the ground"), "Kinematic heat flux through the ground, upwards."),
        key("cooling_rate", from(-10.0, 10.0), "K/h", Otherwise("no heat passes through the ground"), "In place of `heat_flux`: the ground begins with `temperature` and cools by so much an hour; negative warms it."),
        key("damping_from", above(0.0, 2e4), "m", Otherwise("three quarters of `box.height`"), "Height from which on waves are damped, so that the top does not send them back; above the inversion."),
        key("damping_rate", above(0.0, 0.5), "1/s", Value("0.005"), "Rate of damping at the top; it rises from zero with the square of a sine."),
    ],
};

/// `[time]`.
pub(in crate::case) static TIME: Table = Table {
    heading: "[time]",
    about: "How long it lasts. `spin_up` and `record` may be raised afterwards: `--resume` goes on.",
    keys: &[
        key(
            "spin_up",
            from(0.0, 1e6),
            "s",
            Required,
            "Time before planes are recorded: turbulence grows, and the wind comes to a balance, which takes hours.",
        ),
        key(
            "record",
            above(0.0, 1e6),
            "s",
            Required,
            "Time that is recorded after it. A study needs its `time.duration`, the time from its inlet to the first turbine, and that of half the width of the planes.",
        ),
        key(
            "step",
            from(1e-4, 10.0),
            "s",
            Otherwise("the geostrophic wind crosses a tenth of a cell"),
            "Time step.",
        ),
        key(
            "statistics_interval",
            above(0.0, 1e5),
            "s",
            Value("60"),
            "Time between two records of statistics, rounded down to whole steps.",
        ),
    ],
};

/// `[planes]`.
pub(in crate::case) static PLANES: Table = Table {
    heading: "[planes]",
    about: "Planes of wind that are recorded as `planes.bts`. They stand across the mean wind at hub height in the last part of the spin-up; u of the file blows along it, so that the file's x axis is the mean wind there.",
    keys: &[
        key(
            "hub_height",
            above(0.0, 2000.0),
            "m",
            Required,
            "Height whose mean wind the planes stand across, and whose speed carries them along; the statistics tell of it, too.",
        ),
        key(
            "rotor_diameter",
            above(0.0, 1000.0),
            "m",
            Otherwise("the hub alone is marked"),
            "Diameter of the rotors that the wind is for: the report marks what they span. It changes nothing else.",
        ),
        key(
            "width",
            above(0.0, 1e5),
            "m",
            Otherwise("the shorter side of the box"),
            "Width of the planes.",
        ),
        key(
            "height",
            above(0.0, 2e4),
            "m",
            Otherwise("`atmosphere.inversion_height`"),
            "Height up to which points are recorded, one for each cell.",
        ),
        key(
            "interval",
            above(0.0, 1e4),
            "s",
            Otherwise("the geostrophic wind crosses half a cell"),
            "Time between two planes, rounded down to whole steps.",
        ),
    ],
};
