//! `modes`: proper orthogonal modes of a plane's instants, and its spectral modes over frequency.

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, DIAMETER, FIELD, FROM, HUB, LENGTHS, TURBINE, WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Fields, Instants, conditions, refused};
use analysis::modes::{ModesError, Pod, Snapshots, Spod, SpodSettings, frequency_name, pod, spod};
use basis::Sense;
use basis::records::Field;
use formats::FileError;
use formats::fields::FieldFile;
use report::text_table::{Column, TextTable};
use report::{DensityFigure, DensityRow, Signals, SpectrumLine};
use serde_json::json;
use std::cell::RefCell;
use std::ops::Range;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "modes",
    about: "Proper orthogonal modes of a plane at instants and spectral ones over frequency, by blocks, with the frequencies that are the helix's and the rotor's named",
    of: Of::Run("Folder of a run, or a file of fields"),
    settings: &[
        FIELD, TURBINE, BLOCK, OVERLAP, MODES, FROM, AZIMUTHS, DIAMETER, WIND_SPEED, HUB, LENGTHS, ZEROS,
        FIGURES,
    ],
    run,
};

const BLOCK: AnalysisSetting = settings::setting(
    "block",
    "N",
    Takes::Number,
    "Instants of a block; a quarter of all when left out",
);
const OVERLAP: AnalysisSetting = settings::setting(
    "overlap",
    "N",
    Takes::Number,
    "Instants that blocks share; half a block when left out",
);
const MODES: AnalysisSetting =
    settings::setting("modes", "N", Takes::Number, "Modes that are listed; 10 when left out");
/// By how much instants may lie away from even spacing (intervals).
const UNEVEN: f64 = 0.01;
/// Peaks of the spectrum that are listed (–).
const N_PEAKS: usize = 8;

/// Instants as modes are made of: all components of a point one after another.
struct Read {
    inner: RefCell<(FieldFile, Field)>,
    places: Range<usize>,
    n_points: usize,
}

impl Snapshots for Read {
    type Error = FileError;

    fn n_instants(&self) -> usize {
        self.places.len()
    }

    fn n_values(&self) -> usize {
        3 * self.n_points
    }

    fn read(&self, range: Range<usize>, values: &mut Vec<f64>) -> Result<(), FileError> {
        values.clear();
        let (file, field) = &mut *self.inner.borrow_mut();
        for index in self.places.clone() {
            file.read(index, field)?;
            values.extend(range.clone().map(|place| {
                f64::from(field.velocity[place / self.n_points][place % self.n_points])
            }));
        }
        Ok(())
    }
}

/// What was found.
struct Found {
    conditions: String,
    n_instants: usize,
    span: [f64; 2],
    rates: Option<(f64, Option<(f64, Sense)>)>,
    pod: Pod,
    spod: Spod,
    step: f64,
    n_listed: usize,
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let instants = Fields::instants(request)?;
    let interval = interval(&instants)?;
    let times = instants.times();
    let span = [times[0], times[times.len() - 1]];
    let n = times.len();
    let rates = instants.angles.as_ref().and_then(|angles| angles.rates(span));
    let path = instants.file.path().to_owned();
    let conditions = conditions(&instants.setting);
    // Energies per area: the mean over all points.
    let weight = 1.0 / instants.file.grid().len() as f64;
    let n_points = instants.file.grid().len();
    let field = instants.file.empty();
    let Instants { file, places, .. } = instants;
    let read = Read { inner: RefCell::new((file, field)), places, n_points };
    let n_block = settings::whole(request, &BLOCK, 4, (n / 4).max(4))?;
    let n_overlap = settings::whole(request, &OVERLAP, 0, n_block / 2)?;
    let n_listed = settings::whole(request, &MODES, 1, 10)?;
    let wrong = |error: ModesError<FileError>| match error {
        ModesError::Read(error) => PostprocessingError::File(error),
        error => refused(
            &path,
            error.to_string(),
            "ask for other --block or --overlap, or keep more instants",
        ),
    };
    let pod = pod(&read, weight, 2).map_err(wrong)?;
    let settings = SpodSettings { interval, n_block, n_overlap, n_modes: 1, at: Vec::new() };
    let spod = spod(&read, weight, &settings).map_err(wrong)?;
    let step = 1.0 / (interval * n_block as f64);
    let found = Found { conditions, n_instants: n, span, rates, pod, spod, step, n_listed };
    let mut remarks = Vec::new();
    if found.pod.n_masked > 0 {
        remarks.push(format!(
            "{} of {} values have holes at some instant, and play no part",
            found.pod.n_masked,
            3 * n_points
        ));
    }
    remarks.extend(drawn(request, &[signals(&found)])?);
    Ok(Answer { text: text(&found, request.width()), json: json(&found), remarks })
}

/// Time between instants, which must be even (s).
fn interval(instants: &Instants) -> Result<f64, PostprocessingError> {
    let times = instants.times();
    let path = instants.file.path();
    if times.len() < 8 {
        let problem = format!("has {} instants, too few for modes", times.len());
        return Err(refused(path, problem, "keep 8 instants at least"));
    }
    let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let off = |(index, time): (usize, &f64)| {
        (time - times[0] - index as f64 * interval).abs() > UNEVEN * interval
    };
    match times.iter().enumerate().find(|pair| off(*pair)) {
        Some((index, time)) => {
            let problem = format!("has uneven instants: number {index} is at {time} s");
            Err(refused(path, problem, "keep instants at even intervals"))
        }
        None => Ok(interval),
    }
}

/// Places of the peaks of the first mode's energy, the strongest first.
fn peaks(found: &Found) -> Vec<usize> {
    let energy = |place: usize| found.spod.energies[place][0];
    let last = found.spod.energies.len() - 1;
    let is_peak = |place: &usize| {
        let above = *place == last || energy(*place) > energy(place + 1);
        energy(*place) > energy(place - 1) && above
    };
    let mut peaks: Vec<usize> = (1..=last).filter(is_peak).collect();
    peaks.sort_by(|a, b| energy(*b).total_cmp(&energy(*a)));
    peaks.truncate(N_PEAKS);
    peaks
}

/// What the frequency at `place` of the spectrum is.
fn name(found: &Found, place: usize) -> String {
    let helix = found.rates.and_then(|(_, helix)| helix).map(|(rate, _)| rate);
    let rotor = found.rates.map(|(rotor, _)| rotor);
    let frequency = found.spod.frequencies[place];
    frequency_name(frequency, helix, rotor, 0.75 * found.step).unwrap_or_default()
}

fn text(found: &Found, width: usize) -> String {
    let mut text = format!(
        "{}\n{} instants, {:.1} to {:.1} s; {} blocks\n",
        found.conditions, found.n_instants, found.span[0], found.span[1], found.spod.n_blocks
    );
    let total: f64 = found.pod.energies.iter().sum();
    let mut table = TextTable::new(
        [Column::number("mode")],
        ["energy m²/s²", "share %", "all so far %"].map(Column::number),
    );
    let mut sum = 0.0;
    for (mode, energy) in found.pod.energies.iter().enumerate().take(found.n_listed) {
        sum += energy;
        table.row([
            (mode + 1).to_string(),
            format!("{energy:.5}"),
            format!("{:.2}", 100.0 * energy / total),
            format!("{:.2}", 100.0 * sum / total),
        ]);
    }
    text += &table.fitted(width);
    let headings = ["first mode m²/s²/Hz", "its share %"].map(Column::number);
    let keys = [Column::number("frequency Hz"), Column::words("which is")];
    let mut table = TextTable::new(keys, headings);
    for place in peaks(found) {
        let energies = &found.spod.energies[place];
        table.row([
            format!("{:.4}", found.spod.frequencies[place]),
            name(found, place),
            format!("{:.5}", energies[0]),
            format!("{:.1}", 100.0 * energies[0] / energies.iter().sum::<f64>()),
        ]);
    }
    text += &table.fitted(width);
    text + "energies: of all three components, the mean over the points; f_e: excitation, f_r: rotor\n"
}

fn json(found: &Found) -> serde_json::Value {
    let names: Vec<serde_json::Value> = peaks(found)
        .into_iter()
        .map(|place| {
            json!({ "frequency_hz": found.spod.frequencies[place], "is": name(found, place) })
        })
        .collect();
    json!({
        "conditions": found.conditions,
        "n_instants": found.n_instants,
        "span_s": found.span,
        "n_blocks": found.spod.n_blocks,
        "masked_values": found.pod.n_masked,
        "pod_energies_m2_s2": found.pod.energies,
        "pod_coefficients_m_s": found.pod.coefficients,
        "frequencies_hz": found.spod.frequencies,
        "spod_energies_m2_s2_hz": found.spod.energies,
        "peaks": names,
    })
}

fn signals(found: &Found) -> Signals {
    let line = |rank: usize| SpectrumLine {
        name: format!("mode {}", rank + 1),
        colour: rank + 1,
        frequency_step: found.step,
        values: found.spod.energies.iter().map(|energies| energies[rank].max(1e-30)).collect(),
    };
    let n_lines = found.spod.n_blocks.min(3);
    let row = DensityRow {
        label: "energy ((m/s)²/Hz)".to_owned(),
        lines: (0..n_lines).map(line).collect(),
    };
    let marks = peaks(found).into_iter().take(4);
    let marks = marks.map(|place| (found.spod.frequencies[place], name(found, place)));
    let figure = DensityFigure {
        name: "modes-over-frequency".to_owned(),
        title: "Spectral modes".to_owned(),
        caption: format!(
            "Energy of the strongest modes at each frequency, of {} blocks. {}; {} instants.",
            found.spod.n_blocks, found.conditions, found.n_instants
        ),
        lowest_frequency: None,
        highest_frequency: found.spod.frequencies[found.spod.frequencies.len() - 1],
        marks: marks.filter(|(_, name)| !name.is_empty()).collect(),
        band: None,
        rows: vec![row],
    };
    Signals { title: "Modes".to_owned(), densities: vec![figure], ..Signals::default() }
}
