//! What `wakemix analyse` offers: a file here and a line in [`ANALYSES`] each.
//!
//! An analysis reads the records of runs and answers in text and in JSON. The command line makes its
//! arguments and its help from the descriptor; a program calls [`Analysis::run`] with a [`Request`].

pub(crate) mod budget;
mod changes;
pub(crate) mod entrainment;
mod gains;
mod hub_vortex;
mod lock;
mod meandering;
#[cfg(feature = "modes")]
pub(crate) mod modes;
mod moments;
mod offsets;
mod particles;
mod phase;
pub(crate) mod phases;
mod spectra;
mod tune;
pub(crate) mod vortices;
mod winds;

pub use crate::request::{AnalysisSetting, Request, Takes, Told, Watch};

use crate::PostprocessingError;
use basis::records::Statistic;
use report::Signals;
use std::path::Path;

/// All analyses, in the order in which they are listed.
pub const ANALYSES: &[Analysis] = &[
    phase::ANALYSIS,
    winds::ANALYSIS,
    spectra::ANALYSIS,
    moments::ANALYSIS,
    tune::ANALYSIS,
    offsets::ANALYSIS,
    gains::ANALYSIS,
    changes::ANALYSIS,
    lock::ANALYSIS,
    meandering::ANALYSIS,
    hub_vortex::ANALYSIS,
    phases::ANALYSIS,
    entrainment::ANALYSIS,
    budget::ANALYSIS,
    vortices::ANALYSIS,
    #[cfg(feature = "modes")]
    modes::ANALYSIS,
    particles::ANALYSIS,
];

/// Where an analysis draws its figures.
const FIGURES: AnalysisSetting = AnalysisSetting {
    name: "figures",
    value: "FOLDER",
    takes: Takes::Text,
    about: "Folder to draw the figures into, as SVG and PNG in its folder `figures`; nothing is drawn when left out",
};

/// Draws `signals` where `request` asks for it; says which figures those are.
///
/// # Errors
/// [`PostprocessingError::Report`] where they cannot be written.
fn drawn(request: &Request, signals: &[Signals]) -> Result<Option<String>, PostprocessingError> {
    let Some(folder) = request.text(FIGURES.name) else { return Ok(None) };
    let names = report::write_signals(signals, Path::new(folder))?;
    let folder = Path::new(folder).join("figures");
    Ok(Some(format!("drawn in {}: {}", folder.display(), names.join(", "))))
}

/// One analysis.
#[derive(Clone, Copy, Debug)]
pub struct Analysis {
    /// Name on the command line.
    pub name: &'static str,
    /// What it tells, in a sentence without a full stop.
    pub about: &'static str,
    /// The records that it is about.
    pub of: Of,
    /// What else can be set.
    pub settings: &'static [AnalysisSetting],
    /// Makes the answer.
    pub run: fn(&Request) -> Result<Answer, PostprocessingError>,
}

/// The records that an analysis is about, in words for who gives their folders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// One run.
    Run(&'static str),
    /// One run or more, the first of which the others stand beside.
    Runs(&'static str),
    /// Whole studies, one or more.
    Studies(&'static str),
}

/// What an analysis found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    /// For people: a table, with its conventions below.
    pub text: String,
    /// For programs.
    pub json: serde_json::Value,
    /// What has no answer, and why.
    pub remarks: Vec<String>,
}

/// `statistic` times `scale` with so many `digits`, ± half of its 95 % interval where it has one.
pub fn with_interval(statistic: &Statistic, scale: f64, digits: usize) -> String {
    let mean = scale * statistic.mean;
    match statistic.half_width_95 {
        Some(half_width) => format!("{mean:.digits$} ± {:.digits$}", scale * half_width),
        None => format!("{mean:.digits$}"),
    }
}
