//! The columns of a run's series, a group at a time, so that memory does not grow with every channel of a
//! long run.

use crate::StudyError;
use crate::prepared::Prepared;
use analysis::statistics::statistic;
use basis::records::{Series, Statistic};
use formats::records::{RunFolder, SeriesFile};
use std::collections::BTreeSet;

/// Most that the columns of one run take at once (bytes), unless one result needs more of them together.
const BUDGET: usize = 32 << 20;

/// Where the columns of a run come from.
enum Source {
    /// The series on the disk.
    File(SeriesFile),
    /// All of them are in memory.
    Memory,
}

/// The series of one run, and those of its columns that are in memory.
///
/// What is asked for together is in memory together. What is expected to be asked for next comes with it, as
/// far as the budget goes: a usual run is read once, a long one in a few passes, with the same numbers.
pub(crate) struct Columns {
    source: Source,
    first: usize,
    interval: f64,
    /// Length of blocks (s).
    block: f64,
    /// Most columns in memory.
    n_most: usize,
    /// Channels that will be asked for together, in the order in which they will be.
    expected: Vec<Vec<String>>,
    held: Series,
}

impl Columns {
    /// The columns of the run in `folder`, none of them in memory.
    ///
    /// # Errors
    /// [`StudyError::File`] for a series that cannot be read.
    pub(crate) fn open(folder: &RunFolder, setup: &Prepared) -> Result<Self, StudyError> {
        Self::within(BUDGET, folder, setup)
    }

    /// The same within `budget` (bytes).
    pub(crate) fn within(
        budget: usize,
        folder: &RunFolder,
        setup: &Prepared,
    ) -> Result<Self, StudyError> {
        let file = SeriesFile::open(&folder.series_path())?;
        let plan = &setup.plan;
        Ok(Self {
            first: first_row(setup),
            interval: plan.row_interval(),
            block: setup.case.time.block,
            n_most: budget / (size_of::<f64>() * file.n_rows().max(1)),
            expected: Vec::new(),
            held: Series::default(),
            source: Source::File(file),
        })
    }

    /// The columns of a run whose `series` is in memory, whole.
    pub(crate) fn of_series(series: Series, setup: &Prepared) -> Self {
        Self {
            source: Source::Memory,
            first: first_row(setup),
            interval: setup.plan.row_interval(),
            block: setup.case.time.block,
            n_most: usize::MAX,
            expected: Vec::new(),
            held: series,
        }
    }

    /// The series in memory: whole where it was given so.
    pub(crate) fn into_series(self) -> Series {
        self.held
    }

    /// Names of all channels of the run.
    pub(crate) fn names(&self) -> &[String] {
        match &self.source {
            Source::File(file) => file.names(),
            Source::Memory => &self.held.names,
        }
    }

    /// Says which channels will be asked for, those of each [`of`](Self::of) together, in its order.
    pub(crate) fn expect(&mut self, expected: Vec<Vec<String>>) {
        self.expected = expected;
    }

    /// The analysed part of `channels`, as far as the run has them.
    ///
    /// # Errors
    /// [`StudyError::File`] for a series that cannot be read.
    pub(crate) fn of(&mut self, channels: &[String]) -> Result<Analysed<'_>, StudyError> {
        if let Source::File(file) = &self.source
            && channels
                .iter()
                .any(|name| self.held.column(name).is_none() && file.names().contains(name))
        {
            let group = group(channels, &self.expected, self.n_most);
            // What was held goes before anything comes.
            self.held = Series::default();
            self.held = file.read(|name| group.contains(name))?;
        }
        let Self { first, interval, block, .. } = *self;
        Ok(Analysed { series: &self.held, first, interval, block })
    }
}

/// First row that is analysed.
fn first_row(setup: &Prepared) -> usize {
    setup.plan.n_spin_up_steps.div_ceil(setup.plan.row_stride) as usize
}

/// `channels`, and what is `expected` after them as far as all are no more than `n_most`.
fn group<'a>(
    channels: &'a [String],
    expected: &'a [Vec<String>],
    n_most: usize,
) -> BTreeSet<&'a str> {
    let mut group: BTreeSet<&str> = channels.iter().map(String::as_str).collect();
    let requested = expected.iter().position(|part| part.as_slice() == channels);
    for part in expected.iter().skip(requested.map_or(expected.len(), |place| place + 1)) {
        let mut larger = group.clone();
        larger.extend(part.iter().map(String::as_str));
        if larger.len() > n_most {
            break;
        }
        group = larger;
    }
    group
}

/// On return `sum` holds `column` too, instant by instant.
pub(crate) fn add_to(sum: &mut Vec<f64>, column: &[f64]) {
    sum.resize(column.len(), 0.0);
    for (sum, value) in sum.iter_mut().zip(column) {
        *sum += value;
    }
}

/// Columns of one run, cut to the analysed time.
pub(crate) struct Analysed<'a> {
    series: &'a Series,
    /// First analysed row.
    pub(crate) first: usize,
    /// Time between rows (s).
    pub(crate) interval: f64,
    /// Length of the blocks that intervals are made of (s).
    pub(crate) block: f64,
}

impl<'a> Analysed<'a> {
    /// All of a series whose rows lie `interval` (s) apart.
    #[cfg(test)]
    pub(crate) fn whole(series: &'a Series, interval: f64) -> Self {
        Self { series, first: 0, interval, block: analysis::statistics::BLOCK_LENGTH }
    }

    /// Whether the channel `name` is there.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.series.column(name).is_some()
    }

    /// The analysed part of the channel `name`.
    pub(crate) fn column(&self, name: &str) -> Result<&'a [f64], StudyError> {
        let column = self
            .series
            .column(name)
            .ok_or_else(|| StudyError::MissingChannel { channel: name.to_owned() })?;
        Ok(column.get(self.first..).unwrap_or_default())
    }

    /// Mean and deviation of the channel `name`.
    pub(crate) fn statistic(&self, name: &str) -> Result<Statistic, StudyError> {
        Ok(statistic(self.column(name)?, self.interval, self.block)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_expected_next_comes_along_as_far_as_there_is_room() {
        let part = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let expected = [part(&["a", "b"]), part(&["b", "c"]), part(&["d", "e"]), part(&["f"])];
        let found = |requested: &[&str], n_most: usize| {
            group(&part(requested), &expected, n_most).into_iter().collect::<String>()
        };
        // What is needed together comes, room or not.
        assert_eq!(found(&["a", "b"], 0), "ab");
        // What two results need counts once; a result is not read in halves, nor another before it.
        assert_eq!(found(&["a", "b"], 3), "abc");
        assert_eq!(found(&["a", "b"], 4), "abc");
        assert_eq!(found(&["a", "b"], 6), "abcdef");
        assert_eq!(found(&["d", "e"], 6), "def");
        // What nobody expected comes alone.
        assert_eq!(found(&["c"], 6), "c");
    }
}
