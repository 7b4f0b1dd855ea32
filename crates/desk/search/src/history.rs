//! What was evaluated, and the noise in it.

use crate::SearchError;

/// What one evaluation gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation {
    /// Each output as its blocks: means over stretches of time whose mean is the output (unit of the output).
    pub outputs: Vec<Vec<f64>>,
}

/// Points with their evaluations.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// The points, in the units of the variables.
    pub points: Vec<Vec<f64>>,
    /// What each gave.
    pub evaluations: Vec<Evaluation>,
}

/// One output over all evaluations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Observed {
    /// Mean of the blocks of each evaluation.
    pub(crate) means: Vec<f64>,
    /// Blocks of each (–).
    pub(crate) counts: Vec<f64>,
    /// Variance of one block about the mean of its evaluation, what all share taken off.
    pub(crate) noise: f64,
    /// Degrees of freedom behind it (–); 0 where there is one block each.
    pub(crate) freedom: usize,
    /// Variance of the error that the means of all evaluations share.
    pub(crate) shared: f64,
}

impl History {
    /// Evaluations (–).
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether nothing was evaluated.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Takes in one more evaluation, which is to have `n_outputs`.
    ///
    /// # Errors
    /// [`SearchError::Outputs`].
    pub fn add(
        &mut self,
        point: Vec<f64>,
        evaluation: Evaluation,
        n_outputs: usize,
    ) -> Result<(), SearchError> {
        let outputs = &evaluation.outputs;
        let is_good =
            |blocks: &Vec<f64>| !blocks.is_empty() && blocks.iter().all(|block| block.is_finite());
        if outputs.len() != n_outputs || !outputs.iter().all(is_good) {
            return Err(SearchError::Outputs { found: outputs.len(), needed: n_outputs });
        }
        self.points.push(point);
        self.evaluations.push(evaluation);
        Ok(())
    }

    /// The sum of the outputs, each times its of `weights`.
    ///
    /// Where all evaluations have the same two or more blocks and `share_blocks`, block b of each met the
    /// same wind, and their errors are taken apart: y = run + block + rest, a two-way layout. What the
    /// blocks share moves all runs alike: it says nothing against one point or another, but the level is
    /// that uncertain. Searle, Casella and McCulloch, "Variance components", 1992, §4.3.
    pub(crate) fn observed(&self, weights: &[f64], share_blocks: bool) -> Observed {
        let rows: Vec<Vec<f64>> = self.evaluations.iter().map(|one| one.sum(weights)).collect();
        let mean = |row: &Vec<f64>| row.iter().sum::<f64>() / row.len() as f64;
        let means: Vec<f64> = rows.iter().map(mean).collect();
        let counts: Vec<f64> = rows.iter().map(|row| row.len() as f64).collect();
        let (n_runs, n_blocks) = (rows.len(), rows.first().map_or(0, Vec::len));
        let mut rests: Vec<Vec<f64>> = rows
            .iter()
            .zip(&means)
            .map(|(row, mean)| row.iter().map(|value| value - mean).collect())
            .collect();
        let is_layout = share_blocks
            && n_runs > 1
            && n_blocks > 1
            && rows.iter().all(|row| row.len() == n_blocks);
        let mut of_blocks = vec![0.0; n_blocks];
        let mut freedom = rows.iter().map(|row| row.len() - 1).sum();
        if is_layout {
            for (block, of_block) in of_blocks.iter_mut().enumerate() {
                *of_block = rests.iter().map(|row| row[block]).sum::<f64>() / n_runs as f64;
            }
            for row in &mut rests {
                row.iter_mut().zip(&of_blocks).for_each(|(rest, block)| *rest -= block);
            }
            freedom = (n_runs - 1) * (n_blocks - 1);
        }
        let squares: f64 = rests.iter().flatten().map(|rest| rest * rest).sum();
        let noise = if freedom > 0 { squares / freedom as f64 } else { 0.0 };
        let shared = if is_layout {
            let squares: f64 = of_blocks.iter().map(|block| block * block).sum();
            let variance = squares / (n_blocks - 1) as f64 - noise / n_runs as f64;
            variance.max(0.0) / n_blocks as f64
        } else {
            0.0
        };
        Observed { means, counts, noise, freedom, shared }
    }
}

impl Observed {
    /// This, and then `others` of cheaper sources: all blocks have the same noise, which each tells of,
    /// and what evaluations share is that of the first.
    pub(crate) fn followed_by(mut self, others: Vec<Self>) -> Self {
        for other in others {
            let freedom = self.freedom + other.freedom;
            if freedom > 0 {
                let squares = self.noise * self.freedom as f64 + other.noise * other.freedom as f64;
                self.noise = squares / freedom as f64;
            }
            self.freedom = freedom;
            self.means.extend(other.means);
            self.counts.extend(other.counts);
        }
        self
    }
}

impl Evaluation {
    /// Block by block the sum of the outputs, each times its of `weights`; as many blocks as all have.
    fn sum(&self, weights: &[f64]) -> Vec<f64> {
        let parts = || self.outputs.iter().zip(weights).filter(|(_, weight)| **weight != 0.0);
        let n = parts().map(|(blocks, _)| blocks.len()).min().unwrap_or(0);
        let of_block = |block: usize| parts().map(|(blocks, weight)| weight * blocks[block]).sum();
        (0..n).map(of_block).collect()
    }
}
