//! Particles in NetCDF: variables x, y, z, u, v, w and time over one dimension.

use super::{Columns, Counted, Particle, Seen, WHAT};
use crate::fields::Lengths;
use crate::{FileError, atomic};
use netcdf_reader::{NcFile, NcSliceInfo, NcSliceInfoElem};
use std::path::Path;

const FIX: &str = "give variables x, y, z, u, v, w, and time where there is one, each over one and the same dimension, with `units`";
/// Particles that are read at a time (–).
const PART: u64 = 1 << 16;

/// Hands `take` all particles in the file at `path`.
pub(super) fn each(
    path: &Path,
    lengths: Lengths,
    take: impl FnMut(&Particle),
) -> Result<Seen, FileError> {
    atomic::open(path).map_err(|error| FileError::system("read", WHAT, path, error))?;
    let opened = NcFile::open(path).map_err(|error| error.to_string());
    let read = opened.and_then(|file| of_file(&file, lengths, take));
    read.map_err(|problem| FileError::content(WHAT, path, problem, FIX))
}

fn of_file(
    file: &NcFile,
    lengths: Lengths,
    mut take: impl FnMut(&Particle),
) -> Result<Seen, String> {
    let variables = file.variables().map_err(|error| error.to_string())?;
    let named: Vec<(String, String)> = variables
        .iter()
        .map(|variable| {
            let unit = variable.attributes.iter().find(|one| one.name == "units");
            let unit = unit.and_then(|one| one.value.as_string()).unwrap_or_default();
            (variable.name.clone(), unit)
        })
        .collect();
    let columns =
        Columns::find(named.iter().map(|(name, unit)| (name.as_str(), unit.as_str())), lengths)
            .map_err(|(problem, _)| problem)?;
    let wanted: Vec<usize> = (0..named.len()).filter(|place| columns.is_wanted(*place)).collect();
    let shapes: Vec<Vec<u64>> = wanted.iter().map(|place| variables[*place].shape()).collect();
    let n = match shapes.first().map(Vec::as_slice) {
        Some([n]) if shapes.iter().all(|shape| shape[..] == [*n]) => *n,
        _ => return Err("its variables do not stand over one and the same dimension".to_owned()),
    };
    let mut counted = Counted::new(&columns);
    let mut row = vec![0.0; named.len()];
    let mut start = 0;
    while start < n {
        let end = n.min(start + PART);
        let slice =
            NcSliceInfo { selections: vec![NcSliceInfoElem::Slice { start, end, step: 1 }] };
        let mut parts = Vec::with_capacity(wanted.len());
        for place in &wanted {
            let values = file.read_variable_slice_unpacked_masked(&named[*place].0, &slice);
            let values = values.map_err(|error| error.to_string())?.into_raw_vec_and_offset().0;
            if values.len() as u64 != end - start {
                return Err(format!("`{}` is cut short", named[*place].0));
            }
            parts.push(values);
        }
        for index in 0..(end - start) as usize {
            for (place, values) in wanted.iter().zip(&parts) {
                row[*place] = values[index];
            }
            take(&counted.particle(&columns.particle(&row)));
        }
        start = end;
    }
    Ok(counted.seen)
}
