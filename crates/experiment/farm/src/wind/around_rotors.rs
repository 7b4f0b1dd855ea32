//! Wind that is prescribed where the rotors stand: even, made turbulent, or read plane by plane.

use super::{Site, Turbulence, length_scale, profile};
use crate::assemble::TurbineModel;
use crate::case::{Case, TurbulenceModel};
use crate::solvers::WindSource;
use basis::Vector3;
use flow::Inflow;
use flow::inflow::kaimal::{self, Scaling};
use flow::inflow::planes::BoxPlanes;
use flow::inflow::prescribed::Placement;
use flow::inflow::{InflowError, Planes, PrescribedWind, TurbulenceBox, mann};
use std::ops::ControlFlow;
use std::sync::Arc;

/// Air around the outermost tips that a grid of made turbulence covers (diameters of the largest rotor).
const MARGIN: f64 = 0.1;
/// Points of made turbulence across the largest rotor (–).
const POINTS_ACROSS: f64 = 24.0;
/// Time between planes of made turbulence (s),
const PLANE_INTERVAL: f64 = 0.1;
/// for models as long as a wind of this speed takes past the rotor (m/s).
const PASSING_SPEED: f64 = 100.0;
/// Most memory that making turbulence may take (bytes), however long the run is. A run of one turbine shall
/// stay below 200 MB (docs/validation/memory.md), the columns of its series included that summary and report
/// hold.
const MEMORY_LIMIT: u64 = 128 << 20;
/// Places upstream and downstream of the outermost towers at which turbines that face the wind may sample it
/// (m).
const REACH: f64 = 50.0;

/// The wind of `site`, prescribed: `planes` where there are any, else `inflow`, with turbulence on it where
/// the case has it made around the rotors; `progress` receives the share of that done, and a break ends it.
///
/// # Errors
/// [`InflowError`] when turbulence cannot be made, or planes do not cover the rotors for the whole run,
/// [`InflowError::BrokenOff`] after a break.
pub fn prescribed(
    site: &Site,
    inflow: Arc<dyn Inflow>,
    planes: Option<Box<dyn Planes>>,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<PrescribedWind, InflowError> {
    if let Some(planes) = planes {
        return over_rotors(site, planes);
    }
    let Some(grid) = made_grid(site) else { return Ok(PrescribedWind::everywhere(inflow)) };
    let turbulence = Arc::new(made(site, &grid, progress)?);
    let planes = BoxPlanes::new(turbulence, &profile(site.case, site.plan), grid.lowest)?
        .veering(site.case.wind.veer, site.plan.hub_height);
    over_rotors(site, Box::new(planes))
}

/// The turbulence that is made around the rotors of `site`; none where none is.
pub(super) fn turbulence(site: &Site) -> Option<Turbulence> {
    let grid = made_grid(site)?;
    let warning = grid.repeats_after.map(|time| {
        format!(
            "the turbulence returns after {time:.0} s: more would not fit in the memory that one turbine may take; for a longer one \
             write a file with `wakemix inflow generate` and read it with flow.solver = \"planes\""
        )
    });
    Some(Turbulence { memory: grid.memory, n_points: grid.n_points, warning })
}

/// What is wrong with the grid that the case of `site` has given, with the fix: it reaches below the ground,
/// or not over all rotors. None where it has given none, or none is made.
pub fn unsuited_grid(site: &Site) -> Option<String> {
    let given = site.case.wind.grid?;
    let made = made_grid(site)?;
    let [low, high] = around_rotors(site);
    let (side, top) = (0.5 * given.width, made.lowest + given.height);
    let needed = 2.0 * low.y.abs().max(high.y.abs());
    if made.lowest < 0.0 {
        let (most, hub) = (2.0 * site.plan.hub_height, site.plan.hub_height);
        return Some(format!(
            "half of its {} m are below the hub at {hub:.1} m, and reach into the ground: {most:.1} m are the most",
            given.height
        ));
    }
    let beside = low.y < -side || high.y > side;
    let above = low.z < made.lowest || high.z > top;
    if !beside && !above {
        return None;
    }
    Some(format!(
        "it spans {:.1} m to either side and {:.1} to {top:.1} m of height, and the rotors {:.1} to {:.1} m across and {:.1} to {:.1} m of \
         height: give it a width of {needed:.1} m and a height of {:.1} m at least",
        side,
        made.lowest,
        low.y,
        high.y,
        low.z,
        high.z,
        2.0 * (site.plan.hub_height - low.z).max(high.z - site.plan.hub_height),
    ))
}

/// Plane of the points of turbulence that is made around all rotors.
struct Across {
    n_points: [usize; 2],
    /// Distance of neighbouring points (m).
    spacing: [f64; 2],
    /// Height of the lowest row (m).
    lowest: f64,
}

/// The points of made turbulence across the wind of `site`; the middle of the width stands at y = 0.
fn across(site: &Site) -> Across {
    if let Some(grid) = site.case.wind.grid {
        return Across {
            n_points: [grid.columns, grid.rows],
            spacing: grid.spacing(),
            lowest: site.plan.hub_height - 0.5 * grid.height,
        };
    }
    let [low, high] = around_rotors(site);
    let diameter = site.models.iter().map(|m| m.definition.rotor_diameter()).fold(0.0, f64::max);
    let spacing = diameter / POINTS_ACROSS;
    let half_width = low.y.abs().max(high.y.abs()) + MARGIN * diameter;
    let lowest = (low.z - MARGIN * diameter).max(0.5 * spacing);
    let height = high.z + MARGIN * diameter - lowest;
    let points = |length: f64| (length / spacing).ceil() as usize + 1;
    Across { n_points: [points(2.0 * half_width), points(height)], spacing: [spacing; 2], lowest }
}

/// Grid of the turbulence that is made around all rotors.
struct Made {
    n_points: [usize; 3],
    /// Distance of neighbouring points (m).
    spacing: [f64; 3],
    /// Height of the lowest row (m).
    lowest: f64,
    /// Most memory that making it takes (bytes).
    memory: u64,
    /// Time after which the same wind comes again (s), where that is before the run's end.
    repeats_after: Option<f64>,
}

/// The grid of the turbulence that `site` has made around its rotors; none where it has none.
fn made_grid(site: &Site) -> Option<Made> {
    let (case, wind) = (site.case, &site.case.wind);
    if case.wind_source() != WindSource::AroundRotors || wind.turbulence_intensity == 0.0 {
        return None;
    }
    let [low, high] = around_rotors(site);
    let Across { n_points: [n_y, n_z], spacing, lowest } = across(site);
    let interval = PLANE_INTERVAL.min(site.plan.diameter / PASSING_SPEED);
    let along = wind.speed * interval;
    let length = (high.x - low.x) + 2.0 * reach_along(site) + reach_of_wakes(site);
    // Whole records only: 2, 3 and 5 are the only factors, which transforms like best.
    let whole = smooth((case.time.duration / interval + length / along).ceil() as usize);
    let (along, whole, n_across) = match wind.turbulence_model {
        TurbulenceModel::Kaimal => (along, whole, [n_y, n_z]),
        TurbulenceModel::Mann => {
            // Cells of one shape along and across, and twice the width, whose periodic image would be felt
            // otherwise.
            let stride = (spacing[0].min(spacing[1]) / along).floor().max(1.0) as usize;
            let n_across = [smooth(2 * n_y), smooth(2 * n_z)];
            (along * stride as f64, smooth(whole.div_ceil(stride)), n_across)
        }
    };
    let memory = |n_planes: usize| {
        let n_points = [n_planes, n_across[0], n_across[1]];
        match wind.turbulence_model {
            TurbulenceModel::Kaimal => kaimal::peak_memory(n_points),
            TurbulenceModel::Mann => mann::peak_memory(n_points),
        }
    };
    let mut n_planes = whole;
    while memory(n_planes) > MEMORY_LIMIT {
        let fewer = smooth(n_planes * 4 / 5);
        if fewer >= n_planes {
            break;
        }
        n_planes = fewer;
    }
    Some(Made {
        n_points: [n_planes, n_across[0], n_across[1]],
        spacing: [along, spacing[0], spacing[1]],
        lowest,
        memory: memory(n_planes),
        repeats_after: (n_planes < whole).then(|| n_planes as f64 * along / wind.speed),
    })
}

/// The turbulence on `grid`; `progress` receives the share done, and a break ends it.
fn made(
    site: &Site,
    grid: &Made,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<TurbulenceBox, InflowError> {
    let (case, wind) = (site.case, &site.case.wind);
    let Made { n_points, spacing, lowest, .. } = *grid;
    let standard_deviation = wind.turbulence_intensity * wind.speed;
    let (seed, threads) = (wind.seed, case.flow.threads);
    match wind.turbulence_model {
        TurbulenceModel::Kaimal => kaimal::generate_until(
            &kaimal::KaimalSettings {
                n_points,
                spacing,
                hub_speed: wind.speed,
                hub_height: site.plan.hub_height,
                lowest_height: lowest,
                standard_deviation,
                scaling: Scaling::None,
                seed,
                threads,
            },
            progress,
        ),
        TurbulenceModel::Mann => mann::generate_until(
            &mann::MannSettings {
                n_points,
                spacing,
                length_scale: length_scale(wind, site.plan.hub_height),
                anisotropy: wind.anisotropy,
                standard_deviation,
                seed,
                threads,
            },
            progress,
        ),
    }
}

/// The wind of `planes`, checked to cover all rotors for the whole run.
fn over_rotors(site: &Site, planes: Box<dyn Planes>) -> Result<PrescribedWind, InflowError> {
    let [low, high] = around_rotors(site);
    let grid = planes.grid();
    let reach = reach_along(site);
    let extent = [low.x - reach, high.x + reach + reach_of_wakes(site)];
    let placement = Placement { origin_x: grid.origin_x(), shift_y: 0.0, extent };
    let wind = PrescribedWind::over_planes(planes, placement)?;
    wind.covers(low, high, site.case.time.duration)?;
    Ok(wind)
}

/// Places upstream and downstream of the outermost towers at which turbines may sample the wind (m): a rotor
/// that is turned reaches farther, however far it is turned.
fn reach_along(site: &Site) -> f64 {
    let Case { turbines, runs, .. } = site.case;
    let mut controls = runs.iter().flat_map(|run| &run.control);
    let turns = turbines.iter().any(|turbine| turbine.yaw != 0.0)
        || controls.any(|control| control.kind().turns_nacelle());
    let radii = site.models.iter().map(|model| model.definition.rotor_radius());
    if turns { REACH + radii.fold(0.0, f64::max) } else { REACH }
}

/// How far downstream of the outermost rotor wakes ask for the wind (m).
fn reach_of_wakes(site: &Site) -> f64 {
    (site.case.flow.solver.reach)(site.case, site.plan)
}

/// Corners of the box around all rotors (m).
fn around_rotors(site: &Site) -> [Vector3; 2] {
    let reach = |sign: f64| {
        move |(model, foot): (&TurbineModel, &Vector3)| {
            let definition = &model.definition;
            let radius = definition.rotor_radius();
            let hub = *foot + Vector3::Z * definition.rotor.hub_height;
            hub + Vector3::new(0.0, radius, radius) * sign
        }
    };
    let rotors = || site.models.iter().zip(&site.plan.positions);
    let low = rotors().map(reach(-1.0)).reduce(Vector3::min).unwrap_or_default();
    let high = rotors().map(reach(1.0)).reduce(Vector3::max).unwrap_or_default();
    [low, high]
}

/// The least even product of 2, 3 and 5 that is not below `n`.
fn smooth(n: usize) -> usize {
    let only_small_factors = |mut n: usize| {
        for factor in [2, 3, 5] {
            while n.is_multiple_of(factor) {
                n /= factor;
            }
        }
        n == 1
    };
    (n.max(2)..).find(|&n| n.is_multiple_of(2) && only_small_factors(n)).unwrap_or(n)
}
