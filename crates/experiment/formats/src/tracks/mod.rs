//! Particles on their way, as tracks of tomographic measurements: CSV, Tecplot's text, NetCDF.
//!
//! Files of any length take the memory of a line, or of a part. Lengths come in metres, velocities in metres
//! a second; what is not a number is handed on as such, to be counted by who takes it.

mod columns;
mod netcdf;

pub(crate) use columns::{Columns, Role};

use crate::FileError;
use crate::fields::Lengths;
use crate::table::csv;
use crate::tecplot::{Item, TecplotReader};
use std::path::Path;

const WHAT: &str = "particles with their velocities";

/// A particle at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Instant (s); none where the file tells none.
    pub time: Option<f64>,
    /// Place (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
}

/// What was seen on the way through a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seen {
    /// Particles (–).
    pub n: u64,
    /// How often the time of a particle was less than that of the one before (–).
    pub n_times_back: u64,
    /// Particles whose time is not a number, where the file tells times (–).
    pub n_times_missing: u64,
    /// Least and greatest time (s); none where the file tells none.
    pub span: Option<[f64; 2]>,
    /// Whether lengths have no unit in the file.
    pub has_bare_lengths: bool,
}

/// Hands `take` all particles in the file at `path`, in its order: columns or variables x, y, z, u, v, w and,
/// where there is one, a time. Lengths without a unit are in `lengths`.
///
/// # Errors
/// [`FileError::System`] when it cannot be read; [`FileError::Content`] names line or variable, what was
/// expected and the fix: a column that is missing, units that differ, a row cut short.
pub fn each_particle(
    path: &Path,
    lengths: Lengths,
    take: impl FnMut(&Particle),
) -> Result<Seen, FileError> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
    match extension.as_str() {
        "nc" | "nc4" | "cdf" => netcdf::each(path, lengths, take),
        "dat" | "tec" | "plt" => in_tecplot(path, lengths, take),
        _ => in_csv(path, lengths, take),
    }
}

fn in_csv(
    path: &Path,
    lengths: Lengths,
    mut take: impl FnMut(&Particle),
) -> Result<Seen, FileError> {
    let (named, mut rows) = csv::columns(path)?;
    let names = named.iter().map(|column| (column.name.as_str(), column.unit.as_str()));
    let columns = Columns::find(names, lengths)
        .map_err(|(problem, fix)| FileError::content(WHAT, path, problem, fix))?;
    let all: Vec<usize> = (0..named.len()).filter(|place| columns.is_wanted(*place)).collect();
    let mut wanted = vec![0.0; all.len()];
    let mut row = vec![0.0; named.len()];
    let mut counted = Counted::new(&columns);
    while rows.read(path, &named, &all, &mut wanted)? {
        for (place, value) in all.iter().zip(&wanted) {
            row[*place] = *value;
        }
        take(&counted.particle(&columns.particle(&row)));
    }
    Ok(counted.seen)
}

fn in_tecplot(
    path: &Path,
    lengths: Lengths,
    mut take: impl FnMut(&Particle),
) -> Result<Seen, FileError> {
    let mut reader = TecplotReader::open(path, WHAT)?;
    let names = reader.variables().iter().map(|name| (name.as_str(), ""));
    let columns = Columns::find(names, lengths)
        .map_err(|(problem, fix)| FileError::content(WHAT, path, problem, fix))?;
    let n_variables = reader.variables().len();
    let mut counted = Counted::new(&columns);
    let mut time = None;
    loop {
        match reader.next()? {
            Item::End => return Ok(counted.seen),
            Item::Zone(zone) if zone.is_block => {
                return Err(reader.refusal("a zone of particles in BLOCK packing; POINT is read"));
            }
            Item::Zone(zone) => time = zone.time,
            Item::Numbers if reader.numbers.len() != n_variables => {
                let n = reader.numbers.len();
                return Err(reader.refusal(&format!("{n} values under {n_variables} names")));
            }
            Item::Numbers => {
                let mut particle = columns.particle(&reader.numbers);
                particle.time = particle.time.or(time);
                take(&counted.particle(&particle));
            }
        }
    }
}

/// Counts what goes by.
struct Counted {
    seen: Seen,
    latest: f64,
}

impl Counted {
    fn new(columns: &Columns) -> Self {
        let seen = Seen { has_bare_lengths: columns.has_bare_lengths(), ..Seen::default() };
        Self { seen, latest: f64::NEG_INFINITY }
    }

    fn particle(&mut self, particle: &Particle) -> Particle {
        self.seen.n += 1;
        match particle.time {
            Some(time) if time.is_finite() => {
                self.seen.n_times_back += u64::from(time < self.latest);
                self.latest = time;
                let [first, last] = self.seen.span.unwrap_or([time, time]);
                self.seen.span = Some([first.min(time), last.max(time)]);
            }
            Some(_) => self.seen.n_times_missing += 1,
            None => {}
        }
        *particle
    }
}

#[cfg(test)]
mod tests;
