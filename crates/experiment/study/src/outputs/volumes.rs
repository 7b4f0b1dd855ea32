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

/// Bytes of a file beside its points.
const HEADER_BYTES: u64 = 1 << 10;
/// Bytes of the pressure at a point, which the lattice gives beside velocity; it is not written.
const PRESSURE_BYTES: u64 = size_of::<f32>() as u64;

pub(super) static KIND: OutputKind = OutputKind {
    name: "volumes",
    keys: Keys::OfOutput(&["volume_interval", "volume_stride"]),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

fn schedule(setup: &Prepared) -> Option<Schedule> {
    setup.case.output.volume_interval.map(|interval| Schedule::analysed(&setup.plan, interval))
}

fn n_points(setup: &Prepared) -> u64 {
    let stride = setup.case.output.volume_stride;
    setup.plan.n_points.map(|n| n.div_ceil(stride) as u64).iter().product()
}

/// Memory (bytes) that a run of `setup` takes while it writes a volume; none where it writes none.
pub(crate) fn memory(setup: &Prepared) -> u64 {
    let is_kept = KIND.fed_by.admits(&setup.case) && setup.case.output.volume_interval.is_some();
    if is_kept { n_points(setup) * (POINT_BYTES + PRESSURE_BYTES) } else { 0 }
}

fn disk(setup: &Prepared, _run: &Run, _: &Values) -> u64 {
    let n_times = schedule(setup).map_or(0, |schedule| schedule.count(setup.plan.n_steps));
    // Velocity and vorticity.
    n_times * (2 * n_points(setup) * POINT_BYTES + HEADER_BYTES)
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
            let stride = scene.setup.case.output.volume_stride;
            write_volume(scene.folder, self.n_kept, &fields.volume(stride))?;
            self.n_kept += 1;
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.n_kept)
    }
}
