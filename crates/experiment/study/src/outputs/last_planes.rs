//! Planes of the wind at the run's last instant, which the report shows: `planes/NAME-last.nc`.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::Stored;
use super::slices;
use crate::error::StudyError;
use formats::records::write_last_plane;

pub(super) static KIND: OutputKind = OutputKind {
    name: "last planes",
    keys: Keys::OfOutput(&[]),
    fed_by: FedBy::ResolvedFlow,
    disk: |setup, _, _| slices::file_bytes(setup),
    begin,
};

struct LastPlanes;

fn begin(_scene: &Scene, _stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    Ok(Some(Box::new(LastPlanes)))
}

impl Output for LastPlanes {
    fn schedule(&self) -> Schedule {
        Schedule::at_the_end()
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(fields) = scene.farm.flow().fields() {
            let setting = slices::setting(scene.setup, scene.run);
            for slice in slices::of(scene.setup) {
                write_last_plane(scene.folder, &setting, &slice.plane(fields))?;
            }
        }
        Ok(())
    }
}
