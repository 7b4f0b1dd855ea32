//! Sums by phase that take instants as they come.

use super::{Bins, PhaseError};
use basis::records::{Grid, Moments, PhaseAverages, PhaseBin, STRESSES};
use serde::{Deserialize, Serialize};

/// Memory of a point in a bin (bytes): count, three sums, six sums of products.
pub const POINT_BYTES: u64 = (size_of::<u32>() + 9 * size_of::<f64>()) as u64;
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

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Sums {
    n: Vec<u32>,
    first: [Vec<f64>; 3],
    second: [Vec<f64>; 6],
}

impl Sums {
    fn new(n_points: usize) -> Self {
        Self {
            n: vec![0; n_points],
            first: std::array::from_fn(|_| vec![0.0; n_points]),
            second: std::array::from_fn(|_| vec![0.0; n_points]),
        }
    }

    /// Adds `velocity` less `reference` at each point where it has no hole.
    fn add(&mut self, velocity: [&[f32]; 3], reference: &[Vec<f32>; 3]) {
        let n_points = self.n.len();
        let [u, v, w] = velocity.map(|values| &values[..n_points]);
        let [r, s, t] = reference.each_ref().map(|values| &values[..n_points]);
        let [a, b, c] = self.first.each_mut().map(|sums| &mut sums[..n_points]);
        let [aa, bb, cc, ab, ac, bc] = self.second.each_mut().map(|sums| &mut sums[..n_points]);
        for (i, n) in self.n.iter_mut().enumerate() {
            let pairs = [[u[i], r[i]], [v[i], s[i]], [w[i], t[i]]];
            let away = pairs.map(|[value, from]| f64::from(value) - f64::from(from));
            let is_there = (away[0] + away[1] + away[2]).is_finite();
            let [x, y, z] = away.map(|away| if is_there { away } else { 0.0 });
            *n += u32::from(is_there);
            a[i] += x;
            b[i] += y;
            c[i] += z;
            aa[i] += x * x;
            bb[i] += y * y;
            cc[i] += z * z;
            ab[i] += x * y;
            ac[i] += x * z;
            bc[i] += y * z;
        }
    }

    fn moments(&self, reference: &[Vec<f32>; 3]) -> Moments {
        let over = |sum: f64, i: usize| sum / f64::from(self.n[i]);
        let mean = |component: usize| {
            let sums = self.first[component].iter().enumerate();
            sums.map(move |(i, sum)| (f64::from(reference[component][i]) + over(*sum, i)) as f32)
        };
        let stress = |place: usize| {
            let [first, second] = STRESSES[place].map(|component| &self.first[component]);
            let sums = self.second[place].iter().enumerate();
            sums.map(move |(i, sum)| {
                (over(*sum, i) - over(first[i], i) * over(second[i], i)) as f32
            })
        };
        Moments {
            n_samples: self.n.clone(),
            mean: std::array::from_fn(|component| mean(component).collect()),
            stress: std::array::from_fn(|place| stress(place).collect()),
        }
    }
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
        let helix = self.checked(time, rotor, helix, velocity)?;
        let [u, v, w] = velocity;
        let [r, s, t] = &mut self.reference;
        for i in 0..u.len() {
            let is_there = (u[i] + v[i] + w[i]).is_finite();
            self.n_holes += u64::from(!is_there);
            if is_there && r[i].is_nan() {
                (r[i], s[i], t[i]) = (u[i], v[i], w[i]);
            }
        }
        self.all.add(velocity, &self.reference);
        let mut n_bins = 0;
        let mut members = self.bins.of_instant(rotor, helix).peekable();
        for index in 0..self.bins.len() {
            let is_in = members.next_if_eq(&index).is_some();
            if is_in {
                self.each[index].add(velocity, &self.reference);
                self.n_instants[index] += 1;
                self.n_visits[index] += u64::from(!self.inside[index]);
                n_bins += 1;
            }
            self.inside[index] = is_in;
        }
        self.first.get_or_insert(time);
        self.last = Some(time);
        self.latest = time;
        Ok(n_bins)
    }

    /// The helix azimuth of an instant that can be taken in (rad); zero where the bins do not ask for one.
    fn checked(
        &self,
        time: f64,
        rotor: f64,
        helix: Option<f64>,
        velocity: [&[f32]; 3],
    ) -> Result<f64, PhaseError> {
        let expected = self.grid.len();
        if let Some(odd) = velocity.iter().find(|values| values.len() != expected) {
            return Err(PhaseError::Points { found: odd.len(), expected });
        }
        let helix = match (self.bins.helix_width(), helix) {
            (None, _) => 0.0,
            (Some(_), Some(helix)) => helix,
            (Some(_), None) => return Err(PhaseError::NoHelix { time }),
        };
        for (what, value) in [("time", time), ("rotor azimuth", rotor), ("helix azimuth", helix)] {
            if !value.is_finite() {
                return Err(PhaseError::NotFinite { what, value, time });
            }
        }
        match self.last {
            Some(before) if time <= before => Err(PhaseError::TimeRunsBack { time, before }),
            _ => Ok(helix),
        }
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
        self.all.moments(&self.reference)
    }

    /// Mean and second moments of those in bin number `index` so far.
    ///
    /// # Panics
    /// Where there is no such bin.
    pub fn bin(&self, index: usize) -> Moments {
        self.each[index].moments(&self.reference)
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
            each: Vec::new(),
        }
    }

    /// All averages so far; half as much memory again as the sums take.
    pub fn averages(&self) -> PhaseAverages {
        let each = (0..self.bins.len()).map(|index| self.bin(index)).collect();
        PhaseAverages { each, ..self.head() }
    }
}
