//! `[wind]`: its keys and what ties them to what moves the air, read and written.

use super::cut::{check_cut, cut_of, cut_text};
use super::error::ProblemKind;
use super::event::{event_of, event_text, start_of};
use super::grid::{check_grid, grid_of, grid_text};
use super::section::Section;
use super::text::{degrees, quoted};
use farm::case::{Beyond, FROM_WEST, Flow, Shear, TurbulenceModel, Wind};
use farm::solvers::{Fault, Objection, WindSource};
use std::fmt::Write;

/// The wind that `section` describes; not a number where it is missing.
pub(super) fn wind_of(section: &Option<Section>) -> Wind {
    let number = |key| section.as_ref().map_or(f64::NAN, |section| section.number(key));
    Wind {
        speed: number("speed"),
        direction: number("direction_deg").to_radians(),
        turbulence_intensity: number("turbulence_intensity"),
        shear: shear_of(section),
        length_scale: section.as_ref().and_then(|section| section.optional_number("length_scale")),
        anisotropy: number("anisotropy"),
        seed: section.as_ref().map_or(1, |section| section.whole("seed")),
        air_density: number("air_density"),
        kinematic_viscosity: number("kinematic_viscosity"),
        turbulence_model: match section.as_ref().map(|section| section.choice("turbulence_model")) {
            Some("kaimal") => TurbulenceModel::Kaimal,
            _ => TurbulenceModel::Mann,
        },
        grid: section.as_ref().and_then(grid_of),
        planes: section.as_ref().and_then(|section| section.optional_text("planes")),
        precursor: section.as_ref().and_then(|section| section.optional_text("precursor")),
        precursor_beside: section
            .as_ref()
            .is_some_and(|section| section.choice("precursor_wind") == BESIDE),
        beyond_planes: section.as_ref().and_then(beyond_of),
        cut: section.as_ref().and_then(cut_of),
        table: section.as_ref().and_then(|section| section.optional_text("table")),
        veer: number("veer_deg_per_m").to_radians(),
        event: section.as_ref().and_then(|section| {
            let entry = section.entry("event")?;
            event_of(section, entry, number("speed"))
        }),
    }
}

/// Word of `precursor_wind` for a precursor that goes on beside its study.
const BESIDE: &str = "beside";
/// Names of what may blow beyond the planes of a file.
const BEYOND: [(&str, Beyond); 3] =
    [("repeat", Beyond::Repeat), ("mean", Beyond::Mean), ("hold", Beyond::Hold)];

/// What blows beyond the planes, where `section` says so.
fn beyond_of(section: &Section) -> Option<Beyond> {
    if !section.has("beyond_planes") {
        return None;
    }
    let chosen = section.choice("beyond_planes");
    BEYOND.iter().find(|(name, _)| *name == chosen).map(|(_, beyond)| *beyond)
}

/// How the mean speed of `section` grows with height; notes when two laws are asked for.
fn shear_of(section: &Option<Section>) -> Shear {
    let Some(section) = section else { return Shear::PowerLaw { exponent: f64::NAN } };
    let Some(roughness_length) = section.optional_number("roughness_length") else {
        return Shear::PowerLaw { exponent: section.number("shear_exponent") };
    };
    if section.has("shear_exponent") {
        let why = "the profile is logarithmic with wind.roughness_length";
        let key = section.key_path("shear_exponent");
        let kind = ProblemKind::NoUse { key, why: why.to_owned() };
        let fix =
            "leave one of the two out; where --set gives one, the other must go from the file";
        section.findings().note(section.span_of("shear_exponent"), kind, Some(fix.into()));
    }
    Shear::LogLaw { roughness_length }
}

/// Notes where the wind of `section` does not suit what moves the air, or begins after `duration` (s).
pub(super) fn check_together(section: &Section, wind: &Wind, flow: &Flow, duration: f64) {
    let note = |key: &str, kind, fix: &str| {
        section.findings().note(section.span_of(key), kind, Some(fix.into()));
    };
    for Objection { key, fault, fix } in (flow.solver.objections)(wind, flow) {
        let kind = match fault {
            Fault::NoUse(why) => {
                ProblemKind::NoUse { key: section.key_path(key), why: why.to_owned() }
            }
            Fault::Refused(why) => {
                ProblemKind::NotWithSolver { solver: flow.solver.name, why: why.to_owned() }
            }
            Fault::Missing(missing) => ProblemKind::Missing { key: missing.to_owned() },
        };
        note(key, kind, fix);
    }
    if wind.table.is_some() {
        check_table(section, wind, flow);
    }
    check_precursor(section, wind, flow);
    check_cut(section, wind);
    check_grid(section, wind, flow);
    if wind.beyond_planes.is_some()
        && (!wind.brings_planes() || flow.solver.wind.of(wind) != WindSource::AtInlet)
    {
        let why = "it is for recorded planes at the inlet of resolved flow".to_owned();
        let kind = ProblemKind::NoUse { key: section.key_path("beyond_planes"), why };
        note("beyond_planes", kind, "leave it out");
    }
    if let Some(event) = &wind.event {
        let start = start_of(event);
        if start >= duration {
            let key = section.key_path("event.start");
            note("event", ProblemKind::StartsTooLate { key, start, duration }, "begin it earlier");
        }
    }
}

/// Notes where the atmosphere of a precursor has no use, or leaves none to planes.
fn check_precursor(section: &Section, wind: &Wind, flow: &Flow) {
    let (key, why, fix) = if wind.precursor.is_none() {
        if !wind.precursor_beside {
            return;
        }
        (
            "precursor_wind",
            "there is no wind.precursor".to_owned(),
            "name its folder, or leave it out",
        )
    } else if !flow.solver.stands_in_atmosphere {
        let why = format!(
            "flow.solver = \"{}\" has neither temperature nor the earth's turning",
            flow.solver.name
        );
        ("precursor", why, "leave it out, or use flow.solver = \"lattice\"")
    } else if wind.planes.is_some() {
        let why = "the planes are those of wind.precursor".to_owned();
        ("planes", why, "leave one of the two out")
    } else {
        return;
    };
    let kind = ProblemKind::NoUse { key: section.key_path(key), why };
    section.findings().note(section.span_of(key), kind, Some(fix.to_owned()));
}

/// Notes what a table of wind over time leaves no use for, and where it has none itself.
fn check_table(section: &Section, wind: &Wind, flow: &Flow) {
    let no_use = |key: &str, why: String, fix: &str| {
        let kind = ProblemKind::NoUse { key: section.key_path(key), why };
        section.findings().note(section.span_of(key), kind, Some(fix.to_owned()));
    };
    let source = flow.solver.wind.of(wind);
    if source != WindSource::Deterministic {
        let why = if source == WindSource::AtInlet {
            format!(
                "flow.solver = \"{}\" would answer wind that changes everywhere at once with pressure waves",
                flow.solver.name
            )
        } else {
            format!("flow.solver = \"{}\" reads no wind over time", flow.solver.name)
        };
        no_use("table", why, "leave it out, or use flow.solver = \"uniform\"");
        return;
    }
    let why = || "wind.table says what happens in time".to_owned();
    if wind.event.is_some() {
        no_use("event", why(), "leave one of the two out");
    }
    if wind.veer != 0.0 {
        no_use("veer_deg_per_m", why(), "leave one of the two out");
    }
}

/// Writes the section of `wind`. What came in later is written only where it is used, so that the fingerprint
/// of a case without it stays what it was.
pub(super) fn write_wind(text: &mut String, wind: &Wind) -> std::fmt::Result {
    writeln!(text, "\n[wind]")?;
    writeln!(text, "speed = {:?}", wind.speed)?;
    if wind.direction != FROM_WEST {
        writeln!(text, "direction_deg = {:?}", degrees(wind.direction))?;
    }
    writeln!(text, "turbulence_intensity = {:?}", wind.turbulence_intensity)?;
    match wind.shear {
        Shear::PowerLaw { exponent } => writeln!(text, "shear_exponent = {exponent:?}")?,
        Shear::LogLaw { roughness_length } => {
            writeln!(text, "roughness_length = {roughness_length:?}")?;
        }
    }
    if let Some(length_scale) = wind.length_scale {
        writeln!(text, "length_scale = {length_scale:?}")?;
    }
    writeln!(text, "anisotropy = {:?}", wind.anisotropy)?;
    writeln!(text, "seed = {}", wind.seed)?;
    writeln!(text, "air_density = {:?}", wind.air_density)?;
    writeln!(text, "kinematic_viscosity = {:?}", wind.kinematic_viscosity)?;
    let model = match wind.turbulence_model {
        TurbulenceModel::Mann => "mann",
        TurbulenceModel::Kaimal => "kaimal",
    };
    writeln!(text, "turbulence_model = \"{model}\"")?;
    if let Some(grid) = &wind.grid {
        writeln!(text, "grid = {}", grid_text(grid))?;
    }
    if let Some(planes) = &wind.planes {
        writeln!(text, "planes = {}", quoted(planes))?;
    }
    if let Some(precursor) = &wind.precursor {
        writeln!(text, "precursor = {}", quoted(precursor))?;
        if wind.precursor_beside {
            writeln!(text, "precursor_wind = \"{BESIDE}\"")?;
        }
    }
    if let Some(beyond) = wind.beyond_planes {
        let name = BEYOND.iter().find(|(_, one)| *one == beyond).map_or("", |(name, _)| name);
        writeln!(text, "beyond_planes = \"{name}\"")?;
    }
    if let Some(cut) = &wind.cut {
        writeln!(text, "cut = {}", cut_text(cut))?;
    }
    if let Some(table) = &wind.table {
        writeln!(text, "table = {}", quoted(table))?;
    }
    if wind.veer != 0.0 {
        writeln!(text, "veer_deg_per_m = {:?}", degrees(wind.veer))?;
    }
    if let Some(event) = &wind.event {
        writeln!(text, "event = {}", event_text(event))?;
    }
    Ok(())
}
