//! The wake by phase: samples of the bins, and velocity with tip vortices.

use super::kept::{Kept, Run};
use crate::PostprocessingError;
use crate::analyses::phases::figures::{samples, samples_row};
use crate::analyses::vortices::Found;
use crate::analyses::vortices::figures::{curves, velocity};
use crate::analyses::vortices::surfaces;
use crate::wake_fields::conditions;
use report::{CurveFigure, MapFigure, Signals, SurfaceFigure, TrackRow};

/// What was found run by run.
#[derive(Default)]
pub(super) struct ByPhase {
    maps: Vec<MapFigure>,
    curves: Vec<CurveFigure>,
    surfaces: Vec<SurfaceFigure>,
    /// Of each output that averages.
    samples: Vec<Samples>,
    /// What must be said.
    pub(super) notes: Vec<String>,
}

/// Samples of one output.
struct Samples {
    output: String,
    /// Names of the runs, whose rows these are, and what is said of each.
    runs: Vec<String>,
    rows: Vec<TrackRow>,
    told: Vec<String>,
}

impl ByPhase {
    /// Takes the samples of `kept`; planes and volumes of one output have the same.
    pub(super) fn add_samples(&mut self, run: &Run, kept: &Kept) {
        let known = self.samples.iter().position(|one| one.output == kept.output);
        let place = known.unwrap_or_else(|| {
            let (output, runs) = (kept.output.clone(), Vec::new());
            self.samples.push(Samples { output, runs, rows: Vec::new(), told: Vec::new() });
            self.samples.len() - 1
        });
        let of = &mut self.samples[place];
        if of.runs.iter().any(|other| other == run.name()) {
            return;
        }
        let averaged = &kept.averaged;
        of.runs.push(run.name().to_owned());
        of.rows.push(samples_row(averaged, run.name(), run.colour));
        of.told.push(format!("{}; {}.", conditions(&averaged.setting), averaged.counts()));
    }

    /// Takes velocity and vortices of `kept`, which reach along the wind.
    pub(super) fn add_wake(&mut self, run: &Run, kept: Kept) {
        if let Err(error) = self.take_wake(run, kept) {
            self.notes.push(run.told(&error));
        }
    }

    fn take_wake(&mut self, run: &Run, kept: Kept) -> Result<(), PostprocessingError> {
        let Kept { field, request, averaged, .. } = kept;
        // Blades make pairs: without them each vortex is taken with the next.
        let request = match averaged.n_blades {
            Some(n) => request.with("blades", &n.to_string()),
            None => request,
        };
        let found = Found::of(&request, averaged)?;
        let mut map = velocity(&found)?;
        map.title = format!("{}: {}, {field}", map.title, run.name());
        map.name = format!("{}-{field}-{}", map.name, run.name());
        self.maps.push(map);
        for mut curve in curves(&found) {
            curve.title = format!("{}: {}, {field}", curve.title, run.name());
            curve.name = format!("{}-{field}-{}", curve.name, run.name());
            self.curves.push(curve);
        }
        let (surface, _) = surfaces::made(&request, &found, true)?;
        self.surfaces.extend(surface.map(|mut surface| {
            surface.title = format!("{}: {}, {field}", surface.title, run.name());
            surface.name = format!("{}-{field}-{}", surface.name, run.name());
            surface
        }));
        Ok(())
    }

    /// The part of the page.
    pub(super) fn signals(self) -> Signals {
        let figure = |(outputs, one): (Vec<String>, Samples)| {
            let mut figure = samples(one.rows, &one.told.join(" "));
            figure.title = format!("{}: {}", figure.title, outputs.join(", "));
            figure.name = format!("{}-{}", figure.name, outputs.join("-"));
            figure
        };
        // Outputs with the same bins have the same samples.
        let mut alike: Vec<(Vec<String>, Samples)> = Vec::new();
        for one in self.samples {
            match alike.iter_mut().find(|(_, other)| other.told == one.told) {
                Some((outputs, _)) => outputs.push(one.output),
                None => alike.push((vec![one.output.clone()], one)),
            }
        }
        Signals {
            title: "The wake by phase".to_owned(),
            lead: "Velocity averaged in the run by the azimuths of rotor and helix. Lengths are in rotor diameters from the hub. wakemix analyse vortices lists the vortices that were followed."
                .to_owned(),
            maps: self.maps,
            curves: self.curves,
            surfaces: self.surfaces,
            tracks: alike.into_iter().map(figure).collect(),
            notes: self.notes,
            ..Signals::default()
        }
    }
}
