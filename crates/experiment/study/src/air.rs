//! The air that a run starts with.

use crate::StudyError;
use crate::prepare::Setup;
use basis::Vector3;
use farm::Air;
use farm::assemble::lattice_settings;
use farm::case::{Solver, TurbulenceModel};
use flow::inflow::kaimal::{self, Scaling};
use flow::inflow::planes::BoxPlanes;
use flow::inflow::prescribed::Placement;
use flow::inflow::{Planes, PrescribedWind, TurbulenceBox, mann};
use flow::lattice::Lattice;
use std::sync::Arc;

/// Air around the outermost tips that a grid of made turbulence covers (diameters of the largest rotor).
const MARGIN: f64 = 0.1;
/// Points of made turbulence across the largest rotor (–).
const POINTS_ACROSS: f64 = 24.0;
/// Time between planes of made turbulence (s).
const PLANE_INTERVAL: f64 = 0.1;
/// Places upstream and downstream of the outermost towers at which turbines may ask for the wind (m).
const REACH: f64 = 50.0;

/// The air of `setup` at time zero.
///
/// # Errors
/// [`StudyError`] when a lattice cannot be set up, turbulence cannot be made, or a file of wind cannot be read or does not
/// cover the rotors.
pub(crate) fn begin(setup: &Setup) -> Result<Air, StudyError> {
    let (case, plan) = (&setup.case, &setup.plan);
    let wind = match case.flow.solver {
        Solver::Lattice => {
            let lattice = Lattice::new(lattice_settings(case, plan), setup.inflow.clone())?;
            return Ok(Air::Lattice(Box::new(lattice)));
        }
        Solver::Uniform => PrescribedWind::everywhere(setup.inflow.clone()),
        Solver::Turbulence if case.wind.turbulence_intensity == 0.0 => {
            PrescribedWind::everywhere(setup.inflow.clone())
        }
        Solver::Turbulence => {
            let (turbulence, lowest) = made(setup)?;
            let planes = BoxPlanes::new(Arc::new(turbulence), &setup.profile(), lowest)?
                .veering(case.wind.veer, plan.hub_height);
            prescribed(setup, Box::new(planes))?
        }
        Solver::Planes => {
            let name = case.wind.planes.as_deref().unwrap_or_default();
            let planes = formats::turbulence_box::open(&setup.folder().join(name))?;
            prescribed(setup, planes)?
        }
    };
    Ok(Air::Prescribed(Box::new(wind)))
}

/// Turbulence around all rotors for the whole run, and the height of its lowest row (m).
fn made(setup: &Setup) -> Result<(TurbulenceBox, f64), StudyError> {
    let (case, plan) = (&setup.case, &setup.plan);
    let wind = &case.wind;
    let [low, high] = around_rotors(setup);
    let diameter = setup.models.iter().map(|m| m.definition.rotor_diameter()).fold(0.0, f64::max);
    let across = diameter / POINTS_ACROSS;
    // The middle of the width stands at y = 0.
    let half_width = low.y.abs().max(high.y.abs()) + MARGIN * diameter;
    let lowest = (low.z - MARGIN * diameter).max(0.5 * across);
    let height = high.z + MARGIN * diameter - lowest;
    let points = |length: f64| (length / across).ceil() as usize + 1;
    let along = wind.speed * PLANE_INTERVAL;
    let length = (high.x - low.x) + 2.0 * REACH;
    // Whole records only: 2, 3 and 5 are the only factors, which transforms like best.
    let n_planes = smooth((case.time.duration / PLANE_INTERVAL + length / along).ceil() as usize);
    let n_points = [n_planes, points(2.0 * half_width), points(height)];
    let spacing = [along, across, across];
    let standard_deviation = wind.turbulence_intensity * wind.speed;
    let threads = case.flow.threads;
    let turbulence = match wind.turbulence_model {
        TurbulenceModel::Kaimal => kaimal::generate(
            &kaimal::Settings {
                n_points,
                spacing,
                hub_speed: wind.speed,
                hub_height: plan.hub_height,
                lowest_height: lowest,
                standard_deviation,
                scaling: Scaling::None,
                seed: wind.seed,
                threads,
            },
            |_| (),
        )?,
        TurbulenceModel::Mann => {
            // Cells of one shape along and across, and twice the width, whose periodic image would be felt otherwise.
            let stride = (across / along).floor().max(1.0) as usize;
            let n_points = [
                smooth(n_planes.div_ceil(stride)),
                smooth(2 * n_points[1]),
                smooth(2 * n_points[2]),
            ];
            mann::generate(
                &mann::Settings {
                    n_points,
                    spacing: [along * stride as f64, across, across],
                    length_scale: wind.length_scale,
                    anisotropy: wind.anisotropy,
                    standard_deviation,
                    seed: wind.seed,
                    threads,
                },
                |_| (),
            )?
        }
    };
    Ok((turbulence, lowest))
}

/// The wind of `planes`, checked to cover all rotors for the whole run.
fn prescribed(setup: &Setup, planes: Box<dyn Planes>) -> Result<PrescribedWind, StudyError> {
    let [low, high] = around_rotors(setup);
    let grid = planes.grid();
    // As OpenFAST has it: a record that does not repeat starts half its width upwind of the first turbine.
    let [left, right] = grid.across();
    let origin_x = if grid.repeats { 0.0 } else { 0.5 * (right - left) };
    let extent = [low.x - REACH, high.x + REACH];
    let placement = Placement { origin_x, shift_y: 0.0, extent };
    let wind = PrescribedWind::over_planes(planes, placement)?;
    wind.covers(low, high, setup.case.time.duration)?;
    Ok(wind)
}

/// Corners of the box around all rotors (m).
fn around_rotors(setup: &Setup) -> [Vector3; 2] {
    let reach = |sign: f64| {
        move |(model, foot): (&farm::assemble::Model, &Vector3)| {
            let definition = &model.definition;
            let radius = definition.rotor_radius();
            let hub = *foot + Vector3::Z * definition.rotor.hub_height;
            hub + Vector3::new(0.0, radius, radius) * sign
        }
    };
    let rotors = || setup.models.iter().zip(&setup.plan.positions);
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
