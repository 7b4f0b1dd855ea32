//! Averages of fields strip by strip: one thread reads ahead, the others sum.

use super::plan::{Plan, pieces};
use analysis::phases::{Decomposer, Decomposition, PhaseAverager, PhaseBatch, PhaseError};
use basis::records::{Grid, Moments};
use formats::FileError;
use formats::fields::FieldFile;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};

/// What was averaged at some points.
#[derive(Default)]
pub(super) struct Strip {
    /// Moments of all instants.
    pub(super) all: Moments,
    /// Those of each bin that is kept.
    pub(super) each: Vec<Moments>,
    /// Mean, periodic and random parts.
    pub(super) parts: Decomposition,
    /// Samples that were missing (–).
    pub(super) n_holes: u64,
}

/// Velocity at the points of a strip in a batch of instants.
pub(super) struct StripBatch<'a> {
    /// Number of the batch.
    pub(super) batch: usize,
    pub(super) points: Range<usize>,
    /// One instant after the other.
    pub(super) velocity: &'a [Vec<f32>; 3],
}

/// Why there are no averages.
pub(super) enum Trouble {
    File(FileError),
    Phases(PhaseError),
}

impl From<FileError> for Trouble {
    fn from(error: FileError) -> Self {
        Self::File(error)
    }
}

impl From<PhaseError> for Trouble {
    fn from(error: PhaseError) -> Self {
        Self::Phases(error)
    }
}

/// Points in a line: where they stand is nothing to sums.
pub(super) fn line(n_points: usize) -> Grid {
    Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [n_points, 1, 1] }
}

/// Reads the fields of `file` from instant number `first` on, which the `batches` are of, as `plan` has it.
/// `look` is shown what was read, `take` is given each strip in its turn, with its points. Bins of the
/// numbers `kept`, which grow, are kept. What comes out is the same, bit by bit, whatever the plan.
pub(super) fn each_strip(
    (file, first): (&mut FieldFile, usize),
    (plan, batches): (&Plan, &[PhaseBatch]),
    kept: &[usize],
    mut look: impl FnMut(&StripBatch) -> Result<(), Trouble>,
    mut take: impl FnMut(Range<usize>, Strip) -> Result<(), Trouble>,
) -> Result<(), Trouble> {
    let averagers = averagers(plan, batches);
    std::thread::scope(|scope| {
        let (give_back, free) = mpsc::channel::<[Vec<f32>; 3]>();
        let (send, arriving) = mpsc::sync_channel(1);
        (0..2).for_each(|_| give_back.send(Default::default()).unwrap_or_default());
        scope.spawn(move || {
            for strip in plan.strips() {
                for batch in plan.batches() {
                    // Who sums has given up, where nothing comes back or nobody waits.
                    let Ok(mut velocity) = free.recv() else { return };
                    let instants = first + batch.start..first + batch.end;
                    let read = file.read_points(instants, strip.clone(), &mut velocity);
                    let is_sound = read.is_ok();
                    if send.send(read.map(|()| velocity)).is_err() || !is_sound {
                        return;
                    }
                }
            }
        });
        for points in plan.strips() {
            let mut strip = Strip::default();
            for (number, batch) in batches.iter().enumerate() {
                let Ok(read) = arriving.recv() else { return Ok(()) };
                let velocity = read?;
                look(&StripBatch { batch: number, points: points.clone(), velocity: &velocity })?;
                let work = Work {
                    plan,
                    batch,
                    velocity: &velocity,
                    n_points: points.len(),
                    is_first: number == 0,
                    is_last: number + 1 == batches.len(),
                    kept,
                };
                let blocks = work.done(&averagers)?;
                blocks.into_iter().for_each(|block| strip.append(block));
                // The reader may be done.
                let _ = give_back.send(velocity);
            }
            take(points, strip)?;
        }
        Ok(())
    })
}

/// Sums: for each thread where one batch holds all instants, else for each block of a strip.
fn averagers(plan: &Plan, batches: &[PhaseBatch]) -> Vec<Mutex<PhaseAverager>> {
    let n = match batches.len() {
        1 => plan.n_threads,
        _ => plan.of_strip().div_ceil(plan.block),
    };
    let Some(batch) = batches.first() else { return Vec::new() };
    let new = || Mutex::new(PhaseAverager::new(line(plan.block), *batch.bins()));
    std::iter::repeat_with(new).take(n).collect()
}

/// A batch of instants of a strip, to be summed.
struct Work<'a> {
    plan: &'a Plan,
    batch: &'a PhaseBatch,
    velocity: &'a [Vec<f32>; 3],
    n_points: usize,
    is_first: bool,
    is_last: bool,
    kept: &'a [usize],
}

impl Work<'_> {
    /// Takes in the batch, block by block on all threads; the averages of the blocks, in their order, once it
    /// is the last one.
    fn done(&self, averagers: &[Mutex<PhaseAverager>]) -> Result<Vec<Strip>, PhaseError> {
        let next = AtomicUsize::new(0);
        let is_alone = self.is_first && self.is_last;
        let serve = |thread: usize| -> Result<Vec<(usize, Strip)>, PhaseError> {
            let mut rows = [const { Vec::new() }; 3];
            let mut done = Vec::new();
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some(block) = pieces(self.n_points, self.plan.block).nth(number) else {
                    return Ok(done);
                };
                let own = &averagers[if is_alone { thread } else { number }];
                let mut averager = own.lock().unwrap_or_else(PoisonError::into_inner);
                if self.is_first {
                    averager.begin_anew(line(block.len()));
                }
                self.gather(&block, &mut rows);
                averager.add_batch(self.batch, rows.each_ref().map(Vec::as_slice))?;
                if self.is_last {
                    done.push((number, Strip::of(&averager, self.kept)));
                }
            }
        };
        let done = std::thread::scope(|scope| {
            let serve = &serve;
            let others: Vec<_> =
                (1..self.plan.n_threads).map(|thread| scope.spawn(move || serve(thread))).collect();
            let mut done = serve(0)?;
            for other in others {
                let other = other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
                done.extend(other?);
            }
            Ok(done)
        });
        let mut done: Vec<(usize, Strip)> = done?;
        done.sort_by_key(|(number, _)| *number);
        Ok(done.into_iter().map(|(_, block)| block).collect())
    }

    /// On return `rows` are the velocities of `block`, side by side in memory.
    fn gather(&self, block: &Range<usize>, rows: &mut [Vec<f32>; 3]) {
        for (rows, values) in rows.iter_mut().zip(self.velocity) {
            rows.clear();
            for row in values.chunks_exact(self.n_points) {
                rows.extend_from_slice(&row[block.clone()]);
            }
        }
    }
}

impl Strip {
    /// What `averager` has, and its bins of the numbers `kept`, which grow.
    fn of(averager: &PhaseAverager, kept: &[usize]) -> Self {
        let all = averager.all();
        let mut decomposer = Decomposer::new(&all);
        let (mut each, mut moments) = (Vec::new(), Moments::default());
        for (index, bin) in averager.phase_bins().iter().enumerate() {
            let is_kept = kept.binary_search(&index).is_ok();
            if bin.n_instants == 0 && !is_kept {
                continue;
            }
            averager.read_bin(index, &mut moments);
            decomposer.add(&moments);
            if is_kept {
                each.push(moments.clone());
            }
        }
        Self { all, each, parts: decomposer.finish(), n_holes: averager.n_holes() }
    }

    /// Puts `other`, whose points come next, behind this.
    pub(super) fn append(&mut self, other: Self) {
        append_moments(&mut self.all, &other.all);
        self.each.resize_with(other.each.len(), Moments::default);
        for (own, other) in self.each.iter_mut().zip(&other.each) {
            append_moments(own, other);
        }
        self.parts.append(&other.parts);
        self.n_holes += other.n_holes;
    }
}

/// Puts `other`, whose points come next, behind `own`.
pub(super) fn append_moments(own: &mut Moments, other: &Moments) {
    own.n_samples.extend_from_slice(&other.n_samples);
    for (own, other) in own.mean.iter_mut().zip(&other.mean) {
        own.extend_from_slice(other);
    }
    for (own, other) in own.stress.iter_mut().zip(&other.stress) {
        own.extend_from_slice(other);
    }
}
