//! Orders of the polynomial within a bin.

use serde::{Deserialize, Serialize};

/// Order of the polynomial that is fitted to the velocity within a bin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Order {
    /// A weighted mean.
    Constant,
    /// A mean and gradients.
    Linear,
    /// The same, curved: means without the bias of curvature.
    Quadratic,
}

impl Order {
    /// All orders, the highest first.
    pub const DESCENDING: [Self; 3] = [Self::Quadratic, Self::Linear, Self::Constant];

    /// Its degree (–).
    pub fn degree(self) -> usize {
        self as usize
    }
}
