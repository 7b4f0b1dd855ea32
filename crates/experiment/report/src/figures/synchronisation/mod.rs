//! Figures of phase synchronisation: offsets, phases, moments, and what becomes of the wake.
//!
//! All of them draw plain data: whoever reads the records fits curves, takes spectra and finds centre lines
//! first.

mod curves;
mod deficits;
mod densities;
mod discs;
mod maps;
mod marks;
mod offsets;
mod slices;
mod spectra;
mod surfaces;
mod tracks;

use crate::draw::Figure;
use basis::records::{Plane, Statistic};
pub use curves::{CurveAt, CurveFigure, CurvePanel};
pub use discs::{DiscFigure, DiscPanel, DiscPath, DiscPoint};
pub use maps::{MapColours, MapFigure, MapPanel};
pub use surfaces::{SurfaceFigure, SurfacePanel};

/// What a study has to show of a turbine's phase synchronisation; what is empty is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Synchronisation {
    /// Whose it is: the turbine that joins a helix, and which helix where it joins several, such as `T2` or
    /// `T2 cw St 0.25`.
    pub name: String,
    /// How well each run found the phases of the helix.
    pub phases: Vec<PhaseRow>,
    /// Changes over the phase offset: of power, of loads.
    pub offsets: Vec<OffsetFigure>,
    /// Signals over time, estimates beside the truth.
    pub tracks: Vec<TrackFigure>,
    /// Amplitudes over frequency around the excitation.
    pub spectra: Vec<SpectrumFigure>,
    /// The wake from above at one phase, with its centre line.
    pub slices: Option<SliceFigure>,
    /// Deficits about the wake's own centre.
    pub deficits: Option<DeficitFigure>,
}

/// How well one run found the phases of the helix.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseRow {
    /// Name of the run.
    pub run: String,
    /// Phase offset (rad, [0, 2π)); absent where the turbine only monitored.
    pub offset: Option<f64>,
    /// Tilt.
    pub tilt: PhaseNumbers,
    /// Yaw.
    pub yaw: PhaseNumbers,
    /// Mean trust (–).
    pub trust: f64,
}

/// One axis of an estimate against the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseNumbers {
    /// Root mean square of the phase error (rad).
    pub rmse: f64,
    /// Its circular mean (rad).
    pub bias: f64,
    /// Root mean square about that mean (rad).
    pub spread: f64,
    /// Phase locking (–).
    pub locking: f64,
    /// Coherence at the excitation's frequency (–); absent in short records.
    pub coherence: Option<f64>,
    /// Phase of the estimate minus that of the truth at the excitation's frequency, from the cross-spectrum,
    /// and half width of its 95 % interval (rad); absent in short records.
    pub phase_error: Option<[f64; 2]>,
    /// Mean estimated amplitude (m/s).
    pub amplitude: f64,
    /// Mean true amplitude (m/s).
    pub true_amplitude: f64,
}

/// How a quantity changes with the phase offset, a panel for each turbine.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetFigure {
    /// Name of the figure's files, such as `power-over-offset`.
    pub name: String,
    /// Title.
    pub title: String,
    /// What changes and against what, such as `power against the run bl-helix (%)`.
    pub label: String,
    /// The panels, on one scale.
    pub panels: Vec<OffsetPanel>,
}

/// One turbine's changes, and the curve through them.
#[derive(Clone, Debug, PartialEq)]
pub struct OffsetPanel {
    /// Title, such as `T3` or `T2 + T3`.
    pub title: String,
    /// What was simulated.
    pub points: Vec<OffsetPoint>,
    /// A curve through the points at ascending offsets; may be empty.
    pub curve: Vec<CurvePoint>,
    /// Where the curve is highest; absent without one.
    pub highest: Option<CurveEnd>,
    /// Where it is lowest.
    pub lowest: Option<CurveEnd>,
}

/// Where a curve over the offset is highest or lowest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveEnd {
    /// Offset (rad, [0, 2π)).
    pub offset: f64,
    /// Its 95 % interval (rad), which may pass zero or a whole turn.
    pub offset_95: [f64; 2],
    /// The curve there (–).
    pub change: f64,
}

/// The change at one offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetPoint {
    /// Offset (rad, [0, 2π)).
    pub offset: f64,
    /// Change relative to the compared run (–).
    pub change: Statistic,
}

/// The curve at one offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Offset (rad, [0, 2π]).
    pub offset: f64,
    /// Most probable change (–).
    pub mean: f64,
    /// Where it lies with 95 % (–).
    pub band_95: [f64; 2],
}

/// What the rows of a figure run along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Along {
    /// Label of the axis, with its unit.
    pub label: &'static str,
    /// The unit alone.
    pub unit: &'static str,
}

impl Along {
    /// Time.
    pub const TIME: Self = Self { label: "time (s)", unit: "s" };
}

/// Signals over time or a length, one row of axes below the other.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackFigure {
    /// What the rows run along: time, if it is not said otherwise.
    pub along: Along,
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What to look for.
    pub caption: String,
    /// The rows.
    pub rows: Vec<TrackRow>,
    /// An instant to mark (s), such as that at which the synchronisation starts.
    pub mark: Option<f64>,
}

/// One row of signals.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackRow {
    /// What it shows, with its unit; that of angles is the degree.
    pub label: String,
    /// Whether the values are angles (rad), shown about the first line's mean direction.
    pub is_angle: bool,
    /// The signals.
    pub lines: Vec<TrackLine>,
}

/// One signal.
#[derive(Clone, Debug, PartialEq)]
pub struct TrackLine {
    /// Name in the legend.
    pub name: String,
    /// Its colour: 0 is that of the run which others compare with.
    pub colour: usize,
    /// Times (s), or places along the axis of the figure in its unit.
    pub times: Vec<f64>,
    /// Values (unit of the row; rad for angles), as many.
    pub values: Vec<f64>,
    /// Half width of a band about the line (unit of the values), as many; none is drawn where empty.
    pub band: Vec<f64>,
}

/// Amplitude over frequency, cases overlaid.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumFigure {
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What it shows, with its unit.
    pub label: String,
    /// Excitation frequency (Hz), in the figure's middle.
    pub excitation_frequency: f64,
    /// The spectra.
    pub lines: Vec<SpectrumLine>,
}

/// One spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumLine {
    /// Name in the legend.
    pub name: String,
    /// Its colour: 0 is that of the run which others compare with.
    pub colour: usize,
    /// Distance of its frequencies, the first at zero (Hz).
    pub frequency_step: f64,
    /// Values (unit of the figure).
    pub values: Vec<f64>,
}

impl SpectrumLine {
    /// Highest frequency that it holds (Hz).
    pub fn last_frequency(&self) -> f64 {
        self.frequency_step * self.values.len().saturating_sub(1) as f64
    }
}

/// Power spectral densities on a logarithmic scale, one pair of axes below the other.
#[derive(Clone, Debug, PartialEq)]
pub struct DensityFigure {
    /// Name of the figure's files.
    pub name: String,
    /// Title.
    pub title: String,
    /// What to look for.
    pub caption: String,
    /// Lowest frequency that is shown (Hz), on a logarithmic axis; a linear one from zero where absent.
    pub lowest_frequency: Option<f64>,
    /// Highest frequency that is shown (Hz).
    pub highest_frequency: f64,
    /// Frequencies to mark (Hz), each with its name, which may be empty.
    pub marks: Vec<(f64, String)>,
    /// Frequencies to shade between (Hz).
    pub band: Option<[f64; 2]>,
    /// The rows.
    pub rows: Vec<DensityRow>,
}

/// One pair of axes of densities.
#[derive(Clone, Debug, PartialEq)]
pub struct DensityRow {
    /// What it shows, with its unit.
    pub label: String,
    /// The spectra.
    pub lines: Vec<SpectrumLine>,
}

/// Signals and their spectra under one heading; what is empty is left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signals {
    /// The heading.
    pub title: String,
    /// What stands below it.
    pub lead: String,
    /// What is seen over a rotor's disc.
    pub discs: Vec<DiscFigure>,
    /// Quantities over two others.
    pub maps: Vec<MapFigure>,
    /// Surfaces in space.
    pub surfaces: Vec<SurfaceFigure>,
    /// Quantities over one other.
    pub curves: Vec<CurveFigure>,
    /// Signals over time.
    pub tracks: Vec<TrackFigure>,
    /// Their densities over frequency.
    pub densities: Vec<DensityFigure>,
    /// What must be said below, on the page of a study, such as why something is not shown.
    pub notes: Vec<String>,
}

/// The wake at one phase of the excitation, from above, and the centre lines of all cases.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceFigure {
    /// Rotor diameter (m).
    pub diameter: f64,
    /// Free-stream speed at hub height (m/s).
    pub free_stream: f64,
    /// The rotors.
    pub rotors: Vec<SliceRotor>,
    /// Cases whose velocity is shown.
    pub planes: Vec<SlicePanel>,
    /// Cases of which the centre line is shown.
    pub centre_lines: Vec<CentreLine>,
    /// Which phase it is, in words, such as `t = 0 Te`.
    pub phase: String,
}

/// A rotor from above.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceRotor {
    /// Name of its turbine.
    pub name: String,
    /// Its hub (m, farm frame).
    pub hub: [f64; 3],
    /// Its diameter (m).
    pub diameter: f64,
    /// Turn of its nacelle from facing the wind, counter-clockwise seen from above (rad).
    pub yaw: f64,
}

/// One case from above.
#[derive(Clone, Debug, PartialEq)]
pub struct SlicePanel {
    /// Title.
    pub title: String,
    /// Its colour.
    pub colour: usize,
    /// Horizontal plane of mean velocity at the phase.
    pub plane: Plane,
    /// Its centre line: x and y (m); may be empty.
    pub centre_line: Vec<[f64; 2]>,
}

/// One case's centre line.
#[derive(Clone, Debug, PartialEq)]
pub struct CentreLine {
    /// Name in the legend.
    pub name: String,
    /// Its colour.
    pub colour: usize,
    /// x and y (m).
    pub points: Vec<[f64; 2]>,
}

/// Deficits over the distance from the wake's own centre, at several distances downstream.
#[derive(Clone, Debug, PartialEq)]
pub struct DeficitFigure {
    /// Rotor diameter (m).
    pub diameter: f64,
    /// Free-stream speed at hub height (m/s).
    pub free_stream: f64,
    /// A panel for each distance.
    pub panels: Vec<DeficitPanel>,
}

/// Deficits at one distance.
#[derive(Clone, Debug, PartialEq)]
pub struct DeficitPanel {
    /// Title, such as `2 D behind T2`.
    pub title: String,
    /// The cases.
    pub lines: Vec<DeficitLine>,
}

/// One case's deficit.
#[derive(Clone, Debug, PartialEq)]
pub struct DeficitLine {
    /// Name in the legend.
    pub name: String,
    /// Its colour.
    pub colour: usize,
    /// Distance from the centre (m, positive to the left).
    pub offsets: Vec<f64>,
    /// Deficit (m/s), as many.
    pub deficits: Vec<f64>,
}

/// Every figure of `signals`, in the order of a page.
pub(crate) fn of_signals(signals: &Signals) -> Vec<Figure> {
    let densities = signals.densities.iter().filter_map(densities::densities);
    let discs = signals.discs.iter().filter_map(discs::discs);
    let maps = signals.maps.iter().filter_map(maps::maps);
    let surfaces = signals.surfaces.iter().filter_map(surfaces::surfaces);
    let curves = signals.curves.iter().filter_map(curves::curves);
    let discs = discs.chain(maps).chain(surfaces).chain(curves);
    discs.chain(signals.tracks.iter().filter_map(tracks::tracks)).chain(densities).collect()
}

/// Every figure that `records` allow, in the order of a page.
pub(crate) fn all(records: &Synchronisation) -> Vec<Figure> {
    let mut figures = Vec::new();
    figures.extend(records.tracks.iter().filter_map(tracks::tracks));
    figures.extend(records.offsets.iter().filter_map(offsets::offsets));
    figures.extend(records.spectra.iter().filter_map(spectra::spectra));
    figures.extend(records.slices.as_ref().and_then(slices::slices));
    figures.extend(records.deficits.as_ref().and_then(deficits::deficits));
    figures
}
