//! Sums by phase that take instants as they come.

use super::batch::{PhaseBatch, PhaseInstant};
use super::sums::{POINT_BYTES, Sums};
use super::{Bins, PhaseError};
use basis::records::{Grid, Moments, PhaseAverages, PhaseBin};
use serde::{Deserialize, Serialize};

/// Memory of a point beside its bins (bytes): the velocity from which sums are taken.
const REFERENCE_BYTES: u64 = 3 * size_of::<f32>() as u64;

/// Sums of velocity at points of a grid, one for each bin of phase, and one of all instants.
///
/// Velocities are summed as differences from the first at each point, so that nothing cancels. All memory is
/// taken at the start, [`PhaseAverager::memory`]. It is plain data, which a checkpoint keeps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhaseAverager {
    grid: Grid,
    bins: Bins,
    /// First velocity at each point (m/s); not a number until there is one.
    reference: [Vec<f32>; 3],
    all: Sums,
    each: Vec<Sums>,
    n_instants: Vec<u64>,
    n_visits: Vec<u64>,
    /// Whether the last instant fell into each bin.
    inside: Vec<bool>,
    /// Samples that were missing (–).
    n_holes: u64,
    first: Option<f64>,
    /// Latest instant of the record under way (s).
    last: Option<f64>,
    /// Latest instant of all (s).
    latest: f64,
}

impl PhaseAverager {
    /// Averages on the points of `grid` in `bins`; nothing taken in yet.
    pub fn new(grid: Grid, bins: Bins) -> Self {
        let n_points = grid.len();
        Self {
            grid,
            bins,
            reference: std::array::from_fn(|_| vec![f32::NAN; n_points]),
            all: Sums::new(n_points),
            each: (0..bins.len()).map(|_| Sums::new(n_points)).collect(),
            n_instants: vec![0; bins.len()],
            n_visits: vec![0; bins.len()],
            inside: vec![false; bins.len()],
            n_holes: 0,
            first: None,
            last: None,
            latest: 0.0,
        }
    }

    /// Memory that averages at `n_points` points in `bins` take, from the start to the end (bytes).
    pub fn memory(n_points: u64, bins: &Bins) -> u64 {
        n_points * ((bins.len() as u64 + 1) * POINT_BYTES + REFERENCE_BYTES)
    }

    /// The bins.
    pub fn bins(&self) -> &Bins {
        &self.bins
    }

    /// The points.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Samples that were missing so far, over all points and instants (–).
    pub fn n_holes(&self) -> u64 {
        self.n_holes
    }

    /// What comes next is of another record, whose time may begin anew.
    pub fn begin_record(&mut self) {
        self.last = None;
        self.inside.fill(false);
    }

    /// On return nothing is taken in, on the points of `grid`; allocates where there were fewer before.
    pub fn begin_anew(&mut self, grid: Grid) {
        let n_points = grid.len();
        self.grid = grid;
        for values in &mut self.reference {
            values.clear();
            values.resize(n_points, f32::NAN);
        }
        self.all.clear(n_points);
        self.each.iter_mut().for_each(|sums| sums.clear(n_points));
        self.n_instants.fill(0);
        self.n_visits.fill(0);
        (self.n_holes, self.first, self.latest) = (0, None, 0.0);
        self.begin_record();
    }

    /// Takes in `velocity` (m/s, u, v, w in the order of the grid; not a number where there is a hole) at
    /// `time` (s), at the azimuths `rotor` and, where the bins ask for it, `helix` (rad). Gives the number of
    /// bins that it fell into. Allocates nothing.
    ///
    /// # Errors
    /// [`PhaseError`] for other points, a time that runs back, an azimuth that is missing or no number; then
    /// nothing has changed.
    pub fn add(
        &mut self,
        time: f64,
        rotor: f64,
        helix: Option<f64>,
        velocity: [&[f32]; 3],
    ) -> Result<usize, PhaseError> {
        self.check_points(1, velocity)?;
        let helix = PhaseInstant { time, rotor, helix }.checked(&self.bins, self.last)?;
        self.find_reference(velocity);
        self.all.add(&[0], velocity, &self.reference);
        let mut n_bins = 0;
        let mut members = self.bins.of_instant(rotor, helix).peekable();
        for index in 0..self.bins.len() {
            let is_in = members.next_if_eq(&index).is_some();
            if is_in {
                self.each[index].add(&[0], velocity, &self.reference);
                self.n_instants[index] += 1;
                self.n_visits[index] += u64::from(!self.inside[index]);
                n_bins += 1;
            }
            self.inside[index] = is_in;
        }
        self.passed([time; 2]);
        Ok(n_bins)
    }

    /// Takes in all instants of `batch`, whose `velocity` stands one instant after the other. What comes of
    /// it is the same, bit by bit, as if [`PhaseAverager::add`] took in each alone; but each bin is met once,
    /// so that little memory is moved. Allocates nothing.
    ///
    /// # Errors
    /// [`PhaseError`] for other points, a time that runs back; then nothing has changed.
    ///
    /// # Panics
    /// Where the batch is of other bins.
    pub fn add_batch(
        &mut self,
        batch: &PhaseBatch,
        velocity: [&[f32]; 3],
    ) -> Result<(), PhaseError> {
        assert_eq!(batch.bins, self.bins, "a batch of the same bins");
        self.check_points(batch.len(), velocity)?;
        let [time, _] = batch.span;
        if let Some(before) = self.last.filter(|before| time <= *before) {
            return Err(PhaseError::TimeRunsBack { time, before });
        }
        self.find_reference(velocity);
        self.all.add(&batch.all, velocity, &self.reference);
        for (index, members) in batch.each.iter().enumerate() {
            if !members.is_empty() {
                self.each[index].add(members, velocity, &self.reference);
            }
            let (n_visits, is_in) = batch.visits(index, self.inside[index]);
            self.n_instants[index] += members.len() as u64;
            self.n_visits[index] += n_visits;
            self.inside[index] = is_in;
        }
        self.passed(batch.span);
        Ok(())
    }

    /// That `velocity` has a value for each point at `n_instants`.
    fn check_points(&self, n_instants: usize, velocity: [&[f32]; 3]) -> Result<(), PhaseError> {
        let expected = n_instants * self.grid.len();
        match velocity.iter().find(|values| values.len() != expected) {
            Some(odd) => Err(PhaseError::Points { found: odd.len(), expected }),
            None => Ok(()),
        }
    }

    /// Takes the first of `velocity` without a hole where there is no reference yet, and counts holes.
    fn find_reference(&mut self, velocity: [&[f32]; 3]) {
        let n_points = self.grid.len().max(1);
        let [r, s, t] = self.reference.each_mut().map(|values| &mut values[..]);
        let [u, v, w] = velocity.map(|values| values.chunks_exact(n_points));
        for ((u, v), w) in u.zip(v).zip(w) {
            let mut n_holes = 0_u32;
            let mut n_open = 0_u32;
            for ((u, v), (w, r)) in u.iter().zip(v).zip(w.iter().zip(r.iter())) {
                n_holes += u32::from(!(u + v + w).is_finite());
                n_open += u32::from(r.is_nan());
            }
            self.n_holes += u64::from(n_holes);
            if n_open == 0 {
                continue;
            }
            for i in 0..r.len() {
                if r[i].is_nan() && (u[i] + v[i] + w[i]).is_finite() {
                    (r[i], s[i], t[i]) = (u[i], v[i], w[i]);
                }
            }
        }
    }

    /// Instants from the first to the last of `span` (s) were taken in.
    fn passed(&mut self, span: [f64; 2]) {
        self.first.get_or_insert(span[0]);
        self.last = Some(span[1]);
        self.latest = span[1];
    }

    /// First and last instant (s); zeros before there is one.
    pub fn span(&self) -> [f64; 2] {
        [self.first.unwrap_or(0.0), self.latest]
    }

    /// The bins with what fell into them so far.
    pub fn phase_bins(&self) -> Vec<PhaseBin> {
        let bin = |index: usize| self.bins.bin(index, self.n_instants[index], self.n_visits[index]);
        (0..self.bins.len()).map(bin).collect()
    }

    /// Mean and second moments of all instants so far.
    pub fn all(&self) -> Moments {
        let mut moments = Moments::default();
        self.all.moments(&self.reference, &mut moments);
        moments
    }

    /// Mean and second moments of those in bin number `index` so far.
    ///
    /// # Panics
    /// Where there is no such bin.
    pub fn bin(&self, index: usize) -> Moments {
        let mut moments = Moments::default();
        self.read_bin(index, &mut moments);
        moments
    }

    /// On return `moments` are those of bin number `index` so far.
    ///
    /// # Panics
    /// Where there is no such bin.
    pub fn read_bin(&self, index: usize, moments: &mut Moments) {
        self.each[index].moments(&self.reference, moments);
    }

    /// The averages without those of the bins, which [`PhaseAverager::bin`] gives one by one.
    pub fn head(&self) -> PhaseAverages {
        PhaseAverages {
            grid: self.grid,
            rotor_width: self.bins.rotor_width(),
            helix_width: self.bins.helix_width(),
            span: self.span(),
            bins: self.phase_bins(),
            all: self.all(),
            pressure: None,
            each: Vec::new(),
        }
    }

    /// All averages so far; half as much memory again as the sums take.
    pub fn averages(&self) -> PhaseAverages {
        let each = (0..self.bins.len()).map(|index| self.bin(index)).collect();
        PhaseAverages { each, ..self.head() }
    }
}
