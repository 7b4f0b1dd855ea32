//! Turbulence that is carried into a domain through its inlet.

use super::{Site, Turbulence, from_file, length_scale, profile};
use crate::solvers::WindSource;
use flow::Inflow;
use flow::inflow::sizing::{Need, Size};
use flow::inflow::turbulent::BLOCKING_HEIGHT;
use flow::inflow::{InflowError, Planes, TurbulentInflow, mann, size_box};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Most memory that the turbulence may take (bytes); a longer run then meets the same wind again, and is
/// warned of it.
pub(super) const TURBULENCE_MEMORY: u64 = 6 << 30;

/// The turbulence of a box for the inlet of `site`; none where none enters so.
pub(super) fn turbulence(site: &Site) -> Option<Turbulence> {
    let size = size(site)?;
    let returns = || {
        format!(
            "the turbulence returns after {:.0} s: more would not fit in memory",
            size.repeats_after
        )
    };
    let warning = (!size.covers).then(returns);
    Some(Turbulence { memory: size.peak_memory, n_points: size.n_points, warning })
}

/// The wind with turbulence that enters the domain of `site`: that of `planes` where there are any, else made
/// now; none where no turbulence enters so. `progress` receives the share done; a break ends it.
///
/// # Errors
/// [`InflowError`] when it cannot be made or read, [`InflowError::BrokenOff`] after a break.
pub fn entering(
    site: &Site,
    planes: Option<Box<dyn Planes>>,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Option<Arc<dyn Inflow>>, InflowError> {
    if let Some(planes) = planes {
        return Ok(Some(Arc::new(from_file::entering(site, planes, progress)?)));
    }
    let Some(size) = size(site) else { return Ok(None) };
    let (case, plan, wind) = (site.case, site.plan, &site.case.wind);
    let settings = mann::MannSettings {
        n_points: size.n_points,
        spacing: size.spacing,
        length_scale: length_scale(wind, plan.hub_height),
        anisotropy: wind.anisotropy,
        standard_deviation: wind.turbulence_intensity * wind.speed,
        seed: wind.seed,
        threads: case.flow.threads,
    };
    let turbulence = mann::generate_until(&settings, progress)?;
    let profile = profile(case, plan);
    let inflow = TurbulentInflow::aligned(Arc::new(turbulence), profile, plan.origin)?;
    let inflow = inflow.blocked(BLOCKING_HEIGHT * settings.length_scale);
    Ok(Some(Arc::new(inflow.veering(wind.veer, plan.hub_height))))
}

/// What the inlet needs of the turbulence: the box of air at the start, then a plane for every later step.
fn size(site: &Site) -> Option<Size> {
    let (case, plan) = (site.case, site.plan);
    let is_made = case.wind_source() == WindSource::AtInlet && !case.wind.is_brought();
    if !is_made || case.wind.turbulence_intensity == 0.0 {
        return None;
    }
    let [length, width, height] = plan.n_cells.map(|n| n as f64 * plan.spacing);
    Some(size_box(&Need {
        length,
        width,
        height,
        hub_speed: case.wind.speed,
        duration: case.time.duration,
        spacing: plan.spacing,
        length_scale: length_scale(&case.wind, plan.hub_height),
        memory_limit: TURBULENCE_MEMORY,
    }))
}
