//! Other bins beside those that are asked for, at some points spread over the field.

use super::strips::{StripBatch, append_moments, line};
use analysis::phases::{Bins, PhaseAverager, PhaseBatch, PhaseError};
use basis::records::PhaseAverages;

/// Points at which bins are compared, about (–).
const N_COMPARED: usize = 400;

/// Averages in one set of bins.
struct Set {
    batches: Vec<PhaseBatch>,
    /// Sums of the strip under way.
    averager: PhaseAverager,
    averages: Option<PhaseAverages>,
}

/// Averages at some points in several sets of bins.
pub(super) struct Compared {
    stride: usize,
    sets: Vec<Set>,
    /// Velocity at those of the points that are in a strip.
    rows: [Vec<f32>; 3],
}

impl Compared {
    /// In `sets`, each with the batches of its instants, on a field of `n_points`; nothing taken in yet.
    pub(super) fn new(n_points: usize, sets: Vec<(Bins, Vec<PhaseBatch>)>) -> Self {
        let set = |(bins, batches)| {
            let averager = PhaseAverager::new(line(0), bins);
            Set { batches, averager, averages: None }
        };
        let sets = sets.into_iter().map(set).collect();
        Self { stride: n_points.div_ceil(N_COMPARED).max(1), sets, rows: Default::default() }
    }

    /// Takes in what was read.
    pub(super) fn look(&mut self, read: &StripBatch) -> Result<(), PhaseError> {
        if self.sets.is_empty() {
            return Ok(());
        }
        let first = read.points.start.next_multiple_of(self.stride);
        let kept: Vec<usize> = (first..read.points.end).step_by(self.stride).collect();
        for (rows, values) in self.rows.iter_mut().zip(read.velocity) {
            rows.clear();
            for row in values.chunks_exact(read.points.len()) {
                rows.extend(kept.iter().map(|point| row[point - read.points.start]));
            }
        }
        for set in &mut self.sets {
            if read.batch == 0 {
                set.averager.begin_anew(line(kept.len()));
            }
            let batch = &set.batches[read.batch];
            set.averager.add_batch(batch, self.rows.each_ref().map(Vec::as_slice))?;
            if read.batch + 1 == set.batches.len() {
                set.join();
            }
        }
        Ok(())
    }

    /// The averages, set by set.
    pub(super) fn finish(self) -> Vec<PhaseAverages> {
        self.sets.into_iter().filter_map(|set| set.averages).collect()
    }
}

impl Set {
    /// Puts the averages of the strip behind those of the strips before.
    fn join(&mut self) {
        let Some(averages) = &mut self.averages else {
            self.averages = Some(self.averager.averages());
            return;
        };
        averages.grid.n_points[0] += self.averager.grid().len();
        append_moments(&mut averages.all, &self.averager.all());
        for (index, own) in averages.each.iter_mut().enumerate() {
            append_moments(own, &self.averager.bin(index));
        }
    }
}
