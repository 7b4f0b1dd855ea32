//! Natural bending modes of a clamped beam with a body at its free end, as polynomials: what a turbine file
//! needs where its source has stiffness and mass alone.
//!
//! Finite elements of Euler and Bernoulli with cubic shapes; the beam stands still, and gravity does not bend
//! it further.

/// Elements (–); twice as many change the frequencies by less than 0.1 %.
const N_ELEMENTS: usize = 60;
/// Entries of a row of a symmetric matrix from the diagonal to the left that are not zero (–).
const BAND: usize = 4;
/// Rounds of the iteration at most, and relative change of a squared frequency that ends it (–).
const MOST_ROUNDS: usize = 500;
const ENOUGH: f64 = 1e-13;
/// Least deflection of the free end over the greatest one with which a shape can be normalised there (–).
const LEAST_END: f64 = 1e-3;

/// Section of a beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamSection {
    /// Distance from the clamped end (m).
    pub position: f64,
    /// Mass per length (kg/m).
    pub mass: f64,
    /// Bending stiffness (N m²).
    pub stiffness: f64,
}

/// A rigid body on the free end.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndBody {
    /// Mass (kg).
    pub mass: f64,
    /// Its centre beyond the end, along the beam (m).
    pub distance: f64,
    /// Inertia about an axis across the bending, through the centre of mass (kg m²).
    pub inertia: f64,
}

/// A bending mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BendingMode {
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Coefficients of x² to x⁶ (–), x the share of the length from the clamped end; they sum to one.
    pub coefficients: [f64; 5],
}

/// Symmetric and banded: row i holds columns i, i − 1, …
type Banded = Vec<[f64; BAND]>;

/// First and second bending mode of the beam of `length` (m) with `sections` in rising order, two at least,
/// and `end`. None where numbers make no beam, or where the free end stands still in a mode.
pub fn bending_modes(
    length: f64,
    sections: &[BeamSection],
    end: EndBody,
) -> Option<[BendingMode; 2]> {
    let (stiffness, mass) = matrices(length, sections, end);
    let factor = factorised(&stiffness)?;
    let mut found: Vec<Vec<f64>> = Vec::new();
    let mut modes = Vec::new();
    for order in 0..2_i32 {
        let (squared, shape) = mode(&factor, &mass, &found, order)?;
        modes.push(BendingMode { frequency: squared.sqrt(), coefficients: polynomial(&shape)? });
        found.push(shape);
    }
    modes.try_into().ok()
}

/// Stiffness and mass; deflection and slope of each node but the clamped one.
fn matrices(length: f64, sections: &[BeamSection], end: EndBody) -> (Banded, Banded) {
    let n = 2 * N_ELEMENTS;
    let (mut stiffness, mut mass) = (vec![[0.0; BAND]; n], vec![[0.0; BAND]; n]);
    let h = length / N_ELEMENTS as f64;
    for element in 0..N_ELEMENTS {
        let section = section_at(sections, (element as f64 + 0.5) * h);
        let k = section.stiffness / h.powi(3);
        let m = section.mass * h / 420.0;
        let bending = [
            [12.0, 0.0, 0.0, 0.0],
            [6.0 * h, 4.0 * h * h, 0.0, 0.0],
            [-12.0, -6.0 * h, 12.0, 0.0],
            [6.0 * h, 2.0 * h * h, -6.0 * h, 4.0 * h * h],
        ];
        let inertia = [
            [156.0, 0.0, 0.0, 0.0],
            [22.0 * h, 4.0 * h * h, 0.0, 0.0],
            [54.0, 13.0 * h, 156.0, 0.0],
            [-13.0 * h, -3.0 * h * h, -22.0 * h, 4.0 * h * h],
        ];
        for row in 0..4 {
            for column in 0..=row {
                // The first node is clamped.
                let (Some(i), Some(_)) =
                    ((2 * element + row).checked_sub(2), (2 * element + column).checked_sub(2))
                else {
                    continue;
                };
                stiffness[i][row - column] += k * bending[row][column];
                mass[i][row - column] += m * inertia[row][column];
            }
        }
    }
    mass[n - 2][0] += end.mass;
    mass[n - 1][1] += end.mass * end.distance;
    mass[n - 1][0] += end.inertia + end.mass * end.distance.powi(2);
    (stiffness, mass)
}

/// Linear between `sections`, constant beyond.
fn section_at(sections: &[BeamSection], position: f64) -> BeamSection {
    let high = sections.partition_point(|section| section.position < position);
    match (high.checked_sub(1).and_then(|low| sections.get(low)), sections.get(high)) {
        (Some(low), Some(high)) => {
            let share = (position - low.position) / (high.position - low.position);
            BeamSection {
                position,
                mass: low.mass + share * (high.mass - low.mass),
                stiffness: low.stiffness + share * (high.stiffness - low.stiffness),
            }
        }
        (Some(section), None) | (None, Some(section)) => *section,
        (None, None) => BeamSection { position, mass: f64::NAN, stiffness: f64::NAN },
    }
}

/// Cholesky's factor of `matrix`; none where that is not positive definite.
fn factorised(matrix: &Banded) -> Option<Banded> {
    let mut factor = matrix.clone();
    for i in 0..factor.len() {
        for back in (0..BAND.min(i + 1)).rev() {
            let j = i - back;
            let mut sum = factor[i][back];
            for k in (i + 1).saturating_sub(BAND)..j {
                if j - k < BAND {
                    sum -= factor[i][i - k] * factor[j][j - k];
                }
            }
            factor[i][back] = if back > 0 {
                sum / factor[j][0]
            } else if sum > 0.0 {
                sum.sqrt()
            } else {
                return None;
            };
        }
    }
    Some(factor)
}

/// On return `vector` holds what the factorised matrix makes it of.
fn solve(factor: &Banded, vector: &mut [f64]) {
    for i in 0..vector.len() {
        let known: f64 = (1..BAND.min(i + 1)).map(|k| factor[i][k] * vector[i - k]).sum();
        vector[i] = (vector[i] - known) / factor[i][0];
    }
    for i in (0..vector.len()).rev() {
        let above = (1..BAND).filter(|k| i + k < vector.len());
        let known: f64 = above.map(|k| factor[i + k][k] * vector[i + k]).sum();
        vector[i] = (vector[i] - known) / factor[i][0];
    }
}

fn times(matrix: &Banded, vector: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; vector.len()];
    for i in 0..vector.len() {
        product[i] += matrix[i][0] * vector[i];
        for k in 1..BAND.min(i + 1) {
            product[i] += matrix[i][k] * vector[i - k];
            product[i - k] += matrix[i][k] * vector[i];
        }
    }
    product
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The slowest mode across the modes `found`: squared frequency (rad²/s²) and shape, by inverse iteration.
fn mode(factor: &Banded, mass: &Banded, found: &[Vec<f64>], order: i32) -> Option<(f64, Vec<f64>)> {
    let n = mass.len();
    let mut shape: Vec<f64> = (0..n).map(|i| ((i + 1) as f64 / n as f64).powi(order + 2)).collect();
    let mut before = f64::INFINITY;
    for _ in 0..MOST_ROUNDS {
        let mut next = times(mass, &shape);
        solve(factor, &mut next);
        for other in found {
            let weighted = times(mass, other);
            let share = dot(&next, &weighted) / dot(other, &weighted);
            next.iter_mut().zip(other).for_each(|(value, other)| *value -= share * other);
        }
        let size = dot(&next, &times(mass, &next)).sqrt();
        // Of unit size before, what became of it is one over the squared frequency.
        let old = dot(&shape, &times(mass, &shape)).sqrt();
        let squared = old / size;
        if !squared.is_finite() {
            return None;
        }
        shape = next.into_iter().map(|value| value / size).collect();
        if (squared / before - 1.0).abs() < ENOUGH {
            return Some((squared, shape));
        }
        before = squared;
    }
    None
}

/// Coefficients of x² to x⁶ that sum to one and come nearest to the deflections of `shape`; none where its
/// end stands still.
fn polynomial(shape: &[f64]) -> Option<[f64; 5]> {
    let deflections: Vec<f64> = shape.iter().step_by(2).copied().collect();
    let end = *deflections.last()?;
    let greatest = deflections.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    if end.abs() < LEAST_END * greatest {
        return None;
    }
    let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
    for (node, deflection) in deflections.iter().enumerate() {
        let x = (node + 1) as f64 / deflections.len() as f64;
        let terms: [f64; 4] = std::array::from_fn(|k| x.powi(k as i32 + 2) - x.powi(6));
        for row in 0..4 {
            right[row] += terms[row] * (deflection / end - x.powi(6));
            for column in 0..4 {
                matrix[row][column] += terms[row] * terms[column];
            }
        }
    }
    for pivot in 0..4 {
        for row in pivot + 1..4 {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            let upper = matrix[pivot];
            matrix[row].iter_mut().zip(upper).for_each(|(value, upper)| *value -= factor * upper);
            right[row] -= factor * right[pivot];
        }
    }
    for row in (0..4).rev() {
        let known: f64 = (row + 1..4).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    let [second, third, fourth, fifth] = right;
    let coefficients = [second, third, fourth, fifth, 1.0 - right.iter().sum::<f64>()];
    coefficients.iter().all(|value| value.is_finite()).then_some(coefficients)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uniform() -> [BeamSection; 2] {
        [0.0, 50.0].map(|position| BeamSection { position, mass: 300.0, stiffness: 2e9 })
    }

    #[test]
    fn a_uniform_beam_has_the_frequencies_of_the_textbook() {
        // ω = β² √(EI / m), β L = 1.8751041 and 4.6940911: the roots of cos β cosh β = −1 (Blevins,
        // "Formulas for natural frequency and mode shape", 1979, table 8-1).
        let modes = bending_modes(50.0, &uniform(), EndBody::default()).expect("a beam");
        for (mode, root) in modes.iter().zip([1.875_104_1_f64, 4.694_091_1]) {
            let expected = (root / 50.0).powi(2) * (2e9_f64 / 300.0).sqrt();
            assert!((mode.frequency / expected - 1.0).abs() < 1e-4, "{mode:?}, {expected}");
            assert!((mode.coefficients.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
        // Half way the first one deflects 0.3395 of its end (the same, table 8-1a).
        let at = |x: f64| -> f64 {
            (0..5).map(|k| modes[0].coefficients[k] * x.powi(k as i32 + 2)).sum()
        };
        assert!((at(0.5) - 0.3395).abs() < 5e-4, "{}", at(0.5));
    }

    #[test]
    fn a_heavy_body_swings_on_a_spring() {
        // Without inertia of its own: ω² = 3 E I / (M L³), as the beam's mass goes to nothing.
        let light = uniform().map(|section| BeamSection { mass: 1e-3, ..section });
        let body = EndBody { mass: 3e5, ..EndBody::default() };
        let modes = bending_modes(50.0, &light, body);
        // The end stands still in the second mode, which a shape of the end's motion cannot tell.
        assert_eq!(modes, None);
        let body = EndBody { mass: 3e5, distance: 5.0, inertia: 2e7 };
        let [first, _] = bending_modes(50.0, &light, body).expect("a beam");
        // Flexibility of the end under force and moment, on a body of two freedoms, by hand: with
        // a = L³/3, b = L²/2, c = L (over E I) and masses m, m d, J + m d².
        let (a, b, c) = (50.0_f64.powi(3) / 3.0, 1250.0, 50.0);
        let (m, s, j) = (3e5, 1.5e6, 2e7 + 25.0 * 3e5);
        let (trace, determinant) = (a * m + 2.0 * b * s + c * j, (a * c - b * b) * (m * j - s * s));
        let slowest = 0.5 * (trace + (trace * trace - 4.0 * determinant).sqrt()) / 2e9;
        assert!((first.frequency - slowest.powf(-0.5)).abs() < 1e-5 * first.frequency);
    }

    #[test]
    fn numbers_that_make_no_beam_make_no_modes() {
        let soft = uniform().map(|section| BeamSection { stiffness: 0.0, ..section });
        assert_eq!(bending_modes(50.0, &soft, EndBody::default()), None);
        assert_eq!(bending_modes(50.0, &[], EndBody::default()), None);
    }
}
