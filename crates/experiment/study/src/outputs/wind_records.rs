//! The wind over the rotor of a turbine that is not there, as a full field that turbines elsewhere can stand
//! in.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::Stored;
use super::wind_record::{POINT_BYTES, Recorded, WindRecords};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use farm::case::Run;
use flow::inflow::PlaneGrid;

/// Air around the rotor that is kept (rotor diameters): tower tops sway, and rotors are displaced.
const MARGIN: f64 = 0.1;
/// Cells that the wind crosses between two planes, at most (–).
const CELLS_BETWEEN: f64 = 0.5;

pub(super) static KIND: OutputKind = OutputKind {
    name: "wind records",
    keys: Keys::OfOutput(&["inflow_at"]),
    // The grid is as fine as the cells.
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

/// Steps from one plane to the next (–).
fn stride(setup: &Prepared) -> u64 {
    let spacings = setup.case.output.inflow_at.iter().map(|&index| setup.plan.spacing_at(index));
    let spacing = spacings.fold(setup.plan.spacing, f64::min);
    let crossing = CELLS_BETWEEN * spacing / setup.case.wind.speed;
    (crossing / setup.plan.interval).floor().max(1.0) as u64
}

fn schedule(setup: &Prepared) -> Schedule {
    Schedule::analysed_steps(&setup.plan, stride(setup))
}

/// Places of the turbines that are not there in `run` and whose wind the case asks for.
fn places<'a>(setup: &'a Prepared, run: &'a Run) -> impl Iterator<Item = usize> + 'a {
    let requested = setup.case.output.inflow_at.iter().copied();
    requested.filter(|&index| !run.control[index].is_there())
}

/// Points of the planes at the place of turbine number `index`.
///
/// A grid as fine as the cells, with a point at the hub, as far down as half a cell above the ground.
fn grid(setup: &Prepared, index: usize) -> PlaneGrid {
    let (plan, rotor) = (&setup.plan, &setup.models[index].definition);
    let (spacing, hub_height) = (plan.spacing_at(index), rotor.rotor.hub_height);
    let reach = rotor.rotor_radius() + MARGIN * rotor.rotor_diameter();
    let n_aside = (reach / spacing).ceil();
    let n_down = n_aside.min((hub_height / spacing - 0.5).floor()).max(0.0);
    PlaneGrid {
        n_y: 2 * n_aside as usize + 1,
        n_z: (n_aside + n_down) as usize + 1,
        spacing: [spacing; 2],
        first: [-n_aside * spacing, hub_height - n_down * spacing],
        interval: stride(setup) as f64 * plan.interval,
        speed: setup.case.wind.speed,
        n_steps: 0,
        repeats: false,
    }
}

fn disk(setup: &Prepared, run: &Run, _: &Values) -> u64 {
    let grids = places(setup, run).map(|index| grid(setup, index));
    let n_points: usize = grids.map(|grid| grid.n_y * grid.n_z).sum();
    schedule(setup).count(setup.plan.n_steps) * n_points as u64 * POINT_BYTES
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, folder, .. } = *scene;
    if places(setup, run).next().is_none() {
        return Ok(None);
    }
    let wanted = places(setup, run).map(|index| {
        let name = &setup.case.turbines[index].name;
        let recorded = Recorded {
            grid: grid(setup, index),
            foot: setup.plan.positions[index],
            hub_height: setup.models[index].definition.rotor.hub_height,
            description: format!("wakemix: {}, run {}, at {name}", setup.case.name, run.name),
        };
        (folder.inflow_path(name), recorded)
    });
    WindRecords::begin(schedule(setup), wanted, stored)
}
