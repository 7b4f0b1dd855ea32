//! `kind = "meandering"`: its keys, and what they say.

use super::{Decoupling, Followed, Leader, Reference};
use crate::keys::{BASE, PHASE_RANGE, START, sense};
use crate::kind::Control;
use basis::Sense;
use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Table, above, from, key};
use basis::records::PitchResponse;

pub(super) static TABLE: Table = Table {
    heading: "control.T2 = { kind = \"meandering\", … }",
    about: "Cyclic pitch in phase with the meandering of the wake from upstream, whose phase a phase-locked loop estimates from the tilt and yaw moments of the blades (`docs/phase-locked-loops.md`): it amplifies their slow oscillation, or attenuates it.",
    keys: &[
        key(
            "factor",
            from(0.0, 10.0),
            "–",
            Required,
            "Target amplitude of the oscillation over that of the baseline, α: above 1 amplifies and mixes the wake, below 1 attenuates and lowers the turbine's loads.",
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
            "Sense in which the load rotates, looking downwind: the yaw moment a quarter period after the tilt moment (`cw`) or before it (`ccw`).",
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
            "`wake`: the loads less what the pitch adds to them, each axis with its own phase. `load`: the loads as they are, as published; below a factor of about 0.5 the loop responds to its own pitch.",
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
            "Amplitude added per second, per amplitude that is lacking.",
        ),
        key(
            "fallback",
            Holds::Choice(&["baseline", "none"]),
            "",
            Value("\"baseline\""),
            "What it does while the loop is not locked. `baseline`: it fades out, and comes back with the lock. `none`: it pitches with the estimated phase even so, as published.",
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
            Otherwise("identified before the runs, by a helix of a degree in either sense"),
            "Azimuth offset of the inverse multi-blade transformation, with which tilt pitch changes the tilt moment alone; with `delay` and `moment_per_degree_mnm`.",
        ),
        key(
            "delay",
            from(-100.0, 100.0),
            "s",
            Otherwise("identified with `azimuth_offset_deg`"),
            "Time by which the moments lag behind cyclic pitch.",
        ),
        key(
            "moment_per_degree_mnm",
            above(0.0, 1e4),
            "MN m",
            Otherwise("identified with `azimuth_offset_deg`"),
            "Tilt or yaw moment lost per degree of cyclic pitch.",
        ),
        START,
        BASE[0],
        BASE[1],
        BASE[2],
        BASE[3],
        BASE[4],
    ],
};

/// Newton metres of a meganewton metre.
const MEGA: f64 = 1e6;
/// Time to learn the baseline's amplitudes when none is given (s).
const LEARNING_TIME: f64 = 300.0;

/// Settings of a turbine that amplifies or attenuates the meandering of the wake that meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanderingSettings {
    /// Target amplitude of the loads over that of the baseline, α (–).
    pub factor: f64,
    /// Largest pitch amplitude on either axis (rad); 0 is the baseline that only follows, whatever `offset`
    /// says.
    pub amplitude: f64,
    /// Largest constant pitch on either axis, to bring the loads' means to zero (rad).
    pub offset: f64,
    /// Lowest and highest Strouhal number f D / U that is followed (–).
    pub strouhal: [f64; 2],
    /// Way the loads circle.
    pub sense: Sense,
    /// Which moment the oscillator follows.
    pub leader: Leader,
    /// Loads as they are, or the wake's own part of them.
    pub followed: Followed,
    /// Where the baseline's amplitudes come from.
    pub reference: Reference,
    /// Integral action: amplitude added per time and amplitude error (1/s).
    pub bandwidth: f64,
    /// How pitch acts on the loads; found before the runs when absent.
    pub decoupling: Option<Decoupling>,
    /// Whether it fades to the baseline where the loop is not locked.
    pub fallback: bool,
    /// Time at which it starts (s).
    pub start: f64,
}

impl MeanderingSettings {
    /// What `control` says, and what was found before the runs; none where it is of another kind.
    pub fn of(control: &Control) -> Option<Self> {
        if !control.is(&super::MEANDERING) {
            return None;
        }
        let values = control.values();
        Some(Self {
            factor: values.number("factor"),
            amplitude: values.angle("amplitude_deg"),
            offset: values.angle("constant_pitch_deg"),
            strouhal: [values.number("strouhal_low"), values.number("strouhal_high")],
            sense: sense(values),
            leader: match values.word("leader") {
                "tilt" => Leader::Tilt,
                "yaw" => Leader::Yaw,
                _ => Leader::Both,
            },
            followed: if values.word("followed") == "load" {
                Followed::Load
            } else {
                Followed::Wake
            },
            reference: match values.word("reference") {
                "given" => {
                    let [tilt, yaw] = ["reference_tilt_mnm", "reference_yaw_mnm"]
                        .map(|key| values.number(key) * MEGA);
                    Reference::Given { tilt, yaw }
                }
                "learned" => {
                    let duration = values.optional_number("learning_time");
                    Reference::Learned { duration: duration.unwrap_or(LEARNING_TIME) }
                }
                _ => Reference::Observed,
            },
            bandwidth: values.number("integral_gain"),
            decoupling: given_decoupling(control)
                .or(control.response.as_ref().and_then(decoupling_of)),
            fallback: values.word("fallback") != "none",
            start: values.number("start"),
        })
    }
}

/// How pitch acts on the loads, where the keys of `control` tell.
fn given_decoupling(control: &Control) -> Option<Decoupling> {
    let values = control.values();
    Some(Decoupling {
        azimuth_offset: values.optional_number("azimuth_offset_deg")?.to_radians(),
        delay: values.optional_number("delay")?,
        gain: values.optional_number("moment_per_degree_mnm")? * MEGA / 1f64.to_radians(),
    })
}

fn decoupling_of(response: &PitchResponse) -> Option<Decoupling> {
    match *response {
        PitchResponse::Loads { azimuth_offset, delay, gain } => {
            Some(Decoupling { azimuth_offset, delay, gain })
        }
        PitchResponse::Estimator { .. }
        | PitchResponse::Transformation { .. }
        | PitchResponse::IndividualPitch { .. } => None,
    }
}

impl From<Decoupling> for PitchResponse {
    fn from(Decoupling { azimuth_offset, delay, gain }: Decoupling) -> Self {
        Self::Loads { azimuth_offset, delay, gain }
    }
}
