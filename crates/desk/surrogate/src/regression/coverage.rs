//! How many values lie inside their bands.

/// 97.5 % point of the normal distribution (–).
pub(super) const NORMAL_97_5: f64 = 1.959_963_984_540_054;

/// A share of values, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// Share of the values (%).
    pub share: f64,
    /// Where the share of many more values lies, were these drawn independently (%).
    pub interval: [f64; 2],
}

impl Coverage {
    /// Of `n_inside` values out of `n`.
    ///
    /// Source: Wilson, "Probable inference, the law of succession, and statistical inference", J. Am. Stat.
    /// Assoc. 22, 1927.
    pub fn new(n_inside: usize, n: usize) -> Self {
        let (n, share) = (n as f64, n_inside as f64 / n as f64);
        let square = NORMAL_97_5 * NORMAL_97_5 / n;
        let centre = (share + 0.5 * square) / (1.0 + square);
        let half =
            (square * share * (1.0 - share) + 0.25 * square * square).sqrt() / (1.0 + square);
        // Rounding may leave an end outside where all or none are inside.
        let ends = [(centre - half).max(0.0), (centre + half).min(1.0)];
        Self { share: 100.0 * share, interval: ends.map(|end| 100.0 * end) }
    }
}

#[cfg(test)]
mod tests;
