//! Keys that several kinds of controllers have.

use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Key, Objection, Range, Values, above, from, key};

pub(crate) const SENSE: Key = key(
    "sense",
    Holds::Choice(&["cw", "ccw"]),
    "",
    Required,
    "`ccw`: blades pitch at rotor plus excitation frequency. `cw`: at rotor minus excitation frequency.",
);
pub(crate) const AMPLITUDE: Key = key(
    "amplitude_deg",
    from(0.0, 10.0),
    "deg",
    Required,
    "Pitch amplitude of a blade; 0 is the baseline, bit for bit.",
);
pub(crate) const STROUHAL: Key = key(
    "strouhal",
    above(0.0, 2.0),
    "–",
    Required,
    "Strouhal number f D / U of the excitation, with `wind.speed` and the diameter of the first turbine.",
);
pub(crate) const START: Key = key(
    "start",
    from(0.0, 1e6),
    "s",
    Value("0"),
    "Time at which it fades in; before `time.duration`.",
);
pub(crate) const STOP: Key = key(
    "stop",
    above(0.0, 1e6),
    "s",
    Otherwise("never"),
    "Time at which it fades out again, over one excitation period as it fades in; at least one period after `start`. After the end of the run it changes nothing.",
);
pub(crate) const LIDAR: Key = key(
    "lidar",
    Holds::Name,
    "",
    Value("\"lidar\""),
    "The turbine's lidar that looks downwind at its own wake.",
);
pub(crate) const VORTEX_FILTER: Key = key(
    "vortex_filter",
    Holds::Choice(&["robust", "published", "centroid"]),
    "",
    Value("\"robust\""),
    "How the hub vortex is found: weighted, with the filter's delay made good in the phase, as in the paper (fast region, delay left in), or in its place the centroid of the wind over the disc, which grows with the amplitude of the helix.",
);
pub(crate) const VORTEX_CENTRE: Key = key(
    "vortex_centre",
    Holds::Pair(Range { low: -500.0, open: false, high: 500.0 }),
    "m",
    Otherwise("the running mean over one period of the helix"),
    "Centre that the hub vortex is taken to turn about, to the left and up from the rotor's centre: a running mean takes a bias at rest off.",
);
pub(crate) const VORTEX_INTERVAL: Key = key(
    "vortex_interval",
    from(0.01, 10.0),
    "s",
    Value("0.1"),
    "Time between samples of the hub vortex, whose low-pass filter is over 51 of them; at least the control interval.",
);
pub(crate) const AZIMUTH_OFFSET: Key = key(
    "azimuth_offset_deg",
    PHASE_RANGE,
    "deg",
    Value("0"),
    "Azimuth offset of the inverse multi-blade transformation, which decouples tilt and yaw.",
);
pub(crate) const TILT_PHASE: Key =
    key("phase_deg", PHASE_RANGE, "deg", Value("0"), "Phase of the tilt command at time zero.");
/// A shared library under an excitation.
pub(crate) const BASE: [Key; 5] = [
    key(
        "library",
        Holds::Text,
        "",
        Otherwise("baseline, the built-in controller"),
        "Shared library that decides pitch and torque, on top of which the excitation goes; as for `kind = \"discon\"`.",
    ),
    key(
        "input",
        Holds::Text,
        "",
        Otherwise("none"),
        "Input file of the library, such as ROSCO's `DISCON.IN`; a path relative to the case file.",
    ),
    key(
        "procedure",
        Holds::Text,
        "",
        Otherwise("`DISCON`"),
        "Name of the procedure in the library.",
    ),
    key(
        "pitch_control",
        Holds::Choice(&["individual", "collective"]),
        "",
        Otherwise("`individual`"),
        "Which pitch the library is asked for: that of each blade (records 42 to 44), or one for all (record 45).",
    ),
    key(
        "anemometer",
        Holds::Name,
        "",
        Otherwise("the turbine's sensor called `anemometer`"),
        "Sensor of the turbine that shows the library the wind: speed (record 27), and yaw error where it has a second channel (record 24); `none` for a library that looks at no wind.",
    ),
];
pub(crate) const PHASE_RANGE: Holds = from(-360.0, 360.0);

/// What about the key `start` in `values` cannot be in a run of `duration` (s).
pub(crate) fn starts_too_late(values: &Values, duration: f64) -> Option<Objection> {
    too_late("start", values.number("start"), duration)
}

/// Why `start` (s), the value of `key`, cannot be in a run of `duration` (s), where it cannot.
pub(crate) fn too_late(key: &'static str, start: f64, duration: f64) -> Option<Objection> {
    (start >= duration).then(|| Objection {
        key: Some(key),
        message: format!(
            "= {start} s is not before the end of the run, `time.duration` = {duration} s"
        ),
        label: "too late",
        fix: "begin earlier, or raise `time.duration`, which counts from the start of the run"
            .to_owned(),
    })
}

/// The sense under the key `sense`.
pub(crate) fn sense(values: &Values) -> basis::Sense {
    if values.word("sense") == "cw" {
        basis::Sense::Clockwise
    } else {
        basis::Sense::CounterClockwise
    }
}
