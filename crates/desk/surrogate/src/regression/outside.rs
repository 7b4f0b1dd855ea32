//! Points beyond what was observed.

use super::process::Regression;

/// Points asked for beyond what one input was observed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outside {
    /// Which input, the first is 0.
    pub input: usize,
    /// Points outside (–).
    pub n_points: usize,
    /// The first of them.
    pub first: usize,
    /// The value that lies furthest outside (unit of the input).
    pub furthest: f64,
    /// The point that has it.
    pub furthest_point: usize,
    /// Least and greatest value that was observed (unit of the input).
    pub range: [f64; 2],
}

impl Outside {
    /// What of the values `asked` of an `input` lies outside the `range` that was observed, more than the
    /// rounding of numbers in files; none where nothing does.
    pub fn of(input: usize, range: [f64; 2], asked: &[f64]) -> Option<Self> {
        let [low, high] = range;
        let bearing = 1e-9 * (high - low);
        let beyond = |x: f64| (low - x).max(x - high);
        let out: Vec<usize> = (0..asked.len()).filter(|at| beyond(asked[*at]) > bearing).collect();
        let furthest_point =
            out.iter().copied().max_by(|a, b| beyond(asked[*a]).total_cmp(&beyond(asked[*b])))?;
        Some(Self {
            input,
            n_points: out.len(),
            first: out[0],
            furthest: asked[furthest_point],
            furthest_point,
            range,
        })
    }
}

impl Regression {
    /// Which of `inputs` lie outside what was observed, input by input.
    pub fn outside(&self, inputs: &[f64]) -> Vec<Outside> {
        let collapsed = self.problem.scaling.rows(&self.problem.inputs);
        let n_dimensions = self.n_dimensions();
        (0..n_dimensions)
            .filter_map(|input| {
                let of = |all: &[f64]| -> Vec<f64> {
                    all.iter().skip(input).step_by(n_dimensions).copied().collect()
                };
                let observed = of(&collapsed);
                let low = observed.iter().copied().fold(f64::INFINITY, f64::min);
                let high = observed.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                Outside::of(input, [low, high], &of(inputs))
            })
            .collect()
    }
}
