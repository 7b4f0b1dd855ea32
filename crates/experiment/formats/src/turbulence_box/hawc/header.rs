//! The header of HAWC2-style binaries, read and checked.

use super::super::{FASTEST, HEIGHTS, SPACINGS, sound};
use super::{Axis, Header, Layout, WHAT, grid_of};
use crate::FileError;
use crate::atomic;
use std::path::Path;

/// The header at `path`.
///
/// # Errors
/// [`FileError`] names file, line, key and fix.
pub(super) fn read_header(path: &Path) -> Result<Header, FileError> {
    let text = atomic::read_text(path, WHAT)?;
    let header: Header = toml::from_str(&text).map_err(|error| {
        let line = error.span().map_or(1, |span| 1 + text[..span.start].matches('\n').count());
        let problem = format!("line {line}: {}", error.message());
        FileError::content(
            WHAT,
            path,
            problem,
            "the comments of a header that `wakemix inflow generate` wrote name all keys",
        )
    })?;
    check(path, &text, &header)?;
    sound(path, WHAT, &grid_of(&header), header.wind.hub_height)?;
    Ok(header)
}

/// Whether the numbers of `header`, which `text` says, make a box.
fn check(path: &Path, text: &str, header: &Header) -> Result<(), FileError> {
    // Every problem begins with the key that it is about, `box.spacing` or the like.
    let wrong = |problem: String, fix: &str| {
        let key = problem.split_once('.').map_or("", |(_, key)| key);
        let key = key.split(' ').next().unwrap_or_default();
        let line = 1 + text.lines().take_while(|line| !line.trim_start().starts_with(key)).count();
        Err(FileError::content(WHAT, path, format!("line {line}: {problem}"), fix))
    };
    let Layout { n_points, spacing, x_runs, y_runs, .. } = &header.layout;
    if !matches!(x_runs, Axis::Upwind | Axis::Downwind) {
        return wrong("box.x_runs is a way along y".into(), "x_runs = \"upwind\" or \"downwind\"");
    }
    if !matches!(y_runs, Axis::Left | Axis::Right) {
        return wrong("box.y_runs is a way along x".into(), "y_runs = \"left\" or \"right\"");
    }
    let n_values = n_points.iter().try_fold(4_usize, |bytes, n| bytes.checked_mul(*n));
    if n_values.is_none_or(|bytes| bytes == 0) {
        return wrong(
            format!("box.n_points = {n_points:?} is no box"),
            "give the points along x, y, z",
        );
    }
    if !spacing.iter().all(|spacing| SPACINGS.contains(spacing)) {
        return wrong(
            format!("box.spacing = {spacing:?} is no distance"),
            "give 0.001 to 100000 m along x, y, z",
        );
    }
    let wind = &header.wind;
    let (fastest, highest) = (f64::from(FASTEST), *HEIGHTS.end());
    for (key, value, most) in
        [("hub_speed", wind.hub_speed, fastest), ("hub_height", wind.hub_height, highest)]
    {
        if !(value > 0.0 && value <= most) {
            let problem = format!("wind.{key} = {value:?} is not above zero and at most {most}");
            return wrong(problem, "give it in m/s or m");
        }
    }
    if !HEIGHTS.contains(&wind.lowest_height) {
        let problem = format!("wind.lowest_height = {:?} is no height", wind.lowest_height);
        return wrong(problem, "give metres above ground or mean sea level");
    }
    let is_wind = |speed: &f64| speed.abs() <= fastest;
    if let Some(speed) = wind.mean_speeds.iter().find(|speed| !is_wind(speed)) {
        let problem = format!("wind.mean_speeds holds {speed:?}, which is no wind");
        return wrong(problem, "give m/s, one per height, lowest first");
    }
    if wind.mean_speeds.len() != n_points[2] {
        let found = wind.mean_speeds.len();
        let needed = n_points[2];
        return wrong(
            format!("wind.mean_speeds has {found} speeds for {needed} heights"),
            "one per height, lowest first",
        );
    }
    Ok(())
}
