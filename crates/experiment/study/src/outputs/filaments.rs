//! The vortices of wakes at instants of the analysed time, `volumes/filaments-0000.vtp`, and at the run's
//! last instant, which the report shows: `volumes/filaments-last.vtp`.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use farm::case::Run;
use formats::records::{filament_bytes, write_filaments};

/// Bytes of a file beside its nodes and pieces.
const HEADER_BYTES: u64 = 2 << 10;

pub(super) static KIND: OutputKind = OutputKind {
    name: "filaments",
    keys: Keys::OfOutput(&["filament_interval"]),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

fn schedule(setup: &Prepared) -> Schedule {
    let interval = setup.case.output.filament_interval;
    let at_the_end = Schedule::at_the_end();
    interval.map_or(at_the_end, |interval| Schedule::analysed(&setup.plan, interval))
}

fn disk(setup: &Prepared, _run: &Run, _: &Values) -> u64 {
    let Some(most) = setup.case.flow.solver.most_filaments else { return 0 };
    let n_pieces = most(&setup.case, &setup.plan);
    let [of_node, of_piece] = filament_bytes();
    // Never more nodes than pieces: each but a blade's last has one that leads on from it.
    let bytes = n_pieces * (of_node + of_piece) + HEADER_BYTES;
    bytes * (schedule(setup).count(setup.plan.n_steps) + 1)
}

struct Kept {
    schedule: Schedule,
    /// Instants kept so far (–).
    n_kept: u64,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    if scene.setup.case.flow.solver.most_filaments.is_none() {
        return Ok(None);
    }
    let n_kept = stored.map_or(Ok(0), Stored::state)?;
    Ok(Some(Box::new(Kept { schedule: schedule(scene.setup), n_kept })))
}

impl Output for Kept {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(filaments) = scene.farm.flow().filaments() {
            write_filaments(scene.folder, Some(self.n_kept), &filaments)?;
            self.n_kept += 1;
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.n_kept)
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(filaments) = scene.farm.flow().filaments() {
            write_filaments(scene.folder, None, &filaments)?;
        }
        Ok(())
    }
}
