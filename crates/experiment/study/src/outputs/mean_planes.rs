//! Planes of the wind averaged over the analysed time: `planes/NAME-mean.nc`.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::slices::{self, SUM_BYTES, Slice};
use crate::error::StudyError;
use crate::prepared::Prepared;
use farm::Plan;
use flow::fields::{FieldSource, PlaneAverage, PlaneAverageState};
use formats::records::write_mean_plane;

/// Planes are averaged from instants about this far apart (s),
const AVERAGING_INTERVAL: f64 = 2.0;
/// those of models as far apart as a wind of this speed takes past the rotor (m/s).
const PASSING_SPEED: f64 = 50.0;

/// Distance of the instants that planes are averaged from (s).
pub(super) fn averaging_interval(plan: &Plan) -> f64 {
    AVERAGING_INTERVAL.min(plan.diameter / PASSING_SPEED)
}

/// The averages of all planes, of no instant yet.
pub(crate) fn averages(setup: &Prepared, fields: &dyn FieldSource) -> Vec<PlaneAverage> {
    let average = |slice: Slice| PlaneAverage::new(fields, &slice.name, slice.axes, slice.position);
    slices::of(setup).into_iter().map(average).collect()
}

/// The steps that they are made of.
pub(crate) fn schedule(setup: &Prepared) -> Schedule {
    Schedule::analysed(&setup.plan, averaging_interval(&setup.plan))
}

pub(super) static KIND: OutputKind = OutputKind {
    name: "mean planes",
    keys: Keys::OfOutput(&["crosswind_diameters"]),
    fed_by: FedBy::ResolvedFlow,
    disk: |setup, _, _| slices::file_bytes(setup) + slices::n_points(setup) * SUM_BYTES,
    begin,
};

struct MeanPlanes {
    schedule: Schedule,
    averages: Vec<PlaneAverage>,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Some(fields) = scene.farm.flow().fields() else { return Ok(None) };
    let mut averages = averages(scene.setup, fields);
    if let Some(stored) = stored {
        let states: Vec<PlaneAverageState> = stored.state()?;
        for (average, state) in averages.iter_mut().zip(states) {
            average.restore(state)?;
        }
    }
    Ok(Some(Box::new(MeanPlanes { schedule: schedule(scene.setup), averages })))
}

impl Output for MeanPlanes {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(fields) = scene.farm.flow().fields() {
            self.averages.iter_mut().for_each(|average| average.add(fields));
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let states: Vec<PlaneAverageState> =
            self.averages.iter().map(PlaneAverage::state).collect();
        section.keep(&states)
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let setting = slices::setting(scene.setup, scene.run);
        for average in self.averages.iter().filter(|average| average.n_instants() > 0) {
            write_mean_plane(scene.folder, &setting, &average.mean())?;
        }
        Ok(())
    }
}
