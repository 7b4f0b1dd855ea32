//! Files that the wind of a case comes from: that they can be read shows before any run begins.

use crate::StudyError;
use crate::atmosphere::{self, unreadable};
use basis::Vector3;
use farm::case::Case;
use farm::plan::Plan;
use farm::solvers::WindSource;
use farm::wind::{self, Recorded, Site};
use flow::inflow::{Planes, TabulatedWind};
use formats::case::{CaseFile, objection};
use std::sync::Arc;

/// Mean speed of a table of wind over `wind.speed`, less one, beyond which a reader must know (–).
const SPEED_TO_WARN: f64 = 0.05;

/// The wind over time that the case of `file` reads; none where it reads none.
///
/// # Errors
/// [`StudyError::Case`] at `wind.table`.
pub(crate) fn table(
    file: &CaseFile,
    plan: &Plan,
) -> Result<Option<Arc<TabulatedWind>>, StudyError> {
    let case = &file.case;
    let Some(name) = &case.wind.table else { return Ok(None) };
    let refuse = |message| StudyError::Case(objection(file, &["wind", "table"], message));
    let rows = formats::wind_table::read(&file.folder().join(name))
        .map_err(|error| refuse(unreadable(&error)))?;
    let foot = plan.positions.first().copied().unwrap_or(Vector3::ZERO);
    let hub = foot + Vector3::Z * plan.hub_height;
    let table = TabulatedWind::new(wind::profile(case, plan), hub, plan.diameter, rows)
        .map_err(|error| refuse(error.to_string()))?;
    let (end, duration) = (table.end(), case.time.duration);
    if end < duration {
        return Err(refuse(format!(
            "{name} ends at {end} s, and runs last {duration} s: add a row at {duration} s or later, or lower time.duration"
        )));
    }
    Ok(Some(Arc::new(table)))
}

/// The planes of wind that the case of `file` reads, opened; none where it reads none.
///
/// # Errors
/// [`StudyError::Case`] at `wind.planes`, `wind.precursor` or the key of `wind.cut` that does not fit.
pub(crate) fn planes(file: &CaseFile, plan: &Plan) -> Result<Option<Box<dyn Planes>>, StudyError> {
    let case = &file.case;
    if case.wind_source() != WindSource::Planes && !wind::enters_from_file(case) {
        return Ok(None);
    }
    match atmosphere::open_planes(case, file.folder()) {
        Ok(planes) => atmosphere::cut(case, plan, planes).map(Some).map_err(|error| {
            let path = ["wind", "cut"].into_iter().chain(error.key()).collect::<Vec<_>>();
            let message = format!("{}: {}: {error}", path.join("."), name_of(case));
            StudyError::Case(objection(file, &path, message))
        }),
        Err(error) => {
            let message = unreadable(&error);
            Err(StudyError::Case(objection(file, &["wind", key_of(case)], message)))
        }
    }
}

/// Whether the points that the case of `file` gives for its turbulence hold the rotors of `site`.
///
/// # Errors
/// [`StudyError::Case`] at `wind.grid`.
pub(crate) fn check_grid(file: &CaseFile, site: &Site) -> Result<(), StudyError> {
    match wind::unsuited_grid(site) {
        None => Ok(()),
        Some(message) => Err(StudyError::Case(objection(
            file,
            &["wind", "grid"],
            format!("wind.grid does not hold the wind of the rotors: {message}"),
        ))),
    }
}

/// Key of the file that the wind of `case` comes from, and its mean speed at hub height (m/s): that of
/// `table` over the run, or of `planes`; none where it comes from no file.
pub(crate) fn recorded_speed(
    table: Option<&TabulatedWind>,
    planes: Option<&dyn Planes>,
    case: &Case,
) -> Option<(&'static str, f64)> {
    let of_table = table.map(|table| ("table", table.mean_speed(case.time.duration)));
    of_table.or_else(|| planes.map(|planes| (key_of(case), planes.grid().speed)))
}

/// Key of the recorded planes of `case`.
fn key_of(case: &Case) -> &'static str {
    if case.wind.precursor.is_some() { "precursor" } else { "planes" }
}

/// `planes` of the case of `file` as they enter the domain of `site`; none where they do not.
///
/// # Errors
/// [`StudyError::Case`] at `wind.planes` or `wind.precursor` where they do not fit.
pub(crate) fn at_inlet(
    file: &CaseFile,
    site: &Site,
    planes: Option<&dyn Planes>,
) -> Result<Option<Recorded>, StudyError> {
    let Some(planes) = planes.filter(|_| wind::enters_from_file(site.case)) else {
        return Ok(None);
    };
    let recorded = Recorded::new(site, planes).map_err(|error| {
        let (key, name) = (key_of(site.case), name_of(site.case));
        StudyError::Case(objection(file, &["wind", key], format!("{name}: {error}")))
    })?;
    Ok(Some(recorded))
}

/// What a reader of the numbers must know of the planes of the case of `file`, which enter the domain of
/// `site` as `recorded`.
///
/// # Errors
/// [`StudyError::File`] for a file that cannot be read.
pub(crate) fn warnings(
    file: &CaseFile,
    site: &Site,
    recorded: Option<Recorded>,
) -> Result<Vec<String>, StudyError> {
    let Some(recorded) = recorded else { return Ok(Vec::new()) };
    let mut warnings = recorded.warnings(site);
    let Some(name) = &site.case.wind.planes else { return Ok(warnings) };
    let maker = formats::turbulence_box::maker_with_divergence(&file.folder().join(name))?;
    warnings.extend(maker.map(|maker| {
        format!(
            "the turbulence of wind.planes is {maker}'s, which has divergence: the first cells take it away with part of the variance; go by the \
             intensity upstream of the rotor that the results tell, or take a box of Mann's tensor, which has none (wakemix inflow generate)"
        )
    }));
    Ok(warnings)
}

/// What the case calls its recorded planes.
fn name_of(case: &Case) -> &str {
    let wind = &case.wind;
    wind.precursor.as_deref().or(wind.planes.as_deref()).unwrap_or_default()
}

/// That `case` is laid out for another wind than that of `table`.
pub(crate) fn warning(case: &Case, table: Option<&TabulatedWind>) -> Option<String> {
    let mean = table?.mean_speed(case.time.duration);
    let speed = case.wind.speed;
    ((mean / speed - 1.0).abs() > SPEED_TO_WARN).then(|| {
        format!(
            "wind.table blows with {mean:.2} m/s on average, and wind.speed = {speed} m/s: Strouhal numbers and the rotors' first speeds are those of wind.speed"
        )
    })
}
