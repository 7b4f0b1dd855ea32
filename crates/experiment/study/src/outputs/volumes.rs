//! Volumes of the wind at instants of the analysed time: `volumes/velocity-0000.vti`.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::slices::POINT_BYTES;
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use farm::case::Run;
use formats::records::write_volume;

/// Every so many cells along each axis are kept.
const STRIDE: usize = 2;
/// Bytes of a file beside its points.
const HEADER_BYTES: u64 = 1 << 10;

pub(super) static KIND: OutputKind = OutputKind {
    name: "volumes",
    keys: Keys::OfOutput(&["volume_interval"]),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

fn schedule(setup: &Prepared) -> Option<Schedule> {
    setup.case.output.volume_interval.map(|interval| Schedule::analysed(&setup.plan, interval))
}

fn disk(setup: &Prepared, _run: &Run, _: &Values) -> u64 {
    let n_times = schedule(setup).map_or(0, |schedule| schedule.count(setup.plan.n_steps));
    let n_points: usize = setup.plan.n_cells.iter().map(|n| n.div_ceil(STRIDE)).product();
    n_times * (n_points as u64 * POINT_BYTES + HEADER_BYTES)
}

struct Volumes {
    schedule: Schedule,
    /// Volumes kept so far (–).
    n_kept: u64,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Some(schedule) = schedule(scene.setup) else { return Ok(None) };
    let n_kept = stored.map_or(Ok(0), Stored::state)?;
    Ok(Some(Box::new(Volumes { schedule, n_kept })))
}

impl Output for Volumes {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(fields) = scene.farm.flow().fields() {
            write_volume(scene.folder, self.n_kept, &fields.volume(STRIDE))?;
            self.n_kept += 1;
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.n_kept)
    }
}
