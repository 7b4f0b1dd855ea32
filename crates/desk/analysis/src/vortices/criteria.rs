//! What tells a vortex from shear: vorticity, Q, λ₂.

use crate::grids::slopes;
use basis::records::Grid;

/// Slopes of velocity at a point (1/s): row the component, column the axis.
pub type Gradient = [[f64; 3]; 3];

/// Slopes of `velocity` (m/s) at each point of `grid`; those along an axis with one point are taken as zero.
pub fn gradients(grid: &Grid, velocity: &[Vec<f64>; 3]) -> Vec<Gradient> {
    let all: [[Vec<f64>; 3]; 3] = std::array::from_fn(|component| {
        std::array::from_fn(|axis| slopes(grid, &velocity[component], axis))
    });
    let at = |index: usize| all.each_ref().map(|rows| rows.each_ref().map(|row| row[index]));
    (0..grid.len()).map(at).collect()
}

/// Vorticity (1/s).
pub fn vorticity(gradient: &Gradient) -> [f64; 3] {
    let g = gradient;
    [g[2][1] - g[1][2], g[0][2] - g[2][0], g[1][0] - g[0][1]]
}

/// Q (1/s²): positive where turning outweighs straining.
///
/// Source: Hunt, Wray and Moin (1988); van der Hoek et al. (2024), Eq. 7: ½ (tr(∇u)² − tr((∇u)²)).
pub fn q_criterion(gradient: &Gradient) -> f64 {
    let g = gradient;
    let trace = g[0][0] + g[1][1] + g[2][2];
    let square: f64 = (0..3).map(|i| (0..3).map(|j| g[i][j] * g[j][i]).sum::<f64>()).sum::<f64>();
    0.5 * (trace * trace - square)
}

/// λ₂ (1/s²): the middle eigenvalue of S² + Ω², negative in the core of a vortex.
///
/// Source: Jeong and Hussain (1995), "On the identification of a vortex", J. Fluid Mech. 285.
pub fn lambda_2(gradient: &Gradient) -> f64 {
    let g = gradient;
    let half = |i: usize, j: usize, sign: f64| 0.5 * (g[i][j] + sign * g[j][i]);
    let mut sum = [[0.0; 3]; 3];
    for (i, row) in sum.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = (0..3)
                .map(|k| half(i, k, 1.0) * half(k, j, 1.0) + half(i, k, -1.0) * half(k, j, -1.0))
                .sum();
        }
    }
    middle_eigenvalue(&sum)
}

/// The middle eigenvalue of a symmetric matrix, in closed form.
fn middle_eigenvalue(a: &[[f64; 3]; 3]) -> f64 {
    let mean = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
    let off = a[0][1].powi(2) + a[0][2].powi(2) + a[1][2].powi(2);
    let on: f64 = (0..3).map(|i| (a[i][i] - mean).powi(2)).sum();
    let size = ((on + 2.0 * off) / 6.0).sqrt();
    if size == 0.0 || !size.is_finite() {
        return mean + size;
    }
    let b = |i: usize, j: usize| (a[i][j] - if i == j { mean } else { 0.0 }) / size;
    let determinant = b(0, 0) * (b(1, 1) * b(2, 2) - b(1, 2) * b(2, 1))
        - b(0, 1) * (b(1, 0) * b(2, 2) - b(1, 2) * b(2, 0))
        + b(0, 2) * (b(1, 0) * b(2, 1) - b(1, 1) * b(2, 0));
    let angle = (0.5 * determinant).clamp(-1.0, 1.0).acos() / 3.0;
    let third = std::f64::consts::TAU / 3.0;
    // The greatest is at the angle itself, the least a third of a turn on; the middle one is what is left.
    let (greatest, least) = (2.0 * angle.cos(), 2.0 * (angle + third).cos());
    mean - size * (greatest + least)
}
