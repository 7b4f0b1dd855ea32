//! Boxes of cells.

/// Cells `low..high` along x, y, z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellBox {
    pub(crate) low: [usize; 3],
    pub(crate) high: [usize; 3],
}

impl CellBox {
    pub(crate) fn is_empty(&self) -> bool {
        (0..3).any(|axis| self.low[axis] >= self.high[axis])
    }

    pub(crate) fn contains(&self, cell: [usize; 3]) -> bool {
        (0..3).all(|axis| self.low[axis] <= cell[axis] && cell[axis] < self.high[axis])
    }

    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        (0..3).all(|axis| self.low[axis] < other.high[axis] && other.low[axis] < self.high[axis])
    }

    pub(crate) fn join(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|axis| self.low[axis].min(other.low[axis])),
            high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// The box and `margin` cells around it, where there are any.
    pub(crate) fn grown(&self, margin: usize, n_cells: [usize; 3]) -> Self {
        Self {
            low: self.low.map(|low| low.saturating_sub(margin)),
            high: std::array::from_fn(|axis| (self.high[axis] + margin).min(n_cells[axis])),
        }
    }

    /// Cells, x fastest.
    pub(crate) fn cells(self) -> impl Iterator<Item = [usize; 3]> {
        let [x, y, z] = std::array::from_fn(|axis| self.low[axis]..self.high[axis]);
        z.flat_map(move |z| {
            let x = x.clone();
            y.clone().flat_map(move |y| x.clone().map(move |x| [x, y, z]))
        })
    }
}
