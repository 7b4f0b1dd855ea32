//! Values on regular grids: slopes, and values between the points.

use basis::records::Grid;

/// `values` of a record as numbers to reckon with.
pub fn widened(values: &[f32]) -> Vec<f64> {
    values.iter().copied().map(f64::from).collect()
}

/// Slopes of `values` (any unit, in the order of `grid`) along `axis` (0 to 2), per metre.
///
/// Central differences, of second order; so are those at the edges, to one side. Zero along an axis with one
/// point; not a number where a value that is needed is none.
pub fn slopes(grid: &Grid, values: &[f64], axis: usize) -> Vec<f64> {
    let stride: usize = grid.n_points[..axis].iter().product();
    let (last, spacing) = (grid.n_points[axis].saturating_sub(1), grid.spacing[axis]);
    let slope = |index: usize| {
        let step = grid.place(index)[axis];
        match (step, last) {
            (_, 0) => 0.0,
            (_, 1) => {
                let first = index - step * stride;
                (values[first + stride] - values[first]) / spacing
            }
            (0, _) => {
                let [a, b, c] = [0, stride, 2 * stride].map(|away| values[index + away]);
                (-3.0 * a + 4.0 * b - c) / (2.0 * spacing)
            }
            (step, last) if step == last => {
                let [a, b, c] = [0, stride, 2 * stride].map(|away| values[index - away]);
                (3.0 * a - 4.0 * b + c) / (2.0 * spacing)
            }
            _ => (values[index + stride] - values[index - stride]) / (2.0 * spacing),
        }
    };
    (0..values.len()).map(slope).collect()
}

/// Linear between the points around `position` (farm frame, m); none beyond the grid, or where one of those
/// points has no number.
///
/// Along an axis with one point, every position is on it.
pub fn value_at(grid: &Grid, values: &[f64], position: [f64; 3]) -> Option<f64> {
    let mut parts = [(0_usize, 0.0_f64); 3];
    for (axis, part) in parts.iter_mut().enumerate() {
        if grid.n_points[axis] > 1 {
            let steps = grid.steps_to(axis, position[axis])?;
            let low = (steps as usize).min(grid.n_points[axis] - 2);
            *part = (low, steps - low as f64);
        }
    }
    let mut sum = 0.0;
    for corner in 0..8_usize {
        let mut weight = 1.0;
        let place = std::array::from_fn(|axis| {
            let is_high = corner >> axis & 1;
            let (low, share) = parts[axis];
            weight *= if is_high == 1 { share } else { 1.0 - share };
            low + is_high
        });
        if weight > 0.0 {
            sum += weight * values[grid.index(place)];
        }
    }
    sum.is_finite().then_some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quadratic(grid: &Grid) -> Vec<f64> {
        let of = |[x, y, z]: [f64; 3]| 2.0 * x * x - 3.0 * x * y + y + 0.5 * z * z - z;
        (0..grid.len()).map(|index| of(grid.position(grid.place(index)))).collect()
    }

    /// Differences of second order are exact on a parabola, at the edges too.
    #[test]
    fn slopes_of_a_parabola_are_exact() {
        let grid =
            Grid { origin: [-1.0, 0.5, 2.0], spacing: [0.5, 0.25, 1.0], n_points: [4, 5, 3] };
        let values = quadratic(&grid);
        for index in 0..grid.len() {
            let [x, y, z] = grid.position(grid.place(index));
            let expected = [4.0 * x - 3.0 * y, 1.0 - 3.0 * x, z - 1.0];
            for (axis, expected) in expected.into_iter().enumerate() {
                assert!((slopes(&grid, &values, axis)[index] - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn values_between_points_are_linear_and_end_with_the_grid() {
        let grid = Grid { origin: [0.0; 3], spacing: [2.0, 1.0, 1.0], n_points: [3, 1, 2] };
        let values = [0.0, 2.0, f64::NAN, 10.0, 12.0, 14.0];
        assert_eq!(value_at(&grid, &values, [1.0, 7.0, 0.5]), Some(6.0));
        assert_eq!(value_at(&grid, &values, [4.0, 0.0, 1.0]), Some(14.0));
        assert_eq!(value_at(&grid, &values, [3.0, 0.0, 0.5]), None);
        assert_eq!(value_at(&grid, &values, [4.1, 0.0, 1.0]), None);
    }
}
