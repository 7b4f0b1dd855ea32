//! Figures of a precursor: profiles, histories, maps over time and height, spectra, coherence.

mod coherence;
mod maps;
mod profiles;

use super::synchronisation::{self, Signals};
use crate::draw::Figure;
use crate::precursor::PrecursorRecords;

/// Every figure that `records` allow, in the order of a page.
pub(crate) fn all(records: &PrecursorRecords) -> Vec<Figure> {
    let signals = Signals {
        tracks: records.tracks.clone(),
        densities: Vec::from_iter(records.spectra.clone()),
        ..Signals::default()
    };
    let mut figures = Vec::from_iter(profiles::profiles(records));
    let (histories, spectra): (Vec<Figure>, Vec<Figure>) = synchronisation::of_signals(&signals)
        .into_iter()
        .partition(|figure| records.tracks.iter().any(|track| track.name == figure.name));
    figures.extend(histories);
    figures.extend(maps::maps(records));
    figures.extend(spectra);
    figures.extend(coherence::coherence(records));
    figures
}
