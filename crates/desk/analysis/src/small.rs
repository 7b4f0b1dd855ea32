//! Small systems of linear equations.

/// The solution of a small symmetric system, by elimination with pivots; none where it has none.
pub(crate) fn solved<const N: usize>(
    mut matrix: [[f64; N]; N],
    mut right: [f64; N],
) -> Option<[f64; N]> {
    for column in 0..N {
        let best = (column..N)
            .max_by(|a, b| matrix[*a][column].abs().total_cmp(&matrix[*b][column].abs()))?;
        matrix.swap(column, best);
        right.swap(column, best);
        let pivot = matrix[column][column];
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        let above = matrix[column];
        for row in column + 1..N {
            let factor = matrix[row][column] / pivot;
            for (value, &over) in matrix[row].iter_mut().zip(&above).skip(column) {
                *value -= factor * over;
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|place| matrix[row][place] * right[place]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right.iter().all(|value| value.is_finite()).then_some(right)
}
