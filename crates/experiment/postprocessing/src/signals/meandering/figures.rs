//! The figures of one turbine that follows a meandering wake, run by run.

use super::super::{density, line};
use super::{Followed, Meandered, MeanderingNumbers};
use crate::PostprocessingError;
use crate::phase::moments;
use analysis::smooth::smoothed;
use basis::FixedFrame;
use basis::channels::{MEAND_AXES, MEAND_RATE};
use report::{Along, DensityFigure, DensityRow, SpectrumLine, TrackFigure, TrackLine, TrackRow};
use std::f64::consts::TAU;

/// Corner of the low pass for moments over time, over the highest frequency that is followed (–).
const CORNER: f64 = 3.0;
/// Highest frequency of the spectra, over the highest that is followed (–): room for its fifth harmonic.
const SHOWN: f64 = 5.5;
/// One of the fixed frame's components.
type OfFrame = fn(&FixedFrame) -> f64;

/// Meganewton metres of a newton metre, and millihertz of a hertz.
const MEGA: f64 = 1e-6;
const MILLI: f64 = 1e3;
/// Colour of what is true.
const TRUTH: usize = 10;
/// The axes, and what of the fixed frame they are.
const AXES: [OfFrame; 2] = [|moments| moments.tilt, |moments| moments.yaw];

/// The figures of one turbine, run by run.
#[derive(Default)]
pub(super) struct Figures {
    /// Moments of tilt and yaw (MN m) without what is fast.
    loads: [Vec<TrackLine>; 2],
    /// Amplitude error and bias of tilt and yaw (MN m).
    errors: [Vec<TrackLine>; 2],
    biases: [Vec<TrackLine>; 2],
    /// Estimated frequency (mHz).
    frequencies: Vec<TrackLine>,
    /// The true one, where it is known.
    truth: Option<TrackLine>,
    /// Densities of tilt and yaw moment.
    densities: [Vec<SpectrumLine>; 2],
    /// Lowest and highest frequency that is followed in any run (Hz).
    band: Option<[f64; 2]>,
    /// Colours taken: the first is kept for the run that only monitors.
    n_colours: usize,
}

impl Figures {
    /// Adds what became of `run`.
    ///
    /// # Errors
    /// [`PostprocessingError`] for records that lack a channel or cannot be analysed.
    pub(super) fn add(&mut self, run: &Followed) -> Result<(), PostprocessingError> {
        let colour = if run.monitors() {
            0
        } else {
            self.n_colours += 1;
            self.n_colours
        };
        let times = run.times()?;
        let track = |name: &str, colour: usize, values: Vec<f64>| TrackLine {
            name: name.to_owned(),
            colour,
            times: times.to_vec(),
            values,
            band: Vec::new(),
        };
        let [low, high] = run.band();
        let slowly = |values: &[f64]| smoothed(values, run.interval, CORNER * high);
        let all = moments(&run.series, run.turbine)?;
        for (place, (axis, of)) in MEAND_AXES.iter().zip(AXES).enumerate() {
            let moment: Vec<f64> = all.iter().map(|moments| MEGA * of(moments)).collect();
            let slow = slowly(&moment)?;
            self.loads[place].push(track(run.run, colour, slow[run.first..].to_vec()));
            if let Some(found) = density(&moment[run.first..], run.interval, low)? {
                self.densities[place].push(line(run.run, colour, found));
            }
            if run.monitors() {
                continue;
            }
            let mega = |values: &[f64]| values.iter().map(|value| MEGA * value).collect::<Vec<_>>();
            let error = slowly(&mega(&run.amplitude_error(axis)?))?;
            let bias = slowly(&mega(run.own(&axis.offset)?))?;
            self.errors[place].push(track(run.run, colour, error));
            self.biases[place].push(track(run.run, colour, bias));
        }
        let rates = run.own(&MEAND_RATE)?.iter().map(|rate| MILLI * rate / TAU);
        let frequency = slowly(&rates.collect::<Vec<_>>())?;
        if self.truth.is_none()
            && let Some(truth) = run.true_frequency()?
        {
            let truth = truth.iter().map(|frequency| MILLI * frequency).collect();
            self.truth = Some(track("the disk's", TRUTH, truth));
        }
        self.frequencies.push(track(run.run, colour, frequency));
        let [lowest, highest] = self.band.unwrap_or([low, high]);
        self.band = Some([lowest.min(low), highest.max(high)]);
        Ok(())
    }

    /// All of them, for `turbine`.
    pub(super) fn of(self, turbine: &str, numbers: Vec<MeanderingNumbers>) -> Meandered {
        let row = |label: &str, lines: Vec<TrackLine>| TrackRow {
            label: label.to_owned(),
            is_angle: false,
            lines,
        };
        let [tilt, yaw] = self.loads;
        let loads = TrackFigure {
            along: Along::TIME,
            name: format!("meandering-loads-{turbine}"),
            title: format!("Tilt and yaw moment of {turbine}"),
            caption: "Moments of the blades in the fixed frame, without what is faster than three times the highest frequency followed, and \
                      without delay."
                .to_owned(),
            rows: vec![row("tilt (MN m)", tilt), row("yaw (MN m)", yaw)],
            mark: None,
        };
        let [tilt_error, yaw_error] = self.errors;
        let [tilt_bias, yaw_bias] = self.biases;
        let mut rows = vec![
            row("tilt error (MN m)", tilt_error),
            row("yaw error (MN m)", yaw_error),
            row("tilt bias (MN m)", tilt_bias),
            row("yaw bias (MN m)", yaw_bias),
            row("frequency (mHz)", self.frequencies.into_iter().chain(self.truth).collect()),
        ];
        rows.retain(|row| !row.lines.is_empty());
        let tracking = TrackFigure {
            along: Along::TIME,
            name: format!("meandering-tracking-{turbine}"),
            title: format!("Amplitude error, bias and frequency of the load of {turbine}"),
            caption: "Error: target amplitude minus the loop's estimate; bias: the moment's own mean as the loop estimates it. Both, and the \
                      frequency, without what is faster than three times the highest frequency followed."
                .to_owned(),
            rows,
            mark: None,
        };
        let densities = spectra(turbine, self.densities, self.band);
        Meandered {
            turbine: turbine.to_owned(),
            numbers,
            tracks: vec![loads, tracking],
            densities: Vec::from_iter(densities),
        }
    }
}

/// The densities of tilt and yaw moment of `turbine` as a figure with the `band` (Hz) that is followed;
/// nothing where there are none.
fn spectra(
    turbine: &str,
    densities: [Vec<SpectrumLine>; 2],
    band: Option<[f64; 2]>,
) -> Option<DensityFigure> {
    let labels = ["tilt ((MN m)²/Hz)", "yaw ((MN m)²/Hz)"];
    let rows: Vec<DensityRow> = labels
        .into_iter()
        .zip(densities)
        .map(|(label, lines)| DensityRow { label: label.to_owned(), lines })
        .collect();
    let has_lines = rows.iter().any(|row| !row.lines.is_empty());
    has_lines.then(|| DensityFigure {
        name: format!("meandering-spectra-{turbine}"),
        title: format!("Spectra of tilt and yaw moment of {turbine}"),
        caption: "Power spectral densities by Welch's method; the frequencies that the loop may follow are shaded."
            .to_owned(),
        lowest_frequency: None,
        highest_frequency: band.map_or(0.0, |[_, high]| SHOWN * high),
        marks: Vec::new(),
        band,
        rows,
    })
}
