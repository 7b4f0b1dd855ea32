//! The figures of a report.

mod gains;
mod geometry;
pub(crate) mod pitch;
pub(crate) mod power;
pub(crate) mod precursor;
mod profiles;
mod rotors;
mod sheet;
mod slices;
pub(crate) mod surrogate;
pub(crate) mod sweep;
pub(crate) mod synchronisation;

use crate::draw::colour::Ink;
use crate::draw::font::{Face, wrapped};
use crate::draw::{Figure, TextStyle, text};
use crate::sentence;
use crate::study::Study;
use synchronisation::{Signals, Synchronisation};

/// Width of every figure.
const WIDTH: f64 = 1000.0;

/// Every figure that the records allow, in the order of the page.
pub(crate) struct Figures {
    /// Of the study.
    pub(crate) study: Vec<Figure>,
    /// Of each turbine that joins a helix, below the title of its part of the page.
    pub(crate) joined: Vec<(String, Vec<Figure>)>,
    /// Of further signals.
    pub(crate) signals: Vec<SignalsPart>,
}

/// A part of the page with further signals.
pub(crate) struct SignalsPart {
    /// Its title.
    pub(crate) title: String,
    /// What stands below it.
    pub(crate) lead: String,
    /// What it shows.
    pub(crate) figures: Vec<Figure>,
    /// What must be said below.
    pub(crate) notes: Vec<String>,
}

impl Figures {
    /// All of them, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Figure> {
        let joined = self.joined.iter().flat_map(|(_, figures)| figures);
        let signals = self.signals.iter().flat_map(|part| &part.figures);
        self.study.iter().chain(joined).chain(signals)
    }
}

/// Draws them.
pub(crate) fn all(study: &Study) -> Figures {
    let mut figures = Vec::new();
    figures.extend(gains::gains(study));
    figures.extend(gains::gain_over_amplitude(study));
    figures.extend(power::power(study));
    figures.extend(slices::mean(study));
    figures.extend(slices::difference(study));
    figures.extend(slices::instants(study));
    figures.extend(slices::streamwise(study));
    figures.extend(slices::crosswind(study));
    figures.extend(geometry::geometry(study));
    figures.extend(profiles::profiles(study));
    figures.extend(profiles::centre_line(study));
    figures.extend(pitch::pitch(study));
    figures.extend(power::rotor_speed(study));
    let mut joined = joined(&study.records.synchronisation);
    let part = |of: &Signals| SignalsPart {
        title: of.title.clone(),
        lead: of.lead.clone(),
        figures: synchronisation::of_signals(of),
        notes: of.notes.clone(),
    };
    let mut signals: Vec<SignalsPart> = study.records.signals.iter().map(part).collect();
    let conditions = sentence::study_conditions(study);
    let of_turbines = joined.iter_mut().flat_map(|(_, figures)| figures);
    let of_signals = signals.iter_mut().flat_map(|part| &mut part.figures);
    let all = figures.iter_mut().chain(of_turbines).chain(of_signals);
    all.for_each(|figure| sign(figure, &conditions));
    Figures { study: figures, joined, signals }
}

/// Title and figures of each of `found`; where there are several, title and files tell them apart.
fn joined(found: &[Synchronisation]) -> Vec<(String, Vec<Figure>)> {
    let title = "Phase synchronisation";
    let drawn = found.iter().map(|one| {
        let mut figures = synchronisation::all(one);
        if found.len() == 1 {
            return (title.to_owned(), figures);
        }
        let ending = one.name.replace(' ', "-");
        for figure in &mut figures {
            figure.name = format!("{}-{ending}", figure.name);
        }
        (format!("{title} of {}", one.name), figures)
    });
    drawn.collect()
}

/// Writes the conditions below a figure, so that it keeps them wherever it is shown.
fn sign(figure: &mut Figure, conditions: &[String]) {
    const SIZE: f64 = 10.5;
    const LINE: f64 = 15.0;
    let setting = TextStyle::plain(Ink::Muted, SIZE);
    for line in wrapped(conditions, " · ", &Face::new(false), SIZE, figure.width - 40.0) {
        figure.height += LINE;
        figure.shapes.push(text([16.0, figure.height - 4.0], line, setting));
    }
    figure.height += 4.0;
}
