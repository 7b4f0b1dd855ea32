//! Least squares of a signal on a few given ones.

/// Sums of a fit of N signals.
#[derive(Clone, Debug)]
pub(crate) struct Fit<const N: usize> {
    normal: [[f64; N]; N],
    right: [f64; N],
    square: f64,
    n: f64,
}

impl<const N: usize> Default for Fit<N> {
    fn default() -> Self {
        Self { normal: [[0.0; N]; N], right: [0.0; N], square: 0.0, n: 0.0 }
    }
}

impl<const N: usize> Fit<N> {
    /// Takes in one instant: the given signals' values and the one to be explained.
    pub(crate) fn add(&mut self, row: [f64; N], value: f64) {
        for (line, x) in self.normal.iter_mut().zip(row) {
            line.iter_mut().zip(row).for_each(|(cell, y)| *cell += x * y);
        }
        self.right.iter_mut().zip(row).for_each(|(cell, x)| *cell += x * value);
        self.square += value * value;
        self.n += 1.0;
    }

    /// How much of each signal there is.
    pub(crate) fn parts(&self) -> [f64; N] {
        let (mut matrix, mut right) = (self.normal, self.right);
        // A positive definite matrix needs no pivots.
        for pivot in 0..N {
            let (line, value) = (matrix[pivot], right[pivot]);
            for row in (0..N).filter(|row| *row != pivot) {
                let factor = matrix[row][pivot] / line[pivot];
                matrix[row].iter_mut().zip(line).for_each(|(cell, above)| *cell -= factor * above);
                right[row] -= factor * value;
            }
        }
        std::array::from_fn(|index| right[index] / matrix[index][index])
    }

    /// Mean square of what they do not explain.
    pub(crate) fn rest(&self) -> f64 {
        let explained: f64 = self.parts().iter().zip(&self.right).map(|(x, y)| x * y).sum();
        (self.square - explained) / self.n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_known_sum() {
        let mut fit = Fit::<3>::default();
        for step in 0..50 {
            let angle = 0.07 * f64::from(step);
            let row = [1.0, angle.sin(), angle.cos()];
            fit.add(
                row,
                4.0 - 2.0 * row[1] + 0.5 * row[2] + if step % 2 == 0 { 1e-3 } else { -1e-3 },
            );
        }
        let [mean, sine, cosine] = fit.parts();
        assert!(
            (mean - 4.0).abs() < 1e-3 && (sine + 2.0).abs() < 1e-3 && (cosine - 0.5).abs() < 1e-3
        );
        assert!((fit.rest() - 1e-6).abs() < 1e-7);
    }
}
