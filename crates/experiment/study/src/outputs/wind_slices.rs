//! Slices of the wind across it, behind a turbine or before it: each a full field of which
//! [cuts](flow::inflow::CutPlanes) are the wind of other cases.
//!
//! A case asks for them by a name, `output.further.NAME = { kind = "wind-slices", … }`, as often as it likes.

mod keys;

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::wind_record::{POINT_BYTES, POINT_MEMORY, Recorded, WindRecord};
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

struct WindSlices {
    schedule: Schedule,
    records: Vec<WindRecord>,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, folder, name, values, .. } = *scene;
    let Some(slices) = of(setup, values) else { return Ok(None) };
    // So many bytes of each are sure.
    let n_bytes: Option<Vec<u64>> = stored.map(Stored::state).transpose()?;
    let turbine = &setup.case.turbines[slices.turbine].name;
    let record = |(place, &distance): (usize, &f64)| {
        let n_bytes = n_bytes.as_ref().and_then(|n_bytes| n_bytes.get(place)).copied();
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
        WindRecord::begin(&folder.slice_path(name, &slice), recorded, n_bytes)
    };
    let records = slices.distances().iter().enumerate().map(record).collect::<Result<_, _>>()?;
    Ok(Some(Box::new(WindSlices { schedule: slices.schedule(), records })))
}

impl Output for WindSlices {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        self.records.iter_mut().try_for_each(|record| record.write(scene.farm.flow()))
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let flushed = self.records.iter_mut().map(WindRecord::flush);
        let n_bytes: Vec<u64> = flushed.collect::<Result<_, _>>()?;
        section.keep(&n_bytes)
    }

    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        self.records.iter_mut().try_for_each(WindRecord::finish)
    }
}

#[cfg(test)]
mod tests;
