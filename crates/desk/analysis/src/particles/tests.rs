//! Particles of fields that are known.

use super::*;
use basis::records::Grid;
use proptest::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

fn even(random: &mut ChaCha8Rng) -> f64 {
    (f64::from(random.next_u32()) + 0.5) / 2_f64.powi(32)
}

/// Sum of twelve even numbers, less six: normal in effect, deviation one.
fn normal(random: &mut ChaCha8Rng) -> f64 {
    (0..12).map(|_| even(random)).sum::<f64>() - 6.0
}

const MOST: u64 = 1 << 30;

#[test]
fn the_published_cells_are_10_mm_apart() {
    let cells = Cells::new([[0.0, 0.4], [0.0, 0.7], [0.0, 0.7]], 0.04, 0.75, MOST).unwrap();
    assert_eq!(cells.grid.n_points, [41, 71, 71]);
    assert!((cells.grid.spacing[0] - 0.01).abs() < 1e-15);
    assert!(Cells::new([[0.0, 1.0]; 3], 0.04, 1.0, MOST).is_err());
    assert!(Cells::new([[0.0, 1.0], [1.0, 0.0], [0.0, 1.0]], 0.04, 0.5, MOST).is_err());
    let error = Cells::new([[0.0, 1e3]; 3], 0.04, 0.75, MOST).unwrap_err();
    assert!(matches!(error, ParticleError::TooMany { .. }));
}

proptest! {
    /// Particles anywhere in a linear field give its value in the middle and its slopes exactly, however
    /// unevenly they lie.
    #[test]
    fn a_linear_field_comes_back_from_uneven_particles(
        seed: u64, slopes in prop::array::uniform9(-3.0..3.0_f64),
    ) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let at = |p: [f64; 3]| -> [f64; 3] {
            std::array::from_fn(|i| 5.0 + (0..3).map(|j| slopes[3 * i + j] * p[j]).sum::<f64>())
        };
        let cells = Cells::new([[0.0, 0.1]; 3], 0.2, 0.5, MOST).unwrap();
        let mut binner = Binner::new(cells);
        for _ in 0..400 {
            // More of them where x is great.
            let place = [even(&mut random).sqrt(), even(&mut random), even(&mut random)];
            let place = place.map(|p| 0.3 * p - 0.1);
            binner.add(place, at(place));
        }
        let found = binner.binned(10);
        for index in 0..found.cells.grid.len() {
            let expected = at(found.cells.grid.position(found.cells.grid.place(index)));
            for i in 0..3 {
                prop_assert!((found.mean[i][index] - expected[i]).abs() < 1e-9);
                prop_assert!(found.stress[i][index].abs() < 1e-9);
                for j in 0..3 {
                    prop_assert!((found.slopes[index][i][j] - slopes[3 * i + j]).abs() < 1e-7);
                }
            }
        }
    }
}

/// Random velocities: stress is their variance, and the mean is as far off as its error tells.
#[test]
fn stresses_and_errors_are_those_of_the_samples() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let cells = Cells::new([[0.0, 0.0]; 3], 1.0, 0.0, MOST).unwrap();
    let (mut off, mut told, mut stress, n_sets) = (0.0, 0.0, [0.0; 2], 400);
    for _ in 0..n_sets {
        let mut binner = Binner::new(cells);
        for _ in 0..200 {
            let place = std::array::from_fn(|_| even(&mut random) - 0.5);
            let [a, b] = [normal(&mut random), normal(&mut random)];
            binner.add(place, [5.0 + 0.3 * a, 0.3 * (0.6 * a + 0.8 * b), 0.0]);
        }
        let found = binner.binned(1);
        off += (found.mean[0][0] - 5.0).powi(2);
        told += found.error[0][0].powi(2);
        stress[0] += found.stress[0][0] / n_sets as f64;
        stress[1] += found.stress[3][0] / n_sets as f64;
    }
    // 400 sets of 100 effective samples: a scatter of 0.7 % of the variance, 7 % of the squared error.
    assert!((stress[0] / 0.09 - 1.0).abs() < 0.025, "{stress:?}");
    assert!((stress[1] / (0.09 * 0.6) - 1.0).abs() < 0.05, "{stress:?}");
    assert!((off / told - 1.0).abs() < 0.25, "{off} {told}");
}

#[test]
fn what_is_not_taken_is_counted_and_empty_cells_are_masked() {
    let cells = Cells::new([[0.0, 1.0], [0.0, 0.0], [0.0, 0.0]], 0.5, 0.5, MOST).unwrap();
    let mut binner = Binner::new(cells);
    binner.add([0.1, 0.0, 0.0], [1.0, 2.0, 3.0]);
    binner.add([0.1, 0.0, 0.1], [1.0, 2.0, 5.0]);
    binner.add([0.1, 2.0, 0.0], [1.0; 3]);
    binner.add([0.1, f64::NAN, 0.0], [1.0; 3]);
    binner.add([0.1, 0.0, 0.0], [f64::INFINITY, 0.0, 0.0]);
    binner.refuse();
    let taken = Taken { kept: 2, outside: 1, not_finite: 2, outliers: 1 };
    assert_eq!(binner.taken(), taken);
    let found = binner.binned(2);
    assert_eq!((found.n[0], found.n[4], found.n_masked), (2, 0, 3));
    assert_eq!(found.mean[1][0], 2.0);
    assert!(found.mean[0][4].is_nan() && found.slopes[0][0][0].is_nan());
    assert!(is_beyond(&found, [0.0; 3], [1.0, 2.0, 30.0], 3.0, 0.0));
    assert!(!is_beyond(&found, [0.0; 3], [1.0, 2.0, 4.0], 3.0, 0.0));
    assert!(!is_beyond(&found, [1.0, 0.0, 0.0], [99.0, 0.0, 0.0], 3.0, 0.0));
}

#[test]
fn a_vector_that_fits_no_neighbour_is_found_and_shear_is_not() {
    let grid = Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [6, 5, 4] };
    let u = |index: usize| 5.0 + 0.8 * grid.position(grid.place(index))[2];
    let mut velocity: [Vec<f64>; 3] = std::array::from_fn(|_| (0..grid.len()).map(u).collect());
    let test = MedianTest { threshold: MedianTest::THRESHOLD, noise: 0.05 };
    assert!(outliers(&grid, &velocity, &test).iter().all(|is| !is));
    velocity[1][37] += 4.0;
    velocity[0][80] = f64::NAN;
    let found = outliers(&grid, &velocity, &test);
    let places: Vec<usize> = (0..grid.len()).filter(|index| found[*index]).collect();
    assert_eq!(places, [37]);
}
