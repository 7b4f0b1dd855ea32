//! The wind of a part of a record on a rotor.

use crate::StudyError;
use crate::air;
use crate::prepared::Prepared;
use basis::records::Sector;
use farm::solvers::WindSource;
use flow::inflow::{Disc, PlaneGrid, PlaneMeans};
use std::ops::Range;

/// What comes to a rotor.
pub(super) struct RotorWind {
    /// Wind on its quarters.
    pub(super) sectors: Vec<Sector>,
    /// Where the mean wind over it blows to, counter-clockwise from the axis of the planes (rad).
    direction: f64,
}

impl RotorWind {
    /// Turn of a nacelle from facing it (deg) that is turned from that axis by `yaw` (rad).
    pub(super) fn misalignment_deg(&self, yaw: f64) -> f64 {
        (yaw - self.direction).to_degrees()
    }
}

/// The wind that comes to the rotor of turbine number `index` of `setup` while it is analysed; none where it
/// is cut of nothing.
///
/// # Errors
/// [`StudyError`] where the record cannot be read any more.
pub(super) fn of(setup: &Prepared, index: usize) -> Result<Option<RotorWind>, StudyError> {
    let case = &setup.case;
    if case.wind.cut.is_none() || case.wind_source() != WindSource::Planes {
        return Ok(None);
    }
    let (foot, machine) = (setup.plan.positions[index], &setup.models[index].definition);
    let disc =
        Disc { y: foot.y, z: foot.z + machine.rotor.hub_height, radius: machine.rotor_radius() };
    let mut planes = air::planes(setup)?;
    let steps = passing(&planes.grid(), foot.x, [case.time.spin_up, case.time.duration]);
    let means = PlaneMeans::of_steps(planes.as_mut(), case.wind.speed, steps)?;
    Ok(Some(RotorWind {
        sectors: means.sectors(disc)?.to_vec(),
        direction: means.direction(disc)?,
    }))
}

/// The planes of a record on `grid` that pass a rotor at `x` (m) between these times (s).
fn passing(grid: &PlaneGrid, x: f64, [from, to]: [f64; 2]) -> Range<usize> {
    let before = (grid.origin_x() - x) / grid.speed;
    let [first, last] = [from, to].map(|time| (time + before) / grid.interval);
    first.ceil() as usize..last.floor() as usize + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_pass_a_rotor_as_late_as_they_stand_upwind() {
        let grid = PlaneGrid {
            n_y: 35,
            n_z: 10,
            spacing: [10.0; 2],
            first: [-170.0, 10.0],
            interval: 2.0,
            speed: 8.5,
            n_steps: 400,
            repeats: false,
        };
        // Half of 340 m upwind are 20 s: planes 25 to 325 at the first turbine, 10 s fewer 85 m on.
        assert_eq!(passing(&grid, 0.0, [30.0, 630.0]), 25..326);
        assert_eq!(passing(&grid, 85.0, [30.0, 630.0]), 20..321);
        assert_eq!(passing(&PlaneGrid { repeats: true, ..grid }, 0.0, [30.0, 630.0]), 15..316);
    }
}
