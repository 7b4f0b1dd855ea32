//! Planes of the wind at instants of the analysed time: `planes/NAME-0000.nc`.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::slices::{self, Slice};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use farm::case::Run;
use formats::records::write_instant_plane;

pub(super) static KIND: OutputKind = OutputKind {
    name: "instantaneous planes",
    keys: Keys::OfOutput(&["plane_interval"]),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

fn schedule(setup: &Prepared) -> Option<Schedule> {
    setup.case.output.plane_interval.map(|interval| Schedule::analysed(&setup.plan, interval))
}

fn disk(setup: &Prepared, _run: &Run, _: &Values) -> u64 {
    let n_times = schedule(setup).map_or(0, |schedule| schedule.count(setup.plan.n_steps));
    n_times * slices::file_bytes(setup)
}

struct InstantPlanes {
    schedule: Schedule,
    slices: Vec<Slice>,
    /// Instants kept so far (–).
    n_kept: u64,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Some(schedule) = schedule(scene.setup) else { return Ok(None) };
    let n_kept = stored.map_or(Ok(0), Stored::state)?;
    Ok(Some(Box::new(InstantPlanes { schedule, slices: slices::of(scene.setup), n_kept })))
}

impl Output for InstantPlanes {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(fields) = scene.farm.flow().fields() {
            for slice in &self.slices {
                write_instant_plane(scene.folder, self.n_kept, &slice.plane(fields))?;
            }
            self.n_kept += 1;
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.n_kept)
    }
}
