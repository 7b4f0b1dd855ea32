//! `particles`: measured particles brought onto a grid, as fields that the other analyses take.

mod phases;

use super::{Analysis, AnalysisSetting, Answer, Of, Request, Takes};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, HUB, LENGTHS, WIDTH, WIND_SPEED,
};
use crate::wake_fields::{conditions, refused};
use analysis::grids::widened;
use analysis::particles::{
    BinSettings, Binned, Binner, MedianTest, Order, Particle, Screen, ScreenSettings, Screened,
    outliers,
};
use basis::records::FieldSetting;
use formats::fields::FoundSetting;
use formats::tracks::{Seen, each_particle};
use phases::{By, Phases};
use report::text_table::{Column, TextTable};
use serde_json::json;
use std::path::Path;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "particles",
    about: "Particles with their velocities, as tomographic measurements give them, averaged in cells with Gaussian weights: means, slopes, stresses, counts and standard errors, outliers refused, all at once and by phase of rotor and helix, in a file that the other analyses of fields take",
    of: Of::Run("File of particles: CSV, Tecplot's text (.dat) or NetCDF"),
    settings: &[
        CELL, OVERLAP, BOUNDS, ORDER, LEAST, LIMIT, AZIMUTHS, BINS, CYCLES, WIDTH, OUT, DIAMETER,
        WIND_SPEED, HUB, LENGTHS,
    ],
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
const ORDER: AnalysisSetting = AnalysisSetting {
    name: "order",
    value: "ORDER",
    takes: Takes::Choice(&[
        ("constant", "Weighted means alone"),
        ("linear", "With slopes"),
        ("quadratic", "Curved: means without the bias of curvature"),
    ]),
    about: "Highest order of the polynomial that is fitted in a cell, lower where it has too few particles; linear when left out",
};
const LEAST: AnalysisSetting = settings::setting(
    "least",
    "N",
    Takes::Number,
    "Fewest particles of a cell; with fewer it is masked; 10 when left out",
);
const LIMIT: AnalysisSetting = settings::setting(
    "limit",
    "RATIO",
    Takes::Number,
    "Distance from the median of the particles around, over their median distance from it, beyond which one is refused; 5 when left out",
);
const OUT: AnalysisSetting = settings::setting(
    "out",
    "FILE",
    Takes::Text,
    "NetCDF file to write the fields to; none when left out",
);
/// Most memory of the cells (bytes).
const MOST_MEMORY: u64 = 8 << 30;
/// Fluctuation that is no fault, of the median tests, over the free stream (–).
const NOISE: f64 = 0.01;

/// Shares of all particles after which means are kept, to see how they converge (–).
const STAGES: [f64; 3] = [1.0 / 16.0, 0.25, 0.5];

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let path = request.run();
    let setting = settings::of_fields(request, path, &FoundSetting::default())?;
    let bins = bins(request)?;
    let noise = NOISE * setting.wind_speed;
    let limit = settings::positive(request, &LIMIT, ScreenSettings::usual(noise).limit)?;
    let (screened, seen) =
        screened(request, &bins, ScreenSettings { limit, ..ScreenSettings::usual(noise) })?;
    let mut binned = binned(request, bins, &screened, seen.n)?;
    let n_odd = mask(&mut binned, noise);
    let mut remarks = vec![format!(
        "{} cells take {:.1} MB while particles are read",
        bins.grid.len(),
        bins.memory() as f64 / 1e6
    )];
    remarks.extend(remarks_of(&seen, &binned));
    let phases = Phases::of(request, &seen)?;
    if let Some(out) = request.text(OUT.name) {
        let by = By { request, bins, screened: &screened, noise };
        remarks.extend(phases::write(Path::new(out), &setting, &binned, &phases, &by)?);
        remarks.push(format!("fields written to {out}"));
    }
    let numbers = Numbers { seen, n_odd, phases };
    let text = text(&setting, &binned, &numbers, request.width());
    Ok(Answer { text, json: json(&binned, &numbers), remarks })
}

/// The cells that `request` asks for.
fn bins(request: &Request) -> Result<BinSettings, PostprocessingError> {
    let size = settings::positive(request, &CELL, 0.04)?;
    let overlap = request.number(OVERLAP.name).unwrap_or(0.75);
    let bounds = match request.text(BOUNDS.name) {
        Some(text) => six(text)?,
        None => extent(request.run(), settings::lengths(request))?,
    };
    let longest = bounds.iter().map(|[from, to]| to - from).fold(0.0, f64::max);
    if size > longest {
        let problem = format!("has particles over {longest:.3} m, less than a cell of {size} m");
        let fix = "give --cell and --bounds in metres, such as --cell 0.04";
        return Err(refused(request.run(), problem, fix));
    }
    let order = match request.text(ORDER.name) {
        Some("constant") => Order::Constant,
        Some("quadratic") => Order::Quadratic,
        _ => Order::Linear,
    };
    let spacing = [size * (1.0 - overlap); 3];
    let made = BinSettings::over(bounds, spacing, overlap, order, MOST_MEMORY);
    let made = made.map_err(|error| {
        refused(request.run(), error.to_string(), "choose other --cell, --overlap or --bounds")
    })?;
    Ok(BinSettings { fewest: settings::whole(request, &LEAST, 1, 10)? as u32, ..made })
}

/// A first look through the file, by which outliers are told, and what was seen.
fn screened(
    request: &Request,
    bins: &BinSettings,
    how: ScreenSettings,
) -> Result<(Screened, Seen), PostprocessingError> {
    let wrong = |error: analysis::particles::ParticlesError| {
        refused(request.run(), error.to_string(), "choose another --limit")
    };
    let mut screen = Screen::new(&bins.grid, bins.size, how).map_err(wrong)?;
    let seen = each_particle(request.run(), settings::lengths(request), |one| {
        screen.look(&Particle { position: one.position, velocity: one.velocity });
    })?;
    Ok((screen.screened(), seen))
}

/// The `n` particles in `bins`, without those that `screened` takes for outliers.
fn binned(
    request: &Request,
    bins: BinSettings,
    screened: &Screened,
    n: u64,
) -> Result<Binned, PostprocessingError> {
    let mut binner = Binner::new(bins);
    let mut stages = STAGES.iter().map(|share| (share * n as f64) as u64).peekable();
    let mut so_far = 0;
    each_particle(request.run(), settings::lengths(request), |one| {
        let particle = Particle { position: one.position, velocity: one.velocity };
        if screened.is_outlier(&particle) {
            binner.count_outliers(1);
        } else {
            binner.add(&particle);
        }
        so_far += 1;
        if stages.next_if_eq(&so_far).is_some() {
            binner.keep_stage();
        }
    })?;
    Ok(binner.binned())
}

/// What became of particles and cells, beside what the cells know.
struct Numbers {
    seen: Seen,
    n_odd: usize,
    phases: Phases,
}

/// What must be said of what was seen.
fn remarks_of(seen: &Seen, binned: &Binned) -> Vec<String> {
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
    if binned.tally.n_holes > 0 {
        remarks.push(format!(
            "{} particles have a place or velocity that is no number, and are left out",
            binned.tally.n_holes
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

/// Takes the velocity of each cell that is an outlier among those around it, beyond `noise` (m/s); gives
/// their number.
fn mask(binned: &mut Binned, noise: f64) -> usize {
    let test = MedianTest { threshold: MedianTest::THRESHOLD, noise };
    let means = binned.moments.mean.each_ref().map(|mean| widened(mean));
    let odd = outliers(&binned.grid, &means, &test);
    let mut n = 0;
    for index in (0..odd.len()).filter(|index| odd[*index]) {
        let moments = &mut binned.moments;
        let means = moments.mean.iter_mut().chain(&mut moments.stress).chain(&mut binned.error);
        means.for_each(|values| values[index] = f32::NAN);
        binned.order[index] = None;
        n += 1;
    }
    n
}

/// Root of the mean square of the sound ones of `values`.
fn root_mean_square(values: &[f32]) -> f64 {
    let sound = values.iter().map(|value| f64::from(*value)).filter(|value| value.is_finite());
    let (sum, n) = sound.fold((0.0, 0.0), |(sum, n), value| (sum + value * value, n + 1.0));
    (sum / n).sqrt()
}

fn text(setting: &FieldSetting, binned: &Binned, numbers: &Numbers, width: usize) -> String {
    let (tally, [n_x, n_y, n_z]) = (&binned.tally, binned.grid.n_points);
    let mut text = format!(
        "{}\n{} particles: {} in cells, {} outside, {} refused as outliers, {} without numbers\n\
         {n_x} × {n_y} × {n_z} cells of {:.4} m, {:.4} m apart: {} empty, {} of too few particles, {} outliers by the universal median\n\
         {} cells with a curved fit, {} with slopes, {} with a mean alone; {} particles a cell in the middle of all (median)\n",
        conditions(setting),
        numbers.seen.n,
        tally.n_taken,
        tally.n_outside,
        tally.n_outliers,
        tally.n_holes,
        binned.size[0],
        binned.grid.spacing[0],
        tally.n_empty,
        tally.n_thin,
        numbers.n_odd,
        binned.n_of(Order::Quadratic),
        binned.n_of(Order::Linear),
        binned.n_of(Order::Constant),
        binned.median_samples()
    );
    let headings = ["standard error %", "from the last %"].map(Column::number);
    let mut table = TextTable::new([Column::number("particles")], headings);
    for stage in &binned.convergence {
        let share = |value: f64| format!("{:.3}", 100.0 * value / setting.wind_speed);
        table.row([stage.n_taken.to_string(), share(stage.error), share(stage.change)]);
    }
    text += &table.fitted(width);
    text += &numbers.phases.in_words();
    text + "root mean square over cells and components, over the free stream; particles are taken as independent, which those of one track are not\n"
}

fn json(binned: &Binned, numbers: &Numbers) -> serde_json::Value {
    let tally = &binned.tally;
    let convergence = binned.convergence.iter().map(|stage| {
        json!({
            "particles": stage.n_taken,
            "standard_error_m_s": stage.error,
            "from_the_last_m_s": stage.change,
        })
    });
    json!({
        "particles": {
            "all": numbers.seen.n,
            "in_cells": tally.n_taken,
            "outside": tally.n_outside,
            "outliers": tally.n_outliers,
            "without_numbers": tally.n_holes,
            "times_back": numbers.seen.n_times_back,
        },
        "cells": {
            "n": binned.grid.n_points,
            "size_m": binned.size,
            "spacing_m": binned.grid.spacing,
            "empty": tally.n_empty,
            "too_few": tally.n_thin,
            "outliers": numbers.n_odd,
            "curved": binned.n_of(Order::Quadratic),
            "with_slopes": binned.n_of(Order::Linear),
            "means_alone": binned.n_of(Order::Constant),
        },
        "phases": numbers.phases.json(),
        "particles_per_cell": binned.median_samples(),
        "standard_error_m_s": binned.error.each_ref().map(|values| root_mean_square(values)),
        "convergence": convergence.collect::<Vec<_>>(),
    })
}
