//! `phases`: a wake averaged by rotor and helix azimuth, and taken apart into mean, periodic and random
//! parts.

pub(crate) mod figures;

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, MEMORY, TURBINE, WIDTH,
    WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, Wanted, conditions};
use analysis::phases::{Decomposition, decompose, standard_error};
use basis::Sense;
use basis::records::PhaseAverages;
use report::text_table::{Column, TextTable};
use serde_json::json;
use std::path::Path;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "phases",
    about: "A wake averaged by rotor and helix azimuth: samples and standard errors of the bins, stresses of periodic and random fluctuations, and how the width of the bins matters: section 3.2 of van der Hoek et al. (2024)",
    of: Of::Run(
        "Folder of a run, or a file of fields (NetCDF, .vti or a folder of them, Tecplot's text)",
    ),
    settings: &[
        FIELD, TURBINE, BINS, CYCLES, WIDTH, FROM, AZIMUTHS, DIAMETER, WIND_SPEED, HUB, LENGTHS,
        ZEROS, MEMORY, OUT, FIGURES,
    ],
    run,
};

const OUT: AnalysisSetting = settings::setting(
    "out",
    "FILE",
    Takes::Text,
    "NetCDF file to write the averages to, bin by bin, which the other analyses of fields take; none when left out",
);

/// Widths beside the one that is asked for (–).
const WIDTHS: [f64; 4] = [0.5, 1.0, 1.5, 2.25];

/// One width of window.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WidthRow {
    width_deg: f64,
    /// Instants of a bin, on the average (–).
    n_instants: f64,
    /// Standard error of u in a bin over the free stream, instants and visits taken as independent (–).
    errors: [f64; 2],
    /// Root mean square of u in the bins about its mean over the free stream (–).
    periodic: f64,
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let out = request.text(OUT.name).map(Path::new);
    let is_drawn = request.text(FIGURES.name).is_some();
    let found = Averaged::of(request, Wanted::Parts { out, factors: &WIDTHS, is_drawn })?;
    let parts = found.decomposition()?;
    let mut remarks = found.remarks.clone();
    remarks.extend(out.map(|out| format!("averages written to {}", out.display())));
    let widths: Vec<WidthRow> =
        found.compared.iter().map(|one| width_row(one, found.setting.wind_speed)).collect();
    remarks.extend(drawn(request, &[figures::signals(&found, &parts)?])?);
    let sums = summed(&found, &parts);
    let text = text(&found, &sums, &widths, request.width());
    Ok(Answer { text, json: json(&found, &sums, &widths), remarks })
}

/// Root mean squares over all points of the three parts of each normal stress, over the free stream (–).
fn summed(found: &Averaged, parts: &Decomposition) -> [[f64; 3]; 3] {
    let scale = found.setting.wind_speed;
    let mean = |values: &[f64]| {
        let sound: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        (sound.iter().sum::<f64>() / sound.len().max(1) as f64).max(0.0).sqrt() / scale
    };
    std::array::from_fn(|c| {
        [mean(&parts.total[c]), mean(&parts.periodic[c]), mean(&parts.random[c])]
    })
}

/// How samples, errors and periodic part are in `averages` at some points.
fn width_row(averages: &PhaseAverages, scale: f64) -> WidthRow {
    let (mut squares, mut n) = ([0.0; 2], 0_usize);
    for (bin, moments) in averages.bins.iter().zip(&averages.each) {
        for point in 0..averages.grid.len() {
            let errors = [bin.n_instants, bin.n_visits]
                .map(|independent| standard_error(moments, 0, point, independent as f64));
            if errors.iter().all(|error| error.is_finite()) {
                squares[0] += errors[0].powi(2);
                squares[1] += errors[1].powi(2);
                n += 1;
            }
        }
    }
    let parts = decompose(averages);
    let sound: Vec<f64> = parts.periodic[0].iter().copied().filter(|v| v.is_finite()).collect();
    let periodic = sound.iter().sum::<f64>() / sound.len().max(1) as f64;
    let n_instants: u64 = averages.bins.iter().map(|bin| bin.n_instants).sum();
    WidthRow {
        width_deg: averages.helix_width.unwrap_or(0.0).to_degrees(),
        n_instants: n_instants as f64 / averages.bins.len() as f64,
        errors: squares.map(|sum| (sum / n.max(1) as f64).sqrt() / scale),
        periodic: periodic.max(0.0).sqrt() / scale,
    }
}

fn text(found: &Averaged, sums: &[[f64; 3]; 3], widths: &[WidthRow], columns: usize) -> String {
    let mut text = format!("{}\n{}\n", conditions(&found.setting), found.samples());
    if let Some((rotor, helix)) = found.rates {
        text += &match helix {
            Some((helix, sense)) => format!(
                "rotor at {rotor:.4} Hz, {} helix at {helix:.4} Hz: {:.3} revolutions a cycle\n",
                word(sense),
                rotor / helix
            ),
            None => format!("rotor at {rotor:.4} Hz, no helix\n"),
        };
    }
    let headings = ["all %", "periodic %", "random %"].map(Column::number);
    let mut table = TextTable::new([Column::words("component")], headings);
    for (name, row) in ["u", "v", "w"].into_iter().zip(sums) {
        let cells = row.iter().map(|value| format!("{:.2}", 100.0 * value));
        table.row(std::iter::once(name.to_owned()).chain(cells));
    }
    text += &table.fitted(columns);
    text += "root mean square fluctuation over the free stream, over all points; periodic: of the bins' means, less the noise of their samples; random: in the bins\n";
    if !widths.is_empty() {
        let headings = ["instants a bin", "error, instants %", "error, visits %", "periodic u %"]
            .map(Column::number);
        let mut table = TextTable::new([Column::number("width deg")], headings);
        for row in widths {
            table.row([
                format!("{:.0}", row.width_deg),
                format!("{:.1}", row.n_instants),
                format!("{:.3}", 100.0 * row.errors[0]),
                format!("{:.3}", 100.0 * row.errors[1]),
                format!("{:.3}", 100.0 * row.periodic),
            ]);
        }
        text += &table.fitted(columns);
        text += "error: standard error of u in a bin over the free stream, instants of a bin taken as independent, or only its visits; a wider window has more samples, and blurs what is periodic\n";
    }
    text
}

fn word(sense: Sense) -> String {
    sense.to_string()
}

fn json(found: &Averaged, sums: &[[f64; 3]; 3], widths: &[WidthRow]) -> serde_json::Value {
    let bins = found.head.bins.iter().map(|bin| {
        json!({
            "rotor_azimuth_deg": bin.rotor.to_degrees(),
            "helix_azimuth_deg": bin.helix.map(f64::to_degrees),
            "n_instants": bin.n_instants,
            "n_visits": bin.n_visits,
        })
    });
    let components = ["u", "v", "w"].into_iter().zip(sums).map(|(name, row)| {
        json!({ "component": name, "all": row[0], "periodic": row[1], "random": row[2] })
    });
    let widths = widths.iter().map(|row| {
        json!({
            "width_deg": row.width_deg,
            "instants_per_bin": row.n_instants,
            "error_of_instants": row.errors[0],
            "error_of_visits": row.errors[1],
            "periodic_u": row.periodic,
        })
    });
    let helix = found.rates.and_then(|(_, helix)| helix);
    json!({
        "setting": setting_json(found),
        "points": found.grid().n_points,
        "rotor_hz": found.rates.map(|(rotor, _)| rotor),
        "helix_hz": helix.map(|(rate, _)| rate),
        "helix_sense": helix.map(|(_, sense)| word(sense)),
        "helix_width_deg": found.head.helix_width.map(f64::to_degrees),
        "bins": bins.collect::<Vec<_>>(),
        "fluctuations_over_free_stream": components.collect::<Vec<_>>(),
        "widths": widths.collect::<Vec<_>>(),
    })
}

/// What fields were taken of, for programs.
pub(super) fn setting_json(found: &Averaged) -> serde_json::Value {
    let setting = &found.setting;
    json!({
        "name": setting.name,
        "wind_speed_m_s": setting.wind_speed,
        "turbulence_intensity": setting.turbulence_intensity,
        "diameter_m": setting.diameter,
        "hub_m": setting.hub,
        "span_s": found.head.span,
    })
}
