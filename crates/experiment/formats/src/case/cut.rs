//! `[wind.cut]`: what is taken of recorded planes, read and written.

use super::error::ProblemKind;
use super::keys::CUT;
use super::section::Section;
use farm::case::{Cut, Wind};

/// What the `wind` takes of its planes, where it says so.
pub(super) fn cut_of(wind: &Section) -> Option<Cut> {
    if !wind.has("cut") {
        return None;
    }
    let section = wind.section("cut", &CUT);
    Some(Cut {
        from: section.number("from"),
        duration: section.optional_number("duration"),
        block: section.whole("block"),
        width: section.optional_number("width"),
        height: section.optional_number("height"),
        spacing: section.optional_number("spacing"),
        shift: section.number("shift"),
    })
}

/// Notes where there is nothing to cut, and blocks of no length.
pub(super) fn check_cut(section: &Section, wind: &Wind) {
    let Some(cut) = &wind.cut else { return };
    let (key, why, fix) = if wind.planes.is_none() {
        let fix = "name the record, such as planes = \"slices-wake-5D.bts\", or leave it out";
        ("cut", "there is no wind.planes to take a part of", fix)
    } else if cut.block > 1 && cut.duration.is_none() {
        (
            "cut.block",
            "without wind.cut.duration there is one block",
            "add a duration, such as 660.0",
        )
    } else {
        return;
    };
    let kind = ProblemKind::NoUse { key: section.key_path(key), why: why.to_owned() };
    section.findings().note(section.span_of("cut"), kind, Some(fix.to_owned()));
}

/// `cut` as a table in a line.
pub(super) fn cut_text(cut: &Cut) -> String {
    let mut text = format!("{{ from = {:?}, block = {}", cut.from, cut.block);
    let given = [
        ("duration", cut.duration),
        ("width", cut.width),
        ("height", cut.height),
        ("spacing", cut.spacing),
        ("shift", Some(cut.shift)),
    ];
    for (key, value) in given {
        if let Some(value) = value {
            text += &format!(", {key} = {value:?}");
        }
    }
    text + " }"
}
