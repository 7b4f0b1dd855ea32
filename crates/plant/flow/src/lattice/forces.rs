//! Forces on the air as boxes of cells.

use std::ops::Range;

/// Force density (lattice units) on a box of cells, x fastest. Boxes of one list do not overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForceBlock {
    /// First cell along x, y, z.
    pub origin: [usize; 3],
    /// Cells along x, y, z.
    pub size: [usize; 3],
    /// Components along x, y, z, one value per cell each.
    pub force: [Vec<f32>; 3],
}

impl ForceBlock {
    /// On return the block covers `size` cells from `origin` and carries nothing; its storage is reused.
    pub fn reset(&mut self, origin: [usize; 3], size: [usize; 3]) {
        self.origin = origin;
        self.size = size;
        let n = size.iter().product();
        for component in &mut self.force {
            component.clear();
            component.resize(n, 0.0);
        }
    }

    /// Cells of the block's row at (`y`, `z`) of the grid, as a range of indices, when it has one there.
    #[inline]
    pub fn row(&self, y: usize, z: usize) -> Option<Range<usize>> {
        let (dy, dz) = (y.wrapping_sub(self.origin[1]), z.wrapping_sub(self.origin[2]));
        (dy < self.size[1] && dz < self.size[2]).then(|| {
            let start = (dz * self.size[1] + dy) * self.size[0];
            start..start + self.size[0]
        })
    }

    /// Force density on cell (`x`, `y`, `z`) of the grid, when the block holds it.
    #[inline]
    pub fn at(&self, x: usize, y: usize, z: usize) -> Option<[f32; 3]> {
        let dx = x.wrapping_sub(self.origin[0]);
        if dx >= self.size[0] {
            return None;
        }
        let index = self.row(y, z)?.start + dx;
        Some([self.force[0][index], self.force[1][index], self.force[2][index]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_cells_name_the_same_values() {
        let mut block = ForceBlock::default();
        block.reset([2, 3, 4], [3, 2, 2]);
        for (index, value) in block.force[1].iter_mut().enumerate() {
            *value = index as f32;
        }
        assert_eq!(block.row(4, 5), Some(9..12));
        assert_eq!(block.row(2, 5), None);
        assert_eq!(block.row(4, 6), None);
        assert_eq!(block.at(3, 4, 5), Some([0.0, 10.0, 0.0]));
        assert_eq!(block.at(1, 4, 5), None);
        assert_eq!(block.at(5, 4, 5), None);
    }
}
