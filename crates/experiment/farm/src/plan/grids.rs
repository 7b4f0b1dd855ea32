//! The grids of a plan: that of the domain, and those of the boxes of finer cells in it.

use super::Plan;
use flow::lattice::refinement::Refinement;

/// Cells of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct GridOfPlan {
    /// Corner with the least coordinates, farm frame (m).
    pub origin: [f64; 3],
    /// Edge of a cell (m).
    pub spacing: f64,
    /// Cells along x, y, z (–).
    pub n_cells: [usize; 3],
    /// Boxes within one another that it lies in, itself included (–); 0 is the domain.
    pub level: u32,
}

impl GridOfPlan {
    /// Cells in all (–).
    pub fn cells(&self) -> usize {
        self.n_cells.iter().product()
    }

    fn add_boxes(&self, boxes: &[Refinement], all: &mut Vec<GridOfPlan>) {
        for one in boxes {
            let origin = std::array::from_fn(|axis| {
                self.origin[axis] + one.first_cell[axis] as f64 * self.spacing
            });
            let (n_cells, level) = (one.fine_cells(), self.level + 1);
            let grid = GridOfPlan { origin, spacing: 0.5 * self.spacing, n_cells, level };
            all.push(grid.clone());
            grid.add_boxes(&one.within, all);
        }
    }
}

impl Plan {
    /// The grid of the domain, and those of all boxes, each before those in it.
    pub fn grids(&self) -> Vec<GridOfPlan> {
        let (origin, spacing) = (self.origin.to_array(), self.spacing);
        let domain = GridOfPlan { origin, spacing, n_cells: self.n_cells, level: 0 };
        let mut all = vec![domain.clone()];
        domain.add_boxes(&self.boxes, &mut all);
        all
    }

    /// Boxes within one another, at most (–).
    pub fn depth(&self) -> u32 {
        self.boxes.iter().map(Refinement::depth).max().unwrap_or(0)
    }

    /// Duration of a step of the domain's own cells (s).
    pub fn base_interval(&self) -> f64 {
        self.interval * f64::from(1_u32 << self.depth())
    }

    /// Edge of the cells that turbine number `index` stands in (m).
    pub fn spacing_at(&self, index: usize) -> f64 {
        let level = self.levels.get(index).copied().unwrap_or(0);
        self.spacing / f64::from(1_u32 << level)
    }

    /// The plan of turbine number `index` in cells like those that it stands in everywhere, at the same
    /// steps: what it is checked and identified in, alone.
    pub fn alone(&self, index: usize) -> Self {
        let spacing = self.spacing_at(index);
        Self { spacing, boxes: Vec::new(), levels: Vec::new(), ..self.clone() }
    }

    /// Cells of all grids (–).
    pub fn cells(&self) -> usize {
        self.grids().iter().map(GridOfPlan::cells).sum()
    }

    /// Cell updates of a step, in the mean over those of all grids (–).
    pub fn updates_of_step(&self) -> f64 {
        let depth = self.depth();
        let of_grid =
            |grid: &GridOfPlan| grid.cells() as f64 / f64::from(1_u32 << (depth - grid.level));
        self.grids().iter().map(of_grid).sum()
    }

    /// Cell updates of one run (–).
    pub fn updates(&self) -> f64 {
        self.updates_of_step() * self.n_steps as f64
    }

    /// Memory of what grids hand each other (bytes), about, in air with temperature (`is_warm`) or without.
    pub fn exchange_memory(&self, is_warm: bool) -> u64 {
        let stencil = self.method.stencil;
        self.boxes.iter().map(|one| one.exchange_memory(stencil, is_warm)).sum()
    }

    /// Time between rows of the series (s).
    pub fn row_interval(&self) -> f64 {
        self.row_stride as f64 * self.interval
    }
}
