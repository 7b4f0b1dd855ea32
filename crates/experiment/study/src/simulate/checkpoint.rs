//! The checkpoint of a run: everything that time changes, a section for each part.

use crate::StudyError;
use crate::outputs::Writers;
use farm::{Air, Farm};
use formats::checkpoint::{CheckpointReader, CheckpointWriter};
use serde::{Deserialize, Serialize};

/// Sections, besides those of the outputs.
const RUN: &str = "run";
const INSTRUMENTS: &str = "instruments";
const AIR: &str = "air";
/// Checkpoints of earlier programs have none.
const PEAK_MEMORY: &str = "peak memory";

/// What the processes before this one have made of a run, and what that cost.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Before {
    /// Steps made (–).
    pub(super) step: u64,
    /// Wall time (s).
    pub(super) wall_time: f64,
    /// Most memory that a process has held at once (bytes); none where the system does not report it.
    pub(super) peak_memory: Option<u64>,
}

/// The clocks, turbines and controllers.
#[derive(Serialize, Deserialize)]
struct RunState {
    step: u64,
    wall_time: f64,
    turbines: Vec<turbine::TurbineState>,
    controllers: Vec<Vec<u8>>,
}

/// Whether anything that a turbine senses with has a state to be kept.
fn has_instruments(farm: &Farm<Air>) -> bool {
    farm.machines().iter().any(|machine| machine.sensing.has_state())
}

/// Writes `farm` as it stands and the state of its `outputs`; `made` holds what all processes have
/// made so far and what that cost.
///
/// # Errors
/// [`StudyError`] when a file cannot be written.
pub(super) fn write(
    mut writer: CheckpointWriter,
    farm: &mut Farm<Air>,
    outputs: &mut Writers,
    made: Before,
) -> Result<(), StudyError> {
    outputs.checkpoint(&mut writer)?;
    let state = RunState {
        step: made.step,
        wall_time: made.wall_time,
        turbines: farm.machines().iter().map(|m| m.turbine.state().clone()).collect(),
        controllers: farm.machines().iter().map(|m| m.controller.save()).collect(),
    };
    writer.state(RUN, &state)?;
    writer.state(PEAK_MEMORY, &made.peak_memory)?;
    if has_instruments(farm) {
        let sensing: Vec<sensing::SensingState> =
            farm.machines().iter().map(|machine| machine.sensing.state()).collect();
        writer.state(INSTRUMENTS, &sensing)?;
    }
    writer.stream(AIR, |bytes| farm.flow_mut().write_state(bytes))?;
    Ok(writer.finish()?)
}

/// On return `farm` stands where the checkpoint of `reader` was written; gives it with what the
/// processes before have cost.
///
/// # Errors
/// [`StudyError::File`] when the checkpoint does not fit.
pub(super) fn read(
    reader: &mut CheckpointReader,
    farm: Farm<Air>,
) -> Result<(Farm<Air>, Before), StudyError> {
    let state: RunState = reader.state(RUN)?;
    let mut farm = farm.at_step(state.step);
    let n_machines = farm.machines().len();
    for n_stored in [state.turbines.len(), state.controllers.len()] {
        fits(reader, RUN, n_stored, n_machines)?;
    }
    let states = state.turbines.into_iter().zip(state.controllers);
    for (machine, (turbine, controller)) in farm.machines_mut().iter_mut().zip(states) {
        machine.turbine.restore(turbine);
        machine.controller.restore(&controller)?;
    }
    if has_instruments(&farm) {
        let stored: Vec<sensing::SensingState> = reader.state(INSTRUMENTS)?;
        fits(reader, INSTRUMENTS, stored.len(), n_machines)?;
        for (machine, stored) in farm.machines_mut().iter_mut().zip(stored) {
            machine.sensing.restore(stored)?;
        }
    }
    reader.stream(AIR, |bytes| farm.flow_mut().read_state(bytes))?;
    let peak_memory = if reader.holds(PEAK_MEMORY) { reader.state(PEAK_MEMORY)? } else { None };
    Ok((farm, Before { step: state.step, wall_time: state.wall_time, peak_memory }))
}

/// Nothing where a `section` has as many states as there are turbines.
fn fits(
    reader: &CheckpointReader,
    section: &str,
    n_stored: usize,
    n_turbines: usize,
) -> Result<(), StudyError> {
    if n_stored == n_turbines {
        return Ok(());
    }
    let reason = format!("{n_stored} states for {n_turbines} turbines");
    Err(reader.unfitting(section, reason).into())
}
