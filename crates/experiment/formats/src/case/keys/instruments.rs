//! Keys of what a turbine's controller sees of it.

use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Slip, Table, above, from, key};

/// `[turbine.instruments]`.
pub(in crate::case) static INSTRUMENTS: Table = Table {
    heading: "[turbine.instruments]",
    about: "What the controller of a turbine sees of it. Instruments that are not named are perfect, bit for bit. Series, statistics, loads and report hold the truth; only controllers, with their estimators, read instruments. Noise belongs to `wind.seed`, the turbine's place in the file, the channel and the number of the reading. What is found before the runs (`phase-sync`, `meandering`) is found with perfect instruments.",
    keys: &[
        key("azimuth", Holds::Table(&ANGLE), "", PERFECT, "Azimuth encoder."),
        key(
            "pitch",
            Holds::Table(&ANGLE),
            "",
            PERFECT,
            "Pitch encoders, alike on all blades and with noise of their own.",
        ),
        key("rotor_speed", Holds::Table(&SPEED), "", PERFECT, "Encoder of rotor speed."),
        key(
            "generator_speed",
            Holds::Table(&SPEED),
            "",
            PERFECT,
            "Encoder of generator speed, over the gear ratio: torque and collective pitch follow it.",
        ),
        key(
            "generator_torque",
            Holds::Table(&MOMENT),
            "",
            PERFECT,
            "Generator torque, times the gear ratio.",
        ),
        key(
            "flap_moments",
            Holds::Table(&MOMENT),
            "",
            PERFECT,
            "Strain gauges at the blade roots, out of plane: phase synchronisation, meandering and individual pitch follow them.",
        ),
        key(
            "edge_moments",
            Holds::Table(&MOMENT),
            "",
            PERFECT,
            "Strain gauges at the blade roots, in plane.",
        ),
        key("power", Holds::Table(&POWER), "", PERFECT, "Electrical power."),
        key(
            "tower_top_acceleration",
            Holds::Table(&ACCELERATION),
            "",
            PERFECT,
            "Accelerometer at the tower top, fore-aft.",
        ),
    ],
};

const PERFECT: basis::keys::LeftOut = Otherwise("perfect");

/// A table of one kind of instrument: figures in `$unit`, whose keys end in `$suffix`, up to `$most`.
macro_rules! figures {
    (
        $name:ident, $names:literal, $about:literal, $suffix:literal, $unit:literal, $most:expr, $slips:expr
    ) => {
        #[doc = concat!("The instruments ", $names, ".")]
        pub(in crate::case) static $name: Table = Table {
            heading: concat!("turbine.instruments: ", $names, " = { … }"),
            about: $about,
            keys: &[
                key(concat!("noise", $suffix), from(0.0, $most), $unit, Value("0"), "Standard deviation of the white noise in each reading, one per control interval.").mistaken($slips),
                key(concat!("bias", $suffix), from(-$most, $most), $unit, Value("0"), "Bias: mean error of the reading.").mistaken($slips),
                key(concat!("resolution", $suffix), from(0.0, $most), $unit, Value("0"), "Resolution: step between the values that it can show; 0 is continuous.").mistaken($slips),
                key("dropout", from(0.0, 0.99), "–", Value("0"), "Share of the readings that fail and repeat the one before.").mistaken(PERCENT),
                key("time_constant", above(0.0, 1e3), "s", Otherwise("no first-order lag"), "Time constant of a first-order lag.").mistaken(MILLI),
                key("frequency_hz", above(0.0, 1e4), "Hz", Otherwise("no second-order lag"), "Natural frequency of a second-order lag, instead of a first-order one."),
                key("damping_ratio", from(0.0, 10.0), "–", Otherwise("0.7 with `frequency_hz`"), "Its damping ratio."),
            ],
        };
    };
}

const PERCENT: &[Slip] = &[Slip { unit: "percent", factor: 0.01 }];
const MILLI: &[Slip] = &[Slip { unit: "ms", factor: 0.001 }];

figures!(
    ANGLE,
    "azimuth, pitch",
    "An instrument of angles, such as `instruments.azimuth = { resolution_deg = 0.1 }` in `[[turbine]]`.",
    "_deg",
    "deg",
    180.0,
    &[]
);
figures!(
    SPEED,
    "rotor_speed, generator_speed",
    "An instrument of speeds.",
    "_rpm",
    "rpm",
    100.0,
    &[]
);
figures!(
    MOMENT,
    "generator_torque, flap_moments, edge_moments",
    "An instrument of moments, such as `instruments.flap_moments = { noise_mnm = 0.5, time_constant = 0.05 }` in `[[turbine]]`.",
    "_mnm",
    "MN m",
    100.0,
    &[Slip { unit: "kN m", factor: 1e-3 }, Slip { unit: "N m", factor: 1e-6 }]
);
figures!(
    POWER,
    "power",
    "The instrument of power.",
    "_kw",
    "kW",
    1e5,
    &[Slip { unit: "W", factor: 1e-3 }]
);
figures!(
    ACCELERATION,
    "tower_top_acceleration",
    "The instrument of acceleration.",
    "",
    "m/s²",
    100.0,
    &[Slip { unit: "mm/s²", factor: 1e-3 }]
);

/// The tables of [`INSTRUMENTS`], each once.
pub(in crate::case) static INSTRUMENT_KINDS: [&Table; 5] =
    [&ANGLE, &SPEED, &MOMENT, &POWER, &ACCELERATION];
