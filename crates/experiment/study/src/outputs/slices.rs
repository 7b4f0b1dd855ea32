//! The planes of resolved flow that a run keeps: averaged, now and then, and last of all.

use crate::prepared::Prepared;
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};
use farm::case::Run;
use flow::fields::FieldSource;
use formats::records::{PlacedTurbine, PlaneSetting};

/// Bytes of a point in a file: three components.
pub(super) const POINT_BYTES: u64 = 3 * size_of::<f32>() as u64;
/// Bytes of a plane's file beside its points and turbines: header and coordinates.
const FILE_BYTES: u64 = 8 << 10;
/// Bytes of a turbine in a plane's file, at most: name, place and diameter.
const TURBINE_BYTES: u64 = 128;
/// Bytes of a point of a sum, three components, in a checkpoint and the one before it.
pub(super) const SUM_BYTES: u64 = 2 * 3 * size_of::<f64>() as u64;

/// Where a plane lies.
pub(crate) struct Slice {
    /// Its name.
    pub(super) name: String,
    /// What spans it.
    pub(super) axes: PlaneAxes,
    /// Its position along the third axis (m).
    pub(super) position: f64,
}

impl Slice {
    /// The wind on it now.
    pub(crate) fn plane(&self, fields: &dyn FieldSource) -> Plane {
        fields.plane(&self.name, self.axes, self.position)
    }
}

/// The plane at hub height.
pub(super) fn hub_height(setup: &Prepared) -> Slice {
    let position = setup.plan.hub_height;
    Slice { name: "hub-height".to_owned(), axes: PlaneAxes::Horizontal, position }
}

/// Planes along the wind at most (–).
const MOST_ALONG: usize = 4;
/// Turbines whose hubs are nearer to a plane along the wind than this lie on it (rotor diameters).
const ON_PLANE: f64 = 0.05;

/// Planes along the wind: through the first turbine, and, in a staggered row, through those that stand beside
/// it, as many as are kept, with the names of those that they go through.
fn along(setup: &Prepared) -> Vec<Slice> {
    let plan = &setup.plan;
    let mut slices: Vec<Slice> = Vec::new();
    for (turbine, foot) in setup.case.turbines.iter().zip(&plan.positions) {
        let near = |slice: &Slice| (slice.position - foot.y).abs() < ON_PLANE * plan.diameter;
        if slices.len() == MOST_ALONG || slices.iter().any(near) {
            continue;
        }
        let name = match slices.is_empty() {
            true => "streamwise".to_owned(),
            false => format!("streamwise-{}", turbine.name),
        };
        slices.push(Slice { name, axes: PlaneAxes::Streamwise, position: foot.y });
    }
    slices
}

/// All planes that are kept: at hub height, along the wind through the turbines, and across it where the case
/// says.
pub(crate) fn of(setup: &Prepared) -> Vec<Slice> {
    let plan = &setup.plan;
    let foot = plan.positions[0];
    let across = setup.case.output.crosswind_diameters.iter().map(|distance| Slice {
        name: format!("{distance}D"),
        axes: PlaneAxes::Crosswind,
        position: foot.x + distance * plan.diameter,
    });
    std::iter::once(hub_height(setup)).chain(along(setup)).chain(across).collect()
}

/// Planes (–).
pub(super) fn count(setup: &Prepared) -> u64 {
    (1 + along(setup).len() + setup.case.output.crosswind_diameters.len()) as u64
}

/// Bytes of a plane's file beside its points.
pub(super) fn bytes_beside(setup: &Prepared) -> u64 {
    FILE_BYTES + setup.case.turbines.len() as u64 * TURBINE_BYTES
}

/// Bytes of a file of each plane.
pub(super) fn file_bytes(setup: &Prepared) -> u64 {
    n_points(setup) * POINT_BYTES + count(setup) * bytes_beside(setup)
}

/// What the planes of `run` are taken of.
pub(super) fn setting(setup: &Prepared, run: &Run) -> PlaneSetting {
    let (case, plan) = (&setup.case, &setup.plan);
    let turbine = |(index, foot): (usize, &Vector3)| {
        let definition = &setup.models[index].definition;
        PlacedTurbine {
            name: case.turbines[index].name.clone(),
            hub: (*foot + Vector3::Z * definition.rotor.hub_height).to_array(),
            rotor_diameter: definition.rotor_diameter(),
            is_there: run.control[index].is_there(),
        }
    };
    PlaneSetting {
        case: case.name.clone(),
        run: run.name.clone(),
        wind_speed: case.wind.speed,
        wind_direction_deg: case.wind.direction_deg(),
        turbulence_intensity: case.wind.turbulence_intensity,
        air_density: case.wind.air_density,
        turbines: plan.positions.iter().enumerate().map(turbine).collect(),
    }
}

/// Points of the plane at hub height (–).
pub(super) fn n_points_at_hub_height(setup: &Prepared) -> u64 {
    let [n_x, n_y, _] = setup.plan.n_points.map(|n| n as u64);
    n_x * n_y
}

/// Points of all planes together (–).
pub(super) fn n_points(setup: &Prepared) -> u64 {
    let [n_x, n_y, n_z] = setup.plan.n_points.map(|n| n as u64);
    let n_across = setup.case.output.crosswind_diameters.len() as u64;
    n_x * n_y + along(setup).len() as u64 * n_x * n_z + n_across * n_y * n_z
}
