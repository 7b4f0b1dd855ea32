//! What is searched over: ranges of variables, and the points in them.

use crate::SearchError;
use crate::draws::Draws;

/// Points that are looked at in each round, about (–), and steps along a variable alone.
const N_CANDIDATES: usize = 1089;
const MOST_LEVELS: usize = 201;
/// Numbers of variables up to which candidates stand on a lattice (–).
const MOST_ON_LATTICE: usize = 4;

/// The range of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Lower end (its unit).
    pub from: f64,
    /// Upper end (its unit).
    pub to: f64,
    /// Values are whole multiples of it above `from` (its unit); any value where absent.
    pub step: Option<f64>,
    /// Half width of what is left out around zero (its unit): of a variable that counts one way above zero
    /// and the other way below it.
    pub gap: f64,
}

impl Axis {
    /// All values between `from` and `to` (its unit).
    pub fn new(from: f64, to: f64) -> Self {
        Self { from, to, step: None, gap: 0.0 }
    }

    /// Values from `from` to `to` (its unit, above zero), and the same below zero.
    pub fn mirrored(from: f64, to: f64) -> Self {
        Self { from: -to, to, step: None, gap: from }
    }

    /// The pieces of its range, ascending.
    fn pieces(&self) -> Vec<[f64; 2]> {
        if self.gap > 0.0 {
            vec![[self.from, -self.gap], [self.gap, self.to]]
        } else {
            vec![[self.from, self.to]]
        }
    }

    /// The value at `share` (–) of the way along its pieces.
    fn at(&self, share: f64) -> f64 {
        let pieces = self.pieces();
        let length: f64 = pieces.iter().map(|[low, high]| high - low).sum();
        let mut left = share * length;
        for [low, high] in &pieces {
            if left <= high - low {
                return low + left;
            }
            left -= high - low;
        }
        self.to
    }

    /// The nearest value that is allowed.
    pub fn snap(&self, value: f64) -> f64 {
        let clear = if value.abs() < self.gap {
            self.gap.copysign(value)
        } else {
            value.clamp(self.from, self.to)
        };
        let Some(step) = self.step else { return clear };
        // Of a mirrored variable both halves have the same steps, away from zero.
        let base = if self.gap > 0.0 { self.gap } else { self.from };
        let (size, sign) =
            if self.gap > 0.0 { (clear.abs(), clear.signum()) } else { (clear, 1.0) };
        let most = ((self.to - base) / step + 1e-9).floor();
        let n = ((size - base) / step).round().clamp(0.0, most);
        // Through decimals, so that 0.1 + 2 × 0.05 is 0.2 in files.
        sign * rounded(base + n * step)
    }

    /// Values spread over it, ascending, all of its steps where they are no more than `most`.
    fn levels(&self, most: usize) -> Vec<f64> {
        let length: f64 = self.pieces().iter().map(|[low, high]| high - low).sum();
        let n_steps =
            self.step.map(|step| (length / step + 1e-9).floor() as usize + self.pieces().len());
        let n = n_steps.filter(|n| *n <= most).unwrap_or(most).max(2);
        let mut values: Vec<f64> =
            (0..n).map(|place| self.snap(self.at(place as f64 / (n - 1) as f64))).collect();
        if n_steps == Some(n) {
            // Steps and the gap do not fall together: add what was passed over.
            let step = self.step.unwrap_or(1.0);
            for [low, _] in self.pieces() {
                values.extend((0..n).map(|place| self.snap(low + step * place as f64)));
            }
        }
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    }
}

/// `value` to twelve decimals of its own size.
fn rounded(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// The ranges of all variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Space {
    axes: Vec<Axis>,
}

impl Space {
    /// The space of `axes`.
    ///
    /// # Errors
    /// [`SearchError::NoAxes`], [`SearchError::Range`], [`SearchError::Step`].
    pub fn new(axes: Vec<Axis>) -> Result<Self, SearchError> {
        if axes.is_empty() {
            return Err(SearchError::NoAxes);
        }
        for (axis, Axis { from, to, step, gap }) in axes.iter().copied().enumerate() {
            let is_good = from.is_finite() && to.is_finite() && from < to && gap >= 0.0 && gap < to;
            if !is_good {
                return Err(SearchError::Range { axis, from, to });
            }
            if let Some(step) = step.filter(|step| !(*step > 0.0 && *step <= to - from)) {
                return Err(SearchError::Step { axis, step });
            }
        }
        Ok(Self { axes })
    }

    /// The variables.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Variables (–).
    pub fn n_dimensions(&self) -> usize {
        self.axes.len()
    }

    /// The nearest point that is allowed.
    pub fn snap(&self, point: &[f64]) -> Vec<f64> {
        self.axes.iter().zip(point).map(|(axis, value)| axis.snap(*value)).collect()
    }

    /// Whether `point` lies within all ranges.
    pub fn holds(&self, point: &[f64]) -> bool {
        let is_in = |(axis, value): (&Axis, &f64)| {
            (axis.from..=axis.to).contains(value) && value.abs() >= axis.gap
        };
        point.len() == self.axes.len() && self.axes.iter().zip(point).all(is_in)
    }

    /// The point at `shares` (–) of the way along each variable.
    pub(crate) fn at(&self, shares: &[f64]) -> Vec<f64> {
        self.axes.iter().zip(shares).map(|(axis, share)| axis.snap(axis.at(*share))).collect()
    }

    /// `point` over the ranges (–): from 0 to 1, across a gap as well.
    pub fn scaled(&self, point: &[f64]) -> Vec<f64> {
        let of_axis = |(axis, value): (&Axis, &f64)| (value - axis.from) / (axis.to - axis.from);
        self.axes.iter().zip(point).map(of_axis).collect()
    }

    /// Points to choose from: a lattice over few variables, drawn points over many.
    pub fn candidates(&self, seed: u64) -> Vec<Vec<f64>> {
        let n = self.n_dimensions();
        if n > MOST_ON_LATTICE {
            let mut draws = Draws::new(seed, 3);
            let drawn = |_| {
                let shares: Vec<f64> = (0..n).map(|_| draws.uniform()).collect();
                self.at(&shares)
            };
            return distinct((0..N_CANDIDATES).map(drawn).collect());
        }
        let most = ((N_CANDIDATES as f64).powf(1.0 / n as f64).round() as usize).min(MOST_LEVELS);
        self.lattice(most)
    }

    /// The points of a lattice of up to `most` values along each variable, the first variable slowest.
    pub fn lattice(&self, most: usize) -> Vec<Vec<f64>> {
        let mut points = vec![Vec::new()];
        for axis in &self.axes {
            let levels = axis.levels(most);
            points = points
                .iter()
                .flat_map(|point: &Vec<f64>| {
                    levels.iter().map(|level| [point.as_slice(), &[*level]].concat())
                })
                .collect();
        }
        points
    }
}

/// `points` without those that came before.
pub(crate) fn distinct(points: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let mut kept: Vec<Vec<f64>> = Vec::with_capacity(points.len());
    for point in points {
        if !kept.contains(&point) {
            kept.push(point);
        }
    }
    kept
}
