//! Keys of what runs on a turbine.

use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Key, Table, above, from, key};

/// Kinds of control, with the keys of each.
pub(in crate::case) static CONTROLS: &[(&str, &Table)] = &[
    ("baseline", &BASELINE),
    ("helix", &HELIX),
    ("pulse", &PULSE),
    ("phase-sync", &PHASE_SYNC),
    ("meandering", &MEANDERING),
    ("absent", &ABSENT),
];

/// Names of [`CONTROLS`].
pub(in crate::case) const CONTROL_KINDS: &[&str] =
    &["baseline", "helix", "pulse", "phase-sync", "meandering", "absent"];

const KIND: Key =
    key("kind", Holds::Choice(CONTROL_KINDS), "", Required, "What runs on the turbine.");
const AMPLITUDE: Key = key(
    "amplitude_deg",
    from(0.0, 10.0),
    "deg",
    Required,
    "Pitch amplitude of a blade; 0 is the baseline, bit for bit.",
);
const STROUHAL: Key = key(
    "strouhal",
    above(0.0, 2.0),
    "–",
    Required,
    "Strouhal number f D / U of the excitation, with `wind.speed` and the diameter of the first turbine.",
);
const START: Key = key(
    "start",
    from(0.0, 1e6),
    "s",
    Value("0"),
    "Time at which it fades in; before `time.duration`.",
);
const STOP: Key = key(
    "stop",
    above(0.0, 1e6),
    "s",
    Otherwise("never"),
    "Time at which it fades out again, over one excitation period as it fades in; at least one period after `start`. After the end of the run it changes nothing.",
);
const PHASE_RANGE: Holds = from(-360.0, 360.0);

/// `kind = "baseline"`.
pub(in crate::case) static BASELINE: Table = Table {
    heading: "control.T1 = { kind = \"baseline\" }",
    about: "Most power below rated, rated power above.",
    keys: &[KIND],
};

/// `kind = "absent"`.
pub(in crate::case) static ABSENT: Table = Table {
    heading: "control.T1 = { kind = \"absent\" }",
    about: "The turbine is not there in this run: the wake of the others, undisturbed.",
    keys: &[KIND],
};

/// `kind = "helix"`.
pub(in crate::case) static HELIX: Table = Table {
    heading: "control.T1 = { kind = \"helix\", … }",
    about: "Individual pitch that moves the thrust centre on a circle, on top of baseline.",
    keys: &[
        KIND,
        key(
            "sense",
            Holds::Choice(&["cw", "ccw"]),
            "",
            Required,
            "`ccw`: blades pitch at rotor plus excitation frequency. `cw`: at rotor minus excitation frequency.",
        ),
        AMPLITUDE,
        STROUHAL,
        key("phase_deg", PHASE_RANGE, "deg", Value("0"), "Phase of the tilt command at time zero."),
        key(
            "azimuth_offset_deg",
            PHASE_RANGE,
            "deg",
            Value("0"),
            "Azimuth offset of the inverse multi-blade transformation. An open helix has a free phase, of which this is a part: it adds to `phase_deg` (`ccw`) or takes from it (`cw`).",
        ),
        START,
        STOP,
    ],
};

/// `kind = "pulse"`.
pub(in crate::case) static PULSE: Table = Table {
    heading: "control.T1 = { kind = \"pulse\", … }",
    about: "Collective pitch, periodic, on top of baseline.",
    keys: &[
        KIND,
        AMPLITUDE,
        STROUHAL,
        key("phase_deg", PHASE_RANGE, "deg", Value("0"), "Phase at time zero."),
        START,
        STOP,
    ],
};

/// `kind = "phase-sync"`.
pub(in crate::case) static PHASE_SYNC: Table = Table {
    heading: "control.T2 = { kind = \"phase-sync\", … }",
    about: "The helix in step with the one that comes from upstream: its phase is found in the blade loads, and the pitch follows it with an offset.",
    keys: &[
        KIND,
        key(
            "offset_deg",
            from(-3600.0, 3600.0),
            "deg",
            Required,
            "Lead of the pitch over the wind that meets the rotor, 0 to 360. 0: pitch rises where the wind does and takes load off; 180: it falls where the wind rises and adds load. Other angles are turned into the circle, with a warning.",
        ),
        key(
            "amplitude_deg",
            from(0.0, 10.0),
            "deg",
            Required,
            "Pitch amplitude of a blade; 0 is the baseline, bit for bit, with the estimate in the series.",
        ),
        key(
            "sense",
            Holds::Choice(&["cw", "ccw"]),
            "",
            Otherwise("that of the nearest turbine upstream with a helix"),
            "Which way the helix winds that it joins.",
        ),
        key(
            "strouhal",
            above(0.0, 2.0),
            "–",
            Otherwise("that of the nearest turbine upstream with a helix"),
            "Strouhal number of the helix that it joins, with `wind.speed` and the diameter of the first turbine.",
        ),
        key(
            "azimuth_offset_deg",
            PHASE_RANGE,
            "deg",
            Otherwise(
                "found before the runs, by a helix of a degree in either sense in prescribed wind",
            ),
            "Azimuth offset ψ of the inverse multi-blade transformation, with which tilt pitch answers in the tilt moment alone; 0 with `amplitude_deg = 0`. At one frequency the blades pitch with it as with none and an `offset_deg` greater (`ccw`) or less (`cw`) by ψ.",
        ),
        key(
            "estimator",
            Holds::Choice(&["robust", "published"]),
            "",
            Value("\"robust\""),
            "`robust`: extended Kalman filter with states for shear, eddies and what else its model lacks. `published`: the four states of van Vondelen et al. (2025).",
        ),
        key(
            "fallback",
            Holds::Choice(&["baseline", "none"]),
            "",
            Value("\"baseline\""),
            "What it does where the estimate cannot be trusted. `baseline`: it fades out, and comes back with the helix. `none`: it goes on.",
        ),
        key(
            "measurement_noise_mnm",
            above(0.0, 1e4),
            "MN m",
            Otherwise("5 % of the mean moment"),
            "Standard deviation of the noise in a blade's moment that the estimator believes in. `wakemix analyse tune` finds it, and how the wave wanders, on the records of a run.",
        ),
        key(
            "wandering_amplitude",
            above(0.0, 1e6),
            "m²/s³",
            Otherwise("8e-4; 1e-4 with `estimator = \"published\"`"),
            "Variance per time, (m/s)²/s, with which the helix's amplitude wanders in the estimator's belief; with `robust` each of its sine and cosine components.",
        ),
        key(
            "wandering_phase",
            above(0.0, 1e6),
            "rad²/s",
            Otherwise("1e-4; only with `estimator = \"published\"`"),
            "Variance per time with which each phase wanders in the estimator's belief.",
        ),
        START,
    ],
};

/// `kind = "meandering"`.
pub(in crate::case) static MEANDERING: Table = Table {
    heading: "control.T2 = { kind = \"meandering\", … }",
    about: "Cyclic pitch in phase with the meandering of the wake that comes from upstream, found in the tilt and yaw moments of the blades by a phase-locked loop (`docs/phase-locked-loops.md`): it amplifies their slow oscillation, or attenuates it.",
    keys: &[
        KIND,
        key(
            "factor",
            from(0.0, 10.0),
            "–",
            Required,
            "Amplitude of the oscillation asked for over that of the baseline, α: above 1 amplifies and mixes the wake, below 1 attenuates and spares the turbine.",
        ),
        key(
            "amplitude_deg",
            from(0.0, 10.0),
            "deg",
            Required,
            "Largest cyclic pitch on either axis; 0 is the baseline, bit for bit, with the estimate in the series.",
        ),
        key(
            "strouhal_low",
            above(0.0, 2.0),
            "–",
            Value("0.15"),
            "Lowest Strouhal number f D / U that is followed, with `wind.speed` and the diameter of the first turbine.",
        ),
        key(
            "strouhal_high",
            above(0.0, 2.0),
            "–",
            Value("0.3"),
            "Highest Strouhal number that is followed; the loop starts at the middle.",
        ),
        key(
            "sense",
            Holds::Choice(&["cw", "ccw"]),
            "",
            Value("\"cw\""),
            "Way the load circles, looking downwind: the yaw moment a quarter period after the tilt moment (`cw`) or before it (`ccw`).",
        ),
        key(
            "leader",
            Holds::Choice(&["both", "tilt", "yaw"]),
            "",
            Value("\"both\""),
            "Moment that the loop is locked to. `both` takes them for one oscillation of the `sense` given; `yaw` is for a wake that meanders sideways.",
        ),
        key(
            "followed",
            Holds::Choice(&["wake", "load"]),
            "",
            Value("\"wake\""),
            "`wake`: the loads less what the pitch adds to them, each axis with its own phase. `load`: the loads as they are, as published; below a factor of about 0.5 the loop answers to its own pitch.",
        ),
        key(
            "reference",
            Holds::Choice(&["observed", "learned", "given"]),
            "",
            Value("\"observed\""),
            "Where the baseline's amplitudes come from. `observed`: from the loads less what the pitch adds, all the time. `learned`: from the loads before `start`. `given`: from a baseline run, as `reference_tilt_mnm` and `reference_yaw_mnm`.",
        ),
        key(
            "learning_time",
            above(0.0, 1e6),
            "s",
            Otherwise("300 with `reference = \"learned\"`"),
            "How long the baseline's amplitudes are learned, locked, before it acts.",
        ),
        key(
            "reference_tilt_mnm",
            above(0.0, 1e4),
            "MN m",
            Otherwise("none; needed with `reference = \"given\"`"),
            "Amplitude of the tilt moment's oscillation in the baseline.",
        ),
        key(
            "reference_yaw_mnm",
            above(0.0, 1e4),
            "MN m",
            Otherwise("none; needed with `reference = \"given\"`"),
            "Amplitude of the yaw moment's oscillation in the baseline.",
        ),
        key(
            "integral_gain",
            above(0.0, 1.0),
            "1/s",
            Value("0.01"),
            "Amplitude added per second and amplitude missing.",
        ),
        key(
            "fallback",
            Holds::Choice(&["baseline", "none"]),
            "",
            Value("\"baseline\""),
            "What it does while the loop is not locked. `baseline`: it fades out, and comes back with the lock. `none`: it pitches with whatever phase it believes in, as published.",
        ),
        key(
            "constant_pitch_deg",
            from(0.0, 10.0),
            "deg",
            Value("0"),
            "Largest constant pitch on either axis, to bring the means of tilt and yaw moment to zero; 0 leaves them.",
        ),
        key(
            "azimuth_offset_deg",
            PHASE_RANGE,
            "deg",
            Otherwise("found before the runs, by a helix of a degree in either sense"),
            "Azimuth offset of the inverse multi-blade transformation, with which tilt pitch answers in the tilt moment alone; with `delay` and `moment_per_degree_mnm`.",
        ),
        key(
            "delay",
            from(-100.0, 100.0),
            "s",
            Otherwise("found with `azimuth_offset_deg`"),
            "Time by which the moments lag behind cyclic pitch.",
        ),
        key(
            "moment_per_degree_mnm",
            above(0.0, 1e4),
            "MN m",
            Otherwise("found with `azimuth_offset_deg`"),
            "Tilt or yaw moment lost per degree of cyclic pitch.",
        ),
        START,
    ],
};
