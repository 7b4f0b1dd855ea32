//! Velocity in a plane, and where it turns about a point: vorticity across it, Γ₁ and Γ₂.

use basis::records::Grid;

/// Velocity in a plane, first axis fastest.
///
/// Axes come in the order x, y, z; turning from the first to the second is positive: about z in a horizontal
/// plane, about x in one across the wind, and about −y in one along the wind.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Coordinates of the first point along both axes (m).
    pub origin: [f64; 2],
    /// Distance of neighbouring points (m).
    pub spacing: [f64; 2],
    /// Points (–).
    pub n_points: [usize; 2],
    /// Velocity along both axes (m/s).
    pub velocity: [Vec<f64>; 2],
}

impl Section {
    /// The components of `velocity` (m/s) in the plane that `grid` spans; none where it spans another thing.
    pub fn of(grid: &Grid, velocity: &[Vec<f64>; 3]) -> Option<Self> {
        let [first, second] = grid.spanned().try_into().ok()?;
        Some(Self {
            origin: [grid.origin[first], grid.origin[second]],
            spacing: [grid.spacing[first], grid.spacing[second]],
            n_points: [grid.n_points[first], grid.n_points[second]],
            velocity: [velocity[first].clone(), velocity[second].clone()],
        })
    }

    /// Position of point number `index` (m).
    pub fn position(&self, index: usize) -> [f64; 2] {
        let place = [index % self.n_points[0], index / self.n_points[0]];
        std::array::from_fn(|axis| self.origin[axis] + place[axis] as f64 * self.spacing[axis])
    }

    /// Points (–).
    pub(super) fn len(&self) -> usize {
        self.n_points[0] * self.n_points[1]
    }

    /// Vorticity across the plane at each point (1/s).
    pub fn vorticity(&self) -> Vec<f64> {
        let grid = Grid {
            origin: [self.origin[0], self.origin[1], 0.0],
            spacing: [self.spacing[0], self.spacing[1], 1.0],
            n_points: [self.n_points[0], self.n_points[1], 1],
        };
        let along = crate::grids::slopes(&grid, &self.velocity[1], 0);
        let across = crate::grids::slopes(&grid, &self.velocity[0], 1);
        along.iter().zip(&across).map(|(a, b)| a - b).collect()
    }

    /// Γ₁ and Γ₂ at each point (–), of windows that reach `reach` points to each side; not a number at points
    /// that are nearer to an edge, or to a hole.
    ///
    /// |Γ₁| is 1 at the middle of a round vortex that stands still; |Γ₂|, whose window's mean velocity is
    /// taken off, is above 2/π in its core.
    /// Source: Graftieaux, Michard and Grosjean (2001), Meas. Sci. Technol. 12, 1422.
    pub fn turning(&self, reach: usize) -> (Vec<f64>, Vec<f64>) {
        (0..self.len()).map(|index| self.turning_at(index, reach)).unzip()
    }

    /// The same at point number `index`.
    pub(super) fn turning_at(&self, index: usize, reach: usize) -> (f64, f64) {
        let [n_first, n_second] = self.n_points;
        let place = [index % n_first, index / n_first];
        let inside = |axis: usize, n: usize| place[axis] >= reach && place[axis] + reach < n;
        if reach == 0 || !inside(0, n_first) || !inside(1, n_second) {
            return (f64::NAN, f64::NAN);
        }
        let window = || {
            let rows = place[1] - reach..=place[1] + reach;
            rows.flat_map(move |row| {
                (place[0] - reach..=place[0] + reach).map(move |column| row * n_first + column)
            })
        };
        let n = ((2 * reach + 1).pow(2)) as f64;
        let mean = self.velocity.each_ref().map(|v| window().map(|i| v[i]).sum::<f64>() / n);
        let centre = self.position(index);
        let (mut first, mut second) = (0.0, 0.0);
        for other in window().filter(|other| *other != index) {
            let at = self.position(other);
            let away = [at[0] - centre[0], at[1] - centre[1]];
            let own = [self.velocity[0][other], self.velocity[1][other]];
            first += sine(away, own);
            second += sine(away, [own[0] - mean[0], own[1] - mean[1]]);
        }
        (first / (n - 1.0), second / (n - 1.0))
    }
}

/// Sine of the angle from `a` to `b`; zero where one has no length.
fn sine(a: [f64; 2], b: [f64; 2]) -> f64 {
    let length = a[0].hypot(a[1]) * b[0].hypot(b[1]);
    if length == 0.0 { 0.0 } else { (a[0] * b[1] - a[1] * b[0]) / length }
}
