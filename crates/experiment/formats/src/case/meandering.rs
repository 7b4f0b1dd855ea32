//! `kind = "meandering"`: its keys and what ties them together, read and written.

use super::check::sense_of;
use super::error::ProblemKind;
use super::section::Section;
use super::write::{degrees, shortest};
use farm::case::{Decoupling, Followed, Leader, Meandering, Reference, Sense};

/// Newton metres of a meganewton metre.
const MEGA: f64 = 1e6;
/// Time to learn the baseline's amplitudes when none is told (s).
const LEARNING_TIME: f64 = 300.0;

/// The control that `section` describes, starting at `start` (s).
pub(super) fn meandering_of(section: &Section, start: f64) -> Meandering {
    let strouhal = [section.number("strouhal_low"), section.number("strouhal_high")];
    let [low, high] = strouhal;
    if low >= high {
        let kind = ProblemKind::NoRange { key: section.key_path("strouhal_low"), low, high };
        let fix =
            "meandering wanders between about 0.15 and 0.3; give the loop a range to follow it in";
        section.findings().note(section.span_of("strouhal_low"), kind, Some(fix.into()));
    }
    Meandering {
        factor: section.number("factor"),
        amplitude: section.number("amplitude_deg").to_radians(),
        offset: section.number("constant_pitch_deg").to_radians(),
        strouhal,
        sense: sense_of(section),
        leader: match section.choice("leader") {
            "tilt" => Leader::Tilt,
            "yaw" => Leader::Yaw,
            _ => Leader::Both,
        },
        followed: if section.choice("followed") == "load" {
            Followed::Load
        } else {
            Followed::Wake
        },
        reference: reference_of(section),
        bandwidth: section.number("integral_gain"),
        decoupling: decoupling_of(section),
        fallback: section.choice("fallback") != "none",
        start,
    }
}

/// Where the baseline's amplitudes come from; notes what is missing for it, and what is of no use.
fn reference_of(section: &Section) -> Reference {
    let word = section.choice("reference");
    let amplitudes = ["reference_tilt_mnm", "reference_yaw_mnm"];
    for key in amplitudes.into_iter().chain(["learning_time"]) {
        let needed = if key == "learning_time" { "learned" } else { "given" };
        if section.has(key) && word != needed {
            let why = format!("it goes with reference = \"{needed}\", not \"{word}\"");
            let kind = ProblemKind::NoUse { key: section.key_path(key), why };
            section.findings().note(section.span_of(key), kind, Some("leave it out".into()));
        }
    }
    match word {
        "given" => {
            let fix = "reference = \"given\" needs the amplitudes of tilt and yaw moment in the baseline, in MN m";
            let [tilt, yaw] = amplitudes.map(|key| needed(section, key, fix) * MEGA);
            Reference::Given { tilt, yaw }
        }
        "learned" => {
            let duration = section.optional_number("learning_time").unwrap_or(LEARNING_TIME);
            Reference::Learned { duration }
        }
        _ => Reference::Observed,
    }
}

/// How pitch acts on the loads, where the file tells; all three keys or none.
fn decoupling_of(section: &Section) -> Option<Decoupling> {
    let keys = ["azimuth_offset_deg", "delay", "moment_per_degree_mnm"];
    if !keys.iter().any(|key| section.has(key)) {
        return None;
    }
    let fix = "azimuth_offset_deg, delay and moment_per_degree_mnm go together; leave all three out to have them found before the runs";
    let [azimuth_offset, delay, moment] = keys.map(|key| needed(section, key, fix));
    Some(Decoupling { azimuth_offset: azimuth_offset.to_radians(), delay, gain: gain_of(moment) })
}

/// A number that other keys make necessary; notes its absence with `fix`.
fn needed(section: &Section, key: &str, fix: &str) -> f64 {
    section.optional_number(key).unwrap_or_else(|| {
        let kind = ProblemKind::Missing { key: section.key_path(key) };
        section.findings().note(section.span_of(key), kind, Some(fix.to_owned()));
        f64::NAN
    })
}

/// Moment lost per pitch (N m/rad) of a `moment` per degree (MN m).
fn gain_of(moment: f64) -> f64 {
    moment * MEGA / 1f64.to_radians()
}

/// The control as text, every key written out that says something.
pub(super) fn meandering_text(control: &Meandering) -> String {
    let sense = if control.sense == Sense::Clockwise { "cw" } else { "ccw" };
    let leader = match control.leader {
        Leader::Tilt => "tilt",
        Leader::Yaw => "yaw",
        Leader::Both => "both",
    };
    let followed = match control.followed {
        Followed::Load => "load",
        Followed::Wake => "wake",
    };
    let reference = match control.reference {
        Reference::Observed => "reference = \"observed\"".to_owned(),
        Reference::Learned { duration } => {
            format!("reference = \"learned\", learning_time = {duration:?}")
        }
        Reference::Given { tilt, yaw } => {
            let [tilt, yaw] = [tilt, yaw].map(|n| shortest(n, n / MEGA, |text| text * MEGA));
            format!(
                "reference = \"given\", reference_tilt_mnm = {tilt:?}, reference_yaw_mnm = {yaw:?}"
            )
        }
    };
    let decoupling = control.decoupling.map_or_else(String::new, |found| {
        let gain = found.gain;
        let moment = shortest(gain, gain * 1f64.to_radians() / MEGA, gain_of);
        let offset = degrees(found.azimuth_offset);
        let delay = found.delay;
        format!(
            ", azimuth_offset_deg = {offset:?}, delay = {delay:?}, moment_per_degree_mnm = {moment:?}"
        )
    });
    // Only where it is used, so that the fingerprint of a case without it stays what it was.
    let fallback = if control.fallback { "" } else { ", fallback = \"none\"" };
    format!(
        "{{ kind = \"meandering\", factor = {:?}, amplitude_deg = {:?}, strouhal_low = {:?}, strouhal_high = {:?}, sense = \"{sense}\", leader = \"{leader}\", followed = \"{followed}\", {reference}, integral_gain = {:?}, constant_pitch_deg = {:?}{decoupling}{fallback}, start = {:?} }}",
        control.factor,
        degrees(control.amplitude),
        control.strouhal[0],
        control.strouhal[1],
        control.bandwidth,
        degrees(control.offset),
        control.start,
    )
}
