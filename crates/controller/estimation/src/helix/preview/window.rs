//! Least squares over the points of lidar scans that arrive within one period of the helix.
//!
//! A point at the height z and the place y to the right of the rotor's centre, whose air arrives at the time
//! t, has the axial wind
//!
//! ```text
//! u = U + (2z/R) (c_t + p_t sin ωt + q_t cos ωt) + (2y/R) (c_y + p_y sin(ωt + λ) + q_y cos(ωt + λ))
//! ```
//!
//! so that tilt and yaw are the slopes at half the radius, which is what radial lines see of a linear wind
//! (van Vondelen et al. 2025, Eq. 23). Points are added up in slots of arrival time; a window is the sum of
//! its slots. So points of one scan may be measured, and may arrive, at times of their own.

use serde::{Deserialize, Serialize};

/// Unknowns: mean, and of tilt and yaw each a constant, a sine and a cosine (–).
pub(super) const N_UNKNOWNS: usize = 7;
/// Entries of the lower half of the normal matrix, row by row (–).
const N_ENTRIES: usize = N_UNKNOWNS * (N_UNKNOWNS + 1) / 2;
/// Slots of a window (–).
pub(super) const N_SLOTS: usize = 48;
/// Slots that are kept (–): eight windows, more than the longest look ahead takes.
const N_KEPT: usize = 8 * N_SLOTS;
/// Slots to either side within which one without points counts as seen (–): half of a twelfth of a period.
const N_BESIDE: i64 = 2;
/// Share of its diagonal entry below which a pivot is none (–): the points do not tell the unknowns apart.
const LEAST_PIVOT: f64 = 1e-9;

/// The unknowns of a window.
pub(super) type Unknowns = [f64; N_UNKNOWNS];
/// Place of tilt's constant among them; yaw's are [`N_AXIS`] behind.
pub(super) const TILT: usize = 1;
/// Unknowns of an axis: constant, sine, cosine (–).
pub(super) const N_AXIS: usize = 3;

/// Sums over the points of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Sums {
    normal: [f64; N_ENTRIES],
    right: Unknowns,
}

impl Sums {
    const NONE: Self = Self { normal: [0.0; N_ENTRIES], right: [0.0; N_UNKNOWNS] };

    fn add_point(&mut self, factors: &Unknowns, wind: f64) {
        let mut entry = 0;
        for row in 0..N_UNKNOWNS {
            for column in 0..=row {
                self.normal[entry] += factors[row] * factors[column];
                entry += 1;
            }
            self.right[row] += factors[row] * wind;
        }
    }

    fn add(&mut self, other: &Self) {
        self.normal.iter_mut().zip(&other.normal).for_each(|(own, other)| *own += other);
        self.right.iter_mut().zip(&other.right).for_each(|(own, other)| *own += other);
    }

    /// Entry of the normal matrix.
    fn entry(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (row.max(column), row.min(column));
        self.normal[row * (row + 1) / 2 + column]
    }

    /// The unknowns, by Cholesky's decomposition; none where the points do not tell them apart.
    fn solved(&self) -> Option<Unknowns> {
        let mut lower = [[0.0; N_UNKNOWNS]; N_UNKNOWNS];
        for row in 0..N_UNKNOWNS {
            for column in 0..=row {
                let known: f64 =
                    (0..column).map(|inner| lower[row][inner] * lower[column][inner]).sum();
                let left = self.entry(row, column) - known;
                if row != column {
                    lower[row][column] = left / lower[column][column];
                } else if left > LEAST_PIVOT * self.entry(row, row) {
                    lower[row][row] = left.sqrt();
                } else {
                    return None;
                }
            }
        }
        let mut found = self.right;
        for row in 0..N_UNKNOWNS {
            let known: f64 = (0..row).map(|inner| lower[row][inner] * found[inner]).sum();
            found[row] = (found[row] - known) / lower[row][row];
        }
        for row in (0..N_UNKNOWNS).rev() {
            let known: f64 =
                (row + 1..N_UNKNOWNS).map(|inner| lower[inner][row] * found[inner]).sum();
            found[row] = (found[row] - known) / lower[row][row];
        }
        Some(found)
    }

    /// Mean of what the points have of tilt and yaw beyond `found` (m/s).
    fn left_over(&self, found: &Unknowns) -> [f64; 2] {
        [TILT, TILT + N_AXIS].map(|row| {
            let told: f64 =
                (0..N_UNKNOWNS).map(|index| self.entry(row, index) * found[index]).sum();
            (self.right[row] - told) / self.entry(row, row).max(f64::MIN_POSITIVE)
        })
    }
}

/// Points added up by their arrival.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Slots {
    /// Number of the slot in each place, counted from time zero; none where nothing arrived yet.
    numbers: Vec<Option<i64>>,
    sums: Vec<Sums>,
}

/// What the points of a window tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// Mean, then constant, sine and cosine of tilt and of yaw (m/s).
    pub(super) found: Unknowns,
    /// Mean square of what slots have of tilt and of yaw beyond that (m²/s²).
    pub(super) left_over: [f64; 2],
}

impl Slots {
    pub(super) fn empty() -> Self {
        Self { numbers: vec![None; N_KEPT], sums: vec![Sums::NONE; N_KEPT] }
    }

    fn place_of(number: i64) -> usize {
        number.rem_euclid(N_KEPT as i64) as usize
    }

    /// Adds a point of the slot `number`, of `factors` and axial `wind` (m/s).
    pub(super) fn add(&mut self, number: i64, factors: &Unknowns, wind: f64) {
        let place = Self::place_of(number);
        match self.numbers[place] {
            Some(there) if there > number => return,
            Some(there) if there == number => {}
            _ => {
                self.numbers[place] = Some(number);
                self.sums[place] = Sums::NONE;
            }
        }
        self.sums[place].add_point(factors, wind);
    }

    fn sums_of(&self, number: i64) -> Option<&Sums> {
        let place = Self::place_of(number);
        (self.numbers[place] == Some(number)).then(|| &self.sums[place])
    }

    /// Share of the window that ends with the slot `last` in which points arrive (–), gaps of a twelfth of a
    /// period borne.
    pub(super) fn coverage(&self, last: i64) -> f64 {
        let is_seen = |number: i64| {
            (number - N_BESIDE..=number + N_BESIDE).any(|near| self.sums_of(near).is_some())
        };
        let n_seen = Self::window(last).filter(|number| is_seen(*number)).count();
        n_seen as f64 / N_SLOTS as f64
    }

    /// The fit to the window that ends with the slot `last`; none where its points do not tell the unknowns
    /// apart.
    pub(super) fn fit(&self, last: i64) -> Option<Fit> {
        let mut total = Sums::NONE;
        Self::window(last).filter_map(|number| self.sums_of(number)).for_each(|s| total.add(s));
        let found = total.solved()?;
        let (mut squares, mut n) = ([0.0; 2], 0.0);
        for sums in Self::window(last).filter_map(|number| self.sums_of(number)) {
            for (square, left) in squares.iter_mut().zip(sums.left_over(&found)) {
                *square += left * left;
            }
            n += 1.0;
        }
        Some(Fit { found, left_over: squares.map(|square| square / n) })
    }

    fn window(last: i64) -> std::ops::RangeInclusive<i64> {
        last - N_SLOTS as i64 + 1..=last
    }
}
