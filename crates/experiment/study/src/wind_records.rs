//! The wind over the rotor of a turbine that is not there, as a full field that turbines elsewhere can stand in.

use crate::{Prepared, StudyError};
use basis::Vector3;
use farm::case::{Control, Run};
use flow::WindField;
use flow::inflow::PlaneGrid;
use formats::records::RunFolder;
use formats::turbulence_box::WindRecorder;

/// Air around the rotor that is kept (rotor diameters): tower tops sway, and rotors are displaced.
const MARGIN: f64 = 0.1;
/// Cells that the wind crosses between two planes, at most (–).
const CELLS_BETWEEN: f64 = 0.5;

/// One record under way, with room to work in.
pub(crate) struct WindRecord {
    recorder: WindRecorder,
    grid: PlaneGrid,
    hub_height: f64,
    description: String,
    /// Steps from one plane to the next (–).
    stride: u64,
    positions: Vec<Vector3>,
    velocities: Vec<Vector3>,
    wind: Vec<[f32; 3]>,
}

/// Points of the planes at the place of turbine number `index`, and the steps from one to the next.
///
/// A grid as fine as the cells, with a point at the hub, as far down as half a cell above the ground.
fn grid(setup: &Prepared, index: usize) -> (PlaneGrid, u64) {
    let (plan, rotor) = (&setup.plan, &setup.models[index].definition);
    let (spacing, hub_height) = (plan.spacing, rotor.rotor.hub_height);
    let reach = rotor.rotor_radius() + MARGIN * rotor.rotor_diameter();
    let n_aside = (reach / spacing).ceil();
    let n_down = n_aside.min((hub_height / spacing - 0.5).floor()).max(0.0);
    let crossing = CELLS_BETWEEN * spacing / setup.case.wind.speed;
    let stride = (crossing / plan.interval).floor().max(1.0);
    let grid = PlaneGrid {
        n_y: 2 * n_aside as usize + 1,
        n_z: (n_aside + n_down) as usize + 1,
        spacing: [spacing; 2],
        first: [-n_aside * spacing, hub_height - n_down * spacing],
        interval: stride * plan.interval,
        speed: setup.case.wind.speed,
        n_steps: 0,
        repeats: false,
    };
    (grid, stride as u64)
}

/// The records that the case asks for and `run` leaves room for, begun in `folder`, or taken up after the bytes that the
/// checkpoint knows of each, `stored`.
///
/// # Errors
/// [`StudyError::File`].
pub(crate) fn of(
    setup: &Prepared,
    run: &Run,
    folder: &RunFolder,
    stored: Option<&[u64]>,
) -> Result<Vec<WindRecord>, StudyError> {
    let places = setup.case.output.inflow_at.iter().copied();
    let absent = places.filter(|&index| run.control[index] == Control::Absent);
    let begin = |(place, index): (usize, usize)| {
        let name = &setup.case.turbines[index].name;
        let (grid, stride) = grid(setup, index);
        let foot = setup.plan.positions[index];
        let positions: Vec<Vector3> = (0..grid.n_z)
            .flat_map(|row| (0..grid.n_y).map(move |column| (row, column)))
            .map(|(row, column)| {
                let y = grid.first[0] + column as f64 * grid.spacing[0];
                let z = grid.first[1] + row as f64 * grid.spacing[1];
                Vector3::new(foot.x, foot.y + y, z)
            })
            .collect();
        let (path, n_points) = (folder.inflow_path(name), positions.len());
        let recorder = match stored.and_then(|stored| stored.get(place)) {
            Some(&bytes) => WindRecorder::resume(&path, n_points, bytes)?,
            None => WindRecorder::create(&path, n_points)?,
        };
        Ok(WindRecord {
            recorder,
            hub_height: setup.models[index].definition.rotor.hub_height,
            description: format!("wakemix: {}, run {}, at {name}", setup.case.name, run.name),
            stride,
            velocities: vec![Vector3::ZERO; n_points],
            wind: vec![[0.0; 3]; n_points],
            positions,
            grid,
        })
    };
    absent.enumerate().map(begin).collect()
}

impl WindRecord {
    /// Keeps the wind of `field` now, `step` steps after the spin-up, where a plane is due.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn see(&mut self, step: u64, field: &impl WindField) -> Result<(), StudyError> {
        if !step.is_multiple_of(self.stride) {
            return Ok(());
        }
        field.sample(&self.positions, &mut self.velocities);
        for (wind, velocity) in self.wind.iter_mut().zip(&self.velocities) {
            *wind = [velocity.x, velocity.y, velocity.z].map(|component| component as f32);
        }
        Ok(self.recorder.write(&self.wind)?)
    }

    /// Puts what was kept on the disk; gives its bytes, for [`of`].
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn flush(&mut self) -> Result<u64, StudyError> {
        Ok(self.recorder.flush()?)
    }

    /// Completes the file.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn finish(&mut self) -> Result<(), StudyError> {
        Ok(self.recorder.finish(&self.grid, self.hub_height, &self.description)?)
    }
}
