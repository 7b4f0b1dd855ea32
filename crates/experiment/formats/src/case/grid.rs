//! `[wind.grid]`: the points on which turbulence is made around rotors, read and written.

use super::error::ProblemKind;
use super::keys::GRID;
use super::section::Section;
use farm::case::{Flow, MadeGrid, Wind};
use farm::solvers::WindSource;

/// The points that `wind` has for its turbulence, where it says so.
pub(super) fn grid_of(wind: &Section) -> Option<MadeGrid> {
    if !wind.has("grid") {
        return None;
    }
    let section = wind.section("grid", &GRID);
    Some(MadeGrid {
        width: section.number("width"),
        height: section.number("height"),
        columns: section.whole("columns") as usize,
        rows: section.whole("rows") as usize,
    })
}

/// Notes where `flow` has no turbulence made on points of its own.
pub(super) fn check_grid(section: &Section, wind: &Wind, flow: &Flow) {
    let is_made_there = matches!(flow.solver.wind, WindSource::AroundRotors | WindSource::Any);
    if wind.grid.is_none() || is_made_there && !wind.is_brought() && wind.table.is_none() {
        return;
    }
    let why = "no turbulence is made around the rotors".to_owned();
    let kind = ProblemKind::NoUse { key: section.key_path("grid"), why };
    let fix =
        "leave it out, or use flow.solver = \"turbulence\" or \"vortex\" without a file of wind";
    section.findings().note(section.span_of("grid"), kind, Some(fix.to_owned()));
}

/// `grid` as a table in a line.
pub(super) fn grid_text(grid: &MadeGrid) -> String {
    let MadeGrid { width, height, columns, rows } = grid;
    format!("{{ width = {width:?}, height = {height:?}, columns = {columns}, rows = {rows} }}")
}
