//! The report of a study: one self-contained page and its figures, made from records alone.

mod answer;
mod draw;
mod figures;
mod layout;
mod page;
mod precursor;
mod sentence;
mod study;
pub mod text_table;
mod trace;
mod units;
mod words;

pub use answer::{AnswerRecords, AnswerTable};
use basis::records::{Filaments, Plane, Series, Summary, SweepTable};
pub use figures::surrogate::{SurrogateCut, SurrogateFigures, SurrogateMap};
pub use figures::synchronisation::{
    Along, CentreLine, CurveAt, CurveEnd, CurveFigure, CurvePanel, CurvePoint, DeficitFigure,
    DeficitLine, DeficitPanel, DensityFigure, DensityRow, DiscFigure, DiscPanel, DiscPath,
    DiscPoint, MapColours, MapFigure, MapPanel, OffsetFigure, OffsetPanel, OffsetPoint,
    PhaseNumbers, PhaseRow, Signals, SliceFigure, SlicePanel, SliceRotor, SpectrumFigure,
    SpectrumLine, SurfaceFigure, SurfacePanel, Synchronisation, TrackFigure, TrackLine, TrackRow,
};
pub use precursor::{CoherenceLine, DriftRow, HubWind, LevelRow, PrecursorRecords, TimeHeightMap};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
pub use study::colours;
pub use units::{Unit, Units, are_of_models};

/// Files written by this process so far (–).
static N_WRITTEN: AtomicU64 = AtomicU64::new(0);

/// Everything that a report tells of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyRecords {
    /// Name of the case.
    pub case_name: String,
    /// What the study is for, in one line.
    pub description: Option<String>,
    /// The case file as run (TOML).
    pub case_text: String,
    /// The runs, in the case file's order.
    pub runs: Vec<RunRecords>,
    /// Names of the case's runs that are not complete, and not among them.
    pub incomplete: Vec<String>,
    /// What there is to show of phase synchronisation, for each turbine that joins a helix.
    pub synchronisation: Vec<Synchronisation>,
    /// Further signals and their spectra, each under a heading of its own.
    pub signals: Vec<Signals>,
    /// Version of the program that ran it.
    pub version: String,
}

/// What one run left behind.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRecords {
    /// The run in numbers.
    pub summary: Summary,
    /// Channels over time, those that the report [`draws`] or more; empty where none were kept.
    pub series: Series,
    /// Averaged planes: `hub-height`, `streamwise` and crosswind planes.
    pub mean_planes: Vec<Plane>,
    /// The same planes at single instants.
    pub instant_planes: Vec<Plane>,
    /// The vortices of its wakes at the last instant; none where the air has none to show.
    pub filaments: Option<Filaments>,
}

/// Whether the report of a run with this `summary` draws `channel` of its series.
pub fn draws(summary: &Summary, channel: &str) -> bool {
    channel == basis::channels::TIME.name
        || summary.turbines.iter().any(|turbine| {
            let of_turbine = channel.strip_prefix(&turbine.name);
            let quantity = of_turbine.and_then(|rest| rest.strip_prefix('.'));
            quantity.is_some_and(|quantity| {
                figures::power::draws(quantity)
                    || turbine.delivered_pitch.is_some() && figures::pitch::draws(quantity)
            })
        })
}

/// Why a report could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// There is nothing to report on.
    #[error("the study `{case}` has no finished run to report on")]
    NoRuns {
        /// Name of the case.
        case: String,
    },
    /// A file could not be written.
    #[error("cannot write {}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A picture could not be encoded.
    #[error("cannot draw the figure `{figure}` as pixels")]
    Picture {
        /// Name of the figure.
        figure: String,
        /// What the encoder said.
        source: png::EncodingError,
    },
    /// The page could not be put together.
    #[error("cannot assemble the page")]
    Page(#[from] minijinja::Error),
}

/// The page of `study` as text: HTML that needs nothing beside it.
///
/// # Errors
/// [`ReportError::NoRuns`] for a study without runs.
pub fn page(study: &StudyRecords) -> Result<String, ReportError> {
    let digest = study::Study::new(study)?;
    page::render(&digest, &figures::all(&digest))
}

/// Writes `report.html` and `figures/*.svg`, `figures/*.png` of `study` into `directory`.
///
/// The page needs nothing beside it. Every file is made in memory first and appears whole or not
/// at all; the page comes last. The same records give the same bytes.
///
/// # Errors
/// [`ReportError::NoRuns`] for a study without runs, [`ReportError::Write`] when the disk says no.
pub fn write(study: &StudyRecords, directory: &Path) -> Result<(), ReportError> {
    let digest = study::Study::new(study)?;
    let figures = figures::all(&digest);
    let page = page::render(&digest, &figures)?;
    write_figures(figures.iter(), directory)?;
    write_whole(&directory.join("report.html"), page.as_bytes())
}

/// Writes `report.html` of `study` into `directory` without the figures beside it, which the page does not
/// need.
///
/// # Errors
/// Those of [`write()`].
pub fn write_page(study: &StudyRecords, directory: &Path) -> Result<(), ReportError> {
    write_whole(&directory.join("report.html"), page(study)?.as_bytes())
}

/// Writes `report.html` and `figures/*.svg`, `figures/*.png` of the precursor of `records` into `directory`;
/// gives the page's path.
///
/// # Errors
/// [`ReportError::Write`] when the disk says no.
pub fn write_precursor(
    records: &PrecursorRecords,
    directory: &Path,
) -> Result<PathBuf, ReportError> {
    let figures = figures::precursor::all(records);
    let page = page::precursor::render(records, &figures)?;
    write_figures(figures.iter(), directory)?;
    let path = directory.join("report.html");
    write_whole(&path, page.as_bytes())?;
    Ok(path)
}

/// Writes `report.html` and `figures/*.svg`, `figures/*.png` of the answer of `records` into `directory`;
/// gives the page's path.
///
/// # Errors
/// [`ReportError::Write`] when the disk says no.
pub fn write_answer(records: &AnswerRecords, directory: &Path) -> Result<PathBuf, ReportError> {
    let figures: Vec<draw::Figure> =
        records.signals.iter().flat_map(figures::synchronisation::of_signals).collect();
    let page = page::answer::render(records, &figures)?;
    write_figures(figures.iter(), directory)?;
    let path = directory.join("report.html");
    write_whole(&path, page.as_bytes())?;
    Ok(path)
}

/// Writes `sweep.html` and the figures of the sweep of `table` into `directory`, made by the program of
/// `version`; gives the page's path.
///
/// # Errors
/// [`ReportError::Write`] when the disk says no.
pub fn write_sweep(
    table: &SweepTable,
    version: &str,
    directory: &Path,
) -> Result<PathBuf, ReportError> {
    write_figures(figures::sweep::all(table).iter(), directory)?;
    write_sweep_page(table, version, directory)
}

/// Writes `sweep.html` as [`write_sweep`] does, without the figures beside it; gives the page's path.
///
/// # Errors
/// Those of [`write_sweep`].
pub fn write_sweep_page(
    table: &SweepTable,
    version: &str,
    directory: &Path,
) -> Result<PathBuf, ReportError> {
    let page = page::sweep::render(table, &figures::sweep::all(table), version)?;
    let path = directory.join("sweep.html");
    write_whole(&path, page.as_bytes())?;
    Ok(path)
}

/// Writes the figures of a phase synchronisation into `directory`/figures, as SVG and PNG; gives their names.
///
/// # Errors
/// [`ReportError::Write`] when the disk says no.
pub fn write_synchronisation(
    records: &Synchronisation,
    directory: &Path,
) -> Result<Vec<String>, ReportError> {
    let figures = figures::synchronisation::all(records);
    write_figures(figures.iter(), directory)?;
    Ok(figures.into_iter().map(|figure| figure.name).collect())
}

/// Writes the figures of `signals` into `directory`/figures, as SVG and PNG; gives their names.
///
/// # Errors
/// [`ReportError::Write`] when the disk says no.
pub fn write_signals(signals: &[Signals], directory: &Path) -> Result<Vec<String>, ReportError> {
    let figures: Vec<draw::Figure> =
        signals.iter().flat_map(figures::synchronisation::of_signals).collect();
    write_figures(figures.iter(), directory)?;
    Ok(figures.into_iter().map(|figure| figure.name).collect())
}

/// Writes the figures of a surrogate into `directory`/figures, as SVG and PNG; gives their names.
///
/// # Errors
/// [`ReportError::Write`] when the disk says no.
pub fn write_surrogate(
    figures: &SurrogateFigures,
    directory: &Path,
) -> Result<Vec<String>, ReportError> {
    let drawn = figures::surrogate::surrogate(figures);
    write_figures(drawn.iter(), directory)?;
    Ok(drawn.into_iter().map(|figure| figure.name).collect())
}

/// Draws every figure in both forms, then writes them into `directory`/figures.
fn write_figures<'f>(
    figures: impl Iterator<Item = &'f draw::Figure>,
    directory: &Path,
) -> Result<(), ReportError> {
    let mut files = Vec::new();
    for figure in figures {
        let failed = |source| ReportError::Picture { figure: figure.name.clone(), source };
        files.push((format!("{}.svg", figure.name), draw::svg::document(figure).map_err(failed)?));
        files.push((format!("{}.png", figure.name), draw::raster::png(figure).map_err(failed)?));
    }
    let folder = directory.join("figures");
    fs::create_dir_all(&folder)
        .map_err(|source| ReportError::Write { path: folder.clone(), source })?;
    for (name, bytes) in &files {
        write_whole(&folder.join(name), bytes)?;
    }
    Ok(())
}

/// Writes `bytes` beside `path`, brings them to the disk, then puts them in place; several may at once, and
/// the last of them stays.
fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // Of this process and this call alone.
    let call = N_WRITTEN.fetch_add(1, Ordering::Relaxed);
    let unfinished = path.with_file_name(format!(".{name}.{call}.{}.part", std::process::id()));
    let attempt = || {
        let mut file = File::create(&unfinished)?;
        // For who looks for what killed processes have left; that it is written does not hang on it.
        let _ = file.try_lock();
        file.write_all(bytes)?;
        file.sync_all()?;
        drop(file);
        fs::rename(&unfinished, path)
    };
    attempt().map_err(|source| {
        // What is left of the attempt is of no use; the error that matters is the first one.
        let _ = fs::remove_file(&unfinished);
        ReportError::Write { path: path.to_owned(), source }
    })
}
