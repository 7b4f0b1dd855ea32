//! How often blades stand in the cores of other turbines' vortices: no file, but a warning where it is often.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::error::StudyError;
use basis::records::{Warning, WarningKind};

/// Steps from one count to the next (–): a rotor has turned by a good part of the angle between its blades.
const STRIDE: u64 = 8;
/// Share of elements and instants beyond which a reader must know (–).
const SHARE_TO_WARN: f64 = 0.01;
/// Bytes of its counts in two checkpoints, of each turbine.
const COUNT_BYTES: u64 = 2 * 32;

pub(super) static KIND: OutputKind = OutputKind {
    name: "cores",
    keys: Keys::OfOutput(&[]),
    fed_by: FedBy::ResolvedFlow,
    disk: |setup, run, _| match setup.case.flow.solver.most_filaments {
        Some(_) => run.present().count() as u64 * COUNT_BYTES,
        None => 0,
    },
    begin,
};

/// Elements in cores and all elements (–), added up over instants, of each turbine of the run.
struct Counts {
    schedule: Schedule,
    of_turbines: Vec<[u64; 2]>,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let n_turbines = scene.run.present().count();
    if scene.setup.case.flow.solver.most_filaments.is_none() || n_turbines < 2 {
        return Ok(None);
    }
    let nothing = || Ok(vec![[0; 2]; n_turbines]);
    let of_turbines = stored.map_or_else(nothing, Stored::state)?;
    let schedule = Schedule::analysed_steps(&scene.setup.plan, STRIDE);
    Ok(Some(Box::new(Counts { schedule, of_turbines })))
}

impl Output for Counts {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        for (machine, counts) in self.of_turbines.iter_mut().enumerate() {
            let now = scene.farm.flow().elements_in_cores(machine);
            counts.iter_mut().zip(now).for_each(|(count, now)| *count += now);
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        section.keep(&self.of_turbines)
    }

    fn warnings(&self, scene: &Scene) -> Vec<Warning> {
        let found = scene.run.present().zip(&self.of_turbines);
        let beyond = found.filter_map(|(index, &[in_cores, all])| {
            let share = in_cores as f64 / all.max(1) as f64;
            let name = &scene.setup.case.turbines[index].name;
            (share > SHARE_TO_WARN).then(|| warning(&scene.run.name, name, share))
        });
        beyond.collect()
    }
}

fn warning(run: &str, turbine: &str, share: f64) -> Warning {
    let message = format!(
        "{run}: {:.1} % of the blade elements of {turbine} stood in cores of other turbines' vortices, where the core decides what they feel: its loads within a turn follow flow.core_widths and flow.core_growth as much as the wake; \
         raise flow.far_wake_filaments or lower flow.far_wake_steps, so that each vortex is weaker, or move {turbine} aside",
        100.0 * share
    );
    Warning { kind: WarningKind::VortexCores, turbine: Some(turbine.to_owned()), message }
}
