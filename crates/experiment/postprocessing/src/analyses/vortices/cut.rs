//! The plane in which vortices are sought: that of the fields, or one through the hub of a volume.

use crate::PostprocessingError;
use crate::wake_fields::{Averaged, refused};
use basis::records::{Grid, Moments};

/// A plane of the fields.
pub(super) struct Cut {
    /// Its points.
    pub(super) grid: Grid,
    /// Their numbers among those of the fields; all of them in their order where there are none.
    places: Option<Vec<usize>>,
}

impl Cut {
    /// The plane of `averaged`; of a volume that along the wind whose points are nearest to the hub.
    ///
    /// # Errors
    /// [`PostprocessingError::Fields`] for fields that span neither plane nor volume, or a volume that does
    /// not reach the hub.
    pub(super) fn of(averaged: &Averaged) -> Result<Self, PostprocessingError> {
        let grid = *averaged.grid();
        match grid.spanned().len() {
            2 => Ok(Self { grid, places: None }),
            3 => {
                let hub = averaged.setting.hub[1];
                let step = grid.steps_to(1, hub).ok_or_else(|| {
                    let problem = format!("does not reach the hub at y = {hub} m");
                    refused(&averaged.path, problem, "give a volume about the hub, or --hub X,Y,Z")
                })?;
                let step = step.round() as usize;
                let [n_x, _, n_z] = grid.n_points;
                let mut plane = Grid { n_points: [n_x, 1, n_z], ..grid };
                plane.origin[1] = grid.coordinate(1, step);
                let place = |index: usize| {
                    let [x, _, z] = plane.place(index);
                    grid.index([x, step, z])
                };
                let places = (0..plane.len()).map(place).collect();
                Ok(Self { grid: plane, places: Some(places) })
            }
            _ => Err(refusal(averaged)),
        }
    }

    /// Mean velocity in the plane (m/s).
    pub(super) fn velocity(&self, moments: &Moments) -> [Vec<f64>; 3] {
        moments.mean.each_ref().map(|values| match &self.places {
            Some(places) => places.iter().map(|place| f64::from(values[*place])).collect(),
            None => analysis::grids::widened(values),
        })
    }
}

/// That the fields span no plane.
pub(super) fn refusal(averaged: &Averaged) -> PostprocessingError {
    let fix = "name a plane with --field, such as streamwise";
    refused(&averaged.path, "spans no plane, in which vortices are sought", fix)
}
