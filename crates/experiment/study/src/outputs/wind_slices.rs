//! Slices of the wind across it, behind a turbine or before it: each a full field of which
//! [cuts](flow::inflow::CutPlanes) are the wind of other cases.
//!
//! A case asks for them by a name, `output.further.NAME = { kind = "wind-slices", … }`, as often as it likes.

mod keys;

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::section::Stored;
use super::wind_record::{POINT_BYTES, POINT_MEMORY, Recorded, WindRecords};
use crate::error::StudyError;
use crate::prepared::Prepared;
use crate::slice_layout::{KIND_NAME, Laid, Slices};
use basis::keys::Values;
use farm::case::Run;
use keys::OWN;

pub(super) static KIND: OutputKind = OutputKind {
    name: KIND_NAME,
    keys: Keys::Own(&OWN),
    // Prescribed wind is alike behind a turbine and before it.
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

/// What `values` ask for in the runs of `setup`; none where they name no turbine of it.
fn of<'a>(setup: &'a Prepared, values: &'a Values) -> Option<Slices<'a>> {
    let Prepared { case, plan, models, .. } = setup;
    Slices::of(Laid { case, plan, models }, values)
}

/// Memory (bytes) that the slices of a run of `setup` take.
pub(crate) fn memory(setup: &Prepared) -> u64 {
    let further = setup.case.output.further.iter().filter(|one| one.kind.name() == KIND_NAME);
    let slices = further.filter_map(|one| of(setup, &one.values));
    slices.map(|slices| slices.n_points() * POINT_MEMORY).sum()
}

fn disk(setup: &Prepared, _: &Run, values: &Values) -> u64 {
    let Some(slices) = of(setup, values) else { return 0 };
    slices.schedule().count(setup.plan.n_steps) * slices.n_points() * POINT_BYTES
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, folder, name, values, .. } = *scene;
    let Some(slices) = of(setup, values) else { return Ok(None) };
    let turbine = &setup.case.turbines[slices.turbine].name;
    let wanted = slices.distances().iter().map(|&distance| {
        let slice = format!("{distance}D");
        let recorded = Recorded {
            grid: slices.grid(),
            foot: slices.foot(distance),
            hub_height: slices.hub_height(),
            description: format!(
                "wakemix: {}, run {}, {slice} behind {turbine}",
                setup.case.name, run.name
            ),
        };
        (folder.slice_path(name, &slice), recorded)
    });
    WindRecords::begin(slices.schedule(), wanted, stored)
}

#[cfg(test)]
mod tests;
