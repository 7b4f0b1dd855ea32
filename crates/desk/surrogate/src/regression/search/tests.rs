//! Tests of the bounds.

use super::*;
use crate::Observations;
use crate::regression::NoiseGroups;

/// The spread behind the bounds is the mean square of all rows, about their mean where there is a trend:
/// (1 + 1 + 25 + 9)/4 = 9 or, about 2.5, (2.25 + 2.25 + 6.25 + 0.25)/4 = 2.75; replicates are no fewer rows.
#[test]
fn bounds_count_each_row_of_a_replicate() {
    let data = Observations::of_curve(vec![0.0, 0.0, 0.0, 1.0], vec![1.0, 1.0, 5.0, 3.0]);
    let kernel = Kernel::of(Shape::SquaredExponential, 1);
    for (trend, square) in [(Trend::Zero, 9.0), (Trend::Constant, 2.75), (Trend::Linear, 2.75)] {
        let problem = Problem::new(&data, &NoiseGroups::One, &kernel, trend).expect("good data");
        let spread = square / problem.scaling.scale.powi(2);
        let found = bounds(&problem, &kernel).0;
        for (place, share) in [(0, 1e-4), (2, 1e-8)] {
            assert!((found[place][0] - (share * spread).ln()).abs() < 1e-12, "{trend:?} {found:?}");
        }
    }
}
