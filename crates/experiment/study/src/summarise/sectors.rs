//! The wind of a part of a record on the quarters of a rotor.

use crate::StudyError;
use crate::air;
use crate::prepared::Prepared;
use basis::records::Sector;
use farm::solvers::WindSource;
use flow::inflow::{Disc, PlaneMeans};

/// The wind that comes to the rotor of turbine number `index` of `setup`, over the whole block of which its
/// wind is cut; none where it is cut of nothing.
///
/// # Errors
/// [`StudyError`] where the record cannot be read any more.
pub(super) fn of(setup: &Prepared, index: usize) -> Result<Vec<Sector>, StudyError> {
    let case = &setup.case;
    if case.wind.cut.is_none() || case.wind_source() != WindSource::Planes {
        return Ok(Vec::new());
    }
    let (foot, machine) = (setup.plan.positions[index], &setup.models[index].definition);
    let disc =
        Disc { y: foot.y, z: foot.z + machine.rotor.hub_height, radius: machine.rotor_radius() };
    let means = PlaneMeans::of(air::planes(setup)?.as_mut(), case.wind.speed)?;
    Ok(means.sectors(disc)?.to_vec())
}
