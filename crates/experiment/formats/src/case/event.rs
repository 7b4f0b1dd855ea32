//! `wind.event`: what happens in time, read and written.

use super::document::{Entry, Node, Value};
use super::error::ProblemKind;
use super::keys::{self, EVENTS};
use super::section::Section;
use super::text::degrees;
use farm::case::{Change, CirclingDisk, Sense, WindEvent};

/// The event in `entry` of `wind`, whose speed at hub height is `speed` (m/s).
pub(super) fn event_of(wind: &Section, entry: &Entry, speed: f64) -> Option<WindEvent> {
    let Node { value: Value::Table(entries), span } = &entry.node else {
        let expected = "a table, such as { kind = \"step\", start = 100.0, speed = 12.0 }";
        wind.wrong_type("event", &entry.node, expected);
        return None;
    };
    let path = wind.key_path("event");
    let kind = entries.iter().find(|entry| entry.key == "kind").map(|entry| &entry.node.value);
    let known = match kind {
        Some(Value::Text(kind)) => EVENTS.iter().find(|(name, _)| name == kind),
        _ => None,
    };
    let Some((name, table)) = known else {
        // Without a kind no other key can be judged.
        let only_kind: Vec<Entry> =
            entries.iter().filter(|entry| entry.key == "kind").cloned().collect();
        Section::open(&keys::STEP, &only_kind, span.clone(), path, wind.findings()).choice("kind");
        return None;
    };
    let section = Section::open(table, entries, span.clone(), path, wind.findings());
    Some(event_of_kind(name, &section, speed))
}

/// The event of the kind `name`, whose keys stand in `section`, in a wind of `speed` (m/s).
fn event_of_kind(name: &str, section: &Section, speed: f64) -> WindEvent {
    let number = |key: &str| section.number(key);
    let turn = || section.number("change_deg").to_radians();
    // Each kind has its own keys.
    let change = match name {
        "step" => Change::Step { start: number("start"), speed: number("speed") },
        "ramp" => Change::Ramp {
            start: number("start"),
            duration: number("duration"),
            speed: number("speed"),
        },
        "staircase" => staircase_of(section, speed),
        "operating-gust" => Change::OperatingGust {
            start: number("start"),
            duration: number("duration"),
            gust: number("gust"),
        },
        "direction-change" => Change::DirectionChange {
            start: number("start"),
            duration: number("duration"),
            change: turn(),
        },
        "coherent-gust" => Change::CoherentGust {
            start: number("start"),
            duration: number("duration"),
            rise: number("rise"),
            change: turn(),
        },
        "extreme-shear" => return extreme_shear_of(section),
        _ => return WindEvent::RotatingDisk(disk_of(section)),
    };
    WindEvent::Everywhere(change)
}

/// The shear that comes and goes, as `section` has it; notes where there is none.
fn extreme_shear_of(section: &Section) -> WindEvent {
    let number = |key: &str| section.number(key);
    let (vertical, horizontal) = (number("vertical"), number("horizontal"));
    if vertical == 0.0 && horizontal == 0.0 {
        let why = "neither `vertical` nor `horizontal` says how much the wind shears".to_owned();
        let kind = ProblemKind::NoUse { key: section.key_path("kind"), why };
        let fix =
            "give one of them or both, in m/s one radius from the hub, or leave the event out";
        section.findings().note(section.span_of("kind"), kind, Some(fix.into()));
    }
    let (start, duration) = (number("start"), number("duration"));
    WindEvent::ExtremeShear { start, duration, vertical, horizontal }
}

/// The disk that circles, as `section` has it.
fn disk_of(section: &Section) -> CirclingDisk {
    let number = |key: &str| section.number(key);
    CirclingDisk {
        speed: number("speed"),
        offsets_diameters: [number("offset_y_diameters"), number("offset_z_diameters")],
        radius_diameters: number("radius_diameters"),
        edge_diameters: number("edge_diameters"),
        strouhal: [number("strouhal"), number("strouhal_last")],
        sweep: number("sweep"),
        sense: sense_of(section),
    }
}

/// Steps from `speed` (m/s); notes when they would lead below calm.
fn staircase_of(section: &Section, speed: f64) -> Change {
    let (rise, n_steps) = (section.number("rise"), section.whole("n_steps"));
    let last = speed + rise * n_steps as f64;
    if last < 0.0 {
        let kind = ProblemKind::OutOfRange {
            key: section.key_path("rise"),
            value: format!("{rise}"),
            range: format!(
                "rise >= {:.4} m/s for {n_steps} steps down to calm",
                -speed / n_steps as f64
            ),
        };
        let fix = "take fewer or smaller steps";
        section.findings().note(section.span_of("rise"), kind, Some(fix.into()));
    }
    Change::Staircase {
        start: section.number("start"),
        hold: section.number("hold"),
        rise,
        // The table of keys allows a thousand.
        n_steps: n_steps as u32,
    }
}

/// When the event begins (s); the disk circles from time zero.
pub(super) fn start_of(event: &WindEvent) -> f64 {
    match *event {
        WindEvent::Everywhere(change) => change.start(),
        WindEvent::ExtremeShear { start, .. } => start,
        WindEvent::RotatingDisk(_) => 0.0,
    }
}

/// The event as a table in a line.
pub(super) fn event_text(event: &WindEvent) -> String {
    match event {
        WindEvent::Everywhere(change) => change_text(change),
        WindEvent::ExtremeShear { start, duration, vertical, horizontal } => format!(
            "{{ kind = \"extreme-shear\", start = {start:?}, duration = {duration:?}, vertical = {vertical:?}, horizontal = {horizontal:?} }}"
        ),
        WindEvent::RotatingDisk(disk) => {
            let [y, z] = disk.offsets_diameters;
            let [first, last] = disk.strouhal;
            let sense = if disk.sense == Sense::Clockwise { "cw" } else { "ccw" };
            format!(
                "{{ kind = \"rotating-disk\", speed = {:?}, offset_y_diameters = {y:?}, offset_z_diameters = {z:?}, radius_diameters = {:?}, edge_diameters = {:?}, strouhal = {first:?}, strouhal_last = {last:?}, sweep = {:?}, sense = \"{sense}\" }}",
                disk.speed, disk.radius_diameters, disk.edge_diameters, disk.sweep
            )
        }
    }
}

/// A change that is the same at all places as a table in a line.
fn change_text(change: &Change) -> String {
    match *change {
        Change::Step { start, speed } => {
            format!("{{ kind = \"step\", start = {start:?}, speed = {speed:?} }}")
        }
        Change::Ramp { start, duration, speed } => format!(
            "{{ kind = \"ramp\", start = {start:?}, duration = {duration:?}, speed = {speed:?} }}"
        ),
        Change::Staircase { start, hold, rise, n_steps } => format!(
            "{{ kind = \"staircase\", start = {start:?}, hold = {hold:?}, rise = {rise:?}, n_steps = {n_steps} }}"
        ),
        Change::OperatingGust { start, duration, gust } => format!(
            "{{ kind = \"operating-gust\", start = {start:?}, duration = {duration:?}, gust = {gust:?} }}"
        ),
        Change::DirectionChange { start, duration, change } => format!(
            "{{ kind = \"direction-change\", start = {start:?}, duration = {duration:?}, change_deg = {:?} }}",
            degrees(change)
        ),
        Change::CoherentGust { start, duration, rise, change } => format!(
            "{{ kind = \"coherent-gust\", start = {start:?}, duration = {duration:?}, rise = {rise:?}, change_deg = {:?} }}",
            degrees(change)
        ),
    }
}

fn sense_of(section: &Section) -> Sense {
    if section.choice("sense") == "cw" { Sense::Clockwise } else { Sense::CounterClockwise }
}
