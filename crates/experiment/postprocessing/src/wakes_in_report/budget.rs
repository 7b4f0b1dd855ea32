//! The budget of mean kinetic energy along wakes, of what runs kept of volumes.

use super::kept::{Kept, Run};
use crate::PostprocessingError;
use crate::analyses::budget::shown;
use crate::wake_fields::{Averaged, Fields, Wanted};
use report::{Signals, TrackFigure};

/// Name under which analyses know volumes at instants.
const VOLUMES: &str = "volumes";
/// Most values of volumes at instants that a report looks at: points times instants (–). So many take some
/// two seconds.
const MOST_VALUES: usize = 20_000_000;

/// What was found run by run.
#[derive(Default)]
pub(super) struct Budgets {
    tracks: Vec<TrackFigure>,
    notes: Vec<String>,
    /// What must be said of several, and of which.
    told: Vec<(String, Vec<String>)>,
}

impl Budgets {
    /// Takes the budget of the averages in `kept`, which fill a volume.
    pub(super) fn add_averages(&mut self, run: &Run, kept: &Kept) {
        let found = shown(&kept.request, &kept.averaged);
        self.take(run, &kept.field, found);
    }

    /// Takes the budget of the volumes at instants that `run` kept.
    pub(super) fn add_instants(&mut self, run: &Run) {
        // A budget needs no phases: one bin takes least memory.
        let request = run.request().with("field", VOLUMES).with("bins", "1").with("cycles", "0");
        let instants = match Fields::instants(&request) {
            Ok(instants) => instants,
            Err(error) => return self.notes.push(run.told(&error)),
        };
        let (n_points, n_instants) = (instants.file.grid().len(), instants.times().len());
        if n_points * n_instants > MOST_VALUES {
            let how_many = format!("{n_instants} volumes of {n_points} points");
            let note = run.too_large("budgets", VOLUMES, &how_many, "budget --bins 1 --cycles 0");
            return self.notes.push(note);
        }
        let found =
            Averaged::of(&request, Wanted::PARTS).and_then(|averaged| shown(&request, &averaged));
        self.take(run, VOLUMES, found);
    }

    fn take(&mut self, run: &Run, field: &str, found: Result<Signals, PostprocessingError>) {
        match found {
            Ok(found) => {
                for mut figure in found.tracks {
                    figure.title = format!("{}: {}, {field}", figure.title, run.name());
                    figure.name = format!("{}-{field}-{}", figure.name, run.name());
                    self.tracks.push(figure);
                }
                for note in found.notes {
                    let of = format!("{}, {field}", run.name());
                    match self.told.iter_mut().find(|(other, _)| *other == note) {
                        Some((_, all)) => all.push(of),
                        None => self.told.push((note, vec![of])),
                    }
                }
            }
            Err(error) => self.notes.push(run.told(&error)),
        }
    }

    /// The part of the page.
    pub(super) fn signals(self) -> Signals {
        let told = self.told.into_iter().map(|(note, of)| format!("{}: {note}", of.join("; ")));
        Signals {
            title: "Budget of the wake".to_owned(),
            lead: "Mean kinetic energy that boxes about the hub, one behind the other, gain and lose; in U³D²."
                .to_owned(),
            tracks: self.tracks,
            notes: told.chain(self.notes).collect(),
            ..Signals::default()
        }
    }
}
