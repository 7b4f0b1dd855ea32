//! The plane at hub height averaged by the phase of the first helix: `planes/hub-height-phases.nc`.

use super::mean_planes::averaging_interval;
use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::slices::{self, POINT_BYTES, SUM_BYTES, Slice};
use crate::error::StudyError;
use crate::prepared::Prepared;
use analysis::wake::PhaseAverage;
use basis::keys::Values;
use control::excitation_rate;
use farm::case::Run;
use formats::records::{AtPhase, write_phase_planes};

pub(super) static KIND: OutputKind = OutputKind {
    name: "phase planes",
    keys: Keys::OfOutput(&["helix_phases"]),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

/// Phases, and the rate of the helix (rad/s), where the case asks for them and `run` has a helix.
fn requested(setup: &Prepared, run: &Run) -> Option<(usize, f64)> {
    let n_phases = setup.case.output.helix_phases?;
    let (_, strouhal) = setup.case.first_helix(run)?;
    let rate = excitation_rate(strouhal, setup.case.wind.speed, setup.plan.diameter);
    Some((n_phases, rate))
}

fn disk(setup: &Prepared, run: &Run, _: &Values) -> u64 {
    let Some((n_phases, _)) = requested(setup, run) else { return 0 };
    let of_phase = slices::n_points_at_hub_height(setup) * (POINT_BYTES + SUM_BYTES);
    n_phases as u64 * of_phase + slices::bytes_beside(setup)
}

struct PhasePlanes {
    schedule: Schedule,
    slice: Slice,
    average: PhaseAverage,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let requested = requested(scene.setup, scene.run).zip(scene.farm.flow().fields());
    let Some(((n_phases, rate), fields)) = requested else { return Ok(None) };
    let slice = slices::hub_height(scene.setup);
    let average = match stored {
        Some(stored) => stored.state()?,
        None => PhaseAverage::new(&slice.plane(fields), rate, n_phases),
    };
    let schedule = Schedule::analysed(&scene.setup.plan, averaging_interval(&scene.setup.plan));
    Ok(Some(Box::new(PhasePlanes { schedule, slice, average })))
}

impl Output for PhasePlanes {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(fields) = scene.farm.flow().fields() {
            self.average.add(&self.slice.plane(fields))?;
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.average)
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let planes = self.average.planes();
        let phases: Vec<AtPhase> = planes
            .iter()
            .map(|one| AtPhase { phase: one.phase, n_instants: one.n_instants, plane: &one.plane })
            .collect();
        let setting = slices::setting(scene.setup, scene.run);
        Ok(write_phase_planes(scene.folder, &setting, &phases)?)
    }
}
