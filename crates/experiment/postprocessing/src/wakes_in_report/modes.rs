//! What moves together in wakes, of planes and volumes that runs kept at instants.

use super::kept::Run;
use crate::analyses::modes::shown;
use crate::wake_fields::Fields;
use formats::records::RunRecords;
use report::Signals;

/// Most products that a report makes for modes (–): so many take some three seconds.
const MOST_PRODUCTS: f64 = 2e10;
/// Products of an instant with all others, of each point and of the eigenvalues (–).
const OF_POINTS: f64 = 3.0;
const OF_EIGENVALUES: f64 = 30.0;

/// The part of the page about modes of `run`, whose records are `records`; none where it kept neither planes
/// nor volumes at instants.
pub(super) fn of_run(run: &Run, records: &RunRecords) -> Option<Signals> {
    let field = ["streamwise", "hub-height"].into_iter();
    let mut planes = field.filter(|name| run.folder.instants_path(name).is_file());
    let volumes = (!records.volume_paths.is_empty()).then_some("volumes");
    let field = planes.next().or(volumes)?;
    let part = Signals {
        title: format!("Modes of {}", run.name()),
        lead: "What moves together, by energy and by energy at each frequency; f_r is the rotor's frequency, f_e that of the helix."
            .to_owned(),
        ..Signals::default()
    };
    Some(match found(run, field) {
        Ok(found) => Signals { title: part.title, lead: part.lead, ..named(run, field, found) },
        Err(note) => Signals { notes: vec![note], ..part },
    })
}

/// The modes of `field`.
///
/// # Errors
/// What the page says instead.
fn found(run: &Run, field: &str) -> Result<Signals, String> {
    let told = |error| run.told(&error);
    let request = run.request().with("field", field);
    let instants = Fields::instants(&request).map_err(told)?;
    let (n_points, n_instants) = (instants.file.grid().len(), instants.times().len());
    let (points, n) = (n_points as f64, n_instants as f64);
    if OF_POINTS * points * n * n + OF_EIGENVALUES * n.powi(3) > MOST_PRODUCTS {
        let how_many = format!("{n_instants} instants of {n_points} points");
        return Err(run.too_large("modes", field, &how_many, "modes"));
    }
    shown(&request).map_err(told)
}

/// `found` with the name of the run, and of the `field`, in names and titles of its figures.
fn named(run: &Run, field: &str, mut found: Signals) -> Signals {
    let maps = found.maps.iter_mut().map(|map| (&mut map.name, &mut map.title));
    let densities = found.densities.iter_mut().map(|one| (&mut one.name, &mut one.title));
    for (name, title) in maps.chain(densities) {
        *name = format!("{name}-{}", run.name());
        *title = format!("{title}: {}, {field}", run.name());
    }
    found
}
