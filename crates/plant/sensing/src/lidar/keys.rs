//! Keys of a lidar in the case file.

use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Range, Table, above, from, key};

/// Most points of a scan (–): their channels have three digits.
pub(super) const MOST_POINTS: u64 = 999;

pub(super) static TABLE: Table = Table {
    heading: "turbine.sensors.NAME = { kind = \"lidar\", … }",
    about: "A lidar: wind speed along its lines of sight, positive away from it, of any flow solver. A controller sees its latest scan: speeds, places and times of its points. The series keeps the speeds as `Los001` and so on, with the share of points that have one as `Valid`. A point whose beam was lost, or that was not measured yet, is no number. It feels the turn and the swaying of nacelle and tower. Left as it is, it is the lidar of Chen et al. (2026): 80 points over the rotor's disc, a diameter downwind, all at once, ten times a second.",
    keys: &[
        key(
            "scan",
            Holds::Choice(&["plane", "rings", "rosette", "beams"]),
            "",
            Value("\"plane\""),
            "How its points lie in a disc across its axis: on a square grid; on circles; on a curve of loops through the centre; as fixed beams, up to 8 on a cone, more in a spiral that fills the disc.",
        ),
        key(
            "n_points",
            Holds::Whole { least: 1, most: MOST_POINTS },
            "–",
            Value("80"),
            "Points of a scan, at each range. A plane needs a count that fills its disc: 4, 12, 16, 24, 32, 44, 52, 60, 68, 76, 80, 88 and so on.",
        ),
        key(
            "rings",
            Holds::Whole { least: 1, most: 20 },
            "–",
            Otherwise("3 with `scan = \"rings\"`"),
            "Circles, evenly spaced out to the rim.",
        ),
        key(
            "petals",
            Holds::Whole { least: 3, most: 50 },
            "–",
            Otherwise("5 with `scan = \"rosette\"`"),
            "Loops of the curve.",
        ),
        key(
            "order",
            Holds::Choice(&["at-once", "in-turn"]),
            "",
            Value("\"at-once\""),
            "Whether all points are measured at the same instant, or one after another.",
        ),
        key(
            "rate_hz",
            above(0.0, 5000.0),
            "Hz",
            Value("10"),
            "How often it measures: all points, or with `order = \"in-turn\"` the next one. Points that are due between two control instants are measured in the air of the later one.",
        ),
        key(
            "focal_distance_diameters",
            above(0.0, 20.0),
            "D",
            Otherwise("1, without ranges"),
            "Distance of the plane that the beams of a continuous wave are focused on, along the axis.",
        ),
        key(
            "ranges_diameters",
            Holds::Numbers(Range { low: 0.0, open: true, high: 20.0 }),
            "D",
            Otherwise("none: a continuous wave"),
            "Distances along each beam that a pulsed lidar measures at, all of them with each pulse.",
        ),
        key(
            "radius_diameters",
            above(0.0, 5.0),
            "D",
            Value("0.5"),
            "Radius of the disc, at the focal distance or the furthest range.",
        ),
        key(
            "looks",
            Holds::Choice(&["downwind", "upwind"]),
            "",
            Value("\"downwind\""),
            "Which way it looks. Blades block the beams of a lidar that looks upwind from the nacelle.",
        ),
        key(
            "mount",
            Holds::Choice(&["nacelle", "hub"]),
            "",
            Value("\"nacelle\""),
            "What it rides on: the nacelle, level, or the hub, along the shaft, where its beams turn with the rotor.",
        ),
        key(
            "above",
            from(-20.0, 20.0),
            "m",
            Value("0"),
            "How far above the rotor's centre it stands.",
        ),
        key(
            "downwind",
            from(-20.0, 50.0),
            "m",
            Value("0"),
            "How far downwind of the rotor's centre it stands.",
        ),
        key(
            "tilt_deg",
            from(-45.0, 45.0),
            "deg",
            Value("0"),
            "How far its axis is raised from the level, on a nacelle.",
        ),
        key(
            "probe",
            Holds::Choice(&["none", "lorentzian", "gaussian"]),
            "",
            Value("\"none\""),
            "Weight of the air along a beam: the point alone, that of a focused continuous wave, that of a pulse.",
        ),
        key(
            "probe_length",
            above(0.0, 500.0),
            "m",
            Otherwise("needed with a `probe`"),
            "Rayleigh length of a Lorentzian probe, which is cut at ten of them, full width at half maximum of a Gaussian one.",
        ),
        key(
            "noise",
            from(0.0, 20.0),
            "m/s",
            Value("0"),
            "Standard deviation of white noise in each speed.",
        ),
        key("dropout", from(0.0, 1.0), "–", Value("0"), "Share of measurements that are lost."),
        key(
            "seed",
            Holds::Whole { least: 0, most: u32::MAX as u64 },
            "–",
            Value("0"),
            "Another seed is another noise in the same wind; each lidar of a turbine wants its own.",
        ),
    ],
};
