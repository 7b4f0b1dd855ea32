//! Fields in Tecplot's text: a zone for each instant.

use super::{Lengths, WHAT};
use crate::FileError;
use crate::netcdf::even;
use crate::tecplot::{Item, TecplotReader, Zone};
use crate::tracks::{Columns, Role};
use basis::records::Grid;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Zones of one grid. They are read one after the other; a step back begins anew.
pub(super) struct TecplotFields {
    path: PathBuf,
    lengths: Lengths,
    grid: Grid,
    times: Vec<Option<f64>>,
    reader: Option<TecplotReader>,
    /// Zones that were read (–).
    n_read: usize,
}

impl TecplotFields {
    /// Looks through the file at `path`: the first zone tells the points, all tell their instants.
    pub(super) fn open(path: &Path, lengths: Lengths) -> Result<Self, FileError> {
        let mut reader = TecplotReader::open(path, WHAT)?;
        let columns = columns(&reader, path, lengths)?;
        let mut times = Vec::new();
        let mut grid = None;
        let mut item = reader.next()?;
        loop {
            let zone = match item {
                Item::Zone(zone) => zone,
                Item::Numbers => return Err(reader.refusal("numbers before a ZONE")),
                Item::End => break,
            };
            times.push(zone.time);
            let is_first = grid.is_none();
            let (values, next) = zone_values(&mut reader, &zone, &columns, is_first)?;
            if is_first {
                grid = Some(grid_of(&reader, &zone, &columns, &values)?);
            }
            if grid.is_some_and(|grid: Grid| grid.n_points != zone.n_points) {
                return Err(reader.refusal("a zone of other points than the first"));
            }
            if zone.time.is_some() != times[0].is_some() {
                return Err(reader.refusal("of the zones some have a SOLUTIONTIME, some have none"));
            }
            item = next;
        }
        let grid = grid.ok_or_else(|| reader.refusal("the file ends without a ZONE"))?;
        Ok(Self { path: path.to_owned(), lengths, grid, times, reader: None, n_read: 0 })
    }

    pub(super) fn grid(&self) -> Grid {
        self.grid
    }

    pub(super) fn times(&self) -> Vec<Option<f64>> {
        self.times.clone()
    }

    /// On return `velocity` is that of zone number `index` at `points`.
    pub(super) fn read(
        &mut self,
        index: usize,
        points: &Range<usize>,
        velocity: [&mut [f32]; 3],
    ) -> Result<(), FileError> {
        if self.reader.is_none() || self.n_read > index {
            let mut reader = TecplotReader::open(&self.path, WHAT)?;
            pass_to_zone(&mut reader)?;
            (self.reader, self.n_read) = (Some(reader), 0);
        }
        let Some(reader) = self.reader.as_mut() else { return Ok(()) };
        let columns = columns(reader, &self.path, self.lengths)?;
        loop {
            let Item::Zone(zone) = reader.next()? else {
                return Err(reader.refusal("a zone is expected here"));
            };
            let is_wanted = self.n_read == index;
            let (values, next) = zone_values(reader, &zone, &columns, is_wanted)?;
            if let Item::Zone(_) = next {
                reader.keep();
            }
            self.n_read += 1;
            if is_wanted {
                for (own, column) in velocity.into_iter().zip(columns.velocity()) {
                    for (own, value) in own.iter_mut().zip(&values[column.place][points.clone()]) {
                        *own = (column.scale * value) as f32;
                    }
                }
                return Ok(());
            }
        }
    }
}

/// Passes to the first zone.
fn pass_to_zone(reader: &mut TecplotReader) -> Result<(), FileError> {
    match reader.next()? {
        Item::Zone(_) => {
            reader.keep();
            Ok(())
        }
        _ => Err(reader.refusal("a ZONE is expected here")),
    }
}

fn columns(reader: &TecplotReader, path: &Path, lengths: Lengths) -> Result<Columns, FileError> {
    let named = reader.variables().iter().map(|name| (name.as_str(), ""));
    Columns::find(named, lengths)
        .map_err(|(problem, fix)| FileError::content(WHAT, path, problem, fix))
}

/// The numbers of each variable of `zone`, empty unless `keep`; and what comes after it.
fn zone_values(
    reader: &mut TecplotReader,
    zone: &Zone,
    columns: &Columns,
    keep: bool,
) -> Result<(Vec<Vec<f64>>, Item), FileError> {
    let n_variables = reader.variables().len();
    let n_points = zone.n_points.into_iter().try_fold(1_usize, usize::checked_mul);
    let n_points = n_points.filter(|n| n.checked_mul(n_variables).is_some());
    let n_points = n_points.ok_or_else(|| reader.refusal("a zone of too many points"))?;
    let mut values = vec![Vec::new(); n_variables];
    let mut n_seen = 0_usize;
    let next = loop {
        match reader.next()? {
            Item::Numbers => {}
            item => break item,
        }
        for value in &reader.numbers {
            let variable = if zone.is_block { n_seen / n_points } else { n_seen % n_variables };
            n_seen += 1;
            if keep && variable < n_variables && columns.is_wanted(variable) {
                values[variable].push(*value);
            }
        }
    };
    if n_seen != n_points * n_variables {
        let problem = format!("a zone of {n_seen} numbers, not {n_points} × {n_variables}");
        return Err(reader.refusal(&problem));
    }
    Ok((values, next))
}

/// The points of `zone`, whose first direction must be x, then y, then z.
fn grid_of(
    reader: &TecplotReader,
    zone: &Zone,
    columns: &Columns,
    values: &[Vec<f64>],
) -> Result<Grid, FileError> {
    let mut grid = Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: zone.n_points };
    let mut stride = 1;
    for (axis, (name, role)) in
        [("x", Role::X), ("y", Role::Y), ("z", Role::Z)].into_iter().enumerate()
    {
        let n = zone.n_points[axis];
        if let Some(column) = columns.of(role) {
            let along: Vec<f64> =
                (0..n).map(|step| values[column.place][step * stride] * column.scale).collect();
            let (origin, spacing) = even(&along)
                .map_err(|problem| reader.refusal(&format!("`{name}` of the zone {problem}")))?;
            (grid.origin[axis], grid.spacing[axis]) = (origin, spacing);
        }
        stride *= n;
    }
    Ok(grid)
}
