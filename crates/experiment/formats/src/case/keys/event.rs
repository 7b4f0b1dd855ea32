//! Keys of what happens in time in a wind without turbulence.

use basis::keys::LeftOut::{Required, Value};
use basis::keys::{Holds, Key, Slip, Table, above, from, key};

/// Kinds of events, with the keys of each.
pub(in crate::case) static EVENTS: &[(&str, &Table)] = &[
    ("step", &STEP),
    ("ramp", &RAMP),
    ("staircase", &STAIRCASE),
    ("operating-gust", &OPERATING_GUST),
    ("direction-change", &DIRECTION_CHANGE),
    ("coherent-gust", &COHERENT_GUST),
    ("extreme-shear", &EXTREME_SHEAR),
    ("rotating-disk", &ROTATING_DISK),
];

/// Names of [`EVENTS`].
pub(in crate::case) const EVENT_KINDS: &[&str] = &[
    "step",
    "ramp",
    "staircase",
    "operating-gust",
    "direction-change",
    "coherent-gust",
    "extreme-shear",
    "rotating-disk",
];

const KIND: Key = key("kind", Holds::Choice(EVENT_KINDS), "", Required, "What happens.");
const START: Key =
    key("start", from(0.0, 1e6), "s", Required, "When it begins; before `time.duration`.");
const SPEED: Key =
    key("speed", from(0.0, 40.0), "m/s", Required, "Speed at hub height afterwards.")
        .mistaken(&[Slip { unit: "km/h", factor: 1.0 / 3.6 }]);
const CHANGE: Holds = from(-180.0, 180.0);
const DURATION: Holds = above(0.0, 1e6);

/// `kind = "step"`.
pub(in crate::case) static STEP: Table = Table {
    heading: "wind.event = { kind = \"step\" }",
    about: "The whole profile grows or shrinks at once.",
    keys: &[KIND, START, SPEED],
};

/// `kind = "ramp"`.
static RAMP: Table = Table {
    heading: "wind.event = { kind = \"ramp\" }",
    about: "The whole profile grows or shrinks linearly.",
    keys: &[KIND, START, key("duration", DURATION, "s", Required, "How long it takes."), SPEED],
};

/// `kind = "staircase"`.
static STAIRCASE: Table = Table {
    heading: "wind.event = { kind = \"staircase\" }",
    about: "Steps of equal rise, one after the other: a sweep through the operating range.",
    keys: &[
        KIND,
        START,
        key("hold", DURATION, "s", Required, "Time between steps."),
        key(
            "rise",
            from(-40.0, 40.0),
            "m/s",
            Required,
            "Rise of the speed at hub height per step; negative falls, but never below calm.",
        ),
        key("n_steps", Holds::Whole { least: 1, most: 1000 }, "–", Required, "Number of steps."),
    ],
};

/// `kind = "operating-gust"`.
static OPERATING_GUST: Table = Table {
    heading: "wind.event = { kind = \"operating-gust\" }",
    about: "Extreme operating gust of IEC 61400-1 edition 3, eq. 18: a dip, a rise, a dip, the same at every height.",
    keys: &[
        KIND,
        START,
        key("duration", DURATION, "s", Value("10.5"), "How long it takes."),
        key(
            "gust",
            from(-40.0, 40.0),
            "m/s",
            Required,
            "Gust V_gust: the lesser of 1.35 (V_e1 − V_hub) and 3.3 σ₁ / (1 + 0.1 D/Λ₁), eq. 17.",
        ),
    ],
};

/// `kind = "direction-change"`.
static DIRECTION_CHANGE: Table = Table {
    heading: "wind.event = { kind = \"direction-change\" }",
    about: "Extreme direction change of IEC 61400-1 edition 3, eq. 21; the wind stays turned.",
    keys: &[
        KIND,
        START,
        key("duration", DURATION, "s", Value("6"), "How long it takes."),
        key(
            "change_deg",
            CHANGE,
            "deg",
            Required,
            "Change of direction, counter-clockwise seen from above: positive turns the wind towards the left looking downwind.",
        ),
    ],
};

/// `kind = "coherent-gust"`.
static COHERENT_GUST: Table = Table {
    heading: "wind.event = { kind = \"coherent-gust\" }",
    about: "Extreme coherent gust with direction change of IEC 61400-1 edition 3, eqs. 22 and 24; the wind keeps its final speed and direction.",
    keys: &[
        KIND,
        START,
        key("duration", DURATION, "s", Value("10"), "Rise time."),
        key(
            "rise",
            from(-40.0, 40.0),
            "m/s",
            Value("15"),
            "Rise of the speed, the same at every height.",
        ),
        key(
            "change_deg",
            CHANGE,
            "deg",
            Required,
            "Change of direction, counter-clockwise seen from above; the standard has 720°/(V_hub in m/s), either sign.",
        ),
    ],
};

/// `kind = "extreme-shear"`.
static EXTREME_SHEAR: Table = Table {
    heading: "wind.event = { kind = \"extreme-shear\" }",
    about: "Extreme wind shear of IEC 61400-1 edition 3, eqs. 26 and 27, over the rotor of the first turbine; it comes and goes.",
    keys: &[
        KIND,
        START,
        key("duration", DURATION, "s", Value("12"), "How long it takes."),
        key(
            "vertical",
            from(-40.0, 40.0),
            "m/s",
            Value("0"),
            "Largest change of speed one radius above the hub.",
        ),
        key(
            "horizontal",
            from(-40.0, 40.0),
            "m/s",
            Value("0"),
            "Largest change of speed one radius to the left of the hub, looking downwind.",
        ),
    ],
};

/// `kind = "rotating-disk"`.
static ROTATING_DISK: Table = Table {
    heading: "wind.event = { kind = \"rotating-disk\" }",
    about: "A disk of slow air, a meandering wake in its simplest form: its centre runs on an ellipse around the first turbine's hub, from its top at time zero. Lengths are in diameters of the first turbine, Strouhal numbers with `wind.speed`. Defaults after van Veldhoven (TU Delft 2024), §4-1-3, where the speed inside is half that outside.",
    keys: &[
        KIND,
        key("speed", from(0.0, 40.0), "m/s", Required, "Speed inside the disk."),
        key(
            "offset_y_diameters",
            from(0.0, 10.0),
            "D",
            Value("0.2"),
            "Half-axis of the ellipse across.",
        ),
        key(
            "offset_z_diameters",
            from(0.0, 10.0),
            "D",
            Value("0.1"),
            "Half-axis of the ellipse upwards.",
        ),
        key("radius_diameters", above(0.0, 10.0), "D", Value("0.5"), "Radius of the disk."),
        key(
            "edge_diameters",
            from(0.0, 10.0),
            "D",
            Value("0"),
            "Width over which the speed changes linearly at its edge, half inside, half outside; 0 is sharp.",
        ),
        key(
            "strouhal",
            above(0.0, 10.0),
            "–",
            Value("0.18"),
            "Strouhal number f D / U of circling at time zero.",
        ),
        key(
            "strouhal_last",
            above(0.0, 10.0),
            "–",
            Value("0.22"),
            "Strouhal number of circling from the end of the sweep on.",
        ),
        key(
            "sweep",
            from(0.0, 1e6),
            "s",
            Value("1500"),
            "Time over which the frequency goes linearly from the first to the last; 0 has the last from the start.",
        ),
        key(
            "sense",
            Holds::Choice(&["cw", "ccw"]),
            "",
            Value("\"cw\""),
            "Sense of rotation, looking downwind.",
        ),
    ],
};
