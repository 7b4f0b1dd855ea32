//! The universal median test: vectors that do not fit their neighbours.

use basis::records::Grid;

/// How the test judges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MedianTest {
    /// Residual over the median residual of the neighbours above which a vector is an outlier (–).
    pub threshold: f64,
    /// Fluctuation of the measurement that is no fault (m/s).
    pub noise: f64,
}

impl MedianTest {
    /// The published threshold (–).
    pub const THRESHOLD: f64 = 2.0;
}

/// Which vectors of `velocity` (m/s) on `grid` do not fit those around them, up to 26 of a volume and 8 of a
/// plane, of which those count that lie opposite each other. Holes are none; a vector with fewer than four
/// neighbours, such as one at an edge of a plane, is not judged.
///
/// Residuals of the components are taken together as the length of their vector.
/// Source: Westerweel and Scarano (2005), Exp. Fluids 39, 1096.
pub fn outliers(grid: &Grid, velocity: &[Vec<f64>; 3], test: &MedianTest) -> Vec<bool> {
    (0..grid.len()).map(|index| is_outlier(grid, velocity, test, index)).collect()
}

fn is_outlier(grid: &Grid, velocity: &[Vec<f64>; 3], test: &MedianTest, index: usize) -> bool {
    let neighbours = neighbours(grid, index);
    let mut square = 0.0;
    for values in velocity {
        let pairs = neighbours.iter().map(|pair| pair.map(|other| values[other]));
        let mut around: Vec<f64> = pairs.filter(|[a, b]| (a + b).is_finite()).flatten().collect();
        if around.len() < 4 || !values[index].is_finite() {
            return false;
        }
        let middle = median(&mut around);
        let mut residuals: Vec<f64> = around.iter().map(|u| (u - middle).abs()).collect();
        let scale = median(&mut residuals) + test.noise;
        let residual = (values[index] - middle).abs();
        if residual > 0.0 {
            square += (residual / scale).powi(2);
        }
    }
    square.sqrt() > test.threshold
}

/// Pairs of neighbours that lie opposite each other, where both are on the grid: at an edge of it a slope
/// would make all others lie to one side.
fn neighbours(grid: &Grid, index: usize) -> Vec<[usize; 2]> {
    let place = grid.place(index);
    let mut found = Vec::with_capacity(13);
    // The first half of the 26 ways: the others are opposite.
    for way in 0..13_usize {
        let steps = [way % 3, way / 3 % 3, way / 9];
        let moved = |sign: isize| -> Option<usize> {
            let mut there = [0; 3];
            for axis in 0..3 {
                let step = sign * (steps[axis] as isize - 1);
                there[axis] = place[axis].checked_add_signed(step)?;
            }
            let is_on = (0..3).all(|axis| there[axis] < grid.n_points[axis]);
            is_on.then(|| grid.index(there))
        };
        if let (Some(first), Some(second)) = (moved(1), moved(-1)) {
            found.push([first, second]);
        }
    }
    found
}

/// The middle one of `values`, which it reorders, or the mean of the two middle ones; not empty.
pub(super) fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    if n.is_multiple_of(2) { 0.5 * (values[n / 2 - 1] + values[n / 2]) } else { values[n / 2] }
}
