//! Observations as they are worked with: replicates collapsed, inputs and values scaled.

use super::expression::{Kernel, Parameters};
use crate::{Observations, SurrogateError};
use faer::Mat;
use std::collections::BTreeMap;

/// Mean of the curve far from observations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Trend {
    /// Zero.
    Zero,
    /// A constant, estimated by generalised least squares.
    #[default]
    Constant,
    /// A constant and a slope for each input, likewise.
    Linear,
}

impl Trend {
    /// Coefficients over `n_dimensions` inputs (–).
    pub(crate) fn n_coefficients(self, n_dimensions: usize) -> usize {
        match self {
            Self::Zero => 0,
            Self::Constant => 1,
            Self::Linear => 1 + n_dimensions,
        }
    }
}

/// Which observations share an estimated noise.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum NoiseGroups {
    /// All of them.
    #[default]
    One,
    /// Those of the same number, one for each observation, from 0 on without gaps.
    Each(Vec<usize>),
    /// None: no noise beyond the known variances.
    Known,
}

/// Observations in the user's units, those of the same input, noise group and known variance as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Collapsed {
    /// Inputs, those of one observation together (units of the inputs).
    pub inputs: Vec<f64>,
    /// Mean of the replicates of each (unit of the values).
    pub values: Vec<f64>,
    /// Replicates of each (–).
    pub counts: Vec<f64>,
    /// Squares of the replicates about their mean, summed (unit of the values, squared).
    pub within: Vec<f64>,
    /// Known variance of one replicate (unit of the values, squared).
    pub known: Vec<f64>,
    /// Group of noise of each.
    pub groups: Vec<usize>,
}

/// Inputs and values over their own spread.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Scaling {
    pub(crate) centres: Vec<f64>,
    pub(crate) scales: Vec<f64>,
    pub(crate) centre: f64,
    pub(crate) scale: f64,
}

/// Observations of different input, noise group or known variance, each the mean of its replicates.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) scaling: Scaling,
    pub(crate) trend: Trend,
    /// Scaled inputs, a column for each.
    pub(crate) inputs: Vec<Vec<f64>>,
    /// Scaled means.
    pub(crate) values: Vec<f64>,
    /// Replicates behind each (–).
    pub(crate) counts: Vec<f64>,
    /// Squares of the replicates about their mean, summed and scaled.
    pub(crate) within: Vec<f64>,
    /// Known variance of one replicate, scaled.
    pub(crate) known: Vec<f64>,
    /// Group of noise of each.
    pub(crate) groups: Vec<usize>,
    /// Noise variances to be estimated (–).
    pub(crate) n_groups: usize,
}

/// Mean and standard deviation, the latter 1 where all are the same.
fn centre_and_scale(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let centre = values.clone().sum::<f64>() / n;
    let spread = (values.map(|value| (value - centre).powi(2)).sum::<f64>() / n).sqrt();
    (centre, if spread > 1e-12 * centre.abs() { spread } else { 1.0 })
}

impl Problem {
    pub(crate) fn new(
        observations: &Observations,
        groups: &NoiseGroups,
        kernel: &Kernel,
        trend: Trend,
    ) -> Result<Self, SurrogateError> {
        observations.check()?;
        kernel.check(observations.n_dimensions)?;
        let (group_of, n_groups) = grouped(groups, observations.len())?;
        let scaling = Scaling::new(observations, kernel, trend)?;
        let mut problem = Self {
            inputs: vec![Vec::new(); observations.n_dimensions],
            scaling,
            trend,
            values: Vec::new(),
            counts: Vec::new(),
            within: Vec::new(),
            known: Vec::new(),
            groups: Vec::new(),
            n_groups,
        };
        problem.collapse(observations, &group_of);
        Ok(problem)
    }

    /// Takes in `observations`, those of the same input, group and known variance as one.
    fn collapse(&mut self, observations: &Observations, group_of: &[usize]) {
        let Scaling { centres, scales, centre, scale } = &self.scaling;
        let mut found: BTreeMap<(Vec<u64>, usize, u64), usize> = BTreeMap::new();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for (index, group) in group_of.iter().copied().enumerate() {
            let input = observations.input(index);
            let known = observations.variance(index);
            // Adding zero makes −0 and 0 the same.
            let bits = input.iter().map(|x| (x + 0.0).to_bits()).collect();
            let key = (bits, group, (known + 0.0).to_bits());
            let place = *found.entry(key).or_insert(rows.len());
            if place == rows.len() {
                rows.push(Vec::new());
                for (column, (x, (centre, scale))) in
                    self.inputs.iter_mut().zip(input.iter().zip(centres.iter().zip(scales)))
                {
                    column.push((x - centre) / scale);
                }
                self.known.push(known / (scale * scale));
                self.groups.push(group);
            }
            rows[place].push((observations.values[index] - centre) / scale);
        }
        for row in rows {
            let n = row.len() as f64;
            let mean = row.iter().sum::<f64>() / n;
            self.values.push(mean);
            self.counts.push(n);
            self.within.push(row.iter().map(|value| (value - mean).powi(2)).sum());
        }
    }

    /// Of observations that were collapsed before.
    pub(crate) fn restore(
        collapsed: &Collapsed,
        parameters: &Parameters,
        trend: Trend,
    ) -> Result<Self, SurrogateError> {
        let n = collapsed.values.len();
        let n_dimensions = collapsed.inputs.len().checked_div(n).unwrap_or(0);
        let observations = Observations {
            inputs: collapsed.inputs.clone(),
            n_dimensions,
            values: collapsed.values.clone(),
            variances: collapsed.known.clone(),
        };
        observations.check()?;
        parameters.kernel.check(n_dimensions)?;
        let others = [&collapsed.counts, &collapsed.within].map(|part| part.len());
        if let Some(found) = others.into_iter().chain([collapsed.groups.len()]).find(|l| *l != n) {
            let what = "a list of the observations";
            return Err(SurrogateError::Lengths { what, found, needed: n });
        }
        let scaling = Scaling::new(&observations, &parameters.kernel, trend)?;
        let Scaling { centre, scale, .. } = scaling;
        let over = |values: &[f64]| values.iter().map(|v| v / (scale * scale)).collect();
        Ok(Self {
            inputs: scaling.columns(&collapsed.inputs),
            values: collapsed.values.iter().map(|value| (value - centre) / scale).collect(),
            counts: collapsed.counts.clone(),
            within: over(&collapsed.within),
            known: over(&collapsed.known),
            groups: collapsed.groups.clone(),
            n_groups: parameters.noise.len(),
            trend,
            scaling,
        })
    }

    /// The observations in the user's units.
    pub(crate) fn collapsed(&self) -> Collapsed {
        let Scaling { centre, scale, .. } = self.scaling;
        let square = scale * scale;
        Collapsed {
            inputs: self.scaling.rows(&self.inputs),
            values: self.values.iter().map(|value| centre + scale * value).collect(),
            counts: self.counts.clone(),
            within: self.within.iter().map(|within| within * square).collect(),
            known: self.known.iter().map(|known| known * square).collect(),
            groups: self.groups.clone(),
        }
    }

    /// Observations, those of the same input, group and known variance as one (–).
    pub(crate) fn len(&self) -> usize {
        self.values.len()
    }

    pub(crate) fn n_dimensions(&self) -> usize {
        self.inputs.len()
    }

    /// Observations behind it (–).
    pub(crate) fn n_observations(&self) -> f64 {
        self.counts.iter().sum()
    }

    /// The observations number `chosen` alone.
    pub(crate) fn subset(&self, chosen: &[usize]) -> Self {
        let of = |values: &[f64]| chosen.iter().map(|index| values[*index]).collect::<Vec<f64>>();
        Self {
            scaling: self.scaling.clone(),
            trend: self.trend,
            inputs: self.inputs.iter().map(|column| of(column)).collect(),
            values: of(&self.values),
            counts: of(&self.counts),
            within: of(&self.within),
            known: of(&self.known),
            groups: chosen.iter().map(|index| self.groups[*index]).collect(),
            n_groups: self.n_groups,
        }
    }

    /// Variance of one replicate of observation `index` where the groups have `noise`.
    pub(crate) fn variance(&self, index: usize, noise: &[f64]) -> f64 {
        self.known[index] + noise.get(self.groups[index]).copied().unwrap_or(0.0)
    }

    /// The trend's functions at scaled `inputs`: a row for each of `n` points.
    pub(crate) fn basis(&self, inputs: &[Vec<f64>], n: usize) -> Mat<f64> {
        let n_coefficients = self.trend.n_coefficients(self.n_dimensions());
        Mat::from_fn(n, n_coefficients, |row, column| match column {
            0 => 1.0,
            column => inputs[column - 1][row],
        })
    }
}

impl Scaling {
    fn new(data: &Observations, kernel: &Kernel, trend: Trend) -> Result<Self, SurrogateError> {
        let (mut centres, mut scales) = (Vec::new(), Vec::new());
        for input in 0..data.n_dimensions {
            let column = data.inputs.iter().skip(input).step_by(data.n_dimensions).copied();
            let mut others = column.clone();
            let first = others.next().unwrap_or_default();
            if data.len() > 1 && others.all(|other| other == first) {
                return Err(SurrogateError::Constant { input, value: first });
            }
            let (centre, scale) = centre_and_scale(column);
            centres.push(centre);
            scales.push(if kernel.keeps_unit(input) { 1.0 } else { scale });
        }
        let (centre, scale) = centre_and_scale(data.values.iter().copied());
        // Where the trend is zero, so it is in the values' own unit.
        let centre = if trend == Trend::Zero { 0.0 } else { centre };
        Ok(Self { centres, scales, centre, scale })
    }

    /// The constant and slopes in the user's units of `scaled` ones.
    pub(crate) fn coefficients(&self, scaled: &[f64]) -> Vec<f64> {
        let mut found = scaled.to_vec();
        let Some((constant, slopes)) = found.split_first_mut() else { return found };
        *constant = self.centre + self.scale * *constant;
        for (slope, (centre, scale)) in slopes.iter_mut().zip(self.centres.iter().zip(&self.scales))
        {
            *slope *= self.scale / scale;
            *constant -= *slope * centre;
        }
        found
    }

    /// Scaled `columns` in the user's units, those of one point together.
    pub(crate) fn rows(&self, columns: &[Vec<f64>]) -> Vec<f64> {
        let n = columns.first().map_or(0, Vec::len);
        let mut rows = Vec::with_capacity(n * columns.len());
        for index in 0..n {
            for (column, (centre, scale)) in
                columns.iter().zip(self.centres.iter().zip(&self.scales))
            {
                rows.push(centre + scale * column[index]);
            }
        }
        rows
    }

    /// `inputs`, those of one point together, as scaled columns.
    pub(crate) fn columns(&self, inputs: &[f64]) -> Vec<Vec<f64>> {
        let n_dimensions = self.centres.len();
        let scales = self.centres.iter().zip(&self.scales).enumerate();
        let column = |(input, (centre, scale))| {
            let values = inputs.iter().skip(input).step_by(n_dimensions);
            values.map(|x: &f64| (x - centre) / scale).collect()
        };
        scales.map(column).collect()
    }
}

/// Group of each of `n` observations, and groups (–).
fn grouped(groups: &NoiseGroups, n: usize) -> Result<(Vec<usize>, usize), SurrogateError> {
    match groups {
        NoiseGroups::One => Ok((vec![0; n], 1)),
        NoiseGroups::Known => Ok((vec![0; n], 0)),
        NoiseGroups::Each(of_each) => {
            if of_each.len() != n {
                let (what, found) = ("the list of noise groups", of_each.len());
                return Err(SurrogateError::Lengths { what, found, needed: n });
            }
            let n_groups = of_each.iter().max().map_or(0, |most| most + 1);
            match (0..n_groups).find(|group| !of_each.contains(group)) {
                Some(group) => Err(SurrogateError::EmptyGroup { group }),
                None => Ok((of_each.clone(), n_groups)),
            }
        }
    }
}
