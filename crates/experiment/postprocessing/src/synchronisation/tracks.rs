//! Signals over time and over frequency: estimates beside the truth, and what the rotor makes of its pitch.

use super::{Joined, Synchronised};
use crate::PostprocessingError;
use crate::phase::tells;
use crate::winds;
use analysis::phase::{Band, fixed_frame_moments, narrowband};
use analysis::spectra::amplitude;
use basis::Channel;
use basis::PerBlade;
use basis::channels::{AZIMUTH, BLD_PITCH, BladeChannel, EST_WIND_WAVES, ROOT_MYC, TIME};
use basis::mbc::to_fixed_frame;
use basis::records::Series;
use report::{Along, PhaseRow, SpectrumFigure, SpectrumLine, TrackFigure, TrackLine, TrackRow};

/// Cases that one figure of signals shows at most (–).
const MOST_CASES: usize = 5;

/// How well each run found its phases.
pub(super) fn table(study: &Synchronised) -> Vec<PhaseRow> {
    let rows = study.runs.iter().filter_map(|run| {
        let answer = run.answer.as_ref()?;
        let axis = |axis: &crate::phase::PhaseAxis| report::PhaseNumbers {
            rmse: axis.agreement.rmse,
            bias: axis.agreement.bias,
            spread: axis.agreement.spread,
            locking: axis.agreement.locking,
            coherence: axis.coherence.map(|found| found.coherence),
            phase_error: axis
                .coherence
                .map(|found| [found.phase_error, found.phase_error_half_width_95]),
            amplitude: axis.amplitude,
            true_amplitude: axis.true_amplitude,
        };
        Some(PhaseRow {
            run: run.name.clone(),
            offset: run.offset(),
            tilt: axis(&answer.tilt),
            yaw: axis(&answer.yaw),
            trust: answer.trust,
        })
    });
    rows.collect()
}

/// Estimated and true phases, and the answer to the pitch.
pub(super) fn tracks(study: &Synchronised) -> Result<Vec<TrackFigure>, PostprocessingError> {
    let name = &study.case.turbines[study.turbine].name;
    let mut figures: Vec<TrackFigure> =
        study.runs.iter().filter_map(|run| estimate(study, run)).collect();
    figures.extend(answer(study, name)?);
    Ok(figures)
}

/// Estimated and true wind and phases of `run`, where there is a truth.
fn estimate(study: &Synchronised, run: &Joined) -> Option<TrackFigure> {
    let answer = run.answer.as_ref()?;
    let start = (run.sync.amplitude > 0.0 && run.sync.start > answer.times.first().copied()?)
        .then_some(run.sync.start);
    let mark = (study.case.time.spin_up < run.sync.start).then_some(start).flatten();
    Some(winds::figure(answer, mark))
}

/// Runs that signals are shown of: the monitoring one first, then offsets a quarter turn apart where there
/// are.
fn shown<'a>(study: &'a Synchronised) -> Vec<&'a Joined> {
    let monitoring = study.runs.iter().filter(|run| run.offset().is_none());
    let quarter = |run: &&Joined| {
        run.offset().is_some_and(|offset| {
            let quarters = offset.to_degrees() / 90.0;
            (quarters - quarters.round()).abs() < 1e-6
        })
    };
    monitoring.chain(study.runs.iter().filter(quarter)).take(MOST_CASES).collect()
}

/// Estimated wind, pitch and moment of the tilt axis around the excitation.
fn answer(study: &Synchronised, name: &str) -> Result<Option<TrackFigure>, PostprocessingError> {
    let band = Band::around(study.reference.frequency(), Band::RATIO);
    let mut rows: Vec<TrackRow> =
        ["estimated tilt wind (m/s)", "tilt pitch (deg)", "tilt moment (MN m)"]
            .into_iter()
            .map(|label| TrackRow { label: label.to_owned(), is_angle: false, lines: Vec::new() })
            .collect();
    for (colour, run) in shown(study).into_iter().enumerate() {
        let series = &study.records.runs[run.run].series.read(|channel| tells(name, channel))?;
        let Some((first, times, interval)) = analysed(study, series) else { continue };
        let cut = |channel: &Channel| series.column(&channel.at(name)).map(|c| &c[first..]);
        let [estimated, _] = EST_WIND_WAVES;
        let (Some(wind), Some(azimuth)) = (cut(&estimated.wind), cut(&AZIMUTH)) else {
            continue;
        };
        let of_blades = |channel: BladeChannel| columns(series, name, channel, first);
        let (Some(pitch), Some(moment)) = (of_blades(BLD_PITCH), of_blades(ROOT_MYC)) else {
            continue;
        };
        let tilt_pitch: Vec<f64> = (0..times.len())
            .map(|row| {
                let blades = PerBlade::from_fn(pitch.len(), |blade| pitch[blade][row]);
                to_fixed_frame(azimuth[row], &blades).tilt.to_degrees()
            })
            .collect();
        let moments = fixed_frame_moments(azimuth, &moment)?;
        let tilt_moment: Vec<f64> = moments.iter().map(|moment| 1e-6 * moment.tilt).collect();
        for (row, values) in rows.iter_mut().zip([wind.to_vec(), tilt_pitch, tilt_moment]) {
            let wave = narrowband(&values, interval, band)?.wave;
            let times = times.to_vec();
            let (name, band) = (run.name.clone(), Vec::new());
            row.lines.push(TrackLine { name, colour, times, values: wave, band });
        }
    }
    Ok((!rows[0].lines.is_empty()).then(|| TrackFigure {
        along: Along::TIME,
        name: "answer-to-pitch".into(),
        title: format!("Response of {name} to the incoming helix: tilt, around the excitation frequency"),
        caption: "Pitch in phase with the wind (offset 0°) lowers the load; in opposite phase (180°) it adds load.".into(),
        rows,
        mark: None,
    }))
}

/// Spectra of the tilt moment.
pub(super) fn spectra(study: &Synchronised) -> Result<Vec<SpectrumFigure>, PostprocessingError> {
    let name = &study.case.turbines[study.turbine].name;
    let mut lines = Vec::new();
    for (colour, run) in shown(study).into_iter().enumerate() {
        let series = &study.records.runs[run.run].series.read(|channel| tells(name, channel))?;
        let Some((first, _, interval)) = analysed(study, series) else { continue };
        let Some(azimuth) = series.column(&AZIMUTH.at(name)) else { continue };
        let Some(moment) = columns(series, name, ROOT_MYC, first) else { continue };
        let moments = fixed_frame_moments(&azimuth[first..], &moment)?;
        let tilt: Vec<f64> = moments.iter().map(|moment| 1e-6 * moment.tilt).collect();
        let spectrum = amplitude(&tilt, interval)?;
        lines.push(SpectrumLine {
            name: run.name.clone(),
            colour,
            frequency_step: spectrum.frequency_step,
            values: spectrum.values,
        });
    }
    if lines.is_empty() {
        return Ok(Vec::new());
    }
    Ok(vec![SpectrumFigure {
        name: "tilt-moment-spectra".into(),
        title: format!("Tilt moment of {name} around the helix's frequency"),
        label: "amplitude of the tilt moment (MN m)".into(),
        excitation_frequency: study.reference.frequency(),
        lines,
    }])
}

/// First analysed row, the times from it on, and their distance (s).
fn analysed<'a>(study: &Synchronised, series: &'a Series) -> Option<(usize, &'a [f64], f64)> {
    let times = series.column(&TIME.name)?;
    let first = times.iter().position(|time| *time >= study.case.time.spin_up)?;
    let rest = &times[first..];
    let (begin, end) = (rest.first()?, rest.last()?);
    (rest.len() > 1).then(|| (first, rest, (end - begin) / (rest.len() - 1) as f64))
}

/// One column per blade from row `first` on.
fn columns<'a>(
    series: &'a Series,
    name: &str,
    channel: BladeChannel,
    first: usize,
) -> Option<Vec<&'a [f64]>> {
    let of_blade = |blade: usize| {
        series.column(&channel.of_blade(blade).at(name)).map(|column| &column[first..])
    };
    let columns: Vec<&[f64]> = (1..).map_while(of_blade).collect();
    (columns.len() >= 3).then_some(columns)
}
