//! `particles`: measured particles brought onto a grid, as fields that the other analyses take.

use super::{Analysis, AnalysisSetting, Answer, Of, Request, Takes};
use crate::PostprocessingError;
use crate::wake_fields::settings::{self, DIAMETER, HUB, LENGTHS, WIND_SPEED};
use crate::wake_fields::{conditions, refused};
use analysis::particles::{Binned, Binner, Cells, MedianTest, Taken, is_beyond, outliers};
use basis::records::{FieldSetting, Moments, PhaseAverages, PhaseBin};
use formats::fields::FoundSetting;
use formats::records::write_phase_averages;
use formats::tracks::{Seen, each_particle};
use serde_json::json;
use std::f64::consts::TAU;
use std::path::Path;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "particles",
    about: "Particles with their velocities, as tomographic measurements give them, averaged in cells with Gaussian weights: means, slopes, stresses, counts and standard errors, outliers refused, in a file that the other analyses of fields take",
    of: Of::Run("File of particles: CSV, Tecplot's text (.dat) or NetCDF"),
    settings: &[CELL, OVERLAP, BOUNDS, LEAST, GATE, OUT, DIAMETER, WIND_SPEED, HUB, LENGTHS],
    run,
};

const CELL: AnalysisSetting =
    settings::setting("cell", "M", Takes::Number, "Edge of a cell (m); 0.04 when left out");
const OVERLAP: AnalysisSetting = settings::setting(
    "overlap",
    "SHARE",
    Takes::Number,
    "Share of its length that a cell has with the next; 0.75 when left out",
);
const BOUNDS: AnalysisSetting = settings::setting(
    "bounds",
    "X,X,Y,Y,Z,Z",
    Takes::Text,
    "Least and greatest middles of cells along x, y, z (m); where particles are when left out",
);
const LEAST: AnalysisSetting = settings::setting(
    "least",
    "N",
    Takes::Number,
    "Fewest particles of a cell; with fewer it is masked; 10 when left out",
);
const GATE: AnalysisSetting = settings::setting(
    "gate",
    "DEVIATIONS",
    Takes::Number,
    "Standard deviations of its cell beyond which a particle is refused; 4 when left out",
);
const OUT: AnalysisSetting = settings::setting(
    "out",
    "FILE",
    Takes::Text,
    "NetCDF file to write the fields to; none when left out",
);
/// Most memory of the cells (bytes).
const MOST_MEMORY: u64 = 8 << 30;
/// Fluctuation that is no fault, of the median test and of a gate, over the free stream (–).
const NOISE: f64 = 0.01;

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let path = request.run();
    let setting = settings::of_fields(request, path, &FoundSetting::default())?;
    let lengths = settings::lengths(request);
    let size = settings::positive(request, &CELL, 0.04)?;
    let overlap = request.number(OVERLAP.name).unwrap_or(0.75);
    let least = settings::whole(request, &LEAST, 1, 10)? as u32;
    let factor = settings::positive(request, &GATE, 4.0)?;
    let bounds = match request.text(BOUNDS.name) {
        Some(text) => six(text)?,
        None => extent(path, lengths)?,
    };
    let wrong = |error: analysis::particles::ParticleError| {
        refused(path, error.to_string(), "choose other --cell, --overlap or --bounds")
    };
    let cells = Cells::new(bounds, size, overlap, MOST_MEMORY).map_err(wrong)?;
    // Once to know what is usual in each cell, once without what is not.
    let mut first = Binner::new(cells);
    let seen = each_particle(path, lengths, |one| first.add(one.position, one.velocity))?;
    let usual = first.binned(least);
    drop(first);
    let mut second = Binner::new(cells);
    let noise = NOISE * setting.wind_speed;
    each_particle(path, lengths, |one| {
        if is_beyond(&usual, one.position, one.velocity, factor, noise) {
            second.refuse();
        } else {
            second.add(one.position, one.velocity);
        }
    })?;
    let mut binned = second.binned(least);
    let test = MedianTest { threshold: MedianTest::THRESHOLD, noise };
    let odd = outliers(&cells.grid, &binned.mean, &test);
    let n_odd = mask(&mut binned, &odd);
    let mut remarks = vec![format!(
        "{} cells take {:.1} MB while particles are read",
        cells.grid.len(),
        cells.memory() as f64 / 1e6
    )];
    remarks.extend(remarks_of(&seen, &second.taken()));
    if let Some(out) = request.text(OUT.name) {
        write(Path::new(out), &setting, &binned)?;
        remarks.push(format!("fields written to {out}"));
    }
    let numbers = Numbers { taken: second.taken(), seen, n_odd };
    let text = text(&setting, &binned, &numbers);
    Ok(Answer { text, json: json(&binned, &numbers), remarks })
}

/// What became of particles and cells.
struct Numbers {
    taken: Taken,
    seen: Seen,
    n_odd: usize,
}

/// What must be said of what was seen.
fn remarks_of(seen: &Seen, taken: &Taken) -> Vec<String> {
    let mut remarks = Vec::new();
    if seen.has_bare_lengths {
        remarks.push(
            "lengths in the file have no unit: taken as --lengths says, metres when left out"
                .to_owned(),
        );
    }
    if seen.n_times_back > 0 {
        remarks.push(format!(
            "time runs back {} times, as it does where tracks follow one another",
            seen.n_times_back
        ));
    }
    if taken.not_finite > 0 {
        remarks.push(format!(
            "{} particles have a place or velocity that is no number, and are left out",
            taken.not_finite
        ));
    }
    remarks
}

/// Six numbers between commas, as pairs.
fn six(text: &str) -> Result<[[f64; 2]; 3], PostprocessingError> {
    let values: Option<Vec<f64>> = text
        .split(',')
        .map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite()))
        .collect();
    match values.as_deref() {
        Some([a, b, c, d, e, f]) => Ok([[*a, *b], [*c, *d], [*e, *f]]),
        _ => Err(PostprocessingError::Setting {
            setting: BOUNDS.name,
            given: text.to_owned(),
            expected: "six numbers between commas are expected",
            fix: "write such as 0.4,2.5,-0.35,0.35,0.45,1.15",
        }),
    }
}

/// Where particles are.
fn extent(
    path: &Path,
    lengths: formats::fields::Lengths,
) -> Result<[[f64; 2]; 3], PostprocessingError> {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    each_particle(path, lengths, |one| {
        for (bound, value) in bounds.iter_mut().zip(one.position) {
            if value.is_finite() {
                *bound = [bound[0].min(value), bound[1].max(value)];
            }
        }
    })?;
    if bounds.iter().flatten().all(|bound| bound.is_finite()) {
        return Ok(bounds);
    }
    Err(refused(path, "holds no particle", "give a file of particles"))
}

/// Takes the velocity of each cell that is `odd`; gives their number.
fn mask(binned: &mut Binned, odd: &[bool]) -> usize {
    let mut n = 0;
    for index in (0..odd.len()).filter(|index| odd[*index]) {
        let means = binned.mean.iter_mut().chain(&mut binned.stress);
        means.for_each(|values| values[index] = f64::NAN);
        n += 1;
    }
    n
}

/// Writes the fields as one bin of phase, which all instants fall into.
fn write(path: &Path, setting: &FieldSetting, binned: &Binned) -> Result<(), PostprocessingError> {
    let narrow = |values: &Vec<f64>| values.iter().map(|value| *value as f32).collect();
    let is_there = |index: usize| binned.mean[0][index].is_finite();
    let moments = Moments {
        n_samples: (0..binned.n.len())
            .map(|index| if is_there(index) { binned.n[index] } else { 0 })
            .collect(),
        mean: binned.mean.each_ref().map(narrow),
        stress: binned.stress.each_ref().map(narrow),
    };
    let n_instants = u64::from(binned.n.iter().copied().max().unwrap_or(0));
    let head = PhaseAverages {
        grid: binned.cells.grid,
        rotor_width: TAU,
        helix_width: None,
        span: [0.0, 0.0],
        bins: vec![PhaseBin { rotor: 0.0, helix: None, n_instants, n_visits: 1 }],
        all: moments.clone(),
        each: Vec::new(),
    };
    Ok(write_phase_averages(path, setting, &head, |_| moments.clone())?)
}

/// Mean of the sound ones of `values`.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, n) = values.filter(|v| v.is_finite()).fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
    sum / n
}

fn text(setting: &FieldSetting, binned: &Binned, numbers: &Numbers) -> String {
    let Numbers { taken, seen, n_odd } = numbers;
    let [n_x, n_y, n_z] = binned.cells.grid.n_points;
    let error = mean(binned.error[0].iter().copied()) / setting.wind_speed;
    format!(
        "{}\n{} particles: {} in cells, {} outside, {} refused as outliers, {} without numbers\n\
         {n_x} × {n_y} × {n_z} cells of {} m, {} m apart: {} masked for too few particles, {} as outliers by the universal median\n\
         {:.0} particles a cell on the average, as good as {:.0} of equal weight; standard error of u {:.3} % of the free stream\n",
        conditions(setting),
        seen.n,
        taken.kept,
        taken.outside,
        taken.outliers,
        taken.not_finite,
        binned.cells.size,
        binned.cells.grid.spacing[0],
        binned.n_masked,
        n_odd,
        mean(binned.n.iter().map(|n| f64::from(*n))),
        mean(binned.effective.iter().copied()),
        100.0 * error
    )
}

fn json(binned: &Binned, numbers: &Numbers) -> serde_json::Value {
    let Numbers { taken, seen, n_odd } = numbers;
    json!({
        "particles": {
            "all": seen.n,
            "in_cells": taken.kept,
            "outside": taken.outside,
            "outliers": taken.outliers,
            "without_numbers": taken.not_finite,
            "times_back": seen.n_times_back,
        },
        "cells": {
            "n": binned.cells.grid.n_points,
            "size_m": binned.cells.size,
            "spacing_m": binned.cells.grid.spacing[0],
            "masked": binned.n_masked,
            "outliers": n_odd,
            "with_slopes": binned.slopes.iter().filter(|slopes| slopes[0][0].is_finite()).count(),
        },
        "particles_per_cell": mean(binned.n.iter().map(|n| f64::from(*n))),
        "effective_per_cell": mean(binned.effective.iter().copied()),
        "standard_error_u_m_s": mean(binned.error[0].iter().copied()),
    })
}
