//! Where the numbers of a variable lie in a NetCDF file of the classic kind.

use super::numbers::Coding;
use netcdf_reader::classic::data::compute_record_stride;
use netcdf_reader::{NcFile, NcVariable};
use std::ops::Range;

/// Where a component lies.
pub(super) struct Layout {
    /// The first number (byte).
    begin: u64,
    /// From instant to instant (bytes).
    of_instant: u64,
    /// Points that lie together, and from those to the next (bytes).
    run: usize,
    of_run: u64,
    pub(super) coding: Coding,
}

impl Layout {
    /// That of `variable` of `file`, of `n_points` at each instant; it stands over time where `has_time`.
    ///
    /// The library tells offsets in fields that it does not document, which is why its version is pinned.
    pub(super) fn of(
        file: &NcFile,
        variable: &NcVariable,
        (n_points, has_time): (usize, bool),
        coding: Coding,
    ) -> Result<Self, String> {
        let too_long = || format!("`{}` is longer than any file", variable.name);
        let of_record = match variable.is_record_var {
            true => {
                let variables = file.variables().map_err(|error| error.to_string())?;
                compute_record_stride(variables).map_err(|error| error.to_string())?
            }
            false => 0,
        };
        let n_bytes =
            (n_points as u64).checked_mul(coding.n_bytes() as u64).ok_or_else(too_long)?;
        let n_records = variable.dimensions.first().map_or(1, |first| first.size).max(1);
        // Without a time it may be another axis that grows.
        let (of_instant, run, of_run) = match (variable.is_record_var, has_time) {
            (true, true) => (of_record, n_points, 0),
            (true, false) => (0, n_points / n_records as usize, of_record),
            (false, _) => (n_bytes, n_points, 0),
        };
        Ok(Self { begin: variable.data_offset, of_instant, run: run.max(1), of_run, coding })
    }

    /// Where the first of `points` at instant number `instant` lies, how many bytes of them lie there
    /// together, and which points come after those; none where no file is as long.
    pub(super) fn place(
        &self,
        instant: usize,
        points: &Range<usize>,
    ) -> Option<(u64, usize, Range<usize>)> {
        let number = points.start / self.run;
        let end = points.end.min((number + 1) * self.run);
        let n_bytes = self.coding.n_bytes();
        let within = (points.start - number * self.run).checked_mul(n_bytes)? as u64;
        let of_instant = self.of_instant.checked_mul(instant as u64)?;
        let of_run = self.of_run.checked_mul(number as u64)?;
        let at = self.begin.checked_add(of_instant)?.checked_add(of_run)?.checked_add(within)?;
        Some((at, (end - points.start).checked_mul(n_bytes)?, end..points.end))
    }

    /// Bytes that a file has at least, of `n_points` at `n_instants`; none where no file is as long.
    pub(super) fn end(&self, n_points: usize, n_instants: usize) -> Option<u64> {
        let last = n_points.checked_sub(1)?..n_points;
        let (at, n_bytes, _) = self.place(n_instants.checked_sub(1)?, &last)?;
        at.checked_add(n_bytes as u64)
    }
}
