//! Planes of the wind at instants of the analysed time: `planes/NAME.nc`, one file
//! for all instants of a plane.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::slices::{self, POINT_BYTES};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use basis::records::Plane;
use farm::case::Run;
use formats::records::InstantWriter;

pub(super) static KIND: OutputKind = OutputKind {
    name: "instantaneous planes",
    keys: Keys::OfOutput(&["plane_interval"]),
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

fn schedule(setup: &Prepared) -> Option<Schedule> {
    setup.case.output.plane_interval.map(|interval| Schedule::analysed(&setup.plan, interval))
}

fn disk(setup: &Prepared, _run: &Run, _: &Values) -> u64 {
    let Some(schedule) = schedule(setup) else { return 0 };
    let n_times = schedule.count(setup.plan.n_steps);
    let times = n_times * slices::count(setup) * size_of::<f64>() as u64;
    n_times * slices::n_points(setup) * POINT_BYTES
        + times
        + slices::count(setup) * slices::bytes_beside(setup)
}

struct InstantPlanes {
    schedule: Schedule,
    /// Each plane as it was last, with its file.
    planes: Vec<(Plane, InstantWriter)>,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let requested = schedule(scene.setup).zip(scene.farm.flow().fields());
    let Some((schedule, fields)) = requested else { return Ok(None) };
    // So many instants are sure.
    let n_kept: Option<u64> = stored.map(Stored::state).transpose()?;
    let setting = slices::setting(scene.setup, scene.run);
    let mut planes = Vec::new();
    for slice in slices::of(scene.setup) {
        let plane = Plane { averaged: 0.0, ..slice.plane(fields) };
        let path = scene.folder.instants_path(&plane.name);
        let writer = match n_kept {
            Some(n_kept) => InstantWriter::resume(&path, &setting, &plane, n_kept)?,
            None => InstantWriter::create(&path, &setting, &plane)?,
        };
        planes.push((plane, writer));
    }
    Ok(Some(Box::new(InstantPlanes { schedule, planes })))
}

impl Output for InstantPlanes {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        if let Some(fields) = scene.farm.flow().fields() {
            for (plane, writer) in &mut self.planes {
                fields.refresh(plane);
                writer.write(plane)?;
            }
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let mut n_kept = 0;
        for (_, writer) in &mut self.planes {
            n_kept = writer.flush()?;
        }
        section.keep(&n_kept)
    }

    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        Ok(self.planes.iter_mut().try_for_each(|(_, writer)| writer.finish())?)
    }
}
