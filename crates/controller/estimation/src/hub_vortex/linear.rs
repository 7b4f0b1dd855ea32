//! Small systems of linear equations.

/// Least pivot, in parts of the greatest entry (–).
const LEAST_PIVOT: f64 = 1e-12;

/// Solution of `matrix` x = `right` by Gauss's elimination, the greatest pivot first; none of a singular one.
pub(super) fn solved<const N: usize>(
    mut matrix: [[f64; N]; N],
    mut right: [f64; N],
) -> Option<[f64; N]> {
    let greatest = matrix.as_flattened().iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
    for column in 0..N {
        let pivot = (column..N)
            .max_by(|a, b| matrix[*a][column].abs().total_cmp(&matrix[*b][column].abs()))?;
        let is_sound = matrix[pivot][column].abs() > LEAST_PIVOT * greatest;
        if !is_sound {
            return None;
        }
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        let (top, top_right) = (matrix[column], right[column]);
        for row in column + 1..N {
            let factor = matrix[row][column] / top[column];
            for (entry, above) in matrix[row][column..].iter_mut().zip(&top[column..]) {
                *entry -= factor * above;
            }
            right[row] -= factor * top_right;
        }
    }
    let mut solution = [0.0; N];
    for row in (0..N).rev() {
        let known = matrix[row][row + 1..].iter().zip(&solution[row + 1..]);
        let rest: f64 = known.map(|(entry, value)| entry * value).sum();
        solution[row] = (right[row] - rest) / matrix[row][row];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved_whatever_its_order_and_a_singular_one_is_told() {
        let matrix = [[0.0, 2.0, 1.0], [4.0, -1.0, 3.0], [1.0, 1.0, 0.0]];
        let solution = [3.0, -2.0, 0.5];
        let right = matrix.map(|row| row.iter().zip(&solution).map(|(a, x)| a * x).sum());
        let found = solved(matrix, right).expect("a sound system");
        assert!(found.iter().zip(&solution).all(|(a, b)| (a - b).abs() < 1e-13), "{found:?}");
        assert_eq!(solved([[1.0, 2.0], [2.0, 4.0]], [1.0, 2.0]), None);
        assert_eq!(solved([[f64::NAN]], [1.0]), None);
    }
}
