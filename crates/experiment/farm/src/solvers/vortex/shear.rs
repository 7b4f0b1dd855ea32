//! What of the wind's shear does not carry wakes.

use crate::case::Case;
use crate::plan::Plan;
use crate::wind;
use flow::Inflow;
use flow::inflow::{InflowError, MeanColumn, Planes};
use flow::vortex::MeanShear;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Height above the hub up to which the mean of a table of wind is taken (diameters), and heights at which it
/// is (–): beyond, wakes are carried as at the highest.
const HIGHEST_WAKE: f64 = 2.0;
const HEIGHTS: u32 = 200;

/// What the mean shear of the wind does to wakes: of `planes` where there are any, else of `inflow`.
///
/// # Errors
/// [`InflowError`] for planes that cannot be read, [`InflowError::BrokenOff`] after a break of `progress`.
pub(super) fn of(
    case: &Case,
    plan: &Plan,
    inflow: &dyn Inflow,
    planes: Option<&mut dyn Planes>,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<MeanShear, InflowError> {
    if case.flow.values.word("wake_shear") != "left-out" {
        return Ok(MeanShear::Carries);
    }
    if let Some(planes) = planes {
        return Ok(MeanShear::LeftOutOf(Arc::new(MeanColumn::of_planes(planes, progress)?)));
    }
    let own = MeanShear::LeftOut {
        profile: wind::profile(case, plan),
        hub_height: plan.hub_height,
        veer: case.wind.veer,
    };
    if case.wind.table.is_none() {
        return Ok(own);
    }
    let top = plan.hub_height + HIGHEST_WAKE * plan.diameter;
    let heights: Vec<f64> =
        (0..=HEIGHTS).map(|k| top * f64::from(k) / f64::from(HEIGHTS)).collect();
    let foot = plan.positions.first().copied().unwrap_or_default();
    let column = MeanColumn::over_time(inflow, case.time.duration, foot, &heights);
    Ok(column.map_or(own, |column| MeanShear::LeftOutOf(Arc::new(column))))
}
