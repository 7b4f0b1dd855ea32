//! The wind along radial lines at the place of a turbine that is not there: the ground truth of a helix's
//! phase.

use crate::prepared::Prepared;
use analysis::phase::{Lines, lines_to_fixed_frame};
use basis::{FixedFrame, Vector3};
use farm::case::Run;
use flow::WindField;

/// Radial lines over the disc (–). van Vondelen et al. (2025), §3.3.1.
const N_LINES: usize = 36;
/// Points on each line (–).
const N_POINTS: usize = 24;

/// Lines at one place, with room to work in.
pub(super) struct WindLines {
    /// Name of the turbine that is not there.
    pub(super) name: String,
    lines: Lines,
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    means: Vec<f64>,
}

/// Places of the turbines that are not there in `run` and at which the case asks for lines.
fn places<'a>(setup: &'a Prepared, run: &'a Run) -> impl Iterator<Item = usize> + 'a {
    let requested = setup.case.output.lines_at.iter().copied();
    requested.filter(|&index| !run.control[index].is_there())
}

/// Places at which `run` has lines (–).
pub(super) fn count(setup: &Prepared, run: &Run) -> u64 {
    places(setup, run).count() as u64
}

/// The lines that the case asks for and `run` leaves room for.
pub(super) fn of(setup: &Prepared, run: &Run) -> Vec<WindLines> {
    places(setup, run)
        .map(|index| {
            let rotor = &setup.models[index].definition;
            let center =
                setup.plan.positions[index] + Vector3::new(0.0, 0.0, rotor.rotor.hub_height);
            let radius = rotor.rotor_radius();
            let lines = Lines { center, radius, n_lines: N_LINES, n_points: N_POINTS };
            let positions = lines.positions();
            WindLines {
                name: setup.case.turbines[index].name.clone(),
                velocities: vec![Vector3::ZERO; positions.len()],
                means: vec![0.0; N_LINES],
                lines,
                positions,
            }
        })
        .collect()
}

impl WindLines {
    /// Average, tilt and yaw of the wind (m/s) now.
    pub(super) fn wind(&mut self, field: &impl WindField) -> FixedFrame {
        field.sample(&self.positions, &mut self.velocities);
        self.lines.means(&self.velocities, &mut self.means);
        lines_to_fixed_frame(&self.means)
    }
}
